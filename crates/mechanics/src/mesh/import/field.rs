//! Displacement fields of other programs on their own meshes.

use std::collections::BTreeSet;
use std::path::Path;

use super::raw::{ImportFault, Raw, Step, read_text};
use super::{frd, gmsh, pvd, vtk};
use crate::mesh::cells::Mesh;
use crate::units::{self, Dimension};

/// A displacement field and its mesh.
#[derive(Clone, Debug)]
pub struct ImportedField {
    /// The mesh.
    pub mesh: Mesh,
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// The part of the file: the array, or the time of the step.
    pub part: String,
}

/// The displacement fields of a file on its mesh.
#[derive(Clone, Debug)]
pub struct ImportedSeries {
    /// The mesh.
    pub mesh: Mesh,
    /// The fields in the order of the file.
    pub steps: Vec<ImportedStep>,
    /// The part of the file.
    pub part: String,
}

/// One field of a series.
#[derive(Clone, Debug)]
pub struct ImportedStep {
    /// Its time, where the file states it.
    pub time: Option<f64>,
    /// ux, uy of node after node in mm; NaN at nodes without a displacement.
    pub displacement: Vec<f64>,
    /// The first node without a displacement, and why.
    pub hole: Option<String>,
}

/// The largest relative difference of a step's time from the wanted one.
const NEAR: f64 = 1e-4;

/// Reads a field from VTK (`.vtu`, `.vtk`, `.pvd`), CalculiX (`.frd`) or Gmsh (`.msh` with `$NodeData`); `unit` is
/// the length of the file's unit in mm. In VTK and Gmsh files the array with the name `array` is read; without a name
/// the displacement, or the only vector. A unit at the end of an array's name is that of its values. Among several
/// steps the one with the time `time` is read.
///
/// # Errors
/// An [`ImportFault`].
pub fn import_field(
    path: &Path,
    unit: f64,
    array: Option<&str>,
    time: f64,
) -> Result<ImportedField, ImportFault> {
    let ImportedSeries {
        mesh,
        mut steps,
        part,
    } = import_series(path, unit, array)?;
    let near = |step: &ImportedStep| {
        step.time
            .is_some_and(|known| (known - time).abs() <= NEAR * time.abs())
    };
    let timeless = |step: &ImportedStep| step.time.is_none();
    let chosen = steps.iter().rposition(near).or_else(|| {
        let only = steps.len() == 1;
        steps.iter().position(|step| only && timeless(step))
    });
    let Some(chosen) = chosen else {
        let known = steps.iter().filter_map(|step| step.time);
        let known: Vec<_> = known.map(|time| time.to_string()).collect();
        let known = known.join(", ");
        let remedy =
            "choose one of these with --factor, or with --time if they are not load factors";
        return Err(ImportFault {
            reason: format!("has no step at the time {time}; it has {known}"),
            remedy: Some(remedy.to_owned()),
        });
    };
    let step = steps.swap_remove(chosen);
    if let Some(reason) = step.hole {
        return Err(reason.into());
    }
    Ok(ImportedField {
        mesh,
        displacement: step.displacement,
        part: match step.time {
            Some(time) => format!("the step at the time {time}"),
            None => part,
        },
    })
}

/// Reads all steps of a file, see [`import_field`].
///
/// # Errors
/// An [`ImportFault`].
pub fn import_series(
    path: &Path,
    unit: f64,
    array: Option<&str>,
) -> Result<ImportedSeries, ImportFault> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("vtu" | "vtk") => {
            let (raw, arrays) = vtk::read_with_arrays(path)?;
            let (name, values) = choose(arrays, array)?;
            let components = values.len() / raw.positions.len().max(1);
            let pairs = values.chunks_exact(components.max(1)).zip(0..);
            let displacements = pairs.map(|(u, node)| (node, [u[0], u[1]])).collect();
            let steps = vec![(None, displacements)];
            series(raw, unit, &steps, &name)
        }
        Some("msh") => {
            let text = read_text(path)?;
            let (name, views) = choose(gmsh::views(&text)?, array)?;
            series(gmsh::read(&text)?, unit, &views, &name)
        }
        Some("frd") => {
            let results = frd::read(&read_text(path)?)?;
            let steps = results.steps.into_iter();
            let steps: Vec<_> = steps.map(|(time, field)| (Some(time), field)).collect();
            series(results.raw, unit, &steps, "DISP")
        }
        Some("pvd") => collection(path, unit, array),
        _ => Err("is not a .vtu, .vtk, .pvd, .msh, .frd or .csv file".into()),
    }
}

/// The files of a collection as the steps of one series; they must have one mesh.
fn collection(path: &Path, unit: f64, array: Option<&str>) -> Result<ImportedSeries, ImportFault> {
    let mut combined: Option<ImportedSeries> = None;
    for (time, file) in pvd::read(&read_text(path)?)? {
        let name = file.clone();
        let file = path.parent().unwrap_or(Path::new("")).join(file);
        if file
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("pvd"))
        {
            return Err(format!("names the collection {name} as one of its files").into());
        }
        let mut part = import_series(&file, unit, array)
            .map_err(|reason| format!("names {name}, which {reason}"))?;
        for step in &mut part.steps {
            step.time = Some(time);
        }
        match &mut combined {
            None => combined = Some(part),
            Some(combined) if combined.mesh.nodes == part.mesh.nodes => {
                combined.steps.extend(part.steps)
            }
            Some(_) => {
                return Err(
                    format!("names {name}, which has another mesh than the first file").into(),
                );
            }
        }
    }
    combined.ok_or_else(|| "names no files".into())
}

fn series(raw: Raw, unit: f64, fields: &[Step], name: &str) -> Result<ImportedSeries, ImportFault> {
    let used: BTreeSet<u64> = raw.used();
    let unit_of_values = unit_of(name).unwrap_or(unit);
    let step = |(time, field): &Step| {
        let (mut displacement, mut hole) = (Vec::new(), None);
        for node in &used {
            let values = field.get(node).copied();
            let finite = values.filter(|values| values.iter().all(|value| value.is_finite()));
            if finite.is_none() {
                hole.get_or_insert(match values {
                    None => format!("has no displacement of the node {node}"),
                    Some(_) => {
                        format!("has a displacement of the node {node} that is not a number")
                    }
                });
            }
            displacement.extend(finite.map_or([f64::NAN; 2], |u| u.map(|u| unit_of_values * u)));
        }
        ImportedStep {
            time: *time,
            displacement,
            hole,
        }
    };
    let steps = fields.iter().map(step).collect();
    let mesh = raw.mesh(unit)?;
    if let Some(fault) = mesh.cells_without_sense().first() {
        return Err(format!("is faulty: {}", fault.message).into());
    }
    Ok(ImportedSeries {
        mesh,
        steps,
        part: format!("the array `{name}`"),
    })
}

/// The array with a name; without one the displacement among arrays of vectors, or the only one.
fn choose<T>(
    mut arrays: Vec<(String, T)>,
    wanted: Option<&str>,
) -> Result<(String, T), ImportFault> {
    let names: Vec<String> = arrays.iter().map(|(name, _)| name.clone()).collect();
    if names.is_empty() {
        return Err("contains no vectors at its points, and so no displacement".into());
    }
    let is_displacement = |name: &String| {
        let plain = name.to_lowercase();
        plain == "u" || plain.starts_with("disp") || plain.starts_with("u_")
    };
    let chosen = match wanted {
        Some(wanted) => names.iter().position(|name| name == wanted),
        None if names.len() == 1 => Some(0),
        None => {
            let likely = (0..names.len()).filter(|position| is_displacement(&names[*position]));
            let likely: Vec<usize> = likely.collect();
            <[usize; 1]>::try_from(likely)
                .ok()
                .map(|[position]| position)
        }
    };
    let position = chosen.ok_or_else(|| {
        let what = wanted.map_or("array that is surely the displacement".to_owned(), |name| {
            format!("array `{name}` of vectors")
        });
        format!(
            "has no {what}; choose one of its arrays with --array: {}",
            names.join(", ")
        )
    })?;
    Ok(arrays.swap_remove(position))
}

/// The length of the unit at the end of an array's name in mm, as in `displacement_mm`.
fn unit_of(name: &str) -> Option<f64> {
    let (_, unit) = name.rsplit_once(['_', '[', '(', ' '])?;
    let unit = unit.trim_end_matches([']', ')']);
    units::factor(unit, Dimension::Length).ok()
}
