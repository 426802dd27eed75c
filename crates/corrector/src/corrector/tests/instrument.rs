//! The corrector as an instrument: its forms, its matrix, its retained factors and its estimates.

use nalgebra::DMatrix;

use super::*;

fn by_solver(solver: Solver) -> CorrectorSettings {
    CorrectorSettings { solver, ..SETTINGS }
}

/// Some independent rows over `size` unknowns.
fn rows(count: usize, size: usize) -> SparseRows {
    let numbers = noise(count * size);
    let mut rows = SparseRows::new(size);
    for row in 0..count {
        let entries = (0..size).filter(|column| (row * 3 + column) % 4 != 0);
        rows.push(entries.map(|column| (column, numbers[row * size + column])));
    }
    rows
}

#[test]
fn all_forms_of_the_projection_agree() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let plate = plate_corrector(&problem, &springs.mesh);
    let field = &uncorrected.displacement;
    let weights: Vec<f64> = noise(field.len()).iter().map(|n| 1.5 + n).collect();
    let pull = noise(field.len());
    for known in [KnownConditions::ALL, FREE_GRIPS] {
        let project = |solver| {
            let conditions = plate.conditions(STRETCH, known);
            let corrector = Corrector::new(conditions, weights.clone(), by_solver(solver));
            let mut factor = corrector.factor(field)?;
            // No condition is met: neither the balances nor the supports.
            let values = corrector.values(field).unwrap().into_iter();
            let values: Vec<f64> = values.zip(&pull).map(|(c, n)| c + 0.1 * n).collect();
            Ok::<_, SolveFault>((factor.solver(), factor.project(&values, &pull).unwrap()))
        };
        let (_, expected) = project(Solver::Dense).unwrap();
        let mut forms = vec![Solver::Cholesky, Solver::Kkt];
        if known == KnownConditions::ALL {
            forms.push(Solver::Symmetric);
        }
        for form in forms {
            let (taken, computed) = project(form).unwrap();
            assert_eq!(taken, form);
            let step = largest_difference(&computed.step, &expected.step) / largest(&expected.step);
            let psi = largest_difference(&computed.multipliers, &expected.multipliers);
            let psi = psi / largest(&expected.multipliers);
            assert!(
                step < 1e-9 && psi < 1e-9,
                "{form:?} {known:?}: {step:.1e} {psi:.1e}"
            );
        }
    }
}

#[test]
fn the_form_is_chosen_by_size_and_kind() {
    let few = rows(3, 10);
    let chosen = |jacobian, weights, unknowns| {
        Factor::new(jacobian, weights, unknowns, Solver::Automatic)
            .unwrap()
            .solver()
    };
    assert_eq!(chosen(few.clone(), vec![1.0; 10], None), Solver::Dense);
    let mut weights = vec![1.0; 10];
    weights[4] = 0.0;
    assert_eq!(chosen(few, weights, None), Solver::Kkt);
    let mut many = SparseRows::new(400);
    (0..300).for_each(|row| many.push([(row, 1.0), (row + 100, 0.5)]));
    assert_eq!(chosen(many, vec![1.0; 400], None), Solver::Cholesky);
    // Rows that are parallel to seven digits: B Bᵀ is worth nothing, the whole system is.
    let mut close = SparseRows::new(400);
    (0..200).for_each(|row| close.push([(row, 1.0), (row + 200, 1.0)]));
    (0..150).for_each(|row| close.push([(row, 1.0), (row + 200, 1.0 + 4e-7)]));
    assert_eq!(chosen(close, vec![1.0; 400], None), Solver::Kkt);
}

#[test]
fn the_correction_matrix_is_what_the_publication_says() {
    let b = rows(5, 12);
    let matrix = CorrectionMatrix::new(&b, vec![1.0; 12]).unwrap();
    let (y, dense) = (matrix.y(), b.to_dense());
    let size = |matrix: &DMatrix<f64>| matrix.amax();
    assert!(size(&(&y - y.transpose())) < 1e-12, "symmetric");
    assert!(size(&(&y * &y - &y)) < 1e-12, "idempotent");
    assert!(size(&(&dense * &y)) < 1e-12, "B Y = 0");
    assert_eq!(y.rank(1e-9), 12 - 5);
    let normal = &dense * dense.transpose();
    assert!(size(&(matrix.s() * normal - DMatrix::identity(5, 5))) < 1e-11);

    let square = CorrectionMatrix::new(&rows(8, 8), vec![1.0; 8]).unwrap();
    assert!(
        size(&square.y()) < 1e-12,
        "a square B leaves the data no say"
    );

    let weights: Vec<f64> = (0..12).map(|i| 0.5 + f64::from(i)).collect();
    let y = CorrectionMatrix::new(&b, weights.clone()).unwrap().y();
    assert!(size(&(&y * &y - &y)) < 1e-12);
    let data = noise(12);
    let mut factor = Factor::new(b, weights, None, Solver::Cholesky).unwrap();
    let values = factor.jacobian().multiply(&data);
    let projected = factor.project(&values, &[0.0; 12]).unwrap();
    let expected = &y * nalgebra::DVector::from_column_slice(&data);
    let computed: Vec<f64> = data
        .iter()
        .zip(&projected.step)
        .map(|(u, step)| u + step)
        .collect();
    assert!(largest_difference(&computed, expected.as_slice()) < 1e-12);
}

#[test]
fn dependent_and_contradictory_conditions_are_named() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let plate = plate_corrector(&problem, &springs.mesh);
    let size = uncorrected.displacement.len();
    let fault = |value: f64| {
        let mut conditions = plate.conditions(STRETCH, KnownConditions::ALL);
        conditions.push(Box::new(Linear::prescribed("pin", size, [(3, value)])));
        let corrector = Corrector::new(conditions, vec![1.0; size], SETTINGS).named(plate.names());
        let data = &uncorrected.displacement;
        corrector.correct(data, data).map(|_| ()).unwrap_err()
    };
    let SolveFault::Dependent {
        rows,
        contradictory,
        ..
    } = fault(0.5)
    else {
        panic!("not named");
    };
    assert!(contradictory);
    let expected = "at node 1 (0.0, 3.3) mm along y";
    assert_eq!(rows.len(), 2, "{rows:?}");
    assert!(rows.contains(&format!("grips {expected}")), "{rows:?}");
    assert!(rows.contains(&format!("pin {expected}")), "{rows:?}");
    assert!(matches!(
        fault(0.0),
        SolveFault::Dependent {
            contradictory: false,
            ..
        }
    ));
}

#[test]
fn a_retained_factor_is_applied_to_many_fields_and_right_hand_sides() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let plate = plate_corrector(&problem, &springs.mesh);
    let size = uncorrected.displacement.len();
    let corrector = plate.corrector(STRETCH, FREE_GRIPS);
    let mut retained = corrector.factor(&vec![0.0; size]).unwrap();
    for shift in 0..3 {
        let pull: Vec<f64> = noise(size + shift)[shift..].to_vec();
        let values = noise(retained.jacobian().len());
        let mut fresh = corrector.factor(&vec![0.0; size]).unwrap();
        let expected = fresh.project(&values, &pull).unwrap();
        assert_eq!(retained.project(&values, &pull).unwrap(), expected);
    }
}

/// A line through noisy points: slope and intercept are parameters, and the estimate is that of ordinary
/// least squares.
#[test]
fn parameters_without_data_are_regressed_with_their_standard_errors() {
    let n = 20;
    let noise = noise(n);
    let mut data: Vec<f64> = (0..n)
        .map(|i| 1.5 + 0.3 * i as f64 + 0.1 * noise[i])
        .collect();
    data.extend([0.0, 0.0]);
    let mut rows = SparseRows::new(n + 2);
    for i in 0..n {
        rows.push([(i, 1.0), (n, -1.0), (n + 1, -(i as f64))]);
    }
    let mut weights = vec![1.0; n];
    weights.extend([0.0, 0.0]);
    let conditions: Vec<Box<dyn Condition>> =
        vec![Box::new(Linear::new("line", rows, vec![0.0; n]))];
    let corrector = Corrector::new(conditions, weights, SETTINGS);
    let correction = corrector.correct(&data, &data).unwrap();
    let slope = corrector.estimate(&data, &correction, n + 1).unwrap();

    let mean = |value: &dyn Fn(usize) -> f64| (0..n).map(value).sum::<f64>() / n as f64;
    let (x, y) = (mean(&|i| i as f64), mean(&|i| data[i]));
    let spread: f64 = (0..n).map(|i| (i as f64 - x).powi(2)).sum();
    let expected = (0..n).map(|i| (i as f64 - x) * (data[i] - y)).sum::<f64>() / spread;
    let squares: f64 = (0..n)
        .map(|i| (data[i] - y - expected * (i as f64 - x)).powi(2))
        .sum();
    let error = (squares / (n as f64 - 2.0) / spread).sqrt();
    assert!((slope.value - expected).abs() < 1e-12);
    assert!(
        (slope.standard_error / error - 1.0).abs() < 1e-9,
        "{} {error}",
        slope.standard_error
    );
    // Student's distribution with 18 degrees of freedom.
    let reach = (slope.interval[1] - slope.value) / slope.standard_error;
    assert!((reach - 2.100_922).abs() < 1e-5, "{reach}");
}
