//! The discretisation error of a result from three meshes.

use crate::statistics::bisect;

/// The highest order that is trusted: that of a force by biquadratic elements on a smooth solution. A higher one is
/// an accident of the three values, such as a change of sign of the error.
const HIGHEST_ORDER: f64 = 4.0;

/// The lowest order used for extrapolation: below it, the extrapolation goes farther than the three values do.
pub const LOWEST_ORDER: f64 = 0.5;

/// Richardson's extrapolation of a quantity computed with cells of size 4h, 2h and h.
///
/// ```text
/// p  = log₂ |f₄ₕ − f₂ₕ| / |f₂ₕ − fₕ|
/// f* = fₕ + (fₕ − f₂ₕ) / (2ᵖ − 1)
/// ```
///
/// # References
/// P. J. Roache, Annu. Rev. Fluid Mech. 29, 123 (1997), doi:10.1146/annurev.fluid.29.1.123
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Richardson {
    /// Observed order p; `None` where the three values do not converge monotonically.
    pub order: Option<f64>,
    /// Extrapolated value f*; the value of the finest mesh where there is no order or one below ½.
    pub extrapolated: f64,
    /// The error of fₕ over |f*| in percent: |fₕ − f*| where the order is trusted; see [`of_distances`] where there
    /// is none, or one below ½ or above 4.
    pub error_percent: f64,
}

/// Extrapolates `[coarse, middle, fine]`.
pub fn richardson([coarse, middle, fine]: [f64; 3]) -> Richardson {
    let (error, order) = of_distances((coarse - middle).abs(), (middle - fine).abs());
    let monotone = (coarse - middle) * (middle - fine) > 0.0;
    let (error, order) = if monotone {
        (error, order)
    } else {
        (error.max((fine - middle).abs()), None)
    };
    let believed = order.filter(|order| *order >= LOWEST_ORDER);
    let extrapolated = believed.map_or(fine, |order| fine + (fine - middle) / (order.exp2() - 1.0));
    Richardson {
        order,
        extrapolated,
        error_percent: 100.0 * (error / extrapolated).abs(),
    }
}

/// The exponent α of the displacement rᵅ beside a re-entrant corner of the angle ω, in rad, between free edges of an elastic
/// sheet:
///
/// ```text
/// sin αω + α sin ω = 0,   ½ ≤ α < 1            ½ at a crack, 0.5445 where ω = 270°
/// ```
///
/// Whatever the elements, the error of a force or displacement falls there at most with the order 2α on cells of equal size.
///
/// # References
/// M. L. Williams, J. Appl. Mech. 19, 526 (1952)
pub fn corner_exponent(angle: f64) -> f64 {
    let is_below = |exponent: f64| (exponent * angle).sin() + exponent * angle.sin() > 0.0;
    bisect([0.5, 1.0], 60, is_below)[0]
}

/// An error from the distance |f₂ₕ − fₕ| where no order above `most` is possible; at least `error`.
pub fn at_most_of_order(error: f64, last: f64, most: f64) -> f64 {
    error.max(last / (most.exp2() - 1.0))
}

/// The error of the finest of three meshes and the observed order p, from the distances |f₄ₕ − f₂ₕ| and |f₂ₕ − fₕ|.
///
/// ```text
/// e = |f₂ₕ − fₕ| / (2ᵖ − 1),   |f₂ₕ − fₕ| where p is no positive number, and |f₄ₕ − f₂ₕ| / (2⁴ (2⁴ − 1)) at least:
/// no order above 4 is believed
/// ```
pub fn of_distances(before: f64, last: f64) -> (f64, Option<f64>) {
    let ratio = before / last;
    let highest = HIGHEST_ORDER.exp2();
    let least = before / (highest * (highest - 1.0));
    if ratio > 1.0 && ratio.is_finite() {
        ((last / (ratio - 1.0)).max(least), Some(ratio.log2()))
    } else {
        (last.max(least), None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_have_the_exponents_of_williams() {
        for (degrees, exponent) in [(360.0_f64, 0.5), (270.0, 0.544_483_7), (225.0, 0.673_583)] {
            let computed = corner_exponent(degrees.to_radians());
            assert!((computed - exponent).abs() < 1e-6, "{degrees}: {computed}");
        }
    }

    #[test]
    fn a_power_law_is_extrapolated_exactly() {
        let value = |h: f64| 3.0 + 0.2 * h.powf(1.7);
        let extrapolation = richardson([value(4.0), value(2.0), value(1.0)]);
        assert!((extrapolation.order.unwrap() - 1.7).abs() < 1e-12);
        assert!((extrapolation.extrapolated - 3.0).abs() < 1e-12);
        assert!((extrapolation.error_percent - 20.0 / 3.0).abs() < 1e-10);
    }

    #[test]
    fn an_order_by_accident_makes_no_error_small() {
        // The error changes its sign between the last two meshes: 1 %, 0.1 % and -0.09 %, or nearly vanishes.
        for fine in [0.9991, 1.000_999] {
            let extrapolation = richardson([1.01, 1.001, fine]);
            assert!(
                extrapolation.error_percent > 0.003,
                "{fine}: {extrapolation:?}"
            );
        }
        assert_eq!(richardson([2.0; 3]).error_percent, 0.0);
    }

    #[test]
    fn a_sequence_that_hardly_converges_is_not_extrapolated_far_away() {
        let extrapolation = richardson([45.8, 45.9, 45.99]);
        assert_eq!(extrapolation.extrapolated, 45.99);
        assert!(extrapolation.error_percent > 0.5, "{extrapolation:?}");
    }

    #[test]
    fn a_sequence_that_does_not_converge_gets_no_order() {
        let extrapolation = richardson([1.0, 1.1, 1.0]);
        assert_eq!(extrapolation.order, None);
        assert_eq!(extrapolation.extrapolated, 1.0);
        // The last difference is all that is known of its error.
        assert!((extrapolation.error_percent - 10.0).abs() < 1e-12);
        let apart = richardson([1.0, 1.1, 1.3]);
        assert!(apart.order.is_none() && apart.extrapolated == 1.3);
    }
}
