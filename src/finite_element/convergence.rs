//! The discretisation error of a result from three meshes.

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
    /// Observed order p; not a number when the three values do not converge monotonically.
    pub order: f64,
    /// Extrapolated value f*; that of the finest mesh when the order is not a number.
    pub extrapolated: f64,
    /// |fₕ − f*| / |f*| in percent; from |fₕ − f₂ₕ| when the order is not a number.
    pub error_percent: f64,
}

/// Extrapolates `[coarse, middle, fine]`.
pub fn richardson([coarse, middle, fine]: [f64; 3]) -> Richardson {
    let ratio = (coarse - middle) / (middle - fine);
    let (order, extrapolated) = if ratio > 1.0 && ratio.is_finite() {
        (ratio.log2(), fine + (fine - middle) / (ratio - 1.0))
    } else {
        (f64::NAN, fine)
    };
    let difference = if order.is_nan() {
        fine - middle
    } else {
        fine - extrapolated
    };
    Richardson {
        order,
        extrapolated,
        error_percent: 100.0 * (difference / extrapolated).abs(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_extrapolated_exactly() {
        let value = |h: f64| 3.0 + 0.2 * h.powf(1.7);
        let found = richardson([value(4.0), value(2.0), value(1.0)]);
        assert!((found.order - 1.7).abs() < 1e-12);
        assert!((found.extrapolated - 3.0).abs() < 1e-12);
        assert!((found.error_percent - 20.0 / 3.0).abs() < 1e-10);
    }

    #[test]
    fn a_sequence_that_does_not_converge_gets_no_order() {
        let found = richardson([1.0, 1.1, 1.0]);
        assert!(found.order.is_nan());
        assert_eq!(found.extrapolated, 1.0);
    }
}
