//! Sheets in the hand beside problems whose supports are where the hand has them.

use std::sync::Arc;

use super::cases::{Case, EXACT, all, case, distance};
use crate::corrector::climb::ClimbSettings;
use crate::corrector::shape_climb::{Climb, Interactive};
use crate::error::Error;
use crate::material::{HyperelasticLaw, NeoHooke};
use crate::mesh::CellShape;
use crate::problem::{BoundaryProblem, Drive, Grip, GroupState, RigidMotion, Support};
use crate::solve::State;
use crate::units::Linear;

/// The load factor at which sheets are taken.
const TAKEN: f64 = 0.6;

fn taken(case: &Case) -> Interactive<'_> {
    let climb = Climb::new(&case.problem, &case.meshes, ClimbSettings::FAST);
    Interactive::new(climb, TAKEN).unwrap_or_else(|fault| panic!("{}: {fault}", case.name))
}

/// What the hand does to a group, and the support that does the same at the load factor at which the sheet is taken.
fn moved(case: &Case, name: &str, hand: &Interactive) -> (Grip, Support) {
    let mesh = &case.meshes[2];
    let now = hand.at_group(name).displacement;
    match &hand.grips()[name] {
        Grip::Drives([Drive::Force(force), Drive::Displacement(across)]) => {
            let drives = |share: f64| {
                [
                    Drive::Force(1.2 * force * share),
                    Drive::Displacement((across + 0.7) * share),
                ]
            };
            (
                Grip::Drives(drives(1.0)),
                Support::Grip(drives(1.0 / TAKEN)),
            )
        }
        Grip::Drives(_) => panic!("another grip"),
        Grip::Motion(own) => {
            let support = case.problem.supports.iter().find(|own| own.0 == name);
            let (_, support) = support.expect("held");
            if let Support::Displacement([Some(_), None]) = support {
                let by = own.displacement[0] + 1.0;
                let motion = RigidMotion {
                    displacement: [by, 0.0],
                    angle: 0.0,
                };
                let support = Support::Displacement([Some(by / TAKEN), None]);
                return (Grip::Motion(motion), support);
            }
            if *support == Support::Roller {
                let motion = RigidMotion {
                    displacement: [0.0, -0.5],
                    angle: 0.0,
                };
                let support = Support::Displacement([None, Some(-0.5 / TAKEN)]);
                return (Grip::Motion(motion), support);
            }
            let angle = 0.08_f64;
            let displacement = [now[0] + 0.8, now[1] - 0.6];
            let motion = RigidMotion {
                displacement,
                angle,
            };
            // u = d + (R − 1)(X − X̄) + R w, and w = G (X − X̄) on a straight line along Y.
            let (sine, cosine) = angle.sin_cos();
            let slopes = match support {
                Support::LinearDisplacement(field) => {
                    field.map(|own| TAKEN * own.unwrap().slope[1])
                }
                _ => [0.0; 2],
            };
            let along_y = [
                -sine + cosine * slopes[0] - sine * slopes[1],
                cosine - 1.0 + sine * slopes[0] + cosine * slopes[1],
            ];
            let along_x = [cosine - 1.0, sine];
            let group = &mesh.groups()[name];
            let middle = middle(case, group.edges.as_slice());
            let linear = |axis: usize| {
                let [gx, gy] = [along_x[axis], along_y[axis]].map(|own| own / TAKEN);
                Some(Linear {
                    at_origin: displacement[axis] / TAKEN - gx * middle[0] - gy * middle[1],
                    slope: [gx, gy],
                })
            };
            let support = Support::LinearDisplacement([linear(0), linear(1)]);
            (Grip::Motion(motion), support)
        }
    }
}

/// The mean place along some edges at rest, by Simpson's rule over many points of the element's edge.
fn middle(case: &Case, edges: &[Vec<usize>]) -> [f64; 2] {
    const PARTS: usize = 400;
    let nodes = &case.meshes[2].nodes;
    let at = |edge: &[usize], x: f64| {
        let values = match edge.len() {
            2 => vec![0.5 * (1.0 - x), 0.5 * (1.0 + x)],
            _ => vec![0.5 * x * (x - 1.0), 0.5 * x * (x + 1.0), 1.0 - x * x],
        };
        let pairs = || edge.iter().zip(&values);
        [0, 1].map(|axis| {
            pairs()
                .map(|(node, value)| value * nodes[*node][axis])
                .sum::<f64>()
        })
    };
    let (mut sum, mut whole) = ([0.0; 2], 0.0);
    for edge in edges {
        for part in 0..PARTS {
            let x = |share: f64| -1.0 + 2.0 * (part as f64 + share) / PARTS as f64;
            let [a, b, c] = [at(edge, x(0.0)), at(edge, x(1.0)), at(edge, x(0.5))];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            (0..2).for_each(|axis| sum[axis] += length * c[axis]);
            whole += length;
        }
    }
    sum.map(|own| own / whole)
}

fn solved(case: &Case, name: &str, support: Support) -> (State, GroupState) {
    let mut problem: BoundaryProblem = case.problem.clone();
    for own in &mut problem.supports {
        if own.0 == name {
            own.1 = support;
        }
    }
    let mesh = &case.meshes[2];
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy).unwrap();
    let state = model.reach(&[TAKEN], EXACT);
    let state = state.unwrap_or_else(|fault| panic!("{}: {fault}", case.name));
    let at_group = model.reactions(&state).at_group(name);
    (state, at_group)
}

#[test]
fn a_sheet_in_the_hand_is_that_whose_supports_are_where_the_hand_has_them() {
    for case in all() {
        let mut hand = taken(&case);
        let group = ["right", "outside", "start", "left"];
        let held = |name: &&&str| hand.grips().contains_key(**name);
        let name = *group.iter().find(held).unwrap();
        let (grip, support) = moved(&case, name, &hand);
        if let Err(fault) = hand.move_grips(&[(name, grip)]) {
            panic!("{}: {fault}", case.name);
        }
        let (exact, force) = solved(&case, name, support);
        let (own, found) = (hand.state(), hand.at_group(name));
        let off = distance(&own.state.displacement, &exact.displacement);
        let told = format!("{}: {off} of {}", case.name, own.discretisation_error);
        println!("{told}");
        assert!(off <= 0.1 * own.discretisation_error, "{told}");
        for axis in 0..2 {
            let size = force.force[0].hypot(force.force[1]);
            let rest = (found.force[axis] - force.force[axis]).abs();
            assert!(rest < 5e-3 * size, "{told}: {found:?}, {force:?}");
            let rest = (found.displacement[axis] - force.displacement[axis]).abs();
            assert!(
                rest < 0.2 * own.discretisation_error + 1e-9,
                "{told}: {found:?}, {force:?}"
            );
        }
        let balance = case.with_model(|model| model.reactions(&own.state).balance());
        assert!(balance.relative() < 2e-3, "{told}: {}", balance.relative());
        let by_factors = own.work[0].iterations == 0 && own.work[0].linearisations > 0;
        assert_eq!(by_factors, !case.is_symmetric, "{told}: {:?}", own.work);
        assert_eq!(hand.grips()[name], grip);
    }
}

fn neo_hooke(place: usize) -> Case {
    let law: Arc<dyn HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
    case(place, &law, CellShape::Quad4, "neo-hooke")
}

/// All grips turned together about one point: no strain is added, the forces turn; and back.
#[test]
fn a_turn_of_all_grips_turns_the_forces_and_adds_no_strain() {
    let case = neo_hooke(0);
    let mut hand = taken(&case);
    let (start, grips) = (hand.state().clone(), hand.grips().clone());
    let before = hand.at_group("right").force;
    for angle in [0.3_f64, -0.7, 2.0] {
        let (sine, cosine) = angle.sin_cos();
        // About the origin, which is at the middle of the left grip.
        let [dx, dy] = hand_displacement(&grips["right"]);
        let [x, y] = [40.0 + dx, dy];
        let right = RigidMotion {
            displacement: [cosine * x - sine * y - 40.0, sine * x + cosine * y],
            angle,
        };
        let left = RigidMotion {
            displacement: [0.0; 2],
            angle,
        };
        let grips = [("left", Grip::Motion(left)), ("right", Grip::Motion(right))];
        hand.move_grips(&grips).unwrap();
        let after = hand.at_group("right").force;
        let turned = [
            cosine * before[0] - sine * before[1],
            sine * before[0] + cosine * before[1],
        ];
        let size = before[0].hypot(before[1]);
        for axis in 0..2 {
            let rest = (after[axis] - turned[axis]).abs();
            assert!(rest < 2e-3 * size, "{angle}: {after:?} {turned:?}");
        }
        let errors = [hand.state(), &start].map(|own| own.discretisation_error);
        assert!((errors[0] / errors[1] - 1.0).abs() < 1e-3, "{errors:?}");
    }
    let back = [("left", grips["left"]), ("right", grips["right"])];
    let back = hand.move_grips(&back).unwrap();
    let off = distance(&back.state.displacement, &start.state.displacement);
    assert!(off <= 0.1 * start.discretisation_error, "{off}");
}

fn hand_displacement(grip: &Grip) -> [f64; 2] {
    match grip {
        Grip::Motion(motion) => motion.displacement,
        Grip::Drives(_) => panic!("a motion"),
    }
}

/// What a hand cannot do is refused with the reason, and the state before is kept.
#[test]
fn what_the_hand_cannot_do_is_refused() {
    let motion = |x: f64, y: f64, angle: f64| {
        Grip::Motion(RigidMotion {
            displacement: [x, y],
            angle,
        })
    };
    let drives = |x: Drive, y: Drive| Grip::Drives([x, y]);
    let force = drives(Drive::Force(1.0), Drive::Force(1.0));
    let infinite = drives(Drive::Force(f64::INFINITY), Drive::Displacement(0.0));
    let refused: [(usize, &str, Grip, &str); 8] = [
        (
            0,
            "hole",
            motion(1.0, 0.0, 0.0),
            "no support holds a group `hole`",
        ),
        (0, "right", force, "is no grip with a force"),
        (0, "right", motion(f64::NAN, 0.0, 0.0), "not finite"),
        (1, "right", motion(1.0, 0.0, 0.0), "is not moved rigidly"),
        (1, "right", force, "has other drives"),
        (1, "right", infinite, "has other drives"),
        (
            2,
            "right",
            motion(5.0, 0.0, 0.1),
            "slides freely along an axis",
        ),
        (2, "bottom", motion(0.0, 1.0, 0.0), ""),
    ];
    for (place, name, grip, words) in refused {
        let case = neo_hooke(place);
        let mut hand = taken(&case);
        let before = hand.state().state.clone();
        let found = hand.move_grips(&[(name, grip)]).map(drop);
        if words.is_empty() {
            found.unwrap();
            continue;
        }
        let fault = found.unwrap_err();
        assert!(matches!(fault, Error::Input(_)), "{fault}");
        assert!(fault.to_string().contains(words), "{fault}");
        assert_eq!(hand.state().state.displacement, before.displacement);
    }
}

fn right(x: f64, y: f64) -> [(&'static str, Grip); 1] {
    [("right", shifted(x, y))]
}

fn shifted(x: f64, y: f64) -> Grip {
    Grip::Motion(RigidMotion {
        displacement: [x, y],
        angle: 0.0,
    })
}

#[test]
fn grips_that_share_a_node_cannot_part() {
    let mut case = neo_hooke(0);
    let linear = |slope: f64| {
        Some(Linear {
            at_origin: 0.0,
            slope: [slope, 0.0],
        })
    };
    let along = Support::LinearDisplacement([linear(0.2), linear(0.05)]);
    case.problem.supports.push(("bottom".into(), along));
    let mut hand = taken(&case);
    let fault = hand.move_grips(&right(6.0, 1.2)).unwrap_err().to_string();
    assert!(
        fault.contains("`bottom` and `right` contradict each other"),
        "{fault}"
    );
}

/// A hole cannot leave the sheet whose whole outline is held: the state before is kept, and the hand goes on from there.
#[test]
fn a_motion_that_the_sheet_cannot_follow_leaves_the_state_before() {
    let mut case = neo_hooke(0);
    let held = |name: &str, x: f64| {
        let support = Support::Displacement([Some(x), Some(0.0)]);
        (name.to_owned(), support)
    };
    let outline = ["left", "right", "top", "bottom"].map(|name| held(name, 0.0));
    case.problem.supports = outline.into();
    case.problem.supports.push(held("hole", 0.5));
    let mut hand = taken(&case);
    let (before, grips) = (hand.state().state.clone(), hand.grips().clone());
    let fault = hand.move_grips(&[("hole", shifted(30.0, 0.0))]);
    let fault = fault.unwrap_err().to_string();
    let words = "`hole` from (0.300, 0.000) mm turned by 0.00° to (30.000, 0.000) mm";
    assert!(fault.contains(words), "{fault}");
    assert!(fault.contains("the previous field is kept"), "{fault}");
    assert_eq!(hand.state().state, before);
    assert_eq!(*hand.grips(), grips);
    let moved = hand.move_grips(&[("hole", shifted(1.0, 0.2))]).unwrap();
    assert!(moved.work[0].iterations > 0, "{:?}", moved.work);
}
