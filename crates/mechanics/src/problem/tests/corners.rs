//! Forces and moments of groups that meet in a corner.

use super::samples::{CLAMP, problem, strip};
use crate::mesh::{CellShape, Mesh};
use crate::problem::{BoundaryProblem, GroupState, Load, Support};
use crate::solve::NewtonSettings;
use crate::units::parse_linear_length;

const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-12,
    max_iterations: 40,
};

const GROUPS: [&str; 4] = ["left", "bottom", "right", "top"];

fn states_of<const N: usize>(
    problem: &BoundaryProblem,
    mesh: &Mesh,
    groups: [&str; N],
) -> [GroupState; N] {
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy).unwrap();
    let state = model.solve(&[1.0], TIGHT, &|_| ()).unwrap().remove(0);
    let reactions = model.reactions(&state);
    groups.map(|group| reactions.at_group(group))
}

fn at_sides(
    cells: CellShape,
    supports: &[(&str, Support)],
    loads: &[(&str, Load)],
) -> [GroupState; 4] {
    states_of(&problem(supports, loads), &strip(cells), GROUPS)
}

/// A traction of 0.02 MPa on 10 × 2 mm against two axes of symmetry: uniaxial tension, in which one axis pulls with 0.4 N and no moment
/// and the other one does nothing.
#[test]
fn axes_of_symmetry_share_no_force_at_their_corner() {
    let supports = [("left", Support::Roller), ("bottom", Support::Roller)];
    let traction = [("right", Load::Traction([0.02, 0.0]))];
    for (name, cells) in CellShape::NAMES {
        let [left, others @ ..] = at_sides(cells, &supports, &traction);
        assert!((left.force[0] + 0.4).abs() < 1e-10, "{name}: {left:?}");
        assert!(
            left.force[1].abs() + left.moment.abs() < 1e-9,
            "{name}: {left:?}"
        );
        for reaction in others {
            let parts = [
                reaction.force[0],
                reaction.force[1],
                reaction.moment,
                reaction.size,
            ];
            assert!(
                parts.iter().all(|part| part.abs() < 1e-9),
                "{name}: {reaction:?}"
            );
        }
    }
}

/// Sides that hold the same unknowns of a corner share what is there, and those of a part of a side have all of it.
#[test]
fn forces_of_sides_that_meet_add_up_to_those_of_all_supports() {
    let pull = Support::Displacement([Some(3.0), Some(1.0)]);
    for (_, cells) in CellShape::NAMES {
        let supports = [
            ("left", CLAMP),
            ("bottom", Support::Displacement([None, Some(0.0)])),
            ("top", Support::Displacement([Some(0.0), None])),
        ];
        let load = [("right", Load::Traction([0.01, 0.004]))];
        let all = at_sides(cells, &supports, &load);
        let sum = |axis: usize| all.iter().map(|reaction| reaction.force[axis]).sum::<f64>();
        assert!((sum(0) + 0.2).abs() < 1e-10 && (sum(1) + 0.08).abs() < 1e-10);
        assert_eq!((all[1].force[0], all[3].force[1]), (0.0, 0.0));
        assert!(
            all[2].size == 0.0,
            "nothing holds the loaded side: {:?}",
            all[2]
        );

        let grips = [("left", CLAMP), ("right", pull)];
        let [left, bottom, right, _] = at_sides(cells, &grips, &[]);
        assert!((left.force[0] + right.force[0]).abs() < 1e-10 && right.force[0] > 0.1);
        assert_eq!(bottom.size, 0.0);
    }
}

/// An evenly stretched sheet that is held all around: every side has the force of its own tractions, also at the corners, which two
/// sides hold along both axes.
#[test]
fn sides_that_hold_one_corner_have_the_forces_of_their_own_tractions() {
    let along = |text: &str| Some(parse_linear_length(text).unwrap());
    let stretched = Support::LinearDisplacement([along("0.1 * X"), along("-0.02 * Y")]);
    let supports = GROUPS.map(|group| (group, stretched));
    for (name, cells) in CellShape::NAMES {
        let [left, bottom, right, top] = at_sides(cells, &supports, &[]);
        assert!(right.force[0] > 0.1 && top.force[1].abs() > 0.01);
        for (reaction, across, other) in [(left, 1, right), (bottom, 0, top)] {
            let along = 1 - across;
            assert!(
                (reaction.force[along] + other.force[along]).abs() < 1e-10,
                "{name}: {reaction:?} {other:?}"
            );
            for side in [reaction, other] {
                assert!(
                    side.force[across].abs() + side.moment.abs() < 1e-10,
                    "{name}: {side:?}"
                );
            }
        }
    }
}

/// Where the nodes lie says nothing of a moment: rows that become narrower towards one side, pulled evenly.
#[test]
fn moments_are_about_the_middle_of_the_group_however_its_nodes_lie() {
    let supports = [
        ("left", CLAMP),
        ("right", Support::Displacement([Some(3.0), Some(0.0)])),
    ];
    for (_, cells) in CellShape::NAMES {
        let (mut mesh, problem) = (strip(cells), problem(&supports, &[]));
        let [[_, low], [_, high]] = mesh.bounding_box();
        let width = high - low;
        for [_, y] in &mut mesh.nodes {
            *y = low + (*y - low).powi(2) / width;
        }
        let ends = ["left", "right"];
        for (group, reaction) in ends.into_iter().zip(states_of(&problem, &mesh, ends)) {
            let middle = 0.5 * (low + high);
            assert!(
                (reaction.position[1] - middle).abs() < 1e-9,
                "{group}: {reaction:?}"
            );
            // Of the force at half the width a small share: the cells are coarse.
            let arm = reaction.moment / (reaction.force[0] * width);
            assert!(arm.abs() < 0.02, "{group}: {arm}");
        }
    }
}

/// A pin at the end of an edge that slides: the edge carries what both hold, the pin what it alone does.
#[test]
fn a_point_beside_an_edge_adds_nothing_to_what_both_hold() {
    let supports = [
        ("left", Support::Roller),
        ("pin", CLAMP),
        ("right", Support::Displacement([Some(6.0), None])),
    ];
    for (name, cells) in CellShape::NAMES {
        let mut mesh = strip(cells);
        let mut corner = mesh.boundary().iter().flatten().copied();
        let [low, _] = mesh.bounding_box();
        let corner = corner.find(|node| mesh.nodes[*node] == low);
        mesh.name_nodes("pin", &corner.into_iter().collect());
        let right = mesh.groups()["right"].nodes.iter().copied().collect();
        mesh.name_nodes("mark", &right);
        let groups = ["left", "pin", "right", "mark"];
        let [left, pin, right, marked] = states_of(&problem(&supports, &[]), &mesh, groups);
        assert!(right.force[0] > 0.1, "{name}: {right:?}");
        assert!(
            (left.force[0] + right.force[0]).abs() < 1e-10,
            "{name}: {left:?}"
        );
        assert!(
            pin.force[0].abs() + pin.force[1].abs() < 1e-10,
            "{name}: {pin:?}"
        );
        // A set of nodes that no support names has all of its part.
        assert!(
            (marked.force[0] - right.force[0]).abs() < 1e-10,
            "{name}: {marked:?}"
        );
    }
}
