//! The softening of a fit: its parameters, and the cycles of the tests with the energy that each of them dissipates.

use super::data::{Branches, Observation, Test, TestData};
use crate::material::{HyperelasticLaw, Softening};
use crate::statistics::farthest;

/// The softening of a fit.
#[derive(Clone, Debug)]
pub struct Softened {
    /// Its parameters.
    pub softening: Softening,
    /// The text of the card whose law it is; `None` where the law is found.
    pub card: Option<String>,
    /// The cycles of all tests.
    pub cycles: Vec<SofteningCycle>,
}

/// Loading and unloading from one beginning of a loading to the next one, or to the end of the record.
#[derive(Clone, Debug, PartialEq)]
pub struct SofteningCycle {
    /// The test's name.
    pub test: String,
    /// The stretch at the end of the loading.
    pub stretch: f64,
    /// ∮ P dλ of the measured stresses by trapezoids, in mJ/mm³; NaN where stresses that do work along another axis were not measured.
    pub measured: f64,
    /// ∮ P dλ of the fitted stresses.
    pub fitted: f64,
    /// The difference of Ψ between the cycle's ends, which the fitted one approaches with short steps.
    pub closed_form: f64,
    /// D after the cycle minus D before it.
    pub dissipated: f64,
}

/// The cycles of a test with the stresses that a law with softening has at all its observations.
pub fn cycles(
    data: &TestData,
    law: &dyn HyperelasticLaw,
    softening: Softening,
    predicted: &[f64],
) -> Vec<SofteningCycle> {
    let record = rows(data, law, predicted);
    let mut most = data.energy_before(law);
    let of_cycle = |pair: &[usize]| {
        let rows = &record[pair[0]..=pair[1]];
        let [first, last] = [rows[0].energy, rows[rows.len() - 1].energy];
        let before = most.max(first);
        most = rows.iter().fold(before, |most, row| most.max(row.energy));
        let [measured, fitted] = work(data.test, rows);
        let far = farthest(rows.iter().map(|row| row.strain));
        SofteningCycle {
            test: data.name.clone(),
            stretch: 1.0 + far,
            measured,
            fitted,
            closed_form: softening.energy(last, most) - softening.energy(first, before),
            dissipated: softening.dissipated(most) - softening.dissipated(before),
        }
    };
    ends(&record).windows(2).map(of_cycle).collect()
}

impl Softened {
    /// The path of a test along one axis with `steps` steps from each observation to the next: the strain over which it is drawn, and the
    /// stress of the softened law in the measure of the data, in MPa.
    pub fn path(
        &self,
        data: &TestData,
        law: &dyn HyperelasticLaw,
        axis: usize,
        steps: u32,
    ) -> Vec<[f64; 2]> {
        let along = data.observations.iter().filter(|one| one.axis == axis);
        let rows: Vec<&Observation> = along.collect();
        let mut most = data.energy_before(law);
        let mut point = |one: &Observation| {
            let [energy, stress] = data.state_of(law, one);
            most = most.max(energy);
            let [factor, _] = self.softening.factor(energy, most);
            let stress = data
                .stress_measure
                .of_nominal(factor * stress, one.strains[axis]);
            [data.drawn_strain(one), stress]
        };
        let mut path: Vec<[f64; 2]> = rows.first().map(|one| point(one)).into_iter().collect();
        for pair in rows.windows(2) {
            path.extend((1..=steps).map(|step| {
                let share = f64::from(step) / f64::from(steps);
                let strain = |axis: usize| {
                    let [from, to] = [0, 1].map(|end: usize| pair[end].strains[axis]);
                    from + share * (to - from)
                };
                point(&Observation {
                    strains: [0, 1].map(strain),
                    ..*pair[1]
                })
            }));
        }
        path
    }
}

/// A row along the axis that does work.
struct Row {
    strain: f64,
    /// W₀ in mJ/mm³.
    energy: f64,
    /// Measured and fitted nominal stress in MPa.
    stresses: [f64; 2],
}

/// The rows of a test along the axis that does work.
fn rows(data: &TestData, law: &dyn HyperelasticLaw, predicted: &[f64]) -> Vec<Row> {
    let axis = data.drawn_axis_of(data.axes[0]);
    let pairs = data.observations.iter().zip(predicted);
    let along = pairs.filter(|(one, _)| one.axis == axis);
    let row = |(one, fitted): (&Observation, &f64)| {
        let nominal = |stress| data.stress_measure.to_nominal(stress, one.strain());
        Row {
            strain: data.drawn_strain(one),
            energy: data.state_of(law, one)[0],
            stresses: [one.stress, *fitted].map(nominal),
        }
    };
    along.map(row).collect()
}

/// The rows at which cycles begin, and the last one.
fn ends(rows: &[Row]) -> Vec<usize> {
    let strains: Vec<f64> = rows.iter().map(|row| row.strain).collect();
    let branches = Branches::of(&strains);
    let mut ends: Vec<usize> = branches.loading.iter().map(|rows| rows.start).collect();
    if let Some(first) = ends.first_mut() {
        *first = 0;
    }
    ends.extend(rows.len().checked_sub(1));
    ends
}

/// ∫ P dλ of measured and fitted stresses over some rows, by trapezoids, in mJ/mm³; NaN where it is not that of one stress.
fn work(test: Test, rows: &[Row]) -> [f64; 2] {
    let axes = match test {
        Test::Uniaxial | Test::Planar | Test::SimpleShear => 1.0,
        Test::Equibiaxial => 2.0,
        Test::Biaxial => f64::NAN,
    };
    let mut work = [0.0; 2];
    for pair in rows.windows(2) {
        let along = axes * (pair[1].strain - pair[0].strain);
        for (part, sum) in work.iter_mut().enumerate() {
            *sum += 0.5 * (pair[0].stresses[part] + pair[1].stresses[part]) * along;
        }
    }
    work
}
