//! What was typed is never lost: keys act on the view that is shown, and files of others are kept.

use std::fs;

use eframe::egui::{Key, Modifiers};
use gelbench_workbench::logic::scene::{Grip, Scene};
use gelbench_workbench::logic::table::Action;
use gelbench_workbench::views::app::Tab;

mod common;
use common::{small, state, state_mut, window};

#[test]
fn keys_in_the_view_of_studies_save_and_take_back_nothing_of_the_sheet() {
    let folder = std::env::temp_dir().join(format!("gelbench-saving-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    std::env::set_current_dir(&folder).unwrap();
    let mut bench = window([1400.0, 900.0], small());
    let pulled = Scene {
        grip: Grip {
            displacement: [60.0, 0.0],
            ..small().grip
        },
        ..small()
    };
    let scene = Box::new(pulled.clone());
    state_mut(&mut bench).table.act(Action::Change {
        scene,
        gesture: false,
    });
    fs::write("study.toml", "# of somebody else\n").unwrap();
    state_mut(&mut bench).turn_to(Tab::Study);
    bench.step();
    for key in [Key::Z, Key::S] {
        bench.key_press_modifiers(Modifiers::COMMAND, key);
        bench.step();
    }
    assert_eq!(*state(&bench).table.scene(), pulled);
    assert!(!folder.join("workbench.toml").exists());
    let said = state(&bench).said().to_owned();
    assert!(
        said.contains("study.toml") && said.contains("is kept as"),
        "{said}"
    );
    let kept = fs::read_to_string("study.toml.kept").unwrap();
    assert_eq!(kept, "# of somebody else\n");
    // What it has written itself it replaces.
    bench.key_press_modifiers(Modifiers::COMMAND, Key::S);
    bench.step();
    assert!(!folder.join("study.toml.kept-2").exists());
    state_mut(&mut bench).turn_to(Tab::Sheet);
    bench.step();
    for key in [Key::Z, Key::S] {
        bench.key_press_modifiers(Modifiers::COMMAND, key);
        bench.step();
    }
    assert_eq!(*state(&bench).table.scene(), small());
    assert!(folder.join("workbench.toml").exists());
    fs::remove_dir_all(&folder).unwrap();
}
