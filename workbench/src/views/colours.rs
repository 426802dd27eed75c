//! Colours of values: dark to light, even to the eye and told apart by most people (viridis).

use eframe::egui::Color32;

const STOPS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// What no number is coloured with.
const GREY: Color32 = Color32::from_rgb(128, 128, 128);

/// The colour of a value within a range.
pub fn colour(value: f64, [low, high]: [f64; 2]) -> Color32 {
    let share = (value - low) / (high - low).max(f64::MIN_POSITIVE);
    if !share.is_finite() {
        return GREY;
    }
    let last = STOPS.len() - 1;
    let place = share.clamp(0.0, 1.0) * last as f64;
    let before = (place as usize).min(last - 1);
    let part = place - before as f64;
    let [r, g, b] = [0, 1, 2].map(|channel| {
        let [from, to] = [before, before + 1].map(|stop| f64::from(STOPS[stop][channel]));
        (from + part * (to - from)).round() as u8
    });
    Color32::from_rgb(r, g, b)
}

/// The least and the largest of some numbers; nothing where there are none.
pub fn range(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold(None, |range, value| match range {
        None => Some([value; 2]),
        Some([low, high]) => Some([f64::min(low, value), f64::max(high, value)]),
    })
}

/// The range that holds 96 % of some numbers, and zero where they come near it; nothing where there are none. At corners stresses
/// have no bound, and would leave one colour for all the rest.
pub fn most_of(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    let mut finite: Vec<f64> = values
        .into_iter()
        .filter(|value| value.is_finite())
        .collect();
    let last = finite.len().checked_sub(1)?;
    let mut at = |share: f64| {
        let place = (share * last as f64).round() as usize;
        *finite.select_nth_unstable_by(place, f64::total_cmp).1
    };
    let [low, high] = [0.02, 0.98].map(&mut at);
    let near_zero = low > 0.0 && low < 0.1 * high;
    Some([if near_zero { 0.0 } else { low }, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_have_the_ends_of_the_scale_and_no_number_is_grey() {
        assert_eq!(colour(2.0, [2.0, 5.0]), Color32::from_rgb(68, 1, 84));
        assert_eq!(colour(9.0, [2.0, 5.0]), Color32::from_rgb(253, 231, 37));
        assert_eq!(colour(f64::NAN, [2.0, 5.0]), GREY);
        assert_eq!(colour(1.0, [1.0, 1.0]), colour(0.0, [0.0, 1.0]));
    }

    #[test]
    fn a_few_large_values_do_not_take_all_colours() {
        let values = (0..1000).map(|number| {
            if number < 5 {
                1e6
            } else {
                f64::from(number) + 500.0
            }
        });
        let [low, high] = most_of(values).unwrap();
        assert!(low > 500.0 && high < 1500.0, "{low} {high}");
        assert_eq!(most_of([0.01, 1.0, 2.0, 3.0]), Some([0.0, 3.0]));
        assert_eq!(most_of([f64::NAN]), None);
    }

    #[test]
    fn the_range_leaves_out_what_is_no_number() {
        assert_eq!(range([3.0, f64::NAN, 1.0]), Some([1.0, 3.0]));
        assert_eq!(range([f64::NAN]), None);
    }
}
