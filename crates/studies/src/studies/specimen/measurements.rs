//! Measurements within a sheet: fields at points, fields along lines, virtual extensometers.

use crate::mesh::Mesh;
use crate::studies::points::Probe;

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

/// A straight line across a sheet at rest; all coordinates in mm.
#[derive(Clone, Debug, PartialEq)]
pub struct LineCut {
    pub name: String,
    pub from: [f64; 2],
    pub to: [f64; 2],
    /// How many points it has, evenly apart.
    pub count: usize,
}

/// Two points of a sheet at rest, in mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Extensometer {
    pub name: String,
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

/// A measured curve: the force of the measured group over a displacement or a stretch.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// The file, as the study names it.
    pub file: String,
    /// The quantity on its axis.
    pub over: Over,
    /// Displacement in mm or stretch λ − 1, and force in N.
    pub points: Vec<[f64; 2]>,
}

/// The quantity over which a measured force is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Over {
    /// The displacement of the measured group in mm.
    Displacement,
    /// The stretch of an extensometer, by its name.
    Extensometer(String),
    /// The stretch of a length in mm by the displacement of the measured group.
    Length(f64),
}
