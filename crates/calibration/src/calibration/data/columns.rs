//! Measures and units of the columns that are read.

use std::ops::Range;

use super::record::Machine;
use super::roles::{DISPLACEMENT, FORCE, Kind, Quantity, Role, of_kind};
use super::table_reading::{ColumnReading, TableReading};
use super::test_data::StrainColumn;
use crate::document::{Column, ColumnRole, Faulty, Head};
use crate::error::Diagnostic;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::units::Dimension;

/// A test begins at a stretch of 1; a test that begins beyond this factor of it may be in percent.
const AT_REST: f64 = 10.0;

/// The factor from a column of strains or displacements to a ratio; stretches without a unit are plain ratios where they begin near 1.
pub fn strain_factor(
    head: &Head,
    column: usize,
    is_displacement: bool,
    measure: StrainColumn,
) -> Faulty<f64> {
    let named = &head.table.columns[column];
    if is_displacement {
        let unit = head.factor("strain unit", named, Dimension::Length)?;
        return Ok(unit / head.required_quantity("length", Dimension::Length)?);
    }
    let values = head.table.rows.iter().map(|(row, _)| row[column].abs());
    let begins_at_rest = || values.fold(f64::INFINITY, f64::min) < AT_REST;
    let unit = head.setting("strain unit", named.unit.as_deref())?;
    if unit.is_none() && measure == StrainColumn::Stretch && begins_at_rest() {
        Ok(1.0)
    } else {
        head.factor("strain unit", named, Dimension::Ratio)
    }
}

/// The factor from a column of stresses or forces to MPa.
pub fn stress_factor(head: &Head, column: usize, is_force: bool) -> Faulty<f64> {
    let named = &head.table.columns[column];
    if is_force {
        Ok(head.factor("stress unit", named, Dimension::Force)? / area(head)?)
    } else {
        head.factor("stress unit", named, Dimension::Stress)
    }
}

/// Column and factor to a ratio, or to MPa.
pub type Scaled = (usize, f64);

/// Column, factor to MPa and axis of a stress.
pub type StressColumn = (usize, f64, usize);

/// The measure of the strains, and the columns with their factors to a ratio along both axes.
pub fn strains(head: &Head, roles: &[Role]) -> Faulty<(StrainColumn, [Option<Scaled>; 2])> {
    let Some((first, role)) = of_kind(roles, Kind::Strain).min_by_key(|(_, role)| role.axis())
    else {
        let names = "`stretch`, `nominal_strain` or `logarithmic_strain`";
        return Err(no_column(head, "strains", names));
    };
    let displaced = role.measure == Some(DISPLACEMENT);
    let measure = if displaced {
        StrainColumn::Strain(StrainMeasure::Nominal)
    } else {
        head.choice("strain measure", role.measure, &StrainColumn::NAMES)?
    };
    let scaled = |column: usize| -> Faulty<Scaled> {
        Ok((column, strain_factor(head, column, displaced, measure)?))
    };
    let across = of_kind(roles, Kind::Strain).find(|(_, role)| role.axis() == 1);
    let across = across.map(|(column, _)| scaled(column)).transpose()?;
    Ok((measure, [Some(scaled(first)?), across]))
}

/// The measure of the stresses, and their columns.
pub fn stresses(head: &Head, roles: &[Role]) -> Faulty<(StressMeasure, Vec<StressColumn>)> {
    let Some((_, role)) = of_kind(roles, Kind::Stress).next() else {
        let names = "`nominal_stress`, `cauchy_stress` or `force`";
        return Err(no_column(head, "stresses", names));
    };
    let loaded = role.measure == Some(FORCE);
    let measure = if loaded {
        StressMeasure::Nominal
    } else {
        head.choice("stress measure", role.measure, &StressMeasure::NAMES)?
    };
    let direction = match head.setting("direction", None)?.as_deref() {
        None | Some("1") => 0,
        Some("2") => 1,
        Some(other) => {
            let message = format!("the direction {other} is not 1 or 2");
            let hint = "1 is the axis of the strain column, 2 the one across";
            return Err(head.fault(head.place("direction"), message, hint));
        }
    };
    let mut columns = Vec::new();
    for (column, role) in of_kind(roles, Kind::Stress) {
        let factor = stress_factor(head, column, loaded)?;
        columns.push((column, factor, role.axis().max(direction)));
    }
    Ok((measure, columns))
}

/// The cross-section of the specimen in mm²: the stated one, or width times thickness.
pub fn area(head: &Head) -> Faulty<f64> {
    let stated = head.quantity("area", Dimension::Area)?;
    let sides = ["width", "thickness"].map(|key| head.quantity(key, Dimension::Length));
    match (stated, sides) {
        (Some(area), [Ok(None), Ok(None)]) => Ok(area),
        (None, [Ok(None), Ok(None)]) => {
            let mut fault = head.missing("area", "20 mm^2");
            let hint = fault.hint.take().unwrap_or_default();
            fault.hint = Some(format!("{hint}; or width and thickness of the specimen"));
            Err(fault)
        }
        (None, [width, thickness]) => {
            let side = |side: Option<f64>, key| side.ok_or_else(|| head.missing(key, "2 mm"));
            Ok(side(width?, "width")? * side(thickness?, "thickness")?)
        }
        (Some(_), _) => {
            let message = "the area is stated, and width or thickness too";
            Err(head.fault(head.place("area"), message, "state the area, or both sides"))
        }
    }
}

/// The specimen of a table with one column of displacements and one of forces.
pub fn machine(head: &Head, roles: &[Role]) -> Faulty<Option<Machine>> {
    let only = |kind, measure| {
        let mut own = of_kind(roles, kind);
        let first = own
            .next()
            .is_some_and(|(_, role)| role.measure == Some(measure));
        first && own.next().is_none()
    };
    if !only(Kind::Strain, DISPLACEMENT) || !only(Kind::Stress, FORCE) {
        return Ok(None);
    }
    Ok(Some(Machine {
        length: head.required_quantity("length", Dimension::Length)?,
        area: area(head)?,
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
    let place = head.table.columns_place.clone();
    head.fault(place, format!("there is no column of {what}"), &hint)
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
        head.fault(head.place(KEY), message, "it is ε₂/ε₁ of nominal strains")
    })
}

/// The unit of a column, or the one that is stated for its kind.
pub fn unit(head: &Head, column: &Column, kind: Kind) -> Option<String> {
    let said = || head.setting(&format!("{} unit", kind.name()), None);
    column.unit.clone().or_else(|| said().ok().flatten())
}

impl TableReading {
    /// What some roles say, and the rows that are fitted.
    pub fn of(head: &Head, roles: &[Role], rows: &Range<usize>) -> Self {
        let mut found = Self::default();
        for kind in [Kind::Strain, Kind::Stress, Kind::Time, Kind::Other] {
            for (index, role) in of_kind(roles, kind) {
                let column = &head.table.columns[index];
                let name = if column.written.is_empty() {
                    format!("column {}", index + 1)
                } else {
                    format!("`{}`", column.written)
                };
                match kind {
                    Kind::Other => found.unread.push(name),
                    _ => found
                        .columns
                        .push(ColumnReading::of(head, (column, name), role)),
                }
            }
        }
        let line = |row: usize| {
            let (_, place) = &head.table.rows[row.min(head.table.rows.len() - 1)];
            head.table.source.line(place.start)
        };
        found.lines = [line(rows.start), line(rows.end.saturating_sub(1))];
        found
    }
}

impl ColumnReading {
    fn of(head: &Head, (column, name): (&Column, String), role: &Role) -> Self {
        let key = format!("{} measure", role.kind.name());
        let said = || head.setting(&key, None).ok().flatten();
        let measure = role.measure.map(str::to_owned).or_else(said);
        let measure = measure.unwrap_or_default();
        let length = || head.quantity("length", Dimension::Length).ok().flatten();
        let divided_by = match &*measure {
            DISPLACEMENT => length().map(|length| format!("{length} mm")),
            FORCE => area(head).ok().map(|area| format!("{area} mm²")),
            _ => None,
        };
        let quantity = match (&*measure, role.kind) {
            (_, Kind::Time) => "time".to_owned(),
            (DISPLACEMENT | FORCE | "stretch", _) => measure,
            ("cauchy", kind) => format!("Cauchy {}", kind.name()),
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
