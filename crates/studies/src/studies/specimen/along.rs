//! The parameter along a path.

use crate::problem::ClampedPlate;
use crate::solve::PathEnd;

/// The parameter along a path; to the models both are the load factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The factor of all motions and loads.
    LoadFactor,
    /// The stretch λ − 1 between two grips.
    Stretch,
}

impl Along {
    /// `load factor` or `stretch`.
    pub fn name(self) -> &'static str {
        match self {
            Self::LoadFactor => "load factor",
            Self::Stretch => "stretch",
        }
    }

    /// The head of a column of [`Self::value`], and the name of an axis of [`Self::coordinate`].
    pub fn head(self) -> &'static str {
        match self {
            Self::LoadFactor => "load factor [–]",
            Self::Stretch => "stretch [%]",
        }
    }

    /// The head of a column for machines, in which both are ratios.
    pub fn column(self) -> &'static str {
        match self {
            Self::LoadFactor => "load_factor",
            Self::Stretch => "stretch",
        }
    }

    /// `0.5`, or `50` in percent.
    pub fn value(self, factor: f64) -> String {
        match self {
            Self::LoadFactor => factor.to_string(),
            Self::Stretch => ClampedPlate::percent(factor),
        }
    }

    /// The same as a number.
    pub fn coordinate(self, factor: f64) -> f64 {
        match self {
            Self::LoadFactor => factor,
            Self::Stretch => 100.0 * factor,
        }
    }

    /// `load factor 0.5` or `50 % stretch`.
    pub fn describe(self, factor: f64) -> String {
        match self {
            Self::LoadFactor => format!("load factor {factor}"),
            Self::Stretch => ClampedPlate::describe_step(factor),
        }
    }

    /// `load factors 0.5, 1` or `50 %, 100 % stretch`.
    pub fn list(self, factors: impl IntoIterator<Item = f64>) -> String {
        let all = factors.into_iter().map(|factor| self.value(factor));
        let all: Vec<String> = all.collect();
        let several = if all.len() == 1 { "" } else { "s" };
        match self {
            Self::LoadFactor => format!("load factor{several} {}", all.join(", ")),
            Self::Stretch => format!("{} % stretch", all.join(" %, ")),
        }
    }

    /// Where a path ended, such as `50 % stretch (reached 43.2 %)`.
    pub fn describe_end(self, end: &PathEnd) -> String {
        match self {
            Self::LoadFactor => end.describe(),
            Self::Stretch => ClampedPlate::describe_end(end),
        }
    }
}
