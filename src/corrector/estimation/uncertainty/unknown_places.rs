//! The errors of a field where only the markers show the position of its free edges.
//!
//! ```text
//! sₖ = ∂u/∂dₖ                                    d the distance of edge k outside of the mesh's ([`super::moved_edges`])
//! M Dₖ = −AᵀWHsₖ/v − Gᵀ∂F/∂dₖ/σ                  what the regression makes of it, as it knows of no distance
//! Σₖₗ = E(dₖdₗ) = g²/4,  Σₖₖ = g²/3               each edge lies as probably anywhere from nothing to the gap g farther out
//!
//! Cov(p, d) = [C + DΣDᵀ, DΣ; ΣDᵀ, Σ],   ∂u/∂(p, d) = [S, s]
//! ```
//!
//! with A, W, v, G, M of [`crate::corrector::estimation::regression`]. The field remains the one through the edges of the mesh: the distances are
//! considered parameters that are not estimated (Schmidt), so that data with little information on them do not move the field.
//!
//! # References
//! S. F. Schmidt, Adv. Control Syst. 3, 293 (1966), doi:10.1016/B978-1-4831-6716-9.50011-4

use nalgebra::{DMatrix, DVector};

use crate::corrector::estimation::equations::solve;
use crate::corrector::estimation::given::Edge;
use crate::corrector::estimation::search::NearestField;
use crate::error::Error;
use crate::problem::corner_forces::Share;
use crate::solve::vector::dot;

/// Distances of free edges that are considered.
pub struct UnknownPlaces {
    /// sₖ.
    changes: Vec<Vec<f64>>,
    /// D.
    answers: DMatrix<f64>,
    /// Σ in mm².
    squares: DMatrix<f64>,
}

impl NearestField<'_> {
    /// The free edges at unknown positions; must be called before the covariance includes the noise found, because it has to be M⁻¹.
    pub(in crate::corrector::estimation) fn unknown_places(
        &mut self,
        edges: &[Edge],
    ) -> Result<Option<UnknownPlaces>, Error> {
        let Some(gap) = self.equations.task.knowledge.edge_gap else {
            return Ok(None);
        };
        let strips = self.strips(edges);
        let tangent = &mut self.equations.newton.tangent;
        let changes = tangent.changes(&strips).map_err(solve)?;
        let mut answers = DMatrix::zeros(self.fit.covariance.nrows(), changes.len());
        for (index, (change, strip)) in changes.iter().zip(&strips).enumerate() {
            let target = self.target(change, strip)?;
            answers.set_column(index, &(&self.fit.covariance * target));
        }
        let square = |i, j| gap * gap / if i == j { 3.0 } else { 4.0 };
        Ok(Some(UnknownPlaces {
            squares: DMatrix::from_fn(changes.len(), changes.len(), square),
            changes,
            answers,
        }))
    }

    /// −AᵀWHs/v − Gᵀ∂F/∂d/σ of one strip.
    fn target(&self, change: &[f64], strip: &[f64]) -> Result<DVector<f64>, Error> {
        let observations = self.observations();
        let at_markers = observations.interpolation.multiply(change);
        let mut target = self
            .equations
            .target_of(&at_markers, &self.linear, &self.variances);
        for (row, measured) in self
            .equations
            .task
            .knowledge
            .measured_forces()
            .iter()
            .enumerate()
        {
            let own = self
                .equations
                .bodies
                .iter()
                .filter(|body| body.name == measured.edge);
            let shares: Vec<Share> = own
                .flat_map(|body| &body.shares[measured.axis])
                .copied()
                .collect();
            let grip = self.equations.grip(&shares, measured.axis, &self.field)?;
            let off = dot(&grip.pull, change) + dot(&grip.marks, strip);
            let slopes = self.linear.force_rows.0.row(row).transpose();
            target -= slopes * (off / measured.standard_deviation);
        }
        Ok(target)
    }

    /// Appends the distances to the parameters of the field.
    pub(in crate::corrector::estimation) fn consider(&mut self, places: UnknownPlaces) {
        let UnknownPlaces {
            changes,
            answers,
            squares,
        } = places;
        let (own, more) = (answers.nrows(), answers.ncols());
        let across = &answers * &squares;
        let mut whole = DMatrix::zeros(own + more, own + more);
        whole
            .view_mut((0, 0), (own, own))
            .copy_from(&(&self.fit.covariance + &across * answers.transpose()));
        whole.view_mut((0, own), (own, more)).copy_from(&across);
        whole
            .view_mut((own, 0), (more, own))
            .copy_from(&across.transpose());
        whole.view_mut((own, own), (more, more)).copy_from(&squares);
        self.fit.covariance = whole;
        self.linear.sensitivities.extend(changes);
    }
}

#[cfg(test)]
mod tests {
    use crate::corrector::estimation::tests::{SIZE, Truth, law, specimen, with_grips};
    use crate::corrector::estimation::{Answer, EdgeCondition, FieldEstimate, Knowledge, estimate};
    use crate::markers::Marker;
    use crate::material::sheet::{Kinematics, PlaneTensor};
    use crate::mesh::{CellShape, Mesh, Outline};

    const GAP: f64 = 2.0;

    /// A mesh whose free edges lie farther in than those of the plate.
    fn narrow([bottom, top]: [f64; 2]) -> Mesh {
        let [length, width] = SIZE;
        let (low, high) = (bottom, width - top);
        let line = vec![[0.0, low], [length, low], [length, high], [0.0, high]];
        let outline = Outline::of_lines(vec![line]).unwrap();
        outline.mesh(2.0, CellShape::Triangle6)
    }

    /// The estimate by markers amid the plate.
    fn found(truth: &Truth, mesh: &Mesh, gap: Option<f64>, seed: u64) -> FieldEstimate {
        let markers = truth.markers(0.3, seed).into_iter();
        let amid = |marker: &Marker| (GAP..SIZE[1] - GAP).contains(&marker.place[1]);
        let knowledge = Knowledge {
            edge_gap: gap,
            ..with_grips(EdgeCondition::Rigid)
        };
        let markers: Vec<Marker> = markers.filter(amid).collect();
        estimate(&specimen(mesh), &markers, &knowledge).unwrap()
    }

    /// The share of the stresses P₁₁ beside the free edges that ± 1.96 standard errors hold.
    fn held(truth: &Truth, mesh: &Mesh, found: &FieldEstimate) -> f64 {
        const BESIDE: f64 = 8.0;
        let (mut inside, mut all) = (0, 0);
        for (cell, own) in found.cells.iter().enumerate() {
            let place = mesh.place(cell, mesh.shape(cell).centre());
            if (BESIDE..SIZE[1] - BESIDE).contains(&place[1]) {
                continue;
            }
            let (there, local) = truth.mesh.locate(place);
            let gradient = truth.mesh.gradient_at(truth.field(), there, local);
            let kinematics = Kinematics::new(&PlaneTensor::from(gradient)).unwrap();
            let off = own.first_piola_kirchhoff_stress[0] - law().stress(&kinematics).1[0];
            inside += u32::from(off.abs() <= 1.96 * own.stress_error[0]);
            all += 1;
        }
        f64::from(inside) / f64::from(all)
    }

    #[test]
    fn errors_of_stress_hold_edges_that_lie_anywhere_up_to_the_gap() {
        let truth = Truth::new();
        for off in [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [2.0, 0.0]] {
            let mesh = narrow(off);
            let share = |gap: Option<f64>| {
                let of_seed = |seed| {
                    let found = found(&truth, &mesh, gap, seed);
                    assert_ne!(found.verdict.answer, Answer::NotExplained);
                    held(&truth, &mesh, &found)
                };
                (0..4).map(of_seed).sum::<f64>() / 4.0
            };
            let (known, unknown) = (share(None), share(Some(GAP)));
            assert!(unknown > 0.93, "{off:?}: {unknown}");
            // Else there is nothing to hold.
            assert!(off != [2.0, 2.0] || known < 0.8, "{off:?}: {known}");
        }
    }

    /// The field is that through the edges of the mesh, and so is the force.
    #[test]
    fn values_stay_and_only_errors_grow() {
        let (truth, mesh) = (Truth::new(), narrow([1.0, 1.0]));
        let [plain, considered] = [None, Some(GAP)].map(|gap| found(&truth, &mesh, gap, 1));
        assert_eq!(plain.displacement, considered.displacement);
        let errors = plain
            .displacement_error
            .iter()
            .zip(&considered.displacement_error);
        assert!(errors.into_iter().all(|(a, b)| *b >= *a * (1.0 - 1e-9)));
        for (a, b) in plain.cells.iter().zip(&considered.cells) {
            assert!((0..4).all(|i| b.stress_error[i] >= a.stress_error[i] * (1.0 - 1e-9)));
        }
        let mean = |found: &FieldEstimate| {
            let errors = found.cells.iter().map(|own| own.stress_error[0]);
            errors.sum::<f64>() / found.cells.len() as f64
        };
        let growth = mean(&considered) / mean(&plain);
        assert!((1.1..10.0).contains(&growth), "{growth}");
    }
}
