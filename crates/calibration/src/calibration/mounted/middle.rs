//! What the middle of a mounted sheet carries of the measured forces.

use super::interpolation::Interpolation;
use super::sheet::{SheetLaw, SheetState};
use crate::calibration::data::{Observation, TestData};

/// P₀ as a share of the largest stress.
const SMALL_STRESS: f64 = 0.02;

/// The relation of forces and middle by some values.
pub struct Middle {
    law: SheetLaw,
    /// P₀ in MPa.
    small: f64,
    /// What the load cells read without load, in MPa.
    read: [f64; 2],
    /// Over the strains of the bars, or of the markers: coefficients of m − ε, and of c, along both axes.
    of_bars: Interpolation,
    strains: [Vec<f64>; 2],
    factors: [Vec<f64>; 2],
    /// Over the strains of the middle: the coefficients of the derivatives by each value along both axes, over |P| + P₀; `None` by a zero
    /// of force.
    of_middle: Interpolation,
    slopes: Vec<Option<[Vec<f64>; 2]>>,
    /// The same of c.
    factors_of_middle: [Vec<f64>; 2],
    /// The derivatives of the forces over the cross-sections at the knots by each value.
    forces: Vec<Vec<[f64; 2]>>,
    largest: f64,
}

/// The finite elements at the knots: of the law, and of those whose values are moved by steps.
struct Differences<'a> {
    laws: &'a [SheetLaw],
    steps: &'a [Option<f64>],
    solved: &'a [Vec<SheetState>],
    small: f64,
}

impl Differences<'_> {
    /// P of the middle at a knot along an axis.
    fn homogeneous(&self, knot: usize, axis: usize) -> f64 {
        self.laws[0].stresses(self.solved[knot][0].middle)[axis]
    }

    /// c.
    fn factor(&self, knot: usize, axis: usize) -> f64 {
        let stress = self.homogeneous(knot, axis);
        (self.solved[knot][0].stresses[axis] - stress) / (stress.abs() + self.small)
    }

    /// The derivative of the force over the cross-section by a value; zero by a zero of force.
    fn force(&self, knot: usize, axis: usize, number: usize) -> f64 {
        let states = &self.solved[knot];
        let change = states[number + 1].stresses[axis] - states[0].stresses[axis];
        self.steps[number].map_or(0.0, |step| change / step)
    }

    /// The derivative of what the middle carries of a force, less that of the law there, over |P| + P₀.
    fn slope(&self, knot: usize, axis: usize, (number, step): (usize, f64)) -> f64 {
        let stress = self.homogeneous(knot, axis);
        let moved = self.laws[number + 1].stresses(self.solved[knot][0].middle)[axis];
        let over = 1.0 + self.factor(knot, axis) * stress.signum();
        let by_law = (moved - stress) / step;
        (self.force(knot, axis, number) / over - by_law) / (stress.abs() + self.small)
    }
}

impl Middle {
    /// Of the states of a law at the knots, and of laws whose values are moved by some steps; `None` for a value that the sheet does not
    /// depend on.
    pub fn new(
        of_bars: &Interpolation,
        laws: &[SheetLaw],
        steps: &[Option<f64>],
        solved: &[Vec<SheetState>],
        (read, largest): ([f64; 2], f64),
    ) -> Self {
        let small = SMALL_STRESS * largest;
        let differences = Differences {
            laws,
            steps,
            solved,
            small,
        };
        let all = 0..solved.len();
        let middles = solved.iter().map(|states| states[0].middle);
        let of_middle = Interpolation::through(middles.collect());
        let coefficients = |over: &Interpolation, value: &dyn Fn(usize) -> f64| {
            over.coefficients(all.clone().map(value).collect())
        };
        let numbered = || steps.iter().enumerate();
        let slopes =
            numbered().map(|(number, step)| {
                let by = (number, (*step)?);
                Some([0, 1].map(|axis| {
                    coefficients(&of_middle, &|knot| differences.slope(knot, axis, by))
                }))
            });
        let forces = all.clone().map(|knot| {
            let of_value = |(number, _)| [0, 1].map(|axis| differences.force(knot, axis, number));
            numbered().map(of_value).collect()
        });
        let knots = of_bars.knots();
        Self {
            small,
            read,
            strains: [0, 1].map(|axis| {
                let moved = |knot: usize| solved[knot][0].middle[axis] - knots[knot][axis];
                coefficients(of_bars, &moved)
            }),
            factors: [0, 1]
                .map(|axis| coefficients(of_bars, &|knot| differences.factor(knot, axis))),
            factors_of_middle: [0, 1]
                .map(|axis| coefficients(&of_middle, &|knot| differences.factor(knot, axis))),
            slopes: slopes.collect(),
            forces: forces.collect(),
            law: laws[0].clone(),
            of_bars: of_bars.clone(),
            of_middle,
            largest,
        }
    }

    /// The same with the states of its law by other finite elements.
    #[must_use]
    pub fn with_states(&self, law: &[SheetLaw], solved: &[Vec<SheetState>]) -> Self {
        let middle = Self::new(&self.of_bars, law, &[], solved, (self.read, self.largest));
        Self {
            of_middle: self.of_middle.clone(),
            slopes: self.slopes.clone(),
            factors_of_middle: self.factors_of_middle.clone(),
            forces: self.forces.clone(),
            ..middle
        }
    }

    /// The strains of the middle, and c, at an observation.
    fn at(&self, one: &Observation) -> ([f64; 2], f64) {
        let basis = self.of_bars.basis(one.strains);
        let strains = [0, 1].map(|axis| one.strains[axis] + basis.value(&self.strains[axis]));
        (strains, basis.value(&self.factors[one.axis]))
    }

    /// An observation as it would be of the homogeneous middle.
    pub fn of(&self, one: &Observation) -> Observation {
        let (strains, factor) = self.at(one);
        let read = self.read[one.axis];
        // Of x = P + c (|P| + P₀).
        let over = one.stress - read - factor * self.small;
        Observation {
            strains,
            stress: over / (1.0 + factor * over.signum()) + read,
            ..*one
        }
    }

    /// The derivatives of an observation of the middle by each value, less those that the law has there, relative to the cross-section at
    /// rest, and how many times larger the measured stress is.
    pub fn linear(&self, one: &Observation) -> (Vec<f64>, f64) {
        let axis = one.axis;
        let basis = self.of_middle.basis(one.strains);
        let stress = self.law.stresses(one.strains)[axis];
        let size = (stress.abs() + self.small) / self.law.stretches[axis];
        let slope = |slopes: &Option<[Vec<f64>; 2]>| {
            let slopes = slopes.as_ref();
            slopes.map_or(0.0, |slopes| size * basis.value(&slopes[axis]))
        };
        let factor = basis.value(&self.factors_of_middle[axis]);
        let measured = 1.0 + factor * stress.signum();
        (self.slopes.iter().map(slope).collect(), measured)
    }

    /// The sum of squares of the measured less the modelled stresses of some tests in MPa².
    pub fn square(&self, tests: &[TestData]) -> f64 {
        let rows = tests.iter().flat_map(|test| &test.observations);
        rows.map(|one| (one.stress - self.modelled(one)).powi(2))
            .sum()
    }

    /// What would be measured at the strains of an observation, in MPa.
    pub fn modelled(&self, one: &Observation) -> f64 {
        let (strains, factor) = self.at(one);
        let stress = self.law.stresses(strains)[one.axis];
        stress + factor * (stress.abs() + self.small) + self.read[one.axis]
    }

    /// By how much forces change between some values, to first order, as a share of the largest.
    pub fn change(&self, from: &[f64], to: &[f64]) -> f64 {
        let at_knot = |slopes: &Vec<[f64; 2]>| {
            let along = |axis: usize| {
                let changes = from.iter().zip(to).map(|(from, to)| to - from);
                let parts = slopes.iter().zip(changes);
                parts.map(|(slope, by)| slope[axis] * by).sum::<f64>().abs()
            };
            along(0).max(along(1))
        };
        self.forces.iter().map(at_knot).fold(0.0, f64::max) / self.largest
    }
}
