//! A law fitted to the forces of a sheet on its mounting, which finite elements solve for every law that is tried.
//!
//! ```text
//! homogeneous law ─▶ finite elements of the mounted sheet ─▶ what the middle carries of the measured forces ─▶ law ─▶ …
//! ```
//!
//! Forces over cross-sections are not the stress of the middle: tines concentrate the load, and what lies beside them is slack. So the
//! sheet is solved with the present law p at some strains ε of its bars; there its middle has the strains m(ε; p), and its forces f are
//!
//! ```text
//! fₖ/Aₖ = Pₖ(m; p) + cₖ(ε; p) (|Pₖ(m; p)| + P₀),   P₀ a fiftieth of the largest stress
//! ```
//!
//! c takes up what the tines do. Interpolated to all rows (cubic radial functions), m and c turn each measured force into the stress that
//! the middle carried at its own stretches, to which the law is fitted as to any test. What c and m change with the law enters by its
//! derivatives, taken from the finite elements of laws nearby: the fit is that of the finite elements once it does not change, and so are
//! its intervals.
//!
//! # References
//! J. W. Bandler et al., IEEE Trans. Microw. Theory Tech. 52, 337 (2004), doi:10.1109/TMTT.2003.820904 (space mapping);
//! N. T. Jacobs et al., J. Biomech. Eng. 135, 054508 (2013), doi:10.1115/1.4023965 (biaxial tests)

use super::data::{Mounting, Observation, TestData};
use super::fit::{nearest, nearest_about};
use super::fitted::Fit;
use super::regression::Zero;
use super::settings::{FitSettings, MEASURE};
use crate::error::Error;
use crate::material::parameters::{Parameter, StressMeasure};
use crate::material::registry::Law;
use crate::statistics;

mod interpolation;
mod middle;
mod sheet;
#[cfg(test)]
mod tests;

use interpolation::Interpolation;
use middle::Middle;
use sheet::{MountedSheet, SheetLaw, SheetState};

/// A sheet that was solved on its mounting with the law.
#[derive(Debug)]
pub struct MountedFit {
    /// The tests as they would be of the homogeneous middle.
    pub(in crate::calibration) tests: Vec<TestData>,
    /// The law's parameters by the homogeneous reading.
    pub homogeneous: Vec<Parameter>,
    /// By how much the stresses of the homogeneous reading deviate at most along both axes, in equibiaxial states up to the largest stretch
    /// that both axes reached, in %.
    pub bias_percent: [f64; 2],
    /// By how much the forces changed at most when the cells were halved for the last fit, in % of the largest.
    pub discretisation_percent: f64,
    /// How often the sheet was solved.
    pub rounds: usize,
}

/// Rounds of solving and fitting at most.
const MOST_ROUNDS: usize = 20;
/// Forces that change by less, as a share of the largest one, are settled.
const SETTLED: f64 = 2e-4;
/// A sum of squares that is so many times the one before is none that the search goes on from.
const LARGER: f64 = 1.05;

/// The mounting of some tests, which must all have the same one.
///
/// # Errors
/// [`Error::Input`] where they do not.
pub fn mounting(tests: &[TestData]) -> Result<Option<Mounting>, Error> {
    let first = tests.first().map(|test| test.mounted);
    if let Some(other) = tests.iter().find(|test| Some(test.mounted) != first) {
        let message = format!(
            "{} states another mounting, rest state or zero of force than {}",
            other.name, tests[0].name
        );
        let hint = "the tests of one fit are those of one specimen; fit each specimen for itself";
        return Err(Error::input(message, hint));
    }
    Ok(first.and_then(|mounted| mounted.mounting))
}

/// The law that is nearest to tests of a sheet on its mounting.
///
/// # Errors
/// As [`nearest`]; [`Error::Solve`] where the sheet has no equilibrium with the law of the homogeneous reading.
pub fn nearest_mounted(
    law: &'static Law,
    tests: &[TestData],
    mounting: Mounting,
    settings: &FitSettings,
) -> Result<Fit, Error> {
    let homogeneous = nearest(law, tests, settings)?;
    let mut solved = Solved::new(law, tests, mounting, &homogeneous);
    let mut values = values_of(&solved.begin(settings)?);
    let mut last = values.clone();
    let (mut best, mut change, mut rounds) = (f64::INFINITY, f64::INFINITY, 0);
    let mut reached: Option<Middle> = None;
    while rounds < MOST_ROUNDS && change > SETTLED {
        rounds += 1;
        let middle = match solved.middle(&values) {
            Ok(middle) if middle.square(&solved.tests) <= LARGER * best => middle,
            Err(fault) if reached.is_none() => return Err(fault),
            // Too far: half of the way from the last values.
            _ => {
                let pairs = values.iter().zip(&last);
                values = pairs.map(|(far, last)| 0.5 * (far + last)).collect();
                continue;
            }
        };
        best = middle.square(&solved.tests);
        let (fit, _) = solved.fit(&middle, &values, settings)?;
        last = std::mem::replace(&mut values, values_of(&fit));
        change = middle.change(&last, &values);
        reached = Some(middle);
    }
    let (fine, discretisation) = solved.halved(reached.expect("a round"), &values)?;
    let (mut fit, tests) = solved.fit(&fine, &values, settings)?;
    if change > SETTLED {
        fit.quality.warnings.push(format!(
            "the law and the sheet on its mounting have not settled: forces still change by {:.2} % of the largest",
            100.0 * change
        ));
    }
    fit.mounted = Some(MountedFit {
        bias_percent: solved.bias(&homogeneous, &values_of(&fit)),
        homogeneous: homogeneous.law_parameters().to_vec(),
        tests,
        discretisation_percent: 100.0 * discretisation,
        rounds,
    });
    Ok(fit)
}

/// The values of a fit: those of the law, and behind them those of the state at rest.
fn values_of(fit: &Fit) -> Vec<f64> {
    let of_law = fit.law_parameters().iter().map(|parameter| parameter.value);
    of_law
        .chain(fit.quality.zeros.iter().map(|zero| zero.value))
        .collect()
}

/// A sheet that is solved for one set of values after the other.
struct Solved {
    law: &'static Law,
    of_law: usize,
    zeros: Vec<Zero>,
    /// The stretches as mounted that are stated.
    stated: [f64; 2],
    /// The tests from the mounted state on.
    tests: Vec<TestData>,
    sheet: MountedSheet,
    interpolation: Interpolation,
    states: Vec<SheetState>,
}

impl Solved {
    fn new(law: &'static Law, tests: &[TestData], mounting: Mounting, homogeneous: &Fit) -> Self {
        let stated = tests[0].mounted.stated_stretches();
        let back = stated.map(f64::recip);
        let tests: Vec<TestData> = tests.iter().map(|test| test.stretched(back)).collect();
        let rows = tests.iter().flat_map(|test| &test.observations);
        let strains: Vec<[f64; 2]> = rows.map(|one| one.strains).collect();
        let zeros = homogeneous.quality.zeros.iter();
        Self {
            law,
            of_law: homogeneous.of_law,
            zeros: zeros.map(|zero| zero.zero).collect(),
            stated,
            sheet: MountedSheet::new(mounting, 0),
            interpolation: Interpolation::new(&strains),
            states: Vec::new(),
            tests,
        }
    }

    /// The law and the stretches as mounted of some values, and what the load cells read without load in MPa.
    fn sheet_law(&self, values: &[f64]) -> (SheetLaw, [f64; 2]) {
        let (of_law, of_zeros) = values.split_at(self.of_law);
        let (law, _) = self
            .law
            .with_values(of_law, StressMeasure::Nominal, MEASURE);
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
    fn middle(&mut self, values: &[f64]) -> Result<Middle, Error> {
        let (law, read) = self.sheet_law(values);
        let mut laws = vec![law];
        let mut steps = Vec::new();
        for (index, value) in values.iter().enumerate() {
            let step = self.step(index, *value);
            let mut moved = values.to_vec();
            moved[index] += step.unwrap_or(0.0);
            laws.push(self.sheet_law(&moved).0);
            steps.push(step);
        }
        let knots = self.interpolation.knots();
        let solved = self.sheet.states(&laws, knots, &self.states)?;
        let states = solved.iter().map(|states| states[0].clone());
        self.states = states.collect();
        let largest = self.tests.iter().map(|test| test.largest_stress);
        let largest = largest.fold(0.0, f64::max);
        let of_bars = &self.interpolation;
        Ok(Middle::new(
            of_bars,
            &laws,
            &steps,
            &solved,
            (read, largest),
        ))
    }

    /// The step of a difference by a value; `None` for a zero of force, which the sheet does not depend on.
    fn step(&self, index: usize, value: f64) -> Option<f64> {
        const SHARE: f64 = 1e-4;
        const LEAST: f64 = 1e-2;
        let zero = index
            .checked_sub(self.of_law)
            .map(|index| self.zeros[index]);
        match zero {
            Some(Zero::Force { .. }) => None,
            Some(_) => Some(SHARE),
            None if value.abs() > 0.0 => Some(SHARE * value.abs()),
            None => Some(SHARE * LEAST),
        }
    }

    /// An observation of a test at rest from the mounted state on.
    fn as_mounted(&self, one: &Observation) -> Observation {
        let [first, second] = self.stated.map(f64::recip);
        let nominal = StressMeasure::Nominal;
        one.stretched(0, first, nominal)
            .stretched(1, second, nominal)
    }

    /// The law that is nearest to the middle that a neo-Hookean sheet has: what it carries of the forces is nearer to that of any law than
    /// the homogeneous reading, whose strains are too large.
    fn begin(&mut self, settings: &FitSettings) -> Result<Fit, Error> {
        let neo_hooke = Law::named("neo-hooke").expect("a law of the registry");
        let read: Vec<TestData> = self
            .tests
            .iter()
            .map(|test| test.stretched(self.stated))
            .collect();
        let modulus = nearest(neo_hooke, &read, &FitSettings::default())?.parameters[0].value;
        let (law, _) = neo_hooke.with_values(&[modulus], StressMeasure::Nominal, MEASURE);
        let laws = [SheetLaw {
            law: law.into(),
            stretches: [1.0; 2],
        }];
        let knots = self.interpolation.knots();
        let states = self.sheet.states(&laws, knots, &[])?;
        let scale = ([0.0; 2], self.largest_stress());
        let middle = Middle::new(&self.interpolation, &laws, &[], &states, scale);
        self.states = states.into_iter().flatten().collect();
        nearest(self.law, &self.of_middle(&middle), settings)
    }

    /// The tests as they would be of a middle.
    fn of_middle(&self, middle: &Middle) -> Vec<TestData> {
        let of_test = |test: &TestData| {
            let own = test.with_observations(|one| middle.of(one));
            own.stretched(self.stated)
        };
        self.tests.iter().map(of_test).collect()
    }

    /// The fit to the middle of the sheet about some values, and the tests as they would be of this middle.
    fn fit(
        &self,
        middle: &Middle,
        values: &[f64],
        settings: &FitSettings,
    ) -> Result<(Fit, Vec<TestData>), Error> {
        let tests = self.of_middle(middle);
        let derivatives = |one: &Observation| middle.derivatives(&self.as_mounted(one));
        let fit = nearest_about(self.law, &tests, values, derivatives, settings)?;
        Ok((fit, tests))
    }

    /// The same middle by cells of half the size, with the derivatives of the large ones, and by how much the forces change, as a share of
    /// the largest.
    fn halved(&self, middle: Middle, values: &[f64]) -> Result<(Middle, f64), Error> {
        let fine = self.sheet.halved();
        let starts = self.sheet.on(&fine, &self.states);
        let law = [self.sheet_law(values).0];
        let states = fine.states(&law, self.interpolation.knots(), &starts)?;
        let pairs = states.iter().zip(&self.states);
        let changes = pairs.map(|(fine, coarse)| {
            let along = |axis: usize| (fine[0].stresses[axis] - coarse.stresses[axis]).abs();
            along(0).max(along(1))
        });
        let change = changes.fold(0.0, f64::max) / self.largest_stress();
        Ok((middle.with_states(&law, &states), change))
    }

    fn largest_stress(&self) -> f64 {
        let largest = self.tests.iter().map(|test| test.largest_stress);
        largest.fold(0.0, f64::max)
    }

    /// By how much the stresses of the homogeneous reading deviate along both axes in %.
    fn bias(&self, homogeneous: &Fit, values: &[f64]) -> [f64; 2] {
        let farthest = |axis: usize| {
            let rows = self.tests.iter().flat_map(|test| &test.observations);
            rows.map(|one| one.strains[axis]).fold(0.0, f64::max)
        };
        let strain = farthest(0).min(farthest(1));
        let laws =
            [values_of(homogeneous), values.to_vec()].map(|values| self.sheet_law(&values).0);
        let off = |step: u8, axis: usize| {
            let at = [f64::from(step) / 10.0 * strain; 2];
            let [read, solved] = [&laws[0], &laws[1]].map(|law| law.stresses(at)[axis]);
            100.0 * (read / solved - 1.0)
        };
        [0, 1].map(|axis| statistics::farthest((1..=10).map(|step| off(step, axis))))
    }
}
