//! Imports go downward only.

use std::fs;
use std::path::{Path, PathBuf};

/// The modules by layer; a module may name only modules of the layers above it in this list, and itself.
const LAYERS: &[&[&str]] = &[
    &["error", "units", "statistics"],
    &["document"],
    &["mesh", "material", "solve", "multigrid"],
    &["calibration"],
    &["problem", "markers"],
    &["mass_spring", "finite_element"],
    &["dynamics"],
    &["corrector"],
    &["compare", "identification"],
    &["results"],
    &["studies"],
    &["output"],
    &["validation"],
    &["command"],
];

/// Packages that few places may know: one each, but vtkio has one that writes and one that reads.
const DOORS: &[(&str, &[&str])] = &[
    ("faer::", &["src/solve/sparse.rs"]),
    ("vtkio::", &["src/output/vtk.rs", "src/mesh/import/vtk.rs"]),
    ("plotters::", &["src/output/picture"]),
    ("resvg::", &["src/output/picture"]),
    ("png::", &["src/output/picture/animation.rs"]),
    ("maud::", &["src/output/html.rs"]),
    ("clap::", &["src/command"]),
    ("miette::", &["src/command"]),
    ("toml::", &["src/document"]),
    ("spade::", &["src/mesh/triangulate.rs"]),
    ("csv::", &["src/document/table.rs"]),
    ("statrs::", &["src/statistics.rs"]),
    ("rmpfit::", &["src/calibration/least_squares.rs"]),
    (
        "pulp::",
        &[
            "src/material/law.rs",
            "src/multigrid/line.rs",
            "src/multigrid/stencil.rs",
            "src/corrector/climb/forces.rs",
        ],
    ),
];

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| layer.contains(&module))
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            all.push(path);
        }
    }
    all.sort();
    all
}

/// The module of layer rank that a source file belongs to.
fn module(path: &Path) -> String {
    let first = path
        .strip_prefix("src")
        .unwrap()
        .components()
        .next()
        .unwrap();
    let name = first.as_os_str().to_string_lossy();
    name.trim_end_matches(".rs").to_owned()
}

fn violations(module: &str, text: &str) -> Vec<String> {
    let own = layer(module).unwrap_or_else(|| panic!("`{module}` has no layer"));
    let named = text.split("crate::").skip(1).map(|rest| {
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
        &rest[..end.unwrap_or(rest.len())]
    });
    let upward =
        named.filter(|name| layer(name).is_some_and(|layer| *name != module && layer >= own));
    upward
        .map(|name| format!("{module} imports {name}"))
        .collect()
}

#[test]
fn imports_go_downward_only() {
    let files = sources(Path::new("src"));
    assert!(files.len() > 30, "run from the root of the repository");
    let mut found = Vec::new();
    for file in files {
        let name = module(&file);
        if !["guide", "lib", "main"].contains(&name.as_str()) {
            found.extend(violations(&name, &fs::read_to_string(&file).unwrap()));
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn an_upward_import_would_be_seen() {
    assert_eq!(
        violations("mesh", "use crate::material::Card;"),
        ["mesh imports material"]
    );
    assert_eq!(
        violations("corrector", "use crate::compare::Deviation;").len(),
        1
    );
    assert!(
        violations(
            "corrector",
            "use crate::mesh::Mesh; use crate::corrector::plate;"
        )
        .is_empty()
    );
}

#[test]
fn packages_are_named_at_their_doors_only() {
    for file in sources(Path::new("src")) {
        let text = fs::read_to_string(&file).unwrap();
        for (package, doors) in DOORS {
            let uses = text.match_indices(package).any(|(at, _)| {
                let before = text[..at].chars().next_back();
                before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != ':')
            });
            let name = file.to_string_lossy();
            let allowed = doors.iter().any(|door| name.starts_with(door));
            assert!(!uses || allowed, "{name} names {package}");
        }
    }
}
