//! Many states of a strip with a hole: a path of a hundred load factors, and grips in the hand.

use std::time::Instant;

use gelbench::corrector::climb::ClimbSettings;
use gelbench::corrector::shape_climb::{Climb, Interactive, ShapeClimb};
use gelbench::error::Error;
use gelbench::mesh::Mesh;
use gelbench::problem::{Grip, Model, RigidMotion};
use gelbench::solve::{LinearSolver, Loading, NewtonSettings, State, Tangent};

use super::shapes::Family;
use super::{SHARE, distance, timed};

/// States of the path.
const STATES: u32 = 100;
/// Runs in which all contestants take turns.
const REPETITIONS: usize = 3;
/// States that the next guess with a retained factor is extrapolated from.
const HISTORY: usize = 3;

/// As a laboratory solves it, and as near to the end as rounding allows.
const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-6,
    max_iterations: 40,
};
const EXACT: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 40,
};

/// Follows a path in all ways, side by side, and moves the right grip; whether no state of the climb differs from the direct path by more
/// than the allowed share of its discretisation error.
pub fn bench(family: &Family, levels: usize) -> Result<bool, Error> {
    let meshes = family.meshes(levels);
    let factors: Vec<f64> = (1..=STATES)
        .map(|step| f64::from(step) / f64::from(STATES))
        .collect();
    let exact = direct(family, &meshes[levels - 1], &factors, EXACT)?;
    let mut seconds = [f64::INFINITY; 4];
    let (mut paths, mut retained_by) = ([Vec::new(), Vec::new()], (Vec::new(), 0));
    for _ in 0..REPETITIONS {
        for (place, settings) in [ClimbSettings::FAST, ClimbSettings::default()]
            .into_iter()
            .enumerate()
        {
            paths[place] = timed(&mut seconds[place], || {
                climbed(family, &family.meshes(levels), &factors, settings)
            })?;
        }
        let errors: Vec<f64> = paths[0]
            .iter()
            .map(|own| own.discretisation_error)
            .collect();
        retained_by = timed(&mut seconds[2], || {
            let mesh = &family.meshes(levels)[levels - 1];
            retained(family, mesh, &factors, &errors)
        })?;
        timed(&mut seconds[3], || {
            let mesh = &family.meshes(levels)[levels - 1];
            direct(family, mesh, &factors, NEWTON)
        })?;
    }
    println!(
        "{}, {} nodes, {STATES} load factors: ms a state, and over that of the fast climb; the largest difference to the direct path \
         over the discretisation error",
        family.name(),
        meshes[levels - 1].nodes.len()
    );
    let names = [
        "fast climb",
        "climb",
        "retained factor, extrapolated",
        "direct",
    ];
    for (name, seconds_all) in names.iter().zip(seconds) {
        let ms = 1e3 * seconds_all / f64::from(STATES);
        println!("  {name:30} {ms:8.2}  {:5.1}", seconds_all / seconds[0]);
    }
    let mut passes = true;
    for (name, path) in names.iter().zip(&paths) {
        let shares = path.iter().zip(&exact).map(|(own, exact)| {
            distance(&own.state.displacement, &exact.displacement) / own.discretisation_error
        });
        let worst = shares.fold(0.0, f64::max);
        let sum = |pick: fn(&ShapeClimb) -> usize| -> usize { path.iter().map(pick).sum() };
        let last = |own: &ShapeClimb| *own.work.last().expect("a mesh");
        println!(
            "  {name}: largest difference {worst:.4}; {} iterations and {} tangents on the finest mesh, {} states with factors",
            sum(|own| own.work.last().map_or(0, |work| work.iterations)),
            sum(|own| own.work.last().map_or(0, |work| work.linearisations)),
            path.iter()
                .filter(|own| last(own).iterations == 0 && last(own).linearisations > 0)
                .count()
        );
        passes &= worst <= SHARE;
    }
    let shares = retained_by.0.iter().zip(&exact).zip(&paths[0]);
    let shares = shares.map(|((own, exact), climbed)| {
        distance(own, &exact.displacement) / climbed.discretisation_error
    });
    println!(
        "  {}: largest difference {:.4}; {} factors",
        names[2],
        shares.fold(0.0, f64::max),
        retained_by.1
    );
    frames(family, &meshes)?;
    Ok(passes)
}

fn climbed(
    family: &Family,
    meshes: &[Mesh],
    factors: &[f64],
    settings: ClimbSettings,
) -> Result<Vec<ShapeClimb>, Error> {
    let mut states = Vec::new();
    let mut climb = Climb::new(&family.case.problem, meshes, settings);
    climb.follow(factors, &mut |own| states.push(own.clone()))?;
    Ok(states)
}

fn direct(
    family: &Family,
    mesh: &Mesh,
    factors: &[f64],
    settings: NewtonSettings,
) -> Result<Vec<State>, Error> {
    let energy = family.case.problem.finite_elements(mesh);
    let model = model(family, mesh, &energy)?.solved_by(LinearSolver::Direct);
    let states = model.solve(factors, settings, &|_| ());
    states.map_err(|end| model.error(&end))
}

fn model<'a>(
    family: &Family,
    mesh: &'a Mesh,
    energy: &'a dyn gelbench::solve::Remembering,
) -> Result<Model<'a>, Error> {
    let found = family.case.problem.on(mesh, energy);
    found.map_err(|fault| Error::Input(vec![fault]))
}

/// Each state extrapolated from the three before, by Newton's method with the factor of an earlier state as long as it contracts by four;
/// until a step is below what the fast climb may leave. The fields, and how many factors were taken.
fn retained(
    family: &Family,
    mesh: &Mesh,
    factors: &[f64],
    errors: &[f64],
) -> Result<(Vec<Vec<f64>>, usize), Error> {
    let energy = family.case.problem.finite_elements(mesh);
    let model = model(family, mesh, &energy)?;
    let potential = model.potential(factors[0], &[]);
    let describe = |element: usize| model.describe(element);
    let solver = |fault| Error::Solve {
        model: "retained factor".into(),
        step: "the path".into(),
        fault,
    };
    let mut tangent =
        Tangent::new(&*potential, &model.held(), LinearSolver::Direct).map_err(solver)?;
    let first = model.reach(&factors[..1], EXACT)?;
    let mut fields = vec![first.displacement];
    let (mut taken, mut fresh) = (0, false);
    for (place, factor) in factors.iter().enumerate().skip(1) {
        let mut u = extrapolated(&fields, factors, place);
        model.impose(*factor, &mut u);
        let enough = ClimbSettings::FAST.tolerance * errors[place];
        let mut last = f64::INFINITY;
        loop {
            let potential = model.potential(*factor, &[]);
            let residual = if fresh || taken == 0 {
                taken += 1;
                fresh = false;
                last = f64::INFINITY;
                tangent.at(&*potential, &u, &describe).map_err(solver)?
            } else {
                let mut residual = vec![0.0; u.len()];
                let forces = potential.add_forces(&u, &mut residual);
                forces.expect("admissible");
                residual
            };
            let step = tangent.changes(&[residual]).map_err(solver)?.swap_remove(0);
            let size = distance(&step, &vec![0.0; step.len()]);
            u.iter_mut().zip(&step).for_each(|(u, step)| *u += step);
            if size <= enough {
                break;
            }
            fresh = size > 0.25 * last;
            last = size;
        }
        fields.push(u);
    }
    Ok((fields, taken))
}

fn extrapolated(fields: &[Vec<f64>], factors: &[f64], place: usize) -> Vec<f64> {
    let first = fields.len().saturating_sub(HISTORY);
    let known: Vec<f64> = factors[first..place].to_vec();
    let at_rest = known.len() < HISTORY;
    let mut u = vec![0.0; fields[0].len()];
    for (own, field) in known.iter().zip(&fields[first..]) {
        let others = known.iter().copied().chain(at_rest.then_some(0.0));
        let others = others.filter(|other| other != own);
        let share: f64 = others
            .map(|other| (factors[place] - other) / (own - other))
            .product();
        u.iter_mut()
            .zip(field)
            .for_each(|(u, field)| *u += share * field);
    }
    u
}

/// Moves the right grip by a few mm and turns it a little in every frame.
fn frames(family: &Family, meshes: &[Mesh]) -> Result<(), Error> {
    const FRAMES: usize = 60;
    let climb = Climb::new(&family.case.problem, meshes, ClimbSettings::FAST);
    let mut hand = Interactive::new(climb, 1.0)?;
    let begin = hand.at_group("right").displacement[0];
    let mut times = Vec::with_capacity(FRAMES);
    for frame in 1..=FRAMES {
        let phase = 0.1 * frame as f64;
        let right = RigidMotion {
            displacement: [begin + 10.0 * phase.sin(), 10.0 * (1.0 - phase.cos())],
            angle: 0.2 * (0.7 * phase).sin(),
        };
        let start = Instant::now();
        hand.move_grips(&[("right", Grip::Motion(right))])?;
        times.push(1e3 * start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    println!(
        "  {FRAMES} motions of the right grip by about 1 mm and 0.8°: {:.1} ms in the middle, {:.1} ms at worst",
        times[FRAMES / 2],
        times[FRAMES - 1]
    );
    Ok(())
}
