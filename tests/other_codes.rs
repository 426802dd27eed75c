//! Studies handed over to other codes, and fields taken back from them, as a user meets them.
//!
//! The runs of CalculiX need `ccx` on the path (Debian: `calculix-ccx`); without it they say that they are skipped.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

mod common;

use common::{SMALL, folder_with, gelbench, words};

/// A plate on few finite elements.
const PLATE: &str = "[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\ncells = [12, 4]\n[material]\ncard = \"neo-hooke\"\n\
    [load]\nstretches = [\"20 %\", \"50 %\"]\n[finite_element]\ncells = [12, 4]\n";

const HOLE: &str = "kind = \"specimen\"\ntitle = \"hole\"\n[material]\ncard = \"treloar-ogden-3\"\n[specimen]\n\
    shape = \"strip-with-hole\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\nthickness = \"2 mm\"\ncells = 4\n\
    [path]\nfactors = [0.5, 1.0]\nmeasured_group = \"left\"\n\
    [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n";

const PULLED: &str =
    "[[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"10 mm\"\ny = \"0 mm\"\n";

const GRIPPED: &str =
    "[[support]]\ngroup = \"right\"\nkind = \"grip\"\nx_force = \"4 N\"\ny = \"0 mm\"\n";

const ADAPTIVE: &str = "[finite_element]\nelement = \"T2\"\nadaptive = true\nerror = \"2 %\"\n";

/// Deviation of the finite elements in % from what `gelbench compare` prints.
fn deviation(printed: &str) -> f64 {
    let line = printed
        .lines()
        .find(|line| line.starts_with("finite elements"));
    let word = line.and_then(|line| line.split_whitespace().nth(2));
    word.and_then(|word| word.parse().ok())
        .unwrap_or_else(|| panic!("{printed}"))
}

/// Runs CalculiX on `NAME.inp`; nothing where it is not installed.
fn calculix(folder: &Path, name: &str) -> Option<()> {
    let mut command = Command::new("ccx");
    let command = command
        .arg(name)
        .current_dir(folder)
        .env("OMP_NUM_THREADS", "1");
    match command.stdout(Stdio::null()).stderr(Stdio::null()).status() {
        Ok(status) => {
            assert!(status.success(), "ccx ended with {status}");
            Some(())
        }
        Err(_) => {
            println!("skipped: ccx is not installed");
            None
        }
    }
}

/// Exports `small.toml`, solves it with CalculiX, and returns the deviation of the finite elements from its field at
/// every load factor.
fn solved(study: &str, factors: &[&str]) -> Option<Vec<f64>> {
    let folder = folder_with(study);
    let export = [
        "export",
        "small.toml",
        "--to",
        "calculix",
        "--output",
        "small.inp",
    ];
    gelbench(folder.path(), &export).code(0);
    calculix(folder.path(), "small")?;
    let compare = |factor: &&str| {
        let done = gelbench(
            folder.path(),
            &["compare", "small.toml", "small.frd", "--factor", factor],
        );
        deviation(&words(&done.code(0).get_output().stdout))
    };
    Some(factors.iter().map(compare).collect())
}

#[test]
fn calculix_finds_the_same_plate() {
    let Some(found) = solved(&format!("{PLATE}element = \"Q2\"\n"), &["20 %", "50 %"]) else {
        return;
    };
    println!("Q2: {found:?} %");
    assert!(found.iter().all(|percent| *percent < 0.5), "{found:?}");
}

/// CalculiX' linear solids are not the bilinear elements of a sheet: both come nearer to each other on finer meshes.
#[test]
fn calculix_comes_nearer_with_finer_linear_elements() {
    let study = format!("{PLATE}element = \"Q1\"\n");
    let finer = study.replace(
        "[finite_element]\ncells = [12, 4]",
        "[finite_element]\ncells = [24, 8]",
    );
    let Some(coarse) = solved(&study, &["50 %"]) else {
        return;
    };
    let fine = solved(&finer, &["50 %"]).unwrap();
    println!("Q1: {coarse:?} %, on twice as many cells {fine:?} %");
    assert!(fine[0] < 0.8 * coarse[0], "{coarse:?} {fine:?}");
}

#[test]
fn calculix_finds_the_same_strip_with_a_hole_under_every_load() {
    let turned = "[[support]]\ngroup = \"right\"\nkind = \"rotation\"\ncentre = [\"0 mm\", \"40 mm\"]\nangle = \"15 deg\"\n";
    let blown =
        format!("{PULLED}[[load]]\ngroup = \"hole\"\nkind = \"pressure\"\npressure = \"20 kPa\"\n");
    let drawn =
        "[[load]]\ngroup = \"right\"\nkind = \"traction\"\nx = \"0.2 MPa\"\ny = \"10 kPa\"\n";
    for (load, element) in [
        (PULLED, "Q2 serendipity"),
        (turned, "T2"),
        (&blown, "Q2"),
        (drawn, "Q2"),
        (GRIPPED, "Q2 serendipity"),
    ] {
        let study = format!("{HOLE}{load}[finite_element]\nelement = \"{element}\"\n");
        let Some(found) = solved(&study, &["0.5", "1"]) else {
            return;
        };
        println!("{element}: {found:?} %");
        assert!(
            found.iter().all(|percent| *percent < 0.5),
            "{load}: {found:?}"
        );
    }
}

#[test]
fn calculix_finds_the_same_on_meshes_that_are_fine_where_they_must() {
    for study in [
        format!("{PLATE}element = \"Q2\"\ngrading = 2.0\n"),
        format!("{HOLE}{PULLED}{ADAPTIVE}"),
    ] {
        let Some(found) = solved(&study, &["0.5"]) else {
            return;
        };
        println!("{found:?} %");
        assert!(found[0] < 0.5, "{study}: {found:?}");
    }
}

/// The mesh that goes out is the one that the other models are compared with.
#[test]
fn graded_and_refined_meshes_go_out_as_they_are() {
    let export = [
        "export",
        "small.toml",
        "--to",
        "abaqus",
        "--output",
        "a.inp",
    ];
    let folder = folder_with(&format!("{PLATE}element = \"Q2\"\ngrading = 2.0\n"));
    gelbench(folder.path(), &export).code(0);
    let text = fs::read_to_string(folder.path().join("a.inp")).unwrap();
    // 12 cells on 30 mm: the first line lies at 15 (2/12)² mm.
    assert!(text.contains(", 4.16666666667e-1, 0\n"), "{text}");

    let folder = folder_with(&format!("{HOLE}{PULLED}{ADAPTIVE}"));
    gelbench(folder.path(), &export).code(0);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let text = fs::read_to_string(folder.path().join("a.inp")).unwrap();
    let elements = text
        .lines()
        .skip_while(|line| !line.starts_with("*ELEMENT"));
    let elements = elements.skip(1).take_while(|line| !line.starts_with('*'));
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    let cells = format!("on {} cells", elements.count());
    assert!(report.contains(&cells), "{cells}: {report}");
    let coarse = [&export[..], &["--mesh", "coarse"]].concat();
    let done = gelbench(folder.path(), &coarse).code(2);
    assert!(words(&done.get_output().stderr).contains("leave out --mesh"));
}

#[test]
fn every_code_gets_a_file_of_every_kind_of_study() {
    for study in [PLATE.to_owned(), format!("{HOLE}{PULLED}")] {
        let folder = folder_with(&study);
        for (code, expected) in [
            ("abaqus", "*HYPERELASTIC"),
            ("calculix", "*HYPERELASTIC"),
            ("febio", "<febio_spec version=\"4.0\">"),
        ] {
            let export = ["export", "small.toml", "--to", code, "--mesh", "coarse"];
            let done = gelbench(folder.path(), &export).code(0);
            let printed = words(&done.get_output().stdout);
            let path = folder
                .path()
                .join(printed.split_whitespace().next().unwrap());
            let text = fs::read_to_string(&path).unwrap();
            assert!(text.contains(expected), "{code}");
            gelbench(folder.path(), &export).code(0);
            assert_eq!(
                fs::read_to_string(&path).unwrap(),
                text,
                "{code}: the same bytes again"
            );
        }
    }
}

#[test]
fn what_cannot_be_handed_over_is_refused_before_anything_is_written() {
    let gripped = format!("{HOLE}{GRIPPED}");
    for (study, arguments, told) in [
        (&*gripped, vec!["--to", "febio"], "hand over to Abaqus"),
        (SMALL, vec!["--to", "calculix"], "fit such a card"),
        (PLATE, vec!["--to", "calculx"], "did you mean `calculix`"),
        (
            PLATE,
            vec!["--to", "febio", "--bulk-ratio", "1"],
            "bulk ratio",
        ),
        (
            "kind = \"smoothing\"",
            vec!["--to", "febio"],
            "no boundary value problem",
        ),
    ] {
        let folder = folder_with(study);
        let export = [vec!["export", "small.toml"], arguments].concat();
        let done = gelbench(folder.path(), &export).code(2);
        let found = words(&done.get_output().stderr);
        let found = found.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(found.contains(told), "{told}: {found}");
        assert!(!folder.path().join("output").exists());
    }
}

/// What gelbench writes as VTK comes in again; all formats tell the same.
#[test]
fn a_field_of_ones_own_deviates_by_nothing() {
    let folder = folder_with(PLATE);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let field = "out/vtk/finite_element_001.vtu";
    let compare = [
        "compare",
        "small.toml",
        field,
        "--stretch",
        "0.2",
        "--output",
        "compared",
    ];
    let done = gelbench(folder.path(), &compare).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(deviation(&printed) < 1e-6, "{printed}");
    let report = fs::read_to_string(folder.path().join("compared/report.md")).unwrap();
    assert!(
        report.contains("| finite elements | 12 × 4 cells | 0.0000 |"),
        "{report}"
    );
    for file in ["finite_elements.vtu", "mass_spring.vtu", "corrected.vtu"] {
        assert!(
            folder.path().join("compared/vtk").join(file).exists(),
            "{file}"
        );
    }
    // A file with two displacements must be told which; the compared files hold the difference too.
    let two = [
        "compare",
        "small.toml",
        "compared/vtk/corrected.vtu",
        "--factor",
        "0.2",
    ];
    let array = [&two[..], &["--array", "imported_displacement_mm"]].concat();
    let done = gelbench(folder.path(), &array).code(0);
    assert!(deviation(&words(&done.get_output().stdout)) < 1e-6);
    let wrong = [&two[..], &["--array", "velocity"]].concat();
    let done = gelbench(folder.path(), &wrong).code(2);
    assert!(words(&done.get_output().stderr).contains("imported_displacement_mm"));
}

#[test]
fn fields_on_meshes_that_are_fine_where_they_must_come_in_again() {
    for study in [
        format!("{PLATE}element = \"Q2\"\ngrading = 3.0\n"),
        format!("{HOLE}{PULLED}{ADAPTIVE}"),
    ] {
        let folder = folder_with(&study);
        gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
        let field = folder.path().join("out").join("vtk/finite_element_002.vtu");
        let compare = ["compare", "small.toml", &field.display().to_string()];
        let done = gelbench(folder.path(), &compare).code(0);
        let printed = words(&done.get_output().stdout);
        assert!(deviation(&printed) < 1e-6, "{printed}");
    }
}

/// The material points that dolfinx computed for `validation/plate`.
#[test]
fn points_of_another_code_are_a_reference() {
    let study = "[plate]\nlength = \"150 mm\"\nwidth = \"50 mm\"\nthickness = \"2 mm\"\ncells = [24, 8]\n[material]\n\
        card = \"neo-hooke\"\n[load]\nstretches = [\"15 %\", \"50 %\"]\n[finite_element]\ncells = [60, 20]\nelement = \"Q2\"\n";
    let folder = folder_with(study);
    let points = common::root().join("validation/plate/displacement_nh_60x20_Q2.csv");
    let points = points.display().to_string();
    let compare = [
        "compare",
        "small.toml",
        &points,
        "--stretch",
        "50 %",
        "--output",
        "compared",
    ];
    let done = gelbench(folder.path(), &compare).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("341 points") && deviation(&printed) < 1e-4,
        "{printed}"
    );
    assert!(folder.path().join("compared/vtk/corrected.vtu").exists());
    let metres = ["compare", "small.toml", &points, "--stretch", "40 %"];
    let done = gelbench(folder.path(), &metres).code(2);
    assert!(words(&done.get_output().stderr).contains("no rows for the load factor 0.4"));
}
