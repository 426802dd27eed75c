//! The law of Holzapfel, Gasser and Ogden for sheets with fibres.

use std::f64::consts::FRAC_PI_2;

use super::anisotropic_law::{AnisotropicLaw, AnisotropicSheet};
use super::code::{Code, CodeLaw};
use super::jet::Jet;
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// The key of the number of families.
const FAMILIES: &str = "families";

/// The law of Holzapfel, Gasser and Ogden: a neo-Hookean matrix with one or two families of fibres in the
/// plane of the sheet.
///
/// ```text
/// Ψ = μ/2 (I₁ − 3) + Σₐ k₁/(2 k₂) (exp(k₂ ⟨Eₐ⟩²) − 1)                    [MPa = N·mm/mm³]
/// Eₐ = κ (I₁ − 3) + (1 − 3κ) (I₄ₐ − 1),   I₄ₐ = |F aₐ|²,   ⟨E⟩ = max(E, 0)
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μ | `mu` | MPa | > 0 | shear modulus of the matrix |
/// | k₁ | `k1` | MPa | ≥ 0 | stiffness of the fibres |
/// | k₂ | `k2` | – | > 0 | rate of their stiffening |
/// | κ | `kappa` | – | 0 … ⅓ | dispersion: 0 aligned, ⅓ without direction |
/// | θ | `angle` | angle | any | between the fibres and the first axis (the length of a plate) |
/// | | `families` | | `"one"`, `"two"` | fibres at θ, or at θ and −θ |
///
/// Fibres carry load only where ⟨E⟩ is positive; the stress is continuous there, the tangent is not. At rest the
/// tangent is that of stretched fibres.
///
/// **Limits.** k₁ → 0: neo-Hooke. κ = ⅓: isotropic.
/// **Not covered.** Fibres out of the plane, and buckling of compressed fibres.
///
/// # References
/// G. A. Holzapfel, T. C. Gasser, R. W. Ogden, J. Elasticity 61, 1 (2000), doi:10.1023/A:1010835316564;
/// T. C. Gasser, R. W. Ogden, G. A. Holzapfel, J. R. Soc. Interface 3, 15 (2006), doi:10.1098/rsif.2005.0073
#[derive(Clone, Debug)]
pub struct HolzapfelGasserOgden {
    /// μ in MPa.
    pub mu: f64,
    /// k₁ in MPa.
    pub k1: f64,
    /// k₂.
    pub k2: f64,
    /// κ.
    pub kappa: f64,
    /// Unit vectors along the families of fibres.
    pub fibres: Vec<[f64; 2]>,
}

impl HolzapfelGasserOgden {
    /// Reads the parameters of a card; values without a card are those of two families.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let families = parameters.choice(FAMILIES, &[("two", 2), ("one", 1)]);
        Self::read(parameters, families)
    }

    /// Reads the parameters of a card; values without a card are those of one family.
    pub fn one_family_from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let families = parameters.choice(FAMILIES, &[("one", 1), ("two", 2)]);
        Self::read(parameters, families)
    }

    fn read(parameters: &Parameters, families: usize) -> Box<dyn HyperelasticLaw> {
        let (mu, k1) = (
            parameters.stress("mu", Bound::Positive),
            parameters.stress("k1", Bound::NonNegative),
        );
        let k2 = parameters.number("k2", Bound::Positive, [1e-2, 20.0]);
        let kappa = parameters.number("kappa", Bound::Within(0.0, 1.0 / 3.0), [0.0, 0.3]);
        // Two families at θ and −θ are those at −θ and θ.
        let least = if families == 1 { -FRAC_PI_2 } else { 0.0 };
        let (sine, cosine) = parameters.angle("angle", [least, FRAC_PI_2]).sin_cos();
        let fibres = [[cosine, sine], [cosine, -sine]];
        Box::new(
            Self {
                mu,
                k1,
                k2,
                kappa,
                fibres: fibres[..families].to_vec(),
            }
            .sheet(),
        )
    }

    /// The sheet made of it, in whose axes the fibres are stated.
    pub fn sheet(self) -> AnisotropicSheet<Self> {
        AnisotropicSheet {
            law: self,
            axis: [1.0, 0.0],
        }
    }
}

impl AnisotropicLaw for HolzapfelGasserOgden {
    #[inline(always)]
    fn energy(&self, [i1, c11, c12, c22]: [Jet; 4]) -> Jet {
        let family = |[x, y]: &[f64; 2]| {
            let stretched = (x * x) * c11 + (2.0 * x * y) * c12 + (y * y) * c22; // I₄ − 1
            let strain = self.kappa * i1 + (1.0 - 3.0 * self.kappa) * stretched;
            let exponent = self.k2 * strain.positive().squared();
            self.k1 / (2.0 * self.k2) * exponent.exponential_less_one()
        };
        let matrix = 0.5 * self.mu * i1;
        self.fibres
            .iter()
            .map(family)
            .fold(matrix, |sum, one| sum + one)
    }

    fn is_isotropic(&self) -> bool {
        self.k1 == 0.0 || 3.0 * self.kappa == 1.0
    }

    /// FEBio always has two families at ±γ: a single family is written as two of half the stiffness at γ = 0 in turned axes.
    fn in_code(&self, code: Code, bulk: f64, _: [f64; 2]) -> Option<CodeLaw> {
        let febio = |k1: f64, gamma: f64, axis: &[[f64; 2]]| {
            let matrix = [
                ("c", self.mu),
                ("k1", k1),
                ("k2", self.k2),
                ("kappa", self.kappa),
            ];
            let all = matrix.into_iter().chain([("gamma", gamma), ("k", bulk)]);
            CodeLaw::directed("Holzapfel-Gasser-Ogden", all, axis)
        };
        match (code, &self.fibres[..]) {
            (Code::Abaqus, fibres @ [_, ..]) => {
                let matrix = [("C10", self.mu / 2.0), ("D", 2.0 / bulk)];
                let fibre = [("k1", self.k1), ("k2", self.k2), ("kappa", self.kappa)];
                CodeLaw::directed("HOLZAPFEL", matrix.into_iter().chain(fibre), fibres)
            }
            (Code::FeBio, fibres @ [_]) => febio(self.k1 / 2.0, 0.0, fibres),
            (Code::FeBio, [[x, y], other]) if *other == [*x, -y] => {
                febio(self.k1, y.atan2(*x).to_degrees(), &[])
            }
            _ => None,
        }
    }
}
