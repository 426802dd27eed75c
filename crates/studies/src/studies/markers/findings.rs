//! Findings on the frames of a correction: what makes figures doubtful, and remarks on noise and outliers.
//!
//! A doubt stands next to the figures and makes the command end with exit code 1.

use super::MarkerStudy;
use super::finding::once;
use super::gross_errors::has_many;
use super::quantities::{outliers, used};
use super::verdict::{other_gap, reasons};
use crate::estimation::{Answer, FieldEstimate, ForceCheck, RegressedLaw, Robust};
use crate::results::{BESIDE_CORNERS, Finding, Stretches, small_strain};
use crate::solve::vector::largest;
use crate::statistics::small_probability;
use crate::units::{decimals, number};

/// What a rule has found in a frame, with its figures, and what to do, which is the same for all frames.
type Doubt = (String, &'static str);

/// A rule by its name.
type Rule = (
    &'static str,
    fn(&MarkerStudy, &FieldEstimate) -> Option<Doubt>,
);

/// The rules by which each frame is checked, the likeliest cause of others first.
const RULES: [Rule; 9] = [
    ("unknown-edge", unknown_edge),
    ("contradicted-edges", contradicted_edges),
    ("contradicted-force", contradicted_force),
    (NOT_EXPLAINED, not_explained),
    ("no-measurement", no_measurement),
    ("many-outliers", many_outliers),
    ("stated-noise", stated_noise),
    ("large-strains", large_strains),
    ("beyond-card", beyond_card),
];

/// The rules whose findings the terminal shows elsewhere: the verdict, and a mistake in the files.
pub const NOT_EXPLAINED: &str = "not-explained";
pub const MISTAKE: &str = "likely-mistake";

impl MarkerStudy {
    /// What makes the figures doubtful, the likeliest cause first: a mistake in the file, or else what concerns all frames, and each doubt
    /// of single ones once.
    pub fn all_doubts(&self, estimates: &[FieldEstimate]) -> Vec<Finding> {
        if let Some(mistake) = self.mistake.clone() {
            // All other findings follow from the mistake.
            return [&[Finding::doubt_of(MISTAKE, mistake)], &self.doubts[..]].concat();
        }
        let numbers = self.frame_numbers();
        let findings = RULES.iter().flat_map(|(name, rule)| {
            let by_frame = self.frames_with(estimates).filter_map(|(frame, estimate)| {
                let (message, remedy) = rule(self, estimate)?;
                Some((frame.number, (message, remedy.to_owned())))
            });
            once(&numbers, name, by_frame)
        });
        self.doubts.iter().cloned().chain(findings).collect()
    }

    /// The numbers of the frames in their order.
    pub(super) fn frame_numbers(&self) -> Vec<usize> {
        let frames = self.series.frames.iter();
        frames.map(|frame| frame.number).collect()
    }
}

/// Remarks on gross errors and on the noise, once for all frames.
pub fn remarks(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<String> {
    let numbers = study.frame_numbers();
    let rules = [gross_errors, uneven_noise];
    let findings = rules.iter().flat_map(|rule| {
        let frames = study.frames_with(estimates);
        let by_frame = frames.filter_map(|(frame, estimate)| {
            Some((frame.number, (rule(study, estimate)?, String::new())))
        });
        once(&numbers, "", by_frame)
    });
    findings.map(|finding| finding.message).collect()
}

/// Gross errors that were detected without being asked for.
fn gross_errors(study: &MarkerStudy, estimate: &FieldEstimate) -> Option<String> {
    (study.conditions.robust.is_none() && estimate.robust == Robust::Tukey).then(|| {
        format!(
            "{} of {} markers are outliers, some farther off than noise can explain: Tukey's weights reduce the weight of a marker the farther it is off \
             (robust = \"no\" gives all markers full weight)",
            outliers(estimate),
            used(estimate)
        )
    })
}

fn uneven_noise(_: &MarkerStudy, estimate: &FieldEstimate) -> Option<String> {
    let range = |[low, high]: [f64; 2]| {
        if high - low > 1e-6 * high {
            format!("{low:.2e} to {high:.2e} mm")
        } else {
            format!("{low:.2e} mm")
        }
    };
    let [x, y] = estimate.noise_range?.map(range);
    Some(format!(
        "the noise differs between markers, ux {x} and uy {y}: noisier markers get less weight"
    ))
}

/// An edge that only the markers define is the reason why the data cannot judge.
fn unknown_edge(_: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    let gap = estimate.unknown_edges()?;
    let message = format!(
        "the free edges are known only to within {} mm, because only the markers define them, and the data contradict them where the markers end",
        decimals(gap, 4)
    );
    let remedy = "give the edges and holes with --outline or --mesh; an edge that carries load is not free: leave it out of --free";
    Some((message, remedy))
}

fn contradicted_edges(study: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    let contradiction = estimate.contradiction.as_ref()?;
    let edges = contradiction.edges.iter().map(|(name, _)| name.as_str());
    let mut names = edges.collect::<Vec<_>>().join(", ");
    if names.is_empty() {
        names = "all edges together".to_owned();
    }
    let message = format!(
        "the data contradict the stated condition on {names}: releasing it reduces the misfit by an amount that noise alone would reach with probability {}",
        small_probability(contradiction.probability)
    );
    let first = estimate.verdict.trials.first();
    let is_misplaced = first.is_some_and(|trial| other_gap(study, &trial.alternative).is_some());
    let remedy = if is_misplaced {
        "check --edge-gap (edge_gap), the distance from the outermost markers to the specimen's edge: another one explains more than any other \
         alternative, as listed below"
    } else {
        "give an edge that lies inside the specimen the condition \"unknown\", not rigid or free; otherwise the law or the thickness is wrong"
    };
    Some((message, remedy))
}

/// The measured force that is farthest from that of the field.
fn contradicted_force(_: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    let size = |check: &&ForceCheck| check.standardised.abs();
    let checks = estimate.force_checks.iter();
    let wrong = checks.filter(|check| check.contradicts());
    let worst = wrong.max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let measured = &worst.measured;
    let message = format!(
        "the force measured on {} along {}, {} ± {} N, contradicts the field's {} N by {:.1} standard errors",
        measured.edge,
        ["x", "y"][measured.axis],
        number(measured.force),
        number(measured.standard_deviation),
        decimals(worst.estimated, 4),
        size(&worst)
    );
    Some((
        message,
        "check thickness, material, units, the position of the edges, and the sign of the force, which is that of the grip on the specimen",
    ))
}

fn not_explained(_: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    let verdict = &estimate.verdict;
    (verdict.answer == Answer::NotExplained).then(|| {
        let message = format!("{}: {}", verdict.answer.words(), reasons(verdict).join("; "));
        (
            message,
            "intervals are not valid here; see the report for what would improve the fit, and residuals.png and misfit.png for where it is worst",
        )
    })
}

/// Noise that is too large for a measurement: more than a share of the specimen's size and of its displacement.
fn no_measurement(study: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    /// Noise over the specimen's smaller extent, and over the largest displacement.
    const NO_MEASUREMENT: f64 = 0.03;
    let (noise, [x, y]) = (estimate.noise, study.mesh.size());
    let share = noise / x.min(y);
    let moved = largest(&estimate.displacement);
    let is_none = share > NO_MEASUREMENT && noise > NO_MEASUREMENT * moved;
    (estimate.verdict.answer != Answer::NotExplained && is_none).then(|| {
        let message = format!(
            "the markers scatter by {} mm, {:.1} % of the specimen's smaller extent: markers were lost or matched wrongly",
            decimals(noise, 4),
            100.0 * share
        );
        (
            message,
            "leave the frame out, or check its picture; its results rest on almost no valid data",
        )
    })
}

fn many_outliers(_: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    has_many(estimate).then(|| {
        let (count, all) = (outliers(estimate), used(estimate));
        let remedy = match estimate.robust {
            Robust::No => {
                "check the conditions, the law, and the noise if it is stated; try --physics weighted, or see in vtk/markers.pvd \
                 where they lie"
            }
            _ => {
                "see in vtk/markers.pvd where they lie: markers that were lost or matched wrongly lie anywhere, those that the law or the conditions \
                 do not fit lie together; all have reduced or zero weight"
            }
        };
        (
            format!("{count} of {all} markers are outliers, more than noise explains"),
            remedy,
        )
    })
}

/// A stated noise that the data contradict.
fn stated_noise(study: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    // That of images is the tracking's, not a user's.
    let ratio = estimate.noise_ratio.filter(|_| !study.is_of_images())?;
    let message = if estimate.noise_range.is_some() {
        "the markers' noise does not follow the stated noise and varies over the field or between ux and uy; the observed noise is used instead".to_owned()
    } else {
        let relation = if ratio > 1.0 { "more" } else { "less" };
        format!(
            "the markers scatter {ratio:.2} times as much as their stated noise, {relation} than chance allows: the stated noise is \
             rescaled to the observed scatter"
        )
    };
    Some((
        message,
        "correct the stated noise, or leave it out to have it estimated",
    ))
}

/// Strains that are too large for the law.
fn large_strains(study: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    let (mesh, field) = (&study.mesh, &estimate.displacement);
    let reason = study.cards().in_turn(mesh, |card, cells| {
        let reason = small_strain::reason(&*card.law, (mesh, cells), field)?;
        Some((reason, String::new()))
    });
    Some((reason?.0, small_strain::LARGE_STRAINS))
}

/// Stretches beyond the range of the card, on more than a hundredth of the area: its law is an extrapolation there. A law whose
/// parameters are all estimated with the field is calibrated by it.
fn beyond_card(study: &MarkerStudy, estimate: &FieldEstimate) -> Option<Doubt> {
    let acting = study.regressed.as_ref().map(RegressedLaw::acting);
    let is_calibrated = acting.is_some_and(|keys| estimate.parameters.len() == keys.len());
    let (mesh, field) = (&study.mesh, &estimate.displacement);
    let reason = study.cards().in_turn(mesh, |card, cells| {
        if is_calibrated && std::ptr::eq(card, &study.card) {
            return None;
        }
        let stretches = Stretches::new(card, (mesh, cells), field);
        let is_large = stretches.share > BESIDE_CORNERS;
        let reason = stretches.reason(card, "").filter(|_| is_large)?;
        Some((reason, String::new()))
    });
    Some((
        reason?.0,
        "stresses and forces there are extrapolated, which no interval includes: use a card fitted to tests up to these stretches",
    ))
}
