//! Requirements on computed values, and their results.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{Block, Table, limit, or_dash};
use crate::compare::judgement::Judgement;
use crate::document::stored::{StaticText, static_text};
use crate::units::number;

/// The requirement on a computed value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Wanted {
    /// A value, within a tolerance in percent of it.
    Equal(f64, f64),
    /// At most this value.
    AtMost(f64),
    /// At least this value.
    AtLeast(f64),
}

/// A checked value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// The quantity.
    pub quantity: String,
    /// Its unit.
    #[serde(deserialize_with = "static_text")]
    pub unit: StaticText,
    /// The requirement.
    pub wanted: Wanted,
    /// The source of the requirement.
    #[serde(deserialize_with = "static_text")]
    pub source: StaticText,
    /// The computed value.
    pub computed: f64,
    /// The error of the reference itself, in the check's unit, where it is known.
    pub own_error: Option<f64>,
    judgement: Option<Judgement>,
    is_end: bool,
    /// Whether it has neither a value nor a limit.
    is_fault: bool,
}

impl Check {
    /// A check of a computed value.
    pub fn new(
        quantity: impl Into<String>,
        unit: &'static str,
        wanted: Wanted,
        source: &'static str,
        computed: f64,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            unit,
            wanted,
            source,
            computed,
            own_error: None,
            judgement: None,
            is_end: false,
            is_fault: false,
        }
    }

    /// A fault that prevents a check.
    pub fn fault(quantity: impl Into<String>, source: &'static str) -> Self {
        Self {
            is_fault: true,
            ..Self::new(quantity, "–", Wanted::AtMost(0.0), source, f64::NAN)
        }
    }

    /// The end of a model before its last load factor, in a study that requires all of them.
    pub fn end(quantity: impl Into<String>) -> Self {
        Self {
            is_end: true,
            ..Self::fault(quantity, "the whole path")
        }
    }

    /// Whether it is the end of a model.
    pub fn is_end(&self) -> bool {
        self.is_end
    }

    /// Adds the judgement of a comparison with a reference that has an error of its own.
    #[must_use]
    pub fn judged(self, judgement: Judgement, own_error: f64) -> Self {
        Self {
            judgement: Some(judgement),
            own_error: own_error.is_finite().then_some(own_error),
            ..self
        }
    }

    /// Deviation from the wanted value in %, where there is one.
    pub fn error_percent(&self) -> Option<f64> {
        match self.wanted {
            Wanted::Equal(expected, _) => Some(100.0 * (self.computed / expected - 1.0).abs()),
            _ => None,
        }
    }

    /// The judgement of the check.
    pub fn judgement(&self) -> Judgement {
        match &self.judgement {
            Some(judgement) => judgement.clone(),
            None if self.is_met() => Judgement::Pass,
            None => Judgement::Fail,
        }
    }

    /// Whether the check passed; one that cannot be judged did not.
    pub fn passed(&self) -> bool {
        self.judgement().passed()
    }

    /// `pass`, `FAIL` or `cannot be judged`, with the reason where there is one.
    pub fn result(&self) -> String {
        let judgement = self.judgement();
        match judgement.remark() {
            Some(remark) => format!("{}: {remark}", judgement.word()),
            None => judgement.word().to_owned(),
        }
    }

    /// Whether the value meets the requirement; NaN does not.
    fn is_met(&self) -> bool {
        match self.wanted {
            Wanted::Equal(_, tolerance) => {
                self.error_percent().is_some_and(|error| error <= tolerance)
            }
            Wanted::AtMost(limit) => self.computed <= limit,
            Wanted::AtLeast(limit) => self.computed >= limit,
        }
    }

    /// The check in a line for a terminal, `pass force = 0.2 % (at most 0.5 %)`, of one case of several with its name, and a remark in a line
    /// below.
    fn line(&self, case: Option<&str>) -> String {
        let judgement = self.judgement();
        let case = case.map_or_else(String::new, |case| format!(" {case}:"));
        let mut text = format!(
            "{}{case} {}{}\n",
            judgement.word(),
            self.quantity,
            self.values()
        );
        if let Some(remark) = judgement.remark() {
            text += &format!("     {remark}\n");
        }
        text
    }

    /// ` = 0.2 % (at most 0.5 %)`; nothing behind a fault, which has no value and no limit.
    fn values(&self) -> String {
        if self.is_fault {
            return String::new();
        }
        let unit = match self.unit {
            "–" => String::new(),
            unit => format!(" {unit}"),
        };
        let wanted = match self.wanted {
            Wanted::Equal(value, tolerance) => format!("{} ± {} %", limit(value), limit(tolerance)),
            Wanted::AtMost(most) => format!("at most {}{unit}", limit(most)),
            Wanted::AtLeast(least) => format!("at least {}{unit}", limit(least)),
        };
        format!(" = {}{unit} ({wanted})", known(self.computed))
    }

    /// A description of the requirement.
    pub fn wanted(&self) -> String {
        match self.wanted {
            _ if self.is_fault => "–".to_owned(),
            Wanted::Equal(value, tolerance) => format!("{} ± {} %", limit(value), limit(tolerance)),
            Wanted::AtMost(most) => format!("≤ {}", limit(most)),
            Wanted::AtLeast(least) => format!("≥ {}", limit(least)),
        }
    }

    /// The same for machines.
    pub fn json(&self) -> Value {
        let wanted = match self.wanted {
            Wanted::Equal(value, tolerance) => {
                json!({ "equal": value, "tolerance_percent": tolerance })
            }
            Wanted::AtMost(limit) => json!({ "at_most": limit }),
            Wanted::AtLeast(limit) => json!({ "at_least": limit }),
        };
        json!({
            "quantity": self.quantity,
            "unit": self.unit,
            "wanted": wanted,
            "source": self.source,
            "computed": self.computed,
            "error_percent": self.error_percent(),
            "own_error": self.own_error,
            "result": self.judgement().word(),
            "remark": self.judgement().remark(),
            "passed": self.passed(),
        })
    }
}

/// The verdict on all requirements: failed where one fails, passed where all pass.
pub fn verdict(checks: &[Check]) -> &'static str {
    let mut judged = checks.iter().map(Check::judgement);
    if checks.iter().all(Check::passed) {
        "passed"
    } else if judged.any(|judgement| judgement == Judgement::Fail) {
        "failed"
    } else {
        "not been judged in all"
    }
}

/// A line for each check of some cases, with the names of these where there are several, and how many passed.
pub fn check_lines<'a>(checks: impl IntoIterator<Item = (Option<&'a str>, &'a Check)>) -> String {
    let (mut text, mut passed, mut count) = (String::new(), 0, 0);
    for (case, check) in checks {
        text += &check.line(case);
        passed += usize::from(check.passed());
        count += 1;
    }
    text + &format!("{passed} of {count} checks passed\n")
}

/// A figure; a dash for one that is not known.
fn known(value: f64) -> String {
    or_dash(Some(value), number)
}

/// A table of requirements.
pub fn requirements(checks: &[Check]) -> Block {
    Table::of(checks)
        .column("requirement", |check| check.quantity.clone())
        .column("unit", |check| check.unit.to_owned())
        .column("computed", |check| known(check.computed))
        .column("discretisation error of the reference", |check| {
            check.own_error.map_or("–".into(), number)
        })
        .column("wanted", |check| check.wanted())
        .column("source", |check| check.source.to_owned())
        .column("result", |check| check.result())
        .block()
}

/// A number with so many significant digits.
pub fn digits(value: f64, digits: i32) -> String {
    let exponent = value.abs().log10().floor();
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if !(-5.0..=6.0).contains(&exponent) {
        return format!("{value:.*e}", digits as usize - 1);
    }
    let decimals = (digits - 1 - exponent as i32).max(0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checks_pass_and_fail_as_they_should() {
        let check = |wanted, computed| Check::new("x", "mm", wanted, "a book", computed);
        assert!(check(Wanted::Equal(2.0, 1.0), 2.01).passed());
        assert!(!check(Wanted::Equal(2.0, 1.0), 2.03).passed());
        assert!(
            check(Wanted::AtMost(1.0), 1.0).passed() && !check(Wanted::AtMost(1.0), 1.1).passed()
        );
        assert!(check(Wanted::AtLeast(1.0), 1.0).passed());
        for wanted in [
            Wanted::Equal(2.0, 1.0),
            Wanted::AtMost(1.0),
            Wanted::AtLeast(1.0),
        ] {
            assert!(!check(wanted, f64::NAN).passed());
        }
    }

    #[test]
    fn numbers_are_written_with_five_digits() {
        assert_eq!(number(0.012_345_67), "0.012346");
        assert_eq!(number(-123.456_78), "-123.46");
        assert_eq!(number(1.234_56e-7), "1.23e-7");
        assert_eq!((limit(80.0), limit(1e-9)), ("80".into(), "1e-9".into()));
    }

    #[test]
    fn a_path_that_ended_has_neither_a_value_nor_a_limit() {
        let end = Check::end("springs ended");
        assert!(end.is_fault && !end.passed());
        assert_eq!(end.wanted(), "–");
        let check = Check::new("force", "%", Wanted::AtMost(0.5), "study", f64::NAN);
        assert_eq!(
            (check.is_fault, check.wanted()),
            (false, "≤ 0.5".to_owned())
        );
    }
}
