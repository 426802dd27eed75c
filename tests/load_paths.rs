//! How load paths end.

use std::f64::consts::PI;
use std::sync::Arc;

use gelbench::boundary::{BoundaryProblem, Load, Support};
use gelbench::error::SolveFault;
use gelbench::material::{HyperelasticLaw, MooneyRivlin, NeoHooke, Yeoh};
use gelbench::mesh::{CellShape, Shape};
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
    let SolveFault::Buckling { place } = &end.fault else {
        panic!("{}", end.fault)
    };
    assert!(
        place.contains("(50.0, ") && place.ends_with("along y"),
        "{place}"
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
    let told = end.fault.to_string();
    assert!(
        told.starts_with("cell 0 near (2.5, -2.5) mm inverts"),
        "{told}"
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
    let SolveFault::LoadMaximum { factor } = end.fault else {
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
    for (c01, invariant) in [(-0.2, "I₁ = 3.19"), (-0.359, "I₁ = 3.00")] {
        let end = end(size, 4, law(0.3, c01), &right);
        let SolveFault::MaterialUnstable { element, state } = &end.fault else {
            panic!("{}", end.fault)
        };
        assert!(element.starts_with("cell 0 near (1.3, "), "{element}");
        assert_eq!(state, invariant);
    }
    assert!(strip(size, 4, law(0.3, 0.0), &right).is_ok());
}
