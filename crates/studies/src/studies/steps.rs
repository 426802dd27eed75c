//! The parameter along the steps of a study of any kind.

use super::specimen::Along;

/// The parameter along the steps of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Steps {
    /// The path of a plate or a specimen.
    Path(Along),
    /// Time in s.
    Time,
    /// Of another kind, or unknown.
    Unknown,
}

impl Steps {
    /// The name of an axis of [`Self::coordinate`].
    pub fn head(self) -> &'static str {
        match self {
            Self::Path(along) => along.head(),
            Self::Time => "time [s]",
            Self::Unknown => "step [–]",
        }
    }

    /// Where a step lies on that axis.
    pub fn coordinate(self, at: f64) -> f64 {
        match self {
            Self::Path(along) => along.coordinate(at),
            Self::Time | Self::Unknown => at,
        }
    }

    /// A step by the end of a figure's name: `100 % stretch` of `1`.
    pub fn describe(self, at: &str) -> String {
        let (first, again) = at.split_once('#').unwrap_or((at, ""));
        let Ok(value) = first.parse::<f64>() else {
            return at.to_owned();
        };
        let step = match self {
            Self::Path(along) => along.describe(value),
            Self::Time => format!("{first} s"),
            Self::Unknown => format!("step {first}"),
        };
        match again {
            "" => step,
            again => format!("{step}, time {again}"),
        }
    }
}
