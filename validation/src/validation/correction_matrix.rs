//! The properties of Y (Eq. 16–19) and the agreement of the four forms of the projection.

use std::path::Path;

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::case::{Check, Computation, Outcome, check, failed, largest, section};
use crate::corrector::{CorrectionMatrix, Factor, Projection, Solver};
use crate::document::Section;
use crate::solve::{FactorFault, SparseRows};
use crate::statistics::larger;

#[derive(Clone, Copy)]
struct Settings {
    unknowns: usize,
    conditions: usize,
    seed: u64,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let settings = section(root, "system", |system| {
        let settings = Settings {
            unknowns: system.count("unknowns", 4, 400),
            conditions: system.count("conditions", 2, 400),
            seed: system.count("seed", 0, usize::MAX) as u64,
        };
        if settings.conditions >= settings.unknowns {
            system.fault(
                "conditions",
                "must be fewer than the unknowns",
                "such as half as many",
            );
        }
        settings
    });
    Box::new(move |_| compute(settings).map_err(failed("corrector", "a random system")))
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

fn random_numbers(random: &mut ChaCha8Rng, size: usize) -> Vec<f64> {
    (0..size).map(|_| random.random_range(-1.0..1.0)).collect()
}

fn compute(settings: Settings) -> Result<Outcome, FactorFault> {
    let Settings {
        unknowns,
        conditions,
        seed,
    } = settings;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let rows = random_rows(&mut random, conditions, unknowns);
    let square = random_rows(&mut random, unknowns, unknowns);
    let mut checks = properties(&rows, &square)?;
    let system = System {
        rows,
        values: random_numbers(&mut random, conditions),
        pull: random_numbers(&mut random, unknowns),
    };
    checks.extend(system.forms()?);
    checks.push(at_most(
        "Y compared with I − W⁻¹ Bᵀ (B W⁻¹ Bᵀ)⁻¹ B for unequal weights",
        1e-12,
        "Eq. 18-19",
        weighted(&system.rows, &mut random)?,
    ));
    let symmetric = symmetric(&mut random, unknowns)?;
    checks.push(same_projection("symmetric form", symmetric));
    checks.push(at_most(
        "multipliers compared with the derivative of the minimum",
        1e-6,
        "central differences",
        system.derivative()?,
    ));
    Ok(Outcome {
        checks,
        ..Outcome::default()
    })
}

fn at_most(quantity: &str, limit: f64, source: &'static str, value: f64) -> Check {
    check(quantity, "–", value).at_most(limit, source)
}

fn same_projection(form: &str, distance: f64) -> Check {
    let quantity = format!("{form} compared with dense: field and multipliers");
    at_most(&quantity, 1e-9, "the same projection", distance)
}

/// What Eq. 14 and 16–19 say of Y, S and B.
fn properties(rows: &SparseRows, square: &SparseRows) -> Result<Vec<Check>, FactorFault> {
    let (unknowns, conditions) = (rows.columns(), rows.len());
    let matrix = CorrectionMatrix::new(rows, vec![1.0; unknowns])?;
    let (y, s, b) = (matrix.y(), matrix.s(), rows.to_dense());
    let identity = DMatrix::identity(conditions, conditions);
    let y_of_square = CorrectionMatrix::new(square, vec![1.0; unknowns])?.y();
    let largest = |what: &str, limit, source, matrix: DMatrix<f64>| {
        at_most(
            &format!("{what}, largest entry"),
            limit,
            source,
            matrix.amax(),
        )
    };
    let rank = check("rank of Y", "–", y.rank(1e-9) as f64);
    Ok(vec![
        largest("Y − Yᵀ", 1e-12, "Eq. 18", &y - y.transpose()),
        largest("Y Y − Y", 1e-12, "Eq. 18", &y * &y - &y),
        largest("B Y", 1e-12, "Eq. 14", &b * &y),
        largest(
            "S B Bᵀ − I",
            1e-11,
            "Eq. 19",
            s * &b * b.transpose() - identity,
        ),
        rank.equal((unknowns - conditions) as f64, 0.0, "i less the rows of B"),
        largest("Y of a square B", 1e-12, "design of Eq. 22-23", y_of_square),
    ])
}

/// Rows of B, their right-hand sides, and a pull on the unknowns.
struct System {
    rows: SparseRows,
    values: Vec<f64>,
    pull: Vec<f64>,
}

impl System {
    fn factor(&self, solver: Solver) -> Result<Factor, FactorFault> {
        Factor::new(self.rows.clone(), vec![1.0; self.pull.len()], None, solver)
    }

    fn project(&self, solver: Solver) -> Result<Projection, FactorFault> {
        self.factor(solver)?.project(&self.values, &self.pull)
    }

    /// The sparse forms of the projection compared with the dense one.
    fn forms(&self) -> Result<[Check; 2], FactorFault> {
        let dense = self.project(Solver::Dense)?;
        let cholesky = far(&self.project(Solver::Cholesky)?, &dense);
        let kkt = far(&self.project(Solver::Kkt)?, &dense);
        Ok([
            same_projection("sparse Cholesky", cholesky),
            same_projection("sparse KKT", kkt),
        ])
    }

    /// Largest relative difference of −ψ and the derivatives of ½ ‖δ − pull‖² with respect to the right-hand sides.
    fn derivative(&self) -> Result<f64, FactorFault> {
        let mut factor = self.factor(Solver::Dense)?;
        let psi = factor.project(&self.values, &self.pull)?.multipliers;
        let size = largest(psi.iter().copied());
        let mut worst = 0.0;
        for (row, psi) in psi.iter().enumerate() {
            let mut minimum = |step: f64| -> Result<f64, FactorFault> {
                let mut moved = self.values.clone();
                moved[row] -= step;
                let actual = factor.project(&moved, &self.pull)?.step;
                let squares = actual
                    .iter()
                    .zip(&self.pull)
                    .map(|(d, p)| 0.5 * (d - p).powi(2));
                Ok(squares.sum())
            };
            let slope = (minimum(1e-4)? - minimum(-1e-4)?) / 2e-4;
            worst = larger(worst, (slope + psi).abs() / size);
        }
        Ok(worst)
    }
}

/// Largest difference of two projections, relative to the largest entry of the second.
fn far(actual: &Projection, expected: &Projection) -> f64 {
    let far = |a: &[f64], b: &[f64]| {
        largest(a.iter().zip(b).map(|(a, b)| a - b)) / largest(b.iter().copied())
    };
    let multipliers = far(&actual.multipliers, &expected.multipliers);
    larger(far(&actual.step, &expected.step), multipliers)
}

/// Y for unequal weights compared with its definition, computed with an explicit inverse: largest difference.
fn weighted(rows: &SparseRows, random: &mut ChaCha8Rng) -> Result<f64, FactorFault> {
    let weights: Vec<f64> = (0..rows.columns())
        .map(|_| random.random_range(0.5..2.0))
        .collect();
    let y = CorrectionMatrix::new(rows, weights.clone())?.y();
    let b = rows.to_dense();
    let inverse = DMatrix::from_diagonal(&DVector::from_vec(weights).map(|weight| 1.0 / weight));
    let s = (&b * &inverse * b.transpose())
        .try_inverse()
        .ok_or(FactorFault::NotPositiveDefinite)?;
    let expected = DMatrix::identity(y.nrows(), y.nrows()) - inverse * b.transpose() * s * &b;
    Ok((y - expected).amax())
}

/// The symmetric form compared with the dense one for a stiffness with every third unknown prescribed.
fn symmetric(random: &mut ChaCha8Rng, unknowns: usize) -> Result<f64, FactorFault> {
    let a = random_rows(random, unknowns, unknowns).to_dense();
    let stiffness = &a * a.transpose() + DMatrix::identity(unknowns, unknowns);
    let mut rows = SparseRows::new(unknowns);
    for unknown in 0..unknowns {
        match unknown % 3 {
            0 => rows.push([(unknown, 1.0)]),
            _ => rows.push((0..unknowns).map(|column| (column, stiffness[(unknown, column)]))),
        }
    }
    let values = random_numbers(random, unknowns);
    let pull = random_numbers(random, unknowns);
    let project = |solver, unknowns| {
        Factor::new(rows.clone(), vec![1.0; rows.columns()], unknowns, solver)?
            .project(&values, &pull)
    };
    let actual = project(Solver::Symmetric, Some((0..unknowns).collect()))?;
    Ok(far(&actual, &project(Solver::Dense, None)?))
}
