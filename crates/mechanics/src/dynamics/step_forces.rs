//! The forces of a body in a time step, and their tangent.

use super::viscosity::{ElementMotion, Memory, Viscosity, ViscousLocal};
use crate::solve::{
    Connectivity, Evaluated, Inadmissible, Local, Potential, Take, evaluate_by_elements,
};

/// The forces of a body at given velocities as if they were those of a potential: ∂Π/∂u where it is elastic, and f_v.
pub struct StepForces<'a> {
    /// Π; its elements are those of the viscous forces.
    pub energy: &'a dyn Potential,
    /// f_v.
    pub viscosity: Option<&'a dyn Viscosity>,
    /// Velocity in mm/s, on all unknowns.
    pub velocity: &'a [f64],
    /// The memory of the elements at the end of the step before.
    pub memory: &'a Memory,
    /// Time since then in s.
    pub elapsed: f64,
    /// Whether ∂Π/∂u is included.
    pub elastic: bool,
    /// The share of ∂f_v/∂u in the tangent.
    pub by_displacement: f64,
    /// The factor of ∂f_v/∂u̇ in the tangent, in 1/s.
    pub by_velocity: f64,
}

impl StepForces<'_> {
    fn add_viscous(
        &self,
        viscosity: &dyn Viscosity,
        element: usize,
        u: &[f64],
        local: Local<'_>,
    ) -> Result<(), Inadmissible> {
        let motion = ElementMotion {
            displacement: u,
            velocity: &self.connectivity().values(element, self.velocity),
            memory: self.memory.of(element),
            elapsed: self.elapsed,
        };
        let size = local
            .stiffness
            .as_ref()
            .map_or(0, |stiffness| stiffness.len());
        let [mut by_displacement, mut by_velocity] = [(); 2].map(|()| vec![0.0; size]);
        let tangents = [&mut by_displacement[..], &mut by_velocity[..]];
        let viscous_local = ViscousLocal {
            force: local.residual,
            tangents: local.stiffness.is_some().then_some(tangents),
        };
        viscosity.add_element(element, motion, viscous_local)?;
        let parts = by_displacement.iter().zip(&by_velocity);
        for (sum, (k, c)) in local.stiffness.into_iter().flatten().zip(parts) {
            *sum += self.by_displacement * k + self.by_velocity * c;
        }
        Ok(())
    }
}

impl Potential for StepForces<'_> {
    fn connectivity(&self) -> &Connectivity {
        self.energy.connectivity()
    }

    fn evaluate(&self, u: &[f64], forces: &mut [f64], take: Take<'_>) -> Evaluated {
        match (self.elastic, self.viscosity) {
            (true, None) => self.energy.evaluate(u, forces, take),
            _ => evaluate_by_elements(self, u, forces, take),
        }
    }

    fn evaluate_element(&self, element: usize, u: &[f64], mut local: Local<'_>) -> Evaluated {
        let mut energy = 0.0;
        if self.elastic {
            let elastic_local = Local {
                residual: &mut *local.residual,
                stiffness: local.stiffness.as_deref_mut(),
            };
            energy = self.energy.evaluate_element(element, u, elastic_local)?;
        }
        if let Some(viscosity) = self.viscosity {
            self.add_viscous(viscosity, element, u, local)?;
        }
        Ok(energy)
    }
}
