//! Free edges where only the markers show the position of the specimen's edge, as considered parameters ([`super::considered`]).
//!
//! ```text
//! sₖ = ∂u/∂dₖ                                    dₖ the distance of an edge outside of the mesh's at one of its points, linear
//!                                                between them ([`super::moved_edges`])
//! Σₖₗ = E(dₖdₗ) = g²/4,  Σₖₖ = g²/3               each point lies 0 to the gap g farther out, with uniform probability
//! Σₖₗ = a²/6,            Σₖₖ = a²/3               edges are known to ± a: half of the variance is common to all points
//! ```
//!
//! Points are eight gaps apart or more: an edge that is inclined by as little as an eighth against that of the mesh changes the field
//! more than one farther out.

use nalgebra::DMatrix;

use crate::estimation::input::Edge;
use crate::estimation::search::NearestField;

/// The least distance of the points of an edge, in gaps.
const APART: f64 = 8.0;
/// The largest number of parts of an edge between its points.
const MOST_PARTS: f64 = 3.0;
/// The same of a traced edge, which wavers.
const MOST_TRACED_PARTS: f64 = 12.0;

impl NearestField<'_> {
    /// The forces of the strips along the free edges in N/mm, each with the index of its edge, and Σ in mm²; empty where the edges are known.
    pub(in crate::estimation) fn edge_strips(&self) -> (Vec<(usize, Vec<f64>)>, DMatrix<f64>) {
        let knowledge = self.equations.task.knowledge;
        let (gap, common, most) = match knowledge.edge_gap {
            Some(gap) => (gap, 1.0 / 4.0, MOST_PARTS),
            None => (knowledge.edge_accuracy, 1.0 / 6.0, MOST_TRACED_PARTS),
        };
        if gap == 0.0 {
            return (Vec::new(), DMatrix::zeros(0, 0));
        }
        let indexed = self.equations.edges.iter().enumerate();
        let free = indexed.filter(|(_, edge)| edge.has_strip());
        let strips = free.flat_map(|(index, edge)| {
            let strips = self.strips_between_points(edge, gap, most).into_iter();
            strips.map(move |strip| (index, strip))
        });
        let strips: Vec<_> = strips.collect();
        let square = |i, j| gap * gap * if i == j { 1.0 / 3.0 } else { common };
        let squares = DMatrix::from_fn(strips.len(), strips.len(), square);
        (strips, squares)
    }

    /// The forces in N/mm of the strip of each point of an edge: its width falls linearly from 1 at the point to 0 at its neighbours.
    fn strips_between_points(&self, edge: &Edge, gap: f64, most: f64) -> Vec<Vec<f64>> {
        let length = edge.segment.length();
        let parts = (length / (APART * gap)).floor().clamp(1.0, most);
        let at = |arc: f64| parts * arc / length;
        let points = 0..=parts as usize;
        let strip = |point: usize| {
            let width = |arc: f64| (1.0 - (at(arc) - point as f64).abs()).max(0.0);
            self.strip(&edge.segment, &width)
        };
        points.map(strip).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::estimation::tests::{SIZE, Truth, estimate_on, rectangle, with_grips};
    use crate::estimation::{Answer, EdgeCondition, FieldEstimate, Knowledge};
    use crate::markers::Marker;
    use crate::mesh::Mesh;

    const GAP: f64 = 2.0;

    /// A mesh whose free edges lie farther in than those of the plate.
    fn narrow([bottom, top]: [f64; 2]) -> Mesh {
        rectangle([0.0, bottom], [SIZE[0], SIZE[1] - top])
    }

    /// The estimate from markers at least the gap away from the free edges.
    fn estimated(truth: &Truth, mesh: &Mesh, gap: Option<f64>, seed: u64) -> FieldEstimate {
        let markers = truth.markers(0.3, seed).into_iter();
        let is_inner = |marker: &Marker| (GAP..SIZE[1] - GAP).contains(&marker.position[1]);
        let knowledge = Knowledge {
            edge_gap: gap,
            ..with_grips(EdgeCondition::Rigid)
        };
        let markers: Vec<Marker> = markers.filter(is_inner).collect();
        estimate_on(mesh, &markers, &knowledge)
    }

    /// The share of the stresses P₁₁ near the free edges that lie within ± 1.96 standard errors.
    fn held(truth: &Truth, mesh: &Mesh, result: &FieldEstimate) -> f64 {
        const BESIDE: f64 = 8.0;
        let (mut inside, mut all) = (0, 0);
        for (cell, stress) in result.cells.iter().enumerate() {
            let position = mesh.position(cell, mesh.shape(cell).centre());
            if (BESIDE..SIZE[1] - BESIDE).contains(&position[1]) {
                continue;
            }
            let off = stress.first_piola_kirchhoff_stress[0] - truth.stress(position)[0];
            inside += u32::from(off.abs() <= 1.96 * stress.stress_error[0]);
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
                    let estimated = estimated(&truth, &mesh, gap, seed);
                    assert_ne!(estimated.verdict.answer, Answer::NotExplained);
                    held(&truth, &mesh, &estimated)
                };
                (0..4).map(of_seed).sum::<f64>() / 4.0
            };
            let (known, unknown) = (share(None), share(Some(GAP)));
            assert!(unknown > 0.93, "{off:?}: {unknown}");
            // Otherwise the test would show nothing.
            assert!(off != [2.0, 2.0] || known < 0.8, "{off:?}: {known}");
        }
    }

    /// The field is that through the edges of the mesh, and so is the force.
    #[test]
    fn values_stay_and_only_errors_grow() {
        let (truth, mesh) = (Truth::new(), narrow([1.0, 1.0]));
        let [plain, considered] = [None, Some(GAP)].map(|gap| estimated(&truth, &mesh, gap, 1));
        assert_eq!(plain.displacement, considered.displacement);
        let errors = plain
            .displacement_error
            .iter()
            .zip(&considered.displacement_error);
        assert!(errors.into_iter().all(|(a, b)| *b >= *a * (1.0 - 1e-9)));
        for (a, b) in plain.cells.iter().zip(&considered.cells) {
            assert!((0..4).all(|i| b.stress_error[i] >= a.stress_error[i] * (1.0 - 1e-9)));
        }
        let mean = |result: &FieldEstimate| {
            let errors = result.cells.iter().map(|stress| stress.stress_error[0]);
            errors.sum::<f64>() / result.cells.len() as f64
        };
        let growth = mean(&considered) / mean(&plain);
        assert!((1.1..10.0).contains(&growth), "{growth}");
    }
}
