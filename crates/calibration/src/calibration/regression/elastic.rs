//! A law alone as the model of tests, with zeros of strain or stress that are found with it.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::DMatrix;

use super::linear::{Bend, Linear};
use super::misfit::{Estimated, Misfit, Response, Row, at_bound};
use super::zero::Zero;
use crate::calibration::data::{Observation, TestData};
use crate::calibration::least_squares::{self, LEAST_SIZE};
use crate::calibration::settings::MEASURE;
use crate::material::HyperelasticLaw;
use crate::material::parameters::CardEntries;
use crate::material::registry::Law;

/// Tests with more observations than this along one axis are gathered in as many bins. A curve bends so
/// little within one that its parameters do not feel it.
const BINS: usize = 2000;

/// A law as a model of tests. Its values are the parameters, followed by the zeros that are found with it.
#[derive(Clone)]
pub struct Elastic<'a> {
    law: &'static Law,
    /// The curve of a law that takes it as it is.
    curve: Option<Arc<dyn HyperelasticLaw>>,
    tests: &'a [TestData],
    /// What is fitted, with the test of each.
    points: Vec<Row>,
    observations: Vec<Observation>,
    /// How many values are the law's.
    law_values: usize,
    /// Zeros whose values follow those of the law.
    zeros: Vec<Zero>,
    /// The part of the stresses in addition to those of the law.
    linear: Option<Arc<Linear>>,
    /// A stress to draw from: the secant of the data, Σ |σ| |x| / Σ x², in MPa.
    pub stiffness: f64,
    /// The least significant size of each parameter.
    least: Vec<f64>,
}

impl<'a> Elastic<'a> {
    /// A law at all observations, or at means of many neighbouring ones.
    pub fn new(law: &'static Law, tests: &'a [TestData]) -> Self {
        let mut points = Vec::new();
        for (test, data) in tests.iter().enumerate() {
            let protocols = data.protocols();
            for axis in [0, 1] {
                let is_along = |one: &&Observation| one.axis == axis;
                let count = data.observations.iter().filter(is_along).count();
                let each = count.div_ceil(BINS).max(1);
                // States of two protocols may share a stretch and differ in the other one.
                for protocol in &protocols {
                    let rows = protocol.iter().filter(is_along);
                    let mut along: Vec<Observation> = rows.copied().collect();
                    if each > 1 {
                        let strain = |one: &Observation| data.drawn_strain(one);
                        along.sort_by(|a, b| strain(a).total_cmp(&strain(b)));
                    }
                    points.extend(along.chunks(each).map(|bin| point(test, data, bin)));
                }
            }
        }
        Self::of_points(law, tests, points)
    }

    fn of_points(
        law: &'static Law,
        tests: &'a [TestData],
        points: Vec<(Row, Observation)>,
    ) -> Self {
        let (mut product, mut square) = (0.0, f64::MIN_POSITIVE);
        for (row, _) in &points {
            product += (row.stress * row.position).abs();
            square += row.position * row.position;
        }
        let stiffness = (product / square).max(f64::MIN_POSITIVE);
        let entries = law
            .with_values(&[], tests[0].stress_measure, MEASURE)
            .1
            .parameters;
        let (points, observations) = points.into_iter().unzip();
        Self {
            law,
            curve: None,
            tests,
            points,
            observations,
            law_values: entries.len(),
            zeros: Vec::new(),
            linear: None,
            stiffness,
            least: entries
                .iter()
                .map(|one| one.least_size(stiffness))
                .collect(),
        }
    }

    /// A law that takes a curve as it is.
    pub fn of_curve(
        law: &'static Law,
        tests: &'a [TestData],
        curve: Arc<dyn HyperelasticLaw>,
    ) -> Self {
        Self {
            curve: Some(curve),
            ..Self::new(law, tests)
        }
    }

    /// The same with the zeros as values that are found with the law.
    pub fn with_zeros(&self) -> Self {
        Self {
            zeros: Zero::of(self.tests),
            ..self.clone()
        }
    }

    /// The same with a part that is linear in the values about `at`; `linear` returns its derivatives at an observation, and the ratio of the
    /// measured stress to that of the observation.
    pub fn with_linear(
        mut self,
        at: Vec<f64>,
        linear: impl Fn(&Observation) -> (Vec<f64>, f64),
    ) -> Self {
        let (rows, factors): (Vec<Vec<f64>>, Vec<f64>) =
            self.observations.iter().map(linear).unzip();
        for (point, factor) in self.points.iter_mut().zip(factors) {
            point.factor = factor;
        }
        let linear = Linear {
            at,
            rows,
            bend: None,
        };
        Self {
            linear: Some(Arc::new(linear)),
            ..self
        }
    }

    /// The same with a part that is quadratic in the direction of other values, by which the stresses there are the measured ones of `other`;
    /// `sizes` are those of the values.
    pub fn bent(self, values: &[f64], other: &Elastic, sizes: &[f64]) -> Self {
        let Some(linear) = self.linear.as_deref() else {
            return self;
        };
        let direction = values.iter().zip(&linear.at).map(|(to, from)| to - from);
        let shares: Vec<f64> = direction.zip(sizes).map(|(by, size)| by / size).collect();
        let square: f64 = shares.iter().map(|share| share * share).sum();
        let weights = shares.iter().zip(sizes);
        let modelled = self.stresses(values);
        let differences = modelled.iter().enumerate();
        let bend = Bend {
            weights: weights.map(|(share, size)| share / size / square).collect(),
            rows: differences
                .map(|(row, stress)| other.measured(values, row) - stress)
                .collect(),
        };
        let linear = Linear {
            bend: (square > 0.0).then_some(bend),
            ..linear.clone()
        };
        Self {
            linear: Some(Arc::new(linear)),
            ..self
        }
    }

    /// Every n-th point, so that about `count` are left.
    pub fn thinned(&self, count: usize) -> Self {
        let stride = self.points.len().div_ceil(count);
        let rows = self.points.iter().copied();
        let points = rows.zip(self.observations.iter().copied());
        Self::of_points(self.law, self.tests, points.step_by(stride).collect())
    }

    /// The law of some values with the entries of its card.
    pub fn build(&self, values: &[f64]) -> (Box<dyn HyperelasticLaw>, CardEntries) {
        let measure = self.tests[0].stress_measure;
        let of_law = &values[..values.len().min(self.law_values)];
        self.law.with_values(of_law, measure, MEASURE)
    }

    /// An observation of a test with the zeros of some values.
    fn moved(&self, values: &[f64], test: usize, observation: &Observation) -> Observation {
        let of_zeros = values.iter().skip(self.law_values);
        let pairs = self.zeros.iter().zip(of_zeros);
        pairs.fold(*observation, |one, (zero, value)| {
            zero.moved(*value, (test, &self.tests[test]), &one)
        })
    }
}

/// The mean of neighbouring observations of a test.
fn point(test: usize, data: &TestData, bin: &[Observation]) -> (Row, Observation) {
    let observation = Observation::mean(bin);
    let position = data.drawn_strain(&observation);
    let row = Row::of(test, &observation, position, bin.len() as f64);
    (row, observation)
}

impl Response for Elastic<'_> {
    fn data(&self) -> &[TestData] {
        self.tests
    }

    fn rows(&self) -> Vec<Row> {
        self.points.clone()
    }

    fn law(&self, values: &[f64]) -> Arc<dyn HyperelasticLaw> {
        match &self.curve {
            Some(curve) => Arc::clone(curve),
            None => self.build(values).0.into(),
        }
    }

    fn stresses(&self, values: &[f64]) -> Vec<f64> {
        let law = self.law(values);
        let mut stresses = vec![f64::NAN; self.points.len()];
        for (index, (row, one)) in self.points.iter().zip(&self.observations).enumerate() {
            let observation = self.moved(values, row.test, one);
            stresses[index] = self.tests[row.test].stress_of(&*law, &observation);
            if !stresses[index].is_finite() {
                break;
            }
        }
        if let Some(linear) = &self.linear {
            for (row, stress) in stresses.iter_mut().enumerate() {
                *stress += linear.at(row, values);
            }
        }
        stresses
    }

    fn predicted(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let law = self.law(values);
        let tests = self.moved_tests(values);
        let stresses = |test: &TestData| {
            let rows = test.observations.iter();
            rows.map(|row| test.stress_of(&*law, row)).collect()
        };
        tests.iter().map(stresses).collect()
    }

    fn moved_tests(&self, values: &[f64]) -> Cow<'_, [TestData]> {
        if self.zeros.is_empty() {
            return Cow::Borrowed(self.tests);
        }
        let tests = self.tests.iter().enumerate();
        let moved =
            tests.map(|(test, data)| data.with_observations(|one| self.moved(values, test, one)));
        Cow::Owned(moved.collect())
    }

    fn zeros(&self) -> &[Zero] {
        &self.zeros
    }

    fn measured(&self, values: &[f64], row: usize) -> f64 {
        let (point, observation) = (&self.points[row], &self.observations[row]);
        match self.zeros[..] {
            [] => point.stress,
            _ => self.moved(values, point.test, observation).stress,
        }
    }

    fn scale(&self, values: &[f64], row: usize) -> f64 {
        let measure = self.tests[self.points[row].test].stress_measure;
        let unit = Observation {
            stress: 1.0,
            ..self.observations[row]
        };
        let of_zeros = values.iter().skip(self.law_values);
        let pairs = self.zeros.iter().zip(of_zeros);
        pairs.fold(1.0, |scale, (zero, value)| match zero {
            Zero::Stretch { axis } => {
                let stretch = 1.0 + zero.by(*value);
                scale / unit.stretched(*axis, stretch, measure).stress
            }
            Zero::Record { .. } | Zero::Force { .. } => scale,
        })
    }

    /// A value at a bound would lie elsewhere by the data: the others are as uncertain as if it were free. Fixed are only values whose bounds
    /// are equal, and those on which the stresses do not depend to first order.
    fn estimated(&self, values: &[f64], bounds: &[[f64; 2]]) -> Estimated {
        let mut fixed: Vec<bool> = bounds.iter().map(|[low, high]| low == high).collect();
        let mut at_bound = at_bound(values, bounds, [1e-9, 1e-300]);
        for (index, parameter) in self.build(values).1.parameters.iter().enumerate() {
            // A law may limit a parameter by others: beyond the limit, its value does not change.
            let mut outside = values.to_vec();
            outside[index] *= 1.0 + 1e-6;
            let is_limited = self.build(&outside).1.parameters[index].value != outside[index];
            at_bound[index] |= is_limited;
            fixed[index] |= is_limited || parameter.is_symmetric_at(parameter.value);
        }
        let mut least = self.least.clone();
        least.resize(values.len(), LEAST_SIZE);
        Estimated {
            at_bound,
            fixed,
            least,
        }
    }
}

impl Misfit<Elastic<'_>> {
    /// Every n-th point by the weights of the measured stresses.
    pub fn thinned(&self, count: usize) -> Self {
        Self::new(self.response.thinned(count), self.weighting)
    }

    /// Sets those parameters that are stresses, given all others, by linear least squares.
    pub fn complete(&self, values: &mut [f64], stresses: &[usize]) -> Option<()> {
        let mut others = values.to_vec();
        stresses.iter().for_each(|index| others[*index] = 0.0);
        let constant = self.weighed(self.response.stresses(&others));
        let measured = self.rows.iter().map(|row| row.stress).collect();
        let target = self.weighed(measured) - &constant;
        let mut columns = DMatrix::zeros(self.rows.len(), stresses.len());
        for (column, parameter) in stresses.iter().enumerate() {
            let mut unit = others.clone();
            unit[*parameter] = 1.0;
            let modelled = self.weighed(self.response.stresses(&unit)) - &constant;
            columns.set_column(column, &modelled);
        }
        let completed = least_squares::linear(&columns, &target)?;
        for (index, value) in stresses.iter().zip(completed.iter()) {
            values[*index] = *value;
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::settings::Weighting;
    use crate::calibration::tests::helpers::uniaxial;

    fn tests() -> [TestData; 1] {
        [uniaxial("1.2,0.05\n1.6,0.13\n2.0,0.15\n")]
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
            let misfit = Misfit::new(Elastic::new(law, &tests), weighting);
            misfit.complete(&mut values, &[0]).unwrap();
            let expected = sum(&|f, s| f * s) / sum(&|f, _| f * f);
            assert!((values[0] / expected - 1.0).abs() < 1e-12, "{weighting:?}");
            let products: f64 = data.iter().map(|(l, s)| (l - 1.0) * s).sum();
            let squares: f64 = data.iter().map(|(l, _)| (l - 1.0) * (l - 1.0)).sum();
            let stiffness = misfit.response.stiffness;
            assert!((stiffness / (products / squares) - 1.0).abs() < 1e-12);
        }
    }

    /// The mean pulls on a line as the points do together: Σ w² (σ − s)² differs by a constant.
    #[test]
    fn the_mean_of_points_weighs_as_all_of_them() {
        let tests = tests();
        let (row, mean) = point(0, &tests[0], &tests[0].observations);
        assert!((mean.stress - 0.11).abs() < 1e-15 && (row.position - 0.6).abs() < 1e-15);
        let response =
            Elastic::of_points(Law::named("neo-hooke").unwrap(), &tests, vec![(row, mean)]);
        let misfit = Misfit::new(response, Weighting::Absolute);
        assert!((misfit.rows[0].weight - 3.0_f64.sqrt()).abs() < 1e-15);
    }
}
