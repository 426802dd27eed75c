//! Grids that are graded towards the corners.

use super::*;

/// So many cells along Y, and in proportion along X.
fn cells(size: [f64; 2], across: usize) -> [usize; 2] {
    [(size[0] / size[1]) as usize * across, across]
}

/// The stated discretisation error holds within a factor of two and the iteration leaves less than a tenth of it, whatever the grading,
/// scheme, law, proportions and stretch: against a field whose own error is some twenty times smaller.
#[test]
fn the_stated_errors_are_true_on_graded_grids() {
    for (card, size, stretch) in [
        ("pva-10", [150.0, 50.0], 1.0),
        ("pva-10", [50.0, 50.0], 0.1),
        ("neo-hooke", [150.0, 50.0], 0.1),
        ("neo-hooke", [50.0, 50.0], 0.5),
        ("treloar-ogden-3", [150.0, 50.0], 0.5),
    ] {
        let problem = problem(card, size, stretch);
        let solve = |across, scheme, grading, settings| {
            let mut climb = Climb::graded(&problem, cells(size, across), scheme, grading, settings);
            let climbed = climb.correct(stretch).unwrap();
            (climb.grid().clone(), climbed)
        };
        let (fine, truth) = solve(144, DifferenceScheme::Bicubic, 3.0, TIGHT);
        for (scheme, across) in [
            (DifferenceScheme::Gauss, 32),
            (DifferenceScheme::Biquadratic, 32),
            (DifferenceScheme::Bicubic, 36),
        ] {
            for grading in [1.5, 2.0, 2.5, 3.0] {
                let (grid, climbed) = solve(across, scheme, grading, ClimbSettings::FAST);
                let (_, solved) = solve(across, scheme, grading, TIGHT);
                let mut iteration = climbed.field.clone();
                iteration.add(-1.0, &solved.field);
                let mut error = truth.field.onto(&fine, &grid);
                error.add(-1.0, &solved.field);
                let ratio = climbed.discretisation_error / error.size();
                let case = format!("{card} {size:?} {stretch} {scheme:?} graded by {grading}");
                assert!((0.5..2.0).contains(&ratio), "{case}: {ratio}");
                let share = iteration.size() / error.size();
                assert!(share < 0.1, "{case}: {share} of the error");
                let cycles = climbed.corrections.len();
                assert!(cycles <= 12, "{case}: {cycles} cycles");
                assert!(climbed.provenance.by_load_path.is_empty(), "{case}");
            }
        }
    }
}

#[test]
fn a_grading_of_one_is_an_even_grid() {
    let problem = problem("pva-10", [150.0, 50.0], 0.5);
    let (cells, scheme, settings) = ([60, 20], DifferenceScheme::Gauss, ClimbSettings::FAST);
    let [even, graded] = [
        Climb::even(&problem, cells, scheme, settings),
        Climb::graded(&problem, cells, scheme, 1.0, settings),
    ]
    .map(|mut climb| climb.correct(0.5).unwrap().field);
    assert_eq!(even, graded);
}
