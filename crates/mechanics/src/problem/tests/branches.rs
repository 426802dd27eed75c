//! Paths stay on their branch, however far apart their load factors are.

use std::f64::consts::PI;

use super::*;
use crate::mesh::Mesh;
use crate::solve::NewtonSettings;
use crate::solve::vector::largest;

/// So many iterations find other branches too.
const PATIENT: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// The state at load factor 1, by way of others.
fn reached(problem: &super::super::BoundaryProblem, mesh: &Mesh, factors: &[f64]) -> Option<State> {
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy).unwrap();
    let path = model.solve(factors, NEWTON, &|_| ());
    path.ok().map(|mut states| states.remove(factors.len() - 1))
}

/// A whole turn of one end is not that of none, and one of 350° is not −10°.
#[test]
fn turns_are_followed_all_the_way() {
    let mesh = Shape::Strip { size: [30.0, 10.0] }.mesh(2, CellShape::Quad4);
    for degrees in [350.0_f64, 360.0, -360.0, 400.0] {
        let turned = |degrees: f64| Support::Rotation {
            centre: [15.0, 5.0],
            angle: degrees.to_radians(),
        };
        let ends = |degrees| problem(&[("left", CLAMP), ("right", turned(degrees))], &[]);
        let short = (degrees.to_radians() + PI).rem_euclid(2.0 * PI) - PI;
        let other = reached(&ends(short.to_degrees()), &mesh, &[0.5, 1.0]).unwrap();
        for factors in [&[1.0][..], &[0.5, 1.0], &[0.3, 0.9, 1.0]] {
            let Some(state) = reached(&ends(degrees), &mesh, factors) else {
                continue;
            };
            let pairs = state.displacement.iter().zip(&other.displacement);
            let apart: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
            assert!(largest(&apart) > 1.0, "{degrees}° {factors:?}");
        }
    }
    // A body that is turned as a whole is turned by any angle.
    let about_origin = |angle: f64| Support::Rotation {
        centre: [0.0, 0.0],
        angle,
    };
    let turned = problem(
        &[("left", about_origin(7.0)), ("right", about_origin(7.0))],
        &[],
    );
    let state = reached(&turned, &mesh, &[1.0]).unwrap();
    let position = |node: usize| mesh.nodes[node];
    for node in 0..mesh.nodes.len() {
        let [x, y] = position(node);
        let expected = [
            x * 7.0_f64.cos() - y * 7.0_f64.sin() - x,
            x * 7.0_f64.sin() + y * 7.0_f64.cos() - y,
        ];
        for axis in [0, 1] {
            assert!((state.displacement[2 * node + axis] - expected[axis]).abs() < 1e-8);
        }
    }
}

/// A slender column does not flip through its clamp under many times its buckling load, by whatever load factors.
#[test]
fn a_column_ends_where_it_buckles_whatever_the_load_factors() {
    let mesh = Shape::Strip {
        size: [100.0, 10.0],
    }
    .mesh(2, CellShape::Quad9);
    let pushed = problem(
        &[("left", CLAMP)],
        &[("right", Load::Traction([-0.001, 0.0]))],
    );
    let energy = pushed.finite_elements(&mesh);
    let model = pushed.on(&mesh, &energy).unwrap();
    let every = [
        &[0.1, 0.3, 0.6, 1.0, 3.0][..],
        &[1.0],
        &[3.0],
        &[10.0],
        &[30.0],
        &[100.0],
    ];
    let ends = every.map(|factors| {
        let end = model.solve(factors, PATIENT, &|_| ());
        end.map_err(|end| end.reached()).unwrap_err()
    });
    for end in ends {
        assert!((end / ends[0] - 1.0).abs() < 5e-3, "{ends:?}");
    }
}
