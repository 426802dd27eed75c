//! A plate that softens: springs, corrected springs and finite elements along one load history.

use std::sync::Arc;

use super::*;
use crate::corrector::climb::{Climb, ClimbSettings};
use crate::finite_element::{Element, FiniteElements};
use crate::material::{NeoHooke, SoftenedLaw, Softening};
use crate::problem::Measures;
use crate::solve::Loading;
use crate::solve::assembly::derivative_errors;

const STRETCHES: [f64; 4] = [0.8, 0.3, 0.6, 1.0];

fn plate() -> ClampedPlate {
    let softening = Softening {
        r: 1.6,
        m: 0.005,
        beta: 0.1,
    };
    ClampedPlate {
        law: Arc::new(SoftenedLaw::unloaded(
            Arc::new(NeoHooke { c10: 0.1 }),
            softening,
        )),
        stretches: STRETCHES.to_vec(),
        ..problem()
    }
}

/// The difference scheme of Gauss is that of bilinear elements: corrected springs are their equilibria, each with a history of its own.
#[test]
fn corrected_springs_that_soften_are_the_equilibria_of_bilinear_elements() {
    let plate = plate();
    let springs = MassSpring::new(&plate, [9, 6], LatticeSettings::default());
    let newton = NewtonSettings {
        tolerance: 1e-12,
        max_iterations: 60,
    };
    let uncorrected = springs.solve(&plate, newton, &|_| ()).unwrap();
    let elements = FiniteElements::new(&plate, [9, 6], Element::Q1);
    let expected = elements.solve(&plate, newton, &|_| ()).unwrap();
    let model = elements.model(&plate);
    let mut corrector = plate_corrector(&plate, &springs.mesh);
    for (step, stretch) in STRETCHES.into_iter().enumerate() {
        let data = &uncorrected[step].displacement;
        let corrected = corrector
            .correct(data, stretch, KnownConditions::ALL)
            .unwrap();
        let force = Measures::of(&elements.mesh, &expected[step]).force;
        assert!(
            (corrected.measures.force / force - 1.0).abs() < 1e-8,
            "{stretch}"
        );
        let field = &expected[step].displacement;
        assert!(
            largest_difference(&corrected.state.displacement, field) < 1e-7,
            "{stretch}"
        );
        let work = plate
            .on(&springs.mesh, corrector.energy())
            .work(&corrected.state)
            .unwrap();
        let other = model.work(&expected[step]).unwrap();
        assert!(
            (work.stored / other.stored - 1.0).abs() < 1e-8,
            "{work:?} {other:?}"
        );
        assert!(
            (work.dissipated / other.dissipated - 1.0).abs() < 1e-8,
            "{work:?} {other:?}"
        );
        corrector = corrector.after(&corrected.state);
    }
    // Forces fall on the way back below those of the first loading, and dissipation never does.
    let force = |stretches: &[f64]| {
        let plate = ClampedPlate {
            stretches: stretches.to_vec(),
            ..plate.clone()
        };
        let states = elements.solve(&plate, newton, &|_| ()).unwrap();
        Measures::of(&elements.mesh, states.last().unwrap()).force
    };
    assert!(force(&[0.8, 0.3]) < 0.9 * force(&[0.3]));
    let lost: Vec<f64> = expected
        .iter()
        .map(|state| model.work(state).unwrap().dissipated)
        .collect();
    assert!(lost[0] > 0.0 && lost[3] > 1.2 * lost[2]);
    assert!((lost[1] / lost[0] - 1.0).abs() < 1e-12 && (lost[2] / lost[0] - 1.0).abs() < 1e-12);
}

#[test]
fn residual_and_stiffness_of_softened_springs_are_derivatives_of_their_energy() {
    let plate = plate();
    let springs = MassSpring::new(&plate, [6, 4], LatticeSettings::default());
    let states = springs
        .solve(&plate, NewtonSettings::default(), &|_| ())
        .unwrap();
    let model = springs.model(&plate);
    let potential = model.potential(STRETCHES[1], &states[1].history);
    let u = &states[1].displacement;
    let direction: Vec<f64> = (0..u.len()).map(|i| (1.3 * i as f64).sin()).collect();
    let errors = derivative_errors(&*potential, u, &direction);
    assert!(errors.iter().all(|error| *error < 1e-7), "{errors:?}");
    // The forces that are told of springs are those that hold each other.
    let reloaded = springs.spring_states(u, &states[1].history);
    let virgin = springs.spring_states(u, &[]);
    let sum = |states: &[crate::mass_spring::SpringState]| -> f64 {
        states.iter().map(|spring| spring.force.abs()).sum()
    };
    assert!(sum(&reloaded) < 0.9 * sum(&virgin));
}

#[test]
fn the_climb_refuses_a_material_with_a_memory() {
    let plate = plate();
    let mut climb = Climb::even(
        &plate,
        [12, 8],
        DifferenceScheme::Gauss,
        ClimbSettings::default(),
    );
    let fault = climb.correct(0.5).unwrap_err().to_string();
    assert!(
        fault.contains("softens") && fault.contains("[softening]"),
        "{fault}"
    );
}
