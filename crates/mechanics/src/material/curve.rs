//! The curves of the usual tests of a sheet, for every law.

use nalgebra::{Matrix2, Vector2, Vector4};

use super::law::{HyperelasticLaw, TensionResponse};
use super::sheet::{Kinematics, PlaneTensor, SheetResponse};
use crate::document::name_of;

/// The usual tests of a sheet, stretched by λ along its first axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Free edges: λ₂ = λ^(−½) where the law is isotropic.
    Uniaxial,
    /// λ₂ = 1 (pure shear).
    Planar,
    /// λ₂ = λ.
    Equibiaxial,
}

impl Mode {
    /// All tests with their names.
    pub const ALL: [(&'static str, Self); 3] = [
        ("uniaxial", Self::Uniaxial),
        ("planar", Self::Planar),
        ("equibiaxial", Self::Equibiaxial),
    ];

    /// The name of the test.
    pub fn name(self) -> &'static str {
        name_of(&Self::ALL, self)
    }

    /// The displacement gradient of the test at λ = 1 + `strain`; `None` where a strip with free edges has no equilibrium.
    pub fn gradient(self, law: &dyn HyperelasticLaw, strain: f64) -> Option<PlaneTensor> {
        match self {
            Self::Uniaxial => free_edges(&|kinematics| law.response(kinematics), strain),
            Self::Planar => Some(Vector4::new(strain, 0.0, 0.0, 0.0)),
            Self::Equibiaxial => Some(Vector4::new(strain, 0.0, 0.0, strain)),
        }
    }

    /// Nominal stress along the first axis at λ = 1 + `strain`, in MPa.
    pub fn nominal_stress(self, law: &dyn HyperelasticLaw, strain: f64) -> f64 {
        match self {
            Self::Uniaxial => law.tension([1.0, 0.0], strain).nominal_stress,
            Self::Planar => law.biaxial([strain, 0.0])[0],
            Self::Equibiaxial => law.biaxial([strain, strain])[0],
        }
    }
}

/// Shear stress P₁₂ of simple shear, u₁ = γ X₂, by the amount of shear γ, in MPa.
pub fn simple_shear(law: &dyn HyperelasticLaw, amount: f64) -> f64 {
    match Kinematics::new(&Vector4::new(0.0, amount, 0.0, 0.0)) {
        Ok(kinematics) => law.stress(&kinematics).1[1],
        Err(_) => f64::NAN,
    }
}

/// Points of the curves of a law: five values of λ, and of 1 + γ in simple shear, with nominal stresses in MPa.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The test; `None` for simple shear.
    pub mode: Option<Mode>,
    /// λ or 1 + γ, and nominal stress.
    pub points: [[f64; 2]; 5],
}

impl Sample {
    /// The name of the test.
    pub fn name(&self) -> &'static str {
        self.mode.map_or("shear", Mode::name)
    }
}

/// The end of a range of stretches to which a material is loaded: the upper one where the range includes tension.
pub fn far_end([low, high]: [f64; 2]) -> f64 {
    if high > 1.0 { high } else { low }
}

/// The curves of a law from rest to the far end of a range of stretches.
pub fn samples(law: &dyn HyperelasticLaw, range: [f64; 2]) -> Vec<Sample> {
    let far = far_end(range);
    let strain = |i: usize| (far - 1.0) * (i + 1) as f64 / 5.0;
    let modes = Mode::ALL.map(|(_, mode)| Some(mode)).into_iter();
    let sample = |mode: Option<Mode>| {
        let stress = |x: f64| match mode {
            Some(mode) => mode.nominal_stress(law, x),
            None => simple_shear(law, x),
        };
        Sample {
            mode,
            points: std::array::from_fn(|i| [1.0 + strain(i), stress(strain(i))]),
        }
    };
    modes.chain([None]).map(sample).collect()
}

/// The displacement gradient of a strip along the first axis with free edges: H₁₁ = `strain`, H₂₁ = 0, and H₁₂, H₂₂
/// such that P₁₂ = P₂₂ = 0. `None` where there is no such state.
///
/// Newton's method with step halving from the contraction of an isotropic strip, for H₁₂ and H₂₂. Where that ends beyond the
/// largest P₂₂, as in a compressed foam, it is repeated for H₁₂ and ln (1 + H₂₂) with the residual (P₁₂, (1 + H₂₂) P₂₂).
pub fn free_edges(
    response: &dyn Fn(&Kinematics) -> SheetResponse,
    strain: f64,
) -> Option<PlaneTensor> {
    let by = |scale: Scale| free_edges_by(response, strain, scale);
    by(Scale::Stretch).or_else(|| by(Scale::Logarithm))
}

/// What Newton's method looks for across a strip.
#[derive(Clone, Copy)]
enum Scale {
    /// H₂₂, with the residual P₂₂.
    Stretch,
    /// ln (1 + H₂₂), with the residual (1 + H₂₂) P₂₂.
    Logarithm,
}

impl Scale {
    /// Residual, and its tangent with respect to H₁₂ and the unknown.
    fn linearised(self, h: &PlaneTensor, state: &SheetResponse) -> (Vector2<f64>, Matrix2<f64>) {
        let (stress, a) = (&state.first_piola_kirchhoff_stress, &state.tangent);
        match self {
            Self::Stretch => (
                Vector2::new(stress[1], stress[3]),
                Matrix2::new(a[(1, 1)], a[(1, 3)], a[(3, 1)], a[(3, 3)]),
            ),
            Self::Logarithm => {
                let s = 1.0 + h[3];
                let across = s * (s * a[(3, 3)] + stress[3]);
                (
                    Vector2::new(stress[1], s * stress[3]),
                    Matrix2::new(a[(1, 1)], s * a[(1, 3)], s * a[(3, 1)], across),
                )
            }
        }
    }

    /// H₂₂ after a step of the unknown.
    fn moved(self, h: f64, step: f64) -> f64 {
        match self {
            Self::Stretch => h - step,
            Self::Logarithm => (1.0 + h) * (-step).exp() - 1.0,
        }
    }
}

/// A Newton step of this size relative to the strains is the last one: after it the error is of the order of its square.
const LAST_STEP: f64 = 1e-9;

fn free_edges_by(
    response: &dyn Fn(&Kinematics) -> SheetResponse,
    strain: f64,
    scale: Scale,
) -> Option<PlaneTensor> {
    // λ^−½ − 1
    let lateral = -strain / ((1.0 + strain) + (1.0 + strain).sqrt());
    let mut h = Vector4::new(strain, 0.0, 0.0, lateral);
    let at = |h: &PlaneTensor| Some(response(&Kinematics::new(h).ok()?));
    let mut state = at(&h)?;
    for _ in 0..60 {
        let (residual, block) = scale.linearised(&h, &state);
        let step = block.try_inverse()? * residual;
        let after = |length: f64| {
            let mut moved = h;
            moved[1] -= length * step[0];
            moved[3] = scale.moved(h[3], length * step[1]);
            moved
        };
        if step.norm() <= LAST_STEP * h.norm() {
            let last = after(1.0);
            return Some(if last[3] > -1.0 { last } else { h });
        }
        let shorter = |length: f64| {
            let moved = after(length);
            let tried = at(&moved)?;
            let smaller = scale.linearised(&moved, &tried).0.norm() < residual.norm();
            smaller.then_some((moved, tried))
        };
        (h, state) = (0..30).find_map(|halvings| shorter(0.5_f64.powi(halvings)))?;
    }
    None
}

/// The tension curve of a strip with free edges along the first axis, from the sheet's response. NaN where the strip has no equilibrium.
pub fn tension(response: &dyn Fn(&Kinematics) -> SheetResponse, strain: f64) -> TensionResponse {
    let condensed = || {
        let free = free_edges(response, strain)?;
        free_of_lateral_stress(&response(&Kinematics::new(&free).ok()?))
    };
    condensed().unwrap_or(TensionResponse {
        energy: f64::NAN,
        nominal_stress: f64::NAN,
        slope: f64::NAN,
    })
}

/// The tension response of a sheet near P₁₂ = P₂₂ = 0, condensed over H₁₂ and H₂₂: to the second order of these stresses, that at the
/// state without them. `None` where it does not resist H₁₂ and H₂₂.
pub fn free_of_lateral_stress(state: &SheetResponse) -> Option<TensionResponse> {
    let (stress, a) = (&state.first_piola_kirchhoff_stress, &state.tangent);
    let block = Matrix2::new(a[(1, 1)], a[(1, 3)], a[(3, 1)], a[(3, 3)]);
    let coupling = Vector2::new(a[(1, 0)], a[(3, 0)]);
    let condensed = block.try_inverse()? * coupling;
    Some(TensionResponse {
        energy: state.energy,
        nominal_stress: stress[0] - condensed.dot(&Vector2::new(stress[1], stress[3])),
        slope: a[(0, 0)] - coupling.dot(&condensed),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::parameters::{StrainMeasure, StressMeasure};
    use crate::material::registry::Law;

    /// λₜ = λ^(−ν) and P = 2μ/(αλ) (λ^α − λ^(−να)), however far a foam is pressed.
    #[test]
    fn a_pressed_foam_has_free_edges() {
        for exponent in [-6.0, -4.0, -3.0, -2.0, 2.0, 8.0] {
            for poisson_ratio in [1e-4_f64, 0.02, 0.3] {
                let values = [0.1, exponent, poisson_ratio];
                let law = Law::named("ogden-hill-1").unwrap();
                let (law, _) =
                    law.with_values(&values, StressMeasure::Nominal, StrainMeasure::Nominal);
                for stretch in [0.15_f64, 0.3, 0.4, 0.7, 1.3, 2.5] {
                    let computed = Mode::Uniaxial.nominal_stress(&*law, stretch - 1.0);
                    let drawn = stretch.powf(exponent) - stretch.powf(-poisson_ratio * exponent);
                    let exact = 0.2 / (exponent * stretch) * drawn;
                    assert!(
                        (computed - exact).abs() < 1e-9 * exact.abs(),
                        "α {exponent}, ν {poisson_ratio}, λ {stretch}: {computed} {exact}"
                    );
                }
            }
        }
    }
}
