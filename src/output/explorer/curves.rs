//! Curves to explore: the numbers of the models along the path.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use super::labels::{label, model_label};
use crate::results::Results;

/// The numbers of a model at one step, by name: those that stand there, and the forces on edges.
type Numbers = BTreeMap<String, f64>;

/// Numbers of the models along the path, forces first.
pub fn curves(results: &Results, shown: &[f64]) -> Vec<Value> {
    let steps = &results.outcome.steps;
    let at_steps: Vec<(f64, BTreeMap<&String, Numbers>)> = steps
        .iter()
        .map(|step| {
            let models = step.models.iter();
            (
                step.at,
                models.map(|(model, own)| (model, of_model(own))).collect(),
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
        !(name.contains("force_N") || name.contains("measured") || is_on_edge(name))
    });
    let models: Vec<&String> = at_steps
        .first()
        .map_or(Vec::new(), |(_, models)| models.keys().copied().collect());
    let curve = |name: &&String| {
        let of_model = |model: &&String| {
            let at = |time: &f64| {
                let (_, models) = at_steps.iter().find(|(at, _)| at == time)?;
                models.get(model)?.get(*name).copied()
            };
            let points: Vec<Option<f64>> = shown.iter().map(at).collect();
            let known = points.iter().flatten().count();
            (known > 1).then(|| (model_label(model), json!(points)))
        };
        let of_models: Map<String, Value> = models.iter().filter_map(of_model).collect();
        (!of_models.is_empty()).then(|| json!({ "label": label(name), "models": of_models }))
    };
    names.iter().filter_map(curve).collect()
}

/// Begin of the names of forces on edges.
const ON_EDGE: &str = "force_on_";

fn is_on_edge(name: &str) -> bool {
    name.starts_with(ON_EDGE)
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_on_edges_are_numbers_of_their_own() {
        let model = json!({
            "noise_mm": 0.2, "is_white": true,
            "forces": [{ "edge": "right", "x_N": { "value": 1.5 }, "y_N": { "value": null } }],
        });
        let expected = [("force_on_right_along_x_N", 1.5), ("noise_mm", 0.2)];
        let expected = expected.map(|(name, value)| (name.to_owned(), value));
        assert_eq!(of_model(&model), Numbers::from(expected));
    }
}
