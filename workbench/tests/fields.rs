//! The measured field in a window without a display: edges are clicked, the field is corrected, everything goes out.

use eframe::egui::{Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::Queryable;
use gelbench::results::Drawing;
use gelbench_workbench::logic::field::settings::TEXTS;
use gelbench_workbench::logic::field::{Edge, middle};
use gelbench_workbench::views::app::{Tab, Workbench};

mod common;
use common::{Bench, small, state, state_mut, until, window};

const MESH: &str = "mesh of the field";

fn looked(bench: &Workbench) -> bool {
    bench.fields().answer().is_some_and(|answer| answer.is_ok())
}

fn opened() -> Bench {
    let mut bench = window([1400.0, 1000.0], small());
    let text = include_bytes!("../../examples/measured_plate.csv");
    state_mut(&mut bench).open("measured_plate.csv", text);
    until(&mut bench, looked);
    for _ in 0..3 {
        bench.step();
    }
    assert_eq!(state(&bench).tab(), Tab::Field);
    bench
}

/// Where the middle of an edge is on the screen.
fn place_of(bench: &Bench, edge: &str) -> Pos2 {
    let answer = state(bench).fields().answer().unwrap().as_ref().unwrap();
    let Drawing::Mesh(figure) = &answer.preview.drawing else {
        panic!("a mesh is drawn");
    };
    let group = figure.groups.iter().find(|group| group.name == edge);
    let middle = middle(&group.unwrap().lines).unwrap();
    let view = state(bench).fields().view().unwrap();
    view.at(middle)
}

fn click(bench: &mut Bench, at: Pos2) {
    bench.hover_at(at);
    bench.step();
    for pressed in [true, false] {
        bench.event(eframe::egui::Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        bench.step();
    }
    // What pops up measures itself before it is seen.
    for _ in 0..3 {
        bench.step();
    }
}

fn statement_of(bench: &Bench, edge: &str) -> Edge {
    state(bench).fields().edge(edge).unwrap().clone()
}

#[test]
fn an_edge_that_is_clicked_asks_what_is_known_of_it() {
    let mut bench = opened();
    for (edge, word, expected) in [
        ("left", "rigid", Edge::Rigid),
        ("right", "rigid", Edge::Rigid),
        ("top", "free", Edge::Free),
        ("bottom", "free", Edge::Free),
    ] {
        assert_eq!(statement_of(&bench, edge), Edge::Unnamed);
        let at = place_of(&bench, edge);
        click(&mut bench, at);
        assert!(
            bench.query_by_label(&format!("the edge {edge}")).is_some(),
            "{edge}"
        );
        bench.get_by_label(word).click();
        bench.step();
        assert_eq!(statement_of(&bench, edge), expected);
        click(&mut bench, Pos2::new(1390.0, 990.0));
        assert!(bench.query_by_label(&format!("the edge {edge}")).is_none());
    }
    bench.get_by_label("correct").click();
    bench.step();
    let corrected = |bench: &Workbench| {
        let answer = bench.fields().answer().unwrap().as_ref().unwrap();
        answer.corrected.is_some()
    };
    until(&mut bench, corrected);
    bench.step();
    assert!(bench.query_by_label_contains("verdict, frame").is_some());
    assert!(bench.query_by_label_contains("force on right").is_some());
}

#[test]
fn a_known_edge_takes_its_displacement_and_a_wrong_one_is_told() {
    let mut bench = opened();
    let at = place_of(&bench, "left");
    click(&mut bench, at);
    bench.get_by_label("known").click();
    bench.step();
    bench.step();
    assert!(matches!(statement_of(&bench, "left"), Edge::Known(_)));
    state_mut(&mut bench)
        .fields_mut()
        .state_edge("left", Edge::Known(["nothing".into(), String::new()]));
    click(&mut bench, Pos2::new(1390.0, 990.0));
    bench.get_by_label("correct").click();
    bench.step();
    until(&mut bench, |bench| {
        bench
            .fields()
            .answer()
            .is_some_and(|answer| answer.is_err())
    });
    bench.step();
    assert!(
        bench
            .query_by_label_contains("ux of the edge left")
            .is_some()
    );
}

#[test]
fn the_mesh_can_be_found_by_those_who_do_not_see_it() {
    let bench = opened();
    assert!(bench.query_by_label_contains(MESH).is_some());
}

#[test]
fn warnings_name_what_the_view_offers() {
    let bench = opened();
    for setting in &TEXTS {
        assert!(bench.query_by_label(setting.label).is_some(), "{setting:?}");
    }
    let answer = state(&bench).fields().answer().unwrap().as_ref().unwrap();
    let gap = &TEXTS[3];
    let advice = format!("state the edge with “{}”", gap.label);
    let warnings = answer.preview.warnings.join("\n");
    assert!(warnings.contains(&advice), "{warnings}");
    assert!(!warnings.contains(gap.option), "{warnings}");
    assert!(bench.query_by_label_contains(&advice).is_some());
}
