//! Points of a sheet that a study watches.

use crate::document::{Bound, Section};
use crate::mesh::Mesh;
use crate::units::Dimension;

/// A point of the sheet that is watched.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Its name.
    pub name: String,
    /// Where it is at rest, in mm.
    pub at: [f64; 2],
}

/// The mesh of a sheet's outline, and its box.
pub type Region = (Mesh, [[f64; 2]; 2]);

/// All tables of a kind; none where the study has none.
pub fn tables<T>(root: &Section, key: &'static str, read: impl FnMut(&Section) -> T) -> Vec<T> {
    root.optional_tables(key).iter().map(read).collect()
}

/// A point of the sheet at rest in mm.
pub fn read_point(section: &Section, key: &'static str, region: Option<&Region>) -> [f64; 2] {
    /// How far a point may be outside of the lattice, in sizes of a cell: its curved sides lie inside of the outline.
    const MARGIN: f64 = 0.1;
    let at = section.quantities(key, Dimension::Length, Bound::Any);
    let Ok(at) = <[f64; 2]>::try_from(at) else {
        let hint = "such as [\"15 mm\", \"5 mm\"]";
        section.fault(key, "must be two lengths, x and y", hint);
        return [0.0; 2];
    };
    let region = region.filter(|_| at.iter().all(|x| x.is_finite()));
    let Some((mesh, [[left, bottom], [right, top]])) = region else {
        return at;
    };
    let in_box = (left..=right).contains(&&at[0]) && (bottom..=top).contains(&&at[1]);
    if !in_box || mesh.outside(at) > MARGIN {
        let hint = format!(
            "the sheet lies from [\"{left} mm\", \"{bottom} mm\"] to [\"{right} mm\", \"{top} mm\"]"
        );
        section.fault(key, "must be a point of the sheet", &hint);
    }
    at
}

/// All tables of a kind with different names.
pub fn named_tables<T>(
    root: &Section,
    key: &'static str,
    read: impl Fn(&Section, String) -> T,
) -> Vec<T> {
    let mut names = Vec::new();
    tables(root, key, |section| {
        let name = section.heading("name");
        if names.contains(&name) {
            let message = format!("is the name of another {key}");
            let hint = "tables and pictures carry this name: give each one of its own";
            section.fault("name", &message, hint);
        }
        names.push(name.clone());
        let value = read(section, name);
        section.unknown_keys();
        value
    })
}

/// All probes.
pub fn read_probes(root: &Section, region: Option<&Region>) -> Vec<Probe> {
    named_tables(root, "probe", |section, name| Probe {
        name,
        at: read_point(section, "at", region),
    })
}
