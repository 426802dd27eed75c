//! The small changes of the field where free edges of the specimen lie outside or inside of those of the mesh.
//!
//! ```text
//! ∂u/∂d = −K⁻¹ f,   fᵢ = h ∫ P t (t·∇Nᵢ) ds                    d the distance of the edge outside of the mesh's, t its tangent
//! ```
//!
//! The strip between both is so narrow that it only carries tension along the edge: h d P t is the force in it. One
//! linearised step about a field with wrong edges gives distances of a fiftieth of the width with an error below a third.
//!
//! A grip that lies farther out imposes its displacement there, so that the displacement of the mesh's edge differs by −∂u/∂n per mm. An outline
//! that was made from markers is wrong by the same distance on all sides.

use nalgebra::DMatrix;

use crate::error::Error;
use crate::estimation::equations::solve;
use crate::estimation::input::{Edge, EdgeCondition, Segment};
use crate::estimation::outcome::MovedPart;
use crate::estimation::search::NearestField;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::solve::Assembly;
use crate::solve::vector::{add_scaled, moved};

/// A part of the edge with the displacements of the markers per mm that it lies farther out: two rows per marker.
pub type MovedEdge = (MovedPart, DMatrix<f64>);

impl NearestField<'_> {
    /// Each free edge moved alone, all of them together where there are several, and the whole outline where edges have a stated motion.
    pub(in crate::estimation) fn moved_edges(&mut self) -> Result<Vec<MovedEdge>, Error> {
        let edges = self.equations.edges.iter();
        let free = edges.filter(|edge| edge.has_strip());
        let mut parts: Vec<MovedPart> = free
            .map(|edge| MovedPart::FreeEdge(edge.segment.name.clone()))
            .collect();
        let mut strips = self.strips();
        let mut all = vec![0.0; self.field.len()];
        for strip in &strips {
            add_scaled(&mut all, 1.0, strip);
        }
        if strips.len() > 1 {
            parts.push(MovedPart::FreeEdges);
            strips.push(all.clone());
        }
        let designs = self.marker_changes(&strips)?;
        let columns = (0..designs.ncols()).map(|column| designs.columns(column, 1).into_owned());
        let mut moved: Vec<MovedEdge> = parts.into_iter().zip(columns).collect();
        if self.equations.edges.iter().any(moves_as_stated) {
            moved.push((MovedPart::Outline, self.moved_outline(all)?));
        }
        Ok(moved)
    }

    /// The displacements of the markers per mm by which grips lie farther out, and free edges too, which the forces of their strips represent.
    fn moved_outline(&mut self, mut forces: Vec<f64>) -> Result<DMatrix<f64>, Error> {
        let mut motion = vec![0.0; self.field.len()];
        let edges = self.equations.edges.iter();
        for grip in edges.filter(|edge| moves_as_stated(edge)) {
            self.move_grip(grip, &mut motion);
        }
        let equations = &mut self.equations;
        let added = Assembly::add_product(&equations.energy, &self.field, &motion, &mut forces);
        added.map_err(|fault| equations.inverted(fault))?;
        let changes = equations.newton.tangent.changes(&[forces]);
        let change = changes.map_err(solve)?.remove(0);
        let total = moved(&change, 1.0, &motion);
        let markers = self.observations().interpolation.multiply(&total);
        Ok(DMatrix::from_vec(markers.len(), 1, markers))
    }

    /// Sets −∂u/∂n at the nodes of a grip, along the axes in which its motion is stated: the mean of the sides that meet at a node.
    fn move_grip(&self, grip: &Edge, motion: &mut [f64]) {
        let nodes = &grip.segment.nodes;
        let sides: Vec<[f64; 2]> = nodes.windows(2).map(|side| self.slope(side)).collect();
        for (index, node) in nodes.iter().enumerate() {
            let around = &sides[index.saturating_sub(1)..(index + 1).min(sides.len())];
            for axis in [0, 1] {
                if is_stated(grip.condition, axis) {
                    let sum: f64 = around.iter().map(|slope| slope[axis]).sum();
                    motion[2 * node + axis] = -sum / around.len() as f64;
                }
            }
        }
    }

    /// ∂u/∂n in the middle of a side of the boundary, n outwards.
    fn slope(&self, side: &[usize]) -> [f64; 2] {
        let mesh = self.equations.task.specimen.mesh;
        let [a, b] = [mesh.nodes[side[0]], mesh.nodes[side[1]]];
        let middle = [0, 1].map(|axis| 0.5 * (a[axis] + b[axis]));
        let (cell, local) = mesh.locate(middle);
        let centre = mesh.position(cell, mesh.shape(cell).centre());
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let across = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
        let inwards = [0, 1].map(|axis| across[axis] * (centre[axis] - middle[axis]));
        let outwards = -(inwards[0] + inwards[1]).signum();
        let gradient = mesh.gradient_at(&self.field, cell, local);
        [0, 1].map(|axis| {
            let [along_x, along_y] = [gradient[2 * axis], gradient[2 * axis + 1]];
            outwards * (along_x * across[0] + along_y * across[1])
        })
    }

    /// The forces in N/mm of a strip along each of the free edges.
    fn strips(&self) -> Vec<Vec<f64>> {
        let edges = self.equations.edges.iter();
        let free = edges.filter(|edge| edge.has_strip());
        free.map(|edge| self.strip(&edge.segment, &|_| 1.0))
            .collect()
    }

    /// The forces in N/mm on all unknowns of a strip along an edge, relative to its width, a function of the arc length in mm.
    pub(super) fn strip(&self, edge: &Segment, width: &dyn Fn(f64) -> f64) -> Vec<f64> {
        /// Half the distance of both points of Gauss's rule from the middle, over the length.
        const HALF: f64 = 0.288_675_134_594_812_9;
        let specimen = &self.equations.task.specimen;
        let mesh = specimen.mesh;
        let mut forces = vec![0.0; self.field.len()];
        for (pair, start) in edge.nodes.windows(2).zip(&edge.positions) {
            let [a, b] = [mesh.nodes[pair[0]], mesh.nodes[pair[1]]];
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = along[0].hypot(along[1]);
            let tangent = along.map(|component| component / length);
            for share in [0.5 - HALF, 0.5 + HALF] {
                let position = [0, 1].map(|axis| a[axis] + share * along[axis]);
                let (cell, local) = mesh.locate(position);
                let gradient = PlaneTensor::from(mesh.gradient_at(&self.field, cell, local));
                let Ok(kinematics) = Kinematics::new(&gradient) else {
                    continue;
                };
                let stress = self.equations.law(cell).stress(&kinematics).1;
                let tension = [0, 1]
                    .map(|axis| stress[2 * axis] * tangent[0] + stress[2 * axis + 1] * tangent[1]);
                let width = width(start + share * length);
                let weight = 0.5 * length * width * specimen.thickness;
                let (slopes, _) = mesh.gradients(cell, local);
                for (node, slope) in mesh.cell(cell).iter().zip(slopes) {
                    let slope = slope[0] * tangent[0] + slope[1] * tangent[1];
                    for axis in [0, 1] {
                        forces[2 * node + axis] += weight * tension[axis] * slope;
                    }
                }
            }
        }
        forces
    }
}

/// Whether an edge of the boundary has a stated motion along an axis.
fn moves_as_stated(edge: &Edge) -> bool {
    !edge.segment.inside && [0, 1].iter().any(|axis| is_stated(edge.condition, *axis))
}

fn is_stated(condition: EdgeCondition, axis: usize) -> bool {
    match condition {
        EdgeCondition::Rigid => true,
        EdgeCondition::Known(values) => values[axis].is_some(),
        EdgeCondition::Free | EdgeCondition::Unknown => false,
    }
}

#[cfg(test)]
mod tests {
    use crate::estimation::tests::{SIZE, Truth, estimate_on, rectangle, with_grips};
    use crate::estimation::{Alternative, Answer, EdgeCondition, MovedPart};
    use crate::markers::Marker;

    /// The verdict, and the estimated distances of the plate's edges from those of a mesh that lie farther in.
    fn estimated(
        truth: &Truth,
        [bottom, top]: [f64; 2],
        noise: f64,
    ) -> (Answer, Vec<(MovedPart, f64)>) {
        let [length, width] = SIZE;
        let mesh = rectangle([0.0, bottom], [length, width - top]);
        let markers = truth.markers(noise, 5).into_iter();
        let is_inner =
            |marker: &Marker| marker.position[1] > 2.0 && marker.position[1] < width - 2.0;
        let markers: Vec<Marker> = markers.filter(is_inner).collect();
        let knowledge = with_grips(EdgeCondition::Unknown);
        let estimated = estimate_on(&mesh, &markers, &knowledge);
        let moved =
            estimated
                .verdict
                .trials
                .into_iter()
                .filter_map(|trial| match trial.alternative {
                    Alternative::MovedEdge { part, outwards } => Some((part, outwards)),
                    _ => None,
                });
        (estimated.verdict.answer, moved.collect())
    }

    #[test]
    fn the_verdict_gives_the_distances_of_free_edges_from_those_of_the_mesh() {
        let truth = Truth::new();
        // One linearised step about a field with wrong edges has an error below a third.
        let near = |distance: f64, off: f64| (distance / off - 1.0).abs() < 0.35;
        for off in [0.6, -0.6] {
            let (answer, moved) = estimated(&truth, [off; 2], 0.004);
            assert_eq!(answer, Answer::NotExplained);
            assert!(
                moved[0].0 == MovedPart::FreeEdges && near(moved[0].1, off),
                "{moved:?}"
            );
            let (answer, moved) = estimated(&truth, [off, 0.0], 0.004);
            assert_eq!(answer, Answer::NotExplained);
            let bottom = MovedPart::FreeEdge("bottom".to_owned());
            assert!(moved[0].0 == bottom && near(moved[0].1, off), "{moved:?}");
        }
        let (answer, moved) = estimated(&truth, [0.0; 2], 0.004);
        assert!(
            answer != Answer::NotExplained && moved.is_empty(),
            "{moved:?}"
        );
    }

    /// A mesh that is larger or smaller than the plate on all sides, grips too.
    #[test]
    fn the_verdict_begins_with_the_whole_outline_where_it_is_wrong_on_all_sides() {
        let truth = Truth::new();
        let [length, width] = SIZE;
        for off in [1.0, -1.0] {
            let mesh = rectangle([off; 2], [length - off, width - off]);
            let is_inner = |marker: &Marker| {
                let inside = |axis: usize| (1.0..SIZE[axis] - 1.0).contains(&marker.position[axis]);
                inside(0) && inside(1)
            };
            let markers = truth.markers(0.01, 5).into_iter();
            let markers: Vec<Marker> = markers.filter(is_inner).collect();
            let knowledge = with_grips(EdgeCondition::Rigid);
            let verdict = estimate_on(&mesh, &markers, &knowledge).verdict;
            assert_eq!(verdict.answer, Answer::NotExplained);
            let first = &verdict.trials[0].alternative;
            let Alternative::MovedEdge { part, outwards } = first else {
                panic!("{off}: {:#?}", verdict.trials);
            };
            let near = (outwards / off - 1.0).abs() < 0.35;
            assert!(*part == MovedPart::Outline && near, "{off}: {first:?}");
        }
    }
}
