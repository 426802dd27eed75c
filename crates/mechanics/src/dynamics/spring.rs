//! A single spring with a dashpot: one unknown, of which closed forms are known.

use super::viscosity::{ElementMotion, Viscosity, ViscousLocal};
use crate::solve::{Connectivity, Evaluated, Inadmissible, Local, Potential};

/// One unknown with the energy ½ k u² + ¼ q u⁴, in mJ, and a dashpot of constant c in N·s/mm.
pub struct Spring {
    /// k in N/mm.
    pub k: f64,
    /// q in N/mm³.
    pub q: f64,
    /// c in N·s/mm.
    pub c: f64,
}

impl Potential for Spring {
    fn connectivity(&self) -> &Connectivity {
        Connectivity::single()
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        let u = u[0];
        if u.abs() > 1e6 {
            return Err(Inadmissible { element });
        }
        local.residual[0] = self.k * u + self.q * u.powi(3);
        if let Some(stiffness) = local.stiffness {
            stiffness[0] = self.k + 3.0 * self.q * u * u;
        }
        Ok(0.5 * self.k * u * u + 0.25 * self.q * u.powi(4))
    }
}

impl Viscosity for Spring {
    fn add_element(
        &self,
        _: usize,
        motion: ElementMotion<'_>,
        local: ViscousLocal<'_>,
    ) -> Result<(), Inadmissible> {
        local.force[0] += self.c * motion.velocity[0];
        if let Some([_, damping]) = local.tangents {
            damping[0] += self.c;
        }
        Ok(())
    }
}
