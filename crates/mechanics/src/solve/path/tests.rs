use super::*;
use crate::solve::{Connectivity, Evaluated, Inadmissible, Local};

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 30,
};

/// One unknown with the energy Π(u) − s u.
struct Point {
    /// Π, ∂Π/∂u and ∂²Π/∂u² at u; nothing where the load factor s may not be.
    energy: fn(u: f64, s: f64) -> Option<[f64; 3]>,
}

struct Loaded<'a>(&'a Point, f64);

impl Potential for Loaded<'_> {
    fn connectivity(&self) -> &Connectivity {
        Connectivity::single()
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        let [energy, force, stiffness] =
            (self.0.energy)(u[0], self.1).ok_or(Inadmissible { element })?;
        local.residual[0] = force - self.1;
        if let Some(entry) = local.stiffness {
            entry[0] = stiffness;
        }
        Ok(energy - self.1 * u[0])
    }
}

impl Loading for Point {
    fn held(&self) -> Vec<bool> {
        vec![false]
    }

    fn impose(&self, _: f64, _: &mut [f64]) {}

    fn potential<'a>(&'a self, factor: f64, _: &'a [f64]) -> Box<dyn Potential + 'a> {
        Box::new(Loaded(self, factor))
    }

    fn guess(&self, _: f64, _: Option<&State>) -> Option<Vec<f64>> {
        None
    }

    fn describe(&self, _: usize) -> String {
        "the point".into()
    }

    fn describe_unknown(&self, _: usize) -> String {
        "its place".into()
    }
}

fn solve(point: &Point, factors: &[f64]) -> Result<Vec<State>, PathEnd> {
    follow(point, factors, NEWTON, Attendance::reporting(&|_| ()))
}

/// A linear spring that bears steps up to 0.2 as far as u = 0.5, and any beyond.
fn cautious(u: f64, s: f64) -> Option<[f64; 3]> {
    let near = u > 0.5 || (u - s).abs() <= 0.2;
    near.then_some([0.5 * u * u, u, 1.0])
}

#[test]
fn steps_are_halved_where_they_must_and_grow_again() {
    let point = Point { energy: cautious };
    let states = solve(&point, &[10.0, 20.0]).unwrap();
    assert_eq!(states.len(), 2);
    assert!((states[1].displacement[0] - 20.0).abs() < 1e-12);
    // 10/64 four times, then doubled from step to step; without growth 64 steps.
    let steps = states[0].load_steps;
    assert!(steps > 6 && steps < 16, "{steps}");
    assert!(states[1].load_steps <= 3, "{}", states[1].load_steps);
}

#[test]
fn a_path_to_negative_factors_is_halved_as_one_to_positive_ones() {
    let mirrored = |u: f64, s: f64| {
        cautious(-u, -s).map(|[energy, force, stiffness]| [energy, -force, stiffness])
    };
    let point = Point { energy: mirrored };
    let states = solve(&point, &[-10.0, -20.0]).unwrap();
    assert!((states[1].displacement[0] + 20.0).abs() < 1e-12);
    let steps = states[0].load_steps;
    assert!(steps > 6 && steps < 16, "{steps}");
}

/// A maximum far below the load that is wanted is found as exactly as one near by.
#[test]
fn a_maximum_far_below_the_wanted_load_is_named() {
    let point = Point {
        energy: |u, _| Some([0.5 * u * u - u.powi(3) / 6.0, u - 0.5 * u * u, 1.0 - u]),
    };
    let end = solve(&point, &[1000.0]).unwrap_err();
    let reached = end.reached();
    assert!(reached <= 0.5 && reached > 0.5 - 2e-3, "{reached}");
    assert!(
        matches!(end.fault, SolveFault::LoadMaximum { .. }),
        "{}",
        end.fault
    );
}

/// The force 3 u − 3 u² + 0.8 u³ has a maximum of 0.9045 at u = 0.691, and bears more beyond u = 2.4.
#[test]
fn a_path_does_not_snap_to_another_branch_without_a_word() {
    let point = Point {
        energy: |u, _| {
            Some([
                1.5 * u * u - u.powi(3) + 0.2 * u.powi(4),
                3.0 * u - 3.0 * u * u + 0.8 * u.powi(3),
                3.0 - 6.0 * u + 2.4 * u * u,
            ])
        },
    };
    for factors in [&[2.0][..], &[0.5, 2.0], &[0.9, 1.0]] {
        match solve(&point, factors) {
            Ok(states) => {
                let snapped = states.iter().map(|state| state.convergence.snaps);
                assert_eq!(snapped.sum::<usize>(), 1, "{factors:?}");
            }
            Err(end) => {
                let reached = end.reached();
                assert!(reached <= 0.9046 && reached > 0.9, "{factors:?} {reached}");
            }
        }
    }
}

/// The force u − u²/2 has its maximum ½ at u = 1.
#[test]
fn a_path_comes_near_to_the_maximum_of_its_load_and_names_it() {
    let point = Point {
        energy: |u, _| Some([0.5 * u * u - u.powi(3) / 6.0, u - 0.5 * u * u, 1.0 - u]),
    };
    let end = solve(&point, &[0.25, 0.7]).unwrap_err();
    assert_eq!(end.states.len(), 1);
    let last = end.last.clone().expect("an equilibrium beyond 0.25");
    assert!(
        last.factor <= 0.5 && last.factor > 0.5 - 2e-3,
        "{}",
        last.factor
    );
    assert!((last.displacement[0] - (1.0 - (1.0 - 2.0 * last.factor).sqrt())).abs() < 1e-7);
    assert_eq!(
        end.describe(),
        format!("load factor 0.7 (reached {:.4})", last.factor)
    );
    assert_eq!(
        end.fault,
        SolveFault::LoadMaximum {
            factor: last.factor,
            position: "its place".into(),
        }
    );
}

/// A spring of negative stiffness, −½ u², has no stable equilibrium whatever the load: that is no buckling under it.
#[test]
fn a_body_that_is_not_stable_at_rest_is_told_so() {
    let negative = |u: f64, _: f64| Some([-0.5 * u * u, -u, -1.0]);
    let point = Point { energy: negative };
    let end = solve(&point, &[0.1]).unwrap_err();
    let position = "its place".to_owned();
    assert_eq!(end.fault, SolveFault::UnstableAtRest { position });
}

#[test]
fn a_path_may_lead_back_to_rest_and_on_or_end_there() {
    let point = Point { energy: cautious };
    let states = solve(&point, &[0.4, 0.0, 0.3]).unwrap();
    let positions = states.iter().map(|state| state.displacement[0]);
    for (position, expected) in positions.zip([0.4, 0.0, 0.3]) {
        assert!((position - expected).abs() < 1e-12, "{position} {expected}");
    }
    let never = Point {
        energy: |u, s| (s > 0.2).then_some([0.5 * u * u, u, 1.0]),
    };
    let end = solve(&never, &[0.0]).unwrap_err();
    assert_eq!(end.reached(), 0.0);
    let end = solve(&never, &[0.5, 0.0]).unwrap_err();
    assert!(end.reached() > 0.2 && end.reached() < 0.21, "{end}");
}
