//! A law of a sheet that is stretched evenly as it is mounted.

use std::sync::Arc;

use nalgebra::{Matrix2, Matrix4};

use super::curve;
use super::law::{HyperelasticLaw, TensionResponse};
use super::sheet::{Kinematics, PlaneTensor, SheetResponse};

/// The response of a sheet relative to a state in which it is stretched by g₁, g₂ along both axes:
///
/// ```text
/// Ψ*(F) = Ψ(F G),   P* = P Gᵀ,   ∂P*ᵢⱼ/∂Fₖₗ = gⱼ ∂Pᵢⱼ/∂Fₖₗ gₗ,   G = diag(g₁, g₂)
/// ```
///
/// per volume as mounted, which is that at rest of a material that keeps its volume.
#[derive(Clone, Debug)]
pub struct PrestretchedLaw {
    /// The law from rest on.
    pub law: Arc<dyn HyperelasticLaw>,
    /// g₁ and g₂.
    pub stretches: [f64; 2],
}

impl PrestretchedLaw {
    /// The kinematics from rest on of those from the mounted state on; J stays positive.
    fn relative_to_rest(&self, mounted: &Kinematics) -> Kinematics {
        let [first, second] = self.stretches;
        let f = &mounted.deformation_gradient;
        Kinematics::unchecked(&PlaneTensor::new(
            f[0] * first - 1.0,
            f[1] * second,
            f[2] * first,
            f[3] * second - 1.0,
        ))
    }

    /// The factors of the components 11, 12, 21, 22 of a stress.
    fn factors(&self) -> PlaneTensor {
        let [first, second] = self.stretches;
        PlaneTensor::new(first, second, first, second)
    }
}

impl HyperelasticLaw for PrestretchedLaw {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        let (energy, stress) = self.law.stress(&self.relative_to_rest(kinematics));
        (energy, stress.component_mul(&self.factors()))
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let response = self.law.response(&self.relative_to_rest(kinematics));
        let factors = self.factors();
        let stress = response.first_piola_kirchhoff_stress;
        SheetResponse {
            energy: response.energy,
            first_piola_kirchhoff_stress: stress.component_mul(&factors),
            tangent: Matrix4::from_fn(|i, j| factors[i] * factors[j] * response.tangent[(i, j)]),
        }
    }

    fn tension(&self, direction: [f64; 2], strain: f64) -> TensionResponse {
        let [c, s] = direction;
        let turn = Matrix2::new(c, -s, s, c);
        // From the components in the axes of the strip to those of the sheet.
        let to_sheet = turn.kronecker(&turn);
        let identity = PlaneTensor::new(1.0, 0.0, 0.0, 1.0);
        let of_strip = |kinematics: &Kinematics| {
            let f = to_sheet * kinematics.deformation_gradient;
            let response = self.response(&Kinematics::unchecked(&(f - identity)));
            SheetResponse {
                first_piola_kirchhoff_stress: to_sheet
                    .tr_mul(&response.first_piola_kirchhoff_stress),
                tangent: to_sheet.tr_mul(&(response.tangent * to_sheet)),
                ..response
            }
        };
        curve::tension(&of_strip, strain)
    }

    fn is_isotropic(&self) -> bool {
        let [first, second] = self.stretches;
        first == second && self.law.is_isotropic()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{FungDemiray, NeoHooke};

    fn prestretched(law: Arc<dyn HyperelasticLaw>) -> PrestretchedLaw {
        PrestretchedLaw {
            law,
            stretches: [1.1, 0.95],
        }
    }

    /// Stress and tangent are derivatives of the energy per mounted volume.
    #[test]
    fn stress_and_tangent_are_the_derivatives_of_the_energy() {
        let law = prestretched(Arc::new(FungDemiray { mu: 0.02, b: 3.0 }));
        let h = PlaneTensor::new(0.1, -0.05, 0.08, 0.15);
        let at = law.response(&Kinematics::new(&h).unwrap());
        for column in 0..4 {
            let moved = |step: f64| {
                let mut moved = h;
                moved[column] += step;
                law.stress(&Kinematics::new(&moved).unwrap())
            };
            let (above, below) = (moved(1e-6), moved(-1e-6));
            let slope = (above.0 - below.0) / 2e-6;
            let stress = at.first_piola_kirchhoff_stress[column];
            assert!((slope / stress - 1.0).abs() < 1e-6, "{column}");
            let slope = (above.1 - below.1) / 2e-6;
            assert!((slope - at.tangent.column(column)).norm() < 1e-7 * at.tangent.norm());
        }
    }

    /// A strip of it is the strip of the law without stretch, of which one of its states is the beginning.
    #[test]
    fn a_strip_carries_what_the_strip_at_rest_carries_at_the_same_place() {
        let neo = NeoHooke { c10: 0.05 };
        let law = prestretched(Arc::new(neo));
        let mounted = law.tension([1.0, 0.0], 0.2).nominal_stress;
        let at_rest = neo.tension([1.0, 0.0], 1.2 * 1.1 - 1.0).nominal_stress;
        assert!(
            (mounted - 1.1 * at_rest).abs() < 1e-10,
            "{mounted} {at_rest}"
        );
        let across = law.tension([0.0, 1.0], 0.2).nominal_stress;
        let at_rest = neo.tension([1.0, 0.0], 1.2 * 0.95 - 1.0).nominal_stress;
        assert!(
            (across - 0.95 * at_rest).abs() < 1e-10,
            "{across} {at_rest}"
        );
    }
}
