//! Grips in the hand.

use std::time::Instant;

use gelbench::corrector::DifferenceScheme;
use gelbench::corrector::climb::{Climb, ClimbSettings, Grips, Interactive};
use gelbench::error::Error;
use gelbench::problem::ClampedPlate;
use gelbench_mechanics::problem::RigidMotion;

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
