//! The time functions of supports and loads.

use std::f64::consts::TAU;

/// A dimensionless factor as a function of time.
#[derive(Clone, Debug, PartialEq)]
pub enum TimeFunction {
    /// A constant.
    Constant(f64),
    /// Linear from 0 at `begin` to 1 at `end`; both in s.
    Ramp {
        /// The time at which it begins to rise.
        begin: f64,
        /// The time at which it is complete.
        end: f64,
    },
    /// m + a sin(2π f t) from time 0 on; m before.
    Sine {
        /// m.
        mean: f64,
        /// a.
        amplitude: f64,
        /// f in Hz.
        frequency: f64,
    },
    /// Linear between points of ascending times in s, constant beyond them.
    Table(Vec<[f64; 2]>),
}

impl TimeFunction {
    /// Value, rate in 1/s and second derivative in 1/s² at a time in s, on the piece that begins at or before the
    /// time `within`: where the rate jumps, an earlier `within` selects the end of the piece before.
    pub fn at(&self, time: f64, within: f64) -> [f64; 3] {
        match self {
            Self::Constant(value) => [*value, 0.0, 0.0],
            Self::Ramp { begin, end } => between(&[[*begin, 0.0], [*end, 1.0]], time, within),
            Self::Sine {
                mean,
                amplitude,
                frequency,
            } if within >= 0.0 => {
                let omega = TAU * frequency;
                let (sine, cosine) = (omega * time).sin_cos();
                [
                    mean + amplitude * sine,
                    amplitude * omega * cosine,
                    -amplitude * omega * omega * sine,
                ]
            }
            Self::Sine { mean, .. } => [*mean, 0.0, 0.0],
            Self::Table(points) => between(points, time, within),
        }
    }

    /// The value at a time in s.
    pub fn value(&self, time: f64) -> f64 {
        self.at(time, time)[0]
    }

    /// The period in s; `None` for a function that does not oscillate.
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Sine { frequency, .. } => Some(1.0 / frequency),
            Self::Constant(_) | Self::Ramp { .. } | Self::Table(_) => None,
        }
    }

    /// The times in s at which the rate jumps.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Constant(_) | Self::Sine { .. } => Vec::new(),
            Self::Ramp { begin, end } => vec![*begin, *end],
            Self::Table(points) => points.iter().map(|[time, _]| *time).collect(),
        }
    }
}

fn between(points: &[[f64; 2]], time: f64, within: f64) -> [f64; 3] {
    let next = points.partition_point(|[begin, _]| *begin <= within);
    match (
        next.checked_sub(1).map(|last| points[last]),
        points.get(next),
    ) {
        (Some([from, low]), Some([to, high])) => {
            let rate = (high - low) / (to - from);
            [low + (time - from) * rate, rate, 0.0]
        }
        (Some([_, value]), None) | (None, Some(&[_, value])) => [value, 0.0, 0.0],
        (None, None) => [0.0; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_have_their_values_and_rates() {
        let ramp = TimeFunction::Ramp {
            begin: 1.0,
            end: 3.0,
        };
        assert_eq!(ramp.at(0.5, 0.5), [0.0; 3]);
        assert_eq!(ramp.at(1.0, 0.9), [0.0; 3]);
        assert_eq!(ramp.at(1.0, 1.0), [0.0, 0.5, 0.0]);
        assert_eq!(ramp.at(3.0, 2.9), [1.0, 0.5, 0.0]);
        assert_eq!(ramp.at(9.0, 9.0), [1.0, 0.0, 0.0]);
        assert_eq!(ramp.kinks(), [1.0, 3.0]);
        let table = TimeFunction::Table(vec![[0.0, 2.0], [1.0, 4.0], [3.0, 0.0]]);
        assert_eq!(table.at(2.0, 1.5), [2.0, -2.0, 0.0]);
        assert_eq!(table.kinks(), [0.0, 1.0, 3.0]);
        let sine = TimeFunction::Sine {
            mean: 0.3,
            amplitude: 2.0,
            frequency: 0.5,
        };
        assert_eq!(sine.value(0.0), 0.3);
        assert!((sine.value(0.5) - 2.3).abs() < 1e-15);
        let step = 1e-4;
        let [before, now, after] = [-step, 0.0, step].map(|d| sine.at(0.7 + d, 0.7));
        assert!(((after[0] - before[0]) / (2.0 * step) - now[1]).abs() < 1e-6);
        assert!(((after[1] - before[1]) / (2.0 * step) - now[2]).abs() < 1e-5);
    }
}
