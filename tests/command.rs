//! The command as a user meets it: words, files and exit codes.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use serde_json::Value;
use tempfile::TempDir;

const SMALL: &str = r#"
[plate]
cells = [12, 4]
[load]
stretches = ["20 %"]
[finite_element]
cells = [12, 4]
[tolerances]
displacement = "5 %"
departure = "20 %"
force = "5 %"
correction = "10 %"
"#;

fn gelbench(folder: &Path, arguments: &[&str]) -> Assert {
    let mut command = Command::cargo_bin("gelbench").unwrap();
    command.current_dir(folder).args(arguments).assert()
}

fn words(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn folder_with(study: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("small.toml"), study).unwrap();
    folder
}

fn number(value: &Value, path: &[&str]) -> f64 {
    path.iter()
        .fold(value, |value, key| &value[*key])
        .as_f64()
        .unwrap_or(f64::NAN)
}

/// The main job: the figures that the README promises, at every stretch.
#[test]
fn the_pva_plate_study_reaches_its_accuracy() {
    let folder = TempDir::new().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = folder.path().to_str().unwrap();
    let done = gelbench(
        root,
        &["run", "examples/pva_plate.toml", "--output", output],
    )
    .code(0);
    let printed = words(&done.get_output().stdout);
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    for line in printed.lines().filter(|line| !line.contains("files in")) {
        assert!(readme.contains(line), "the README does not show: {line}");
    }

    let text = fs::read_to_string(folder.path().join("report.json")).unwrap();
    let report: Value = serde_json::from_str(&text).unwrap();
    let steps = report["steps"].as_array().unwrap();
    let stretches: Vec<f64> = steps
        .iter()
        .map(|step| number(step, &["stretch"]))
        .collect();
    assert_eq!(stretches, [0.15, 0.3, 0.5, 0.75, 1.0]);
    // Converged forces and widths of dolfinx, scikit-fem and FElupe.
    let published = [
        [2.49239, 46.55659],
        [5.98013, 43.75464],
        [12.87459, 40.71896],
        [27.17571, 37.69968],
        [52.16485, 35.27206],
    ];
    for (step, [force, width]) in steps.iter().zip(published) {
        assert!(number(step, &["corrected", "displacement_percent"]) <= 0.1);
        assert!(number(step, &["corrected", "departure_percent"]) <= 1.0);
        assert!(number(step, &["corrected", "force_percent"]).abs() <= 0.2);
        assert!(number(step, &["corrected", "correction_percent"]) >= 95.0);
        assert!(number(step, &["mass_spring", "departure_percent"]) > 20.0);
        let own = number(step, &["finite_element", "discretisation_percent"]);
        assert!(own < 0.01, "{own}");
        let found = number(step, &["finite_element", "extrapolated_force_N"]);
        assert!((found / force - 1.0).abs() < 1e-5, "{found} {force}");
        let found = number(step, &["finite_element", "extrapolated_width_mm"]);
        assert!((found / width - 1.0).abs() < 1e-6, "{found} {width}");
        for key in ["max_difference_mm", "force_N", "width_mm"] {
            assert!(
                number(step, &["mass_spring", key]) > 0.0
                    && number(step, &["corrected", key]) > 0.0
            );
        }
    }
    assert!(number(&report, &["times_s", "corrector"]) > 0.0);
}

#[test]
fn the_same_study_gives_the_same_bytes() {
    let folder = folder_with(SMALL);
    for output in ["first", "second"] {
        gelbench(folder.path(), &["run", "small.toml", "--output", output]).code(0);
    }
    let mut compared = 0;
    for part in ["", "vtk"] {
        for entry in fs::read_dir(folder.path().join("first").join(part)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            assert!(!name.starts_with('.'), "{name} was left behind");
            // Reports end with a section of times.
            if path.is_dir() || name.starts_with("report") {
                continue;
            }
            let other = folder.path().join("second").join(part).join(&name);
            assert_eq!(fs::read(&path).unwrap(), fs::read(other).unwrap(), "{name}");
            compared += 1;
        }
    }
    assert_eq!(compared, 6 + 8, "pictures and VTK files");
    let without_times = |output: &str| {
        let report = fs::read_to_string(folder.path().join(output).join("report.md")).unwrap();
        report.split("## Times").next().unwrap().to_owned()
    };
    assert_eq!(without_times("first"), without_times("second"));
}

#[test]
fn pictures_and_vtk_files_are_what_they_claim() {
    let folder = folder_with(SMALL);
    gelbench(folder.path(), &["run", "small.toml"]).code(0);
    let output = folder.path().join("output/small");
    for name in [
        "material",
        "plates_001",
        "error_001",
        "errors",
        "force",
        "residuals",
    ] {
        let bytes = fs::read(output.join(format!("{name}.png"))).unwrap();
        assert!(
            bytes.starts_with(b"\x89PNG") && bytes.len() > 5_000,
            "{name}"
        );
    }
    let page = fs::read_to_string(output.join("report.html")).unwrap();
    assert_eq!(page.matches("data:image/png;base64,").count(), 6);
    for model in ["mass_spring", "springs", "corrected", "finite_element"] {
        let collection = fs::read_to_string(output.join(format!("vtk/{model}.pvd"))).unwrap();
        assert!(collection.contains(&format!(
            "timestep=\"0.2\" part=\"0\" file=\"{model}_001.vtu\""
        )));
        let grid = fs::read_to_string(output.join(format!("vtk/{model}_001.vtu"))).unwrap();
        assert!(grid.contains("UnstructuredGrid") && grid.contains("displacement_mm"));
    }
}

#[test]
fn nothing_of_an_earlier_run_is_left_among_the_files() {
    let folder = folder_with(&SMALL.replace("[\"20 %\"]", "[0.1, 0.2]"));
    let output = folder.path().join("output/small");
    gelbench(folder.path(), &["run", "small.toml"]).code(0);
    assert!(
        output.join("plates_002.png").exists() && output.join("vtk/corrected_002.vtu").exists()
    );
    fs::write(output.join("notes_002.png"), "mine").unwrap();
    fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    gelbench(folder.path(), &["run", "small.toml"]).code(0);
    assert!(
        !output.join("plates_002.png").exists() && !output.join("vtk/corrected_002.vtu").exists()
    );
    assert!(output.join("plates_001.png").exists() && output.join("notes_002.png").exists());
}

#[test]
fn a_requirement_that_is_not_met_ends_with_code_1() {
    let folder = folder_with(&SMALL.replace("\"5 %\"", "\"0.001 %\""));
    let done = gelbench(folder.path(), &["run", "small.toml"]).code(1);
    assert!(words(&done.get_output().stdout).contains("FAIL displacement"));
    assert!(folder.path().join("output/small/report.html").exists());
}

#[test]
fn faults_of_a_study_are_told_at_once_with_code_2() {
    let study = SMALL.replace(
        "cells = [12, 4]\n[load]",
        "cels = [12, 4]\nthickness = 2\n[load]",
    );
    let folder = folder_with(&study.replace("[plate]", "[material]\ncard = \"pva10\"\n[plate]"));
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let told = words(&done.get_output().stderr);
    for expected in [
        "did you mean `pva-10`",
        "plate.cels",
        "did you mean `cells`",
        "needs a unit",
        "small.toml:5",
    ] {
        assert!(told.contains(expected), "{expected}: {told}");
    }
    gelbench(folder.path(), &["run", "small.toml"]).code(2);
    assert!(!folder.path().join("output").exists(), "nothing is written");
    gelbench(folder.path(), &["run", "missing.toml"]).code(2);
    gelbench(folder.path(), &["walk"]).code(2);
}

#[test]
fn a_model_without_solution_ends_with_code_3() {
    let folder = folder_with(&format!("{SMALL}\n[mass_spring]\nmax_iterations = 1\n"));
    let done = gelbench(folder.path(), &["run", "small.toml"]).code(3);
    let told = words(&done.get_output().stderr);
    assert!(
        told.contains("mass-spring (12 × 4 cells) at 20 % stretch") && told.contains("try:"),
        "{told}"
    );
    assert!(
        !folder.path().join("output/small").exists(),
        "no empty folder is left"
    );
}

#[test]
fn a_folder_that_takes_no_files_ends_with_code_4() {
    let folder = folder_with(SMALL);
    let done = gelbench(
        folder.path(),
        &["run", "small.toml", "--output", "small.toml/out"],
    )
    .code(4);
    assert!(words(&done.get_output().stderr).contains("cannot write small.toml/out"));
}

#[test]
fn a_new_study_is_complete_and_is_not_overwritten() {
    let folder = TempDir::new().unwrap();
    gelbench(folder.path(), &["new", "mine"]).code(0);
    let done = gelbench(folder.path(), &["check", "mine.toml"]).code(0);
    assert!(words(&done.get_output().stdout).contains("no faults"));
    let done = gelbench(folder.path(), &["new", "mine.toml"]).code(4);
    assert!(words(&done.get_output().stderr).contains("exists already"));
}

#[test]
fn cards_are_listed_and_shown() {
    let folder = TempDir::new().unwrap();
    let done = gelbench(folder.path(), &["materials", "list"]).code(0);
    assert!(words(&done.get_output().stdout).contains("pva-10-cauchy"));
    let done = gelbench(folder.path(), &["materials", "show", "pva-10"]).code(0);
    let shown = words(&done.get_output().stdout);
    assert!(
        shown.contains("amplitude = 0.0611 MPa") && shown.contains("10.1002/jbm.b.30543"),
        "{shown}"
    );
    gelbench(folder.path(), &["materials", "show", "pva"]).code(2);
    gelbench(folder.path(), &["materials", "plot", "pva-10"]).code(0);
    assert!(folder.path().join("pva-10_curves.png").exists());
    let done = gelbench(
        folder.path(),
        &["materials", "compare", "pva-10", "neo-hooke"],
    )
    .code(0);
    assert!(words(&done.get_output().stdout).contains("E₀ = 0.136540 MPa"));
    assert!(folder.path().join("materials.png").exists());
    let done = gelbench(folder.path(), &["materials", "compare", "pva", "neo"]).code(2);
    let told = words(&done.get_output().stderr);
    assert!(
        told.contains("`pva`") && told.contains("`neo`"),
        "both are named: {told}"
    );
}

#[test]
fn a_reader_that_has_gone_away_is_no_error() {
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("gelbench"));
    command
        .args(["materials", "list"])
        .stdout(std::process::Stdio::piped());
    let mut child = command.spawn().unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// From a file of test data to a card that drives a study; the README shows what is printed.
#[test]
fn a_law_is_fitted_and_its_card_is_used() {
    let folder = folder_with(&format!("{SMALL}[material]\ncard = \"pva.toml\"\n"));
    let data = root().join("materials/data/pva_10_uniaxial.csv");
    let data = data.to_str().unwrap();
    let fit = ["materials", "fit", data, "--law", "yeoh", "--name", "pva"];
    let printed = words(&gelbench(folder.path(), &fit).code(0).get_output().stdout);
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let shown =
        |line: &&str| line.starts_with("  c") && line.contains('±') || line.contains("RMSE");
    assert_eq!(printed.lines().filter(shown).count(), 4);
    for line in printed.lines().filter(shown) {
        assert!(readme.contains(line), "{line}");
    }
    let figures = fs::read_to_string(folder.path().join("pva.json")).unwrap();
    let figures: Value = serde_json::from_str(&figures).unwrap();
    assert!((number(&figures, &["r_squared"]) - 0.999_925).abs() < 1e-6);
    assert!(
        fs::read(folder.path().join("pva.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    gelbench(folder.path(), &["check", "small.toml"]).code(0);
    gelbench(folder.path(), &["materials", "refit", "pva.toml"]).code(0);

    // The same again gives the same bytes, but a card that no fit has written is left alone.
    let card = fs::read(folder.path().join("pva.toml")).unwrap();
    gelbench(folder.path(), &fit).code(0);
    assert_eq!(fs::read(folder.path().join("pva.toml")).unwrap(), card);
    fs::write(folder.path().join("pva.toml"), "mine").unwrap();
    let refused = gelbench(folder.path(), &fit).code(4);
    assert!(words(&refused.get_output().stderr).contains("choose another --name"));
    assert_eq!(fs::read(folder.path().join("pva.toml")).unwrap(), b"mine");
}

#[test]
fn a_card_that_was_changed_is_not_found_again() {
    let folder = TempDir::new().unwrap();
    let card = fs::read_to_string(root().join("materials/treloar-ogden-3.toml")).unwrap();
    let data = root().join("materials/data/");
    let card = card
        .replace("alpha_2 = 1.89", "alpha_2 = 1.88")
        .replace("data/", &data.display().to_string());
    fs::write(folder.path().join("a.toml"), card).unwrap();
    let done = gelbench(folder.path(), &["materials", "refit", "a.toml"]).code(1);
    assert!(words(&done.get_output().stdout).contains("DIFFERENT"));
    let none = gelbench(folder.path(), &["materials", "refit", "pva-10"]).code(2);
    assert!(words(&none.get_output().stderr).contains("has no [fit]"));
}

#[test]
fn all_laws_are_ranked_and_the_best_stable_one_is_written() {
    let folder = TempDir::new().unwrap();
    let data = root().join("materials/data/treloar_1944_uniaxial.csv");
    let arguments = ["materials", "fit", data.to_str().unwrap(), "--all"];
    let done = gelbench(folder.path(), &arguments).code(0);
    let printed = words(&done.get_output().stdout);
    assert_eq!(
        printed
            .lines()
            .filter(|line| line.ends_with("yes") || line.ends_with("no"))
            .count(),
        14
    );
    assert!(printed.contains("uniaxial only: planar and equibiaxial stresses are predictions"));
    assert!(
        folder
            .path()
            .join("treloar_1944_uniaxial-ogden-3.toml")
            .exists()
    );
}

#[test]
fn test_data_that_cannot_be_trusted_are_refused_with_line_and_remedy() {
    let folder = TempDir::new().unwrap();
    let fit = |text: &str, options: &[&str]| {
        fs::write(folder.path().join("a.csv"), text).unwrap();
        let arguments = ["materials", "fit", "a.csv", "--law", "neo-hooke"];
        let all: Vec<&str> = arguments.iter().chain(options).copied().collect();
        words(&gelbench(folder.path(), &all).code(2).get_output().stderr)
    };
    for (text, options, told) in [
        (
            "stretch [-],nominal_stress [MPa]\n1.1,0.1\n",
            &[][..],
            "give --test uniaxial",
        ),
        (
            "stretch [-],nominal_stress [MPa]\n1.1,0.1\n",
            &["--test", "uniaxial"],
            "neo-hooke: 1 parameters need at least 2 points",
        ),
        (
            "stretch [-],stress\n1.1,0.1\n",
            &["--test", "uniaxial", "--stress", "nominal"],
            "stress unit is not stated",
        ),
        (
            "stretch [-],stress [MPa]\n1.1,0.1\n",
            &["--test", "uniaxial", "--stress", "true"],
            "it must be one of nominal, cauchy",
        ),
        ("", &["--test", "uniaxial"], "there are no columns"),
    ] {
        let found = fit(text, options);
        let found = found.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(found.contains(told), "{text:?}: {found}");
    }
    let mixed = "# test: uniaxial\nstretch [-];nominal_stress [MPa]\n1,1;0.1\n1,2;0.2\n";
    assert!(fit(mixed, &[]).contains("mixed"));
    fs::write(folder.path().join("b.csv"), b"stretch,\xff\n").unwrap();
    let arguments = ["materials", "fit", "b.csv", "--all"];
    let refused = gelbench(folder.path(), &arguments).code(2);
    assert!(words(&refused.get_output().stderr).contains("is not UTF-8"));
}

#[test]
fn test_data_are_converted() {
    let folder = TempDir::new().unwrap();
    let text = "# test: uniaxial\nnominal_strain [%];nominal_stress [kPa]\n50,0;200,0\n";
    fs::write(folder.path().join("a.csv"), text).unwrap();
    let arguments = ["materials", "convert", "a.csv", "--to-stress", "cauchy"];
    let done = gelbench(folder.path(), &arguments).code(0);
    let expected = "# test: uniaxial\nstretch [-],cauchy_stress [MPa]\n1.5,0.30000000000000004\n";
    assert_eq!(words(&done.get_output().stdout), expected);
}

/// A specimen study with little to compute; `shape` gives the measures, `rest` the supports and loads.
fn specimen(shape: &str, rest: &str) -> String {
    format!(
        "kind = \"specimen\"\ntitle = \"small\"\n[material]\ncard = \"pva-10-yeoh\"\n\
         [specimen]\nthickness = \"2 mm\"\n{shape}\n{rest}\n\
         [tolerances]\ndisplacement = \"5 %\"\nforce = \"5 %\"\ncorrection = \"10 %\"\n"
    )
}

const PULLED: &str = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"left\"\n\
    [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
    [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"6 mm\"\ny = \"0 mm\"\n";

#[test]
fn specimens_of_every_shape_run_in_all_three_models() {
    let turned = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"start\"\n\
        [[support]]\ngroup = \"start\"\nkind = \"clamp\"\n\
        [[support]]\ngroup = \"end\"\nkind = \"rotation\"\ncentre = [\"0 mm\", \"0 mm\"]\nangle = \"15 deg\"\n\
        [[load]]\ngroup = \"outside\"\nkind = \"pressure\"\npressure = \"-0.5 kPa\"\n";
    let drawn = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"left\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[load]]\ngroup = \"right\"\nkind = \"traction\"\nx = \"20 kPa\"\n";
    for (shape, rest) in [
        (
            "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6\nlattice = \"triangles\"",
            PULLED,
        ),
        (
            "shape = \"strip-with-hole\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\ncells = 8",
            drawn,
        ),
        (
            "shape = \"notched-strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nnotch_depth = \"2 mm\"\nnotch_length = \"6 mm\"\ncells = 8",
            PULLED,
        ),
        (
            "shape = \"dog-bone\"\nlength = \"75 mm\"\nwidth = \"12.5 mm\"\nnarrow_length = \"25 mm\"\nnarrow_width = \"4 mm\"\nshoulder_length = \"8 mm\"\ncells = 6",
            PULLED,
        ),
        (
            "shape = \"ring-sector\"\ninner_radius = \"10 mm\"\nouter_radius = \"15 mm\"\nangle = \"90 deg\"\ncells = 8",
            turned,
        ),
    ] {
        let folder = folder_with(&specimen(shape, rest));
        let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
        let printed = words(&done.get_output().stdout);
        assert!(
            printed.contains("4 of 4 checks passed"),
            "{shape}: {printed}"
        );
        let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
        assert!(report.contains("corrected: displacement [%]"), "{shape}");
        for file in [
            "mass_spring_002.vtu",
            "corrected.pvd",
            "springs_001.vtu",
            "finite_element_002.vtu",
        ] {
            assert!(
                folder.path().join("out/vtk").join(file).exists(),
                "{shape} {file}"
            );
        }
    }
}

/// A mesh that goes out as VTK comes in again and gives the same figures.
#[test]
fn a_mesh_of_another_program_is_a_specimen() {
    let shape = "shape = \"strip-with-hole\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\ncells = 8";
    let folder = folder_with(&specimen(shape, PULLED));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let file = "shape = \"mesh\"\nfile = \"out/vtk/mass_spring_001.vtu\"\nfile_unit = \"1 mm\"";
    fs::write(folder.path().join("file.toml"), specimen(file, PULLED)).unwrap();
    gelbench(folder.path(), &["run", "file.toml", "--output", "again"]).code(0);
    let figure = |folder_name: &str| {
        let path = folder.path().join(folder_name).join("report.json");
        let report: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
        report["checks"][0]["computed"].as_f64().unwrap()
    };
    // The outline of the file is a polygon: its finite elements are not those of the circle.
    assert!(
        (figure("out") - figure("again")).abs() < 0.5,
        "{} {}",
        figure("out"),
        figure("again")
    );
}

#[test]
fn faults_of_a_specimen_are_told_with_their_place() {
    let strip = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    for (shape, rest, told) in [
        (strip, PULLED.replace("group = \"right\"", "group = \"rihgt\""), "the mesh has no group `rihgt`"),
        (strip, PULLED.replace("\"clamp\"", "\"clmp\""), "did you mean \"clamp\""),
        (strip, PULLED.replace("measured_group = \"left\"", "measured_group = \"hole\""), "the specimen has no group `hole`"),
        ("shape = \"strip-with-hole\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"10 mm\"\ncells = 6", PULLED.into(), "nine tenths"),
        ("shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 7", PULLED.into(), "cells must be even"),
        ("shape = \"mesh\"\nfile = \"nothing.msh\"\nfile_unit = \"1 mm\"", PULLED.into(), "nothing.msh"),
        (
            strip,
            format!("{PULLED}[[load]]\ngroup = \"top\"\nkind = \"pressure\"\npressure = \"1 kPa\"\n").replace(
                "[[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"6 mm\"\ny = \"0 mm\"\n",
                "",
            ),
            "under pressure and ends freely",
        ),
    ] {
        let folder = folder_with(&specimen(shape, &rest));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let found = words(&done.get_output().stderr);
        let found = found.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(found.contains(told), "{told}: {found}");
    }
}

/// The states before the end of a path are written, and the end is told as a requirement that is not met.
#[test]
fn what_was_reached_before_a_path_ends_is_not_lost() {
    let shape = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    // The second load factor presses the strip through itself.
    let pressed = PULLED
        .replace("factors = [0.5, 1.0]", "factors = [0.1, 30.0]")
        .replace("x = \"6 mm\"", "x = \"-2 mm\"");
    let folder = folder_with(&specimen(shape, PULLED));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    assert!(folder.path().join("out/vtk/corrected_002.vtu").exists());
    fs::write(folder.path().join("small.toml"), specimen(shape, &pressed)).unwrap();
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("load factor 30"), "{printed}");
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(report.contains("| 0.1 |"), "{report}");
    assert!(folder.path().join("out/vtk/corrected_001.vtu").exists());
    assert!(!folder.path().join("out/vtk/corrected_002.vtu").exists());
}
