//! The house holds: imports go downward only, no files in circles, packages at their doors, nothing too long.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

pub mod sources;

use sources::{Arrows, ModulePath, Sources, expand, functions};

/// The modules by floor, the lowest first; a module may name only modules of lower floors, and itself.
const FLOORS: &[&[&str]] = &[
    &["error", "statistics"],
    &["units", "budget"],
    &["document"],
    &["mesh", "material", "solve"],
    &["problem", "markers", "multigrid"],
    &["mass_spring", "finite_element", "calibration"],
    &["dynamics"],
    &["corrector", "estimation", "images"],
    &["compare", "identification"],
    &["results"],
    &["studies"],
    &["output"],
    &["validation"],
    &["kinds"],
    &["sweep"],
    &["command"],
    &["guide"],
];

/// Packages that few places may know: one each, but vtkio has one that writes and one that reads.
const DOORS: &[(&str, &[&str])] = &[
    ("faer::", &["crates/mechanics/src/solve/sparse.rs"]),
    (
        "vtkio::",
        &[
            "crates/report/src/output/vtk.rs",
            "crates/mechanics/src/mesh/import/vtk.rs",
        ],
    ),
    ("image::", &["crates/images/src/images/read.rs"]),
    ("tiff::", &["crates/images/src/images/read"]),
    ("plotters::", &["crates/report/src/output/picture"]),
    ("tiny_skia::", &["crates/report/src/output/picture"]),
    ("pdf_writer::", &["crates/report/src/output/picture/pdf.rs"]),
    (
        "png::",
        &[
            "crates/report/src/output/picture/animation.rs",
            "crates/report/src/output/picture/encode.rs",
        ],
    ),
    ("maud::", &["crates/report/src/output/html.rs"]),
    ("clap::", &["src/command"]),
    ("miette::", &["src/command"]),
    ("toml::", &["crates/base/src/document"]),
    ("spade::", &["crates/mechanics/src/mesh/triangulate.rs"]),
    (
        "csv::",
        &[
            "crates/base/src/document/records.rs",
            "crates/base/src/document/table.rs",
        ],
    ),
    ("zip::", &["crates/base/src/document/archive.rs"]),
    ("calamine::", &["crates/base/src/document/spreadsheet.rs"]),
    ("encoding_rs::", &["crates/base/src/document/encoding.rs"]),
    ("statrs::", &["crates/base/src/statistics.rs"]),
    (
        "rmpfit::",
        &["crates/calibration/src/calibration/least_squares.rs"],
    ),
    (
        "pulp::",
        &[
            "crates/mechanics/src/material/body/points.rs",
            "crates/mechanics/src/material/invariant_law.rs",
            "crates/corrector/src/multigrid/",
            "crates/corrector/src/corrector/climb/forces.rs",
        ],
    ),
];

/// Lines of a file, its tests included.
const LONGEST_FILE: usize = 400;
/// Lines of a function that few may exceed, and how many may.
const LONG_FUNCTION: (usize, usize) = (60, 8);
/// Lines of a function that none may exceed.
const LONGEST_FUNCTION: usize = 80;

fn floor(module: &str) -> usize {
    let result = FLOORS.iter().position(|floor| floor.contains(&module));
    result.unwrap_or_else(|| panic!("`{module}` has no floor"))
}

/// The files that can be reached from one.
fn reached<'a>(arrows: &'a Arrows, from: &'a ModulePath) -> BTreeSet<&'a ModulePath> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(module) = open.pop() {
        let next = arrows.get(module).into_iter().flatten();
        open.extend(next.filter(|next| seen.insert(*next)));
    }
    seen
}

/// The groups of files that can all be reached from one another.
fn circles(arrows: &Arrows) -> Vec<String> {
    let reached: BTreeMap<_, _> = arrows
        .keys()
        .map(|module| (module, reached(arrows, module)))
        .collect();
    let circle = |module: &ModulePath| {
        let back = reached[module]
            .iter()
            .filter(|other| reached[**other].contains(module));
        back.map(|other| other.join("::"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let result: BTreeSet<String> = arrows
        .keys()
        .map(circle)
        .filter(|circle| !circle.is_empty())
        .collect();
    result.into_iter().collect()
}

#[test]
fn imports_go_downward_only() {
    for (module, others) in Sources::of_workspace().arrows() {
        for other in others
            .iter()
            .filter(|other| !module.is_empty() && other[0] != module[0])
        {
            let (upper, lower) = (module.join("::"), other.join("::"));
            assert!(
                floor(&other[0]) < floor(&module[0]),
                "{upper} names {lower}"
            );
        }
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let result = circles(&Sources::of_workspace().arrows());
    assert!(result.is_empty(), "{} circles: {result:#?}", result.len());
}

#[test]
fn a_circle_would_be_seen() {
    let module = |name: &str| vec![name.to_owned()];
    let mut arrows = BTreeMap::from([
        (module("a"), BTreeSet::from([module("b")])),
        (module("b"), BTreeSet::from([module("c")])),
        (module("c"), BTreeSet::new()),
    ]);
    assert!(circles(&arrows).is_empty());
    arrows.insert(module("c"), BTreeSet::from([module("a")]));
    assert_eq!(circles(&arrows), ["a, b, c"]);
    let paths = expand("super::{a::{self, B as C}, d}", &[]);
    let imports: Vec<String> = paths
        .iter()
        .map(|(path, name)| format!("{} {name}", path.join("::")))
        .collect();
    assert_eq!(imports, ["super::a a", "super::a::B C", "super::d d"]);
}

#[test]
fn files_and_functions_are_short() {
    let mut long = Vec::new();
    for source in Sources::of_workspace().0.values() {
        let file = source.path.display();
        let lines = fs::read_to_string(&source.path).unwrap().lines().count();
        assert!(lines <= LONGEST_FILE, "{file} has {lines} lines");
        for (name, lines) in functions(&source.code) {
            let message = format!("{file}: {name} has {lines} lines");
            assert!(lines <= LONGEST_FUNCTION, "{message}");
            long.extend((lines > LONG_FUNCTION.0).then_some(message));
        }
    }
    assert!(long.len() <= LONG_FUNCTION.1, "{long:#?}");
}

#[test]
fn packages_are_named_at_their_doors_only() {
    for source in Sources::of_workspace().0.values() {
        for (package, doors) in DOORS {
            let uses = source.code.match_indices(package).any(|(at, _)| {
                let before = source.code[..at].chars().next_back();
                before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != ':')
            });
            let name = source.path.to_string_lossy();
            let allowed = doors.iter().any(|door| name.starts_with(door));
            assert!(!uses || allowed, "{name} names {package}");
        }
    }
}
