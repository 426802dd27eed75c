//! The rows of files, and how they are gathered into frames of markers.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::FRAC_1_SQRT_2;
use std::path::PathBuf;

use super::frames::{Frame, Marker, MarkerSeries};
use super::outside::within;
use super::role::ChosenColumns;
use super::understood::Understood;
use crate::document::TextEncoding;
use crate::error::Diagnostic;
use crate::mesh::Mesh;
use crate::statistics::farthest;

/// How files are to be understood.
#[derive(Clone, Debug, Default)]
pub struct ReadSettings {
    /// The length of the files' unit, or of a pixel, in mm, where the files do not state it.
    pub unit: Option<f64>,
    /// The array of a file of VTK or Gmsh, where it must be named.
    pub array: Option<String>,
    /// The distance of the points of a matrix in mm.
    pub grid: Option<f64>,
    /// Columns of a table that are ignored.
    pub ignored_columns: Vec<String>,
    /// Columns of a table that the user names.
    pub columns: ChosenColumns,
    /// The encoding of tables; `None` to recognise it from their bytes.
    pub encoding: Option<TextEncoding>,
    /// Whether the y axis of tables points down; `None` for the convention of their layout.
    pub downwards: Option<bool>,
    /// Whether positions in tables are those in the frame instead of at rest; `None` for the convention of their layout.
    pub deformed: Option<bool>,
    /// The table of the positions at rest, where those of the frames are tables of positions too.
    pub rest: Option<PathBuf>,
}

/// A marker of a file, before markers have numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Row {
    /// The frame, where the file states it.
    pub frame: Option<usize>,
    pub time: Option<f64>,
    /// The point's own number, where the file has one.
    pub name: Option<u64>,
    pub position: [f64; 2],
    /// No numbers where the marker was not found.
    pub displacement: [f64; 2],
    pub standard_deviation: Option<f64>,
}

/// The rows of one file and the mesh that they came on.
#[derive(Default)]
pub(super) struct FileRows {
    pub rows: Vec<Row>,
    pub mesh: Option<Mesh>,
    pub understood: Understood,
    /// What deserves attention.
    pub warnings: Vec<Diagnostic>,
}

impl FileRows {
    /// Gathers rows into frames; a point has the number that the files give it, otherwise one by its position. Rows of a table with the same
    /// position and displacement in the same frame are one measurement, and count once: a copy carries no information. Rows with other
    /// displacements at the same position are further measurements.
    pub fn gather(self, warnings: &mut Vec<Diagnostic>) -> MarkerSeries {
        let coordinates = self.rows.iter().flat_map(|row| row.position);
        let mut gathering = Gathering {
            rounding: ROUNDING * farthest(coordinates.filter(|x| x.is_finite())).abs(),
            named: self.rows.iter().all(|row| row.name.is_some()),
            mesh: self.mesh.is_some(),
            ..Gathering::default()
        };
        self.rows.into_iter().for_each(|row| gathering.add(row));
        gathering.finish(warnings)
    }
}

/// Positions at rest that differ by less than this share of the largest coordinate are those of one marker: where the displacement was
/// subtracted from the position in the frame, they are rounded differently in every frame.
const ROUNDING: f64 = 1e-9;

/// Frames as they fill with rows.
#[derive(Default)]
struct Gathering {
    /// The distance in mm to multiples of which positions are rounded to find those of one marker.
    rounding: f64,
    /// Whether the files number all points.
    named: bool,
    /// Whether the points are nodes of a mesh.
    mesh: bool,
    by_position: HashMap<[u64; 2], usize>,
    frames: BTreeMap<usize, Frame>,
    /// The displacements at each position of each frame.
    seen: HashMap<(usize, [u64; 2]), Vec<[f64; 2]>>,
    lost: BTreeMap<usize, [f64; 2]>,
    holes: usize,
    /// Rows that repeat another one.
    duplicates: usize,
    /// Rows with another displacement at a position that was measured before.
    repetitions: usize,
}

impl Gathering {
    fn add(&mut self, row: Row) {
        // An irrational offset keeps decimal numbers off the ends of what is rounded to one multiple.
        let key = row
            .position
            .map(|x| ((x / self.rounding + FRAC_1_SQRT_2).round() + 0.0).to_bits());
        let next = self.by_position.len();
        let number = match row.name {
            Some(name) if self.named => name as usize,
            _ => *self.by_position.entry(key).or_insert(next),
        };
        let frame_number = row.frame.unwrap_or(1);
        let frame = self.frames.entry(frame_number).or_default();
        frame.time = frame.time.or(row.time);
        if row.displacement.iter().any(|u| !u.is_finite()) {
            self.holes += 1;
            if row.position.iter().all(|x| x.is_finite()) {
                self.lost.insert(number, row.position);
            }
            return;
        }
        let displacements = self.seen.entry((frame_number, key)).or_default();
        if !self.mesh && displacements.contains(&row.displacement) {
            self.duplicates += 1;
            return;
        }
        self.repetitions += usize::from(!self.mesh && !displacements.is_empty());
        displacements.push(row.displacement);
        frame.markers.push(Marker {
            number,
            position: row.position,
            displacement: row.displacement,
            standard_deviation: row.standard_deviation,
        });
    }

    fn finish(mut self, warnings: &mut Vec<Diagnostic>) -> MarkerSeries {
        for marker in self.frames.values().flat_map(|frame| &frame.markers) {
            self.lost.remove(&marker.number);
        }
        let counted = [
            (
                self.holes,
                "points without a displacement",
                "they are left out; the positions of those within the specimen still count for the outline",
            ),
            (
                self.duplicates,
                "duplicate rows, with the same position and displacement in one frame",
                "each counts once: a copy adds no information",
            ),
            (
                self.repetitions,
                "markers measured again at the same position in one frame, with another displacement",
                "each counts as a measurement of its own; give one row per marker if they are not independent",
            ),
        ];
        for (count, what, hint) in counted.into_iter().filter(|(count, ..)| *count > 0) {
            warnings.push(Diagnostic::warning("", format!("{what}: {count}")).hint(hint));
        }
        let markers = self.frames.values().flat_map(|frame| &frame.markers);
        let by_number: BTreeMap<usize, [f64; 2]> = markers
            .map(|marker| (marker.number, marker.position))
            .collect();
        let tracked: Vec<[f64; 2]> = by_number.into_values().collect();
        let all: Vec<[f64; 2]> = self.lost.into_values().collect();
        let without = all.len();
        let lost = within(&tracked, all);
        if lost.len() < without {
            let message = format!(
                "points without a displacement in any frame, assumed to lie outside the specimen: {}",
                without - lost.len()
            );
            let hint = "they leave whole rows or columns of the matrix empty, or more than a tenth of it at its rim; give the true edge with --outline";
            warnings.push(Diagnostic::warning("", message).hint(hint));
        }
        let (frames, at_rest) = with_markers(self.frames, warnings);
        MarkerSeries {
            frames,
            lost,
            at_rest,
        }
    }
}

/// Displacements below this share of the largest one of all frames are rounding.
const AT_REST: f64 = 1e-12;

/// The frames that have markers which move, and the numbers of those in which none does, with warnings of these frames, and of frames that have
/// no marker or are missing.
fn with_markers(
    frames: BTreeMap<usize, Frame>,
    warnings: &mut Vec<Diagnostic>,
) -> (Vec<Frame>, Vec<usize>) {
    let mut warn = |message: String, hint: &str| {
        warnings.push(Diagnostic::warning("", message).hint(hint));
    };
    let largest = frames.values().map(Frame::largest_displacement);
    let most = largest.fold(0.0, f64::max);
    let (mut kept, mut at_rest) = (Vec::new(), Vec::new());
    for (number, frame) in frames {
        if frame.markers.is_empty() {
            let message = format!("frame {number} has no displacement at all");
            warn(message, "it is left out");
        } else if most > 0.0 && frame.largest_displacement() <= AT_REST * most {
            let message = format!("no marker moves in frame {number}: it is the picture at rest");
            warn(message, "it is left out, with the forces in it");
            at_rest.push(number);
        } else {
            kept.push(Frame { number, ..frame });
        }
    }
    let moving = kept.iter().map(|frame| frame.number);
    let mut known: Vec<usize> = moving.chain(at_rest.iter().copied()).collect();
    known.sort_unstable();
    if let Some(gaps) = missing_frames(&known) {
        let message = format!("frames are missing: {gaps}");
        warn(message, "the others are corrected one by one");
    }
    (kept, at_rest)
}

/// The numbers that are missing between the first and the last of some frames; `None` where the numbers are regular, such as every tenth of a
/// camera.
fn missing_frames(numbers: &[usize]) -> Option<String> {
    let is_regular = |three: &[usize]| three[1] - three[0] == three[2] - three[1];
    if numbers.len() > 2 && numbers.windows(3).all(is_regular) {
        return None;
    }
    let pairs = numbers.windows(2).map(|pair| [pair[0], pair[1]]);
    let gaps = pairs.filter(|[from, to]| *to > from + 1);
    let described = gaps.map(|[from, to]| match to - from {
        2 => (from + 1).to_string(),
        _ => format!("{} to {}", from + 1, to - 1),
    });
    let missing: Vec<String> = described.collect();
    (!missing.is_empty()).then(|| missing.join(", "))
}
