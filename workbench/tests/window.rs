//! The workbench in a window without a display: hands, keys, files, layout.

use eframe::egui::{Key, Modifiers, Rect, pos2, vec2};
use egui_kittest::kittest::Queryable;
use gelbench_report::results::Stroke;
use gelbench_workbench::logic::scene::{Grip, Model, Outline, Scene};
use gelbench_workbench::views::app::{Tab, Workbench};
use gelbench_workbench::views::guide::Shows;

mod common;
use common::{Bench, small, state, state_mut, until, window};

fn settled(bench: &mut Bench) {
    until(bench, |bench| bench.table.is_settled());
}

fn force(bench: &Bench) -> f64 {
    let shown = state(bench).table.shown(Model::Corrected);
    shown.expect("it was solved").solved.force[0]
}

fn stretch(bench: &Bench) -> f64 {
    state(bench).table.scene().stretch()
}

fn grip_of(bench: &Bench, model: &str) -> Rect {
    bench
        .get_by_label_contains(&format!("grip of the {model}"))
        .rect()
}

#[test]
fn the_grip_follows_the_mouse_and_the_models_follow_the_grip() {
    let mut bench = window([1400.0, 900.0], small());
    settled(&mut bench);
    let (before, at_rest) = (force(&bench), stretch(&bench));
    let from = grip_of(&bench, "corrected springs").center();
    bench.hover_at(from);
    bench.step();
    bench.drag_at(from);
    bench.step();
    for step in 1..=10 {
        bench.hover_at(from + vec2(6.0 * step as f32, 0.0));
        bench.step();
    }
    bench.drop_at(from + vec2(60.0, 0.0));
    bench.step();
    settled(&mut bench);
    assert!(
        stretch(&bench) > at_rest + 0.05,
        "{} {}",
        stretch(&bench),
        at_rest
    );
    assert!(force(&bench) > before);
    assert!(state(&bench).table.deviation(Model::Corrected).is_some());
    // The whole pull is one step back.
    bench.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    bench.step();
    settled(&mut bench);
    assert_eq!(stretch(&bench), at_rest);
    assert!((force(&bench) / before - 1.0).abs() < 1e-9);
}

#[test]
fn the_grip_follows_the_keys() {
    let mut bench = window([1400.0, 900.0], small());
    settled(&mut bench);
    let grip = "grip of the springs";
    bench.get_by_label_contains(grip).focus();
    bench.step();
    bench.key_press(Key::ArrowRight);
    bench.step();
    assert!(
        (stretch(&bench) - 0.31).abs() < 1e-12,
        "{}",
        stretch(&bench)
    );
    bench.key_press(Key::ArrowUp);
    bench.step();
    bench.key_press(Key::Comma);
    bench.step();
    let moved = state(&bench).table.scene().grip;
    assert!(
        (moved.displacement[1] - 1.5).abs() < 1e-12
            && (moved.angle.to_degrees() - 1.0).abs() < 1e-12
    );
    settled(&mut bench);
    assert!(
        Model::ALL
            .iter()
            .all(|model| state(&bench).table.fault(*model).is_none())
    );
}

#[test]
fn controls_leave_what_lies_beyond_their_range_as_it_is() {
    let scene = Scene {
        outline: Outline::Hole { diameter: 20.0 },
        thickness: 0.005,
        cells: [10, 3],
        grip: Grip {
            displacement: [30.0, 75.0],
            angle: 1.7,
        },
        ..small()
    };
    let mut bench = window([1400.0, 900.0], scene.clone());
    bench.run_steps(2);
    assert_eq!(*state(&bench).table.scene(), scene);
}

#[test]
fn all_that_is_needed_is_inside_the_window_in_every_size_and_light() {
    for size in [[1400.0, 900.0], [800.0, 600.0]] {
        for theme in [eframe::egui::Theme::Dark, eframe::egui::Theme::Light] {
            let mut bench = window(size, small());
            bench.ctx.set_theme(theme);
            settled(&mut bench);
            bench.step();
            let inside = Rect::from_min_max(pos2(0.0, 0.0), pos2(size[0], size[1]));
            for label in [
                "sheet", "material", "undo", "redo", "file", "guide", "controls",
            ] {
                let rect = bench.get_by_label(label).rect();
                assert!(
                    inside.contains_rect(rect),
                    "{label} at {rect:?} in {size:?}"
                );
            }
            for model in Model::ALL {
                let grip = grip_of(&bench, model.name());
                assert!(
                    inside.contains_rect(grip.shrink(8.0)),
                    "{grip:?} in {size:?}"
                );
            }
        }
    }
}

#[test]
fn every_guided_scene_is_solved_without_a_fault() {
    let mut bench = window([1400.0, 900.0], small());
    for (number, scene) in gelbench_workbench::views::guide::SCENES.iter().enumerate() {
        let label = format!("{} {}", number + 1, scene.title);
        bench.get_by_label(&label).click();
        bench.step();
        bench.step();
        settled(&mut bench);
        match scene.shows {
            Shows::Sheet(scene) => assert_eq!(*state(&bench).table.scene(), scene(), "{label}"),
            Shows::MeasuredField => {
                let corrected = |bench: &Workbench| {
                    let answer = bench.fields.answer();
                    answer.is_some_and(|answer| answer.as_ref().unwrap().corrected.is_some())
                };
                until(&mut bench, corrected);
                bench.step();
                assert!(bench.query_by_label_contains("verdict, frame").is_some());
            }
        }
        let shown = |bench: &Workbench| {
            let corrected = bench.table.shown(Model::Corrected);
            corrected.is_some_and(|shown| shown.solved.multipliers.is_some())
        };
        if state(&bench).table.scene().look.multipliers {
            until(&mut bench, shown);
        }
        let faults = Model::ALL.map(|model| state(&bench).table.fault(model).cloned());
        assert!(faults.iter().all(Option::is_none), "{label}: {faults:?}");
    }
}

#[test]
fn dropped_files_find_their_view_and_bad_ones_are_told() {
    let mut bench = window([1400.0, 900.0], small());
    state_mut(&mut bench).open(
        "bad.toml",
        b"kind = \"plate\"\n[plate]\nlenght = \"3 cm\"\n",
    );
    bench.step();
    assert!(bench.query_by_label_contains("lenght").is_some());
    state_mut(&mut bench).open("noise.toml", &[0xff, 0xfe, 0x00]);
    state_mut(&mut bench).open("pull.csv", b"# test: uniaxial\n");
    bench.step();
    assert_eq!(state(&bench).tab, Tab::Material);
}

#[test]
fn a_dropped_file_that_nothing_reads_says_what_would_be() {
    let mut bench = window([800.0, 600.0], small());
    for (name, content) in [("film.mp4", &b"\xff\xd8"[..]), ("notes.md", b"# notes")] {
        state_mut(&mut bench).open(name, content);
        bench.step();
        let message = &state(&bench).message;
        assert!(
            message.contains(name) && message.contains("(.toml"),
            "{message}"
        );
        assert_eq!(state(&bench).tab, Tab::Sheet, "nothing else happens");
        assert!(state(&bench).studies.files.is_empty());
        assert!(bench.query_by_label_contains(name).is_some());
    }
}

#[test]
fn the_points_of_a_dropped_test_are_drawn_at_once() {
    let mut bench = window([800.0, 600.0], small());
    let test = include_bytes!("../../materials/data/treloar_1944_uniaxial.csv");
    state_mut(&mut bench).open("treloar_1944_uniaxial.csv", test);
    bench.step();
    until(&mut bench, |bench| bench.materials.seen.is_some());
    bench.run_steps(2);
    let materials = &state(&bench).materials;
    assert!(materials.ranking().is_none(), "nothing was fitted");
    let lines = &materials.seen.as_ref().unwrap().lines;
    assert_eq!(lines.len(), 1);
    assert!(lines[0].points.len() > 20 && lines[0].stroke == Stroke::Points);
    let chart = bench.get_by_label_contains("as they were read").rect();
    assert!(
        chart.bottom() < 300.0,
        "below {chart:?} the points are seen"
    );
    // A file that does not say what was measured is asked about at once too.
    state_mut(&mut bench).open("bare.csv", b"strain,stress\n0.1,0.01\n0.2,0.02\n0.3,0.03\n");
    until(&mut bench, |bench| bench.materials.ranking().is_some());
    assert!(state(&bench).materials.ranking().unwrap().is_err());
}

#[test]
fn a_dropped_test_is_fitted_and_the_sheet_is_made_of_it() {
    let mut bench = window([1400.0, 900.0], small());
    let test = include_bytes!("../../materials/data/treloar_1944_uniaxial.csv");
    state_mut(&mut bench).open("treloar_1944_uniaxial.csv", test);
    bench.step();
    bench.step();
    bench.get_by_label("fit").click();
    bench.step();
    until(&mut bench, |bench| bench.materials.ranking().is_some());
    let ranking = state(&bench).materials.ranking().unwrap().as_ref().unwrap();
    assert!(ranking.fits.len() > 5, "{}", ranking.fits.len());
    bench.step();
    bench.get_by_label("use it for the sheet").click();
    bench.step();
    assert!(state(&bench).table.scene().card.name.starts_with("fitted-"));
}
