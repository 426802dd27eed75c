//! What the command line says of test data.

use clap::Args;

use crate::calibration;
use crate::document::Statements;

/// What the files of test data do not say themselves.
#[derive(Args)]
#[command(next_help_heading = "What the files do not say")]
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
    /// Unit of the stresses, or of the force
    #[arg(long, value_name = "UNIT")]
    stress_unit: Option<String>,
    /// Unit of the strains, `-` or `%`, or of the displacement
    #[arg(long, value_name = "UNIT", allow_hyphen_values = true)]
    strain_unit: Option<String>,
    /// Axis of the stress: 1 as the strain, 2 across
    #[arg(long, allow_hyphen_values = true)]
    direction: Option<String>,
    /// ε₂/ε₁ of a biaxial test: of nominal strains, whatever the column holds
    #[arg(long, allow_hyphen_values = true)]
    strain_ratio: Option<String>,
    /// Cross-section of the specimen, where the file has forces
    #[arg(long, allow_hyphen_values = true)]
    area: Option<String>,
    /// Length of the specimen, where the file has displacements
    #[arg(long, allow_hyphen_values = true)]
    length: Option<String>,
    /// Width of the specimen; with the thickness in place of the cross-section
    #[arg(long, allow_hyphen_values = true)]
    width: Option<String>,
    /// Thickness of the specimen
    #[arg(long, allow_hyphen_values = true)]
    thickness: Option<String>,
    /// Unit of the times
    #[arg(long, value_name = "UNIT")]
    time_unit: Option<String>,
    /// Of several cycles: first, last, a number, or all rows; the last one's loading branch where forces and displacements have cycles
    #[arg(long, allow_hyphen_values = true)]
    cycle: Option<String>,
    /// Where the specimen begins to be stretched: automatic, none (as the file has it), a displacement, or a force
    #[arg(long, allow_hyphen_values = true)]
    zero: Option<String>,
    /// How long the strain took to the first row, in a file of relaxation that begins stretched
    #[arg(long, value_name = "TIME")]
    ramp: Option<String>,
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
        ];
        let pairs = calibration::KEYS.into_iter().zip(given);
        pairs
            .filter_map(|(key, value)| Some((key.to_owned(), value?)))
            .collect()
    }
}
