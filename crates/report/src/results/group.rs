//! Groups of specimens as figures and as a picture.

use serde_json::{Value, json};

use super::chart::stress_chart;
use super::{Axis, Drawing, Line, PALETTE, Stroke};
use crate::calibration::{Fit, Group, GroupState};
use crate::document::write_records;

/// A group with its name, its states and its mean law.
pub struct NamedGroup {
    /// Its name.
    pub name: String,
    /// The group.
    pub group: Group,
    /// Its stresses.
    pub states: Vec<GroupState>,
    /// The law of its mean stresses.
    pub mean: Fit,
}

/// A table of all states, one record each: strains, mean with its interval and spread of each group, and the difference of two.
pub fn group_table(groups: &[NamedGroup]) -> String {
    let mut head: Vec<String> = ["stretch_1 [-]", "stretch_2 [-]", "axis [-]"]
        .map(str::to_owned)
        .into();
    for NamedGroup { name, .. } in groups {
        let columns = ["mean", "mean_low", "mean_high", "between"];
        head.extend(columns.map(|column| format!("{name}_{column} [MPa]")));
    }
    if groups.len() == 2 {
        let columns = ["difference", "difference_low", "difference_high"];
        head.extend(columns.map(|column| format!("{column} [MPa]")));
    }
    let rows = groups[0].states.iter().enumerate().map(|(row, state)| {
        let mut record: Vec<String> = state
            .strains
            .map(|strain| (1.0 + strain).to_string())
            .into();
        record.push((state.axis + 1).to_string());
        for group in groups {
            let stress = group.states[row].stress;
            let [low, high] = stress.estimate().interval;
            record
                .extend([stress.mean, low, high, stress.between].map(|figure| figure.to_string()));
        }
        if let [first, second] = groups {
            let difference = first.states[row]
                .stress
                .difference(&second.states[row].stress);
            let [low, high] = difference.interval;
            record.extend([difference.value, low, high].map(|value| value.to_string()));
        }
        record
    });
    write_records([head].into_iter().chain(rows))
}

/// All figures of groups.
pub fn group_json(groups: &[NamedGroup]) -> Value {
    let of_group = |group: &NamedGroup| {
        json!({
            "name": group.name,
            "law": group.mean.law.name,
            "mean_law": group.mean.parameters.iter().map(|one| json!({
                "key": one.key, "value": one.value, "unit": one.unit(),
            })).collect::<Vec<_>>(),
            "specimens": group.group.fits.iter().zip(&group.group.tests).map(|(fit, test)| json!({
                "file": test.name,
                "verdict": fit.quality.verdict.map(|verdict| verdict.answer.words()),
                "r_squared": fit.quality.r_squared,
                "parameters": fit.parameters.iter().map(|one| (one.key.to_owned(), json!(one.value))).collect::<serde_json::Map<_, _>>(),
            })).collect::<Vec<_>>(),
            "states": group.states.iter().map(|state| json!({
                "stretches": state.strains.map(|strain| 1.0 + strain),
                "axis": state.axis + 1,
                "mean_MPa": state.stress.mean,
                "interval_95_percent_MPa": state.stress.estimate().interval,
                "between_specimens_MPa": state.stress.between,
            })).collect::<Vec<_>>(),
        })
    };
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "groups": groups.iter().map(of_group).collect::<Vec<_>>(),
    })
}

/// The mean stresses along both axes of the first protocol with their 95 % bands, and dashed by how much specimens differ.
pub fn group_picture(groups: &[NamedGroup]) -> Drawing {
    let test = &groups[0].group.tests[0];
    let measure = format!("{} stress", test.stress_measure.title());
    let states = groups.iter().flat_map(|group| &group.states);
    let ends = states.flat_map(|state| state.stress.estimate().interval);
    let highest = ends.map(f64::abs).fold(0.0, f64::max);
    let count = test.axes.len();
    let charts = test.axes.iter().map(|axis| {
        let axis = *axis;
        let lines = curves(groups, axis);
        let title = match count {
            1 => format!("mean of specimens, {}", groups[0].mean.law.name),
            _ => format!("mean of specimens along axis {}, both axes alike", axis + 1),
        };
        let chart = stress_chart(title, Axis::stretch(), &measure, highest, lines);
        (chart, 380)
    });
    Drawing::Charts(charts.collect())
}

fn curves(groups: &[NamedGroup], axis: usize) -> Vec<Line> {
    let (mut bands, mut lines) = (Vec::new(), Vec::new());
    for (group, colour) in groups.iter().zip(PALETTE) {
        // The first protocol, from rest on.
        let along = group.states.iter().filter(|state| state.axis == axis);
        let protocol: Vec<&GroupState> = along.take(Group::STEPS.into()).collect();
        let curve = |value: &dyn Fn(&GroupState) -> f64| {
            // Across a planar test the sheet has no strain.
            let point = |state: &&GroupState| {
                let [along, other] = [axis, 1 - axis].map(|axis| state.strains[axis]);
                let strain = if along == 0.0 { other } else { along };
                [1.0 + strain, value(state)]
            };
            let points = protocol.iter().map(point);
            [[1.0, 0.0]].into_iter().chain(points).collect::<Vec<_>>()
        };
        let [low, high] = [0, 1].map(|end| curve(&|state| state.stress.estimate().interval[end]));
        let outline = low.into_iter().chain(high.into_iter().rev());
        bands.push(Line::new(
            format!("{}: 95 % of the mean", group.name),
            outline,
            colour,
            Stroke::Filled,
        ));
        for side in [-1.0, 1.0] {
            let name = if side > 0.0 {
                format!("{}: standard deviation", group.name)
            } else {
                String::new()
            };
            let spread = curve(&|state| state.stress.mean + side * state.stress.between);
            lines.push(Line::new(name, spread, colour, Stroke::Dashed));
        }
        let name = format!("{}, {} specimens", group.name, group.group.fits.len());
        lines.push(Line::new(
            name,
            curve(&|state| state.stress.mean),
            colour,
            Stroke::Solid,
        ));
    }
    bands.into_iter().chain(lines).collect()
}
