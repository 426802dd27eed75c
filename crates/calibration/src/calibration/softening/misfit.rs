//! A law that softens as the model of tests.

use std::sync::Arc;

use crate::calibration::data::{Observation, TestData};
use crate::calibration::regression::{Response, Row};
use crate::calibration::settings::MEASURE;
use crate::document::Bound;
use crate::material::parameters::Parameter;
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

/// A law that softens at all rows, in the order of the file. Values are those of the law, then r, m and β.
#[derive(Clone)]
pub struct Softens<'a> {
    /// Where the law comes from.
    pub base: Base<'a>,
    /// How many values of the law are found.
    pub of_law: usize,
    /// The tests.
    pub tests: &'a [TestData],
}

impl Softens<'_> {
    /// The softening of some values.
    pub fn softening(&self, values: &[f64]) -> Softening {
        let parameters = &values[self.of_law..];
        Softening {
            r: parameters[0],
            m: parameters[1],
            beta: parameters[2],
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
}

impl Response for Softens<'_> {
    fn data(&self) -> &[TestData] {
        self.tests
    }

    fn rows(&self) -> Vec<Row> {
        let tests = self.tests.iter().enumerate();
        let rows = tests.flat_map(|(test, data)| {
            let rows = data.observations.iter().enumerate();
            rows.map(move |(number, one)| Row::of(test, one, number as f64, 1.0))
        });
        rows.collect()
    }

    fn law(&self, values: &[f64]) -> Arc<dyn HyperelasticLaw> {
        match self.base {
            Base::Card(card) => Arc::clone(&card.law),
            Base::Law(law) => {
                let measure = self.tests[0].stress_measure;
                let of_law = &values[..self.of_law];
                law.with_values(of_law, measure, MEASURE).0.into()
            }
        }
    }

    fn stresses(&self, values: &[f64]) -> Vec<f64> {
        self.predicted(values).concat()
    }

    fn predicted(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let (law, softening) = (self.law(values), self.softening(values));
        let of_test = |data: &TestData| {
            let mut most = data.energy_before(&*law);
            let stress = |one: &Observation| {
                let [energy, nominal] = data.state_of(&*law, one);
                most = most.max(energy);
                let [factor, _] = softening.factor(energy, most);
                let x = one.strain();
                data.stress_measure.of_nominal(factor * nominal, x)
            };
            data.observations.iter().map(stress).collect()
        };
        self.tests.iter().map(of_test).collect()
    }
}
