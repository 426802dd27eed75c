//! The meaning of the names of columns.

use super::test_data::Test;
use crate::document::{
    Column, ColumnNames, ColumnRole, Faulty, Head, MACHINE_DISPLACEMENTS, MACHINE_FORCES, TIMES,
    meaning,
};

/// The kind of quantity in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A stretch, strain or displacement.
    Strain,
    /// A stress or force.
    Stress,
    /// The time of the row.
    Time,
    /// The size of the specimen along an axis, as it is stretched.
    Size,
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
            Self::Size => "size",
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
    /// 0 or 1, where the name has a number, or the letter of an axis.
    pub numbered: Option<usize>,
}

/// The measure of a column of displacements.
pub const DISPLACEMENT: &str = "displacement";
/// The measure of a column of Green-Lagrange strains.
pub const GREEN_LAGRANGE: &str = "green-lagrange";
/// The measure of a column of second Piola-Kirchhoff stresses.
pub const SECOND_PIOLA_KIRCHHOFF: &str = "second-piola-kirchhoff";
/// The measure of a column of forces.
pub const FORCE: &str = "force";

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
        let known = |stem: &str| meaning(NAMES, stem);
        let numbered =
            || axes_of(&column.name).find_map(|(stem, axis)| Some((known(stem)?, Some(axis))));
        let plain = known(&column.name).map(|result| (result, None));
        match plain.or_else(numbered) {
            Some(((kind, measure, naming), axis)) => (Self::new(kind, measure, axis), naming),
            None => (Self::OTHER, Naming::Usual),
        }
    }
}

/// The meanings of names, and whose names they are.
const NAMES: &ColumnNames<(Kind, Option<&str>, Naming)> = &[
    (
        (Kind::Strain, Some("stretch"), Naming::Usual),
        "stretch stretch_ratio lambda lam λ",
    ),
    (
        (Kind::Strain, None, Naming::Usual),
        "strain epsilon eps ε shear_strain amount_of_shear shear gamma γ",
    ),
    (
        (Kind::Strain, Some("nominal"), Naming::Usual),
        "nominal_strain engineering_strain eng_strain",
    ),
    (
        (Kind::Strain, Some("logarithmic"), Naming::Usual),
        "logarithmic_strain true_strain log_strain hencky_strain",
    ),
    (
        (Kind::Strain, Some(GREEN_LAGRANGE), Naming::Usual),
        "green_lagrange_strain green_strain lagrange_strain lagrangian_strain",
    ),
    (
        (Kind::Strain, Some(DISPLACEMENT), Naming::Usual),
        "displacement extension elongation",
    ),
    (
        (Kind::Strain, Some(DISPLACEMENT), Naming::Machine),
        MACHINE_DISPLACEMENTS,
    ),
    (
        (Kind::Strain, None, Naming::Evaluation),
        "tensile_strain compressive_strain dehnung stauchung déformation 应变",
    ),
    (
        (Kind::Stress, None, Naming::Usual),
        "stress sigma σ shear_stress tau τ",
    ),
    (
        (Kind::Stress, Some("nominal"), Naming::Usual),
        "nominal_stress engineering_stress eng_stress first_piola_kirchhoff_stress first_piola_stress pk1 pk1_stress p",
    ),
    (
        (Kind::Stress, Some("cauchy"), Naming::Usual),
        "cauchy_stress true_stress",
    ),
    (
        (Kind::Stress, Some(SECOND_PIOLA_KIRCHHOFF), Naming::Usual),
        "second_piola_kirchhoff_stress second_piola_stress pk2 pk2_stress",
    ),
    ((Kind::Stress, Some(FORCE), Naming::Usual), "force load"),
    ((Kind::Stress, Some(FORCE), Naming::Machine), MACHINE_FORCES),
    (
        (Kind::Stress, None, Naming::Evaluation),
        "tensile_stress compressive_stress spannung zugspannung contrainte 应力",
    ),
    ((Kind::Time, None, Naming::Usual), TIMES),
    ((Kind::Size, None, Naming::Machine), "size"),
];

/// A name without the number or letter of its axis, and the axis: `stress_1`, `stress1`, `p11`, `force_y`, `XForce`.
fn axes_of(name: &str) -> impl Iterator<Item = (&str, usize)> {
    const ENDS: [[&str; 5]; 2] = [
        ["1", "11", "x", "xx", "axial"],
        ["2", "22", "y", "yy", "transverse"],
    ];
    const BEGINNINGS: [&str; 2] = ["x", "y"];
    let ends = ENDS.into_iter().enumerate().flat_map(move |(axis, ends)| {
        let stems = ends.into_iter().filter_map(|end| name.strip_suffix(end));
        stems.map(move |stem| (stem.trim_end_matches('_'), axis))
    });
    let letters = BEGINNINGS.into_iter().enumerate();
    let beginnings = letters.filter_map(move |(axis, letter)| {
        let stem = name.strip_prefix(letter)?;
        Some((stem.trim_start_matches('_'), axis))
    });
    ends.chain(beginnings)
}

/// The columns of some kind with the meaning of their names.
pub fn of_kind(roles: &[Role], kind: Kind) -> impl Iterator<Item = (usize, &Role)> {
    let all = roles.iter().enumerate();
    all.filter(move |(_, role)| role.kind == kind)
}

/// Refuses columns that are not consistent: all strains have one measure, and so have all stresses.
pub fn check_columns(head: &Head, roles: &[Role], test: Test) -> Faulty<()> {
    let position = || head.table.columns_place.clone();
    for (kind, what) in [(Kind::Strain, "strain"), (Kind::Stress, "stress")] {
        let first = of_kind(roles, kind).next();
        let other = |(_, role): &(usize, &Role)| {
            first.is_some_and(|(_, first)| first.measure != role.measure)
        };
        if let Some((column, _)) = of_kind(roles, kind).find(other) {
            let name = &head.table.columns[column].name;
            let message = format!("`{name}` has another measure than the column before it");
            let hint = format!("give every {what} in the same measure");
            return Err(head.fault(position(), message, &hint));
        }
    }
    let strains = of_kind(roles, Kind::Strain).count();
    if strains > 1 && test != Test::Biaxial {
        let message = format!("the strains of a {} test have one column", test.name());
        let hint = "choose one with --columns strain=NAME, or call the test biaxial";
        return Err(head.fault(position(), message, hint));
    }
    let numbered = of_kind(roles, Kind::Stress).any(|(_, role)| role.axis() == 1);
    if numbered && head.setting("direction", None)?.is_some() {
        let hint = "leave the direction out";
        let message = "the columns of stress name their axes, and a direction is given too";
        return Err(head.fault_of("direction", message, hint));
    }
    Ok(())
}
