//! Fields to explore in a report: what the program in the page shows, as compact data.
//!
//! ```text
//! points      x, y at rest in mm as 32-bit floats, node after node
//! triangles   three nodes each; quadratic cells are divided at their nodes
//! steps       of every model the fields at its nodes: [low, high, 16-bit shares of that range], 65535 for what is no number
//! ```

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};

use super::picture::bar_colours;
use crate::mesh::CellShape;
use crate::results::models::MODELS;
use crate::results::{Array, Components, Grid, GridCell, GridSeries, Results};
use crate::statistics::extremes;

mod curves;

use curves::{curves, label, model_label};

/// The most bytes of all fields, before they become letters.
const MOST_BYTES: usize = 3_000_000;

/// The program of the page.
pub const PROGRAM: &str = include_str!("explorer/explorer.js");
/// What it looks like.
pub const STYLE: &str = include_str!("explorer/explorer.css");

/// What can be explored.
pub struct Explorer {
    /// For the program of the page.
    pub data: String,
    /// What was left out, for the reader.
    pub note: String,
}

impl Explorer {
    /// Of the sheets' fields along the path; `None` where there are none.
    pub fn of(results: &Results) -> Option<Self> {
        let outcome = &results.outcome;
        let series = outcome.grids.iter().chain(&outcome.explored);
        let mut models: Vec<&GridSeries> = series.filter(|series| is_sheet(series)).collect();
        let all = models.len();
        let size = |models: &[&GridSeries]| {
            models
                .iter()
                .map(|model| bytes_of_step(model))
                .sum::<usize>()
        };
        while size(&models) > MOST_BYTES && !models.is_empty() {
            let largest = (0..models.len()).max_by_key(|index| bytes_of_step(models[*index]));
            models.remove(largest.unwrap_or_default());
        }
        let mut notes = Vec::new();
        if models.len() < all {
            notes.push("Models on meshes too fine for a page are left out.".to_owned());
        }
        let times = times(&models)?;
        if models.iter().any(|model| model.grids.len() > times.len()) {
            notes.push("Of steps at one place of the path the first is here.".to_owned());
        }
        let most = (MOST_BYTES / size(&models).max(1)).max(1);
        let shown = evenly(&times, most);
        if shown.len() < times.len() {
            notes.push(format!(
                "{} of {} steps are here.",
                shown.len(),
                times.len()
            ));
        }
        if !notes.is_empty() {
            notes.push("The files in vtk/ contain all of them.".to_owned());
        }
        let data = json!({
            "along": outcome.along,
            "steps": shown.iter().map(|at| json!({ "at": at })).collect::<Vec<_>>(),
            "models": models.iter().map(|series| model(series, &shown)).collect::<Vec<_>>(),
            "fields": fields(&models[0].grids[0].grid),
            "curves": curves(results, &shown),
            "colours": { "even": colours(false), "signed": colours(true) },
            "lines": line_colours(),
        });
        Some(Self {
            // Nothing in a script may look like its end.
            data: data.to_string().replace('<', "\\u003c"),
            note: notes.join(" "),
        })
    }
}

/// The colours of the models' lines by their names.
fn line_colours() -> Map<String, Value> {
    let hexadecimal = |[r, g, b]: [u8; 3]| json!(format!("#{r:02x}{g:02x}{b:02x}"));
    let lines = MODELS.map(|style| (style.name.to_owned(), hexadecimal(style.colour)));
    lines.into_iter().collect()
}

fn colours(is_signed: bool) -> String {
    STANDARD.encode(bar_colours(is_signed).as_flattened())
}

fn is_sheet(series: &GridSeries) -> bool {
    let is_mesh = |cell: &GridCell| matches!(cell, GridCell::Mesh(_));
    let is_sheet = |grid: &Grid| !grid.cells.is_empty() && grid.cells.iter().all(is_mesh);
    let grids = &series.grids;
    !grids.is_empty()
        && grids
            .iter()
            .all(|step| step.time.is_some() && is_sheet(&step.grid))
}

fn bytes_of_step(series: &GridSeries) -> usize {
    let grid = &series.grids[0].grid;
    2 * grid.points.len() * (2 + shown_arrays(grid).count())
}

/// The places on the path at which a model has a field, from rest on; `None` where there is no model.
fn times(models: &[&GridSeries]) -> Option<Vec<f64>> {
    let all = models.iter().flat_map(|series| &series.grids);
    let mut times: Vec<f64> = all.filter_map(|grid| grid.time).collect();
    times.sort_by(|one, other| one.abs().total_cmp(&other.abs()));
    times.dedup();
    (!times.is_empty()).then_some(times)
}

/// So many of some places at most, the last one among them.
fn evenly(times: &[f64], most: usize) -> Vec<f64> {
    let every = times.len().div_ceil(most);
    let mut shown: Vec<f64> = times.iter().rev().step_by(every).copied().collect();
    shown.reverse();
    shown
}

/// The arrays that a page shows: numbers, and vectors by their length.
fn shown_arrays(grid: &Grid) -> impl Iterator<Item = &Array> {
    let arrays = grid.at_points.iter();
    arrays.filter(|array| {
        let is_field = matches!(array.components, Components::Scalar | Components::Vector);
        is_field && array.name != DISPLACEMENT
    })
}

const DISPLACEMENT: &str = "displacement_mm";

/// What can be chosen: the displacement's components first.
fn fields(grid: &Grid) -> Value {
    let displacements = [
        json!({ "name": "ux", "label": "displacement along x [mm]" }),
        json!({ "name": "uy", "label": "displacement along y [mm]" }),
    ];
    let arrays = shown_arrays(grid).map(|array| {
        let size = match array.components {
            Components::Vector => "size of ",
            _ => "",
        };
        json!({ "name": array.name, "label": format!("{size}{}", label(array.name)) })
    });
    displacements.into_iter().chain(arrays).collect()
}

fn model(series: &GridSeries, shown: &[f64]) -> Value {
    let grid = &series.grids[0].grid;
    let xy = grid.points.iter().flatten();
    let points: Vec<u8> = xy.flat_map(|at| (*at as f32).to_le_bytes()).collect();
    let triangles: Vec<u8> = triangles(grid).flat_map(u32::to_le_bytes).collect();
    let at = |time: &f64| series.grids.iter().find(|step| step.time == Some(*time));
    let steps = shown
        .iter()
        .map(|time| at(time).map(|step| values(&step.grid)));
    json!({
        "name": series.name,
        "label": model_label(&series.name),
        "points": STANDARD.encode(points),
        "triangles": STANDARD.encode(triangles),
        "steps": steps.collect::<Vec<_>>(),
    })
}

fn values(grid: &Grid) -> Value {
    let mut all = Map::new();
    let displacement = grid
        .at_points
        .iter()
        .find(|array| array.name == DISPLACEMENT);
    for (name, axis) in [("ux", 0), ("uy", 1)] {
        let along = displacement
            .into_iter()
            .flat_map(|array| array.values.chunks_exact(2));
        all.insert(name.into(), packed(along.map(|u| u[axis]).collect()));
    }
    for array in shown_arrays(grid) {
        let each = array.values.chunks_exact(array.components.count());
        let sizes = each.map(|components| match components {
            [x, y] => x.hypot(*y),
            components => components[0],
        });
        all.insert(array.name.into(), packed(sizes.collect()));
    }
    Value::Object(all)
}

/// Numbers as 16-bit shares of their range.
fn packed(values: Vec<f64>) -> Value {
    const WHOLE: f64 = 65534.0;
    let known = values.iter().copied().filter(|value| value.is_finite());
    let [low, high] = extremes(known);
    if low > high {
        return Value::Null;
    }
    let share = |value: f64| {
        if !value.is_finite() {
            u16::MAX
        } else if high > low {
            (WHOLE * ((value - low) / (high - low))).round() as u16
        } else {
            0
        }
    };
    let bytes: Vec<u8> = values
        .into_iter()
        .flat_map(|value| share(value).to_le_bytes())
        .collect();
    json!([low, high, STANDARD.encode(bytes)])
}

/// The nodes of triangles that fill the cells.
fn triangles(grid: &Grid) -> impl Iterator<Item = u32> {
    let mut first = 0;
    let middle = middle(grid.points.iter().copied());
    grid.cells.iter().flat_map(move |cell| {
        let nodes = &grid.connectivity[first..first + cell.points()];
        first += cell.points();
        let pieces = match cell {
            GridCell::Mesh(CellShape::Quad4) if turned(grid, nodes, middle) => &TURNED,
            _ => parts(*cell),
        };
        pieces.iter().flatten().map(|local| nodes[*local] as u32)
    })
}

/// A quadrilateral's triangles by its other diagonal.
const TURNED: [[usize; 3]; 2] = [[0, 1, 3], [1, 2, 3]];

/// The middle of the box around points.
fn middle(points: impl Iterator<Item = [f64; 2]> + Clone) -> [f64; 2] {
    [0, 1].map(|axis| {
        let [low, high] = extremes(points.clone().map(|point| point[axis]));
        0.5 * (low + high)
    })
}

/// Whether a quadrilateral is cut by its other diagonal: what lies left of the middle as what lies right of it, mirrored, and likewise above
/// and below.
fn turned(grid: &Grid, nodes: &[usize], of_all: [f64; 2]) -> bool {
    let centre = middle(nodes.iter().map(|node| grid.points[*node]));
    (centre[0] - of_all[0]) * (centre[1] - of_all[1]) < 0.0
}

/// Triangles of a cell's own nodes: corners, then middles of the sides, then the centre.
fn parts(cell: GridCell) -> &'static [[usize; 3]] {
    let GridCell::Mesh(shape) = cell else {
        return &[];
    };
    match shape {
        CellShape::Triangle3 => &[[0, 1, 2]],
        CellShape::Triangle6 => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
        CellShape::Quad4 => &[[0, 1, 2], [0, 2, 3]],
        CellShape::Quad8 => &[
            [0, 4, 7],
            [4, 1, 5],
            [5, 2, 6],
            [6, 3, 7],
            [4, 5, 7],
            [5, 6, 7],
        ],
        CellShape::Quad9 => &[
            [0, 4, 8],
            [0, 8, 7],
            // All through the centre: a symmetric field is drawn as one.
            [4, 1, 8],
            [1, 5, 8],
            [8, 5, 2],
            [8, 2, 6],
            [3, 8, 6],
            [3, 7, 8],
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_packed_within_a_65534th_of_their_range() {
        let packed = packed(vec![-1.0, 2.0, f64::NAN, 0.5]);
        let bytes = STANDARD.decode(packed[2].as_str().unwrap()).unwrap();
        let shares = bytes
            .chunks_exact(2)
            .map(|two| u16::from_le_bytes([two[0], two[1]]));
        assert_eq!(shares.collect::<Vec<_>>(), [0, 65534, 65535, 32767]);
        assert_eq!((&packed[0], &packed[1]), (&json!(-1.0), &json!(2.0)));
    }

    #[test]
    fn too_many_places_are_thinned_and_the_last_one_stays() {
        assert_eq!(evenly(&[1.0, 2.0, 3.0, 4.0, 5.0], 2), [2.0, 5.0]);
        assert_eq!(evenly(&[1.0, 2.0], 9), [1.0, 2.0]);
    }

    #[test]
    fn the_parts_of_a_cell_fill_it() {
        for (name, shape) in CellShape::NAMES {
            let at = shape.natural_nodes();
            let area = |[a, b, c]: &[usize; 3]| {
                let [a, b, c] = [at[*a], at[*b], at[*c]];
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            };
            let areas: Vec<f64> = parts(GridCell::Mesh(shape)).iter().map(area).collect();
            let total = if shape.is_triangle() { 0.5 } else { 4.0 };
            assert!(areas.iter().all(|size| *size > 0.0), "{name}");
            assert!((areas.iter().sum::<f64>() - total).abs() < 1e-12, "{name}");
        }
    }
}
