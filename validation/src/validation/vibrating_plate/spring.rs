//! A linear spring: ω = √(k/m) = 2 rad/s, and the order of its error in the step.

use std::f64::consts::TAU;

use super::motion::{METHODS, Run};
use crate::dynamics::spring::Spring;
use crate::dynamics::{Motion, Start};
use crate::error::Error;
use crate::validation::case::{Check, check};

/// Both methods.
pub fn checks() -> Result<Vec<Check>, Error> {
    let exact = 2.0 / TAU;
    let spring = Spring {
        k: 4.0,
        q: 0.0,
        c: 0.0,
    };
    let motion = Motion {
        energy: &spring,
        viscosity: None,
        mass: vec![1.0],
        supports: Vec::new(),
        forces: Vec::new(),
        start: Start::held_at(vec![1.0]),
        describe: Box::new(|_| "the spring".into()),
    };
    let mut checks = Vec::new();
    for (name, integrator) in METHODS {
        let error = |steps: usize| {
            let run = Run {
                integrator,
                step: 1.0 / (exact * steps as f64),
                count: 10 * steps + steps / 4,
                every: 1,
            };
            Ok::<f64, Error>((run.frequency(&motion, 0)? / exact - 1.0).abs())
        };
        let [coarse, fine, finest] = [error(100)?, error(200)?, error(4000)?];
        let what = "frequency of a linear spring, 4000 steps in a period, relative error";
        let order = (coarse / fine).log2();
        checks.extend([
            check(format!("{name}: {what}"), "–", finest).at_most(1e-6, "√(k/m)"),
            check(
                format!("{name}: order of that error in the step"),
                "–",
                order,
            )
            .equal(2.0, 2.0, "both methods are of second order"),
        ]);
    }
    Ok(checks)
}
