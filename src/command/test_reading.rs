//! The options about test data.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use serde_json::Value;

use super::terminal::{together, warn};
use gelbench_base::document::file::MOST_OF_A_STUDY;
use gelbench_base::document::{Statements, read_text};
use gelbench_base::error::{Diagnostic, Error};
use gelbench_calibration::calibration::{self, TestData};

const MOUNTING: &str = "Planar biaxial tests";

/// What the files of test data do not say themselves.
#[derive(Args, Default, Serialize)]
#[command(next_help_heading = "What the files do not state")]
pub struct ReadingArguments {
    /// uniaxial, planar, equibiaxial, biaxial, compression or simple-shear; biaxial where strains are measured along two axes
    #[arg(long, allow_hyphen_values = true)]
    test: Option<String>,
    /// nominal, cauchy or second-piola-kirchhoff
    #[arg(long, allow_hyphen_values = true)]
    stress: Option<String>,
    /// stretch, nominal, logarithmic or green-lagrange
    #[arg(long, allow_hyphen_values = true)]
    strain: Option<String>,
    /// Unit of the stress, or of the force
    #[arg(long, value_name = "UNIT")]
    stress_unit: Option<String>,
    /// Unit of the strain, `-` or `%`, or of the displacement
    #[arg(long, value_name = "UNIT", allow_hyphen_values = true)]
    strain_unit: Option<String>,
    /// Axis of the stress: 1 along the strain, 2 transverse
    #[arg(long, allow_hyphen_values = true)]
    direction: Option<String>,
    /// ε₂/ε₁ of a biaxial test, in nominal strains whatever the column contains
    #[arg(long, allow_hyphen_values = true)]
    strain_ratio: Option<String>,
    /// Cross-section of the specimen, if the file has forces
    #[arg(long, allow_hyphen_values = true)]
    area: Option<String>,
    /// Length of the specimen, if the file has displacements and no size; in simple shear, the distance of the plates
    #[arg(long, allow_hyphen_values = true)]
    length: Option<String>,
    /// Width of the specimen; with the thickness it replaces the cross-section. Of a biaxial test, the length along the second axis
    #[arg(long, allow_hyphen_values = true)]
    width: Option<String>,
    /// Thickness of the specimen
    #[arg(long, allow_hyphen_values = true)]
    thickness: Option<String>,
    /// Unit of the times
    #[arg(long, value_name = "UNIT")]
    time_unit: Option<String>,
    /// Cycle to use: first, last, a number, or all rows; by default the loading branch of the last one if forces and displacements have cycles
    #[arg(long, allow_hyphen_values = true)]
    cycle: Option<String>,
    /// Where stretching begins: automatic, none (as in the file), a displacement, or a force
    #[arg(long, allow_hyphen_values = true)]
    zero: Option<String>,
    /// Duration of the ramp before the first row, if a relaxation file begins already stretched
    #[arg(long, value_name = "TIME")]
    ramp: Option<String>,
    /// Largest stretch λ before the record, of a specimen that was preconditioned; for `--softening`
    #[arg(long, value_name = "STRETCH", allow_hyphen_values = true)]
    preconditioned: Option<String>,
    /// Columns by their quantity, such as strain=Extension,stress="Load (N)"; also strain_1, strain_2, stress_1, stress_2 and time. Columns
    /// without names, or of equal names, have numbers: strain=2,stress=1
    #[arg(long, value_name = "WHAT=COLUMN")]
    columns: Vec<String>,
    /// Rows to use: lines of the file such as 12..340, or a column and its value such as SetName=Test
    #[arg(long, value_name = "ROWS")]
    rows: Option<String>,
    /// Nominal strains to use, counted from the zero that is fitted, such as 0..0.3 or ..30%
    #[arg(long, value_name = "LOW..HIGH", allow_hyphen_values = true)]
    strain_range: Option<String>,
    /// Columns whose sign is reversed: strain, stress or both
    #[arg(long, value_name = "COLUMNS")]
    flip: Option<String>,
    /// What holds the sheet of a biaxial test: rakes or cruciform. It is then solved with the law by finite elements, instead of taken as
    /// homogeneous; `length` and `width` are the distances of the bars or grips, and the thickness is that of the mounted sheet
    #[arg(long, help_heading = MOUNTING)]
    mounting: Option<String>,
    /// Tines at each side
    #[arg(long, value_name = "NUMBER", help_heading = MOUNTING)]
    tines: Option<String>,
    /// Distance between neighbouring tines
    #[arg(long, value_name = "LENGTH", help_heading = MOUNTING)]
    tine_spacing: Option<String>,
    /// Distance of the tines from the edge of the sheet
    #[arg(long, value_name = "LENGTH", help_heading = MOUNTING)]
    tine_inset: Option<String>,
    /// Diameter of a tine
    #[arg(long, value_name = "LENGTH", help_heading = MOUNTING)]
    tine_diameter: Option<String>,
    /// fixed, or sliding where tines or threads move along their bar; fixed if omitted
    #[arg(long, value_name = "HOW", help_heading = MOUNTING)]
    tine_bars: Option<String>,
    /// Width of the arms of a cruciform
    #[arg(long, value_name = "LENGTH", help_heading = MOUNTING)]
    arm_width: Option<String>,
    /// Radius of the fillets between the arms of a cruciform
    #[arg(long, value_name = "LENGTH", help_heading = MOUNTING)]
    fillet: Option<String>,
    /// The stretches are those of markers at the corners of a square of this side in the middle; of the bars if omitted
    #[arg(long, value_name = "LENGTH", help_heading = MOUNTING)]
    markers: Option<String>,
    /// The state without stress: as-mounted (if omitted), estimated with the law, or the stretches along both axes as mounted, such as
    /// 1.05,1.03
    #[arg(long, value_name = "STATE", help_heading = MOUNTING)]
    rest_state: Option<String>,
    /// The zeros of both forces: as-measured (if omitted), or estimated with the law
    #[arg(long, value_name = "ZERO", help_heading = MOUNTING)]
    force_zero: Option<String>,
    /// Statements remembered under a name: written to presets/NAME.txt from the options if there is none, and taken from it otherwise;
    /// options take precedence
    #[arg(long, value_name = "NAME")]
    preset: Option<String>,
    /// All files are one specimen, under several protocols; files of several specimens state `# specimen name: NAME` each
    #[arg(long)]
    #[serde(rename = "specimen_name")]
    one_specimen: bool,
}

impl ReadingArguments {
    /// What is said, by the keys of test data.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::Write`] of the preset.
    pub fn reading(self) -> Result<Statements, Error> {
        let stated = self.stated();
        match self.preset {
            None => Ok(stated),
            Some(name) => with_preset(&name, stated),
        }
    }

    /// What the options say, each of which is called as its key.
    fn stated(&self) -> Statements {
        let options = serde_json::to_value(self).unwrap_or_default();
        let stated = |key: &str| match &options[option(key)] {
            Value::String(value) => Some(value.clone()),
            Value::Array(_) => Some(self.columns.join(",")).filter(|columns| !columns.is_empty()),
            Value::Bool(true) => Some("one".to_owned()),
            _ => None,
        };
        let pairs = calibration::KEYS.into_iter();
        pairs
            .filter_map(|key| Some((key.to_owned(), stated(key)?)))
            .collect()
    }
}

/// The name of the option that states a key of test data.
fn option(key: &str) -> String {
    key.replace(" measure", "").replace(' ', "_")
}

/// Statements with those of a preset, which is a file of the lines that the head of a table may have; it is written from the statements where
/// there is none.
fn with_preset(name: &str, stated: Statements) -> Result<Statements, Error> {
    let path = Path::new("presets").join(format!("{name}.txt"));
    if !path.exists() {
        if stated.is_empty() {
            let hint = format!(
                "give the options that it shall remember; it is written to {}",
                path.display()
            );
            return Err(Error::input(format!("there is no preset {name} yet"), hint));
        }
        let lines = stated
            .iter()
            .map(|(key, value)| format!("# {key}: {value}\n"));
        let text: String = lines.collect();
        let written = std::fs::create_dir_all("presets").and_then(|()| std::fs::write(&path, text));
        written.map_err(|fault| Error::write(&path, fault.to_string()))?;
        warn(&[
            Diagnostic::warning("", format!("the preset {} was written", path.display())).hint(
                format!("--preset {name} states the same again; it is a text that can be edited"),
            ),
        ]);
        return Ok(stated);
    }
    let text = read_text(&path, MOST_OF_A_STUDY, "a preset is a text")?;
    let mut all = Statements::new();
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let pair = line.trim_start_matches('#').split_once(':');
        let known = pair.filter(|(key, _)| calibration::KEYS.contains(&key.trim()));
        let Some((key, value)) = known else {
            let hint = format!(
                "lines such as `# area: 10 mm^2`, with one of {}",
                calibration::KEYS.join(", ")
            );
            let message = format!(
                "{}: `{line}` is no statement about test data",
                path.display()
            );
            return Err(Error::input(message, hint));
        };
        all.insert(key.trim().to_owned(), value.trim().to_owned());
    }
    all.extend(stated);
    Ok(all)
}

/// Reads the tests of some files, and prints their warnings.
///
/// # Errors
/// [`Error::Input`] with the faults of all files, and where a test is given twice: it would count as two.
pub fn read_tests(files: &[PathBuf], reading: &Statements) -> Result<Vec<TestData>, Error> {
    let tests = together(files.iter().map(|path| TestData::read(path, reading)))?;
    calibration::refuse_repeated(&tests)?;
    tests.iter().for_each(|test| warn(&test.warnings));
    Ok(tests)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_key_has_an_option_and_each_option_but_the_preset_a_key() {
        let options = serde_json::to_value(ReadingArguments::default()).unwrap();
        for key in calibration::KEYS {
            assert!(options.get(option(key)).is_some(), "{key}");
        }
        let count = options.as_object().map(serde_json::Map::len);
        assert_eq!(count, Some(calibration::KEYS.len() + 1));
    }
}
