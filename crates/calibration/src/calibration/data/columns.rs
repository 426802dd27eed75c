//! Measures and units of the columns that are read.

use super::record::Machine;
use super::roles::{DISPLACEMENT, FORCE, Kind, Quantity, Role, SECOND_PIOLA_KIRCHHOFF, of_kind};
use super::strain_column::StrainColumn;
use super::table_reading::{ColumnReading, TableReading};
use super::test_data::Test;
use crate::document::{Column, ColumnRole, Faulty, Head};
use crate::error::Diagnostic;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::units::{self, Dimension};

/// Tests begin at a stretch of about 1: values that begin above this may be in percent.
const AT_REST: f64 = 10.0;

/// The factor from a column of strains or displacements to a ratio; stretches without a unit are plain ratios where they begin near 1.
pub fn strain_factor(
    head: &Head,
    roles: &[Role],
    (column, role): (usize, &Role),
    measure: StrainColumn,
) -> Faulty<f64> {
    let named = &head.table.columns[column];
    if role.measure == Some(DISPLACEMENT) {
        let unit = head.factor("strain unit", named, Dimension::Length)?;
        return Ok(unit / length_along(head, roles, role)?);
    }
    let values = head.table.rows.iter().map(|(row, _)| row[column].abs());
    let begins_at_rest = || values.fold(f64::INFINITY, f64::min) < AT_REST;
    let is_bare = named.unit.is_none() && head.setting("strain unit", None)?.is_none();
    if is_bare && measure == StrainColumn::Stretch && begins_at_rest() {
        Ok(1.0)
    } else {
        head.factor("strain unit", named, Dimension::Ratio)
    }
}

/// The factor from a column of stresses or forces to MPa.
pub fn stress_factor(head: &Head, roles: &[Role], (column, role): (usize, &Role)) -> Faulty<f64> {
    let named = &head.table.columns[column];
    if role.measure == Some(FORCE) {
        Ok(head.factor("stress unit", named, Dimension::Force)?
            / area(head, roles, sized_axis(head, role))?)
    } else {
        head.factor("stress unit", named, Dimension::Stress)
    }
}

/// Column and factor to a ratio, or to MPa.
pub type Scaled = (usize, f64);

/// A column of stresses.
#[derive(Clone, Copy, Debug)]
pub struct StressColumn {
    /// Its number.
    pub column: usize,
    /// The factor to MPa.
    pub factor: f64,
    /// The axis of the stress.
    pub axis: usize,
    /// Whether it is the second Piola-Kirchhoff stress S, which the stretch turns into the nominal one, P = λ S.
    pub is_second: bool,
}

/// What a statement on the measure of stresses means: the measure as data have it, and whether it is the second Piola-Kirchhoff stress.
const STRESS_MEASURES: [(&str, (StressMeasure, bool)); 3] = [
    ("nominal", (StressMeasure::Nominal, false)),
    ("cauchy", (StressMeasure::Cauchy, false)),
    (SECOND_PIOLA_KIRCHHOFF, (StressMeasure::Nominal, true)),
];

/// The measure of the strains, and the columns with their factors to a ratio along both axes.
pub fn strains(
    head: &Head,
    roles: &[Role],
    test: Option<Test>,
) -> Faulty<(StrainColumn, [Option<Scaled>; 2])> {
    let Some(first) = of_kind(roles, Kind::Strain).min_by_key(|(_, role)| role.axis()) else {
        let names = "`stretch`, `nominal_strain` or `logarithmic_strain`";
        return Err(no_column(head, "strains", names));
    };
    let is_plain = first.1.measure == Some(DISPLACEMENT) || test == Some(Test::SimpleShear);
    let measure = if is_plain {
        StrainColumn::Strain(StrainMeasure::Nominal)
    } else {
        head.choice("strain measure", first.1.measure, &StrainColumn::NAMES)?
    };
    let scaled = |column: (usize, &Role)| -> Faulty<Scaled> {
        Ok((column.0, strain_factor(head, roles, column, measure)?))
    };
    let along = scaled(first)?;
    let second = of_kind(roles, Kind::Strain).find(|(_, role)| role.axis() == 1);
    let across = second.map(scaled).transpose()?;
    Ok((measure, [Some(along), across]))
}

/// The measure of the stresses, and their columns.
pub fn stresses(
    head: &Head,
    roles: &[Role],
    test: Option<Test>,
) -> Faulty<(StressMeasure, Vec<StressColumn>)> {
    let Some((_, role)) = of_kind(roles, Kind::Stress).next() else {
        let names = "`nominal_stress`, `cauchy_stress` or `force`";
        return Err(no_column(head, "stresses", names));
    };
    let is_plain = role.measure == Some(FORCE) || test == Some(Test::SimpleShear);
    let (measure, is_second) = if is_plain {
        (StressMeasure::Nominal, false)
    } else {
        head.choice("stress measure", role.measure, &STRESS_MEASURES)?
    };
    let direction = match head.setting("direction", None)?.as_deref() {
        None | Some("1") => 0,
        Some("2") => 1,
        Some(other) => {
            let message = format!("the direction {other} is not 1 or 2");
            let hint = "1 is the axis of the strain column, 2 the one across";
            return Err(head.fault_of("direction", message, hint));
        }
    };
    let mut columns = Vec::new();
    for column in of_kind(roles, Kind::Stress) {
        columns.push(StressColumn {
            column: column.0,
            factor: stress_factor(head, roles, column)?,
            axis: column.1.axis().max(direction),
            is_second,
        });
    }
    Ok((measure, columns))
}

/// The length of the specimen at rest along an axis in mm: `length`, or `width` along the second axis, where it is stated; otherwise the size
/// in the first row that has one less the displacement there.
pub fn length(head: &Head, roles: &[Role], axis: usize) -> Faulty<f64> {
    size(head, roles, LENGTHS[axis], axis)
}

/// The keys of the specimen's length along both axes.
const LENGTHS: [&str; 2] = ["length", "width"];

fn size(head: &Head, roles: &[Role], key: &str, axis: usize) -> Faulty<f64> {
    let stated = head.quantity(key, Dimension::Length)?;
    let size = stated.or_else(|| size_at_rest(head, roles, axis));
    size.ok_or_else(|| head.missing(key, "2 mm"))
}

/// The length along the axis of a column of displacements.
fn length_along(head: &Head, roles: &[Role], role: &Role) -> Faulty<f64> {
    let key = LENGTHS[sized_axis(head, role).unwrap_or(0)];
    size(head, roles, key, role.axis())
}

/// The axis by which the sizes of the specimen are named. A strip is as long as it is pulled, whatever the axis is called.
fn sized_axis(head: &Head, role: &Role) -> Option<usize> {
    let test = head.choice("test", None, &Test::NAMES);
    let is_strip = matches!(test, Ok(Test::Uniaxial | Test::SimpleShear));
    role.numbered.filter(|axis| *axis == 0 || !is_strip)
}

/// The columns of the specimen's size and displacement along an axis, with their factors to mm.
pub fn sized(head: &Head, roles: &[Role], axis: usize) -> Option<(Scaled, Option<Scaled>)> {
    let column = |kind: Kind, measure: Option<&str>| {
        let mut columns = of_kind(roles, kind);
        let (column, _) =
            columns.find(|(_, role)| role.axis() == axis && role.measure == measure)?;
        let unit = head.table.columns[column].unit.as_deref()?;
        let factor = units::factor(unit, Dimension::Length).ok()?;
        Some((column, factor))
    };
    let size = column(Kind::Size, None)?;
    Some((size, column(Kind::Strain, Some(DISPLACEMENT))))
}

/// The size of the specimen along an axis in mm less its displacement, where columns state both: in the first row that has them.
fn size_at_rest(head: &Head, roles: &[Role], axis: usize) -> Option<f64> {
    let (size, displacement) = sized(head, roles, axis)?;
    let rows = head.table.rows.iter().map(|(row, _)| {
        let value = |(column, factor): (usize, f64)| factor * row[column];
        value(size) - displacement.map_or(0.0, value)
    });
    let mut known = rows.filter(|size| size.is_finite());
    known.next().filter(|size| *size > 0.0)
}

/// The cross-section of the specimen in mm²: the stated one, or width times thickness; of a specimen that is pulled along two axes, the
/// thickness times its length along the other axis.
pub fn area(head: &Head, roles: &[Role], axis: Option<usize>) -> Faulty<f64> {
    let stated = head.quantity("area", Dimension::Area)?;
    let thickness = head.quantity("thickness", Dimension::Length)?;
    let across = match axis {
        Some(_) if head.text("arm width")?.is_some() => {
            head.quantity("arm width", Dimension::Length)?
        }
        Some(axis) => head.quantity(["width", "length"][axis], Dimension::Length)?,
        None => head.quantity("width", Dimension::Length)?,
    };
    match (stated, thickness, across) {
        (Some(area), None, _) if axis.is_some() || across.is_none() => Ok(area),
        (None, None, None) => {
            let mut fault = head.missing("area", "20 mm^2");
            let hint = fault.hint.take().unwrap_or_default();
            fault.hint = Some(format!("{hint}; or width and thickness of the specimen"));
            Err(fault)
        }
        (None, None, Some(_)) => Err(head.missing("thickness", "2 mm")),
        (None, Some(thickness), Some(across)) => Ok(thickness * across),
        (None, Some(thickness), None) => {
            Ok(thickness * length(head, roles, 1 - axis.unwrap_or(0))?)
        }
        (Some(_), ..) => {
            let message = "the area is stated, and width or thickness too";
            Err(head.fault_of("area", message, "state the area, or both sides"))
        }
    }
}

/// The specimen of a table with one column of displacements and one of forces.
pub fn machine(head: &Head, roles: &[Role]) -> Faulty<Option<Machine>> {
    let only = |kind, measure| {
        let mut columns = of_kind(roles, kind);
        let first = columns
            .next()
            .is_some_and(|(_, role)| role.measure == Some(measure));
        first && columns.next().is_none()
    };
    if !only(Kind::Strain, DISPLACEMENT) || !only(Kind::Stress, FORCE) {
        return Ok(None);
    }
    Ok(Some(Machine {
        length: length(head, roles, 0)?,
        area: area(head, roles, None)?,
        presses: head.setting("test", None)?.as_deref() == Some("compression"),
    }))
}

/// The column of times with its factor.
pub fn time(head: &Head, roles: &[Role]) -> Option<Faulty<Scaled>> {
    let (column, _) = of_kind(roles, Kind::Time).next()?;
    let factor = head.factor("time unit", &head.table.columns[column], Dimension::Time);
    Some(factor.map(|factor| (column, factor)))
}

fn no_column(head: &Head, what: &str, names: &str) -> Box<Diagnostic> {
    let columns: Vec<_> = head.table.columns.iter().map(Column::head).collect();
    let hint = format!(
        "name one {names}, or say which it is, as in --columns {}; the columns are: {}",
        Quantity::EXAMPLE,
        columns.join(", ")
    );
    let position = head.table.columns_place.clone();
    head.fault(position, format!("there is no column of {what}"), &hint)
}

/// ε₂/ε₁ of nominal strains, for a biaxial test without a second column.
pub fn strain_ratio(head: &Head) -> Faulty<f64> {
    const KEY: &str = "strain ratio";
    let Some(ratio) = head.setting(KEY, None)? else {
        return Err(head.missing(KEY, "0.5"));
    };
    let number = ratio.parse::<f64>().ok().filter(|ratio| ratio.is_finite());
    number.ok_or_else(|| {
        let message = format!("the strain ratio {ratio} is not a number");
        head.fault_of(KEY, message, "it is ε₂/ε₁ of nominal strains")
    })
}

/// The unit of a column, or the one that is stated for its kind where the column has none that is known.
pub fn unit(head: &Head, column: &Column, kind: Kind) -> Option<String> {
    let stated = || head.setting(&format!("{} unit", kind.name()), None);
    let unit = column.unit.clone();
    let is_known =
        |unit: &&String| units::is_known(unit) || units::factor(unit, Dimension::Ratio).is_ok();
    let known = unit.as_ref().filter(is_known).cloned();
    known.or_else(|| stated().ok().flatten()).or(unit)
}

/// A dimension of the specimen without the rounding of its arithmetic.
fn rounded(value: f64) -> f64 {
    (1e9 * value).round() / 1e9
}

impl TableReading {
    /// The columns by their roles, and the first and last of the fitted rows.
    pub fn of(head: &Head, roles: &[Role], [first, last]: [usize; 2]) -> Self {
        let mut result = Self::default();
        for kind in [
            Kind::Strain,
            Kind::Stress,
            Kind::Time,
            Kind::Size,
            Kind::Other,
        ] {
            for (index, role) in of_kind(roles, kind) {
                let column = &head.table.columns[index];
                let name = if column.written.is_empty() {
                    format!("column {}", index + 1)
                } else {
                    format!("`{}`", column.written)
                };
                match kind {
                    Kind::Other => result.unread.push(name),
                    _ => result
                        .columns
                        .push(ColumnReading::of(head, roles, (column, name), role)),
                }
            }
        }
        let line = |row: usize| head.table.source.line(head.table.rows[row].1.start);
        result.lines = [line(first), line(last)];
        result
    }
}

impl ColumnReading {
    fn of(head: &Head, roles: &[Role], (column, name): (&Column, String), role: &Role) -> Self {
        let key = format!("{} measure", role.kind.name());
        let stated = || head.setting(&key, None).ok().flatten();
        let named = role.measure.map(str::to_owned).or_else(stated);
        let measure = named.unwrap_or_default();
        let divided_by = match &*measure {
            DISPLACEMENT => length_along(head, roles, role)
                .ok()
                .map(|length| format!("{} mm", rounded(length))),
            FORCE => area(head, roles, sized_axis(head, role))
                .ok()
                .map(|area| format!("{} mm²", rounded(area))),
            _ => None,
        };
        let quantity = match (&*measure, role.kind) {
            (_, Kind::Time) => "time".to_owned(),
            (_, Kind::Size) => "size at rest".to_owned(),
            ("green-lagrange", _) => "Green-Lagrange strain".to_owned(),
            (SECOND_PIOLA_KIRCHHOFF, _) => "second Piola-Kirchhoff stress".to_owned(),
            (DISPLACEMENT | FORCE | "stretch", _) => measure,
            ("cauchy", kind) => format!("Cauchy {}", kind.name()),
            ("", kind) => kind.name().to_owned(),
            (measure, kind) => format!("{measure} {}", kind.name()),
        };
        let axis = match role.numbered {
            Some(axis) => format!(" along axis {}", axis + 1),
            None => String::new(),
        };
        Self {
            quantity: format!("{quantity}{axis}"),
            column: name,
            unit: unit(head, column, role.kind).unwrap_or_else(|| "-".to_owned()),
            divided_by: divided_by.unwrap_or_default(),
        }
    }
}
