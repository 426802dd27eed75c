//! One frame among all, at given parameters of the law.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::found::{JointFrame, Step};
use super::reduced::{Order, Ordered, Reduced};
use crate::error::{Diagnostic, Error};
use crate::estimation::equations::{Equations, Place};
use crate::estimation::free_edges;
use crate::estimation::given::{
    Edge, Knowledge, MeasuredForce, Observations, RegressedLaw, Segment, Specimen, Task, parts,
};
use crate::estimation::judge::{Model, Rows, soundness};
use crate::estimation::noise::with_own_noise;
use crate::estimation::regression::{MarkerRows, VarianceComponents};
use crate::estimation::search::{MOST_STEPS, NearestField, VARIANCE_STEPS};
use crate::estimation::uncertainty::MeshDifference;
use crate::statistics::{CorrelatedNoise, Sites};

/// The part of a frame that does not change with the law.
pub struct FrameSetup<'a> {
    frame: &'a JointFrame<'a>,
    outline: Vec<Segment>,
    observations: Observations,
}

/// A frame whose edges are settled.
pub struct Judged<'a> {
    ground: &'a FrameSetup<'a>,
    edges: Vec<Edge<'a>>,
    observations: Observations,
}

/// The state of a frame's search.
#[derive(Clone)]
pub struct State {
    place: Place,
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
    /// −2 ln L of its independent values.
    pub deviance: f64,
    /// The contribution of its mesh's own error to the score; `None` where that is not known.
    pub mesh: Option<Step>,
    /// The contributions to the score of one standard deviation of the common error of all forces, and of all pictures.
    pub common: [Step; 2],
    /// Σ (F − f)²/(σ² + s²) of its forces.
    pub force_misfit: f64,
    /// Number of parameters of its edges that the data determine.
    pub effective: f64,
    /// Number of independent values of its markers.
    pub independent: f64,
    /// The residuals of its markers by their numbers.
    left: HashMap<usize, [f64; 2]>,
}

/// A frame with the law of others.
pub struct CrossPrediction {
    /// The force of the field for each measured force, in N.
    pub forces: Vec<f64>,
    /// Root mean square of the components of the trusted markers' residuals in mm.
    pub left: f64,
}

/// Results of the equations linearised about a field, with the law's parameters after all others.
struct AboutField {
    normal: Ordered,
    /// The derivatives of the markers.
    design: DMatrix<f64>,
    /// The effect of the mesh's own error on the right-hand side.
    mesh: Option<DVector<f64>>,
    /// The effects on it of the common errors of forces, and of pictures.
    common: [DVector<f64>; 2],
}

impl<'a> FrameSetup<'a> {
    /// # Errors
    /// As [`crate::estimation::estimate`].
    pub fn new(frame: &'a JointFrame<'a>) -> Result<Self, Error> {
        let input = |fault: Diagnostic| Error::Input(vec![fault]);
        let knowledge = &frame.knowledge;
        knowledge.check().map_err(input)?;
        Ok(Self {
            outline: parts(frame.mesh, &knowledge.edges).map_err(input)?,
            observations: Observations::new(frame.mesh, frame.markers, knowledge.noise)
                .map_err(input)?,
            frame,
        })
    }

    /// The frame with the edges that the data have chosen where that is open, and with noise that they do not contradict.
    pub fn judged(&'a self, law: &RegressedLaw) -> Result<Judged<'a>, Error> {
        let specimen = self.specimen(law, &law.start());
        let knowledge = self.knowledge(None, false);
        let mut observations = self.observations.clone();
        let edges = self.outline.iter();
        let first: Vec<_> = edges
            .map(|segment| Edge::new(segment, &self.frame.knowledge))
            .collect();
        let search = |observations: &Observations| {
            let task = Task {
                specimen: &specimen,
                observations,
                knowledge: &knowledge,
            };
            let (found, edges) = free_edges::search(&task, first.clone())?;
            let other = found.other_noise(&found.markers(), &edges);
            let settled = edges
                .iter()
                .map(|edge| (edge.condition, edge.probability, edge.of_body));
            Ok((settled.collect::<Vec<_>>(), other))
        };
        let (settled, _) = with_own_noise(&mut observations, search)?;
        let edges = first.into_iter().zip(settled);
        Ok(Judged {
            ground: self,
            edges: edges
                .map(|(edge, (condition, probability, of_body))| Edge {
                    condition,
                    probability,
                    of_body,
                    tested: false,
                    ..edge
                })
                .collect(),
            observations,
        })
    }

    fn specimen(&self, law: &RegressedLaw, values: &[f64]) -> Specimen<'a> {
        Specimen {
            mesh: self.frame.mesh,
            law: law.at(values),
            thickness: self.frame.thickness,
        }
    }

    fn knowledge(&self, law: Option<RegressedLaw>, forces: bool) -> Knowledge {
        let mut knowledge = self.frame.knowledge.clone();
        knowledge.law = law;
        if !forces {
            knowledge.forces.clear();
        }
        knowledge
    }
}

impl Judged<'_> {
    /// The measured forces.
    pub fn measured(&self) -> &[MeasuredForce] {
        &self.ground.frame.knowledge.forces
    }

    /// Whether the noise is stated and not contradicted.
    pub fn knows_noise(&self) -> bool {
        self.observations.known_noise
    }

    /// The frame's field at values of the law's parameters, from a state or from the start; the variances are fixed where `settled`.
    ///
    /// # Errors
    /// As the search.
    pub fn at(
        &self,
        law: &RegressedLaw,
        values: &[f64],
        from: Option<&State>,
        settled: bool,
    ) -> Result<State, Error> {
        self.with_field(law, values, from, settled, |found| {
            let (place, variances) = (place(&found), found.variances.clone());
            let equations = self.law_equations(found, law, values, None)?.normal;
            let reduced = Reduced::new(&equations, values.len())?;
            Ok(State {
                information: reduced.information,
                score: reduced.score,
                misfit: reduced.misfit,
                place,
                variances,
            })
        })
    }

    /// The information of the frame at the end.
    ///
    /// # Errors
    /// As the search.
    pub fn say(
        &self,
        law: &RegressedLaw,
        values: &[f64],
        from: &State,
    ) -> Result<FrameInformation, Error> {
        self.with_field(law, values, Some(from), true, |found| {
            let left = self.left(&found);
            let observations = found.observations();
            let sound = soundness(&observations.weights, &found.fit, &found.variances);
            let rows = Rows::new(&found, &sound, None);
            let noise = rows
                .as_ref()
                .and_then(|rows| Model::of_search(rows, &found).noises(rows).first().copied());
            let markers = observations.chosen.len() as f64;
            let sites = Sites::new(observations.places.clone());
            let independent = 2.0
                * noise.map_or(markers, |noise: CorrelatedNoise| {
                    noise.correlation.independent(sites.places())
                });
            let variance: f64 = found.variances.variance;
            let markers_deviance = if observations.known_noise {
                found.misfit(&found) * independent / (2.0 * markers)
            } else {
                independent * variance.ln()
            };
            let (effective, variances) = (found.fit.effective, found.variances.clone());
            let difference = found.mesh_difference(&self.edges);
            let about = self.law_equations(found, law, values, difference.as_ref())?;
            let equations = about.normal;
            let reduced = Reduced::new(&equations, values.len())?;
            let forces = reduced.force_misfit;
            let rows = MarkerRows {
                design: &about.design,
                weights: &self.observations.weights,
                variances: &variances,
            };
            let white = rows.information();
            let of_markers = noise.map_or(white.clone(), |noise| rows.spread(&noise, &sites));
            let spread = &equations.matrix - white + &of_markers;
            Ok(FrameInformation {
                spread: reduced.project(&spread),
                spread_of_markers: reduced.project(&of_markers),
                mesh: about.mesh.map(|target| reduced.score_of(&target)),
                common: about.common.map(|target| reduced.score_of(&target)),
                force_misfit: forces,
                information: reduced.information,
                deviance: markers_deviance + forces,
                effective,
                independent,
                left,
            })
        })
    }

    /// The frame with the law of others: its measured forces beside those of its field, which does not include them.
    ///
    /// # Errors
    /// As the search.
    pub fn foreign(
        &self,
        law: &RegressedLaw,
        values: &[f64],
        from: Option<&State>,
    ) -> Result<CrossPrediction, Error> {
        self.with_field(law, values, from, false, |found| {
            let forces = found.forces(1.0, None, &[])?;
            let prediction = |measured: &MeasuredForce| {
                let own = forces.iter().filter(|force| force.edge == measured.edge);
                own.map(|force| force.force[measured.axis].value).sum()
            };
            let trusted = found.variances.trust.iter().sum::<f64>().max(1.0);
            let rows = found.fit.residual.as_slice().chunks_exact(2);
            let square: f64 = rows
                .zip(&found.variances.trust)
                .map(|(r, trust)| trust * (r[0] * r[0] + r[1] * r[1]))
                .sum();
            Ok(CrossPrediction {
                forces: self.measured().iter().map(prediction).collect(),
                left: (square / (2.0 * trusted)).sqrt(),
            })
        })
    }

    /// Calls a function with the nearest field at given values, which does not include the forces: their information on the law
    /// follows from the equations linearised about the field, so that a wrong force or thickness bends no edge.
    fn with_field<T>(
        &self,
        law: &RegressedLaw,
        values: &[f64],
        from: Option<&State>,
        settled: bool,
        work: impl FnOnce(NearestField) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let specimen = self.ground.specimen(law, values);
        let task = Task {
            specimen: &specimen,
            observations: &self.observations,
            knowledge: &self.ground.knowledge(None, false),
        };
        let search = Equations::new(&task, &self.edges)?;
        let found = match from {
            None => search.run(MOST_STEPS)?,
            Some(state) => {
                let adjusting = if settled { 0 } else { VARIANCE_STEPS };
                let variances = state.variances.clone();
                search.run_from(state.place.clone(), variances, adjusting, MOST_STEPS)?
            }
        };
        work(found)
    }

    /// The equations about a field with the law's parameters among the unknowns.
    fn law_equations(
        &self,
        found: NearestField,
        law: &RegressedLaw,
        values: &[f64],
        difference: Option<&MeshDifference>,
    ) -> Result<AboutField, Error> {
        let knowledge = self.ground.knowledge(Some(law.beginning_at(values)), true);
        let mut place = place(&found);
        let NearestField {
            mut equations,
            variances,
            ..
        } = found;
        equations.task.knowledge = &knowledge;
        let first = equations.motion.parameters();
        let of_law = values.iter().copied();
        place.parameters.splice(first..first, of_law);
        let linear = equations.linearise(&place)?;
        let normal = equations.with_regression(&place, true, &linear, |regression| {
            regression.equations(&variances)
        });
        let order = Order {
            first,
            law: values.len(),
            all: linear.design.ncols(),
        };
        let target = difference.map(|own| equations.mesh_target(own, &linear, &variances));
        let force_rows = knowledge.measured_forces().iter();
        let off = force_rows.map(|own| own.common_deviation * own.force / own.standard_deviation);
        let (of_forces, _) = &linear.force_rows;
        let off = of_forces.tr_mul(&DVector::from_vec(off.collect()));
        let magnified = equations.magnified(&place.field);
        let magnified = equations.target_of(&magnified, &linear, &variances);
        let common = [off, magnified * -knowledge.scale_deviation];
        Ok(AboutField {
            design: order.columns(&linear.design),
            normal: order.of(normal),
            mesh: target.map(|target| order.rows(&target)),
            common: common.map(|target| order.rows(&target)),
        })
    }

    /// The residuals of the trusted markers, by their numbers.
    fn left(&self, found: &NearestField) -> HashMap<usize, [f64; 2]> {
        const TRUSTED: f64 = 0.5;
        let rows = found.fit.residual.as_slice().chunks_exact(2);
        let all = self
            .observations
            .chosen
            .iter()
            .zip(rows)
            .zip(&found.variances.trust);
        let trusted = all.filter(|(_, trust)| **trust >= TRUSTED);
        trusted
            .map(|((index, r), _)| (self.ground.frame.markers[*index].number, [r[0], r[1]]))
            .collect()
    }
}

fn place(found: &NearestField) -> Place {
    Place {
        parameters: found.parameters.clone(),
        field: found.field.clone(),
    }
}

/// The mean correlation of what is left of the same markers in one frame and the next one of the same specimen; zero where there is
/// none, or frames differ in their markers.
pub fn common_noise(frames: &[&Judged], says: &[FrameInformation]) -> f64 {
    let pairs = frames.windows(2).zip(says.windows(2));
    let same = pairs.filter(|(frames, _)| {
        std::ptr::eq(frames[0].ground.frame.mesh, frames[1].ground.frame.mesh)
    });
    let [product, size] = same.fold([0.0; 2], |[product, size], (_, says)| {
        let left = says[0].left.iter();
        let found = left.filter_map(|(number, a)| Some((*a, *says[1].left.get(number)?)));
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        found.fold([product, size], |[product, size], (a, b)| {
            [product + dot(a, b), size + 0.5 * (dot(a, a) + dot(b, b))]
        })
    });
    (product / size.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
}
