use super::*;

fn even(length: f64, cells: usize) -> Vec<f64> {
    let at = |node: usize| length * node as f64 / cells as f64;
    (0..=cells).map(at).collect()
}

/// Plane stress of a soft sheet at rest, E = 1, ν = ½, on a grid of rectangles.
fn write(stencil: &mut Stencil, grid: &[Vec<f64>; 2]) {
    let cells = grid[1].len() - 1;
    let (hx, hy) = (grid[0][1] - grid[0][0], grid[1][1] - grid[1][0]);
    let [c11, c12, c33] = [4.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0];
    let (ratio, inverse) = ((hy / hx) as f32, (hx / hy) as f32);
    let values = [
        ratio * c11,
        0.0,
        ratio * c33,
        inverse * c33,
        0.0,
        inverse * c11,
        0.0,
        0.25 * c12,
        0.25 * c33,
        0.0,
    ];
    let written = stencil.assemble(|_, target| {
        for (array, value) in target.0.iter_mut().zip(values) {
            array[1..=cells].fill(value);
        }
        true
    });
    assert!(written);
}

fn multigrid(sizes: &[[usize; 2]]) -> (Multigrid, Vec<[Vec<f64>; 2]>) {
    let grids: Vec<_> = sizes
        .iter()
        .map(|[nx, ny]| [even(3.0, *nx), even(1.0, *ny)])
        .collect();
    let mut multigrid = Multigrid::new(&grids);
    for (level, grid) in grids.iter().enumerate() {
        write(multigrid.stencil(level), grid);
    }
    multigrid.invert_coarsest().unwrap();
    (multigrid, grids)
}

fn product(a: &Vector, b: &Vector) -> f64 {
    let lines = a.lines();
    let line = |line: usize| {
        let pairs = a.line(line).into_iter().zip(b.line(line));
        pairs
            .flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)))
            .sum::<f64>()
    };
    (1..lines.count - 1).map(line).sum()
}

fn noise(lines: Lines, seed: u32) -> Vector {
    let mut vector = Vector::zeros(lines);
    vector.for_each_free_line(|line, x, y| {
        for (axis, values) in [x, y].into_iter().enumerate() {
            for (node, value) in values[1..=lines.nodes].iter_mut().enumerate() {
                let place = (line * 8_191 + node * 131 + axis * 17) as u32;
                let mixed = place
                    .wrapping_mul(2_654_435_761)
                    .wrapping_add(seed)
                    .rotate_left(13);
                *value = (mixed.wrapping_mul(2_246_822_519) >> 8) as f32 / 8_388_608.0 - 1.0;
            }
        }
    });
    vector
}

#[test]
fn a_uniform_strain_is_in_equilibrium_inside() {
    let (mut multigrid, grids) = multigrid(&[[12, 4], [24, 8]]);
    let lines = multigrid.stencil(1).lines();
    let mut field = Vector::zeros(lines);
    field.for_each_free_line(|line, x, y| {
        for node in 0..lines.nodes {
            x[node + 1] = (0.3 * grids[1][0][line] + 0.1 * grids[1][1][node]) as f32;
            y[node + 1] = (0.2 * grids[1][0][line] - 0.05 * grids[1][1][node]) as f32;
        }
    });
    let mut residual = Vector::zeros(lines);
    multigrid
        .stencil(1)
        .residual(&field, &Vector::zeros(lines), &mut residual);
    // Lines beside the grips feel the field that is missing there; edges feel the traction.
    for line in 2..lines.count - 2 {
        for component in residual.line(line) {
            let worst = component[2..lines.nodes]
                .iter()
                .fold(0.0, |m: f32, r| m.max(r.abs()));
            assert!(worst < 1e-5, "line {line}: {worst}");
        }
    }
}

#[test]
fn a_cycle_is_symmetric_and_takes_more_than_half_of_an_error_away() {
    for sizes in [
        vec![[12, 4], [24, 8], [48, 16], [96, 32]],
        vec![[9, 3], [17, 6], [34, 11], [67, 21]],
        vec![[15, 3], [15, 5], [30, 10]],
    ] {
        let (mut multigrid, _) = multigrid(&sizes);
        let level = sizes.len() - 1;
        let lines = multigrid.stencil(level).lines();
        let mut apply = |b: &Vector| {
            *multigrid.right_hand_side(level) = b.clone();
            multigrid.cycle(level).clone()
        };
        let (a, b) = (noise(lines, 1), noise(lines, 2));
        let (to_a, to_b) = (apply(&a), apply(&b));
        let (ab, ba) = (product(&a, &to_b), product(&b, &to_a));
        let size = (product(&a, &to_a) * product(&b, &to_b)).sqrt();
        assert!((ab - ba).abs() < 1e-4 * size, "{sizes:?}: {ab} {ba}");

        // x ← x + M (b − K x): the energy of the error falls by a factor each time.
        let mut x = Vector::zeros(lines);
        let mut energies = Vec::new();
        for _ in 0..6 {
            let mut residual = Vector::zeros(lines);
            multigrid.stencil(level).residual(&x, &a, &mut residual);
            *multigrid.right_hand_side(level) = residual.clone();
            let step = multigrid.cycle(level).clone();
            energies.push(product(&residual, &step));
            x.for_each_free_line(|line, x, y| {
                for (x, step) in [x, y].into_iter().zip(step.line(line)) {
                    x.iter_mut().zip(step).for_each(|(x, step)| *x += step);
                }
            });
        }
        let factor = (energies[5] / energies[1]).powf(1.0 / 8.0);
        assert!(factor < 0.5, "{sizes:?}: {factor}");
    }
}
