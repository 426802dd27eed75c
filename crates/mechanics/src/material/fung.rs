//! The exponential law of Fung for orthotropic sheets.

use std::f64::consts::FRAC_PI_4;

use super::anisotropic_law::{AnisotropicLaw, AnisotropicSheet};
use super::code::{Code, CodeLaw};
use super::jet::Jet;
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// The generalised law of Fung in the plane: the exponential of a quadratic form of Green and Lagrange's strain in material
/// axes.
///
/// ```text
/// Ψ = c/2 (e^Q − 1),   Q = a₁ E₁₁² + a₂ E₂₂² + 2 a₃ E₁₁ E₂₂ + a₄ (2 E₁₂)²    [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | c | `c` | MPa | > 0 | scale of the stress |
/// | a₁, a₂ | `a1`, `a2` | – | > 0 | stiffness along the first and the second material axis |
/// | a₃ | `a3` | – | a₃² < a₁ a₂ | coupling of both |
/// | a₄ | `a4` | – | > 0 | shear, with the amount of shear 2 E₁₂; with E₁₂ alone, a₄ is a quarter of the coefficient |
/// | θ | `angle` | angle | any | between the first material axis and that of the sheet |
///
/// Q is positive definite, which makes Ψ convex in E. Turned by 90° and with a₁ and a₂ exchanged, the law is the same.
/// Normal stresses of a sheet that is stretched along its axes depend on θ and a₄ through three coefficients of E₁₁² and
/// E₂₂² alone: fits to tests without shear hold θ = 0 and a₄ = 10 unless a bound or a value is stated for them.
///
/// **Limits.** Small strain: an orthotropic sheet with C₁₁₁₁ = c a₁, C₂₂₂₂ = c a₂, C₁₁₂₂ = c a₃, C₁₂₁₂ = c a₄.
/// **Not covered.** Terms of shear beside normal strain. The thickness follows from the constant volume and has no energy.
///
/// # References
/// P. Tong, Y. C. Fung, J. Biomech. 9, 649 (1976), doi:10.1016/0021-9290(76)90107-X; Y. C. Fung, K. Fronek, P. Patitucci,
/// Am. J. Physiol. 237, H620 (1979), doi:10.1152/ajpheart.1979.237.5.H620
#[derive(Clone, Copy, Debug)]
pub struct Fung {
    /// c in MPa.
    pub c: f64,
    /// a₁, a₂, a₃, a₄.
    pub a: [f64; 4],
}

impl Fung {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let c = parameters.stress("c", Bound::Positive);
        let number = |key, bound| parameters.number(key, bound, [0.1, 500.0]);
        let [a1, a2] = ["a1", "a2"].map(|key| number(key, Bound::Positive));
        let mut a3 = number("a3", Bound::Any);
        let a4 = number("a4", Bound::Positive);
        let angle = parameters.angle("angle", [-FRAC_PI_4, FRAC_PI_4]);
        parameters.hold_without_shear(&[("a4", 10.0), ("angle", 0.0)]);
        let most = (1.0 - 1e-9) * (a1 * a2).sqrt();
        if a3.abs() > most {
            let hint = "a3² must be less than a1 a2, or some strain lowers the energy";
            parameters.fault("a3", "is larger than a1 and a2 allow", hint);
            a3 = parameters.replace("a3", a3.clamp(-most, most));
        }
        let a = [a1, a2, a3, a4];
        AnisotropicSheet::boxed(Self { c, a }, angle)
    }
}

impl AnisotropicLaw for Fung {
    #[inline(always)]
    fn energy(&self, [_, c11, c12, c22]: [Jet; 4]) -> Jet {
        let ([a1, a2, a3, a4], e11, e22) = (self.a, 0.5 * c11, 0.5 * c22);
        // 2 E₁₁ E₂₂ = (E₁₁ + E₂₂)² − E₁₁² − E₂₂²
        let exponent = (a1 - a3) * e11.squared()
            + (a2 - a3) * e22.squared()
            + a3 * (e11 + e22).squared()
            + a4 * c12.squared();
        0.5 * self.c * exponent.exponential_less_one()
    }

    fn is_isotropic(&self) -> bool {
        let [a1, a2, a3, a4] = self.a;
        a1 == a2 && a1 == a3 + 2.0 * a4
    }

    /// Abaqus: b₁₁₁₁, b₁₁₂₂, b₂₂₂₂, b₁₁₃₃, b₂₂₃₃, b₃₃₃₃, b₁₂₁₂, b₁₃₁₃, b₂₃₂₃, c, D in material axes. FEBio's form needs a stiffness
    /// across the sheet.
    fn in_code(&self, code: Code, bulk: f64, axis: [f64; 2]) -> Option<CodeLaw> {
        let [a1, a2, a3, a4] = self.a;
        let names = [
            "b1111", "b1122", "b2222", "b1133", "b2233", "b3333", "b1212", "b1313", "b2323", "c",
            "D",
        ];
        let values = [a1, a3, a2, 0.0, 0.0, 0.0, a4, 0.0, 0.0, self.c, 2.0 / bulk];
        let law = || CodeLaw::directed("FUNG-ORTHOTROPIC", names.into_iter().zip(values), &[axis]);
        (code == Code::Abaqus).then(law).flatten()
    }
}
