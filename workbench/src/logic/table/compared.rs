//! The quantities by which models are compared, and which colour them.

use super::Table;
use crate::logic::deviations::Deviation;
use crate::logic::scene::{Colour, Model, Scene};

impl Table {
    /// Compares the models that have the grip where the finite elements have it.
    pub(super) fn compare(&mut self) {
        let (Some(elements), Ok([lattice, _])) = (self.shown(Model::Elements), &self.meshes) else {
            return;
        };
        let Some(grip) = elements.grip else {
            return;
        };
        let scene = Scene {
            grip,
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

    /// What colours the nodes of a model; nothing where it is not known there.
    pub fn values(&self, model: Model) -> Option<Vec<f64>> {
        let shown = self.shown(model)?;
        let solved = &shown.solved;
        let colour = self.scene().look.colour;
        if colour != Colour::Distance {
            return (solved.colour == colour).then(|| solved.values.clone());
        }
        if model == Model::Elements {
            return Some(vec![0.0; solved.displacement.len() / 2]);
        }
        let elements = self
            .shown(Model::Elements)
            .filter(|other| other.grip.is_some() && other.grip == shown.grip)?;
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
