//! The shapes with their problems, and their families of meshes from coarse to fine.

use std::sync::Arc;

use gelbench::material::HyperelasticLaw;
use gelbench::mesh::{CellShape, Mesh};
use gelbench::problem::{BoundaryProblem, Load, Support};

use super::meshes::{self, Layout, element};

#[path = "../../tests/common/sheets.rs"]
mod sheets;

use sheets::{DOG_BONE, RING, STRIP_WITH_HOLE, held, named};

/// A problem on a shape.
pub struct Case {
    pub name: &'static str,
    pub problem: BoundaryProblem,
    /// Where the right side is gripped: the length of the shape in mm.
    pub gripped: Option<f64>,
    /// Linear and quadratic cells.
    pub kinds: [CellShape; 2],
    /// Gradings beside equal cells.
    pub gradings: &'static [f64],
    /// Grading of the reference.
    pub finest_grading: f64,
    /// Cells across of the coarsest meshes, of two families for each kind of cells.
    pub bases: [[usize; 2]; 2],
    mesh: fn(usize, Layout) -> Mesh,
}

/// Meshes of a shape, each with cells of half the size of those of the one before.
#[derive(Clone, Copy)]
pub struct Family<'a> {
    pub case: &'a Case,
    pub kind: CellShape,
    pub grading: f64,
    /// Cells across of the coarsest mesh.
    pub base: usize,
}

impl Family<'_> {
    pub fn layout(&self, level: usize) -> Layout {
        Layout {
            kind: self.kind,
            across: self.base << level,
            grading: self.grading,
        }
    }

    pub fn mesh(&self, level: usize) -> Mesh {
        (self.case.mesh)(self.base, self.layout(level))
    }

    /// So many meshes, coarse to fine.
    pub fn meshes(&self, count: usize) -> Vec<Mesh> {
        (0..count).map(|level| self.mesh(level)).collect()
    }

    /// Nodes of the mesh of a level, about.
    pub fn nodes(&self, level: usize) -> usize {
        let known = level.min(2);
        self.mesh(known).nodes.len() << (2 * (level - known))
    }

    /// The levels of so many nodes, about.
    pub fn levels(&self, nodes: std::ops::RangeInclusive<usize>) -> Vec<usize> {
        let to = (1..).take_while(|level| self.nodes(*level) <= *nodes.end());
        to.filter(|level| self.nodes(*level) >= *nodes.start())
            .collect()
    }

    pub fn name(&self) -> String {
        format!("{}, {}", self.case.name, element(self.kind))
    }
}

impl Case {
    /// The families of meshes of a grading and a kind of cells.
    pub fn families(&self, grading: f64, kind: CellShape) -> [Family<'_>; 2] {
        let bases = self.bases[usize::from(kind == self.kinds[1])];
        bases.map(|base| Family {
            case: self,
            kind,
            grading,
            base,
        })
    }
}

const QUADRILATERALS: [CellShape; 2] = [CellShape::Quad4, CellShape::Quad9];
const TRIANGLES: [CellShape; 2] = [CellShape::Triangle3, CellShape::Triangle6];

/// All of them; displacements and pressures make strains of some 50 %, the traction on Cook's membrane a little less.
pub fn all(law: &Arc<dyn HyperelasticLaw>) -> Vec<Case> {
    let problem = |supports, loads| BoundaryProblem {
        thickness: 2.0,
        law: Arc::clone(law),
        supports,
        loads,
    };
    let grips = |by: f64| named([("left", held(0.0, 0.0)), ("right", held(by, 0.0))]);
    let rollers = named([("start", Support::Roller), ("end", Support::Roller)]);
    let pressed = named([("inside", Load::Pressure(0.01))]);
    let sheared = named([("right", Load::Traction([0.0, 0.005]))]);
    let clamped = named([("left", held(0.0, 0.0))]);
    let case = |name, problem, mesh| Case {
        name,
        problem,
        gripped: None,
        kinds: QUADRILATERALS,
        gradings: &[1.5, 2.0],
        finest_grading: 3.0,
        bases: [[6, 8], [4, 6]],
        mesh,
    };
    vec![
        Case {
            gripped: Some(100.0),
            ..case("strip with hole", problem(grips(50.0), vec![]), |_, own| {
                meshes::strip_with_hole(STRIP_WITH_HOLE, own)
            })
        },
        Case {
            gripped: Some(115.0),
            bases: [[4, 6]; 2],
            ..case("dog-bone", problem(grips(50.0), vec![]), |_, own| {
                meshes::dog_bone(DOG_BONE, own)
            })
        },
        Case {
            // The field is smooth everywhere.
            gradings: &[],
            finest_grading: 1.0,
            ..case("ring sector", problem(rollers, pressed), |_, own| {
                RING.mesh(own.across, own.kind)
            })
        },
        Case {
            // Under twice the traction, or on much finer cells, the compressed corner creases, and no field converges.
            finest_grading: 2.0,
            bases: [[8, 5], [4, 5]],
            ..case("Cook's membrane", problem(clamped, sheared), |_, own| {
                meshes::cook(own)
            })
        },
        Case {
            gripped: Some(60.0),
            kinds: TRIANGLES,
            gradings: &[2.0],
            finest_grading: 3.0,
            bases: [[10, 14], [8, 10]],
            ..case(
                "unstructured",
                problem(grips(30.0), vec![]),
                meshes::unstructured,
            )
        },
    ]
}
