//! What is told about a specimen: deviations, own errors, compression.

use super::files::{figures, files};
use super::read::Measured;
use super::{Models, Solved, Specimen};
use crate::compare::area_weighted_percent;
use crate::mesh::Mesh;
use crate::output::{Block, wrinkling};
use crate::validation::{Check, Outcome, Wanted};

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

/// The worst of all load factors, in %.
struct Worst {
    displacement: f64,
    measured: f64,
    correction: f64,
    own_error: f64,
}

/// The outcome at the load factors that all models have reached.
pub fn outcome(specimen: &Specimen, models: &Models) -> Outcome {
    let lattice = &models.springs.mesh;
    let reference = &models.reference;
    let states = reference.solved.states.iter();
    let expected = states.map(|state| reference.mesh.displacement_on(&state.displacement, lattice));
    let expected: Vec<Vec<f64>> = expected.take(specimen.factors.len()).collect();
    let mut worst = Worst {
        displacement: 0.0,
        measured: 0.0,
        correction: f64::INFINITY,
        own_error: 0.0,
    };
    let steps = expected.iter().enumerate();
    let rows = steps.map(|(step, expected)| row(specimen, models, step, expected, &mut worst));
    let table = Block::Table(head(specimen), rows.collect());
    let mut blocks = vec![Block::Paragraph(introduction(specimen, models)), table];
    blocks.extend(reference.history(specimen));
    blocks.extend(compression(specimen, models).map(Block::Paragraph));
    Outcome {
        checks: checks(specimen, models, &worst),
        blocks,
        figures: figures(specimen, models, &expected),
        vtk: files(specimen, models, &expected),
        ..Outcome::default()
    }
}

/// The figures of one load factor.
fn row(
    specimen: &Specimen,
    models: &Models,
    step: usize,
    expected: &[f64],
    worst: &mut Worst,
) -> Vec<String> {
    let (lattice, reference) = (&models.springs.mesh, &models.reference);
    let measured = reference.solved.measured[step];
    let before = deviation(lattice, &models.uncorrected, step, expected, measured);
    let after = deviation(lattice, &models.corrected, step, expected, measured);
    let correction = 100.0 * (1.0 - after.displacement / before.displacement);
    worst.displacement = worst.displacement.max(after.displacement);
    worst.measured = worst.measured.max(after.measured.abs());
    worst.correction = worst.correction.min(correction);
    worst.own_error = worst.own_error.max(reference.measured_percent(step));
    let three_meshes = reference.three_meshes_percent(step);
    vec![
        specimen.factors[step].to_string(),
        format!("{:.3}", before.displacement),
        format!("{:.4}", after.displacement),
        format!("{correction:.2}"),
        format!("{:.2}", before.measured),
        format!("{:.3}", after.measured),
        format!("{measured:.5}"),
        three_meshes.map_or("–".into(), |error| format!("{error:.4}")),
        format!("{:.4}", reference.recovered_percent(step)),
        format!("{:.4}", reference.estimates[step].energy.percent()),
    ]
}

fn head(specimen: &Specimen) -> Vec<String> {
    let measured = specimen.measured();
    let what = measured.name();
    vec![
        "load factor [–]".into(),
        "mass-spring: displacement [%]".into(),
        "corrected: displacement [%]".into(),
        "correction [%]".into(),
        format!("mass-spring: {what} [%]"),
        format!("corrected: {what} [%]"),
        format!("finite elements: {what} [{}]", measured.unit()),
        "their own error, by three meshes [%]".into(),
        "their own error, by recovery [%]".into(),
        "their field's own error by recovery, energy norm [%]".into(),
    ]
}

fn introduction(specimen: &Specimen, models: &Models) -> String {
    let lattice = &models.springs.mesh;
    let whose = match specimen.measured() {
        Measured::Force => "the supports on",
        Measured::Displacement(_) => "the grip at",
    };
    format!(
        "Deviations from the finite elements ({} on {}, {}) at {} nodes of the lattice ({}). \
         Displacements in relative L2, weighted by area; the {} is that of {whose} the group `{}`.",
        models.reference.mesh.element_names(),
        models.reference.mesh.describe(),
        models.reference.kind(),
        lattice.nodes.len(),
        lattice.describe(),
        specimen.measured().name(),
        specimen.measured
    )
}

fn checks(specimen: &Specimen, models: &Models, worst: &Worst) -> Vec<Check> {
    let limits = specimen.tolerances;
    let what = specimen.measured().name();
    let by_what = models.reference.by_what();
    let check = |quantity: &str, wanted, value| {
        Check::new(quantity, "%", wanted, "the study's tolerance", value)
    };
    let mut checks = vec![
        check(
            "corrected displacement from the finite elements",
            Wanted::AtMost(limits.displacement_percent),
            worst.displacement,
        ),
        check(
            &format!("corrected {what} from the finite elements"),
            Wanted::AtMost(limits.force_percent),
            worst.measured,
        ),
        check(
            "correction of the displacement",
            Wanted::AtLeast(limits.correction_percent),
            worst.correction,
        ),
        check(
            &format!("finite elements' own error of the {what}, {by_what}"),
            Wanted::AtMost(limits.force_percent),
            worst.own_error,
        ),
    ];
    checks.extend(models.reference.goal_check(specimen));
    checks
}

/// The warning about compression in the finite elements.
fn compression(specimen: &Specimen, models: &Models) -> Option<String> {
    let states = models.reference.solved.states.iter().zip(&specimen.factors);
    let states =
        states.map(|(state, factor)| (format!("load factor {factor}"), &*state.displacement));
    wrinkling::warning(&*specimen.problem.law, &models.reference.mesh, states)
}
