//! The strain at which a specimen begins to be stretched: slack and preload of a record.
//!
//! ```text
//! y = y₀ + b ⟨x − x₀⟩ + c ⟨x − x₀⟩²,   ⟨x⟩ = max(x, 0)
//! ```
//!
//! is fitted to the beginning of a loading branch by least squares, with a search for x₀. The specimen was slack up
//! to x₀ if this is far nearer than the same curve without a bend, and if the force before it does not rise: a
//! material that is soft at first has no such bend. Where there is no slack and a force acts at once, it is a
//! preload, and the zero is where the curve, extrapolated backwards, has no force: x₀ − y₀/b.

use nalgebra::{DMatrix, DVector};

use crate::calibration::least_squares::linear;
use crate::statistics::{farthest, inverse, median};

/// The beginning of a branch ends at this share of its largest stress.
const BEGINNING: f64 = 0.2;
/// Fewest rows that determine anything.
const FEWEST: usize = 12;
/// More rows are thinned.
const MOST: usize = 400;
/// Fewest rows on either side of a bend.
const SIDE_ROWS: usize = 5;
/// The least F of the improvement by a bend.
const SIGNIFICANT: f64 = 30.0;
/// Values below this share of the largest stress count as zero.
const NEGLIGIBLE: f64 = 5e-4;

/// A bend before the first row.
const START: f64 = -1e-9;

/// What was found at the beginning of a branch; strains and stresses of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Beginning {
    /// Stress rises from zero at the first row.
    Clean,
    /// The same at a strain that is not zero: the machine counts its position from another point.
    Elsewhere(f64),
    /// The specimen was slack.
    Slack {
        /// The strain at which it begins to be stretched.
        zero: f64,
        /// Its standard error.
        error: f64,
        /// The reading of the stress without load.
        offset: f64,
        /// Its standard error.
        offset_error: f64,
    },
    /// A stress acted at the first row.
    Preload {
        /// The strain at which the curve, extrapolated backwards, has no stress.
        zero: f64,
        /// The stress at the first row.
        stress: f64,
    },
    /// The first stress is opposite to the pull, as in a load cell that was not set to zero.
    Offset(f64),
}

/// A zero that was found at the beginning of a machine's record: it is uncertain, so that it is determined again with the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FoundZero {
    /// The zero of strain, on a specimen of this length in mm.
    Strain {
        /// The length.
        length: f64,
        /// The standard error in MPa of the stress without load, which was subtracted; zero where none was.
        offset_error: f64,
    },
    /// The zero of stress, on a specimen of this cross-section in mm².
    Stress {
        /// The cross-section.
        area: f64,
    },
}

impl FoundZero {
    /// The zero of strain where no stress was subtracted.
    pub fn strain(length: f64) -> Self {
        Self::Strain {
            length,
            offset_error: 0.0,
        }
    }
}

/// Columns of the curve that bends at a strain.
fn columns(x: &[f64], bend: f64) -> DMatrix<f64> {
    DMatrix::from_fn(x.len(), 3, |row, column| match column {
        0 => 1.0,
        _ => (x[row] - bend).max(0.0).powi(column as i32),
    })
}

/// A curve that was fitted, with its sum of squares.
struct Bent {
    coefficients: DVector<f64>,
    sum: f64,
}

fn bent(x: &[f64], y: &DVector<f64>, bend: f64) -> Option<Bent> {
    let columns = columns(x, bend);
    let coefficients = linear(&columns, y)?;
    let sum = (&columns * &coefficients - y).norm_squared();
    Some(Bent { coefficients, sum })
}

impl Beginning {
    /// The beginning of a loading branch.
    pub fn of(strains: &[f64], stresses: &[f64]) -> Self {
        /// Share of the strains up to which they begin at zero.
        const NEAR: f64 = 0.05;
        let largest = farthest(stresses.iter().copied()).abs();
        let is_unloaded = match Self::search(strains, stresses) {
            Some(Self::Clean) => true,
            Some(shown) => return shown,
            None => stresses[0].abs() <= NEGLIGIBLE * largest,
        };
        match strains {
            [first, .., last] if is_unloaded && first.abs() > NEAR * (last - first).abs() => {
                Self::Elsewhere(*first)
            }
            _ => Self::Clean,
        }
    }

    /// The beginning by curves that are fitted to it, `Clean` where the first row has no stress within its noise; `None` where they determine nothing.
    fn search(strains: &[f64], stresses: &[f64]) -> Option<Self> {
        let (first, last) = (*strains.first()?, *strains.last()?);
        let direction = (last - first).signum();
        let initial = median(stresses.iter().copied().take(SIDE_ROWS));
        let top = farthest(stresses.iter().map(|y| y - initial));
        let rises = |y: &f64| (y - initial) / top > BEGINNING;
        let rows = stresses.iter().position(rises)? + 1;
        if rows < FEWEST || top == 0.0 {
            return None;
        }
        let stride = rows.div_ceil(MOST);
        let thin = |values: &[f64]| {
            values[..rows]
                .iter()
                .copied()
                .step_by(stride)
                .collect::<Vec<_>>()
        };
        // Both rise from zero to about one.
        let width = (strains[rows - 1] - first) * direction;
        if width <= 0.0 {
            return None;
        }
        let x: Vec<f64> = thin(strains)
            .iter()
            .map(|x| (x - first) * direction / width)
            .collect();
        let y = DVector::from_vec(thin(stresses)) / top;
        let plain = bent(&x, &y, START)?;
        let slack = slack(&x, &y, &plain);
        if let Some(bend) = slack {
            return Some(Self::Slack {
                zero: first + direction * width * bend.position,
                error: width * bend.error,
                offset: bend.level * top,
                offset_error: (bend.level_error * top).abs(),
            });
        }
        Self::loaded(
            &x,
            &y,
            top,
            [first, direction * width],
            (last - first).abs(),
        )
    }

    /// Whether a stress acts at the first row; strains are `first` + `width` x.
    fn loaded(
        x: &[f64],
        y: &DVector<f64>,
        top: f64,
        [first, width]: [f64; 2],
        range: f64,
    ) -> Option<Self> {
        // The first quarter alone: a curve that stiffens is not a parabola.
        let near = (x.len() / 4).max(FEWEST);
        let (x, y) = (&x[..near], y.rows(0, near).into_owned());
        let plain = bent(x, &y, START)?;
        let variance = plain.sum / (near - 3) as f64;
        let columns = columns(x, START);
        let error = (inverse(&columns.tr_mul(&columns), 1e-13)?[(0, 0)] * variance).sqrt();
        let (at_rest, slope) = (plain.coefficients[0], plain.coefficients[1]);
        if at_rest.abs() <= 4.0 * error + NEGLIGIBLE {
            return Some(Self::Clean);
        }
        let (back, stress) = (width * at_rest / slope, at_rest * top);
        if at_rest > 0.0 {
            let zero = first - back;
            (slope > 0.0 && back.abs() < 0.25 * range).then_some(Self::Preload { zero, stress })
        } else {
            Some(Self::Offset(stress))
        }
    }
}

/// Where a curve bends, and the level before, with their standard errors.
struct Bend {
    position: f64,
    error: f64,
    level: f64,
    level_error: f64,
}

/// The bend where the specimen was slack.
fn slack(x: &[f64], y: &DVector<f64>, plain: &Bent) -> Option<Bend> {
    let n = x.len();
    if (plain.sum / n as f64).sqrt() < NEGLIGIBLE {
        return None;
    }
    let sum = |bend: f64| bent(x, y, bend).map_or(f64::INFINITY, |result| result.sum);
    let inner = SIDE_ROWS..n.checked_sub(SIDE_ROWS)?;
    let best = inner.map(|row| (sum(x[row]), row));
    let (_, row) = best.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let bend = golden(&sum, [x[row - 1], x[row + 1]]);
    let result = bent(x, y, bend)?;
    let variance = result.sum / (n - 4) as f64;
    if plain.sum - result.sum < SIGNIFICANT * variance {
        return None;
    }
    let before: Vec<usize> = (0..n).filter(|row| x[*row] < bend).collect();
    if before.len() < SIDE_ROWS {
        return None;
    }
    // The force before the bend must not rise: neither by more than noise nor by a fiftieth of what follows.
    let line = DMatrix::from_fn(before.len(), 2, |i, column| {
        x[before[i]].powi(column as i32)
    });
    let level = DVector::from_fn(before.len(), |i, _| y[before[i]]);
    let flat = linear(&line, &level)?;
    let spread = (inverse(&line.tr_mul(&line), 1e-13)?[(1, 1)] * variance).sqrt();
    let after = (y[n - 1] - result.coefficients[0]) / (x[n - 1] - bend);
    if flat[1].abs() > 3.0 * spread + 0.02 * after {
        return None;
    }
    let (b, c) = (result.coefficients[1], result.coefficients[2]);
    // A bend, rather than a parabola that begins there.
    if b < 0.3 * after {
        return None;
    }
    let mut all = columns(x, bend).insert_column(3, 0.0);
    for row in 0..n {
        if x[row] > bend {
            all[(row, 3)] = -b - 2.0 * c * (x[row] - bend);
        }
    }
    let inverse = inverse(&all.tr_mul(&all), 1e-13)?;
    let [level_error, error] = [0, 3].map(|i| (inverse[(i, i)] * variance).sqrt());
    (error <= 0.2 * bend).then_some(Bend {
        position: bend,
        error,
        level: result.coefficients[0],
        level_error,
    })
}

/// The minimum of a function between two arguments, to a millionth of their distance, by golden sections.
fn golden(value: &dyn Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    const SHARE: f64 = 0.618_033_988_749_894_9;
    for _ in 0..30 {
        let (a, b) = (high - SHARE * (high - low), low + SHARE * (high - low));
        if value(a) < value(b) {
            high = b
        } else {
            low = a
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(row: usize) -> f64 {
        (12.9898 * row as f64).sin() + (78.233 * row as f64).cos()
    }

    fn record(curve: &dyn Fn(f64) -> f64, scatter: f64) -> (Vec<f64>, Vec<f64>) {
        let x: Vec<f64> = (0..400).map(|i| f64::from(i) / 400.0).collect();
        let y = x.iter().enumerate();
        let y = y.map(|(row, x)| curve(*x) + scatter * noise(row));
        let y = y.collect();
        (x, y)
    }

    #[test]
    fn slack_is_found_with_its_uncertainty_in_tension_and_compression() {
        for sign in [1.0, -1.0] {
            let curve =
                |x: f64| 0.05 + sign * ((x - 0.13).max(0.0) + 0.8 * (x - 0.13).max(0.0).powi(2));
            let (x, y) = record(&curve, 3e-3);
            let x: Vec<f64> = x.iter().map(|x| sign * x).collect();
            let Beginning::Slack {
                zero,
                error,
                offset,
                offset_error,
            } = Beginning::of(&x, &y)
            else {
                panic!("{:?}", Beginning::of(&x, &y));
            };
            assert!(
                (sign * zero - 0.13).abs() < 4.0 * error && error < 0.01,
                "{zero} ± {error}"
            );
            assert!((offset - 0.05).abs() < 4.0 * offset_error && offset_error < 1e-3);
        }
    }

    /// Soft tissue: exponentials are no slack, however soft they begin.
    #[test]
    fn a_soft_beginning_is_no_slack() {
        for exponent in [0.1, 2.0, 5.0, 10.0, 15.0] {
            for scatter in [0.0, 1e-4, 1e-3] {
                let curve = |x: f64| (exponent * x).exp_m1() / f64::exp_m1(exponent);
                let (x, y) = record(&curve, scatter);
                let result = Beginning::of(&x, &y);
                assert_eq!(result, Beginning::Clean, "{exponent} {scatter}");
                // A machine's position that begins elsewhere.
                let from = x
                    .iter()
                    .map(|x| x + 1.5 - f64::from(u8::from(scatter > 0.0)));
                let from: Vec<f64> = from.collect();
                let moved = Beginning::of(&from, &y);
                assert_eq!(moved, Beginning::Elsewhere(from[0]), "{exponent} {scatter}");
            }
        }
    }

    #[test]
    fn preload_is_followed_back_and_a_load_cell_set_right() {
        let (x, y) = record(&|x| 2.0 * (x + 0.03) + 0.5 * (x + 0.03).powi(2), 1e-3);
        let Beginning::Preload { zero, stress } = Beginning::of(&x, &y) else {
            panic!("{:?}", Beginning::of(&x, &y));
        };
        assert!(
            (zero + 0.03).abs() < 2e-3 && (stress - 0.06).abs() < 2e-3,
            "{zero} {stress}"
        );
        let (x, y) = record(&|x| 2.0 * x - 0.1, 1e-3);
        let result = Beginning::of(&x, &y);
        assert!(
            matches!(result, Beginning::Offset(y) if (y + 0.1).abs() < 2e-3),
            "{result:?}"
        );
    }
}
