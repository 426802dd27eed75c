//! The residuals of a law that softens.

use std::sync::Arc;

use crate::calibration::data::{Observation, TestData};
use crate::calibration::least_squares::{Measured, Residuals};
use crate::calibration::regression::{Reweighed, Rows};
use crate::calibration::settings::{MEASURE, Weighting};
use crate::document::Bound;
use crate::material::parameters::{Parameter, StressMeasure};
use crate::material::registry::Law;
use crate::material::{Card, HyperelasticLaw, Softening};
use crate::units::Dimension;

/// The keys of the parameters.
pub const SOFTENING: [&str; 3] = ["softening.r", "softening.m", "softening.beta"];

/// Where the law of the first loading comes from.
#[derive(Clone, Copy, Debug)]
pub enum Base<'a> {
    /// It is found together with the softening.
    Law(&'static Law),
    /// It is that of a card.
    Card(&'a Card),
}

/// r, m and β; energies are measured by the largest one of the data.
pub fn softening_parameters(largest: f64) -> [Parameter; 3] {
    let [r, m, beta] = SOFTENING;
    let parameter = |key, value, dimension, bound| Parameter {
        key,
        value,
        dimension,
        bound,
        usual: [f64::NAN; 2],
    };
    let least = 1e-6 * largest;
    [
        parameter(r, 2.0, Dimension::Ratio, Softening::R),
        parameter(
            m,
            0.2 * largest,
            Dimension::Stress,
            Bound::Within(least, f64::INFINITY),
        ),
        parameter(beta, 0.1, Dimension::Ratio, Bound::NonNegative),
    ]
}

/// The residuals of a law that softens at all rows. Parameters are those of the law, then r, m and β.
pub struct SofteningMisfit<'a> {
    /// Where the law comes from.
    pub base: Base<'a>,
    /// How many parameters of the law are found.
    pub of_law: usize,
    tests: &'a [TestData],
    weighting: Weighting,
    weights: Vec<Vec<f64>>,
}

impl<'a> SofteningMisfit<'a> {
    /// The residuals with so many parameters of the law, weighted by the measured stresses.
    pub fn new(base: Base<'a>, of_law: usize, tests: &'a [TestData], weighting: Weighting) -> Self {
        let weights = tests.iter().map(|data| {
            let rows = data.observations.iter();
            rows.map(|one| weighting.weight(data, one)).collect()
        });
        Self {
            base,
            of_law,
            tests,
            weighting,
            weights: weights.collect(),
        }
    }

    /// The stress measure of the data.
    pub fn measure(&self) -> StressMeasure {
        self.tests[0].stress_measure
    }

    /// The law of the first loading.
    pub fn law(&self, values: &[f64]) -> Arc<dyn HyperelasticLaw> {
        match self.base {
            Base::Card(card) => Arc::clone(&card.law),
            Base::Law(law) => {
                let own = &values[..self.of_law];
                law.with_values(own, self.measure(), MEASURE).0.into()
            }
        }
    }

    /// The softening of some values.
    pub fn softening(&self, values: &[f64]) -> Softening {
        let own = &values[self.of_law..];
        Softening {
            r: own[0],
            m: own[1],
            beta: own[2],
        }
    }

    /// The largest energy of a law in all tests, in mJ/mm³.
    pub fn largest_energy(&self, law: &dyn HyperelasticLaw) -> f64 {
        let all = self.tests.iter().flat_map(|data| {
            let rows = data.observations.iter();
            let before = data.energy_before(law);
            rows.map(|one| data.state_of(law, one)[0]).chain([before])
        });
        all.fold(0.0, f64::max)
    }

    /// The stresses at all rows of each test, in the measure of the data, in MPa.
    pub fn stresses(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let (law, softening) = (self.law(values), self.softening(values));
        let of_test = |data: &TestData| {
            let mut most = data.energy_before(&*law);
            let stress = |one: &Observation| {
                let [energy, nominal] = data.state_of(&*law, one);
                most = most.max(energy);
                let [factor, _] = softening.factor(energy, most);
                let x = one.strains[one.axis];
                data.stress_measure.of_nominal(factor * nominal, x)
            };
            data.observations.iter().map(stress).collect()
        };
        self.tests.iter().map(of_test).collect()
    }

    /// The rows of each test along each axis, in the order of the file.
    pub fn curves(&self) -> Vec<Rows> {
        let mut curves = Vec::new();
        let mut first = 0;
        for data in self.tests {
            for axis in [0, 1] {
                let rows = data.observations.iter().enumerate();
                let rows = rows.filter(|(_, one)| one.axis == axis);
                let rows: Rows = rows.map(|(row, _)| (first + row, row as f64)).collect();
                if !rows.is_empty() {
                    curves.push(rows);
                }
            }
            first += data.observations.len();
        }
        curves
    }
}

/// The residuals of the same law without softening.
pub struct WithoutSoftening<'a>(pub &'a SofteningMisfit<'a>);

impl Residuals for WithoutSoftening<'_> {
    fn count(&self) -> usize {
        self.0.count()
    }

    fn evaluate(&self, parameters: &[f64], residuals: &mut [f64]) -> bool {
        // η = 1 − erf(…)/r
        let none = [f64::INFINITY, 1.0, 0.0];
        self.0.evaluate(&[parameters, &none].concat(), residuals)
    }
}

impl Residuals for SofteningMisfit<'_> {
    fn count(&self) -> usize {
        self.weights.iter().map(Vec::len).sum()
    }

    fn evaluate(&self, parameters: &[f64], residuals: &mut [f64]) -> bool {
        let found = self.stresses(parameters);
        let found = found.iter().flatten().zip(self.weights.iter().flatten());
        let measured = self.tests.iter().flat_map(|data| &data.observations);
        for ((place, one), (stress, weight)) in residuals.iter_mut().zip(measured).zip(found) {
            *place = weight * (one.stress - stress);
        }
        residuals.iter().all(|residual| residual.is_finite())
    }
}

impl Reweighed for SofteningMisfit<'_> {
    fn reweighed(&self, values: &[f64]) -> Self {
        let stresses = self.stresses(values);
        let weights = self.tests.iter().zip(&stresses).map(|(data, own)| {
            let own = own.iter();
            own.map(|stress| self.weighting.weight_of(data, *stress))
                .collect()
        });
        Self {
            weights: weights.collect(),
            ..*self
        }
    }

    fn is_relative(&self) -> bool {
        self.weighting == Weighting::Relative
    }

    fn measured(&self) -> Vec<Measured> {
        let rows = self.tests.iter().flat_map(|data| &data.observations);
        let rows = rows.zip(self.weights.iter().flatten());
        rows.map(|(one, weight)| Measured {
            stress: one.stress,
            weight: *weight,
            count: 1.0,
        })
        .collect()
    }
}
