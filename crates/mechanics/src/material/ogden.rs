//! Ogden's law.

use std::sync::Arc;

use super::code::{Code, CodeLaw};
use super::flory::{self, IsochoricLaw};
use super::law::{HyperelasticLaw, TensionResponse};
use super::measures::{Derivatives, Measures};
use super::parameters::Parameters;
use super::sheet::{Kinematics, PlaneTensor, SheetResponse};
use super::volume::Volume;
use crate::document::Bound;

/// Ogden's law: powers of the principal stretches.
///
/// ```text
/// Ψ = Σᵢ 2 μᵢ/αᵢ² (λ₁^αᵢ + λ₂^αᵢ + λ₃^αᵢ − 3)                      [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μᵢ | `mu_1` … | MPa | any | share of the initial shear modulus |
/// | αᵢ | `alpha_1` … | – | not 0 | exponents |
/// | | `convention` | | `"2mu/alpha^2"`, `"mu/alpha"`, `"mu/alpha^2"` | the factor before each sum |
///
/// With `convention = "mu/alpha"` the card's μᵢ are those of Ψ = Σ μᵢ/αᵢ (…), as Ogden wrote it; they become
/// μᵢ αᵢ/2 here. With `"mu/alpha^2"` they are FEBio's cᵢ, and become μᵢ/2.
///
/// **Derivation.** With m = ln J and z = (tr C − 2J)/(2J) = cosh(ln λ₁/λ₂) − 1 a term is
///
/// ```text
/// 2 μ/α² (2 e^{αm/2} T + e^{−αm} − 3),   T(z) = cosh(½ α arcosh(1 + z))
/// ```
///
/// T is Chebyshev's function of the order α/2: smooth in z where the two stretches are equal, so no
/// eigenvectors are needed. tr C − 2J is a sum of squares, and differences of exponentials are written
/// with expm1: no digit is lost near rest. T′ = α sinh(αδ)/(2 sinh 2δ) with z = 2 sinh²δ, and
/// T″ follows from z (2 + z) T″ + (1 + z) T′ = (α/2)² T.
///
/// **Limits.** One term with α = 2: neo-Hooke; terms with α = 2 and −2: Mooney–Rivlin. Small strain: μ₀ = Σ μᵢ
/// in the first convention. A term is stable when μᵢ > 0 (Hill).
/// **Not covered.** Fits are not unique: very different parameters may follow the same curve and differ
/// elsewhere (Ogden, Saccomandi, Sgura 2004).
///
/// # References
/// R. W. Ogden, Proc. R. Soc. Lond. A 326, 565 (1972), doi:10.1098/rspa.1972.0026;
/// R. W. Ogden, G. Saccomandi, I. Sgura, Comput. Mech. 34, 484 (2004), doi:10.1007/s00466-004-0593-y
#[derive(Clone, Debug)]
pub struct Ogden {
    /// μᵢ in MPa and αᵢ of each term, for the factor 2 μ/α².
    pub terms: Vec<[f64; 2]>,
}

/// The factor before the sum of powers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convention {
    /// 2 μ/α², of Abaqus and CalculiX.
    TwoMuByAlphaSquared,
    /// μ/α, of Ogden and Ansys.
    MuByAlpha,
    /// μ/α², of FEBio.
    MuByAlphaSquared,
}

impl Convention {
    /// The names that cards use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("2mu/alpha^2", Self::TwoMuByAlphaSquared),
        ("mu/alpha", Self::MuByAlpha),
        ("mu/alpha^2", Self::MuByAlphaSquared),
    ];

    /// The law's energy in this convention.
    pub const fn formula(self) -> &'static str {
        match self {
            Self::TwoMuByAlphaSquared => "Ψ = Σ 2 μᵢ/αᵢ² (λ₁^αᵢ + λ₂^αᵢ + λ₃^αᵢ − 3)",
            Self::MuByAlpha => "Ψ = Σ μᵢ/αᵢ (λ₁^αᵢ + λ₂^αᵢ + λ₃^αᵢ − 3)",
            Self::MuByAlphaSquared => "Ψ = Σ μᵢ/αᵢ² (λ₁^αᵢ + λ₂^αᵢ + λ₃^αᵢ − 3)",
        }
    }
}

const KEYS: [[&str; 2]; 4] = [
    ["mu_1", "alpha_1"],
    ["mu_2", "alpha_2"],
    ["mu_3", "alpha_3"],
    ["mu_4", "alpha_4"],
];

impl Ogden {
    /// Reads the parameters of a card with `N` terms.
    pub fn from_card<const N: usize>(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let convention = parameters.choice("convention", &Convention::NAMES);
        let term = |[mu, alpha]: [&'static str; 2]| {
            let mu = parameters.stress(mu, Bound::Any);
            let exponent = parameters.exponent(alpha);
            match convention {
                Convention::TwoMuByAlphaSquared => [mu, exponent],
                Convention::MuByAlpha => [mu * exponent / 2.0, exponent],
                Convention::MuByAlphaSquared => [mu / 2.0, exponent],
            }
        };
        Box::new(Self {
            terms: KEYS[..N].iter().map(|keys| term(*keys)).collect(),
        })
    }

    /// T of every term.
    fn powers(&self, z: f64) -> Powers {
        Powers::new(self.terms.iter().map(|[_, alpha]| 0.5 * alpha), z)
    }

    /// Ψ and its derivatives with respect to m and z.
    fn derivatives(&self, m: f64, powers: &Powers) -> Derivatives {
        let mut sum = Derivatives::default();
        for (term, [mu, alpha]) in self.terms.iter().enumerate() {
            let half = 0.5 * alpha;
            let grown = half * m;
            let [t_minus_1, t, dt, ddt] = powers.of(term, half);
            let a = grown.exp_m1();
            let (growth, shrink) = (1.0 + a, (-2.0 * grown).exp());
            let factor = 2.0 * mu / (alpha * alpha);
            sum.energy +=
                factor * (2.0 * growth * t_minus_1 + a * a * (3.0 + 2.0 * a) / (growth * growth));
            sum.m += factor * alpha * (growth * t_minus_1 + shrink * (3.0 * grown).exp_m1());
            sum.z += 2.0 * factor * growth * dt;
            sum.mm += 2.0 * mu * (0.5 * growth * t + shrink);
            sum.mz += factor * alpha * growth * dt;
            sum.zz += 2.0 * factor * growth * ddt;
        }
        sum
    }
}

/// T − 1, T, T′ and T″ of the terms of a law at one z; for laws with more terms than cards have, they are computed on demand.
#[derive(Clone, Copy, Debug)]
pub struct Powers {
    z: f64,
    delta: f64,
    terms: [[f64; 4]; KEYS.len()],
}

impl Powers {
    /// Computes them for the orders of the terms.
    pub fn new(orders: impl Iterator<Item = f64>, z: f64) -> Self {
        // Half the difference of the logarithmic stretches.
        let delta = (0.5 * z).sqrt().asinh();
        let mut terms = [[0.0; 4]; KEYS.len()];
        for (term, order) in terms.iter_mut().zip(orders) {
            *term = chebyshev(order, z, delta);
        }
        Self { z, delta, terms }
    }

    /// The values of a term, whose order is given once more.
    pub fn of(&self, term: usize, order: f64) -> [f64; 4] {
        match self.terms.get(term) {
            Some(known) => *known,
            None => chebyshev(order, self.z, self.delta),
        }
    }
}

/// T − 1, T, T′ and T″ of the order `n` at z = 2 sinh²δ.
fn chebyshev(n: f64, z: f64, delta: f64) -> [f64; 4] {
    let t_minus_1 = 2.0 * (n * delta).sinh().powi(2);
    let t = 1.0 + t_minus_1;
    let square = n * n;
    if z < 1e-4 {
        // T″ is multiplied by terms of the order of z: two terms of the series are exact there.
        let second = square * (square - 1.0) / 3.0;
        let ddt = second * (1.0 + (square - 4.0) * z / 5.0);
        let dt = square + second * z * (1.0 + (square - 4.0) * z / 10.0);
        return [t_minus_1, t, dt, ddt];
    }
    let dt = n * (2.0 * n * delta).sinh() / (2.0 * delta).sinh();
    let ddt = (square * t - (1.0 + z) * dt) / (z * (2.0 + z));
    [t_minus_1, t, dt, ddt]
}

impl IsochoricLaw for Ogden {
    type Shape = Powers;

    fn shape(&self, z: f64) -> Powers {
        self.powers(z)
    }

    fn at(&self, area_change: f64, powers: Powers) -> Derivatives {
        self.derivatives(area_change.ln_1p(), &powers)
    }
}

impl HyperelasticLaw for Ogden {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        let measures = Measures::new(kinematics);
        let w = IsochoricLaw::at(self, kinematics.area_change, self.powers(measures.z));
        (w.energy, measures.stress(&w))
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let measures = Measures::new(kinematics);
        let w = IsochoricLaw::at(self, kinematics.area_change, self.powers(measures.z));
        measures.response(&w)
    }

    fn with_volume(self: Arc<Self>, volume: Volume) -> Option<Arc<dyn HyperelasticLaw>> {
        Some(flory::sheet(self, volume))
    }

    /// ```text
    /// P = Σ 2 μ/α (λ^α − λ^(−α/2))/λ
    /// ```
    fn tension(&self, _: [f64; 2], strain: f64) -> TensionResponse {
        let (logarithm, stretch) = (strain.ln_1p(), 1.0 + strain);
        let mut energy = 0.0;
        // τ = dΨ/dε with ε = ln λ, and dτ/dε.
        let (mut tau, mut slope) = (0.0, 0.0);
        for [mu, alpha] in &self.terms {
            let b = (-0.5 * alpha * logarithm).exp_m1();
            let lateral = 1.0 + b;
            energy += 2.0 * mu / (alpha * alpha) * b * b * (3.0 + 2.0 * b) / (lateral * lateral);
            tau += 2.0 * mu / alpha * lateral * (1.5 * alpha * logarithm).exp_m1();
            slope += mu * (2.0 / (lateral * lateral) + lateral);
        }
        TensionResponse {
            energy,
            nominal_stress: tau / stretch,
            slope: (slope - tau) / (stretch * stretch),
        }
    }

    /// ```text
    /// Pᵢ = Σ 2 μ/α (λᵢ^α − λ₃^α)/λᵢ,   λ₃ = 1/(λ₁ λ₂)
    /// ```
    fn biaxial(&self, strains: [f64; 2]) -> [f64; 2] {
        let logarithms = strains.map(f64::ln_1p);
        let across = -logarithms[0] - logarithms[1];
        let mut stresses = [0.0; 2];
        for [mu, alpha] in &self.terms {
            let lateral = 2.0 * mu / alpha * (alpha * across).exp();
            for (stress, logarithm) in stresses.iter_mut().zip(logarithms) {
                *stress += lateral * (alpha * (logarithm - across)).exp_m1();
            }
        }
        [0, 1].map(|axis| stresses[axis] / (1.0 + strains[axis]))
    }

    /// μ₀ = Σ μᵢ.
    fn shear_modulus(&self) -> f64 {
        self.terms.iter().map(|[mu, _]| mu).sum()
    }

    fn youngs_modulus(&self) -> f64 {
        3.0 * self.shear_modulus()
    }

    /// FEBio writes Σ c/m² (…).
    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
        let ([mu, alpha], factor) = match code {
            Code::FeBio => (["c", "m"], 2.0),
            _ => (["mu_", "alpha_"], 1.0),
        };
        let count = self.terms.len();
        let term = |([value, exponent], i): ([f64; 2], usize)| {
            [
                (format!("{mu}{i}"), factor * value),
                (format!("{alpha}{i}"), exponent),
            ]
        };
        let terms = self.terms.iter().copied().zip(1..=count).flat_map(term);
        let volume = |i: usize| (format!("D{i}"), 2.0 / bulk);
        match code {
            Code::FeBio => CodeLaw::named("Ogden", terms.chain([("k".into(), bulk)])),
            Code::CalculiX if count > 3 => None,
            _ => CodeLaw::named(
                &format!("OGDEN, N={count}"),
                terms.chain((1..=count).map(volume)),
            ),
        }
    }
}
