//! Curves to explore, the numbers of the models along the path, and the names of these and of arrays for the page.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::results::models::MODELS;
use crate::results::{Results, from_rest};

/// The numbers of a model at one step, by name, and the forces on its edges.
type Numbers = BTreeMap<String, f64>;

/// Numbers of the models along the path, forces first: for each model its steps with their numbers, and the rest that the path
/// begins with where nothing acts in it.
pub fn curves(results: &Results, shown: &[f64]) -> Vec<Value> {
    let steps = &results.outcome.steps;
    let at_steps: Vec<(f64, BTreeMap<&String, Numbers>)> = steps
        .iter()
        .map(|step| {
            let models = step.models.iter();
            (
                step.at,
                models
                    .map(|(model, value)| (model, of_model(value)))
                    .collect(),
            )
        })
        .collect();
    let mut names: Vec<&String> = Vec::new();
    for name in at_steps
        .iter()
        .flat_map(|(_, models)| models.values().flat_map(Numbers::keys))
    {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    // Sorting keeps the order of equals.
    names.sort_by_key(|name| {
        !(name.contains("force_N") || name.contains("measured") || name.starts_with(ON_EDGE))
    });
    let models: Vec<&String> = at_steps
        .first()
        .map_or(Vec::new(), |(_, models)| models.keys().copied().collect());
    let curve = |name: &&String| {
        let of_model = |model: &&String| {
            let at = |time: &f64| {
                let (_, models) = at_steps.iter().find(|(at, _)| at == time)?;
                Some([*time, *models.get(model)?.get(*name)?])
            };
            let mut points: Vec<[f64; 2]> = shown.iter().filter_map(at).collect();
            if !points.is_empty() && is_none_at_rest(results.outcome.along, name) {
                points = from_rest(points);
            }
            (points.len() > 1).then(|| (model_label(model), json!(points)))
        };
        let of_models: Map<String, Value> = models.iter().filter_map(of_model).collect();
        (!of_models.is_empty()).then(|| json!({ "label": label(name), "models": of_models }))
    };
    names.iter().filter_map(curve).collect()
}

/// Whether a number is zero before anything acts: forces, energies and the measured displacement of a path of loads.
fn is_none_at_rest(along: &str, name: &str) -> bool {
    let is_of_loads = ["stretch", "load factor"].contains(&along);
    is_of_loads && (name.ends_with("_N") || name.ends_with("_mJ") || name == "measured_mm")
}

/// Begin of the names of forces on edges.
const ON_EDGE: &str = "force_on_";

fn of_model(model: &Value) -> Numbers {
    let mut all = Numbers::new();
    for (key, value) in model.as_object().into_iter().flatten() {
        all.extend(value.as_f64().map(|number| (key.clone(), number)));
    }
    let forces = model["forces"].as_array().into_iter().flatten();
    for force in forces {
        for axis in ["x", "y"] {
            let along = force[format!("{axis}_N")]["value"].as_f64();
            if let (Some(edge), Some(value)) = (force["edge"].as_str(), along) {
                all.insert(format!("{ON_EDGE}{edge}_along_{axis}_N"), value);
            }
        }
    }
    all
}

/// `von_mises_stress_at_nodes_MPa` as people write it.
pub fn label(name: &str) -> String {
    const UNITS: [(&str, &str); 8] = [
        ("_mm_per_s", "mm/s"),
        ("_mm2_per_N", "mm²/N"),
        ("_percent", "%"),
        ("_MPa", "MPa"),
        ("_mm", "mm"),
        ("_mJ", "mJ"),
        ("_N", "N"),
        ("_s", "s"),
    ];
    let name = name.replace("_at_nodes", "");
    let matched = UNITS
        .iter()
        .find_map(|(end, unit)| Some((name.strip_suffix(end)?, format!(" [{unit}]"))));
    let (words, unit) = matched.unwrap_or((&name, String::new()));
    let words = words
        .replace('_', " ")
        .replace("mises", "Mises")
        .replace("cauchy", "Cauchy")
        .replace("green lagrange", "Green-Lagrange");
    format!("{words}{unit}")
}

/// A model as reports call it.
pub fn model_label(name: &str) -> String {
    let known = MODELS.into_iter().find(|style| style.key == name);
    known.map_or_else(|| name.replace('_', " "), |style| style.name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Outcome, Step};

    #[test]
    fn a_path_of_loads_begins_at_rest_and_a_motion_at_its_first_instant() {
        let step = |at: f64| {
            let model = json!({ "force_N": 8.0 * at, "mid_width_mm": 50.0 - at });
            let models = [("finite_element".to_owned(), model)].into_iter();
            Step {
                at,
                models: models.collect(),
            }
        };
        let of = |along: &'static str| {
            let steps = vec![step(0.5), step(1.0)];
            let outcome = Outcome {
                along,
                steps,
                ..Outcome::default()
            };
            let results = Results {
                outcome,
                kind: "plate",
                ..Results::default()
            };
            let curves = curves(&results, &[0.5, 1.0]);
            [0, 1].map(|curve| curves[curve]["models"]["finite elements"].clone())
        };
        let width = json!([[0.5, 49.5], [1.0, 49.0]]);
        let force = json!([[0.0, 0.0], [0.5, 4.0], [1.0, 8.0]]);
        assert_eq!(of("stretch"), [force, width.clone()]);
        let moving = json!([[0.5, 4.0], [1.0, 8.0]]);
        assert_eq!(of("time"), [moving, width]);
    }

    #[test]
    fn forces_on_edges_are_numbers_of_their_own() {
        let model = json!({
            "noise_mm": 0.2, "is_white": true,
            "forces": [{ "edge": "right", "x_N": { "value": 1.5 }, "y_N": { "value": null } }],
        });
        let expected = [("force_on_right_along_x_N", 1.5), ("noise_mm", 0.2)]
            .map(|(name, value)| (name.to_owned(), value));
        assert_eq!(of_model(&model), Numbers::from(expected));
    }

    #[test]
    fn names_of_arrays_are_words_with_units() {
        assert_eq!(
            label("von_mises_stress_at_nodes_MPa"),
            "von Mises stress [MPa]"
        );
        assert_eq!(label("grip_force_N"), "grip force [N]");
        assert_eq!(label("wrinkling"), "wrinkling");
        assert_eq!(
            label("difference_to_finite_elements_mm"),
            "difference to finite elements [mm]"
        );
        assert_eq!(model_label("finite_element"), "finite elements");
    }
}
