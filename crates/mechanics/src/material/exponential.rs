//! The exponential function without branches, so that loops over many points are vectorised by the compiler.
//!
//! ```text
//! z = k ln 2 + r,   |r| ≤ ½ ln 2,   eᶻ = 2ᵏ (1 + r + r² q(r)),   q(r) = Σ rⁿ/(n + 2)!
//! ```
//!
//! ln 2 is split into two parts, the first of which has few enough digits that k times it is exact.

pub(super) const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
pub(super) const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// 1.5 · 2⁵²: adding it to a number rounds that number to an integer, which is then in the lowest bits.
const ROUNDING: f64 = 6_755_399_441_055_744.0;

/// 1/(n + 2)! for n = 0 … 11.
const COEFFICIENTS: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// k, 2ᵏ, r and q(r) of a number of magnitude 708 at most.
#[inline(always)]
fn reduce(z: f64) -> (f64, f64, f64, f64) {
    let rounded = z * std::f64::consts::LOG2_E + ROUNDING;
    let k = rounded - ROUNDING;
    let r = (z - k * LN_2_HIGH) - k * LN_2_LOW;
    let power = f64::from_bits((rounded.to_bits() << 52).wrapping_add(1.0_f64.to_bits()));
    // Evaluated in pairs of pairs: a short chain of dependent operations.
    let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11] = COEFFICIENTS;
    let r2 = r * r;
    let r4 = r2 * r2;
    let low = (c0 + c1 * r) + (c2 + c3 * r) * r2;
    let middle = (c4 + c5 * r) + (c6 + c7 * r) * r2;
    let high = (c8 + c9 * r) + (c10 + c11 * r) * r2;
    (k, power, r, low + (middle + high * r4) * r4)
}

/// eᶻ within 2 units in the last place; infinite above 709, zero below −708.
#[inline(always)]
pub fn exponential(z: f64) -> f64 {
    let (_, power, r, q) = reduce(z.clamp(-708.0, 709.0));
    let value = power + power * (r + r * r * q);
    let value = if z > 709.0 { f64::INFINITY } else { value };
    let value = if z < -708.0 { 0.0 } else { value };
    if z.is_nan() { z } else { value }
}

/// eᶻ − 1 − z, without cancellation where z is small.
#[inline(always)]
pub fn exponential_remainder(z: f64) -> f64 {
    let (k, power, r, q) = reduce(z.clamp(-708.0, 709.0));
    // Where k = 0, power = 1 and r = z: both sums are the square's alone.
    let value =
        ((power - 1.0) - k * std::f64::consts::LN_2) + ((power - 1.0) * r + power * (r * r * q));
    let value = if z > 709.0 { f64::INFINITY } else { value };
    if z.is_nan() { z } else { value }
}

/// eᶻ − 1, without cancellation where z is small.
#[inline(always)]
pub fn exponential_less_one(z: f64) -> f64 {
    let (_, power, r, q) = reduce(z.clamp(-708.0, 709.0));
    let value = (power - 1.0) + power * (r + r * r * q);
    let value = if z > 709.0 { f64::INFINITY } else { value };
    if z.is_nan() { z } else { value }
}

/// φ₂ = (eᶻ − 1 − z)/z², without cancellation where z is small.
#[inline(always)]
pub fn second_quotient(z: f64) -> f64 {
    let (k, _, _, q) = reduce(z.clamp(-708.0, 709.0));
    let far = exponential_remainder(z) / (z * z);
    if k == 0.0 { q } else { far }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units_in_the_last_place(value: f64, expected: f64) -> f64 {
        let unit = expected.abs().next_up() - expected.abs();
        (value - expected).abs() / unit
    }

    #[test]
    fn the_exponential_is_accurate_to_two_units_in_the_last_place() {
        let points = (-700_000..700_000).map(|i| f64::from(i) * 1.000_3e-3);
        let worst = points
            .map(|z| units_in_the_last_place(exponential(z), z.exp()))
            .fold(0.0, f64::max);
        assert!(worst <= 2.0, "{worst}");
        assert_eq!(exponential(1e3), f64::INFINITY);
        assert_eq!(exponential(-1e3), 0.0);
        assert_eq!(exponential(0.0), 1.0);
        assert!(exponential(f64::NAN).is_nan());
    }

    #[test]
    fn the_quotients_keep_their_digits_at_rest() {
        for z in [
            0.0, 1e-12, -1e-9, 1e-5, 0.3, -0.34, 0.35, 0.7, 2.0, 5.0, -3.0, 40.0,
        ] {
            let less_one = exponential_less_one(z);
            assert!(
                (less_one - z.exp_m1()).abs() <= 1e-15 * z.exp_m1().abs(),
                "{z}"
            );
            // Σ zᵏ/(k + 2)!
            let series = (0..60)
                .rev()
                .fold(0.0, |sum, k| (1.0 + z * sum) / f64::from(k + 2));
            if z.abs() <= 5.0 {
                let error = (second_quotient(z) / series - 1.0).abs();
                assert!(error < 4e-15, "{z}: {error}");
            }
        }
    }
}
