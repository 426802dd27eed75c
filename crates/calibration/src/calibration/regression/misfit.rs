//! The residuals of a law at the observations of some tests.

use nalgebra::{DMatrix, DVector};

use super::reweighed::Reweighed;
use crate::calibration::data::{FoundZero, Observation, TestData};
use crate::calibration::least_squares::{self, Measured, Residuals};
use crate::calibration::settings::{MEASURE, Weighting};
use crate::material::HyperelasticLaw;
use crate::material::parameters::CardEntries;
use crate::material::registry::Law;

/// Rows of the residuals along a curve, with the strain that they are drawn over.
pub type Rows = Vec<(usize, f64)>;

/// The residuals of a law at some observations, or at means of many neighbouring ones.
pub struct Misfit<'a> {
    law: &'static Law,
    tests: &'a [TestData],
    weighting: Weighting,
    points: Vec<Point>,
    /// How many values are the law's.
    law_values: usize,
    /// Zeros that are found with the law.
    zeros: Vec<Zero>,
}

/// The zero of a test that is found with the law: its value, behind those of the law, is 1 + by/scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    pub test: usize,
    /// The largest strain, or stress in MPa.
    pub scale: f64,
}

impl Zero {
    /// By how much a value moves it: strain, or stress in MPa.
    pub fn by(self, value: f64) -> f64 {
        self.scale * (value - 1.0)
    }
}

/// An observation of a test with its weight.
#[derive(Clone, Copy)]
struct Point {
    test: usize,
    observation: Observation,
    weight: f64,
}

/// Tests with more observations than this along one axis are gathered in as many bins. A curve bends so
/// little within one that its parameters do not feel it.
const BINS: usize = 2000;

impl<'a> Misfit<'a> {
    /// Residuals weighted by the measured stresses.
    pub fn new(law: &'static Law, tests: &'a [TestData], weighting: Weighting) -> Self {
        Self::weighted(law, tests, weighting, &|_, one| one.stress)
    }

    /// Residuals weighted by some stress of every observation.
    fn weighted(
        law: &'static Law,
        tests: &'a [TestData],
        weighting: Weighting,
        stress: &dyn Fn(usize, &Observation) -> f64,
    ) -> Self {
        let mut points = Vec::new();
        for (test, data) in tests.iter().enumerate() {
            for axis in [0, 1] {
                let along = data.observations.iter().filter(|one| one.axis == axis);
                let mut own: Vec<Point> = along
                    .map(|observation| Point {
                        test,
                        observation: *observation,
                        weight: weighting.weight_of(data, stress(test, observation)),
                    })
                    .collect();
                if own.len() > BINS {
                    let strain = |point: &Point| data.drawn_strain(&point.observation);
                    own.sort_by(|a, b| strain(a).total_cmp(&strain(b)));
                    own = own.chunks(own.len().div_ceil(BINS)).map(mean).collect();
                }
                points.extend(own);
            }
        }
        let measure = tests[0].stress_measure;
        let (_, entries) = law.with_values(&[], measure, MEASURE);
        Self {
            law,
            tests,
            weighting,
            points,
            law_values: entries.parameters.len(),
            zeros: Vec::new(),
        }
    }

    /// The same with the zeros as values that were found in the records.
    pub fn with_zeros(&self) -> Self {
        let zero = |(test, data): (usize, &TestData)| {
            let strains = data.observations.iter().map(|one| data.drawn_strain(one));
            let scale = match data.found_zero? {
                FoundZero::Strain { .. } => strains.fold(0.0, |most: f64, x| most.max(x.abs())),
                FoundZero::Stress { .. } => data.largest_stress,
            };
            Some(Zero { test, scale })
        };
        Self {
            points: self.points.clone(),
            zeros: self.tests.iter().enumerate().filter_map(zero).collect(),
            ..*self
        }
    }

    /// The zeros whose values stand behind those of the law.
    pub fn zeros(&self) -> &[Zero] {
        &self.zeros
    }

    /// The tests with the zeros that some values give them.
    pub fn moved_tests(&self, values: &[f64]) -> Vec<TestData> {
        let tests = self.tests.iter().enumerate();
        tests
            .map(|(test, data)| data.with_zero_moved(self.moved(values, test)))
            .collect()
    }

    /// By how much some values move the zero of a test.
    fn moved(&self, values: &[f64], test: usize) -> f64 {
        let own = self.zeros.iter().position(|zero| zero.test == test);
        own.map_or(0.0, |place| {
            self.zeros[place].by(values[self.law_values + place])
        })
    }

    /// Every n-th point, so that about `count` are left.
    pub fn thinned(&self, count: usize) -> Self {
        let stride = self.points.len().div_ceil(count);
        Self {
            points: self.points.iter().copied().step_by(stride).collect(),
            zeros: self.zeros.clone(),
            ..*self
        }
    }

    pub fn build(&self, values: &[f64]) -> (Box<dyn HyperelasticLaw>, CardEntries) {
        let measure = self.tests[0].stress_measure;
        let own = &values[..values.len().min(self.law_values)];
        self.law.with_values(own, measure, MEASURE)
    }

    /// The rows along each axis of each test, with the strain that they are drawn over.
    pub fn curves(&self) -> Vec<Rows> {
        let mut curves: Vec<(usize, usize, Rows)> = Vec::new();
        for (row, point) in self.points.iter().enumerate() {
            let (test, axis) = (point.test, point.observation.axis);
            let place = (row, self.tests[test].drawn_strain(&point.observation));
            match curves.last_mut() {
                Some((t, a, rows)) if (*t, *a) == (test, axis) => rows.push(place),
                _ => curves.push((test, axis, vec![place])),
            }
        }
        curves.into_iter().map(|(.., rows)| rows).collect()
    }

    fn predict(&self, law: &dyn HyperelasticLaw, point: &Point) -> f64 {
        self.tests[point.test].stress_of(law, &point.observation)
    }

    /// A stress to draw from: the secant of the data, Σ |σ| |x| / Σ x².
    pub fn stiffness(&self) -> f64 {
        let (mut product, mut square) = (0.0, f64::MIN_POSITIVE);
        for point in &self.points {
            let x = self.tests[point.test].drawn_strain(&point.observation);
            product += (point.observation.stress * x).abs();
            square += x * x;
        }
        (product / square).max(f64::MIN_POSITIVE)
    }

    /// The values of the parameters that are stresses, by linear least squares.
    pub fn complete(&self, values: &mut [f64], stresses: &[usize]) -> Option<()> {
        let target = self.points.iter();
        let target = target.map(|point| point.weight * point.observation.stress);
        let target = DVector::from_iterator(self.points.len(), target);
        let mut columns = DMatrix::zeros(self.points.len(), stresses.len());
        for (column, index) in stresses.iter().enumerate() {
            let mut unit = values.to_vec();
            stresses.iter().for_each(|other| unit[*other] = 0.0);
            unit[*index] = 1.0;
            let (law, _) = self.build(&unit);
            for (row, point) in self.points.iter().enumerate() {
                columns[(row, column)] = point.weight * self.predict(&*law, point);
            }
        }
        let found = least_squares::linear(&columns, &target)?;
        for (index, value) in stresses.iter().zip(found.iter()) {
            values[*index] = *value;
        }
        Some(())
    }
}

/// The mean of some points by their weights; it weighs as all of them together.
fn mean(points: &[Point]) -> Point {
    let squares: f64 = points.iter().map(|point| point.weight * point.weight).sum();
    let mean = |value: &dyn Fn(&Observation) -> f64| -> f64 {
        let sum = points.iter();
        let sum = sum.map(|point| point.weight * point.weight * value(&point.observation));
        sum.sum::<f64>() / squares
    };
    Point {
        test: points[0].test,
        observation: Observation {
            strains: [0, 1].map(|axis| mean(&|one| one.strains[axis])),
            axis: points[0].observation.axis,
            stress: mean(&|one| one.stress),
        },
        weight: squares.sqrt(),
    }
}

impl Residuals for Misfit<'_> {
    fn count(&self) -> usize {
        self.points.len()
    }

    fn evaluate(&self, parameters: &[f64], residuals: &mut [f64]) -> bool {
        let (law, _) = self.build(parameters);
        for (residual, point) in residuals.iter_mut().zip(&self.points) {
            let data = &self.tests[point.test];
            let one = data.moved(&point.observation, self.moved(parameters, point.test));
            *residual = point.weight * (one.stress - data.stress_of(&*law, &one));
            if !residual.is_finite() {
                return false;
            }
        }
        true
    }
}

impl Reweighed for Misfit<'_> {
    fn reweighed(&self, values: &[f64]) -> Self {
        let (law, _) = self.build(values);
        let stress = |test: usize, one: &Observation| {
            let data = &self.tests[test];
            data.stress_of(&*law, &data.moved(one, self.moved(values, test)))
        };
        Self {
            zeros: self.zeros.clone(),
            ..Self::weighted(self.law, self.tests, self.weighting, &stress)
        }
    }

    fn is_relative(&self) -> bool {
        self.weighting == Weighting::Relative
    }

    fn measured(&self) -> Vec<Measured> {
        let measured = |point: &Point| Measured {
            stress: point.observation.stress,
            weight: point.weight,
            count: 1.0,
        };
        self.points.iter().map(measured).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Statements;

    const TEXT: &str =
        "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n1.2,0.05\n1.6,0.13\n2.0,0.15\n";

    fn tests() -> [TestData; 1] {
        [TestData::parse("a.csv", TEXT, &Statements::new()).unwrap()]
    }

    /// Σ w² f σ/Σ w² f² with the slope f = 2 (λ − λ⁻²), and the secant Σ |σ x|/Σ x².
    #[test]
    fn parameters_that_are_stresses_are_completed_by_weighted_linear_regression() {
        let tests = tests();
        let law = Law::named("neo-hooke").unwrap();
        let data = [(1.2_f64, 0.05_f64), (1.6, 0.13), (2.0, 0.15)];
        for weighting in [Weighting::Absolute, Weighting::Relative] {
            let sum = |value: &dyn Fn(f64, f64) -> f64| -> f64 {
                let weight = |stress: f64| match weighting {
                    Weighting::Absolute => 1.0,
                    Weighting::Relative => stress.powi(-2),
                };
                let slope = |l: f64| 2.0 * (l - l.powi(-2));
                data.iter()
                    .map(|(l, s)| weight(*s) * value(slope(*l), *s))
                    .sum()
            };
            let mut values = [7.0];
            let misfit = Misfit::new(law, &tests, weighting);
            misfit.complete(&mut values, &[0]).unwrap();
            let expected = sum(&|f, s| f * s) / sum(&|f, _| f * f);
            assert!((values[0] / expected - 1.0).abs() < 1e-12, "{weighting:?}");
            let products: f64 = data.iter().map(|(l, s)| (l - 1.0) * s).sum();
            let squares: f64 = data.iter().map(|(l, _)| (l - 1.0) * (l - 1.0)).sum();
            assert!((misfit.stiffness() / (products / squares) - 1.0).abs() < 1e-12);
        }
    }

    /// The mean pulls on a line as the points do together: Σ w² (σ − s)² differs by a constant.
    #[test]
    fn the_mean_of_points_weighs_as_all_of_them() {
        let observation = tests()[0].observations[0];
        let point = |stress: f64, weight: f64| Point {
            test: 0,
            observation: Observation {
                stress,
                ..observation
            },
            weight,
        };
        let points = [point(1.0, 2.0), point(4.0, 1.0)];
        let found = mean(&points);
        assert!((found.observation.stress - 1.6).abs() < 1e-15);
        assert!((found.weight - 5.0_f64.sqrt()).abs() < 1e-15);
    }
}
