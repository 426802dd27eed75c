//! Specimens of any shape, as a user meets them.

use std::fs;

mod ends;
mod faults;
mod loads;
mod nested;
mod nothing;
mod paths;

use crate::common::{folder_with, gelbench, machine_report, number, words};

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
        report.contains("| displacement of the group [mm] |"),
        "{report}"
    );
    let lame = rest.replace("y = \"0 mm\"\n", "");
    fs::write(folder.path().join("small.toml"), specimen(shape, &lame)).unwrap();
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let result = words(&done.get_output().stderr);
    assert!(result.contains("needs either y or y_force"), "{result}");
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
        assert!(report.contains("| corrected |"), "{shape}");
        let machine = machine_report(&folder.path().join("out"));
        let forces = fs::read_to_string(folder.path().join("out/forces.csv")).unwrap();
        let last = forces.lines().last().unwrap();
        let (names, numbers) = last.split_at(last.match_indices(',').nth(2).unwrap().0 + 1);
        let [_, group, "finite elements", _] = names.split(',').collect::<Vec<_>>()[..] else {
            panic!("{last}");
        };
        let force = &machine["steps"][1]["finite_element"]["groups"][group]["force_N"];
        let result: Vec<f64> = numbers
            .split(',')
            .map(|word| word.parse().unwrap())
            .collect();
        for (axis, result) in result[..2].iter().enumerate() {
            assert!(
                (force[axis].as_f64().unwrap() - result).abs() < 1e-12,
                "{last}"
            );
        }
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

/// A lattice that goes out as VTK comes in again and gives the same force.
#[test]
fn a_mesh_of_another_program_is_a_specimen() {
    let shape = "shape = \"strip-with-hole\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\ncells = 8";
    let folder = folder_with(&specimen(shape, PULLED));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let file = "shape = \"mesh\"\nfile = \"out/vtk/mass_spring_001.vtu\"\nfile_unit = \"1 mm\"";
    fs::write(folder.path().join("file.toml"), specimen(file, PULLED)).unwrap();
    gelbench(folder.path(), &["run", "file.toml", "--output", "again"]).code(0);
    let figure = |folder_name: &str| {
        let report = machine_report(&folder.path().join(folder_name));
        number(&report["steps"][1], &["mass_spring", "measured_N"])
    };
    assert!(
        (figure("out") / figure("again") - 1.0).abs() < 1e-9,
        "{} {}",
        figure("out"),
        figure("again")
    );
}

const STRIP: &str = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";

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
    for output in [
        "the mean displacement along x of the group `right`",
        "a traction of (0.02, 0) MPa",
        "clamped: ux = uy = 0",
        "a strip of 20 × 10 mm, 2 mm thick",
        "| c10 |",
    ] {
        assert!(report.contains(output), "{output}: {report}");
    }
    let json = machine_report(&folder.path().join("out"));
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
        let message = words(&done.get_output().stderr);
        assert!(!message.contains("do not balance"), "{message}");
        let json = machine_report(&folder.path().join("out"));
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
