//! The meaning of a table's columns, and the rows read accordingly.

use std::ops::Range;

use super::cycles::{Turns, preconditioned};
use super::plausible::{check_signs, implausible, stress_at_rest};
use super::record::{Machine, Part};
use super::roles::{DISPLACEMENT, FORCE, Kind, Role, check_columns, of_kind, roles};
use super::rounding::WrittenColumn;
use super::test_data::{Loaded, Observation, StrainColumn, Test, TestData, Times};
use crate::document::{Faulty, Head, Table};
use crate::error::{Diagnostic, Error};
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::statistics::farthest;
use crate::units::Dimension;

/// The meaning of the columns.
pub struct Layout {
    test: Test,
    stress_measure: StressMeasure,
    strain: StrainColumn,
    /// Column and factor to a ratio, along both axes.
    strains: [Option<(usize, f64)>; 2],
    stresses: Vec<StressColumn>,
    /// ε₂/ε₁ of nominal strains in a biaxial test without a second column.
    strain_ratio: Option<f64>,
    /// The specimen of a table with one column of displacements and one of forces.
    machine: Option<Machine>,
    /// Column and factor to s; a fault where the unit is unknown.
    time: Option<Faulty<Scaled>>,
}

impl Layout {
    /// Determines the meaning of the columns; all missing information is reported at once.
    pub fn new(head: &Head) -> Result<Self, Vec<Diagnostic>> {
        let roles = roles(head);
        let mut faults = Faults::default();
        let test = faults.of(head.choice("test", None, &Test::NAMES));
        let strains = faults.of(strains(head, &roles));
        let stresses = faults.of(stresses(head, &roles));
        let machine = faults.of(machine(head, &roles));
        let (Some(test), Some((strain, strains)), Some((stress_measure, stresses)), Some(machine)) =
            (test, strains, stresses, machine)
        else {
            return Err(faults.0);
        };
        faults.of(check_columns(head, &roles, test));
        let ratio = (test == Test::Biaxial && strains[1].is_none()).then(|| strain_ratio(head));
        let strain_ratio = ratio.and_then(|ratio| faults.of(ratio));
        if !faults.0.is_empty() {
            return Err(faults.0);
        }
        Ok(Self {
            test,
            stress_measure,
            strain,
            strains,
            stresses,
            strain_ratio,
            machine,
            time: time(head, &roles),
        })
    }

    /// The columns that are read.
    pub fn columns(&self) -> impl Iterator<Item = usize> {
        let strains = self.strains.iter().flatten().map(|(column, _)| *column);
        strains.chain(self.stresses.iter().map(|(column, ..)| *column))
    }

    /// The columns that are read, including that of times.
    pub fn all_columns(&self) -> impl Iterator<Item = usize> {
        let time = self.time.iter().flatten().map(|(column, _)| *column);
        self.columns().chain(time)
    }

    /// The strains of an observation along an axis: the strain across a strip is not known.
    fn along(&self, axis: usize, [first, second]: [f64; 2]) -> [f64; 2] {
        match self.test == Test::Uniaxial && axis == 1 {
            true => [f64::NAN, first],
            false => [first, second],
        }
    }

    /// Reads the rows.
    pub fn read(&self, head: &Head) -> Faulty<TestData> {
        let table = head.table;
        let part = self.part(head)?;
        let (mut kept, mut left_out) = (Vec::new(), Vec::new());
        let mut turns = Turns::default();
        for (index, (row, place)) in table.rows.iter().enumerate() {
            let [first, second] = self.strains_of(row, &part);
            if [first, second].iter().any(|x| *x <= -1.0) {
                let message = format!("the stretch is {}", 1.0 + first.min(second));
                let hint = "stretches are greater than zero; is the column a strain?";
                return Err(head.fault(place.clone(), message, hint));
            }
            let observations = match part.rows.contains(&index) {
                true => &mut kept,
                false => &mut left_out,
            };
            if part.remarks.is_empty() && part.rows.contains(&index) {
                turns.add(index, first);
            }
            for (column, factor, axis) in &self.stresses {
                observations.push(Observation {
                    strains: self.along(*axis, [first, second]),
                    axis: *axis,
                    stress: part.stress(row[*column] * factor),
                });
            }
        }
        let observations = kept;
        let stresses = observations.iter().map(|one| one.stress.abs());
        let largest_stress = stresses.fold(0.0, f64::max);
        check_signs(head, &observations, self.test)?;
        let widest = [0, 1].map(|axis| farthest(observations.iter().map(|one| one.strains[axis])));
        let at_rest = stress_at_rest(head, &observations).filter(|_| part.offset == 0.0);
        let warnings = [
            turns.warning(head),
            implausible(head, self.strain, widest[0].abs().max(widest[1].abs())),
            at_rest,
        ];
        Ok(TestData {
            name: table.source.name.clone(),
            test: self.test,
            stress_measure: self.stress_measure,
            axes: self.stresses.iter().map(|(.., axis)| *axis).collect(),
            drawn_axis: usize::from(widest[1].abs() > widest[0].abs()),
            loaded: Loaded::of(observations.iter().flat_map(|one| one.strains)),
            observations,
            largest_stress,
            rounding: self.rounding(table, &part.rows),
            times: self.times(table, &part),
            rise: head.quantity("ramp", Dimension::Time)?.unwrap_or(0.0),
            preconditioned: preconditioned(head, self.test, farthest(widest))?,
            left_out,
            found_zero: part.found_zero,
            remarks: part.remarks,
            head: head.written(),
            warnings: warnings.into_iter().flatten().collect(),
        })
    }

    /// The part of the table that is fitted.
    fn part(&self, head: &Head) -> Faulty<Part> {
        let rows = &head.table.rows;
        let plain = Part::whole(rows.len());
        let strains = rows.iter().map(|(row, _)| self.strains_of(row, &plain)[0]);
        let (column, factor, _) = self.stresses[0];
        let stresses = rows.iter().map(|(row, _)| row[column] * factor);
        let [strains, stresses] = [strains.collect::<Vec<_>>(), stresses.collect()];
        Part::of(head, self.machine, &strains, &stresses)
    }

    /// The time of every observation.
    fn times(&self, table: &Table, part: &Part) -> Times {
        let (column, factor) = match &self.time {
            None => return Times::None,
            Some(Err(fault)) => return Times::Unknown(fault.clone()),
            Some(Ok(scaled)) => *scaled,
        };
        let hint = "every row has a time";
        if let Err(Error::Input(faults)) = table.check_numbers([column], hint)
            && let Some(fault) = faults.into_iter().next()
        {
            return Times::Unknown(Box::new(fault));
        }
        let rows = &table.rows[part.rows.clone()];
        let times = rows.iter().map(|(row, _)| row[column] * factor);
        let each = self.stresses.len();
        Times::Known(times.flat_map(|time| vec![time; each]).collect())
    }

    /// The rounding of strains and stresses; zero for strains that were commanded.
    fn rounding(&self, table: &Table, rows: &Range<usize>) -> [f64; 2] {
        let own = |column: usize| WrittenColumn::of(table, column, rows);
        let measured = own(self.stresses[0].0);
        let of_strain = |(column, factor): &Scaled| {
            let read = |value: f64| self.strain.to_nominal(value * factor);
            let strains = own(*column);
            match strains.is_commanded(&measured) {
                true => 0.0,
                false => strains.rounding(&read),
            }
        };
        let stresses = self.stresses.iter();
        let stresses = stresses.map(|(column, factor, _)| own(*column).rounding(&|y| y * factor));
        let strains = self.strains.iter().flatten().map(of_strain);
        [strains.fold(0.0, f64::max), stresses.fold(0.0, f64::max)]
    }

    /// λ − 1 along both axes in a row.
    fn strains_of(&self, row: &[f64], part: &Part) -> [f64; 2] {
        let strain = |axis: usize| {
            let read = |(column, factor): (usize, f64)| {
                part.strain(self.strain.to_nominal(row[column] * factor))
            };
            self.strains[axis].map_or(f64::NAN, read)
        };
        let first = strain(0);
        let second = match self.test {
            Test::Uniaxial => f64::NAN,
            Test::Planar => 0.0,
            Test::Equibiaxial => first,
            Test::Biaxial => self
                .strain_ratio
                .map_or_else(|| strain(1), |ratio| ratio * first),
        };
        [first, second]
    }
}

/// Missing information and faults, each once.
#[derive(Default)]
struct Faults(Vec<Diagnostic>);

impl Faults {
    /// The value that was found, or `None` after recording a fault.
    fn of<T>(&mut self, found: Faulty<T>) -> Option<T> {
        let fault = match found {
            Ok(found) => return Some(found),
            Err(fault) => *fault,
        };
        if self.0.iter().all(|known| known.message != fault.message) {
            self.0.push(fault);
        }
        None
    }
}

/// A test begins at a stretch of 1; a test that begins beyond this factor of it may be in percent.
const AT_REST: f64 = 10.0;

/// Whether a column of stretches without a unit contains plain ratios.
fn is_plain_stretch(head: &Head, column: usize) -> bool {
    let values = head.table.rows.iter().map(|(row, _)| row[column].abs());
    values.fold(f64::INFINITY, f64::min) < AT_REST
}

/// Column and factor to a ratio, or to MPa.
type Scaled = (usize, f64);

/// Column, factor to MPa and axis of a stress.
type StressColumn = (usize, f64, usize);

fn strains(head: &Head, roles: &[Role]) -> Faulty<(StrainColumn, [Option<Scaled>; 2])> {
    let Some((first, role)) = of_kind(roles, Kind::Strain).min_by_key(|(_, role)| role.axis) else {
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
        let named = &head.table.columns[column];
        let factor = if displaced {
            let unit = head.factor("strain unit", named, Dimension::Length)?;
            unit / head.required_quantity("length", Dimension::Length)?
        } else {
            let plain = measure == StrainColumn::Stretch && is_plain_stretch(head, column);
            let unit = head.setting("strain unit", named.unit.as_deref())?;
            match unit {
                None if plain => 1.0,
                _ => head.factor("strain unit", named, Dimension::Ratio)?,
            }
        };
        Ok((column, factor))
    };
    let across = of_kind(roles, Kind::Strain).find(|(_, role)| role.axis == 1);
    let across = across.map(|(column, _)| scaled(column)).transpose()?;
    Ok((measure, [Some(scaled(first)?), across]))
}

fn stresses(head: &Head, roles: &[Role]) -> Faulty<(StressMeasure, Vec<StressColumn>)> {
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
        let named = &head.table.columns[column];
        let factor = if loaded {
            let unit = head.factor("stress unit", named, Dimension::Force)?;
            unit / area(head)?
        } else {
            head.factor("stress unit", named, Dimension::Stress)?
        };
        columns.push((column, factor, role.axis.max(direction)));
    }
    Ok((measure, columns))
}

/// The cross-section of the specimen in mm²: the stated one, or width times thickness.
fn area(head: &Head) -> Faulty<f64> {
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
fn machine(head: &Head, roles: &[Role]) -> Faulty<Option<Machine>> {
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
fn time(head: &Head, roles: &[Role]) -> Option<Faulty<Scaled>> {
    let (column, _) = of_kind(roles, Kind::Time).next()?;
    let factor = head.factor("time unit", &head.table.columns[column], Dimension::Time);
    Some(factor.map(|factor| (column, factor)))
}

fn no_column(head: &Head, what: &str, names: &str) -> Box<Diagnostic> {
    let columns: Vec<_> = head.table.columns.iter().map(|one| &*one.name).collect();
    let hint = format!("name one {names}; the columns are: {}", columns.join(", "));
    let place = head.table.columns_place.clone();
    head.fault(place, format!("there is no column of {what}"), &hint)
}

/// ε₂/ε₁ of nominal strains, for a biaxial test without a second column.
fn strain_ratio(head: &Head) -> Faulty<f64> {
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
