//! The meaning of the names of columns.

use super::test_data::Test;
use crate::document::{Column, ColumnRole, Faulty, Head};

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

impl Kind {
    /// Its name; empty for a column that is not read.
    pub fn name(self) -> &'static str {
        match self {
            Self::Strain => "strain",
            Self::Stress => "stress",
            Self::Time => "time",
            Self::Other => "",
        }
    }
}

/// A quantity whose column a user may name: its kind, and the axis where it is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity(pub Kind, pub Option<usize>);

impl ColumnRole for Quantity {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("strain", Self(Kind::Strain, None)),
        ("strain_1", Self(Kind::Strain, Some(0))),
        ("strain_2", Self(Kind::Strain, Some(1))),
        ("stress", Self(Kind::Stress, None)),
        ("stress_1", Self(Kind::Stress, Some(0))),
        ("stress_2", Self(Kind::Stress, Some(1))),
        ("time", Self(Kind::Time, None)),
    ];
    const EXAMPLE: &'static str = "strain=Extension,stress=\"Load (N)\"";
}

/// The meaning of a column's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Role {
    /// The kind of quantity.
    pub kind: Kind,
    /// The measure, where the name states it.
    pub measure: Option<&'static str>,
    /// 0 or 1, where the name has a number.
    pub numbered: Option<usize>,
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

/// What kind of name a column has: where several columns may be the same quantity, the first kind counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Naming {
    /// One that people choose.
    Usual,
    /// One that machines give to their displacements and forces.
    Machine,
    /// One that machines give to what they evaluate of displacements and forces.
    Evaluation,
}

impl Role {
    /// The role of a column that is not read.
    pub const OTHER: Self = Self::new(Kind::Other, None, None);

    /// A role.
    pub const fn new(kind: Kind, measure: Option<&'static str>, numbered: Option<usize>) -> Self {
        Self {
            kind,
            measure,
            numbered,
        }
    }

    /// 0 or 1; a column without a number is along the first axis.
    pub fn axis(&self) -> usize {
        self.numbered.unwrap_or(0)
    }

    /// The meaning of a column by its name, and what kind of name it is.
    pub fn of(column: &Column) -> (Self, Naming) {
        let (stem, axis) = axis_of(&column.name);
        let is = |names: &[&str]| names.contains(&stem);
        let (kind, measure) = match stem {
            "stretch" | "lambda" | "λ" => (Kind::Strain, Some("stretch")),
            "strain" => (Kind::Strain, None),
            "nominal_strain" | "engineering_strain" => (Kind::Strain, Some("nominal")),
            "logarithmic_strain" | "true_strain" => (Kind::Strain, Some("logarithmic")),
            "displacement" | "extension" => (Kind::Strain, Some(DISPLACEMENT)),
            "stress" => (Kind::Stress, None),
            "nominal_stress" | "engineering_stress" | "first_piola_kirchhoff_stress" => {
                (Kind::Stress, Some("nominal"))
            }
            "cauchy_stress" | "true_stress" => (Kind::Stress, Some("cauchy")),
            "force" | "load" => (Kind::Stress, Some(FORCE)),
            _ if is(&TIMES) => (Kind::Time, None),
            _ if is(&MACHINE_DISPLACEMENTS) => (Kind::Strain, Some(DISPLACEMENT)),
            _ if is(&MACHINE_FORCES) => (Kind::Stress, Some(FORCE)),
            _ if is(&MACHINE_STRAINS) => (Kind::Strain, None),
            _ if is(&MACHINE_STRESSES) => (Kind::Stress, None),
            _ => (Kind::Other, None),
        };
        let naming = match () {
            () if is(&MACHINE_DISPLACEMENTS) || is(&MACHINE_FORCES) => Naming::Machine,
            () if is(&MACHINE_STRAINS) || is(&MACHINE_STRESSES) => Naming::Evaluation,
            () => Naming::Usual,
        };
        (Self::new(kind, measure, axis), naming)
    }
}

/// A name without the number of its axis, and the axis.
fn axis_of(name: &str) -> (&str, Option<usize>) {
    match name.rsplit_once('_') {
        Some((stem, "1")) => (stem, Some(0)),
        Some((stem, "2")) => (stem, Some(1)),
        _ => (name, None),
    }
}

/// The columns of some kind with the meaning of their names.
pub fn of_kind(roles: &[Role], kind: Kind) -> impl Iterator<Item = (usize, &Role)> {
    let all = roles.iter().enumerate();
    all.filter(move |(_, role)| role.kind == kind)
}

/// Refuses columns that are not consistent: all strains have one measure, and so have all stresses.
pub fn check_columns(head: &Head, roles: &[Role], test: Test) -> Faulty<()> {
    let place = || head.table.columns_place.clone();
    for (kind, what) in [(Kind::Strain, "strain"), (Kind::Stress, "stress")] {
        let first = of_kind(roles, kind).next();
        let other = |(_, role): &(usize, &Role)| {
            first.is_some_and(|(_, first)| first.measure != role.measure)
        };
        if let Some((column, _)) = of_kind(roles, kind).find(other) {
            let name = &head.table.columns[column].name;
            let message = format!("`{name}` has another measure than the column before it");
            let hint = format!("give every {what} in the same measure");
            return Err(head.fault(place(), message, &hint));
        }
    }
    let strains = of_kind(roles, Kind::Strain).count();
    if strains > 1 && test != Test::Biaxial {
        let message = format!("the strains of a {} test have one column", test.name());
        let hint = "choose one with --columns strain=NAME, or call the test biaxial";
        return Err(head.fault(place(), message, hint));
    }
    let numbered = of_kind(roles, Kind::Stress).any(|(_, role)| role.axis() == 1);
    if numbered && head.setting("direction", None)?.is_some() {
        let hint = "leave the direction out";
        let message = "the columns of stress name their axes, and a direction is given too";
        return Err(head.fault(head.place("direction"), message, hint));
    }
    Ok(())
}
