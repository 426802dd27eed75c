//! Cubics between points that rise wherever the points rise, without overshoot.
//!
//! ```text
//! f(x₀ + s) = f₀ + s (d₀ + s (c₂ + s c₃)),   m = (f₁ − f₀)/h,   c₂ = (3 m − 2 d₀ − d₁)/h,   c₃ = (d₀ + d₁ − 2 m)/h²
//! ```
//!
//! # References
//! F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5, 300 (1984), doi:10.1137/0905021

/// The cubic of one interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic {
    begin: f64,
    /// d₀, c₂ and c₃.
    coefficients: [f64; 3],
}

impl Cubic {
    /// The cubic between two points (x, f) with slopes there.
    pub fn new([[from, low], [to, high]]: [[f64; 2]; 2], [begin, end]: [f64; 2]) -> Self {
        let h = to - from;
        let mean = (high - low) / h;
        let c2 = (3.0 * mean - 2.0 * begin - end) / h;
        let c3 = (begin + end - 2.0 * mean) / (h * h);
        Self {
            begin: low,
            coefficients: [begin, c2, c3],
        }
    }

    /// f at s from the first point.
    pub fn value(&self, s: f64) -> f64 {
        self.begin + s * self.secant(s)
    }

    /// ∂f/∂s.
    pub fn slope(&self, s: f64) -> f64 {
        let [first, c2, c3] = self.coefficients;
        first + s * (2.0 * c2 + 3.0 * s * c3)
    }

    /// (f − f₀)/s, without cancellation.
    pub fn secant(&self, s: f64) -> f64 {
        let [first, c2, c3] = self.coefficients;
        first + s * (c2 + s * c3)
    }

    /// ∂/∂s of the secant.
    pub fn secant_slope(&self, s: f64) -> f64 {
        let [_, c2, c3] = self.coefficients;
        c2 + 2.0 * c3 * s
    }

    /// ∫ f ds from the first point.
    pub fn integral(&self, s: f64) -> f64 {
        let [first, c2, c3] = self.coefficients;
        s * (self.begin + s * (first / 2.0 + s * (c2 / 3.0 + s * c3 / 4.0)))
    }
}

/// Slopes at the points: a weighted harmonic mean of the neighbours', zero at extrema.
pub fn slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let widths: Vec<f64> = points.windows(2).map(|p| p[1][0] - p[0][0]).collect();
    let means: Vec<f64> = points
        .windows(2)
        .zip(&widths)
        .map(|(p, h)| (p[1][1] - p[0][1]) / h)
        .collect();
    let last = means.len() - 1;
    if last == 0 {
        return vec![means[0]; 2];
    }
    let mut slopes = vec![end_slope(widths[0], widths[1], means[0], means[1])];
    for i in 1..=last {
        let (before, after) = (means[i - 1], means[i]);
        slopes.push(if before * after <= 0.0 {
            0.0
        } else {
            let (w1, w2) = (
                2.0 * widths[i] + widths[i - 1],
                widths[i] + 2.0 * widths[i - 1],
            );
            (w1 + w2) / (w1 / before + w2 / after)
        });
    }
    let end = end_slope(widths[last], widths[last - 1], means[last], means[last - 1]);
    slopes.push(end);
    slopes
}

/// Three-point slope at an end, limited so that the curve is monotone.
fn end_slope(h: f64, next_h: f64, mean: f64, next_mean: f64) -> f64 {
    let slope = ((2.0 * h + next_h) * mean - h * next_mean) / (h + next_h);
    if slope * mean <= 0.0 {
        // A curve with a flat start would have no modulus: the secant slope is taken instead.
        mean
    } else if mean * next_mean < 0.0 && slope.abs() > 3.0 * mean.abs() {
        3.0 * mean
    } else {
        slope
    }
}
