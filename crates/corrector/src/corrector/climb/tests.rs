use std::path::Path;
use std::sync::Arc;

use super::*;
use crate::corrector::CorrectorSettings;
use crate::corrector::Solver;
use crate::corrector::plate::{KnownConditions, PlateCorrector};
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::{LatticeSettings, MassSpring};
use crate::material::volume::bulk_modulus;
use crate::material::{Card, PlaneState, Volume, VolumeEnergy};
use crate::mesh::{CellShape, Mesh};
use crate::solve::NewtonSettings;

mod graded;

const TIGHT: ClimbSettings = ClimbSettings {
    tolerance: 1e-6,
    max_iterations: 60,
};

const EXACT: NewtonSettings = NewtonSettings {
    tolerance: 1e-11,
    max_iterations: 60,
};

fn problem(card: &str, size: [f64; 2], stretch: f64) -> ClampedPlate {
    let card = Card::load(card, Path::new(".")).unwrap();
    ClampedPlate {
        size,
        thickness: 2.0,
        law: Arc::clone(&card.law),
        stretches: vec![stretch],
    }
}

/// Whether a cell is turned by a right angle or more, which no cell of a clamped plate is: F₁₁ + F₂₂ ≤ 0 in its middle.
fn is_turned(field: &Field, grid: &Grid) -> bool {
    let [x, y] = &field.components;
    let cells = grid
        .coordinates
        .each_ref()
        .map(|positions| positions.len() - 1);
    let turned = |column: usize, row: usize| {
        let at = |u: &[f64], [i, j]: [usize; 2]| u[(column + i) * field.width + row + j];
        let along = at(x, [1, 0]) + at(x, [1, 1]) - at(x, [0, 0]) - at(x, [0, 1]);
        let across = at(y, [0, 1]) + at(y, [1, 1]) - at(y, [0, 0]) - at(y, [1, 0]);
        let [width, height] =
            [(0, column), (1, row)].map(|(axis, cell)| grid.span(axis, cell, cell + 1));
        2.0 + 0.5 * (along / width + across / height) <= 0.0
    };
    (0..cells[0]).any(|column| (0..cells[1]).any(|row| turned(column, row)))
}

/// Under strong compression there are equilibria that pass through themselves; they are no plates.
#[test]
fn no_plate_is_turned_over() {
    for stretch in [-0.45, -0.6] {
        for card in ["pva-10-yeoh", "pva-10", "neo-hooke"] {
            let plate = problem(card, [150.0, 50.0], stretch);
            let mut climb = Climb::even(
                &plate,
                [24, 8],
                DifferenceScheme::Biquadratic,
                ClimbSettings::default(),
            );
            if let Ok(climbed) = climb.correct(stretch) {
                assert!(!is_turned(&climbed.field, climb.grid()), "{card} {stretch}");
            }
        }
    }
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The direct corrector's field and force; its multipliers are compared with the climb's.
fn direct(
    problem: &ClampedPlate,
    cells: [usize; 2],
    grading: f64,
    scheme: DifferenceScheme,
) -> (Vec<f64>, f64) {
    let springs = MassSpring::new(problem, cells, LatticeSettings { area_term: false });
    let newton = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 60,
    };
    let springs_state = springs.solve(problem, newton, &|_| ()).unwrap().remove(0);
    let mesh = scheme.graded(problem.size, cells, grading);
    let data = springs
        .mesh
        .displacement_on(&springs_state.displacement, &mesh);
    let settings = CorrectorSettings {
        tolerance: 1e-11,
        movement: 1e-9,
        max_steps: 60,
        solver: Solver::Automatic,
    };
    let corrector = PlateCorrector::new(problem, &mesh, scheme, settings);
    let stretch = problem.stretches[0];
    let state = corrector
        .correct(&data, stretch, KnownConditions::ALL)
        .unwrap();
    let multipliers: Vec<f64> = state
        .multipliers
        .into_iter()
        .flat_map(|m| m.values)
        .collect();
    let mut climb = Climb::graded(problem, cells, scheme, grading, TIGHT);
    let climbed = corrector.climb(&mut climb, &data, stretch).unwrap();
    let nodal: Vec<f64> = climbed
        .multipliers
        .into_iter()
        .flat_map(|m| m.values)
        .collect();
    let most = nodal.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    assert!(largest_difference(&nodal, &multipliers) < 1e-4 * most);
    (state.state.displacement, state.measures.force)
}

#[test]
fn the_climb_reaches_the_direct_corrector_with_every_scheme_law_and_number_of_cells() {
    use DifferenceScheme::{Bicubic, Biquadratic, Gauss};
    let cases = [
        ("pva-10", [150.0, 50.0], [60, 20], 1.0, Gauss),
        ("pva-10", [150.0, 50.0], [36, 12], 0.5, Biquadratic),
        ("pva-10", [150.0, 50.0], [31, 11], 0.5, Gauss),
        ("neo-hooke", [60.0, 90.0], [17, 23], 0.3, Gauss),
        ("treloar-ogden-3", [40.0, 40.0], [18, 14], 0.4, Biquadratic),
        ("pva-10-yeoh", [200.0, 20.0], [50, 7], 0.2, Gauss),
        ("pva-10", [150.0, 50.0], [54, 18], 1.0, Bicubic),
        ("neo-hooke", [40.0, 60.0], [18, 15], 0.3, Bicubic),
    ];
    let graded = |case| [1.0, 1.5, 2.5].map(|grading| (case, grading));
    for ((card, size, cells, stretch, scheme), grading) in cases.into_iter().flat_map(graded) {
        let problem = problem(card, size, stretch);
        let (expected, force) = direct(&problem, cells, grading, scheme);
        let climbed = Climb::graded(&problem, cells, scheme, grading, TIGHT)
            .correct(stretch)
            .unwrap();
        let off = largest_difference(&climbed.field.to_nodes(), &expected);
        let case = format!("{card} {cells:?} {scheme:?} graded by {grading}");
        assert!(off < 1e-6 * size[0], "{case}: {off} mm");
        assert!((climbed.force / force - 1.0).abs() < 1e-7, "{case}");
    }
}

#[test]
fn it_stops_at_a_tenth_of_the_discretisation_error_and_knows_how_large_that_is() {
    let problem = problem("pva-10", [150.0, 50.0], 0.5);
    let scheme = DifferenceScheme::Gauss;
    let mut fine = Climb::even(&problem, [240, 80], DifferenceScheme::Biquadratic, TIGHT);
    let truth = fine.correct(0.5).unwrap().field;
    for cells in [[30, 10], [60, 20], [120, 40]] {
        let mut climb = Climb::even(&problem, cells, scheme, ClimbSettings::FAST);
        let climbed = climb.correct(0.5).unwrap();
        let mut solved = Climb::even(&problem, cells, scheme, TIGHT)
            .correct(0.5)
            .unwrap()
            .field;
        let mut iteration = climbed.field.clone();
        iteration.add(-1.0, &solved);
        solved.add(-1.0, &truth.onto(fine.grid(), climb.grid()));
        let error = solved.size();
        let ratio = climbed.discretisation_error / error;
        assert!((0.5..2.0).contains(&ratio), "{cells:?}: {ratio}");
        assert!(
            iteration.size() < 0.1 * error,
            "{cells:?}: {} of {error}",
            iteration.size()
        );
    }
}

#[test]
fn graded_grids_have_the_equations_of_finite_elements_on_them() {
    let problem = problem("neo-hooke", [90.0, 30.0], 0.4);
    let graded = |length: f64, elements: usize| -> Vec<f64> {
        let position = |i: usize| {
            let x = i as f64 / elements as f64;
            length * (x - 0.6 * (std::f64::consts::TAU * x).sin() / std::f64::consts::TAU)
        };
        (0..=elements).map(position).collect()
    };
    let boundaries = [graded(90.0, 24), graded(30.0, 10)];
    let mut climb = Climb::new(&problem, boundaries, DifferenceScheme::Gauss, TIGHT);
    let climbed = climb.correct(0.4).unwrap();
    let [x, y] = &climb.grid().coordinates;
    let nodes = x
        .iter()
        .flat_map(|x| y.iter().map(move |y| [*x, *y]))
        .collect();
    let cells = (0..24).flat_map(|i| {
        (0..10).map(move |j| {
            let node = |di: usize, dj: usize| (i + di) * 11 + j + dj;
            (
                CellShape::Quad4,
                vec![node(0, 0), node(1, 0), node(1, 1), node(0, 1)],
            )
        })
    });
    let mesh = Mesh::new(nodes, cells);
    let energy =
        crate::problem::sheet_energy::SheetEnergy::of_mesh(Arc::clone(&problem.law), &mesh, 2.0);
    let u = climbed.field.to_nodes();
    let mut residual = vec![0.0; u.len()];
    crate::solve::Assembly::residual(&energy, &u, &mut residual).unwrap();
    let free = 2 * 11..u.len() - 2 * 11;
    let worst = residual[free]
        .iter()
        .fold(0.0, |most: f64, r| most.max(r.abs()));
    assert!(worst < 1e-6 * climbed.force, "{worst} N");
}

#[test]
fn threads_do_not_change_a_bit() {
    for (card, stretch, grading) in [("pva-10", 0.7, 1.0), ("neo-hooke", 0.5, 2.0)] {
        let problem = problem(card, [150.0, 50.0], stretch);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                let (scheme, settings) = (DifferenceScheme::Biquadratic, ClimbSettings::FAST);
                let mut climb = Climb::graded(&problem, [210, 70], scheme, grading, settings);
                let climbed = climb.correct(stretch).unwrap();
                (climbed.field, climbed.force)
            })
        };
        let [one, two, three] = [1, 2, 3].map(run);
        assert!(one == two && one == three, "graded by {grading}");
    }
}

#[test]
fn all_starts_come_to_the_same_field() {
    let problem = problem("pva-10", [150.0, 50.0], 1.0);
    let mut climb = Climb::even(&problem, [60, 20], DifferenceScheme::Gauss, TIGHT);
    let at_once = climb.correct_springs(1, 1.0).unwrap().field;
    let in_steps = climb.correct_springs(4, 1.0).unwrap().field;
    let by_newton = climb.along_load_path(climb.start, 1.0).unwrap().field;
    for mut difference in [in_steps, by_newton] {
        difference.add(-1.0, &at_once);
        assert!(difference.size() < 1e-4, "{} mm", difference.size());
    }
}

#[test]
fn grips_in_the_hand_turn_the_plate_and_bring_it_back() {
    let problem = problem("pva-10", [150.0, 50.0], 0.3);
    let climb = Climb::even(&problem, [60, 20], DifferenceScheme::Gauss, TIGHT);
    let mut hand = Interactive::new(climb, 0.3).unwrap();
    let (start, grips) = (hand.state().clone(), hand.grips());
    let mut sheared = grips;
    sheared.right.displacement[1] += 6.0;
    sheared.right.angle += 0.05;
    let force = hand.move_grips(sheared).unwrap().force;
    assert!(force > start.force, "shear stretches it further");
    let back = hand.move_grips(grips).unwrap();
    assert!((back.force / start.force - 1.0).abs() < 1e-6);
    // Both grips turned about the plate's middle: no strain is added.
    let angle = 0.1_f64;
    let arm = 0.5 * 150.0;
    let reach = 0.5 * 150.0 * 1.3;
    let middle = 0.5 * 150.0 * 1.3;
    let turned = Grips {
        left: RigidMotion {
            displacement: [middle - reach * angle.cos(), -reach * angle.sin()],
            angle,
        },
        right: RigidMotion {
            displacement: [
                middle + reach * angle.cos() - 2.0 * arm,
                reach * angle.sin(),
            ],
            angle,
        },
    };
    let forces = hand.move_grips(turned).unwrap().clone();
    let expected = start.force * angle.cos();
    assert!(
        (forces.force / expected - 1.0).abs() < 1e-5,
        "{} {expected}",
        forces.force
    );
}

#[test]
fn grips_on_a_single_grid_move_although_its_error_is_not_known() {
    let problem = problem("pva-10", [150.0, 50.0], 0.3);
    let climb = Climb::even(&problem, [8, 4], DifferenceScheme::Gauss, TIGHT);
    let mut hand = Interactive::new(climb, 0.3).unwrap();
    let mut grips = hand.grips();
    grips.right.displacement[1] += 0.5;
    let error = hand.move_grips(grips).unwrap().discretisation_error;
    assert!(error.is_nan(), "{error}");
}

#[test]
fn finite_elements_of_nine_nodes_have_the_biquadratic_equations() {
    let problem = problem("pva-10", [150.0, 50.0], 0.5);
    let model = FiniteElements::new(&problem, [15, 5], Element::Q2);
    let solved = model.solve(&problem, EXACT, &|_| ()).unwrap();
    let mut climb = Climb::even(&problem, [30, 10], DifferenceScheme::Biquadratic, TIGHT);
    let field = climb.correct(0.5).unwrap().field.to_nodes();
    assert!(largest_difference(&field, &solved[0].displacement) < 1e-6);
}

#[test]
fn sheets_in_plane_strain_are_climbed_however_little_their_volume_changes() {
    let loads = [
        (0.3, 0.5),
        (0.49, 1.0),
        (0.4999, 0.15),
        (0.4999, 1.0),
        (0.4999, -0.1),
    ];
    for (poisson, stretch) in loads {
        let mut problem = problem("neo-hooke", [150.0, 50.0], stretch);
        let volume = Volume {
            bulk_modulus: bulk_modulus(problem.law.shear_modulus(), poisson),
            energy: VolumeEnergy::default(),
            plane: PlaneState::Strain,
        };
        let sheet = Arc::clone(&problem.law).with_volume(volume);
        problem.law = sheet.unwrap();
        let model = FiniteElements::new(&problem, [12, 4], Element::Q2);
        let solved = model.solve(&problem, EXACT, &|_| ()).unwrap();
        let mut climb = Climb::even(&problem, [24, 8], DifferenceScheme::Biquadratic, TIGHT);
        let climbed = climb.correct(stretch).unwrap();
        let off = largest_difference(&climbed.field.to_nodes(), &solved[0].displacement);
        assert!(off < 1e-5, "ν = {poisson}, {stretch}: {off} mm");
    }
}
