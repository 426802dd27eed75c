//! `gelbench materials convert`.

use std::path::PathBuf;

use clap::Args;

use super::arguments::one_of;
use super::terminal::{Outcome, print, print_data, save, warn};
use super::test_reading::ReadingArguments;
use gelbench_base::error::Diagnostic;
use gelbench_calibration::calibration::{Conversion, StrainColumn, TestData};
use gelbench_mechanics::material::parameters::StressMeasure;
use gelbench_report::output;

#[derive(Args)]
pub struct ConvertArguments {
    /// The file of test data
    data: PathBuf,
    /// Stress measure to write
    #[arg(long, value_name = "MEASURE", value_parser = one_of(&StressMeasure::NAMES))]
    to_stress: Option<StressMeasure>,
    /// Strain measure to write
    #[arg(long, value_name = "MEASURE", default_value = "stretch", value_parser = one_of(&StrainColumn::NAMES))]
    to_strain: StrainColumn,
    /// Unit of stress to write
    #[arg(long, value_name = "UNIT", default_value = "MPa")]
    to_unit: String,
    /// The file to write; standard output if omitted
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reading: ReadingArguments,
}

/// Writes test data in other measures and units.
pub fn convert(arguments: ConvertArguments) -> Outcome {
    let data = TestData::read(&arguments.data, &arguments.reading.reading()?)?;
    let mut warnings = data.all_warnings();
    warnings.extend(data.mounted.mounting.map(|_| {
        let message = "the mounting of the sheet is not written with the converted data";
        let hint = "state it again where they are fitted, with the sizes of the sheet";
        Diagnostic::warning("", message).hint(hint)
    }));
    warn(&warnings);
    let text = Conversion {
        stress: arguments.to_stress.unwrap_or(data.stress_measure),
        strain: arguments.to_strain,
        unit: arguments.to_unit,
    }
    .table(&data)?;
    match arguments.output {
        None => print_data(&text)?,
        Some(file) => {
            output::refuse_inputs(&file, &[&arguments.data])?;
            let text = format!("# source: gelbench materials convert\n{text}");
            save(&file, text.as_bytes())?;
            print(&format!("{} written\n", file.display()))?;
        }
    }
    Ok(0)
}
