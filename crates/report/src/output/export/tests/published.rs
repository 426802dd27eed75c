//! The energies that the manuals of the codes give, with the parameters of an exported file.

use super::*;
use crate::statistics::bisect;

/// What a code reads of a law: keyword, parameters in order (or points of a curve), and directions.
pub(super) struct Exported {
    pub(super) keyword: String,
    pub(super) values: Vec<f64>,
    pub(super) directions: Vec<[f64; 2]>,
}

impl Exported {
    pub(super) fn read(code: Code, text: &str) -> Self {
        match code {
            Code::FeBio => Self::of_xml(text),
            _ => Self::of_deck(text),
        }
    }

    pub(super) fn of_deck(text: &str) -> Self {
        let (_, after) = text.split_once("HYPERELASTIC, ").unwrap();
        let (keyword, _) = after.split_once('\n').unwrap();
        let keyword = keyword.split(", LOCAL").next().unwrap();
        let directions = if text.contains("*ORIENTATION") {
            let mut lines = numbers(text, "*ORIENTATION");
            if keyword.starts_with("FUNG") {
                vec![lines.remove(0)]
            } else {
                lines.split_off(2)
            }
        } else {
            Vec::new()
        };
        let data = match keyword {
            "MARLOW" => numbers(text, "*UNIAXIAL TEST DATA"),
            _ => numbers(text, "HYPERELASTIC, "),
        };
        Self {
            keyword: keyword.into(),
            values: data.concat(),
            directions: directions.iter().map(|row| [row[0], row[1]]).collect(),
        }
    }

    pub(super) fn of_xml(text: &str) -> Self {
        let (_, material) = text.split_once("name=\"material_1\" type=\"").unwrap();
        let (keyword, rest) = material.split_once("\">").unwrap();
        let (body, _) = rest.split_once("</material>").unwrap();
        let axis = body.split_once("<a>").map(|(_, axis)| row(axis));
        let body = body.split("<mat_axis").next().unwrap();
        let values = body.lines().filter_map(|line| line.split_once('>'));
        Self {
            keyword: keyword.into(),
            values: values.map(|(_, value)| row(value)[0]).collect(),
            directions: axis.iter().map(|row| [row[0], row[1]]).collect(),
        }
    }
}

/// The lines of numbers that follow a keyword.
pub(super) fn numbers(text: &str, keyword: &str) -> Vec<Vec<f64>> {
    let (_, after) = text.split_once(keyword).unwrap();
    let lines = after.lines().skip(1);
    let rows = lines.take_while(|line| !line.starts_with('*'));
    rows.map(row).collect()
}

pub(super) fn row(text: &str) -> Vec<f64> {
    let content = text.split('<').next().unwrap();
    content
        .split(',')
        .map(|field| field.trim().parse().unwrap())
        .collect()
}

/// An incompressible sheet with F₂₁ = 0.
pub(super) struct Sheet {
    /// C₁₁, C₁₂, C₂₂.
    pub(super) c: [f64; 3],
    pub(super) stretches: [f64; 3],
}

impl Sheet {
    pub(super) fn new([f11, f12, f22]: [f64; 3]) -> Self {
        let c = [f11 * f11, f11 * f12, f12 * f12 + f22 * f22];
        let mean = (c[0] + c[2]) / 2.0;
        let radius = ((c[0] - c[2]) / 2.0).hypot(c[1]);
        let stretches = [
            (mean + radius).sqrt(),
            (mean - radius).sqrt(),
            1.0 / (f11 * f22),
        ];
        Self { c, stretches }
    }

    pub(super) fn powers(&self, exponent: f64) -> f64 {
        self.stretches
            .iter()
            .map(|stretch| stretch.powf(exponent))
            .sum()
    }

    /// I₁ − 3 and I₂ − 3.
    pub(super) fn invariants(&self) -> [f64; 2] {
        [2.0, -2.0].map(|exponent| self.powers(exponent) - 3.0)
    }

    /// The energy of fibres in the form of Holzapfel, Gasser and Ogden.
    pub(super) fn fibre(&self, [k1, k2, kappa]: [f64; 3], [x, y]: [f64; 2]) -> f64 {
        let [c11, c12, c22] = self.c;
        let i4 = x * x * c11 + 2.0 * x * y * c12 + y * y * c22;
        let strain = kappa * self.invariants()[0] + (1.0 - 3.0 * kappa) * (i4 - 1.0);
        k1 / (2.0 * k2) * ((k2 * strain.max(0.0).powi(2)).exp() - 1.0)
    }
}

/// The energy of an incompressible sheet that the manuals give.
///
/// Abaqus 2016 Analysis User's Guide, 22.5.1 and 22.5.3; CalculiX 2.20, `*HYPERELASTIC`; FEBio User's Manual 4, uncoupled
/// materials.
pub(super) fn published(law: &Exported, sheet: &Sheet) -> f64 {
    let (v, [x, y]) = (&law.values[..], sheet.invariants());
    let ogden = |mu: f64, alpha: f64| 2.0 * mu / (alpha * alpha) * (sheet.powers(alpha) - 3.0);
    match (&*law.keyword, v) {
        ("NEO HOOKE", [c10, _]) => c10 * x,
        ("MOONEY-RIVLIN" | "Mooney-Rivlin", [c10, c01, _]) => c10 * x + c01 * y,
        ("POLYNOMIAL, N=2" | "polynomial", [c10, c01, c20, c11, c02, ..]) => {
            c10 * x + c01 * y + c20 * x * x + c11 * x * y + c02 * y * y
        }
        ("YEOH", [c10, c20, c30, ..]) => c10 * x + c20 * x * x + c30 * x.powi(3),
        ("ARRUDA-BOYCE", [mu, locking, _]) => {
            let factors = [
                0.5,
                1.0 / 20.0,
                11.0 / 1050.0,
                19.0 / 7000.0,
                519.0 / 673_750.0,
            ];
            let term = |(i, factor): (i32, f64)| {
                factor / locking.powi(2 * i - 2) * ((x + 3.0).powi(i) - 3.0_f64.powi(i))
            };
            mu * (1..).zip(factors).map(term).sum::<f64>()
        }
        // Σ c/m² (…)
        ("Ogden", _) => v
            .chunks_exact(2)
            .map(|term| ogden(term[0] / 2.0, term[1]))
            .sum(),
        ("Gent", [g, jm, _]) => -0.5 * g * jm * (1.0 - x / jm).ln(),
        ("Veronda-Westmann", [c1, c2, _]) => c1 * ((c2 * x).exp() - 1.0) - 0.5 * c1 * c2 * y,
        ("HOLZAPFEL", [c10, _, k1, k2, kappa]) => {
            let fibre = |along: &[f64; 2]| sheet.fibre([*k1, *k2, *kappa], *along);
            c10 * x + law.directions.iter().map(fibre).sum::<f64>()
        }
        // c/2 (e^Q − 1), Q = Σ bᵢⱼₖₗ Eᵢⱼ Eₖₗ over all indices, in material axes.
        ("FUNG-ORTHOTROPIC", [b1111, b1122, b2222, _, _, _, b1212, _, _, c, _]) => {
            let [c11, c12, c22] = sheet.c;
            let [x, y] = law.directions[0];
            let (e11, e22, e12) = ((c11 - 1.0) / 2.0, (c22 - 1.0) / 2.0, c12 / 2.0);
            let along = |[a, b]: [f64; 2], [p, q]: [f64; 2]| {
                a * p * e11 + (a * q + b * p) * e12 + b * q * e22
            };
            let (f, s) = ([x, y], [-y, x]);
            let [normal, shear, across] = [along(f, f), along(f, s), along(s, s)];
            let exponent = b1111 * normal * normal
                + 2.0 * b1122 * normal * across
                + b2222 * across * across
                + 4.0 * b1212 * shear * shear;
            c / 2.0 * (exponent.exp() - 1.0)
        }
        // Two families at ±γ from the first material axis.
        ("Holzapfel-Gasser-Ogden", [c, k1, k2, kappa, gamma, _]) => {
            let axis = law.directions.first().map_or(0.0, |[x, y]| y.atan2(*x));
            let fibre = |sign: f64| {
                let (sine, cosine) = (axis + sign * gamma.to_radians()).sin_cos();
                sheet.fibre([*k1, *k2, *kappa], [cosine, sine])
            };
            c / 2.0 * x + fibre(1.0) + fibre(-1.0)
        }
        ("MARLOW", curve) => marlow(curve, x),
        (keyword, _) if keyword.starts_with("OGDEN, N=") => {
            // μᵢ, αᵢ of each term, then its Dᵢ.
            let terms = v[..v.len() / 3 * 2].chunks_exact(2);
            terms.map(|term| ogden(term[0], term[1])).sum()
        }
        (other, _) => panic!("{other} {v:?}"),
    }
}

/// Marlow's energy ∫ T dε to the strain of a strip with the same I₁; T is linear between points of stress and strain.
pub(super) fn marlow(curve: &[f64], x: f64) -> f64 {
    let excess = |strain: f64| strain * strain * (3.0 + strain) / (1.0 + strain) - x;
    let [low, _] = bisect([0.0, 1e3], 100, |strain| excess(strain) < 0.0);
    let points: Vec<_> = curve.chunks_exact(2).collect();
    let mut energy = 0.0;
    for pair in points.windows(2) {
        let ([from, begin], [to, end]) = ([pair[0][0], pair[0][1]], [pair[1][0], pair[1][1]]);
        let part = (low.min(end) - begin).max(0.0);
        energy += part * (from + (to - from) * part / (end - begin) / 2.0);
    }
    energy
}
