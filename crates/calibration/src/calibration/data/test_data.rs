//! Test data: the strains of a specimen, and the stresses that were measured.

use super::mounting::Mounted;
use super::table_reading::TableReading;
use super::zero::FoundZero;
use crate::document::{Statements, name_of};
use crate::error::{Diagnostic, Error};
use crate::material::HyperelasticLaw;
use crate::material::curve::simple_shear;
use crate::material::parameters::StressMeasure;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::statistics::{extremes, farthest};

/// The kinds of test of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// Stretched or pressed along one axis, free across.
    Uniaxial,
    /// Stretched along one axis, held across (pure shear).
    Planar,
    /// Stretched equally along both axes.
    Equibiaxial,
    /// Stretched along both axes by different amounts.
    Biaxial,
    /// Sheared by γ with its thickness held, as between two plates: u₁ = γ X₂. Its strain along the first axis stands for γ, its stress
    /// for the shear stress, of which the nominal and the Cauchy one are the same.
    SimpleShear,
}

impl Test {
    /// The names that files use.
    pub const NAMES: [(&'static str, Self); 7] = [
        ("uniaxial", Self::Uniaxial),
        ("planar", Self::Planar),
        ("equibiaxial", Self::Equibiaxial),
        ("biaxial", Self::Biaxial),
        ("unequal-biaxial", Self::Biaxial),
        ("compression", Self::Uniaxial),
        ("simple-shear", Self::SimpleShear),
    ];

    /// The name of the test.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }
}

/// The side of rest to which a specimen was loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loaded {
    /// Stretched only: at strains below zero it is slack.
    Stretched,
    /// Pressed only: at strains above zero the plates do not touch it.
    Pressed,
    /// Both.
    Both,
}

impl Loaded {
    /// Strains on the other side count as noise below this share of the largest.
    const NOISE: f64 = 0.02;

    /// Of the strains of a test; those that are not known are left out.
    pub fn of(strains: impl Iterator<Item = f64>) -> Self {
        let [low, high] = extremes(strains.chain([0.0]));
        match (-low <= Self::NOISE * high, high <= -Self::NOISE * low) {
            (true, _) => Self::Stretched,
            (_, true) => Self::Pressed,
            _ => Self::Both,
        }
    }

    /// The strain increased by `by`; where the specimen would be slack, the strain at rest.
    fn moved(self, strain: f64, by: f64) -> f64 {
        match self {
            Self::Stretched => (strain + by).max(strain.min(0.0)),
            Self::Pressed => (strain + by).min(strain.max(0.0)),
            Self::Both => strain + by,
        }
    }
}

/// One measured stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// λ − 1 along both axes; NaN across a uniaxial test.
    pub strains: [f64; 2],
    /// The axis along which the stress was measured: 0 or 1.
    pub axis: usize,
    /// The stress in the measure of the data, in MPa.
    pub stress: f64,
}

impl Observation {
    /// λ − 1 along the axis of the stress.
    pub fn strain(&self) -> f64 {
        self.strains[self.axis]
    }

    /// The largest strains of some observations along both axes.
    pub(in crate::calibration) fn farthest_strains(all: &[Self]) -> [f64; 2] {
        [0, 1].map(|axis| farthest(all.iter().map(|one| one.strains[axis])))
    }

    /// The axis that is stretched further, by the largest strains along both.
    pub(super) fn drawn_axis([first, second]: [f64; 2]) -> usize {
        usize::from(second.abs() > first.abs())
    }

    /// The largest stress of some observations without its sign, in MPa.
    pub(super) fn largest_stress(all: &[Self]) -> f64 {
        farthest(all.iter().map(|one| one.stress)).abs()
    }

    /// The mean of neighbouring observations along one axis.
    pub(in crate::calibration) fn mean(bin: &[Self]) -> Self {
        if let [one] = bin {
            return *one;
        }
        let count = bin.len() as f64;
        let mean = |value: &dyn Fn(&Self) -> f64| bin.iter().map(value).sum::<f64>() / count;
        Self {
            strains: [0, 1].map(|axis| mean(&|one| one.strains[axis])),
            axis: bin[0].axis,
            stress: mean(&|one| one.stress),
        }
    }
}

/// The times of observations.
#[derive(Clone, Debug)]
pub enum Times {
    /// The file has none.
    None,
    /// One for each observation, in s.
    Known(Vec<f64>),
    /// The file has times that cannot be read.
    Unknown(Box<Diagnostic>),
}

/// The data of one test.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TestData {
    /// The file's name.
    pub name: String,
    /// The kind of test.
    pub test: Test,
    /// The measure of the stresses.
    pub stress_measure: StressMeasure,
    /// The axes along which the stresses of each row were measured.
    pub axes: Vec<usize>,
    /// The observations in the order of the file, one for each axis of a row.
    pub observations: Vec<Observation>,
    /// The axis that is stretched further: 0 or 1.
    pub drawn_axis: usize,
    /// The side of rest to which it was loaded, along all axes.
    pub loaded: Loaded,
    /// The largest stress without its sign, in MPa.
    pub largest_stress: f64,
    /// Root mean squares of the possible rounding, by the digits of the file: of the strains (nominal), zero for
    /// commanded ones, and of the stresses in MPa.
    pub rounding: [f64; 2],
    /// The times of the observations.
    pub times: Times,
    /// The time that the strain took to the first row, where the file begins stretched, in s.
    pub rise: f64,
    /// λ − 1 along the drawn axis to which the specimen was stretched before the record; `None` where that is not stated.
    pub preconditioned: Option<f64>,
    /// The part of the record that is not fitted: slack, holds, other cycles.
    pub left_out: Vec<Observation>,
    /// The zero that was found in the record, if one was.
    pub found_zero: Option<FoundZero>,
    /// How the sheet of a biaxial test is held.
    pub mounted: Mounted,
    /// The name of the specimen, where it is stated: tests of one name are one specimen.
    pub specimen: Option<String>,
    /// The columns and rows of the file that were read.
    pub table: TableReading,
    /// Descriptions of the part of a record that was taken, and of what was subtracted.
    pub remarks: Vec<String>,
    /// The head's statements on source, specimen, DOI and licence.
    pub head: Statements,
    /// Warnings about the data.
    pub warnings: Vec<Diagnostic>,
}

impl TestData {
    /// The warnings about the data, and what was taken of a record as warnings.
    pub fn all_warnings(&self) -> Vec<Diagnostic> {
        let taken = self.remarks.iter();
        let remarks = taken.map(|remark| Diagnostic::warning("", remark));
        self.warnings.iter().cloned().chain(remarks).collect()
    }

    /// The largest stress of some tests without its sign, in MPa.
    pub(in crate::calibration) fn largest_stress(tests: &[Self]) -> f64 {
        let stresses = tests.iter().map(|test| test.largest_stress);
        stresses.fold(0.0, f64::max)
    }

    /// The strains farthest from rest along both axes.
    pub(in crate::calibration) fn farthest_strains(&self) -> [f64; 2] {
        Observation::farthest_strains(&self.observations)
    }

    /// The largest strain along an axis.
    pub(in crate::calibration) fn reached(&self, axis: usize) -> f64 {
        let strains = self.observations.iter().map(|one| one.strains[axis]);
        strains.fold(0.0, f64::max)
    }

    /// The standard error in MPa of a stress that was subtracted from all observations.
    pub(in crate::calibration) fn offset_error(&self) -> f64 {
        match self.found_zero {
            Some(FoundZero::Strain { offset_error, .. }) => offset_error,
            _ => 0.0,
        }
    }

    /// The times of the observations in s, if the file has any.
    ///
    /// # Errors
    /// [`Error::Input`] where they cannot be read.
    pub fn known_times(&self) -> Result<Option<&[f64]>, Error> {
        match &self.times {
            Times::None => Ok(None),
            Times::Known(times) => Ok(Some(times)),
            Times::Unknown(fault) => Err(Error::Input(vec![Diagnostic::clone(fault)])),
        }
    }

    /// The stress of a law at an observation, in the measure of the data, in MPa.
    pub fn stress_of(&self, law: &dyn HyperelasticLaw, observation: &Observation) -> f64 {
        let (axis, x) = (observation.axis, observation.strain());
        let nominal = match self.test {
            Test::Uniaxial => {
                let direction = [[1.0, 0.0], [0.0, 1.0]][axis];
                law.tension(direction, x).nominal_stress
            }
            Test::SimpleShear => simple_shear(law, x),
            _ => law.biaxial(observation.strains)[axis],
        };
        self.stress_measure.of_nominal(nominal, x)
    }

    /// Energy in mJ/mm³ and nominal stress in MPa of a law at an observation.
    pub fn state_of(&self, law: &dyn HyperelasticLaw, observation: &Observation) -> [f64; 2] {
        let (axis, [first, second]) = (observation.axis, observation.strains);
        let (gradient, component) = match self.test {
            Test::Uniaxial => {
                let direction = [[1.0, 0.0], [0.0, 1.0]][axis];
                let result = law.tension(direction, observation.strain());
                return [result.energy, result.nominal_stress];
            }
            Test::SimpleShear => (PlaneTensor::new(0.0, first, 0.0, 0.0), 1),
            _ => (PlaneTensor::new(first, 0.0, 0.0, second), 3 * axis),
        };
        Kinematics::new(&gradient).map_or([f64::NAN; 2], |kinematics| {
            let (energy, stress) = law.stress(&kinematics);
            [energy, stress[component]]
        })
    }

    /// The largest energy of a law in mJ/mm³ before the record: at the strain to which the specimen was stretched, zero where none is stated.
    pub fn energy_before(&self, law: &dyn HyperelasticLaw) -> f64 {
        self.preconditioned.map_or(0.0, |x| {
            let across = match self.test {
                Test::Planar => 0.0,
                _ => x,
            };
            let axis = self.drawn_axis_of(self.axes[0]);
            let mut strains = [across; 2];
            strains[axis] = x;
            let observation = Observation {
                strains,
                axis,
                stress: 0.0,
            };
            self.state_of(law, &observation)[0]
        })
    }

    /// An observation after a shift of the zero that was found: its strain, or its stress in MPa, is larger by `by`. A specimen that
    /// would be slack is at rest: it carries no load of the opposite sign.
    pub fn moved(&self, observation: &Observation, by: f64) -> Observation {
        let mut moved = *observation;
        match self.found_zero {
            None => {}
            Some(FoundZero::Stress { .. }) => moved.stress += by,
            Some(FoundZero::Strain { .. }) => {
                let is_moved = |axis: usize| match self.test {
                    Test::Uniaxial | Test::SimpleShear => axis == observation.axis,
                    Test::Planar => axis == self.drawn_axis,
                    Test::Equibiaxial | Test::Biaxial => true,
                };
                for axis in [0, 1].into_iter().filter(|axis| is_moved(*axis)) {
                    moved.strains[axis] = self.loaded.moved(moved.strains[axis], by);
                }
            }
        }
        moved
    }

    /// λ − 1 along the axis over which the data are drawn: the one of the stress in a uniaxial test, otherwise the one that is stretched further.
    pub fn drawn_strain(&self, observation: &Observation) -> f64 {
        observation.strains[self.drawn_axis_of(observation.axis)]
    }

    /// The axis over which the stresses of an axis are drawn.
    pub(in crate::calibration) fn drawn_axis_of(&self, axis: usize) -> usize {
        match self.test {
            Test::Uniaxial | Test::SimpleShear => axis,
            _ => self.drawn_axis,
        }
    }

    /// The range of stretches of the data along both axes, including rest; in simple shear, of the principal stretches λ and 1/λ with
    /// λ − 1/λ = γ.
    pub fn stretch_range(&self) -> [f64; 2] {
        if self.test == Test::SimpleShear {
            let half = 0.5 * farthest(self.observations.iter().map(|one| one.strains[0])).abs();
            let stretch = half + half.hypot(1.0);
            return [1.0 / stretch, stretch];
        }
        let strains = self.observations.iter().flat_map(|one| one.strains);
        // Strains that are not known are ignored.
        extremes(strains.chain([0.0])).map(|strain| 1.0 + strain)
    }

    /// States along the data of one axis, from the smallest to the largest strain with rest between or at an
    /// end, for drawing a curve: `count` steps, the strain across interpolated. Their stresses are zero.
    pub fn path(&self, axis: usize, count: usize) -> Vec<Observation> {
        let mut sorted: Vec<&Observation> = self
            .observations
            .iter()
            .filter(|one| one.axis == axis)
            .collect();
        sorted.sort_by(|a, b| self.drawn_strain(a).total_cmp(&self.drawn_strain(b)));
        let ends = [sorted.first(), sorted.last()]
            .map(|one| one.map_or(0.0, |one| self.drawn_strain(one)));
        let (low, high) = (ends[0].min(0.0), ends[1].max(0.0));
        let drawn = self.drawn_axis_of(axis);
        let at = |x: f64| {
            let across = match self.test {
                Test::Uniaxial | Test::SimpleShear => f64::NAN,
                Test::Planar => 0.0,
                Test::Equibiaxial => x,
                Test::Biaxial => interpolate(&sorted, drawn, x),
            };
            let strains = if drawn == 0 { [x, across] } else { [across, x] };
            Observation {
                strains,
                axis,
                stress: 0.0,
            }
        };
        let share = |i: usize| low + (high - low) * i as f64 / count as f64;
        (0..=count).map(|i| at(share(i))).collect()
    }
}

/// The strain across at a strain along, between sorted observations.
fn interpolate(sorted: &[&Observation], along: usize, x: f64) -> f64 {
    let mut before = sorted.first().map_or([0.0; 2], |one| one.strains);
    for one in sorted {
        if one.strains[along] >= x {
            let width = one.strains[along] - before[along];
            let share = if width > 0.0 {
                (x - before[along]) / width
            } else {
                1.0
            };
            return before[1 - along] + share * (one.strains[1 - along] - before[1 - along]);
        }
        before = one.strains;
    }
    before[1 - along]
}
