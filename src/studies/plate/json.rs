//! A report for machines.

use serde_json::{Value, json};

use crate::compare::{Deviation, SelfConvergence, StepComparison};
use crate::problem::Measures;
use crate::results::{Check, Wanted};
use crate::solve::State;
use crate::studies::plate::problem::Study;
use crate::studies::plate::results::{Results, verdict};

/// The figures of a run. Numbers and models that do not exist are `null`.
pub fn json(study: &Study, results: &Results) -> Value {
    let requirements = results.requirements(study);
    let steps = results.comparison.iter().enumerate();
    let times = results
        .times
        .iter()
        .map(|(what, seconds)| ((*what).to_owned(), json!(seconds)));
    let mut warnings: Vec<String> = study.warnings.iter().map(ToString::to_string).collect();
    warnings.extend(super::warnings::warnings(study, results));
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "study": { "name": study.name, "title": study.title, "text": study.text },
        "warnings": warnings,
        "material": {
            "card": study.card.name,
            "law": study.card.law_name,
            "text": study.card.text,
            "fit_error_percent": study.card.fit_error_percent(),
        },
        "plate": {
            "length_mm": study.problem.size[0],
            "width_mm": study.problem.size[1],
            "thickness_mm": study.problem.thickness,
            "cells": study.cells,
        },
        "reference": { "element": study.reference.element.name(), "cells": study.reference.meshes(), "grading": study.reference.grading },
        "ends": results.ends.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "balance": balance(results),
        "steps": steps.map(|(index, step)| self::step(results, index, step)).collect::<Vec<_>>(),
        "requirements": requirements.iter().map(self::requirement).collect::<Vec<_>>(),
        "passed": results.ends.is_empty() && requirements.iter().all(Check::passed),
        "verdict": verdict(&requirements),
        "times_s": times.collect::<serde_json::Map<_, _>>(),
    })
}

fn requirement(check: &Check) -> Value {
    let (limit, limit_is) = match check.wanted {
        Wanted::AtLeast(limit) => (limit, "smallest"),
        Wanted::AtMost(limit) | Wanted::Equal(limit, _) => (limit, "largest"),
    };
    let judgement = check.judgement();
    json!({
        "name": check.quantity,
        "worst_percent": check.computed,
        "own_error_percent": check.own_error,
        "limit_percent": limit,
        "limit_is": limit_is,
        "judgement": judgement.word(),
        "remark": judgement.remark(),
        "passed": judgement.passed(),
    })
}

/// The largest unbalanced force or moment of every model, over the largest one, and the largest force left at a free node
/// over that on a grip.
fn balance(results: &Results) -> Value {
    let of = |model| {
        json!({
            "grips": results.worst_balance(model).map(|(relative, _)| relative),
            "free_nodes": results.worst_residual(model),
        })
    };
    json!({ "mass_spring": of(0), "corrected": of(1), "finite_element": of(2) })
}

fn step(results: &Results, index: usize, step: &StepComparison) -> Value {
    let [springs, corrected, finest] = results.models(index);
    let measures = results.measures(index);
    let mut corrected = model(step.corrected.as_ref(), corrected.zip(measures[1]));
    if step.corrected.is_some() {
        corrected["correction_percent"] = json!(step.correction_percent(|d| d.departure_percent));
        corrected["displacement_correction_percent"] =
            json!(step.correction_percent(|d| d.displacement_percent));
    }
    json!({
        "stretch": step.stretch,
        "mass_spring": model(step.mass_spring.as_ref(), springs.zip(measures[0])),
        "corrected": corrected,
        "finite_element": finest.zip(measures[2]).map(|finest| finite_element(results, index, step, finest)),
    })
}

fn finite_element(
    results: &Results,
    index: usize,
    step: &StepComparison,
    (finest, measures): (&State, Measures),
) -> Value {
    let own = step.reference;
    let of = |value: fn(&SelfConvergence) -> f64| own.as_ref().map(value);
    let energy = results.estimates.get(index).and_then(Option::as_ref);
    json!({
        "force_N": measures.force,
        "width_mm": measures.mid_width,
        "energy_mJ": measures.energy,
        "discretisation_percent": of(|own| own.force.error_percent),
        "order": own.as_ref().and_then(|own| own.force.order),
        "extrapolated_force_N": of(|own| own.force.extrapolated),
        "extrapolated_width_mm": of(|own| own.width.extrapolated),
        "width_discretisation_percent": of(|own| own.width.error_percent),
        "width_order": own.as_ref().and_then(|own| own.width.order),
        "displacement_discretisation_percent": of(|own| own.displacement_percent),
        "departure_discretisation_percent": of(|own| own.departure_percent),
        "displacement_order": own.as_ref().and_then(|own| own.displacement_order),
        "estimated_energy_norm_percent": energy.map(|estimate| estimate.energy.percent()),
        "estimated_force_percent": results.recovered_force_percent(index),
        "own_force_percent": results.own_force_percent(index),
        "residuals": finest.convergence.residuals,
    })
}

/// A model beside the finite elements: what it has, and its deviation where they have a solution too.
fn model(deviation: Option<&Deviation>, solution: Option<(&State, Measures)>) -> Value {
    let Some((solution, measures)) = solution else {
        return Value::Null;
    };
    let of = |value: fn(&Deviation) -> f64| deviation.map(value);
    json!({
        "displacement_percent": of(|deviation| deviation.displacement_percent),
        "departure_percent": of(|deviation| deviation.departure_percent),
        "max_difference_mm": of(|deviation| deviation.max_difference),
        "force_percent": of(|deviation| deviation.force_percent),
        "width_percent": of(|deviation| deviation.width_percent),
        "nominal_stress_percent": of(|deviation| deviation.nominal_stress_percent),
        "force_N": measures.force,
        "width_mm": measures.mid_width,
        "energy_mJ": measures.energy,
        "residuals": solution.convergence.residuals,
    })
}
