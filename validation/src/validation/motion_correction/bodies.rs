//! The plate that is let go, as springs, as the corrector's difference scheme, and as the elements of the reference.

use crate::corrector::DifferenceScheme;
use crate::corrector::motion::EquationOfMotion;
use crate::document::Section;
use crate::dynamics::{
    Dashpots, Integrator, Motion, MovingSupport, SheetViscosity, Start, Step, TimeSettings,
    Viscosity, follow, frequency, lumped_mass,
};
use crate::error::{Error, SolveFault};
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::{DashpotLaw, MassSpring};
use crate::material::viscosity::ViscousMaterial;
use crate::mesh::{Mesh, Side};
use crate::problem::Model;
use crate::problem::sheet_energy::SheetEnergy;
use crate::validation::case::{self, failed};
use crate::validation::plate::{NEWTON, Plate};

/// A displacement field for each instant.
pub type Fields = Vec<Vec<f64>>;

/// A plate with what its motion takes.
pub struct PlateInTime {
    pub plate: Plate,
    /// In tonne/mm³.
    pub density: f64,
    pub material: ViscousMaterial,
}

/// The difference scheme takes two by two cells together.
pub fn check_even(section: &Section, cells: [usize; 2]) {
    if cells.iter().any(|count| count % 2 == 1) {
        let hint = "two by two cells are taken together";
        section.fault("cells", "must be even", hint);
    }
}

/// A fault of a motion.
pub fn fault(fault: SolveFault) -> Error {
    failed("motion", "the released plate")(fault)
}

/// The three models, whose bodies borrow from them.
pub struct Models<'a> {
    plate: &'a PlateInTime,
    pub lattice: MassSpring,
    law: DashpotLaw,
    scheme: SheetEnergy,
    elements: FiniteElements,
}

/// What resists rates in each of the models.
pub struct Viscosities<'a> {
    springs: Dashpots<'a>,
    scheme: SheetViscosity<'a>,
    elements: SheetViscosity<'a>,
}

impl<'a> Models<'a> {
    /// Springs and scheme on `cells`, the reference on the plate's own.
    pub fn new(plate: &'a PlateInTime, cells: [usize; 2]) -> Self {
        let problem = &plate.plate.problem;
        let on_cells = Plate {
            cells,
            ..plate.plate.clone()
        };
        let lattice = on_cells.lattice();
        Self {
            plate,
            law: DashpotLaw::Material(plate.material.clone()),
            scheme: DifferenceScheme::Biquadratic.energy(problem, &lattice.mesh),
            elements: FiniteElements::new(problem, plate.plate.cells, Element::Q2),
            lattice,
        }
    }

    pub fn viscosities(&self) -> Viscosities<'_> {
        let material = &self.plate.material;
        Viscosities {
            springs: Dashpots::new(&self.lattice, &self.law),
            scheme: SheetViscosity::new(&self.scheme, material),
            elements: SheetViscosity::new(self.elements.energy(), material),
        }
    }

    pub fn bodies(&'a self, viscosities: &'a Viscosities) -> Result<Bodies<'a>, Error> {
        let problem = &self.plate.plate.problem;
        let scheme = problem
            .on(&self.lattice.mesh, &self.scheme)
            .named("difference scheme");
        let scheme = scheme.describing(|element| format!("cell {element}"));
        Ok(Bodies {
            springs: self.body(&self.lattice.model(problem), &viscosities.springs)?,
            scheme: self.body(&scheme, &viscosities.scheme)?,
            reference: self.body(&self.elements.model(problem), &viscosities.elements)?,
        })
    }

    /// The plate that has been held at its stretch and is let go at the right end.
    fn body(&self, model: &Model<'a>, viscosity: &'a dyn Viscosity) -> Result<Body<'a>, Error> {
        let (mesh, problem) = (model.mesh, &self.plate.plate.problem);
        let held = model.reach(&problem.stretches, NEWTON)?;
        let left = (0..mesh.nodes.len()).filter(|node| mesh.on(Side::Left, *node));
        let unknowns = left.flat_map(|node| [2 * node, 2 * node + 1]).collect();
        let motion = Motion {
            energy: model.energy,
            viscosity: Some(viscosity),
            mass: lumped_mass(mesh, self.plate.density, problem.thickness),
            supports: vec![MovingSupport::fixed(unknowns)],
            forces: Vec::new(),
            start: Start::held_at(held.displacement),
            describe: Box::new(|element| format!("element {element}")),
        };
        Ok(Body { mesh, motion })
    }
}

/// A body made of one of the models, held at the stretch until it is let go.
pub struct Body<'a> {
    pub mesh: &'a Mesh,
    pub motion: Motion<'a>,
}

/// The same plate made of each of the models.
pub struct Bodies<'a> {
    pub springs: Body<'a>,
    pub scheme: Body<'a>,
    pub reference: Body<'a>,
}

/// Equal steps in time.
#[derive(Clone, Copy)]
pub struct Steps {
    /// In s.
    pub step: f64,
    pub count: usize,
    /// Steps from one instant to the next.
    pub every: usize,
    /// Parts into which a step is divided for more accuracy.
    pub finer: usize,
}

impl Bodies<'_> {
    /// The motion of the reference at the nodes of the lattice.
    pub fn exact(&self, steps: Steps) -> Result<Fields, Error> {
        let fields = self.reference.integrate(steps)?;
        let on_lattice =
            |field: &Vec<f64>| self.reference.mesh.displacement_on(field, self.scheme.mesh);
        Ok(fields.iter().map(on_lattice).collect())
    }

    /// The equation that the corrector imposes.
    pub fn equation(&self, step: f64) -> Result<EquationOfMotion<'_>, Error> {
        EquationOfMotion::new(&self.scheme.motion, step, 0.25)
            .map_err(|reason| Error::input(reason.to_string(), "change the motion"))
    }
}

impl Body<'_> {
    /// The slowest small longitudinal vibration about rest in s.
    pub fn period(&self) -> Result<f64, Error> {
        let rest = vec![0.0; self.motion.energy.unknowns()];
        let modes = frequency::slowest(&self.motion, &self.motion.held(0.0), &rest, 3);
        let modes = modes.map_err(fault)?;
        // Bending in the plane may be slower: the longitudinal one moves the middle of the free end most along x.
        let along = |mode: &frequency::Mode| -> f64 {
            let share = |axis: usize| -> f64 {
                let component = mode.shape.iter().skip(axis).step_by(2);
                component.map(|u| u * u).sum()
            };
            share(0) / share(1)
        };
        let longitudinal = modes.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
        longitudinal
            .map(|mode| 1.0 / mode.frequency)
            .ok_or(fault(SolveFault::Singular))
    }

    /// The motion by generalised-α without damping of its own.
    pub fn integrate(&self, steps: Steps) -> Result<Fields, Error> {
        let settings = TimeSettings {
            duration: steps.step * steps.count as f64,
            interval: steps.step * steps.every as f64,
            step: Step::AtMost(steps.step / steps.finer as f64),
            integrator: Integrator::GeneralisedAlpha {
                spectral_radius: 1.0,
                tolerance: 1e-9,
            },
            most_steps: crate::budget::Budget::USUAL.steps,
        };
        let history = follow(&self.motion, settings, &|_| ()).map_err(|end| fault(end.fault))?;
        let instants = history.instants.into_iter();
        Ok(instants.map(|instant| instant.displacement).collect())
    }
}

/// Distance of two motions over the size of the second, in relative L2 over space and time, in %.
pub fn percent(fields: &[Vec<f64>], reference: &[Vec<f64>]) -> f64 {
    case::percent(&fields.concat(), &reference.concat())
}
