//! Supports that prescribe different motions of the same node.

use std::collections::BTreeMap;

use super::boundary_conditions::Support;
use super::constraints::{Constraints, FACTORS, Motion};
use crate::error::Diagnostic;
use crate::mesh::Mesh;
use crate::units::Linear;

/// What a support prescribes for an unknown.
#[derive(Clone, Copy)]
enum Demand {
    Motion(Motion),
    /// To move with the others of a grip that is pulled.
    Tie,
}

/// Why two supports cannot both hold an unknown.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Conflict {
    Motions,
    GripAndSupport,
    Grips,
}

/// Every pair of supports that contradict each other, with the position of the first node.
pub fn contradictions(
    supports: &[(String, Support)],
    mesh: &Mesh,
) -> Result<Vec<Diagnostic>, Diagnostic> {
    let rounding = 1e-12 * mesh.diagonal();
    let mut demands: BTreeMap<usize, Vec<(usize, Demand)>> = BTreeMap::new();
    for (number, support) in supports.iter().enumerate() {
        let constraints = Constraints::each(mesh, std::slice::from_ref(support))?;
        let Constraints {
            held, ties, forces, ..
        } = constraints;
        let held = held.into_iter();
        let held = held.map(|(unknown, motion)| (unknown, Demand::Motion(motion)));
        let tied = ties
            .into_keys()
            .chain(forces.into_iter().map(|(master, _)| master));
        for (unknown, demand) in held.chain(tied.map(|unknown| (unknown, Demand::Tie))) {
            demands.entry(unknown).or_default().push((number, demand));
        }
    }
    let mut conflicts: BTreeMap<(usize, usize, Conflict), Vec<usize>> = BTreeMap::new();
    for (unknown, demands) in &demands {
        for (position, (later, demand)) in demands.iter().enumerate() {
            for (earlier, other) in &demands[..position] {
                if let Some(conflict) = conflict(*other, *demand, rounding) {
                    let pair = (*earlier, *later, conflict);
                    conflicts.entry(pair).or_default().push(*unknown);
                }
            }
        }
    }
    let diagnostics = conflicts
        .into_iter()
        .map(|(pair, unknowns)| diagnostic(supports, mesh, pair, &unknowns));
    Ok(diagnostics.collect())
}

/// The effects of all supports on the unknowns of a mesh.
pub fn agreeing(supports: &[(String, Support)], mesh: &Mesh) -> Result<Constraints, Diagnostic> {
    match contradictions(supports, mesh)?.into_iter().next() {
        Some(fault) => Err(fault),
        None => Constraints::of(mesh, supports),
    }
}

fn conflict(a: Demand, b: Demand, rounding: f64) -> Option<Conflict> {
    match (a, b) {
        (Demand::Motion(a), Demand::Motion(b)) => {
            let differ = FACTORS.iter().any(|factor| {
                let (a, b) = (a.at(*factor), b.at(*factor));
                (a - b).abs() > rounding + 1e-9 * a.abs().max(b.abs())
            });
            differ.then_some(Conflict::Motions)
        }
        (Demand::Tie, Demand::Tie) => Some(Conflict::Grips),
        _ => Some(Conflict::GripAndSupport),
    }
}

fn diagnostic(
    supports: &[(String, Support)],
    mesh: &Mesh,
    (earlier, later, conflict): (usize, usize, Conflict),
    unknowns: &[usize],
) -> Diagnostic {
    let [one, other] = [earlier, later].map(|number| {
        let (group, support) = &supports[number];
        let what = describe(support);
        format!("support {} on the group `{group}` ({what})", number + 1)
    });
    let position = mesh.describe_unknown(unknowns[0]);
    let more = match unknowns.len() - 1 {
        0 => String::new(),
        1 => " and at 1 more node".to_owned(),
        more => format!(" and at {more} more nodes"),
    };
    let (message, hint) = match conflict {
        Conflict::Motions => (
            format!("{one} and {other} contradict each other at {position}{more}"),
            "leave out one of them, give both the same motion, or leave the shared nodes out of one of the groups",
        ),
        Conflict::GripAndSupport => (
            format!(
                "{one} shares {position}{more} with another support, {other}: one of them is a grip with a force"
            ),
            "leave the node out of one of the groups, or give the grip a displacement there",
        ),
        Conflict::Grips => (
            format!("{one} shares {position}{more} with another grip, {other}"),
            "leave the node out of one of the groups",
        ),
    };
    Diagnostic::error("support", message).hint(hint)
}

/// Describes a support.
fn describe(support: &Support) -> String {
    let axes = |values: [Option<String>; 2]| {
        let named = ["x", "y"].iter().zip(values);
        let given = named.filter_map(|(axis, value)| Some(format!("{axis} = {}", value?)));
        given.collect::<Vec<_>>().join(", ")
    };
    match support {
        Support::Displacement([Some(0.0), Some(0.0)]) => "a clamp".to_owned(),
        Support::Displacement(displacement) => {
            axes(displacement.map(|along| along.map(|u| format!("{u} mm"))))
        }
        Support::LinearDisplacement(field) => axes(field.map(|along| {
            let Linear { at_origin, slope } = along?;
            Some(format!(
                "{at_origin} mm + {} * X + {} * Y",
                slope[0], slope[1]
            ))
        })),
        Support::Radial { displacement, .. } => format!("radial, {displacement} mm"),
        Support::Roller => "a roller".to_owned(),
        Support::Rotation { angle, .. } => format!("a rotation by {angle} rad"),
        Support::Grip(_) => "a grip".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::boundary_conditions::Drive;
    use super::super::tests::samples::{CLAMP, problem, strip};
    use super::*;
    use crate::mesh::CellShape;

    fn messages_of(supports: &[(&str, Support)]) -> Vec<String> {
        let (mesh, problem) = (strip(CellShape::Quad4), problem(supports, &[]));
        let faults = contradictions(&problem.supports, &mesh).unwrap();
        let refused = problem.held_by(&mesh).err().map(|fault| fault.message);
        assert_eq!(refused, faults.first().map(|first| first.message.clone()));
        faults.into_iter().map(|fault| fault.message).collect()
    }

    fn moved(x: Option<f64>, y: Option<f64>) -> Support {
        Support::Displacement([x, y])
    }

    #[test]
    fn different_motions_of_one_unknown_are_told_with_both_supports_and_the_place() {
        let messages = messages_of(&[("left", CLAMP), ("left", moved(Some(5.0), None))]);
        assert_eq!(
            messages,
            [
                "support 1 on the group `left` (a clamp) and support 2 on the group `left` (x = 5 mm) contradict each other at node 0 (0.0, -5.0) mm along x and at 4 more nodes"
            ]
        );
        let corner = messages_of(&[("top", moved(None, Some(1.0))), ("left", CLAMP)]);
        assert_eq!(corner.len(), 1);
        assert!(corner[0].ends_with("(0.0, 5.0) mm along y"), "{corner:?}");
        let turn = Support::Rotation {
            centre: [0.0, 0.0],
            angle: 2.0 * PI,
        };
        // A full turn ends where it began, but moves on the way.
        assert_eq!(messages_of(&[("left", CLAMP), ("left", turn)]).len(), 1);
        let grip = Support::Grip([Drive::Force(1.0), Drive::Displacement(0.0)]);
        for (supports, words) in [
            (
                [("left", grip), ("top", moved(Some(0.0), None))],
                "with another support",
            ),
            ([("left", grip), ("top", grip)], "with another grip"),
        ] {
            let messages = messages_of(&supports);
            assert!(
                messages.iter().any(|text| text.contains(words)),
                "{messages:?}"
            );
        }
        let three = [
            ("left", CLAMP),
            ("top", moved(None, Some(1.0))),
            ("right", moved(Some(2.0), Some(0.0))),
        ];
        assert_eq!(messages_of(&three).len(), 2);
    }

    #[test]
    fn supports_that_agree_may_share_nodes() {
        let linear = |at_origin: f64, slope: [f64; 2]| Some(Linear { at_origin, slope });
        let stretch = Support::LinearDisplacement([linear(0.0, [0.1, 0.0]), None]);
        let right = Support::LinearDisplacement([linear(3.0, [0.0, 0.0]), linear(0.0, [0.0, 0.0])]);
        for supports in [
            vec![
                ("left", CLAMP),
                ("bottom", Support::Roller),
                ("left", CLAMP),
            ],
            vec![
                ("bottom", moved(None, Some(0.0))),
                ("left", moved(Some(0.0), None)),
            ],
            vec![("left", CLAMP), ("top", stretch), ("right", right)],
        ] {
            assert_eq!(messages_of(&supports), Vec::<String>::new());
        }
    }
}
