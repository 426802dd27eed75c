//! The states of one model along a path: equilibria at load factors, or the instants of a motion. Pictures, grids, headlines and findings of
//! all studies of one sheet are made from them.

use super::ModelKind;
use super::specimen::problem::{Outline, Specimen};
use crate::mesh::{Mesh, Shape};
use crate::problem::{GroupState, Solution};
use crate::results::{
    Array, Block, Deformed, Figure, Gauge, Grid, Headline, LoadedSheet, Panel, Sheet, Stroke,
    ViscousStress, sheet_figures,
};
use crate::solve::State;

/// The models in the order in which their lines are drawn, and how: the corrected field last, as rings around the others' markers.
pub const DRAWN: [(ModelKind, Stroke); 3] = [
    (ModelKind::FiniteElement, Stroke::Marked),
    (ModelKind::MassSpring, Stroke::Marked),
    (ModelKind::Corrected, Stroke::Ringed),
];

/// The axis along which some vectors have the largest component; x where they are none.
pub fn larger_axis(vectors: impl Iterator<Item = [f64; 2]>) -> usize {
    let [x, y] = vectors.fold([0.0_f64; 2], |most, vector| {
        [0, 1].map(|axis| most[axis].max(vector[axis].abs()))
    });
    usize::from(y > x)
}

/// The states of one model.
pub struct ModelSeries<'a> {
    pub kind: ModelKind,
    pub mesh: &'a Mesh,
    /// Its states, up to the last one that it reached.
    pub states: Vec<ModelState<'a>>,
}

/// One state of a model.
#[derive(Default)]
pub struct ModelState<'a> {
    /// The load factor or the stretch, or the time in s.
    pub at: f64,
    /// ux, uy of node after node in mm.
    pub displacement: &'a [f64],
    /// In mm/s; `None` at rest.
    pub velocity: Option<&'a [f64]>,
    /// The displacement fields before, where the material remembers them.
    pub past: Vec<&'a [f64]>,
    /// The viscous part of the stresses, in a motion.
    pub viscous: Option<&'a ViscousStress>,
    /// The states of the groups.
    pub groups: &'a [GroupState],
    /// The finite elements' displacement at the nodes of the model; `None` where they have none, and of themselves.
    pub expected: Option<&'a [f64]>,
}

impl<'a> ModelSeries<'a> {
    /// The equilibria of a path, with the finite elements' displacements at its nodes as far as these go.
    pub fn of(kind: ModelKind, solution: &'a Solution, expected: &'a [Vec<f64>]) -> Self {
        let state = |(step, state): (usize, &'a State)| ModelState {
            at: state.factor,
            displacement: &state.displacement,
            past: solution.past(step),
            groups: solution.groups(step).unwrap_or_default(),
            expected: expected.get(step).map(Vec::as_slice),
            ..ModelState::default()
        };
        Self {
            kind,
            mesh: &solution.mesh,
            states: solution.states.iter().enumerate().map(state).collect(),
        }
    }

    /// Its fields at a step, which determine the stresses.
    pub fn deformed(&self, step: usize) -> Option<Deformed<'a>> {
        let state = self.states.get(step)?;
        let before = state.past.iter().copied();
        let fields = before.chain([state.displacement]).collect();
        Some(Deformed {
            viscous: state.viscous.map_or(&[], |stress| &stress.at_nodes),
            ..Deformed::elastic(self.kind.style().name, self.mesh, fields)
        })
    }

    /// A quantity of the displacement at a step; `None` where it has not reached it.
    pub fn panel(&self, step: usize, value: impl Fn([f64; 2]) -> f64) -> Option<Panel> {
        let u = self.states.get(step)?.displacement;
        let at_node = |node: usize| value([u[2 * node], u[2 * node + 1]]);
        let name = self.kind.style().name;
        Some(Panel::at_nodes(name, self.mesh, u, &at_node))
    }

    /// Its fields at a step, with velocities and the difference to the finite elements where it has them.
    pub fn grid(&self, sheet: Sheet, step: usize) -> Grid {
        let state = &self.states[step];
        let velocity = state
            .velocity
            .map(|velocity| Array::vectors("velocity_mm_per_s", velocity.iter().copied()));
        let difference = state.expected;
        let difference = difference.map(|v| Array::to_finite_elements(state.displacement, v));
        Grid::sheet(state.strained(sheet), self.mesh, state.displacement)
            .with(velocity)
            .with(difference)
    }

    /// The beginning of a report: the states of some groups at some steps, each with its description, and the largest values at one step;
    /// `model` and `along` are the names of the model and of the parameter along its steps.
    pub fn headline(
        &self,
        specimen: &Specimen,
        (model, along, groups): (&str, &'static str, Vec<&str>),
        steps: impl IntoIterator<Item = (usize, String)>,
        (largest, at): (usize, String),
    ) -> Vec<Block> {
        let Some(deformed) = self.deformed(largest) else {
            return Vec::new();
        };
        let steps = steps.into_iter();
        let headline = Headline {
            model,
            along,
            groups,
            steps: steps
                .map(|(step, words)| (words, self.states[step].groups.to_vec()))
                .collect(),
            state: LoadedSheet {
                at,
                laws: specimen.problem.laws(),
                deformed,
                // Supports were checked when the study was read.
                singular: specimen
                    .problem
                    .singular_points(self.mesh)
                    .unwrap_or_default(),
                gauge: gauge(&specimen.outline, self.mesh),
            },
        };
        headline.blocks()
    }
}

impl ModelState<'_> {
    /// A sheet with the history and the viscous stresses of this state.
    pub fn strained<'b>(&'b self, sheet: Sheet<'b>) -> Sheet<'b> {
        Sheet {
            past: &self.past,
            viscous: self.viscous,
            ..sheet
        }
    }
}

/// The stresses and strains of all models at a step, which `at` describes; `file` makes the name of a file from that of a field.
pub fn stress_figures(
    specimen: &Specimen,
    series: &[ModelSeries],
    step: usize,
    at: &str,
    file: &dyn Fn(&str) -> String,
) -> Vec<Figure> {
    let pictures = &specimen.pictures;
    let shown = series
        .iter()
        .filter(|model| pictures.models.contains(&model.kind));
    let deformed: Vec<_> = shown.filter_map(|model| model.deformed(step)).collect();
    sheet_figures(
        &pictures.fields,
        specimen.problem.laws(),
        &deformed,
        at,
        file,
    )
}

/// The gauge section of a strip or a dog-bone.
fn gauge(outline: &Outline, mesh: &Mesh) -> Option<Gauge> {
    let shape = match outline {
        Outline::Shape { shape, .. } => *shape,
        Outline::Grid(grids) => Shape::Strip { size: grids.size },
        Outline::File { .. } => return None,
    };
    let (length, description) = match shape {
        Shape::Strip { size } => (size[0], "the middle half of the length"),
        Shape::DogBone { narrow, .. } => (narrow[0], "the middle half of the narrow part"),
        _ => return None,
    };
    Some(Gauge::middle_half(mesh, length, description))
}
