//! Frequencies of small vibrations about a state: K φ = ω² M φ.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, DVectorView, Dyn, SymmetricEigen};

use super::motion::Motion;
use crate::error::SolveFault;
use crate::solve::krylov::{irregular, largest_eigenvalue};
use crate::solve::vector::{gather, spread};
use crate::solve::{Assembly, Cholesky, SymmetricPattern};
use crate::statistics::larger;

/// A free vibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// ω/2π in Hz.
    pub frequency: f64,
    /// φ on all unknowns with φᵀ M φ = 1, in tonne^−½.
    pub shape: Vec<f64>,
}

/// Least share of a body's mass in its principal vibration along an axis: a bar's has 8/π².
const PRINCIPAL: f64 = 0.25;

/// The mode with the largest part in a motion of the whole body along an axis: (Σ mᵢ φᵢ)² over its unknowns is its effective
/// mass. `None` where that is less than a quarter of the whole: bending has no part in a motion along a strip.
pub fn strongest(modes: Vec<Mode>, mass: &[f64], axis: usize) -> Option<Mode> {
    let along = || (axis..mass.len()).step_by(2);
    let effective = |mode: &Mode| {
        along()
            .map(|i| mass[i] * mode.shape[i])
            .sum::<f64>()
            .powi(2)
    };
    let pairs = modes.into_iter().map(|mode| (effective(&mode), mode));
    let most = pairs.max_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = along().map(|i| mass[i]).sum();
    most.filter(|(effective, _)| *effective >= PRINCIPAL * total)
        .map(|(_, mode)| mode)
}

/// The principal vibration along X about the body at rest, sought among an increasing number of the slowest
/// ones: in slender strips many bending vibrations are slower. `None` where it is not among the first hundred.
///
/// # Errors
/// As [`slowest`].
pub fn principal(motion: &Motion, held: &[bool]) -> Result<Option<Mode>, SolveFault> {
    let rest = vec![0.0; held.len()];
    for count in [6, 24, 96] {
        let modes = slowest(motion, held, &rest, count)?;
        if let Some(mode) = strongest(modes, &motion.mass, 0) {
            return Ok(Some(mode));
        }
    }
    Ok(None)
}

/// The fastest vibration ω in rad/s, or somewhat more: ω² is the largest eigenvalue of M^−½ K M^−½.
pub(super) fn fastest(pattern: &SymmetricPattern, stiffness: &[f64], mass: &[f64]) -> f64 {
    let roots: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
    let over_roots = |x: &[f64]| -> Vec<f64> { x.iter().zip(&roots).map(|(x, r)| x / r).collect() };
    let apply = |x: &[f64]| over_roots(&pattern.multiply(stiffness, &over_roots(x)));
    largest_eigenvalue(mass.len(), apply).sqrt()
}

/// The `count` slowest vibrations about a displacement in mm, ascending, by inverse iteration of a subspace: with ψ = M^½ φ they
/// are the largest eigenvalues 1/ω² of M^½ K⁻¹ M^½, several equal ones included. Empty where nothing is free.
///
/// # Errors
/// [`SolveFault`] when the body is not stable there, or when the iteration stalls.
///
/// # References
/// K.-J. Bathe, Finite Element Procedures (2014), § 11.6
pub fn slowest(
    motion: &Motion,
    held: &[bool],
    displacement: &[f64],
    count: usize,
) -> Result<Vec<Mode>, SolveFault> {
    const ITERATIONS: usize = 200;
    const TOLERANCE: f64 = 1e-11;
    let assembly = Assembly::new(motion.energy, held);
    if assembly.free().is_empty() {
        return Ok(Vec::new());
    }
    let cholesky = factorised(motion, &assembly, displacement)?;
    let mass = gather(assembly.free(), &motion.mass);
    let roots = DVector::from_iterator(mass.len(), mass.iter().map(|m| m.sqrt()));
    let width = (2 * count).max(count + 6).min(mass.len());
    let columns = (0..width).flat_map(|seed| irregular(mass.len(), seed));
    let mut space = DMatrix::from_iterator(mass.len(), width, columns);
    let mut last = vec![f64::INFINITY; count.min(width)];
    for _ in 0..ITERATIONS {
        let basis = space.qr().q();
        let mut image = basis.clone();
        times_rows(&mut image, &roots);
        cholesky.substitute_columns(image.as_mut_slice(), width);
        times_rows(&mut image, &roots);
        let ritz = descending(SymmetricEigen::new(basis.tr_mul(&image)));
        let values = &ritz.eigenvalues.as_slice()[..last.len()];
        let changes = values
            .iter()
            .zip(&last)
            .map(|(now, last)| (last / now - 1.0).abs());
        if changes.fold(0.0, larger) < TOLERANCE {
            let shapes = basis * &ritz.eigenvectors;
            let mode = |(value, shape): (&f64, DVectorView<f64>)| {
                let scaled = shape.component_div(&roots);
                Mode {
                    frequency: 1.0 / (TAU * value.sqrt()),
                    shape: spread(assembly.free(), scaled.as_slice(), held.len()),
                }
            };
            return Ok(values.iter().zip(shapes.column_iter()).map(mode).collect());
        }
        last.copy_from_slice(values);
        space = image * ritz.eigenvectors;
    }
    Err(SolveFault::Stalled {
        iterations: ITERATIONS,
        residual: f64::NAN,
        tolerance: TOLERANCE,
    })
}

/// The factor of the stiffness at a displacement.
fn factorised(
    motion: &Motion,
    assembly: &Assembly,
    displacement: &[f64],
) -> Result<Cholesky, SolveFault> {
    let (mut residual, mut stiffness) = (vec![0.0; displacement.len()], Vec::new());
    assembly
        .linearise(motion.energy, displacement, &mut residual, &mut stiffness)
        .map_err(|fault| motion.inverted(fault))?;
    let mut cholesky = assembly.analyse()?;
    let factor = cholesky.factorise(&stiffness);
    factor.map_err(|fault| fault.or(SolveFault::NotPositiveDefinite))?;
    Ok(cholesky)
}

fn times_rows(matrix: &mut DMatrix<f64>, factors: &DVector<f64>) {
    for mut column in matrix.column_iter_mut() {
        column.component_mul_assign(factors);
    }
}

/// Eigenvalues and eigenvectors, the largest first.
fn descending(mut eigen: SymmetricEigen<f64, Dyn>) -> SymmetricEigen<f64, Dyn> {
    let values = eigen.eigenvalues.clone();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    eigen.eigenvectors = eigen.eigenvectors.select_columns(&order);
    eigen.eigenvalues = values.select_rows(&order);
    eigen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::tests::{DENSITY, clamp, plate, solved};
    use crate::dynamics::{Start, lumped_mass};
    use crate::finite_element::{Element, FiniteElements};

    /// Beside all eigenvalues of the dense matrix M^−½ K M^−½.
    #[test]
    fn the_slowest_and_the_fastest_vibrations_are_those_of_the_dense_matrix() {
        let problem = plate();
        let elements = FiniteElements::new(&problem, [5, 3], Element::Q1);
        let size = 2 * elements.mesh.nodes.len();
        let motion = Motion {
            energy: elements.energy(),
            viscosity: None,
            mass: lumped_mass(&elements.mesh, DENSITY, problem.thickness),
            supports: vec![clamp(&elements.mesh)],
            forces: Vec::new(),
            start: Start::held_at(vec![0.0; size]),
            describe: Box::new(|element| element.to_string()),
        };
        let stretched = solved(&problem, &elements.mesh, elements.energy(), 0.3);
        let held = motion.held(0.0);
        let assembly = Assembly::new(motion.energy, &held);
        let (mut residual, mut stiffness) = (vec![0.0; size], Vec::new());
        assembly
            .linearise(motion.energy, &stretched, &mut residual, &mut stiffness)
            .unwrap();
        let (pattern, mass) = (assembly.pattern(), gather(assembly.free(), &motion.mass));
        let mut dense = DMatrix::zeros(mass.len(), mass.len());
        for (row, entries) in pattern.full_rows(&stiffness).into_iter().enumerate() {
            for (column, value) in entries {
                dense[(row, column)] = value / (mass[row] * mass[column]).sqrt();
            }
        }
        let mut squares: Vec<f64> = dense.symmetric_eigenvalues().iter().copied().collect();
        squares.sort_by(f64::total_cmp);

        let modes = slowest(&motion, &held, &stretched, 4).unwrap();
        assert_eq!(modes.len(), 4);
        for (i, (mode, square)) in modes.iter().zip(&squares).enumerate() {
            let expected = square.sqrt() / TAU;
            assert!((mode.frequency / expected - 1.0).abs() < 1e-8, "{i}");
            for (j, other) in modes.iter().enumerate() {
                let pairs = mode.shape.iter().zip(&other.shape).zip(&motion.mass);
                let share: f64 = pairs.map(|((a, b), m)| m * a * b).sum();
                assert!(
                    (share - f64::from(i == j)).abs() < 1e-10,
                    "{i} {j}: {share}"
                );
            }
        }
        // The largest Ritz value with its bound is never below, and not far above.
        let most = squares[squares.len() - 1].sqrt();
        let highest = fastest(pattern, &stiffness, &mass);
        assert!((1.0..1.05).contains(&(highest / most)), "{highest} {most}");
    }

    #[test]
    fn the_strongest_mode_moves_most_mass_along_its_axis() {
        let mode = |frequency: f64, shape: [f64; 4]| Mode {
            frequency,
            shape: shape.to_vec(),
        };
        // One moves the nodes against each other, one along X, one along Y.
        let modes = vec![
            mode(1.0, [3.0, 0.1, -3.0, 0.0]),
            mode(2.0, [0.7, 0.0, 0.7, -0.3]),
            mode(3.0, [-0.1, 0.8, 0.0, 0.9]),
        ];
        let frequencies =
            [0, 1].map(|axis| strongest(modes.clone(), &[1.0; 4], axis).unwrap().frequency);
        assert_eq!(frequencies, [2.0, 3.0]);
        assert_eq!(strongest(modes[..1].to_vec(), &[1.0; 4], 0), None);
    }
}
