//! The three models of a specimen.

use web_time::Instant;

use super::end::Run;
use super::lattice::OnLattice;
use super::reference::Reference;
use crate::error::Error;
use crate::problem::Solution;
use crate::studies::ModelKind;
use crate::studies::series::ModelSeries;

/// The three models of a specimen, each up to the end of its path; those that the study leaves out have no states.
pub struct Models {
    /// The finite elements.
    pub reference: Reference,
    /// Springs and corrected springs.
    pub on_lattice: OnLattice,
    /// The finite elements' displacements at the nodes of springs and corrected field, at the load factors that they reach.
    expected: [Vec<Vec<f64>>; 2],
    /// Wall-clock times: what was computed, and seconds.
    pub times: Vec<(String, f64)>,
}

impl Models {
    /// Solves the models that the study asks for, each up to the end of its path.
    ///
    /// # Errors
    /// [`Error::Input`] when a group of a mesh cannot be held or loaded as the study says.
    pub fn solve(run: &mut Run) -> Result<Self, Error> {
        let start = Instant::now();
        let reference = run.specimen.computes(ModelKind::FiniteElement);
        let reference = reference.then(|| Reference::solve(run));
        let reference = reference.transpose()?;
        let elements = start.elapsed().as_secs_f64();
        let on_lattice = OnLattice::solve(run)?;
        let all = start.elapsed().as_secs_f64();
        let left_out = || Reference::left_out(run.specimen, &on_lattice);
        let reference = reference.unwrap_or_else(left_out);
        Ok(Self {
            expected: expected(&reference, &on_lattice),
            reference,
            on_lattice,
            times: vec![
                (
                    "finite elements on all meshes, with their error".into(),
                    elements,
                ),
                ("springs and corrector".into(), all - elements),
            ],
        })
    }

    /// The same with finer finite elements.
    ///
    /// # Errors
    /// [`Error::Input`] when a group of a mesh cannot be held or loaded as the study says.
    pub fn with_finer_elements(self, run: &mut Run) -> Result<Self, Error> {
        let reference = self.reference.finer(run)?;
        Ok(Self {
            expected: expected(&reference, &self.on_lattice),
            reference,
            ..self
        })
    }

    /// The equilibria of a model, up to the end of its path.
    pub fn of(&self, kind: ModelKind) -> &Solution {
        match kind {
            ModelKind::MassSpring => &self.on_lattice.uncorrected,
            ModelKind::Corrected => &self.on_lattice.corrected,
            ModelKind::FiniteElement => &self.reference.finest,
        }
    }

    /// Springs, corrected springs, finite elements.
    pub fn all(&self) -> [(ModelKind, &Solution); 3] {
        ModelKind::ALL.map(|kind| (kind, self.of(kind)))
    }

    /// The states of a model with what pictures, grids and findings need of them.
    pub fn series(&self, kind: ModelKind) -> ModelSeries<'_> {
        ModelSeries::of(kind, self.of(kind), self.all_expected(kind))
    }

    /// Those of springs, corrected springs, finite elements.
    pub fn all_series(&self) -> [ModelSeries<'_>; 3] {
        ModelKind::ALL.map(|kind| self.series(kind))
    }

    /// The model that is nearest to the truth: the finite elements, or else the corrected field or the springs; `None` where none has
    /// reached a load factor.
    pub fn best(&self) -> Option<ModelKind> {
        let mut all = self.all().into_iter().rev();
        all.find_map(|(kind, solution)| (solution.reached() > 0).then_some(kind))
    }

    /// How many load factors at least one model has reached.
    pub fn reached(&self) -> usize {
        let reached = self.all().map(|(_, solution)| solution.reached());
        reached.into_iter().max().unwrap_or(0)
    }

    /// The finite elements' displacement at the nodes of springs or corrected field, at the load factor of a number; `None` where they
    /// have none.
    pub fn expected(&self, kind: ModelKind, step: usize) -> Option<&[f64]> {
        self.all_expected(kind).get(step).map(Vec::as_slice)
    }

    fn all_expected(&self, kind: ModelKind) -> &[Vec<f64>] {
        match kind {
            ModelKind::MassSpring => &self.expected[0],
            ModelKind::Corrected => &self.expected[1],
            ModelKind::FiniteElement => &[],
        }
    }
}

fn expected(reference: &Reference, on_lattice: &OnLattice) -> [Vec<Vec<f64>>; 2] {
    let finest = &reference.finest;
    [&on_lattice.uncorrected.mesh, &on_lattice.corrected.mesh].map(|mesh| {
        let onto_mesh = finest.mesh.interpolation_on(mesh);
        let states = finest.states.iter();
        states
            .map(|state| onto_mesh.apply(&state.displacement))
            .collect()
    })
}
