//! Linear elasticity.

use std::sync::Arc;

use nalgebra::Matrix4;

use super::law::{HyperelasticLaw, TensionResponse};
use super::parameters::Parameters;
use super::sheet::{Kinematics, PlaneState, PlaneTensor, SheetResponse};
use super::volume::lame_modulus;

/// Linear elasticity: Hooke's law in the strain of small displacement gradients.
///
/// ```text
/// W = ½ Λ (tr ε)² + μ ε : ε,   ε = ½ (H + Hᵀ),   P = Λ tr ε 1 + 2 μ ε              [MPa = N·mm/mm³]
/// plane stress   ε₃₃ = −Λ/(Λ + 2 μ) (ε₁₁ + ε₂₂)
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μ | `mu` | MPa | > 0 | shear modulus |
/// | ν | `poisson_ratio` | – | −0.9 … 0.4999 | Poisson's ratio; Λ = 2 μ ν/(1 − 2 ν) |
///
/// **Limits.** Every law of the same μ and ν at strains and rotations that are small against 1.
/// **Not covered.** Rotations: a rigid rotation causes a stress of the order of the square of the angle. Stresses on the deformed
/// sheet equal those on the sheet at rest. Take the law of Saint Venant and Kirchhoff where a sheet rotates.
#[derive(Clone, Copy, Debug)]
pub struct LinearElastic {
    /// μ in MPa.
    pub shear_modulus: f64,
    /// Λ in MPa.
    pub lame_modulus: f64,
    /// The state of the third direction.
    pub plane: PlaneState,
}

impl LinearElastic {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let [shear_modulus, poisson_ratio] = parameters.shear_modulus_and_ratio();
        Box::new(Self {
            shear_modulus,
            lame_modulus: lame_modulus(shear_modulus, poisson_ratio),
            plane: PlaneState::Stress,
        })
    }

    /// ε₃₃ over ε₁₁ + ε₂₂.
    fn contraction(&self) -> f64 {
        match self.plane {
            PlaneState::Stress => {
                -self.lame_modulus / (self.lame_modulus + 2.0 * self.shear_modulus)
            }
            PlaneState::Strain => 0.0,
        }
    }

    /// Λ (1 + ε₃₃/(ε₁₁ + ε₂₂)): Λ of the sheet in its plane.
    fn in_plane(&self) -> f64 {
        self.lame_modulus * (1.0 + self.contraction())
    }
}

/// ε₁₁ + ε₂₂ = J − 1 − det H, without cancellation.
fn trace(kinematics: &Kinematics) -> f64 {
    let f = &kinematics.deformation_gradient;
    kinematics.area_change - ((f[0] - 1.0) * (f[3] - 1.0) - f[1] * f[2])
}

impl HyperelasticLaw for LinearElastic {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        let trace = trace(kinematics);
        // ε₁₁ − ε₂₂ and 2 ε₁₂
        let [difference, shear] = [kinematics.distortion[0], kinematics.distortion[1]];
        let (mu, lame) = (self.shear_modulus, self.in_plane());
        let mean = (lame + mu) * trace;
        let squares = 0.5 * (trace * trace + difference * difference + shear * shear);
        let stress = PlaneTensor::new(
            mean + mu * difference,
            mu * shear,
            mu * shear,
            mean - mu * difference,
        );
        (0.5 * lame * trace * trace + mu * squares, stress)
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let (energy, first_piola_kirchhoff_stress) = self.stress(kinematics);
        let (mu, lame) = (self.shear_modulus, self.in_plane());
        let mut tangent = Matrix4::identity() * mu;
        (tangent[(0, 0)], tangent[(3, 3)]) = (lame + 2.0 * mu, lame + 2.0 * mu);
        (tangent[(0, 3)], tangent[(3, 0)]) = (lame, lame);
        (tangent[(1, 2)], tangent[(2, 1)]) = (mu, mu);
        SheetResponse {
            energy,
            first_piola_kirchhoff_stress,
            tangent,
        }
    }

    /// ```text
    /// P = 4 μ (Λ′ + μ)/(Λ′ + 2 μ) ε,   Λ′ = Λ (1 + ε₃₃/(ε₁₁ + ε₂₂))
    /// ```
    fn tension(&self, _: [f64; 2], strain: f64) -> TensionResponse {
        let (mu, lame) = (self.shear_modulus, self.in_plane());
        let slope = 4.0 * mu * (lame + mu) / (lame + 2.0 * mu);
        TensionResponse {
            energy: 0.5 * slope * strain * strain,
            nominal_stress: slope * strain,
            slope,
        }
    }

    fn volume_ratio(&self, kinematics: &Kinematics) -> f64 {
        kinematics.area_ratio() * self.thickness_stretch(kinematics)
    }

    fn thickness_stretch(&self, kinematics: &Kinematics) -> f64 {
        1.0 + self.contraction() * trace(kinematics)
    }

    fn thickness_gradient(&self, _: &Kinematics) -> PlaneTensor {
        self.contraction() * PlaneTensor::new(1.0, 0.0, 0.0, 1.0)
    }

    fn thickness_stress(&self, kinematics: &Kinematics) -> f64 {
        match self.plane {
            PlaneState::Stress => 0.0,
            PlaneState::Strain => self.lame_modulus * trace(kinematics),
        }
    }

    /// P itself, which is symmetric.
    fn cauchy_stress(&self, _: &Kinematics, stress: &PlaneTensor) -> [f64; 3] {
        [stress[0], stress[1], stress[3]]
    }

    fn plane_state(&self) -> PlaneState {
        self.plane
    }

    fn is_for_small_strains(&self) -> bool {
        true
    }

    fn in_plane_strain(&self) -> Option<Arc<dyn HyperelasticLaw>> {
        Some(Arc::new(Self {
            plane: PlaneState::Strain,
            ..*self
        }))
    }

    fn bulk_modulus(&self) -> Option<f64> {
        Some(self.lame_modulus + 2.0 / 3.0 * self.shear_modulus)
    }

    fn is_objective(&self) -> bool {
        false
    }
}
