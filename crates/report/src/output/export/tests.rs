use std::path::Path;

use super::*;
use crate::material::Card;
use crate::mesh::{CellShape, Mesh, Shape};
use crate::problem::{BoundaryProblem, Load, Support};

mod laws;
mod published;
mod solids;

/// A strip of 2 × 1 cells under everything that a study can say.
fn problem(card: &Card) -> BoundaryProblem {
    let displacement = |x, y| Support::Displacement([x, y]);
    BoundaryProblem {
        thickness: 2.0,
        law: card.law.clone(),
        regions: Vec::new(),
        supports: vec![
            ("left".into(), displacement(Some(0.0), Some(0.0))),
            (
                "right".into(),
                Support::Rotation {
                    centre: [0.0, 0.0],
                    angle: 0.5,
                },
            ),
        ],
        loads: vec![
            ("bottom".into(), Load::Pressure(0.01)),
            ("top".into(), Load::Traction([0.0, 0.03])),
        ],
    }
}

fn written(card: &Card, code: Code, shape: CellShape) -> Result<InputFile, Error> {
    let mesh = Shape::Strip { size: [4.0, 2.0] }.mesh(2, shape);
    let export = Export {
        title: "strip",
        problem: &problem(card),
        card,
        regions: &[],
        mesh: &mesh,
        factors: &[0.5, 1.0],
        bulk_ratio: 1000.0,
    };
    export.input_file(code)
}

fn two_cells() -> Mesh {
    let mut mesh = Mesh::new(
        vec![
            [0.0, 0.0],
            [2.0, 0.0],
            [4.0, 0.0],
            [0.0, 2.0],
            [2.0, 2.0],
            [4.0, 2.0],
        ],
        [
            (CellShape::Quad4, vec![0, 1, 4, 3]),
            (CellShape::Quad4, vec![1, 2, 5, 4]),
        ],
    );
    mesh.name_boundary("left", |[x, _]| x == 0.0);
    mesh.name_boundary("right", |[x, _]| x == 4.0);
    mesh.name_boundary("bottom", |[_, y]| y == 0.0);
    mesh.name_boundary("top", |[_, y]| y == 2.0);
    mesh
}

/// ```text
///   4───5───6      cells 1 and 2, each 2 × 2 mm: left clamped, right turned by 0.5, pressure from below,
///   │ 1 │ 2 │      traction on top
///   1───2───3
/// ```
#[test]
fn supports_loads_and_steps_are_those_of_the_study() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    let mesh = two_cells();
    let export = Export {
        title: "Zwei Zellen, μ",
        problem: &problem(&card),
        card: &card,
        regions: &[],
        mesh: &mesh,
        factors: &[0.5, 1.0],
        bulk_ratio: 100.0,
    };
    let text = export.input_file(Code::CalculiX).unwrap().text;
    assert!(text.is_ascii(), "no code reads other letters everywhere");
    for expected in [
        "gelbench: Zwei Zellen, ?\n",
        "*ELEMENT, TYPE=CPS4, ELSET=SPECIMEN\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n",
        "*NSET, NSET=RIGHT\n3, 6\n",
        "*SURFACE, NAME=BOTTOM_EDGES, TYPE=ELEMENT\n1, S1\n2, S1\n",
        "*SURFACE, NAME=TOP_EDGES, TYPE=ELEMENT\n1, S3\n2, S3\n",
        "MATERIAL=MATERIAL_1\n2\n",
        "*BOUNDARY\nLEFT, 1, 1, 0\nLEFT, 2, 2, 0\n3, 1, 1,",
        // Traction 0.03 MPa on 2 mm × 2 mm for each edge, half of it at the first load factor.
        "*CLOAD\n4, 2, 0.03\n5, 2, 0.06\n6, 2, 0.03\n*DLOAD\n1, P1, 0.005\n2, P1, 0.005\n",
        "*CLOAD\n4, 2, 0.06\n5, 2, 0.12\n6, 2, 0.06\n*DLOAD\n1, P1, 0.01\n2, P1, 0.01\n",
    ] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    assert_eq!(text.matches("*STEP, NLGEOM").count(), 2);
    // The node (4, 2) mm turned by 0.25 and by 0.5 about the origin.
    let turned = |angle: f64| 4.0 * (angle.cos() - 1.0) - 2.0 * angle.sin();
    let lines = text
        .lines()
        .filter_map(|line| line.strip_prefix("6, 1, 1, "));
    let numbers: Vec<f64> = lines.map(|line| line.parse().unwrap()).collect();
    for (number, angle) in numbers.iter().zip([0.25, 0.5]) {
        assert!((number - turned(angle)).abs() < 1e-10, "{number}");
    }
    assert_eq!(numbers.len(), 2);
    let abaqus = export.input_file(Code::Abaqus).unwrap().text;
    assert!(
        abaqus.contains("*HYPERELASTIC, NEO HOOKE\n0.05, 0\n"),
        "{abaqus}"
    );
}

/// A displacement that is linear in the position is exported node by node.
#[test]
fn linear_displacements_go_out_with_the_value_of_every_node() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    let mesh = Shape::Strip { size: [4.0, 2.0] }.mesh(2, CellShape::Quad4);
    let field = crate::units::parse_linear_length("0.1 * X + 0.05 * Y").unwrap();
    let mut problem = problem(&card);
    problem.supports[1].1 = Support::LinearDisplacement([Some(field), None]);
    let export = Export {
        title: "strip",
        problem: &problem,
        card: &card,
        regions: &[],
        mesh: &mesh,
        factors: &[1.0],
        bulk_ratio: 100.0,
    };
    for code in [Code::CalculiX, Code::FeBio] {
        assert!(export.input_file(code).is_ok());
    }
    let text = export.input_file(Code::CalculiX).unwrap().text;
    for node in &mesh.groups()["right"].nodes {
        let line = format!("\n{}, 1, 1, ", node + 1);
        let (_, after) = text.split_once(&line).expect("a line of the node");
        let value: f64 = after.lines().next().unwrap().parse().unwrap();
        assert!(
            (value - field.at(mesh.nodes[*node])).abs() < 1e-12,
            "{value}"
        );
    }
}

/// CalculiX gets one step whose load factors are times, where nothing turns; sets of groups are none of the writers' own.
#[test]
fn what_grows_with_the_load_factor_goes_out_in_one_step_to_calculix() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    let mut mesh = Shape::Strip { size: [4.0, 2.0] }.mesh(2, CellShape::Quad4);
    mesh.name_boundary("all_nodes", |[x, _]| x == 4.0);
    mesh.name_boundary("force_1", |[x, _]| x == 0.0);
    let mut problem = problem(&card);
    problem.supports[1].1 = Support::Displacement([Some(1.0), Some(0.0)]);
    let export = |factors: &'static [f64]| Export {
        title: "strip",
        problem: &problem,
        card: &card,
        regions: &[],
        mesh: &mesh,
        factors,
        bulk_ratio: 100.0,
    };
    let text = |factors, code| export(factors).input_file(code).unwrap().text;
    let growing = text(&[0.5, 2.0], Code::CalculiX);
    for expected in [
        "*TIME POINTS, NAME=FACTORS\n0.5\n2\n",
        "*STATIC\n0.1, 2, 0.000002, 2\n",
        "*NODE FILE, OUTPUT=2D, TIME POINTS=FACTORS\n",
        "RIGHT, 1, 1, 2\n",
        "*NSET, NSET=G_ALL_NODES\n",
    ] {
        assert!(growing.contains(expected), "{expected}: {growing}");
    }
    assert_eq!(growing.matches("*STEP,").count(), 1);
    assert_eq!(growing.matches("NSET=ALL_NODES").count(), 1);
    assert!(text(&[1.0], Code::FeBio).contains("name=\"G_FORCE_1\""));
    for several in [
        text(&[0.5, 2.0, 1.0], Code::CalculiX),
        text(&[0.5, 1.0, 2.0], Code::Abaqus),
    ] {
        assert_eq!(several.matches("*STEP,").count(), 3);
    }
}

/// FEBio's time grows, whatever the sign of the load factors.
#[test]
fn a_compression_takes_time_too() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    let mut problem = problem(&card);
    problem.supports[1].1 = Support::Displacement([Some(4.0), Some(0.0)]);
    let export = Export {
        title: "strip",
        problem: &problem,
        card: &card,
        regions: &[],
        mesh: &two_cells(),
        factors: &[-0.05, -0.1],
        bulk_ratio: 1000.0,
    };
    let text = export.input_file(Code::FeBio).unwrap().text;
    assert_eq!(text.matches("<step_size>0.005</step_size>").count(), 2);
    assert!(text.contains("<pt>1,-1</pt>"), "{text}");
    assert!(!text.contains("<dtmax>-"), "{text}");
}

/// Codes that take displacements along straight lines take a large turn in several steps, whose ends lie on the arc.
#[test]
fn turns_go_out_in_steps() {
    let card = Card::load("pva-10-yeoh", Path::new(".")).unwrap();
    let mesh = Shape::Strip { size: [4.0, 2.0] }.mesh(2, CellShape::Quad4);
    let mut turned = problem(&card);
    turned.supports[1].1 = Support::Rotation {
        centre: [4.0, 1.0],
        angle: std::f64::consts::PI,
    };
    let export = Export {
        title: "strip",
        problem: &turned,
        card: &card,
        regions: &[],
        mesh: &mesh,
        factors: &[0.5, 1.0],
        bulk_ratio: 1000.0,
    };
    for code in [Code::Abaqus, Code::CalculiX] {
        let text = export.input_file(code).unwrap().text;
        assert_eq!(text.matches("*STEP,").count(), 6, "{text}");
        assert!(text.contains("** load factor 0.5\n") && text.contains("** load factor 1\n"));
    }
}
