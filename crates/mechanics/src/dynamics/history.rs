//! A computed motion: its instants and energies.

use crate::statistics::larger;

/// The energies of a motion, in mJ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
    /// ½ u̇ᵀ M u̇.
    pub kinetic: f64,
    /// Π, the energy of the springs or of the elastic material.
    pub stored: f64,
    /// Work done against the viscous forces since the start: dissipated energy, and energy stored for a while by relaxing stresses.
    pub viscous_work: f64,
    /// Work of loads and supports since the start.
    pub external_work: f64,
}

impl EnergyBalance {
    /// Kinetic and stored energy and viscous work less the external work: constant in an exact motion.
    pub fn total(&self) -> f64 {
        self.kinetic + self.stored + self.viscous_work - self.external_work
    }

    /// The largest of the energies, relative to which their errors are measured.
    pub fn largest(&self) -> f64 {
        let parts = [self.stored, self.viscous_work, self.external_work];
        parts
            .into_iter()
            .fold(self.kinetic, |most, part| most.max(part.abs()))
    }
}

/// A moving body at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Time in s.
    pub time: f64,
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// Velocity in mm/s.
    pub velocity: Vec<f64>,
    /// Acceleration in mm/s².
    pub acceleration: Vec<f64>,
    /// The energies.
    pub energy: EnergyBalance,
    /// The force of each support on the body in N along both axes, including the inertia of its own nodes; zero after its release.
    pub support_forces: Vec<[f64; 2]>,
}

/// A computed motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// The instants in order, the start first.
    pub instants: Vec<Instant>,
    /// Steps that were taken, including those between the instants.
    pub steps: usize,
    /// Steps that were taken again with half the length.
    pub halved: usize,
    /// Factorisations of the tangent.
    pub factorisations: usize,
}

impl History {
    /// The times in s.
    pub fn times(&self) -> Vec<f64> {
        self.instants.iter().map(|instant| instant.time).collect()
    }

    /// One unknown at all instants, in mm.
    pub fn displacement(&self, unknown: usize) -> Vec<f64> {
        let instants = self.instants.iter();
        instants
            .map(|instant| instant.displacement[unknown])
            .collect()
    }

    /// The largest departure of the energy balance from its value at the start, relative to the largest energy of the motion.
    pub fn energy_error(&self) -> f64 {
        let Some(first) = self.instants.first() else {
            return 0.0;
        };
        let energies = || self.instants.iter().map(|instant| instant.energy);
        let largest = energies().fold(0.0, |most: f64, energy| most.max(energy.largest()));
        let strays = energies().map(|energy| (energy.total() - first.energy.total()).abs());
        strays.fold(0.0, larger) / largest.max(f64::MIN_POSITIVE)
    }
}
