//! The figures of a plate for machines. Numbers and models that do not exist are `null`.

use serde_json::{Map, Value, json};

use crate::compare::{Deviation, SelfConvergence, StepComparison};
use crate::problem::Measures;
use crate::results::Step;
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::solve::State;
use crate::studies::plate::problem::Study;
use crate::studies::plate::results::Results;

/// What is solved.
pub fn problem(study: &Study) -> Map<String, Value> {
    let all = json!({
        "length_mm": study.problem.size[0],
        "width_mm": study.problem.size[1],
        "thickness_mm": study.problem.thickness,
        "cells": study.cells,
        "corrector": { "grading": study.corrector.grading },
        "reference": { "element": study.reference.element.name(), "cells": study.reference.meshes(), "grading": study.reference.grading },
    });
    all.as_object().cloned().unwrap_or_default()
}

/// The names of the models, in the order of [`super::results::MODELS`].
const KEYS: [&str; 3] = [MASS_SPRING.key, CORRECTED.key, FINITE_ELEMENTS.key];

/// The largest unbalanced force or moment of every model, over the largest one, and the largest force left at a free node
/// over that on a grip.
pub fn balances(results: &Results) -> Map<String, Value> {
    let of = |(model, key): (usize, &str)| {
        let value = json!({
            "unbalanced": results.worst_balance(model).map(|(relative, _)| relative),
            "free_nodes": results.worst_residual(model),
        });
        (key.to_owned(), value)
    };
    KEYS.into_iter().enumerate().map(of).collect()
}

/// The quantities of all models at every stretch.
pub fn steps(results: &Results) -> Vec<Step> {
    let steps = results.comparison.iter().enumerate();
    steps
        .map(|(index, step)| self::step(results, index, step))
        .collect()
}

fn step(results: &Results, index: usize, step: &StepComparison) -> Step {
    let [springs, corrected, finest] = results.models(index);
    let measures = results.measures(index);
    let mut corrected = model(step.corrected.as_ref(), corrected.zip(measures[1]));
    if step.corrected.is_some() {
        corrected["correction_percent"] = json!(step.correction_percent(|d| d.departure_percent));
        corrected["displacement_correction_percent"] =
            json!(step.correction_percent(|d| d.displacement_percent));
    }
    let springs = model(step.mass_spring.as_ref(), springs.zip(measures[0]));
    let finest = finest.zip(measures[2]);
    let finest = finest.map(|finest| finite_element(results, index, step, finest));
    let mut models = [springs, corrected, json!(finest)];
    for (model, work) in models.iter_mut().zip(results.works(index)) {
        if let (Some(work), false) = (work, model.is_null()) {
            model["stored_mJ"] = json!(work.stored);
            model["dissipated_mJ"] = json!(work.dissipated);
        }
    }
    Step {
        at: step.stretch,
        models: KEYS.map(str::to_owned).into_iter().zip(models).collect(),
    }
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

/// A model compared with the finite elements: what it has, and its deviation where they have a solution too.
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
