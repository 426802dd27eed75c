//! Whether a deviation is within its limit, and whether the reference is good enough to judge it.
//!
//! A reference has an error of its own. Let d be the measured deviation from it, e the reference's own error of the same
//! quantity, and l the limit, all in percent of the same size:
//!
//! ```text
//! d ≤ ρ and e ≤ ρ     exact: both are rounding, ρ = 10⁻⁶ %
//! e ≤ d/10            judged: pass where d ≤ l, else FAIL
//! d + 10 e ≤ l        pass: even ten times the reference's error would not change that
//! else                cannot be judged: the reference is too coarse for what it has to judge
//! ```
//!
//! Where the reference is expensive, and limits are far from what is measured ([`judge_by_margin`]):
//!
//! ```text
//! d + e ≤ l           pass
//! d − e > l           FAIL
//! else                cannot be judged
//! ```

use serde::{Deserialize, Serialize};

use crate::document::stored::{StaticText, static_text};

/// Deviations below this, in percent, are due to solvers and rounding.
pub const ROUNDING_PERCENT: f64 = 1e-6;

/// The largest part of a deviation that may be the reference's own error.
pub const LARGEST_SHARE: f64 = 0.1;

/// The judgement of a requirement.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Judgement {
    /// Within the limit.
    Pass,
    /// Within the limit because there is nothing to measure, and why.
    Exact(#[serde(deserialize_with = "static_text")] StaticText),
    /// Within the limit by a margin of ten times the reference's own error, which is more than a tenth of the deviation.
    PassByMargin,
    /// Beyond the limit, or NaN.
    Fail,
    /// The reference is not good enough to judge it.
    CannotBeJudged {
        /// Why.
        reason: String,
        /// The remedy.
        remedy: String,
    },
}

impl Judgement {
    /// `pass`, `FAIL` or `cannot be judged`.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Pass | Self::Exact(_) | Self::PassByMargin => "pass",
            Self::Fail => "FAIL",
            Self::CannotBeJudged { .. } => "cannot be judged",
        }
    }

    /// Whether the requirement is met.
    pub fn passed(&self) -> bool {
        matches!(self, Self::Pass | Self::Exact(_) | Self::PassByMargin)
    }

    /// The remark beside the word: the reason and the remedy where it cannot be judged, or why there is nothing to measure.
    pub fn remark(&self) -> Option<String> {
        match self {
            Self::Pass | Self::Fail => None,
            Self::Exact(why) => Some((*why).to_owned()),
            Self::PassByMargin => {
                Some("even ten times the reference's own error would not change this".to_owned())
            }
            Self::CannotBeJudged { reason, remedy } => Some(format!("{reason}; {remedy}")),
        }
    }
}

/// Judges a deviation from a reference with an error of its own, both without signs and in percent of the same size.
/// `remedy` describes how the reference becomes better.
pub fn judge(deviation: f64, own_error: f64, limit: f64, remedy: &str) -> Judgement {
    if deviation.is_nan() {
        return Judgement::Fail;
    }
    if deviation <= ROUNDING_PERCENT && own_error <= ROUNDING_PERCENT {
        return Judgement::Exact("exact but for rounding");
    }
    if own_error <= LARGEST_SHARE * deviation {
        return if deviation <= limit {
            Judgement::Pass
        } else {
            Judgement::Fail
        };
    }
    if deviation + own_error / LARGEST_SHARE <= limit {
        return Judgement::PassByMargin;
    }
    let reason = format!(
        "the reference is too coarse: its own error, {} %, is more than a tenth of the deviation, {} %, and of its distance to the limit",
        percent(own_error),
        percent(deviation)
    );
    too_coarse(own_error, reason, remedy)
}

/// The judgement where the reference's own error is too large, and why.
fn too_coarse(own_error: f64, reason: String, remedy: &str) -> Judgement {
    Judgement::CannotBeJudged {
        reason: if own_error.is_finite() {
            reason
        } else {
            "the reference's own error is not known".to_owned()
        },
        remedy: remedy.to_owned(),
    }
}

/// Judges the share of an uncorrected deviation that remains after a correction, 100 d/d₀: at most `limit` %. Where
/// d₀ is only rounding, there is nothing to correct.
pub fn judge_correction(
    [before, after]: [f64; 2],
    own_error: f64,
    limit: f64,
    remedy: &str,
) -> Judgement {
    if before <= ROUNDING_PERCENT && own_error <= ROUNDING_PERCENT {
        return Judgement::Exact(
            "nothing to correct: exact but for rounding before the correction",
        );
    }
    if before.is_nan() {
        return Judgement::Fail;
    }
    // The rounding level is that of the deviations, not of their ratio.
    judge(after, own_error, before * limit / 100.0, remedy)
}

/// Judges a deviation by whether its distance to the limit exceeds the reference's own error; both in percent of the same size.
pub fn judge_by_margin(deviation: f64, own_error: f64, limit: f64, remedy: &str) -> Judgement {
    if deviation.is_nan() || deviation - own_error > limit {
        return Judgement::Fail;
    }
    if deviation + own_error <= limit {
        return Judgement::Pass;
    }
    let reason = format!(
        "the reference's own error, {} %, decides whether the deviation, {} %, is within the limit",
        percent(own_error),
        percent(deviation)
    );
    too_coarse(own_error, reason, remedy)
}

/// A deviation in % as a sentence shows it.
pub fn percent(value: f64) -> String {
    if value.abs() < 1e-3 {
        format!("{value:.1e}")
    } else {
        format!("{value:.3}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_open(judged: &Judgement) -> bool {
        matches!(judged, Judgement::CannotBeJudged { .. })
    }

    #[test]
    fn a_deviation_is_judged_only_by_a_reference_ten_times_as_good() {
        let judged = |d, e| judge(d, e, 0.1, "refine");
        assert_eq!(judged(0.05, 0.004), Judgement::Pass);
        assert_eq!(judged(0.2, 0.01), Judgement::Fail);
        // Too coarse: neither failed nor passed, however small or large the deviation is.
        for d in [0.0, 1e-9, 0.05, 0.2] {
            let open = judged(d, 0.021);
            assert!(is_open(&open) && open.word() == "cannot be judged", "{d}");
            assert!(open.remark().unwrap().ends_with("; refine"));
        }
    }

    #[test]
    fn a_deviation_far_within_its_limit_passes_by_a_reference_that_is_far_better_than_the_limit() {
        let judged = |d, e| judge(d, e, 0.5, "refine");
        assert_eq!(judged(0.0097, 0.0015), Judgement::PassByMargin);
        assert_eq!(judged(0.0, 0.049), Judgement::PassByMargin);
        assert!(
            judged(0.0097, 0.0015)
                .remark()
                .unwrap()
                .contains("ten times")
        );
        assert!(is_open(&judged(0.0097, 0.05)) && is_open(&judged(0.45, 0.046)));
        assert!(is_open(&judge(0.01, f64::NAN, f64::INFINITY, "")));
    }

    #[test]
    fn by_margin_the_own_error_must_not_decide() {
        let judged = |d, e| judge_by_margin(d, e, 16.0, "refine");
        assert_eq!(judged(8.0, 3.0), Judgement::Pass);
        assert_eq!(judged(20.0, 3.0), Judgement::Fail);
        assert!(is_open(&judged(14.0, 3.0)) && is_open(&judged(18.0, 3.0)));
        assert!(is_open(&judged(8.0, f64::NAN)));
        assert_eq!(judged(f64::NAN, 1.0), Judgement::Fail);
    }

    #[test]
    fn roundings_pass_and_what_is_no_number_does_not() {
        assert_eq!(judge(1e-12, 1e-11, 0.1, "").word(), "pass");
        assert_eq!(judge(0.0, 0.0, 0.1, "").word(), "pass");
        assert_eq!(judge(f64::NAN, 0.0, 0.1, ""), Judgement::Fail);
        assert!(is_open(&judge(0.05, f64::NAN, 0.1, "")));
        assert!(is_open(&judge(0.0, f64::NAN, 0.1, "")));
        assert!(is_open(&judge(0.05, f64::INFINITY, 0.1, "")));
    }

    #[test]
    fn a_ratio_of_two_roundings_is_no_failed_correction() {
        let judged = |pair, e| judge_correction(pair, e, 5.0, "");
        assert!(
            judged([1e-12, 1e-12], 1e-13)
                .remark()
                .unwrap()
                .contains("nothing to correct")
        );
        assert_eq!(judged([20.0, 0.2], 0.01), Judgement::Pass);
        assert_eq!(judged([20.0, 2.0], 0.01), Judgement::Fail);
        assert!(judged([20.0, 1e-9], 1e-9).passed());
        // What is left cannot be told from the reference's own error, which is far below the limit of 1.
        assert_eq!(judged([20.0, 0.0], 0.01), Judgement::PassByMargin);
        assert!(is_open(&judged([20.0, 0.0], 0.2)));
        assert!(is_open(&judged([1e-12, 1e-12], 0.01)));
        assert_eq!(judged([f64::NAN, f64::NAN], 0.01), Judgement::Fail);
    }
}
