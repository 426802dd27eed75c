//! Rounds of local refinement: whether their goal is reached, and their table.

use super::reference::Reference;
use crate::compare::judgement::Judgement;
use crate::results::{Block, Check, Table, Wanted, or_dash};
use crate::studies::specimen::problem::Specimen;

impl Reference {
    /// Whether local refinement has reached the study's goal; `None` without local refinement.
    pub fn goal_check(&self, specimen: &Specimen) -> Option<Check> {
        let (goal, last) = (specimen.refinement?, self.rounds.last()?);
        let mut quantity = "finite elements' own error of the field, energy norm".to_owned();
        if last.energy_percent > goal.error_percent {
            quantity += &format!(
                "; {} cells and no more than most_cells = {} were allowed",
                last.cells, goal.most_cells
            );
        }
        let wanted = Wanted::AtMost(goal.error_percent);
        let source = "the study's goal";
        let check = Check::new(quantity, "%", wanted, source, last.energy_percent);
        Some(if last.energy_percent.is_nan() {
            check.judged(unknown_energy(), f64::NAN)
        } else {
            check
        })
    }

    /// The outline's share of the error, and the rounds of local refinement.
    pub fn history(&self) -> Vec<Block> {
        let outline = self.outline_note();
        if self.rounds.is_empty() {
            return outline.into_iter().collect();
        }
        let text = "Local refinement: in every round the cells that contribute half of the squared error are divided into four. Errors are those at \
                    the worst load factor.";
        let table = Table::of(self.rounds.iter().enumerate())
            .column("round", |(number, _)| number.to_string())
            .column("cells", |(_, round)| round.cells.to_string())
            .column("nodes", |(_, round)| round.nodes.to_string())
            .column(
                "error of the field by recovery, energy norm [%]",
                |(_, round)| figure(round.energy_percent, 4),
            )
            .column(
                format!("error of the {} by recovery [%]", self.measured.name()),
                |(_, round)| figure(round.measured_percent, 5),
            );
        let history = [Block::Paragraph(text.into()), table.block()];
        outline.into_iter().chain(history).collect()
    }
}

/// The judgement of an error that recovery does not estimate.
fn unknown_energy() -> Judgement {
    Judgement::CannotBeJudged {
        reason: "recovery gives no error estimate: no load factor is reached, or between the integration points the field folds or exceeds the limit \
                 of the law"
            .into(),
        remedy: "take smaller load factors, or allow more cells".into(),
    }
}

/// A figure with some decimals; a dash for one that is not known.
fn figure(value: f64, decimals: usize) -> String {
    let known = value.is_finite().then_some(value);
    or_dash(known, |value| format!("{value:.decimals$}"))
}
