//! Points of a sheet in motion: probes and point forces.

use crate::document::{Bound, Section};
use crate::dynamics::TimeFunction;
use crate::mesh::Mesh;
use crate::studies::motion::problem::{PointForce, Probe};
use crate::units::Dimension;

/// The mesh of a sheet's outline, and its box.
pub type Region = (Mesh, [[f64; 2]; 2]);

/// All tables of a kind; none where the study has none.
fn tables<T>(root: &Section, key: &'static str, read: impl FnMut(&Section) -> T) -> Vec<T> {
    if root.has(key) {
        root.tables(key).iter().map(read).collect()
    } else {
        Vec::new()
    }
}

/// A point of the sheet in mm.
fn read_point(section: &Section, region: Option<&Region>) -> [f64; 2] {
    /// Of a cell's size: curved sides of a lattice lie inside of the outline.
    const BEYOND: f64 = 0.1;
    let at = section.quantities("at", Dimension::Length, Bound::Any);
    let Ok(at) = <[f64; 2]>::try_from(at) else {
        let hint = "such as [\"15 mm\", \"5 mm\"]";
        section.fault("at", "must be two lengths, x and y", hint);
        return [0.0; 2];
    };
    let region = region.filter(|_| at.iter().all(|x| x.is_finite()));
    let Some((mesh, [[left, bottom], [right, top]])) = region else {
        return at;
    };
    let in_box = (left..=right).contains(&&at[0]) && (bottom..=top).contains(&&at[1]);
    if !in_box || mesh.outside(at) > BEYOND {
        let hint = format!(
            "the sheet lies from [\"{left} mm\", \"{bottom} mm\"] to [\"{right} mm\", \"{top} mm\"]"
        );
        section.fault("at", "must be a point of the sheet", &hint);
    }
    at
}

/// All probes; tables have columns of their names.
pub fn read_probes(root: &Section, region: Option<&Region>) -> Vec<Probe> {
    let mut names = Vec::new();
    tables(root, "probe", |section| {
        let probe = read_probe(section, region);
        if names.contains(&probe.name) {
            let hint = "table columns carry this name: give each probe a name of its own";
            section.fault("name", "is the name of another probe", hint);
        }
        names.push(probe.name.clone());
        probe
    })
}

fn read_probe(section: &Section, region: Option<&Region>) -> Probe {
    let probe = Probe {
        name: section.heading("name"),
        at: read_point(section, region),
    };
    section.unknown_keys();
    probe
}

fn read_force(section: &Section, region: Option<&Region>) -> PointForce {
    let force = ["x", "y"].map(|axis| section.quantity(axis, Dimension::Force, Bound::Any));
    let instant = |key| section.quantity(key, Dimension::Time, Bound::NonNegative);
    let time = if section.has("begin") || section.has("end") {
        let begin = if section.has("begin") {
            instant("begin")
        } else {
            0.0
        };
        let end = instant("end");
        if end <= begin {
            section.fault("end", "must be after the begin", "give a later time");
        }
        TimeFunction::Ramp { begin, end }
    } else {
        TimeFunction::Constant(1.0)
    };
    let force = PointForce {
        at: read_point(section, region),
        force,
        time,
    };
    section.unknown_keys();
    force
}

/// All point forces.
pub fn read_forces(root: &Section, region: Option<&Region>) -> Vec<PointForce> {
    tables(root, "force", |one| read_force(one, region))
}
