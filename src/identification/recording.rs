//! Recorded force and motion of one spring.

use std::path::Path;

use crate::calibration::{Column, Table};
use crate::error::{Diagnostic, Error};
use crate::units::{self, Dimension};

/// What the command line says beside the file.
#[derive(Clone, Debug, Default)]
pub struct Said {
    /// The mass that the force moves, such as `5 g`.
    pub mass: Option<String>,
    /// The length at rest, such as `50 mm`.
    pub length: Option<String>,
    /// The cross-section at rest, such as `20 mm^2`.
    pub area: Option<String>,
}

/// Force and motion at increasing instants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Instants in s.
    pub times: Vec<f64>,
    /// Extension beyond the length at rest in mm.
    pub extension: Vec<f64>,
    /// Force that pulls, in N.
    pub force: Vec<f64>,
    /// The mass that the force moves, in tonne; zero where none is stated.
    pub mass: f64,
    /// Length at rest in mm, where it is known.
    pub length: Option<f64>,
    /// Cross-section at rest in mm², where it is known.
    pub area: Option<f64>,
}

/// Fewest instants that are taken.
const FEWEST: usize = 30;

/// How a column tells the motion.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Motion {
    Extension,
    Length,
    Stretch,
}

const MOTIONS: [(&str, Motion, Dimension); 3] = [
    ("extension", Motion::Extension, Dimension::Length),
    ("length", Motion::Length, Dimension::Length),
    ("stretch", Motion::Stretch, Dimension::Ratio),
];

impl Recording {
    /// Reads a table with the columns `time`, `extension` or `length` or `stretch`, and `force`.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the file.
    pub fn read(path: &Path, said: &Said) -> Result<Self, Error> {
        Self::of_table(&Table::read(path)?, said)
    }

    /// Takes the columns from a table.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the table.
    pub fn of_table(table: &Table, said: &Said) -> Result<Self, Error> {
        let mut reader = Reader {
            table,
            faults: Vec::new(),
        };
        let times = reader.column("time", Dimension::Time);
        let motion = MOTIONS
            .iter()
            .find(|(name, ..)| reader.index(name).is_some());
        let places = motion.map(|(name, _, dimension)| reader.column(name, *dimension));
        if motion.is_none() {
            let message = "there is no column of the motion";
            let hint = "name one `extension [mm]`, `length [mm]` or `stretch [-]`";
            reader.fault(table.columns_place.clone(), message, hint);
        }
        let force = reader.column("force", Dimension::Force);
        let mass = reader.setting("mass", said.mass.as_deref(), Dimension::Mass);
        let length = reader.setting("length", said.length.as_deref(), Dimension::Length);
        let area = reader.setting("area", said.area.as_deref(), Dimension::Area);
        let kind = motion.map_or(Motion::Extension, |(_, kind, _)| *kind);
        if kind != Motion::Extension && length.is_none() {
            let message = "the length at rest is not stated";
            reader.fault(
                0..0,
                message,
                "write `# length: 50 mm` at the top of the file, or give --length \"50 mm\"",
            );
        }
        reader.increasing(&times);
        if !reader.faults.is_empty() {
            return Err(Error::Input(reader.faults));
        }
        let rest = length.unwrap_or_default();
        let extension = |value: &f64| match kind {
            Motion::Extension => *value,
            Motion::Length => value - rest,
            Motion::Stretch => (value - 1.0) * rest,
        };
        let recording = Self {
            extension: places.unwrap_or_default().iter().map(extension).collect(),
            times,
            force,
            mass: mass.unwrap_or_default(),
            length,
            area,
        };
        recording.moving(&reader)?;
        Ok(recording)
    }

    fn moving(&self, reader: &Reader) -> Result<(), Error> {
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
        Err(Error::Input(vec![reader.diagnostic(0..0, &message, &hint)]))
    }
}

struct Reader<'a> {
    table: &'a Table,
    faults: Vec<Diagnostic>,
}

impl Reader<'_> {
    fn diagnostic(&self, place: std::ops::Range<usize>, message: &str, hint: &str) -> Diagnostic {
        Diagnostic::error("", message)
            .hint(hint)
            .at(&self.table.source, place)
    }

    fn fault(&mut self, place: std::ops::Range<usize>, message: &str, hint: &str) {
        self.faults.push(self.diagnostic(place, message, hint));
    }

    fn index(&self, name: &str) -> Option<usize> {
        self.table
            .columns
            .iter()
            .position(|column| column.name == name)
    }

    /// A column in the internal unit.
    fn column(&mut self, name: &str, dimension: Dimension) -> Vec<f64> {
        let place = self.table.columns_place.clone();
        let Some(index) = self.index(name) else {
            let unit = dimension.units().next().unwrap_or("-");
            self.fault(
                place,
                &format!("there is no column `{name}`"),
                &format!("name one `{name} [{unit}]`"),
            );
            return Vec::new();
        };
        if let Some((reason, row)) = self.table.fault(index) {
            let reason = format!("{name}: {reason}");
            self.fault(row, &reason, "every row needs a number in this column");
        }
        match factor(&self.table.columns[index], dimension) {
            Ok(factor) => self
                .table
                .rows
                .iter()
                .map(|(row, _)| factor * row[index])
                .collect(),
            Err(reason) => {
                let units: Vec<_> = dimension.units().collect();
                let hint = format!(
                    "write the unit in brackets behind the name; known: {}",
                    units.join(", ")
                );
                self.fault(place, &format!("the column `{name}` {reason}"), &hint);
                Vec::new()
            }
        }
    }

    /// A positive quantity of the head or the command line.
    fn setting(&mut self, key: &str, said: Option<&str>, dimension: Dimension) -> Option<f64> {
        let in_file = self.table.head.get(key).cloned();
        if let (Some((value, place)), Some(said)) = (&in_file, said)
            && value != said
        {
            let message =
                format!("the {key} is {value} by the head and {said} by the command line");
            self.fault(place.clone(), &message, "say it once, or alike");
            return None;
        }
        let (value, place) = in_file.or_else(|| Some((said?.to_owned(), 0..0)))?;
        let reason = match units::parse(&value, dimension) {
            Ok(number) if number > 0.0 => return Some(number),
            Ok(_) => "is not positive".to_owned(),
            Err(fault) => fault.to_string(),
        };
        let message = format!("the {key} \"{value}\" {reason}");
        self.fault(
            place,
            &message,
            &format!("write it as {}", dimension.example()),
        );
        None
    }

    fn increasing(&mut self, times: &[f64]) {
        let wrong = times.windows(2).position(|pair| pair[1] <= pair[0]);
        if let Some(row) = wrong {
            let message = format!(
                "time {} s does not come after {} s",
                times[row + 1],
                times[row]
            );
            let place = self.table.rows[row + 1].1.clone();
            self.fault(
                place,
                &message,
                "sort the rows by time and leave out repeated ones",
            );
        }
    }
}

fn factor(column: &Column, dimension: Dimension) -> Result<f64, String> {
    match column.unit.as_deref() {
        None if dimension == Dimension::Ratio => Ok(1.0),
        None => Err("has no unit".to_owned()),
        Some("-" | "–" | "1" | "mm/mm") if dimension == Dimension::Ratio => Ok(1.0),
        Some(unit) => {
            units::parse(&format!("1 {unit}"), dimension).map_err(|fault| fault.to_string())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(count: usize) -> String {
        let row = |i: usize| format!("{},{},{}\n", 2 * i, 1.0 + 0.1 * (i % 7) as f64, 3 * (i % 7));
        (0..count).map(row).collect()
    }

    fn read(text: &str) -> Result<Recording, Error> {
        Recording::of_table(&Table::parse("a.csv", text).unwrap(), &Said::default())
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
    fn all_faults_of_a_recording_are_told_with_place_and_remedy() {
        let told = read(&format!(
            "# mass: 5 cm\ntime [mm],force\n{}",
            "1,2\n0.5,3\n".repeat(20)
        ));
        let told = told.unwrap_err().to_string();
        for part in [
            "a.csv:2: the column `time` has the unit `mm`, which measures length",
            "a.csv:2: there is no column of the motion (name one `extension [mm]`",
            "the column `force` has no unit",
            "a.csv:1: the mass \"5 cm\" has the unit `cm`",
        ] {
            assert!(told.contains(part), "{part}: {told}");
        }
        let told = |text: &str| read(text).unwrap_err().to_string();
        let head = "time [s],extension [mm],force [N]\n";
        assert!(told(&format!("{head}{}", rows(20))).contains("20 instants are too few"));
        assert!(
            told(&format!("{head}1,2,3\n1,2,4\n"))
                .contains("a.csv:3: time 1 s does not come after 1 s")
        );
        assert!(
            told(&format!("time [s],stretch,force [N]\n{}", rows(40)))
                .contains("length at rest is not stated")
        );
        assert!(
            told(&format!("{head}{}x,1,2\n", rows(40))).contains("time: \"x\" is not a number")
        );
        let said = Said {
            length: Some("5 mm".into()),
            ..Said::default()
        };
        let table = Table::parse("a.csv", &format!("# length: 4 mm\n{head}{}", rows(40))).unwrap();
        let told = Recording::of_table(&table, &said).unwrap_err().to_string();
        assert!(
            told.contains("4 mm by the head and 5 mm by the command line"),
            "{told}"
        );
    }
}
