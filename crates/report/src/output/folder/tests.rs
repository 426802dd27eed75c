use tempfile::TempDir;

use super::manifest::MANIFEST;
use super::*;

fn run(folder: &Path, inputs: &[&Path], files: &[(&str, &str)]) -> Result<Vec<PathBuf>, Error> {
    let mut results = ResultFolder::open(folder, "run", inputs)?;
    for (name, text) in files {
        results.add(name, text.as_bytes())?;
    }
    results.finish()
}

fn names(folder: &Path) -> Vec<String> {
    let mut files = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy();
                files.push(name.replace('\\', "/"));
            }
        }
    }
    files.sort();
    files
}

#[test]
fn a_file_of_somebody_else_is_kept_under_another_name() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    fs::write(path.join("report.md"), "mine").unwrap();
    fs::write(path.join("report.md.kept"), "mine too").unwrap();
    let mut results = ResultFolder::open(path, "run", &[]).unwrap();
    results.add("report.md", b"1").unwrap();
    results.add("force.png", b"1").unwrap();
    let warnings = results.in_the_way();
    assert_eq!(warnings.len(), 1);
    assert!(
        warnings[0].message.ends_with("report.md.kept-2"),
        "{warnings:?}"
    );
    assert!(results.in_the_way().is_empty());
    results.finish().unwrap();
    run(path, &[], &[("report.md", "2")]).unwrap();
    let read = |name: &str| fs::read_to_string(path.join(name)).unwrap();
    assert_eq!(read("report.md"), "2");
    assert_eq!(read("report.md.kept"), "mine too");
    assert_eq!(read("report.md.kept-2"), "mine");
}

#[test]
fn only_what_an_earlier_run_has_written_is_removed() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    fs::write(path.join("plates_2024.png"), "mine").unwrap();
    fs::write(path.join("markers_7.csv"), "mine").unwrap();
    let first = [
        ("report.md", "1"),
        ("vtk/a_001.vtu", "1"),
        ("vtk/a_002.vtu", "1"),
    ];
    run(path, &[], &first).unwrap();
    let written = run(path, &[], &[("report.md", "2"), ("vtk/a_001.vtu", "2")]).unwrap();
    assert_eq!(
        written,
        [path.join("report.md"), path.join("vtk/a_001.vtu")]
    );
    let expected = [
        MANIFEST,
        "markers_7.csv",
        "plates_2024.png",
        "report.md",
        "vtk/a_001.vtu",
    ];
    assert_eq!(names(path), expected);
    assert_eq!(fs::read_to_string(path.join("report.md")).unwrap(), "2");
}

#[test]
fn what_another_command_has_written_stays() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    run(path, &[], &[("report.md", "1"), ("a.csv", "1")]).unwrap();
    let mut other = ResultFolder::open(path, "compare", &[]).unwrap();
    other.add("differences.md", b"2").unwrap();
    other.finish().unwrap();
    run(path, &[], &[("report.md", "3")]).unwrap();
    assert_eq!(names(path), [MANIFEST, "differences.md", "report.md"]);
}

#[test]
fn an_input_is_neither_replaced_nor_removed() {
    let folder = TempDir::new().unwrap();
    let input = folder.path().join("a.toml");
    fs::write(&input, "study").unwrap();
    let refused = run(folder.path(), &[&input], &[("b.md", ""), ("a.toml", "law")]);
    assert!(refused.unwrap_err().to_string().contains("is an input"));
    assert_eq!(fs::read_to_string(&input).unwrap(), "study");
    assert_eq!(names(folder.path()), ["a.toml"]);
    // A table that another command has written may be what this one reads; one of its own it would replace.
    let table = folder.path().join("nodes.csv");
    run(folder.path(), &[], &[("nodes.csv", "1")]).unwrap();
    let refused = run(folder.path(), &[&table], &[("report.md", "2")]).unwrap_err();
    assert!(refused.to_string().contains("is an input"), "{refused}");
    let mut other = ResultFolder::open(folder.path(), "compare", &[&table]).unwrap();
    other.add("differences.md", b"3").unwrap();
    other.finish().unwrap();
    assert_eq!(fs::read_to_string(&table).unwrap(), "1");
}

#[test]
fn a_run_that_does_not_end_leaves_the_results_before_it_as_they_were() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("results");
    drop(ResultFolder::open(&path, "run", &[]).unwrap());
    assert!(!path.exists(), "nothing was written");
    run(&path, &[], &[("report.md", "1")]).unwrap();
    let mut second = ResultFolder::open(&path, "run", &[]).unwrap();
    second.add("report.md", b"2").unwrap();
    assert_eq!(fs::read_to_string(path.join("report.md")).unwrap(), "1");
    // As a kill leaves it: the partial folder stays until the next run.
    let partial = path.join(format!("{PARTIAL}left"));
    fs::rename(&second.unfinished.partial, &partial).unwrap();
    drop(second);
    assert!(partial.exists());
    run(&path, &[], &[("report.md", "3")]).unwrap();
    assert_eq!(names(&path), [MANIFEST, "report.md"]);
    assert_eq!(fs::read_to_string(path.join("report.md")).unwrap(), "3");
}

#[test]
fn two_runs_do_not_write_into_one_folder_at_once() {
    let folder = TempDir::new().unwrap();
    let first = ResultFolder::open(folder.path(), "run", &[]).unwrap();
    let second = ResultFolder::open(folder.path(), "run", &[]).unwrap_err();
    assert!(second.to_string().contains("another run"), "{second}");
    drop(first);
    ResultFolder::open(folder.path(), "run", &[]).unwrap();
}

#[test]
fn a_folder_that_is_taken_away_meanwhile_is_made_anew() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("results");
    let mut results = ResultFolder::open(&path, "run", &[]).unwrap();
    results.add("a.md", b"1").unwrap();
    fs::remove_dir_all(&path).unwrap();
    results.add("b.md", b"2").unwrap();
    let fault = results.finish().unwrap_err();
    assert!(fault.to_string().contains("a.md"), "{fault}");
}

#[test]
fn a_manifest_that_leads_out_of_its_folder_removes_nothing() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("results");
    fs::create_dir(&path).unwrap();
    fs::write(folder.path().join("mine.txt"), "mine").unwrap();
    let forged =
        r#"{"gelbench":"0","complete":true,"files":{"../mine.txt":"run","/etc/none":"run"}}"#;
    fs::write(path.join(MANIFEST), forged).unwrap();
    run(&path, &[], &[("report.md", "1")]).unwrap();
    assert!(folder.path().join("mine.txt").exists());
    fs::write(path.join(MANIFEST), "{ half").unwrap();
    run(&path, &[], &[("other.md", "1")]).unwrap();
    assert!(path.join("report.md").exists());
}

#[test]
fn a_set_that_was_killed_while_it_moved_is_finished_by_the_next_run() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    run(path, &[], &[("a.md", "1"), ("b.md", "1"), ("old.md", "1")]).unwrap();
    let partial = format!("{PARTIAL}killed");
    fs::create_dir(path.join(&partial)).unwrap();
    fs::write(path.join("a.md"), "2").unwrap();
    fs::write(path.join(&partial).join("b.md"), "2").unwrap();
    let files = ["a.md", "b.md", "old.md"].map(|name| (name.to_owned(), "run".to_owned()));
    let moving = Moving {
        from: partial,
        files: vec!["a.md".into(), "b.md".into()],
        stale: vec!["old.md".into()],
    };
    let mut manifest = Locked::open(path).unwrap();
    let moved = Manifest {
        files: files.into(),
        moving: Some(moving),
        ..Manifest::default()
    };
    manifest.write(&moved).unwrap();
    drop(manifest);
    // Whatever becomes of the next run itself.
    drop(ResultFolder::open(path, "compare", &[]).unwrap());
    assert_eq!(names(path), [MANIFEST, "a.md", "b.md"]);
    assert_eq!(fs::read_to_string(path.join("b.md")).unwrap(), "2");
    let settled = Locked::open(path).unwrap().read();
    assert!(settled.complete);
    let listed: Vec<&String> = settled.files.keys().collect();
    assert_eq!(listed, ["a.md", "b.md"]);
}

#[test]
fn work_that_was_broken_off_goes_on_where_it_was_with_the_same_identity_only() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    let begin = |identity| ResultFolder::resume(path, "correct", &[], identity).unwrap();
    let mut first = begin("1");
    first.add("a.csv", b"1").unwrap();
    first.keep("1", &"one".to_owned()).unwrap();
    first.add("b.csv", b"half").unwrap();
    assert_eq!(first.unfinished().break_off().remains, Remains::Parts);
    drop(first);
    let mut second = begin("1");
    assert_eq!(second.kept("1"), Some("one".to_owned()));
    assert_eq!(second.kept::<String>("2"), None);
    second.add("b.csv", b"2").unwrap();
    second.finish().unwrap();
    assert_eq!(names(path), [MANIFEST, "a.csv", "b.csv"]);
    let mut third = begin("1");
    third.keep("1", &"one".to_owned()).unwrap();
    assert_eq!(third.unfinished().break_off().remains, Remains::Parts);
    drop(third);
    assert_eq!(begin("2").kept::<String>("1"), None);
    assert_eq!(names(path), [MANIFEST, "a.csv", "b.csv"]);
}

#[test]
fn a_file_of_somebody_else_is_kept_by_work_that_goes_on_too() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    fs::write(path.join("a.csv"), "mine").unwrap();
    let begin = || ResultFolder::resume(path, "correct", &[], "1").unwrap();
    let mut first = begin();
    first.add("a.csv", b"1").unwrap();
    first.keep("1", &()).unwrap();
    first.unfinished().break_off();
    drop(first);
    let mut second = begin();
    assert!(second.kept::<()>("1").is_some());
    assert_eq!(second.in_the_way().len(), 1);
    second.finish().unwrap();
    assert_eq!(fs::read_to_string(path.join("a.csv.kept")).unwrap(), "mine");
}

#[test]
fn nothing_is_written_into_what_was_broken_off() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    for file in 0..20 {
        let mut results = ResultFolder::open(path, "run", &[]).unwrap();
        let unfinished = results.unfinished();
        let writer = std::thread::spawn(move || {
            for number in 0.. {
                if let Err(fault) = results.add(&format!("vtk/{number}.vtu"), &[0; 1 << 16]) {
                    return fault.to_string();
                }
            }
            unreachable!()
        });
        while !unfinished.partial.join(format!("vtk/{file}.vtu")).exists() {
            std::thread::yield_now();
        }
        assert_eq!(unfinished.break_off().remains, Remains::Nothing);
        assert!(writer.join().unwrap().contains("interrupted"));
        assert!(!path.exists(), "{:?}", names(path));
    }
}

#[test]
fn results_that_are_in_place_stay_when_their_run_is_broken_off() {
    let folder = TempDir::new().unwrap();
    let mut results = ResultFolder::open(folder.path(), "run", &[]).unwrap();
    results.add("a.csv", b"1").unwrap();
    let unfinished = results.unfinished();
    results.finish().unwrap();
    assert_eq!(unfinished.break_off().remains, Remains::Results);
    assert_eq!(names(folder.path()), [MANIFEST, "a.csv"]);
}

#[test]
fn results_of_another_study_and_files_of_another_command_are_told_before_they_are_replaced() {
    let folder = TempDir::new().unwrap();
    let [path, a, b] = ["out", "a.toml", "b.toml"].map(|name| folder.path().join(name));
    fs::write(&a, "a").unwrap();
    fs::write(&b, "b").unwrap();
    let open = |input: &Path, writer: &str| ResultFolder::open(&path, writer, &[input]).unwrap();
    let message = |input: &Path, writer: &str| {
        open(input, writer)
            .replaces()
            .map(|warning| warning.message)
    };
    assert_eq!(message(&a, "run"), None);
    run(&path, &[&a], &[("report.md", "1")]).unwrap();
    assert_eq!(message(&a, "run"), None);
    assert!(message(&b, "run").unwrap().contains("a.toml"));
    assert_eq!(message(&b, "sweep"), None);
    let mut sweep = open(&a, "sweep");
    sweep.add("report.md", b"2").unwrap();
    let others = sweep.in_the_way();
    assert!(
        others[0].message.contains("of `gelbench run`"),
        "{others:?}"
    );
    drop(sweep);
    // A study that has got another name is the same one.
    fs::rename(&a, folder.path().join("c.toml")).unwrap();
    assert_eq!(message(&b, "run"), None);
}
