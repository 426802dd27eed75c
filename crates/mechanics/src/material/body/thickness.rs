//! The thickness of a sheet with free surfaces: W_b = 0.

use std::sync::LazyLock;

use super::{BodyDerivatives, BodyLaw, BodySheet, BodyStretches};

/// Steps of Newton's method before the root is looked for between bounds.
const MOST_STEPS: usize = 40;

/// A step of ln λ₃ of this size, relative to the strains, is the last one: the remaining error, about its square, is
/// condensed with W_b, which removes it from the stress, and leaves 1e-11 in the tangent.
const LAST_STEP: f64 = 3e-6;

/// Range in which roots are searched: ln λ₃ within ± this.
const FARTHEST: f64 = 12.0;

/// Number of pieces of this range.
const PIECES: usize = 960;

/// λ₃^⅓ − 1 where the pieces end.
static THICKNESSES: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let logarithm = |step: usize| FARTHEST * (2.0 * step as f64 / PIECES as f64 - 1.0);
    let ends = (0..=PIECES).map(|step| (logarithm(step) / 3.0).exp_m1());
    ends.collect()
});

/// 2 (J − 1)/(J + 1), which is ln J to the second order.
#[inline(always)]
fn midpoint_logarithm(area_change: f64) -> f64 {
    2.0 * area_change / (2.0 + area_change)
}

impl<L: BodyLaw> BodySheet<L> {
    /// q = J₃^⅓ − 1 where W_b = 0, at several points at once, each by itself: Newton's method from a series at small strain.
    /// NaN where there is no such thickness.
    ///
    /// A step Δb of ln λ₃ is one of ln J₃, and (1 + q) (1 + Δb/3) is its root to the first order, as far as Newton's method goes.
    #[inline(always)]
    pub(super) fn free_surface<const N: usize>(
        &self,
        area_change: &[f64; N],
        z: &[f64; N],
        shapes: &[L::Shape; N],
    ) -> [f64; N] {
        let mut root = [0.0; N];
        for lane in 0..N {
            root[lane] = self.expected(area_change[lane], z[lane]);
        }
        let mut open = [1_u64; N];
        for _ in 0..MOST_STEPS {
            let mut unconverged = 0;
            for lane in 0..N {
                let w = self.evaluated(area_change[lane], shapes[lane], root[lane]);
                let step = w.b / w.bb.abs();
                let strains = area_change[lane].abs().min(1.0) + root[lane].abs();
                let last = (w.bb > 0.0) & (step.abs() <= LAST_STEP * strains);
                // A step beyond 1 is outside of the range of Newton's method.
                let next = root[lane] - (1.0 + root[lane]) * (step.clamp(-1.0, 1.0) / 3.0);
                root[lane] = if open[lane] == 1 { next } else { root[lane] };
                open[lane] &= u64::from(!last);
                unconverged |= open[lane];
            }
            if unconverged == 0 {
                return root;
            }
        }
        self.searched(area_change, z, shapes, root, open)
    }

    /// The whole series, where its first term alone is known.
    pub(super) fn with_series(mut self) -> Self {
        const SMALL: f64 = 1e-2;
        let first = self.series[0];
        let wide = 2.0 * SMALL / (2.0 - SMALL);
        let narrow = -2.0 * SMALL / (2.0 + SMALL);
        let changes = [wide, narrow, 0.0, wide, narrow];
        let z = [0.0, 0.0, SMALL * SMALL, SMALL * SMALL, SMALL * SMALL];
        let [up, down, aside, up_aside, down_aside] = self
            .free_surface(&changes, &z, &self.shapes(&changes, &z))
            .map(|root| root.ln_1p());
        let cube = (0.5 * (up - down) / SMALL - first) / (SMALL * SMALL);
        let mixed = 0.5 * ((up_aside - down_aside) - (up - down)) / (SMALL * SMALL * SMALL);
        let second = 0.5 * (up + down) / (SMALL * SMALL);
        self.series = [first, second, cube, aside / (SMALL * SMALL), mixed];
        self
    }

    #[inline(always)]
    fn evaluated(&self, area_change: f64, shape: L::Shape, root: f64) -> BodyDerivatives {
        self.law.evaluate(BodyStretches {
            area_change,
            shape,
            volume_root_change: root,
        })
    }

    /// q by the series at small strain; higher orders count as far as they are only a correction.
    #[inline(always)]
    fn expected(&self, area_change: f64, z: f64) -> f64 {
        const MOST: f64 = 0.1;
        let [c1, c2, c3, c4, c5] = self.series;
        let area = midpoint_logarithm(area_change);
        let higher = area * area * (c2 + area * c3) + z * (c4 + area * c5);
        let third_of_volume = c1 * area + higher.clamp(-MOST, MOST);
        // e^x − 1, as exact as a start needs it; above −1.
        third_of_volume * (1.0 + third_of_volume * (0.5 + third_of_volume / 6.0))
    }

    /// The points that are still open, by bisection.
    #[cold]
    #[inline(never)]
    fn searched<const N: usize>(
        &self,
        area_change: &[f64; N],
        z: &[f64; N],
        shapes: &[L::Shape; N],
        mut root: [f64; N],
        open: [u64; N],
    ) -> [f64; N] {
        for lane in (0..N).filter(|lane| open[*lane] == 1) {
            root[lane] = self.bisected(area_change[lane], z[lane], shapes[lane]);
        }
        root
    }

    /// The root at which W_b rises that is nearest to the series of small strain.
    fn bisected(&self, area_change: f64, z: f64, shape: L::Shape) -> f64 {
        let slope = |root: f64| {
            self.law.thickness_slope(BodyStretches {
                area_change,
                shape,
                volume_root_change: root,
            })
        };
        let area = (area_change.ln_1p() / 3.0).exp_m1();
        let position = |step: usize| area + (1.0 + area) * THICKNESSES[step];
        match rising(position, slope, self.expected(area_change, z)) {
            Some(ends) => root_between(ends, slope),
            None => f64::NAN,
        }
    }
}

/// The root of a rising function between two positions: by secants whose end that stays counts half (Illinois), and by halves where they are slow.
fn root_between([mut low, mut high]: [f64; 2], function: impl Fn(f64) -> f64) -> f64 {
    let (mut below, mut above) = (function(low), function(high));
    let mut stayed = 0_i32;
    while high - low > f64::EPSILON * high.abs().max(low.abs()) {
        let secant = high - above * (high - low) / (above - below);
        let is_slow = stayed.abs() > 3;
        let middle = if is_slow || !(low < secant && secant < high) {
            0.5 * (low + high)
        } else {
            secant
        };
        if middle <= low || middle >= high {
            break;
        }
        let value = function(middle);
        if value < 0.0 {
            (low, below) = (middle, value);
            stayed = stayed.max(0) + 1;
            above *= if stayed > 1 { 0.5 } else { 1.0 };
        } else {
            (high, above) = (middle, value);
            stayed = stayed.min(0) - 1;
            below *= if stayed < -1 { 0.5 } else { 1.0 };
        }
        if value == 0.0 {
            break;
        }
    }
    high
}

/// Of the pieces between ascending positions, finds one over which a function rises through zero, and whose middle is
/// nearest to a number. Nearer ones are checked first, and every position once.
fn rising(
    position: impl Fn(usize) -> f64,
    function: impl Fn(f64) -> f64,
    number: f64,
) -> Option<[f64; 2]> {
    let off = |piece: usize| 0.5 * (position(piece) + position(piece + 1)) - number;
    let mut values = vec![None; PIECES + 1];
    let mut value = |step: usize| *values[step].get_or_insert_with(|| function(position(step)));
    let (mut above, mut end) = (0, PIECES);
    while above < end {
        let middle = usize::midpoint(above, end);
        if off(middle) < 0.0 {
            above = middle + 1
        } else {
            end = middle
        }
    }
    let mut below = above;
    while below > 0 || above < PIECES {
        let down = below > 0 && (above == PIECES || -off(below - 1) <= off(above));
        let piece = if down { below - 1 } else { above };
        if value(piece) < 0.0 && value(piece + 1) >= 0.0 {
            return Some([position(piece), position(piece + 1)]);
        }
        if down { below -= 1 } else { above += 1 }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use super::*;

    /// A function that rises through zero in several pieces, and one that never does.
    #[test]
    fn the_nearest_piece_is_found_and_every_place_is_looked_at_once() {
        let position = |step: usize| (0.01 * step as f64 - 4.8).exp_m1();
        for number in [-2.0, -0.9, -0.3, 0.0, 0.7, 11.0, 200.0] {
            for frequency in [0.0, 0.3, 2.0, 9.0] {
                let function = |x: f64| 0.1 + (frequency * x.ln_1p()).sin();
                let seen = RefCell::new(Vec::new());
                let bracket = rising(
                    position,
                    |x| {
                        seen.borrow_mut().push(x);
                        function(x)
                    },
                    number,
                );
                let pieces = (0..PIECES).map(|piece| [position(piece), position(piece + 1)]);
                let all =
                    pieces.filter(|[low, high]| function(*low) < 0.0 && function(*high) >= 0.0);
                let off = |[low, high]: &[f64; 2]| (0.5 * (low + high) - number).abs();
                assert_eq!(bracket, all.min_by(|a, b| off(a).total_cmp(&off(b))));
                let mut seen = seen.into_inner();
                let looks = seen.len();
                seen.sort_unstable_by(f64::total_cmp);
                seen.dedup();
                assert_eq!(seen.len(), looks, "{number} {frequency}");
            }
        }
    }
}
