//! A law whose second axis points the other way.

use std::sync::Arc;

use nalgebra::Matrix4;

use super::law::{HyperelasticLaw, TensionResponse};
use super::sheet::{Kinematics, PlaneTensor, SheetResponse};

/// The response of a sheet that keeps its volume, seen in a mirror:
///
/// ```text
/// Ψ*(F) = Ψ(M F M),   P* = M P M,   M = diag(1, −1)
/// ```
#[derive(Clone, Debug)]
pub struct MirroredLaw {
    /// The law as it is.
    pub law: Arc<dyn HyperelasticLaw>,
}

impl MirroredLaw {
    /// The signs of the components 11, 12, 21, 22 in the mirror.
    const SIGNS: PlaneTensor = PlaneTensor::new(1.0, -1.0, -1.0, 1.0);

    fn mirrored(kinematics: &Kinematics) -> Kinematics {
        let h = kinematics.deformation_gradient - PlaneTensor::new(1.0, 0.0, 0.0, 1.0);
        Kinematics::unchecked(&h.component_mul(&Self::SIGNS))
    }
}

impl HyperelasticLaw for MirroredLaw {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        let (energy, stress) = self.law.stress(&Self::mirrored(kinematics));
        (energy, stress.component_mul(&Self::SIGNS))
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let response = self.law.response(&Self::mirrored(kinematics));
        let (signs, stress) = (Self::SIGNS, response.first_piola_kirchhoff_stress);
        SheetResponse {
            energy: response.energy,
            first_piola_kirchhoff_stress: stress.component_mul(&signs),
            tangent: Matrix4::from_fn(|i, j| signs[i] * signs[j] * response.tangent[(i, j)]),
        }
    }

    fn tension(&self, [x, y]: [f64; 2], strain: f64) -> TensionResponse {
        self.law.tension([x, -y], strain)
    }

    fn is_isotropic(&self) -> bool {
        self.law.is_isotropic()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::HolzapfelGasserOgden;

    #[test]
    fn fibres_in_a_mirror_have_the_opposite_angle() {
        let fibres = |y: f64| HolzapfelGasserOgden {
            mu: 0.01,
            k1: 0.02,
            k2: 1.5,
            kappa: 0.08,
            fibres: vec![[0.8, y]],
        };
        let law = Arc::new(fibres(0.6).sheet());
        let (mirrored, expected) = (MirroredLaw { law }, fibres(-0.6).sheet());
        let state = Kinematics::new(&PlaneTensor::new(0.2, 0.05, -0.1, -0.04)).unwrap();
        let (a, b) = (mirrored.response(&state), expected.response(&state));
        let stresses = [a, b].map(|one| one.first_piola_kirchhoff_stress);
        assert!((stresses[0] - stresses[1]).norm() < 1e-12 * stresses[1].norm());
        assert!((a.tangent - b.tangent).norm() < 1e-12 * b.tangent.norm());
        let [a, b] = [
            mirrored.tension([0.6, 0.8], 0.2),
            expected.tension([0.6, 0.8], 0.2),
        ];
        assert!((a.nominal_stress / b.nominal_stress - 1.0).abs() < 1e-9);
    }
}
