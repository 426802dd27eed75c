//! Specimens on a mesh file whose cells have names, with a card for each region, as a user meets them.

use std::fmt::Write;
use std::fs;

use gelbench::material::Card;
use gelbench::material::curve::Mode;
use gelbench::mesh::{MeshReading, import};
use gelbench::problem::{BoundaryProblem, Support};
use gelbench::solve::NewtonSettings;
use tempfile::TempDir;

use crate::common::measured::right_force;
use crate::common::{folder_with, gelbench, machine_report, number, one_line, root, words};

/// Gmsh's file of a strip of 8 × 4 squares of 2 mm, whose cells below and above the middle are `lower` and `upper`; `others` cells in a row are
/// in no group.
fn strip(others: usize) -> String {
    let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"lower\"\n2 2 \"upper\"\n$EndPhysicalNames\n".to_owned();
    text += "$Nodes\n45\n";
    for (i, j) in (0..9).flat_map(|i| (0..5).map(move |j| (i, j))) {
        let _ = writeln!(text, "{} {} {} 0", 5 * i + j + 1, 2 * i, 2 * j);
    }
    text += "$EndNodes\n$Elements\n32\n";
    for (number, (i, j)) in (0..8).flat_map(|i| (0..4).map(move |j| (i, j))).enumerate() {
        let first = 5 * i + j + 1;
        let group = match j {
            _ if number < others => 0,
            0 | 1 => 1,
            _ => 2,
        };
        let nodes = format!("{first} {} {} {}", first + 5, first + 6, first + 1);
        let _ = writeln!(text, "{} 3 2 {group} 1 {nodes}", number + 1);
    }
    text + "$EndElements\n"
}

/// A study of the strip between frictionless supports, pulled by 40 %.
fn study(materials: &str) -> String {
    format!(
        "kind = \"specimen\"\n{materials}\n\
         [specimen]\nshape = \"mesh\"\nfile = \"strip.msh\"\nfile_unit = \"mm\"\nthickness = \"0.5 mm\"\n\
         [[support]]\ngroup = \"left\"\nkind = \"symmetry\"\n\
         [[support]]\ngroup = \"bottom\"\nkind = \"roller\"\n\
         [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"6.4 mm\"\n\
         [path]\nfactors = [0.5, 1.0]\nmeasured_group = \"right\"\n\
         [tolerances]\ndisplacement = \"1 %\"\nforce = \"1 %\"\ncorrection = \"10 %\"\n"
    )
}

fn folder(materials: &str, others: usize) -> TempDir {
    let folder = folder_with(&study(materials));
    fs::write(folder.path().join("strip.msh"), strip(others)).unwrap();
    folder
}

const BOTH: &str = "[[material]]\ncard = \"neo-hooke\"\non = \"lower\"\n[[material]]\ncard = \"meunier-yeoh\"\non = \"upper\"\n";

fn stress(card: &str) -> f64 {
    let card = Card::load(card, root()).unwrap();
    Mode::Uniaxial.nominal_stress(&*card.law, 0.4)
}

/// Incompressible strips in parallel have the same width at the same stretch: F = t Σ hᵢ Pᵢ(λ).
#[test]
fn the_models_of_two_strips_in_parallel_carry_the_sum_of_their_forces() {
    let folder = folder(BOTH, 0);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let report = machine_report(&folder.path().join("out"));
    let exact = 0.5 * 4.0 * (stress("neo-hooke") + stress("meunier-yeoh"));
    let force = |model: &str| number(&report["steps"][1], &[model, "measured_N"]);
    assert!((force("finite_element") / exact - 1.0).abs() < 1e-8);
    assert!((force("corrected") / exact - 1.0).abs() < 1e-8);
    // Springs alone are stiffer in a sheet that is free to contract.
    assert!((1.0..1.3).contains(&(force("mass_spring") / exact)));
    let regions = report["material"]["regions"].as_array().unwrap();
    let output: Vec<_> = regions
        .iter()
        .map(|region| {
            (
                &region["number"],
                &region["name"],
                &region["material"]["card"],
            )
        })
        .map(|(number, name, card)| format!("{number} {name} {card}"))
        .collect();
    assert_eq!(
        output,
        ["1 \"lower\" \"neo-hooke\"", "2 \"upper\" \"meunier-yeoh\""]
    );
    let page = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    for expected in [
        "# Specimen of neo-Hooke, C10 = 0.05 MPa (verification) and unfilled silicone rubber RTV 141, yeoh\n",
        "## Regions",
        "| 2 | upper | meunier-yeoh |",
        "## Material of lower",
    ] {
        assert!(page.contains(expected), "{expected}: {page}");
    }
    for model in ["mass_spring", "corrected", "finite_element"] {
        let file = folder.path().join(format!("out/vtk/{model}_002.vtu"));
        let bytes = fs::read(file).unwrap();
        assert!(
            String::from_utf8_lossy(&bytes).contains("Name=\"region\""),
            "{model}"
        );
    }
    assert!(folder.path().join("out/small_material.png").exists());
}

#[test]
fn every_code_gets_a_material_and_a_set_of_cells_for_each_region() {
    let folder = folder(BOTH, 0);
    let written = |code: &str| {
        let arguments = [
            "export",
            "small.toml",
            "--to",
            code,
            "--mesh",
            "coarse",
            "--output",
            "file",
        ];
        gelbench(folder.path(), &arguments).code(0);
        fs::read_to_string(folder.path().join("file")).unwrap()
    };
    for code in ["abaqus", "calculix"] {
        let text = written(code);
        for expected in [
            "*ELSET, ELSET=LOWER_CELLS\n1, 2, 5, 6, 9, 10, 13, 14, 17, 18\n",
            "*ELSET, ELSET=UPPER_CELLS\n3, 4, 7, 8,",
            "*MATERIAL, NAME=MATERIAL_1\n*HYPERELASTIC, NEO HOOKE\n0.05,",
            "*SOLID SECTION, ELSET=LOWER_CELLS, MATERIAL=MATERIAL_1\n0.5\n",
            "*MATERIAL, NAME=MATERIAL_2\n*HYPERELASTIC, YEOH\n1.81409483654e-1,",
            "*SOLID SECTION, ELSET=UPPER_CELLS, MATERIAL=MATERIAL_2\n0.5\n",
            "** material of LOWER_CELLS: card neo-hooke, law neo-hooke\n",
        ] {
            assert!(text.contains(expected), "{code}, {expected}: {text}");
        }
    }
    // FEBio lacks Yeoh's law.
    fs::write(
        folder.path().join("small.toml"),
        study(&BOTH.replace("meunier-yeoh", "mooney-rivlin")),
    )
    .unwrap();
    let text = written("febio");
    for expected in [
        "<material id=\"1\" name=\"material_1\" type=",
        "<material id=\"2\" name=\"material_2\" type=",
        "<Elements type=\"hex27\" name=\"hex27_LOWER_CELLS\">",
        "<SolidDomain name=\"hex27_UPPER_CELLS\" mat=\"material_2\"/>",
    ] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
}

/// What `check` says of materials, with exit code 2.
fn refused(materials: &str, others: usize) -> String {
    let folder = folder(materials, others);
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    words(&done.get_output().stderr)
}

fn card(name: &str, rest: &str) -> String {
    format!("[[material]]\ncard = \"{name}\"\n{rest}\n")
}

#[test]
fn faults_of_regions_are_told_with_their_remedies() {
    let lower = card("neo-hooke", "on = \"lower\"");
    let rest = card("neo-hooke", "");
    for (materials, others, expected) in [
        (
            card("neo-hooke", "on = \"uper\"") + &rest,
            0,
            vec![
                "the mesh has no region `uper`",
                "did you mean `upper`?",
                "its regions are lower, upper",
            ],
        ),
        (
            lower.clone(),
            0,
            vec![
                "16 of 32 cells have no card: those of `upper`",
                "without `on`",
            ],
        ),
        (
            lower.clone() + &card("neo-hooke", "on = \"upper\""),
            3,
            vec!["3 of 32 cells have no card: which have no name"],
        ),
        (
            lower.clone() + &lower + &rest,
            0,
            vec!["the region `lower` has a card already"],
        ),
        (
            rest.clone() + &rest,
            0,
            vec!["another card is for all remaining cells already"],
        ),
        (
            "[material]\ncard = \"neo-hooke\"\non = \"lower\"\n".to_owned(),
            0,
            vec!["material.on", "write [[material]] for each region"],
        ),
    ] {
        let output = refused(&materials, others);
        let output = output
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            .replace("│ ", "");
        for expected in expected {
            assert!(output.contains(expected), "{expected}: {output}");
        }
    }
}

#[test]
fn built_in_shapes_have_no_regions_and_a_sheet_has_one_plane_state() {
    let shape = study(BOTH).replace(
        "shape = \"mesh\"\nfile = \"strip.msh\"\nfile_unit = \"mm\"",
        "shape = \"strip\"\nlength = \"16 mm\"\nwidth = \"8 mm\"",
    );
    let folder = folder_with(&shape);
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let output = words(&done.get_output().stderr);
    assert!(
        output.contains("the cells of a built-in shape have no names"),
        "{output}"
    );
    let soft =
        "law = \"neo-hooke\"\n[parameters]\nc10 = \"0.05 MPa\"\n[volume]\npoisson_ratio = 0.4\n";
    let folder = self::folder(
        &(card("soft.toml", "on = \"lower\"\nsheet = \"plane-strain\"") + &card("soft.toml", "")),
        0,
    );
    let template = fs::read_to_string(root().join("materials/neo-hooke.toml")).unwrap();
    let soft = template.replace(
        "law = \"neo-hooke\"\n\n[parameters]\nc10 = \"0.05 MPa\"\n",
        soft,
    );
    fs::write(folder.path().join("soft.toml"), soft).unwrap();
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let output = words(&done.get_output().stderr);
    assert!(
        output.contains("write the same `sheet` for all cards"),
        "{output}"
    );
}

/// The first mesh of `examples/inclusion.toml` by scikit-fem 12.0.2: `MeshTri2` with `ElementTriP2` on the same nodes and the same three points of
/// each cell, Newton's method in four steps to residual forces of 1e-13 N, with Ψ = Σ Cᵢ (tr C + 1/det C − 3)ⁱ written for it.
#[test]
fn an_inclusion_has_the_force_and_the_displacement_of_another_code() {
    let file = root().join("examples/inclusion.msh");
    let (mesh, warnings) = import(&file, MeshReading::in_unit(1.0)).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let law = |card: &str| Card::load(card, root()).unwrap().law;
    let held = |x: f64| Support::Displacement([Some(x), Some(0.0)]);
    let problem = BoundaryProblem {
        thickness: 0.5,
        law: law("neo-hooke"),
        regions: vec![("inclusion".into(), law("meunier-yeoh"))],
        supports: vec![("left".into(), held(0.0)), ("right".into(), held(18.0))],
        loads: Vec::new(),
    };
    problem.check(&mesh).unwrap();
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    let newton = NewtonSettings {
        tolerance: 1e-13,
        max_iterations: 40,
    };
    let states = model.solve(&[0.25, 0.5, 0.75, 1.0], newton, &|_| ());
    let states = states.ok().unwrap();
    for (step, force, energy) in [
        (1, 0.647650280434278, 3.04674903838223),
        (3, 1.15789953108755, 11.2499789897858),
    ] {
        let [actual, _] = model.reaction(&states[step], "right");
        assert!((actual / force - 1.0).abs() < 1e-9, "{actual}");
        let actual = states[step].convergence.energy;
        assert!((actual / energy - 1.0).abs() < 1e-9, "{actual}");
    }
    let sheet = problem.deformed(&mesh, &states[3]);
    for (position, expected) in [
        ([32.0, 13.0], [8.27815747167066, 0.272367141829521]),
        ([26.0, 19.0], [7.65191336517936, -0.0484161161714678]),
        ([30.0, 30.0], [8.9452353159507, -1.56208163960977]),
    ] {
        let actual = sheet.displacement_at(position).unwrap();
        for axis in [0, 1] {
            assert!(
                (actual[axis] - expected[axis]).abs() < 1e-8,
                "{position:?}: {actual:?}"
            );
        }
    }
}

/// A correction of these markers with one card.
const CORRECT: [&str; 8] = [
    "correct",
    "markers.csv",
    "--material",
    "neo-hooke",
    "--thickness",
    "0.5 mm",
    "--mesh",
    "strip.msh",
];

/// A field of markers of two strips in parallel: homogeneous, and as both cards alone make it.
fn markers_of_parallel_strips() -> String {
    let across = 1.4_f64.powf(-0.5) - 1.0;
    let mut text = "x [mm],y [mm],ux [mm],uy [mm]\n".to_owned();
    for (i, j) in (0..33).flat_map(|i| (0..17).map(move |j| (i, j))) {
        let [x, y] = [f64::from(i) * 0.5, f64::from(j) * 0.5];
        // Draws that do not depend on their neighbours.
        let noise = |seed: f64| {
            0.002 * ((seed * 12.9898 + f64::from(i * 17 + j)).sin() * 43758.5453).fract()
        };
        let (ux, uy) = (0.4 * x + noise(1.0), across * y + noise(2.0));
        let _ = writeln!(text, "{x},{y},{ux:.6},{uy:.6}");
    }
    text
}

#[test]
fn a_corrected_field_has_the_force_of_the_cards_of_all_regions() {
    let folder = folder(BOTH, 0);
    let markers = folder.path().join("markers.csv");
    fs::write(markers, markers_of_parallel_strips()).unwrap();
    let cards = "[[material]]\non = \"upper\"\ncard = \"meunier-yeoh\"\n";
    fs::write(folder.path().join("known.toml"), cards).unwrap();
    let force = |arguments: &[&str]| {
        let edges = ["--free", "bottom,top", "--output", "out"];
        let all = [&CORRECT[..], &edges, arguments];
        gelbench(folder.path(), &all.concat()).code(0);
        let report = machine_report(&folder.path().join("out"));
        right_force(&report, "x_N")[0]
    };
    let exact = 0.5 * 4.0 * (stress("neo-hooke") + stress("meunier-yeoh"));
    let of_option = force(&["--region", "upper=meunier-yeoh"]);
    assert!(
        (of_option / exact - 1.0).abs() < 2e-3,
        "{of_option} {exact}"
    );
    assert_eq!(of_option, force(&["--study", "known.toml"]));
    let of_one = force(&[]);
    assert!((of_one / (0.5 * 8.0 * stress("neo-hooke")) - 1.0).abs() < 2e-3);
}

#[test]
fn a_card_for_a_region_that_the_mesh_lacks_is_refused() {
    let folder = folder(BOTH, 0);
    let markers = folder.path().join("markers.csv");
    fs::write(markers, markers_of_parallel_strips()).unwrap();
    let given = [&CORRECT[..], &["--region", "uper=meunier-yeoh"]].concat();
    let message = gelbench(folder.path(), &given).code(2);
    assert!(
        one_line(&message.get_output().stderr)
            .contains("no region `uper` help: did you mean `upper`?"),
        "{message:?}"
    );
}
