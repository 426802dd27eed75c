//! A report for machines.

use serde_json::{Value, json};

use crate::compare::{Deviation, StepComparison};
use crate::problem::Solution;
use crate::results::Results;
use crate::study::Study;

/// The figures of a run. Numbers that do not exist are `null`.
pub fn json(study: &Study, results: &Results) -> Value {
    let requirements = results.requirements(&study.tolerances);
    let steps = results.comparison.iter().enumerate();
    let times = results
        .times
        .iter()
        .map(|(what, seconds)| ((*what).to_owned(), json!(seconds)));
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "study": { "name": study.name, "title": study.title, "text": study.text },
        "warnings": study.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "material": {
            "card": study.card.name,
            "law": study.card.law_name,
            "text": study.card.text,
            "fit_error_percent": study.card.fit_error_percent(),
        },
        "reference": { "element": study.element.name(), "cells": study.reference_meshes(), "grading": study.grading },
        "steps": steps.map(|(index, step)| self::step(results, index, step)).collect::<Vec<_>>(),
        "requirements": requirements.iter().map(|requirement| json!({
            "name": requirement.name,
            "worst_percent": requirement.worst,
            "limit_percent": requirement.limit,
            "limit_is": if requirement.at_most { "largest" } else { "smallest" },
            "passed": requirement.passed,
        })).collect::<Vec<_>>(),
        "passed": requirements.iter().all(|requirement| requirement.passed),
        "times_s": times.collect::<serde_json::Map<_, _>>(),
    })
}

fn step(results: &Results, index: usize, step: &StepComparison) -> Value {
    let own = &step.reference;
    let finest = &results.finest().solutions[index];
    let mut corrected = model(&step.corrected, &results.corrected[index].solution);
    corrected["correction_percent"] = json!(step.correction_percent(|d| d.departure_percent));
    corrected["displacement_correction_percent"] =
        json!(step.correction_percent(|d| d.displacement_percent));
    json!({
        "stretch": step.stretch,
        "mass_spring": model(&step.mass_spring, &results.uncorrected[index]),
        "corrected": corrected,
        "finite_element": {
            "force_N": finest.force,
            "width_mm": finest.mid_width,
            "energy_mJ": finest.energy,
            "discretisation_percent": own.force.error_percent,
            "order": own.force.order,
            "extrapolated_force_N": own.force.extrapolated,
            "extrapolated_width_mm": own.width.extrapolated,
            "width_discretisation_percent": own.width.error_percent,
            "width_order": own.width.order,
            "displacement_discretisation_percent": own.displacement_percent,
            "displacement_order": own.displacement_order,
            "estimated_energy_norm_percent": results.estimates[index].energy.percent(),
            "estimated_force_percent": results.estimated_force_percent(index),
            "residuals": finest.convergence.residuals,
        },
    })
}

fn model(deviation: &Deviation, solution: &Solution) -> Value {
    json!({
        "displacement_percent": deviation.displacement_percent,
        "departure_percent": deviation.departure_percent,
        "max_difference_mm": deviation.max_difference,
        "force_percent": deviation.force_percent,
        "width_percent": deviation.width_percent,
        "nominal_stress_percent": deviation.nominal_stress_percent,
        "force_N": solution.force,
        "width_mm": solution.mid_width,
        "energy_mJ": solution.energy,
        "residuals": solution.convergence.residuals,
    })
}
