//! A moving body: energy, mass, viscous forces, supports, loads and the start.

use super::time_function::TimeFunction;
use super::viscosity::Viscosity;
use crate::solve::Potential;
use crate::solve::vector::add_scaled;

/// A body with its supports, loads and start.
pub struct Motion<'a> {
    /// Its strain energy; elements and unknowns are those of this.
    pub energy: &'a dyn Potential,
    /// Its viscous forces.
    pub viscosity: Option<&'a dyn Viscosity>,
    /// The mass of each unknown in tonne.
    pub mass: Vec<f64>,
    /// The supports that move held unknowns; an unknown must have one support at most.
    pub supports: Vec<MovingSupport>,
    /// The loads.
    pub forces: Vec<MovingForce>,
    /// The start.
    pub start: Start,
    /// Names an element of the energy with its position, for messages.
    pub describe: Box<dyn Fn(usize) -> String + Sync + 'a>,
}

/// A support that moves held unknowns in time.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingSupport {
    /// The unknowns that it holds.
    pub unknowns: Vec<usize>,
    /// The displacement of each in mm at the time function's 1.
    pub displacement: Vec<f64>,
    /// The share of it that is imposed, as a function of time.
    pub time: TimeFunction,
    /// The time in s at which the support is released; `None` where it never is.
    pub until: Option<f64>,
}

/// Dead forces that change in time, including gravity.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingForce {
    /// The force on each unknown in N at the time function's 1.
    pub force: Vec<f64>,
    /// The share of it that acts, as a function of time.
    pub time: TimeFunction,
}

/// A body's state at time 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Displacement in mm; held unknowns are imposed.
    pub displacement: Vec<f64>,
    /// Velocity in mm/s; held unknowns are imposed.
    pub velocity: Vec<f64>,
    /// Whether the body has rested there so long that its viscous stresses have relaxed; otherwise it was brought there at once from rest.
    pub relaxed: bool,
}

impl Start {
    /// A body that has been held at a displacement for long.
    pub fn held_at(displacement: Vec<f64>) -> Self {
        Self {
            velocity: vec![0.0; displacement.len()],
            displacement,
            relaxed: true,
        }
    }
}

impl MovingSupport {
    /// A support that holds unknowns where they are at rest.
    pub fn fixed(unknowns: Vec<usize>) -> Self {
        Self {
            displacement: vec![0.0; unknowns.len()],
            unknowns,
            time: TimeFunction::Constant(1.0),
            until: None,
        }
    }

    /// Whether it still holds in the time after `time`.
    pub fn holds(&self, time: f64) -> bool {
        self.until.is_none_or(|until| time < until)
    }
}

impl Motion<'_> {
    /// Marks the unknowns that are held in the time after `time`.
    pub fn held(&self, time: f64) -> Vec<bool> {
        let mut held = vec![false; self.energy.unknowns()];
        let supports = self.supports.iter().filter(|support| support.holds(time));
        for unknown in supports.flat_map(|support| &support.unknowns) {
            held[*unknown] = true;
        }
        held
    }

    /// The shortest period in s of oscillating supports or forces; `None` where none oscillates.
    pub fn shortest_period(&self) -> Option<f64> {
        let supports = self.supports.iter().map(|support| &support.time);
        let forces = self.forces.iter().map(|force| &force.time);
        let periods = supports.chain(forces).filter_map(TimeFunction::period);
        periods.reduce(f64::min)
    }

    /// Writes displacement, velocity and acceleration of the unknowns that are held after the time `within`, at a time
    /// in s that is not before it; see [`TimeFunction::at`].
    pub fn impose(&self, time: f64, within: f64, motion: [&mut [f64]; 3]) {
        let [u, v, a] = motion;
        for support in self.supports.iter().filter(|support| support.holds(within)) {
            let [value, rate, second] = support.time.at(time, within);
            for (unknown, amplitude) in support.unknowns.iter().zip(&support.displacement) {
                u[*unknown] = value * amplitude;
                v[*unknown] = rate * amplitude;
                a[*unknown] = second * amplitude;
            }
        }
    }

    /// The loads f(t) on all unknowns in N.
    pub fn external_forces(&self, time: f64) -> Vec<f64> {
        let mut sum = vec![0.0; self.energy.unknowns()];
        for load in &self.forces {
            add_scaled(&mut sum, load.time.value(time), &load.force);
        }
        sum
    }

    /// The times up to `duration` in s at which a support is released, or at which the rate of a support or load jumps.
    pub fn marks(&self, duration: f64) -> Vec<f64> {
        let supports = self.supports.iter();
        let mut marks: Vec<f64> = supports
            .flat_map(|support| support.time.kinks().into_iter().chain(support.until))
            .chain(self.forces.iter().flat_map(|load| load.time.kinks()))
            .filter(|time| *time > 0.0 && *time < duration)
            .collect();
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        marks
    }
}
