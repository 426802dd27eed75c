//! The shapes, each with meshes from coarse to fine.

use std::sync::Arc;

use gelbench::material::HyperelasticLaw;
use gelbench::mesh::{Block, CellShape, Mesh, Outline, Shape, mesh_of_blocks};
use gelbench::problem::{BoundaryProblem, Load, Support};

#[path = "../../tests/common/sheets.rs"]
mod sheets;

use sheets::{DOG_BONE, RING, STRIP_WITH_HOLE, held, named};

/// A problem on a shape.
pub struct Case {
    pub name: &'static str,
    pub problem: BoundaryProblem,
    meshes: Box<dyn Fn(usize) -> Mesh>,
}

impl Case {
    /// So many meshes, each with cells of half the size of those of the one before.
    pub fn meshes(&self, count: usize) -> Vec<Mesh> {
        (0..count).map(|level| (self.meshes)(level)).collect()
    }

    /// Nodes of the mesh of a level, about.
    pub fn nodes(&self, level: usize) -> usize {
        (self.meshes)(0).nodes.len() << (2 * level)
    }
}

/// All of them; displacements, tractions and pressures make strains of some 50 %.
pub fn all(law: &Arc<dyn HyperelasticLaw>) -> Vec<Case> {
    let (hole, bone, ring) = (STRIP_WITH_HOLE, DOG_BONE, RING);
    let case = |name, meshes, supports, loads| Case {
        name,
        meshes,
        problem: BoundaryProblem {
            thickness: 2.0,
            law: Arc::clone(law),
            supports,
            loads,
        },
    };
    let of_shape = |shape: Shape, across: usize, kind: CellShape| -> Box<dyn Fn(usize) -> Mesh> {
        Box::new(move |level| shape.mesh(across << level, kind))
    };
    let grips = |by: f64| named([("left", held(0.0, 0.0)), ("right", held(by, 0.0))]);
    let rollers = named([("start", Support::Roller), ("end", Support::Roller)]);
    let pressed = named([("inside", Load::Pressure(0.01))]);
    let sheared = named([("right", Load::Traction([0.0, 0.01]))]);
    let clamped = named([("left", held(0.0, 0.0))]);
    vec![
        case(
            "strip with hole, Q1",
            of_shape(hole, 6, CellShape::Quad4),
            grips(50.0),
            vec![],
        ),
        case(
            "strip with hole, Q2",
            of_shape(hole, 4, CellShape::Quad9),
            grips(50.0),
            vec![],
        ),
        case(
            "dog-bone, Q1",
            of_shape(bone, 4, CellShape::Quad4),
            grips(50.0),
            vec![],
        ),
        case(
            "ring sector, Q1",
            of_shape(ring, 6, CellShape::Quad4),
            rollers,
            pressed,
        ),
        case(
            "Cook's membrane, Q1",
            Box::new(|level| cook(8 << level)),
            clamped,
            sheared,
        ),
        case(
            "unstructured, T1",
            Box::new(unstructured),
            grips(30.0),
            vec![],
        ),
    ]
}

fn cook(cells: usize) -> Mesh {
    let map = |[s, t]: [f64; 2]| [48.0 * s, (1.0 - t) * 44.0 * s + t * (44.0 + 16.0 * s)];
    let block = Block {
        map: Box::new(map),
        cells: [cells, cells],
        sides: ["bottom", "right", "top", "left"],
    };
    mesh_of_blocks(&[block], CellShape::Quad4)
}

/// Triangles that a mesh generator made in a plate with two holes, halved.
fn unstructured(level: usize) -> Mesh {
    let hexagon = |x: f64, y: f64, r: f64| -> Vec<[f64; 2]> {
        let corner = |k: i32| f64::from(k) * std::f64::consts::FRAC_PI_3;
        let place = |k| [x + r * f64::cos(corner(k)), y + r * f64::sin(corner(k))];
        (0..6).map(place).collect()
    };
    let outer = vec![[0.0, 0.0], [60.0, 0.0], [60.0, 40.0], [0.0, 40.0]];
    let lines = vec![outer, hexagon(18.0, 24.0, 7.0), hexagon(42.0, 14.0, 5.0)];
    let outline = Outline::of_lines(lines).expect("lines that do not cross");
    let first = outline.mesh(4.0, CellShape::Triangle3);
    (0..level).fold(first, |mesh, _| mesh.refined())
}
