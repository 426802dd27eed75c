use super::*;
use crate::logic::background::Worker;
use crate::logic::engine::Engine;
use crate::logic::scene::Colour;

fn small() -> Scene {
    Scene {
        cells: [24, 8],
        ..Scene::default()
    }
}

fn pull(table: &mut Table, x: f64, gesture: bool) {
    let mut scene = Box::new(table.scene().clone());
    scene.grip.displacement[0] = x;
    table.act(Action::Change { scene, gesture });
}

/// Does everything that is to be solved.
fn settle(table: &mut Table, engine: &mut Engine) {
    loop {
        let tasks = table.tasks();
        if tasks.is_empty() {
            return;
        }
        for task in tasks {
            table.take(engine.answer(&task));
        }
    }
}

#[test]
fn a_pull_is_compared_drawn_as_a_curve_and_taken_back_in_one_step() {
    let (mut table, mut engine) = (Table::new(small()), Engine::default());
    settle(&mut table, &mut engine);
    for x in [50.0, 60.0, 70.0] {
        pull(&mut table, x, true);
        assert!(!table.is_settled());
        settle(&mut table, &mut engine);
    }
    table.act(Action::EndGesture);
    settle(&mut table, &mut engine);
    assert!(table.is_settled());
    let [springs, corrected] =
        [Model::Springs, Model::Corrected].map(|model| *table.deviation(model).unwrap());
    assert!(
        springs.departure > 10.0 && corrected.departure < 2.0,
        "{springs:?} {corrected:?}"
    );
    assert!(corrected.displacement < springs.displacement / 10.0);
    let curve = table.curve(Model::Corrected);
    assert_eq!(curve.len(), 4);
    assert!(
        curve.windows(2).all(|pair| pair[0][1] < pair[1][1]),
        "{curve:?}"
    );
    table.act(Action::Undo);
    assert_eq!(table.scene().grip.displacement[0], 45.0);
}

#[test]
fn what_was_asked_for_is_not_asked_for_again() {
    let mut table = Table::new(small());
    assert_eq!(table.tasks().len(), 3);
    assert!(table.tasks().is_empty());
    let mut scene = Box::new(table.scene().clone());
    scene.look.cells = true;
    table.act(Action::Change {
        scene,
        gesture: false,
    });
    assert!(table.tasks().is_empty(), "drawing cells needs no solution");
}

#[test]
fn answers_of_a_sheet_that_is_gone_are_put_away() {
    let (mut table, mut engine) = (Table::new(small()), Engine::default());
    let old = table.tasks();
    let scene = Box::new(Scene {
        thickness: 3.0,
        ..small()
    });
    table.act(Action::Change {
        scene,
        gesture: false,
    });
    for task in old {
        table.take(engine.answer(&task));
    }
    assert!(table.shown(Model::Springs).is_none());
    settle(&mut table, &mut engine);
    assert!(table.shown(Model::Springs).is_some());
}

#[test]
fn studies_and_cards_are_opened_and_faults_are_told() {
    let mut table = Table::new(small());
    let text = include_str!("../../../../examples/pva_plate.toml").to_owned();
    table.act(Action::Open {
        file: "pva_plate.toml".into(),
        text,
    });
    assert_eq!(
        (table.scene().cells, table.scene().stretch()),
        ([60, 20], 1.0)
    );
    let text = include_str!("../../../../materials/meunier-yeoh.toml")
        .replace("title = \"", "title = \"My ");
    table.act(Action::Open {
        file: "mine.toml".into(),
        text,
    });
    assert_eq!(table.scene().card.reference(), "mine.toml");
    table.act(Action::Open {
        file: "bad.toml".into(),
        text: "kind = \"plate\"\n[plate]\nwidth = \"3\"".into(),
    });
    assert!(table.message().unwrap().message.contains("width"));
    assert_eq!(
        table.scene().card.reference(),
        "mine.toml",
        "what is on the table stays"
    );
}

#[test]
fn impossible_measures_say_so_and_can_be_taken_back() {
    let mut table = Table::new(small());
    let scene = Box::new(Scene {
        cells: [1, 1],
        ..small()
    });
    table.act(Action::Change {
        scene,
        gesture: false,
    });
    assert!(table.meshes().is_err() && table.tasks().is_empty());
    table.act(Action::Undo);
    assert!(table.meshes().is_ok() && !table.tasks().is_empty());
}

#[test]
fn a_corrector_that_is_told_less_is_solved_anew_and_begins_another_curve() {
    let (mut table, mut engine) = (Table::new(small()), Engine::default());
    settle(&mut table, &mut engine);
    let full = table.deviation(Model::Corrected).unwrap().departure;
    pull(&mut table, 50.0, false);
    settle(&mut table, &mut engine);
    assert_eq!(table.curve(Model::Corrected).len(), 2);
    let mut scene = Box::new(table.scene().clone());
    scene.look.known.free_edges = false;
    table.act(Action::Change {
        scene,
        gesture: false,
    });
    settle(&mut table, &mut engine);
    assert!(table.is_settled());
    assert_eq!(table.curve(Model::Corrected).len(), 1);
    assert!(table.deviation(Model::Corrected).unwrap().departure > 5.0 * full);
}

#[test]
fn what_was_solved_for_another_sheet_or_colour_is_not_taken_for_the_present_one() {
    let (mut table, mut engine) = (Table::new(small()), Engine::default());
    settle(&mut table, &mut engine);
    let change = |table: &mut Table, scene: Scene| {
        table.act(Action::Change {
            scene: Box::new(scene),
            gesture: false,
        });
    };
    let mut scene = table.scene().clone();
    scene.look.colour = Colour::Stretch;
    change(&mut table, scene.clone());
    assert!(!table.is_settled() && table.values(Model::Springs).is_none());
    settle(&mut table, &mut engine);
    assert!(table.is_settled() && table.values(Model::Springs).is_some());
    scene.thickness = 3.0;
    change(&mut table, scene);
    assert!(!table.is_settled() && !table.drawn(Model::Springs).unwrap().follows);
    let springs = table.tasks().remove(0);
    table.take(engine.answer(&springs));
    assert!(table.drawn(Model::Springs).unwrap().follows);
    let deviation = table.deviation(Model::Springs);
    assert!(deviation.is_none(), "the finite elements are thinner");
}

#[test]
fn shapes_other_than_plates_are_corrected_with_all_that_is_known() {
    let [_, (_, outline), ..] = Outline::all(small().size);
    let mut scene = Scene { outline, ..small() };
    scene.look.known.free_edges = false;
    let tasks = Table::new(scene).tasks();
    assert_eq!(tasks.len(), 3);
    assert!(tasks.iter().all(|task| task.scene.look.known == Known::ALL));
}
