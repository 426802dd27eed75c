//! Gels: networks that take up solvent.

use super::body::{BodyDerivatives, BodyLaw, BodySheet, BodyStretches};
use super::compressible_neo_hooke::chains;
use super::law::HyperelasticLaw;
use super::logarithm::logarithm_remainder;
use super::parameters::Parameters;
use super::sheet::PlaneState;
use crate::document::Bound;
use crate::units::Dimension;

/// The gas constant in mJ/(mol·K), CODATA 2018.
pub const GAS_CONSTANT: f64 = 8_314.462_618;

/// A gel in contact with its solvent, after Flory and Rehner. The sheet at rest is the gel that has swollen freely.
///
/// ```text
/// W/φ = ½ G₀/φ₀ (λ₁² + λ₂² + λ₃² − 3 − B ln J₀) + R T/V₁ ((Q − 1) ln(1 − 1/Q) + χ (1 − 1/Q) − Q ln a)     [MPa]
/// λᵢ   stretches from the preparation,   J₀ = λ₁ λ₂ λ₃,   Q = J₀/φ₀   volume over that of the dry polymer
/// φ    polymer fraction of the freely swollen gel, W is per its volume
/// ```
///
/// W is the free energy at a fixed chemical potential R T ln a of the solvent: solvent flows in and out as the gel is stretched.
/// It vanishes at rest, where the gel has swollen freely:
///
/// ```text
/// G₀ ((φ/φ₀)^⅓ − ½ B φ/φ₀) + R T/V₁ (ln(1 − φ) + φ + χ φ² − ln a) = 0
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | G₀ | `modulus` | MPa | > 0 | shear modulus as prepared |
/// | N | `strand_density` | mol/m³ | > 0 | instead of `modulus`: strands in the gel as prepared; G₀ = N R T, phantom ½ N R T |
/// | χ | `chi` | – | −2 … 2 | Flory's interaction parameter |
/// | φ₀ | `preparation_fraction` | – | 0 … 1 | polymer fraction as prepared; 1 for a network made dry |
/// | B | `chains` | | `"affine"`, `"phantom"` | 1 for affine chains, 0 for phantom ones, on junctions of four strands |
/// | V₁ | `molar_volume` | mm³/mol | > 0 | of the solvent; default: 18.07 cm³/mol, water |
/// | T | `temperature` | K | > 0 | default: 298.15 K |
/// | a | `activity` | – | 0 … 1 | of the solvent: relative humidity; default: 1, in the liquid |
///
/// **Limits.** Swollen shear modulus G₀ (φ/φ₀)^⅓. Stretched so fast that no solvent moves, the gel is neo-Hookean
/// with this modulus; this law is for stretching so slow that the solvent is in equilibrium.
/// **Not covered.** χ that depends on the polymer fraction, charged networks, chains near their full length, the time
/// that the flow of solvent takes.
///
/// # References
/// P. J. Flory, J. Rehner, J. Chem. Phys. 11, 521 (1943), doi:10.1063/1.1723792;
/// J. C. Bray, E. W. Merrill, J. Appl. Polym. Sci. 17, 3779 (1973), doi:10.1002/app.1973.070171219;
/// W. Hong, Z. Liu, Z. Suo, Int. J. Solids Struct. 46, 3282 (2009), doi:10.1016/j.ijsolstr.2009.04.022
#[derive(Clone, Copy, Debug)]
pub struct Network {
    /// G₀ in MPa.
    pub modulus: f64,
    /// χ.
    pub chi: f64,
    /// φ₀.
    pub preparation_fraction: f64,
    /// B.
    pub logarithm: f64,
    /// R T/V₁ in MPa.
    pub osmotic_modulus: f64,
    /// a.
    pub activity: f64,
}

/// How the junctions of a network move: B, and G₀ over N R T.
const CHAINS: [(&str, [f64; 2]); 2] = [("affine", [1.0, 1.0]), ("phantom", [0.0, 0.5])];

impl Network {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let [logarithm, share] = parameters.choice("chains", &CHAINS);
        let temperature = parameters.condition("temperature", Dimension::Temperature, 298.15);
        let molar_volume = parameters.condition("molar_volume", Dimension::MolarVolume, 18_070.0);
        let activity = parameters.condition("activity", Dimension::Ratio, 1.0);
        let preparation_fraction =
            parameters.condition("preparation_fraction", Dimension::Ratio, f64::NAN);
        for (key, value) in [
            ("activity", activity),
            ("preparation_fraction", preparation_fraction),
        ] {
            if !(value > 0.0 && value <= 1.0) {
                parameters.fault(
                    key,
                    "must be greater than zero, up to 1",
                    "it is a fraction",
                );
            }
        }
        let thermal = GAS_CONSTANT * temperature;
        let modulus = match ["strand_density", "modulus"].map(|key| parameters.states(key)) {
            [true, given] => {
                if given {
                    parameters.remark("modulus");
                    let message = "and `modulus` are both given; one of them is enough";
                    parameters.fault("strand_density", message, "each follows from the other");
                }
                let strands = Dimension::Concentration;
                share * thermal * parameters.condition("strand_density", strands, f64::NAN)
            }
            [false, _] => parameters.stress("modulus", Bound::Positive),
        };
        let network = Self {
            modulus,
            chi: parameters.number("chi", Bound::Within(-2.0, 2.0), [0.3, 0.6]),
            preparation_fraction,
            logarithm,
            osmotic_modulus: thermal / molar_volume,
            activity,
        };
        Box::new(BodySheet::new(
            SwollenNetwork::new(network),
            PlaneState::Stress,
        ))
    }

    /// ln(1 − φ) + φ + χ φ² − ln a: the chemical potential of the solvent in the polymer without a network, less the potential outside, over R T.
    fn mixing(&self, fraction: f64) -> f64 {
        (-fraction).ln_1p() + fraction + self.chi * fraction * fraction - self.activity.ln()
    }

    /// The stress of the isotropically swollen gel in MPa: negative where it swells further.
    fn stress(&self, fraction: f64) -> f64 {
        let ratio = fraction / self.preparation_fraction;
        self.modulus * (ratio.cbrt() - 0.5 * self.logarithm * ratio)
            + self.osmotic_modulus * self.mixing(fraction)
    }

    /// φ: the polymer fraction of the gel that has swollen freely; NaN where a parameter is NaN.
    ///
    /// The stress is positive for the thinnest gel and negative for a dry one. Bisection between them, to the last digit.
    pub fn free_swelling(&self) -> f64 {
        let [mut low, mut high] = [f64::MIN_POSITIVE, 1.0];
        if self.stress(1e-12).is_nan() {
            return f64::NAN;
        }
        loop {
            // Fractions of any size are found to the same relative precision.
            let middle = if low < 0.1 * high {
                (low * high).sqrt()
            } else {
                0.5 * (low + high)
            };
            if middle <= low || middle >= high {
                return middle;
            }
            if self.stress(middle) > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
    }
}

/// A network, and the gel that it becomes by swelling freely.
#[derive(Clone, Copy, Debug)]
struct SwollenNetwork {
    network: Network,
    /// φ.
    fraction: f64,
    /// G₀ (φ/φ₀)^⅓ in MPa.
    modulus: f64,
    /// ln(1 − φ) + φ + χ φ² − ln a.
    mixing: f64,
}

impl SwollenNetwork {
    fn new(network: Network) -> Self {
        let fraction = network.free_swelling();
        let ratio = fraction / network.preparation_fraction;
        Self {
            network,
            fraction,
            modulus: network.modulus * ratio.cbrt(),
            mixing: network.mixing(fraction),
        }
    }

    /// The part U of the energy without the squares of the stretches, at v = J₃ − 1: U(c) − U(0) − c U′(0), U′(c) −
    /// U′(0) and U″(c) with c = ln J₃. With ϕ = φ/J₃:
    ///
    /// ```text
    /// U = −½ B G₀ φ/φ₀ c + R T/V₁ ((J₃ − φ) ln(1 − ϕ) + χ (φ − φ ϕ) − J₃ ln a)
    /// ```
    #[inline(always)]
    fn volume(&self, v: f64) -> [f64; 3] {
        let (phi, k) = (self.fraction, self.network.osmotic_modulus);
        let (chi, dry) = (self.network.chi, 1.0 - self.fraction);
        // J₃ − 1 − c, and 1/J₃ − 1 + c
        let swelling = -logarithm_remainder(v);
        let shrinking = v * v / (1.0 + v) - swelling;
        // ϕ − φ, and ln((1 − ϕ)/(1 − φ)) with its part beyond first order
        let thinner = -phi * v / (1.0 + v);
        let remainder = logarithm_remainder(-thinner / dry);
        let logarithm = remainder - thinner / dry;
        let now = phi + thinner;
        let change = remainder - thinner * phi / dry + chi * thinner * (phi + now);
        let slope = k * (v * self.mixing + (1.0 + v) * change);
        let curvature =
            k * (1.0 + v) * (self.mixing + change + now * now * (1.0 / (1.0 - now) - 2.0 * chi));
        let energy = k
            * ((self.mixing - phi - chi * phi * phi) * swelling + dry * remainder + v * logarithm
                - phi * (1.0 + chi * phi) * shrinking);
        [energy, slope, curvature]
    }
}

impl BodyLaw for SwollenNetwork {
    type Shape = f64;

    #[inline(always)]
    fn shape(&self, _: f64, z: f64) -> f64 {
        z
    }

    #[inline(always)]
    fn evaluate(&self, at: BodyStretches) -> BodyDerivatives {
        chains(self.modulus, at, self.volume(at.volume_change()))
    }

    fn swelling_stretch(&self) -> f64 {
        (self.network.preparation_fraction / self.fraction).cbrt()
    }

    fn statements(&self) -> Vec<(&'static str, String)> {
        let network = &self.network;
        let stretch = self.swelling_stretch();
        vec![
            (
                "freely swollen",
                format!(
                    "polymer fraction {:.6}, {:.5} times the dry volume; {:.5} times the volume and {stretch:.6} times the length \
                     as prepared",
                    self.fraction,
                    1.0 / self.fraction,
                    stretch.powi(3)
                ),
            ),
            (
                "swollen modulus",
                format!(
                    "{:.6} MPa, as prepared {:.6} MPa",
                    self.modulus, network.modulus
                ),
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Card;
    use crate::material::samples;
    use crate::material::sheet::{Kinematics, PlaneTensor};
    use crate::statistics::bisect;

    /// Gels of all kinds whose swelling is known: φ is chosen and χ follows from it.
    ///
    /// ```text
    /// χ = −(ln(1 − φ) + φ − ln a + G₀ V₁/(R T) ((φ/φ₀)^⅓ − ½ B φ/φ₀))/φ²
    /// ```
    fn gels() -> Vec<(Network, f64)> {
        let mut all = Vec::new();
        for modulus in [1e-3, 0.02, 0.5] {
            for preparation_fraction in [0.05, 0.3, 1.0] {
                for (logarithm, activity) in [(0.0, 1.0), (1.0, 1.0), (1.0, 0.97), (2.0, 1.0)] {
                    for fraction in [0.02, 0.1, 0.4, 0.9] {
                        let ratio: f64 = fraction / preparation_fraction;
                        let osmotic_modulus = 137.0;
                        let elastic = modulus / osmotic_modulus
                            * (ratio.powf(1.0 / 3.0) - 0.5 * logarithm * ratio);
                        let solution = f64::ln(1.0 - fraction) + fraction - f64::ln(activity);
                        let network = Network {
                            modulus,
                            chi: -(solution + elastic) / (fraction * fraction),
                            preparation_fraction,
                            logarithm,
                            osmotic_modulus,
                            activity,
                        };
                        all.push((network, fraction));
                    }
                }
            }
        }
        all
    }

    #[test]
    fn free_swelling_and_the_swollen_modulus_are_the_closed_forms() {
        let mut tested = 0;
        for (network, fraction) in gels() {
            let swelling = network.free_swelling();
            // Where χ is beyond ½ by much, a second phase may take the place: another root of the same equation.
            let first = network.stress(0.999 * fraction) > 0.0;
            let only = (1..2000).filter(|i| {
                let at = |i: i32| network.stress(f64::from(i) / 2000.0);
                at(*i) > 0.0 && at(*i + 1) <= 0.0
            });
            if !first || only.count() != 1 {
                continue;
            }
            crate::assert_near(swelling, fraction, 1e-10, &network);
            let law = BodySheet::new(SwollenNetwork::new(network), PlaneState::Stress);
            let swollen = network.modulus * (fraction / network.preparation_fraction).cbrt();
            crate::assert_near(law.shear_modulus(), swollen, 1e-10, &network);
            tested += 1;
        }
        assert!(tested > 60, "{tested}");
    }

    /// A film that swells on a rigid floor, in stretches from the preparation: λ₁ = λ₂ = 1, and
    ///
    /// ```text
    /// G₀ (λ₃² − ½ B)/λ₃ + R T/V₁ (ln(1 − φ) + φ + χ φ²) = 0,   φ = φ₀/λ₃,   σ₁₁ = G₀ (1 − λ₃²)/λ₃
    /// ```
    #[test]
    fn a_film_that_cannot_widen_has_the_stress_of_its_closed_form() {
        let sheet = samples::card(
            "flory-rehner",
            "modulus = \"0.02 MPa\"\nchi = 0.45\npreparation_fraction = 0.1\nchains = \"affine\"",
        )
        .law;
        let (modulus, osmotic) = (0.02, GAS_CONSTANT * 298.15 / 18_070.0);
        let balance = |l: f64| {
            let phi = 0.1 / l;
            modulus * (l * l - 0.5) / l + osmotic * ((1.0 - phi).ln() + phi + 0.45 * phi * phi)
        };
        let [_, low] = bisect([10.0, 0.2], 200, |l| balance(l) > 0.0);
        let network = Network {
            modulus,
            chi: 0.45,
            preparation_fraction: 0.1,
            logarithm: 1.0,
            osmotic_modulus: osmotic,
            activity: 1.0,
        };
        let swollen = (0.1 / network.free_swelling()).cbrt();
        let held = 1.0 / swollen - 1.0;
        let state = Kinematics::new(&PlaneTensor::new(held, 0.0, 0.0, held)).unwrap();
        let thickness = swollen * sheet.thickness_stretch(&state);
        assert!((thickness / low - 1.0).abs() < 1e-10, "{thickness} {low}");
        let stress = sheet.stress(&state).1;
        let computed = sheet.cauchy_stress(&state, &stress)[0];
        let expected = modulus * (1.0 - low * low) / low;
        crate::assert_near(computed, expected, 1e-9, &"");
    }

    #[test]
    fn strands_make_the_modulus_and_faults_are_told() {
        let rest =
            "chi = 0.45\npreparation_fraction = 0.1\nchains = \"phantom\"\ntemperature = \"300 K\"";
        let of = |text: &str| samples::card("flory-rehner", &format!("{text}\n{rest}")).law;
        let modulus = 0.5 * 20e-9 * GAS_CONSTANT * 300.0;
        let [by_strands, by_modulus] = [
            of("strand_density = \"20 mol/m^3\""),
            of(&format!("modulus = \"{modulus} MPa\"")),
        ]
        .map(|law| law.shear_modulus());
        assert!((by_strands / by_modulus - 1.0).abs() < 1e-12);
        let text = samples::card("flory-rehner", &format!("modulus = \"0.02 MPa\"\n{rest}")).text;
        let fault = |from: &str, to: &str| {
            let text = text.replace(from, to);
            Card::parse("gel", "gel.toml", &text)
                .unwrap_err()
                .to_string()
        };
        assert!(fault("preparation_fraction = 0.1\n", "").contains("preparation_fraction"));
        assert!(
            fault("preparation_fraction = 0.1", "preparation_fraction = 1.5").contains("up to 1")
        );
        assert!(fault("\"300 K\"", "\"300 mm\"").contains("temperature"));
        assert!(fault("chi = 0.45", "chi = 0.45\nhumidity = 1").contains("humidity"));
    }
}
