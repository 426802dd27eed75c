//! The quantities by which models are compared, and which colour them.

use super::Table;
use crate::logic::deviations::Deviation;
use crate::logic::scene::{Colour, Model, Scene};

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
