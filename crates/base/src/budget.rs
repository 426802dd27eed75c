//! Limits for memory and work, which grow with a user's input: the need is estimated before anything is built, and refused where it exceeds the
//! budget.
//!
//! | quantity | usual | what counts |
//! |---|---|---|
//! | cells | 1,000,000 | of the largest mesh |
//! | instants | 20,000 | states that are kept: stretches, load factors, frames, instants of a motion |
//! | steps | 10,000,000 | of time |
//! | unknowns | 3,000,000 | of the largest system of equations |
//! | bytes | 8 GB | memory at its peak |
//!
//! [`Budget::LARGE`] is the budget with the option `--allow-large`.

use std::fmt;

/// The most that may be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Cells of the largest mesh.
    pub cells: f64,
    /// States that are kept.
    pub instants: f64,
    /// Steps of time.
    pub steps: f64,
    /// Unknowns of the largest system of equations.
    pub unknowns: f64,
    /// Memory at its peak.
    pub bytes: f64,
}

impl Budget {
    /// For a common machine and a run of hours.
    pub const USUAL: Self = Self {
        cells: 1e6,
        instants: 2e4,
        steps: 1e7,
        unknowns: 3e6,
        bytes: 8e9,
    };

    /// The limit of what can be addressed: no machine could compute more.
    pub const LARGE: Self = Self {
        cells: 1e9,
        instants: 1e7,
        steps: 1e12,
        unknowns: 1e9,
        bytes: 1e12,
    };

    /// Checks that a need is within the budget.
    ///
    /// # Errors
    /// The first quantity that exceeds it.
    pub fn afford(&self, need: Need) -> Result<(), Excess> {
        let excess = |budget: &Self| {
            let quantities = [
                ("cells", need.cells, budget.cells),
                ("instants", need.instants, budget.instants),
                ("time steps", need.steps, budget.steps),
                ("unknowns", need.unknowns, budget.unknowns),
                ("bytes of memory", need.bytes, budget.bytes),
            ];
            // NaN counts as too much.
            quantities
                .into_iter()
                .find(|(_, needed, allowed)| needed.is_nan() || needed > allowed)
        };
        let Some((what, needed, allowed)) = excess(self) else {
            return Ok(());
        };
        let passes = *self != Self::LARGE && excess(&Self::LARGE).is_none();
        Err(Excess {
            what,
            needed,
            allowed,
            passes,
        })
    }
}

impl Default for Budget {
    fn default() -> Self {
        Self::USUAL
    }
}

/// The estimated need of a computation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Need {
    /// See [`Budget::cells`].
    pub cells: f64,
    /// See [`Budget::instants`].
    pub instants: f64,
    /// See [`Budget::steps`].
    pub steps: f64,
    /// See [`Budget::unknowns`].
    pub unknowns: f64,
    /// See [`Budget::bytes`].
    pub bytes: f64,
}

impl Need {
    /// Need of the states of a system with so many unknowns, solved by factorisation and kept with their results.
    ///
    /// ```text
    /// bytes = unknowns (3,000 + 200 instants)
    /// ```
    ///
    /// The first term was measured for plates and specimens between 20,000 and 400,000 unknowns, the second is estimated.
    pub fn of_states(unknowns: f64, instants: f64) -> Self {
        Self {
            unknowns,
            instants,
            bytes: unknowns * (3000.0 + 200.0 * instants),
            ..Self::default()
        }
    }

    /// The same need with so many cells.
    #[must_use]
    pub fn on_cells(self, cells: f64) -> Self {
        Self { cells, ..self }
    }
}

/// A quantity that exceeds the budget.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("needs about {} {what}, and {} are allowed", Amount(*.needed), Amount(*.allowed))]
pub struct Excess {
    /// The quantity.
    pub what: &'static str,
    /// The amount needed.
    pub needed: f64,
    /// The amount allowed.
    pub allowed: f64,
    /// Whether the option for large studies permits it.
    pub passes: bool,
}

impl Excess {
    /// Advice: a smaller problem, or the option where it helps.
    pub fn remedy(&self, smaller: &str) -> String {
        if self.passes {
            format!("{smaller}, or use --allow-large")
        } else {
            smaller.to_owned()
        }
    }
}

/// A large number: 1,200 or 3.4e12.
struct Amount(f64);

impl fmt::Display for Amount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_nan() || self.0.abs() >= 1e9 {
            return write!(f, "{:.1e}", self.0);
        }
        let digits = format!("{:.0}", self.0);
        for (position, digit) in digits.chars().enumerate() {
            if position > 0 && (digits.len() - position).is_multiple_of(3) {
                write!(f, ",")?;
            }
            write!(f, "{digit}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_much_is_told_with_its_estimate_and_remedy() {
        let need = |cells| Need::default().on_cells(cells);
        assert_eq!(Budget::USUAL.afford(need(1e6)), Ok(()));
        let excess = Budget::USUAL.afford(need(1_234_567.0)).unwrap_err();
        assert_eq!(
            excess.to_string(),
            "needs about 1,234,567 cells, and 1,000,000 are allowed"
        );
        assert_eq!(
            excess.remedy("take fewer"),
            "take fewer, or use --allow-large"
        );
        assert_eq!(Budget::LARGE.afford(need(1_234_567.0)), Ok(()));
    }

    #[test]
    fn what_no_machine_has_is_refused_whatever_is_said() {
        for needed in [1e30, f64::INFINITY, f64::NAN] {
            let need = Need::of_states(needed, 1.0);
            for budget in [Budget::USUAL, Budget::LARGE] {
                let excess = budget.afford(need).unwrap_err();
                assert_eq!(
                    (excess.what, excess.passes),
                    ("unknowns", false),
                    "{needed}"
                );
                assert_eq!(excess.remedy("take fewer"), "take fewer");
            }
        }
    }
}
