//! Everything that a run has computed.

use crate::compare::StepComparison;
use crate::corrector::plate::CorrectedState;
use crate::error::Error;
use crate::finite_element::FiniteElements;
use crate::finite_element::error_estimate::ErrorEstimate;
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::problem::{Measures, Solution, Work};
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::solve::State;
use crate::statistics::larger;

mod requirement;
pub mod run;

/// The names of the models, in the order of [`Results::models`].
pub const MODELS: [&str; 3] = [MASS_SPRING.name, CORRECTED.name, FINITE_ELEMENTS.name];

/// One finite-element mesh and its solutions.
#[derive(Debug)]
pub struct ReferenceMesh {
    /// The model.
    pub model: FiniteElements,
    /// One state per stretch that was reached.
    pub solution: Solution,
}

/// All fields and figures of a study. A model that has ended early has fewer states than the study has stretches; the
/// others go on without it.
#[derive(Debug)]
pub struct Results {
    /// The lattice.
    pub springs: MassSpring,
    /// The cells of the corrected fields: those of the lattice, or as many that become smaller towards the corners.
    pub corrected_mesh: Mesh,
    /// The lattice in equilibrium, one state per stretch that was reached.
    pub uncorrected: Solution,
    /// The corrected field at every stretch; `None` where none was found.
    pub corrected: Vec<Option<CorrectedState>>,
    /// The finite elements on three meshes, coarse to fine; the last is the reference.
    pub reference: [ReferenceMesh; 3],
    /// The estimated errors of the finest of them; `None` where its tangent cannot be factorised.
    pub estimates: Vec<Option<ErrorEstimate>>,
    /// The reference field in mm at the nodes of the lattice, and at those of the corrected fields, as far as the path goes.
    pub reference_on: [Vec<Vec<f64>>; 2],
    /// Deviations from the reference, one entry per stretch.
    pub comparison: Vec<StepComparison>,
    /// Why models have no solution at stretches of the study, in the order in which they were solved.
    pub ends: Vec<Error>,
    /// Whether the material softens by its largest load.
    pub remembers: bool,
    /// Wall-clock times: names and seconds.
    pub times: Vec<(&'static str, f64)>,
}

impl Results {
    /// The finest finite-element mesh and its solutions.
    pub fn finest(&self) -> &ReferenceMesh {
        &self.reference[2]
    }

    /// The mass-spring model, the corrected field and the finest finite elements at a stretch, each where it exists.
    pub fn models(&self, step: usize) -> [Option<&State>; 3] {
        let corrected = self.corrected[step].as_ref();
        [
            self.uncorrected.states.get(step),
            corrected.map(|corrected| &corrected.state),
            self.finest().solution.states.get(step),
        ]
    }

    /// The displacement fields of a model before a stretch, which a softening material remembers; empty where it does not soften.
    pub fn past(&self, model: usize, step: usize) -> Vec<&[f64]> {
        let remembers = self.remembers;
        let before = (0..step).filter(|_| remembers);
        let field = |before: usize| Some(&self.models(before)[model]?.displacement[..]);
        before.filter_map(field).collect()
    }

    /// The work done on the material up to a stretch in each of them; `None` where it has no memory.
    pub fn works(&self, step: usize) -> [Option<Work>; 3] {
        let of = |solution: &Solution| *solution.works.get(step)?;
        let corrected = self.corrected[step].as_ref();
        [
            of(&self.uncorrected),
            corrected.and_then(|own| own.work),
            of(&self.finest().solution),
        ]
    }

    /// The measures of each of them.
    pub fn measures(&self, step: usize) -> [Option<Measures>; 3] {
        let [springs, _, elements] = self.models(step);
        let of = |mesh, state: Option<&State>| state.map(|state| Measures::of(mesh, state));
        let corrected = self.corrected[step].as_ref();
        [
            of(&self.springs.mesh, springs),
            corrected.map(|corrected| corrected.measures),
            of(&self.finest().model.mesh, elements),
        ]
    }

    /// The mesh of each of them.
    pub fn meshes(&self) -> [&Mesh; 3] {
        [
            &self.springs.mesh,
            &self.corrected_mesh,
            &self.finest().model.mesh,
        ]
    }

    /// The stretches at which a model of [`MODELS`] has a solution.
    pub fn reached(&self, model: usize) -> Vec<f64> {
        let steps = 0..self.comparison.len();
        let stretch = |step: usize| Some(self.models(step)[model]?.factor);
        steps.filter_map(stretch).collect()
    }

    /// The stretches with a corrected field and without one of the springs.
    pub fn stretches_without_springs(&self) -> Vec<f64> {
        let steps = 0..self.comparison.len();
        let stretch = |step: usize| match self.models(step) {
            [None, Some(corrected), _] => Some(corrected.factor),
            _ => None,
        };
        steps.filter_map(stretch).collect()
    }

    /// The worst balance of the grips' reactions of a model of [`MODELS`], and the stretch of it; `None` where the model
    /// has no solution.
    pub fn worst_balance(&self, model: usize) -> Option<(f64, f64)> {
        let of_step = |step: usize| {
            let balance = match model {
                0 => self.uncorrected.balances.get(step).copied(),
                1 => self.corrected[step].as_ref().map(|own| own.balance),
                _ => self.finest().solution.balances.get(step).copied(),
            };
            Some((balance?, self.comparison[step].stretch))
        };
        let all = (0..self.comparison.len()).filter_map(of_step);
        all.max_by(|(a, _), (b, _)| a.total_cmp(b))
    }

    /// The worst balance of every model that has a solution.
    pub fn worst_balances(&self) -> impl Iterator<Item = f64> {
        let balances = (0..MODELS.len()).filter_map(|model| self.worst_balance(model));
        balances.map(|(relative, _)| relative)
    }

    /// The largest residual force at a node that no grip holds over the force on a grip, the worst of all stretches, of a
    /// model of [`MODELS`]; `None` where it has no solution.
    pub fn worst_residual(&self, model: usize) -> Option<f64> {
        let mesh = self.meshes()[model];
        let of_step = |step: usize| {
            let solution = self.models(step)[model]?;
            let residual = solution.residual.iter().enumerate();
            let free = residual.filter(|(unknown, _)| !mesh.on_grip(unknown / 2));
            let largest = free.fold(0.0, |most: f64, (_, force)| most.max(force.abs()));
            Some(largest / self.measures(step)[model]?.force.abs())
        };
        let steps = 0..self.comparison.len();
        steps.filter_map(of_step).reduce(larger)
    }

    /// The last stretch at which one of the models has a solution.
    pub fn last_step(&self) -> Option<usize> {
        let any = |step: &usize| self.models(*step).iter().any(Option::is_some);
        (0..self.comparison.len()).rev().find(any)
    }

    /// The estimated error of the finest mesh's force at a stretch in %, by recovery, without its sign.
    pub fn recovered_force_percent(&self, step: usize) -> Option<f64> {
        let estimate = self.estimates.get(step)?.as_ref()?;
        Some(100.0 * (estimate.force / self.measures(step)[2]?.force).abs())
    }

    /// The finite elements' own error of the force at a stretch in %: that of three meshes, or the larger one of that and of
    /// the recovery on the finest where the three do not converge monotonically.
    pub fn own_force_percent(&self, step: usize) -> Option<f64> {
        let own = self.comparison[step].reference?.force;
        let doubted = self
            .recovered_force_percent(step)
            .filter(|_| own.order.is_none());
        Some(doubted.map_or(own.error_percent, |recovered| {
            own.error_percent.max(recovered)
        }))
    }
}
