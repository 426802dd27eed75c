//! The equilibria of a mounted sheet with laws that differ little.

use std::sync::Arc;

use nalgebra::{Matrix2, Vector2};
use rayon::prelude::*;

use super::sheet::{MountedSheet, SheetLaw, SheetState};
use crate::error::{Error, SolveFault};
use crate::material::HyperelasticLaw;
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::vector::{difference, moved};
use crate::solve::{Assembly, Loading, Newton, NewtonSettings};

/// Strains of the bars that differ by less are reached by the tangent taken last.
const NEARBY: f64 = 1e-5;

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-9,
    max_iterations: 15,
};

impl MountedSheet {
    /// The states of some laws at strains of the bars, or of the markers where these were measured: for each strain one of each law. The laws
    /// differ little from the first one. `starts` are states of a law like the first one at these strains, or none.
    ///
    /// # Errors
    /// [`Error::Solve`] with the strains at which there is none.
    pub fn states(
        &self,
        laws: &[SheetLaw],
        strains: &[[f64; 2]],
        starts: &[SheetState],
    ) -> Result<Vec<Vec<SheetState>>, Error> {
        let bodies: Vec<Body> = laws.iter().map(|law| Body::new(self, law)).collect();
        let size = strains
            .len()
            .div_ceil(2 * rayon::current_num_threads())
            .max(1);
        // Neighbours begin at each other's states: from ratio to ratio, the smallest strains first.
        let mut order: Vec<usize> = (0..strains.len()).collect();
        let position = |number: &usize| {
            let [x, y] = strains[*number];
            ((8.0 * y.atan2(x)).round(), x.hypot(y))
        };
        order.sort_by(|a, b| {
            position(a)
                .partial_cmp(&position(b))
                .expect("finite strains")
        });
        let chunks = order.par_chunks(size).map(|chunk| {
            let mut search = Search::new(self, &bodies)?;
            let mut solved: Vec<(usize, Vec<SheetState>)> = Vec::new();
            for number in chunk {
                let target = strains[*number];
                let far = |state: &&SheetState| {
                    (state.middle[0] - target[0]).hypot(state.middle[1] - target[1])
                };
                let known = solved.iter().map(|(_, states)| &states[0]);
                let nearest = known.min_by(|a, b| far(a).total_cmp(&far(b)));
                let result = search.first(target, [starts.get(*number), nearest, None]);
                let states = result.map_err(|fault| fault_at(target, fault))?;
                solved.push((*number, states));
            }
            Ok(solved)
        });
        let of_chunks: Vec<Vec<(usize, Vec<SheetState>)>> = chunks.collect::<Result<_, Error>>()?;
        let mut all: Vec<(usize, Vec<SheetState>)> = of_chunks.into_iter().flatten().collect();
        all.sort_by_key(|(number, _)| *number);
        Ok(all.into_iter().map(|(_, states)| states).collect())
    }
}

/// The energy of the sheet with a law.
struct Body {
    law: Arc<dyn HyperelasticLaw>,
    energy: SheetEnergy,
    /// Whether the sheet is mounted at rest.
    is_at_rest: bool,
}

impl Body {
    fn new(sheet: &MountedSheet, law: &SheetLaw) -> Self {
        let mounted = law.mounted();
        Self {
            energy: sheet.energy.with_law(Arc::clone(&mounted)),
            law: mounted,
            is_at_rest: law.stretches == [1.0; 2],
        }
    }
}

/// The derivatives of the strains of the markers by those of the bars.
#[derive(Clone, Copy)]
struct Markers(Matrix2<f64>);

impl Markers {
    /// The step of the bars by which the markers move so far; `None` where they do not follow.
    fn step(self, far: Vector2<f64>) -> Option<Vector2<f64>> {
        self.0.try_inverse().map(|inverse| inverse * far)
    }

    /// The nearest derivatives by which the markers move as they did with a step of the bars.
    ///
    /// # References
    /// C. G. Broyden, Math. Comp. 19, 577 (1965)
    fn updated(self, step: Vector2<f64>, moved: Vector2<f64>) -> Self {
        let missed = moved - self.0 * step;
        Self(self.0 + missed * step.transpose() / step.norm_squared())
    }
}

/// The search for the states of some laws.
struct Search<'a> {
    sheet: &'a MountedSheet,
    bodies: &'a [Body],
    newton: Newton,
    /// The strains of the bars in the state whose tangent was factorised last.
    factorised: Option<[f64; 2]>,
    /// How the markers follow the bars about the state found last.
    markers: Option<Markers>,
}

impl<'a> Search<'a> {
    fn new(sheet: &'a MountedSheet, bodies: &'a [Body]) -> Result<Self, Error> {
        let first = &bodies[0];
        let problem = sheet.problem(&first.law, [0.0; 2]);
        let built = problem.on(&sheet.mesh, &first.energy);
        let model = built.map_err(|fault| Error::Input(vec![fault]))?;
        let newton = Newton::new(&*model.potential(1.0, &[]), &model.held());
        Ok(Self {
            sheet,
            bodies,
            newton: newton.map_err(|fault| fault_at([0.0; 2], fault))?,
            factorised: None,
            markers: None,
        })
    }

    /// The states of all laws at some strains from the first of some starts that leads there; `None` is the mounted sheet.
    fn first(
        &mut self,
        strains: [f64; 2],
        [first, others @ ..]: [Option<&SheetState>; 3],
    ) -> Result<Vec<SheetState>, SolveFault> {
        let mut result = self.states(strains, first);
        for start in others {
            result = result.or_else(|_| self.states(strains, start));
        }
        result
    }

    /// The states of all laws at some strains: those of the others begin at that of the first one.
    fn states(
        &mut self,
        strains: [f64; 2],
        near: Option<&SheetState>,
    ) -> Result<Vec<SheetState>, SolveFault> {
        let (first, others) = self.bodies.split_first().expect("a law");
        let state = self.state(first, strains, near)?;
        let mut states = vec![state];
        if self.sheet.mounting.markers.is_some() || states[0].field.iter().all(|u| *u == 0.0) {
            for body in others {
                let near = states[0].clone();
                states.push(self.state(body, strains, Some(&near))?);
            }
        } else if !others.is_empty() {
            let moved = self.moved(first, others, &states[0])?;
            states.extend(moved);
        }
        Ok(states)
    }

    /// The states of laws that differ little from the one of a state between the same bars, by a step of Newton's method with its tangent.
    fn moved(
        &mut self,
        first: &Body,
        others: &[Body],
        state: &SheetState,
    ) -> Result<Vec<SheetState>, SolveFault> {
        let mesh = &self.sheet.mesh;
        let problem = |body: &Body| self.sheet.problem(&body.law, state.bars);
        let first_problem = problem(first);
        let model = first_problem
            .on(mesh, &first.energy)
            .expect("the groups of the shape");
        let describe = |element| model.describe(element);
        let potential = model.potential(1.0, &[]);
        self.newton
            .tangent
            .at(&*potential, &state.field, &describe)?;
        self.factorised = Some(state.bars);
        let mut states = Vec::new();
        for body in others {
            let problem = problem(body);
            let model = problem
                .on(mesh, &body.energy)
                .expect("the groups of the shape");
            let mut residual = vec![0.0; state.field.len()];
            let potential = model.potential(1.0, &[]);
            Assembly::residual(&*potential, &state.field, &mut residual)
                .map_err(|fault| fault.named(describe))?;
            let change = self.newton.tangent.changes(&[residual])?;
            let mut field = moved(&state.field, 1.0, &change[0]);
            model.impose(1.0, &mut field);
            states.push(self.seen(body, state.bars, field));
        }
        Ok(states)
    }

    /// The state at some strains of the bars, or of the markers where these were measured.
    fn state(
        &mut self,
        body: &Body,
        strains: [f64; 2],
        near: Option<&SheetState>,
    ) -> Result<SheetState, SolveFault> {
        if self.sheet.mounting.markers.is_none() {
            return self.at_bars(body, strains, near);
        }
        /// Strains of the markers are reached this closely.
        const CLOSE: f64 = 1e-7;
        const MOST: usize = 20;
        /// Where a step covers less of what it should, the derivatives are taken anew.
        const SERVES: f64 = 0.5;
        let target = Vector2::from(strains);
        let missing = |state: &SheetState| target - Vector2::from(state.middle);
        let begin = near.map_or(strains, |near| {
            let bars = Vector2::from(near.bars);
            let step = self.markers.and_then(|markers| markers.step(missing(near)));
            (bars + step.unwrap_or_else(|| missing(near))).into()
        });
        let mut state = self.at_bars(body, begin, near)?;
        let mut share = 1.0_f64;
        // The derivatives at the state, once they were taken: they serve shorter steps from it too.
        let mut exact: Option<Markers> = None;
        for _ in 0..MOST {
            let far = missing(&state);
            if far.amax() < CLOSE {
                return Ok(state);
            }
            let markers = match self.markers.take().or(exact) {
                Some(markers) => markers,
                None => *exact.insert(self.markers_by_differences(body, &state)?),
            };
            let step = share * markers.step(far).unwrap_or(far);
            let bars = Vector2::from(state.bars) + step;
            let reached = self.at_bars(body, bars.into(), Some(&state));
            let Some(next) = reached
                .ok()
                .filter(|next| missing(next).norm() < far.norm())
            else {
                share *= 0.5;
                continue;
            };
            let remaining = missing(&next).norm() / far.norm();
            self.markers = (remaining < 1.0 - SERVES * share)
                .then(|| markers.updated(step, far - missing(&next)));
            (state, share, exact) = (next, (2.0 * share).min(1.0), None);
        }
        let missing = missing(&state).amax();
        if missing < CLOSE {
            return Ok(state);
        }
        Err(SolveFault::MarkersMissed { missing })
    }

    /// How the markers follow the bars about a state.
    fn markers_by_differences(
        &mut self,
        body: &Body,
        state: &SheetState,
    ) -> Result<Markers, SolveFault> {
        /// So close that the tangent of the state serves.
        const STEP: f64 = 0.5 * NEARBY;
        let mut columns = [Vector2::<f64>::zeros(); 2];
        for axis in [0, 1] {
            let mut bars = state.bars;
            bars[axis] += STEP;
            let moved = self.at_bars(body, bars, Some(state))?;
            columns[axis] = (Vector2::from(moved.middle) - Vector2::from(state.middle)) / STEP;
        }
        Ok(Markers(Matrix2::from_columns(&columns)))
    }

    /// The state at some strains of the bars, from a state nearby, in shorter steps where it is not reached in one.
    fn at_bars(
        &mut self,
        body: &Body,
        bars: [f64; 2],
        near: Option<&SheetState>,
    ) -> Result<SheetState, SolveFault> {
        const SHORTEST: f64 = 1.0 / 16.0;
        let at_rest = vec![0.0; 2 * self.sheet.mesh.nodes.len()];
        if bars == [0.0; 2] && body.is_at_rest {
            return Ok(SheetState {
                stresses: [0.0; 2],
                middle: [0.0; 2],
                bars,
                field: at_rest,
            });
        }
        let (mut at, mut field) =
            near.map_or(([0.0; 2], at_rest), |near| (near.bars, near.field.clone()));
        let (begin, mut reached, mut step) = (at, 0.0, 1.0);
        loop {
            let share = f64::min(1.0, reached + step);
            let target = [0, 1].map(|axis| begin[axis] + share * (bars[axis] - begin[axis]));
            match self.step(body, target, at, &field) {
                Ok(state) if share >= 1.0 => return Ok(state),
                Ok(state) => (at, reached, field) = (target, share, state.field),
                Err(fault) if step <= SHORTEST => return Err(fault),
                Err(_) => step *= 0.5,
            }
        }
    }

    /// One equilibrium, from a field at other strains of the bars, by the tangent there; from the same strains by the tangent taken last.
    fn step(
        &mut self,
        body: &Body,
        bars: [f64; 2],
        from: [f64; 2],
        field: &[f64],
    ) -> Result<SheetState, SolveFault> {
        let mesh = &self.sheet.mesh;
        let problem = self.sheet.problem(&body.law, bars);
        let built = problem.on(mesh, &body.energy);
        let model = built.expect("the groups of the shape");
        let potential = model.potential(1.0, &[]);
        let describe = |element| model.describe(element);
        let mut reached = field.to_vec();
        model.impose(1.0, &mut reached);
        let mut residual = vec![0.0; reached.len()];
        let is_near =
            |other: [f64; 2]| (0..2).all(|axis| (bars[axis] - other[axis]).abs() < NEARBY);
        let factorised = self.factorised.take();
        let newton = &mut self.newton;
        if factorised.is_some_and(is_near) {
            newton.solve_near(&*potential, &mut reached, &mut residual, NEWTON, &describe)?;
        } else if is_near(from) {
            newton.solve(&*potential, &mut reached, &mut residual, NEWTON, &describe)?;
        } else {
            let motion = difference(&reached, field);
            let change = newton
                .tangent
                .predict(&*potential, field, &motion, &describe)?;
            reached = moved(field, 1.0, &change);
            model.impose(1.0, &mut reached);
            newton.solve(&*potential, &mut reached, &mut residual, NEWTON, &describe)?;
        }
        model.impose(1.0, &mut reached);
        self.factorised = Some(bars);
        Ok(self.seen(body, bars, reached))
    }

    /// What is seen of an equilibrium.
    fn seen(&self, body: &Body, bars: [f64; 2], field: Vec<f64>) -> SheetState {
        let sheet = self.sheet;
        let mut forces = vec![0.0; field.len()];
        let admissible = Assembly::residual(&body.energy, &field, &mut forces).is_ok();
        let stress = |axis: usize| {
            let nodes = sheet.pulled[axis].iter();
            let force: f64 = nodes.map(|node| forces[2 * node + axis]).sum();
            force / sheet.mounting.areas[axis]
        };
        let stresses = if admissible {
            [stress(0), stress(1)]
        } else {
            [f64::NAN; 2]
        };
        SheetState {
            stresses,
            middle: sheet.middle(&field),
            bars,
            field,
        }
    }
}

fn fault_at([first, second]: [f64; 2], fault: SolveFault) -> Error {
    let model = match fault {
        SolveFault::MarkersMissed { .. } => "search for the strains of the bars",
        _ => "finite elements of the mounted sheet",
    };
    Error::Solve {
        model: model.into(),
        step: format!("strains of {first:.4} and {second:.4}"),
        fault,
    }
}
