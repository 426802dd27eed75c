//! A sheet on its mounting, solved with one law after the other until law and sheet settle.

use super::interpolation::Interpolation;
use super::middle::Middle;
use super::sheet::{MountedSheet, SheetLaw, SheetState};
use crate::calibration::data::{Mounting, Observation, TestData};
use crate::calibration::fitted::Fit;
use crate::calibration::nearest::{About, nearest};
use crate::calibration::regression::Zero;
use crate::calibration::settings::{FitSettings, MEASURE, Weighting};
use crate::error::Error;
use crate::material::parameters::StressMeasure;
use crate::material::registry::Law;
use crate::statistics;

/// Rounds of solving and fitting at most.
const MOST_ROUNDS: usize = 20;

/// A law that has settled with the sheet.
pub struct Reached {
    law: &'static Law,
    /// Its values, followed by those of the state at rest.
    pub values: Vec<f64>,
    /// What the middle of the sheet carries by them.
    pub middle: Middle,
    /// How often the sheet was solved.
    pub rounds: usize,
    /// By how much forces still change, as a share of the largest.
    pub change: f64,
    /// The sum of squares of measured less modelled stresses in MPa².
    square: f64,
}

impl Reached {
    fn new(law: &'static Law, values: &[f64], (middle, square): (Middle, f64)) -> Self {
        Self {
            law,
            values: values.to_vec(),
            middle,
            rounds: 0,
            change: f64::INFINITY,
            square,
        }
    }
}

/// A sheet that is solved for one law after the other.
pub struct Solved {
    zeros: Vec<Zero>,
    /// The stretches as mounted that are stated.
    stated: [f64; 2],
    /// The tests from the mounted state on.
    tests: Vec<TestData>,
    sheet: MountedSheet,
    interpolation: Interpolation,
    /// Those of the last law, at the knots.
    states: Vec<SheetState>,
}

impl Solved {
    /// Of some tests, with knots no farther apart than `near` asks, a share of the largest strains.
    pub fn new(tests: &[TestData], mounting: Mounting, near: f64) -> Self {
        let zeros = Zero::of(tests);
        let stated = tests[0].mounted.stated_stretches();
        let back = stated.map(f64::recip);
        let tests: Vec<TestData> = tests.iter().map(|test| test.stretched(back)).collect();
        let rows = tests.iter().flat_map(|test| &test.observations);
        let strains: Vec<[f64; 2]> = rows.map(|one| one.strains).collect();
        Self {
            zeros,
            stated,
            sheet: MountedSheet::new(mounting, 0),
            interpolation: Interpolation::new(&strains, near),
            states: Vec::new(),
            tests,
        }
    }

    /// The middle of a neo-Hookean sheet, whose modulus hardly matters.
    pub fn neo_hookean(&mut self, tests: &[TestData]) -> Result<Middle, Error> {
        let neo_hooke = named("neo-hooke");
        let modulus = nearest(neo_hooke, tests, &FitSettings::default())?.parameters[0].value;
        let (law, _) = neo_hooke.with_values(&[modulus], StressMeasure::Nominal, MEASURE);
        let laws = [SheetLaw {
            law: law.into(),
            stretches: [1.0; 2],
        }];
        let states = self.sheet.states(&laws, self.interpolation.knots(), &[])?;
        let scale = ([0.0; 2], TestData::largest_stress(&self.tests));
        let middle = Middle::new(&self.interpolation, &laws, &[], &states, scale);
        self.states = states.into_iter().flatten().collect();
        Ok(middle)
    }

    /// The values of a law fitted to the stresses of the middle by an isotropic law, and to the stresses of that law at the strains around the
    /// tines. No homogeneous test has such strains: extrapolated to them, laws that agree in the middle differ by orders of magnitude.
    /// Exponents are halved until the forces of the sheet are of the size of those of the isotropic law.
    pub fn extended(
        &mut self,
        isotropic: &Reached,
        law: &'static Law,
        settings: &FitSettings,
    ) -> Result<Vec<f64>, Error> {
        const MOST_HALVINGS: usize = 6;
        /// Times the sum of squares of the isotropic law.
        const ALIKE: f64 = 10.0;
        let relative = FitSettings {
            weighting: Weighting::Relative,
            ..settings.clone()
        };
        let mut tests = self.of_middle(&isotropic.middle);
        tests.extend(self.around_tines(isotropic, &tests));
        let fit = nearest(law, &tests, &relative)?;
        let mut values = fit.values();
        let square = isotropic.middle.square(&self.tests);
        for _ in 0..MOST_HALVINGS {
            let middle = self.middle(law, &values);
            if middle.is_ok_and(|middle| middle.square(&self.tests) < ALIKE * square) {
                break;
            }
            for (value, parameter) in values.iter_mut().zip(fit.law_parameters()) {
                if parameter.is_exponent() {
                    *value *= 0.5;
                }
            }
        }
        Ok(values)
    }

    /// Tests of a law at some strains around the tines for each protocol of some tests.
    fn around_tines(&self, isotropic: &Reached, tests: &[TestData]) -> Vec<TestData> {
        /// Strains around the tines over the largest ones of the middle.
        const MULTIPLES: [f64; 4] = [1.5, 2.0, 2.5, 3.0];
        let (at, _) = self.sheet_law(isotropic.law, &isotropic.values);
        let size = |one: &Observation| one.strains[0].hypot(one.strains[1]);
        let of_test = tests.iter().map(|test| {
            let protocols = test.protocols();
            let largest = protocols
                .iter()
                .filter_map(|rows| rows.iter().max_by(|a, b| size(a).total_cmp(&size(b))));
            let strains =
                largest.flat_map(|far| MULTIPLES.map(|times| far.strains.map(|x| times * x)));
            let observations = strains.flat_map(|strains| {
                let stresses = at.law.biaxial(strains);
                [0, 1].map(|axis| Observation {
                    strains,
                    axis,
                    stress: stresses[axis],
                })
            });
            TestData {
                observations: observations.collect(),
                ..test.clone()
            }
            .with_observations(|one| *one)
        });
        of_test.collect()
    }

    /// The values of a law after alternate solutions of the sheet and fits of the law, until forces change by less than the share `until` of the
    /// largest one. In each round values change by at most a share of their size, which is doubled where the sum of squares falls and halved
    /// where it does not.
    pub fn settled(
        &mut self,
        law: &'static Law,
        mut values: Vec<f64>,
        settings: &FitSettings,
        until: f64,
    ) -> Result<Reached, Error> {
        const SHARES: [f64; 2] = [0.5, 4.0];
        /// A sum of squares that is larger by less is as good: it is not quite what the fit makes the least.
        const AS_GOOD: f64 = 1.02;
        /// Forces that change by less, as a share of the largest one, do so linearly.
        const CLOSE: f64 = 0.01;
        let mut share = SHARES[0];
        let mut best: Option<Reached> = None;
        let mut other: Option<(Vec<f64>, Middle)> = None;
        for rounds in 1..=MOST_ROUNDS {
            let result = self.middle(law, &values);
            let before = best.as_ref().map_or(f64::INFINITY, |best| best.square);
            let outcome = result.as_ref();
            let square = outcome.map_or(f64::INFINITY, |middle| middle.square(&self.tests));
            if square <= AS_GOOD * before || best.is_none() {
                let middle = result?;
                share = (2.0 * share).min(SHARES[1]);
                // Between values that are close, differences are rounding.
                other = best
                    .take()
                    .filter(|last| last.change > CLOSE)
                    .map(|last| (last.values, last.middle));
                best = Some(Reached::new(law, &values, (middle, square)));
            } else {
                share *= 0.5;
                other = result.ok().map(|middle| (values.clone(), middle)).or(other);
            }
            let reached = best.as_mut().expect("a round");
            let tests = self.of_middle(&reached.middle);
            let others = other
                .as_ref()
                .map(|(values, middle)| (values, self.of_modelled(&reached.middle, middle)));
            let about = About {
                other: others
                    .as_ref()
                    .map(|(values, tests)| (&values[..], &tests[..])),
                ..self.about(law, (&reached.middle, &tests), &reached.values, settings)
            };
            values = about.within(share)?;
            (reached.change, reached.rounds) =
                (reached.middle.change(&reached.values, &values), rounds);
            if reached.change <= until {
                break;
            }
        }
        Ok(best.expect("a round"))
    }

    /// The values to which the iteration converges from `begin`, or from a fit to the middle that these lead to, as long as this is better:
    /// where a family of fibres carries no load, or lies along an axis, stresses do not depend on it to first order.
    pub fn nearly_settled(
        &mut self,
        law: &'static Law,
        begin: Vec<f64>,
        settings: &FitSettings,
    ) -> Result<Reached, Error> {
        const MOST: usize = 3;
        /// Of the sum of squares before.
        const BETTER: f64 = 0.98;
        /// Forces that change by less, as a share of the largest one, lead to the settled ones.
        const NEARLY: f64 = 0.02;
        let mut reached = self.settled(law, begin, settings, NEARLY)?;
        for _ in 0..MOST {
            let begin = nearest(law, &self.of_middle(&reached.middle), settings)?.values();
            let other = self.settled(law, begin, settings, NEARLY);
            match other
                .ok()
                .filter(|other| other.square < BETTER * reached.square)
            {
                Some(other) => reached = other,
                None => break,
            }
        }
        Ok(reached)
    }

    /// The law and the stretches as mounted of some values, and what the load cells read without load in MPa.
    fn sheet_law(&self, law: &Law, values: &[f64]) -> (SheetLaw, [f64; 2]) {
        let (of_law, of_zeros) = values.split_at(values.len() - self.zeros.len());
        let (law, _) = law.with_values(of_law, StressMeasure::Nominal, MEASURE);
        let (mut stretches, mut read) = (self.stated, [0.0; 2]);
        for (zero, value) in self.zeros.iter().zip(of_zeros) {
            match zero {
                Zero::Stretch { axis } => stretches[*axis] = *value,
                Zero::Force { axis, .. } => read[*axis] = zero.by(*value),
                Zero::Record { .. } => {}
            }
        }
        let law = law.into();
        (SheetLaw { law, stretches }, read)
    }

    /// What the middle of the sheet carries by some values, with the derivatives by each of them.
    fn middle(&mut self, law: &Law, values: &[f64]) -> Result<Middle, Error> {
        let (unmoved, read) = self.sheet_law(law, values);
        let mut laws = vec![unmoved];
        let steps = self.steps(values);
        for (index, step) in steps.iter().enumerate() {
            let mut moved = values.to_vec();
            moved[index] += step.unwrap_or(0.0);
            laws.push(self.sheet_law(law, &moved).0);
        }
        let solved = self
            .sheet
            .states(&laws, self.interpolation.knots(), &self.states)?;
        let states = solved.iter().map(|states| states[0].clone());
        self.states = states.collect();
        let scale = (read, TestData::largest_stress(&self.tests));
        Ok(Middle::new(
            &self.interpolation,
            &laws,
            &steps,
            &solved,
            scale,
        ))
    }

    /// The steps of differences by some values; `None` for a zero of force, which the sheet does not depend on.
    fn steps(&self, values: &[f64]) -> Vec<Option<f64>> {
        const SHARE: f64 = 1e-4;
        const LEAST: f64 = 1e-2;
        let of_law = values.len() - self.zeros.len();
        let of_laws = values[..of_law].iter().map(|value| {
            let size = if *value == 0.0 { LEAST } else { value.abs() };
            Some(SHARE * size)
        });
        let zeros = self.zeros.iter();
        let of_zeros = zeros.map(|zero| match zero {
            Zero::Force { .. } => None,
            Zero::Stretch { .. } | Zero::Record { .. } => Some(SHARE),
        });
        of_laws.chain(of_zeros).collect()
    }

    /// The tests as they would be of a middle.
    pub fn of_middle(&self, middle: &Middle) -> Vec<TestData> {
        self.tests_of(|one| middle.of(one))
    }

    /// The tests as they would be of a middle if another one had been measured.
    fn of_modelled(&self, middle: &Middle, other: &Middle) -> Vec<TestData> {
        self.tests_of(|one| {
            let stress = other.modelled(one);
            middle.of(&Observation { stress, ..*one })
        })
    }

    fn tests_of(&self, change: impl Fn(&Observation) -> Observation) -> Vec<TestData> {
        let tests = self.tests.iter();
        tests
            .map(|test| test.with_observations(&change).stretched(self.stated))
            .collect()
    }

    /// The law about some values with the tests of a middle.
    pub fn about<'a>(
        &self,
        law: &'static Law,
        (middle, tests): (&'a Middle, &'a [TestData]),
        start: &'a [f64],
        settings: &'a FitSettings,
    ) -> About<'a, impl Fn(&Observation) -> (Vec<f64>, f64) + use<'a>> {
        let [first, second] = self.stated.map(f64::recip);
        let nominal = StressMeasure::Nominal;
        About {
            law,
            tests,
            start,
            linear: move |one: &Observation| {
                let mounted = one.stretched(0, first, nominal);
                middle.linear(&mounted.stretched(1, second, nominal))
            },
            other: None,
            settings,
        }
    }

    /// The middle of a law that has settled, extrapolated from cells of half the size to ever smaller ones, with the derivatives of the large
    /// ones, and by how much the forces change, as a share of the largest. Errors of quadratic elements around tines fall to a seventh with
    /// each halving (measured: a fifth to an eighth).
    pub fn extrapolated(&mut self, reached: &Reached) -> Result<(Middle, f64), Error> {
        const RATIO: f64 = 7.0;
        let fine = self.sheet.halved();
        let law = [self.sheet_law(reached.law, &reached.values).0];
        let knots = self.interpolation.knots();
        let coarse = self.sheet.states(&law, knots, &self.states)?.concat();
        let fine_states = fine.states(&law, knots, &self.sheet.on(&fine, &coarse))?;
        let mut states = fine_states.concat();
        let correction = |fine: f64, coarse: f64| (fine - coarse) * RATIO / (RATIO - 1.0);
        let mut most = 0.0_f64;
        for (fine, coarse) in states.iter_mut().zip(&coarse) {
            for axis in [0, 1] {
                let change = correction(fine.stresses[axis], coarse.stresses[axis]);
                most = most.max(change.abs());
                fine.stresses[axis] = coarse.stresses[axis] + change;
                fine.middle[axis] =
                    coarse.middle[axis] + correction(fine.middle[axis], coarse.middle[axis]);
            }
        }
        let states: Vec<Vec<SheetState>> = states.into_iter().map(|state| vec![state]).collect();
        let change = most / TestData::largest_stress(&self.tests);
        Ok((reached.middle.with_states(&law, &states), change))
    }

    /// By how much the stresses of the homogeneous reading deviate along both axes in %.
    pub fn bias(&self, homogeneous: &Fit, fit: &Fit) -> [f64; 2] {
        let reached = |axis: usize| {
            let strains = self.tests.iter().map(|test| test.reached(axis));
            strains.fold(0.0, f64::max)
        };
        let strain = reached(0).min(reached(1));
        let laws = [homogeneous, fit].map(|fit| self.sheet_law(fit.law, &fit.values()).0);
        let off = |step: u8, axis: usize| {
            let at = [f64::from(step) / 10.0 * strain; 2];
            let [read, solved] = [&laws[0], &laws[1]].map(|law| law.stresses(at)[axis]);
            100.0 * (read / solved - 1.0)
        };
        [0, 1].map(|axis| statistics::farthest((1..=10).map(|step| off(step, axis))))
    }
}
/// A law of the registry.
pub fn named(name: &str) -> &'static Law {
    Law::named(name).expect("a law of the registry")
}
