//! Displacement fields of other programs on their own meshes.

use std::path::Path;

use super::{Raw, frd, read_text, vtk};
use crate::mesh::Mesh;
use crate::units::{self, Dimension};

/// A displacement field and its mesh.
#[derive(Clone, Debug)]
pub struct ImportedField {
    /// The mesh.
    pub mesh: Mesh,
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// What of the file it is: the array, or the time of the step.
    pub part: String,
}

/// The time of a step may differ by so much of it from the one that is wanted.
const NEAR: f64 = 1e-4;

/// Reads a field from VTK (`.vtu`, `.vtk`) or CalculiX (`.frd`); `unit` is the length of the file's unit in mm. Of
/// VTK's arrays the one of the name `array` is taken; without a name the displacement, or the only vector. A unit at
/// the end of an array's name is that of its values. Of CalculiX' steps the one with the time `time` is taken.
///
/// # Errors
/// Says what the file holds that cannot be read, or what is wrong with it.
pub fn import_field(
    path: &Path,
    unit: f64,
    array: Option<&str>,
    time: f64,
) -> Result<ImportedField, String> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("vtu" | "vtk") => {
            let (raw, arrays) = vtk::read_with_arrays(path)?;
            let (name, values) = choose(arrays, array)?;
            let components = values.len() / raw.places.len().max(1);
            let at = |node: u64| {
                let start = components * node as usize;
                Some([*values.get(start)?, *values.get(start + 1)?])
            };
            let own = unit_of(&name).unwrap_or(unit);
            field(raw, unit, own, format!("the array `{name}`"), &at)
        }
        Some("frd") => {
            let results = frd::read(&read_text(path)?)?;
            let times: Vec<f64> = results.steps.iter().map(|(time, _)| *time).collect();
            let near = |known: &f64| (known - time).abs() <= NEAR * time;
            let step = times.iter().rposition(near).ok_or_else(|| {
                let known: Vec<_> = times.iter().map(ToString::to_string).collect();
                let known = known.join(", ");
                format!("has no step at the time {time}; it has {known}: choose one with --time")
            })?;
            let (time, displacements) = &results.steps[step];
            let at = |node: u64| displacements.get(&node).copied();
            field(
                results.raw,
                unit,
                unit,
                format!("the step at the time {time}"),
                &at,
            )
        }
        _ => Err("is no .vtu, .vtk, .frd or .csv file".into()),
    }
}

fn field(
    raw: Raw,
    unit: f64,
    unit_of_values: f64,
    part: String,
    at: &dyn Fn(u64) -> Option<[f64; 2]>,
) -> Result<ImportedField, String> {
    let mut displacement = Vec::new();
    for node in raw.used() {
        let values = at(node).ok_or_else(|| format!("has no displacement of the node {node}"))?;
        if values.iter().any(|value| !value.is_finite()) {
            return Err(format!(
                "has a displacement of the node {node} that is no number"
            ));
        }
        displacement.extend(values.map(|value| unit_of_values * value));
    }
    Ok(ImportedField {
        mesh: raw.mesh(unit)?,
        displacement,
        part,
    })
}

/// The array of a name; without one the displacement among arrays of vectors, or the only one.
fn choose(mut arrays: vtk::Arrays, wanted: Option<&str>) -> Result<(String, Vec<f64>), String> {
    let names: Vec<String> = arrays.iter().map(|(name, _)| name.clone()).collect();
    if names.is_empty() {
        return Err("holds no vectors at its points, and so no displacement".into());
    }
    let is_displacement = |name: &String| {
        let plain = name.to_lowercase();
        plain == "u" || plain.starts_with("disp") || plain.starts_with("u_")
    };
    let found = match wanted {
        Some(wanted) => names.iter().position(|name| name == wanted),
        None if names.len() == 1 => Some(0),
        None => {
            let likely = (0..names.len()).filter(|place| is_displacement(&names[*place]));
            let likely: Vec<usize> = likely.collect();
            <[usize; 1]>::try_from(likely).ok().map(|[place]| place)
        }
    };
    let place = found.ok_or_else(|| {
        let what = wanted.map_or("array that is surely the displacement".to_owned(), |name| {
            format!("array `{name}` of vectors")
        });
        format!(
            "has no {what}; choose one of its arrays with --array: {}",
            names.join(", ")
        )
    })?;
    Ok(arrays.swap_remove(place))
}

/// The length of the unit at the end of an array's name in mm, as in `displacement_mm`.
fn unit_of(name: &str) -> Option<f64> {
    let (_, unit) = name.rsplit_once(['_', '[', '(', ' '])?;
    let unit = unit.trim_end_matches([']', ')']);
    units::parse(&format!("1 {unit}"), Dimension::Length).ok()
}
