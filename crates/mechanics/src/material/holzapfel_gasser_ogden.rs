//! The law of Holzapfel, Gasser and Ogden for sheets with fibres.

use super::code::{Code, CodeLaw};
use super::curve;
use super::law::{HyperelasticLaw, TensionResponse};
use super::parameters::Parameters;
use super::sheet::{Kinematics, PlaneTensor, SheetResponse};
use crate::document::Bound;

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
/// The contraction and the shear of a strip cut from the sheet follow from equilibrium: its curve has no closed form
/// and is found by Newton's method.
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
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let families = parameters.choice("families", &[("two", 2), ("one", 1)]);
        let (mu, k1) = (
            parameters.stress("mu", Bound::Positive),
            parameters.stress("k1", Bound::NonNegative),
        );
        let k2 = parameters.number("k2", Bound::Positive, [1e-2, 20.0]);
        let kappa = parameters.number("kappa", Bound::Within(0.0, 1.0 / 3.0), [0.0, 0.3]);
        let (sine, cosine) = parameters
            .angle("angle", [0.0, std::f64::consts::FRAC_PI_2])
            .sin_cos();
        let fibres = [[cosine, sine], [cosine, -sine]];
        Box::new(Self {
            mu,
            k1,
            k2,
            kappa,
            fibres: fibres[..families].to_vec(),
        })
    }

    /// The law in axes of which the first is `direction`.
    fn turned(&self, [c, s]: [f64; 2]) -> Self {
        let turn = |[x, y]: &[f64; 2]| [c * x + s * y, c * y - s * x];
        Self {
            fibres: self.fibres.iter().map(turn).collect(),
            ..*self
        }
    }

    /// Eₐ, ∂Eₐ/∂F, and Ψ, Ψ′, Ψ″ of one family; `None` for compressed fibres.
    fn family(&self, kinematics: &Kinematics, [x, y]: [f64; 2]) -> Option<Family> {
        let [e11, e12, e22] = kinematics.twice_green_lagrange;
        let stretched = x * x * e11 + 2.0 * x * y * e12 + y * y * e22; // I₄ − 1
        let aligned = 1.0 - 3.0 * self.kappa;
        let e = self.kappa * kinematics.invariants.i1_minus_3 + aligned * stretched;
        if e < 0.0 {
            return None;
        }
        let f = &kinematics.deformation_gradient;
        let along = [f[0] * x + f[1] * y, f[2] * x + f[3] * y]; // F a
        let direction = PlaneTensor::new(along[0] * x, along[0] * y, along[1] * x, along[1] * y);
        let exponent = self.k2 * e * e;
        let growth = self.k1 * exponent.exp();
        Some(Family {
            de: 2.0 * (self.kappa * kinematics.half_d1 + aligned * direction),
            energy: self.k1 / (2.0 * self.k2) * exponent.exp_m1(),
            d: growth * e,
            dd: growth * (1.0 + 2.0 * exponent),
        })
    }
}

struct Family {
    de: PlaneTensor,
    energy: f64,
    d: f64,
    dd: f64,
}

impl HyperelasticLaw for HolzapfelGasserOgden {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        let mut energy = 0.5 * self.mu * kinematics.invariants.i1_minus_3;
        let mut stress = self.mu * kinematics.half_d1;
        for family in self
            .fibres
            .iter()
            .filter_map(|a| self.family(kinematics, *a))
        {
            energy += family.energy;
            stress += family.d * family.de;
        }
        (energy, stress)
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let (energy, stress) = self.stress(kinematics);
        let isotropic = kinematics.second_derivative_1(); // ½ ∂²I₁/∂F²
        let mut tangent = self.mu * isotropic;
        for [x, y] in &self.fibres {
            let Some(family) = self.family(kinematics, [*x, *y]) else {
                continue;
            };
            tangent += family.dd * family.de * family.de.transpose();
            tangent += 2.0 * family.d * self.kappa * isotropic;
            let aligned = 2.0 * family.d * (1.0 - 3.0 * self.kappa);
            for (row, column, factor) in
                [(0, 0, x * x), (0, 1, x * y), (1, 0, x * y), (1, 1, y * y)]
            {
                tangent[(row, column)] += aligned * factor;
                tangent[(2 + row, 2 + column)] += aligned * factor;
            }
        }
        SheetResponse {
            energy,
            first_piola_kirchhoff_stress: stress,
            tangent,
        }
    }

    fn tension(&self, direction: [f64; 2], strain: f64) -> TensionResponse {
        let turned = self.turned(direction);
        curve::tension(&|kinematics| turned.response(kinematics), strain)
    }

    fn is_isotropic(&self) -> bool {
        self.k1 == 0.0 || 3.0 * self.kappa == 1.0
    }

    /// FEBio always has two families at ±γ: a single family is written as two of half the stiffness at γ = 0 in turned axes.
    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
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
