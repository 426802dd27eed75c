//! The finite elements as quick as gelbench's own parts allow: ordering and symbolic factorisation once, the best guess at hand, no line
//! search where none is needed, and no more Newton iterations than the mesh is worth.
//!
//! With a factor of every tangent the iteration ends when the square of a step, relative to the size of the field, is below a tenth of
//! the mesh's own error e or, where the field would then not be as accurate as that of the mesh's exact solution, of a tenth of e,
//! and so on (see `measure.rs`); coarser meshes have three times the error of the next finer one, at least. Where these steps lead
//! nowhere, load steps with a line search take their place.

use gelbench::error::Error;
use gelbench::mesh::{Interpolation, Mesh};
use gelbench::problem::{BoundaryProblem, Model};
use gelbench::solve::{
    Assembly, Cholesky, Convergence, Ladder, LinearSolver, Loading, Newton, NewtonSettings,
    Remembering, State,
};

/// Where load steps are needed.
const STEPS: NewtonSettings = NewtonSettings {
    tolerance: 1e-6,
    max_iterations: 40,
};
/// How many times as large the error of a mesh with cells of twice the size is, at least about.
const COARSER: f64 = 3.0;
/// Error on coarse meshes that is exact enough for the next finer one.
const LARGEST_ERROR: f64 = 0.03;
/// Newton iterations at most.
const ITERATIONS: usize = 12;
/// Halves of a step that turns cells over, at most.
const HALVES: usize = 6;

/// A field on the last of some meshes.
pub struct Found {
    pub u: Vec<f64>,
    /// Newton iterations on the last mesh.
    pub iterations: usize,
}

/// The problem on a mesh with the energy of its finite elements.
fn on<'a>(
    problem: &BoundaryProblem,
    mesh: &'a Mesh,
    energy: &'a dyn Remembering,
) -> Result<Model<'a>, Error> {
    let model = problem.on(mesh, energy);
    model.map_err(|fault| Error::Input(vec![fault]))
}

/// With a factor of every tangent from mesh to mesh; the error is that of the last mesh, relative to the size of the field, as the way
/// there takes it and as the last mesh does.
pub fn nested(
    problem: &BoundaryProblem,
    meshes: &[Mesh],
    [error, last]: [f64; 2],
) -> Result<Found, Error> {
    let mut found: Option<Found> = None;
    for (level, mesh) in meshes.iter().enumerate() {
        let energy = problem.finite_elements(mesh);
        let model = on(problem, mesh, &energy)?;
        found = Some(match found.take() {
            None => by_steps(&model, STEPS)?,
            Some(coarser) => {
                let finer = (meshes.len() - 1 - level) as i32;
                let error = match finer {
                    0 => last,
                    _ => LARGEST_ERROR.min(error * COARSER.powi(finer)),
                };
                let coarse = &meshes[level - 1];
                let mut u = coarse.interpolation_on(mesh).apply(&coarser.u);
                model.impose(1.0, &mut u);
                match newton(&model, &mut u, error) {
                    Some(iterations) => Found { u, iterations },
                    None => by_steps(&model.near(coarse, &[state(coarser.u)]), STEPS)?,
                }
            }
        });
    }
    Ok(found.expect("a mesh"))
}

/// A field as the state at load factor 1.
fn state(u: Vec<f64>) -> State {
    State {
        factor: 1.0,
        residual: vec![0.0; u.len()],
        displacement: u,
        history: Vec::new(),
        load_steps: 1,
        convergence: Convergence::default(),
    }
}

/// With a factor of every tangent on one mesh; `None` where that leads nowhere. Begun with the uniform stretch of a specimen of so many mm
/// between its grips, or with what the tangent at rest predicts.
pub fn on_one_mesh(
    problem: &BoundaryProblem,
    mesh: &Mesh,
    error: f64,
    gripped: Option<f64>,
) -> Result<Option<Found>, Error> {
    let energy = problem.finite_elements(mesh);
    let model = on(problem, mesh, &energy)?;
    let mut u = vec![0.0; 2 * mesh.nodes.len()];
    if let Some(length) = gripped {
        model.impose(1.0, &mut u);
        let drawn = u.iter().fold(0.0, |most: f64, u| most.max(*u));
        let stretch = 1.0 + drawn / length;
        let middle = mesh.middle()[1];
        for (u, [x, y]) in u.chunks_exact_mut(2).zip(&mesh.nodes) {
            u.copy_from_slice(&[
                (stretch - 1.0) * x,
                (stretch.powf(-0.5) - 1.0) * (y - middle),
            ]);
        }
    }
    let iterations = newton(&model, &mut u, error);
    Ok(iterations.map(|iterations| Found { u, iterations }))
}

/// The same with a line search, and in load steps where it must.
pub fn in_steps(problem: &BoundaryProblem, mesh: &Mesh, tolerance: f64) -> Result<Found, Error> {
    let energy = problem.finite_elements(mesh);
    let model = on(problem, mesh, &energy)?.solved_by(LinearSolver::Direct);
    let settings = NewtonSettings { tolerance, ..STEPS };
    by_steps(&model, settings).or_else(|_| by_steps(&model, STEPS))
}

fn by_steps(model: &Model, settings: NewtonSettings) -> Result<Found, Error> {
    let states = model.solve(&[1.0], settings, &|_| ());
    let state = states.map_err(|end| model.error(&end))?.swap_remove(0);
    Ok(Found {
        iterations: state.convergence.iterations(),
        u: state.displacement,
    })
}

/// Makes a field as exact as rounding allows, by Newton's method with factors.
pub fn polished(problem: &BoundaryProblem, mesh: &Mesh, u: Vec<f64>) -> Result<Vec<f64>, Error> {
    let energy = problem.finite_elements(mesh);
    let model = on(problem, mesh, &energy)?;
    let mut exact = u;
    match newton(&model, &mut exact, 1e-15) {
        Some(_) => Ok(exact),
        None => Ok(by_steps(&model, STEPS)?.u),
    }
}

/// Newton's iteration with factors until a step's square is below a tenth of the error; `None` where it leads nowhere. Held unknowns
/// that are not in their place yet are moved there with the first step.
fn newton(model: &Model, u: &mut [f64], error: f64) -> Option<usize> {
    let potential = model.potential(1.0, &[]);
    let assembly = Assembly::new(&*potential, &model.held());
    let mut cholesky = assembly.analyse().ok()?;
    let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
    let linearise = |u: &[f64], residual: &mut [f64], stiffness: &mut Vec<f64>| {
        let found = assembly.linearise(&*potential, u, residual, stiffness);
        found.ok()
    };
    let mut imposed = u.to_vec();
    model.impose(1.0, &mut imposed);
    let motion: Vec<f64> = imposed
        .iter()
        .zip(&*u)
        .map(|(to, from)| to - from)
        .collect();
    let mut admissible = linearise(u, &mut residual, &mut stiffness);
    let mut step = Vec::new();
    for iteration in 1..=ITERATIONS {
        let mut halves = 0;
        while admissible.is_none() && !step.is_empty() && halves < HALVES {
            step.iter_mut().for_each(|step: &mut f64| *step *= 0.5);
            add(assembly.free(), &step, -1.0, u);
            admissible = linearise(u, &mut residual, &mut stiffness);
            halves += 1;
        }
        admissible?;
        if iteration == 1 && motion.iter().any(|motion| *motion != 0.0) {
            Assembly::add_product(&*potential, u, &motion, &mut residual).ok()?;
            u.iter_mut().zip(&motion).for_each(|(u, by)| *u += by);
        }
        step = solved(&mut cholesky, &assembly, &stiffness, &residual)?;
        add(assembly.free(), &step, 1.0, u);
        let share = norm(&step) / norm(u);
        if share * share <= 0.1 * error {
            // The reactions.
            Assembly::residual(&*potential, u, &mut residual).ok()?;
            return Some(iteration);
        }
        if iteration < ITERATIONS {
            admissible = linearise(u, &mut residual, &mut stiffness);
        }
    }
    None
}

/// −K⁻¹ r of the free unknowns; `None` where the tangent is not positive definite.
fn solved(
    cholesky: &mut Cholesky,
    assembly: &Assembly,
    stiffness: &[f64],
    residual: &[f64],
) -> Option<Vec<f64>> {
    cholesky.factorise(stiffness).ok()?;
    let free = assembly.free().iter();
    let mut step: Vec<f64> = free.map(|unknown| -residual[*unknown]).collect();
    cholesky.substitute(&mut step);
    step.iter().all(|step| step.is_finite()).then_some(step)
}

fn add(free: &[usize], step: &[f64], times: f64, u: &mut [f64]) {
    for (unknown, step) in free.iter().zip(step) {
        u[*unknown] += times * step;
    }
}

fn norm(field: &[f64]) -> f64 {
    field.iter().map(|u| u * u).sum::<f64>().sqrt()
}

/// Newton's method with the climb's own multigrid, over the tangents of the coarser meshes, from mesh to mesh: a tangent for every step,
/// until the imbalance is below `tolerance` of the largest reaction.
pub fn by_multigrid(
    problem: &BoundaryProblem,
    meshes: &[Mesh],
    tolerance: f64,
) -> Result<Found, Error> {
    let settings = NewtonSettings { tolerance, ..STEPS };
    let energy = problem.finite_elements(&meshes[0]);
    let model = on(problem, &meshes[0], &energy)?;
    let mut found = by_steps(&model, STEPS)?;
    let potential = model.potential(1.0, &[]);
    let mut ladder = Ladder::begin(&*potential, &model.held(), &found.u);
    for pair in meshes.windows(2) {
        let energy = problem.finite_elements(&pair[1]);
        let model = on(problem, &pair[1], &energy)?.solved_by(LinearSolver::Multigrid);
        let potential = model.potential(1.0, &[]);
        let interpolation = pair[0].interpolation_on(&pair[1]);
        let mut u = interpolation.apply(&found.u);
        model.impose(1.0, &mut u);
        let solver = LinearSolver::Multigrid;
        let newton = match ladder.take() {
            Some(own) => {
                let carry = carrying(&interpolation);
                Newton::above(&*potential, &model.held(), own, &carry)
            }
            None => Newton::with_solver(&*potential, &model.held(), solver),
        };
        let solve = |mut newton: Newton| {
            let mut residual = vec![0.0; u.len()];
            let describe = |element: usize| model.describe(element);
            let log = newton.solve(&*potential, &mut u, &mut residual, settings, &describe);
            log.ok().map(|log| (log.iterations(), newton))
        };
        (found, ladder) = match newton.ok().and_then(solve) {
            Some((iterations, newton)) => (Found { u, iterations }, newton.into_ladder()),
            None => (by_steps(&model, STEPS)?, None),
        };
    }
    Ok(found)
}

/// Writes the unknowns of the coarser mesh, with their shares, that an unknown of the finer one is made of.
fn carrying(interpolation: &Interpolation) -> impl Fn(usize, &mut Vec<(usize, f64)>) + '_ {
    |unknown, terms| {
        let nodes = interpolation.of(unknown / 2);
        terms.extend(nodes.map(|(node, share)| (2 * node + unknown % 2, share)));
    }
}
