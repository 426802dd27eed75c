//! Measured displacements made to satisfy the physics, as a user meets it.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use gelbench::compare::displacement_percent;
use gelbench::material::Card;
use gelbench::mesh::{CellShape, Mesh};
use gelbench::output::vtk;
use gelbench::problem::{BoundaryProblem, Support};
use gelbench::results::{Grid, Sheet};
use gelbench::solve::NewtonSettings;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use tempfile::TempDir;

use crate::common::{gelbench, number, report_of_correction as report, root, words};

/// Standard deviation of the example's noise in mm.
const NOISE: f64 = 0.25;

/// The plate 150 × 50 × 2 mm of 10 % PVA, clamped at its short sides and pulled by 25 and 50 %, by finite elements.
fn pulled(mesh: &Mesh) -> [Vec<f64>; 2] {
    let problem = BoundaryProblem {
        thickness: 2.0,
        law: Card::load("pva-10", root()).unwrap().law,
        regions: Vec::new(),
        supports: vec![
            ("left".into(), Support::Displacement([Some(0.0); 2])),
            (
                "right".into(),
                Support::Displacement([Some(75.0), Some(0.0)]),
            ),
        ],
        loads: Vec::new(),
    };
    let energy = problem.finite_elements(mesh);
    let settings = NewtonSettings {
        tolerance: 1e-9,
        max_iterations: 50,
    };
    let discretised = problem.on(mesh, &energy).unwrap();
    let solved = discretised.solve(&[0.25, 0.5, 0.75, 1.0], settings, &|_| {});
    let states = solved.unwrap();
    [1, 3].map(|step: usize| states[step].displacement.clone())
}

/// The plate on a mesh of nine-node elements.
fn plate() -> (Mesh, [Vec<f64>; 2]) {
    let mesh = Mesh::plate([150.0, 50.0], [48, 16], CellShape::Quad9);
    let fields = pulled(&mesh);
    (mesh, fields)
}

/// The example's markers: 31 × 11 points, normal noise of a seed, one in fifty far off and one in fifty lost.
fn markers() -> String {
    let (mesh, fields) = plate();
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut text = String::from(
        "# Markers on a plate of PVA hydrogel, made by finite elements of nine nodes (48 x 16), seed 8 of ChaCha8:\n\
         # noise of 0.25 mm, one marker in fifty off by 3 to 8 mm, one in fifty lost.\n\
         frame,x [mm],y [mm],ux [mm],uy [mm]\n",
    );
    for (field, frame) in fields.iter().zip(1..) {
        for (i, j) in (0..31).flat_map(|i| (0..11).map(move |j| (i, j))) {
            let [x, y] = [5.0 * f64::from(i), 5.0 * f64::from(j)];
            let u = mesh.displacement_at(field, [x, y]);
            let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
            let noise = [NOISE * normal(), NOISE * normal()];
            let fate: f64 = random.random();
            let far = 3.0 + 5.0 * random.random::<f64>();
            let angle = std::f64::consts::TAU * random.random::<f64>();
            let off = if fate < 0.02 { far } else { 0.0 };
            let [ux, uy] = [
                u[0] + noise[0] + off * angle.cos(),
                u[1] + noise[1] + off * angle.sin(),
            ];
            let _ = if fate > 0.98 {
                writeln!(text, "{frame},{x},{y},,")
            } else {
                writeln!(text, "{frame},{x},{y},{ux:.4},{uy:.4}")
            };
        }
    }
    text
}

#[test]
fn the_example_is_what_the_program_makes_of_its_seed() {
    let built = markers();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("measured_plate.csv");
    fs::write(path, &built).unwrap();
    let kept = fs::read_to_string(root().join("examples/measured_plate.csv")).unwrap();
    for (built, kept) in built.lines().zip(kept.lines()) {
        let numbers = |line: &str| -> Option<Vec<f64>> {
            line.split(',').map(|field| field.parse().ok()).collect()
        };
        match (numbers(built), numbers(kept)) {
            (Some(built), Some(kept)) => {
                assert!(
                    built.iter().zip(&kept).all(|(a, b)| (a - b).abs() < 2e-4),
                    "{kept:?}"
                );
            }
            _ => assert_eq!(built, kept),
        }
    }
    assert_eq!(built.lines().count(), kept.lines().count());
}

const PLATE: [&str; 6] = [
    "correct",
    "plate.csv",
    "--material",
    "neo-hooke",
    "--thickness",
    "2 mm",
];

/// Uniaxial tension of a strip of 40 × 20 mm by 20 %, exactly an equilibrium of an incompressible sheet, at points that
/// are 4 mm apart.
fn uniaxial(unit: f64) -> String {
    let (along, across) = (1.2, 1.0 / 1.2f64.sqrt());
    let mut text = String::from("x [mm],y [mm],ux [mm],uy [mm]\n");
    for (i, j) in (0..=10).flat_map(|i| (0..=5).map(move |j| (i, j))) {
        let [x, y] = [4.0 * f64::from(i), 4.0 * f64::from(j)];
        let u = [(along - 1.0) * x, (across - 1.0) * (y - 10.0)];
        let [x, y, ux, uy] = [x, y, u[0], u[1]].map(|value| value * unit);
        let _ = writeln!(text, "{x},{y},{ux},{uy}");
    }
    text
}

#[test]
fn a_homogeneous_field_keeps_its_stress_and_force() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), uniaxial(1.0)).unwrap();
    let conditions = "title = \"Strip\"\n[[edges]]\nnames = [\"top\", \"bottom\"]\ncondition = \"free\"\n\
                      [[edges]]\nnames = [\"left\", \"right\"]\ncondition = \"unknown\"\n";
    fs::write(folder.path().join("known.toml"), conditions).unwrap();
    let arguments = [&PLATE[..], &["--study", "known.toml", "--noise", "0.01 mm"]].concat();
    // The field has no noise: what was stated is contradicted, with a word and exit code 1.
    let done = gelbench(folder.path(), &arguments).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("force along x") && printed.contains("    1  right"),
        "{printed}"
    );
    assert!(
        printed.contains(
            "doubtful: frame 1: the markers scatter 0.00 times as much as their stated noise"
        ),
        "{printed}"
    );
    let actual = report(folder.path());
    let frame = &actual["steps"][0]["corrected"];
    assert!(number(frame, &["left_mm"]) < 1e-3, "{frame:#}");
    // P = 2 C₁₀ (λ − 1/λ²) on the width of 20 mm and the thickness of 2 mm.
    let card = Card::load("neo-hooke", root()).unwrap();
    let stress = 2.0 * card.parameter("c10").unwrap() * (1.2 - 1.2f64.powi(-2));
    let forces = frame["forces"].as_array().unwrap();
    let right = forces
        .iter()
        .find(|force| force["edge"] == "right")
        .unwrap();
    let force = number(right, &["x_N", "value"]);
    assert!(
        (force / (40.0 * stress) - 1.0).abs() < 1e-3,
        "{force} {}",
        40.0 * stress
    );
    let cells = fs::read_to_string(folder.path().join("output/correct/cells_001.csv")).unwrap();
    let mut lines = cells.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = head
        .iter()
        .position(|name| *name == "nominal_stress_xx_MPa")
        .unwrap();
    for line in lines {
        let value: f64 = line.split(',').nth(column).unwrap().parse().unwrap();
        assert!((value / stress - 1.0).abs() < 2e-3, "{value} {stress}");
    }
    for file in [
        "report.html",
        "stress.png",
        "vtk/corrected.pvd",
        "vtk/markers_001.vtu",
        "nodes_001.csv",
    ] {
        assert!(
            folder.path().join("output/correct").join(file).exists(),
            "{file}"
        );
    }
    let again = fs::read(folder.path().join("output/correct/vtk/corrected_001.vtu")).unwrap();
    gelbench(folder.path(), &arguments).code(1);
    let bytes = fs::read(folder.path().join("output/correct/vtk/corrected_001.vtu")).unwrap();
    assert!(bytes == again, "same input, same bytes");
}

/// A square of 40 × 20 mm of two triangles in Gmsh's format 2.2, moved by the given lengths.
fn gmsh(unit: f64, height: f64, view: &str) -> String {
    let [length, width] = [40.0 * unit, 20.0 * unit];
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 {length} 0 0\n3 {length} {width} {height}\n\
         4 0 {width} 0\n$EndNodes\n$Elements\n2\n1 2 0 1 2 3\n2 2 0 1 3 4\n$EndElements\n{view}"
    )
}

#[test]
fn wrong_input_ends_in_one_clear_message_and_nothing_is_written() {
    let folder = TempDir::new().unwrap();
    let put = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    put("plate.csv", &uniaxial(1.0));
    put("small.csv", &uniaxial(0.1));
    put("nothing.csv", "x [mm],y [mm],temperature\n1,2,3\n");
    put(
        "lost.csv",
        "x [mm],y [mm],ux [mm],uy [mm]\n1,2,NaN,NaN\n2,2,NaN,NaN\n",
    );
    put("text.csv", "x [mm],y [mm],ux [mm],uy [mm]\n1,2,3,four\n");
    put(
        "lifted.csv",
        "x [mm],y [mm],ux [mm],uy [mm],uz [mm]\n1,2,3,4,5\n",
    );
    put(
        "hot.csv",
        "x [mm],y [mm],ux [mm],uy [mm],temperature\n1,2,3,4,5\n",
    );
    let apart = uniaxial(1.0)
        .lines()
        .skip(1)
        .fold(uniaxial(1.0), |all, line| {
            let (x, rest) = line.split_once(',').unwrap();
            all + &format!("{},{rest}\n", x.parse::<f64>().unwrap() + 300.0)
        });
    put("apart.csv", &apart);
    put("bow.csv", "x [mm],y [mm]\n0,0\n40,20\n40,0\n0,20\n");
    put("plain.msh", &gmsh(1.0, 0.0, ""));
    put("metres.msh", &gmsh(0.001, 0.0, ""));
    put("solid.msh", &gmsh(1.0, 3.0, ""));
    put(
        "tetrahedra.msh",
        &gmsh(1.0, 0.0, "").replace("1 2 0 1 2 3", "1 4 0 1 2 3 4"),
    );
    put(
        "bad.toml",
        "[[edges]]\nnames = [\"up\"]\ncondition = \"fre\"\n",
    );
    put(
        "up.toml",
        "[[edges]]\nnames = [\"tops\"]\ncondition = \"free\"\n",
    );
    let cases: &[(&[&str], &str, &str)] = &[
        (&["none.csv"], "cannot read none.csv", "markers are a table"),
        (
            &["nothing.csv"],
            "there is no column `ux`",
            "name the columns",
        ),
        (
            &["lost.csv"],
            "no point of the field has a displacement",
            "check the columns",
        ),
        (
            &["text.csv"],
            "\"four\" is not a number",
            "empty where nothing was found",
        ),
        (
            &["lifted.csv"],
            "do not stay in a plane: `uz`",
            "--ignore-columns uz",
        ),
        (
            &["hot.csv"],
            "the column `temperature` is not known here",
            "--ignore-columns temperature",
        ),
        (
            &["plate.csv", "--edge-gap", "1 mm", "--outline", "bow.csv"],
            "cannot be used with",
            "--outline",
        ),
        (
            &["plain.msh"],
            "contains no vectors at its points",
            "give a field as",
        ),
        (
            &["plate.csv", "--mesh", "metres.msh"],
            "about a factor of 1000",
            "--mesh-unit",
        ),
        (
            &["small.csv", "--mesh", "plain.msh"],
            "about a factor of 10",
            "--unit",
        ),
        (
            &["plate.csv", "--mesh", "solid.msh"],
            "is not flat",
            "a mesh file is",
        ),
        (
            &["plate.csv", "--mesh", "tetrahedra.msh"],
            "is a 3-D mesh",
            "a mesh file is",
        ),
        (
            &["plate.csv", "--outline", "bow.csv"],
            "crosses itself near",
            "in order",
        ),
        (&["apart.csv"], "two separated parts", "--outline"),
        (
            &["plate.csv", "--study", "bad.toml"],
            "\"fre\" is not known here",
            "did you mean \"free\"",
        ),
        (
            &["plate.csv", "--study", "up.toml"],
            "the mesh has no edge `tops`",
            "did you mean `top`",
        ),
        (
            &["plate.csv", "--free", "middle"],
            "the mesh has no edge `middle`",
            "bottom",
        ),
        (
            &["plate.csv", "--cell-size", "30 mm"],
            "too large",
            "smaller",
        ),
        (
            &["plate.csv", "--cell-size", "0.001 mm"],
            "1,000,000 are allowed",
            "larger",
        ),
        (
            &["plate.csv", "--fit", "c10", "--rigid", "right"],
            "without a measured force",
            "give the force",
        ),
        (&["plate.csv", "--unit", "parsec"], "parsec", "mm"),
        (
            &["plate.csv", "--force", "12 N"],
            "edge, axis and force",
            "right x 1.2 N",
        ),
    ];
    for (given, reason, remedy) in cases {
        let mut arguments = vec!["correct"];
        arguments.extend_from_slice(given);
        arguments.extend_from_slice(&PLATE[2..]);
        let done = gelbench(folder.path(), &arguments).code(2);
        let message = words(&done.get_output().stderr);
        let message = message
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            .replace("│ ", "");
        assert!(message.contains(reason), "{given:?}: {message}");
        assert!(message.contains(remedy), "{given:?}: {message}");
        assert!(!folder.path().join("output/correct").exists(), "{given:?}");
    }
}

#[test]
fn a_coarse_field_is_brought_onto_a_finer_mesh() {
    let (fine, fields) = plate();
    let truth = &fields[1];
    // Bilinear elements on a coarse mesh, with an error of their own.
    let coarse = Mesh::plate([150.0, 50.0], [15, 5], CellShape::Quad4);
    let [_, field] = &pulled(&coarse);
    let folder = TempDir::new().unwrap();
    let law = Card::load("pva-10", root()).unwrap().law;
    let sheet = Sheet {
        laws: (&law).into(),
        thickness: 2.0,
        past: &[],
        viscous: None,
    };
    let finer = Mesh::plate([150.0, 50.0], [30, 10], CellShape::Quad9);
    let write = |name: &str, mesh: &Mesh, field: &[f64]| {
        let bytes = vtk::grid(&Grid::sheet(sheet, mesh, field));
        fs::write(folder.path().join(name), bytes).unwrap();
    };
    write("coarse.vtu", &coarse, field);
    write("fine.vtu", &finer, &vec![0.0; 2 * finer.nodes.len()]);
    let arguments = [
        "correct",
        "coarse.vtu",
        "--material",
        "pva-10",
        "--thickness",
        "2 mm",
        "--mesh",
        "fine.vtu",
        "--free",
        "top,bottom",
    ];
    let done = gelbench(folder.path(), &arguments).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("correction, root mean square"),
        "{printed}"
    );
    let nodes = fs::read_to_string(folder.path().join("output/correct/nodes_001.csv")).unwrap();
    let corrected: Vec<f64> = nodes
        .lines()
        .skip(1)
        .flat_map(|line| {
            line.split(',')
                .skip(3)
                .take(2)
                .map(|u| u.parse::<f64>().unwrap())
        })
        .collect();
    let truth: Vec<f64> = fine.displacement_on(truth, &finer);
    let interpolated = coarse.displacement_on(field, &finer);
    let before = displacement_percent(&finer, &interpolated, &truth);
    let after = displacement_percent(&finer, &corrected, &truth);
    assert!(before > 0.1 && after < 0.1 * before, "{before} % {after} %");
    // A computed field has neither noise nor a scale.
    let message = [&arguments[..], &["--scale-error", "0.1 %"]].concat();
    let done = gelbench(folder.path(), &message).code(0);
    let message = words(&done.get_output().stderr);
    assert!(
        message.contains("without noise; ignored: scale_error"),
        "{message}"
    );
}

#[test]
fn a_field_in_metres_labelled_mm_is_told() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), uniaxial(0.001)).unwrap();
    let arguments = [&PLATE[..], &["--free", "top,bottom"]].concat();
    let done = gelbench(folder.path(), &arguments).code(1);
    let message = words(&done.get_output().stdout);
    assert!(
        message.contains("assumes a thin sheet") && message.contains("--unit"),
        "{message}"
    );
}
