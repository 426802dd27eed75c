//! The finite elements that a specimen's other models are held to, and their own error.

use super::measured::Measured;
use crate::compare::area_weighted_percent;
use crate::finite_element::convergence::richardson;
use crate::finite_element::error_estimate::ErrorEstimate;
use crate::mesh::Mesh;
use crate::problem::Solution;
use crate::results::{Block, Check, Wanted};
use crate::studies::specimen::problem::Specimen;

/// The finest finite elements.
pub struct Reference {
    /// On the finest mesh.
    pub finest: Solution,
    /// What is compared of all models.
    pub measured: Measured,
    /// One a load factor; `None` where the tangent of that state gives none.
    pub estimates: Vec<Option<ErrorEstimate>>,
    /// Up to two coarser meshes, from coarse to fine.
    pub(super) coarser: Vec<Solution>,
    /// The rounds of local refinement; none where the meshes are halved.
    pub(super) rounds: Vec<Round>,
    /// What the curves that a file's edges stand for change in what is measured at each load factor; `None` where there
    /// are no such edges.
    pub(super) outline: Option<Vec<f64>>,
}

/// One mesh of local refinement, with its errors at the worst load factor.
pub struct Round {
    /// Its cells.
    pub cells: usize,
    /// Its nodes.
    pub nodes: usize,
    /// Estimated error of the field in the energy norm in %.
    pub energy_percent: f64,
    /// Estimated error of what is measured in %.
    pub measured_percent: f64,
}

impl Reference {
    /// The solutions on coarser meshes, from coarse to fine.
    pub fn coarser(&self) -> &[Solution] {
        &self.coarser
    }

    /// How many load factors the finest mesh has reached.
    pub fn reached(&self) -> usize {
        self.finest.reached()
    }

    /// `Q2 elements on 48 × 16 cells, the finest of three meshes`, for reports.
    pub fn describe(&self) -> String {
        let (elements, cells) = (
            self.finest.mesh.element_names(),
            self.finest.mesh.describe(),
        );
        match self.rounds.len() {
            0 => {
                let others = [
                    "",
                    ", the finer of two meshes",
                    ", the finest of three meshes",
                ];
                format!(
                    "{elements} elements on {cells}{}",
                    others[self.coarser.len()]
                )
            }
            rounds => format!(
                "{elements} elements on {cells}, refined locally in {} rounds",
                rounds - 1
            ),
        }
    }

    /// How the finite elements become better.
    pub fn remedy(&self) -> &'static str {
        let quadratic = self.finest.mesh.shape(0).degree() == 2;
        match (self.rounds.is_empty(), quadratic) {
            (true, false) => "take finite elements of the second degree, such as \"Q2\"",
            (true, true) => "take more cells, or `adaptive = true` with \"T2\"",
            (false, _) => "take a smaller `finite_element.error`",
        }
    }

    /// The own error of what is measured at a load factor in %: by three meshes where there are three that were halved,
    /// otherwise by recovery, with that of a file's outline; `None` where it is not known.
    pub fn measured_percent(&self, step: usize) -> Option<f64> {
        let by_meshes = self.three_meshes_percent(step);
        let own = by_meshes.or_else(|| self.recovered_percent(step))?;
        match self.outline {
            Some(_) => Some(own + self.outline_percent(step)?),
            None => Some(own),
        }
    }

    /// Whether what is measured is none at a load factor, so that there is no error of it.
    fn measures_none(&self, step: usize) -> bool {
        self.measured.none_of(&self.finest, step).is_some()
    }

    /// What the curves that a file's edges stand for change in what is measured at a load factor, in %.
    fn outline_percent(&self, step: usize) -> Option<f64> {
        if self.measures_none(step) {
            return Some(0.0);
        }
        let change = self.outline.as_ref()?.get(step)?;
        let measured = self.measured.at(&self.finest, step)?;
        Some(100.0 * (change / measured).abs())
    }

    /// What is said about a file's outline.
    fn outline_told(&self) -> Option<Block> {
        let steps = 0..self.outline.as_ref()?.len();
        let percents = steps.filter_map(|step| self.outline_percent(step));
        let most = percents.fold(0.0, f64::max);
        Some(Block::Paragraph(format!(
            "The outline: finite elements on meshes of the file have its edges, chords or parabolas. With the smooth \
             curves that these stand for the {} would change by up to {most:.2e} %; this is part of its own error.",
            self.measured.name()
        )))
    }

    /// The error of what is measured by three meshes at a load factor in %, where there are three.
    pub fn three_meshes_percent(&self, step: usize) -> Option<f64> {
        let [coarse, middle] = &self.coarser[..] else {
            return None;
        };
        if !self.rounds.is_empty() {
            return None;
        }
        if self.measures_none(step) {
            return Some(0.0);
        }
        let all = [coarse, middle, &self.finest].map(|own| self.measured.at(own, step));
        let [Some(coarse), Some(middle), Some(fine)] = all else {
            return None;
        };
        Some(richardson([coarse, middle, fine]).error_percent)
    }

    /// The error of what is measured by recovery at a load factor in %.
    pub fn recovered_percent(&self, step: usize) -> Option<f64> {
        if self.measures_none(step) {
            return Some(0.0);
        }
        let estimate = self.estimates.get(step)?.as_ref()?;
        let measured = self.measured.at(&self.finest, step)?;
        Some(100.0 * (estimate.force / measured).abs())
    }

    /// The error of the field by recovery in the energy norm at a load factor in %.
    pub fn energy_percent(&self, step: usize) -> Option<f64> {
        let estimate = self.estimates.get(step)?.as_ref()?;
        Some(estimate.energy.percent())
    }

    /// The error of the displacement at the nodes of a lattice by the coarser meshes, in relative L2 in %; `None` where no
    /// coarser mesh has the load factor.
    ///
    /// ```text
    /// e = ‖u₃ − u₂‖/(r − 1),   r = ‖u₂ − u₁‖/‖u₃ − u₂‖        ‖u₃ − u₂‖ where r ≤ 1
    /// ```
    pub fn displacement_percent(&self, step: usize, lattice: &Mesh) -> Option<f64> {
        let on_lattice = |own: &Solution| {
            let displacement = own.displacement(step)?;
            Some(own.mesh.displacement_on(displacement, lattice))
        };
        let fine = on_lattice(&self.finest)?;
        let coarser: Vec<_> = self.coarser.iter().filter_map(on_lattice).collect();
        let distance = |u: &[f64], v: &[f64]| area_weighted_percent(lattice, u, v);
        match &coarser[..] {
            [] => None,
            [only] => Some(distance(only, &fine)),
            [.., first, second] => {
                let (before, last) = (distance(first, second), distance(second, &fine));
                let ratio = before / last;
                let converges = ratio > 1.0 && ratio.is_finite();
                Some(if converges {
                    last / (ratio - 1.0)
                } else {
                    last
                })
            }
        }
    }

    /// Whether local refinement has come as far as the study wants.
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
        Some(Check::new(
            quantity,
            "%",
            wanted,
            source,
            last.energy_percent,
        ))
    }

    /// The outline's share of the error, and the rounds of local refinement.
    pub fn history(&self) -> Vec<Block> {
        let outline = self.outline_told();
        if self.rounds.is_empty() {
            return outline.into_iter().collect();
        }
        let head = [
            "round",
            "cells",
            "nodes",
            "error of the field by recovery, energy norm [%]",
            &format!("error of the {} by recovery [%]", self.measured.name()),
        ];
        let row = |(number, round): (usize, &Round)| {
            vec![
                number.to_string(),
                round.cells.to_string(),
                round.nodes.to_string(),
                format!("{:.4}", round.energy_percent),
                format!("{:.5}", round.measured_percent),
            ]
        };
        let text = "Local refinement: in every round the cells with half of the squared error are cut into four. Errors \
                    are those of the worst load factor.";
        let rounds = self.rounds.iter().enumerate().map(row);
        let history = [Block::Paragraph(text.into()), Block::table(&head, rounds)];
        outline.into_iter().chain(history).collect()
    }
}
