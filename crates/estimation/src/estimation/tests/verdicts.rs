//! The verdicts on the right law and on a wrong one under noise that is white, or of which few values are independent.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::*;
use crate::mesh::{CellShape, Mesh};
use crate::statistics::normal_numbers;

/// 31 × 18 markers on the plate.
fn positions() -> Vec<[f64; 2]> {
    let [along, across] = SIZE.map(|size| size * 0.98);
    let position = |i: usize, j: usize| {
        [
            0.01 * SIZE[0] + along * i as f64 / 30.0,
            0.01 * SIZE[1] + across * j as f64 / 17.0,
        ]
    };
    (0..31)
        .flat_map(|i| (0..18).map(move |j| position(i, j)))
        .collect()
}

/// The root of the covariance e^(−d/ℓ) of the positions.
fn root(positions: &[[f64; 2]], length: f64) -> DMatrix<f64> {
    let far = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let count = positions.len();
    let covariance = DMatrix::from_fn(count, count, |i, j| {
        (-far(positions[i], positions[j]) / length).exp()
    });
    covariance.cholesky().unwrap().unpack()
}

/// Markers with noise of a standard deviation in mm, white or with this root of its covariance.
fn disturbed(
    truth: &Truth,
    positions: &[[f64; 2]],
    root: Option<&DMatrix<f64>>,
    noise: f64,
    seed: u64,
) -> Vec<Marker> {
    let mut normal = normal_numbers(seed);
    let white = DMatrix::from_fn(positions.len(), 2, |_, _| normal());
    let values = root.map_or(white.clone(), |root| root * &white);
    let marker = |(number, position): (usize, &[f64; 2])| {
        let exact = truth.at(*position);
        Marker {
            number,
            position: *position,
            displacement: [0, 1].map(|axis| exact[axis] + noise * values[(number, axis)]),
            standard_deviation: None,
        }
    };
    positions.iter().enumerate().map(marker).collect()
}

fn pva() -> Arc<dyn HyperelasticLaw> {
    Card::load("pva-10", std::path::Path::new(".")).unwrap().law
}

fn estimated(
    law: Arc<dyn HyperelasticLaw>,
    mesh: &crate::mesh::Mesh,
    markers: &[Marker],
) -> FieldEstimate {
    let specimen = Specimen {
        laws: law.into(),
        ..specimen(mesh)
    };
    estimate(&specimen, markers, &with_grips(EdgeCondition::Unknown)).unwrap()
}

/// As 4 mm on a strip of 40 mm × 20 mm.
const LENGTH: f64 = 6.0;

#[test]
fn too_few_independent_values_leave_the_right_law_undecided_with_intervals_that_hold_the_truth() {
    let (truth, mesh, positions) = (Truth::new(), estimate_mesh(), positions());
    let root = root(&positions, LENGTH);
    let estimated = |seed| {
        let markers = disturbed(&truth, &positions, Some(&root), 0.1, seed);
        estimated(law(), &mesh, &markers)
    };
    let all: Vec<FieldEstimate> = (0..8).into_par_iter().map(estimated).collect();
    for estimated in &all {
        assert_ne!(estimated.verdict.answer, Answer::NotExplained);
        let force = &estimated.forces[right(estimated)].force[0];
        let [low, high] = force.interval;
        assert!(low < truth.force && truth.force < high, "{force:?}");
        assert!(high - low < 0.1 * truth.force, "{force:?}");
    }
    let undecided = all.iter().map(|estimated| &estimated.verdict);
    let undecided: Vec<_> = undecided
        .filter(|verdict| verdict.answer == Answer::Undecided)
        .collect();
    assert!(undecided.len() >= 5, "{}", undecided.len());
    for verdict in undecided {
        assert!(verdict.has_intervals(), "{verdict:?}");
        let words = verdict.reasons[0].words();
        assert!(words.contains("no evidence against the law"), "{words}");
    }
}

#[test]
fn a_wrong_law_is_refuted_by_white_noise_and_never_explained_by_correlated_noise() {
    let (truth, mesh, positions) = (Truth::new(), estimate_mesh(), positions());
    let root = root(&positions, LENGTH);
    for seed in 0..4 {
        let white = disturbed(&truth, &positions, None, 0.02, seed);
        let white = estimated(pva(), &mesh, &white).verdict;
        assert_eq!(white.answer, Answer::NotExplained, "{seed} {white:?}");
        let noisy = disturbed(&truth, &positions, Some(&root), 0.02, seed);
        let noisy = estimated(pva(), &mesh, &noisy);
        assert!(!noisy.is_explained(), "{seed} {:?}", noisy.verdict);
    }
}

/// Half of a plate between grips, whose axis of symmetry below is stated to be something else.
#[test]
fn a_roller_is_proposed_where_an_edge_is_stated_to_be_free_or_a_grip() {
    let truth = Mesh::plate(SIZE, [26, 14], CellShape::Quad9);
    let moved = |values: [Option<f64>; 2]| Support::Displacement(values);
    let problem = sheet(vec![
        ("left".into(), moved([Some(0.0); 2])),
        ("right".into(), moved([Some(24.0), Some(0.0)])),
        ("bottom".into(), moved([None, Some(0.0)])),
    ]);
    let energy = problem.finite_elements(&truth);
    let model = problem.on(&truth, &energy).unwrap();
    let states = model.solve(&[0.5, 1.0], NewtonSettings::default(), &|_| ());
    let field = states.unwrap().remove(1).displacement;
    let at = |position: [f64; 2]| truth.displacement_at(&field, position);
    let markers = noisy(&positions(), &at, 0.02, 3);
    let roller = EdgeCondition::Known([None, Some(0.0)]);
    for stated in [EdgeCondition::Free, EdgeCondition::Rigid, roller] {
        let mut knowledge = with_grips(EdgeCondition::Rigid);
        let bottom = knowledge
            .edges
            .iter_mut()
            .find(|(name, _)| name == "bottom");
        bottom.unwrap().1 = stated;
        let mesh = estimate_mesh();
        let verdict = estimate_on(&mesh, &markers, &knowledge).verdict;
        let proposed = verdict
            .trials
            .iter()
            .find_map(|trial| match &trial.alternative {
                Alternative::Condition { edge, condition } => Some((edge.as_str(), *condition)),
                _ => None,
            });
        if stated == roller {
            assert_ne!(verdict.answer, Answer::NotExplained, "{verdict:?}");
            assert_eq!(proposed, None);
        } else {
            assert_eq!(verdict.answer, Answer::NotExplained, "{stated:?}");
            assert_eq!(
                proposed,
                Some(("bottom", roller)),
                "{stated:?} {verdict:#?}"
            );
        }
    }
}

/// A force that the field cannot have is reported, and does not change the field.
#[test]
fn a_wrong_force_leaves_the_field_as_the_markers_show_it() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let markers = truth.markers(0.02, 4);
    for share in [0.4, 0.6, 1.5] {
        let knowledge = Knowledge {
            forces: vec![measured_force(share * truth.force, 0.01 * truth.force)],
            ..with_grips(EdgeCondition::Rigid)
        };
        let result = estimate_on(&mesh, &markers, &knowledge);
        assert_eq!(result.verdict.answer, Answer::NotExplained);
        assert!(truth.error(&mesh, &result.displacement) < 0.02, "{share}");
        let factor = result
            .verdict
            .trials
            .iter()
            .find_map(|trial| match trial.alternative {
                Alternative::Factor(factor) => Some(factor),
                _ => None,
            });
        assert!(
            (factor.unwrap() / share - 1.0).abs() < 0.01,
            "{share}: {factor:?}"
        );
    }
}
