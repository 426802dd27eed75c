//! The climb of a field from the springs to the finest mesh.

use std::collections::BTreeMap;

use super::field::{NEWTON, ShapeClimb, ShapeWork, approached};
use super::levels::{Levels, carrying, on};
use super::systems::{Scale, Systems};
use crate::corrector::climb::{ClimbSettings, Ratios, geometric_tail};
use crate::corrector::specimen::correct_without_multipliers;
use crate::error::Error;
use crate::mass_spring::MassSpring;
use crate::problem::Model;
use crate::solve::vector::{add_scaled, difference, norm};
use crate::solve::{
    Approach, Assembly, FirstTangent, Ladder, LinearSolver, Loading, Nearness, Newton,
    NewtonSettings, Potential, Stage, State,
};

/// The iteration's error on all meshes but the finest, relative to that allowed there.
const ON_THE_WAY: f64 = 3.0;

/// The part of the allowed share that is used: the imbalance measures the error of the field in the energy, not in the displacement.
const SURE: f64 = 0.1;

/// The springs are a first guess, which the correction changes by some hundredths: a more exact equilibrium wastes time, as do more iterations than
/// finite elements take from rest.
const SPRINGS: NewtonSettings = NewtonSettings {
    tolerance: 5e-2,
    max_iterations: 8,
};

/// Iterations of the correction after which the springs were no good guess: finite elements take about as many from rest.
const AFTER_SPRINGS: usize = 6;

/// The changes of the finer meshes are larger by far, where there are any.
const COARSEST: NewtonSettings = NewtonSettings {
    tolerance: 1e-4,
    ..NEWTON
};
const ALONE: NewtonSettings = NewtonSettings {
    tolerance: 1e-6,
    ..NEWTON
};

/// The tangents of a mesh and of the coarser ones.
enum Tangents {
    /// That of the coarsest mesh.
    Coarsest(Box<Ladder>),
    /// Those of Newton's method by multigrid, with the ties of the mesh.
    Solved(Box<Newton>, BTreeMap<usize, usize>),
}

impl Tangents {
    /// As systems for a finer mesh; `None` where multigrid was not used on all of them.
    fn into_ladder(self) -> Option<Ladder> {
        match self {
            Self::Coarsest(ladder) => Some(*ladder),
            Self::Solved(newton, ties) => Some(newton.into_ladder()?.tied(&ties)),
        }
    }
}

/// A field during the climb.
pub struct Ascent {
    state: State,
    /// The number of its mesh.
    level: usize,
    tangents: Option<Tangents>,
    /// The change of the field from the mesh before to this one, and its size: root mean square over the nodes in mm.
    change: Option<Vec<f64>>,
    size: f64,
    /// The ratio by which changes shrink from mesh to mesh.
    ratio: f64,
    /// The imbalance with which a mesh was reached by multigrid, and the share of it that may remain.
    reached: Option<(Approach, f64)>,
    work: Vec<ShapeWork>,
}

impl Ascent {
    /// Climbs to the finest mesh at a load factor.
    ///
    /// # Errors
    /// [`Error::Input`] where a mesh does not suit the problem, [`Error::Solve`] where no field was found.
    pub fn of(levels: &Levels, factor: f64, settings: ClimbSettings) -> Result<Self, Error> {
        let mut ascent = Self::begin(levels, factor)?;
        for level in 1..=levels.finest() {
            let finest = level == levels.finest();
            let slack = if finest { 1.0 } else { ON_THE_WAY };
            ascent.climb(levels, slack * settings.tolerance)?;
        }
        let model = levels.model(ascent.level)?;
        let state = &mut ascent.state;
        let mut forces = vec![0.0; state.displacement.len()];
        let potential = model.potential(factor, &[]);
        let found = Assembly::residual(&*potential, &state.displacement, &mut forces);
        state.convergence.energy = found.unwrap_or(f64::NAN);
        Ok(ascent)
    }

    /// The corrected springs' field on the coarsest mesh; where the springs have none after few iterations, or it
    /// does not lead to the corrected one in few, finite elements start from rest.
    fn begin(levels: &Levels, factor: f64) -> Result<Self, Error> {
        let (problem, mesh) = (levels.problem, &levels.meshes[0]);
        let lattice = match mesh.degree() {
            1 => mesh.clone(),
            _ => mesh.refined().linear(),
        };
        let springs = MassSpring::on_mesh(&problem.law, problem.thickness, lattice);
        let model = levels.model(0)?;
        let by_springs = on(problem, &springs.mesh, springs.potential())?;
        let by_springs = by_springs.describing(|element| springs.describe_element(element));
        let settings = match levels.finest() {
            0 => ALONE,
            _ => COARSEST,
        };
        let corrected = |state: State| {
            let interpolation = springs.mesh.interpolation_on(mesh);
            let data = interpolation.apply(&state.displacement);
            let settings = NewtonSettings {
                max_iterations: AFTER_SPRINGS,
                ..settings
            };
            correct_without_multipliers(&model, &data, Stage::first(factor), settings).ok()
        };
        let by_springs = by_springs.reach(&[factor], SPRINGS).ok();
        let state = match by_springs.and_then(corrected) {
            Some(corrected) => corrected,
            None => model.reach(&[factor], settings)?,
        };
        let potential = model.potential(factor, &[]);
        let ladder = Ladder::begin(&*potential, &model.held(), &state.displacement);
        let ladder = ladder.map(|own| own.tied(model.ties()));
        let mut ascent = Self {
            state,
            level: 0,
            tangents: ladder.map(|own| Tangents::Coarsest(Box::new(own))),
            change: None,
            size: f64::NAN,
            ratio: Ratios::MEASURED.first,
            reached: None,
            work: Vec::new(),
        };
        ascent.note(mesh.nodes.len(), 0, 0);
        Ok(ascent)
    }

    /// Takes the field to the next finer mesh.
    fn climb(&mut self, levels: &Levels, tolerance: f64) -> Result<(), Error> {
        let (factor, level) = (self.state.factor, self.level + 1);
        let model = levels.model(level)?;
        let interpolation = levels.to(level);
        let mut before = interpolation.apply(&self.state.displacement);
        model.impose(factor, &mut before);
        let mut u = before.clone();
        if let Some(change) = &self.change {
            add_scaled(&mut u, self.ratio, &interpolation.apply(change));
            model.impose(factor, &mut u);
        }
        let share = SURE * tolerance * geometric_tail(1.0, self.ratio);
        let potential = model.potential(factor, &[]);
        let newton = self.newton(&*potential, &model.held(), levels);
        let near = newton.and_then(|own| approach(&model, &*potential, own, factor, &u, share));
        self.reached = None;
        self.state = match near {
            Some((state, newton, own)) => {
                self.note(model.mesh.nodes.len(), own.linearisations, own.iterations);
                let newton = Box::new(newton);
                self.tangents = Some(Tangents::Solved(newton, model.ties().clone()));
                self.reached = Some((own, share));
                state
            }
            None => {
                self.note(model.mesh.nodes.len(), 0, 0);
                model.reach(&[factor], NEWTON)?
            }
        };
        let change = difference(&self.state.displacement, &before);
        let size = norm(&change) / (model.mesh.nodes.len() as f64).sqrt();
        if size > 0.0 {
            self.ratio = Ratios::MEASURED.told([self.size, size], self.ratio);
        }
        (self.change, self.size, self.level) = (Some(change), size, level);
        Ok(())
    }

    /// Newton's method on the next finer mesh, by multigrid on the tangents of the coarser ones where they are available.
    fn newton(
        &mut self,
        potential: &dyn Potential,
        held: &[bool],
        levels: &Levels,
    ) -> Option<Newton> {
        let Some(ladder) = self.tangents.take().and_then(Tangents::into_ladder) else {
            return Newton::with_solver(potential, held, LinearSolver::Multigrid).ok();
        };
        let carry = carrying(levels.to(self.level + 1));
        Newton::above(potential, held, ladder, &carry).ok()
    }

    fn note(&mut self, nodes: usize, linearisations: usize, iterations: usize) {
        self.work.push(ShapeWork {
            nodes,
            linearisations,
            iterations,
        });
    }

    /// s q + s q² + …, the change that all finer meshes would add.
    fn discretisation_error(&self) -> f64 {
        geometric_tail(self.size, self.ratio)
    }

    /// The systems of the finest mesh.
    ///
    /// # Errors
    /// [`Error::Solve`] where the finest mesh has no tangent.
    pub fn systems(&mut self, levels: &Levels, tolerance: f64) -> Result<Systems, Error> {
        let errors = [self.discretisation_error(), tolerance];
        let scale = Scale::of(levels, &self.state, errors);
        let (scale, newton) = match (self.tangents.take(), self.reached) {
            (Some(Tangents::Solved(newton, _)), Some((own, share))) => {
                (scale.told(&own, share), Some(*newton))
            }
            _ => (scale.without_multigrid(), None),
        };
        Systems::new(levels, &self.state, newton, scale)
    }

    /// The field with its errors.
    pub fn climbed(self) -> ShapeClimb {
        let left = self.reached.map_or(0.0, |(own, _)| own.left());
        ShapeClimb {
            discretisation_error: self.discretisation_error(),
            iteration_error: match self.level {
                0 => f64::NAN,
                _ => left * self.size,
            },
            state: self.state,
            work: self.work,
        }
    }

    /// Whether the tangents of all meshes are available for a finer one.
    #[cfg(test)]
    pub fn is_nested(&self) -> bool {
        match &self.tangents {
            Some(Tangents::Solved(newton, _)) => newton.is_nested(),
            own => own.is_some(),
        }
    }

    /// The work on each mesh.
    #[cfg(test)]
    pub fn work(&self) -> &[ShapeWork] {
        &self.work
    }
}

/// The equilibrium near a field at a load factor, up to a share of its imbalance, with the tangents for finer meshes,
/// and the work; `None` where multigrid does not converge.
fn approach(
    model: &Model,
    potential: &dyn Potential,
    mut newton: Newton,
    factor: f64,
    start: &[f64],
    share: f64,
) -> Option<(State, Newton, Approach)> {
    let (mut displacement, mut residual) = (start.to_vec(), vec![0.0; start.len()]);
    let own = newton.approach(
        potential,
        &mut displacement,
        &mut residual,
        Nearness::Share(share),
        FirstTangent::Own,
    )?;
    model.impose(factor, &mut displacement);
    let state = approached(factor, displacement, residual, f64::NAN, &own);
    Some((state, newton, own))
}
