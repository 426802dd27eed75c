//! What the sheet shows: what was computed, what the command warns of, and what is seen in windows of every size.

use eframe::egui::{Event, MouseWheelSource, MouseWheelUnit, Rect, TouchPhase, pos2, vec2};
use egui_kittest::kittest::Queryable;
use gelbench_report::results::{Block, Stroke};
use gelbench_workbench::logic::background::Worker;
use gelbench_workbench::logic::scene::{Grip, Model, Scene};
use gelbench_workbench::logic::studies::{Runner, StudyQuestion};
use gelbench_workbench::logic::table::Action;
use gelbench_workbench::views::colours::most_of;
use gelbench_workbench::views::figures;
use gelbench_workbench::views::guide::{SCENES, Shows};

mod common;
use common::{Bench, small, state, state_mut, until, window};

fn settled(bench: &mut Bench) {
    until(bench, |bench| bench.table.is_settled());
    bench.run_steps(2);
}

fn pulled_to(stretch: f64) -> Scene {
    let grip = Grip {
        displacement: [stretch * small().size[0], 0.0],
        angle: 0.0,
    };
    Scene { grip, ..small() }
}

fn pull(bench: &mut Bench, stretch: f64) {
    let scene = Box::new(pulled_to(stretch));
    state_mut(bench).table.act(Action::Change {
        scene,
        gesture: false,
    });
    settled(bench);
}

#[test]
fn the_chart_has_what_was_computed_and_nothing_between() {
    let mut bench = window([1200.0, 800.0], pulled_to(0.1));
    settled(&mut bench);
    pull(&mut bench, 1.5);
    let table = &state(&bench).table;
    for (line, model) in figures::curve(table).lines.iter().zip(Model::ALL) {
        assert_eq!(
            line.stroke,
            Stroke::Points,
            "lines between points show forces that nobody has computed"
        );
        let computed = table.curve(model);
        assert_eq!(computed.len(), 2);
        assert_eq!(line.points[0], [0.0, 0.0], "a sheet at rest has no force");
        assert_eq!(line.points[1..], computed);
    }
}

#[test]
fn warnings_of_the_command_stand_on_the_sheet() {
    let mut bench = window([800.0, 600.0], pulled_to(0.1));
    settled(&mut bench);
    assert!(state(&bench).table.warnings().is_empty());
    assert!(bench.query_by_label_contains("warning:").is_none());
    // Pulled beyond the tests of the card, and pressed until it buckles.
    for (rule, headline, stretch) in [
        ("beyond-card", "warning: beyond the card's range", 1.5),
        ("wrinkling", "warning: may wrinkle or buckle", -0.15),
    ] {
        let scene = Scene {
            thickness: 0.1,
            ..pulled_to(stretch)
        };
        let study = scene.study();
        let scene = Box::new(scene);
        state_mut(&mut bench).table.act(Action::Change {
            scene,
            gesture: false,
        });
        settled(&mut bench);
        let sheets = Rect::from_min_max(pos2(250.0, 0.0), pos2(800.0, 600.0));
        let shown = bench.get_by_label(headline).rect();
        assert!(sheets.contains_rect(shown), "{shown:?}");
        let name = "study.toml".to_owned();
        let files = vec![(name.clone(), study.into_bytes())];
        let question = StudyQuestion { study: name, files };
        let blocks = Runner.answer(&question).unwrap().blocks;
        let [ours] = state(&bench).table.warnings() else {
            panic!("{:?}", state(&bench).table.warnings());
        };
        assert_eq!(ours.rule, rule);
        let ours = ours.to_string();
        let is_ours =
            |block: &Block| matches!(block, Block::Paragraph(text) if text.contains(&ours));
        assert!(blocks.iter().any(is_ours), "{ours} is not among {blocks:?}");
        let sentence = bench.query_by_label(&ours);
        assert!(sentence.is_some(), "the whole sentence stands below");
    }
}

#[test]
fn finite_elements_take_no_colour_from_the_first_picture() {
    let mut bench = window([1200.0, 800.0], Scene::default());
    until(&mut bench, |bench| {
        let shown = |model| bench.table.shown(model).is_some();
        shown(Model::Springs) && shown(Model::Corrected) && shown(Model::Elements)
    });
    let table = &state(&bench).table;
    let span = |models: &[Model]| most_of(table.spanned(models)).unwrap();
    let before = span(&[Model::Springs, Model::Corrected]);
    let after = span(&Model::ALL);
    let change = after.range[1] / before.range[1] - 1.0;
    assert!(change.abs() < 0.02, "{before:?} {after:?}");
    assert!(
        after.exceeded[1],
        "stresses in corners have no bound, which an arrow shows"
    );
}

#[test]
fn controls_are_whole_in_every_guided_scene() {
    let mut bench = window([1200.0, 800.0], small());
    for (number, scene) in SCENES.iter().enumerate() {
        if matches!(scene.shows, Shows::MeasuredField) {
            continue;
        }
        let label = format!("{} {}", number + 1, scene.title);
        bench.get_by_label(&label).click();
        bench.run_steps(3);
        for words in ["colour", "shape", "card"] {
            for node in bench.get_all_by_label(words) {
                let height = node.rect().height();
                assert!(
                    height < 30.0,
                    "`{words}` is {height} points high in {label}"
                );
            }
        }
    }
}

#[test]
fn what_was_held_is_seen_until_the_release_is_computed() {
    let mut bench = window([1200.0, 800.0], small());
    settled(&mut bench);
    let table = &mut state_mut(&mut bench).table;
    let before = (
        table.drawn(Model::Springs).unwrap().displacement.to_vec(),
        table.drawn_values(Model::Springs),
        table.spanned(&Model::ALL),
    );
    table.act(Action::LetGo { damping: 0.0 });
    assert!(table.moving().is_some() && table.played().is_none());
    for model in Model::ALL {
        assert!(table.drawn(model).unwrap().follows, "{model:?}");
    }
    let after = (
        table.drawn(Model::Springs).unwrap().displacement.to_vec(),
        table.drawn_values(Model::Springs),
        table.spanned(&Model::ALL),
    );
    assert_eq!(before, after);
    until(&mut bench, |bench| bench.table.played().is_some());
}

#[test]
fn the_report_is_shown_after_a_run_with_contents_that_lead_to_its_headings() {
    let mut bench = window([1000.0, 700.0], small());
    let text = include_str!("../../examples/released_plate.toml");
    let small = text.replace("cells = [30, 10]", "cells = [12, 4]");
    state_mut(&mut bench).open("motion.toml", small.as_bytes());
    bench.run_steps(2);
    bench.get_by_label("run").click();
    bench.step();
    until(&mut bench, |bench| bench.studies.report().is_some());
    bench.run_steps(60);
    let report = state(&bench).studies.report().unwrap().as_ref().unwrap();
    let title = report.title.clone();
    let heading = report.blocks.iter().rev().find_map(|block| match block {
        Block::Heading(_, text) => Some(text.clone()),
        _ => None,
    });
    let at = bench.get_all_by_label(&title).last().unwrap().rect();
    assert!(at.top() > 0.0 && at.top() < 250.0, "{at:?}");
    let heading = heading.unwrap();
    let positions = |bench: &Bench| -> Vec<Rect> {
        bench
            .get_all_by_label(&heading)
            .map(|node| node.rect())
            .collect()
    };
    let [entry, before] = positions(&bench)[..] else {
        panic!("an entry and a heading {heading}");
    };
    assert!(entry.top() < 700.0);
    bench.get_all_by_label(&heading).next().unwrap().click();
    bench.run_steps(60);
    let after = positions(&bench)[1];
    assert!(
        after.top() < before.top() && after.bottom() < 700.0,
        "{before:?} {after:?}"
    );
}

#[test]
fn the_wheel_zooms_about_the_pointer_and_the_background_is_pulled() {
    let mut bench = window([1200.0, 800.0], small());
    settled(&mut bench);
    let grip = |bench: &Bench| {
        let handle = bench.get_by_label_contains("grip of the corrected springs");
        handle.rect()
    };
    let before = grip(&bench);
    let at = before.center() - vec2(100.0, 0.0);
    bench.hover_at(at);
    bench.step();
    bench.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        source: MouseWheelSource::Wheel,
        delta: vec2(0.0, 100.0),
        phase: TouchPhase::Move,
        modifiers: Default::default(),
    });
    bench.run_steps(40);
    let zoomed = grip(&bench);
    let factor = (zoomed.center().x - at.x) / 100.0;
    assert!(factor > 1.2, "{before:?} {zoomed:?}");
    bench.drag_at(at);
    bench.step();
    bench.hover_at(at + vec2(-40.0, 10.0));
    bench.step();
    bench.drop_at(at + vec2(-40.0, 10.0));
    bench.run_steps(2);
    let shifted = grip(&bench).center() - zoomed.center();
    assert!((shifted - vec2(-40.0, 10.0)).length() < 2.0, "{shifted:?}");
    assert_eq!(
        *state(&bench).table.scene(),
        small(),
        "the sheet stays as it is"
    );
}

#[test]
fn small_windows_keep_the_sheet_large() {
    for (size, share) in [([800.0, 600.0], 0.48), ([1200.0, 800.0], 0.48)] {
        let mut bench = window(size, small());
        settled(&mut bench);
        let [first, last] = ["springs", "finite elements"].map(|model| {
            let label = format!("grip of the {model}");
            bench.get_by_label_contains(&label).rect()
        });
        let height = last.bottom() - first.top();
        assert!(height > share * size[1], "{height} in {size:?}");
    }
}
