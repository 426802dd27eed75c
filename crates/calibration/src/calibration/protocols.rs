//! How well the protocols of a biaxial test determine a law: the error of its prediction of protocols to which it was not fitted, and the
//! further protocol that would reduce the uncertainty of its parameters most.
//!
//! ```text
//! C' = C − C Jᵀ (σ² 1 + J C Jᵀ)⁻¹ J C,   J = ∂r/∂p of the further protocol, σ² the variance of the weighted residuals r
//! ```
//!
//! # References
//! A. C. Atkinson, A. N. Donev, Optimum Experimental Designs, Oxford 1992

use nalgebra::DMatrix;

use super::data::{Observation, Test, TestData};
use super::fitted::{Fit, FurtherProtocol, Protocols};
use super::least_squares::{LEAST_SIZE, jacobian, sum_of_squares};
use super::nearest::About;
use super::regression::{Elastic, Misfit, Response, Zero};

/// The figures of the protocols to which a law was fitted; `None` for other tests, or for a single protocol.
pub fn protocols(fit: &Fit, tests: &[TestData]) -> Option<Protocols> {
    let tests = fit.mounted.as_ref().map_or(tests, |mounted| &mounted.tests);
    let is_biaxial = tests.iter().all(|test| test.test == Test::Biaxial);
    let of_record = |zero: &Zero| matches!(zero, Zero::Record { .. });
    if !is_biaxial || Zero::of(tests).iter().any(of_record) {
        return None;
    }
    let protocols: Vec<TestData> = tests.iter().flat_map(TestData::by_protocol).collect();
    if protocols.len() < 2 {
        return None;
    }
    let left_out = |number| left_out(fit, &protocols, number);
    let left_out: Option<Vec<f64>> = (0..protocols.len()).map(left_out).collect();
    Some(Protocols {
        left_out_percent: left_out?,
        further: further(fit, &protocols),
    })
}

/// The error with which a protocol is predicted by the law fitted to the others in % of the largest stress.
fn left_out(fit: &Fit, protocols: &[TestData], number: usize) -> Option<f64> {
    let mut others = protocols.to_vec();
    let omitted = [others.remove(number)];
    let start = fit.values();
    let about = About {
        law: fit.law,
        tests: &others,
        start: &start,
        linear: |_: &Observation| (vec![0.0; start.len()], 1.0),
        other: None,
        settings: &fit.settings,
    };
    let values = about.within(f64::INFINITY).ok()?;
    let response = Elastic::new(fit.law, &omitted).with_zeros();
    let predicted = response.predicted(&values).concat();
    let measured = response.moved_tests(&values);
    let pairs = measured[0].observations.iter().zip(&predicted);
    let square: f64 = pairs
        .map(|(one, stress)| (one.stress - stress).powi(2))
        .sum();
    let error = (square / predicted.len() as f64).sqrt();
    Some(100.0 * error / TestData::largest_stress(protocols))
}

/// The most useful further protocol.
fn further(fit: &Fit, protocols: &[TestData]) -> Option<FurtherProtocol> {
    /// Shares of the largest strains of both axes.
    const RATIOS: [[f64; 2]; 9] = [
        [1.0, 1.0],
        [1.0, 0.75],
        [0.75, 1.0],
        [1.0, 0.5],
        [0.5, 1.0],
        [1.0, 0.25],
        [0.25, 1.0],
        [1.0, 0.0],
        [0.0, 1.0],
    ];
    let quality = &fit.quality;
    let noise = quality.noise.as_ref().filter(|_| quality.has_intervals())?;
    let covariance = noise.covariance();
    let share = |index: usize| {
        let estimate = &quality.estimates[index];
        estimate.standard_error / estimate.value.abs()
    };
    let known = (0..fit.parameters.len()).filter(|index| share(*index).is_finite());
    let widest = known.max_by(|a, b| share(*a).total_cmp(&share(*b)))?;
    let free = (0..quality.fixed.len()).filter(|index| !quality.fixed[*index]);
    let row = free.clone().position(|index| index == widest)?;
    let variance = variance(fit, protocols, free.clone().count());
    let narrowed = |ratio: [f64; 2]| {
        let protocol = [protocol(fit, protocols, ratio)?];
        let response = Elastic::new(fit.law, &protocol).with_zeros();
        let misfit = Misfit::new(response, fit.settings.weighting);
        let least = vec![LEAST_SIZE; quality.fixed.len()];
        let derivatives = jacobian(&misfit, &fit.values(), &quality.fixed, &least)?;
        let slopes = derivatives.select_columns(&free.clone().collect::<Vec<_>>());
        let across = &covariance * slopes.transpose();
        let size = slopes.nrows();
        let inverse = (&slopes * &across + variance * DMatrix::identity(size, size)).cholesky()?;
        let gained = across.row(row) * inverse.solve(&across.transpose()).column(row);
        let remaining = (1.0 - gained[(0, 0)] / covariance[(row, row)])
            .max(0.0)
            .sqrt();
        let largest = Observation::farthest_strains(&protocol[0].observations);
        Some((remaining, largest.map(|strain| 1.0 + strain)))
    };
    let all = RATIOS.into_iter().filter_map(narrowed);
    let (remaining, stretches) = all.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let percent = 100.0 * share(widest);
    Some(FurtherProtocol {
        stretches,
        key: fit.parameters[widest].key,
        standard_error_percent: [percent, remaining * percent],
    })
}

/// The variance of the weighted residuals, increased by the number of points over the number of independent ones.
fn variance(fit: &Fit, protocols: &[TestData], values: usize) -> f64 {
    let response = Elastic::new(fit.law, protocols).with_zeros();
    let misfit = Misfit::new(response, fit.settings.weighting);
    let rows = misfit.rows.len();
    let freedom = rows.saturating_sub(values).max(1) as f64;
    let worth = fit.quality.verdict.map_or(1.0, |verdict| {
        (verdict.effective_points / rows as f64).clamp(f64::MIN_POSITIVE, 1.0)
    });
    sum_of_squares(&misfit, &fit.values()) / freedom / worth
}

/// A protocol up to shares of the largest strains, or to the largest stress, whose stresses are those of the law.
fn protocol(fit: &Fit, protocols: &[TestData], ratio: [f64; 2]) -> Option<TestData> {
    let counts = protocols.iter().map(|one| one.observations.len());
    let total: usize = counts.sum();
    let rows = (total / protocols.len() / 2).max(2);
    let largest = [0, 1].map(|axis| {
        let strains = protocols.iter().map(|protocol| protocol.reached(axis));
        ratio[axis] * strains.fold(0.0, f64::max)
    });
    let most = TestData::largest_stress(protocols);
    let of_rows = |stress: f64| {
        let observations = (1..=rows).flat_map(|row| {
            let share = row as f64 / rows as f64;
            let strains = largest.map(|strain| share * strain);
            [0, 1].map(|axis| Observation {
                strains,
                axis,
                stress,
            })
        });
        TestData {
            observations: observations.collect(),
            left_out: Vec::new(),
            largest_stress: most,
            ..protocols[0].clone()
        }
    };
    // What is measured is linear in the stress of the law at the strains from rest.
    let [zero, unit] = [0.0, most].map(|stress| [of_rows(stress)]);
    let values = fit.values();
    let moved = [&zero, &unit].map(|tests| {
        let response = Elastic::new(fit.law, tests).with_zeros();
        let rows = &response.moved_tests(&values)[0].observations;
        let stresses: Vec<f64> = rows.iter().map(|one| one.stress).collect();
        (stresses, response.predicted(&values).concat())
    });
    let [(at_zero, predicted), (at_unit, _)] = moved;
    let mut protocol = zero[0].clone();
    for (row, one) in protocol.observations.iter_mut().enumerate() {
        one.stress = most * (predicted[row] - at_zero[row]) / (at_unit[row] - at_zero[row]);
    }
    let is_too_large = |pair: &&[Observation]| pair.iter().any(|one| one.stress > 1.001 * most);
    let pairs = protocol.observations.chunks(2);
    let within = pairs.take_while(|pair| !is_too_large(pair)).count();
    protocol.observations.truncate(2 * within);
    (within > 1).then_some(protocol)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::tests::biaxial::record;
    use crate::calibration::tests::helpers::fitted;

    const TISSUE: [f64; 5] = [0.01, 0.05, 3.0, 0.1, 0.6];

    /// Protocols up to a strain of 0.2.
    fn biaxial_test(ratios: &[[f64; 2]]) -> [TestData; 1] {
        let law = ("holzapfel-gasser-ogden", &TISSUE[..]);
        [record(law, (ratios, 0.2), (0.002, 0))]
    }

    fn protocols(law: &str, ratios: &[[f64; 2]]) -> Protocols {
        fitted(law, &biaxial_test(ratios)).protocols.unwrap()
    }

    /// The right law predicts what it did not see within its noise; an isotropic one does not.
    #[test]
    fn protocols_that_are_left_out_tell_laws_apart() {
        let ratios = [[1.0, 1.0], [1.0, 0.5], [0.5, 1.0]];
        let [right, wrong] =
            ["holzapfel-gasser-ogden", "fung-demiray"].map(|law| protocols(law, &ratios));
        assert_eq!(right.left_out_percent.len(), 3);
        assert!(right.all_left_out_percent() < 1.0, "{right:?}");
        assert!(wrong.all_left_out_percent() > 4.0, "{wrong:?}");
    }

    /// What is predicted for a further protocol is what comes of it.
    #[test]
    fn a_further_protocol_narrows_the_widest_interval_as_predicted() {
        let ratios = vec![[1.0, 1.0], [1.0, 0.75]];
        let before = protocols("holzapfel-gasser-ogden", &ratios)
            .further
            .unwrap();
        let [today, then] = before.standard_error_percent;
        assert!(then < 0.7 * today, "{before:?}");
        let share = before.stretches.map(|stretch| (stretch - 1.0) / 0.2);
        let tests = biaxial_test(&[&ratios[..], &[share]].concat());
        let after = fitted("holzapfel-gasser-ogden", &tests);
        let index = after
            .parameters
            .iter()
            .position(|parameter| parameter.key == before.key)
            .unwrap();
        let estimate = &after.quality.estimates[index];
        let percent = 100.0 * estimate.standard_error / estimate.value;
        assert!(
            percent < 1.5 * then && percent > then / 1.5,
            "{percent} {before:?}"
        );
    }
}
