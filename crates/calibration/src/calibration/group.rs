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

/// The kind of a test, its axes and the sign of its strain, in words.
fn kind(test: &TestData) -> String {
    let axes: Vec<String> = test
        .axes
        .iter()
        .map(|axis| (axis + 1).to_string())
        .collect();
    let sign = if farthest(test.farthest_strains()) < 0.0 {
        "negative"
    } else {
        "positive"
    };
    format!(
        "{} with {sign} strains, stressed along axis {}",
        test.test.name(),
        axes.join(" and ")
    )
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

    /// Checks that tests, of one group or of two, have one measure, one kind, the same axes and one sign of the strain.
    ///
    /// # Errors
    /// [`Error::Input`] where they do not, or where there are none.
    pub fn check(tests: &[TestData]) -> Result<(), Error> {
        check_measures(tests)?;
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
        Err(Error::input(
            message,
            "compare specimens by tests of one kind",
        ))
    }

    /// Fits a law to the test of each specimen.
    ///
    /// # Errors
    /// As [`Self::check`]; [`Error::Input`] for fewer than two specimens; as [`fit`] for each.
    pub fn new(
        law: &'static Law,
        tests: &[TestData],
        settings: &FitSettings,
    ) -> Result<Self, Error> {
        Self::check(tests)?;
        let first = &tests[0];
        if tests.len() < 2 {
            let message = format!("{} alone is no group", first.name);
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

    /// The strains farthest from rest along both axes that all specimens reached, and those of another group.
    fn reached(&self, other: Option<&Self>) -> [f64; 2] {
        let tests = || {
            self.tests
                .iter()
                .chain(other.into_iter().flat_map(|other| &other.tests))
        };
        [0, 1].map(|axis| {
            let reached = tests().map(|test| test.farthest_strains()[axis]);
            let least = reached.min_by(|a, b| a.abs().total_cmp(&b.abs()));
            least.unwrap_or(0.0)
        })
    }

    /// The states at which stresses are compared, along the axes of a test: for biaxial ones, protocols in three ratios of the largest
    /// strains.
    fn positions(reached: [f64; 2], test: &TestData) -> Vec<Observation> {
        const RATIOS: [[f64; 2]; 3] = [[1.0, 1.0], [1.0, 0.5], [0.5, 1.0]];
        let ratios = match test.test {
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
        let strains = ratios.iter().flat_map(steps);
        strains
            .flat_map(|strains| {
                test.axes.iter().map(move |axis| Observation {
                    strains,
                    axis: *axis,
                    stress: 0.0,
                })
            })
            .collect()
    }

    /// The stresses of the group where all specimens of this and of another group have been.
    pub fn states(&self, other: Option<&Self>) -> Vec<GroupState> {
        let positions = Self::positions(self.reached(other), &self.tests[0]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::tests::biaxial::record;
    use crate::calibration::tests::helpers::{law, parsed};
    use crate::calibration::{Conversion, StrainColumn};
    use crate::material::parameters::StressMeasure;

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

    fn uniaxial(c10: f64, stretch: f64) -> f64 {
        2.0 * c10 * (stretch - stretch.powi(-2))
    }

    fn equibiaxial(c10: f64, stretch: f64) -> f64 {
        2.0 * c10 * (stretch - stretch.powi(-5))
    }

    /// Specimens with C₁₀ of 0.05 and 0.07 MPa that are pressed, pulled along the second axis, or stressed along both.
    #[test]
    fn means_are_those_at_the_strains_and_along_the_axes_of_the_tests() {
        type Stress = fn(f64, f64) -> f64;
        let cases: [(&str, Stress, f64, usize); 3] = [
            (
                "compression\nstretch [-],nominal_stress [MPa]",
                uniaxial,
                0.6,
                1,
            ),
            (
                "uniaxial; direction: 2\nstretch [-],nominal_stress [MPa]",
                uniaxial,
                1.5,
                1,
            ),
            (
                "equibiaxial\nstretch [-],nominal_stress_1 [MPa],nominal_stress_2 [MPa]",
                equibiaxial,
                1.5,
                2,
            ),
        ];
        for (head, stress, last, columns) in cases {
            let specimen = |c10: f64| {
                let row = |step: i32| {
                    let stretch = 1.0 + (last - 1.0) * f64::from(step) / 20.0;
                    let stresses = format!(",{}", stress(c10, stretch)).repeat(columns);
                    format!("{stretch}{stresses}\n")
                };
                let rows: String = (1..=20).map(row).collect();
                parsed(&format!("# test: {head}\n{rows}"))
            };
            let law = Law::named("neo-hooke").unwrap();
            let tests = [0.05, 0.07].map(specimen);
            let group = Group::new(law, &tests, &FitSettings::default()).unwrap();
            let states = group.states(None);
            let conversion = Conversion {
                stress: StressMeasure::Nominal,
                strain: StrainColumn::Stretch,
                unit: "MPa".to_owned(),
            };
            let text = conversion.table(&group.mean_test("mean", &states)).unwrap();
            let mean = parsed(&text);
            assert_eq!(mean.observations.len(), 20 * columns, "{text}");
            assert!((mean.observations[20 * columns - 1].strain() - (last - 1.0)).abs() < 1e-12);
            for one in &mean.observations {
                let expected = stress(0.06, 1.0 + one.strain());
                assert!((one.stress / expected - 1.0).abs() < 1e-4, "{text}");
            }
        }
    }

    #[test]
    fn tests_of_another_axis_sign_or_measure_are_refused() {
        let head = "stretch [-],nominal_stress [MPa]\n";
        let pulled = parsed(&format!("# test: uniaxial\n{head}1.1,0.1\n1.2,0.2\n"));
        for (text, message) in [
            (
                format!("# test: uniaxial; direction: 2\n{head}1.1,0.1\n1.2,0.2\n"),
                "stressed along axis 2",
            ),
            (
                format!("# test: compression\n{head}0.9,-0.1\n0.8,-0.2\n"),
                "negative strains",
            ),
            (
                "# test: uniaxial\nstretch [-],cauchy_stress [MPa]\n1.1,0.1\n1.2,0.2\n".to_owned(),
                "cauchy stress",
            ),
        ] {
            let fault = Group::check(&[pulled.clone(), parsed(&text)]).unwrap_err();
            assert!(fault.to_string().contains(message), "{fault}");
        }
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
