//! A plate that moves: supports, loads, start, and what is computed.

use crate::budget::Need;
use crate::dynamics::{
    Integrator, Motion, MovingForce, MovingSupport, Start, Step, TimeFunction, TimeSettings,
    Viscosity, lumped_mass,
};
use crate::error::Error;
use crate::finite_element::Element;
use crate::mass_spring::{DashpotLaw, LatticeSettings, SpringLaw};
use crate::material::Card;
use crate::material::viscosity::ViscousMaterial;
use crate::mesh::{Mesh, Side};
use crate::problem::{ClampedPlate, Model};
use crate::solve::NewtonSettings;
use crate::studies::pictures::Pictures;

/// How the plate at the start is solved.
const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// Memory of an unknown at an instant, with what is written of it, estimated: numbers of the state, of the history and of the text.
const BYTES_OF_AN_INSTANT: f64 = 200.0;

/// A point of the plate that is watched.
pub struct Probe {
    /// Its name.
    pub name: String,
    /// Where it is at rest, in mm.
    pub at: [f64; 2],
}

/// A dead force on a point.
pub struct PointForce {
    /// Where it pulls, in mm.
    pub at: [f64; 2],
    /// In N.
    pub force: [f64; 2],
    /// How much of it acts.
    pub time: TimeFunction,
}

/// What has to be reached, in %.
#[derive(Clone, Copy)]
pub struct Tolerances {
    /// Largest error of the energy balance.
    pub energy_percent: f64,
    /// Largest deviation of the corrected motion, or of the springs where there is none, from the finite elements.
    pub deviation_percent: f64,
    /// Largest deviation of its force of the right grip; `None` where nothing is required of it.
    pub force_percent: Option<f64>,
}

/// A plate that moves.
pub struct MovingPlate {
    /// The plate; its stretches are that of the start, or none at rest.
    pub problem: ClampedPlate,
    /// The card of its material.
    pub card: Card,
    /// In tonne/mm³.
    pub density: f64,
    /// The viscous part of the material.
    pub viscosity: ViscousMaterial,
    /// The right grip's stretch in time.
    pub grip: TimeFunction,
    /// When it lets go, in s.
    pub release: Option<f64>,
    /// In mm/s².
    pub gravity: [f64; 2],
    /// Point forces.
    pub forces: Vec<PointForce>,
    /// Duration, instants, steps.
    pub time: TimeSettings,
    /// Cells of the lattice.
    pub cells: [usize; 2],
    /// What it consists of.
    pub lattice: LatticeSettings,
    /// K(·).
    pub springs: SpringLaw,
    /// D(·).
    pub dashpots: DashpotLaw,
    /// Whether the springs' motion is corrected.
    pub is_corrected: bool,
    /// The finite element, and how many.
    pub element: (Element, [usize; 2]),
    /// Points that are watched.
    pub probes: Vec<Probe>,
    /// What has to be reached.
    pub tolerances: Tolerances,
    /// The pictures of its fields.
    pub pictures: Pictures,
}

impl MovingPlate {
    /// The length of the first longitudinal wave over that of the plate: a quarter of a wave where one end is released, else a half.
    pub(super) fn bar_waves(&self) -> u32 {
        match self.release {
            Some(_) => 4,
            None => 2,
        }
    }

    /// The first longitudinal vibration of a bar of the plate's length in Hz.
    pub(super) fn bar_frequency(&self) -> f64 {
        let speed = (self.problem.law.youngs_modulus() / self.density).sqrt();
        speed / (f64::from(self.bar_waves()) * self.problem.size[0])
    }

    /// The plate of another material, such as one made by [`Card::of_law`]; density and viscosity stay those of the study.
    #[must_use]
    pub fn with_card(mut self, card: Card) -> Self {
        self.problem.law = std::sync::Arc::clone(&card.law);
        self.card = card;
        self
    }

    /// What its motion will use. With the wave speed c at rest and cells of the side a, velocity Verlet takes steps of about
    /// half of the longest stable one, which is shorter in a stretched or damped plate:
    ///
    /// ```text
    /// c² = 4 μ/ρ,   h ≈ a/(2 c),   steps = duration/h
    /// ```
    pub fn need(&self) -> Need {
        let TimeSettings {
            duration,
            interval,
            step,
            integrator,
            ..
        } = self.time;
        let (element, fine) = self.element;
        let cells = |cells: [usize; 2]| cells[0] as f64 * cells[1] as f64;
        let per_cell = match element {
            Element::Q1 => 2.0,
            Element::Q2 => 8.0,
        };
        let unknowns = (2.0 * cells(self.cells)).max(per_cell * cells(fine));
        let instants =
            duration / interval + (self.grip.kinks().len() + 2 * self.forces.len()) as f64;
        let side = |cells: [usize; 2]| {
            let sides = [0, 1].map(|axis| self.problem.size[axis] / cells[axis] as f64);
            sides[0].min(sides[1])
        };
        let speed = (4.0 * self.problem.law.shear_modulus() / self.density).sqrt();
        let step = match (step, integrator) {
            (Step::AtMost(step), _) => step.min(interval),
            (Step::Automatic, Integrator::VelocityVerlet) => {
                side(self.cells).min(side(fine)) / (2.0 * speed)
            }
            (Step::Automatic, Integrator::GeneralisedAlpha { .. }) => interval,
        };
        Need {
            cells: cells(self.cells).max(cells(fine)),
            instants,
            steps: duration / step,
            unknowns,
            bytes: unknowns
                * (3000.0 + BYTES_OF_AN_INSTANT * instants + 8.0 * self.forces.len() as f64),
        }
    }

    /// The motion of a model of the plate.
    pub fn motion<'a>(
        &self,
        model: &'a Model<'a>,
        viscosity: Option<&'a dyn Viscosity>,
    ) -> Result<Motion<'a>, Error> {
        let mesh = model.mesh;
        let size = 2 * mesh.nodes.len();
        let mass = lumped_mass(mesh, self.density, self.problem.thickness);
        let start = match self.problem.stretches[..] {
            [] => vec![0.0; size],
            _ => model.reach(&self.problem.stretches, NEWTON)?.displacement,
        };
        let weight = (0..size).map(|i| mass[i] * self.gravity[i % 2]).collect();
        let gravity = MovingForce {
            force: weight,
            time: TimeFunction::Constant(1.0),
        };
        let points = self.forces.iter().map(|own| MovingForce {
            force: point_force(mesh, own.at, own.force),
            time: own.time.clone(),
        });
        Ok(Motion {
            energy: model.energy,
            viscosity,
            supports: vec![
                MovingSupport::fixed(unknowns(mesh, Side::Left)),
                self.right_grip(mesh),
            ],
            forces: [gravity].into_iter().chain(points).collect(),
            start: Start::held_at(start),
            describe: Box::new(|element| (model.describe)(element)),
            mass,
        })
    }

    fn right_grip(&self, mesh: &Mesh) -> MovingSupport {
        let unknowns = unknowns(mesh, Side::Right);
        let length = self.problem.size[0];
        let along = |unknown: &usize| {
            if unknown.is_multiple_of(2) {
                length
            } else {
                0.0
            }
        };
        MovingSupport {
            displacement: unknowns.iter().map(along).collect(),
            unknowns,
            time: self.grip.clone(),
            until: self.release,
        }
    }
}

/// The unknowns of the nodes on a side.
fn unknowns(mesh: &Mesh, side: Side) -> Vec<usize> {
    let nodes = (0..mesh.nodes.len()).filter(|node| mesh.on(side, *node));
    nodes.flat_map(|node| [2 * node, 2 * node + 1]).collect()
}

/// A force in N on a point, shared by the nodes of its cell as the shape functions say.
fn point_force(mesh: &Mesh, at: [f64; 2], force: [f64; 2]) -> Vec<f64> {
    let mut sum = vec![0.0; 2 * mesh.nodes.len()];
    let (cell, local) = mesh.locate(at);
    for (node, value) in mesh.cell(cell).iter().zip(mesh.shape(cell).values(local)) {
        for axis in [0, 1] {
            sum[2 * node + axis] += value * force[axis];
        }
    }
    sum
}
