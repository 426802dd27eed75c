//! The ratio of the change on a grid to that on the grid before.

use crate::corrector::DifferenceScheme;

/// The ratios by which changes shrink from grid to grid, or from mesh to mesh.
#[derive(Clone, Copy, Debug)]
pub struct Ratios {
    /// The ratio where two changes are not known yet.
    pub first: f64,
    /// The range of ratios that are accepted.
    pub believed: [f64; 2],
}

impl Ratios {
    /// The ratios where nothing is known about the cells.
    pub const MEASURED: Self = Self {
        first: 1.0 / 3.0,
        believed: [0.15, 0.7],
    };

    /// On cells that are graded by g errors fall with h^(p + 1), but beside a clamped corner, where the field goes
    /// like r^α, at most with h^(2 α g). Ratios on coarse grids are less accurate than theory: they are accepted only
    /// near it. With 2 α = 1.6, errors of 1,395 plates of three laws, four proportions, both schemes and gradings of
    /// 1.3 to 3 were estimated within a factor of two but for four to twelve, and never by a factor of more than 2.4; those of
    /// 576 plates of four laws, four proportions and gradings of 1.5 to 3 by the bicubic scheme, at its nodes, within 0.56 to 1.53.
    pub fn of_graded(scheme: DifferenceScheme, grading: f64) -> Self {
        let order = (scheme.side() + 1) as f64;
        let ratio = 0.5_f64.powf(order.min(1.6 * grading));
        Self {
            first: ratio,
            believed: [0.8 * ratio, 1.1 * ratio],
        }
    }

    /// The ratio of the size of a change to that of the one before, which is NaN where there was none; the ratio is then unchanged.
    pub fn measured(&self, [before, size]: [f64; 2], ratio: f64) -> f64 {
        let [least, most] = self.believed;
        if before.is_nan() {
            ratio
        } else {
            (size / before).clamp(least, most)
        }
    }
}

/// The sum of d q + d q² + …: the change that all finer grids would add after a change d.
pub fn geometric_tail(change: f64, ratio: f64) -> f64 {
    change * ratio / (1.0 - ratio)
}
