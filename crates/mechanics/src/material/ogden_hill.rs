//! The law of Ogden and Hill for foams, and Blatz and Ko's.

use super::body::{BodyDerivatives, BodyLaw, BodySheet, BodyStretches};
use super::exponential::{exponential_less_one, exponential_remainder, second_quotient};
use super::law::HyperelasticLaw;
use super::ogden::Powers;
use super::parameters::Parameters;
use super::sheet::PlaneState;
use super::volume::POISSON_RATIO;
use crate::document::Bound;

/// The law of Ogden and Hill in the form of Storåkers: powers of the principal stretches of a foam.
///
/// ```text
/// W = Σᵢ 2 μᵢ/αᵢ² (λ₁^αᵢ + λ₂^αᵢ + λ₃^αᵢ − 3 + (J₃^(−αᵢ βᵢ) − 1)/βᵢ),   βᵢ = νᵢ/(1 − 2 νᵢ)    [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μᵢ | `mu_1` … | MPa | any | share of the initial shear modulus |
/// | αᵢ | `alpha_1` … | – | not 0 | exponents |
/// | νᵢ | `nu_1` … | – | −0.9 … 0.4999 | Poisson's ratio of the term |
///
/// Abaqus has it as `*HYPERFOAM` with the same parameters.
///
/// **Limits.** Equal νᵢ: ν is that ratio at any stretch of a strip, in logarithmic strain: λ₂ = λ₁^(−ν). νᵢ → ½ in plane stress:
/// Ogden. Small strain: μ₀ = Σ μᵢ. A term is stable at all strains where μᵢ αᵢ > 0 (in the convention with μᵢ/αᵢ) and βᵢ > −⅓.
///
/// # References
/// R. Hill, Adv. Appl. Mech. 18, 1 (1979), doi:10.1016/S0065-2156(08)70264-3;
/// B. Storåkers, J. Mech. Phys. Solids 34, 125 (1986), doi:10.1016/0022-5096(86)90033-5
#[derive(Clone, Debug)]
pub struct OgdenHill {
    /// The terms.
    pub terms: Vec<FoamTerm>,
}

/// A term of the law of Ogden and Hill.
#[derive(Clone, Copy, Debug)]
pub struct FoamTerm {
    /// μ in MPa.
    pub modulus: f64,
    /// α.
    pub exponent: f64,
    /// β.
    pub volume_exponent: f64,
}

const KEYS: [[&str; 3]; 3] = [
    ["mu_1", "alpha_1", "nu_1"],
    ["mu_2", "alpha_2", "nu_2"],
    ["mu_3", "alpha_3", "nu_3"],
];

/// β = ν/(1 − 2 ν)
fn volume_exponent(poisson_ratio: f64) -> f64 {
    poisson_ratio / (1.0 - 2.0 * poisson_ratio)
}

impl OgdenHill {
    /// Reads the parameters of a card with `N` terms.
    pub fn from_card<const N: usize>(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let term = |[mu, alpha, nu]: [&'static str; 3]| FoamTerm {
            modulus: parameters.stress(mu, Bound::Any),
            exponent: parameters.exponent(alpha),
            volume_exponent: volume_exponent(parameters.number(nu, POISSON_RATIO, [0.0, 0.45])),
        };
        let terms = KEYS[..N].iter().map(|keys| term(*keys)).collect();
        Box::new(BodySheet::new(Self { terms }, PlaneState::Stress))
    }

    /// Reads the parameters of a card of Blatz and Ko's law.
    ///
    /// ```text
    /// W = ½ μ f (I₁ − 3 + (J₃^(−2β) − 1)/β) + ½ μ (1 − f) (I₂/J₃² − 3 + (J₃^(2β) − 1)/β),   β = ν/(1 − 2 ν)
    /// ```
    ///
    /// | symbol | card key | unit | admissible | meaning |
    /// |---|---|---|---|---|
    /// | μ | `mu` | MPa | > 0 | initial shear modulus |
    /// | f | `share` | – | 0 … 1 | share of the solid; 0 is the foam of polyurethane that Blatz and Ko measured, with ν = ¼ |
    /// | ν | `poisson_ratio` | – | −0.9 … 0.4999 | initial Poisson's ratio |
    ///
    /// It has the terms α = 2 and α = −2 of the law of Ogden and Hill. The foam, f = 0, is unstable where a strip is
    /// stretched too far: its stable range is reported.
    ///
    /// # References
    /// P. J. Blatz, W. L. Ko, Trans. Soc. Rheol. 6, 223 (1962), doi:10.1122/1.548937
    pub fn blatz_ko_from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let [modulus, poisson_ratio] = parameters.shear_modulus_and_ratio();
        let share = parameters.number("share", Bound::Within(0.0, 1.0), [0.0, 1.0]);
        let term = |share: f64, exponent: f64| FoamTerm {
            modulus: share * modulus,
            exponent,
            volume_exponent: volume_exponent(poisson_ratio),
        };
        let terms = vec![term(share, 2.0), term(1.0 - share, -2.0)];
        Box::new(BodySheet::new(Self { terms }, PlaneState::Stress))
    }
}

impl BodyLaw for OgdenHill {
    type Shape = (f64, Powers);

    /// a, and T of every term.
    fn shape(&self, area_change: f64, z: f64) -> (f64, Powers) {
        let orders = self.terms.iter().map(|term| 0.5 * term.exponent);
        (area_change.ln_1p(), Powers::new(orders, z))
    }

    /// With T of [`Ogden`](super::Ogden): λ₁^α + λ₂^α = 2 e^(αa/2) T(z).
    fn evaluate(&self, at: BodyStretches<(f64, Powers)>) -> BodyDerivatives {
        let ((a, powers), total) = (at.shape, at.volume());
        let b = total - a;
        let mut sum = BodyDerivatives::default();
        for (number, term) in self.terms.iter().enumerate() {
            let (alpha, beta) = (term.exponent, term.volume_exponent);
            let factor = 2.0 * term.modulus / (alpha * alpha);
            let [t_minus_1, t, dt, ddt] = powers.of(number, 0.5 * alpha);
            let [grown, across, all] = [0.5 * alpha * a, alpha * b, alpha * total];
            let [grown_remainder, across_remainder] = [grown, across].map(exponential_remainder);
            let volume = exponential_less_one(-beta * all);
            let (growth_less_1, across_less_1) =
                (grown + grown_remainder, across + across_remainder);
            let growth = 1.0 + growth_less_1;
            sum.energy += factor
                * (2.0 * (growth * t_minus_1 + grown_remainder)
                    + across_remainder
                    + beta * all * all * second_quotient(-beta * all));
            sum.a += factor * alpha * (growth * t_minus_1 + growth_less_1 - volume);
            sum.b += factor * alpha * (across_less_1 - volume);
            sum.z += 2.0 * factor * growth * dt;
            sum.zz += 2.0 * factor * growth * ddt;
            sum.az += factor * alpha * growth * dt;
            let square = factor * alpha * alpha;
            let resisting = square * beta * (1.0 + volume);
            sum.aa += 0.5 * square * growth * t + resisting;
            sum.ab += resisting;
            sum.bb += square * (1.0 + across_less_1) + resisting;
        }
        sum
    }

    /// Σ 2 μ/α (e^(αb) − J₃^(−αβ))
    fn thickness_slope(&self, at: BodyStretches<(f64, Powers)>) -> f64 {
        let total = at.volume();
        let b = total - at.shape.0;
        let slopes = self.terms.iter().map(|term| {
            let (alpha, beta) = (term.exponent, term.volume_exponent);
            let across_less_1 = exponential_less_one(alpha * b);
            let volume = exponential_less_one(-beta * alpha * total);
            2.0 * term.modulus / alpha * (across_less_1 - volume)
        });
        let slope: f64 = slopes.sum();
        if slope.is_finite() { slope } else { f64::NAN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_by_thickness_is_that_of_the_energy() {
        let term = |modulus, exponent, volume_exponent| FoamTerm {
            modulus,
            exponent,
            volume_exponent,
        };
        let law = OgdenHill {
            terms: vec![term(0.4, 11.0, 0.3), term(-0.1, -4.5, 1.2)],
        };
        for area_change in [-0.4, -1e-6, 0.0, 0.3, 4.0] {
            for z in [0.0, 1e-8, 0.5] {
                for volume_root_change in [-0.6, -1e-7, 0.0, 0.2, 3.0] {
                    let at = || BodyStretches {
                        area_change,
                        shape: law.shape(area_change, z),
                        volume_root_change,
                    };
                    let (slope, all) = (law.thickness_slope(at()), law.evaluate(at()));
                    let scale = 1e-12 * all.bb.abs().max(slope.abs());
                    assert!((slope - all.b).abs() <= scale, "{slope} {}", all.b);
                }
            }
        }
        let far = BodyStretches {
            area_change: 0.0,
            shape: law.shape(0.0, 0.0),
            volume_root_change: 1e40,
        };
        assert!(law.thickness_slope(far).is_nan());
    }
}
