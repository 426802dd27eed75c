//! One frame among all, at given parameters of the law.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::estimate::{JointFrame, Step};
use super::reduced::Reduced;
use crate::error::Error;
use crate::estimation::equations::{Equations, SearchState};
use crate::estimation::free_edges;
use crate::estimation::input::{
    Edge, Knowledge, MeasuredForce, Observations, RegressedLaw, Specimen, Task, observe,
};
use crate::estimation::judge::{Model, Rows, soundness};
use crate::estimation::noise::with_observed_noise;
use crate::estimation::regression::{MarkerRows, NormalEquations, VarianceComponents};
use crate::estimation::search::{MOST_STEPS, NearestField, VARIANCE_STEPS};
use crate::estimation::uncertainty::MeshDifference;
use crate::statistics::{CorrelatedNoise, Sites};

/// A frame whose free edges and noise are those that its markers show.
pub struct Frame<'a> {
    source: &'a JointFrame<'a>,
    edges: Vec<Edge>,
    observations: Observations,
    /// The known conditions without the measured forces.
    knowledge: Knowledge,
}

/// The state of a frame's search.
#[derive(Clone)]
pub struct State {
    state: SearchState,
    variances: VarianceComponents,
    /// Sₖ.
    pub information: DMatrix<f64>,
    /// tₖ.
    pub score: Step,
    /// Qₖ.
    pub misfit: f64,
}

/// The information of a frame at the end.
pub struct FrameInformation {
    /// Sₖ.
    pub information: DMatrix<f64>,
    /// Jₖ.
    pub spread: DMatrix<f64>,
    /// The markers' part of Jₖ.
    pub spread_of_markers: DMatrix<f64>,
    /// −2 ln L of one of its independent values.
    pub deviance: f64,
    /// The contribution of its discretisation error to the score, if that is known.
    pub mesh: Option<Step>,
    /// The contributions to the score of one standard deviation of the common error of all forces, and of all pictures.
    pub common: [Step; 2],
    /// Σ (F − f)²/(σ² + s²) of its forces.
    pub force_misfit: f64,
    /// Number of parameters of its edges that the data determine.
    pub effective: f64,
    /// Number of independent values of its markers.
    pub independent: f64,
    /// The relative growth of its forces where its free edges lie farther out by the gap that is not known.
    pub growth: f64,
    /// The residuals of its trusted markers by their numbers.
    residuals: BTreeMap<usize, [f64; 2]>,
}

/// A frame with the law of other frames.
pub struct CrossPrediction {
    /// The force of the field for each measured force, in N.
    pub forces: Vec<f64>,
    /// Root mean square of the components of the trusted markers' residuals in mm.
    pub residual_rms: f64,
}

/// The equations linearised about a field, with the law's parameters among the unknown parameters.
struct LawEquations {
    normal: NormalEquations,
    /// The derivatives of the markers.
    design: DMatrix<f64>,
    /// The effect of the discretisation error on the right-hand side.
    mesh: Option<DVector<f64>>,
    /// The effects on it of the common errors of forces, and of pictures.
    common: [DVector<f64>; 2],
    reduced: Reduced,
}

impl<'a> Frame<'a> {
    /// The frame with the free edges and the noise that its markers show with the law's first values.
    ///
    /// # Errors
    /// As [`crate::estimation::estimate`].
    pub fn new(source: &'a JointFrame<'a>, law: &RegressedLaw) -> Result<Self, Error> {
        let (first, mut observations) =
            observe(source.specimen.mesh, source.markers, &source.knowledge)?;
        let knowledge = Knowledge {
            law: None,
            forces: Vec::new(),
            ..source.knowledge.clone()
        };
        let search = |observations: &Observations| {
            let task = Task {
                specimen: specimen(source, law),
                observations,
                knowledge: &knowledge,
            };
            let nearest = free_edges::search(&task, first.clone())?;
            let other = nearest.other_noise(&nearest.markers(None));
            Ok((nearest.equations.edges, other))
        };
        let (edges, _) = with_observed_noise(&mut observations, search)?;
        Ok(Self {
            source,
            edges,
            observations,
            knowledge,
        })
    }

    pub fn measured(&self) -> &[MeasuredForce] {
        &self.source.knowledge.forces
    }

    /// Whether the noise is stated and not contradicted.
    pub fn knows_noise(&self) -> bool {
        self.observations.known_noise
    }

    /// The frame at the law's first values, from a state or from the start; the variances are fixed where `settled`.
    ///
    /// # Errors
    /// As the search.
    pub fn at(
        &self,
        law: &RegressedLaw,
        from: Option<&State>,
        settled: bool,
    ) -> Result<State, Error> {
        let nearest = self.nearest(law, from, settled)?;
        let (state, variances) = (nearest.state(), nearest.variances.clone());
        let reduced = self.law_equations(nearest, law, None)?.reduced;
        Ok(State {
            information: reduced.information,
            score: reduced.score,
            misfit: reduced.misfit,
            state,
            variances,
        })
    }

    /// The information of the frame at the law's first values.
    ///
    /// # Errors
    /// As the search.
    pub fn information(&self, law: &RegressedLaw, from: &State) -> Result<FrameInformation, Error> {
        let nearest = self.nearest(law, Some(from), true)?;
        let observations = &self.observations;
        let sites = Sites::new(observations.positions.clone());
        let noise = correlated_noise(&nearest);
        let markers = observations.chosen.len() as f64;
        let independent = 2.0
            * noise.map_or(markers, |noise| {
                noise.correlation.independent(sites.positions())
            });
        let deviance = if observations.known_noise {
            nearest.misfit(&nearest.fit, &nearest.variances) / (2.0 * markers)
        } else {
            nearest.variances.variance.ln()
        };
        let (effective, residuals) = (nearest.fit.effective, self.residuals(&nearest));
        let variances = nearest.variances.clone();
        let gap = self.source.knowledge.edge_gap;
        let growth = gap.map_or(0.0, |gap| gap * nearest.growth());
        let difference = nearest.mesh_difference();
        let about = self.law_equations(nearest, law, difference.as_ref())?;
        let reduced = about.reduced;
        let rows = MarkerRows {
            design: &about.design,
            weights: &observations.weights,
            variances: &variances,
        };
        let white = rows.information();
        let of_markers = noise.map_or(white.clone(), |noise| rows.spread(&noise, &sites));
        let spread = &about.normal.matrix - white + &of_markers;
        Ok(FrameInformation {
            spread: reduced.project(&spread),
            spread_of_markers: reduced.project(&of_markers),
            mesh: about.mesh.map(|target| &reduced.projection * target),
            common: about.common.map(|target| &reduced.projection * target),
            force_misfit: reduced.force_misfit,
            deviance,
            information: reduced.information,
            effective,
            independent,
            growth,
            residuals,
        })
    }

    /// The forces and residuals of the field with a law, which does not include the measured forces.
    ///
    /// # Errors
    /// As the search.
    pub fn cross_predict(
        &self,
        law: &RegressedLaw,
        from: Option<&State>,
    ) -> Result<CrossPrediction, Error> {
        let nearest = self.nearest(law, from, false)?;
        let forces = nearest.forces(1.0, None, &[])?;
        let predicted = |measured: &MeasuredForce| {
            let of_edge = forces.iter().filter(|force| force.edge == measured.edge);
            of_edge.map(|force| force.force[measured.axis].value).sum()
        };
        let trust = &nearest.variances.trust;
        let trusted = trust.iter().sum::<f64>().max(1.0);
        let rows = nearest.fit.residual.as_slice().chunks_exact(2).zip(trust);
        let square: f64 = rows
            .map(|(r, trust)| trust * (r[0] * r[0] + r[1] * r[1]))
            .sum();
        Ok(CrossPrediction {
            forces: self.measured().iter().map(predicted).collect(),
            residual_rms: (square / (2.0 * trusted)).sqrt(),
        })
    }

    /// The nearest field at the law's first values, which does not include the forces: their information on the law follows from the
    /// equations linearised about the field, so that a wrong force or thickness bends no edge.
    fn nearest(
        &self,
        law: &RegressedLaw,
        from: Option<&State>,
        settled: bool,
    ) -> Result<NearestField<'_>, Error> {
        let task = Task {
            specimen: specimen(self.source, law),
            observations: &self.observations,
            knowledge: &self.knowledge,
        };
        let search = Equations::new(&task, &self.edges)?;
        let Some(State {
            state, variances, ..
        }) = from
        else {
            return search.run(MOST_STEPS);
        };
        let adjusting = if settled { 0 } else { VARIANCE_STEPS };
        search.run_from(state.clone(), variances.clone(), adjusting, MOST_STEPS)
    }

    /// The equations linearised about a field, and reduced to the law's parameters.
    fn law_equations(
        &self,
        nearest: NearestField,
        law: &RegressedLaw,
        difference: Option<&MeshDifference>,
    ) -> Result<LawEquations, Error> {
        let knowledge = Knowledge {
            law: Some(law.clone()),
            ..self.source.knowledge.clone()
        };
        let mut state = nearest.state();
        let NearestField {
            mut equations,
            variances,
            ..
        } = nearest;
        equations.task.knowledge = &knowledge;
        let values = law.start();
        let first = equations.motion.parameters();
        let of_law = first..first + values.len();
        state.parameters.splice(first..first, values);
        let linear = equations.linearise(&state)?;
        let regression = equations.regression(&state, true, &linear);
        let normal = regression.equations(&variances);
        let measured = knowledge.measured_forces().iter();
        let gain = measured.map(|one| one.common_deviation * one.force / one.standard_deviation);
        let gain = linear
            .force_rows
            .0
            .tr_mul(&DVector::from_vec(gain.collect()));
        let magnified = equations.magnified(&state.field);
        let magnified = equations.target_of(&magnified, &linear.design, &variances);
        Ok(LawEquations {
            reduced: Reduced::new(&normal, of_law)?,
            normal,
            mesh: difference.map(|one| equations.mesh_target(one, &linear, &variances)),
            common: [gain, magnified * -knowledge.scale_deviation],
            design: linear.design,
        })
    }

    /// The residuals of the trusted markers, by their numbers.
    fn residuals(&self, nearest: &NearestField) -> BTreeMap<usize, [f64; 2]> {
        const TRUSTED: f64 = 0.5;
        let rows = nearest.fit.residual.as_slice().chunks_exact(2);
        let all = self.observations.chosen.iter().zip(rows);
        let trusted = all
            .zip(&nearest.variances.trust)
            .filter(|(_, trust)| **trust >= TRUSTED);
        trusted
            .map(|((index, r), _)| (self.source.markers[*index].number, [r[0], r[1]]))
            .collect()
    }
}

fn specimen<'a>(frame: &JointFrame<'a>, law: &RegressedLaw) -> Specimen<'a> {
    let laws = frame.specimen.laws.with_law(law.at(&law.start()));
    Specimen {
        laws,
        ..frame.specimen.clone()
    }
}

/// The likeliest correlation of the noise of a field's markers, where they show one.
fn correlated_noise(nearest: &NearestField) -> Option<CorrelatedNoise> {
    let weights = &nearest.observations().weights;
    let sound = soundness(weights, &nearest.fit, &nearest.variances);
    let rows = Rows::new(nearest, &sound, None)?;
    let noises = Model::of_search(&rows, nearest).noises(&rows);
    noises.first().copied()
}

/// The mean correlation of the residuals of the same markers in one frame and the next one of the same specimen; zero where there is
/// none, or frames differ in their markers.
pub fn common_noise(frames: &[&Frame], parts: &[FrameInformation]) -> f64 {
    let pairs = frames.windows(2).zip(parts.windows(2));
    let same = pairs.filter(|(pair, _)| {
        std::ptr::eq(pair[0].source.specimen.mesh, pair[1].source.specimen.mesh)
    });
    let [product, size] = same.fold([0.0; 2], |[product, size], (_, parts)| {
        let [ab, aa, bb] = residual_products(&parts[0].residuals, &parts[1].residuals);
        [product + ab, size + 0.5 * (aa + bb)]
    });
    (product / size.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
}

/// Σ a·b, Σ a·a and Σ b·b of the residuals of markers that two frames have in common.
pub fn residual_products(
    before: &BTreeMap<usize, [f64; 2]>,
    after: &BTreeMap<usize, [f64; 2]>,
) -> [f64; 3] {
    let pairs = after
        .iter()
        .filter_map(|(number, b)| Some((before.get(number)?, b)));
    pairs.fold([0.0; 3], |[ab, aa, bb], (a, b)| {
        let dot = |a: &[f64; 2], b: &[f64; 2]| a[0] * b[0] + a[1] * b[1];
        [ab + dot(a, b), aa + dot(a, a), bb + dot(b, b)]
    })
}
