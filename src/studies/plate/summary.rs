//! The headline figures of a plate for a terminal.

use super::results::Results;
use crate::compare::Deviation;
use crate::compare::judgement::Judgement;
use crate::problem::ClampedPlate;
use crate::results::{Check, Wanted};

/// The headline figures of a run.
pub fn summary(results: &Results, requirements: &[Check]) -> String {
    let mut text = String::from(
        "deviation from the finite elements [%]\n\
         \x20            mass-spring                       corrected\n\
         stretch  displacement  departure  force   displacement  departure  force\n",
    );
    for step in &results.comparison {
        let row = |deviation: Option<&Deviation>, decimals: [usize; 3]| {
            let figure = |value: fn(&Deviation) -> f64, index: usize| match deviation {
                Some(deviation) => format!("{:.*}", decimals[index], value(deviation)),
                None => "–".to_owned(),
            };
            [
                figure(|deviation| deviation.displacement_percent, 0),
                figure(|deviation| deviation.departure_percent, 1),
                figure(|deviation| deviation.force_percent.abs(), 2),
            ]
        };
        let [u, departure, force] = row(step.mass_spring.as_ref(), [3, 2, 2]);
        text += &format!(
            "{:>5} %  {u:>12}  {departure:>9}  {force:>5}   ",
            ClampedPlate::percent(step.stretch)
        );
        let [u, departure, force] = row(step.corrected.as_ref(), [4, 3, 3]);
        text += &format!("{u:>12}  {departure:>9}  {force:>5}\n");
    }
    for requirement in requirements {
        text += &self::requirement(requirement);
    }
    text
}

fn requirement(check: &Check) -> String {
    let judgement = check.judgement();
    let mut text = format!("{} {}", judgement.word(), check.quantity);
    if !check.computed.is_nan() || judgement == Judgement::Fail {
        let bound = match check.wanted {
            Wanted::AtLeast(limit) => format!("at least {limit} %"),
            Wanted::AtMost(limit) | Wanted::Equal(limit, _) => format!("at most {limit} %"),
        };
        text += &format!(": {:.3} % ({bound})", check.computed);
    }
    if let Some(remark) = judgement.remark() {
        text += &format!(": {remark}");
    }
    text + "\n"
}
