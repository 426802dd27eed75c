//! The meaning of a table's columns, and the rows read accordingly.

use std::ops::Range;

use super::choice::Choice;
use super::columns::{Scaled, StressColumn, machine, strain_ratio, strains, stresses, time};
use super::cycles::{SPECIMEN_NAME, preconditioned, reversals};
use super::mounting::Mounted;
use super::mounting_statements::refuse_cauchy;
use super::plausible::{check_signs, check_sizes, implausible, stress_at_rest};
use super::record::{Curve, Machine, Part};
use super::roles::{Kind, Role, check_columns, of_kind};
use super::rounding::WrittenColumn;
use super::row_choice::{protocols, rows_in_range};
use super::strain_column::{StrainColumn, flip};
use super::table_reading::TableReading;
use super::test_data::{Loaded, Observation, Test, TestData, Times};
use crate::document::{Faulty, Head, Table};
use crate::error::{Diagnostic, Error};
use crate::material::parameters::StressMeasure;
use crate::statistics::{extremes, farthest};
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
    /// How the sheet is held.
    mounted: Mounted,
    /// What each column is read as.
    roles: Vec<Role>,
}

impl Layout {
    /// Determines the meaning of the columns; all missing information is reported at once.
    pub fn new(head: &Head) -> Result<Self, Vec<Diagnostic>> {
        let mut faults = Faults::default();
        let stated = head.choice("test", None, &Test::NAMES);
        let Choice {
            roles,
            questions,
            of_times,
            ..
        } = Choice::of(head, stated.as_ref().ok().copied())?;
        // Strains that are measured along two axes are those of a biaxial test, whatever its ratio.
        let strains_across = of_kind(&roles, Kind::Strain).filter(|(_, role)| role.axis() == 1);
        let test = match strains_across.count() {
            1 if matches!(head.setting("test", None), Ok(None)) => Some(Test::Biaxial),
            _ => faults.of(stated),
        };
        faults.0.extend(questions);
        let strains = faults.of(strains(head, &roles, test));
        let stresses = faults.of(stresses(head, &roles, test));
        let machine = faults.of(machine(head, &roles));
        let (Some(test), Some((strain, strains)), Some((stress_measure, stresses)), Some(machine)) =
            (test, strains, stresses, machine)
        else {
            return Err(faults.0);
        };
        faults.of(check_columns(head, &roles, test));
        let [turn_strain, turn_stress] = faults.of(flip(head, strain)).unwrap_or([1.0; 2]);
        let flipped = |(column, factor)| (column, turn_strain * factor);
        let strains = strains.map(|along| along.map(flipped));
        let turned = |column: StressColumn| StressColumn {
            factor: turn_stress * column.factor,
            ..column
        };
        let stresses = stresses.into_iter().map(turned).collect();
        let ratio = (test == Test::Biaxial && strains[1].is_none()).then(|| strain_ratio(head));
        let strain_ratio = ratio.and_then(|ratio| faults.of(ratio));
        let mounted = faults
            .of(Mounted::stated(head, &roles, test))
            .unwrap_or_default();
        if mounted.mounting.is_some() && stress_measure == StressMeasure::Cauchy {
            faults.of::<()>(Err(refuse_cauchy(head)));
        }
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
            time: match of_times {
                Some(question) => Some(Err(Box::new(question))),
                None => time(head, &roles),
            },
            mounted,
            roles,
        })
    }

    /// The columns that are read.
    pub fn columns(&self) -> impl Iterator<Item = usize> {
        let strains = self.strains.iter().flatten().map(|(column, _)| *column);
        strains.chain(self.stresses.iter().map(|stress| stress.column))
    }

    /// Those of some rows that are `chosen` by strains and stresses of any axis.
    pub fn unlike(
        &self,
        table: &Table,
        rows: &[usize],
        chosen: fn(&[f64], &[f64]) -> Vec<usize>,
    ) -> Vec<usize> {
        let row = |row: &usize| &table.rows[*row].0;
        // Without any zero found in the record.
        let plain = Part::all_rows(0);
        let of_rows = rows.iter().map(|at| self.strains_of(row(at), &plain)[0]);
        let strains: Vec<f64> = of_rows.collect();
        let of_axis = |stress: &StressColumn| {
            let stresses: Vec<f64> = rows.iter().map(|at| row(at)[stress.column]).collect();
            chosen(&strains, &stresses)
        };
        let mut all: Vec<usize> = self.stresses.iter().flat_map(of_axis).collect();
        all.sort_unstable();
        all.dedup();
        all.into_iter().map(|at| rows[at]).collect()
    }

    /// Whether the times of some rows decrease from each to the next.
    pub fn runs_backwards(&self, table: &Table, rows: &[usize]) -> bool {
        let Some(Ok((column, _))) = self.time else {
            return false;
        };
        let time = |row: usize| table.rows[row].0[column];
        rows.len() > 1 && rows.windows(2).all(|pair| time(pair[1]) < time(pair[0]))
    }

    /// The strains of an observation along an axis: the strain across a strip is not known.
    fn along(&self, axis: usize, [first, second]: [f64; 2]) -> [f64; 2] {
        if self.test == Test::Uniaxial && axis == 1 {
            [f64::NAN, first]
        } else {
            [first, second]
        }
    }

    /// Reads the rows.
    pub fn read(&self, head: &Head) -> Faulty<TestData> {
        let table = head.table;
        check_sizes(head, &self.roles)?;
        let part = Part::of(head, self.machine, || self.curves(table))?;
        let strain = |row: usize| self.strains_of(&table.rows[row].0, &part)[0];
        let rows = rows_in_range(head, &part.rows, strain)?;
        let ends = [rows[0], rows[rows.len() - 1]];
        let (mut kept, mut left_out) = (Vec::new(), Vec::new());
        let mut along = Vec::new();
        for (index, (row, position)) in table.rows.iter().enumerate() {
            let [first, second] = self.strains_of(row, &part);
            let is_stretched = self.test != Test::SimpleShear;
            if is_stretched && [first, second].iter().any(|x| *x <= -1.0) {
                let message = format!("the stretch is {}", 1.0 + first.min(second));
                let hint = "stretches are greater than zero; is the column a strain?";
                return Err(head.fault(position.clone(), message, hint));
            }
            let is_kept = rows.binary_search(&index).is_ok();
            if part.remarks.is_empty() && is_kept {
                // The size of a biaxial strain: protocols begin where both are small.
                along.push((index, farthest([first, second])));
            }
            let observations = if is_kept { &mut kept } else { &mut left_out };
            observations.extend(self.observations(row, [first, second], &part));
        }
        let observations = kept;
        let column = self.machine.is_none().then_some(self.strain);
        check_signs(head, &observations, self.test, column)?;
        let widest = Observation::farthest_strains(&observations);
        let at_rest = stress_at_rest(head, &observations).filter(|_| part.offset == 0.0);
        let warnings = [
            reversals(head, self.test, &along),
            implausible(head, self.strain, &observations),
            at_rest,
        ];
        let data = TestData {
            name: table.source.name.clone(),
            test: self.test,
            stress_measure: self.stress_measure,
            axes: self.stresses.iter().map(|stress| stress.axis).collect(),
            drawn_axis: Observation::drawn_axis(widest),
            loaded: Loaded::of(observations.iter().flat_map(|one| one.strains)),
            largest_stress: Observation::largest_stress(&observations),
            observations,
            rounding: self.rounding(table, &rows),
            times: self.times(table, &rows),
            rise: head.quantity("ramp", Dimension::Time)?.unwrap_or(0.0),
            preconditioned: preconditioned(head, self.test, farthest(widest))?,
            left_out,
            found_zero: part.found_zero,
            mounted: self.mounted,
            specimen: head.text(SPECIMEN_NAME)?,
            table: TableReading::of(head, &self.roles, ends),
            remarks: part.remarks,
            head: head.written(),
            warnings: warnings.into_iter().flatten().collect(),
        };
        Ok(data.stretched(self.mounted.stated_stretches()))
    }

    /// The observations of a row with these strains.
    fn observations<'a>(
        &'a self,
        row: &'a [f64],
        strains: [f64; 2],
        part: &'a Part,
    ) -> impl Iterator<Item = Observation> + 'a {
        self.stresses.iter().map(move |column| {
            let strains = self.along(column.axis, strains);
            let stress = part.stress(row[column.column] * column.factor);
            let stretch = if column.is_second {
                1.0 + strains[column.axis]
            } else {
                1.0
            };
            Observation {
                strains,
                axis: column.axis,
                stress: stretch * stress,
            }
        })
    }

    /// The curve of each protocol of a biaxial test, and the only one of any other, or of a machine.
    fn curves(&self, table: &Table) -> Vec<Curve> {
        let protocols = match self.test {
            Test::Biaxial if self.machine.is_none() => protocols(table),
            _ => vec![(String::new(), 0..table.rows.len())],
        };
        let are_several = protocols.len() > 1;
        let curve = |(name, rows): (String, Range<usize>)| {
            let title = if are_several {
                format!("protocol `{name}`: ")
            } else {
                String::new()
            };
            self.curve(table, title, rows)
        };
        protocols.into_iter().map(curve).collect()
    }

    /// The curve of some rows along the first axis, or along a measured second one that is stretched more than twice as far.
    fn curve(&self, table: &Table, title: String, rows: Range<usize>) -> Curve {
        let plain = Part::all_rows(0);
        let of_rows = || table.rows[rows.clone()].iter().map(|(row, _)| row);
        let strains = [0, 1].map(|axis| {
            let strain = |row: &Vec<f64>| self.strains_of(row, &plain)[axis];
            of_rows().map(strain).collect::<Vec<f64>>()
        });
        let [first, second] = strains.each_ref().map(|along| {
            let [low, high] = extremes(along.iter().copied());
            high - low
        });
        let axis = usize::from(self.strains[1].is_some() && second > 2.0 * first);
        let along = self.stresses.iter().find(|stress| stress.axis == axis);
        let stress = along.unwrap_or(&self.stresses[0]);
        let [first, second] = strains;
        Curve {
            title,
            stresses: of_rows()
                .map(|row| row[stress.column] * stress.factor)
                .collect(),
            strains: if axis == 0 { first } else { second },
            rows,
        }
    }

    /// The time of every observation.
    fn times(&self, table: &Table, rows: &[usize]) -> Times {
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
        let times = rows.iter().map(|row| table.rows[*row].0[column] * factor);
        let each = self.stresses.len();
        Times::Known(times.flat_map(|time| vec![time; each]).collect())
    }

    /// The rounding of strains and stresses; zero for strains that were commanded.
    fn rounding(&self, table: &Table, rows: &[usize]) -> [f64; 2] {
        let written = |column: usize| WrittenColumn::of(table, column, rows);
        let measured = written(self.stresses[0].column);
        let of_strain = |(column, factor): &Scaled| {
            let read = |value: f64| self.strain.to_nominal(value * factor);
            let strains = written(*column);
            if strains.is_commanded(&measured) {
                0.0
            } else {
                strains.rounding(&read)
            }
        };
        let columns = self.stresses.iter();
        let stresses =
            columns.map(|stress| written(stress.column).rounding(&|y| y * stress.factor));
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
            Test::Uniaxial | Test::SimpleShear => f64::NAN,
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
    fn of<T>(&mut self, outcome: Faulty<T>) -> Option<T> {
        let fault = match outcome {
            Ok(value) => return Some(value),
            Err(fault) => *fault,
        };
        if self.0.iter().all(|known| known.message != fault.message) {
            self.0.push(fault);
        }
        None
    }
}
