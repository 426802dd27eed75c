//! What the report says about a specimen: what the study states, deviations, own errors, forces, warnings.

use serde_json::{Map, Value, json};

use super::files::{figures, grids};
use super::headline::headline;
use super::problem::Specimen;
use super::results::lattice::{OnLattice, Start};
use super::results::models::{Models, NamedSolution};
use super::results::verdict::{Deviation, checks};
use super::warnings::warnings;
use super::{forces, statement, work};
use crate::compare::area_weighted_percent;
use crate::compare::judgement::Judgement;
use crate::problem::Solution;
use crate::results::{Block, Check, Content, Material, Outcome, Step};
use crate::units::{decimals, number};

/// The outcome of models that have reached at least one load factor, or have an equilibrium on the way to it.
pub fn outcome(specimen: &Specimen, models: &Models) -> Outcome {
    let expected = expected(models);
    let deviations = deviations(specimen, models, &expected);
    let steps = 0..models.reached();
    let rows = steps.map(|step| row(specimen, models, step, deviations[step].as_ref()));
    let table = Block::Table(head(models), rows.collect());
    let mut warnings = warnings(specimen, models);
    warnings.extend(forces::unbalanced(models));
    warnings.extend(forces::unjudged_moment(specimen, models));
    let mut blocks = vec![Block::Paragraph(introduction(models)), table];
    blocks.extend(starts(specimen, models).map(Block::Paragraph));
    blocks.extend(models.reference.history());
    blocks.extend(forces::table(specimen, models));
    blocks.extend(work::blocks(specimen, models));
    blocks.extend(statement::blocks(specimen));
    let quantities = |step: usize| Step {
        at: specimen.factors[step],
        models: quantities(specimen, models, step, deviations[step].as_ref()),
    };
    let steps = (0..specimen.factors.len()).map(quantities).collect();
    let judged: Vec<_> = deviations.iter().flatten().copied().collect();
    Outcome {
        headline: headline(specimen, models),
        style: specimen.pictures.style.clone(),
        checks: checks(specimen, models, &judged),
        problem: statement::json(specimen),
        material: Some(Material::from(&specimen.card)),
        along: "load factor",
        steps,
        blocks,
        figures: figures(specimen, models, &expected),
        grids: grids(specimen, models, &expected),
        files: vec![(
            "forces.csv".to_owned(),
            Content::Text(forces::csv(specimen, models)),
        )],
        warnings,
        balance: forces::worst_balance(models),
        balances: forces::balances(models),
        ..Outcome::default()
    }
}

/// The figures of one load factor for machines.
fn quantities(
    specimen: &Specimen,
    models: &Models,
    step: usize,
    deviation: Option<&Deviation>,
) -> Map<String, Value> {
    let reference = &models.reference;
    let measured = &reference.measured;
    let deviations = |pair: Option<[f64; 2]>| {
        json!({
            "displacement_percent": pair.map(|[displacement, _]| displacement),
            "measured_percent": pair.map(|[_, measured]| measured),
        })
    };
    let mut springs = deviations(deviation.and_then(|own| own.springs));
    let mut corrected = deviations(deviation.map(|own| own.corrected));
    corrected["displacement_correction_percent"] =
        json!(deviation.and_then(Deviation::correction_percent));
    corrected["discretisation_mm"] = json!(models.on_lattice.discretisation_errors.get(step));
    let own = |which: usize| deviation.map(|own| own.own[which]);
    let mut elements = json!({
        "displacement_discretisation_percent": own(0),
        "field_discretisation_percent": reference.field_percent(step),
        "measured_discretisation_percent": own(1),
        "three_meshes_percent": reference.three_meshes_percent(step),
        "recovery_percent": reference.recovered_percent(step),
        "estimated_energy_norm_percent": reference.energy_percent(step),
    });
    let all = [&mut springs, &mut corrected, &mut elements];
    let named = models.named().into_iter().zip(all);
    let model = |(own, quantities): (NamedSolution, &mut Value)| {
        let key = own.file.to_owned();
        let Some(groups) = forces::groups(specimen, own.solution, step) else {
            return (key, Value::Null);
        };
        quantities["groups"] = groups;
        if let Some(work) = own.solution.works.get(step).copied().flatten() {
            quantities["stored_mJ"] = json!(work.stored);
            quantities["dissipated_mJ"] = json!(work.dissipated);
        }
        let value = measured.at(own.solution, step);
        quantities[format!("measured_{}", measured.unit())] = json!(value);
        (key, quantities.take())
    };
    named.map(model).collect()
}

/// Whether the finite elements are too coarse for something that they have to judge.
pub fn is_open(specimen: &Specimen, models: &Models) -> bool {
    let deviations = deviations(specimen, models, &expected(models));
    let judged: Vec<_> = deviations.into_iter().flatten().collect();
    let checks = checks(specimen, models, &judged);
    let open = |check: &Check| matches!(check.judgement(), Judgement::CannotBeJudged { .. });
    checks.iter().any(open)
}

/// The deviations at each load factor, where there are any.
fn deviations(
    specimen: &Specimen,
    models: &Models,
    expected: &[Vec<Vec<f64>>; 2],
) -> Vec<Option<Deviation>> {
    let steps = 0..specimen.factors.len();
    steps
        .map(|step| deviation(models, step, expected.each_ref().map(|of| of.get(step))))
        .collect()
}

/// The finite elements' displacements at the nodes of springs and corrected field, at the load factors that they reach.
fn expected(models: &Models) -> [Vec<Vec<f64>>; 2] {
    let finest = &models.reference.finest;
    let OnLattice {
        uncorrected,
        corrected,
        ..
    } = &models.on_lattice;
    [&uncorrected.mesh, &corrected.mesh].map(|mesh| {
        let states = finest.states.iter();
        states
            .map(|state| finest.mesh.displacement_on(&state.displacement, mesh))
            .collect()
    })
}

/// Deviations from the expected field, where there is a corrected one.
fn deviation(
    models: &Models,
    step: usize,
    [by_springs, by_corrected]: [Option<&Vec<f64>>; 2],
) -> Option<Deviation> {
    let reference = &models.reference;
    let what = &reference.measured;
    let measured = what.at(&reference.finest, step)?;
    let none_of = what.none_of(&reference.finest, step);
    let is_none = |solved: &Solution| none_of.is_some() && what.none_of(solved, step).is_some();
    let of = |solved: &Solution, expected: &[f64]| {
        let field = &solved.states.get(step)?.displacement;
        let displacement = area_weighted_percent(&solved.mesh, field, expected);
        let value = what.at(solved, step)?;
        let deviation = match none_of {
            _ if is_none(solved) => 0.0,
            Some(all) => 100.0 * (value - measured) / all,
            None => percent(value, measured),
        };
        Some([displacement, deviation])
    };
    Some(Deviation {
        measures_none: is_none(&models.on_lattice.corrected),
        springs: of(&models.on_lattice.uncorrected, by_springs?),
        corrected: of(&models.on_lattice.corrected, by_corrected?)?,
        own: [
            reference.displacement_percent(step).unwrap_or(f64::NAN),
            reference.measured_percent(step).unwrap_or(f64::NAN),
        ],
    })
}

/// The deviation of a value from another one in % of it; two zeros do not deviate.
fn percent(value: f64, expected: f64) -> f64 {
    if value == expected {
        0.0
    } else {
        100.0 * (value / expected - 1.0)
    }
}

/// The figures of one load factor.
fn row(
    specimen: &Specimen,
    models: &Models,
    step: usize,
    deviation: Option<&Deviation>,
) -> Vec<String> {
    let reference = &models.reference;
    let text = |value: Option<f64>, digits: usize| {
        let known = value.filter(|value| !value.is_nan());
        known.map_or("–".into(), |value| format!("{value:.digits$}"))
    };
    let springs = |which: usize| deviation.and_then(|own| Some(own.springs?[which]));
    let corrected = |which: usize| deviation.map(|own| own.corrected[which]);
    vec![
        specimen.factors[step].to_string(),
        text(springs(0), 3),
        text(corrected(0), 4),
        text(deviation.and_then(Deviation::correction_percent), 2),
        text(reference.field_percent(step), 4),
        text(springs(1), 2),
        text(corrected(1), 3),
        reference
            .measured
            .at(&reference.finest, step)
            .map_or("–".into(), |value| decimals(value, 5)),
        text(reference.three_meshes_percent(step), 4),
        text(reference.recovered_percent(step), 4),
        text(reference.energy_percent(step), 4),
    ]
}

fn head(models: &Models) -> Vec<String> {
    let measured = &models.reference.measured;
    let what = measured.name();
    vec![
        "load factor [–]".into(),
        "mass-spring: displacement [%]".into(),
        "corrected: displacement [%]".into(),
        "correction [%]".into(),
        "finite elements: own error of the field, displacement [%]".into(),
        format!("mass-spring: {what} [%]"),
        format!("corrected: {what} [%]"),
        format!("finite elements: {what} [{}]", measured.unit()),
        format!("their own error of the {what}, by three meshes [%]"),
        "the same, by recovery [%]".into(),
        "their field's own error by recovery, energy norm [%]".into(),
    ]
}

fn introduction(models: &Models) -> String {
    let OnLattice {
        springs, corrected, ..
    } = &models.on_lattice;
    let measured = &models.reference.measured;
    format!(
        "Deviations from the finite elements ({}) at the nodes of the springs' lattice ({}) and of the corrected field ({}). Displacements are \
         relative L2 norms, weighted by area. They are judged by the own error of the finite elements' displacement at the nodes of the corrected \
         field; the own error of the field is the larger of this error and the error at all nodes of the finite elements. The measured quantity is \
         {}; its {} axis is that of the larger component or of the given load.",
        models.reference.describe(),
        springs.mesh.describe(),
        corrected.mesh.describe(),
        measured.describe(),
        measured.axis_name(),
    )
}

/// Nested meshes, and the error of the corrected field that they show.
fn nested(specimen: &Specimen, models: &Models) -> Option<String> {
    let errors = models.on_lattice.discretisation_errors.iter();
    let (most, factor) = errors
        .zip(&specimen.factors)
        .max_by(|a, b| a.0.total_cmp(b.0))?;
    let error = if most.is_nan() {
        String::new()
    } else {
        format!(
            "; the meshes give an estimate of its discretisation error: {} mm (root mean square over the nodes) at load factor {factor}, where it \
             is largest",
            number(*most)
        )
    };
    Some(format!(
        "The corrected field comes from springs on a coarser mesh, corrected there and carried from mesh to mesh; the lattice's own springs serve only \
         the comparison{error}. "
    ))
}

/// Where the corrector began elsewhere than at the springs' field.
fn starts(specimen: &Specimen, models: &Models) -> Option<String> {
    let at = |wanted: Start| {
        let starts = models.on_lattice.starts.iter().zip(&specimen.factors);
        let found = starts.filter(|(start, _)| **start == wanted);
        let found: Vec<_> = found.map(|(_, factor)| factor.to_string()).collect();
        found.join(", ")
    };
    let (alone, steps) = (at(Start::Alone), at(Start::LoadSteps));
    let mut text = nested(specimen, models).unwrap_or_default();
    if !steps.is_empty() {
        text += &format!(
            "At the load factors {steps} the corrector did not converge from the springs' field; it started from an equilibrium that Newton's method \
             reached from rest in load steps. "
        );
    }
    if !alone.is_empty() {
        text += &format!(
            "The springs have no equilibrium at the load factors {alone}. There the corrected field comes from the corrector's conditions alone, by \
             Newton's method in load steps from rest: it does not use a springs' field, and there is no correction to be measured."
        );
    }
    (!text.is_empty()).then(|| text.trim_end().to_owned())
}
