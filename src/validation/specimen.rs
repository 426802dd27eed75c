//! A specimen of any shape in all three models: springs, corrected springs, finite elements.

use std::path::Path;

use crate::boundary::{BoundaryProblem, Discretised};
use crate::compare::area_weighted_percent;
use crate::compare::imported::ModelField;
use crate::corrector::{CorrectorSettings, Solver, specimen::correct};
use crate::document::Section;
use crate::error::{Diagnostic, Error, SolveFault};
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::output::picture::Scale;
use crate::output::{self, Block, Figure, vtk};
use crate::solve::{NewtonSettings, PathEnd, State};
use crate::validation::{Case, Check, Outcome, Prepared, Progress, Wanted};

mod read;
mod reference;

pub use read::{Refinement, Specimen, Tolerances};
use reference::Reference;

/// The `kind` of these studies.
pub const KIND: &str = "specimen";

/// A specimen's study: its title, the specimen, and what deserves attention.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn load(
    case: &Case,
    file: &Path,
    text: &str,
) -> Result<(String, Specimen, Vec<Diagnostic>), Error> {
    let (title, specimen, warnings) = case.read_with(file, text, read::read)?;
    let specimen = specimen.expect("a study without faults has a specimen");
    Ok((title, specimen, warnings))
}

/// Reads a study of this kind.
pub fn prepare(root: &Section, folder: &Path) -> Prepared {
    let specimen = read::read(root, folder);
    Box::new(move |progress| {
        specimen.map_or(Ok(Outcome::default()), |read| compute(read, progress))
    })
}

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

const CORRECTOR: CorrectorSettings = CorrectorSettings {
    tolerance: 1e-8,
    movement: 1e-9,
    max_steps: 60,
    solver: Solver::Automatic,
};

/// The states of one model and its force on the measured group at each load factor.
struct Solved {
    states: Vec<State>,
    forces: Vec<f64>,
}

fn fault(model: &str, factor: f64, fault: SolveFault) -> Error {
    Error::Solve {
        model: model.to_owned(),
        step: format!("load factor {factor}"),
        fault,
    }
}

/// Solves as many load factors as can be reached; the others are taken from the specimen, and why is told.
fn solve(
    specimen: &mut Specimen,
    model: &Discretised,
    name: &str,
    ends: &mut Vec<Error>,
) -> Result<Solved, Error> {
    let states = match model.solve(&specimen.factors, NEWTON, &|_| ()) {
        Ok(states) => states,
        Err(PathEnd {
            factor,
            fault: cause,
            states,
        }) => specimen.end(states, fault(name, factor, cause), ends)?,
    };
    let forces = states
        .iter()
        .map(|state| specimen.force(model, state))
        .collect();
    Ok(Solved { states, forces })
}

impl Specimen {
    /// Ends the path after the states that were reached; a fault before the first of them is one of the study.
    fn end(
        &mut self,
        states: Vec<State>,
        fault: Error,
        ends: &mut Vec<Error>,
    ) -> Result<Vec<State>, Error> {
        if states.is_empty() {
            return Err(fault);
        }
        self.factors.truncate(states.len());
        ends.push(fault);
        Ok(states)
    }

    /// The larger component of the force on the measured group: its axis, and its size in N with its sign.
    fn component(&self, model: &Discretised, state: &State) -> (usize, f64) {
        let [x, y] = model.reaction(state, &self.measured);
        if x.abs() >= y.abs() { (0, x) } else { (1, y) }
    }

    fn force(&self, model: &Discretised, state: &State) -> f64 {
        self.component(model, state).1
    }

    /// The problem on a mesh; groups were checked when the study was read.
    fn on<'a>(
        &self,
        problem: &BoundaryProblem,
        mesh: &'a Mesh,
        energy: &'a dyn crate::solve::Potential,
    ) -> Result<Discretised<'a>, Error> {
        problem
            .on(mesh, energy)
            .map_err(|found| Error::Input(vec![found]))
    }
}

/// The mesh of the finest finite elements; a specimen that refines itself is solved for it.
///
/// # Errors
/// [`Error::Solve`] when it must be solved and has no solution.
pub fn finest_mesh(specimen: &mut Specimen) -> Result<Mesh, Error> {
    if specimen.refinement.is_none() {
        let [_, _, mesh] = specimen.reference_meshes();
        return Ok(mesh);
    }
    let mut ends = Vec::new();
    let (mesh, _) = reference::finest(specimen, &mut ends)?;
    ends.pop().map_or(Ok(mesh), Err)
}

/// The fields of all models at a load factor: finite elements on the finest mesh, springs, corrected springs. The
/// study's load factors before it are steps on the way.
///
/// # Errors
/// [`Error::Solve`] when a model has no solution.
pub fn fields(
    mut specimen: Specimen,
    factor: f64,
    progress: Progress,
) -> Result<[ModelField; 3], Error> {
    let (specimen, mut ends) = (&mut specimen, Vec::new());
    specimen.factors.retain(|before| *before < factor);
    specimen.factors.push(factor);
    progress("finite elements");
    let (mesh, reference) = reference::finest(specimen, &mut ends)?;
    let (springs, [uncorrected, corrected]) = on_lattice(specimen, &mut ends, progress)?;
    if let Some(end) = ends.pop() {
        return Err(end);
    }
    let field = |model, mesh: Mesh, mut solved: Solved| ModelField {
        model,
        mesh,
        displacement: solved.states.pop().expect("the last factor").displacement,
    };
    Ok([
        field("finite elements", mesh, reference),
        field("mass-spring", springs.mesh.clone(), uncorrected),
        field("corrected", springs.mesh, corrected),
    ])
}

fn compute(mut specimen: Specimen, progress: Progress) -> Result<Outcome, Error> {
    let (specimen, mut ends) = (&mut specimen, Vec::new());
    progress("finite elements");
    let reference = Reference::solve(specimen, &mut ends)?;
    let (springs, [uncorrected, corrected]) = on_lattice(specimen, &mut ends, progress)?;
    let mut outcome = outcome(specimen, &reference, &springs, [&uncorrected, &corrected]);
    for end in ends {
        let wanted = Wanted::AtMost(0.0);
        let check = Check::new(end.to_string(), "–", wanted, "the whole path", f64::NAN);
        outcome.checks.push(check);
    }
    Ok(outcome)
}

/// The springs, and the states of them before and after the correction.
fn on_lattice(
    specimen: &mut Specimen,
    ends: &mut Vec<Error>,
    progress: Progress,
) -> Result<(MassSpring, [Solved; 2]), Error> {
    let problem = &specimen.problem.clone();
    progress("mass-spring");
    let springs = MassSpring::on_mesh(&problem.law, problem.thickness, specimen.lattice());
    let lattice = &springs.mesh;
    let model = specimen.on(problem, lattice, springs.potential())?;
    let model = model.named(|element| springs.describe_element(element));
    let uncorrected = solve(specimen, &model, "mass-spring", ends)?;
    drop(model);

    progress("corrector");
    let energy = problem.finite_elements(lattice);
    let model = specimen.on(problem, lattice, &energy)?;
    let corrected = correct_all(specimen, &model, lattice, &uncorrected, ends)?;
    drop(model);
    Ok((springs, [uncorrected, corrected]))
}

/// Corrects the states of the springs as far as they can be.
fn correct_all(
    specimen: &mut Specimen,
    model: &Discretised,
    lattice: &Mesh,
    uncorrected: &Solved,
    ends: &mut Vec<Error>,
) -> Result<Solved, Error> {
    let mut states: Vec<State> = Vec::new();
    let mut change = vec![0.0; 2 * lattice.nodes.len()];
    for state in &uncorrected.states[..specimen.factors.len()] {
        // What the correction has changed at the load factor before is nearly right at this one.
        let data = &state.displacement;
        let pairs = data.iter().zip(&change);
        let start: Vec<f64> = pairs.map(|(u, change)| u + change).collect();
        match correct(lattice, model, data, &start, state.factor, CORRECTOR) {
            Ok(field) => {
                let pairs = field.state.displacement.iter().zip(data);
                change = pairs.map(|(corrected, u)| corrected - u).collect();
                states.push(field.state);
            }
            Err(cause) => {
                let fault = fault("corrector", state.factor, cause);
                states = specimen.end(states, fault, ends)?;
                break;
            }
        }
    }
    let forces = states
        .iter()
        .map(|state| specimen.force(model, state))
        .collect();
    Ok(Solved { states, forces })
}

/// Deviations of one model at one load factor, in %.
struct Deviation {
    displacement: f64,
    force: f64,
}

fn deviation(
    lattice: &Mesh,
    solved: &Solved,
    step: usize,
    expected: &[f64],
    force: f64,
) -> Deviation {
    Deviation {
        displacement: area_weighted_percent(lattice, &solved.states[step].displacement, expected),
        force: 100.0 * (solved.forces[step] / force - 1.0),
    }
}

fn outcome(
    specimen: &Specimen,
    reference: &Reference,
    springs: &MassSpring,
    [uncorrected, corrected]: [&Solved; 2],
) -> Outcome {
    let lattice = &springs.mesh;
    let fine = &reference.mesh;
    let mut rows = Vec::new();
    let mut worst = [0.0_f64, 0.0, f64::INFINITY];
    let mut own_error = 0.0_f64;
    let mut fields = Vec::new();
    for (step, factor) in specimen.factors.iter().enumerate() {
        let expected = fine.displacement_on(&reference.solved.states[step].displacement, lattice);
        let force = reference.solved.forces[step];
        let before = deviation(lattice, uncorrected, step, &expected, force);
        let after = deviation(lattice, corrected, step, &expected, force);
        let correction = 100.0 * (1.0 - after.displacement / before.displacement);
        worst[0] = worst[0].max(after.displacement);
        worst[1] = worst[1].max(after.force.abs());
        worst[2] = worst[2].min(correction);
        own_error = own_error.max(reference.force_percent(step));
        rows.push(vec![
            factor.to_string(),
            format!("{:.3}", before.displacement),
            format!("{:.4}", after.displacement),
            format!("{correction:.2}"),
            format!("{:.2}", before.force),
            format!("{:.3}", after.force),
            format!("{force:.5}"),
            reference
                .three_meshes_percent(step)
                .map_or("–".into(), |error| format!("{error:.4}")),
            format!("{:.4}", reference.estimated_force_percent(step)),
            format!("{:.4}", reference.estimates[step].energy.percent()),
        ]);
        fields.push(expected);
    }
    let limits = specimen.tolerances;
    let check = |quantity: &str, wanted, value| {
        Check::new(quantity, "%", wanted, "the study's tolerance", value)
    };
    let mut checks = vec![
        check(
            "corrected displacement from the finite elements",
            Wanted::AtMost(limits.displacement_percent),
            worst[0],
        ),
        check(
            "corrected force from the finite elements",
            Wanted::AtMost(limits.force_percent),
            worst[1],
        ),
        check(
            "correction of the displacement",
            Wanted::AtLeast(limits.correction_percent),
            worst[2],
        ),
        check(
            &format!(
                "finite elements' own error of the force, {}",
                reference.by_what()
            ),
            Wanted::AtMost(limits.force_percent),
            own_error,
        ),
    ];
    checks.extend(reference.goal_check(specimen));
    let head = [
        "load factor [–]",
        "mass-spring: displacement [%]",
        "corrected: displacement [%]",
        "correction [%]",
        "mass-spring: force [%]",
        "corrected: force [%]",
        "finite elements: force [N]",
        "their own error, by three meshes [%]",
        "their own error, by recovery [%]",
        "their field's own error by recovery, energy norm [%]",
    ];
    let text = format!(
        "Deviations from the finite elements ({} on {}, {}) at {} nodes of the lattice ({}). \
         Displacements in relative L2, weighted by area; the force is that of the supports on the group `{}`.",
        specimen.element_name,
        fine.describe(),
        reference.kind(),
        lattice.nodes.len(),
        lattice.describe(),
        specimen.measured
    );
    Outcome {
        checks,
        blocks: [
            Block::Paragraph(text),
            Block::Table(head.map(String::from).to_vec(), rows),
        ]
        .into_iter()
        .chain(reference.history())
        .collect(),
        figures: figures(
            specimen,
            reference,
            springs,
            [uncorrected, corrected],
            &fields,
        ),
        vtk: files(
            specimen,
            reference,
            springs,
            [uncorrected, corrected],
            &fields,
        ),
        ..Outcome::default()
    }
}

fn sizes(u: &[f64]) -> Vec<f64> {
    u.chunks_exact(2).map(|u| u[0].hypot(u[1])).collect()
}

fn figures(
    specimen: &Specimen,
    reference: &Reference,
    springs: &MassSpring,
    [uncorrected, corrected]: [&Solved; 2],
    expected: &[Vec<f64>],
) -> Vec<Figure> {
    let lattice = &springs.mesh;
    let last = specimen.factors.len() - 1;
    let fine = &reference.mesh;
    let [before, after] = [uncorrected, corrected].map(|model| &*model.states[last].displacement);
    let exact = &*reference.solved.states[last].displacement;
    let distance = |u: &[f64]| {
        let pairs = u.iter().zip(&expected[last]);
        sizes(&pairs.map(|(u, v)| u - v).collect::<Vec<_>>())
    };
    let name = |what: &str| format!("{}_{what}.png", specimen.name);
    let at = format!("load factor {}", specimen.factors[last]);
    vec![
        Figure {
            name: name("displacement"),
            caption: format!("Displacement in all three models at {at}, on one colour scale."),
            png: output::field_figure(
                &format!("Displacement at {at}"),
                "displacement [mm]",
                Scale::Linear,
                &[
                    ("mass-spring", lattice, before, sizes(before)),
                    ("corrected", lattice, after, sizes(after)),
                    ("finite elements", fine, exact, sizes(exact)),
                ],
            ),
        },
        Figure {
            name: name("error"),
            caption: format!(
                "Distance to the finite elements at {at}, before and after the correction."
            ),
            png: output::field_figure(
                &format!("Distance to the finite elements at {at}"),
                "distance [mm]",
                Scale::Logarithmic,
                &[
                    ("mass-spring", lattice, before, distance(before)),
                    ("corrected", lattice, after, distance(after)),
                ],
            ),
        },
        Figure {
            name: name("mesh"),
            caption: "The cells of the lattice.".into(),
            png: output::mesh_picture("Lattice", lattice),
        },
        Figure {
            name: name("estimated_error"),
            caption: format!(
                "Estimated error of every finite element at {at}, in % of the solution's energy norm."
            ),
            png: output::cell_figure(
                (&format!("Estimated error at {at}"), "error of a cell [%]"),
                Scale::Logarithmic,
                fine,
                exact,
                &reference.estimates[last].energy.cell_percents(),
            ),
        },
    ]
}

fn files(
    specimen: &Specimen,
    reference: &Reference,
    springs: &MassSpring,
    [uncorrected, corrected]: [&Solved; 2],
    expected: &[Vec<f64>],
) -> Vec<(String, Vec<u8>)> {
    let sheet = vtk::Sheet {
        law: &*specimen.problem.law,
        thickness: specimen.problem.thickness,
    };
    let lattice = &springs.mesh;
    let title = &specimen.name;
    let mut files = Vec::new();
    let mut series = |name: &str, file: &dyn Fn(usize) -> Vec<u8>| {
        let steps = specimen.factors.iter().enumerate();
        let named: Vec<(f64, String)> = steps
            .map(|(step, factor)| (*factor, format!("{name}_{:03}.vtu", step + 1)))
            .collect();
        for (step, (_, file_name)) in named.iter().enumerate() {
            files.push((file_name.clone(), file(step)));
        }
        files.push((format!("{name}.pvd"), vtk::collection(&named)));
    };
    for (name, model) in [("mass_spring", uncorrected), ("corrected", corrected)] {
        series(name, &|step| {
            let u = &model.states[step].displacement;
            vtk::field_file(title, &sheet, lattice, u, &expected[step])
        });
    }
    series("springs", &|step| {
        vtk::springs_file(title, springs, &uncorrected.states[step].displacement)
    });
    series("finite_element", &|step| {
        let u = &reference.solved.states[step].displacement;
        let error = &reference.estimates[step].energy;
        vtk::finite_element_file(title, &sheet, &reference.mesh, u, error)
    });
    files
}
