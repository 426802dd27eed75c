//! What the middle of a mounted sheet carries of the measured forces.

use super::interpolation::Interpolation;
use super::sheet::{SheetLaw, SheetState};
use crate::calibration::data::{Observation, TestData};

/// The largest measured stress in MPa.
#[derive(Clone, Copy)]
struct Largest(f64);

impl Largest {
    /// P₀ as a share of it.
    const SMALL: f64 = 0.02;
    /// P₁ as a share of it.
    const MODERATE: f64 = 0.2;

    /// (P² + P₁²)^½.
    fn beside(self, stress: f64) -> f64 {
        stress.hypot(Self::MODERATE * self.0)
    }

    /// How many times larger a force over its cross-section is than the stress of the middle: (|f/A| + P₀) / (|P| + P₀).
    fn ratio(self, force: f64, stress: f64) -> f64 {
        let small = Self::SMALL * self.0;
        (force.abs() + small) / (stress.abs() + small)
    }
}

/// The relation of forces and middle by some values.
pub struct Middle {
    law: SheetLaw,
    largest: Largest,
    /// What the load cells read without load, in MPa.
    read: [f64; 2],
    /// Over the strains of the bars, or of the markers: coefficients of m − ε, and of d, along both axes.
    of_bars: Interpolation,
    strains: [Vec<f64>; 2],
    effects: [Vec<f64>; 2],
    /// Over the strains of the middle: the coefficients of the derivatives by each value along both axes, over (P² + P₁²)^½; `None` by a
    /// zero of force.
    of_middle: Interpolation,
    slopes: Vec<Option<[Vec<f64>; 2]>>,
    /// The same of d.
    effects_of_middle: [Vec<f64>; 2],
    /// The derivatives of the forces over the cross-sections at the knots by each value.
    forces: Vec<Vec<[f64; 2]>>,
}

/// The finite elements at the knots: of the law, and of those whose values are moved by steps.
struct Differences<'a> {
    laws: &'a [SheetLaw],
    steps: &'a [Option<f64>],
    solved: &'a [Vec<SheetState>],
    largest: Largest,
}

impl Differences<'_> {
    /// P of the middle at a knot along an axis.
    fn homogeneous(&self, knot: usize, axis: usize) -> f64 {
        self.laws[0].stresses(self.solved[knot][0].middle)[axis]
    }

    /// d.
    fn effect(&self, knot: usize, axis: usize) -> f64 {
        let stress = self.homogeneous(knot, axis);
        (self.solved[knot][0].stresses[axis] - stress) / self.largest.beside(stress)
    }

    /// The derivative of the force over the cross-section by a value; zero by a zero of force.
    fn force(&self, knot: usize, axis: usize, number: usize) -> f64 {
        let states = &self.solved[knot];
        let change = states[number + 1].stresses[axis] - states[0].stresses[axis];
        self.steps[number].map_or(0.0, |step| change / step)
    }

    /// The derivative of what the middle carries of a force, less that of the law there, over (P² + P₁²)^½.
    fn slope(&self, knot: usize, axis: usize, (number, step): (usize, f64)) -> f64 {
        let stress = self.homogeneous(knot, axis);
        let moved = self.laws[number + 1].stresses(self.solved[knot][0].middle)[axis];
        let ratio = self
            .largest
            .ratio(self.solved[knot][0].stresses[axis], stress);
        let by_law = (moved - stress) / step;
        (self.force(knot, axis, number) / ratio - by_law) / self.largest.beside(stress)
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
        let largest = Largest(largest);
        let differences = Differences {
            laws,
            steps,
            solved,
            largest,
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
            largest,
            read,
            strains: [0, 1].map(|axis| {
                let moved = |knot: usize| solved[knot][0].middle[axis] - knots[knot][axis];
                coefficients(of_bars, &moved)
            }),
            effects: [0, 1]
                .map(|axis| coefficients(of_bars, &|knot| differences.effect(knot, axis))),
            effects_of_middle: [0, 1]
                .map(|axis| coefficients(&of_middle, &|knot| differences.effect(knot, axis))),
            slopes: slopes.collect(),
            forces: forces.collect(),
            law: laws[0].clone(),
            of_bars: of_bars.clone(),
            of_middle,
        }
    }

    /// The same with the states of its law by other finite elements.
    #[must_use]
    pub fn with_states(&self, law: &[SheetLaw], solved: &[Vec<SheetState>]) -> Self {
        let middle = Self::new(&self.of_bars, law, &[], solved, (self.read, self.largest.0));
        Self {
            of_middle: self.of_middle.clone(),
            slopes: self.slopes.clone(),
            effects_of_middle: self.effects_of_middle.clone(),
            forces: self.forces.clone(),
            ..middle
        }
    }

    /// The strains and the stress of the middle, and the force over its cross-section, at an observation.
    fn at(&self, one: &Observation) -> ([f64; 2], f64, f64) {
        let basis = self.of_bars.basis(one.strains);
        let strains = [0, 1].map(|axis| one.strains[axis] + basis.value(&self.strains[axis]));
        let stress = self.law.stresses(strains)[one.axis];
        let effect = basis.value(&self.effects[one.axis]);
        (
            strains,
            stress,
            stress + effect * self.largest.beside(stress),
        )
    }

    /// An observation as it would be of the homogeneous middle.
    pub fn of(&self, one: &Observation) -> Observation {
        let (strains, stress, force) = self.at(one);
        let read = self.read[one.axis];
        let more = (one.stress - read - force) / self.largest.ratio(force, stress);
        Observation {
            strains,
            stress: stress + more + read,
            ..*one
        }
    }

    /// The derivatives of an observation of the middle by each value, less those that the law has there, relative to the cross-section at
    /// rest, and how many times larger the measured stress is.
    pub fn linear(&self, one: &Observation) -> (Vec<f64>, f64) {
        let axis = one.axis;
        let basis = self.of_middle.basis(one.strains);
        let stress = self.law.stresses(one.strains)[axis];
        let beside = self.largest.beside(stress);
        let size = beside / self.law.stretches[axis];
        let slope = |slopes: &Option<[Vec<f64>; 2]>| {
            let slopes = slopes.as_ref();
            slopes.map_or(0.0, |slopes| size * basis.value(&slopes[axis]))
        };
        let force = stress + basis.value(&self.effects_of_middle[axis]) * beside;
        let measured = self.largest.ratio(force, stress);
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
        let (_, _, force) = self.at(one);
        force + self.read[one.axis]
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
        self.forces.iter().map(at_knot).fold(0.0, f64::max) / self.largest.0
    }
}
