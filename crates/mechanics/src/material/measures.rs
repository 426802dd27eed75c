//! Area and shape measures of a sheet's deformation, and the response of a law that depends on them.
//!
//! ```text
//! m = ln J,   z = (tr C − 2J)/(2J) = cosh(ln λ₁/λ₂) − 1                                      [–]
//! P = Ψ_m ∂m + Ψ_z ∂z,   ∂m = cof F/J,   ∂z = (F − cof F − z cof F)/J                      [MPa]
//! ∂²m = 𝔼/J − ∂m ⊗ ∂m,   ∂²z = (𝟙 − 𝔼 − z 𝔼)/J − ∂z ⊗ ∂m − ∂m ⊗ ∂z,   𝔼 = ∂ cof F/∂F
//! ```
//!
//! Every isotropic law of a sheet is a function of m and z. Both are smooth where the two stretches are equal, so no eigenvectors
//! are needed, and tr C − 2J is a sum of squares: no digit is lost near rest.

use nalgebra::Matrix4;

use super::sheet::{Kinematics, PlaneTensor, SheetResponse, cofactor, cofactor_derivative};

/// An energy and its derivatives with respect to m and z.
#[derive(Clone, Copy, Debug, Default)]
pub struct Derivatives {
    /// Ψ in mJ/mm³.
    pub energy: f64,
    /// Ψ_m in MPa.
    pub m: f64,
    /// Ψ_z in MPa.
    pub z: f64,
    /// Ψ_mm in MPa.
    pub mm: f64,
    /// Ψ_mz in MPa.
    pub mz: f64,
    /// Ψ_zz in MPa.
    pub zz: f64,
}

/// z, and the derivatives of m and z with respect to F.
#[derive(Clone, Copy, Debug)]
pub struct Measures {
    /// z.
    pub z: f64,
    /// ∂m/∂F.
    pub dm: PlaneTensor,
    /// ∂z/∂F.
    pub dz: PlaneTensor,
    /// 1/J.
    inverse: f64,
}

impl Measures {
    /// The measures of a state.
    #[inline(always)]
    pub fn new(kinematics: &Kinematics) -> Self {
        let inverse = 1.0 / kinematics.area_ratio();
        let cofactor = cofactor(&kinematics.deformation_gradient);
        // Half the squared norm of F − cof F is tr C − 2J.
        let distortion = &kinematics.distortion;
        let z = 0.25 * inverse * distortion.norm_squared();
        let dm = inverse * cofactor;
        Self {
            z,
            dm,
            dz: inverse * distortion - z * dm,
            inverse,
        }
    }

    /// P in MPa.
    #[inline(always)]
    pub fn stress(&self, w: &Derivatives) -> PlaneTensor {
        w.m * self.dm + w.z * self.dz
    }

    /// Energy, stress and tangent.
    #[inline(always)]
    pub fn response(&self, w: &Derivatives) -> SheetResponse {
        let (dm, dz) = (&self.dm, &self.dz);
        let mixed = w.mz - w.z;
        let [by_m, by_z] = [(w.mm - w.m) * dm + mixed * dz, mixed * dm + w.zz * dz];
        SheetResponse {
            energy: w.energy,
            first_piola_kirchhoff_stress: self.stress(w),
            tangent: by_m * dm.transpose()
                + by_z * dz.transpose()
                + Matrix4::identity() * (w.z * self.inverse)
                + cofactor_derivative() * ((w.m - w.z * (1.0 + self.z)) * self.inverse),
        }
    }
}
