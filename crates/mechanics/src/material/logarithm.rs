//! The logarithm without branches, so that loops over many points are vectorised by the compiler.
//!
//! ```text
//! 1 + y = 2ᵏ (1 + f),   √½ ≤ 1 + f < √2,   ln(1 + f) = 2 Σ s²ⁿ⁺¹/(2n + 1),   s = f/(2 + f)
//! ```
//!
//! The part of y that 1 + y loses by rounding is added to first order.

use super::exponential::{LN_2_HIGH, LN_2_LOW};

/// The bits of √½.
const ROOT_OF_HALF: u64 = 0x3fe6_a09e_667f_3bcd;
const ONE: u64 = 0x3ff0_0000_0000_0000;
const EXPONENT: u64 = 0xfff0_0000_0000_0000;

/// 2⁵²: adding a small whole number to it adds that number to its bits.
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// ln(1 + y) within 2 units in the last place where 1 + y is a positive normal number, without cancellation where y is small.
#[inline(always)]
pub fn logarithm_of_one_plus(y: f64) -> f64 {
    let u = 1.0 + y;
    let lost = (y - (u - 1.0)) / u;
    let bits = u.to_bits().wrapping_sub(ROOT_OF_HALF);
    let biased = (bits.wrapping_add(ONE)) >> 52;
    let k = f64::from_bits(WHOLE.to_bits() | (biased & 0xfff)) - WHOLE - 1023.0;
    let f = f64::from_bits(u.to_bits().wrapping_sub(bits & EXPONENT)) - 1.0;
    let s = f / (2.0 + f);
    let q = s * s;
    let series = series(q);
    // 2 s = f − s f: the first term has no error of division.
    let mantissa = f - s * (f - 2.0 * q * series);
    let value = k * LN_2_HIGH + (mantissa + (k * LN_2_LOW + lost));
    if u > 0.0 { value } else { f64::NAN }
}

/// Σ qⁿ/(2n + 3)
#[inline(always)]
fn series(q: f64) -> f64 {
    let q4 = (q * q) * (q * q);
    let low = (1.0 / 3.0 + q / 5.0) + (1.0 / 7.0 + q / 9.0) * (q * q);
    let middle = (1.0 / 11.0 + q / 13.0) + (1.0 / 15.0 + q / 17.0) * (q * q);
    low + (middle + (1.0 / 19.0 + q / 21.0) * q4) * q4
}

/// ln(1 + y) − y, without cancellation where y is small.
#[inline(always)]
pub fn logarithm_remainder(y: f64) -> f64 {
    let s = y / (2.0 + y);
    let near = 2.0 * s * s * s * series(s * s) - y * y / (2.0 + y);
    let far = logarithm_of_one_plus(y) - y;
    if y.abs() < 0.3 { near } else { far }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_logarithm_is_accurate_to_two_units_in_the_last_place() {
        let large = (-4000..4000).map(|i| (f64::from(i) * 0.017_3).exp_m1());
        let small = (0..3000).flat_map(|i| {
            let y = 10f64.powf(-15.0 + f64::from(i) * 5e-3);
            [y, -0.99 * y]
        });
        for y in large.chain(small).filter(|y| *y > -1.0) {
            let expected = y.ln_1p();
            let unit = expected.abs().next_up() - expected.abs();
            let error = (logarithm_of_one_plus(y) - expected).abs() / unit;
            assert!(error <= 2.0, "{y:e}: {error}");
        }
        assert_eq!(logarithm_of_one_plus(0.0), 0.0);
        assert!(logarithm_of_one_plus(-1.5).is_nan() && logarithm_of_one_plus(f64::NAN).is_nan());
    }

    #[test]
    fn the_logarithm_beyond_first_order_keeps_its_digits() {
        for y in [
            1e-12, -1e-9, 1e-5, -1e-3, 0.1, -0.2, 0.29, 0.31, -0.31, 0.7, 3.0, -0.9,
        ] {
            // y² ∫ −t/(1 + y t) dt by its series where that converges quickly.
            let expected: f64 = if f64::abs(y) < 0.5 {
                (2..200).rev().map(|n| -(-y).powi(n) / f64::from(n)).sum()
            } else {
                y.ln_1p() - y
            };
            let error = (logarithm_remainder(y) / expected - 1.0).abs();
            assert!(error < 4e-15, "{y}: {error:.1e}");
        }
    }
}
