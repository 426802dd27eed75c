//! The small changes of the field due to free edges that lie elsewhere than those of the mesh.
//!
//! ```text
//! ∂u/∂d = −K⁻¹ f,   fᵢ = h ∫ P t (t·∇Nᵢ) ds                    d the distance of the edge outside of the mesh's, t its tangent
//! ```
//!
//! The strip between both is so narrow that it only carries tension along the edge: h d P t is the force in it. One
//! step about a field that was found with wrong edges determines distances of a fiftieth of the width to a third.

use nalgebra::DMatrix;

use crate::error::Error;
use crate::estimation::input::Edge;
use crate::estimation::search::NearestField;
use crate::material::sheet::{Kinematics, PlaneTensor};

/// A free edge, or all of them, with the displacements of the markers per mm that it lies farther out: two rows per marker.
pub type MovedEdge = (Option<String>, DMatrix<f64>);

impl NearestField<'_> {
    /// Each of the free edges moved alone, and all of them together where there are several.
    pub(in crate::estimation) fn moved_edges(
        &mut self,
        edges: &[Edge],
    ) -> Result<Vec<MovedEdge>, Error> {
        let free = edges.iter().filter(|edge| edge.has_strip());
        let mut names: Vec<_> = free.map(|edge| Some(edge.segment.name.clone())).collect();
        let mut strips = self.strips(edges);
        if strips.len() > 1 {
            let mut all = vec![0.0; self.field.len()];
            for strip in &strips {
                all.iter_mut().zip(strip).for_each(|(sum, own)| *sum += own);
            }
            names.push(None);
            strips.push(all);
        }
        let designs = self.marker_changes(&strips)?;
        let columns = (0..designs.ncols()).map(|column| designs.columns(column, 1).into_owned());
        Ok(names.into_iter().zip(columns).collect())
    }

    /// The forces in N/mm of a strip along each of the free edges.
    pub(in crate::estimation) fn strips(&self, edges: &[Edge]) -> Vec<Vec<f64>> {
        let free = edges.iter().filter(|edge| edge.has_strip());
        free.map(|edge| self.strip(&edge.segment.nodes)).collect()
    }

    /// The forces in N/mm on all unknowns of a strip along an edge.
    fn strip(&self, nodes: &[usize]) -> Vec<f64> {
        /// Half the distance of both points of Gauss's rule from the middle, over the length.
        const HALF: f64 = 0.288_675_134_594_812_9;
        let specimen = &self.equations.task.specimen;
        let mesh = specimen.mesh;
        let mut forces = vec![0.0; self.field.len()];
        for pair in nodes.windows(2) {
            let [a, b] = [mesh.nodes[pair[0]], mesh.nodes[pair[1]]];
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = along[0].hypot(along[1]);
            let tangent = along.map(|component| component / length);
            for share in [0.5 - HALF, 0.5 + HALF] {
                let place = [0, 1].map(|axis| a[axis] + share * along[axis]);
                let (cell, local) = mesh.locate(place);
                let gradient = PlaneTensor::from(mesh.gradient_at(&self.field, cell, local));
                let Ok(kinematics) = Kinematics::new(&gradient) else {
                    continue;
                };
                let stress = self.equations.law(cell).stress(&kinematics).1;
                let tension = [0, 1]
                    .map(|axis| stress[2 * axis] * tangent[0] + stress[2 * axis + 1] * tangent[1]);
                let weight = 0.5 * length * specimen.thickness;
                let (slopes, _) = mesh.gradients(cell, local);
                for (node, slope) in mesh.cell(cell).iter().zip(slopes) {
                    let share = slope[0] * tangent[0] + slope[1] * tangent[1];
                    for axis in [0, 1] {
                        forces[2 * node + axis] += weight * tension[axis] * share;
                    }
                }
            }
        }
        forces
    }
}

#[cfg(test)]
mod tests {
    use crate::estimation::tests::{SIZE, Truth, specimen, with_grips};
    use crate::estimation::{Alternative, Answer, EdgeCondition, estimate};
    use crate::markers::Marker;
    use crate::mesh::{CellShape, Outline};

    /// How far the edges of a plate are found from those of a mesh that lie so much farther in.
    fn found(truth: &Truth, [bottom, top]: [f64; 2], noise: f64) -> (Answer, Vec<(String, f64)>) {
        let [length, width] = SIZE;
        let (low, high) = (bottom, width - top);
        let line = vec![[0.0, low], [length, low], [length, high], [0.0, high]];
        let mesh = Outline::of_lines(vec![line])
            .unwrap()
            .mesh(2.0, CellShape::Triangle6);
        let markers = truth.markers(noise, 5).into_iter();
        let amid = |marker: &Marker| marker.place[1] > 2.0 && marker.place[1] < width - 2.0;
        let markers: Vec<Marker> = markers.filter(amid).collect();
        let knowledge = with_grips(EdgeCondition::Unknown);
        let found = estimate(&specimen(&mesh), &markers, &knowledge).unwrap();
        let moved = found
            .verdict
            .trials
            .into_iter()
            .filter_map(|trial| match trial.alternative {
                Alternative::MovedEdge { edge, outwards } => {
                    Some((edge.unwrap_or_else(|| "all".to_owned()), outwards))
                }
                _ => None,
            });
        (found.verdict.answer, moved.collect())
    }

    #[test]
    fn the_verdict_tells_how_far_free_edges_lie_from_those_of_the_mesh() {
        let truth = Truth::new();
        // One linearised step about a field with wrong edges tells it to a third.
        let near = |found: f64, off: f64| (found / off - 1.0).abs() < 0.35;
        for off in [0.6, -0.6] {
            let (answer, moved) = found(&truth, [off; 2], 0.004);
            assert_eq!(answer, Answer::NotExplained);
            assert!(moved[0].0 == "all" && near(moved[0].1, off), "{moved:?}");
            let (answer, moved) = found(&truth, [off, 0.0], 0.004);
            assert_eq!(answer, Answer::NotExplained);
            assert!(moved[0].0 == "bottom" && near(moved[0].1, off), "{moved:?}");
        }
        let (answer, moved) = found(&truth, [0.0; 2], 0.004);
        assert!(
            answer != Answer::NotExplained && moved.is_empty(),
            "{moved:?}"
        );
    }
}
