//! What markers tell in addition to the field: which edges are free, and a parameter of the law.

use rayon::prelude::*;

use super::subject::{Disturbance, MIDDLE, Subject, unknown_grips};
use super::trials::TARGET;
use crate::error::Error;
use crate::estimation::{EdgeCondition, Knowledge, RegressedLaw, Unnamed};
use crate::validation::case::{Check, check, mean, normal_numbers_of_stream, share};

/// Nothing is stated about any edge: the data tell which ones are free.
pub fn free_edges(subject: &Subject, seeds: u64) -> Result<Check, Error> {
    let knowledge = Knowledge {
        unnamed: Unnamed::Tested,
        ..Knowledge::default()
    };
    let [length, _] = subject.mesh.size();
    let right = |seed: u64| -> Result<bool, Error> {
        let data = subject.data(Disturbance::noise(MIDDLE), seed);
        let actual = subject.estimate(&data, &knowledge)?;
        let tested = actual
            .edges
            .iter()
            .filter(|edge| edge.probability.is_some());
        let mut right = tested.map(|edge| {
            let is_long = edge.length > 0.9 * length;
            is_long == (edge.condition == EdgeCondition::Free)
        });
        Ok(right.clone().count() == 4 && right.all(|right| right))
    };
    let right: Result<Vec<bool>, Error> = (0..seeds).into_par_iter().map(right).collect();
    let what = "seeds whose data distinguish the free edges from the grips";
    Ok(check(format!("{}: {what}", subject.name), "%", share(right?)).at_least(90.0, TARGET))
}

/// An estimate of the law's first parameter.
struct Estimate {
    is_covered: bool,
    error_percent: f64,
}

/// The first parameter of the law, from the field and the force, whose standard deviation is a share of it.
pub fn modulus(
    subject: &Subject,
    law: &RegressedLaw,
    relative_deviation: f64,
    seeds: u64,
) -> Result<[Check; 2], Error> {
    let truth = law.start()[0];
    let estimate = |seed: u64| -> Result<Estimate, Error> {
        let data = subject.data(Disturbance::noise(MIDDLE), seed);
        let draw = normal_numbers_of_stream(seed, 1).next().unwrap_or(0.0);
        let knowledge = Knowledge {
            forces: vec![subject.measured_force(relative_deviation, draw)],
            law: Some(law.scaled(1.3)),
            ..unknown_grips()
        };
        let (_, _, modulus) = subject.estimate(&data, &knowledge)?.parameters[0];
        Ok(Estimate {
            is_covered: modulus.holds(truth),
            error_percent: 100.0 * (modulus.value / truth - 1.0).abs(),
        })
    };
    let actual: Result<Vec<_>, Error> = (0..seeds).into_par_iter().map(estimate).collect();
    let actual = actual?;
    let (name, key) = (subject.name, law.parameters()[0].key);
    let coverage = share(actual.iter().map(|actual| actual.is_covered));
    let error = mean(actual.iter().map(|actual| actual.error_percent));
    Ok([
        check(
            format!("{name}: seeds with {key} in its 95 % interval"),
            "%",
            coverage,
        )
        .at_least(90.0, TARGET),
        check(format!("{name}: mean relative error of {key}"), "%", error).at_most(2.0, TARGET),
    ])
}
