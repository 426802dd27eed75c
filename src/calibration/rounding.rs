//! How finely the numbers of a column were written.

/// The root mean square of what rounding may have taken from some numbers: those with fewer digits than the others ended
/// in zeros, so that all have as many decimals, or as many significant digits, as the one with the most.
pub fn rounding(values: &[f64]) -> f64 {
    let texts: Vec<String> = values
        .iter()
        .map(|value| format!("{:e}", value.abs()))
        .collect();
    let numbers: Vec<(i32, i32)> = texts.iter().filter_map(|text| digits(text)).collect();
    let most_digits = numbers.iter().map(|(digits, _)| *digits).max().unwrap_or(0);
    let decimals = numbers
        .iter()
        .map(|(digits, exponent)| digits - 1 - exponent);
    let most_decimals = decimals.max().unwrap_or(0);
    let square = |(_, exponent): &(i32, i32)| {
        let last = (-most_decimals).max(exponent + 1 - most_digits);
        10f64.powi(last).powi(2) / 12.0
    };
    (numbers.iter().map(square).sum::<f64>() / numbers.len().max(1) as f64).sqrt()
}

/// Significant digits and exponent of a number such as `1.25e-3`; nothing of zero.
fn digits(text: &str) -> Option<(i32, i32)> {
    let (mantissa, exponent) = text.split_once('e')?;
    let digits = mantissa.chars().filter(char::is_ascii_digit).count();
    let known = (i32::try_from(digits).ok()?, exponent.parse().ok()?);
    (mantissa != "0").then_some(known)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of width w has the standard deviation w/√12.
    #[test]
    fn the_last_decimal_or_digit_tells_what_was_rounded() {
        let width = |values: &[f64]| rounding(values) * 12f64.sqrt();
        assert!((width(&[0.0, 1.2, 12.53, 130.11]) / 0.01 - 1.0).abs() < 1e-12);
        // Three digits each: 0.001, 0.01 and 0.1.
        let mean = ((1e-6 + 1e-4 + 1e-2) / 3.0_f64).sqrt();
        assert!((width(&[0.123, 1.23, 12.3]) / mean - 1.0).abs() < 1e-12);
        assert!(width(&[1.0 / 3.0, 2.0 / 7.0]) < 1e-15);
        assert_eq!(width(&[0.0]), 0.0);
    }
}
