//! The uncertainty of the parameters of a fit, as its card records it.

use nalgebra::DMatrix;

use crate::document::{Bound, Section};

/// Parameters of a law with their covariance.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterUncertainty {
    /// Their keys.
    pub keys: Vec<String>,
    /// Their covariance in internal units: that of a normal distribution with the 95 % intervals of the fit.
    pub covariance: DMatrix<f64>,
}

impl ParameterUncertainty {
    /// Reads the keys of a record of a fit, if there are any.
    pub(super) fn read(section: &Section) -> Option<Self> {
        const DEVIATIONS: &str = "standard_deviations";
        const PARAMETERS: &str = "parameters";
        const CORRELATIONS: &str = "correlations";
        if !section.has(DEVIATIONS) {
            return None;
        }
        let keys = section.optional_texts(PARAMETERS);
        let deviations = section.multiples(DEVIATIONS, Bound::NonNegative, f64::INFINITY);
        let read = |_: &_, key| section.multiples(key, Bound::Within(-1.0, 1.0), 1.0);
        let correlations = section.stated(CORRELATIONS, read).unwrap_or_default();
        let count = keys.len();
        if deviations.len() != count || correlations.len() != count * count.saturating_sub(1) / 2 {
            let message =
                "needs one value for each of `parameters`, and `correlations` one for each pair";
            let hint = "in MPa or as a number; correlations row by row below the diagonal";
            section.fault(DEVIATIONS, message, hint);
            return None;
        }
        let covariance = DMatrix::from_fn(count, count, |row, column| {
            let (more, less) = (row.max(column), row.min(column));
            let correlation = if more == less {
                1.0
            } else {
                correlations[more * (more - 1) / 2 + less]
            };
            deviations[row] * correlation * deviations[column]
        });
        Some(Self { keys, covariance })
    }

    /// The lines of a card that state it: keys with their lists.
    pub fn lines(&self) -> [(&'static str, String); 3] {
        let count = self.keys.len();
        let deviation = |row: usize| self.covariance[(row, row)].sqrt();
        let pairs = (0..count).flat_map(|row| (0..row).map(move |column| (row, column)));
        let correlation = |(row, column): (usize, usize)| {
            self.covariance[(row, column)] / (deviation(row) * deviation(column))
        };
        let keys: Vec<String> = self.keys.iter().map(|key| format!("\"{key}\"")).collect();
        let deviations: Vec<String> = (0..count)
            .map(|row| format!("{:.4e}", deviation(row)))
            .collect();
        let correlations: Vec<String> = pairs
            .map(|pair| format!("{:.6}", correlation(pair)))
            .collect();
        [
            ("parameters", format!("[{}]", keys.join(", "))),
            (
                "standard_deviations",
                format!("[{}]", deviations.join(", ")),
            ),
            ("correlations", format!("[{}]", correlations.join(", "))),
        ]
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::material::Card;

    #[test]
    fn what_is_recorded_is_read_again_and_lists_that_do_not_fit_are_faults() {
        let recorded = ParameterUncertainty {
            keys: ["c10", "c20", "c30"].map(str::to_owned).to_vec(),
            covariance: DMatrix::from_row_slice(
                3,
                3,
                &[4.0, 1.0, -1.0, 1.0, 1.0, 0.5, -1.0, 0.5, 9.0],
            ),
        };
        let lines = recorded
            .lines()
            .map(|(key, list)| format!("{key} = {list}\n"));
        let text = Card::load("pva-10-yeoh", Path::new(".")).unwrap().text + &lines.concat();
        let read = |text: &str| Card::parse("own", "own.toml", text);
        let restored = read(&text).unwrap().fit.unwrap().uncertainty.unwrap();
        assert_eq!(restored.keys, recorded.keys);
        assert!((restored.covariance - recorded.covariance).amax() < 1e-5);
        let short = text.replace("correlations = [0.5", "correlations = [");
        assert!(short != text && read(&short).is_err());
    }
}
