//! Equilibria along a path of load factors.

use super::newton::{Convergence, Newton, NewtonSettings};
use super::potential::Potential;
use crate::error::SolveFault;

/// A system whose supports and loads follow one load factor.
pub trait Loading {
    /// Marks the unknowns that supports hold.
    fn held(&self) -> Vec<bool>;

    /// Writes the displacements that supports impose at a load factor.
    fn impose(&self, factor: f64, displacement: &mut [f64]);

    /// The potential at a load factor; its pattern must not depend on the factor.
    fn potential(&self, factor: f64) -> Box<dyn Potential + '_>;

    /// A first guess at a load factor; held unknowns are imposed afterwards. Nothing where the linear
    /// prediction from the state before is the best guess.
    fn guess(&self, factor: f64, previous: Option<&State>) -> Option<Vec<f64>>;

    /// Names an element of the potential with its place, for messages.
    fn describe(&self, element: usize) -> String;
}

/// An equilibrium at one load factor.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// The load factor.
    pub factor: f64,
    /// The unknowns.
    pub displacement: Vec<f64>,
    /// ∂Π/∂u: nothing at free unknowns, reactions at held ones.
    pub residual: Vec<f64>,
    /// Equilibria on the way from the state before, this one included; 1 when it was reached in one go.
    pub load_steps: usize,
    /// How the last of them was reached.
    pub convergence: Convergence,
}

/// The end of a path before its last load factor.
#[derive(Clone, Debug, PartialEq)]
pub struct PathEnd {
    /// The load factor that could not be reached.
    pub factor: f64,
    /// Why.
    pub fault: SolveFault,
    /// The equilibria before it.
    pub states: Vec<State>,
}

/// How often the way to a load factor is halved before it is given up.
const HALVINGS: usize = 5;

/// Solves all load factors, one after the other. One that cannot be reached from the one before in one go
/// is approached by halves.
///
/// # Errors
/// [`PathEnd`] with the load factor at which no equilibrium was found and the states before it.
pub fn follow(
    loading: &dyn Loading,
    factors: &[f64],
    settings: NewtonSettings,
    progress: &dyn Fn(f64),
) -> Result<Vec<State>, PathEnd> {
    let mut states: Vec<State> = Vec::new();
    let end = |factor: f64, fault: SolveFault, states: Vec<State>| PathEnd {
        factor,
        fault,
        states,
    };
    let Some(&first) = factors.first() else {
        return Ok(states);
    };
    let newton = Newton::new(&*loading.potential(first), &loading.held());
    let mut path = match newton {
        Ok(newton) => Path {
            loading,
            settings,
            newton,
        },
        Err(fault) => return Err(end(first, fault, states)),
    };
    for &factor in factors {
        match path.reach(states.last(), factor, HALVINGS) {
            Ok(state) => states.push(state),
            Err(fault) => return Err(end(factor, fault, states)),
        }
        progress(factor);
    }
    Ok(states)
}

/// The change of an equilibrium by its tangent while held unknowns move as `motion` says and the others follow:
/// the sensitivity of the field to a support's motion, and, as the tangent is symmetric, the influence of a
/// disturbance of the field on the support's reaction.
///
/// # Errors
/// A [`SolveFault`] when the tangent cannot be factorised.
pub fn influence(
    loading: &dyn Loading,
    state: (f64, &[f64]),
    motion: &[f64],
) -> Result<Vec<f64>, SolveFault> {
    let (factor, displacement) = state;
    let potential = loading.potential(factor);
    let mut newton = Newton::new(&*potential, &loading.held())?;
    let describe = |element| loading.describe(element);
    let change = newton.predict(&*potential, displacement, motion, &describe)?;
    Ok(motion.iter().zip(change).map(|(m, c)| m + c).collect())
}

struct Path<'a> {
    loading: &'a dyn Loading,
    settings: NewtonSettings,
    newton: Newton,
}

impl Path<'_> {
    /// Solves one load factor from the state before it, through intermediate ones where it must.
    fn reach(
        &mut self,
        previous: Option<&State>,
        factor: f64,
        halvings: usize,
    ) -> Result<State, SolveFault> {
        let direct = self.solve_at(previous, factor);
        if direct.is_ok() || halvings == 0 {
            return direct;
        }
        let half = 0.5 * (previous.map_or(0.0, |previous| previous.factor) + factor);
        let half = self.reach(previous, half, halvings - 1)?;
        let state = self.reach(Some(&half), factor, halvings - 1)?;
        Ok(State {
            load_steps: half.load_steps + state.load_steps,
            ..state
        })
    }

    fn solve_at(&mut self, previous: Option<&State>, factor: f64) -> Result<State, SolveFault> {
        let potential = self.loading.potential(factor);
        let mut displacement = match self.loading.guess(factor, previous) {
            Some(guess) => guess,
            None => self.predict(previous, factor, &*potential)?,
        };
        self.loading.impose(factor, &mut displacement);
        let mut residual = vec![0.0; displacement.len()];
        let convergence = self.newton.solve(
            &*potential,
            &mut displacement,
            &mut residual,
            self.settings,
            &|element| self.loading.describe(element),
        )?;
        Ok(State {
            factor,
            displacement,
            residual,
            load_steps: 1,
            convergence,
        })
    }

    /// The linear prediction: the tangent at the state before, for the change of supports and loads.
    fn predict(
        &mut self,
        previous: Option<&State>,
        factor: f64,
        potential: &dyn Potential,
    ) -> Result<Vec<f64>, SolveFault> {
        let mut start = match previous {
            Some(previous) => previous.displacement.clone(),
            None => vec![0.0; potential.unknowns()],
        };
        let mut target = start.clone();
        self.loading.impose(factor, &mut target);
        let motion: Vec<f64> = target
            .iter()
            .zip(&start)
            .map(|(to, from)| to - from)
            .collect();
        let describe = |element| self.loading.describe(element);
        let step = self.newton.predict(potential, &start, &motion, &describe)?;
        for ((u, motion), step) in start.iter_mut().zip(motion).zip(step) {
            *u += motion + step;
        }
        Ok(start)
    }
}
