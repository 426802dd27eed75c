//! The points at which the energy of a plate's rectangular elements is sampled: products of points along both axes.

use std::sync::{Arc, LazyLock};

use crate::mesh::{GAUSS_2, GAUSS_3, GAUSS_4, lobatto};
use crate::problem::ClampedPlate;
use crate::problem::sampling_point::{DerivativeTable, PointMap};
use crate::problem::sheet_energy::SheetEnergy;

/// The Gauss points at which the energy of an element is sampled along one axis, and the polynomials through its nodes there, as
/// many as points.
#[derive(Clone, Copy, Debug)]
pub struct Rule<const NODES: usize> {
    /// Share of the element's length.
    pub weights: [f64; NODES],
    /// Values of the functions: point, node.
    pub values: [[f64; NODES]; NODES],
    /// Their derivatives with respect to the element's unit coordinate.
    pub derivatives: [[f64; NODES]; NODES],
}

/// Linear functions at two Gauss points.
pub static LINEAR: LazyLock<Rule<2>> = LazyLock::new(|| Rule::gauss(GAUSS_2));
/// Parabolas at three Gauss points.
pub static QUADRATIC: LazyLock<Rule<3>> = LazyLock::new(|| Rule::gauss(GAUSS_3));
/// Cubics at four Gauss points.
pub static CUBIC: LazyLock<Rule<4>> = LazyLock::new(|| Rule::gauss(GAUSS_4));

impl<const NODES: usize> Rule<NODES> {
    /// Lagrange's polynomials of the nodes, with the points and weights of a rule on −1…1.
    fn gauss(line: [(f64, f64); NODES]) -> Self {
        let nodes = lobatto(NODES - 1);
        let functions = line.map(|(point, _)| lagrange(nodes, 0.5 + 0.5 * point));
        Self {
            weights: line.map(|(_, weight)| 0.5 * weight),
            values: functions.map(|functions| functions.map(|[value, _]| value)),
            derivatives: functions.map(|functions| functions.map(|[_, slope]| slope)),
        }
    }

    /// The derivatives φ′ φ and φ φ′ of the functions of an element's nodes, line by line, at all points (a, b).
    fn table(&self) -> DerivativeTable {
        let Self {
            values,
            derivatives,
            ..
        } = self;
        let at = |[a, b]: [usize; 2]| {
            pairs::<NODES>().map(move |[line, node]| {
                [
                    derivatives[a][line] * values[b][node],
                    values[a][line] * derivatives[b][node],
                ]
            })
        };
        DerivativeTable::new(NODES * NODES, pairs::<NODES>().flat_map(at))
    }
}

/// Value and derivative of each node's polynomial, which is one there and zero at the other nodes.
fn lagrange<const NODES: usize>(nodes: &[f64], position: f64) -> [[f64; 2]; NODES] {
    std::array::from_fn(|node| {
        let others = || (0..NODES).filter(move |other| *other != node);
        let factor = |other: usize| 1.0 / (nodes[node] - nodes[other]);
        let without = |left_out: usize| -> f64 {
            let kept = others().filter(|other| *other != left_out);
            kept.map(|other| (position - nodes[other]) * factor(other))
                .product()
        };
        let slope = others().map(|other| factor(other) * without(other)).sum();
        [without(node), slope]
    })
}

/// Π = Σ t hx hy wₐ w_b Ψ(H) over the points (a, b) of all elements of a plate between the lines of its nodes along X and Y in mm, whose
/// numbers run line by line along Y.
///
/// # Panics
/// When the number of cells is no multiple of those of an element.
pub fn energy<const NODES: usize>(
    problem: &ClampedPlate,
    coordinates: &[Vec<f64>; 2],
    rule: &Rule<NODES>,
) -> SheetEnergy {
    let order = NODES - 1;
    let [x, y] = coordinates;
    let cells = [x, y].map(|positions| positions.len() - 1);
    assert!(cells.iter().all(|cells| cells.is_multiple_of(order)));
    let nodes = x.iter().flat_map(|x| y.iter().map(|y| [*x, *y])).collect();
    let mut energy = SheetEnergy::new(Arc::clone(&problem.law), x.len() * y.len());
    let table = energy.push_table(rule.table());
    let rows = (0..cells[1]).step_by(order);
    for (i, j) in (0..cells[0])
        .step_by(order)
        .flat_map(|i| rows.clone().map(move |j| (i, j)))
    {
        // The sides of an element are the units of its natural coordinates.
        let (hx, hy) = (x[i + order] - x[i], y[j + order] - y[j]);
        let on_line = |line: usize| (j..=j + order).map(move |j| line * y.len() + j);
        let nodes: Vec<usize> = (i..=i + order).flat_map(on_line).collect();
        let area = problem.thickness * hx * hy;
        let points = pairs::<NODES>().map(|[a, b]| PointMap {
            inverse: [[1.0 / hx, 0.0], [0.0, 1.0 / hy]],
            volume: area * rule.weights[a] * rule.weights[b],
        });
        energy.push_cell(&nodes, table, points);
    }
    energy.complete(nodes)
}

/// Pairs of points or nodes along both axes.
fn pairs<const NODES: usize>() -> impl Iterator<Item = [usize; 2]> + Clone {
    (0..NODES).flat_map(|a| (0..NODES).map(move |b| [a, b]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polynomials of the degree of a rule are reproduced with their slopes, and integrals of twice the degree are exact.
    fn check<const NODES: usize>(rule: &Rule<NODES>, points: [(f64, f64); NODES]) {
        let nodes = lobatto(NODES - 1);
        let power = |x: f64, n: usize| x.powi(n as i32);
        for degree in 0..NODES {
            for (point, (at, _)) in points.iter().enumerate() {
                let x = 0.5 + 0.5 * at;
                let sum = |shares: &[f64; NODES]| -> f64 {
                    let pairs = shares.iter().zip(nodes);
                    pairs
                        .map(|(share, node)| share * power(*node, degree))
                        .sum()
                };
                let slope = match degree {
                    0 => 0.0,
                    _ => degree as f64 * power(x, degree - 1),
                };
                assert!((sum(&rule.values[point]) - power(x, degree)).abs() < 1e-14);
                assert!((sum(&rule.derivatives[point]) - slope).abs() < 1e-13);
            }
        }
        for degree in 0..2 * NODES {
            let values = points.iter().zip(rule.weights);
            let sum: f64 = values
                .map(|((at, _), weight)| weight * power(0.5 + 0.5 * at, degree))
                .sum();
            assert!((sum - 1.0 / (degree + 1) as f64).abs() < 1e-14, "{degree}");
        }
    }

    #[test]
    fn rules_are_exact_for_polynomials() {
        check(&LINEAR, GAUSS_2);
        check(&QUADRATIC, GAUSS_3);
        check(&CUBIC, GAUSS_4);
    }
}
