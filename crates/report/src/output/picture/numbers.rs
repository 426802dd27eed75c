//! Round numbers, and how axes and colour bars write them.

use super::letters::Letters;
use crate::results::Scale;
use crate::statistics::extremes;

impl Scale {
    /// The position of a value; values that a logarithm does not take have none.
    pub(super) fn position(self, value: f64) -> Option<f64> {
        let position = match self {
            Self::Linear | Self::Interval => value,
            Self::Logarithmic => value.log10(),
        };
        position.is_finite().then_some(position)
    }

    /// The value at a position.
    pub(super) fn value(self, position: f64) -> f64 {
        match self {
            Self::Linear | Self::Interval => position,
            Self::Logarithmic => 10f64.powf(position),
        }
    }

    /// Limits that hold all positions: complete decades where there are many, otherwise a margin around the values.
    pub(super) fn limits(self, positions: impl Iterator<Item = f64>) -> [f64; 2] {
        let [low, high] = extremes(positions);
        if low > high {
            return [0.0, 1.0];
        }
        if self == Self::Logarithmic && high - low > 2.0 {
            return [low.floor(), high.ceil()];
        }
        let margin = match high - low {
            width if width > 1e-9 * high.abs() => 0.05 * width,
            _ if self == Self::Logarithmic => 0.5,
            _ => 0.5 * high.abs().max(1.0),
        };
        // Zero is shown where it is near.
        let from_zero = self == Self::Linear && low >= 0.0 && low < 0.4 * high;
        [if from_zero { 0.0 } else { low - margin }, high + margin]
    }
}

/// Round positions within a range, about so many.
pub(super) fn round_positions([low, high]: [f64; 2], about: f64) -> Vec<f64> {
    let step = round_step((high - low) / about);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}

/// The smallest of 1, 2, 2.5, 5 times a power of ten that is no smaller than a length.
fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.log10().floor());
    let mut steps = [1.0, 2.0, 2.5, 5.0].iter().map(|factor| factor * decade);
    steps.find(|step| *step >= least).unwrap_or(10.0 * decade)
}

/// The fewest ticks of an axis.
const FEWEST: usize = 3;

/// The positions of the ticks of an axis, with their labels.
#[derive(Clone, Debug)]
pub(super) struct Ticks {
    pub at: Vec<(f64, String)>,
    pub numbers: Numbers,
}

impl Ticks {
    /// At most so many ticks between two positions, but three at least.
    pub fn within([low, high]: [f64; 2], scale: Scale, most: usize) -> Self {
        if scale != Scale::Logarithmic {
            let positions = even([low, high], most);
            let numbers = Numbers::of(&positions);
            let labelled = positions.into_iter().map(|at| (at, numbers.label(at)));
            return Self {
                at: labelled.collect(),
                numbers,
            };
        }
        if let Some(powers) = powers([low, high], most) {
            let numbers = Numbers::default();
            return Self {
                at: powers,
                numbers,
            };
        }
        let values = even([low, high].map(|end| 10f64.powf(end)), most);
        let numbers = Numbers::of(&values);
        let values = values.into_iter().filter(|value| *value > 0.0);
        let labelled = values.map(|value| (value.log10(), numbers.label(value)));
        Self {
            at: labelled.collect(),
            numbers,
        }
    }

    /// As many ticks of a horizontal axis of a length as have room beside one another; of the three fewest only the ends.
    pub fn fitting(limits: [f64; 2], scale: Scale, length: f64, letters: Letters) -> Self {
        const APART: f64 = 10.0;
        let fits = |ticks: &Self| {
            ticks.at.windows(2).all(|pair| {
                let apart = (pair[1].0 - pair[0].0) / (limits[1] - limits[0]) * length;
                let widths = letters.width(&pair[0].1) + letters.width(&pair[1].1);
                apart >= 0.5 * widths + APART
            })
        };
        let mut fewer = (FEWEST..=8)
            .rev()
            .map(|most| Self::within(limits, scale, most));
        fewer.find(fits).unwrap_or_else(|| {
            let mut ends = Self::within(limits, scale, FEWEST).ends();
            if !fits(&ends) {
                ends.at.truncate(1);
            }
            ends
        })
    }

    /// The first and the last tick.
    pub fn ends(mut self) -> Self {
        if self.at.len() > 2 {
            self.at.drain(1..self.at.len() - 1);
        }
        self
    }
}

/// Round positions within a range, at most so many but three at least.
fn even(range: [f64; 2], most: usize) -> Vec<f64> {
    let about = |about: usize| round_positions(range, about as f64);
    let choices = (FEWEST..=most).rev().map(about);
    let mut few = choices.filter(|positions| (FEWEST..=most).contains(&positions.len()));
    let more = || {
        (FEWEST..20)
            .map(about)
            .find(|positions| positions.len() >= FEWEST)
    };
    few.next().or_else(more).unwrap_or_default()
}

/// Logarithmic ticks: decades, every second one, … or what lies between where there are few of them. All of an axis are
/// written in the same way. `None` where there are fewer than three.
fn powers([low, high]: [f64; 2], most: usize) -> Option<Vec<(f64, String)>> {
    let decades = low.floor() as i32..=high.ceil() as i32;
    let steps = [1, 2, 3, 4, 5, 10, 20, 50, 100].into_iter();
    let coarse = steps.map(|step| {
        let decades = decades.clone().filter(move |exponent| exponent % step == 0);
        decades.map(|exponent| (1.0, exponent)).collect()
    });
    let fine = [vec![1.0, 3.0], vec![1.0, 2.0, 5.0]];
    let fine = fine.into_iter().map(|mantissas| {
        let all = decades
            .clone()
            .flat_map(|exponent| mantissas.iter().map(move |m| (*m, exponent)));
        all.collect()
    });
    let at = |(mantissa, exponent): (f64, i32)| mantissa.log10() + f64::from(exponent);
    let within = |tick: &(f64, i32)| (low - 1e-9..=high + 1e-9).contains(&at(*tick));
    let mut choices = coarse.chain(fine).map(|mut ticks: Vec<(f64, i32)>| {
        ticks.retain(within);
        ticks
    });
    let chosen = choices.find(|ticks| (FEWEST..=most.max(5)).contains(&ticks.len()))?;
    // Decades are always powers of ten, so that all axes of a picture have them alike.
    let has_parts = chosen.iter().any(|(mantissa, _)| *mantissa != 1.0);
    let is_small = chosen
        .iter()
        .all(|(_, exponent)| (-2..=3).contains(exponent));
    let is_plain = has_parts && is_small;
    let label = |tick: &(f64, i32)| {
        if is_plain {
            plain(tick.0 * 10f64.powi(tick.1))
        } else {
            in_powers(*tick)
        }
    };
    let labelled = chosen.iter().map(|tick| (at(*tick), label(tick)));
    Some(labelled.collect())
}

/// A round number without trailing zeros.
fn plain(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// 10⁻⁴, 2×10⁻⁴.
fn in_powers((mantissa, exponent): (f64, i32)) -> String {
    let power = power_of_ten(f64::from(exponent));
    if mantissa == 1.0 {
        return power;
    }
    format!("{mantissa}×{power}")
}

/// A power of ten by its exponent: 10⁻³.
fn power_of_ten(exponent: f64) -> String {
    let digits = format!("{exponent:.0}");
    let superscript = digits.chars().map(|digit| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        other => char::from_u32('⁰' as u32 + other as u32 - '0' as u32).unwrap_or(other),
    });
    format!("10{}", superscript.collect::<String>())
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

    /// The quantity of an axis with the power of ten that its numbers have in common: stress [10⁻⁶ MPa].
    pub fn labelled(self, quantity: &str) -> String {
        if self.exponent == 0 {
            return quantity.to_owned();
        }
        let power = power_of_ten(f64::from(self.exponent));
        match quantity.rsplit_once('[') {
            Some((name, "–]")) => format!("{name}[{power}]"),
            Some((name, unit)) => format!("{name}[{power} {unit}"),
            None => format!("{quantity} [{power}]"),
        }
    }
}

/// The power of ten that numbers far from one are written with; zero for others.
fn common_exponent(largest: f64) -> i32 {
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
        let ticks = Ticks::within(limits, scale, 7);
        ticks.at.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_have_the_same_decimals() {
        let linear = |low, high| labels([low, high], Scale::Linear);
        assert_eq!(
            linear(-0.5, 0.9),
            ["−0.4", "−0.2", "0.0", "0.2", "0.4", "0.6", "0.8"]
        );
        assert_eq!(linear(0.0, 74.9), ["0", "20", "40", "60"]);
        assert_eq!(linear(5.0, 5.000_02)[1], "5.000005");
        assert_eq!(linear(0.0, 3.1e-8)[..2], ["0.0", "0.5"]);
        let ticks = Ticks::within([0.0, 3.1e-8], Scale::Linear, 5);
        assert_eq!(ticks.numbers.between(-2.468e-8), "−2.47");
        assert_eq!(ticks.numbers.labelled("force [N]"), "force [10⁻⁸ N]");
        assert_eq!(ticks.numbers.labelled("strain [–]"), "strain [10⁻⁸]");
    }

    #[test]
    fn logarithmic_ticks_are_written_alike_and_three_at_least() {
        let logarithmic = |low, high| labels([low, high], Scale::Logarithmic);
        assert_eq!(logarithmic(-3.7, 0.1), ["10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert_eq!(logarithmic(-1.3, 0.1), ["0.1", "0.3", "1"]);
        assert_eq!(logarithmic(-3.8, -2.9), ["2×10⁻⁴", "5×10⁻⁴", "10⁻³"]);
        assert_eq!(logarithmic(-12.0, 0.0)[..2], ["10⁻¹²", "10⁻¹⁰"]);
        assert!(logarithmic(0.31, 0.36).len() >= 3);
    }

    #[test]
    fn every_axis_has_three_ticks_and_no_more_than_it_has_room_for() {
        for scale in [Scale::Linear, Scale::Interval, Scale::Logarithmic] {
            for (low, width) in (0..40).flat_map(|i| (1..60).map(move |j| (i, j))) {
                let low = 0.37 * f64::from(low) - 7.3;
                let range = [low, low + 0.0173 * f64::from(width * width)];
                for most in 4..9 {
                    let count = Ticks::within(range, scale, most).at.len();
                    assert!(
                        (3..=most.max(5)).contains(&count),
                        "{scale:?} {range:?} {most}"
                    );
                }
            }
        }
    }
}
