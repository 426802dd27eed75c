//! Tests without a fit.

use super::{Course, STRETCH, deformation};
use crate::calibration::TestData;
use crate::results::chart::{LineChart, Scale, stress_chart};

/// Tests alone, as they were read, before any law is fitted to them.
pub fn tests_chart(tests: &[TestData]) -> LineChart {
    let stresses = |data: &TestData| data.observations.iter().map(|one| one.stress).collect();
    let stresses: Vec<Vec<f64>> = tests.iter().map(stresses).collect();
    let named = tests.iter().zip(&stresses);
    let named =
        named.map(|(data, stress)| (data.clone(), &stress[..], data.test.name().to_owned()));
    let named: Vec<_> = named.collect();
    let courses = Course::all(&named);
    let points = courses
        .iter()
        .map(|course| course.measured(STRETCH, Scale::Linear));
    let largest = tests.iter().map(|test| test.largest_stress);
    let measure = tests.first().map_or("", |test| test.stress_measure.title());
    stress_chart(
        "The tests as they were read",
        deformation(tests),
        &format!("{measure} stress"),
        largest.fold(0.0, f64::max),
        points.collect(),
    )
}
