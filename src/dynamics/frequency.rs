//! Frequencies of small vibrations about a state: K φ = ω² M φ.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, SymmetricEigen};

use super::motion::Motion;
use super::viscosity::{gather, inverted};
use crate::error::SolveFault;
use crate::solve::{Assembly, SymmetricPattern};

/// A free vibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// ω/2π in Hz.
    pub frequency: f64,
    /// φ on all unknowns with φᵀ M φ = 1, in tonne^−½.
    pub shape: Vec<f64>,
}

/// The mode that takes most of a motion of the whole body along an axis: (Σ mᵢ φᵢ)² over its unknowns is its effective
/// mass.
pub fn strongest(modes: Vec<Mode>, mass: &[f64], axis: usize) -> Option<Mode> {
    let effective = |mode: &Mode| {
        let along = (axis..mass.len()).step_by(2);
        along.map(|i| mass[i] * mode.shape[i]).sum::<f64>().abs()
    };
    let pairs = modes.into_iter().map(|mode| (effective(&mode), mode));
    let most = pairs.max_by(|a, b| a.0.total_cmp(&b.0));
    most.map(|(_, mode)| mode)
}

/// A vector without any symmetry.
fn irregular(size: usize, seed: usize) -> Vec<f64> {
    let entry = |i: usize| ((i + 1) as f64 * (2.0 + seed as f64).sqrt()).sin();
    (0..size)
        .map(|i| entry(i) + 0.3 * (i as f64).sqrt().sin())
        .collect()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The fastest vibration ω in rad/s by Lanczos' method on M^−½ K M^−½: the largest Ritz value with its error bound.
///
/// # References
/// B. N. Parlett, The Symmetric Eigenvalue ClampedPlate, SIAM (1998), § 13.2, doi:10.1137/1.9781611971163
pub(super) fn fastest(pattern: &SymmetricPattern, stiffness: &[f64], mass: &[f64]) -> f64 {
    const STEPS: usize = 24;
    let roots: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
    let size = mass.len();
    let mut now = irregular(size, 0);
    let scale = product(&now, &now).sqrt();
    now.iter_mut().for_each(|x| *x /= scale);
    let mut last = vec![0.0; size];
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    let mut beta = 0.0;
    for _ in 0..STEPS.min(size) {
        let scaled: Vec<f64> = now.iter().zip(&roots).map(|(x, root)| x / root).collect();
        let mut next = pattern.multiply(stiffness, &scaled);
        for ((next, root), last) in next.iter_mut().zip(&roots).zip(&last) {
            *next = *next / root - beta * last;
        }
        let alpha = product(&next, &now);
        next.iter_mut()
            .zip(&now)
            .for_each(|(next, now)| *next -= alpha * now);
        diagonal.push(alpha);
        beta = product(&next, &next).sqrt();
        beside.push(beta);
        if beta <= 1e-12 * alpha.abs() {
            break;
        }
        next.iter_mut().for_each(|x| *x /= beta);
        last = std::mem::replace(&mut now, next);
    }
    let count = diagonal.len();
    let tridiagonal = DMatrix::from_fn(count, count, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.min(j)],
        _ => 0.0,
    });
    if tridiagonal.iter().any(|entry| !entry.is_finite()) {
        return f64::NAN;
    }
    let eigen = SymmetricEigen::new(tridiagonal);
    let bounds = (0..count).map(|i| {
        eigen.eigenvalues[i].abs() + beside[count - 1] * eigen.eigenvectors[(count - 1, i)].abs()
    });
    bounds.fold(0.0, f64::max).sqrt()
}

/// The `count` slowest vibrations about a displacement in mm, by inverse iteration of a subspace, ascending.
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
    let size = assembly.free().len();
    let (mut residual, mut stiffness) = (vec![0.0; held.len()], Vec::new());
    assembly
        .linearise(motion.energy, displacement, &mut residual, &mut stiffness)
        .map_err(inverted(&*motion.describe))?;
    let mut cholesky = assembly
        .analyse(motion.energy)
        .map_err(|_| SolveFault::Singular)?;
    cholesky
        .factorise(&stiffness)
        .map_err(|_| SolveFault::NotPositiveDefinite)?;
    let mass = gather(assembly.free(), &motion.mass);
    let width = (2 * count).max(count + 6).min(size);
    let mut space: Vec<Vec<f64>> = (0..width).map(|seed| irregular(size, seed)).collect();
    let mut last = vec![f64::INFINITY; count.min(width)];
    for _ in 0..ITERATIONS {
        for vector in &mut space {
            let mut forces: Vec<f64> = vector.iter().zip(&mass).map(|(x, m)| x * m).collect();
            cholesky.substitute(&mut forces);
            *vector = forces;
        }
        orthonormalise(&mut space, &mass);
        let squares = rotate(&mut space, assembly.pattern(), &stiffness);
        let squares = &squares[..last.len()];
        let pairs = squares.iter().zip(&last);
        if pairs.fold(0.0, |most: f64, (now, last)| {
            most.max((now / last - 1.0).abs())
        }) < TOLERANCE
        {
            let mode = |(square, own): (&f64, &Vec<f64>)| {
                let mut shape = vec![0.0; held.len()];
                for (unknown, entry) in assembly.free().iter().zip(own) {
                    shape[*unknown] = *entry;
                }
                Mode {
                    frequency: square.sqrt() / TAU,
                    shape,
                }
            };
            return Ok(squares.iter().zip(&space).map(mode).collect());
        }
        last.copy_from_slice(squares);
    }
    Err(SolveFault::Stalled {
        iterations: ITERATIONS,
        residual: f64::NAN,
        tolerance: TOLERANCE,
    })
}

/// Makes vectors orthonormal with the mass as their scalar product, twice for the digits.
fn orthonormalise(space: &mut [Vec<f64>], mass: &[f64]) {
    for i in 0..space.len() {
        let (before, rest) = space.split_at_mut(i);
        let own = &mut rest[0];
        for _ in 0..2 {
            for other in before.iter() {
                let share: f64 = (0..own.len()).map(|k| own[k] * mass[k] * other[k]).sum();
                own.iter_mut()
                    .zip(other)
                    .for_each(|(own, other)| *own -= share * other);
            }
            let square: f64 = own.iter().zip(mass).map(|(x, m)| m * x * x).sum();
            let scale = square.sqrt().max(f64::MIN_POSITIVE);
            own.iter_mut().for_each(|x| *x /= scale);
        }
    }
}

/// Turns the vectors into the Ritz vectors of the stiffness in their span; ω², ascending.
fn rotate(space: &mut [Vec<f64>], pattern: &SymmetricPattern, stiffness: &[f64]) -> Vec<f64> {
    let forces: Vec<Vec<f64>> = space
        .iter()
        .map(|own| pattern.multiply(stiffness, own))
        .collect();
    let width = space.len();
    let projected = DMatrix::from_fn(width, width, |i, j| {
        0.5 * (product(&space[i], &forces[j]) + product(&space[j], &forces[i]))
    });
    let eigen = SymmetricEigen::new(projected);
    let mut order: Vec<usize> = (0..width).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let turned: Vec<Vec<f64>> = order
        .iter()
        .map(|column| {
            let mut own = vec![0.0; space[0].len()];
            for (row, vector) in space.iter().enumerate() {
                let factor = eigen.eigenvectors[(row, *column)];
                own.iter_mut()
                    .zip(vector)
                    .for_each(|(own, x)| *own += factor * x);
            }
            own
        })
        .collect();
    space
        .iter_mut()
        .zip(turned)
        .for_each(|(own, turned)| *own = turned);
    order.iter().map(|i| eigen.eigenvalues[*i]).collect()
}

/// x of A x = b for a positive definite matrix, to 14 digits or as near as rounding allows.
pub(super) fn conjugate_gradients(
    pattern: &SymmetricPattern,
    values: &[f64],
    b: &[f64],
) -> Vec<f64> {
    let diagonal: Vec<f64> = pattern
        .diagonal()
        .iter()
        .map(|place| values[*place])
        .collect();
    let precondition =
        |r: &[f64]| -> Vec<f64> { r.iter().zip(&diagonal).map(|(r, d)| r / d).collect() };
    let (mut x, mut r) = (vec![0.0; b.len()], b.to_vec());
    let mut z = precondition(&r);
    let mut direction = z.clone();
    let mut square = product(&r, &z);
    let enough = 1e-28 * square;
    for _ in 0..2 * b.len() + 20 {
        if square <= enough || square.is_nan() {
            break;
        }
        let image = pattern.multiply(values, &direction);
        let length = square / product(&direction, &image);
        for i in 0..x.len() {
            x[i] += length * direction[i];
            r[i] -= length * image[i];
        }
        z = precondition(&r);
        let next = product(&r, &z);
        for (direction, z) in direction.iter_mut().zip(&z) {
            *direction = z + next / square * *direction;
        }
        square = next;
    }
    x
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
            start: Start::at_rest(size),
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
        let found = fastest(pattern, &stiffness, &mass);
        assert!((1.0..1.05).contains(&(found / most)), "{found} {most}");
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
        let found = [0, 1].map(|axis| strongest(modes.clone(), &[1.0; 4], axis).unwrap().frequency);
        assert_eq!(found, [2.0, 3.0]);
    }
}
