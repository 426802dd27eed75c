use super::*;
use crate::logic::scene::Outline;

fn task(scene: &Scene, model: Model, settled: bool) -> Task {
    Task {
        settled,
        ..Task::settled(scene, model)
    }
}

fn solved(engine: &mut Engine, scene: &Scene, model: Model, settled: bool) -> Solved {
    engine.answer(&task(scene, model, settled)).result.unwrap()
}

fn small() -> Scene {
    Scene {
        cells: [24, 8],
        ..Scene::default()
    }
}

fn at(scene: &Scene, displacement: [f64; 2], angle: f64) -> Scene {
    Scene {
        grip: Grip {
            displacement,
            angle,
        },
        ..scene.clone()
    }
}

#[test]
fn the_force_at_rest_of_the_grip_does_not_depend_on_the_way_there() {
    let scene = small();
    let goal = at(&scene, [40.0, 6.0], 0.1);
    let (mut one, mut other) = (Engine::default(), Engine::default());
    for model in Model::ALL {
        for displacement in [[10.0, 0.0], [70.0, -5.0]] {
            solved(&mut one, &at(&scene, displacement, 0.2), model, false);
        }
        let [a, b] = [&mut one, &mut other].map(|engine| solved(engine, &goal, model, true));
        for (a, b) in a.force.iter().zip(b.force) {
            assert!((a - b).abs() < 1e-9 * b.abs(), "{model:?}: {a} {b}");
        }
    }
}

#[test]
fn the_quick_force_is_near_the_exact_one() {
    let mut engine = Engine::default();
    let scene = at(&small(), [50.0, 0.0], 0.0);
    let quick = solved(&mut engine, &scene, Model::Corrected, false);
    let exact = solved(&mut engine, &scene, Model::Corrected, true);
    assert!(
        (quick.force[0] / exact.force[0] - 1.0).abs() < 1e-4,
        "{quick:?}"
    );
}

#[test]
fn the_plate_has_the_force_that_the_command_finds() {
    // The README's table at 50 %: 0.009 % above the finite elements' 12.87459 N.
    let mut engine = Engine::default();
    let scene = at(&Scene::default(), [75.0, 0.0], 0.0);
    let solution = solved(&mut engine, &scene, Model::Corrected, true);
    let percent = 100.0 * (solution.force[0] / 12.87459 - 1.0);
    assert_eq!(format!("{percent:.3}"), "0.009", "{:?}", solution.force);
}

#[test]
fn every_shape_has_three_models_in_balance() {
    for (name, outline) in Outline::all([90.0, 30.0]) {
        let scene = Scene {
            outline,
            size: [90.0, 30.0],
            cells: [24, 8],
            ..Scene::default()
        };
        let scene = at(&scene, [20.0, 2.0], 0.05);
        let mut engine = Engine::default();
        let forces = Model::ALL.map(|model| solved(&mut engine, &scene, model, true).force[0]);
        let [springs, corrected, elements] = forces;
        assert!(
            (corrected / elements - 1.0).abs() < 0.05,
            "{name}: {forces:?}"
        );
        assert!((springs / elements - 1.0).abs() < 0.3, "{name}: {forces:?}");
    }
}

#[test]
fn multipliers_are_the_derivative_of_the_smallest_distance_and_vanish_without_one() {
    let scene = at(&small(), [30.0, 0.0], 0.0);
    let mut engine = Engine::default();
    let springs = solved(&mut engine, &scene, Model::Springs, true).displacement;
    let corrected = solved(&mut engine, &scene, Model::Corrected, true).displacement;
    let mut with = |springs: Vec<f64>| {
        let springs = Some(springs);
        let task = Task {
            springs,
            ..task(&scene, Model::Corrected, true)
        };
        engine.answer(&task).result.unwrap().multipliers.unwrap()
    };
    assert!(with(springs).iter().any(|value| value.abs() > 1e-3));
    assert!(with(corrected).iter().all(|value| value.abs() < 1e-6));
}

#[test]
fn faults_are_the_librarys_own() {
    let mut engine = Engine::default();
    let thick = Scene {
        thickness: -1.0,
        ..small()
    };
    let fault = engine
        .answer(&task(&thick, Model::Springs, true))
        .result
        .unwrap_err();
    assert!(fault.message.contains("thickness"), "{fault:?}");
    let pressed = at(&small(), [-149.0, 0.0], 0.0);
    let answer = engine.answer(&task(&pressed, Model::Elements, true));
    assert!(!answer.result.unwrap_err().message.is_empty());
}
