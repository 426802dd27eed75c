//! The law of Holzapfel and Ogden for myocardium.

use std::f64::consts::FRAC_PI_4;

use super::anisotropic_law::{AnisotropicLaw, AnisotropicSheet};
use super::jet::Jet;
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// The law of Holzapfel and Ogden for myocardium, in a sheet that holds the fibres f and, across them, the sheet
/// direction s.
///
/// ```text
/// Ψ = a/(2b) (e^{b (I₁ − 3)} − 1) + Σ_{i = f, s} aᵢ/(2bᵢ) (e^{bᵢ ⟨I₄ᵢ − 1⟩²} − 1)
///     + a_fs/(2b_fs) (e^{b_fs I₈²} − 1)                                          [MPa = N·mm/mm³]
/// I₄ᵢ = |F i|²,   I₈ = (F f)·(F s),   ⟨x⟩ = max(x, 0)
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | a, b | `a`, `b` | MPa, – | > 0 | matrix: initial shear modulus, rate of stiffening |
/// | a_f, b_f | `a_f`, `b_f` | MPa, – | ≥ 0, > 0 | fibres |
/// | a_s, b_s | `a_s`, `b_s` | MPa, – | ≥ 0, > 0 | sheet direction |
/// | a_fs, b_fs | `a_fs`, `b_fs` | MPa, – | ≥ 0, > 0 | shear between both |
/// | θ | `angle` | angle | any | between f and the first axis |
///
/// Fibres carry in tension only; at rest the tangent is that of stretched fibres. Turned by 90° and with f and s
/// exchanged, the law is the same. Fits to tests without shear hold a_fs = 0 unless a bound or a value is stated.
///
/// **Limits.** a_f = a_s = a_fs = 0: Fung and Demiray with μ = a. b → 0, a_fs = 0: two perpendicular families of Holzapfel, Gasser and
/// Ogden's with κ = 0.
/// **Not covered.** Fibres out of the plane; dispersion. Exports: no code has this law by the same name and form.
///
/// # References
/// G. A. Holzapfel, R. W. Ogden, Phil. Trans. R. Soc. A 367, 3445 (2009), doi:10.1098/rsta.2009.0091
#[derive(Clone, Copy, Debug)]
pub struct HolzapfelOgden {
    /// a in MPa and b.
    pub matrix: [f64; 2],
    /// a_f in MPa and b_f.
    pub fibres: [f64; 2],
    /// a_s in MPa and b_s.
    pub sheets: [f64; 2],
    /// a_fs in MPa and b_fs.
    pub shear: [f64; 2],
}

impl HolzapfelOgden {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let pair = |[a, b]: [&'static str; 2], bound| {
            [
                parameters.stress(a, bound),
                parameters.number(b, Bound::Positive, [0.1, 100.0]),
            ]
        };
        let law = Self {
            matrix: pair(["a", "b"], Bound::Positive),
            fibres: pair(["a_f", "b_f"], Bound::NonNegative),
            sheets: pair(["a_s", "b_s"], Bound::NonNegative),
            shear: pair(["a_fs", "b_fs"], Bound::NonNegative),
        };
        let angle = parameters.angle("angle", [-FRAC_PI_4, FRAC_PI_4]);
        parameters.hold_without_shear(&[("a_fs", 0.0), ("b_fs", 1.0)]);
        AnisotropicSheet::boxed(law, angle)
    }
}

/// a/(2b) (e^x − 1) of x = b y.
#[inline(always)]
fn term([a, b]: [f64; 2], y: Jet) -> Jet {
    a / (2.0 * b) * (b * y).exponential_less_one()
}

impl AnisotropicLaw for HolzapfelOgden {
    #[inline(always)]
    fn energy(&self, [i1, c11, c12, c22]: [Jet; 4]) -> Jet {
        let stretched = |strain: Jet| strain.positive().squared();
        term(self.matrix, i1)
            + term(self.fibres, stretched(c11))
            + term(self.sheets, stretched(c22))
            + term(self.shear, c12.squared())
    }

    fn is_isotropic(&self) -> bool {
        [self.fibres, self.sheets, self.shear]
            .iter()
            .all(|[a, _]| *a == 0.0)
    }
}
