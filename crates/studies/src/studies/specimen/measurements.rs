//! What a study measures within its sheet: fields at points, fields along lines, virtual extensometers.

use super::problem::Outline;
use crate::document::Section;
use crate::mesh::Mesh;
use crate::studies::points::{Probe, Region, named_tables, read_point, read_probes};

/// Measurements within a sheet, by points at rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Points where all fields are read at every state.
    pub probes: Vec<Probe>,
    /// Lines along which all fields are read.
    pub lines: Vec<LineCut>,
    /// Pairs of points whose distance is read at every state.
    pub extensometers: Vec<Extensometer>,
}

/// A straight line across a sheet at rest, all places in mm.
#[derive(Clone, Debug, PartialEq)]
pub struct LineCut {
    /// Its name.
    pub name: String,
    /// Its first point.
    pub from: [f64; 2],
    /// Its last point.
    pub to: [f64; 2],
    /// How many points it has, evenly apart.
    pub count: usize,
}

/// Two points of a sheet at rest, in mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Extensometer {
    /// Its name.
    pub name: String,
    /// Its ends.
    pub ends: [[f64; 2]; 2],
}

impl LineCut {
    /// Its points.
    pub fn points(&self) -> Vec<[f64; 2]> {
        let last = (self.count - 1) as f64;
        let point = |index: usize| {
            let share = index as f64 / last;
            [0, 1].map(|axis| self.from[axis] + share * (self.to[axis] - self.from[axis]))
        };
        (0..self.count).map(point).collect()
    }

    /// How far a point of it is from the first one in mm.
    pub fn distance(&self, [x, y]: [f64; 2]) -> f64 {
        (x - self.from[0]).hypot(y - self.from[1])
    }
}

impl Extensometer {
    /// The distance of its ends at rest, and with displacements of a mesh, in mm.
    pub fn lengths(&self, mesh: &Mesh, displacement: &[f64]) -> [f64; 2] {
        let [a, b] = self.ends;
        let [ua, ub] = self.ends.map(|end| mesh.displacement_at(displacement, end));
        let apart = [0, 1].map(|axis| b[axis] - a[axis]);
        let now = [0, 1].map(|axis| apart[axis] + ub[axis] - ua[axis]);
        [apart, now].map(|[x, y]| x.hypot(y))
    }
}

/// Reads `[[probe]]`, `[[line]]` and `[[extensometer]]` of a sheet, which has no outline where it could not be read.
pub fn read(root: &Section, outline: Option<&Outline>) -> Measurements {
    let wanted = ["probe", "line", "extensometer"];
    let outline = outline.filter(|_| wanted.iter().any(|key| root.has(key)));
    let region = outline.map(|outline| (outline.lattice(), outline.bounding_box()));
    let region = region.as_ref();
    Measurements {
        probes: read_probes(root, region),
        lines: named_tables(root, "line", |section, name| {
            read_line(section, name, region)
        }),
        extensometers: named_tables(root, "extensometer", |section, name| {
            read_extensometer(section, name, region)
        }),
    }
}

fn read_line(section: &Section, name: String, region: Option<&Region>) -> LineCut {
    const USUAL: usize = 101;
    let line = LineCut {
        name,
        from: read_point(section, "from", None),
        to: read_point(section, "to", None),
        count: if section.has("points") {
            section.count("points", 2, 10_000)
        } else {
            USUAL
        },
    };
    let is_on_sheet = |point: &[f64; 2]| region.is_none_or(|(mesh, _)| mesh.outside(*point) == 0.0);
    let is_known = line.from.iter().chain(&line.to).all(|x| x.is_finite());
    if is_known && !line.points().iter().any(is_on_sheet) {
        let hint = "the ends are points at rest; the line may begin and end outside of the sheet";
        section.fault("to", "ends a line that does not meet the sheet", hint);
    }
    line
}

fn read_extensometer(section: &Section, name: String, region: Option<&Region>) -> Extensometer {
    let ends = ["from", "to"].map(|key| read_point(section, key, region));
    if ends[0] == ends[1] {
        let hint = "give two different points at rest";
        section.fault("to", "is the point `from`", hint);
    }
    Extensometer { name, ends }
}
