//! Specimens of any shape, as a user meets them.

use std::fs;

use serde_json::Value;

mod common;

use common::{folder_with, gelbench, words};

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

/// All three models are pulled by the same force between the same conditions; what is measured is the displacement.
#[test]
fn a_grip_with_a_force_moves_in_all_three_models() {
    let shape = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    let rest = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"right\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"symmetry\"\n\
        [[support]]\ngroup = \"bottom\"\nkind = \"roller\"\n\
        [[support]]\ngroup = \"right\"\nkind = \"grip\"\nx_force = \"0.6 N\"\ny = \"0 mm\"\n";
    let folder = folder_with(&specimen(shape, rest));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("corrected displacement of the group from"),
        "{printed}"
    );
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(
        report.contains("finite elements: displacement of the group [mm]"),
        "{report}"
    );
    let lame = rest.replace("y = \"0 mm\"\n", "");
    fs::write(folder.path().join("small.toml"), specimen(shape, &lame)).unwrap();
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let found = words(&done.get_output().stderr);
    assert!(found.contains("needs either y or y_force"), "{found}");
}

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
            printed.contains("3 of 3 checks passed"),
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
        report["requirements"][0]["computed"].as_f64().unwrap()
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
        (
            strip,
            PULLED.replace("group = \"right\"", "group = \"rihgt\""),
            "the specimen has no group `rihgt`",
        ),
        (
            strip,
            PULLED.replace("\"clamp\"", "\"clmp\""),
            "did you mean \"clamp\"",
        ),
        (
            strip,
            PULLED.replace("measured_group = \"left\"", "measured_group = \"hole\""),
            "the specimen has no group `hole`",
        ),
        (
            "shape = \"strip-with-hole\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"10 mm\"\ncells = 6",
            PULLED.into(),
            "nine tenths",
        ),
        (
            "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 7",
            PULLED.into(),
            "specimen.cells: must be even",
        ),
        (
            "shape = \"mesh\"\nfile = \"nothing.msh\"\nfile_unit = \"1 mm\"",
            PULLED.into(),
            "nothing.msh",
        ),
        (
            strip,
            format!("{PULLED}[finite_element]\nadaptive = true\n"),
            "adaptive refinement is that of triangles",
        ),
        (
            strip,
            format!(
                "{PULLED}[[load]]\ngroup = \"top\"\nkind = \"force\"\ny = \"1 N\"\n\
                [finite_element]\nelement = \"T1\"\nadaptive = true\n"
            ),
            "a force is shared by the nodes of its group",
        ),
        (
            strip,
            format!(
                "{PULLED}[[support]]\ngroup = \"top\"\nkind = \"displacement\"\ny = \"1 mm\"\n"
            ),
            "support 1 on the group `left` (a clamp) and support 3 on the group `top` (y = 1 mm) contradict each other",
        ),
    ] {
        let folder = folder_with(&specimen(shape, &rest));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let found = words(&done.get_output().stderr);
        let found = found.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(found.contains(told), "{told}: {found}");
    }
}

/// A specimen refines itself to the error that the study wants; where the cells do not suffice, that is told.
#[test]
fn local_refinement_ends_at_its_goal_or_at_its_limit() {
    let shape = "shape = \"notched-strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nnotch_depth = \"2 mm\"\n\
        notch_length = \"6 mm\"\ncells = 8\n[finite_element]\nelement = \"T2\"\nadaptive = true\n";
    let folder = folder_with(&specimen(&format!("{shape}error = \"1 %\""), PULLED));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("4 of 4 checks passed"), "{printed}");
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(report.contains("refined locally in"), "{report}");
    let finest = fs::read_to_string(folder.path().join("out/vtk/finite_element_002.vtu")).unwrap();
    assert!(finest.contains("estimated_error_percent_of_energy_norm"));

    let text = specimen(
        &format!("{shape}error = \"0.1 %\"\nmost_cells = 200"),
        PULLED,
    );
    fs::write(folder.path().join("small.toml"), text).unwrap();
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("most_cells = 200"), "{printed}");
}

/// Not even the first load factor is reached: the last equilibrium on the way is written all the same.
#[test]
fn a_path_that_ends_before_its_first_load_factor_leaves_its_last_state() {
    let shape = "shape = \"strip\"\nlength = \"60 mm\"\nwidth = \"6 mm\"\ncells = 4";
    let squeezed = PULLED.replace("x = \"6 mm\"", "x = \"-20 mm\"");
    let folder = folder_with(&specimen(shape, &squeezed));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("buckling or wrinkling"), "{printed}");
    assert!(
        folder
            .path()
            .join("out/vtk/finite_element_end.vtu")
            .exists()
    );
    assert!(
        !folder
            .path()
            .join("out/vtk/finite_element_001.vtu")
            .exists()
    );
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
    assert!(printed.contains("load factor 30 (reached 8."), "{printed}");
    assert!(printed.contains("buckling or wrinkling"), "{printed}");
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(report.contains("| 0.1 |"), "{report}");
    assert!(folder.path().join("out/vtk/corrected_001.vtu").exists());
    assert!(!folder.path().join("out/vtk/corrected_002.vtu").exists());
    // The last equilibrium on the way to the second load factor is kept apart, and said to be.
    assert!(report.contains("| finite_element_end.vtu |"), "{report}");
    assert!(
        folder
            .path()
            .join("out/vtk/finite_element_end.vtu")
            .exists()
    );
}

/// The report for machines of a run into `out`.
fn machine_report(folder: &std::path::Path) -> Value {
    let text = fs::read_to_string(folder.join("out/report.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

const STRIP: &str = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";

/// Nothing that a specimen is made of, held by or loaded with is taken from the study that comes along.
#[test]
fn what_a_study_does_not_say_is_not_done() {
    let whole = specimen(STRIP, PULLED);
    for (left_out, told) in [
        (
            "[material]\ncard = \"pva-10-yeoh\"\n",
            "material.card: is missing",
        ),
        ("thickness = \"2 mm\"\n", "specimen.thickness: is missing"),
        ("shape = \"strip\"\n", "specimen.shape: is missing"),
        ("length = \"20 mm\"\n", "specimen.length: is missing"),
        ("width = \"10 mm\"\n", "specimen.width: is missing"),
        ("factors = [0.5, 1.0]\n", "path.factors: is missing"),
        (
            "measured_group = \"left\"\n",
            "path.measured_group: is missing",
        ),
    ] {
        assert!(whole.contains(left_out), "{left_out}");
        let folder = folder_with(&whole.replace(left_out, ""));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let found = words(&done.get_output().stderr);
        assert!(found.contains(told), "{told}: {found}");
        assert!(found.contains("only what a study says is done"), "{found}");
    }
    let unheld = &PULLED[..PULLED.find("[[support]]").unwrap()];
    let folder = folder_with(&specimen(STRIP, unheld));
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let found = words(&done.get_output().stderr);
    assert!(
        found.contains("support: is missing: nothing holds the specimen"),
        "{found}"
    );
    // A list that holds no tables is no list of supports.
    let listed = format!("support = [1, 2]\n{}", specimen(STRIP, unheld));
    let folder = folder_with(&listed);
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let found = words(&done.get_output().stderr);
    assert!(
        found.contains("support: must be a list of tables"),
        "{found}"
    );
}

/// A fault of a support points to that support, and one of a load to that load.
#[test]
fn a_fault_points_to_the_entry_that_it_is_about() {
    let upside = PULLED.replace("y = \"0 mm\"\n", "");
    let free = upside.replace("kind = \"clamp\"", "kind = \"displacement\"\nx = \"0 mm\"");
    for (rest, line, told) in [
        (
            format!("{PULLED}[[load]]\ngroup = \"botom\"\nkind = \"force\"\nx = \"1 N\"\n"),
            "group = \"botom\"",
            "did you mean `bottom`?",
        ),
        (
            format!(
                "{PULLED}[[support]]\ngroup = \"top\"\nkind = \"displacement\"\ny = \"1 mm\"\n"
            ),
            "group = \"top\"",
            "contradict each other",
        ),
        (free, "", "can move"),
    ] {
        let folder = folder_with(&specimen(STRIP, &rest));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let found = words(&done.get_output().stderr);
        assert!(
            found.contains(told) && found.contains(line),
            "{told}: {found}"
        );
    }
}

/// The springs of a cantilever collapse before its full load; finite elements and corrected field go on.
#[test]
fn the_end_of_the_springs_is_told_and_the_other_models_complete() {
    let shape = "shape = \"strip\"\nlength = \"40 mm\"\nwidth = \"20 mm\"\ncells = 4";
    let rest = "[path]\nfactors = [0.2, 1.0]\nmeasured_group = \"left\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[load]]\ngroup = \"right\"\nkind = \"traction\"\ny = \"80 kPa\"\n";
    let study = specimen(shape, rest).replace("pva-10-yeoh", "neo-hooke");
    let folder = folder_with(&study);
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("FAIL specimen: mass-spring at load factor 1 (reached 0."),
        "{printed}"
    );
    assert!(!printed.contains("specimen: corrector at"), "{printed}");
    let out = folder.path().join("out");
    for file in [
        "mass_spring_001.vtu",
        "mass_spring_end.vtu",
        "corrected_002.vtu",
        "finite_element_002.vtu",
    ] {
        assert!(out.join("vtk").join(file).exists(), "{file}");
    }
    assert!(!out.join("vtk/mass_spring_002.vtu").exists());
    let report = fs::read_to_string(out.join("report.md")).unwrap();
    assert!(
        report.contains("The springs have no equilibrium at the load factors 1."),
        "{report}"
    );
    let json = machine_report(folder.path());
    let steps = |model: &str| {
        let steps = json["steps"].as_array().unwrap().iter();
        steps.filter(|step| step[model].is_object()).count()
    };
    assert_eq!(
        ["mass_spring", "corrected", "finite_element"].map(steps),
        [1, 2, 2]
    );
}

/// A square stretched equally along both axes is homogeneous: no model deviates, and nothing is to be corrected.
#[test]
fn an_exact_solution_passes() {
    let shape = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"20 mm\"\ncells = 4";
    let rest = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"right\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"symmetry\"\n\
        [[support]]\ngroup = \"bottom\"\nkind = \"symmetry\"\n\
        [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"0.3 * X\"\n\
        [[support]]\ngroup = \"top\"\nkind = \"displacement\"\ny = \"6 mm\"\n";
    let folder = folder_with(&specimen(shape, rest));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("nothing to correct"), "{printed}");
    assert!(printed.contains("exact but for rounding"), "{printed}");
}

/// A strip under a given traction: the force at the clamp is given by equilibrium, so the displacement is compared.
#[test]
fn a_load_that_is_given_is_not_compared_with_itself() {
    let rest = "[path]\nfactors = [1.0]\nmeasured_group = \"left\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[load]]\ngroup = \"right\"\nkind = \"traction\"\nx = \"20 kPa\"\n";
    let folder = folder_with(&specimen(STRIP, rest));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("corrected displacement of the group from"),
        "{printed}"
    );
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    for said in [
        "the mean displacement along x of the group `right`",
        "a traction of (0.02, 0) MPa",
        "clamped: ux = uy = 0",
        "a strip of 20 × 10 mm, 2 mm thick",
        "| c10 |",
    ] {
        assert!(report.contains(said), "{said}: {report}");
    }
    let json = machine_report(folder.path());
    assert_eq!(json["problem"]["thickness_mm"], 2.0);
    assert_eq!(json["problem"]["loads"][0]["group"], "right");
    // 20 kPa on 10 × 2 mm.
    for model in ["mass_spring", "corrected", "finite_element"] {
        let force = &json["steps"][0][model]["groups"]["left"]["force_N"];
        assert!(
            (force[0].as_f64().unwrap() + 0.4).abs() < 1e-9,
            "{model}: {force}"
        );
    }
}

/// Whatever the shape, the law and the supports are: both components of all forces are written, they balance, and no
/// warning says otherwise.
#[test]
fn forces_of_all_supports_balance_on_every_shape_and_law() {
    let moved = |x: &str, y: &str| {
        format!(
            "[path]\nfactors = [1.0]\nmeasured_group = \"left\"\n\
             [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
             [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"{x}\"\ny = \"{y}\"\n"
        )
    };
    let gripped = moved("1 mm", "0 mm").replace(
        "kind = \"displacement\"\nx = \"1 mm\"\ny = \"0 mm\"",
        "kind = \"grip\"\nx_force = \"0.1 N\"\ny = \"0.2 mm\"",
    );
    let shapes = [
        "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 4\nlattice = \"triangles\"",
        "shape = \"strip-with-hole\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\ncells = 4",
        "shape = \"notched-strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\nnotch_depth = \"1 mm\"\nnotch_length = \"4 mm\"\ncells = 4",
    ];
    let supports = [
        moved("3 mm", "1 mm"),
        gripped,
        moved("0.1 * X", "-0.02 * X + 0.05 * Y"),
    ];
    let cards = ["neo-hooke", "pva-10", "treloar-ogden-3", "mooney-rivlin"];
    for (number, card) in cards.iter().enumerate() {
        let (shape, rest) = (shapes[number % 3], &supports[(number + number / 3) % 3]);
        let study = specimen(shape, rest).replace("pva-10-yeoh", card);
        let folder = folder_with(&study);
        let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
        let told = words(&done.get_output().stderr);
        assert!(!told.contains("do not balance"), "{told}");
        let json = machine_report(folder.path());
        for model in ["mass_spring", "corrected", "finite_element"] {
            let groups = &json["steps"][0][model]["groups"];
            let force = |group: &str, axis: usize| groups[group]["force_N"][axis].as_f64().unwrap();
            let size = force("left", 0).hypot(force("left", 1));
            assert!(size > 0.0, "{study}");
            for axis in [0, 1] {
                let sum = force("left", axis) + force("right", axis);
                assert!(
                    sum.abs() < 1e-9 * size,
                    "{model}, axis {axis}: {sum} of {size}\n{study}"
                );
            }
            let balance = &json["balance"]["models"][model]["unbalanced"];
            let balance = balance.as_f64().unwrap();
            assert!(balance < 1e-9, "{model}: {balance}\n{study}");
        }
    }
}
