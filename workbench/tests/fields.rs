//! The measured field in a window without a display: edges are clicked, the field is corrected, everything goes out.

use eframe::egui::accesskit::Role;
use eframe::egui::{Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::Queryable;
use gelbench::results::Drawing;
use gelbench_report::results::MeshFigure;
use gelbench_workbench::logic::field::settings::TEXTS;
use gelbench_workbench::logic::field::{Edge, middle};
use gelbench_workbench::views::app::{Tab, Workbench};

mod common;
use common::{Bench, small, state, state_mut, until, window};

const MESH: &str = "mesh of the field";

fn looked(bench: &Workbench) -> bool {
    bench.fields.answer().is_some_and(|answer| answer.is_ok())
}

fn opened() -> Bench {
    let mut bench = window([1400.0, 1000.0], small());
    let text = include_bytes!("../../examples/measured_plate.csv");
    state_mut(&mut bench).open("measured_plate.csv", text);
    until(&mut bench, looked);
    for _ in 0..3 {
        bench.step();
    }
    assert_eq!(state(&bench).tab, Tab::Field);
    bench
}

/// Where the middle of an edge is on the screen.
fn place_of(bench: &Bench, edge: &str) -> Pos2 {
    let answer = state(bench).fields.answer().unwrap().as_ref().unwrap();
    let Drawing::Mesh(figure) = &answer.preview.drawing else {
        panic!("a mesh is drawn");
    };
    let group = figure.groups.iter().find(|group| group.name == edge);
    let middle = middle(&group.unwrap().lines).unwrap();
    let view = state(bench).fields.view.unwrap();
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
    state(bench).fields.question.edges[edge].clone()
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
        let answer = bench.fields.answer().unwrap().as_ref().unwrap();
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
    let known = Edge::Known(["nothing".into(), String::new()]);
    let edges = &mut state_mut(&mut bench).fields.question.edges;
    edges.insert("left".to_owned(), known);
    click(&mut bench, Pos2::new(1390.0, 990.0));
    bench.get_by_label("correct").click();
    bench.step();
    until(&mut bench, |bench| {
        bench.fields.answer().is_some_and(|answer| answer.is_err())
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
    let answer = state(&bench).fields.answer().unwrap().as_ref().unwrap();
    let gap = &TEXTS[3];
    let advice = format!("state the edge with “{}”", gap.label);
    let warnings = answer.preview.warnings.join("\n");
    assert!(warnings.contains(&advice), "{warnings}");
    assert!(!warnings.contains(gap.option), "{warnings}");
    assert!(bench.query_by_label_contains(&advice).is_some());
}

/// Two photographs, the edge and the length of a pixel.
fn photographs(edge: Option<&[u8]>) -> Bench {
    let mut bench = window([1400.0, 1400.0], small());
    let first = include_bytes!("../../examples/gel_0.png");
    state_mut(&mut bench).open("gel_0.png", first);
    bench.step();
    assert!(
        bench
            .query_by_label_contains("drop an image under load")
            .is_some()
    );
    if let Some(edge) = edge {
        state_mut(&mut bench).open("gel_edge.csv", edge);
    }
    let loaded = include_bytes!("../../examples/gel_1.png");
    state_mut(&mut bench).open("gel_1.png", loaded);
    until(&mut bench, |bench| bench.fields.answer().is_some());
    bench.step();
    let unit = &TEXTS[1];
    let asks = bench.query_all_by_label_contains(unit.label).count();
    assert!(asks > 1, "the length of a pixel is asked for");
    bench
        .get_by_role_and_label(Role::TextInput, unit.label)
        .focus();
    bench.step();
    bench
        .get_by_role_and_label(Role::TextInput, unit.label)
        .type_text("0.05 mm");
    bench.step();
    bench
}

#[test]
fn two_photographs_and_an_edge_lead_to_force_and_stress() {
    let mut bench = photographs(Some(include_bytes!("../../examples/gel_edge.csv")));
    for edge in ["top", "bottom"] {
        let edges = &mut state_mut(&mut bench).fields.question.edges;
        edges.insert(edge.to_owned(), Edge::Free);
    }
    bench.get_by_label("correct").click();
    bench.step();
    until(&mut bench, |bench| !bench.fields.corrector.is_busy());
    bench.step();
    let answer = state(&bench).fields.answer().unwrap().as_ref();
    let answer = answer.unwrap();
    assert_eq!(answer.preview.photo.as_ref().unwrap().size, [420, 240]);
    let (frames, _) = answer.corrected.as_ref().unwrap();
    let (photo, Drawing::Mesh(deformed)) = frames[0].photo.as_ref().unwrap() else {
        panic!("a mesh is drawn");
    };
    let Drawing::Mesh(at_rest) = &answer.preview.drawing else {
        panic!("a mesh is drawn");
    };
    let right = |figure: &MeshFigure| {
        let corners = figure.cells.iter().flatten();
        corners.fold(f64::MIN, |most, corner| most.max(corner[0]))
    };
    assert!(right(deformed) > right(at_rest) + 0.1);
    assert!(right(deformed) < photo.corners[1][0]);
    assert!(bench.query_by_label_contains("the camera image").is_some());
    assert!(bench.query_by_label_contains("force on right").is_some());
}

#[test]
fn the_edge_may_be_drawn_on_the_first_photograph() {
    let mut bench = photographs(None);
    bench.get_by_label("look").click();
    until(&mut bench, looked);
    bench.step();
    bench.get_by_label("draw the edge").click();
    bench.step();
    bench.step();
    let [left, right, bottom, top] = [1.0, 16.0, 1.95, 9.95];
    let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
    let view = state(&bench).fields.view.unwrap();
    // One corner too many is taken back.
    let clicks = corners[..3].iter().chain([&[18.0, 6.0]]);
    for corner in clicks {
        click(&mut bench, view.at(*corner));
    }
    bench.get_by_label("take back the last corner").click();
    bench.step();
    for corner in [corners[3], corners[0]] {
        click(&mut bench, view.at(corner));
    }
    bench.get_by_label("use this edge").click();
    bench.step();
    until(&mut bench, |bench| !bench.fields.corrector.is_busy());
    bench.step();
    let answer = state(&bench).fields.answer().unwrap().as_ref().unwrap();
    let Drawing::Mesh(figure) = &answer.preview.drawing else {
        panic!("a mesh is drawn");
    };
    // To a point of the screen.
    let point = view.vector(eframe::egui::vec2(1.0, 0.0))[0];
    for (axis, sides) in [[left, right], [bottom, top]].into_iter().enumerate() {
        let nodes = || figure.cells.iter().flatten().map(|node| node[axis]);
        let [least, most] = [
            nodes().fold(f64::MAX, f64::min),
            nodes().fold(f64::MIN, f64::max),
        ];
        assert!((least - sides[0]).abs() < point && (most - sides[1]).abs() < point);
    }
    assert!(
        ["left", "right", "bottom", "top"].iter().all(|name| answer
            .preview
            .edges
            .iter()
            .any(|edge| edge == name))
    );
}
