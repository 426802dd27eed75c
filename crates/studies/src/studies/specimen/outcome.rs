//! The report of a specimen: statements of the study, deviations, errors of the reference, forces, warnings.

use serde_json::{Map, Value, json};

use super::files::{figures, grids, tables};
use super::forces::Balance;
use super::headline::headline;
use super::measured_fields::MeasuredFields;
use super::problem::Specimen;
use super::results::lattice::Start;
use super::results::measured::Quantity;
use super::results::models::Models;
use super::results::verdict::{Deviation, Distance, Measure, checks, deviations};
use super::{forces, history, statement};
use crate::problem::Solution;
use crate::results::{Block, Outcome, Step, Table, object, or_dash, pictures};
use crate::studies::ModelKind;
use crate::studies::findings::{Examined, findings};
use crate::units::{decimals, number};

/// The outcome of models that have reached at least one load factor, or have an equilibrium on the way to it.
pub fn outcome(specimen: &Specimen, models: &Models) -> Outcome {
    let deviations = deviations(specimen, models);
    let judged: Vec<_> = deviations.iter().flatten().copied().collect();
    let balances = forces::balances(specimen, models);
    let quantities = |(step, deviation): (usize, &Option<Deviation>)| Step {
        at: specimen.factors[step],
        models: quantities(specimen, models, step, deviation.as_ref()),
    };
    let measured = MeasuredFields::of(specimen, models);
    let mut outcome = Outcome {
        headline: headline(specimen, models),
        summary: agreement(specimen, models, &deviations),
        style: specimen.pictures.style.clone(),
        checks: checks(specimen, models, &judged),
        problem: statement::json(specimen),
        material: Some(specimen.cards().material(&specimen.outline.coarse())),
        along: specimen.along.name(),
        steps: deviations.iter().enumerate().map(quantities).collect(),
        figures: figures(specimen, models, &deviations, &measured),
        grids: grids(specimen, models),
        files: [tables(specimen, models), measured.tables()].concat(),
        findings: findings(Examined {
            specimen,
            series: &models.all_series(),
            models: Some(models),
            has_springs: specimen.models.contains(&ModelKind::MassSpring),
            is_motion: false,
        }),
        balance: forces::worst_balance(&balances),
        balances: forces::balances_json(&balances),
        times: models.times.clone(),
        ..Outcome::default()
    };
    outcome.blocks = blocks(specimen, models, &deviations, &balances, &outcome);
    outcome
}

/// The tables of the report, with the pictures of `outcome` among them.
fn blocks(
    specimen: &Specimen,
    models: &Models,
    deviations: &[Option<Deviation>],
    balances: &[Balance],
    outcome: &Outcome,
) -> Vec<Block> {
    let mut blocks = Vec::new();
    if deviations.iter().any(Option::is_some) {
        blocks.push(Block::heading("Deviation from the finite elements"));
        blocks.push(Block::Paragraph(introduction(specimen, models)));
        blocks.push(deviation_table(specimen, models, deviations));
    }
    blocks.extend(starts(specimen, models).map(Block::Paragraph));
    blocks.extend(pictures("Pictures", outcome));
    blocks.extend(forces::table(specimen, models, balances));
    blocks.extend(history::work(specimen, models));
    if models.reference.reached() > 0 {
        blocks.push(Block::heading("The finite elements' own error"));
        blocks.push(Block::Paragraph(format!(
            "{}; of the displacement at the nodes of the corrected field, by which deviations are judged, and of the field, the larger of this and \
             the error at all nodes of the finite elements.",
            models.reference.describe()
        )));
        blocks.push(reference_errors(specimen, models));
        blocks.extend(models.reference.history());
    }
    blocks.extend(history::convergence(specimen, models));
    blocks.extend(statement::blocks(specimen));
    blocks
}

/// The measures that a terminal shows with their names, and their decimals of the springs and of the corrected field.
fn measures(specimen: &Specimen, models: &Models) -> Vec<(Measure, &'static str, [usize; 2])> {
    let what = match models.reference.measured.quantity {
        Quantity::Force => "force",
        Quantity::Displacement => "group",
    };
    let mut measures = vec![
        (Measure::Displacement, "displacement", [3, 4]),
        (Measure::Departure, "departure", [2, 3]),
        (Measure::Measured, what, [2, 3]),
    ];
    if specimen.grids().is_none() {
        measures.retain(|(measure, ..)| *measure != Measure::Departure);
    }
    measures
}

/// The deviations of the load factors that have some.
fn judged<'a>(
    specimen: &'a Specimen,
    deviations: &'a [Option<Deviation>],
) -> impl Iterator<Item = (f64, &'a Deviation)> {
    let factors = specimen.factors.iter().copied();
    let pairs = factors.zip(deviations);
    pairs.filter_map(|(factor, deviation)| Some((factor, deviation.as_ref()?)))
}

/// The deviations of springs and corrected field as a table for a terminal; empty where there are none.
fn agreement(specimen: &Specimen, models: &Models, deviations: &[Option<Deviation>]) -> String {
    let along = specimen.along;
    let mut table = Table::of(judged(specimen, deviations))
        .column(along.head(), |(factor, _)| along.value(*factor));
    if table.is_empty() {
        return String::new();
    }
    for (index, kind) in CORRECTED_LAST.into_iter().enumerate() {
        for (measure, name, decimals) in measures(specimen, models) {
            let head = format!("{}: {name}", kind.style().name);
            table = table.column(head, |(_, deviation)| {
                let distance = deviation.of(kind);
                let value = distance.and_then(|distance| distance.by(measure));
                figure(value, decimals[index])
            });
        }
    }
    format!(
        "deviation from the finite elements [%]\n{}",
        table.block().plain()
    )
}

/// The models that are compared with the finite elements.
const CORRECTED_LAST: [ModelKind; 2] = [ModelKind::MassSpring, ModelKind::Corrected];

/// The figures of one load factor for machines.
fn quantities(
    specimen: &Specimen,
    models: &Models,
    step: usize,
    deviation: Option<&Deviation>,
) -> Map<String, Value> {
    let all = models.all().into_iter();
    all.map(|(kind, solution)| {
        let key = kind.style().key.to_owned();
        let Some(mut quantities) = quantities_of_model(specimen, models, solution, step) else {
            return (key, Value::Null);
        };
        quantities.extend(match kind {
            ModelKind::MassSpring => {
                deviation_json(deviation.and_then(|deviation| deviation.springs))
            }
            ModelKind::Corrected => {
                let mut corrected = deviation_json(deviation.map(|deviation| deviation.corrected));
                let correction = deviation.and_then(Deviation::correction_percent);
                corrected.insert("displacement_correction_percent".into(), json!(correction));
                let error = models.on_lattice.correction.discretisation_errors.get(step);
                corrected.insert("discretisation_mm".into(), json!(error));
                corrected
            }
            ModelKind::FiniteElement => reference_errors_json(models, step, deviation),
        });
        (key, Value::Object(quantities))
    })
    .collect()
}

/// The results of a model at one load factor; `None` where it has not reached it.
fn quantities_of_model(
    specimen: &Specimen,
    models: &Models,
    solution: &Solution,
    step: usize,
) -> Option<Map<String, Value>> {
    let measured = &models.reference.measured;
    let state = solution.states.get(step)?;
    let mut all = object(json!({
        "groups": forces::groups(specimen, solution, step),
        "energy_mJ": solution.energies[step],
        "residuals": state.convergence.residuals,
    }));
    if let Some(work) = solution.works.get(step).copied().flatten() {
        all.insert("stored_mJ".into(), json!(work.stored));
        all.insert("dissipated_mJ".into(), json!(work.dissipated));
    }
    let value = json!(measured.at(solution, step));
    if specimen.grids().is_some() {
        all.insert("force_N".into(), value.clone());
        let width = solution.mesh.mid_width(&state.displacement);
        all.insert("width_mm".into(), json!(width));
    }
    all.insert(format!("measured_{}", measured.unit()), value);
    Some(all)
}

/// The deviation of a model from the finite elements.
fn deviation_json(distance: Option<Distance>) -> Map<String, Value> {
    let mut all = object(json!({
        "displacement_percent": distance.map(|distance| distance.displacement),
        "measured_percent": distance.map(|distance| distance.measured),
        "max_difference_mm": distance.map(|distance| distance.largest),
    }));
    if let Some(departure) = distance.and_then(|distance| distance.departure()) {
        all.insert("departure_percent".into(), json!(departure));
    }
    all
}

fn reference_errors_json(
    models: &Models,
    step: usize,
    deviation: Option<&Deviation>,
) -> Map<String, Value> {
    let reference = &models.reference;
    let error = |which: usize| deviation.map(|deviation| deviation.reference_errors[which]);
    object(json!({
        "displacement_discretisation_percent": reference.displacement_percent(step),
        "departure_discretisation_percent": error(1),
        "field_discretisation_percent": reference.field_percent(step),
        "measured_discretisation_percent": reference.measured_percent(step),
        "three_meshes_percent": reference.three_meshes_percent(step),
        "recovery_percent": reference.recovered_percent(step),
        "estimated_energy_norm_percent": reference.energy_percent(step),
    }))
}

/// A figure with some decimals; a dash where there is none.
fn figure(value: Option<f64>, decimals: usize) -> String {
    or_dash(value, |value| format!("{value:.decimals$}"))
}

/// A row for every load factor and model.
fn deviation_table(
    specimen: &Specimen,
    models: &Models,
    deviations: &[Option<Deviation>],
) -> Block {
    let is_plate = specimen.grids().is_some();
    let what = models.reference.measured.name();
    let rows = judged(specimen, deviations).flat_map(|(factor, deviation)| {
        let of = move |kind| Some((factor, kind, deviation.of(kind)?, deviation));
        CORRECTED_LAST.into_iter().filter_map(of)
    });
    Table::of(rows)
        .column(specimen.along.head(), |(factor, ..)| {
            specimen.along.value(*factor)
        })
        .column("model", |(_, kind, ..)| kind.style().name.to_owned())
        .column("displacement [%]", |(.., distance, _)| {
            figure(Some(distance.displacement), 4)
        })
        .column_if(
            is_plate,
            "departure from affine [%]",
            |(.., distance, _)| figure(distance.departure(), 3),
        )
        .column("largest difference [mm]", |(.., distance, _)| {
            figure(Some(distance.largest), 4)
        })
        .column(format!("{what} [%]"), |(.., distance, _)| {
            or_dash(Some(distance.measured), |value| format!("{value:+.3}"))
        })
        .column("correction [%]", |(_, kind, _, deviation)| {
            let is_corrected = *kind == ModelKind::Corrected;
            figure(deviation.correction_percent().filter(|_| is_corrected), 2)
        })
        .block()
}

/// The estimates of the finite elements' own error at every load factor.
fn reference_errors(specimen: &Specimen, models: &Models) -> Block {
    let (along, reference) = (specimen.along, &models.reference);
    let (measured, what) = (&reference.measured, reference.measured.name());
    Table::of(0..reference.reached())
        .column(along.head(), |step| along.value(specimen.factors[*step]))
        .column(format!("{what} [{}]", measured.unit()), |step| {
            or_dash(measured.at(&reference.finest, *step), |value| {
                decimals(value, 5)
            })
        })
        .column(
            format!("error of the {what}, by three meshes [%]"),
            |step| figure(reference.three_meshes_percent(*step), 5),
        )
        .column("the same, by recovery [%]", |step| {
            figure(reference.recovered_percent(*step), 5)
        })
        .column("error of the displacement [%]", |step| {
            figure(reference.displacement_percent(*step), 5)
        })
        .column("error of the field [%]", |step| {
            figure(reference.field_percent(*step), 5)
        })
        .column("error of the field by recovery, energy norm [%]", |step| {
            figure(reference.energy_percent(*step), 4)
        })
        .block()
}

fn introduction(specimen: &Specimen, models: &Models) -> String {
    let measured = &models.reference.measured;
    let departure = if specimen.grids().is_some() {
        " The departure has the affine stretch subtracted from both fields and is the strict measure."
    } else {
        ""
    };
    format!(
        "Deviations from the finite elements ({}) at the nodes of the springs' lattice ({}) and of the corrected field ({}). Displacements are \
         relative L2 norms, weighted by area.{departure} The measured quantity is {}; its {} axis is that of the larger component or of the given \
         load. Correction is 1 − e(corrected)/e(mass-spring) of the displacement. There are as many conditions as unknowns: one field satisfies \
         them whatever the springs' field is; the springs provide the start and the multipliers.",
        models.reference.describe(),
        models.on_lattice.springs.mesh.describe(),
        models.on_lattice.corrected.mesh.describe(),
        measured.describe(),
        measured.axis_name(),
    )
}

/// A sentence on nested meshes, with the error of the corrected field that they estimate; `None` where they were not used.
fn nested(specimen: &Specimen, models: &Models) -> Option<String> {
    let errors = models.on_lattice.correction.discretisation_errors.iter();
    let (most, factor) = errors
        .zip(&specimen.factors)
        .max_by(|a, b| a.0.total_cmp(b.0))?;
    let error = if most.is_nan() {
        String::new()
    } else {
        format!(
            "; the meshes give an estimate of its discretisation error: {} mm (root mean square over the nodes) at {}, where it \
             is largest",
            number(*most),
            specimen.along.describe(*factor)
        )
    };
    Some(format!(
        "The corrected field comes from springs on a coarser mesh, corrected there and carried from mesh to mesh; the lattice's own springs serve only \
         the comparison{error}. "
    ))
}

/// The load factors at which the corrector did not begin at the springs' field.
fn starts(specimen: &Specimen, models: &Models) -> Option<String> {
    let at = |wanted: Start| {
        let starts = models
            .on_lattice
            .correction
            .starts
            .iter()
            .zip(&specimen.factors);
        let starts = starts.filter(|(start, _)| **start == wanted);
        let factors: Vec<f64> = starts.map(|(_, factor)| *factor).collect();
        (!factors.is_empty()).then(|| specimen.along.list(factors))
    };
    let (alone, steps) = (at(Start::Alone), at(Start::LoadSteps));
    let mut text = nested(specimen, models).unwrap_or_default();
    if let Some(steps) = steps {
        text += &format!(
            "At {steps} the corrector did not converge from the springs' field; it started from an equilibrium that Newton's method \
             reached from rest in load steps. "
        );
    }
    if let Some(affine) = at(Start::GridsAlone) {
        text += &format!(
            "The springs have no field at {affine}: there the affine stretch takes the place of ū. "
        );
    }
    if let Some(alone) = alone {
        text += &format!(
            "The springs have no field at {alone}. There the corrected field comes from the corrector's conditions alone, by \
             Newton's method in load steps from rest: it does not use a springs' field, and there is no correction to be measured."
        );
    }
    (!text.is_empty()).then(|| text.trim_end().to_owned())
}
