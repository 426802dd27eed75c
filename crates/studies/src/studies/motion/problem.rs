//! A sheet that moves: supports, loads, start, and the models that are computed.

use crate::budget::Need;
use crate::dynamics::{
    Integrator, Motion, MovingForce, MovingSupport, Start, Step, TimeFunction, TimeSettings,
    Viscosity, lumped_mass,
};
use crate::error::Error;
use crate::mass_spring::{DashpotLaw, MassSpring, SpringLaw};
use crate::material::Card;
use crate::material::viscosity::ViscousMaterial;
use crate::mesh::Mesh;
use crate::problem::{BoundaryProblem, Model};
use crate::studies::points::Probe;
use crate::studies::specimen::{NEWTON, Outline, PlateGrids, Specimen};

/// Estimated memory of an unknown at an instant: the numbers of the state and of the history, and their text in files.
const BYTES_OF_AN_INSTANT: f64 = 200.0;

/// How often the cells of a shape's finite elements are halved: once beyond those of the corrected field.
const HALVINGS: usize = 1;

/// A dead force on a point.
pub struct PointForce {
    /// Where it pulls, in mm.
    pub at: [f64; 2],
    /// In N.
    pub force: [f64; 2],
    /// How much of it acts.
    pub time: TimeFunction,
}

/// The load factor in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The factor of all motions of supports and of all loads; of a plate, the stretch.
    pub factor: TimeFunction,
    /// When the supports of the measured group release it, in s.
    pub release: Option<f64>,
}

/// Requirements in %.
#[derive(Clone, Copy)]
pub struct Tolerances {
    /// Largest error of the energy balance.
    pub energy_percent: f64,
    /// Largest deviation of the corrected motion, or of the springs where there is none, from the finite elements.
    pub deviation_percent: f64,
    /// Largest deviation of its force of the measured group; `None` where nothing is required of it.
    pub force_percent: Option<f64>,
}

/// A sheet that moves.
#[non_exhaustive]
pub struct MovingSheet {
    /// The sheet with supports, loads and meshes; its load factors are that of the start, or none at rest.
    pub specimen: Specimen,
    /// In tonne/mm³.
    pub density: f64,
    /// The viscous part of the material.
    pub viscosity: ViscousMaterial,
    /// The load factor of supports and loads.
    pub drive: Drive,
    /// In mm/s².
    pub gravity: [f64; 2],
    /// Point forces.
    pub forces: Vec<PointForce>,
    /// Duration, instants, steps.
    pub time: TimeSettings,
    /// K(·).
    pub springs: SpringLaw,
    /// D(·).
    pub dashpots: DashpotLaw,
    /// Whether the springs' motion is corrected.
    pub is_corrected: bool,
    /// Points that are watched.
    pub probes: Vec<Probe>,
    /// The requirements.
    pub tolerances: Tolerances,
}

impl MovingSheet {
    /// The sheet, its material, the duration and the models in a line.
    pub fn describe(&self) -> String {
        let corrected = if self.is_corrected { "corrected, " } else { "" };
        format!(
            "{}; {} s, an instant every {} s; mass-spring, {corrected}finite elements",
            self.specimen.describe_sheet(),
            self.time.duration,
            self.time.interval,
        )
    }

    /// The length of the first longitudinal wave over that of the sheet: a quarter of a wave where one end is released, else a half.
    pub(super) fn bar_waves(&self) -> u32 {
        match self.drive.release {
            Some(_) => 4,
            None => 2,
        }
    }

    /// The first longitudinal vibration of a bar of the sheet's length in Hz.
    pub(super) fn bar_frequency(&self) -> f64 {
        let speed = (self.specimen.problem.law.youngs_modulus() / self.density).sqrt();
        speed / (f64::from(self.bar_waves()) * self.specimen.outline.size()[0])
    }

    /// The sheet of another material, such as one made by [`Card::of_law`]; density and viscosity stay those of the study.
    #[must_use]
    pub fn with_card(self, card: Card) -> Self {
        Self {
            specimen: self.specimen.with_card(card),
            ..self
        }
    }

    /// The springs on the lattice.
    pub(super) fn lattice(&self) -> MassSpring {
        self.specimen
            .springs()
            .with_spring_law(self.springs.clone())
    }

    /// The mesh of the finite elements, or one whose cells are twice as large so many times; `None` where there is none.
    pub(super) fn elements_mesh(&self, coarser: usize) -> Option<Mesh> {
        match &self.specimen.outline {
            Outline::Grid(grids) => grids.elements.coarser_mesh(grids.size, coarser),
            outline => {
                let level = outline.halvings().min(HALVINGS).checked_sub(coarser)?;
                Some(outline.reference_mesh(level))
            }
        }
    }

    /// The memory and work that its motion needs. With the wave speed c at rest and cells of the side a, velocity Verlet takes steps of about
    /// half of the longest stable one, which is shorter in a stretched or damped sheet:
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
        let Extent {
            cells,
            unknowns,
            side,
        } = self.extent();
        let instants =
            duration / interval + (self.drive.factor.kinks().len() + 2 * self.forces.len()) as f64;
        let law = &self.specimen.problem.law;
        let speed = (4.0 * law.shear_modulus() / self.density).sqrt();
        let step = match (step, integrator) {
            (Step::AtMost(step), _) => step.min(interval),
            (Step::Automatic, Integrator::VelocityVerlet) => side / (2.0 * speed),
            (Step::Automatic, Integrator::GeneralisedAlpha { .. }) => interval,
        };
        Need {
            cells,
            instants,
            steps: duration / step,
            unknowns,
            bytes: unknowns
                * (3000.0 + BYTES_OF_AN_INSTANT * instants + 8.0 * self.forces.len() as f64),
        }
    }

    /// The larger extent of the lattice and of the finite elements; that of grids, which may be too large, without a mesh.
    fn extent(&self) -> Extent {
        let meshes = match &self.specimen.outline {
            Outline::Grid(PlateGrids {
                size,
                cells,
                elements,
                ..
            }) => {
                let per_cell = 2.0 * (elements.element.shape().degree() as f64).powi(2);
                [(*cells, 2.0), (elements.cells, per_cell)].map(|(cells, per_cell)| {
                    let sides = [0, 1].map(|axis| size[axis] / cells[axis] as f64);
                    let cells = cells[0] as f64 * cells[1] as f64;
                    Extent {
                        cells,
                        unknowns: per_cell * cells,
                        side: sides[0].min(sides[1]),
                    }
                })
            }
            outline => [Some(outline.lattice()), self.elements_mesh(0)]
                .map(|mesh| mesh.map_or_else(Extent::default, |mesh| Extent::of(&mesh))),
        };
        let [lattice, elements] = meshes;
        Extent {
            cells: lattice.cells.max(elements.cells),
            unknowns: lattice.unknowns.max(elements.unknowns),
            side: lattice.side.min(elements.side),
        }
    }

    /// The motion of a model of the sheet.
    pub fn motion<'a>(
        &self,
        model: &'a Model<'a>,
        viscosity: Option<&'a dyn Viscosity>,
    ) -> Result<Motion<'a>, Error> {
        let mesh = model.mesh;
        let size = 2 * mesh.nodes.len();
        let problem = &self.specimen.problem;
        let mass = lumped_mass(mesh, self.density, problem.thickness);
        let start = match self.specimen.factors[..] {
            [] => vec![0.0; size],
            _ => model.reach(&self.specimen.factors, NEWTON)?.displacement,
        };
        let weight = (0..size).map(|i| mass[i] * self.gravity[i % 2]).collect();
        let gravity = MovingForce {
            force: weight,
            time: TimeFunction::Constant(1.0),
        };
        let loads = MovingForce {
            force: problem.dead_forces(mesh)?,
            time: self.drive.factor.clone(),
        };
        let points = self.forces.iter().map(|point| MovingForce {
            force: point_force(mesh, point.at, point.force),
            time: point.time.clone(),
        });
        Ok(Motion {
            energy: model.energy,
            viscosity,
            supports: self.supports(mesh)?,
            forces: [gravity, loads].into_iter().chain(points).collect(),
            start: Start::held_at(start),
            describe: Box::new(|element| (model.describe)(element)),
            mass,
        })
    }

    /// Whether gravity or forces act besides supports and loads.
    pub(super) fn is_loaded(&self) -> bool {
        let mut forces = self.forces.iter();
        self.gravity != [0.0; 2] || forces.any(|point| point.force != [0.0; 2])
    }

    /// Whether the support of a group is released.
    fn is_released(&self, group: &str) -> bool {
        self.drive.release.is_some() && group == self.specimen.group
    }

    /// The supports on a mesh, in the order of the study. A node that several hold belongs to one that is never released, if there is one.
    fn supports(&self, mesh: &Mesh) -> Result<Vec<MovingSupport>, Error> {
        let problem = &self.specimen.problem;
        let mut order: Vec<usize> = (0..problem.supports.len()).collect();
        order.sort_by_key(|number| self.is_released(&problem.supports[*number].0));
        let sorted = BoundaryProblem {
            supports: order
                .iter()
                .map(|number| problem.supports[*number].clone())
                .collect(),
            ..problem.clone()
        };
        let moving = problem.supports.iter().map(|(group, _)| MovingSupport {
            unknowns: Vec::new(),
            displacement: Vec::new(),
            time: self.drive.factor.clone(),
            until: self.drive.release.filter(|_| self.is_released(group)),
        });
        let mut moving: Vec<MovingSupport> = moving.collect();
        for (unknown, by) in sorted.held_by(mesh)? {
            let number = order[by];
            let (node, axis) = (unknown / 2, unknown % 2);
            let (_, support) = &problem.supports[number];
            let displacement = support.displacement(mesh.nodes[node], axis, 1.0);
            moving[number].unknowns.push(unknown);
            moving[number]
                .displacement
                .push(displacement.unwrap_or(0.0));
        }
        Ok(moving)
    }

    /// The force in N of the supports of the measured group, of those of all supports; `None` where no support holds it.
    pub(super) fn measured_force(&self, forces: &[[f64; 2]]) -> Option<[f64; 2]> {
        let supports = self.specimen.problem.supports.iter().zip(forces);
        let measured = supports.filter(|((group, _), _)| *group == self.specimen.group);
        measured
            .map(|(_, force)| *force)
            .reduce(|sum, force| [sum[0] + force[0], sum[1] + force[1]])
    }

    /// A description of the measured group.
    pub(super) fn measured_name(&self) -> String {
        match self.specimen.grids() {
            Some(_) => "right grip".into(),
            None => format!("group `{}`", self.specimen.group),
        }
    }

    /// Whether a support holds the measured group.
    pub(super) fn is_measured_held(&self) -> bool {
        let mut supports = self.specimen.problem.supports.iter();
        supports.any(|(group, _)| *group == self.specimen.group)
    }
}

/// The extent of a mesh.
#[derive(Default)]
struct Extent {
    cells: f64,
    unknowns: f64,
    /// The side in mm of a square as large as the smallest cell.
    side: f64,
}

impl Extent {
    fn of(mesh: &Mesh) -> Self {
        let areas = (0..mesh.cell_count()).map(|cell| mesh.cell_area(cell));
        Self {
            cells: mesh.cell_count() as f64,
            unknowns: 2.0 * mesh.nodes.len() as f64,
            side: areas.fold(f64::INFINITY, f64::min).sqrt(),
        }
    }
}

/// A force in N on a point, distributed to the nodes of its cell by the shape functions.
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
