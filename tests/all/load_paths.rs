//! How load paths end.

use std::f64::consts::PI;
use std::sync::Arc;

use gelbench::error::SolveFault;
use gelbench::material::{HyperelasticLaw, MooneyRivlin, NeoHooke, Yeoh};
use gelbench::mesh::{CellShape, Shape};
use gelbench::problem::{BoundaryProblem, Drive, Load, Support};
use gelbench::solve::{NewtonSettings, PathEnd, State};

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 40,
};

const NEO_HOOKE: NeoHooke = NeoHooke { c10: 0.05 };

/// What moves or pulls the right end of a strip.
enum Right {
    Moved([f64; 2]),
    Pulled(f64),
}

/// A strip clamped on its left, to the load factors 0.1 and 1.
fn strip(
    size: [f64; 2],
    cells: usize,
    law: impl HyperelasticLaw + 'static,
    right: &Right,
) -> Result<Vec<State>, PathEnd> {
    let mesh = Shape::Strip { size }.mesh(cells, CellShape::Quad4);
    let mut problem = BoundaryProblem {
        thickness: 1.0,
        law: Arc::new(law),
        regions: Vec::new(),
        supports: vec![("left".into(), Support::Displacement([Some(0.0); 2]))],
        loads: Vec::new(),
    };
    match right {
        Right::Moved(by) => {
            let support = Support::Displacement(by.map(Some));
            problem.supports.push(("right".into(), support));
        }
        Right::Pulled(traction) => {
            let load = Load::Traction([*traction, 0.0]);
            problem.loads.push(("right".into(), load));
        }
    }
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    model.solve(&[0.1, 1.0], NEWTON, &|_| ())
}

fn end(
    size: [f64; 2],
    cells: usize,
    law: impl HyperelasticLaw + 'static,
    right: &Right,
) -> PathEnd {
    strip(size, cells, law, right).expect_err("the path ends early")
}

/// Euler's strut between clamps: ε = π² h²/(3 L²).
#[test]
fn a_squeezed_slender_strip_buckles_in_its_middle() {
    let end = end([100.0, 10.0], 4, NEO_HOOKE, &Right::Moved([-30.0, 0.0]));
    let euler = PI * PI / 3.0 * 0.01;
    let strain = 0.3 * end.reached();
    assert!((strain / euler - 1.0).abs() < 0.1, "{strain} {euler}");
    let SolveFault::Buckling { position } = &end.fault else {
        panic!("{}", end.fault)
    };
    assert!(
        position.contains("(50.0, ") && position.ends_with("along y"),
        "{position}"
    );
    assert_eq!(end.states.len(), 1);
    assert!(end.last.is_some());
}

#[test]
fn a_strip_pressed_through_itself_inverts() {
    let end = end([10.0, 10.0], 2, NEO_HOOKE, &Right::Moved([-20.0, 0.0]));
    // The strip has no length at 0.5.
    assert!(
        end.reached() > 0.49 && end.reached() < 0.5,
        "{}",
        end.reached()
    );
    let output = end.fault.to_string();
    assert!(
        output.starts_with("cell 0 near (2.5, -2.5) mm inverts"),
        "{output}"
    );
}

/// P = 2 (C₁₀ + 2 C₂₀ (I₁ − 3)) (λ − λ⁻²) has a maximum where C₂₀ < 0.
#[test]
fn a_force_ends_at_its_maximum() {
    let [c10, c20] = [0.05, -0.003];
    let law = Yeoh {
        coefficients: [c10, c20, 0.0],
    };
    let stress = |l: f64| 2.0 * (c10 + 2.0 * c20 * (l * l + 2.0 / l - 3.0)) * (l - l.powi(-2));
    let most = (100..400)
        .map(|i| stress(0.01 * f64::from(i)))
        .fold(0.0, f64::max);
    let end = end([30.0, 10.0], 4, law, &Right::Pulled(1.0));
    let SolveFault::LoadMaximum { factor, .. } = end.fault else {
        panic!("{}", end.fault)
    };
    assert_eq!(factor, end.reached());
    // The clamp carries a little more than the free strip.
    assert!((factor / most - 1.0).abs() < 0.02, "{factor} {most}");
}

/// Mooney-Rivlin's laws with C₀₁ < 0 lose their stability: the one at some strain, the other has none at all.
#[test]
fn an_unstable_material_is_named_with_its_cell_and_state() {
    let law = |c10: f64, c01: f64| MooneyRivlin { c10, c01 };
    let right = Right::Moved([60.0, 0.0]);
    let size = [30.0, 10.0];
    for (c01, invariant) in [(-0.2, 3.195), (-0.359, 3.0)] {
        let end = end(size, 4, law(0.3, c01), &right);
        let SolveFault::MaterialUnstable { element, state } = &end.fault else {
            panic!("{}", end.fault)
        };
        assert!(element.starts_with("cell 0 near (1.3, "), "{element}");
        // How near to the loss of stability the path comes is a matter of its steps.
        let actual: f64 = state.strip_prefix("I₁ = ").unwrap().parse().unwrap();
        assert!((actual - invariant).abs() < 0.011, "{state}");
    }
    assert!(strip(size, 4, law(0.3, 0.0), &right).is_ok());
}

/// A strip held in `supports`, to the load factors 0.5 and 1; the states, the displacement and the force of its
/// right side.
fn held(supports: &[(&str, Support)]) -> (Vec<State>, [f64; 2], [f64; 2]) {
    let size = [30.0, 10.0];
    let mesh = Shape::Strip { size }.mesh(4, CellShape::Quad9);
    let support = |(group, support): &(&str, Support)| ((*group).to_owned(), *support);
    let problem = BoundaryProblem {
        thickness: 1.0,
        law: Arc::new(NEO_HOOKE),
        regions: Vec::new(),
        supports: supports.iter().map(support).collect(),
        loads: Vec::new(),
    };
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    let states = model.solve(&[0.5, 1.0], NEWTON, &|_| ()).unwrap();
    let last = &states[1];
    let right = model.reactions(last).at_group("right");
    (states, right.displacement, right.force)
}

/// What the moved grip needs as force, given as force, moves it as far.
#[test]
fn a_rigid_grip_is_moved_by_its_force() {
    let clamp = ("left", Support::Displacement([Some(0.0); 2]));
    let moved = Support::Grip([Drive::Displacement(12.0), Drive::Displacement(4.0)]);
    let (by_motion, _, force) = held(&[clamp, ("right", moved)]);
    assert!(force[0] > 0.1 && force[1] > 0.01, "{force:?}");
    let pulled = Support::Grip(force.map(Drive::Force));
    let (by_force, displacement, _) = held(&[clamp, ("right", pulled)]);
    assert!((displacement[0] - 12.0).abs() < 1e-7 && (displacement[1] - 4.0).abs() < 1e-7);
    let pairs = by_motion[1]
        .displacement
        .iter()
        .zip(&by_force[1].displacement);
    let worst = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    assert!(worst < 1e-7, "{worst}");
    // At half the factor the force is half the force, which is not half the way.
    assert!((by_force[0].displacement[0] - by_motion[0].displacement[0]).abs() < 1.0);
    assert_ne!(by_force[0].displacement, by_motion[0].displacement);
}

/// A strip that keeps its width between rollers: P = 2 C₁₀ (λ − λ⁻³).
#[test]
fn rollers_and_a_pulled_grip_give_planar_tension() {
    let force = 10.0 * 2.0 * 0.05 * (1.5 - 1.5_f64.powi(-3));
    let grip = Support::Grip([Drive::Force(force), Drive::Displacement(0.0)]);
    let (states, moved, reaction) = held(&[
        ("left", Support::Roller),
        ("bottom", Support::Roller),
        ("top", Support::Roller),
        ("right", grip),
    ]);
    assert!((moved[0] - 15.0).abs() < 1e-8, "{moved:?}");
    assert!((reaction[0] / force - 1.0).abs() < 1e-9, "{reaction:?}");
    assert!(states[1].convergence.iterations() < 8);
}

#[test]
fn grips_and_rollers_that_cannot_be_are_refused() {
    let ring = Shape::RingSector {
        radii: [10.0, 15.0],
        angle: 0.5,
    };
    let mesh = ring.mesh(4, CellShape::Quad4);
    let grip = Support::Grip([Drive::Force(1.0), Drive::Displacement(0.0)]);
    let clamp = Support::Displacement([Some(0.0); 2]);
    for (supports, output) in [
        (vec![("inside", Support::Roller)], "not a straight line"),
        (vec![("start", clamp), ("inside", grip)], "another support"),
        (vec![("inside", grip), ("start", clamp)], "another support"),
        (vec![("inside", grip), ("end", grip)], "another grip"),
    ] {
        let support = |(group, support): (&str, Support)| (group.to_owned(), support);
        let problem = BoundaryProblem {
            thickness: 1.0,
            law: Arc::new(NEO_HOOKE),
            regions: Vec::new(),
            supports: supports.into_iter().map(support).collect(),
            loads: Vec::new(),
        };
        let energy = problem.finite_elements(&mesh);
        let actual = problem.on(&mesh, &energy).err().expect("refused");
        assert!(actual.message.contains(output), "{}", actual.message);
    }
}

/// The influence field of a pulled grip is the change of the equilibrium by the force, tied nodes with the others.
#[test]
fn the_influence_of_a_pulled_grip_is_the_derivative_by_its_force() {
    let mesh = Shape::Strip { size: [30.0, 10.0] }.mesh(4, CellShape::Quad4);
    let solved = |force: f64| {
        let clamp = Support::Displacement([Some(0.0); 2]);
        let grip = Support::Grip([Drive::Force(force), Drive::Displacement(0.0)]);
        let problem = BoundaryProblem {
            thickness: 1.0,
            law: Arc::new(NEO_HOOKE),
            regions: Vec::new(),
            supports: vec![("left".into(), clamp), ("right".into(), grip)],
            loads: Vec::new(),
        };
        let energy = problem.finite_elements(&mesh);
        let model = problem.on(&mesh, &energy).unwrap();
        let state = model.solve(&[1.0], NEWTON, &|_| ()).unwrap().remove(0);
        let mut influences = model.influences(std::slice::from_ref(&state), "right", 0);
        (state.displacement, influences.remove(0).unwrap())
    };
    let (_, influence) = solved(0.4);
    let step = 1e-3;
    let [more, less] = [solved(0.4 + step).0, solved(0.4 - step).0];
    for ((more, less), influence) in more.iter().zip(less).zip(&influence) {
        let change = (more - less) / (2.0 * step);
        assert!((change - influence).abs() < 1e-3, "{change} {influence}");
    }
    assert!(influence.iter().any(|u| u.abs() > 10.0), "{influence:?}");
}
