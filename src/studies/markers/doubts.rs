//! What makes the figures of a correction doubtful, and what an unknown edge does to them.
//!
//! A doubt stands next to the figures and makes the command end with exit code 1.

use super::MarkerStudy;
use crate::corrector::estimation::FieldEstimate;
use crate::error::Diagnostic;
use crate::markers::Frame;
use crate::statistics::{Estimate, robust_deviation};

/// A measured force farther from the field's than so many of its standard deviations contradicts it: noise alone does so in
/// six of a hundred thousand cases.
const CONTRADICTS: f64 = 4.0;

/// More outliers than this share of the markers are no outliers.
const MANY: f64 = 0.1;

/// Noise farther from what was stated than this factor is told, if it is by four standard errors too.
const OFF: f64 = 1.25;

impl MarkerStudy {
    /// What makes the figures of the frames doubtful, of all of them first.
    pub fn all_doubts(&self, estimates: &[FieldEstimate]) -> Vec<Diagnostic> {
        let mut all = self.doubts.clone();
        let frames = self.series.frames.iter().zip(estimates);
        for (frame, estimate) in frames {
            all.extend(of_frame(frame, estimate));
        }
        all
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

/// Moves the end of an interval on the side of `by`.
fn widen(estimate: &mut Estimate, by: f64) {
    let [low, high] = &mut estimate.interval;
    match by < 0.0 {
        true => *low += by,
        false => *high += by,
    }
}

fn of_frame(frame: &Frame, estimate: &FieldEstimate) -> Vec<Diagnostic> {
    let doubts = [
        noise(estimate),
        outliers(estimate),
        edges(estimate),
        correlation(estimate),
    ];
    let doubts = doubts.into_iter().flatten().chain(forces(estimate));
    let named = |(message, hint): (String, &str)| {
        Diagnostic::warning("", format!("frame {}: {message}", frame.number)).hint(hint)
    };
    doubts.map(named).collect()
}

type Doubt = (String, &'static str);

/// The noise that is left, from the median of the standardised residuals, compared with the stated one.
fn noise(estimate: &FieldEstimate) -> Option<Doubt> {
    // The standard error of ln of a deviation from the median.
    const ERROR: f64 = 0.72;
    const SURE: f64 = 4.0;
    let markers = estimate.markers.iter().flatten();
    let lengths: Vec<f64> = markers.map(|marker| marker.standardised_residual).collect();
    // A field without noise that was brought onto another mesh has nothing to compare.
    if !estimate.known_noise || estimate.noise == 0.0 || lengths.is_empty() {
        return None;
    }
    let sure = SURE * ERROR / (lengths.len() as f64).sqrt();
    let ratio = estimate.noise_scale * robust_deviation(lengths);
    (ratio.ln().abs() > OFF.ln().max(sure)).then(|| {
        let relation = if ratio > 1.0 { "more" } else { "less" };
        let message = format!(
            "the markers scatter {ratio:.2} times as much as their stated noise, {relation} than chance allows"
        );
        (
            message,
            "intervals follow the stated noise: correct it, or leave it out to have it estimated; noise that is far too large \
             is misfit of law, thickness or conditions",
        )
    })
}

fn outliers(estimate: &FieldEstimate) -> Option<Doubt> {
    let markers = estimate.markers.iter().flatten();
    let count = markers.clone().count();
    let off = markers.filter(|marker| marker.outlier).count();
    (off as f64 > MANY * count as f64).then(|| {
        (
            format!("{off} of {count} markers are outliers, which is no noise"),
            "look at the conditions, the law, and the noise if it is stated; --physics weighted, or look at vtk/markers.pvd \
             where they are",
        )
    })
}

fn edges(estimate: &FieldEstimate) -> Option<Doubt> {
    let found = estimate.contradiction.as_ref()?;
    let which = match found.edges.is_empty() {
        true => "all of its edges together".to_owned(),
        false => {
            let edges: Vec<&str> = found.edges.iter().map(|(name, _)| name.as_str()).collect();
            edges.join(", ")
        }
    };
    let message = format!(
        "the data contradict what is said of {which}: let go, the misfit falls as by noise in {:.0e} of cases",
        found.probability
    );
    Some((
        message,
        "an edge inside of the specimen is \"unknown\", not rigid or free; else the law or the thickness is wrong",
    ))
}

fn correlation(estimate: &FieldEstimate) -> Option<Doubt> {
    let found = estimate.whiteness.filter(|found| !found.is_white())?;
    let message = format!(
        "not explained: what is left of neighbouring markers correlates by {:.2}, white noise by {:.2} ± {:.2}; intervals are \
         too narrow",
        found.correlation, found.expected, found.deviation
    );
    Some((
        message,
        "law, thickness or conditions do not explain the data, or their noise is not independent from marker to marker, as where \
         subsets of image correlation overlap: give fewer markers then",
    ))
}

fn forces(estimate: &FieldEstimate) -> Vec<Doubt> {
    let checks = estimate.force_checks.iter();
    let wrong = checks.filter(|check| check.standardised.abs() > CONTRADICTS);
    let doubt = |check: &crate::corrector::estimation::ForceCheck| {
        let measured = &check.measured;
        let message = format!(
            "the force measured on {} along {}, {} ± {} N, contradicts the field's {:.4} N by {:.1} standard errors",
            measured.edge,
            ["x", "y"][measured.axis],
            measured.force,
            measured.standard_deviation,
            check.found,
            check.standardised.abs()
        );
        (
            message,
            "look at thickness, material, units, the place of the edges, and the force's sign: it is the grip's on the specimen",
        )
    };
    wrong.map(doubt).collect()
}
