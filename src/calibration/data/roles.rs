//! The meaning of the names of columns.

use super::test_data::Test;
use crate::document::{Faulty, Head};

/// The kind of quantity in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A stretch, strain or displacement.
    Strain,
    /// A stress or force.
    Stress,
    /// The time of the row.
    Time,
    /// A column that is not read.
    Other,
}

/// The meaning of a column's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Role {
    /// The kind of quantity.
    pub kind: Kind,
    /// The measure, where the name states it.
    pub measure: Option<&'static str>,
    /// 0 or 1.
    pub axis: usize,
}

/// The measure of a column of displacements.
pub const DISPLACEMENT: &str = "displacement";
/// The measure of a column of forces.
pub const FORCE: &str = "force";

/// Names that testing machines give to the displacement of their grip.
const MACHINE_DISPLACEMENTS: [&str; 15] = [
    "tensile_extension",
    "compressive_extension",
    "tensile_displacement",
    "compressive_displacement",
    "axial_displacement",
    "crosshead",
    "crosshead_displacement",
    "crosshead_position",
    "position",
    "stroke",
    "disp",
    "standardweg",
    "traversenweg",
    "weg",
    "位移",
];

/// Names that testing machines give to the force.
const MACHINE_FORCES: [&str; 11] = [
    "tensile_load",
    "compressive_load",
    "tensile_force",
    "compressive_force",
    "axial_load",
    "axial_force",
    "standard_force",
    "standardkraft",
    "kraft",
    "力",
    "载荷",
];

/// Names that testing machines give to strains and stresses without stating their measure.
const MACHINE_STRAINS: [&str; 6] = [
    "tensile_strain",
    "compressive_strain",
    "dehnung",
    "stauchung",
    "déformation",
    "应变",
];
const MACHINE_STRESSES: [&str; 6] = [
    "tensile_stress",
    "compressive_stress",
    "spannung",
    "zugspannung",
    "contrainte",
    "应力",
];

/// Names that testing machines give to the time.
const TIMES: [&str; 10] = [
    "time",
    "t",
    "elapsed_time",
    "total_time",
    "test_time",
    "running_time",
    "prüfzeit",
    "zeit",
    "temps",
    "时间",
];

impl Role {
    const fn strain(measure: Option<&'static str>, axis: usize) -> Self {
        Self::measured(Kind::Strain, measure, axis)
    }

    const fn stress(measure: Option<&'static str>, axis: usize) -> Self {
        Self::measured(Kind::Stress, measure, axis)
    }

    const fn other(kind: Kind) -> Self {
        Self::measured(kind, None, 0)
    }

    const fn measured(kind: Kind, measure: Option<&'static str>, axis: usize) -> Self {
        Self {
            kind,
            measure,
            axis,
        }
    }

    fn named(name: &str) -> Self {
        let (stem, axis) = axis_of(name);
        match stem {
            "stretch" | "lambda" | "λ" => Self::strain(Some("stretch"), axis),
            "strain" => Self::strain(None, axis),
            "nominal_strain" | "engineering_strain" => Self::strain(Some("nominal"), axis),
            "logarithmic_strain" | "true_strain" => Self::strain(Some("logarithmic"), axis),
            "displacement" | "extension" => Self::strain(Some(DISPLACEMENT), axis),
            "stress" => Self::stress(None, axis),
            "nominal_stress" | "engineering_stress" | "first_piola_kirchhoff_stress" => {
                Self::stress(Some("nominal"), axis)
            }
            "cauchy_stress" | "true_stress" => Self::stress(Some("cauchy"), axis),
            "force" | "load" => Self::stress(Some(FORCE), axis),
            name if TIMES.contains(&name) => Self::other(Kind::Time),
            _ => Self::other(Kind::Other),
        }
    }

    /// The meaning of a name that only machines write: it counts where no other column is of its kind.
    fn of_machine(name: &str) -> Option<Self> {
        let (stem, axis) = axis_of(name);
        let is = |names: &[&str]| names.contains(&stem);
        if is(&MACHINE_DISPLACEMENTS) {
            return Some(Self::strain(Some(DISPLACEMENT), axis));
        }
        is(&MACHINE_FORCES).then(|| Self::stress(Some(FORCE), axis))
    }

    /// The meaning of a name that only machines write beside displacements and forces: it counts where there are none of these.
    fn of_machine_s_evaluation(name: &str) -> Option<Self> {
        let (stem, axis) = axis_of(name);
        if MACHINE_STRAINS.contains(&stem) {
            return Some(Self::strain(None, axis));
        }
        MACHINE_STRESSES
            .contains(&stem)
            .then(|| Self::stress(None, axis))
    }
}

/// A name without the number of its axis, and the axis.
fn axis_of(name: &str) -> (&str, usize) {
    match name.rsplit_once('_') {
        Some((stem, "1")) => (stem, 0),
        Some((stem, "2")) => (stem, 1),
        _ => (name, 0),
    }
}

/// The columns of some kind with the meaning of their names.
pub fn of_kind(roles: &[Role], kind: Kind) -> impl Iterator<Item = (usize, &Role)> {
    let all = roles.iter().enumerate();
    all.filter(move |(_, role)| role.kind == kind)
}

/// The meaning of the columns' names; the first two columns of a file without names are strain and stress.
pub fn roles(head: &Head) -> Vec<Role> {
    let columns = &head.table.columns;
    if columns.iter().all(|column| column.name.is_empty()) {
        let plain = [Role::strain(None, 0), Role::stress(None, 0)];
        return plain.into_iter().take(columns.len()).collect();
    }
    let named = columns.iter().map(|column| Role::named(&column.name));
    let mut roles: Vec<Role> = named.collect();
    for kind in [Kind::Strain, Kind::Stress] {
        for meaning in [Role::of_machine, Role::of_machine_s_evaluation] {
            if of_kind(&roles, kind).next().is_some() {
                break;
            }
            for (role, column) in roles.iter_mut().zip(columns) {
                let own = meaning(&column.name).filter(|own| own.kind == kind);
                *role = own.unwrap_or(*role);
            }
        }
    }
    roles
}

/// Refuses columns that are not consistent: each axis has one strain and one stress, all strains have one measure, and so have all stresses.
pub fn check_columns(head: &Head, roles: &[Role], test: Test) -> Faulty<()> {
    let place = || head.table.columns_place.clone();
    for (kind, what) in [(Kind::Strain, "strain"), (Kind::Stress, "stress")] {
        let mut first: Option<&Role> = None;
        for (column, role) in of_kind(roles, kind) {
            let name = &head.table.columns[column].name;
            let earlier = of_kind(roles, kind).find(|(_, other)| other.axis == role.axis);
            if earlier.is_some_and(|(other, _)| other != column) {
                let message = format!(
                    "there are two columns of {what} along axis {}",
                    role.axis + 1
                );
                let hint = "leave one out, or name them with _1 and _2 for the two axes";
                return Err(head.fault(place(), message, hint));
            }
            if first.is_some_and(|first| first.measure != role.measure) {
                let message = format!("`{name}` has another measure than the column before it");
                let hint = format!("give every {what} in the same measure");
                return Err(head.fault(place(), message, &hint));
            }
            first = Some(role);
        }
    }
    let strains = of_kind(roles, Kind::Strain).count();
    if strains > 1 && test != Test::Biaxial {
        let message = format!("the strains of a {} test have one column", test.name());
        let hint = "leave the other out, or call the test biaxial";
        return Err(head.fault(place(), message, hint));
    }
    let numbered = of_kind(roles, Kind::Stress).any(|(_, role)| role.axis == 1);
    if numbered && head.setting("direction", None)?.is_some() {
        let hint = "leave the direction out";
        let message = "the columns of stress name their axes, and a direction is given too";
        return Err(head.fault(head.place("direction"), message, hint));
    }
    Ok(())
}
