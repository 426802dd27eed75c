//! The range of the colour bar of a field.

use crate::results::{Panel, Scale, Values};
use crate::statistics::extremes;

/// The share of the area whose values may exceed each end of the colour bar.
const EXCEEDING: f64 = 0.002;

/// Values that exceed an end by more than this, in lengths of the colour bar, are marked; for smaller ones the bar is made longer.
const FAR: f64 = 0.15;

/// The most decades of a logarithmic colour bar: below lie single nodes that happen to be exact.
const DECADES: f64 = 6.0;

/// A field counts as one of both signs if the smaller side is at least so large a part of the larger one.
const SIGNED: f64 = 0.02;

/// The positions at the ends of the colour bar, and the values that exceed them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
    /// The smallest value where it lies below the bar.
    pub below: Option<f64>,
    /// The largest value where it lies above the bar.
    pub above: Option<f64>,
    /// Whether the values have both signs, so that zero is in the middle.
    pub is_signed: bool,
}

impl Range {
    /// The range of all panels on a linear scale between two given values, or else all of their values.
    pub fn of<'a>(
        panels: impl Iterator<Item = &'a Panel> + Clone,
        scale: Scale,
        given: Option<[f64; 2]>,
    ) -> Self {
        let values = panels.clone().flat_map(|panel| match &panel.values {
            Values::AtPoints(values) | Values::InCells(values) => values.iter().copied(),
        });
        let [least, most] = extremes(values.filter(|value| value.is_finite()));
        if let Some([low, high]) = given {
            return Self::between([low, high], [least, most], low == -high);
        }
        let shares = panels.flat_map(|panel| {
            let means = panel
                .corners()
                .map(|corners| corners.iter().sum::<f64>() / 3.0);
            means.zip(areas(panel))
        });
        let known = shares.filter_map(|(mean, area)| Some((scale.position(mean)?, area)));
        let Some([low, high]) = middle(known.collect()) else {
            let is_signed = false;
            return Self {
                low: 0.0,
                high: 1.0,
                below: None,
                above: None,
                is_signed,
            };
        };
        match scale {
            Scale::Logarithmic => Self::logarithmic([low, high], [least, most]),
            Scale::Linear | Scale::Interval => Self::even([low, high], [least, most]),
        }
    }

    fn even([low, high]: [f64; 2], [least, most]: [f64; 2]) -> Self {
        let far = FAR * (high - low);
        let is_local = high - low < 1e-3 * (most - least);
        let mut low = if low - least > far && !is_local {
            low
        } else {
            least
        };
        let mut high = if most - high > far && !is_local {
            high
        } else {
            most
        };
        let is_signed = low < 0.0 && high > 0.0 && (-low).min(high) > SIGNED * (-low).max(high);
        if is_signed {
            high = high.max(-low);
            low = -high;
        }
        if high - low <= 1e-6 * high.abs().max(low.abs()) {
            let margin = if high == 0.0 { 0.5 } else { 0.1 * high.abs() };
            (low, high) = (low - margin, high + margin);
        }
        Self::between([low, high], [least, most], is_signed)
    }

    fn between([low, high]: [f64; 2], [least, most]: [f64; 2], is_signed: bool) -> Self {
        let margin = 1e-9 * (high - low);
        Self {
            low,
            high,
            below: (least < low - margin).then_some(least),
            above: (most > high + margin).then_some(most),
            is_signed,
        }
    }

    fn logarithmic([low, high]: [f64; 2], [least, most]: [f64; 2]) -> Self {
        let top = most.log10();
        let bottom = if least > 0.0 {
            least.log10()
        } else {
            f64::NEG_INFINITY
        };
        let low = if low - bottom > FAR * (high - low) {
            low
        } else {
            bottom
        };
        let low = low.max(top - DECADES);
        let (low, high) = if top - low > 1e-6 {
            (low, top)
        } else {
            (low - 0.5, top + 0.5)
        };
        Self {
            low,
            high,
            below: (bottom < low - 1e-9).then_some(least),
            above: None,
            is_signed: false,
        }
    }

    /// Where a position lies on the bar: 0 at its lower end, 1 at its upper one.
    pub fn share(&self, position: f64) -> f64 {
        (position - self.low) / (self.high - self.low)
    }
}

/// The positions with all but a small share of the area between them.
fn middle(mut parts: Vec<(f64, f64)>) -> Option<[f64; 2]> {
    parts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = parts.iter().map(|(_, area)| area).sum();
    let mut passed = 0.0;
    let mut first_above = |share: f64| {
        let mut rest = parts.iter();
        passed = 0.0;
        let part = rest.find(|(_, area)| {
            passed += area;
            passed > share * total
        });
        part.or(parts.last()).map(|(position, _)| *position)
    };
    Some([first_above(EXCEEDING)?, first_above(1.0 - EXCEEDING)?])
}

fn areas(panel: &Panel) -> impl Iterator<Item = f64> {
    let surface = &panel.surface;
    surface.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|point| surface.points[point as usize]);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(values: impl Iterator<Item = f64>, scale: Scale) -> Range {
        let cells: Vec<_> = values
            .enumerate()
            .map(|(i, value)| {
                let x = i as f64;
                ([[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]], value)
            })
            .collect();
        Range::of([Panel::quadrilaterals("", &cells)].iter(), scale, None)
    }

    #[test]
    fn a_peak_in_a_small_part_of_the_area_is_beyond_the_bar_and_marked() {
        let peak = |i: i32| {
            if i == 500 {
                50.0
            } else {
                f64::from(i) / 1000.0
            }
        };
        let computed = range((0..1000).map(peak), Scale::Linear);
        assert!((computed.high - 0.998).abs() < 2e-3, "{computed:?}");
        assert_eq!(
            (computed.above, computed.below, computed.low),
            (Some(50.0), None, 0.0)
        );
        let without = range((0..1000).map(|i| f64::from(i) / 999.0), Scale::Linear);
        assert_eq!((without.high, without.above), (1.0, None));
    }

    #[test]
    fn zero_is_in_the_middle_where_the_values_have_both_signs() {
        let computed = range((-30..=99).map(f64::from), Scale::Linear);
        assert_eq!(
            (computed.low, computed.high, computed.is_signed),
            (-99.0, 99.0, true)
        );
        let computed = range((-1..=99).map(f64::from), Scale::Linear);
        assert_eq!((computed.low, computed.is_signed), (-1.0, false));
    }

    #[test]
    fn a_logarithmic_bar_marks_what_it_does_not_reach() {
        let computed = range(
            (0..400).map(|i| 10f64.powf(f64::from(i) / -50.0)),
            Scale::Logarithmic,
        );
        assert_eq!((computed.low, computed.high), (-6.0, 0.0));
        assert!(computed.below.is_some_and(|least| least < 1e-7));
        let computed = range([0.0, 1.0, 10.0].into_iter(), Scale::Logarithmic);
        assert_eq!(
            (computed.low, computed.high, computed.below),
            (0.0, 1.0, Some(0.0))
        );
    }

    #[test]
    fn a_field_of_one_value_or_none_has_a_range() {
        let computed = range([2.0; 3].into_iter(), Scale::Linear);
        assert!((computed.low, computed.high) == (1.8, 2.2) && computed.above.is_none());
        assert_eq!(range([0.0; 3].into_iter(), Scale::Linear).high, 0.5);
        for scale in [Scale::Linear, Scale::Logarithmic] {
            assert_eq!(range([f64::NAN; 3].into_iter(), scale).high, 1.0);
        }
    }
}
