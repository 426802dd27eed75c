//! What was typed or pulled is never lost, and files of others are not replaced unasked.

use std::cell::RefCell;
use std::fs;
use std::future::poll_fn;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::task::Poll;

use eframe::egui::{Key, Modifiers, ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::kittest::Queryable;
use gelbench_workbench::logic::scene::{Grip, Scene};
use gelbench_workbench::logic::table::Action;
use gelbench_workbench::views::app::Tab;
use gelbench_workbench::views::files::{Choice, Recent};

mod common;
use common::{Bench, small, state, state_mut, until, window};

/// A folder of a test's own, which ends with it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gelbench-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.at(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// What the dialogues were asked.
type Asked = Rc<RefCell<Vec<Choice>>>;

/// A window whose dialogues are answered with paths, one after the other; without one more they are cancelled.
fn answered(paths: &[PathBuf]) -> (Bench, Asked) {
    let mut bench = window([1200.0, 800.0], small());
    let asked = Asked::default();
    let (noted, paths) = (Rc::clone(&asked), paths.to_vec());
    state_mut(&mut bench).choose_by(Box::new(move |choice, _| {
        let path = paths.get(noted.borrow().len()).cloned();
        noted.borrow_mut().push(choice.clone());
        Box::pin(async { path })
    }));
    (bench, asked)
}

fn press(bench: &mut Bench, modifiers: Modifiers, key: Key) {
    bench.key_press_modifiers(modifiers, key);
    bench.run_steps(3);
}

fn choose(bench: &mut Bench, answer: &str) {
    // A modal is measured in its first frame.
    bench.run_steps(2);
    bench.get_by_label(answer).click();
    bench.run_steps(3);
}

fn pull(bench: &mut Bench, x: f64) {
    let grip = Grip {
        displacement: [x, 0.0],
        ..Grip::default()
    };
    let scene = Box::new(Scene { grip, ..small() });
    state_mut(bench).table.act(Action::Change {
        scene,
        gesture: false,
    });
    bench.step();
}

/// Has the window closed by the user; whether it stays open.
fn close(bench: &mut Bench) -> bool {
    let root = bench.input_mut().viewports.entry(ViewportId::ROOT);
    root.or_default().events.push(ViewportEvent::Close);
    bench.step();
    commands(bench).contains(&ViewportCommand::CancelClose)
}

fn commands(bench: &Bench) -> &[ViewportCommand] {
    &bench.output().viewport_output[&ViewportId::ROOT].commands
}

#[test]
fn a_sheet_is_saved_where_a_dialogue_says_and_from_then_on_without_one() {
    let folder = Folder::new("save-as");
    let path = folder.at("mine.toml");
    let (mut bench, asked) = answered(std::slice::from_ref(&path));
    pull(&mut bench, 60.0);
    assert!(state(&bench).is_changed(Tab::Sheet));
    press(&mut bench, Modifiers::COMMAND, Key::S);
    assert_eq!(*asked.borrow(), [Choice::Save("sheet.toml".to_owned())]);
    assert_eq!(
        folder.text("mine.toml"),
        state(&bench).table.scene().study()
    );
    assert!(!state(&bench).is_changed(Tab::Sheet));
    pull(&mut bench, 61.0);
    press(&mut bench, Modifiers::COMMAND, Key::S);
    assert_eq!(asked.borrow().len(), 1, "the path is known");
    assert_eq!(
        folder.text("mine.toml"),
        state(&bench).table.scene().study()
    );
    press(&mut bench, Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    assert_eq!(asked.borrow().len(), 2, "`save as …` asks anew");
}

#[test]
fn what_changes_while_a_dialogue_is_open_is_not_taken_for_saved() {
    let folder = Folder::new("meanwhile");
    let mut bench = window([1200.0, 800.0], small());
    let answer: Rc<RefCell<Option<PathBuf>>> = Rc::default();
    let awaited = Rc::clone(&answer);
    state_mut(&mut bench).choose_by(Box::new(move |_, _| {
        let awaited = Rc::clone(&awaited);
        Box::pin(poll_fn(move |_| match awaited.take() {
            Some(path) => Poll::Ready(Some(path)),
            None => Poll::Pending,
        }))
    }));
    pull(&mut bench, 60.0);
    let asked_for = state(&bench).table.scene().study();
    press(&mut bench, Modifiers::COMMAND, Key::S);
    pull(&mut bench, 61.0);
    *answer.borrow_mut() = Some(folder.at("mine.toml"));
    bench.run_steps(2);
    assert_eq!(folder.text("mine.toml"), asked_for);
    assert!(state(&bench).is_changed(Tab::Sheet));
}

#[test]
fn a_file_is_opened_by_a_dialogue_and_is_among_the_recent_ones() {
    let folder = Folder::new("open");
    let scene = Scene {
        size: [120.0, 40.0],
        ..small()
    };
    fs::write(folder.at("other.toml"), scene.study()).unwrap();
    let (mut bench, asked) = answered(&[folder.at("other.toml")]);
    state_mut(&mut bench).remember(Recent::in_list(folder.at("recent")));
    press(&mut bench, Modifiers::COMMAND, Key::O);
    assert_eq!(*asked.borrow(), [Choice::Open]);
    assert_eq!(state(&bench).table.scene().size, [120.0, 40.0]);
    assert!(!state(&bench).is_changed(Tab::Sheet));
    pull(&mut bench, 33.0);
    bench.get_by_label("file").click();
    bench.run_steps(2);
    bench.get_by_label("other.toml").click();
    bench.run_steps(2);
    assert_eq!(*state(&bench).table.scene(), scene);
    let again = Recent::in_list(folder.at("recent"));
    assert_eq!(again.paths(), [folder.at("other.toml")]);
}

#[test]
fn a_file_of_others_is_replaced_only_where_the_user_agrees() {
    let folder = Folder::new("others");
    let path = folder.at("study.toml");
    let theirs = format!("# by hand\n{}", small().study());
    fs::write(&path, &theirs).unwrap();
    let (mut bench, asked) = answered(&[]);
    state_mut(&mut bench).open_path(&path);
    pull(&mut bench, 60.0);
    for answer in ["cancel", "save as …"] {
        press(&mut bench, Modifiers::COMMAND, Key::S);
        choose(&mut bench, answer);
        assert_eq!(folder.text("study.toml"), theirs);
    }
    assert_eq!(asked.borrow().len(), 1, "another place was asked for");
    press(&mut bench, Modifiers::COMMAND, Key::S);
    choose(&mut bench, "replace");
    let ours = state(&bench).table.scene().study();
    assert_eq!(folder.text("study.toml"), ours);
    // What it has written itself it replaces, until somebody else changes it.
    pull(&mut bench, 61.0);
    press(&mut bench, Modifiers::COMMAND, Key::S);
    assert_ne!(folder.text("study.toml"), ours);
    fs::write(&path, &theirs).unwrap();
    press(&mut bench, Modifiers::COMMAND, Key::S);
    assert_eq!(folder.text("study.toml"), theirs);
}

#[test]
fn an_ending_that_is_added_to_a_name_replaces_nothing_unasked() {
    let folder = Folder::new("ending");
    fs::write(folder.at("mine.toml"), "# of others").unwrap();
    let (mut bench, _) = answered(&[folder.at("mine"), folder.at("new")]);
    press(&mut bench, Modifiers::COMMAND, Key::S);
    choose(&mut bench, "save as …");
    assert_eq!(folder.text("mine.toml"), "# of others");
    assert_eq!(folder.text("new.toml"), small().study());
}

#[test]
fn exports_of_several_files_have_a_folder_of_their_own_and_replace_nothing_unasked() {
    let folder = Folder::new("export");
    fs::create_dir_all(folder.at("sheet")).unwrap();
    fs::write(folder.at("sheet/springs.vtu"), "of others").unwrap();
    let (mut bench, asked) = answered(std::slice::from_ref(&folder.0));
    until(&mut bench, |bench| bench.table.is_settled());
    bench.get_by_label("export").click();
    bench.run_steps(2);
    bench.get_by_label("the fields as VTK …").click();
    bench.step();
    until(&mut bench, |bench| bench.message != "writing …");
    let asks = "springs.vtu is there already";
    bench.run_steps(3);
    assert_eq!(*asked.borrow(), [Choice::Folder("sheet".to_owned())]);
    assert!(bench.query_by_label_contains(asks).is_some());
    assert_eq!(folder.text("sheet/springs.vtu"), "of others");
    assert!(!folder.at("sheet/corrected.vtu").exists());
    choose(&mut bench, "replace");
    assert!(folder.text("sheet/springs.vtu").contains("<VTKFile"));
    assert!(folder.at("sheet/corrected.vtu").exists());
}

#[test]
fn a_window_with_changes_closes_only_once_the_user_has_said_what_becomes_of_them() {
    let folder = Folder::new("close");
    let (mut bench, _) = answered(&[folder.at("kept.toml")]);
    assert!(!close(&mut bench), "nothing has changed");
    pull(&mut bench, 60.0);
    assert!(close(&mut bench));
    bench.run_steps(2);
    assert!(bench.query_by_label_contains("not saved").is_some());
    choose(&mut bench, "cancel");
    assert!(!commands(&bench).contains(&ViewportCommand::Close));
    assert!(state(&bench).is_changed(Tab::Sheet));
    assert!(close(&mut bench));
    choose(&mut bench, "save");
    assert_eq!(
        folder.text("kept.toml"),
        state(&bench).table.scene().study()
    );
    assert!(commands(&bench).contains(&ViewportCommand::Close));
    assert!(!close(&mut bench));
}

#[test]
fn a_study_that_was_written_is_not_lost_to_another_one() {
    let (mut bench, _) = answered(&[]);
    state_mut(&mut bench).tab = Tab::Study;
    bench.step();
    let editor = bench.get_by_role(eframe::egui::accesskit::Role::MultilineTextInput);
    editor.focus();
    bench.step();
    bench
        .get_by_role(eframe::egui::accesskit::Role::MultilineTextInput)
        .type_text("# mine\n");
    bench.run_steps(2);
    assert!(state(&bench).is_changed(Tab::Study));
    let motion = include_bytes!("../../examples/released_plate.toml");
    for (answer, is_mine) in [("cancel", true), ("discard", false)] {
        state_mut(&mut bench).open("motion.toml", motion);
        bench.step();
        choose(&mut bench, answer);
        assert_eq!(state(&bench).studies.text.contains("# mine"), is_mine);
    }
    assert!(!state(&bench).is_changed(Tab::Study));
}

#[test]
fn a_desktop_without_dialogues_says_what_is_missing() {
    let (mut bench, _) = answered(&[]);
    press(&mut bench, Modifiers::COMMAND, Key::O);
    let message = &state(&bench).message;
    assert!(message.contains("xdg-desktop-portal"), "{message}");
}

#[test]
fn keys_in_the_view_of_studies_save_and_take_back_nothing_of_the_sheet() {
    let folder = Folder::new("keys");
    let (mut bench, asked) = answered(&[folder.at("study.toml"), folder.at("sheet.toml")]);
    pull(&mut bench, 60.0);
    let pulled = state(&bench).table.scene().clone();
    state_mut(&mut bench).tab = Tab::Study;
    bench.step();
    for key in [Key::Z, Key::S] {
        press(&mut bench, Modifiers::COMMAND, key);
    }
    assert_eq!(*state(&bench).table.scene(), pulled);
    assert_eq!(folder.text("study.toml"), state(&bench).studies.text);
    state_mut(&mut bench).tab = Tab::Sheet;
    bench.step();
    for key in [Key::Z, Key::S] {
        press(&mut bench, Modifiers::COMMAND, key);
    }
    assert_eq!(*state(&bench).table.scene(), small());
    assert_eq!(asked.borrow().len(), 2);
    assert!(Path::new(&folder.at("sheet.toml")).exists());
}
