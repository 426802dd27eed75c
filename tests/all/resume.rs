//! Long work that was broken off goes on where it was, and its results are the same bytes.
#![cfg(unix)]

use std::cell::{Cell, RefCell};
use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

use gelbench::budget::Budget;
use gelbench::kinds;
use gelbench::solve::{Journal, Milestone};
use gelbench::studies::Progress;

use crate::common::process::*;

/// Equilibria of all paths in the order in which they were found.
#[derive(Default)]
struct Notes {
    before: RefCell<Vec<(usize, Milestone)>>,
    paths: Cell<usize>,
    milestones: RefCell<Vec<(usize, Milestone)>>,
}

impl Journal for Notes {
    fn begin(&self) -> Vec<Milestone> {
        let path = self.paths.replace(self.paths.get() + 1);
        let mut before = self.before.borrow_mut();
        let milestones = before.extract_if(.., |(of, _)| *of == path);
        milestones.map(|(_, milestone)| milestone).collect()
    }

    fn keep(&self, milestone: Milestone) {
        self.milestones
            .borrow_mut()
            .push((self.paths.get() - 1, milestone));
    }
}

/// What a study finds, but for times, and what it has kept.
fn computed(study: &Path, before: &[(usize, Milestone)]) -> (String, Vec<(usize, Milestone)>) {
    let notes = Notes {
        before: RefCell::new(before.to_vec()),
        ..Notes::default()
    };
    let ready = kinds::read(study, Budget::default()).unwrap();
    let mut outcome = ready
        .compute(Progress::silent().kept_by(&notes))
        .unwrap()
        .outcome;
    outcome.times.clear();
    outcome.blocks.clear();
    assert!(
        notes.before.borrow().is_empty(),
        "all that was kept is taken"
    );
    (format!("{outcome:?}"), notes.milestones.into_inner())
}

/// A plate far stretched, a hole under shear, local refinement, and a force whose steps are cut.
const STUDIES: [(&str, &str); 4] = [
    (
        "plate",
        "[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\ncells = [6, 2]\n[material]\ncard = \"pva-10\"\n[load]\n\
      stretches = [\"400 %\", \"500 %\", \"520 %\"]\n[finite_element]\ncells = [4, 4]\n[output]\nplots = false\n",
    ),
    (
        "hole",
        "kind = \"specimen\"\n[material]\ncard = \"pva-10\"\n[specimen]\nshape = \"strip-with-hole\"\n\
      length = \"40 mm\"\nwidth = \"20 mm\"\nhole_diameter = \"8 mm\"\nthickness = \"1 mm\"\ncells = 2\n[[support]]\n\
      group = \"left\"\nkind = \"clamp\"\n[[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"60 mm\"\n\
      y = \"40 mm\"\n[path]\nfactors = [0.5, 1]\nmeasured_group = \"right\"\n",
    ),
    (
        "refined",
        "kind = \"specimen\"\n[material]\ncard = \"neo-hooke\"\n[specimen]\nshape = \"dog-bone\"\nlength = \"90 mm\"\nwidth = \"30 mm\"\nnarrow_length = \"30 mm\"\nnarrow_width = \"15 mm\"\nshoulder_length = \"15 mm\"\nthickness = \"1 mm\"\n\
      cells = 2\n[finite_element]\nelement = \"T2\"\nadaptive = true\nerror = \"1 %\"\n[[support]]\ngroup = \"left\"\n\
      kind = \"clamp\"\n[[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"10 mm\"\ny = \"0 mm\"\n[path]\n\
      factors = [0.5, 1]\nmeasured_group = \"right\"\n",
    ),
    (
        "pushed",
        "kind = \"specimen\"\n[material]\ncard = \"pva-10\"\n[specimen]\nshape = \"strip\"\nlength = \"40 mm\"\n\
      width = \"10 mm\"\nthickness = \"1 mm\"\ncells = 2\n[[support]]\ngroup = \"left\"\nkind = \"clamp\"\n[[support]]\n\
      group = \"right\"\nkind = \"grip\"\nx_force = \"80 N\"\ny = \"40 mm\"\n[path]\nfactors = [0.1, 0.2, 1]\nmeasured_group = \"right\"\n",
    ),
];

#[test]
fn a_computation_goes_on_from_any_equilibrium_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in STUDIES {
        let study = folder.path().join(format!("{name}.toml"));
        fs::write(&study, text).unwrap();
        let (full, milestones) = computed(&study, &[]);
        assert!(milestones.len() >= 6, "{name}: {}", milestones.len());
        for kept in (0..=milestones.len()).step_by(2) {
            let (gone_on, rest) = computed(&study, &milestones[..kept]);
            assert_eq!(rest, milestones[kept..], "{name}, {kept} kept");
            assert!(gone_on == full, "{name}, {kept} kept");
        }
    }
}

/// A plate whose finite elements take some seconds.
const LONG: &str = "[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\ncells = [6, 2]\n[material]\ncard = \"pva-10\"\n[load]\n\
    stretches = [\"3 %\", \"6 %\", \"9 %\", \"12 %\", \"15 %\", \"18 %\", \"21 %\", \"24 %\", \"27 %\", \"30 %\"]\n[finite_element]\ncells = [100, 52]\n\
    [output]\nplots = false\n";

#[test]
fn a_run_goes_on_where_it_was_broken_off() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("l"));
    fs::write(folder.join("long.toml"), LONG).unwrap();
    let command = "run long.toml --output l";
    run(folder, command);
    let complete = results(output);
    fs::remove_dir_all(output).unwrap();
    let kept = || first_partial(output).is_some_and(|partial| partial.join(".parts/0").exists());
    // A run keeps nothing within its first two seconds: it sleeps through them. It sleeps again once it has kept something; on a busy machine
    // it may have ended by then, and another one is started.
    let started = || {
        for _ in 0..10 {
            let mut child = start(folder, command);
            wait_for(|| partial(output));
            send(&child, Signal::SIGSTOP);
            thread::sleep(Duration::from_secs(2));
            send(&child, Signal::SIGCONT);
            wait_for(kept);
            send(&child, Signal::SIGSTOP);
            thread::sleep(Duration::from_millis(20));
            if kept() && child.try_wait().unwrap().is_none() {
                return child;
            }
            send(&child, Signal::SIGCONT);
            child.wait().unwrap();
            fs::remove_dir_all(output).unwrap();
        }
        panic!("every run ended before it was broken off");
    };
    for interrupt in [true, false] {
        let mut child = started();
        if interrupt {
            send(&child, Signal::SIGINT);
            send(&child, Signal::SIGCONT);
            let ended = child.wait_with_output().unwrap();
            assert_ends(&ended, 130, "the same command continues from here");
        } else {
            child.kill().unwrap();
            child.wait().unwrap();
        }
        assert!(kept());
        let ended = run(folder, command);
        assert!(
            output_text(&ended).contains("continues from"),
            "{}",
            output_text(&ended)
        );
        assert_eq!(results(output), complete);
        assert!(!partial(output));
    }
    // Another study is another run.
    let mut child = started();
    child.kill().unwrap();
    child.wait().unwrap();
    fs::write(folder.join("long.toml"), LONG.replace("30 %", "31 %")).unwrap();
    let ended = run(folder, command);
    assert!(
        !output_text(&ended).contains("continues from"),
        "{}",
        output_text(&ended)
    );
    assert_ne!(results(output), complete);
}

#[test]
fn a_correction_of_frames_goes_on_where_it_was_broken_off() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("c"));
    run(folder, CORRECT);
    let complete = results(output);
    assert_eq!(complete.len(), 4 * 5 + 3 + 1 + 12, "{:?}", complete.keys());
    fs::remove_dir_all(output).unwrap();

    let first = |of: &str| first_partial(output).map(|partial| partial.join(of));
    let is_done = |frame: &str| first(&format!(".parts/{frame}")).is_some_and(|part| part.exists());
    let kill_after = |frame: &str| {
        let mut child = start(folder, CORRECT);
        wait_for(|| is_done(frame));
        child.kill().unwrap();
        child.wait().unwrap();
    };
    kill_after("2");
    let modified = |path: &Path| fs::metadata(path).unwrap().modified().unwrap();
    let early = modified(&first("nodes_001.csv").unwrap());
    run(folder, CORRECT);
    assert_eq!(
        modified(&output.join("nodes_001.csv")),
        early,
        "the first frame is not done again"
    );
    assert_eq!(results(output), complete);
    assert!(!partial(output));

    // Other markers are another correction.
    kill_after("2");
    let changed = markers(4).replacen("0.0100", "0.0150", 1);
    fs::write(folder.join("m.csv"), changed).unwrap();
    run(folder, CORRECT);
    assert_ne!(results(output)["nodes_001.csv"], complete["nodes_001.csv"]);
    assert_ne!(
        results(output)["markers_001.csv"],
        complete["markers_001.csv"]
    );
    assert!(!partial(output));

    let child = start(folder, &CORRECT.replace("c.csv", "m.csv"));
    wait_for(|| is_done("1"));
    send(&child, Signal::SIGINT);
    assert_ends(
        &child.wait_with_output().unwrap(),
        130,
        "the same command continues from here",
    );
    assert!(is_done("1"));
}
