//! Groups of specimens: the mean law, how much specimens differ, and the difference of two groups.
//!
//! Parameters that a test determines poorly cannot be averaged. Instead the stresses of the fitted laws are averaged, each with its
//! uncertainty, at strains that all specimens have reached ([`RandomEffects`]); the mean law is fitted to their means.

use rayon::prelude::*;

use super::data::{Mounted, Observation, Test, TestData, Times};
use super::fit::fit;
use super::fitted::Fit;
use super::nearest::{check_measures, nearest};
use super::settings::FitSettings;
use crate::error::Error;
use crate::material::registry::Law;
use crate::statistics::{RandomEffects, farthest, normal_reach};

/// A law fitted to every specimen of a group.
#[derive(Debug)]
pub struct Group {
    /// The fits, in the order of the specimens.
    pub fits: Vec<Fit>,
    /// Their tests as they were fitted.
    pub tests: Vec<TestData>,
}

/// A state at which the stresses of specimens are averaged.
#[derive(Clone, Copy, Debug)]
pub struct GroupState {
    /// The strains, and the axis of the stress.
    pub strains: [f64; 2],
    /// 0 or 1.
    pub axis: usize,
    /// The stresses of the group in MPa.
    pub stress: RandomEffects,
}

impl Group {
    /// Strains of each protocol at which stresses are averaged.
    pub const STEPS: u8 = 20;

    /// Fits a law to the test of each specimen.
    ///
    /// # Errors
    /// [`Error::Input`] for fewer than two specimens; those of [`Group::check_alike`]; as [`fit`] for each.
    pub fn new(
        law: &'static Law,
        tests: &[TestData],
        settings: &FitSettings,
    ) -> Result<Self, Error> {
        Self::check_alike(tests)?;
        if tests.len() < 2 {
            let message = format!("{} alone is no group", tests[0].name);
            let hint = "how much specimens differ takes two at least, each in a file of its own";
            return Err(Error::input(message, hint));
        }
        let all: Vec<Result<Fit, Error>> = tests
            .par_iter()
            .map(|test| fit(law, std::slice::from_ref(test), settings))
            .collect();
        let fits = all.into_iter().collect::<Result<Vec<Fit>, Error>>()?;
        let pairs = fits.iter().zip(tests);
        let fitted = pairs.flat_map(|(fit, test)| fit.fitted_tests(std::slice::from_ref(test)));
        Ok(Self {
            tests: fitted.collect(),
            fits,
        })
    }

    /// Refuses tests whose stresses cannot be compared, of one group or of two.
    ///
    /// # Errors
    /// [`Error::Input`] with two tests of different stress measures, of different kinds, or one pulled and one pressed.
    pub fn check_alike(tests: &[TestData]) -> Result<(), Error> {
        check_measures(tests)?;
        let kind = |test: &TestData| {
            let is_pressed = farthest_strain(test, 0) < 0.0;
            let pressed = if is_pressed { " in compression" } else { "" };
            format!("{}{pressed}", test.test.name())
        };
        let first = &tests[0];
        let Some(other) = tests.iter().find(|test| kind(test) != kind(first)) else {
            return Ok(());
        };
        let message = format!(
            "{} is a test of another kind than {}: {} and {}",
            other.name,
            first.name,
            kind(other),
            kind(first)
        );
        let hint = "compare specimens by tests of one kind";
        Err(Error::input(message, hint))
    }

    /// The strains along both axes, farthest from rest, that all specimens reached.
    fn reached(&self) -> [f64; 2] {
        [0, 1].map(|axis| {
            let reached = self.tests.iter().map(|test| farthest_strain(test, axis));
            reached.reduce(nearer).unwrap_or_default()
        })
    }

    /// The states at which stresses are compared: for biaxial tests, protocols in three ratios of the largest strains.
    fn positions(reached: [f64; 2], test: Test) -> Vec<Observation> {
        const RATIOS: [[f64; 2]; 3] = [[1.0, 1.0], [1.0, 0.5], [0.5, 1.0]];
        let ratios = match test {
            Test::Biaxial => &RATIOS[..],
            _ => &RATIOS[..1],
        };
        let steps = |ratio: &[f64; 2]| {
            let ratio = *ratio;
            (1..=Self::STEPS).map(move |step| {
                let share = f64::from(step) / f64::from(Self::STEPS);
                [0, 1].map(|axis| share * ratio[axis] * reached[axis])
            })
        };
        let axes = if test == Test::Biaxial { 0..2 } else { 0..1 };
        let strains = ratios.iter().flat_map(steps);
        strains
            .flat_map(|strains| {
                axes.clone().map(move |axis| Observation {
                    strains,
                    axis,
                    stress: 0.0,
                })
            })
            .collect()
    }

    /// The stresses of the group where all specimens of this and of another group have been.
    pub fn states(&self, other: Option<&Self>) -> Vec<GroupState> {
        let mut reached = self.reached();
        if let Some(other) = other {
            let of_other = other.reached();
            reached = [0, 1].map(|axis| nearer(reached[axis], of_other[axis]));
        }
        let positions = Self::positions(reached, self.tests[0].test);
        let of_fit = |(fit, test): (&Fit, &TestData)| -> Vec<[f64; 2]> {
            let halves = fit.half_widths(test, &positions).into_iter();
            let pairs = positions.iter().zip(halves);
            pairs
                .map(|(one, half)| {
                    // Without intervals, the spread between specimens is the only uncertainty.
                    let error = if half.is_finite() {
                        half / normal_reach()
                    } else {
                        0.0
                    };
                    [test.stress_of(&*fit.fitted, one), error]
                })
                .collect()
        };
        let specimens: Vec<Vec<[f64; 2]>> = self.fits.iter().zip(&self.tests).map(of_fit).collect();
        let state = |(number, one): (usize, &Observation)| {
            let stresses: Vec<[f64; 2]> =
                specimens.iter().map(|specimen| specimen[number]).collect();
            GroupState {
                strains: one.strains,
                axis: one.axis,
                stress: RandomEffects::new(&stresses).expect("two specimens at least"),
            }
        };
        positions.iter().enumerate().map(state).collect()
    }

    /// The mean stresses of some states as a test.
    pub fn mean_test(&self, name: &str, states: &[GroupState]) -> TestData {
        let observations = states.iter().map(|state| Observation {
            strains: state.strains,
            axis: state.axis,
            stress: state.stress.mean,
        });
        TestData {
            name: name.to_owned(),
            observations: observations.collect(),
            left_out: Vec::new(),
            found_zero: None,
            times: Times::None,
            mounted: Mounted::default(),
            head: [("specimen", format!("mean of {} specimens", self.fits.len()))]
                .map(|(key, value)| (key.to_owned(), value))
                .into(),
            warnings: Vec::new(),
            remarks: Vec::new(),
            ..self.tests[0].clone()
        }
        .with_observations(|one| *one)
    }

    /// The law of the mean stresses.
    ///
    /// # Errors
    /// As [`fit`].
    pub fn mean_law(&self, states: &[GroupState], settings: &FitSettings) -> Result<Fit, Error> {
        nearest(
            self.fits[0].law,
            &[self.mean_test("mean", states)],
            settings,
        )
    }
}

/// The strain along an axis that is farthest from rest.
fn farthest_strain(test: &TestData, axis: usize) -> f64 {
    farthest(test.observations.iter().map(|one| one.strains[axis]))
}

/// The one of two strains that is nearer to rest.
fn nearer(one: f64, other: f64) -> f64 {
    if one.abs() <= other.abs() { one } else { other }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::tests::biaxial::record;
    use crate::calibration::tests::helpers::law;
    use crate::document::Statements;

    /// The parameters of a specimen.
    fn values(number: u32, mu: f64) -> [f64; 5] {
        let k1 = 0.05 * (1.0 + 0.2 * f64::from(number % 3));
        [mu, k1, 3.0, 0.1, 0.6]
    }

    fn specimen(number: u32, mu: f64) -> TestData {
        let law = ("holzapfel-gasser-ogden", &values(number, mu)[..]);
        let ratios = [[1.0, 1.0], [1.0, 0.5], [0.5, 1.0]];
        record(law, (&ratios, 0.2), (1e-3, number.into()))
    }

    fn group(numbers: std::ops::Range<u32>, mu: f64) -> Group {
        let tests: Vec<TestData> = numbers.map(|number| specimen(number, mu)).collect();
        let law = Law::named("holzapfel-gasser-ogden").unwrap();
        Group::new(law, &tests, &FitSettings::default()).unwrap()
    }

    /// At the strains that all of them reached, which are negative.
    #[test]
    fn pressed_specimens_are_averaged_where_all_have_been() {
        let specimen = |name: &str, c10: f64, last: i32| {
            let rows = (0..=last).map(|row| {
                let stretch = 1.0 - 0.02 * f64::from(row);
                let stress = 2.0 * c10 * (stretch - stretch.powi(-2));
                format!("{stretch},{stress}\n")
            });
            let head = "# test: uniaxial\nstretch [-],nominal_stress [MPa]";
            let text = format!("{head}\n{}", rows.collect::<String>());
            TestData::parse(name, &text, &Statements::new()).unwrap()
        };
        let tests = [specimen("a.csv", 0.09, 10), specimen("b.csv", 0.11, 20)];
        let law = Law::named("neo-hooke").unwrap();
        let group = Group::new(law, &tests, &FitSettings::default()).unwrap();
        let states = group.states(None);
        let last = states[states.len() - 1];
        assert!((last.strains[0] + 0.2).abs() < 1e-9, "{last:?}");
        let right = 2.0 * 0.1 * (0.8 - 0.8_f64.powi(-2));
        assert!((last.stress.mean / right - 1.0).abs() < 1e-3, "{last:?}");
    }

    /// The mean stress of three specimens, their spread, and what stiffer matrices add.
    #[test]
    fn mean_spread_and_difference_of_groups() {
        let (first, second) = (group(0..3, 0.01), group(3..6, 0.02));
        let states = [first.states(Some(&second)), second.states(Some(&first))];
        let right = |mu: f64, strains: [f64; 2], axis: usize| {
            let each = (0..3).map(|number| {
                law("holzapfel-gasser-ogden", &values(number, mu)).biaxial(strains)[axis]
            });
            each.collect::<Vec<f64>>()
        };
        for (one, two) in states[0].iter().zip(&states[1]) {
            let stresses = right(0.01, one.strains, one.axis);
            let mean = stresses.iter().sum::<f64>() / 3.0;
            let square: f64 = stresses.iter().map(|stress| (stress - mean).powi(2)).sum();
            let between = (square / 2.0).sqrt();
            let scale = 2e-4 + 0.02 * mean;
            assert!((one.stress.mean - mean).abs() < scale, "{one:?} {mean}");
            assert!(
                (one.stress.between - between).abs() < scale,
                "{one:?} {between}"
            );
            let more = right(0.02, one.strains, one.axis).iter().sum::<f64>() / 3.0 - mean;
            let difference = one.stress.difference(&two.stress);
            assert!(difference.holds(more), "{difference:?} {more}");
        }
        let mean = first.mean_law(&states[0], &FitSettings::default()).unwrap();
        let mu = mean.parameters[0].value;
        assert!((mu - 0.01).abs() < 1e-3, "{mu}");
    }
}
