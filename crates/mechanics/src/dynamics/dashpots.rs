//! The viscous forces of a mass-spring lattice: a dashpot in parallel to each spring.

use super::viscosity::{ElementMotion, Viscosity, ViscousLocal};
use crate::mass_spring::{DashpotLaw, MassSpring, SpringPose};
use crate::solve::Inadmissible;

/// Dashpots along the springs of a lattice. A spring whose stress relaxes stores S∞ = P/λ and the stress Qᵢ of every branch of the Prony series.
#[derive(Clone, Copy, Debug)]
pub struct Dashpots<'a> {
    springs: &'a MassSpring,
    law: &'a DashpotLaw,
}

impl<'a> Dashpots<'a> {
    /// A dashpot in parallel to each spring.
    pub fn new(springs: &'a MassSpring, law: &'a DashpotLaw) -> Self {
        Self { springs, law }
    }

    fn pose(&self, element: usize, u: &[f64]) -> Result<Option<SpringPose>, Inadmissible> {
        if element >= self.springs.springs.len() {
            return Ok(None);
        }
        let pose = self.springs.pose(element, u);
        if pose.stretch > 0.0 {
            Ok(Some(pose))
        } else {
            Err(Inadmissible { element })
        }
    }

    /// Second Piola–Kirchhoff stress at long times.
    fn long(pose: &SpringPose) -> f64 {
        pose.response.nominal_stress / pose.stretch
    }

    /// Qᵢ of all branches at the end of a step.
    fn branches(&self, memory: &[f64], now: f64, elapsed: f64) -> Vec<f64> {
        let Some(material) = self.law.relaxing() else {
            return Vec::new();
        };
        let branches = material.recursions(elapsed).zip(&memory[1..]);
        branches
            .map(|(recursion, q)| recursion.keeps * q + recursion.takes * (now - memory[0]))
            .collect()
    }
}

impl Viscosity for Dashpots<'_> {
    fn memory(&self, element: usize) -> usize {
        match self.law.relaxing() {
            Some(material) if element < self.springs.springs.len() => 1 + material.relaxation.len(),
            _ => 0,
        }
    }

    fn depends_on_rates(&self) -> bool {
        !matches!(self.law, DashpotLaw::Material(material) if material.shear_viscosity == 0.0)
    }

    fn add_element(
        &self,
        element: usize,
        motion: ElementMotion<'_>,
        local: ViscousLocal<'_>,
    ) -> Result<(), Inadmissible> {
        let Some(pose) = self.pose(element, motion.displacement)? else {
            return Ok(());
        };
        let spring = &self.springs.springs[element];
        let (area, length) = (spring.area, spring.rest_length);
        let v = motion.velocity;
        let relative = [v[2] - v[0], v[3] - v[1]];
        let unit = pose.unit;
        let rate = (unit[0] * relative[0] + unit[1] * relative[1]) / length;
        let [stress, by_rate] = self.law.stress(pose.stretch, rate);
        let (mut relaxing, mut slope) = (0.0, 0.0);
        if let Some(material) = self.law.relaxing() {
            let long = Self::long(&pose);
            let q: f64 = self
                .branches(motion.memory, long, motion.elapsed)
                .iter()
                .sum();
            relaxing = pose.stretch * q;
            // d(λ Q)/dλ with dQ = Σ takes dS∞ and λ dS∞/dλ = P′ − S∞.
            slope = q + material.taken(motion.elapsed) * (pose.response.slope - long);
        }
        pose.add_force(area * (stress + relaxing), local.force);
        if let Some([by_displacement, by_velocity]) = local.tangents {
            let across = area * relaxing / (pose.stretch * length);
            pose.add_stiffness([area * slope / length, across], by_displacement);
            pose.add_stiffness([area * by_rate / length, 0.0], by_velocity);
        }
        Ok(())
    }

    fn remember(
        &self,
        element: usize,
        motion: ElementMotion<'_>,
        next: &mut [f64],
    ) -> Result<(), Inadmissible> {
        if let Some(pose) = self.pose(element, motion.displacement)?
            && self.law.relaxing().is_some()
        {
            let now = Self::long(&pose);
            let branches = self.branches(motion.memory, now, motion.elapsed);
            next[0] = now;
            next[1..].copy_from_slice(&branches);
        }
        Ok(())
    }
}
