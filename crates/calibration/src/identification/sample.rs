//! A recording that gelbench computes itself, with known functions.

use std::fmt::Write;

use super::recording::Recording;
use crate::statistics::normal_numbers;

/// A stiffening spring with a growing dashpot, shaken by a force of several frequencies:
///
/// ```text
/// K(x) = 0.15 + 0.05 e^(x/8 mm) N/mm,   D(x) = 0.004 + 0.0015 tanh(x/5 mm) N·s/mm,   m = 200 g
/// f(t) = 0.5 + 1.0 sin(2π 1.3 t) + 0.8 sin(2π 3.1 t + 1) + 0.6 sin(2π 5.3 t + 2) N
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Duration in s; the motion starts at rest a second before.
    pub duration: f64,
    /// Instants, the first and the last included.
    pub instants: usize,
    /// Standard deviation of the white noise on extension and on force, over their root mean squares.
    pub noise: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// 200 g.
const MASS: f64 = 2e-4;
const LENGTH: f64 = 50.0;

impl Default for Sample {
    fn default() -> Self {
        Self {
            duration: 4.0,
            instants: 1201,
            noise: 0.05,
            seed: 1,
        }
    }
}

impl Sample {
    /// K(x) in N/mm.
    pub fn stiffness(x: f64) -> f64 {
        0.15 + 0.05 * (x / 8.0).exp()
    }

    /// D(x) in N·s/mm.
    pub fn damping(x: f64) -> f64 {
        0.004 + 0.0015 * (x / 5.0).tanh()
    }

    fn force(t: f64) -> f64 {
        let sine = |amplitude: f64, frequency: f64, phase: f64| {
            amplitude * (std::f64::consts::TAU * frequency * t + phase).sin()
        };
        0.5 + sine(1.0, 1.3, 0.0) + sine(0.8, 3.1, 1.0) + sine(0.6, 5.3, 2.0)
    }

    /// Extension and force without noise, by the classical Runge–Kutta method of order 4.
    pub fn exact(&self) -> Recording {
        const SUBSTEPS: usize = 20;
        const BEFORE: f64 = 1.0;
        let rate = |t: f64, [x, v]: [f64; 2]| {
            [
                v,
                (Self::force(t) - Self::stiffness(x) * x - Self::damping(x) * v) / MASS,
            ]
        };
        let advance = |t: f64, y: [f64; 2], h: f64| {
            let along = |slope: [f64; 2], share: f64| {
                [y[0] + share * h * slope[0], y[1] + share * h * slope[1]]
            };
            let k1 = rate(t, y);
            let k2 = rate(t + 0.5 * h, along(k1, 0.5));
            let k3 = rate(t + 0.5 * h, along(k2, 0.5));
            let k4 = rate(t + h, along(k3, 1.0));
            [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
        };
        let step = self.duration / (self.instants - 1) as f64;
        let h = step / SUBSTEPS as f64;
        let mut y = [0.0; 2];
        let before = (BEFORE / h).round() as usize;
        let time = |n: usize| (n as f64 - before as f64) * h;
        (0..before).for_each(|n| y = advance(time(n), y, h));
        let mut recording = Recording {
            mass: MASS,
            length: Some(LENGTH),
            ..Recording::default()
        };
        for instant in 0..self.instants {
            let t = step * instant as f64;
            recording.times.push(t);
            recording.extension.push(y[0]);
            recording.force.push(Self::force(t));
            for n in 0..SUBSTEPS {
                y = advance(t + n as f64 * h, y, h);
            }
        }
        recording
    }

    /// The recording with its noise.
    pub fn recording(&self) -> Recording {
        let mut recording = self.exact();
        let mut normal = normal_numbers(self.seed);
        for signal in [&mut recording.extension, &mut recording.force] {
            let square =
                signal.iter().map(|value| value * value).sum::<f64>() / signal.len() as f64;
            for value in signal {
                *value += self.noise * square.sqrt() * normal();
            }
        }
        recording
    }

    /// The recording as a file.
    pub fn csv(&self) -> String {
        let recording = self.recording();
        let mut text = format!(
            "# source: gelbench identify --sample --seed {}: computed, with noise of {} % of the root mean square on both signals\n\
             # functions: K(x) = 0.15 + 0.05 exp(x/8 mm) N/mm, D(x) = 0.004 + 0.0015 tanh(x/5 mm) N s/mm\n\
             # mass: 200 g\n# length: 50 mm\ntime [s],extension [mm],force [N]\n",
            self.seed,
            100.0 * self.noise
        );
        for ((t, x), f) in recording
            .times
            .iter()
            .zip(&recording.extension)
            .zip(&recording.force)
        {
            let _ = writeln!(text, "{t:.6},{x:.5},{f:.6}");
        }
        text
    }
}
