//! The tangents of a body on its way.

use super::frequency;
use super::motion::{Motion, Moving};
use super::viscosity::{Passing, ViscousLocal, gather, inverted};
use crate::error::SolveFault;
use crate::solve::{Assembly, Connectivity, Inadmissible, Local, Potential};

/// The tangent of a step: of Π + viscous forces by the displacements at its end.
pub(super) struct Tangents<'a> {
    motion: &'a Motion<'a>,
    at: &'a Moving,
    elapsed: f64,
    /// How much of ∂Π/∂u + ∂f_v/∂u, and of ∂f_v/∂u̇.
    parts: [f64; 2],
}

impl<'a> Tangents<'a> {
    /// Of a state that lies `elapsed` after the memory's.
    pub fn new(motion: &'a Motion<'a>, at: &'a Moving, elapsed: f64) -> Self {
        Self {
            motion,
            at,
            elapsed,
            parts: [1.0, 0.0],
        }
    }

    /// The fastest vibration ω in rad/s, the viscous forces' stiffness included.
    pub fn fastest(&self, assembly: &Assembly) -> Result<f64, SolveFault> {
        let stiffness = self.assemble(assembly)?;
        let mass: Vec<f64> = gather(assembly.free(), &self.motion.mass);
        let fastest = frequency::fastest(assembly.pattern(), &stiffness, &mass);
        if fastest.is_finite() {
            Ok(fastest)
        } else {
            Err(SolveFault::NotFinite("the fastest frequency".into()))
        }
    }

    /// ∂f_v/∂u̇ over the free unknowns, in N·s/mm.
    pub fn damping(mut self, assembly: &Assembly) -> Result<Vec<f64>, SolveFault> {
        self.parts = [0.0, 1.0];
        self.assemble(assembly)
    }

    /// ∂Π/∂u + ∂f_v/∂u + c ∂f_v/∂u̇ over the free unknowns, in N/mm.
    pub fn combined(mut self, assembly: &Assembly, c: f64) -> Result<Vec<f64>, SolveFault> {
        self.parts = [1.0, c];
        self.assemble(assembly)
    }

    fn assemble(&self, assembly: &Assembly) -> Result<Vec<f64>, SolveFault> {
        let (mut residual, mut values) = (vec![0.0; self.unknowns()], Vec::new());
        assembly
            .linearise(self, &self.at.displacement, &mut residual, &mut values)
            .map_err(inverted(&*self.motion.describe))?;
        Ok(values)
    }

    fn add_viscous(
        &self,
        element: usize,
        u: &[f64],
        stiffness: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let Some(viscosity) = self.motion.viscosity else {
            return Ok(());
        };
        let velocity = gather(self.element_unknowns(element), &self.at.velocity);
        let passing = Passing {
            displacement: u,
            velocity: &velocity,
            memory: self.at.memory.of(element),
            elapsed: self.elapsed,
        };
        let mut force = vec![0.0; u.len()];
        let [mut by_displacement, mut by_velocity] = [(); 2].map(|()| vec![0.0; u.len() * u.len()]);
        let local = ViscousLocal {
            force: &mut force,
            tangents: Some([&mut by_displacement, &mut by_velocity]),
        };
        viscosity.add_element(element, passing, local)?;
        let [own, rates] = self.parts;
        for (sum, (k, c)) in stiffness
            .iter_mut()
            .zip(by_displacement.iter().zip(&by_velocity))
        {
            *sum += own * k + rates * c;
        }
        Ok(())
    }
}

impl Potential for Tangents<'_> {
    fn connectivity(&self) -> &Connectivity {
        self.motion.energy.connectivity()
    }

    fn evaluate_element(
        &self,
        element: usize,
        u: &[f64],
        mut local: Local<'_>,
    ) -> Result<f64, Inadmissible> {
        let mut energy = 0.0;
        if self.parts[0] != 0.0 {
            let own = Local {
                residual: &mut *local.residual,
                stiffness: local.stiffness.as_deref_mut(),
            };
            energy = self.motion.energy.evaluate_element(element, u, own)?;
        }
        if let Some(stiffness) = local.stiffness {
            self.add_viscous(element, u, stiffness)?;
        }
        Ok(energy)
    }
}
