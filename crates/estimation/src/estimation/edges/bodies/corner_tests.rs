//! Forces of edges that meet, where the stress is the same everywhere.

use std::path::Path;
use std::sync::Arc;

use super::bodies;
use crate::estimation::input::{EdgeCondition, segments};
use crate::material::Card;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::mesh::{CellShape, Grid, Mesh};
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::Assembly;

const SIDES: [&str; 4] = ["left", "right", "bottom", "top"];
const THICKNESS: f64 = 2.0;

/// The nodes of a plate moved to another quadrilateral with straight sides, at any position and angle.
fn placed(plate: &Mesh, [shear, turn, far]: [f64; 3]) -> Mesh {
    let position = |[x, y]: [f64; 2]| {
        let (x, y) = (x + shear * y + 0.01 * shear * x * y, y);
        let (sine, cosine) = turn.sin_cos();
        [far + cosine * x - sine * y, sine * x + cosine * y - far]
    };
    let nodes = plate.nodes.iter().map(|node| position(*node)).collect();
    let cells = (0..plate.cell_count()).map(|cell| (plate.shape(cell), plate.cell(cell).to_vec()));
    let mut mesh = Mesh::new(nodes, cells);
    for side in SIDES {
        mesh.name_nodes(side, &plate.groups()[side].nodes.iter().copied().collect());
    }
    mesh
}

fn meshes() -> Vec<Mesh> {
    let grids = [([6, 4], 1.0), ([5, 3], 2.0)];
    let shapes = [CellShape::Quad4, CellShape::Quad9];
    let kinds = shapes
        .into_iter()
        .flat_map(|shape| grids.map(|grid| (shape, grid)));
    let kinds = kinds.map(|(shape, (cells, grading))| {
        Mesh::of_grid(Grid::new([30.0, 20.0], cells, grading), shape)
    });
    kinds
        .flat_map(|plate| {
            let ways = [[0.0, 0.0, 0.0], [0.3, 0.7, 0.0], [-0.4, 2.0, 1e3]];
            ways.map(|way| placed(&plate, way))
        })
        .collect()
}

/// t ∫ P n ds over a side between two positions.
fn exact(stress: [f64; 4], [from, to]: [[f64; 2]; 2]) -> [f64; 2] {
    let along = [to[0] - from[0], to[1] - from[1]];
    // The specimen lies to the left.
    let normal = [along[1], -along[0]];
    [0, 1].map(|i| THICKNESS * (stress[2 * i] * normal[0] + stress[2 * i + 1] * normal[1]))
}

#[test]
fn forces_of_edges_that_meet_are_those_of_a_uniform_stress() {
    let gradients = [
        [0.3, 0.0, 0.0, 0.2],
        [0.0, 0.4, 0.0, 0.0],
        [0.2, 0.3, -0.1, -0.05],
    ];
    for card in ["neo-hooke", "pva-10"] {
        let law = Card::load(card, Path::new(".")).unwrap().law;
        for (mesh, gradient) in meshes()
            .iter()
            .flat_map(|mesh| gradients.map(|g| (mesh, g)))
        {
            let nodes = mesh.nodes.iter();
            let field: Vec<f64> = nodes
                .flat_map(|[x, y]| [0, 1].map(|i| gradient[2 * i] * x + gradient[2 * i + 1] * y))
                .collect();
            let energy = SheetEnergy::of_mesh(Arc::clone(&law), mesh, THICKNESS);
            let mut reactions = vec![0.0; field.len()];
            Assembly::residual(&energy, &field, &mut reactions).unwrap();
            let kinematics = Kinematics::new(&PlaneTensor::from(gradient)).unwrap();
            let stress: [f64; 4] = law.stress(&kinematics).1.into();
            let parts = segments(mesh, &SIDES).unwrap();
            let held = parts.iter().map(|part| (part, EdgeCondition::Unknown));
            for (body, part) in bodies(mesh, held).iter().zip(&parts) {
                let ends = part.ends().map(|node| mesh.nodes[node]);
                let (found, wanted) = (body.force(&reactions), exact(stress, ends));
                for axis in 0..2 {
                    let off = (found[axis] - wanted[axis]).abs();
                    assert!(
                        off < 1e-9,
                        "{card} {gradient:?} {}: {found:?} {wanted:?}",
                        body.name
                    );
                }
            }
        }
    }
}

/// The reaction at a corner of a rigid edge and an unknown one, less the tractions of the unknown one, belongs to the rigid one; where an edge
/// holds one axis only, the other edge has all of the reaction along the other axis.
#[test]
fn the_shares_of_a_reaction_sum_to_one() {
    let mesh = Mesh::plate([6.0, 4.0], [3, 2], CellShape::Quad4);
    let parts = segments(&mesh, &SIDES).unwrap();
    let condition = |name: &str| match name {
        "left" => EdgeCondition::Rigid,
        "bottom" => EdgeCondition::Known([None, Some(0.0)]),
        "top" => EdgeCondition::Free,
        _ => EdgeCondition::Unknown,
    };
    let held = parts.iter().map(|part| (part, condition(&part.name)));
    let found = bodies(&mesh, held);
    for (axis, node) in (0..2).flat_map(|axis| (0..mesh.nodes.len()).map(move |node| (axis, node)))
    {
        let shares = found.iter().flat_map(|body| &body.shares[axis]);
        let own = shares.filter(|(own, _)| *own == node);
        let sum: f64 = own.map(|(_, factor)| factor).sum();
        assert!(
            sum.abs() < 1e-12 || (sum - 1.0).abs() < 1e-12,
            "{axis} {node}: {sum}"
        );
    }
    let bottom = found.iter().find(|body| body.name == "bottom").unwrap();
    assert!(bottom.shares[0].is_empty());
}
