//! The climb on any shape: springs on the coarsest of some meshes, corrected there, then from mesh to mesh.
//!
//! On each finer mesh the field is interpolated, with about what the mesh before has added, the governing equation is linearised, mostly
//! once, and a few conjugate-gradient iterations bring the correction, each with one cycle of multigrid on the tangents that the
//! coarser meshes already have (see [`Ladder`]). What the iteration may leave is a share of the discretisation error, which the meshes tell: changes
//! s shrink by a ratio q from mesh to mesh, and all finer ones would add s q/(1 − q).
//!
//! All supports, loads, laws and elements; where the iteration does not lead to the end, load steps and factors do.

use super::CorrectorSettings;
use super::climb::{ClimbSettings, Ratios, geometric_tail};
use super::specimen::correct;
use crate::error::{Diagnostic, Error};
use crate::mass_spring::MassSpring;
use crate::material::softened_law::check_memory;
use crate::mesh::{Interpolation, Mesh};
use crate::problem::{BoundaryProblem, Model};
use crate::solve::vector::{add_scaled, difference, norm};
use crate::solve::{
    Approach, Convergence, Ladder, LinearSolver, Loading, Newton, NewtonSettings, Potential, State,
};

/// What the iteration may leave on all meshes but the finest, relative to what it may leave there.
const ON_THE_WAY: f64 = 3.0;

/// What of the allowed share is used: the imbalance tells the error of the field in the energy, not in the displacement.
const SURE: f64 = 0.1;

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
    let ascent = ascend(problem, meshes, factor, settings)?;
    Ok(ShapeClimb {
        discretisation_error: ascent.discretisation_error(),
        iteration_error: ascent.left * ascent.size,
        state: ascent.state,
        work: ascent.work,
    })
}

fn ascend<'a>(
    problem: &BoundaryProblem,
    meshes: &'a [Mesh],
    factor: f64,
    settings: ClimbSettings,
) -> Result<Ascent<'a>, Error> {
    check_memory(&*problem.law, "the climb")?;
    let (coarsest, finer) = meshes.split_first().expect("a mesh");
    let (state, ladder) = begin(problem, coarsest, factor)?;
    let mut ascent = Ascent {
        state,
        mesh: coarsest,
        ladder,
        change: None,
        size: f64::NAN,
        ratio: Ratios::MEASURED.first,
        left: 0.0,
        work: Vec::new(),
    };
    ascent.note(0, 0);
    for (index, mesh) in finer.iter().enumerate() {
        let finest = index + 1 == finer.len();
        let slack = if finest { 1.0 } else { ON_THE_WAY };
        ascent.climb(problem, mesh, slack * settings.tolerance)?;
    }
    Ok(ascent)
}

/// The springs' field, corrected, on the coarsest mesh; where the springs have none, or it does not lead to the corrected one, load
/// steps do.
fn begin(
    problem: &BoundaryProblem,
    mesh: &Mesh,
    factor: f64,
) -> Result<(State, Option<Ladder>), Error> {
    let lattice = match mesh.degree() {
        1 => mesh.clone(),
        _ => mesh.refined().linear(),
    };
    let springs = MassSpring::on_mesh(&problem.law, problem.thickness, lattice);
    let energy = problem.finite_elements(mesh);
    let model = on(problem, mesh, &energy)?.named("corrector");
    let by_springs = on(problem, &springs.mesh, springs.potential())?;
    let by_springs = by_springs.describing(|element| springs.describe_element(element));
    let corrected = |state: State| {
        let interpolation = springs.mesh.interpolation_on(mesh);
        let data = interpolation.apply(&state.displacement);
        let settings = CorrectorSettings::default();
        correct(&model, &data, &data, (factor, &[]), settings).ok()
    };
    let by_springs = by_springs.reach(&[factor], NEWTON).ok();
    let state = match by_springs.and_then(corrected) {
        Some(corrected) => corrected.state,
        None => model.reach(&[factor], NEWTON)?,
    };
    let potential = model.potential(factor, &[]);
    let ladder = Ladder::begin(&*potential, &model.held(), &state.displacement);
    Ok((state, ladder.map(|own| own.tied(model.ties()))))
}

fn on<'a>(
    problem: &BoundaryProblem,
    mesh: &'a Mesh,
    energy: &'a dyn Potential,
) -> Result<Model<'a>, Error> {
    let found = problem.on(mesh, energy);
    found.map_err(|fault: Diagnostic| Error::Input(vec![fault]))
}

/// A field on its way up.
struct Ascent<'a> {
    state: State,
    mesh: &'a Mesh,
    /// The tangents of this mesh and of the coarser ones, where multigrid has served on all of them.
    ladder: Option<Ladder>,
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
        let share = SURE * tolerance * geometric_tail(1.0, self.ratio);
        let potential = model.potential(factor, &[]);
        let newton = self.newton(&*potential, &model.held(), &interpolation);
        let near = newton.and_then(|own| approach(&model, &*potential, own, (factor, &u), share));
        let (state, ladder, [linearisations, iterations], left) = match near {
            Some((state, ladder, own)) => {
                let work = [own.linearisations, own.iterations];
                (state, ladder, work, own.left)
            }
            None => (model.reach(&[factor], NEWTON)?, None, [0; 2], 0.0),
        };
        self.ladder = ladder;
        let change = difference(&state.displacement, &before);
        let size = norm(&change) / (mesh.nodes.len() as f64).sqrt();
        self.ratio = Ratios::MEASURED.told([self.size, size], self.ratio);
        (self.change, self.size, self.left) = (Some(change), size, left);
        (self.state, self.mesh) = (state, mesh);
        self.note(linearisations, iterations);
        Ok(())
    }

    /// Newton's method on a mesh, by multigrid on the tangents of the coarser ones where they are at hand.
    fn newton(
        &mut self,
        potential: &dyn Potential,
        held: &[bool],
        interpolation: &Interpolation,
    ) -> Option<Newton> {
        let Some(ladder) = self.ladder.take() else {
            return Newton::with_solver(potential, held, LinearSolver::Multigrid).ok();
        };
        let carry = |unknown: usize, terms: &mut Vec<(usize, f64)>| {
            let nodes = interpolation.of(unknown / 2).iter();
            terms.extend(nodes.map(|(node, share)| (2 * node + unknown % 2, *share)));
        };
        Newton::above(potential, held, ladder, &carry).ok()
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
        geometric_tail(self.size, self.ratio)
    }
}

/// The equilibrium near a field at a load factor, up to a share of its imbalance, with the tangents for finer meshes, and what it
/// took; `None` where multigrid does not lead there.
fn approach(
    model: &Model,
    potential: &dyn Potential,
    mut newton: Newton,
    (factor, start): (f64, &[f64]),
    share: f64,
) -> Option<(State, Option<Ladder>, Approach)> {
    let (mut displacement, mut residual) = (start.to_vec(), vec![0.0; start.len()]);
    let found = newton.approach(potential, &mut displacement, &mut residual, share)?;
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
    let ladder = newton.into_ladder().map(|own| own.tied(model.ties()));
    Some((state, ladder, found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use crate::material::NeoHooke;
    use crate::mesh::{CellShape, Shape};
    use crate::problem::{Drive, Support};

    /// Tangents of coarser meshes serve with held, sliding and tied nodes, on curved outlines, and their iterations do not grow
    /// with the mesh.
    #[test]
    fn iterations_on_the_tangents_of_coarser_meshes_do_not_grow() {
        let hole = Shape::StripWithHole {
            size: [40.0, 20.0],
            radius: 4.0,
        };
        let supports = [
            ("left", Support::Roller),
            ("bottom", Support::Roller),
            (
                "right",
                Support::Grip([Drive::Force(2.0), Drive::Displacement(0.0)]),
            ),
        ];
        for kind in [CellShape::Quad4, CellShape::Triangle3, CellShape::Quad9] {
            let problem = BoundaryProblem {
                thickness: 2.0,
                law: Arc::new(NeoHooke { c10: 0.05 }),
                supports: supports.map(|(name, own)| (name.to_owned(), own)).into(),
                loads: Vec::new(),
            };
            let meshes: Vec<Mesh> = (0..4).map(|level| hole.mesh(3 << level, kind)).collect();
            let ascent = ascend(&problem, &meshes, 1.0, ClimbSettings::default()).unwrap();
            let work: Vec<usize> = ascent.work[1..].iter().map(|own| own.iterations).collect();
            assert!(ascent.ladder.is_some(), "{kind:?}: {work:?}");
            let steady = work.iter().all(|own| *own > 0) && work[2] <= work[1] + 3;
            assert!(steady, "{kind:?}: {work:?}");
        }
    }
}
