//! A specimen of any shape in all three models: springs, corrected springs, finite elements.

use std::path::Path;

use crate::boundary::{BoundaryProblem, Discretised};
use crate::compare::area_weighted_percent;
use crate::corrector::{CorrectorSettings, Solver, specimen::correct};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::{Richardson, richardson};
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::output::picture::Scale;
use crate::output::{self, Block, Figure, vtk, wrinkling};
use crate::sheet_energy::SheetEnergy;
use crate::solve::{NewtonSettings, State};
use crate::validation::{Check, Outcome, Prepared, Progress, Wanted};

mod end;
mod read;

use end::End;
use read::{Measured, Specimen};

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

/// The states of one model and what is measured at each load factor: force in N or displacement in mm.
struct Solved {
    states: Vec<State>,
    measured: Vec<f64>,
}

impl Solved {
    fn new(specimen: &Specimen, model: &Discretised, states: Vec<State>) -> Self {
        let measured = states.iter().map(|state| specimen.measure(model, state));
        Self {
            measured: measured.collect(),
            states,
        }
    }
}

/// Solves as many load factors as can be reached; where others cannot, the end is told.
fn solve(
    specimen: &Specimen,
    model: &Discretised,
    names: [&str; 2],
    mesh: &Mesh,
    ends: &mut Vec<End>,
) -> Solved {
    let states = match model.solve(&specimen.factors, NEWTON, &|_| ()) {
        Ok(states) => states,
        Err(end) => {
            let last = end.last.as_deref().or(end.states.last());
            let measured = last.map_or(0.0, |state| specimen.measure(model, state));
            ends.push(End::of_path(names, mesh, &end, measured));
            end.states
        }
    };
    Solved::new(specimen, model, states)
}

impl Specimen {
    /// The size of the force on the measured group in N, with the sign of its larger component; its displacement in
    /// mm where it is a grip with a given force.
    fn measure(&self, model: &Discretised, state: &State) -> f64 {
        if let Measured::Displacement(axis) = self.measured() {
            return model.displacement(state, &self.measured)[axis];
        }
        let [x, y] = model.reaction(state, &self.measured);
        if x.abs() >= y.abs() { x } else { y }
    }

    /// What stresses follow from.
    fn sheet(&self) -> vtk::Sheet<'_> {
        vtk::Sheet {
            law: &*self.problem.law,
            thickness: self.problem.thickness,
        }
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

/// The finite elements on three meshes, coarse to fine.
struct Reference {
    meshes: [Mesh; 3],
    solved: [Solved; 3],
}

/// File names of the finite elements' ends, coarse to fine.
const REFERENCES: [&str; 3] = [
    "finite_element_coarse",
    "finite_element_middle",
    "finite_element",
];

fn compute(mut specimen: Specimen, progress: Progress) -> Result<Outcome, Error> {
    let (specimen, mut ends) = (&mut specimen, Vec::new());
    let problem = &specimen.problem.clone();
    progress("finite elements");
    let meshes = specimen.reference_meshes();
    let mut solved = Vec::new();
    for (mesh, file) in meshes.iter().zip(REFERENCES) {
        let energy: SheetEnergy = problem.finite_elements(mesh);
        let model = specimen.on(problem, mesh, &energy)?;
        let name = format!("finite elements ({})", mesh.describe());
        solved.push(solve(specimen, &model, [&name, file], mesh, &mut ends));
    }
    let solved = solved.try_into().ok().expect("three meshes");
    let reference = Reference { meshes, solved };

    progress("mass-spring");
    let springs = MassSpring::on_mesh(&problem.law, problem.thickness, specimen.lattice());
    let lattice = &springs.mesh;
    let model = specimen.on(problem, lattice, springs.potential())?;
    let model = model.named(|element| springs.describe_element(element));
    let names = ["mass-spring", "mass_spring"];
    let uncorrected = solve(specimen, &model, names, lattice, &mut ends);

    progress("corrector");
    let energy = problem.finite_elements(lattice);
    let model = specimen.on(problem, lattice, &energy)?;
    let corrected = correct_all(specimen, &model, lattice, &uncorrected, &mut ends);
    let all = reference.solved.iter().chain([&uncorrected, &corrected]);
    let reached = all.map(|solved| solved.states.len()).min();
    specimen.factors.truncate(reached.unwrap_or(0));
    let mut outcome = if specimen.factors.is_empty() {
        end::without_state(&ends)?
    } else {
        outcome(specimen, &reference, &springs, [&uncorrected, &corrected])
    };
    end::tell(specimen, ends, &mut outcome);
    Ok(outcome)
}

/// Corrects the states of the springs as far as they can be.
fn correct_all(
    specimen: &Specimen,
    model: &Discretised,
    lattice: &Mesh,
    uncorrected: &Solved,
    ends: &mut Vec<End>,
) -> Solved {
    let mut states: Vec<State> = Vec::new();
    let mut change = vec![0.0; 2 * lattice.nodes.len()];
    for state in &uncorrected.states {
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
            Err(fault) => {
                ends.push(End::at("corrector", state.factor, fault));
                break;
            }
        }
    }
    Solved::new(specimen, model, states)
}

/// Deviations of one model at one load factor, in %.
struct Deviation {
    displacement: f64,
    measured: f64,
}

fn deviation(
    lattice: &Mesh,
    solved: &Solved,
    step: usize,
    expected: &[f64],
    measured: f64,
) -> Deviation {
    Deviation {
        displacement: area_weighted_percent(lattice, &solved.states[step].displacement, expected),
        measured: 100.0 * (solved.measured[step] / measured - 1.0),
    }
}

fn outcome(
    specimen: &Specimen,
    reference: &Reference,
    springs: &MassSpring,
    [uncorrected, corrected]: [&Solved; 2],
) -> Outcome {
    let lattice = &springs.mesh;
    let [_, _, fine] = &reference.meshes;
    let mut rows = Vec::new();
    let mut worst = [0.0_f64, 0.0, f64::INFINITY];
    let mut own_error = 0.0_f64;
    let mut fields = Vec::new();
    for (step, factor) in specimen.factors.iter().enumerate() {
        let expected =
            fine.displacement_on(&reference.solved[2].states[step].displacement, lattice);
        let measured = [0, 1, 2].map(|level| reference.solved[level].measured[step]);
        let own: Richardson = richardson(measured);
        let before = deviation(lattice, uncorrected, step, &expected, measured[2]);
        let after = deviation(lattice, corrected, step, &expected, measured[2]);
        let correction = 100.0 * (1.0 - after.displacement / before.displacement);
        worst[0] = worst[0].max(after.displacement);
        worst[1] = worst[1].max(after.measured.abs());
        worst[2] = worst[2].min(correction);
        own_error = own_error.max(own.error_percent);
        rows.push(vec![
            factor.to_string(),
            format!("{:.3}", before.displacement),
            format!("{:.4}", after.displacement),
            format!("{correction:.2}"),
            format!("{:.2}", before.measured),
            format!("{:.3}", after.measured),
            format!("{:.5}", measured[2]),
            format!("{:.4}", own.error_percent),
        ]);
        fields.push(expected);
    }
    let limits = specimen.tolerances;
    let what = specimen.measured().name();
    let check = |quantity: &str, wanted, value| {
        Check::new(quantity, "%", wanted, "the study's tolerance", value)
    };
    let checks = vec![
        check(
            "corrected displacement from the finite elements",
            Wanted::AtMost(limits.displacement_percent),
            worst[0],
        ),
        check(
            &format!("corrected {what} from the finite elements"),
            Wanted::AtMost(limits.force_percent),
            worst[1],
        ),
        check(
            "correction of the displacement",
            Wanted::AtLeast(limits.correction_percent),
            worst[2],
        ),
        check(
            &format!("finite elements' own error of the {what}, by three meshes"),
            Wanted::AtMost(limits.force_percent),
            own_error,
        ),
    ];
    let head = [
        "load factor [–]".into(),
        "mass-spring: displacement [%]".into(),
        "corrected: displacement [%]".into(),
        "correction [%]".into(),
        format!("mass-spring: {what} [%]"),
        format!("corrected: {what} [%]"),
        format!("finite elements: {what} [{}]", specimen.measured().unit()),
        "their own error [%]".into(),
    ];
    let text = format!(
        "Deviations from the finite elements ({} on {}, finest of three meshes) at {} nodes of the lattice ({}). \
         Displacements in relative L2, weighted by area; the {what} is that of {} the group `{}`.",
        specimen.element_name,
        fine.describe(),
        lattice.nodes.len(),
        lattice.describe(),
        if what == "force" {
            "the supports on"
        } else {
            "the grip at"
        },
        specimen.measured
    );
    let mut blocks = vec![Block::Paragraph(text), Block::Table(head.to_vec(), rows)];
    blocks.extend(compression(specimen, reference).map(Block::Paragraph));
    Outcome {
        checks,
        blocks,
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

/// The warning about compression in the finite elements.
fn compression(specimen: &Specimen, reference: &Reference) -> Option<String> {
    let [_, _, fine] = &reference.meshes;
    let states = reference.solved[2].states.iter().zip(&specimen.factors);
    let states =
        states.map(|(state, factor)| (format!("load factor {factor}"), &*state.displacement));
    wrinkling::warning(&*specimen.problem.law, fine, states)
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
    let fine = &reference.meshes[2];
    let [before, after] = [uncorrected, corrected].map(|model| &*model.states[last].displacement);
    let exact = &*reference.solved[2].states[last].displacement;
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
    ]
}

fn files(
    specimen: &Specimen,
    reference: &Reference,
    springs: &MassSpring,
    [uncorrected, corrected]: [&Solved; 2],
    expected: &[Vec<f64>],
) -> Vec<(String, Vec<u8>)> {
    let sheet = specimen.sheet();
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
            vtk::field_file(title, &sheet, lattice, u, Some(&expected[step]))
        });
    }
    series("springs", &|step| {
        vtk::springs_file(title, springs, &uncorrected.states[step].displacement)
    });
    series("finite_element", &|step| {
        let u = &reference.solved[2].states[step].displacement;
        vtk::field_file(title, &sheet, &reference.meshes[2], u, None)
    });
    files
}
