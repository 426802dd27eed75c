//! The plate that moves, and how its motion is integrated and measured.

use std::sync::Arc;

use crate::dynamics::{
    History, Integrator, Motion, MovingSupport, Start, Step, TimeSettings, follow, lumped_mass,
};
use crate::error::{Error, SolveFault};
use crate::material::{HyperelasticLaw, NeoHooke};
use crate::mesh::Mesh;
use crate::problem::{ClampedPlate, Model};
use crate::validation::case::failed;

pub const SIZE: [f64; 2] = [150.0, 50.0];
pub const THICKNESS: f64 = 2.0;
/// In tonne/mm³.
pub const DENSITY: f64 = 1.02e-9;
pub const VERLET: Integrator = Integrator::VelocityVerlet;
pub const NEWMARK: Integrator = Integrator::GeneralisedAlpha {
    spectral_radius: 1.0,
    tolerance: 1e-11,
};
pub const METHODS: [(&str, Integrator); 2] =
    [("velocity Verlet", VERLET), ("generalised-α", NEWMARK)];

pub fn law() -> Arc<dyn HyperelasticLaw> {
    Arc::new(NeoHooke { c10: 0.05 })
}

pub fn problem(stretches: Vec<f64>) -> ClampedPlate {
    ClampedPlate {
        size: SIZE,
        thickness: THICKNESS,
        law: law(),
        stretches,
    }
}

pub fn fault(step: &str, fault: SolveFault) -> Error {
    failed("motion", step)(fault)
}

/// A motion of a model without loads, clamped on the left.
pub fn clamped<'a>(model: &'a Model<'a>, start: Vec<f64>) -> Motion<'a> {
    Motion {
        energy: model.energy,
        viscosity: None,
        mass: lumped_mass(model.mesh, DENSITY, THICKNESS),
        supports: vec![MovingSupport::fixed(unknowns_of(model.mesh, "left"))],
        forces: Vec::new(),
        start: Start::held_at(start),
        describe: Box::new(|element| (model.describe)(element)),
    }
}

/// The unknowns of a side.
pub fn unknowns_of(mesh: &Mesh, side: &str) -> Vec<usize> {
    let nodes = mesh.groups()[side].nodes.iter();
    nodes.flat_map(|node| [2 * node, 2 * node + 1]).collect()
}

/// Equal steps in time.
pub struct Run {
    pub integrator: Integrator,
    /// In s.
    pub step: f64,
    pub count: usize,
    /// Steps from one instant to the next.
    pub every: usize,
}

impl Run {
    pub fn history(&self, motion: &Motion) -> Result<History, Error> {
        let settings = TimeSettings {
            duration: self.count as f64 * self.step,
            interval: self.every as f64 * self.step,
            step: Step::AtMost(self.step * (1.0 + 1e-9)),
            integrator: self.integrator,
            most_steps: crate::budget::Budget::USUAL.steps,
        };
        follow(motion, settings, &|_| ()).map_err(|end| fault(&end.describe(), end.fault))
    }

    /// Frequency of an unknown in Hz.
    pub fn frequency(&self, motion: &Motion, unknown: usize) -> Result<f64, Error> {
        let history = self.history(motion)?;
        Ok(measured(&history.times(), &history.displacement(unknown)))
    }
}

/// Frequency in Hz from the first and the last rise of a series through zero, found by inverse interpolation with cubics.
fn measured(times: &[f64], values: &[f64]) -> f64 {
    let rises = (2..values.len() - 1).filter(|i| values[i - 1] < 0.0 && values[*i] >= 0.0);
    let crossings = rises.map(|i| {
        let (t, u) = (&times[i - 2..i + 2], &values[i - 2..i + 2]);
        let weight = |a: usize| -> f64 {
            let others = (0..4).filter(|b| *b != a);
            others.map(|b| -u[b] / (u[a] - u[b])).product()
        };
        (0..4).map(|a| t[a] * weight(a)).sum()
    });
    let crossings: Vec<f64> = crossings.collect();
    match crossings[..] {
        [first, .., last] => (crossings.len() - 1) as f64 / (last - first),
        _ => f64::NAN,
    }
}
