//! What of a recorded signal can be measured.

/// The share of a signal's largest value below which a deviation is no evidence against a body: sensors are not more linear, and splines of
/// a motion without noise not more exact.
pub const RESOLUTION: f64 = 1e-3;

/// The largest magnitude of a signal.
pub fn largest(signal: &[f64]) -> f64 {
    signal.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Whether the residuals of a signal are larger than sensors are linear and splines exact.
pub fn exceeds_resolution(measured: &[f64], fitted: &[f64]) -> bool {
    let squares = measured.iter().zip(fitted).map(|(a, b)| (a - b).powi(2));
    let mean_square = squares.sum::<f64>() / measured.len() as f64;
    mean_square.sqrt() > RESOLUTION * largest(measured)
}
