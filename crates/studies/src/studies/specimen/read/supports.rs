//! The supports and loads of a specimen's study.

use crate::document::{Bound, Section};
use crate::error::{Severity, suggestion};
use crate::mesh::Mesh;
use crate::problem::{BoundaryProblem, Drive, Load, Support};
use crate::units::Dimension;

/// An entry of a study's list with its group and the support or load.
struct Entry<'a, T> {
    section: Section<'a>,
    group: String,
    condition: T,
}

/// The supports and loads of a study, with their sections.
pub struct SupportsAndLoads<'a> {
    supports: Vec<Entry<'a, Support>>,
    loads: Vec<Entry<'a, Load>>,
    /// Whether all entries could be read.
    complete: bool,
}

impl<'a> SupportsAndLoads<'a> {
    /// Reads `[[support]]` and `[[load]]`; the study must say what holds the specimen.
    pub fn read(root: &Section<'a>) -> Self {
        if !root.has("support") {
            let hint = "no support is assumed: add [[support]] with group = \"left\" and kind = \"clamp\", for example, once for each group that is \
                        held";
            root.fault("support", "is missing: nothing holds the specimen", hint);
        }
        let (supports, all_supports) = entries(root, "support", read_support);
        let (loads, all_loads) = entries(root, "load", read_load);
        Self {
            supports,
            loads,
            complete: all_supports && all_loads,
        }
    }

    /// The supports by group.
    pub fn supports(&self) -> Vec<(String, Support)> {
        pairs(&self.supports)
    }

    /// The loads by group.
    pub fn loads(&self) -> Vec<(String, Load)> {
        pairs(&self.loads)
    }

    /// The groups of all entries, with their sections.
    fn groups(&self) -> impl Iterator<Item = (&Section<'a>, &str)> {
        let supports = self.supports.iter();
        let supports = supports.map(|entry| (&entry.section, &*entry.group));
        let loads = self.loads.iter();
        supports.chain(loads.map(|entry| (&entry.section, &*entry.group)))
    }

    /// Records groups that the specimen does not have.
    pub fn check_groups(&self, mesh: &Mesh) {
        // A missing name was reported when it was read.
        for (section, group) in self.groups().filter(|(_, group)| !group.is_empty()) {
            check_group(section, "group", group, mesh);
        }
    }

    /// Records supports and loads that a motion in time does not have.
    pub fn check_in_time(&self) {
        for Entry {
            section, condition, ..
        } in &self.supports
        {
            let is_pulled = matches!(condition, Support::Grip(drives)
                if drives.iter().any(|drive| matches!(drive, Drive::Force(_))));
            if is_pulled {
                let message = "a rigid grip that is pulled by a force has no equation of motion";
                let hint = "move the grip with x and y, or put a [[load]] of kind \"force\" on a free group";
                section.fault("kind", message, hint);
            }
            if matches!(condition, Support::Rotation { .. }) {
                let message = "a rotation in time is not computed";
                let hint =
                    "for small turns take kind = \"displacement\" with x and y linear in X and Y";
                section.fault("kind", message, hint);
            }
        }
        let pressures = self.loads.iter();
        for entry in pressures.filter(|entry| matches!(entry.condition, Load::Pressure(_))) {
            let message = "a pressure that follows the edges is not computed in time";
            let hint = "take a traction, which keeps its direction";
            entry.section.fault("kind", message, hint);
        }
    }

    /// Records what keeps the problem from being solved on a mesh, at the entry that each fault names.
    pub fn check(&self, root: &Section, problem: &BoundaryProblem, mesh: &Mesh) {
        let mut groups = self.groups();
        if self.supports.is_empty()
            || !self.complete
            || !problem.thickness.is_finite()
            || !groups.all(|(_, group)| mesh.groups().contains_key(group))
        {
            return; // These faults were reported when the study was read.
        }
        let unstrained = |()| problem.unstrained(mesh).map_err(|fault| vec![fault]);
        let checked = problem.check(mesh).and_then(unstrained);
        for fault in checked.map_or_else(|faults| faults, |warnings| warnings.into_iter().collect())
        {
            let hint = fault.hint.unwrap_or_default();
            let entry = match fault.key.as_str() {
                "load" => named(&self.loads, "load", &fault.message),
                _ => named(&self.supports, "support", &fault.message),
            };
            match entry {
                // Gravity and point forces, too, move a sheet in time: the reader of motions warns.
                _ if fault.severity == Severity::Warning && root.has("time") => {}
                _ if fault.severity == Severity::Warning => {
                    root.warning("support", &fault.message, &hint);
                }
                Some(section) => section.fault("group", &fault.message, &hint),
                None => root.fault("support", &fault.message, &hint),
            }
        }
    }
}

/// Records a group under `key` that the specimen does not have.
pub fn check_group(section: &Section, key: &'static str, group: &str, mesh: &Mesh) {
    if !mesh.groups().contains_key(group) {
        let known: Vec<_> = mesh.groups().keys().map(String::as_str).collect();
        let message = format!("the specimen has no group `{group}`");
        section.fault(key, &message, &suggestion(group, &known, "its groups are"));
    }
}

/// The last entry of a list that a fault names by its number, or the first by its group.
fn named<'a, T>(entries: &'a [Entry<'a, T>], what: &str, message: &str) -> Option<&'a Section<'a>> {
    let numbered = entries.iter().enumerate();
    let mut by_number = numbered.filter(|(number, entry)| {
        message.contains(&format!(
            "{what} {} on the group `{}`",
            number + 1,
            entry.group
        ))
    });
    let by_group = || {
        let of_group =
            |entry: &&Entry<T>| message.starts_with(&format!("the group `{}`", entry.group));
        entries.iter().find(of_group)
    };
    let entry = by_number
        .next_back()
        .map(|(_, entry)| entry)
        .or_else(by_group);
    entry.map(|entry| &entry.section)
}

/// The entries of a list in the file, and whether all could be read; none where it has no such list.
fn entries<'a, T>(
    root: &Section<'a>,
    key: &'static str,
    read: fn(&Section) -> Option<(String, T)>,
) -> (Vec<Entry<'a, T>>, bool) {
    let sections = root.optional_tables(key);
    let written = sections.len();
    let entries = sections.into_iter().filter_map(|section| {
        let (group, condition) = read(&section)?;
        Some(Entry {
            section,
            group,
            condition,
        })
    });
    let entries: Vec<_> = entries.collect();
    let complete = entries.len() == written;
    (entries, complete)
}

fn pairs<T: Copy>(entries: &[Entry<T>]) -> Vec<(String, T)> {
    let entries = entries.iter();
    entries
        .map(|entry| (entry.group.clone(), entry.condition))
        .collect()
}

/// What moves a grip along an axis, by the keys of a displacement and of a force.
fn drive(section: &Section, (displacement, force): (&'static str, &'static str)) -> Drive {
    match (section.has(displacement), section.has(force)) {
        (true, false) => {
            Drive::Displacement(section.quantity(displacement, Dimension::Length, Bound::Any))
        }
        (false, true) => Drive::Force(section.quantity(force, Dimension::Force, Bound::Any)),
        (given, _) => {
            let message = if given {
                format!("a grip has {displacement} or {force}, and not both")
            } else {
                format!("a grip needs either {displacement} or {force}")
            };
            let hint = format!(
                "{displacement} = \"0 mm\" holds it, {force} = \"0 N\" leaves it free to move"
            );
            section.fault("kind", &message, &hint);
            Drive::Displacement(f64::NAN)
        }
    }
}

/// A point under `centre` in mm.
fn read_centre(section: &Section) -> [f64; 2] {
    let centre = section.quantities("centre", Dimension::Length, Bound::Any);
    centre.try_into().unwrap_or_else(|_| {
        if section.has("centre") {
            let hint = "such as [\"0 mm\", \"0 mm\"]";
            section.fault("centre", "must be two lengths", hint);
        }
        [f64::NAN; 2]
    })
}

/// The kinds of supports.
const SUPPORTS: [&str; 7] = [
    "clamp",
    "displacement",
    "roller",
    "symmetry",
    "grip",
    "rotation",
    "radial",
];

fn read_support(section: &Section) -> Option<(String, Support)> {
    let group = section.text("group");
    let support = match section.choice("kind", &SUPPORTS.map(|kind| (kind, kind)))? {
        "clamp" => Support::Displacement([Some(0.0); 2]),
        "displacement" => {
            let displacement = ["x", "y"].map(|key| section.stated(key, Section::linear_length));
            if displacement == [None; 2] {
                section.fault("kind", "needs x or y", "x = \"0 mm\" is a roller along y");
            }
            let even = displacement
                .iter()
                .flatten()
                .all(|along| along.slope == [0.0; 2]);
            if even {
                Support::Displacement(displacement.map(|along| Some(along?.at_origin)))
            } else {
                Support::LinearDisplacement(displacement)
            }
        }
        "roller" | "symmetry" => Support::Roller,
        "radial" => Support::Radial {
            centre: read_centre(section),
            displacement: section.quantity("displacement", Dimension::Length, Bound::Any),
        },
        "grip" => {
            Support::Grip([("x", "x_force"), ("y", "y_force")].map(|keys| drive(section, keys)))
        }
        _ => {
            let centre = read_centre(section);
            Support::Rotation {
                centre,
                angle: section.quantity("angle", Dimension::Angle, Bound::Any),
            }
        }
    };
    section.unknown_keys_with(|key| {
        let moves = ["x", "y", "x_force", "y_force"].contains(&key);
        let hint = "a support that moves along x or y is of kind = \"displacement\", or \"grip\" if it is rigid";
        moves.then(|| hint.to_owned())
    });
    Some((group, support))
}

fn read_load(section: &Section) -> Option<(String, Load)> {
    let group = section.text("group");
    let vector = |dimension: Dimension| {
        let given = ["x", "y"].map(|key| section.optional_quantity(key, dimension, Bound::Any));
        if given == [None; 2] {
            let hint = format!("x = {} acts along x", dimension.example());
            section.fault("kind", "needs x or y", &hint);
        }
        given.map(Option::unwrap_or_default)
    };
    let kinds = ["traction", "pressure", "force"];
    let load = match section.choice("kind", &kinds.map(|kind| (kind, kind)))? {
        "traction" => Load::Traction(vector(Dimension::Stress)),
        "pressure" => Load::Pressure(section.quantity("pressure", Dimension::Stress, Bound::Any)),
        _ => Load::Force(vector(Dimension::Force)),
    };
    section.unknown_keys();
    Some((group, load))
}
