//! Kills, full disks, closed outputs and other misfortunes: results are those of the run before or those of this one, whole,
//! and the next run succeeds.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::common::process::*;

/// What the folder of a run that ends here holds: whether its files are all in place. Where they are, they are one of the
/// whole sets and those that the manifest lists; where they are not, those on their way and those in place are.
#[track_caller]
fn assert_nothing_is_lost(folder: &Path, sets: &[(&str, BTreeMap<String, Vec<u8>>)]) -> bool {
    let manifest = manifest(folder);
    let mut remaining = results(folder);
    let Some(moving) = manifest["moving"].as_object() else {
        assert_eq!(manifest["complete"], true);
        let listed = manifest["files"].as_object().unwrap().keys();
        let there = files(folder);
        let there = there.keys().filter(|name| *name != MANIFEST);
        assert!(listed.eq(there), "the manifest lists what is there");
        assert!(
            sets.iter().any(|(_, set)| *set == remaining),
            "{:?}",
            remaining.keys()
        );
        return true;
    };
    let aside = folder.join(moving["from"].as_str().unwrap());
    for stale in moving["stale"].as_array().unwrap() {
        remaining.remove(stale.as_str().unwrap());
    }
    remaining.extend(results(&aside));
    assert!(
        sets.iter().any(|(_, set)| *set == remaining),
        "{:?}",
        remaining.keys()
    );
    false
}

/// Lets a process go on for a moment, a short one or one of a millisecond; false once it has ended.
fn goes_on(child: &mut Child, short: bool) -> bool {
    let (id, pause) = (child.id(), if short { "" } else { "sleep 0.001;" });
    let script = format!(
        "kill -CONT {id}; {pause} kill -STOP {id}; until ps -o state= -p {id} | grep -q '[TZ]'; do :; done"
    );
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).stderr(Stdio::null());
    shell.status().unwrap();
    child.try_wait().unwrap().is_none()
}

#[test]
fn a_run_killed_at_any_moment_leaves_the_old_results_or_the_new_ones() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("o"));
    let sets = ["b", "a"].map(|study| {
        run(folder, &format!("run {study}.toml --output o"));
        (study, results(output))
    });
    assert_ne!(sets[0].1.len(), sets[1].1.len());
    let mut in_transit = 0;
    for moment in 0..30 {
        let (new, _) = sets[moment % 2];
        let mut child = start(folder, &format!("run {new}.toml --output o"));
        // The first of the moments pass while it computes and writes; the others while it moves its files into place.
        let written =
            || first_partial(output).is_some_and(|aside| aside.join("report.md").exists());
        let mut steps = 8 * moment;
        while steps > 0 && goes_on(&mut child, written()) {
            in_transit += usize::from(!assert_nothing_is_lost(output, &sets));
            steps -= usize::from(moment < 10 || written());
        }
        let _ = child.kill();
        child.wait().unwrap();
        assert_nothing_is_lost(output, &sets);
    }
    assert!(
        in_transit > 0,
        "no moment fell between the first file and the last"
    );
    for (study, set) in &sets {
        run(folder, &format!("run {study}.toml --output o"));
        assert_eq!(results(output), *set);
        assert!(assert_nothing_is_lost(output, &sets));
        assert!(!partial(output), "leftovers are swept");
    }
}

/// A fit on a disk that takes the card, but not the picture.
#[test]
fn a_fit_is_written_as_a_whole_or_not_at_all() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("f"));
    let data = crate::common::root().join("materials/data/pva_10_uniaxial.csv");
    let data = data.display();
    let fit = |law: &str| format!("materials fit {data} --law {law} --name gel --output f");
    run(folder, &fit("yeoh"));
    let before = files(output);
    assert_eq!(before.len(), 4, "{:?}", before.keys());
    let other = fit("gent");
    let ended = shell(
        folder,
        &format!("trap '' XFSZ; ulimit -f 24; \"$G\" {other}"),
    );
    assert_ends(&ended, 4, "cannot write f/gel.png");
    assert_eq!(files(output), before);
    run(folder, &other);
    let after = files(output);
    for ending in ["toml", "json", "png"] {
        let name = format!("gel.{ending}");
        assert_ne!(after[&name], before[&name], "{name}");
    }
}

#[test]
fn an_interrupt_ends_with_130_and_leaves_nothing_of_the_run() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("o"));
    let interrupted = |arguments: &str, ready: &dyn Fn() -> bool| {
        let child = start(folder, arguments);
        wait_for(ready);
        send(&child, Signal::SIGINT);
        child.wait_with_output().unwrap()
    };
    let ended = interrupted("run b.toml --output o", &|| partial(output));
    assert_ends(&ended, 130, "nothing of this run is kept");
    assert!(!output.exists(), "{:?}", files(output).keys());
    run(folder, "run a.toml --output o");
    let before = files(output);
    let ended = interrupted("run b.toml --output o", &|| partial(output));
    assert_ends(&ended, 130, "results of earlier runs are unchanged");
    assert_eq!(files(output), before);
    assert!(!partial(output));
}

#[test]
fn a_full_disk_leaves_the_results_before_it() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("o"));
    run(folder, "run a.toml --output o");
    let before = files(output);
    // Files end at 4 blocks, by a signal or, where it is ignored, by a fault of writing.
    let ended = shell(
        folder,
        "trap '' XFSZ; ulimit -f 4; \"$G\" run b.toml --output o",
    );
    assert_ends(&ended, 4, "cannot write o/");
    assert_eq!(files(output), before);
    assert!(!partial(output));
    let ended = shell(folder, "ulimit -f 4; \"$G\" run b.toml --output o");
    assert_ne!(ended.status.code(), Some(0));
    assert_eq!(files(output), before);
    run(folder, "run a.toml --output o");
    assert_eq!(results(output).len(), before.len() - 4);
    assert!(!partial(output));
    let ended = shell(
        folder,
        "trap '' XFSZ; ulimit -f 4; \"$G\" materials plot neo-hooke --output p.png",
    );
    assert_ends(&ended, 4, "cannot write p.png");
    assert!(!folder.join("p.png").exists());
}

#[test]
fn closed_outputs_are_no_reason_to_lose_results() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("o"));
    run(folder, "run a.toml --output whole");
    let complete = results(&folder.join("whole"));
    for closed in [">&- 2>&-", "| true", "2>/dev/full"] {
        shell(folder, &format!("\"$G\" run a.toml --output o {closed}"));
        assert_eq!(results(output), complete, "{closed}");
        fs::remove_dir_all(output).unwrap();
    }
    let ended = shell(folder, "\"$G\" run a.toml --output o >/dev/full");
    assert_ends(&ended, 4, "standard output");
    assert_eq!(results(output), complete);
}

#[test]
fn places_that_take_no_files_are_told_before_anything_is_computed() {
    let position = workplace();
    let folder = position.path();
    let ended = run(folder, "run a.toml --output /proc/gelbench");
    assert_ends(&ended, 4, "cannot write /proc/gelbench");
    let closed = folder.join("closed");
    fs::create_dir_all(closed.join("vtk")).unwrap();
    shell(folder, "chmod a-w closed/vtk");
    if fs::write(closed.join("vtk/probe"), "").is_ok() {
        eprintln!("skipped: this user may write into read-only folders");
        return;
    }
    let ended = run(folder, "run a.toml --output closed");
    assert_ends(&ended, 4, "cannot write closed/vtk");
}

#[test]
fn a_second_run_into_a_folder_is_refused_and_the_first_is_whole() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("o"));
    let first = start(folder, "run b.toml --output o");
    wait_for(|| partial(output));
    let second = run(folder, "run a.toml --output o");
    assert_ends(&second, 4, "another run is writing into this folder");
    assert_ne!(first.wait_with_output().unwrap().status.code(), Some(4));
    assert_complete(output);
    assert!(output.join("vtk/corrected_002.vtu").exists());
}

#[test]
fn a_folder_taken_away_during_a_run_is_told_or_made_anew() {
    let position = workplace();
    let (folder, output) = (position.path(), &position.path().join("o"));
    let child = start(folder, "run b.toml --output o");
    wait_for(|| partial(output));
    let _ = fs::remove_dir_all(output);
    let ended = child.wait_with_output().unwrap();
    let code = ended.status.code();
    assert!(
        matches!(code, Some(0 | 1 | 4)),
        "{code:?} {}",
        output_text(&ended)
    );
    if code != Some(4) {
        assert_complete(output);
    }
    assert_ne!(run(folder, "run b.toml --output o").status.code(), Some(4));
    assert_complete(output);
}

/// A study on a mesh of an earlier run's results, and a `.pvd` whose parts would be replaced.
#[test]
fn no_command_writes_over_a_file_that_it_has_read() {
    let position = workplace();
    let folder = position.path();
    run(folder, "run a.toml --output o");
    let study = "kind = \"specimen\"\ntitle = \"own\"\n[material]\ncard = \"neo-hooke\"\n[specimen]\nshape = \"mesh\"\n\
        file = \"o/vtk/finite_element_001.vtu\"\nfile_unit = \"mm\"\nthickness = \"2 mm\"\n[path]\nfactors = [0.1]\n\
        measured_group = \"left\"\n[[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"1 mm\"\ny = \"0 mm\"\n";
    fs::write(folder.join("own.toml"), study).unwrap();
    let card = "card.toml";
    let shipped = crate::common::root().join("materials/neo-hooke.toml");
    fs::copy(shipped, folder.join(card)).unwrap();
    let before = files(folder);
    let correct = "correct o/vtk/corrected.pvd --material neo-hooke --thickness 2mm --output";
    for (arguments, input) in [
        (
            "run own.toml --output o".to_owned(),
            "finite_element_001.vtu",
        ),
        (
            "export own.toml --to calculix --output o/vtk/finite_element_001.vtu".to_owned(),
            "finite_element_001.vtu",
        ),
        (format!("{correct} o"), "corrected_001.vtu"),
        (
            "export a.toml --to calculix --output a.toml".to_owned(),
            "a.toml",
        ),
        (format!("materials plot ./{card} --output {card}"), card),
        (
            format!("materials compare {card} neo-hooke --output ./{card}"),
            card,
        ),
    ] {
        let ended = run(folder, &arguments);
        let message = output_text(&ended);
        let spared = before
            .iter()
            .all(|(name, bytes)| fs::read(folder.join(name)).ok().as_ref() == Some(bytes));
        assert!(spared, "{arguments}: {message}");
        assert!(
            message.contains("is an input of this command") && message.contains(input),
            "{arguments}: {message}"
        );
        assert_eq!(ended.status.code(), Some(4), "{arguments}: {message}");
    }
}
