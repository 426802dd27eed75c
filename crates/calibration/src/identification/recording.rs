//! Recorded force and motion of one spring.

use std::ops::Range;
use std::path::Path;

use crate::document::{
    ColumnNames, Faulty, Head, MACHINE_DISPLACEMENTS, MACHINE_FORCES, Statements, TIMES, Table,
    column_meaning,
};
use crate::error::{Diagnostic, Error};
use crate::statistics::median;
use crate::units::{Dimension, QuantityFault};

/// Force and motion at increasing instants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Instants in s.
    pub times: Vec<f64>,
    /// Extension beyond the length at rest in mm.
    pub extension: Vec<f64>,
    /// Tensile force in N.
    pub force: Vec<f64>,
    /// The mass that the force moves, in tonne; zero where none is stated.
    pub mass: f64,
    /// Length at rest in mm, where it is known.
    pub length: Option<f64>,
    /// Cross-section at rest in mm², where it is known.
    pub area: Option<f64>,
}

/// Fewest instants that are accepted.
const FEWEST: usize = 30;

/// What a column records.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Signal {
    Time,
    Extension,
    Length,
    Stretch,
    Force,
}

/// The names of columns; those of people count before those of machines.
const NAMES: &ColumnNames<Signal> = &[
    (Signal::Time, TIMES),
    (Signal::Extension, "extension displacement"),
    (Signal::Extension, MACHINE_DISPLACEMENTS),
    (Signal::Length, "length"),
    (Signal::Stretch, "stretch lambda λ"),
    (Signal::Force, "force load"),
    (Signal::Force, MACHINE_FORCES),
];

impl Signal {
    /// The signals that give the motion.
    const MOTIONS: [Self; 3] = [Self::Extension, Self::Length, Self::Stretch];

    /// The usual name of its column, and the dimension.
    fn usual(self) -> (&'static str, Dimension) {
        match self {
            Self::Time => ("time", Dimension::Time),
            Self::Extension => ("extension", Dimension::Length),
            Self::Length => ("length", Dimension::Length),
            Self::Stretch => ("stretch", Dimension::Ratio),
            Self::Force => ("force", Dimension::Force),
        }
    }

    /// Its column in a table.
    fn column(self, table: &Table) -> Option<usize> {
        column_meaning(NAMES, self, table)
    }
}

/// Statements of a file or the command line about a recording: the mass that the force moves, length and cross-section at rest.
const KEYS: [&str; 3] = ["mass", "length", "area"];

impl Recording {
    /// The usual time between two instants in s: the median.
    pub fn interval(&self) -> f64 {
        median(self.times.windows(2).map(|pair| pair[1] - pair[0]))
    }

    /// Reads a table with the columns `time`, `extension` or `length` or `stretch`, and `force`; `given` supplements
    /// the head: `mass`, `length`, `area`.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the file.
    pub fn read(path: &Path, given: &Statements) -> Result<Self, Error> {
        Self::of_table(&Table::read(path, Table::HINT)?, given)
    }

    /// Reads the columns of a table.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the table.
    pub fn of_table(table: &Table, given: &Statements) -> Result<Self, Error> {
        let head = Head::new(table, &KEYS, given)?;
        let mut reader = Reader {
            table,
            faults: Vec::new(),
        };
        let times = reader.column(Signal::Time);
        let mut motions = Signal::MOTIONS.into_iter();
        let motion = motions.find(|signal| signal.column(table).is_some());
        let positions = motion.map(|signal| reader.column(signal));
        if motion.is_none() {
            let message = "there is no column of the motion";
            let hint = "name one `extension [mm]`, `length [mm]` or `stretch [-]`";
            reader.fault(table.columns_place.clone(), message, hint);
        }
        let force = reader.column(Signal::Force);
        let mass = reader.take(head.quantity("mass", Dimension::Mass));
        let kind = motion.unwrap_or(Signal::Extension);
        let length = reader.take(match kind {
            Signal::Extension => head.quantity("length", Dimension::Length),
            _ => head
                .required_quantity("length", Dimension::Length)
                .map(Some),
        });
        let area = reader.take(head.quantity("area", Dimension::Area));
        reader.increasing(&times);
        if !reader.faults.is_empty() {
            return Err(Error::Input(reader.faults));
        }
        let rest = length.unwrap_or_default();
        let extension = |value: &f64| match kind {
            Signal::Length => value - rest,
            Signal::Stretch => (value - 1.0) * rest,
            _ => *value,
        };
        let recording = Self {
            extension: positions
                .unwrap_or_default()
                .iter()
                .map(extension)
                .collect(),
            times,
            force,
            mass: mass.unwrap_or_default(),
            length,
            area,
        };
        recording.check_motion(table)?;
        Ok(recording)
    }

    fn check_motion(&self, table: &Table) -> Result<(), Error> {
        let still = |values: &[f64]| values.iter().all(|value| *value == values[0]);
        let message = match () {
            () if self.times.len() < FEWEST => format!("{} instants are too few", self.times.len()),
            () if still(&self.extension) => "nothing moves in this recording".to_owned(),
            () if still(&self.force) => "the force never changes in this recording".to_owned(),
            () => return Ok(()),
        };
        let hint = format!(
            "record at least {FEWEST} instants of a motion that stretches and slackens the spring"
        );
        Err(table.refuse(0..0, message, &hint))
    }
}

struct Reader<'a> {
    table: &'a Table,
    faults: Vec<Diagnostic>,
}

impl Reader<'_> {
    fn fault(&mut self, position: Range<usize>, message: impl Into<String>, hint: &str) {
        self.faults.push(self.table.fault(position, message, hint));
    }

    fn take<T: Default>(&mut self, result: Faulty<T>) -> T {
        result.unwrap_or_else(|fault| {
            self.faults.push(*fault);
            T::default()
        })
    }

    /// A column in the internal unit.
    fn column(&mut self, signal: Signal) -> Vec<f64> {
        let (name, dimension) = signal.usual();
        let position = self.table.columns_place.clone();
        let Some(index) = signal.column(self.table) else {
            let unit = dimension.units().next().unwrap_or("-");
            let hint = format!("name one `{name} [{unit}]`");
            self.fault(position, format!("there is no column `{name}`"), &hint);
            return Vec::new();
        };
        let hint = "every row needs a number in this column";
        if let Err(Error::Input(faults)) = self.table.check_numbers([index], hint) {
            self.faults.extend(faults);
        }
        match self.table.columns[index].factor(dimension) {
            Ok(factor) => {
                let rows = self.table.rows.iter();
                rows.map(|(row, _)| factor * row[index]).collect()
            }
            Err(reason) => {
                let units: Vec<_> = dimension.units().collect();
                let hint = match &reason {
                    QuantityFault::UnknownUnit(unit) => reason.remedy(unit, dimension),
                    _ => format!(
                        "write the unit in brackets after the name; known: {}",
                        units.join(", ")
                    ),
                };
                self.fault(position, format!("the column `{name}` {reason}"), &hint);
                Vec::new()
            }
        }
    }

    fn increasing(&mut self, times: &[f64]) {
        let wrong = times.windows(2).position(|pair| pair[1] <= pair[0]);
        if let Some(row) = wrong {
            let (first, second) = (times[row], times[row + 1]);
            let message = format!("time {second} s does not come after {first} s");
            let position = self.table.rows[row + 1].1.clone();
            let hint = "sort the rows by time and leave out repeated ones";
            self.fault(position, message, hint);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assertions::assert_contains;

    fn rows(count: usize) -> String {
        let row = |i: usize| format!("{},{},{}\n", 2 * i, 1.0 + 0.1 * (i % 7) as f64, 3 * (i % 7));
        (0..count).map(row).collect()
    }

    fn read(text: &str) -> Result<Recording, Error> {
        Recording::of_table(&Table::parse("a.csv", text).unwrap(), &Statements::new())
    }

    #[test]
    fn units_and_measures_become_internal_ones() {
        let text = format!(
            "# mass: 5 g\n# length: 5 cm\ntime [ms],stretch [-],force [mN]\n{}",
            rows(40)
        );
        let recording = read(&text).unwrap();
        assert!((recording.times[3] - 0.006).abs() < 1e-15);
        assert!((recording.extension[3] - 15.0).abs() < 1e-12);
        assert!((recording.force[3] - 0.009).abs() < 1e-15);
        assert!((recording.mass - 5e-6).abs() < 1e-18);
        assert_eq!(recording.length, Some(50.0));
    }

    #[test]
    fn the_names_that_machines_give_to_columns_are_known() {
        let usual = read(&format!("time [s],extension [mm],force [N]\n{}", rows(40))).unwrap();
        let machine = "Elapsed Time (s),Stroke (mm),Standardkraft (N)";
        assert_eq!(read(&format!("{machine}\n{}", rows(40))).unwrap(), usual);
    }

    #[test]
    fn all_faults_of_a_recording_are_told_with_place_and_remedy() {
        let output = read(&format!(
            "# mass: 5 cm\ntime [mm],force\n{}",
            "1,2\n0.5,3\n".repeat(20)
        ));
        let output = output.unwrap_err().to_string();
        for part in [
            "a.csv:2: the column `time` has the unit `mm`, which measures length",
            "a.csv:2: there is no column of the motion (name one `extension [mm]`",
            "the column `force` has no unit",
            "a.csv:1: the mass \"5 cm\" has the unit `cm`",
        ] {
            assert!(output.contains(part), "{part}: {output}");
        }
        let head = "time [s],extension [mm],force [N]\n";
        let stretch = "time [s],stretch,force [N]\n";
        let (few, many) = (rows(20), rows(40));
        for (text, fault) in [
            (format!("{head}{few}"), "20 instants are too few"),
            (
                format!("{head}1,2,3\n1,2,4\n"),
                "a.csv:3: time 1 s does not come after 1 s",
            ),
            (format!("{stretch}{many}"), "the length is not stated"),
            (
                format!("{head}{many}x,1,2\n"),
                "column `time`: \"x\" is not a number",
            ),
        ] {
            assert_contains(&read(&text).unwrap_err().to_string(), fault);
        }
        let given = Statements::from([("length".to_owned(), "5 mm".to_owned())]);
        let table = Table::parse("a.csv", &format!("# length: 4 mm\n{head}{many}")).unwrap();
        let output = Recording::of_table(&table, &given).unwrap_err().to_string();
        assert_contains(
            &output,
            "4 mm according to the header and 5 mm according to the command line",
        );
    }

    #[test]
    fn one_mass_in_two_units_is_no_contradiction() {
        let head =
            "# mass: 200 g\n# mass: 0.2 kg\n# length: 5 cm\ntime [s],extension [mm],force [N]\n";
        let table = Table::parse("a.csv", &format!("{head}{}", rows(40))).unwrap();
        let given = [("mass", "0.2 kg"), ("length", "50.0 mm")];
        let given = given.map(|(key, value)| (key.to_owned(), value.to_owned()));
        let recording = Recording::of_table(&table, &Statements::from(given)).unwrap();
        assert!((recording.mass / 2e-4 - 1.0).abs() < 1e-12);
    }
}
