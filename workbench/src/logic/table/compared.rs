//! The quantities by which models are compared, and which colour them.

use gelbench::mesh::Mesh;

use super::Table;
use crate::logic::deviations::Deviation;
use crate::logic::scene::{Colour, Model, Scene};

/// The area in mm² that belongs to each node, that of a cell equally to all of its nodes; sides are taken for straight.
pub(super) fn node_areas(mesh: &Mesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.nodes.len()];
    for cell in 0..mesh.cell_count() {
        let nodes = mesh.cell(cell);
        let corners = mesh.corners(cell);
        let next = corners.iter().cycle().skip(1);
        let doubled = corners.iter().zip(next).map(|(one, other)| {
            let ([x, y], [u, v]) = (mesh.nodes[*one], mesh.nodes[*other]);
            x * v - u * y
        });
        let area = 0.5 * doubled.sum::<f64>().abs();
        for node in nodes {
            areas[*node] += area / nodes.len() as f64;
        }
    }
    areas
}

impl Table {
    /// Compares the models that have the grip where the finite elements have it.
    pub(super) fn compare(&mut self) {
        let Some(elements) = self.shown(Model::Elements) else {
            return;
        };
        let Ok([lattice, _]) = &self.meshes else {
            return;
        };
        let scene = Scene {
            grip: elements.grip,
            ..self.scene().clone()
        };
        let of = |model: Model| {
            let shown = self
                .shown(model)
                .filter(|shown| shown.grip == elements.grip)?;
            Deviation::of(&scene, lattice, &shown.solved, &elements.solved)
        };
        self.deviations = [Model::Springs, Model::Corrected].map(of);
    }

    /// What colours the nodes of a model, and whether it belongs to the place that the model is shown at.
    pub fn values(&self, model: Model) -> Option<Vec<f64>> {
        let shown = self.shown(model)?;
        let solved = &shown.solved;
        if self.scene().look.colour != Colour::Distance {
            let fits = solved.values.len() * 2 == solved.displacement.len();
            return fits.then(|| solved.values.clone());
        }
        if model == Model::Elements {
            return Some(vec![0.0; solved.displacement.len() / 2]);
        }
        let elements = self
            .shown(Model::Elements)
            .filter(|other| other.grip == shown.grip)?;
        let expected = elements.solved.on_lattice.as_ref()?;
        let pairs = solved
            .displacement
            .chunks_exact(2)
            .zip(expected.chunks_exact(2));
        Some(
            pairs
                .map(|(u, v)| (u[0] - v[0]).hypot(u[1] - v[1]))
                .collect(),
        )
    }
}
