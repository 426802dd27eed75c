//! Every law, shape, number of cells and stretch finds a start, and the result is the direct method's.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

use super::*;
use crate::corrector::DifferenceScheme;
use crate::corrector::climb::{ClimbSettings, ClimbSolution};
use crate::material::samples;
use crate::problem::ClampedPlate;

fn problem(card: &str, size: [f64; 2], stretch: f64) -> ClampedPlate {
    let mut laws = samples::all().into_iter();
    ClampedPlate {
        size,
        thickness: 2.0,
        law: laws.find(|(name, _)| *name == card).expect("a sample").1,
        stretches: vec![stretch],
    }
}

/// The field of the same equations by Newton's method along the path of stretches, without any of the climb's code.
fn direct(
    problem: &ClampedPlate,
    cells: [usize; 2],
    scheme: DifferenceScheme,
) -> Result<Vec<f64>, Error> {
    let mesh = scheme.graded(problem.size, cells, 1.0);
    let energy = scheme.energy(problem, &mesh);
    let newton = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 60,
    };
    let state = problem
        .on(&mesh, &energy)
        .reach(&problem.stretches, newton)?;
    Ok(state.displacement)
}

/// Root mean square over the nodes of the distance to the direct method's field in mm.
fn distance(climbed: &ClimbSolution, direct: &[f64]) -> f64 {
    let field = climbed.field.to_nodes();
    let squares = field.iter().zip(direct).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / (0.5 * direct.len() as f64)).sqrt()
}

fn check(
    problem: &ClampedPlate,
    cells: [usize; 2],
    scheme: DifferenceScheme,
) -> Result<ClimbSolution, String> {
    let stretch = problem.stretches[0];
    let mut climb = Climb::even(problem, cells, scheme, ClimbSettings::FAST);
    let Ok(expected) = direct(problem, cells, scheme) else {
        return Err("no equilibrium by the direct method".into());
    };
    let climbed = climb.correct(stretch).map_err(|fault| fault.to_string())?;
    let distance = distance(&climbed, &expected);
    let limit = if climbed.discretisation_error.is_nan() {
        1e-5 * climbed.field.size()
    } else {
        0.1 * climbed.discretisation_error
    };
    if distance <= limit {
        Ok(climbed)
    } else {
        Err(format!(
            "{}: {distance:e} mm of {limit:e} mm",
            climbed.provenance
        ))
    }
}

#[test]
fn laws_whose_springs_collapse_on_the_coarse_lattice_climb_all_the_same() {
    let mut helped = 0;
    for card in ["neo-hooke", "mooney-rivlin"] {
        for (cells, stretch) in [
            ([60, 20], 0.15),
            ([60, 20], 1.0),
            ([30, 10], 2.0),
            ([31, 11], 2.0),
        ] {
            let problem = problem(card, [150.0, 50.0], stretch);
            let climbed = check(&problem, cells, DifferenceScheme::Gauss).unwrap();
            helped += usize::from(climbed.provenance.start != Start::Springs);
        }
    }
    assert!(
        helped > 0,
        "at least one plate needs more than springs at once"
    );
}

/// Laws × 1:20 … 20:1 × odd and even cells × 0.01 … 300 %, a seeded sample.
#[test]
fn any_plate_climbs_to_the_direct_field() {
    let laws = samples::all();
    let schemes = DifferenceScheme::NAMES.map(|(_, scheme)| scheme);
    let plates = (
        0..laws.len(),
        0..schemes.len(),
        -1.3..1.3_f64,
        [4..40_usize, 4..24_usize],
        -4.0..0.4772_f64,
    );
    let config = Config {
        cases: 80,
        rng_seed: RngSeed::Fixed(15),
        failure_persistence: None,
        ..Config::default()
    };
    let run = TestRunner::new(config).run(&plates, |(law, scheme, aspect, cells, stretch)| {
        let scheme = schemes[scheme];
        let cells = cells.map(|cells| cells.next_multiple_of(scheme.side()));
        let size = [
            50.0 * 10f64.powf(0.5 * aspect),
            50.0 * 10f64.powf(-0.5 * aspect),
        ];
        let problem = problem(laws[law].0, size, 10f64.powf(stretch));
        let checked = check(&problem, cells, scheme);
        let described = format!("{} {scheme:?} {:?}: {checked:?}", laws[law].0, problem.size);
        prop_assert!(checked.is_ok(), "{described}");
        Ok(())
    });
    run.unwrap();
}

#[test]
fn where_the_iteration_never_ends_newtons_method_finds_every_grids_field() {
    let problem = problem("neo-hooke", [150.0, 50.0], 1.0);
    let never = ClimbSettings {
        tolerance: 1e-12,
        max_iterations: 0,
    };
    let mut starts = Vec::new();
    for scheme in DifferenceScheme::NAMES.map(|(_, scheme)| scheme) {
        let cells = [24, 8_usize.next_multiple_of(scheme.side())];
        let climbed = Climb::even(&problem, cells, scheme, never)
            .correct(1.0)
            .unwrap();
        starts.push(climbed.provenance.start);
        assert!(
            climbed.provenance.by_load_path.contains(&cells),
            "{}",
            climbed.provenance
        );
        let expected = direct(&problem, cells, scheme).unwrap();
        assert!(distance(&climbed, &expected) < 1e-7, "{scheme:?}");
    }
    // Of Gauss points the coarsest grid's factor has nearly the equations: a single iteration is enough there.
    let expected = [Start::Springs, Start::LoadPath, Start::LoadPath];
    assert_eq!(starts, expected);
}

#[test]
fn a_way_that_names_springs_began_with_them() {
    let problem = problem("pva-10", [150.0, 50.0], 0.5);
    let mut climb = Climb::even(
        &problem,
        [60, 20],
        DifferenceScheme::Gauss,
        ClimbSettings::FAST,
    );
    let provenance = climb.correct(0.5).unwrap().provenance;
    assert_eq!(
        (provenance.start, provenance.cells),
        (Start::Springs, [8, 3])
    );
    let grid = climb.levels[climb.start].grid.clone();
    let mut away = climb.springs(0.5).unwrap();
    away.add(
        -1.0,
        &climb.along_load_path(climb.start, 0.5).unwrap().field,
    );
    assert!(
        (provenance.away / away.size() - 1.0).abs() < 1e-3,
        "{} {}",
        provenance.away,
        away.size()
    );
    // The field from which the springs begin is another one.
    let mut other = contracted_stretch(problem.size, &grid, 0.5);
    other.add(
        -1.0,
        &climb.along_load_path(climb.start, 0.5).unwrap().field,
    );
    assert!(other.size() > 1.2 * away.size() || other.size() < 0.8 * away.size());
}

#[test]
fn the_contracted_stretch_inverts_no_cell() {
    for aspect in [0.01, 0.05, 0.5, 1.0, 3.0, 20.0, 1000.0] {
        for stretch in [-0.9, -0.1, 1e-6, 0.5, 10.0] {
            let problem = problem("neo-hooke", [10.0 * aspect, 10.0], stretch);
            for scheme in DifferenceScheme::NAMES.map(|(_, scheme)| scheme) {
                let cells = [12, 8_usize.next_multiple_of(scheme.side())];
                let mut climb = Climb::even(&problem, cells, scheme, ClimbSettings::FAST);
                let field = contracted_stretch(problem.size, climb.grid(), stretch);
                assert!(
                    climb.forces(&field).is_some(),
                    "{aspect} {stretch} {scheme:?}"
                );
            }
        }
    }
}

#[test]
fn springs_get_cells_that_they_bear() {
    for aspect in [1e-3, 0.05, 0.3, 1.0, 2.9, 20.0, 500.0] {
        for cells in [[2, 2], [8, 3], [31, 2], [3, 40]] {
            let size = [40.0 * aspect, 40.0];
            let [along, across] = sound_cells(size, cells);
            let ratio = (size[0] / along as f64) / (size[1] / across as f64);
            assert!(
                ratio.max(1.0 / ratio) <= LARGEST_ASPECT,
                "{aspect} {cells:?}"
            );
        }
    }
}

/// Beyond the maximum of its stress no sheet of this law holds: the message says so, not that a cell folds.
#[test]
fn an_unstable_law_is_named_as_the_cause() {
    let law = samples::card(
        "yeoh",
        "c10 = \"0.03 MPa\"\nc20 = \"-20 kPa\"\nc30 = \"0 kPa\"",
    )
    .law;
    let problem = ClampedPlate {
        law,
        ..problem("neo-hooke", [150.0, 50.0], 1.5)
    };
    let mut climb = Climb::even(
        &problem,
        [24, 8],
        DifferenceScheme::Gauss,
        ClimbSettings::FAST,
    );
    let fault = climb.correct(1.5).map(|_| ()).unwrap_err().to_string();
    assert!(
        fault.contains("material unstable") && fault.contains("reached"),
        "{fault}"
    );
}
