//! Interpolation of a motion between the instants that are kept.

/// Parts of the interval from one instant to the next.
pub const PARTS: usize = 12;

/// The largest difference of the mean velocity of an interval from the mean of the velocities at its ends, over the largest of the three: that of
/// a sine with five instants a period.
const FAR: f64 = 0.15;

/// The cubic that has the displacement and the velocity of both ends of an interval of h s:
///
/// ```text
/// x(s) = (1 + 2s)(1 − s)² x₀ + s(1 − s)² h v₀ + s²(3 − 2s) x₁ − s²(1 − s) h v₁,   s = (t − t₀)/h
/// ```
pub fn cubic(s: f64, h: f64, [[x0, v0], [x1, v1]]: [[f64; 2]; 2]) -> f64 {
    let r = 1.0 - s;
    let before = r * r * (1.0 + 2.0 * s) * x0 + h * s * r * r * v0;
    before + (s * s * (1.0 + 2.0 * r) * x1 - h * s * s * r * v1)
}

/// Times in s, displacements in mm and velocities in mm/s at the instants and between them, on cubics, and on straight lines where the
/// instants are too far apart for a cubic: where the mean of both velocities is not that of the interval.
pub fn with_cubics(instants: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let between = instants.windows(2).flat_map(|pair| {
        let [[t0, x0, v0], [t1, x1, v1]] = [pair[0], pair[1]];
        let h = t1 - t0;
        let slope = (x1 - x0) / h;
        let fastest = slope.abs().max(v0.abs()).max(v1.abs());
        let is_smooth = (slope - 0.5 * (v0 + v1)).abs() <= FAR * fastest;
        (0..PARTS).map(move |part| {
            let s = part as f64 / PARTS as f64;
            let r = 1.0 - s;
            if !is_smooth {
                return [t0 + s * h, r * x0 + s * x1, r * v0 + s * v1];
            }
            let x = cubic(s, h, [[x0, v0], [x1, v1]]);
            let v =
                6.0 * s * r * (x1 - x0) / h + r * (1.0 - 3.0 * s) * v0 + s * (3.0 * s - 2.0) * v1;
            [t0 + s * h, x, v]
        })
    });
    between.chain(instants.last().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp that begins and ends between instants.
    #[test]
    fn instants_that_are_far_apart_are_joined_by_straight_lines() {
        let points = with_cubics(&[[0.0, 0.0, 0.0], [1.0, 8.0, 30.0], [2.0, 15.0, 0.0]]);
        let most = points.iter().fold(0.0, |most: f64, [_, x, _]| most.max(*x));
        assert!((most - 15.0).abs() < 1e-12, "{most}");
    }

    #[test]
    fn a_cubic_is_itself_and_an_oscillation_is_met_to_a_thousandth() {
        let cubic = |t: f64| [t, 2.0 - t + 3.0 * t * t * t, -1.0 + 9.0 * t * t];
        for [t, x, v] in with_cubics(&[0.0, 0.3, 1.0].map(cubic)) {
            let [_, there, slope] = cubic(t);
            assert!(
                (x - there).abs() < 1e-12 && (v - slope).abs() < 1e-12,
                "{t}"
            );
        }
        let twenty_a_period: Vec<_> = (0..=20)
            .map(|i| f64::from(i) * std::f64::consts::TAU / 20.0)
            .map(|t| [t, t.sin(), t.cos()])
            .collect();
        let points = with_cubics(&twenty_a_period);
        assert_eq!(points.len(), 20 * PARTS + 1);
        for [t, x, v] in points {
            assert!(
                (x - t.sin()).abs() < 1e-4 && (v - t.cos()).abs() < 1e-3,
                "{t}"
            );
        }
    }
}
