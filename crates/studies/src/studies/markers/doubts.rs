//! What makes the figures of a correction doubtful, and what an unknown edge does to them.
//!
//! A doubt stands next to the figures and makes the command end with exit code 1.

use super::MarkerStudy;
use super::frame_agreement;
use super::gross_errors::has_many;
use super::of_frames::{OfFrame, once};
use super::report::{outliers, used};
use crate::error::Diagnostic;
use crate::estimation::{Answer, FieldEstimate, ForceCheck, RegressedLaw, Robust};
use crate::results::{BESIDE_CORNERS, Stretches, small_strain};
use crate::statistics::{Estimate, median, small_probability};
use crate::units::{decimals, number};

/// A frame that is looked at.
struct Looked<'a> {
    study: &'a MarkerStudy,
    estimate: &'a FieldEstimate,
    /// The noise of most frames, where there are several.
    usual_noise: Option<f64>,
}

/// What is doubtful and what to do about it, which is the same for all frames.
type Doubt = (String, &'static str);

/// What may be doubtful of a frame, the likeliest cause of what follows first.
const DOUBTS: [fn(&Looked) -> Option<Doubt>; 10] = [
    |frame| frame.unknown_edge(),
    |frame| idle_edges(frame.estimate),
    |frame| edges(frame.estimate),
    |frame| forces(frame.estimate),
    |frame| not_explained(frame.estimate),
    |frame| frame.no_measurement(),
    |frame| many_outliers(frame.estimate),
    |frame| noise(frame.estimate),
    |frame| frame.strains(),
    |frame| frame.beyond_card(),
];

impl MarkerStudy {
    /// What makes the figures doubtful, the likeliest cause first: a mistake in the file, or else what concerns all frames, and each doubt
    /// of single ones once.
    pub fn all_doubts(&self, estimates: &[FieldEstimate]) -> Vec<Diagnostic> {
        if let Some(mistake) = self.mistake(estimates) {
            // All else follows from a field that nobody measured.
            return [&[mistake][..], &self.doubts].concat();
        }
        let usual = median(estimates.iter().map(|estimate| estimate.noise));
        let usual_noise = Some(usual).filter(|usual| estimates.len() > 2 && *usual > 0.0);
        let of_frames = DOUBTS.iter().flat_map(|doubt| {
            let frames = self.series.frames.iter().zip(estimates);
            frames.filter_map(move |(frame, estimate)| {
                let looked = Looked {
                    study: self,
                    estimate,
                    usual_noise,
                };
                doubt(&looked).map(|(message, hint)| OfFrame {
                    frame: frame.number,
                    message,
                    hint: hint.to_owned(),
                })
            })
        });
        let of_frames = once(&self.frame_numbers(), of_frames.collect());
        let of_all = frame_agreement::doubts(estimates);
        [&self.doubts[..], &of_frames, &of_all].concat()
    }

    /// The numbers of the frames in their order.
    pub(super) fn frame_numbers(&self) -> Vec<usize> {
        let frames = self.series.frames.iter();
        frames.map(|frame| frame.number).collect()
    }

    /// An estimate whose intervals of forces hold that the edge may lie a marker's spacing farther out: one more row of
    /// markers would fit in else. The force grows with the width as far as the strain energy along the free edges says; a
    /// modulus that follows a measured force falls by as much.
    pub(super) fn with_unknown_edge(&self, mut estimate: FieldEstimate) -> FieldEstimate {
        let Some(gap) = self.unknown_gap else {
            return estimate;
        };
        let more = estimate.growth * gap;
        for force in estimate.forces.iter_mut().flat_map(|edge| &mut edge.force) {
            let farther = more * force.value;
            widen(force, farther);
        }
        for (_, unit, found) in &mut estimate.parameters {
            if *unit == "MPa" {
                let less = found.value / (1.0 + more) - found.value;
                widen(found, less);
            }
        }
        estimate
    }
}

impl Looked<'_> {
    /// An edge that nothing but the markers tells of may be what does not explain the data.
    fn unknown_edge(&self) -> Option<Doubt> {
        let gap = self.study.unknown_gap?;
        (self.estimate.verdict.answer == Answer::NotExplained).then(|| {
            let message = format!(
                "the free edges are known only to within {} mm, because only the markers define them; with precise data even a smaller \
                 offset leads to rejection",
                decimals(gap, 4)
            );
            (
                message,
                "give the edges and holes with --outline or --mesh, or set --edge-gap if the report estimates how far the free edges lie from those of the mesh",
            )
        })
    }

    /// Strains that are too large for the law.
    fn strains(&self) -> Option<Doubt> {
        let law = self.study.law(self.estimate);
        let displacement = &self.estimate.displacement;
        let reason = small_strain::reason(&*law, &self.study.mesh, displacement)?;
        Some((reason, small_strain::LARGE_STRAINS))
    }

    /// Stretches beyond the range of the card, on more than a hundredth of the area: its law is an extrapolation there. A law whose
    /// parameters are all found with the field is calibrated by it.
    fn beyond_card(&self) -> Option<Doubt> {
        let study = self.study;
        let acting = study.regressed.as_ref().map(RegressedLaw::acting);
        if acting.is_some_and(|keys| self.estimate.parameters.len() == keys.len()) {
            return None;
        }
        let stretches = Stretches::new(&study.card, &study.mesh, &self.estimate.displacement);
        let reason = stretches.reason(&study.card, "");
        let reason = reason.filter(|_| stretches.share > BESIDE_CORNERS)?;
        Some((reason, EXTRAPOLATED))
    }

    /// Noise that is no measurement's: a share of the specimen, or many times that of most frames, where there are several.
    fn no_measurement(&self) -> Option<Doubt> {
        if self.estimate.verdict.answer == Answer::NotExplained {
            return None;
        }
        let (noise, [low, high]) = (self.estimate.noise, self.study.mesh.bounding_box());
        let across = (high[0] - low[0]).min(high[1] - low[1]);
        let reason = if noise > NO_MEASUREMENT * across {
            format!(
                "{:.1} % of the specimen's smaller extent",
                100.0 * noise / across
            )
        } else {
            let usual = self.usual_noise.filter(|usual| noise > NOISIER * usual)?;
            format!("{:.0} times as much as in most frames", noise / usual)
        };
        let message = format!(
            "the markers scatter by {} mm, {reason}: markers were lost or matched wrongly",
            decimals(noise, 4)
        );
        Some((
            message,
            "leave the frame out, or check its picture; its results rest on almost no valid data",
        ))
    }
}

/// Noise over the specimen's smaller extent, and over the median of all frames, beyond which a frame is no measurement.
const NO_MEASUREMENT: f64 = 0.03;
const NOISIER: f64 = 20.0;

/// What helps where the card is left.
const EXTRAPOLATED: &str = "stresses and forces there are extrapolated, which no interval includes: use a card fitted to tests up to \
    these stretches";

/// Moves the end of an interval on the side of `by`.
fn widen(estimate: &mut Estimate, by: f64) {
    let [low, high] = &mut estimate.interval;
    if by < 0.0 { *low += by } else { *high += by }
}

/// The noise that was stated, where the data contradict it.
fn noise(estimate: &FieldEstimate) -> Option<Doubt> {
    let ratio = estimate.noise_ratio?;
    if estimate.noise_range.is_some() {
        let message = "the markers' noise does not follow the stated noise and varies over the field or between ux and uy; the observed noise is used instead";
        let hint = "correct the stated noise, or leave it out to have it estimated";
        return Some((message.to_owned(), hint));
    }
    let relation = if ratio > 1.0 { "more" } else { "less" };
    let message = format!(
        "the markers scatter {ratio:.2} times as much as their stated noise, {relation} than chance allows: the stated noise is \
         rescaled to the observed scatter"
    );
    Some((
        message,
        "correct the stated noise, or leave it out to have it estimated",
    ))
}

fn many_outliers(estimate: &FieldEstimate) -> Option<Doubt> {
    has_many(estimate).then(|| {
        let (off, count) = (outliers(estimate), used(estimate));
        let hint = match estimate.robust {
            Robust::No => {
                "check the conditions, the law, and the noise if it is stated; try --physics weighted, or see in vtk/markers.pvd \
                 where they lie"
            }
            _ => {
                "see in vtk/markers.pvd where they lie: markers that were lost or matched wrongly lie anywhere, those that the law or the conditions \
                 do not fit lie together; all have reduced or zero weight"
            }
        };
        (format!("{off} of {count} markers are outliers, more than noise explains"), hint)
    })
}

fn edges(estimate: &FieldEstimate) -> Option<Doubt> {
    let found = estimate.contradiction.as_ref()?;
    let which = if found.edges.is_empty() {
        "all edges together".to_owned()
    } else {
        let edges: Vec<&str> = found.edges.iter().map(|(name, _)| name.as_str()).collect();
        edges.join(", ")
    };
    let message = format!(
        "the data contradict the stated condition on {which}: releasing it reduces the misfit by an amount that noise alone would reach with probability {}",
        small_probability(found.probability)
    );
    Some((
        message,
        "give an edge that lies inside the specimen the condition \"unknown\", not rigid or free; otherwise the law or the thickness is wrong",
    ))
}

/// Edges that are free, but not where the mesh has them.
fn idle_edges(estimate: &FieldEstimate) -> Option<Doubt> {
    let idle = estimate.edges.iter().filter(|edge| edge.idle);
    let names: Vec<&str> = idle.map(|edge| edge.edge.as_str()).collect();
    let which = match names[..] {
        [] => return None,
        [_] => "carries no force, but the data reject a free edge there",
        _ => "carry no force, but the data reject free edges there",
    };
    let message = format!(
        "{} {which}: the specimen probably ends elsewhere, and forces correspond to the mesh's width",
        names.join(", ")
    );
    Some((
        message,
        "state how far the edges lie outside the markers with --edge-gap, or give them with --outline or --mesh",
    ))
}

fn not_explained(estimate: &FieldEstimate) -> Option<Doubt> {
    let verdict = &estimate.verdict;
    (verdict.answer == Answer::NotExplained).then(|| {
        let reasons: Vec<String> = verdict.reasons.iter().map(|reason| reason.words()).collect();
        let message = format!("{}: {}", verdict.answer.words(), reasons.join("; "));
        (
            message,
            "intervals are not valid here; see the report for what would improve the fit, and residuals.png and misfit.png for where it is worst",
        )
    })
}

/// The measured force that is farthest from that of the field.
fn forces(estimate: &FieldEstimate) -> Option<Doubt> {
    let wrong = estimate
        .force_checks
        .iter()
        .filter(|check| check.contradicts());
    let size = |check: &&ForceCheck| check.standardised.abs();
    let worst = wrong.max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let measured = &worst.measured;
    let message = format!(
        "the force measured on {} along {}, {} ± {} N, contradicts the field's {} N by {:.1} standard errors",
        measured.edge,
        ["x", "y"][measured.axis],
        number(measured.force),
        number(measured.standard_deviation),
        decimals(worst.found, 4),
        size(&worst)
    );
    Some((
        message,
        "check thickness, material, units, the position of the edges, and the sign of the force, which is that of the grip on the specimen",
    ))
}
