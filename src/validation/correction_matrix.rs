//! The properties of Y (Eq. 16–19) and the agreement of the four forms of the projection.

use std::path::Path;

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::case::{Check, Outcome, Prepared, Wanted};
use super::plate::CORRECTOR;
use crate::corrector::{CorrectionMatrix, Corrector, Factor, Linear, Projection, Solver, retained};
use crate::document::Section;
use crate::error::{Error, SolveFault};
use crate::solve::{NotPositiveDefinite, SparseRows};

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("system");
    let unknowns = section.count("unknowns", 4, 400);
    let conditions = section.count("conditions", 2, 400);
    if conditions >= unknowns {
        section.fault(
            "conditions",
            "must be fewer than the unknowns",
            "such as half as many",
        );
    }
    let seed = section.count("seed", 0, usize::MAX) as u64;
    section.unknown_keys();
    Box::new(move |_| {
        compute(unknowns, conditions, seed).map_err(|NotPositiveDefinite| Error::Solve {
            model: "corrector".into(),
            step: "a random system".into(),
            fault: SolveFault::Singular,
        })
    })
}

/// Numbers in −1…1, about a third of them zero.
fn random_rows(random: &mut ChaCha8Rng, count: usize, size: usize) -> SparseRows {
    let mut rows = SparseRows::new(size);
    for _ in 0..count {
        let row = (0..size).filter_map(|column| {
            let value = random.random_range(-1.5..1.0_f64);
            (value > -1.0).then_some((column, value))
        });
        rows.push(row.collect::<Vec<_>>());
    }
    rows
}

fn compute(unknowns: usize, conditions: usize, seed: u64) -> Result<Outcome, NotPositiveDefinite> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let rows = random_rows(&mut random, conditions, unknowns);
    let numbers = |random: &mut ChaCha8Rng, size: usize| -> Vec<f64> {
        (0..size).map(|_| random.random_range(-1.0..1.0)).collect()
    };
    let matrix = CorrectionMatrix::new(&rows, vec![1.0; unknowns])?;
    let (y, s, b) = (matrix.y(), matrix.s(), matrix.b());
    let size = |matrix: DMatrix<f64>| matrix.amax();
    let identity = DMatrix::identity(conditions, conditions);
    let square = random_rows(&mut random, unknowns, unknowns);
    let zero = size(CorrectionMatrix::new(&square, vec![1.0; unknowns])?.y());
    let at_most = |quantity: &str, limit, source, value| {
        Check::new(quantity, "–", Wanted::AtMost(limit), source, value)
    };
    let mut checks = vec![
        at_most(
            "Y − Yᵀ, largest entry",
            1e-12,
            "Eq. 18",
            size(&y - y.transpose()),
        ),
        at_most(
            "Y Y − Y, largest entry",
            1e-12,
            "Eq. 18",
            size(&y * &y - &y),
        ),
        at_most("B Y, largest entry", 1e-12, "Eq. 14", size(b * &y)),
        at_most(
            "S B Bᵀ − I, largest entry",
            1e-11,
            "Eq. 19",
            size(s * b * b.transpose() - identity),
        ),
        Check::new(
            "rank of Y",
            "–",
            Wanted::Equal((unknowns - conditions) as f64, 0.0),
            "i less the rows of B",
            y.rank(1e-9) as f64,
        ),
        at_most(
            "Y of a square B, largest entry",
            1e-12,
            "design of Eq. 22-23",
            zero,
        ),
    ];

    let (values, pull) = (
        numbers(&mut random, conditions),
        numbers(&mut random, unknowns),
    );
    let project = |solver| {
        Factor::new(rows.clone(), vec![1.0; unknowns], None, solver)?.project(&values, &pull)
    };
    let expected = project(Solver::Dense)?;
    for (name, solver) in [
        ("sparse Cholesky", Solver::Cholesky),
        ("sparse KKT", Solver::Kkt),
    ] {
        let found = project(solver)?;
        let worst = far(&found, &expected);
        checks.push(at_most(
            &format!("{name} beside dense: field and multipliers"),
            1e-9,
            "the same projection",
            worst,
        ));
    }
    checks.push(at_most(
        "Y beside I − W⁻¹ Bᵀ (B W⁻¹ Bᵀ)⁻¹ B for unequal weights",
        1e-12,
        "Eq. 18-19",
        weighted(&rows, &mut random)?,
    ));
    checks.push(at_most(
        "symmetric form beside dense: field and multipliers",
        1e-9,
        "the same projection",
        symmetric(&mut random, unknowns)?,
    ));
    let mut kept = Factor::new(rows.clone(), vec![1.0; unknowns], None, Solver::Cholesky)?;
    let corrector = of_rows(&rows, unknowns);
    let mut read = retained::from_bytes(&retained::to_bytes(&kept, &corrector), &corrector)
        .map_err(|_| NotPositiveDefinite)?;
    let (found, before) = (read.project(&values, &pull)?, kept.project(&values, &pull)?);
    let worst = far(&found, &expected).max(far(&found, &before));
    checks.push(at_most(
        "retained factor, written and read, beside dense: field and multipliers",
        1e-9,
        "the same projection",
        worst,
    ));
    checks.push(at_most(
        "multipliers beside the derivative of the minimum",
        1e-6,
        "central differences",
        derivative(&rows, &values, &pull)?,
    ));
    Ok(Outcome {
        checks,
        ..Outcome::default()
    })
}

/// Largest difference of two projections, relative to the largest entry of the second.
fn far(found: &Projection, expected: &Projection) -> f64 {
    let far = |a: &[f64], b: &[f64]| {
        let scale = b.iter().fold(0.0, |most: f64, b| most.max(b.abs()));
        a.iter()
            .zip(b)
            .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
            / scale
    };
    far(&found.step, &expected.step).max(far(&found.multipliers, &expected.multipliers))
}

/// The corrector whose conditions are these rows.
fn of_rows(rows: &SparseRows, unknowns: usize) -> Corrector<'static> {
    let conditions = Linear::new("rows", rows.clone(), vec![0.0; rows.len()]);
    Corrector::new(vec![Box::new(conditions)], vec![1.0; unknowns], CORRECTOR)
}

/// Y for unequal weights beside its definition, computed with an explicit inverse: largest difference.
fn weighted(rows: &SparseRows, random: &mut ChaCha8Rng) -> Result<f64, NotPositiveDefinite> {
    let weights: Vec<f64> = (0..rows.columns())
        .map(|_| random.random_range(0.5..2.0))
        .collect();
    let y = CorrectionMatrix::new(rows, weights.clone())?.y();
    let b = rows.to_dense();
    let inverse = DMatrix::from_diagonal(&DVector::from_vec(weights).map(|weight| 1.0 / weight));
    let s = (&b * &inverse * b.transpose())
        .try_inverse()
        .ok_or(NotPositiveDefinite)?;
    let expected = DMatrix::identity(y.nrows(), y.nrows()) - inverse * b.transpose() * s * &b;
    Ok((y - expected).amax())
}

/// The symmetric form beside the dense one for a stiffness with every third unknown prescribed.
fn symmetric(random: &mut ChaCha8Rng, unknowns: usize) -> Result<f64, NotPositiveDefinite> {
    let a = random_rows(random, unknowns, unknowns).to_dense();
    let stiffness = &a * a.transpose() + DMatrix::identity(unknowns, unknowns);
    let mut rows = SparseRows::new(unknowns);
    for unknown in 0..unknowns {
        match unknown % 3 {
            0 => rows.push([(unknown, 1.0)]),
            _ => rows.push((0..unknowns).map(|column| (column, stiffness[(unknown, column)]))),
        }
    }
    let numbers = |random: &mut ChaCha8Rng| -> Vec<f64> {
        (0..unknowns)
            .map(|_| random.random_range(-1.0..1.0))
            .collect()
    };
    let (values, pull) = (numbers(random), numbers(random));
    let project = |solver, unknowns| {
        Factor::new(rows.clone(), vec![1.0; rows.columns()], unknowns, solver)?
            .project(&values, &pull)
    };
    let found = project(Solver::Symmetric, Some((0..unknowns).collect()))?;
    Ok(far(&found, &project(Solver::Dense, None)?))
}

/// Largest relative difference of −ψ and the derivatives of ½ ‖δ − pull‖² by the right-hand sides.
fn derivative(rows: &SparseRows, values: &[f64], pull: &[f64]) -> Result<f64, NotPositiveDefinite> {
    let mut factor = Factor::new(rows.clone(), vec![1.0; pull.len()], None, Solver::Dense)?;
    let psi = factor.project(values, pull)?.multipliers;
    let largest = psi.iter().fold(0.0, |most: f64, psi| most.max(psi.abs()));
    let mut worst = 0.0_f64;
    for row in 0..values.len() {
        let mut minimum = |step: f64| -> Result<f64, NotPositiveDefinite> {
            let mut moved = values.to_vec();
            moved[row] -= step;
            let found = factor.project(&moved, pull)?.step;
            Ok(found
                .iter()
                .zip(pull)
                .map(|(d, p)| 0.5 * (d - p).powi(2))
                .sum())
        };
        let slope = (minimum(1e-4)? - minimum(-1e-4)?) / 2e-4;
        worst = worst.max((slope + psi[row]).abs() / largest);
    }
    Ok(worst)
}
