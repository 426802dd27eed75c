//! The climb on any shape: springs on the coarsest of some meshes, corrected there, then from mesh to mesh.
//!
//! On each finer mesh the field is interpolated, with about what the mesh before has added, the governing equation is linearised, mostly
//! once, and a few conjugate-gradient iterations with one cycle of multigrid each (see [`LinearSolver::Multigrid`]) bring the
//! correction. What the iteration may leave is a share of the discretisation error, which the meshes tell: changes
//! s shrink by a ratio q from mesh to mesh, and all finer ones would add s q/(1 − q).
//!
//! All supports, loads, laws and elements; where the iteration does not lead to the end, load steps and factors do.

use super::CorrectorSettings;
use super::climb::ClimbSettings;
use super::specimen::correct;
use crate::error::{Diagnostic, Error};
use crate::mass_spring::MassSpring;
use crate::material::softened_law::check_memory;
use crate::mesh::Mesh;
use crate::problem::{BoundaryProblem, Model};
use crate::solve::vector::{add_scaled, difference, norm};
use crate::solve::{Convergence, LinearSolver, Loading, Newton, NewtonSettings, State};

/// The ratio of the changes of two meshes where it is not known yet, and the ratios that are believed.
const RATIO: f64 = 1.0 / 3.0;
const RATIOS: [f64; 2] = [0.15, 0.7];

/// What the iteration may leave on all meshes but the finest, relative to what it may leave there.
const ON_THE_WAY: f64 = 3.0;

/// What of the allowed share is used: the imbalance tells the error of the field in the energy, not in the displacement.
const SURE: f64 = 0.03;

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// A field that has climbed.
#[derive(Clone, Debug)]
pub struct ShapeClimb {
    /// On the finest mesh.
    pub state: State,
    /// The estimated discretisation error of the field, root mean square over the nodes in mm; not a number where there is one
    /// mesh alone.
    pub discretisation_error: f64,
    /// What the iteration left, estimated, root mean square over the nodes in mm.
    pub iteration_error: f64,
    /// What was done on each mesh, coarse to fine.
    pub work: Vec<ShapeWork>,
}

/// What was done on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeWork {
    /// Its nodes.
    pub nodes: usize,
    /// Tangents.
    pub linearisations: usize,
    /// Iterations, each with one cycle of multigrid; none where factors were taken.
    pub iterations: usize,
}

/// Corrects the springs' field at a load factor on the last of some meshes of a problem, coarse to fine: each with about half the spacing
/// of the one before.
///
/// # Errors
/// [`Error::Input`] where a mesh does not suit the problem, [`Error::Solve`] where no field was found.
///
/// # Panics
/// Without a mesh.
pub fn climb(
    problem: &BoundaryProblem,
    meshes: &[Mesh],
    factor: f64,
    settings: ClimbSettings,
) -> Result<ShapeClimb, Error> {
    check_memory(&*problem.law, "the climb")?;
    let (coarsest, finer) = meshes.split_first().expect("a mesh");
    let mut ascent = Ascent {
        state: begin(problem, coarsest, factor)?,
        mesh: coarsest,
        change: None,
        size: f64::NAN,
        ratio: RATIO,
        left: 0.0,
        work: Vec::new(),
    };
    ascent.note(0, 0);
    for (index, mesh) in finer.iter().enumerate() {
        let finest = index + 1 == finer.len();
        let slack = if finest { 1.0 } else { ON_THE_WAY };
        ascent.climb(problem, mesh, slack * settings.tolerance)?;
    }
    Ok(ShapeClimb {
        discretisation_error: ascent.discretisation_error(),
        iteration_error: ascent.left * ascent.size,
        state: ascent.state,
        work: ascent.work,
    })
}

/// The springs' field, corrected, on the coarsest mesh; where the springs have none, or it does not lead to the corrected one, load
/// steps do.
fn begin(problem: &BoundaryProblem, mesh: &Mesh, factor: f64) -> Result<State, Error> {
    let lattice = match mesh.degree() {
        1 => mesh.clone(),
        _ => mesh.refined().linear(),
    };
    let springs = MassSpring::on_mesh(&problem.law, problem.thickness, lattice);
    let energy = problem.finite_elements(mesh);
    let model = on(problem, mesh, &energy)?.named("corrector");
    let by_springs = on(problem, &springs.mesh, springs.potential())?;
    let by_springs = by_springs.describing(|element| springs.describe_element(element));
    if let Ok(state) = by_springs.reach(&[factor], NEWTON) {
        let data = springs
            .mesh
            .interpolation_on(mesh)
            .apply(&state.displacement);
        let corrected = correct(
            &model,
            &data,
            &data,
            (factor, &[]),
            CorrectorSettings::default(),
        );
        if let Ok(corrected) = corrected {
            return Ok(corrected.state);
        }
    }
    model.reach(&[factor], NEWTON)
}

fn on<'a>(
    problem: &BoundaryProblem,
    mesh: &'a Mesh,
    energy: &'a dyn crate::solve::Potential,
) -> Result<Model<'a>, Error> {
    let found = problem.on(mesh, energy);
    found.map_err(|fault: Diagnostic| Error::Input(vec![fault]))
}

/// A field on its way up.
struct Ascent<'a> {
    state: State,
    mesh: &'a Mesh,
    /// What this mesh added to the field of the one before, and its size: root mean square over the nodes in mm.
    change: Option<Vec<f64>>,
    size: f64,
    /// How changes shrink from mesh to mesh.
    ratio: f64,
    /// What the iteration left, as a share of the change.
    left: f64,
    work: Vec<ShapeWork>,
}

impl<'a> Ascent<'a> {
    /// Takes the field to the next finer mesh.
    fn climb(
        &mut self,
        problem: &BoundaryProblem,
        mesh: &'a Mesh,
        tolerance: f64,
    ) -> Result<(), Error> {
        let factor = self.state.factor;
        let energy = problem.finite_elements(mesh);
        let model = on(problem, mesh, &energy)?.named("corrector");
        let interpolation = self.mesh.interpolation_on(mesh);
        let mut before = interpolation.apply(&self.state.displacement);
        model.impose(factor, &mut before);
        let mut u = before.clone();
        if let Some(change) = &self.change {
            add_scaled(&mut u, self.ratio, &interpolation.apply(change));
            model.impose(factor, &mut u);
        }
        let share = SURE * tolerance * self.ratio / (1.0 - self.ratio);
        let (state, work) = match approach(&model, &u, factor, share) {
            Some((state, work)) => (state, work),
            None => (model.reach(&[factor], NEWTON)?, (0, 0, 0.0)),
        };
        let change = difference(&state.displacement, &before);
        let size = norm(&change) / (mesh.nodes.len() as f64).sqrt();
        if !self.size.is_nan() {
            self.ratio = (size / self.size).clamp(RATIOS[0], RATIOS[1]);
        }
        (self.change, self.size, self.left) = (Some(change), size, work.2);
        (self.state, self.mesh) = (state, mesh);
        self.note(work.0, work.1);
        Ok(())
    }

    fn note(&mut self, linearisations: usize, iterations: usize) {
        self.work.push(ShapeWork {
            nodes: self.mesh.nodes.len(),
            linearisations,
            iterations,
        });
    }

    /// s q + s q² + …, what all finer meshes would add.
    fn discretisation_error(&self) -> f64 {
        self.size * self.ratio / (1.0 - self.ratio)
    }
}

/// The equilibrium near a field, up to a share of its imbalance, with linearisations, iterations and what is left; `None` where multigrid
/// does not lead there.
fn approach(
    model: &Model,
    start: &[f64],
    factor: f64,
    share: f64,
) -> Option<(State, (usize, usize, f64))> {
    let potential = model.potential(factor, &[]);
    let newton = Newton::with_solver(&*potential, &model.held(), LinearSolver::Multigrid);
    let (mut displacement, mut residual) = (start.to_vec(), vec![0.0; start.len()]);
    let found = newton
        .ok()?
        .approach(&*potential, &mut displacement, &mut residual, share)?;
    model.impose(factor, &mut displacement);
    let state = State {
        factor,
        displacement,
        residual,
        history: Vec::new(),
        load_steps: 1,
        convergence: Convergence {
            residuals: vec![1.0, found.left],
            energy: found.energy,
            ..Convergence::default()
        },
    };
    Some((state, (found.linearisations, found.iterations, found.left)))
}
