//! The error estimate beside true errors, the order of the force with graded cells, and local refinement beside
//! uniform refinement.

use std::path::Path;

use super::{held, manufactured, misfit, ring, sheet, solve};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::finite_element::error_estimate::{EnergyError, ErrorEstimate, Solved, bulk};
use crate::finite_element::recovery::Recovery;
use crate::finite_element::{Element, FiniteElements};
use crate::mesh::{CellShape, Mesh, Shape};
use crate::problem::{ClampedPlate, Measures};
use crate::results::{Axis, Block, Figure, Line, LineChart, PALETTE, Stroke, mesh_outlines};
use crate::validation::case::{Check, Outcome, Prepared, Progress, Wanted, number};

const SIZE: [f64; 2] = [150.0, 50.0];
const STRETCH: f64 = 0.5;

/// The plate's force in N at this stretch by dolfinx, scikit-fem and FElupe, extrapolated.
const OTHER_CODES: f64 = 10.7125;

/// The part of the squared error that is refined in a round.
const SHARE: f64 = 0.5;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("smooth");
    let smooth = section.count("cells", 8, 64);
    section.unknown_keys();
    let section = root.section("plate");
    let plate = section.count("coarsest", 4, 20);
    section.unknown_keys();
    let section = root.section("adaptive");
    let coarsest = section.count("coarsest", 2, 16);
    let halvings = section.count("halvings", 1, 4);
    section.unknown_keys();
    Box::new(move |progress| {
        let mut outcome = Outcome::default();
        let mut forces = Vec::new();
        for (name, shape) in CellShape::NAMES {
            progress(name);
            outcome.checks.extend(smooth_checks(name, shape, smooth)?);
            forces.push(smooth_force(name, shape, smooth, &mut outcome)?);
        }
        outcome.blocks.extend(force_table(forces));
        let exact = graded_plates(plate, &mut outcome, progress)?;
        progress("local refinement");
        refinement([coarsest, halvings], exact, &mut outcome)?;
        Ok(outcome)
    })
}

/// Amplitude of the manufactured solutions.
const AMPLITUDE: f64 = 0.05;

fn smooth_check(name: &str, what: &str, effectivity: f64) -> Check {
    Check::new(
        format!("{name}: estimated over true error, {what}"),
        "–",
        Wanted::Equal(1.0, 20.0),
        "exact in the limit",
        effectivity,
    )
}

/// True and estimated error of the force on a manufactured solution between rollers: a row of a table, and a check for
/// all elements but T2, whose two integrals nearly cancel there.
fn smooth_force(
    name: &str,
    shape: CellShape,
    cells: usize,
    outcome: &mut Outcome,
) -> Result<Vec<String>, Error> {
    let (mesh, state, force) = manufactured::between_rollers(shape, cells, AMPLITUDE)?;
    let estimate = on(&mesh, &state.displacement, sheet().thickness, |solved| {
        solved.estimate(&Recovery::new(&mesh), &force.influence)
    });
    let error = force.found - force.exact;
    let effectivity = estimate.force / error;
    if shape != CellShape::Triangle6 {
        let what = "force on a manufactured solution";
        outcome.checks.push(smooth_check(name, what, effectivity));
    }
    let percent = |error: f64| number(100.0 * error / force.exact);
    Ok(vec![
        name.to_owned(),
        number(force.exact),
        percent(error),
        percent(estimate.force),
        number(effectivity),
    ])
}

fn force_table(rows: Vec<Vec<String>>) -> [Block; 2] {
    let text = "The force of the right side of a manufactured solution between four rollers. No check is made of T2: the two \
                integrals of its estimate nearly cancel.";
    let head = [
        "element",
        "exact force [N]",
        "error of the force [%]",
        "the same by recovery [%]",
        "estimated over true error",
    ];
    [Block::Paragraph(text.into()), Block::table(&head, rows)]
}

/// Estimated over true error of an element on smooth problems.
fn smooth_checks(name: &str, shape: CellShape, cells: usize) -> Result<[Check; 2], Error> {
    let check = |what: &str, effectivity: f64| smooth_check(name, what, effectivity);
    let (mesh, state, field) = manufactured::solved(shape, cells, AMPLITUDE)?;
    let solved = on(&mesh, &state.displacement, sheet().thickness, |solved| {
        let exact = solved.distance(|cell, local| field.gradient(mesh.place(cell, local)));
        effectivity(solved, &exact)
    });
    let (mesh, state) = ring::blown_up(cells, shape)?;
    let (fine, exact) = ring::blown_up(3 * cells, CellShape::Quad9)?;
    let blown_up = on(&mesh, &state.displacement, sheet().thickness, |solved| {
        let exact = solved.distance(|cell, local| {
            let (there, local) = fine.locate(mesh.place(cell, local));
            fine.gradient_at(&exact.displacement, there, local)
        });
        effectivity(solved, &exact)
    });
    Ok([
        check("manufactured solution", solved),
        check("ring under pressure", blown_up),
    ])
}

/// Calls with a solution of the case's sheet.
fn on<T>(mesh: &Mesh, displacement: &[f64], thickness: f64, call: impl FnOnce(&Solved) -> T) -> T {
    let problem = sheet();
    call(&Solved {
        law: &*problem.law,
        thickness,
        mesh,
        displacement,
    })
}

fn effectivity(solved: &Solved, exact: &EnergyError) -> f64 {
    (solved.energy_estimate().squared() / exact.squared()).sqrt()
}

/// What is exact for the plate: force in N and energy in mJ.
#[derive(Clone, Copy)]
struct Exact {
    force: f64,
    energy: f64,
}

/// One mesh of the plate.
struct Plate {
    element: Element,
    grading: f64,
    describe: String,
    measures: Measures,
    estimate: ErrorEstimate,
}

/// Plates with equal and with graded cells; the exact values from the best of them.
fn graded_plates(
    coarsest: usize,
    outcome: &mut Outcome,
    progress: Progress,
) -> Result<Exact, Error> {
    let mut series = Vec::new();
    for (element, grading) in [
        (Element::Q2, 3.0),
        (Element::Q2, 1.0),
        (Element::Q1, 1.5),
        (Element::Q1, 1.0),
    ] {
        progress(&format!("plate, {}, grading {grading}", element.name()));
        let plates = [1, 2, 4].map(|finer| plate(finer * coarsest, element, grading));
        let [coarse, middle, fine] = plates;
        series.push([coarse?, middle?, fine?]);
    }
    let values = |value: fn(&Measures) -> f64, plates: &[Plate; 3]| {
        richardson(plates.each_ref().map(|plate| value(&plate.measures)))
    };
    let force = |plates| values(|measures| measures.force, plates);
    let exact = Exact {
        force: force(&series[0]).extrapolated,
        energy: values(|measures| measures.energy, &series[0]).extrapolated,
    };
    outcome.checks.push(Check::new(
        "plate, graded, extrapolated force",
        "N",
        Wanted::Equal(OTHER_CODES, 1e-4),
        "dolfinx, scikit-fem, FElupe, extrapolated",
        exact.force,
    ));
    for plates in &series {
        let [.., fine] = plates;
        let (wanted, source) = match (fine.element, fine.grading > 1.0) {
            (Element::Q2, true) => (Wanted::AtLeast(3.7), "2p = 4"),
            (Element::Q1, true) => (Wanted::AtLeast(1.9), "2p = 2"),
            (Element::Q2, false) => (Wanted::AtMost(2.3), "singular corners"),
            (Element::Q1, false) => (Wanted::AtMost(1.9), "singular corners"),
        };
        outcome.checks.push(Check::new(
            format!("plate, {}: order of the force", fine.name()),
            "–",
            wanted,
            source,
            force(plates).order.unwrap_or(f64::NAN),
        ));
    }
    outcome.blocks.extend(table(&series, exact));
    Ok(exact)
}

impl Plate {
    fn name(&self) -> String {
        let cells = match self.grading > 1.0 {
            true => format!("graded by {}", self.grading),
            false => "equal cells".to_owned(),
        };
        format!("{}, {cells}", self.element.name())
    }
}

fn plate(across: usize, element: Element, grading: f64) -> Result<Plate, Error> {
    let problem = ClampedPlate {
        size: SIZE,
        thickness: sheet().thickness,
        law: sheet().law,
        stretches: vec![STRETCH],
    };
    let model = FiniteElements::graded(&problem, [3 * across, across], element, grading);
    let state = model.model(&problem).reach(&[STRETCH], super::NEWTON)?;
    let estimate = model.estimate(&problem, &state, &Recovery::new(&model.mesh));
    Ok(Plate {
        element,
        grading,
        describe: model.describe(),
        estimate: estimate.map_err(|fault| Error::Solve {
            model: model.describe(),
            step: ClampedPlate::describe_step(STRETCH),
            fault,
        })?,
        measures: Measures::of(&model.mesh, &state),
    })
}

fn table(series: &[[Plate; 3]], exact: Exact) -> Vec<Block> {
    let row = |plate: &Plate| {
        let measures = &plate.measures;
        let surplus = 2.0 * (measures.energy - exact.energy);
        let squared = plate.estimate.energy.squared();
        vec![
            plate.describe.clone(),
            format!("{:.6}", measures.force),
            number(100.0 * (measures.force / exact.force - 1.0)),
            number(100.0 * plate.estimate.force / exact.force),
            number(plate.estimate.energy.percent()),
            number((squared / surplus).sqrt()),
        ]
    };
    let head = [
        "clamped plate",
        "force [N]",
        "its error [%]",
        "the same by recovery [%]",
        "error of the field by recovery, energy norm [%]",
        "estimated over true error of the field",
    ];
    vec![
        Block::Paragraph(
            "The clamped plate at 50 % stretch. True errors are those from the extrapolated graded Q2 plates; that of the \
             field is the root of twice the surplus of the potential. Beside a singular corner a recovered gradient is \
             no better than the elements' own: there the estimate is less exact, and no check is made of it."
                .into(),
        ),
        Block::table(&head, series.iter().flatten().map(row)),
    ]
}

/// One mesh of a refinement: cells, error of the force in %, estimate.
struct Round {
    triangles: Mesh,
    force_percent: f64,
    estimate: EnergyError,
}

/// T2 elements on the plate of some triangles.
fn round(triangles: Mesh, exact: Exact) -> Result<Round, Error> {
    let mesh = triangles.quadratic();
    let problem = held(&[
        ("left", [Some(0.0); 2]),
        ("right", [Some(STRETCH * SIZE[0]), Some(0.0)]),
    ]);
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).map_err(misfit)?;
    let state = solve(&model, "local refinement", 1)?;
    let force = model.reaction(&state, "right")[0];
    let estimate = on(&mesh, &state.displacement, problem.thickness, |solved| {
        solved.energy_estimate()
    });
    Ok(Round {
        triangles,
        force_percent: 100.0 * (force / exact.force - 1.0).abs(),
        estimate,
    })
}

/// Refines until the force is as good as on the finest uniform mesh, and compares the numbers of cells.
fn refinement(
    [coarsest, halvings]: [usize; 2],
    exact: Exact,
    outcome: &mut Outcome,
) -> Result<(), Error> {
    let first = Shape::Strip { size: SIZE }.mesh(coarsest, CellShape::Triangle3);
    let mut uniform = vec![round(first.clone(), exact)?];
    for _ in 0..halvings {
        let finer = uniform[uniform.len() - 1].triangles.refined();
        uniform.push(round(finer, exact)?);
    }
    let finest = &uniform[uniform.len() - 1];
    let most = finest.triangles.cell_count();
    let mut adaptive = vec![round(first, exact)?];
    loop {
        let last = &adaptive[adaptive.len() - 1];
        let cells = last.triangles.cell_count();
        if last.force_percent <= finest.force_percent || cells > most {
            break;
        }
        let marked = bulk(&last.estimate.cells, SHARE);
        let finer = last.triangles.refined_where(&marked);
        adaptive.push(round(finer, exact)?);
    }
    let last = &adaptive[adaptive.len() - 1];
    outcome.checks.push(Check::new(
        format!(
            "plate, T2: cells of local over {most} of uniform refinement, at {} % error of the force",
            number(finest.force_percent)
        ),
        "–",
        Wanted::AtMost(0.25),
        "the same error with fewer cells",
        last.triangles.cell_count() as f64 / most as f64,
    ));
    outcome.blocks.extend(rounds(&uniform, &adaptive));
    outcome.figures.extend(pictures(&uniform, &adaptive));
    Ok(())
}

fn rounds(uniform: &[Round], adaptive: &[Round]) -> Vec<Block> {
    let row = |name: &str, round: &Round| {
        vec![
            name.to_owned(),
            round.triangles.cell_count().to_string(),
            number(round.force_percent),
            number(round.estimate.percent()),
        ]
    };
    let head = [
        "T2, refinement",
        "cells",
        "error of the force [%]",
        "error of the field by recovery, energy norm [%]",
    ];
    let uniform = uniform.iter().map(|round| row("uniform", round));
    let rows = uniform.chain(adaptive.iter().map(|round| row("local", round)));
    vec![Block::table(&head, rows)]
}

fn pictures(uniform: &[Round], adaptive: &[Round]) -> [Figure; 2] {
    let line = |label: &str, rounds: &[Round], colour| Line {
        label: label.to_owned(),
        points: rounds
            .iter()
            .map(|round| [round.triangles.cell_count() as f64, round.force_percent])
            .collect(),
        colour,
        stroke: Stroke::Marked,
    };
    let chart = LineChart {
        title: "Force of the clamped plate, T2".into(),
        x: Axis::logarithmic("cells"),
        y: Axis::logarithmic("error of the force [%]"),
        lines: vec![
            line("uniform refinement", uniform, PALETTE[0]),
            line("local refinement", adaptive, PALETTE[1]),
        ],
        band: None,
    };
    let last = &adaptive[adaptive.len() - 1].triangles;
    [
        Figure::new(
            "own_error.png",
            "Error of the plate's force over the number of cells.",
            chart,
        ),
        Figure::new(
            "own_error_mesh.png",
            "The last mesh of the local refinement.",
            mesh_outlines("Refined where the estimated error is", last),
        ),
    ]
}
