//! A plate in motion: springs with dashpots, corrected in time, beside finite elements, from one study.

use std::path::Path;
use std::time::Instant as Clock;

use crate::document::Section;
use crate::dynamics::frequency::{slowest, strongest};
use crate::dynamics::{
    Dashpots, History, Motion, MovingForce, MovingSupport, SheetViscosity, Start, TimeFunction,
    Viscosity, follow, lumped_mass,
};
use crate::error::Error;
use crate::finite_element::FiniteElements;
use crate::mass_spring::{DashpotLaw, MassSpring};
use crate::mesh::{Mesh, Side};
use crate::problem::Model;
use crate::results::Outcome;
use crate::solve::NewtonSettings;
use crate::studies::{Prepared, Progress};

mod corrected;
mod files;
mod outcome;
mod read;
mod statement;

/// How the plate at the start is solved.
const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

use read::MovingPlate;

/// Reads a study of this kind.
pub fn prepare(root: &Section, folder: &Path) -> Prepared {
    let plate = read::read(root, folder);
    Box::new(move |progress| {
        plate.map_or(Ok(Outcome::default()), |plate| compute(&plate, progress))
    })
}

/// One model's motion.
struct Moved {
    /// Its name.
    name: &'static str,
    /// For file names.
    file: &'static str,
    mesh: Mesh,
    history: History,
    /// The first longitudinal vibration about the undeformed plate, with the right grip as at the end, in Hz.
    frequency: f64,
    /// Computing time in s.
    seconds: f64,
}

fn compute(plate: &MovingPlate, progress: Progress) -> Result<Outcome, Error> {
    let springs = MassSpring::new(&plate.problem, plate.cells, plate.lattice)
        .with_spring_law(plate.springs.clone());
    let dashpots = Dashpots::new(&springs, &plate.dashpots);
    let damped = match &plate.dashpots {
        DashpotLaw::Material(material) => !material.is_none(),
        DashpotLaw::Viscosity { .. } => true,
    };
    progress("mass-spring");
    let dashpots = damped.then_some(&dashpots as &dyn Viscosity);
    let model = springs.model(&plate.problem);
    let springs_moved = plate.moved(["mass-spring", "mass_spring"], &model, dashpots)?;
    progress("finite elements");
    let (element, cells) = plate.element;
    let elements = FiniteElements::new(&plate.problem, cells, element);
    let sheet = SheetViscosity::new(elements.energy(), &plate.viscosity);
    let sheet = (!plate.viscosity.is_none()).then_some(&sheet as &dyn Viscosity);
    let model = elements.model(&plate.problem);
    let elements_moved = plate.moved(["finite elements", "finite_element"], &model, sheet)?;
    progress("corrector");
    let corrected = plate.corrected(&springs_moved)?;
    Ok(outcome::outcome(
        plate,
        &[springs_moved, elements_moved],
        &corrected,
    ))
}

impl MovingPlate {
    /// Computes the motion of one model.
    fn moved(
        &self,
        [name, file]: [&'static str; 2],
        model: &Model,
        viscosity: Option<&dyn Viscosity>,
    ) -> Result<Moved, Error> {
        let start = Clock::now();
        let motion = self.motion(model, viscosity)?;
        let fault = |time: String, fault| Error::Solve {
            model: model.name.clone(),
            step: time,
            fault,
        };
        let history =
            follow(&motion, self.time, &|_| ()).map_err(|end| fault(end.describe(), end.fault))?;
        let held = motion.held(self.time.duration);
        let rest = vec![0.0; motion.mass.len()];
        let modes = slowest(&motion, &held, &rest, 6);
        let modes = modes.map_err(|found| fault("rest".into(), found))?;
        Ok(Moved {
            name,
            file,
            mesh: model.mesh.clone(),
            history,
            frequency: strongest(modes, &motion.mass, 0).map_or(f64::NAN, |mode| mode.frequency),
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    fn motion<'a>(
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
