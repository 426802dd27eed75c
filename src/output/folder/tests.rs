use super::*;

fn run(folder: &Path, inputs: &[&Path], files: &[(&str, &str)]) -> Result<Vec<PathBuf>, Error> {
    let mut results = ResultFolder::open(folder, "run", inputs)?;
    for (name, text) in files {
        results.add(name, text.as_bytes())?;
    }
    results.finish()
}

fn names(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy();
                found.push(name.replace('\\', "/"));
            }
        }
    }
    found.sort();
    found
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
    // A table that one run has written may be what the next one reads.
    run(folder.path(), &[], &[("nodes.csv", "1")]).unwrap();
    let table = folder.path().join("nodes.csv");
    run(folder.path(), &[&table], &[("report.md", "2")]).unwrap();
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
    let partial = second.partial.take().unwrap().keep();
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
