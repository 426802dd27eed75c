//! The figures of a correction for machines.

use serde_json::{Map, Value, json};

use super::quantities::{largest_correction, largest_error, outliers, residual_rms, used};
use super::verdict;
use crate::estimation::{EdgeCondition, EdgeForce, FieldEstimate, Robust};
use crate::markers::{Frame, Understood};
use crate::results::{Step, object};
use crate::statistics::Estimate;
use crate::studies::markers::MarkerStudy;

/// What was corrected.
pub fn problem(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Map<String, Value> {
    object(json!({
        "layout": field.understood.layout,
        "reading": reading(&field.understood),
        "thickness_mm": field.thickness,
        "mesh": {
            "origin": field.mesh_origin,
            "nodes": field.mesh.nodes.len(),
            "cells": field.mesh.cell_count(),
        },
        "trade": estimates.first().map(|estimate| &*estimate.rule),
        "brought_onto_another_mesh": field.coarse.is_some(),
        "edge_may_lie_farther_out_by_mm": field.unknown_gap,
    }))
}

/// How the files were understood.
fn reading(understood: &Understood) -> Value {
    let columns = understood.columns.iter().map(|taken| {
        json!({
            "holds": taken.holds,
            "column": taken.head,
            "unit_mm": taken.unit,
        })
    });
    json!({
        "encoding": understood.encoding,
        "columns": columns.collect::<Vec<_>>(),
        "y_axis_turned_up": understood.turned_up,
        "places_taken_to_rest": understood.taken_to_rest,
    })
}

/// The figures of one frame.
pub fn step(field: &MarkerStudy, frame: &Frame, estimate: &FieldEstimate) -> Step {
    Step {
        at: frame.number as f64,
        models: object(json!({ "corrected": of_frame(field, frame, estimate) })),
    }
}

fn of_frame(field: &MarkerStudy, frame: &Frame, estimate: &FieldEstimate) -> Value {
    let of = |value: &Estimate| of_estimate(value, estimate.has_intervals());
    let estimated = estimate.parameters.iter();
    let parameters =
        estimated.map(|(key, unit, value)| json!({ "key": key, "unit": unit, "found": of(value) }));
    let checks = estimate.force_checks.iter().map(|check| {
        json!({
            "edge": check.measured.edge,
            "axis": (["x", "y"][check.measured.axis]),
            "measured_N": check.measured.force,
            "found_N": check.estimated,
            "standardised_difference": check.standardised,
        })
    });
    let edges = estimate.edges.iter();
    let free = edges.filter(|edge| edge.condition == EdgeCondition::Free);
    json!({
        "time": frame.time,
        "markers": used(estimate),
        "outliers": outliers(estimate),
        "weights": Robust::NAMES.iter().find(|(_, one)| *one == estimate.robust).map(|(name, _)| name),
        "noise_mm": estimate.noise,
        "noise_range_mm": estimate.noise_range,
        "noise_is_given": estimate.known_noise,
        "left_mm": residual_rms(estimate),
        "largest_left_mm": largest_correction(estimate),
        "effective_parameters": estimate.effective_parameters,
        "largest_standard_error_mm": estimate.has_intervals().then(|| largest_error(estimate)),
        "verdict": verdict::json(estimate),
        "steps": estimate.steps,
        "errors_hold_the_mesh": estimate.holds_mesh_error,
        "mesh_error_dominates_area_percent": 100.0 * estimate.coarse_share(&field.mesh),
        "forces_are_given_the_card": estimate.is_given_the_law,
        "measured_forces": checks.collect::<Vec<_>>(),
        "forces": forces(estimate),
        "parameters": parameters.collect::<Vec<_>>(),
        "free_edges": free.map(|edge| edge.edge.as_str()).collect::<Vec<_>>(),
    })
}

fn forces(estimate: &FieldEstimate) -> Vec<Value> {
    let of = |value: &Estimate| of_estimate(value, estimate.has_intervals());
    let change = |index: usize| {
        let change = estimate.scale_change.forces.get(index)?;
        Some(change.map(|change| 0.01 * change))
    };
    let force = |(index, force): (usize, &EdgeForce)| {
        json!({
            "edge": force.edge,
            "x_N": of(&force.force[0]),
            "y_N": of(&force.force[1]),
            "standard_error_by_the_card_N": estimate.law_deviations.get(index),
            "change_by_one_percent_of_the_scale_N": change(index),
        })
    };
    estimate.forces.iter().enumerate().map(force).collect()
}

/// A value with its uncertainty, which only an explained field has.
pub fn of_estimate(value: &Estimate, explained: bool) -> Value {
    json!({
        "value": value.value,
        "standard_error": explained.then_some(value.standard_error),
        "interval": explained.then_some(value.interval),
    })
}
