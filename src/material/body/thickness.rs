//! The thickness of a sheet with free surfaces: W_b = 0.

use super::{BodyLaw, BodySheet};

/// Steps of Newton's method before the root is looked for between bounds.
const MOST_STEPS: usize = 40;

/// A step of this size, in parts of |a| + |b|, is the last one: its square is not larger than rounding.
const LAST_STEP: f64 = 3e-8;

/// Where roots are looked for: ln λ₃ within ± this.
const FARTHEST: f64 = 12.0;

/// How finely.
const PIECES: i32 = 480;

impl<L: BodyLaw> BodySheet<L> {
    /// ln λ₃ where W_b = 0, at several points at once, each by itself: Newton's method from a series at small strain.
    /// Not a number where there is no such thickness.
    #[inline(always)]
    pub(super) fn free_surface<const N: usize>(
        &self,
        area: &[f64; N],
        shape: &[f64; N],
    ) -> [f64; N] {
        let mut thickness = [0.0; N];
        for lane in 0..N {
            thickness[lane] = self.expected(area[lane], shape[lane]);
        }
        let mut open = [1_u64; N];
        for _ in 0..MOST_STEPS {
            let mut left = 0;
            for lane in 0..N {
                let w = self.evaluated(area[lane], shape[lane], thickness[lane]);
                let step = w.b / w.bb.abs();
                let small = LAST_STEP * (area[lane].abs() + thickness[lane].abs());
                let last = (w.bb > 0.0) & (step.abs() <= small);
                // A step beyond 1 is none of Newton's method any more.
                let next = thickness[lane] - step.clamp(-1.0, 1.0);
                thickness[lane] = if open[lane] == 1 {
                    next
                } else {
                    thickness[lane]
                };
                open[lane] &= u64::from(!last);
                left |= open[lane];
            }
            if left == 0 {
                return thickness;
            }
        }
        self.searched(area, shape, thickness, open)
    }

    /// b by its series at small strain; the second order counts as far as it is no more than a correction.
    #[inline(always)]
    fn expected(&self, area: f64, shape: f64) -> f64 {
        const MOST: f64 = 0.3;
        let [first, second, third] = self.series;
        first * area + (second * area * area + third * shape).clamp(-MOST, MOST)
    }

    /// The points that are still open, by bisection.
    #[cold]
    #[inline(never)]
    fn searched<const N: usize>(
        &self,
        area: &[f64; N],
        shape: &[f64; N],
        mut thickness: [f64; N],
        open: [u64; N],
    ) -> [f64; N] {
        for lane in (0..N).filter(|lane| open[*lane] == 1) {
            thickness[lane] = self.bisected(area[lane], shape[lane]);
        }
        thickness
    }

    /// The root at which W_b rises that is nearest to the series of small strain.
    fn bisected(&self, area: f64, shape: f64) -> f64 {
        let slope = |thickness: f64| {
            let w = self.evaluated(area, shape, thickness);
            if w.energy.is_finite() { w.b } else { f64::NAN }
        };
        let expected = self.expected(area, shape);
        let place = |piece: i32| FARTHEST * f64::from(piece) / f64::from(PIECES);
        let pieces = (-PIECES..PIECES).map(|piece| [place(piece), place(piece + 1)]);
        let rising = pieces.filter(|[low, high]| slope(*low) < 0.0 && slope(*high) >= 0.0);
        let off = |[low, high]: &[f64; 2]| (0.5 * (low + high) - expected).abs();
        let Some([mut low, mut high]) = rising.min_by(|a, b| off(a).total_cmp(&off(b))) else {
            return f64::NAN;
        };
        while high - low > f64::EPSILON * high.abs().max(low.abs()) {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            match slope(middle) < 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        high
    }
}
