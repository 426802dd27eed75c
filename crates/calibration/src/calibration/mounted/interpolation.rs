//! Interpolation over the strains of both axes between rest and some of the measured ones.

use nalgebra::{DMatrix, DVector};

/// Knots at most.
const MOST_KNOTS: usize = 40;

/// Σ aᵢ |x − xᵢ|³ + a + b·x through values at knots xᵢ, x the strains over the largest ones, with Σ aᵢ = Σ aᵢ xᵢ = 0.
///
/// # References
/// J. Duchon, RAIRO Anal. Numér. 10, 5 (1976)
#[derive(Clone)]
pub struct Interpolation {
    knots: Vec<[f64; 2]>,
    scales: [f64; 2],
    inverse: DMatrix<f64>,
}

/// The values of the functions of the interpolation at some strains.
pub struct Basis(Vec<f64>);

impl Basis {
    /// The value of some coefficients.
    pub fn value(&self, coefficients: &[f64]) -> f64 {
        self.0.iter().zip(coefficients).map(|(a, b)| a * b).sum()
    }
}

/// The largest strains along both axes.
fn scales(strains: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let sizes = strains.iter().map(|one| one[axis].abs());
        let largest = sizes.fold(0.0, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    })
}

impl Interpolation {
    /// With knots at no strain and among some strains: each next one is the farthest from all before, until no one is farther from a knot than
    /// `near`, a share of the largest strains. So what vanishes without strain does so here too, and there are no knots next to it, where a
    /// sheet has forces of the size of their rounding.
    pub fn new(strains: &[[f64; 2]], near: f64) -> Self {
        let scales = scales(strains);
        let distance = |a: &[f64; 2], b: &[f64; 2]| {
            ((a[0] - b[0]) / scales[0]).hypot((a[1] - b[1]) / scales[1])
        };
        let mut knots = vec![[0.0; 2]];
        let mut far: Vec<f64> = strains.iter().map(|one| distance(one, &knots[0])).collect();
        while knots.len() < MOST_KNOTS {
            let farthest = far.iter().zip(strains).max_by(|a, b| a.0.total_cmp(b.0));
            let Some((_, knot)) = farthest.filter(|(far, _)| **far > near) else {
                break;
            };
            knots.push(*knot);
            for (far, one) in far.iter_mut().zip(strains) {
                *far = far.min(distance(one, knot));
            }
        }
        Self::of(knots, scales)
    }

    /// Through values at some strains.
    pub fn through(knots: Vec<[f64; 2]>) -> Self {
        let scales = scales(&knots);
        Self::of(knots, scales)
    }

    fn of(knots: Vec<[f64; 2]>, scales: [f64; 2]) -> Self {
        let mut interpolation = Self {
            knots,
            scales,
            inverse: DMatrix::zeros(0, 0),
        };
        let size = interpolation.knots.len() + 3;
        let mut matrix = DMatrix::zeros(size, size);
        for (row, knot) in interpolation.knots.iter().enumerate() {
            for (column, value) in interpolation.basis(*knot).0.into_iter().enumerate() {
                matrix[(row, column)] = value;
                if column + 3 >= size {
                    matrix[(column, row)] = value;
                }
            }
        }
        // Knots on a line do not determine the plane: the flattest one is taken.
        interpolation.inverse = matrix
            .pseudo_inverse(1e-10)
            .expect("a tolerance above zero");
        interpolation
    }

    /// The strains at which values are given.
    pub fn knots(&self) -> &[[f64; 2]] {
        &self.knots
    }

    /// The coefficients of values at the knots.
    pub fn coefficients(&self, mut values: Vec<f64>) -> Vec<f64> {
        values.resize(self.knots.len() + 3, 0.0);
        (&self.inverse * DVector::from_vec(values)).data.into()
    }

    /// The functions at some strains.
    pub fn basis(&self, strains: [f64; 2]) -> Basis {
        let [x, y] = [0, 1].map(|axis| strains[axis] / self.scales[axis]);
        let radial = self.knots.iter().map(|knot| {
            let far = (x - knot[0] / self.scales[0]).hypot(y - knot[1] / self.scales[1]);
            far.powi(3)
        });
        Basis(radial.chain([1.0, x, y]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rays of five ratios, as protocols are; what lies on them is interpolated to a thousandth of its range.
    #[test]
    fn smooth_functions_are_interpolated_along_protocols() {
        let rays = [[1.0, 1.0], [1.0, 0.75], [0.75, 1.0], [1.0, 0.5], [0.5, 1.0]];
        let strains: Vec<[f64; 2]> = rays
            .iter()
            .flat_map(|ray| (0..=60).map(|i| ray.map(|x| 0.2 * x * f64::from(i) / 60.0)))
            .collect();
        let interpolation = Interpolation::new(&strains, 0.07);
        assert!(interpolation.knots().len() <= MOST_KNOTS);
        let function = |[x, y]: [f64; 2]| 0.3 + x - 2.0 * y + 8.0 * x * y + (4.0 * x).exp();
        let values = interpolation.knots().iter().map(|knot| function(*knot));
        let coefficients = interpolation.coefficients(values.collect());
        for one in &strains {
            let result = interpolation.basis(*one).value(&coefficients);
            assert!((result - function(*one)).abs() < 3e-3, "{one:?} {result}");
        }
    }

    /// One protocol is a line.
    #[test]
    fn knots_on_a_line_suffice_for_what_lies_on_it() {
        let strains: Vec<[f64; 2]> = (0..=50).map(|i| [0.004 * f64::from(i); 2]).collect();
        let interpolation = Interpolation::new(&strains, 0.07);
        let values = interpolation.knots().iter().map(|knot| knot[0].exp());
        let coefficients = interpolation.coefficients(values.collect());
        for one in &strains {
            let result = interpolation.basis(*one).value(&coefficients);
            assert!((result - one[0].exp()).abs() < 3e-5, "{one:?} {result}");
        }
    }
}
