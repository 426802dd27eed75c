//! Every command of the README and of the guide, as written and in order, prints what stands below it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

use crate::common::{root, words};

/// Commands that are not run at all, and why.
const NOT_RUN: &[(&str, &str)] = &[
    ("cargo test", "runs this test"),
    (
        "cargo run",
        "opens the workbench, which has tests of its own",
    ),
    (
        "pip install",
        "builds gelbench for Python, which python/check does",
    ),
    (
        "cargo bench",
        "measures times for minutes, with 7 GB of memory",
    ),
    (
        "gelbench validate",
        "redoes all claims in three quarters of an hour; tests/all/validation.rs runs the cases",
    ),
];

/// Commands that take longer than about 20 s in a build without optimisation, and why.
const SLOW: &[(&str, &str)] = &[
    ("gelbench sweep", "computes whole studies"),
    ("gelbench run", "computes a whole study in three models"),
    (
        "gelbench materials group",
        "fits a law to each of several sheets on rakes",
    ),
    ("gelbench compare", "solves the study in three models"),
    (
        "ccx",
        "is another program, and computes what `compare` takes",
    ),
];

/// What commands with a word in them need besides gelbench and the programs of every system.
const PROGRAMS: &[(&str, &str)] = &[("dog_bone_calculix", "ccx")];

/// A command of a document, or lines that a document shows of what was printed.
#[derive(Debug)]
enum Part {
    Command(String),
    Printed(Vec<String>),
}

/// The commands in blocks of the shell and in tables, and the blocks of text after them.
fn parts(text: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let block = |lines: &mut std::str::Lines| -> Vec<String> {
            lines
                .take_while(|line| *line != "```")
                .map(str::to_owned)
                .collect()
        };
        match line {
            "```sh" => {
                let text = block(&mut lines).join("\n").replace("\\\n", " ");
                let text = text.replace("cargo run --release -- ", "gelbench ");
                let commands = text.lines().map(|line| Part::Command(line.to_owned()));
                parts.extend(commands);
            }
            "```text" => parts.push(Part::Printed(block(&mut lines))),
            row if row.starts_with('|') => {
                let code = row.split('`').skip(1).step_by(2);
                let commands = code.filter(|code| is_command(code));
                parts.extend(commands.map(|code| Part::Command(code.to_owned())));
            }
            _ => {}
        }
    }
    parts
}

fn is_command(code: &str) -> bool {
    ["gelbench ", "cargo bench"]
        .iter()
        .any(|begin| code.starts_with(begin))
}

/// The README, then the pages of the guide in the order of their table.
fn documents() -> Vec<PathBuf> {
    let guide = fs::read_to_string(root().join("src/guide.rs")).unwrap();
    let pages = guide
        .lines()
        .filter_map(|line| line.split_once("include_str!(\"guide/"));
    let pages = pages.filter_map(|(_, page)| page.split_once('"'));
    let pages = pages.map(|(page, _)| root().join("src/guide").join(page));
    std::iter::once(root().join("README.md"))
        .chain(pages)
        .collect()
}

fn listed(command: &str, list: &[(&str, &str)]) -> bool {
    list.iter().any(|(begin, _)| command.starts_with(begin))
}

/// A copy of what the commands read, with the program on its path.
fn workplace() -> TempDir {
    let folder = TempDir::new().unwrap();
    for part in [
        "examples",
        "materials",
        "materials/data",
        "validation",
        "validation/plate",
        "validation/measured/rakes",
        "validation/measured/tissue_biaxial",
    ] {
        fs::create_dir_all(folder.path().join(part)).unwrap();
        for entry in fs::read_dir(root().join(part)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                fs::copy(
                    &path,
                    folder.path().join(part).join(path.file_name().unwrap()),
                )
                .unwrap();
            }
        }
    }
    folder
}

/// Runs a line of a shell; returns what it prints.
fn run(folder: &Path, line: &str) -> String {
    let program = assert_cmd::cargo::cargo_bin("gelbench");
    let others = std::env::var("PATH").unwrap();
    let path = format!("{}:{others}", program.parent().unwrap().display());
    let done = Command::new("sh")
        .args(["-c", line])
        .current_dir(folder)
        .env("PATH", path)
        .output();
    let done = done.unwrap();
    let printed = words(&done.stdout);
    assert!(
        done.status.success(),
        "{line}\n{printed}{}",
        words(&done.stderr)
    );
    printed
}

fn is_installed(program: &str) -> bool {
    Command::new("sh")
        .args(["-c", &format!("command -v {program}")])
        .output()
        .unwrap()
        .status
        .success()
}

/// Runs the commands of a document that are chosen; what is shown after a command that ran stands in what was printed.
fn follow(document: &Path, folder: &Path, chosen: impl Fn(&str) -> bool) -> usize {
    let text = fs::read_to_string(document).unwrap();
    let (mut printed, mut ran) = (String::new(), 0);
    let mut complete = true;
    for part in parts(&text) {
        match part {
            Part::Command(line) if chosen(&line) => {
                printed += &run(folder, &line);
                ran += 1;
            }
            Part::Command(_) => complete = false,
            Part::Printed(lines) if complete => {
                let mut rest = printed.as_str();
                for line in lines.iter().filter(|line| !line.is_empty()) {
                    let at = rest.find(&format!("{line}\n"));
                    let at = at.unwrap_or_else(|| {
                        panic!("{}: not printed: {line}\n{printed}", document.display())
                    });
                    rest = &rest[at + line.len()..];
                }
            }
            Part::Printed(_) => {}
        }
    }
    ran
}

#[test]
fn quick_commands_of_readme_and_guide_run_as_written() {
    let chosen = |line: &str| !listed(line, NOT_RUN) && !listed(line, SLOW);
    let ran = documents()
        .into_iter()
        .map(|document| follow(&document, workplace().path(), chosen));
    assert!(ran.sum::<usize>() >= 15);
}

#[test]
#[ignore = "computes every study of README and guide: minutes, in a build with optimisation"]
fn all_commands_of_readme_and_guide_run_as_written() {
    for document in documents() {
        let folder = workplace();
        let chosen = |line: &str| {
            let needed = PROGRAMS.iter().find(|(word, _)| line.contains(word));
            let program = needed.map(|(_, program)| *program);
            let missing = program.filter(|program| !is_installed(program));
            if let Some(program) = missing {
                eprintln!("not run: `{line}`, as {program} is not installed");
            }
            !listed(line, NOT_RUN) && missing.is_none()
        };
        follow(&document, folder.path(), chosen);
    }
}

#[test]
fn what_is_not_run_stands_in_the_documents() {
    let commands: Vec<String> = documents()
        .iter()
        .flat_map(|document| parts(&fs::read_to_string(document).unwrap()))
        .filter_map(|part| match part {
            Part::Command(line) => Some(line),
            Part::Printed(_) => None,
        })
        .collect();
    for (begin, _) in NOT_RUN.iter().chain(SLOW) {
        assert!(
            commands.iter().any(|line| line.starts_with(begin)),
            "{begin}"
        );
    }
}
