//! Mistakes in how a field was written. Each is tried by estimating the field that would have been intended: where the mistake was made, this
//! field is far nearer to an equilibrium than the one that was written.
//!
//! ```text
//! AIC = 2 n ln r + 2 p        r: residual, n: number of values, p: number of parameters
//! ```
//!
//! decides between both. A nearly uniform field has the same residual with and without a mistake, since loads on all edges hold any uniform
//! strain in equilibrium. There the edges decide: some are free in the intended field and surely not in the written one, as in hardly any
//! biaxial test.
//!
//! Only fields whose misfit is more than their noise, or in which no edge is free where the data may choose, are tried, and of a file only the
//! frame that moves most, because all frames of a file have the same mistake.

use std::sync::Arc;

use nalgebra::Matrix2;
use rayon::prelude::*;

use super::MarkerStudy;
use super::quantities::{residual_rms, rounding, used};
use crate::error::Diagnostic;
use crate::estimation::{EdgeCondition, EdgeOutcome, FieldEstimate};
use crate::markers::{Frame, Marker, Mistake};
use crate::material::PlaneState;
use crate::material::mirrored::MirroredLaw;
use crate::units::decimals;

/// By how much Akaike's criterion is smaller where a mistake is reported: by chance this happens to one of e¹⁵ fields.
const SURE: f64 = 30.0;

/// The ratio of residuals from which on a mistake is reported though the intended field is not explained either.
const NEARER: f64 = 3.0;

/// The share of the residuals' variance that correlates, from which on a misfit may be that of a mistake.
const MUCH: f64 = 0.5;

/// The mean principal stretches that specimens are believed to have.
const STRETCHES: std::ops::Range<f64> = 0.2..5.0;

/// Whether the mean displacement gradient of the intended field is that of a test: a specimen that is pulled is not only sheared, and becomes
/// narrower.
fn is_plausible(mistake: Mistake, written: &Matrix2<f64>, intended: &Matrix2<f64>) -> bool {
    let deformation = Matrix2::identity() + intended;
    let stretches = deformation.singular_values();
    let is_sound = deformation.determinant() > 0.0
        && stretches.iter().all(|stretch| STRETCHES.contains(stretch));
    let normal_strain = |h: &Matrix2<f64>| h.m11.abs().max(h.m22.abs());
    is_sound
        && match mistake {
            Mistake::FinalPositions | Mistake::Reversed => true,
            Mistake::Exchanged => normal_strain(intended) > normal_strain(written),
            Mistake::Mirrored(_) => intended.m11 * intended.m22 < 0.0,
        }
}

impl MarkerStudy {
    /// The mistake that a file seems to hold, if there is one.
    pub(super) fn likely_mistake(&self, estimates: &[FieldEstimate]) -> Option<Diagnostic> {
        if self.is_of_images() {
            return self.mistaken_images.clone();
        }
        let frames = self.frames_with(estimates);
        let doubtful = frames.filter(|(_, estimate)| may_be_mistaken(estimate));
        let (frame, estimate) =
            doubtful.max_by(|(a, _), (b, _)| a.motion().total_cmp(&b.motion()))?;
        let ((seems, hint), intended) = self.likeliest(frame, Some(estimate))?;
        let message = format!(
            "frame {}: the field seems to be {seems}: with this undone {}",
            frame.number,
            evidence(&intended, estimate)
        );
        Some(Diagnostic::warning("", message).hint(hint))
    }

    /// Why a frame seems to have no estimate: a mistake in its file, or wrong conditions of edges.
    pub(super) fn cause_without_solution(&self, frame: &Frame) -> Option<Diagnostic> {
        let Some(((seems, hint), _)) = self.likeliest(frame, None) else {
            return self.wrong_conditions(frame);
        };
        let message = format!("the field has no solution, but seems to be {seems}");
        Some(Diagnostic::error("", message).hint(hint))
    }

    /// The edge, or else all edges, without whose stated conditions a frame is explained; `None` where it is not explained without all of them.
    fn wrong_conditions(&self, frame: &Frame) -> Option<Diagnostic> {
        if self.coarse.is_some() {
            return None;
        }
        let edges = self.conditions.edges.iter();
        let stated = edges.filter(|(_, condition)| *condition != EdgeCondition::Unknown);
        let stated: Vec<&str> = stated.map(|(name, _)| name.as_str()).collect();
        if stated.is_empty() || !self.is_explained_without(&stated, frame) {
            return None;
        }
        // A single edge has been tried above.
        let mut each = stated.chunks(1).filter(|_| stated.len() > 1);
        let one = each.find(|name| self.is_explained_without(name, frame));
        let names = one.unwrap_or(&stated).join(" and ");
        let message = format!(
            "the field has no solution with the stated conditions, but is explained if {names} moved in an unknown way"
        );
        let hint = match self.unknown_gap {
            None => "state only what is known of edges: a free one carries no load",
            Some(_) => {
                "state only what is known of edges: a free one carries no load; and where the specimen ends (--outline, --edge-gap), as a free edge \
                 is known only from markers here"
            }
        };
        Some(Diagnostic::error("", message).hint(hint))
    }

    fn is_explained_without(&self, names: &[&str], frame: &Frame) -> bool {
        let mut study = self.clone();
        for (name, condition) in &mut study.conditions.edges {
            if names.contains(&name.as_str()) {
                *condition = EdgeCondition::Unknown;
            }
        }
        let estimate = study.estimate_frame(frame);
        estimate.is_ok_and(|estimate| estimate.is_explained())
    }

    /// What explains the most, in words with a remedy, and the estimate of the field that was intended.
    fn likeliest(
        &self,
        frame: &Frame,
        written: Option<&FieldEstimate>,
    ) -> Option<((String, &'static str), FieldEstimate)> {
        if self.coarse.is_some() || self.is_of_images() {
            return None;
        }
        let gradient = frame.mean_gradient()?;
        let tried = Mistake::ALL.into_par_iter().filter_map(|mistake| {
            let markers = frame.markers.iter().map(|marker| Marker {
                displacement: mistake.intended(marker.position, marker.displacement),
                ..*marker
            });
            let intended = Frame {
                markers: markers.collect(),
                ..frame.clone()
            };
            if !is_plausible(mistake, &gradient, &intended.mean_gradient()?) {
                return None;
            }
            Some((mistake.words(), self.estimate_frame(&intended).ok()?))
        });
        let mut tried: Vec<_> = tried.collect();
        let mirrored = self.mirrored().map(|study| study.estimate_frame(frame));
        let image_axes = (
            "given in axes of an image, with y down".to_owned(),
            "state --y-axis down; or the fibres on the card have the opposite angle",
        );
        let mirrored = mirrored.and_then(Result::ok);
        tried.extend(mirrored.map(|estimate| (image_axes, estimate)));
        tried.retain(|(_, estimate)| is_nearer(estimate, written));
        let least = |(_, a): &(_, _), (_, b): &(_, _)| criterion(a).total_cmp(&criterion(b));
        tried.into_iter().min_by(least)
    }

    /// The study with its material seen in a mirror, which is that of the other y axis; `None` where no directions of one sheet tell it from
    /// this one.
    fn mirrored(&self) -> Option<Self> {
        let law = &self.card.law;
        let is_sheet = law.plane_state() == PlaneState::Stress && law.bulk_modulus().is_none();
        let alone = self.regions.iter().all(|(_, card)| card.law.is_isotropic());
        let is_known = self.regressed.is_none() && !self.understood.turned_up;
        (is_sheet && !law.is_isotropic() && alone && is_known).then(|| {
            let mut mirrored = self.clone();
            let law = Arc::clone(law);
            mirrored.card.law = Arc::new(MirroredLaw { law });
            mirrored
        })
    }
}

/// Whether the misfit of a field is more than its noise, or none of its edges is free where the data may choose.
fn may_be_mistaken(estimate: &FieldEstimate) -> bool {
    let correlation = estimate.verdict.correlation;
    let is_far = correlation.is_some_and(|correlation| correlation.share > MUCH);
    !has_free_edge(estimate) || (!estimate.is_explained() && is_far)
}

/// The evidence for a mistake: the misfit that it explains, or the edges that become free.
fn evidence(intended: &FieldEstimate, written: &FieldEstimate) -> String {
    if criterion(written) - criterion(intended) <= SURE {
        let freed = freed(intended, written).collect::<Vec<_>>().join(", ");
        return format!("it is explained with free edges ({freed}), instead of loads on all edges");
    }
    format!(
        "it leaves a residual of {} mm with {:.1} parameters, instead of {} mm with {:.1}",
        decimals(residual_rms(intended), 4),
        intended.effective_parameters,
        decimals(residual_rms(written), 4),
        written.effective_parameters,
    )
}

/// Whether a field is explained with a free edge, stated or chosen by the data, where they may choose.
fn is_natural(estimate: &FieldEstimate) -> bool {
    let is_free = |edge: &EdgeOutcome| edge.condition == EdgeCondition::Free;
    estimate.is_explained() && (has_free_edge(estimate) || estimate.edges.iter().any(is_free))
}

/// Whether one of the edges is free where the data may choose; true where they may not.
fn has_free_edge(estimate: &FieldEstimate) -> bool {
    let mut chosen = estimate
        .edges
        .iter()
        .filter(|edge| edge.probability.is_some())
        .map(|edge| edge.condition == EdgeCondition::Free)
        .peekable();
    chosen.peek().is_none() || chosen.any(|is_free| is_free)
}

/// The edges that are free in the intended field and surely not free in the written one.
fn freed<'a>(
    intended: &'a FieldEstimate,
    written: &FieldEstimate,
) -> impl Iterator<Item = &'a str> {
    let surely = (-SURE / 2.0).exp();
    let both = intended.edges.iter().zip(&written.edges);
    let freed = both.filter(move |(intended, written)| {
        let refused = written.condition != EdgeCondition::Free;
        let is_sure = written
            .probability
            .is_some_and(|probability| probability < surely);
        intended.condition == EdgeCondition::Free && refused && is_sure
    });
    freed.map(|(edge, _)| &*edge.edge)
}

/// Whether the intended field is far more probable than the written one.
fn is_nearer(intended: &FieldEstimate, written: Option<&FieldEstimate>) -> bool {
    let Some(written) = written else {
        return is_natural(intended);
    };
    // Where a stated edge is wrong, its release reduces the misfit by more than a mistake that was not made.
    let trials = written.verdict.trials.iter();
    let released = trials
        .map(|trial| trial.residual_rms)
        .fold(f64::INFINITY, f64::min);
    let residual = residual_rms(intended);
    let nearer = NEARER * residual < residual_rms(written) && residual < released;
    let is_sure = criterion(written) - criterion(intended) > SURE;
    let frees = !has_free_edge(written) && freed(intended, written).next().is_some();
    (is_sure && (nearer || is_natural(intended))) || (frees && is_natural(intended))
}

/// Akaike's criterion; residuals below the rounding of the displacements count as equal.
fn criterion(estimate: &FieldEstimate) -> f64 {
    let residual = residual_rms(estimate).max(rounding(estimate));
    let values = 2.0 * used(estimate) as f64;
    2.0 * values * residual.ln() + 2.0 * estimate.effective_parameters
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;
    use std::path::Path;

    use nalgebra::Vector2;

    use super::*;
    use crate::budget::Budget;
    use crate::estimation::Answer;
    use crate::markers::ReadSettings;
    use crate::material::Card;
    use crate::material::sheet::{Kinematics, PlaneTensor};
    use crate::mesh::CellShape;
    use crate::statistics::normal_numbers;
    use crate::studies::markers::{Conditions, MeshSource, Request};

    /// The doubt about a strip of 60 mm × 20 mm with these stretches, written with a mistake or none, and the answer.
    fn doubt_and_answer(
        [x, y]: [f64; 2],
        noise: f64,
        mistake: Option<Mistake>,
    ) -> (Option<String>, Answer) {
        let mut normal = normal_numbers(7);
        let mut drawn = || noise * normal();
        let card = Card::load("neo-hooke", Path::new(".")).unwrap();
        judged(card, |position| {
            let u = [
                (x - 1.0) * position[0] + drawn(),
                (y - 1.0) * position[1] + drawn(),
            ];
            match mistake {
                None => u,
                Some(Mistake::FinalPositions) => [position[0] + u[0], position[1] + u[1]],
                // The others undo themselves.
                Some(mistake) => mistake.intended(position, u),
            }
        })
    }

    /// The doubt about such a strip, whose file holds these displacements, and the answer.
    fn judged(
        card: Card,
        mut written: impl FnMut([f64; 2]) -> [f64; 2],
    ) -> (Option<String>, Answer) {
        let mut table = "x [mm],y [mm],ux [mm],uy [mm]\n".to_owned();
        for position in (0..13 * 5).map(|k| [5.0 * f64::from(k / 5), 5.0 * f64::from(k % 5)]) {
            let [ux, uy] = written(position);
            writeln!(table, "{},{},{ux},{uy}", position[0], position[1]).unwrap();
        }
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("strip.csv");
        std::fs::write(&file, table).unwrap();
        let request = Request {
            files: vec![file],
            reading: ReadSettings::default(),
            images: Default::default(),
            material: String::new(),
            thickness: 1.0,
            mesh: MeshSource::Data,
            cell_size: Some(5.0),
            shape: CellShape::Quad8,
            holes: false,
            conditions: Conditions::default(),
            forces: None,
            budget: Budget::USUAL,
        };
        let mut study = MarkerStudy::prepare_with(card, request, &|_| ()).unwrap();
        match study.estimate(&|_| ()) {
            Ok(estimates) => {
                let doubt = study.mistake.map(|mistake| mistake.message);
                (doubt, estimates[0].verdict.answer)
            }
            Err(fault) => (Some(fault.to_string()), Answer::NotExplained),
        }
    }

    /// Loads on all edges hold any uniform strain, so that the misfit is noise whatever the file holds.
    #[test]
    fn a_mistake_in_a_uniform_field_is_named_by_the_edges_that_it_frees() {
        let stretches = [1.05, 1.2, 1.6].into_par_iter();
        stretches.for_each(|stretch: f64| {
            for noise in [0.0, 0.005] {
                let free = [stretch, stretch.sqrt().recip()];
                for mistake in Mistake::ALL {
                    let (doubt, answer) = doubt_and_answer(free, noise, Some(mistake));
                    let case = format!("{mistake:?} {stretch} {noise}: {doubt:?}");
                    assert_eq!(answer, Answer::NotExplained, "{case}");
                    assert!(doubt.unwrap().contains(&mistake.words().0), "{case}");
                }
                let (doubt, answer) = doubt_and_answer(free, noise, None);
                assert_ne!(answer, Answer::NotExplained);
                assert_eq!(doubt, None, "{stretch} {noise}");
            }
        });
    }

    #[test]
    fn a_strip_that_is_pulled_along_both_axes_holds_no_mistake() {
        for stretches in [[1.3, 1.1], [1.2, 1.2], [1.3, 1.0], [1.1, 1.02]] {
            for noise in [0.0, 0.02] {
                let (doubt, answer) = doubt_and_answer(stretches, noise, None);
                assert_eq!(doubt, None, "{stretches:?} {noise}");
                assert_ne!(answer, Answer::NotExplained, "{stretches:?} {noise}");
            }
        }
    }

    /// A strip with fibres at 30 degrees that is pulled is sheared by them; in a mirror they have the opposite angle.
    #[test]
    fn a_y_axis_that_points_down_is_told_by_fibres() {
        let card = |degrees: f64| {
            let text = format!(
                "title = \"fibres\"\nlaw = \"holzapfel-gasser-ogden\"\n[parameters]\nmu = \"0.01 MPa\"\nk1 = \"0.02 MPa\"\n\
                 k2 = 1.5\nkappa = 0.08\nfamilies = \"one\"\nangle = \"{degrees} deg\"\n"
            );
            Card::parse("fibres", "fibres.toml", &text).unwrap()
        };
        let law = card(30.0).law;
        let mut h = PlaneTensor::new(0.2, 0.0, 0.0, -0.1);
        // No load on the long edges.
        for _ in 0..20 {
            let at = law.response(&Kinematics::new(&h).unwrap());
            let (p, t) = (at.first_piola_kirchhoff_stress, at.tangent);
            let across = Matrix2::new(t[(1, 1)], t[(1, 3)], t[(3, 1)], t[(3, 3)]);
            let step = across.try_inverse().unwrap() * Vector2::new(p[1], p[3]);
            h -= PlaneTensor::new(0.0, step[0], 0.0, step[1]);
        }
        for (degrees, is_mirrored) in [(30.0, false), (-30.0, true)] {
            let mut normal = normal_numbers(7);
            let (doubt, answer) = judged(card(degrees), |[x, y]| {
                [h[0] * x + h[1] * y, h[2] * x + h[3] * y].map(|u| u + 0.005 * normal())
            });
            assert_eq!(answer == Answer::NotExplained, is_mirrored, "{doubt:?}");
            let named = doubt.iter().any(|doubt| doubt.contains("with y down"));
            assert_eq!(named, is_mirrored, "{degrees}: {doubt:?}");
        }
    }
}
