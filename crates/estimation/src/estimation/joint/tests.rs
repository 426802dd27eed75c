use std::path::Path;

use super::*;
use crate::estimation::tests::{SIZE, grid, measured_force, solved, specimen, with_grips};
use crate::estimation::{EdgeCondition, Knowledge};
use crate::markers::Marker;
use crate::material::Card;
use crate::mesh::{CellShape, Mesh};
use crate::statistics::normal_numbers;

const CELLS: [usize; 2] = [20, 10];
const STRETCHES: [f64; 5] = [0.1, 0.25, 0.4, 0.6, 0.9];

/// A clamped sheet of Yeoh's law and what is measured of it in every frame.
struct Series {
    mesh: Mesh,
    law: RegressedLaw,
    markers: Vec<Vec<Marker>>,
    forces: Vec<f64>,
}

impl Series {
    /// Markers with noise in mm, and forces with noise relative to each force.
    fn new(stretches: &[f64], noise: [f64; 2], seed: u64) -> Self {
        Self::on([26, 14], stretches, noise, seed)
    }

    /// The same on a mesh with these numbers of cells.
    fn on(cells: [usize; 2], stretches: &[f64], noise: [f64; 2], seed: u64) -> Self {
        let law = RegressedLaw::of_card(
            &Card::load("meunier-yeoh", Path::new(".")).unwrap(),
            &["all"],
        );
        let law = law.unwrap();
        let fine = Mesh::plate(SIZE, cells, CellShape::Quad9);
        let motion = [SIZE[0], 0.0];
        let states = solved(&fine, law.at(&law.start()), "right", motion, stretches);
        let mut draw = normal_numbers(seed);
        let mut series = Self {
            mesh: Mesh::plate(SIZE, CELLS, CellShape::Quad9),
            law,
            markers: Vec::new(),
            forces: Vec::new(),
        };
        for (displacement, [force, _]) in &states {
            let marker = |(number, position): (usize, [f64; 2])| Marker {
                number,
                position,
                displacement: fine
                    .displacement_at(displacement, position)
                    .map(|u| u + noise[0] * draw()),
                standard_deviation: None,
            };
            series
                .markers
                .push(grid().into_iter().enumerate().map(marker).collect());
            series.forces.push(force * (1.0 + noise[1] * draw()));
        }
        series
    }

    fn frames(&self) -> Vec<JointFrame<'_>> {
        let pairs = self.markers.iter().zip(&self.forces);
        pairs
            .map(|(markers, force)| self.frame(markers, *force))
            .collect()
    }

    fn frame<'a>(&'a self, markers: &'a [Marker], force: f64) -> JointFrame<'a> {
        JointFrame {
            specimen: specimen(&self.mesh),
            markers,
            knowledge: Knowledge {
                forces: vec![measured_force(force, 0.01 * force)],
                ..with_grips(EdgeCondition::Rigid)
            },
        }
    }
}

fn estimated(frames: &[JointFrame], law: &RegressedLaw, profiles: bool) -> JointEstimate {
    let settings = JointSettings {
        profiles,
        ..JointSettings::default()
    };
    estimate_jointly(frames, law, &settings, &|_| ()).unwrap()
}

fn values(result: &JointEstimate) -> Vec<f64> {
    result.parameters.iter().map(|one| one.value).collect()
}

#[test]
fn three_parameters_come_out_of_five_frames_from_anywhere_and_in_any_order() {
    let series = Series::on(CELLS, &STRETCHES, [1e-4, 1e-6], 1);
    let truth = series.law.start();
    let start = series
        .law
        .beginning_at(&[10.0 * truth[0], 0.3 * truth[2], 30.0 * truth[2]]);
    let mut frames = series.frames();
    let result = estimated(&frames, &start, false);
    for (value, truth) in values(&result).iter().zip(&truth) {
        assert!((value / truth - 1.0).abs() < 0.03, "{value} for {truth}");
    }
    assert!(result.directions.iter().all(Direction::is_determined));
    assert!(result.prediction_error().unwrap() < 0.01);
    frames.reverse();
    let turned = estimated(&frames, &start, false);
    for (a, b) in result.parameters.iter().zip(&turned.parameters) {
        assert!(
            (a.value - b.value).abs() < 0.1 * a.standard_error,
            "{a:?}, {b:?}"
        );
    }
}

#[test]
fn noise_leaves_the_truth_within_the_intervals_and_likelihood_agrees_with_errors() {
    let series = Series::new(&STRETCHES, [0.1, 0.01], 2);
    let truth = series.law.start();
    let result = estimated(&series.frames(), &series.law, true);
    for (estimate, truth) in result.parameters.iter().zip(&truth) {
        assert!((estimate.value - truth).abs() < 4.0 * estimate.standard_error);
        let [low, high] = estimate.interval;
        let half = (high - low) / 2.0 / estimate.standard_error;
        assert!((1.3..4.0).contains(&half), "{estimate:?}");
    }
    assert!(result.common < 0.2, "{}", result.common);
    let shares: f64 = result.frames.iter().map(|frame| frame.share).sum();
    assert!((shares - 1.0).abs() < 1e-6, "{shares}");
    for frame in &result.frames {
        let force = &frame.forces[0];
        let off = force.predicted.unwrap() / force.measured.force - 1.0;
        assert!(off.abs() < 0.15, "{force:?}");
    }
}

#[test]
fn what_small_strains_do_not_determine_is_reported_and_keeps_the_cards_value() {
    let series = Series::new(&[0.02, 0.04], [0.02, 0.01], 3);
    let result = estimated(&series.frames(), &series.law, false);
    let vague = result.directions.iter().filter(|one| !one.is_determined());
    assert!((1..=2).contains(&vague.count()), "{:?}", result.directions);
    let c10 = &result.parameters[0];
    assert!(
        (c10.value / series.law.start()[0] - 1.0).abs() < 0.1,
        "{c10:?}"
    );
}

#[test]
fn without_a_force_no_stiffness_is_determined() {
    let series = Series::new(&[0.2], [0.02, 0.01], 4);
    let mut frames = series.frames();
    frames[0].knowledge.forces.clear();
    let fault = estimate_jointly(&frames, &series.law, &JointSettings::default(), &|_| ());
    assert!(
        fault
            .unwrap_err()
            .to_string()
            .contains("no force was measured")
    );
}

#[test]
fn a_single_frame_predicts_no_force() {
    let series = Series::new(&[0.5], [0.02, 0.01], 5);
    let law = RegressedLaw::of_card(&Card::load("neo-hooke", Path::new(".")).unwrap(), &["all"]);
    let result = estimated(&series.frames(), &law.unwrap(), false);
    assert_eq!(result.prediction_error(), None);
}

#[test]
fn the_error_of_coarse_cells_is_in_the_intervals() {
    let mut series = Series::on([40, 20], &[0.2, 0.4, 0.6], [1e-3, 1e-6], 6);
    series.mesh = Mesh::plate(SIZE, [10, 5], CellShape::Quad4);
    let card = Card::load("meunier-yeoh", Path::new(".")).unwrap();
    let law = RegressedLaw::of_card(&card, &["c10"]).unwrap();
    let mut frames = series.frames();
    for frame in &mut frames {
        frame.knowledge.forces[0].standard_deviation *= 1e-2;
    }
    let truth = law.start()[0];
    for profiles in [false, true] {
        let result = estimated(&frames, &law, profiles);
        assert!(result.holds_mesh_error);
        let estimate = &result.parameters[0];
        let [low, high] = estimate.interval;
        assert!(low < truth && truth < high, "{truth} by {estimate:?}");
        let off = (estimate.value - truth).abs();
        assert!(high - low < 8.0 * off, "{truth} by {estimate:?}");
    }
}

/// A load cell that shows too much does so in all frames: no number of frames makes up for it.
#[test]
fn intervals_hold_a_factor_that_all_forces_have_in_common() {
    let series = Series::on(CELLS, &STRETCHES, [1e-3, 1e-4], 1);
    let truth = series.law.start()[0];
    let held = |common: f64| {
        let mut frames = series.frames();
        let forces = frames
            .iter_mut()
            .flat_map(|frame| &mut frame.knowledge.forces);
        for measured in forces {
            measured.force *= 1.01;
            measured.standard_deviation *= 0.1;
            measured.common_deviation = common;
        }
        let [low, high] = estimated(&frames, &series.law, true).parameters[0].interval;
        low < truth && truth < high
    };
    assert!(held(0.01) && !held(0.0));
}

/// A scatter of forces above the stated one is reported, and intervals include it.
#[test]
fn forces_that_scatter_more_than_stated_widen_the_intervals() {
    let [calm, wild] = [0.01, 0.06].map(|noise| {
        let series = Series::on(CELLS, &STRETCHES, [1e-3, noise], 3);
        estimated(&series.frames(), &series.law, false)
    });
    assert!(
        !calm.force_scatter.is_too_large(),
        "{:?}",
        calm.force_scatter
    );
    assert!(
        wild.force_scatter.is_too_large(),
        "{:?}",
        wild.force_scatter
    );
    let width =
        |result: &JointEstimate| result.parameters[0].standard_error / result.parameters[0].value;
    assert!(
        width(&wild) > 2.0 * width(&calm),
        "{} {}",
        width(&wild),
        width(&calm)
    );
}
