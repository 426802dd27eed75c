//! What intervals of one estimate hold of the truth.

use super::subject::Subject;
use super::trial::is_away;
use crate::estimation::{Answer, FieldEstimate};

/// Stresses within so many radii of the hole's centre are near it.
const NEAR: f64 = 1.6;

/// What of one seed lies in its intervals: how many, and of how many.
#[derive(Clone, Copy, Debug, Default)]
pub struct CoverageTrial {
    answer: Answer,
    /// Displacements, stresses, stresses near the hole, force, parameter.
    held: [[usize; 2]; 5],
}

impl CoverageTrial {
    /// The verdict alone.
    pub fn verdict(field: &FieldEstimate) -> Self {
        Self {
            answer: field.verdict.answer,
            ..Self::default()
        }
    }

    /// Of an estimate, and one with a parameter of the law whose true value is `truth`. What is not explained has no intervals.
    pub fn new(
        subject: &Subject,
        radius: f64,
        field: &FieldEstimate,
        fitted: &FieldEstimate,
        truth: Option<f64>,
    ) -> Self {
        let mut trial = Self::verdict(field);
        if !field.has_intervals() {
            return trial;
        }
        trial.displacements(subject, field);
        trial.stresses(subject, radius, field);
        let right = field.forces.iter().find(|force| force.edge == "right");
        if let Some(right) = right {
            trial.count(3, right.force[0].holds(subject.truth.force));
        }
        if let (Some((_, _, parameter)), Some(truth)) = (fitted.parameters.first(), truth) {
            trial.count(4, parameter.holds(truth));
        }
        trial
    }

    fn displacements(&mut self, subject: &Subject, field: &FieldEstimate) {
        let nodes = subject.mesh.nodes.iter();
        let exact = nodes.flat_map(|node| subject.truth.displacement(*node));
        let estimates = field.displacement.iter().zip(&field.displacement_error);
        for (exact, (u, error)) in exact.zip(estimates) {
            self.count(0, (exact - u).abs() <= field.reach * error);
        }
    }

    fn stresses(&mut self, subject: &Subject, radius: f64, field: &FieldEstimate) {
        let (mesh, truth) = (&subject.mesh, &subject.truth);
        let [low, high] = mesh.bounding_box();
        let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        for (cell, estimate) in field.cells.iter().enumerate() {
            let position = mesh.position(cell, mesh.shape(cell).centre());
            let Some(exact) = truth.stress(position).filter(|_| is_away(truth, position)) else {
                continue;
            };
            let distance = (position[0] - middle[0]).hypot(position[1] - middle[1]);
            let stress = estimate.first_piola_kirchhoff_stress.iter();
            for (exact, (stress, error)) in exact.iter().zip(stress.zip(&estimate.stress_error)) {
                let held = (exact - stress).abs() <= field.reach * error;
                self.count(1, held);
                if distance < NEAR * radius {
                    self.count(2, held);
                }
            }
        }
    }

    fn count(&mut self, of: usize, held: bool) {
        self.held[of][0] += usize::from(held);
        self.held[of][1] += 1;
    }
}

/// Shares of all seeds in %.
pub struct Shares {
    /// Of explained, explained with correlated noise, undecided, not explained.
    pub answers: [f64; 4],
    held: [[usize; 2]; 5],
}

impl Shares {
    /// Of all seeds.
    pub fn of(all: &[CoverageTrial]) -> Self {
        let answers = [
            Answer::Explained,
            Answer::Correlated,
            Answer::Undecided,
            Answer::NotExplained,
        ];
        let mut held = [[0; 2]; 5];
        for trial in all {
            for (sum, counts) in held.iter_mut().zip(trial.held) {
                (0..2).for_each(|part| sum[part] += counts[part]);
            }
        }
        Self {
            answers: answers.map(|answer| {
                let matching = all.iter().filter(|trial| trial.answer == answer);
                100.0 * matching.count() as f64 / all.len() as f64
            }),
            held,
        }
    }

    /// Of displacements, stresses, stresses near the hole, forces and parameters in their intervals; `None` where none is given.
    pub fn covered(&self) -> [Option<f64>; 5] {
        self.held
            .map(|[held, all]| (all > 0).then(|| 100.0 * held as f64 / all as f64))
    }
}
