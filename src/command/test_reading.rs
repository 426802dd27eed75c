//! What the command line says of test data.

use clap::Args;

use gelbench_base::document::Statements;
use gelbench_calibration::calibration;

/// What the files of test data do not say themselves.
#[derive(Args)]
#[command(next_help_heading = "What the files do not state")]
pub struct ReadingArguments {
    /// uniaxial, planar, equibiaxial, biaxial or compression
    #[arg(long, allow_hyphen_values = true)]
    test: Option<String>,
    /// nominal or cauchy
    #[arg(long, allow_hyphen_values = true)]
    stress: Option<String>,
    /// stretch, nominal or logarithmic
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
    /// Length of the specimen, if the file has displacements
    #[arg(long, allow_hyphen_values = true)]
    length: Option<String>,
    /// Width of the specimen; with the thickness it replaces the cross-section
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
    /// All files are one specimen, under several protocols; files of several specimens state `# specimen name: NAME` each
    #[arg(long)]
    one_specimen: bool,
}

impl ReadingArguments {
    /// What is said, by the keys of test data.
    pub fn reading(self) -> Statements {
        let given = [
            self.test,
            self.stress,
            self.strain,
            self.stress_unit,
            self.strain_unit,
            self.direction,
            self.strain_ratio,
            self.area,
            self.length,
            self.width,
            self.thickness,
            self.time_unit,
            self.cycle,
            self.zero,
            self.ramp,
            self.preconditioned,
            Some(self.columns.join(",")).filter(|columns| !columns.is_empty()),
            self.one_specimen.then(|| "one".to_owned()),
        ];
        let pairs = calibration::KEYS.into_iter().zip(given);
        pairs
            .filter_map(|(key, value)| Some((key.to_owned(), value?)))
            .collect()
    }
}
