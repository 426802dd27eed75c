//! Files of any kind as one measurement.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use super::{Frame, Marker, Measurement, matrices, on_mesh, plausible, table};
use crate::error::{Diagnostic, Error};
use crate::mesh::Mesh;

/// How files are to be understood.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The length of the files' unit, or of a pixel, in mm, where the files do not say it.
    pub unit: Option<f64>,
    /// The array of a file of VTK or Gmsh, where it must be named.
    pub array: Option<String>,
    /// The distance of the points of a matrix in mm.
    pub grid: Option<f64>,
    /// Columns of a table that are passed over.
    pub ignored_columns: Vec<String>,
}

/// What files hold.
#[derive(Debug)]
pub struct Read {
    /// The markers.
    pub measurement: Measurement,
    /// The mesh that the field came on.
    pub mesh: Option<Mesh>,
    /// The layout of the files.
    pub layout: &'static str,
    /// What deserves attention.
    pub warnings: Vec<Diagnostic>,
}

/// A marker of a file, before markers have numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// The frame, where the file says it.
    pub frame: Option<usize>,
    pub time: Option<f64>,
    /// The point's own number, where the file has one.
    pub name: Option<u64>,
    pub place: [f64; 2],
    /// No numbers where the marker was not found.
    pub displacement: [f64; 2],
    pub standard_deviation: Option<f64>,
}

/// The rows of one file and the mesh that they came on.
pub(super) struct Rows {
    pub rows: Vec<Row>,
    pub mesh: Option<Mesh>,
    pub layout: &'static str,
    /// What deserves attention.
    pub warnings: Vec<Diagnostic>,
}

/// Reads one or several files. Several tables or fields are frames: the number at the end of a file's name is its
/// frame's, else its place in the list. Two matrices whose names end in `u` and `v` are one frame.
///
/// # Errors
/// [`Error::Input`] with the file, what is wrong and what to do.
pub fn read(files: &[PathBuf], reading: &Reading) -> Result<Read, Error> {
    let groups = matrices::pairs(files);
    let several = groups.len() > 1;
    let mut whole: Option<Rows> = None;
    for (group, number) in groups.iter().zip(frame_numbers(&groups)) {
        let mut found = match group[..] {
            [u, v] => matrices::read(u, v, reading)?,
            _ if is_table(group[0]) => table::read(group[0], reading)?,
            _ => on_mesh::read(group[0], reading)?,
        };
        if several {
            for row in &mut found.rows {
                row.frame = Some(number);
            }
        }
        match &mut whole {
            None => whole = Some(found),
            Some(whole) => append(whole, found, group[0])?,
        }
    }
    let Some(whole) = whole else {
        return Err(Error::input("no field is given", "name a file"));
    };
    let Rows {
        rows,
        mesh,
        layout,
        mut warnings,
    } = whole;
    let measurement = measurement(rows, mesh.is_some(), &mut warnings);
    plausible::check(&measurement, &mut warnings)?;
    Ok(Read {
        measurement,
        mesh,
        layout,
        warnings,
    })
}

fn is_table(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    ending.is_some_and(|ending| {
        ["csv", "txt", "dat", "tsv"]
            .iter()
            .any(|known| ending == *known)
    })
}

/// Adds the frames of one more file, which must be of the same kind.
fn append(whole: &mut Rows, found: Rows, file: &Path) -> Result<(), Error> {
    let meshes = [&whole.mesh, &found.mesh].map(|mesh| mesh.as_ref().map(|mesh| &mesh.nodes));
    let fault = match () {
        () if whole.layout != found.layout => "is of another kind than the files before it",
        () if meshes[0] != meshes[1] => "has another mesh than the files before it",
        () => {
            whole.rows.extend(found.rows);
            whole.warnings.extend(found.warnings);
            return Ok(());
        }
    };
    let hint = "give the frames of one measurement in one layout and on one mesh";
    Err(Error::input(format!("{} {fault}", file.display()), hint))
}

/// The numbers at the ends of the files' names where all have one of their own, else 1, 2, 3 …
fn frame_numbers(groups: &[Vec<&Path>]) -> Vec<usize> {
    let number = |group: &Vec<&Path>| {
        let stem = group[0].file_stem()?.to_string_lossy().into_owned();
        let stem = match group.len() {
            2 => matrices::series(&stem)?.to_owned(),
            _ => stem,
        };
        let digits = stem.trim_end_matches(|letter: char| letter.is_ascii_digit());
        stem[digits.len()..].parse().ok()
    };
    let numbers: Option<Vec<usize>> = groups.iter().map(number).collect();
    let different = |numbers: &Vec<usize>| {
        let mut sorted = numbers.clone();
        sorted.sort_unstable();
        sorted.windows(2).all(|pair| pair[0] != pair[1])
    };
    let counted = || (1..=groups.len()).collect();
    numbers.filter(different).unwrap_or_else(counted)
}

/// Gathers rows into frames; a point has the number that the files give it, else one by its place. Rows of a table that stand
/// twice, with the same place and displacement in the same frame, count once: they are one measurement, and its weight must
/// not grow by writing it down again. Rows that differ at one place are measurements of their own.
fn measurement(rows: Vec<Row>, mesh: bool, warnings: &mut Vec<Diagnostic>) -> Measurement {
    let named = rows.iter().all(|row| row.name.is_some());
    let key = |place: [f64; 2]| place.map(|x| (x + 0.0).to_bits());
    let mut by_place: HashMap<[u64; 2], usize> = HashMap::new();
    let mut frames: BTreeMap<usize, Frame> = BTreeMap::new();
    let mut seen: HashMap<(usize, [u64; 2]), Vec<[f64; 2]>> = HashMap::new();
    let mut lost: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    let (mut holes, mut twice, mut again) = (0, 0, 0);
    for row in rows {
        let next = by_place.len();
        let number = match row.name {
            Some(name) if named => name as usize,
            _ => *by_place.entry(key(row.place)).or_insert(next),
        };
        let frame_number = row.frame.unwrap_or(1);
        let frame = frames.entry(frame_number).or_default();
        frame.time = frame.time.or(row.time);
        if row.displacement.iter().any(|u| !u.is_finite()) {
            holes += 1;
            if row.place.iter().all(|x| x.is_finite()) {
                lost.insert(number, row.place);
            }
            continue;
        }
        let there = seen.entry((frame_number, key(row.place))).or_default();
        if !mesh && there.contains(&row.displacement) {
            twice += 1;
            continue;
        }
        again += usize::from(!mesh && !there.is_empty());
        there.push(row.displacement);
        frame.markers.push(Marker {
            number,
            place: row.place,
            displacement: row.displacement,
            standard_deviation: row.standard_deviation,
        });
    }
    for marker in frames.values().flat_map(|frame| &frame.markers) {
        lost.remove(&marker.number);
    }
    let mut warn = |count: usize, what: &str, hint: &str| {
        if count > 0 {
            let message = format!("{what}: {count}");
            warnings.push(Diagnostic::warning("", message).hint(hint));
        }
    };
    warn(
        holes,
        "points without a displacement",
        "they are left out; their places still count for the outline",
    );
    warn(
        twice,
        "rows that stand twice, with one place and displacement in one frame",
        "each counts once: writing a measurement down again makes it no surer",
    );
    warn(
        again,
        "markers measured again at the same place in one frame, with another displacement",
        "each counts as a measurement of its own; give one row a marker if they are not independent",
    );
    Measurement {
        frames: with_markers(frames, warnings),
        lost: lost.into_values().collect(),
    }
}

/// The frames that have markers, with a word about those that have none or are missing.
fn with_markers(frames: BTreeMap<usize, Frame>, warnings: &mut Vec<Diagnostic>) -> Vec<Frame> {
    let mut warn = |message: String, hint: &str| {
        warnings.push(Diagnostic::warning("", message).hint(hint));
    };
    let mut kept = Vec::new();
    for (number, frame) in frames {
        if frame.markers.is_empty() {
            let message = format!("the frame {number} has no displacement at all");
            warn(message, "it is left out");
        } else {
            kept.push(Frame { number, ..frame });
        }
    }
    if let Some(gaps) = missing_frames(&kept) {
        let message = format!("frames are missing: {gaps}");
        warn(message, "the others are corrected one by one");
    }
    kept
}

/// The numbers that are missing between the first and the last frame; none where frames stand at regular numbers,
/// such as every tenth of a camera.
fn missing_frames(frames: &[Frame]) -> Option<String> {
    let pairs = frames.windows(2);
    let pairs: Vec<[usize; 2]> = pairs.map(|pair| [pair[0].number, pair[1].number]).collect();
    let steps: Vec<usize> = pairs.iter().map(|[from, to]| to - from).collect();
    if steps.len() > 1 && steps.iter().all(|step| *step == steps[0]) {
        return None;
    }
    let gaps = pairs.iter().filter(|[from, to]| *to > from + 1);
    let gaps = gaps.map(|[from, to]| match to - from {
        2 => (from + 1).to_string(),
        _ => format!("{} to {}", from + 1, to - 1),
    });
    let gaps: Vec<_> = gaps.collect();
    (!gaps.is_empty()).then(|| gaps.join(", "))
}
