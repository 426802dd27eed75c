//! Many states: a path of a hundred stretches, and grips in the hand.

use std::time::Instant;

use gelbench::corrector::DifferenceScheme;
use gelbench::corrector::climb::{Climb, ClimbSettings, Grips, Interactive};
use gelbench::error::Error;
use gelbench::finite_element::FiniteElements;
use gelbench::problem::ClampedPlate;
use gelbench::solve::NewtonSettings;
use gelbench_mechanics::problem::RigidMotion;

use super::opponent::Opponent;
use super::way::{self, Layout};

/// Times of a path in s, shortest of several runs.
pub struct PathTimes {
    pub scheme: DifferenceScheme,
    pub states: usize,
    pub climb: f64,
    /// The built-in finite elements, each state from the one before, scaled.
    pub built_in: f64,
    /// The tuned ones, each state extrapolated from the three before.
    pub tuned: f64,
    /// Their Newton iterations in all.
    pub iterations: usize,
    /// The largest deviation of the climb's force from the tuned finite elements' in percent.
    pub force_percent: f64,
}

/// States that the finite elements' next guess is extrapolated from.
const HISTORY: usize = 3;
const REPETITIONS: usize = 5;

/// Follows a path in all three ways, side by side. `error` is the mesh's own error at the last stretch.
pub fn path(
    problem: &ClampedPlate,
    cells: [usize; 2],
    scheme: DifferenceScheme,
    stretches: &[f64],
    error: f64,
) -> Result<PathTimes, Error> {
    let mut times = PathTimes {
        scheme,
        states: stretches.len(),
        climb: f64::INFINITY,
        built_in: f64::INFINITY,
        tuned: f64::INFINITY,
        iterations: 0,
        force_percent: 0.0,
    };
    for _ in 0..REPETITIONS {
        let start = Instant::now();
        let mut forces = Vec::new();
        let mut climb = Climb::even(problem, cells, scheme, ClimbSettings::FAST);
        climb.follow(stretches, &mut |climbed| forces.push(climbed.force))?;
        times.climb = times.climb.min(start.elapsed().as_secs_f64());

        let start = Instant::now();
        let (expected, iterations) = tuned(problem, cells, scheme, stretches, error);
        times.tuned = times.tuned.min(start.elapsed().as_secs_f64());
        times.iterations = iterations;
        let pairs = forces.iter().zip(&expected);
        let largest = pairs.map(|(own, expected)| 100.0 * (own / expected - 1.0).abs());
        times.force_percent = largest.fold(0.0, f64::max);

        let start = Instant::now();
        built_in(problem, cells, scheme, stretches)?;
        times.built_in = times.built_in.min(start.elapsed().as_secs_f64());
    }
    Ok(times)
}

fn built_in(
    problem: &ClampedPlate,
    cells: [usize; 2],
    scheme: DifferenceScheme,
    stretches: &[f64],
) -> Result<(), Error> {
    let problem = ClampedPlate {
        stretches: stretches.to_vec(),
        ..problem.clone()
    };
    let settings = NewtonSettings {
        tolerance: 1e-6,
        max_iterations: 20,
    };
    let elements = cells.map(|cells| cells / scheme.side());
    let model = FiniteElements::new(&problem, elements, way::built_in(scheme));
    model.solve(&problem, settings, &|_| ()).map(drop)
}

/// The forces and the number of iterations.
fn tuned(
    problem: &ClampedPlate,
    cells: [usize; 2],
    scheme: DifferenceScheme,
    stretches: &[f64],
    error: f64,
) -> (Vec<f64>, usize) {
    let mut opponent = Opponent::new(problem, Layout::equal(cells), scheme);
    let mut known: Vec<(f64, Vec<f64>)> = Vec::new();
    let (mut forces, mut iterations) = (Vec::new(), 0);
    for stretch in stretches.iter().copied() {
        let mut u = match known.len() {
            0 => opponent.start(super::opponent::Guess::Affine, stretch, error),
            _ => extrapolate(&known, stretch),
        };
        opponent.impose(stretch, &mut u);
        iterations += opponent.solve(&mut u, stretch, error);
        forces.push(opponent.force(&u));
        if known.len() == HISTORY {
            known.remove(0);
        }
        known.push((stretch, u));
    }
    (forces, iterations)
}

/// The polynomial through the known states and the state of rest where there are fewer than three.
fn extrapolate(known: &[(f64, Vec<f64>)], stretch: f64) -> Vec<f64> {
    let at_rest = known.len() < HISTORY;
    let mut u = vec![0.0; known[0].1.len()];
    for (own, (place, state)) in known.iter().enumerate() {
        let others = known.iter().enumerate().filter(|(other, _)| *other != own);
        let mut share: f64 = others
            .map(|(_, (other, _))| (stretch - other) / (place - other))
            .product();
        if at_rest {
            share *= stretch / place;
        }
        u.iter_mut()
            .zip(state)
            .for_each(|(u, state)| *u += share * state);
    }
    u
}

/// Times of the frames of a plate in the hand, in s.
pub struct Frames {
    pub nodes: usize,
    pub median: f64,
    pub worst: f64,
}

/// Moves the right grip by a few mm and turns it a little in every frame.
pub fn frames(problem: &ClampedPlate, cells: [usize; 2], count: usize) -> Result<Frames, Error> {
    let climb = Climb::even(
        problem,
        cells,
        DifferenceScheme::Biquadratic,
        ClimbSettings::FAST,
    );
    let nodes = climb.grid().nodes();
    let mut plate = Interactive::new(climb, 0.5)?;
    let mut times = Vec::with_capacity(count);
    let length = problem.size[0];
    for frame in 1..=count {
        let phase = 0.1 * frame as f64;
        let right = RigidMotion {
            displacement: [
                length * 0.5 + 30.0 * phase.sin(),
                20.0 * (1.0 - phase.cos()),
            ],
            angle: 0.2 * (0.7 * phase).sin(),
        };
        let start = Instant::now();
        plate.move_grips(Grips {
            right,
            ..plate.grips()
        })?;
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    Ok(Frames {
        nodes,
        median: times[count / 2],
        worst: times[count - 1],
    })
}
