//! Climbs, paths and hands on small meshes.

use std::sync::Arc;

use super::*;

mod cases;
mod hands;
mod paths;

use crate::material::NeoHooke;
use crate::mesh::{CellShape, Shape};
use crate::problem::{Drive, Support};

/// Tangents of coarser meshes serve with held, sliding and tied nodes, on curved outlines, and their iterations do not grow
/// with the mesh.
#[test]
fn iterations_on_the_tangents_of_coarser_meshes_do_not_grow() {
    let hole = Shape::StripWithHole {
        size: [40.0, 20.0],
        radius: 4.0,
    };
    let supports = [
        ("left", Support::Roller),
        ("bottom", Support::Roller),
        (
            "right",
            Support::Grip([Drive::Force(2.0), Drive::Displacement(0.0)]),
        ),
    ];
    for kind in [CellShape::Quad4, CellShape::Triangle3, CellShape::Quad9] {
        let problem = BoundaryProblem {
            thickness: 2.0,
            law: Arc::new(NeoHooke { c10: 0.05 }),
            supports: supports.map(|(name, own)| (name.to_owned(), own)).into(),
            loads: Vec::new(),
        };
        let meshes: Vec<Mesh> = (0..4).map(|level| hole.mesh(3 << level, kind)).collect();
        let ascent = Ascent::of(
            &Levels::new(&problem, &meshes),
            1.0,
            ClimbSettings::default(),
        )
        .unwrap();
        let work: Vec<usize> = ascent.work()[1..]
            .iter()
            .map(|own| own.iterations)
            .collect();
        assert!(ascent.is_nested(), "{kind:?}: {work:?}");
        let steady = work.iter().all(|own| *own > 0) && work[2] <= work[1] + 3;
        assert!(steady, "{kind:?}: {work:?}");
    }
}
