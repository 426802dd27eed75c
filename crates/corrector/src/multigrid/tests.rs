use super::strip::LineSmoother;
use super::*;

/// Lines that are closer to each other towards both ends; with a grading of 1 they are as far everywhere.
fn graded(length: f64, cells: usize, grading: f64) -> Vec<f64> {
    let near = |line: usize| 0.5 * (2.0 * line as f64 / cells as f64).powf(grading);
    let share = |line: usize| {
        if 2 * line <= cells {
            near(line)
        } else {
            1.0 - near(cells - line)
        }
    };
    (0..=cells).map(|line| length * share(line)).collect()
}

/// Plane stress of a soft sheet at rest, E = 1, ν = ½, on a grid of rectangles.
fn write(stencil: &mut Stencil, grid: &[Vec<f64>; 2]) {
    let [c11, c12, c33] = [4.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0];
    let spacing = |axis: usize, cell: usize| grid[axis][cell + 1] - grid[axis][cell];
    let written = stencil.assemble(|column, target| {
        for cell in 0..grid[1].len() - 1 {
            let ratio = (spacing(1, cell) / spacing(0, column)) as f32;
            let inverse = 1.0 / ratio;
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
            for (array, value) in target.0.iter_mut().zip(values) {
                array[cell + 1] = value;
            }
        }
        true
    });
    assert!(written);
}

fn multigrid(sizes: &[[usize; 2]], grading: f64) -> (Multigrid, Vec<[Vec<f64>; 2]>) {
    let grids: Vec<_> = sizes
        .iter()
        .map(|[nx, ny]| [graded(3.0, *nx, grading), graded(1.0, *ny, grading)])
        .collect();
    let mut multigrid = Multigrid::new(&grids);
    for (level, grid) in grids.iter().enumerate() {
        write(multigrid.stencil(level), grid);
    }
    multigrid.factorise_coarsest().unwrap();
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
                let position = (line * 8_191 + node * 131 + axis * 17) as u32;
                let mixed = position
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
    let (mut multigrid, grids) = multigrid(&[[12, 4], [24, 8]], 1.0);
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

/// On wide and tall grids, whose unknowns are numbered along the shorter side.
#[test]
fn the_coarsest_grid_is_solved() {
    for size in [[2, 1], [2, 9], [12, 4], [4, 12], [5, 4], [6, 5]] {
        let (mut multigrid, _) = multigrid(&[size], 1.3);
        let lines = multigrid.stencil(0).lines();
        let b = noise(lines, 3);
        *multigrid.right_hand_side(0) = b.clone();
        let (x, mut r) = (multigrid.cycle(0).clone(), Vector::zeros(lines));
        multigrid.stencil(0).residual(&x, &b, &mut r);
        let remaining = (product(&r, &r) / product(&b, &b)).sqrt();
        assert!(remaining < 1e-5, "{size:?}: {remaining}");
    }
}

#[test]
fn a_cycle_is_symmetric_and_takes_more_than_half_of_an_error_away() {
    for (sizes, grading) in [
        (vec![[12, 4], [24, 8], [48, 16], [96, 32]], 1.0),
        (vec![[9, 3], [17, 6], [34, 11], [67, 21]], 1.0),
        (vec![[15, 3], [15, 5], [30, 10]], 1.0),
        (vec![[12, 4], [24, 8], [48, 16], [96, 32]], 1.5),
        (vec![[12, 4], [24, 8], [48, 16], [96, 32]], 2.0),
        (vec![[12, 4], [24, 8], [48, 16], [96, 32]], 3.0),
        (vec![[9, 3], [17, 6], [34, 11], [67, 21]], 2.5),
        (vec![[4, 12], [8, 24], [16, 48], [32, 96]], 2.0),
        (vec![[3, 15], [5, 15], [10, 30]], 2.0),
    ] {
        let (mut multigrid, _) = multigrid(&sizes, grading);
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
        assert!(
            (ab - ba).abs() < 1e-4 * size,
            "{sizes:?} graded by {grading}: {ab} {ba}"
        );

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
        assert!(factor < 0.5, "{sizes:?} graded by {grading}: {factor}");
    }
}

#[test]
fn long_cells_are_relaxed_along_lines_and_equal_ones_never() {
    let strips = |grid: [Vec<f64>; 2]| LineSmoother::new(&grid).ranges();
    let equal = [graded(30.0, 24, 1.0), graded(1.0, 24, 1.0)];
    assert!(strips(equal).is_empty());
    let nearly_square = [graded(3.0, 12, 1.2), graded(1.0, 4, 1.2)];
    assert!(strips(nearly_square).is_empty());
    // Beside all four sides, and the same on opposite ones.
    let along_all = strips([graded(3.0, 96, 2.0), graded(1.0, 32, 2.0)]);
    let [left, right, bottom, top] = &along_all[..] else {
        panic!("{along_all:?}")
    };
    assert_eq!((left.start, right.end), (1, 96));
    assert_eq!((bottom.start, top.end), (0, 33));
    assert_eq!((left.len(), bottom.len()), (right.len(), top.len()));
    assert!(left.len() > 5 && bottom.len() > 2);
}
