//! The systems that a climb leaves for states nearby.

use super::field::{NEWTON, ShapeClimb, ShapeWork, approached};
use super::levels::{Levels, carrying};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::solve::{
    Approach, FirstTangent, LinearSolver, Loading, Nearness, Newton, Potential, Stage, State,
    equilibrium,
};

/// Approximate cost in cycles of the tangent of the finest mesh and of a check of its stability.
const TANGENT: usize = 30;

/// Iterations per step, relative to those with the tangents of all meshes at one state, from which on the tangents of
/// the coarser meshes are taken anew.
const STALE: f64 = 2.0;

/// How much softer than the whole field the iteration's error may be, √(energy) over size.
const SOFTER: f64 = 4.0;

/// Errors found by a climb, relative to the size of its field; NaN where they are not known.
#[derive(Clone, Copy)]
pub struct Scale {
    /// Root mean square departure of the field from a rigid motion in mm.
    departure: f64,
    /// Discretisation error.
    pub discretisation: f64,
    /// Imbalance that may remain in √mJ/mm; `None` where there is no multigrid, or where it is not known.
    imbalance: Option<f64>,
    /// Error of the field in mm due to an imbalance, in mm/√mJ.
    compliance: f64,
}

impl Scale {
    /// The scale of a field with a discretisation error in mm; the iteration may leave a share of it, `tolerance`.
    ///
    /// An error z of the field has the imbalance √(z · K z). The changes of finer meshes are rough and have a large imbalance; the error of
    /// iterations between states is about as smooth as the field u itself, and √(2 W) of its strain energy W stands for ‖u‖.
    pub fn of(levels: &Levels, state: &State, [discretisation_error, tolerance]: [f64; 2]) -> Self {
        let finest = levels.finest();
        let departure = departure(&levels.meshes[finest], &state.displacement);
        let energy = levels.strain_energy(finest, &state.displacement);
        let compliance = SOFTER * departure / (2.0 * energy).sqrt();
        let imbalance = tolerance * discretisation_error / compliance / departure;
        Self {
            departure,
            discretisation: discretisation_error / departure,
            imbalance: Some(imbalance).filter(|own| !own.is_nan()),
            compliance,
        }
    }

    /// The scale with the result of an approach, of whose first imbalance some share may remain.
    pub fn told(self, own: &Approach, share: f64) -> Self {
        let of_approach = share * own.first / self.departure;
        Self {
            imbalance: self.imbalance.map(|own| own.min(of_approach)),
            ..self
        }
    }

    /// The scale where there is no multigrid.
    pub fn without_multigrid(self) -> Self {
        Self {
            imbalance: None,
            ..self
        }
    }

    /// The scale with the stricter limits of two.
    pub fn and(self, other: Self) -> Self {
        Self {
            departure: self.departure.max(other.departure),
            discretisation: self.discretisation,
            imbalance: self.imbalance.zip(other.imbalance).map(|(a, b)| a.min(b)),
            compliance: self.compliance.max(other.compliance),
        }
    }
}

/// The root mean square over the nodes of a field's departure from the rigid motion nearest to it in mm.
///
/// ```text
/// min ‖x − x̄ − R (X − X̄)‖,   R a rotation,   x = X + u
/// ```
pub fn departure(mesh: &Mesh, u: &[f64]) -> f64 {
    let places = || mesh.nodes.iter().zip(u.chunks_exact(2));
    let count = mesh.nodes.len() as f64;
    let (mut rest, mut moved) = ([0.0; 2], [0.0; 2]);
    for (place, u) in places() {
        for axis in 0..2 {
            rest[axis] += place[axis] / count;
            moved[axis] += (place[axis] + u[axis]) / count;
        }
    }
    // Relative to both means: X − X̄ and u − ū.
    let relative = places().map(|(place, u)| {
        let arm = [0, 1].map(|axis| place[axis] - rest[axis]);
        let own = [0, 1].map(|axis| place[axis] + u[axis] - moved[axis] - arm[axis]);
        (arm, own)
    });
    let relative: Vec<_> = relative.collect();
    let (mut along, mut across) = (0.0, 0.0);
    for ([x, y], [ux, uy]) in &relative {
        along += x * (x + ux) + y * (y + uy);
        across += x * uy - y * ux;
    }
    let (sine, cosine) = across.atan2(along).sin_cos();
    // 1 − cos without cancellation.
    let lost = sine * sine / (1.0 + cosine).max(f64::MIN_POSITIVE);
    let squares = relative.iter().map(|([x, y], [ux, uy])| {
        let own = [ux + lost * x + sine * y, uy - sine * x + lost * y];
        own[0] * own[0] + own[1] * own[1]
    });
    (squares.sum::<f64>() / count).sqrt()
}

/// The tangents that are taken anew.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Anew {
    None,
    Finest,
    All,
}

/// The systems of all meshes, and how well they serve.
pub struct Systems {
    newton: Newton,
    pub scale: Scale,
    /// The tangents with which the next state begins.
    anew: Anew,
    /// Iterations per step when all tangents were of one state.
    pace: f64,
    /// Whether the tangents of the coarser meshes no longer suit that of the finest one.
    coarser_are_stale: bool,
    /// Cycles of a state with a tangent of its own, and all cycles beyond that number since.
    own: usize,
    beyond: usize,
}

/// A load factor, or another parameter of a loading, with the field that is expected there, and the load factor of the loads.
pub struct Aim {
    pub factor: f64,
    pub start: Vec<f64>,
    pub load_factor: f64,
}

impl Systems {
    /// The systems of the finest mesh after a climb; without multigrid they are created there for factors.
    ///
    /// # Errors
    /// [`Error::Solve`] where there is no tangent, [`Error::Input`] where the mesh does not suit the problem.
    pub fn new(
        levels: &Levels,
        state: &State,
        newton: Option<Newton>,
        scale: Scale,
    ) -> Result<Self, Error> {
        let newton = match newton {
            Some(newton) => newton,
            None => {
                let model = levels.model(levels.finest())?;
                let potential = model.potential(state.factor, &[]);
                let newton =
                    Newton::with_solver(&*potential, &model.held(), LinearSolver::Automatic);
                newton.map_err(|fault| Error::Solve {
                    model: model.name.clone(),
                    step: format!("load factor {}", state.factor),
                    fault,
                })?
            }
        };
        Ok(Self {
            newton,
            scale,
            anew: Anew::None,
            pace: f64::INFINITY,
            coarser_are_stale: false,
            own: 0,
            beyond: 0,
        })
    }

    /// The approximate effect of a small motion of held unknowns from an equilibrium; `None` where there is no tangent.
    pub fn carried_along(
        &mut self,
        loading: &dyn Loading,
        potential: &dyn Potential,
        u: &[f64],
        motion: &[f64],
    ) -> Option<Vec<f64>> {
        let by_multigrid = self.newton.carried_along(potential, u, motion);
        by_multigrid.or_else(|| {
            let describe = |element| loading.describe(element);
            let tangent = &mut self.newton.tangent;
            tangent.predict(potential, u, motion, &describe).ok()
        })
    }

    /// The equilibrium near an expected field: by multigrid, with tangents taken anew where they no longer serve, or by Newton's method
    /// with factors. `None` where neither leads there.
    pub fn reach(
        &mut self,
        levels: &Levels,
        loading: &dyn Loading,
        aim: Aim,
    ) -> Option<ShapeClimb> {
        let mesh = &levels.meshes[levels.finest()];
        let size = departure(mesh, &aim.start).max(1e-9 * self.scale.departure);
        let nodes = mesh.nodes.len();
        let potential = loading.potential(aim.factor, &[]);
        if let Some((state, own)) = self.near(levels, loading, &*potential, &aim, size) {
            return Some(ShapeClimb {
                discretisation_error: self.discretisation_error(mesh, &state),
                state,
                iteration_error: own.last * self.scale.compliance,
                work: vec![ShapeWork {
                    nodes,
                    linearisations: own.linearisations,
                    iterations: own.iterations,
                }],
            });
        }
        self.anew = Anew::All;
        let (stage, newton) = (Stage::first(aim.factor), &mut self.newton);
        let state = equilibrium(loading, &*potential, stage, newton, aim.start, NEWTON);
        Some(self.of_factors(levels, state.ok()?))
    }

    /// The result for a state that was found with factors.
    pub fn of_factors(&self, levels: &Levels, state: State) -> ShapeClimb {
        let mesh = &levels.meshes[levels.finest()];
        ShapeClimb {
            discretisation_error: self.discretisation_error(mesh, &state),
            iteration_error: 0.0,
            work: vec![ShapeWork {
                nodes: mesh.nodes.len(),
                linearisations: state.convergence.iterations(),
                iterations: 0,
            }],
            state,
        }
    }

    fn discretisation_error(&self, mesh: &Mesh, state: &State) -> f64 {
        self.scale.discretisation * departure(mesh, &state.displacement)
    }

    fn near(
        &mut self,
        levels: &Levels,
        loading: &dyn Loading,
        potential: &dyn Potential,
        aim: &Aim,
        size: f64,
    ) -> Option<(State, Approach)> {
        let nearness = Nearness::Imbalance(self.scale.imbalance? * size);
        for anew in [Anew::None, Anew::Finest, Anew::All] {
            if anew < self.anew {
                continue;
            }
            if anew == Anew::All {
                let ladder = levels.tangents_below(aim.load_factor, &aim.start)?;
                let carry = carrying(levels.to(levels.finest()));
                self.newton.put_on(ladder, &carry);
            }
            let tangent = match anew {
                Anew::None => FirstTangent::Known,
                _ => FirstTangent::Own,
            };
            let (mut u, mut residual) = (aim.start.clone(), vec![0.0; aim.start.len()]);
            let newton = &mut self.newton;
            let own = newton.approach(potential, &mut u, &mut residual, nearness, tangent);
            let Some(own) = own else {
                continue;
            };
            self.judge(&own, anew);
            loading.impose(aim.factor, &mut u);
            let state = approached(aim.factor, u, residual, f64::NAN, &own);
            return Some((state, own));
        }
        None
    }

    /// Decides with which tangents the next state begins.
    fn judge(&mut self, own: &Approach, anew: Anew) {
        let cycles = own.iterations + own.steps + 1;
        if own.linearisations > 0 {
            let pace = own.iterations as f64 / own.steps.max(1) as f64;
            if anew == Anew::All || self.pace.is_infinite() {
                self.pace = pace.max(1.0);
            }
            self.coarser_are_stale = pace > STALE * self.pace || !self.newton.is_nested();
            self.own = if anew == Anew::None { self.own } else { cycles };
            self.beyond = 0;
        } else {
            if self.own == 0 {
                self.own = cycles;
            }
            self.beyond += cycles - cycles.min(self.own);
        }
        self.anew = match (self.beyond > TANGENT, self.coarser_are_stale) {
            (false, _) => Anew::None,
            (true, false) => Anew::Finest,
            (true, true) => Anew::All,
        };
    }
}
