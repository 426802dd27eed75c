use super::*;
use crate::solve::nodal::{NodalMatrix, Nodes, conjugate_gradients};
use crate::solve::{Assembly, Connectivity, Evaluated, Local, Potential};

/// Plane stress of a soft sheet at rest, E = 1, ν = ½, on a grid of bilinear rectangles, its left side held: ½ uᵀ K u.
struct Sheet {
    connectivity: Connectivity,
    held: Vec<bool>,
    stiffness: [[f64; 8]; 8],
}

impl Potential for Sheet {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn evaluate_element(&self, _: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        for (force, row) in local.residual.iter_mut().zip(&self.stiffness) {
            *force = crate::solve::vector::dot(row, u);
        }
        if let Some(stiffness) = local.stiffness {
            stiffness.copy_from_slice(self.stiffness.as_flattened());
        }
        Ok(0.5 * crate::solve::vector::dot(local.residual, u))
    }
}

/// The stiffness of a rectangle by one point a corner of the 2 × 2 Gauss rule.
fn rectangle([hx, hy]: [f64; 2]) -> [[f64; 8]; 8] {
    let [c11, c12, c33] = [4.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0];
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut stiffness = [[0.0; 8]; 8];
    for point in corners {
        let [x, y] = point.map(|x: f64| x / 3_f64.sqrt());
        let gradients =
            corners.map(|[a, b]| [0.5 * a * (1.0 + b * y) / hx, 0.5 * b * (1.0 + a * x) / hy]);
        for (a, g) in gradients.iter().enumerate() {
            for (b, h) in gradients.iter().enumerate() {
                let blocks = [
                    [
                        c11 * g[0] * h[0] + c33 * g[1] * h[1],
                        c12 * g[0] * h[1] + c33 * g[1] * h[0],
                    ],
                    [
                        c12 * g[1] * h[0] + c33 * g[0] * h[1],
                        c11 * g[1] * h[1] + c33 * g[0] * h[0],
                    ],
                ];
                for i in 0..2 {
                    for k in 0..2 {
                        stiffness[2 * a + i][2 * b + k] += 0.25 * hx * hy * blocks[i][k];
                    }
                }
            }
        }
    }
    stiffness
}

/// `order` numbers the nodes anew; `slides` frees the held side along y above its first node.
fn sheet(cells: [usize; 2], size: [f64; 2], slides: bool, order: impl Fn(usize) -> usize) -> Sheet {
    let [nx, ny] = cells;
    let h = [size[0] / nx as f64, size[1] / ny as f64];
    let node = |i: usize, j: usize| order(i * (ny + 1) + j);
    let count = (nx + 1) * (ny + 1);
    let (mut positions, mut held) = (vec![[0.0; 2]; count], vec![false; 2 * count]);
    for i in 0..=nx {
        for j in 0..=ny {
            positions[node(i, j)] = [7.0 + h[0] * i as f64, -3.0 + h[1] * j as f64];
            held[2 * node(i, j)] = i == 0;
            held[2 * node(i, j) + 1] = i == 0 && (!slides || j == 0);
        }
    }
    let mut connectivity = Connectivity::new(2 * count);
    for [i, j] in (0..nx).flat_map(|i| (0..ny).map(move |j| [i, j])) {
        connectivity.push_nodes(&[
            node(i, j),
            node(i + 1, j),
            node(i + 1, j + 1),
            node(i, j + 1),
        ]);
    }
    Sheet {
        connectivity: connectivity.with_positions(positions),
        held,
        stiffness: rectangle(h),
    }
}

impl Sheet {
    fn matrix(&self) -> (Nodes, NodalMatrix) {
        let assembly = Assembly::new(self, &self.held);
        let nodes = Nodes::new(assembly.free(), assembly.positions().unwrap());
        let mut matrix = NodalMatrix::new(&nodes, assembly.free(), self);
        let rest = vec![0.0; self.held.len()];
        matrix.linearise(self, &rest, &mut rest.clone()).unwrap();
        (nodes, matrix)
    }

    fn prepare(&self) -> (Nodes, NodalMatrix, Hierarchy) {
        let (nodes, matrix) = self.matrix();
        let cycle = Hierarchy::new(&matrix.full(), &nodes.motions()).unwrap();
        (nodes, matrix, cycle)
    }

    fn iterations(&self) -> usize {
        let (nodes, matrix, mut cycle) = self.prepare();
        let solution = conjugate_gradients(
            &matrix,
            |r, z| cycle.apply(r, z),
            &nodes.uneven(),
            1e-8,
            200,
        )
        .unwrap();
        assert!(solution.reduction <= 1e-8);
        // The true residual has fallen too.
        let b = nodes.gather(&nodes.uneven());
        let assembly = Assembly::new(self, &self.held);
        let (rest, mut values) = (vec![0.0; self.held.len()], Vec::new());
        let linearised = assembly.linearise(self, &rest, &mut rest.clone(), &mut values);
        linearised.unwrap();
        assert_eq!(matrix.entries(&nodes, assembly.pattern()), values);
        let image = assembly
            .pattern()
            .multiply(&values, &nodes.gather(&solution.x));
        let residual = crate::solve::vector::difference(&b, &image);
        let (residual, size) = (
            crate::solve::vector::norm(&residual),
            crate::solve::vector::norm(&b),
        );
        assert!(residual < 1e-4 * size, "{residual} of {size}");
        solution.iterations
    }
}

fn dot(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    a.iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(a, b)| a * b)
        .sum()
}

#[test]
fn a_cycle_is_symmetric_and_positive() {
    for (cells, slides) in [([60, 20], false), ([7, 90], true)] {
        let (nodes, _, mut cycle) = sheet(cells, [3.0, 1.0], slides, |node| node).prepare();
        assert!(cycle.nodes().len() > 1, "{:?}", cycle.nodes());
        let a = nodes.uneven();
        let b: Vec<[f64; 2]> =
            nodes.spread(&crate::solve::krylov::irregular(nodes.gather(&a).len(), 3));
        let mut apply = |r: &[[f64; 2]]| {
            let mut z = vec![[0.0; 2]; r.len()];
            cycle.apply(r, &mut z);
            z
        };
        let (to_a, to_b) = (apply(&a), apply(&b));
        let (ab, ba) = (dot(&a, &to_b), dot(&b, &to_a));
        let size = (dot(&a, &to_a) * dot(&b, &to_b)).sqrt();
        assert!(
            size > 0.0 && (ab - ba).abs() < 2e-5 * size,
            "{ab} {ba} of {size}"
        );
    }
}

#[test]
fn iterations_hardly_depend_on_the_number_of_nodes() {
    let counts = [20, 40, 80]
        .map(|across| sheet([3 * across, across], [3.0, 1.0], false, |node| node).iterations());
    assert!(
        counts[0] >= 5 && counts[2] <= counts[0] + 5 && counts[2] <= 20,
        "{counts:?}"
    );
}

#[test]
fn long_cells_and_sliding_sides_take_a_few_iterations_more() {
    for slides in [false, true] {
        let iterations = sheet([24, 16], [3.0, 0.5], slides, |node| node).iterations();
        assert!(iterations <= 40, "{slides}: {iterations}");
    }
}

#[test]
fn the_order_of_the_nodes_costs_a_few_iterations_at_most() {
    let count = 61 * 21;
    let straight = sheet([60, 20], [3.0, 1.0], true, |node| node).iterations();
    let mixed = sheet([60, 20], [3.0, 1.0], true, |node| node * 577 % count).iterations();
    assert!(mixed <= straight + 8, "{straight} {mixed}");
}

#[test]
fn an_indefinite_matrix_is_seen() {
    let sheet = sheet([30, 10], [3.0, 1.0], false, |node| node);
    // Springs of negative stiffness below all nodes: the softest modes fall below zero, all diagonal entries stay positive.
    let (nodes, mut matrix) = sheet.matrix();
    for end in &matrix.blocks.starts[1..] {
        let block = &mut matrix.blocks.values[end - 1];
        (block[0][0], block[1][1]) = (block[0][0] - 0.01, block[1][1] - 0.01);
    }
    let seen = match Hierarchy::new(&matrix.full(), &nodes.motions()) {
        Err(_) => true,
        Ok(mut cycle) => {
            conjugate_gradients(&matrix, |r, z| cycle.apply(r, z), &nodes.uneven(), 0.0, 12)
                .is_err()
        }
    };
    assert!(seen);
}
