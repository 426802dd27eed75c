//! The corrector in time: a released plate, and a noisy recorded motion.
//!
//! The reference are quadratic finite elements on nodes half as far apart, integrated by generalised-α, with half the
//! step too. It never shares its mesh with the corrector.

use std::path::Path;

use super::case::{Check, Claim, Outcome, Prepared, Progress, Wanted, number};
use super::plate::{NEWTON, Plate};
use crate::corrector::DifferenceScheme;
use crate::corrector::motion::{EquationOfMotion, WindowSettings};
use crate::document::{Bound, Section};
use crate::dynamics::{
    Dashpots, Integrator, Motion, MovingSupport, SheetViscosity, Start, Step, TimeSettings,
    Viscosity, follow, frequency, lumped_mass,
};
use crate::error::{Error, SolveFault};
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::{DashpotLaw, MassSpring};
use crate::material::viscosity::ViscousMaterial;
use crate::mesh::{Mesh, Side};
use crate::problem::{ClampedPlate, Model};
use crate::results::{Axis, Block, Figure, Line, LineChart, PALETTE, Stroke};
use crate::solve::Potential;
use crate::units::Dimension;

mod recorded;

use recorded::Recording;

/// What both parts of the case share.
struct Settings {
    plate: Plate,
    density: f64,
    material: ViscousMaterial,
    periods: usize,
    steps: usize,
    window: usize,
    recording: Recording,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Prepared {
    let plate = Plate::read(root, folder);
    if plate.cells.iter().any(|count| count % 2 == 1) {
        let section = root.section("plate");
        section.fault(
            "cells",
            "must be even",
            "two by two cells are taken together",
        );
    }
    let section = root.section("motion");
    let density = section.quantity("density", Dimension::Density, Bound::Positive);
    let shear_viscosity = section.quantity("viscosity", Dimension::Viscosity, Bound::Positive);
    let settings = Settings {
        plate,
        density,
        material: ViscousMaterial {
            shear_viscosity,
            relaxation: Vec::new(),
        },
        periods: section.count("periods", 1, 100),
        steps: section.count("steps", 20, 10_000),
        window: section.count("window", 1, 1000),
        recording: Recording::read(root),
    };
    section.unknown_keys();
    Box::new(move |progress| compute(&settings, progress))
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    progress("released plate");
    released(settings, progress, &mut outcome)?;
    progress("recorded motion");
    recorded::compute(settings, progress, &mut outcome)?;
    Ok(outcome)
}

/// A body made of one of the models, and its field held at the stretch.
struct Body<'a> {
    mesh: &'a Mesh,
    motion: Motion<'a>,
}

impl Settings {
    fn fault(fault: SolveFault) -> Error {
        Error::Solve {
            model: "motion".into(),
            step: "the released plate".into(),
            fault,
        }
    }

    /// The plate that has been held at its stretch and is let go at the right end.
    fn body<'a>(
        &self,
        model: &Model<'a>,
        mesh: &'a Mesh,
        viscosity: &'a dyn Viscosity,
    ) -> Result<Body<'a>, Error> {
        let held = model.reach(&self.plate.problem.stretches, NEWTON)?;
        let left = (0..mesh.nodes.len()).filter(|node| mesh.on(Side::Left, *node));
        let unknowns = left.flat_map(|node| [2 * node, 2 * node + 1]).collect();
        let motion = Motion {
            energy: model.energy,
            viscosity: Some(viscosity),
            mass: lumped_mass(mesh, self.density, self.plate.problem.thickness),
            supports: vec![MovingSupport::fixed(unknowns)],
            forces: Vec::new(),
            start: Start::held_at(held.displacement),
            describe: Box::new(|element| format!("element {element}")),
        };
        Ok(Body { mesh, motion })
    }

    /// The slowest small vibration about rest in s.
    fn period(body: &Body) -> Result<f64, Error> {
        let rest = vec![0.0; body.motion.energy.unknowns()];
        let modes = frequency::slowest(&body.motion, &body.motion.held(0.0), &rest, 3)
            .map_err(Self::fault)?;
        // Bending in the plane may be slower: the longitudinal one moves the middle of the free end most along x.
        let along = |mode: &frequency::Mode| -> f64 {
            let share = |axis: usize| {
                mode.shape
                    .iter()
                    .skip(axis)
                    .step_by(2)
                    .map(|u| u * u)
                    .sum::<f64>()
            };
            share(0) / share(1)
        };
        let longitudinal = modes.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
        longitudinal
            .map(|mode| 1.0 / mode.frequency)
            .ok_or(Self::fault(SolveFault::Singular))
    }
}

/// Generalised-α without damping of its own: every `every`th step is an instant.
fn integrate(
    body: &Body,
    step: f64,
    count: usize,
    every: usize,
    finer: usize,
) -> Result<Vec<Vec<f64>>, Error> {
    let settings = TimeSettings {
        duration: step * count as f64,
        interval: step * every as f64,
        step: Step::AtMost(step / finer as f64),
        integrator: Integrator::GeneralisedAlpha {
            spectral_radius: 1.0,
            tolerance: 1e-9,
        },
    };
    let history =
        follow(&body.motion, settings, &|_| ()).map_err(|end| Settings::fault(end.fault))?;
    Ok(history
        .instants
        .into_iter()
        .map(|instant| instant.displacement)
        .collect())
}

/// Distance of two motions over the size of the second, in relative L2 over space and time, in %.
fn percent(fields: &[Vec<f64>], reference: &[Vec<f64>]) -> f64 {
    let flat = |fields: &[Vec<f64>]| fields.concat();
    super::case::percent(&flat(fields), &flat(reference))
}

fn every<T: Clone>(fields: &[T], stride: usize) -> Vec<T> {
    fields.iter().step_by(stride).cloned().collect()
}

fn corrected_energy(
    problem: &ClampedPlate,
    lattice: &MassSpring,
) -> crate::problem::sheet_energy::SheetEnergy {
    DifferenceScheme::Biquadratic.energy(problem, &lattice.mesh)
}

fn sheet_model<'a>(plate: &ClampedPlate, mesh: &'a Mesh, energy: &'a dyn Potential) -> Model<'a> {
    let model = plate.on(mesh, energy).named("difference scheme");
    model.describing(|element| format!("cell {element}"))
}

fn released(settings: &Settings, progress: Progress, outcome: &mut Outcome) -> Result<(), Error> {
    /// Steps between the instants that are compared.
    const STRIDE: usize = 8;
    let plate = &settings.plate;
    let lattice = plate.lattice();
    let law = DashpotLaw::Material(settings.material.clone());
    let dashpots = Dashpots::new(&lattice, &law);
    let springs = settings.body(&lattice.model(&plate.problem), &lattice.mesh, &dashpots)?;
    let energy = corrected_energy(&plate.problem, &lattice);
    let sheet = SheetViscosity::new(&energy, &settings.material);
    let scheme = settings.body(
        &sheet_model(&plate.problem, &lattice.mesh, &energy),
        &lattice.mesh,
        &sheet,
    )?;
    let elements = FiniteElements::new(&plate.problem, plate.cells, Element::Q2);
    let viscosity = SheetViscosity::new(elements.energy(), &settings.material);
    let reference = settings.body(&elements.model(&plate.problem), &elements.mesh, &viscosity)?;

    let period = Settings::period(&reference)?;
    let (step, count) = (
        period / settings.steps as f64,
        settings.periods * settings.steps,
    );
    progress("finite elements");
    let on_lattice = |fields: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        fields
            .iter()
            .map(|field| reference.mesh.displacement_on(field, &lattice.mesh))
            .collect()
    };
    let coarse = on_lattice(integrate(&reference, step, count, STRIDE, 1)?);
    let exact = on_lattice(integrate(&reference, step, count, STRIDE, 2)?);
    progress("springs");
    let uncorrected = integrate(&springs, step, count, 1, 1)?;
    progress("corrector");
    let equation = EquationOfMotion::new(&scheme.motion, step, 0.25)
        .map_err(|reason| Error::input(reason.to_string(), "change the motion"))?;
    let windows = WindowSettings {
        steps: settings.window,
        tolerance: 1e-9,
        max_iterations: 20,
    };
    let found = equation
        .correct(&uncorrected, &scheme.motion.start, windows)
        .map_err(Settings::fault)?;

    let (before, after) = (
        every(&uncorrected, STRIDE),
        every(&found.displacement, STRIDE),
    );
    let [before_percent, after_percent] = [&before, &after].map(|fields| percent(fields, &exact));
    outcome.checks.extend([
        Check::new(
            format!(
                "error of the springs over the corrected one, {} periods",
                settings.periods
            ),
            "–",
            Wanted::AtLeast(5.0),
            "finite elements on another mesh",
            before_percent / after_percent,
        ),
        Check::new(
            "springs: deviation over space and time",
            "%",
            Wanted::AtLeast(1.0),
            "there is something to correct",
            before_percent,
        ),
        Check::new(
            "reference: change by half the step, over the corrected deviation",
            "–",
            Wanted::AtMost(0.5),
            "converged in time",
            percent(&coarse, &exact) / after_percent,
        ),
    ]);
    outcome.claims.push(Claim {
        claim: "§ 3.2: in dynamics the technique improves the results to within 10 % of finite elements",
        reproduced: format!(
            "{} periods of a released plate: {} % by springs, {} % corrected",
            settings.periods,
            number(before_percent),
            number(after_percent)
        ),
    });
    outcome.blocks.push(Block::Paragraph(format!(
        "Period {} s, step {} s; {} windows of up to {} steps, {} Newton steps, {} factorisations. With the start, the \
         supports and all loads known the correction is Newton's method in time: its result does not depend on the springs.",
        number(period), number(step), found.windows, settings.window, found.iterations, found.factorisations
    )));
    let times: Vec<f64> = (0..exact.len())
        .map(|i| step * (STRIDE * i) as f64)
        .collect();
    outcome
        .figures
        .extend(figures(&lattice.mesh, &times, [&exact, &before, &after]));
    Ok(())
}

fn figures(mesh: &Mesh, times: &[f64], [exact, before, after]: [&[Vec<f64>]; 3]) -> Vec<Figure> {
    const INK: [u8; 3] = [60, 60, 60];
    // The node in the middle of the free end.
    let [length, width] = mesh.grid().size;
    let far = |node: &usize| {
        let [x, y] = mesh.nodes[*node];
        (x - length).hypot(y - 0.5 * width)
    };
    let tip = (0..mesh.nodes.len())
        .min_by(|a, b| far(a).total_cmp(&far(b)))
        .unwrap_or(0);
    let line = |label: &str, values: Vec<f64>, colour, stroke| Line {
        label: label.to_owned(),
        points: times.iter().zip(values).map(|(t, u)| [*t, u]).collect(),
        colour,
        stroke,
    };
    let along = |fields: &[Vec<f64>]| fields.iter().map(|field| field[2 * tip]).collect();
    let size = (exact.concat().iter().map(|u| u * u).sum::<f64>() / exact.len() as f64).sqrt();
    let error = |fields: &[Vec<f64>]| -> Vec<f64> {
        let instants = fields.iter().zip(exact);
        instants
            .map(|(u, v)| {
                100.0
                    * u.iter()
                        .zip(v)
                        .map(|(u, v)| (u - v).powi(2))
                        .sum::<f64>()
                        .sqrt()
                    / size
            })
            .collect()
    };
    let motion = LineChart {
        title: "A released plate: the free end".into(),
        x: Axis::linear("time [s]"),
        y: Axis::linear("displacement [mm]"),
        lines: vec![
            line("finite elements", along(exact), INK, Stroke::Solid),
            line("springs", along(before), PALETTE[1], Stroke::Solid),
            line("corrected", along(after), PALETTE[0], Stroke::Dashed),
        ],
        band: None,
    };
    let errors = LineChart {
        title: "Deviation from the finite elements over the size of the motion".into(),
        x: Axis::linear("time [s]"),
        y: Axis::logarithmic("deviation [%]"),
        lines: vec![
            line("springs", error(before), PALETTE[1], Stroke::Solid),
            line("corrected", error(after), PALETTE[0], Stroke::Solid),
        ],
        band: None,
    };
    vec![
        Figure::new(
            "motion_correction.png",
            "Displacement of the middle of the free end.",
            motion,
        ),
        Figure::new(
            "motion_correction_error.png",
            "Deviation from the finite elements over time.",
            errors,
        ),
    ]
}
