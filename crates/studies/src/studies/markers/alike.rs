//! Whether the residuals of the markers are alike from frame to frame, as a misfit is and the noise of single pictures is not.
//!
//! The noise of the picture at rest is common to all frames: where it is as large as that of the other pictures, the residuals of two
//! frames correlate by ½. A correlation above 0.8 would take a picture at rest with twice their noise. Where one of the two frames is
//! not explained by itself, a correlation above ½ is enough to say that both have the same misfit.

use std::collections::BTreeMap;

use super::quantities::sound;
use crate::estimation::{Answer, FieldEstimate, Reason, residual_products};
use crate::markers::Frame;
use crate::statistics::normal_tail;

/// The largest correlation that is attributed to the picture at rest: where both frames would be explained by themselves, and where
/// one is not.
const COMMON: [f64; 2] = [0.8, 0.5];

/// The probability by noise below which residuals are too much alike.
const LEVEL: f64 = 1e-4;

/// The least number of independent values from which a correlation is judged.
const FEWEST: f64 = 6.0;

/// Estimates of frames in their order, each compared with the one before.
#[derive(Default)]
pub struct ComparedFrames<'a> {
    frames: Vec<&'a Frame>,
    estimates: Vec<FieldEstimate>,
}

impl<'a> ComparedFrames<'a> {
    /// Adds the estimate of the next frame; returns the one before, whose verdict is final now.
    pub fn push(
        &mut self,
        frame: &'a Frame,
        mut estimate: FieldEstimate,
    ) -> Option<(&'a Frame, &FieldEstimate)> {
        let before = self.frames.last().copied();
        if let Some((before, last)) = before.zip(self.estimates.last_mut()) {
            compare([before, frame], [last, &mut estimate]);
        }
        self.frames.push(frame);
        self.estimates.push(estimate);
        let settled = self.estimates.iter().rev().nth(1);
        before.zip(settled)
    }

    /// The last frame and its estimate.
    pub fn last(&self) -> Option<(&'a Frame, &FieldEstimate)> {
        self.frames.last().copied().zip(self.estimates.last())
    }

    /// All estimates.
    pub fn into_estimates(self) -> Vec<FieldEstimate> {
        self.estimates
    }
}

/// Refutes two frames whose noise correlates between neighbours where their residuals are alike.
fn compare(frames: [&Frame; 2], estimates: [&mut FieldEstimate; 2]) {
    let [before, after] = &estimates;
    let (Some(of_a), Some(of_b)) = (before.verdict.correlation, after.verdict.correlation) else {
        return;
    };
    // Both components of as many markers as are independent.
    let values = 2.0 * of_a.independent.min(of_b.independent);
    let correlation = correlation((frames[0], before), (frames[1], after));
    let refuted = [before, after].map(|estimate| estimate.verdict.answer == Answer::NotExplained);
    let common = COMMON[usize::from(refuted.contains(&true))];
    if probability(correlation, common, values) >= LEVEL {
        return;
    }
    for estimate in estimates {
        let verdict = &mut estimate.verdict;
        let mut reasons = verdict.reasons.iter();
        if !reasons.any(|reason| matches!(reason, Reason::Alike(_))) {
            verdict.reasons.push(Reason::Alike(correlation));
        }
        verdict.answer = Answer::NotExplained;
    }
}

/// The probability of such a correlation among so many independent pairs of numbers whose true correlation is at most `common`, by Fisher's
/// transformation.
fn probability(correlation: f64, common: f64, pairs: f64) -> f64 {
    if pairs < FEWEST || correlation <= common {
        return 1.0;
    }
    let excess = correlation.min(1.0 - f64::EPSILON).atanh() - common.atanh();
    0.5 * normal_tail(excess * (pairs - 3.0).sqrt())
}

/// The correlation of the residuals of the markers that are sound in both frames; zero where there is none.
fn correlation(before: (&Frame, &FieldEstimate), after: (&Frame, &FieldEstimate)) -> f64 {
    let [ab, aa, bb] = residual_products(&residuals(before), &residuals(after));
    if aa * bb > 0.0 {
        ab / (aa * bb).sqrt()
    } else {
        0.0
    }
}

fn residuals((frame, estimate): (&Frame, &FieldEstimate)) -> BTreeMap<usize, [f64; 2]> {
    let markers = sound(frame, estimate);
    markers
        .map(|(_, marker, residual)| (marker.number, residual))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimation::{MarkerEstimate, NoiseCorrelation, Verdict};
    use crate::markers::Marker;
    use crate::statistics::normal_numbers;

    const MARKERS: usize = 40;

    fn frame(number: usize) -> Frame {
        let marker = |number| Marker {
            number,
            position: [number as f64, 0.0],
            displacement: [0.0; 2],
            standard_deviation: None,
        };
        Frame {
            number,
            time: None,
            markers: (0..MARKERS).map(marker).collect(),
        }
    }

    /// A frame with such residuals, and noise that correlates between neighbours.
    fn estimated(residuals: &[[f64; 2]]) -> FieldEstimate {
        let marker = |residual: &[f64; 2]| {
            Some(MarkerEstimate {
                residual: *residual,
                standardised_residual: 1.0,
                trust: 1.0,
                outlier: false,
            })
        };
        let correlation = Some(NoiseCorrelation {
            length: 1.0,
            share: 1.0,
            independent: MARKERS as f64,
            evidence: 30.0,
        });
        let verdict = Verdict {
            answer: Answer::Correlated,
            correlation,
            ..Verdict::default()
        };
        let markers = residuals.iter().map(marker).collect();
        FieldEstimate {
            markers,
            verdict,
            ..FieldEstimate::default()
        }
    }

    /// How many of 200 frames are not explained, each compared with a first frame that has the answer `first`. Both have noise of their own of
    /// size 1, that of the picture at rest of size `rest`, and a misfit of size `misfit` in common.
    fn count_unexplained(rest: f64, misfit: f64, first: Answer) -> usize {
        let mut normal = normal_numbers(7);
        let frames = [frame(1), frame(2)];
        let mut count = 0;
        for _ in 0..200 {
            let mut noise = |size: f64| -> Vec<[f64; 2]> {
                let mut one = || size * normal();
                (0..MARKERS).map(|_| [one(), one()]).collect()
            };
            let (at_rest, common, noises) = (noise(rest), noise(misfit), [noise(1.0), noise(1.0)]);
            let residuals = noises.map(|noises| -> Vec<[f64; 2]> {
                let all = noises.iter().zip(&at_rest).zip(&common);
                all.map(|((value, rest), common)| {
                    [0, 1].map(|axis| value[axis] - rest[axis] + common[axis])
                })
                .collect()
            });
            let [mut before, mut after] = residuals.map(|residuals| estimated(&residuals));
            before.verdict.answer = first;
            compare(frames.each_ref(), [&mut before, &mut after]);
            count += usize::from(!after.is_explained());
        }
        count
    }

    #[test]
    fn noise_of_the_picture_at_rest_is_no_misfit_and_what_both_frames_have_in_common_is() {
        let count = |rest, misfit| count_unexplained(rest, misfit, Answer::Correlated);
        assert_eq!([count(0.0, 0.0), count(1.0, 0.0), count(1.5, 0.0)], [0; 3]);
        assert!(count(2.0, 0.0) <= 1, "{}", count(2.0, 0.0));
        assert!(count(1.0, 6.0) >= 195, "{}", count(1.0, 6.0));
    }

    #[test]
    fn beside_a_frame_that_is_not_explained_less_misfit_is_told_and_noise_is_none() {
        let count = |rest, misfit| count_unexplained(rest, misfit, Answer::NotExplained);
        assert!(count(1.0, 0.0) <= 1, "{}", count(1.0, 0.0));
        assert!(count(1.0, 3.0) >= 190, "{}", count(1.0, 3.0));
    }

    #[test]
    fn a_frame_is_handed_on_when_the_one_after_it_is_known() {
        let residuals: Vec<[f64; 2]> = (0..MARKERS).map(|i| [(i as f64).sin(), 1.0]).collect();
        let frames = [frame(1), frame(2), frame(3)];
        let mut compared = ComparedFrames::default();
        for (index, frame) in frames.iter().enumerate() {
            let settled = compared.push(frame, estimated(&residuals));
            let settled =
                settled.map(|(before, estimate)| (before.number, estimate.is_explained()));
            assert_eq!(settled, (index > 0).then_some((index, false)));
        }
        let (last, estimate) = compared.last().unwrap();
        assert_eq!((last.number, estimate.is_explained()), (3, false));
        assert_eq!(compared.into_estimates().len(), 3);
    }

    #[test]
    fn few_values_white_noise_and_lost_markers_tell_nothing() {
        let residuals: Vec<[f64; 2]> = (0..MARKERS).map(|i| [(i as f64).sin(), 1.0]).collect();
        let alike = |change: &dyn Fn(&mut FieldEstimate)| {
            let [mut before, mut after] = [estimated(&residuals), estimated(&residuals)];
            change(&mut after);
            compare([&frame(1), &frame(2)], [&mut before, &mut after]);
            after.is_explained()
        };
        assert!(!alike(&|_| ()));
        assert!(alike(&|estimate| estimate.verdict.correlation = None));
        assert!(alike(&|estimate| estimate
            .verdict
            .correlation
            .as_mut()
            .unwrap()
            .independent = 2.0));
        assert!(alike(&|estimate| estimate
            .markers
            .iter_mut()
            .for_each(|marker| *marker = None)));
    }
}
