//! Numbers as messages, reports and tables show them.

/// A number with so many decimals; where these would leave fewer than three digits, as [`number`] writes it.
pub fn decimals(value: f64, decimals: usize) -> String {
    const ROUNDING: f64 = 1e-12;
    let least = 10_f64.powi(2 - decimals as i32);
    if (ROUNDING..least).contains(&value.abs()) {
        number(value)
    } else {
        format!("{value:.decimals$}")
    }
}

/// A number as a table shows it: five significant digits, or powers of ten where it is far from one.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor();
    if (-3.0..5.0).contains(&exponent) {
        let digits = (4.0 - exponent).max(0.0) as usize;
        return format!("{value:.digits$}");
    }
    format!("{value:.2e}")
}

/// A number as [`number`] writes it, without trailing zeros.
pub fn brief(value: f64) -> String {
    let text = number(value);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// Length and width of something in mm, as messages say them.
pub fn extents([length, width]: [f64; 2]) -> String {
    format!("{} × {} mm", decimals(length, 4), decimals(width, 4))
}
