//! Round numbers, and how axes and colour bars write them.

use super::canvas::{power_of_ten, tick};
use crate::results::Scale;

/// Round positions within a range, about so many.
pub(super) fn round_positions([low, high]: [f64; 2], about: f64) -> Vec<f64> {
    let step = round_step((high - low) / about);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}

/// The smallest of 1, 2, 2.5, 5 times a power of ten that is no smaller than a length.
pub(super) fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.log10().floor());
    let mut steps = [1.0, 2.0, 2.5, 5.0].iter().map(|factor| factor * decade);
    steps.find(|step| *step >= least).unwrap_or(10.0 * decade)
}

/// The ticks of a colour bar between two positions: where they are, and what they say.
pub(super) fn ticks([low, high]: [f64; 2], scale: Scale) -> (Vec<(f64, String)>, Numbers) {
    let even = |low: f64, high: f64| {
        let positions = round_positions([low, high], 6.0);
        (Numbers::of(&positions), positions)
    };
    if scale != Scale::Logarithmic {
        let (numbers, positions) = even(low, high);
        let labelled = positions.into_iter().map(|at| (at, numbers.label(at)));
        return (labelled.collect(), numbers);
    }
    let mantissas: &[f64] = match high - low {
        wide if wide >= 3.0 => &[1.0],
        _ => &[1.0, 2.0, 5.0],
    };
    let decades = low.floor() as i32..=high.ceil() as i32;
    let all = decades.flat_map(|exponent| mantissas.iter().map(move |m| (*m, exponent)));
    let at = |(mantissa, exponent): (f64, i32)| mantissa.log10() + f64::from(exponent);
    let within = |tick: &(f64, i32)| (low - 1e-9..=high + 1e-9).contains(&at(*tick));
    let few: Vec<_> = all.filter(within).collect();
    if few.len() >= 2 {
        let labelled = few.into_iter().map(|tick| (at(tick), in_powers(tick)));
        return (labelled.collect(), Numbers::default());
    }
    let (numbers, values) = even(10f64.powf(low), 10f64.powf(high));
    let values = values.into_iter().filter(|value| *value > 0.0);
    let labelled = values.map(|value| (value.log10(), numbers.label(value)));
    (labelled.collect(), numbers)
}

/// 0.02, 5, 10⁻⁴, 2×10⁻⁴.
fn in_powers((mantissa, exponent): (f64, i32)) -> String {
    match (mantissa, exponent) {
        (_, -2..=2) => tick(mantissa * 10f64.powi(exponent)),
        (1.0, _) => power_of_ten(f64::from(exponent)),
        _ => format!("{mantissa}×{}", power_of_ten(f64::from(exponent))),
    }
}

/// How the numbers of an axis are written: with a common power of ten, and so many decimals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Numbers {
    exponent: i32,
    decimals: usize,
}

impl Numbers {
    /// For numbers that are an even step apart.
    pub fn of(numbers: &[f64]) -> Self {
        let largest = numbers.iter().fold(0.0, |most: f64, n| most.max(n.abs()));
        Self::in_units_of(common_exponent(largest), numbers)
    }

    /// For numbers that are an even step apart, without a power of ten.
    pub fn plain(numbers: &[f64]) -> Self {
        Self::in_units_of(0, numbers)
    }

    fn in_units_of(exponent: i32, numbers: &[f64]) -> Self {
        let unit = 10f64.powi(exponent);
        let steps = numbers.windows(2).map(|pair| pair[1] - pair[0]);
        let step = steps.fold(f64::INFINITY, f64::min);
        let exact = |decimals: &usize| {
            let power = 10f64.powi(*decimals as i32) / unit;
            let rounding = 1e-4_f64.min(0.01 * step * power);
            let mut digits = numbers.iter().map(|number| number * power);
            digits.all(|digit| (digit - digit.round()).abs() <= rounding)
        };
        let decimals = (0..9).find(exact).unwrap_or(9);
        Self { exponent, decimals }
    }

    /// A number as the ticks have it.
    pub fn label(self, number: f64) -> String {
        let decimals = self.decimals;
        sign(&format!(
            "{:.decimals$}",
            number / 10f64.powi(self.exponent)
        ))
    }

    /// A number between the ticks, with three digits.
    pub fn between(self, number: f64) -> String {
        let number = number / 10f64.powi(self.exponent);
        let exponent = number.abs().max(f64::MIN_POSITIVE).log10().floor();
        match exponent {
            _ if number == 0.0 => "0".to_owned(),
            -3.0..5.0 => {
                let decimals = (2.0 - exponent).max(0.0) as usize;
                sign(&format!("{number:.decimals$}"))
            }
            _ => {
                let mantissa = number / 10f64.powf(exponent);
                format!(
                    "{}×{}",
                    sign(&format!("{mantissa:.1}")),
                    power_of_ten(exponent)
                )
            }
        }
    }

    /// ×10⁻⁶, where the numbers have one.
    pub fn power(self) -> Option<String> {
        let power = || format!("×{}", power_of_ten(f64::from(self.exponent)));
        (self.exponent != 0).then(power)
    }
}

/// The power of ten that numbers far from one are written with; zero for others.
pub(super) fn common_exponent(largest: f64) -> i32 {
    let exponent = largest.log10().floor();
    if exponent.is_finite() && !(-2.0..5.0).contains(&exponent) {
        exponent as i32
    } else {
        0
    }
}

/// A true minus sign, and none before zero.
fn sign(number: &str) -> String {
    let is_zero = !number.contains(|digit| ('1'..='9').contains(&digit));
    match number.strip_prefix('-') {
        Some(zero) if is_zero => zero.to_owned(),
        Some(size) => format!("−{size}"),
        None => number.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(limits: [f64; 2], scale: Scale) -> Vec<String> {
        let (ticks, _) = ticks(limits, scale);
        ticks.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_have_the_same_decimals() {
        let linear = |low, high| labels([low, high], Scale::Linear);
        assert_eq!(
            linear(-0.5, 0.9),
            ["−0.50", "−0.25", "0.00", "0.25", "0.50", "0.75"]
        );
        assert_eq!(linear(0.0, 74.9), ["0", "20", "40", "60"]);
        assert_eq!(
            linear(0.19444, 0.19446),
            ["0.194440", "0.194445", "0.194450", "0.194455", "0.194460"]
        );
        assert_eq!(linear(5.0, 5.000_02)[1], "5.000005");
        assert_eq!(linear(0.0, 3.1e-8), ["0", "1", "2", "3"]);
        let (_, numbers) = ticks([0.0, 3.1e-8], Scale::Linear);
        assert_eq!(numbers.power().as_deref(), Some("×10⁻⁸"));
        assert_eq!(numbers.between(-2.468e-8), "−2.47");
    }

    #[test]
    fn logarithmic_ticks_are_decades_and_what_lies_between_where_there_are_few() {
        let logarithmic = |low, high| labels([low, high], Scale::Logarithmic);
        assert_eq!(logarithmic(-3.7, 0.1), ["10⁻³", "0.01", "0.1", "1"]);
        assert_eq!(logarithmic(-3.8, -2.9), ["2×10⁻⁴", "5×10⁻⁴", "10⁻³"]);
        assert_eq!(
            logarithmic(0.31, 0.36),
            ["2.05", "2.10", "2.15", "2.20", "2.25"]
        );
    }
}
