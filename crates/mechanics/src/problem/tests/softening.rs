//! Sheets that soften: load histories against closed forms, work, derivatives.

use std::sync::Arc;

use super::samples::{CLAMP, NEWTON, problem, strip};
use super::*;
use crate::material::sheet::Kinematics;
use crate::material::{HyperelasticLaw, NeoHooke, SoftenedLaw, Softening, Volume, VolumeEnergy};
use crate::problem::{BoundaryProblem, Model};
use crate::solve::Loading;
use crate::solve::assembly::derivative_errors;

const SOFTENING: Softening = Softening {
    r: 1.7,
    m: 0.004,
    beta: 0.1,
};
const C10: f64 = 0.2;
/// Loading, unloading, loading again, beyond, and back.
const FACTORS: [f64; 7] = [0.5, 1.0, 0.4, 0.1, 0.7, 1.2, 0.6];

fn softened(virgin: Arc<dyn HyperelasticLaw>) -> Arc<dyn HyperelasticLaw> {
    Arc::new(SoftenedLaw::unloaded(virgin, SOFTENING))
}

fn soft(supports: &[(&str, Support)]) -> BoundaryProblem {
    BoundaryProblem {
        law: softened(Arc::new(NeoHooke { c10: C10 })),
        ..problem(supports, &[])
    }
}

/// A strip of 30 × 10 × 2 mm between rollers, pulled at the right, and at the top where `both`.
fn pulled(both: bool) -> BoundaryProblem {
    let right = Support::Displacement([Some(30.0), None]);
    let top = Support::Displacement([None, Some(10.0)]);
    let mut supports = vec![
        ("left", Support::Roller),
        ("bottom", Support::Roller),
        ("right", right),
    ];
    if both {
        supports.push(("top", top));
    }
    soft(&supports)
}

#[test]
fn a_homogeneous_strip_follows_its_load_history_as_the_closed_form() {
    for (_, shape) in CellShape::NAMES {
        for both in [false, true] {
            let (mesh, problem) = (strip(shape), pulled(both));
            let energy = problem.finite_elements(&mesh);
            let model = problem.on(&mesh, &energy).unwrap();
            let states = model.solve(&FACTORS, NEWTON, &|_| ()).unwrap();
            let mut most = 0.0_f64;
            for state in &states {
                let l: f64 = 1.0 + state.factor;
                // W₀ and P₀ of neo-Hooke in uniaxial and in equibiaxial tension.
                let [density, stress] = if !both {
                    [C10 * (l * l + 2.0 / l - 3.0), 2.0 * C10 * (l - l.powi(-2))]
                } else {
                    [
                        C10 * (2.0 * l * l + l.powi(-4) - 3.0),
                        2.0 * C10 * (l - l.powi(-5)),
                    ]
                };
                most = most.max(density);
                let [factor, _] = SOFTENING.factor(density, most);
                let [force, _] = model.reaction(state, "right");
                let expected = 20.0 * factor * stress;
                assert!(
                    (force - expected).abs() < 1e-10 * expected,
                    "{shape:?} {both} {}: {force} {expected}",
                    state.factor
                );
                let work = model.work(state).unwrap();
                let [all, lost] = [SOFTENING.energy(density, most), SOFTENING.dissipated(most)];
                crate::assert_near(work.dissipated, 600.0 * lost, 1e-10, &work);
                crate::assert_near(work.stored, 600.0 * (all - lost), 1e-9, &work);
            }
        }
    }
}

/// In compressible plane stress and in plane strain η acts on the whole energy: the field is that of the law itself.
#[test]
fn sheets_that_change_volume_soften_in_their_whole_energy() {
    let volume = Volume {
        bulk_modulus: 0.9,
        energy: VolumeEnergy::Quadratic,
        plane: crate::material::PlaneState::Stress,
    };
    let stress = Arc::new(NeoHooke { c10: C10 }).with_volume(volume).unwrap();
    let strain = stress.in_plane_strain().unwrap();
    for virgin in [stress, strain] {
        let mesh = strip(CellShape::Quad9);
        let solved = |law: Arc<dyn HyperelasticLaw>, factors: &[f64]| {
            let problem = BoundaryProblem {
                law,
                ..pulled(false)
            };
            let energy = problem.finite_elements(&mesh);
            let model = problem.on(&mesh, &energy).unwrap();
            let last = model.reach(factors, NEWTON).unwrap();
            let [force, _] = model.reaction(&last, "right");
            (force, last)
        };
        let (first, top) = solved(Arc::clone(&virgin), &[0.8]);
        let (below, virgin_state) = solved(Arc::clone(&virgin), &[0.3]);
        let (softened_force, state) = solved(softened(Arc::clone(&virgin)), &[0.8, 0.3]);
        let density = |state: &crate::solve::State| {
            let gradient = mesh.gradient_at(&state.displacement, 3, [0.0, 0.0]);
            virgin.stress(&Kinematics::new(&gradient.into()).unwrap()).0
        };
        let [factor, _] = SOFTENING.factor(density(&virgin_state), density(&top));
        crate::assert_near(softened_force, factor * below, 1e-10, &(&below, &first));
        let pairs = state.displacement.iter().zip(&virgin_state.displacement);
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-9));
    }
}

fn clamped() -> BoundaryProblem {
    soft(&[
        ("left", CLAMP),
        ("right", Support::Displacement([Some(30.0), Some(0.0)])),
    ])
}

/// The work of the grip along loading, unloading and loading beyond, by trapezoids of so many steps a leg, and what the plate has
/// stored and dissipated.
fn works(model: &Model, steps: usize) -> [f64; 2] {
    let mut factors = Vec::new();
    // The force has a kink where the load comes back to its largest value: steps end there.
    for [from, to] in [[0.0, 0.6], [0.6, 0.2], [0.2, 0.6], [0.6, 0.9], [0.9, 0.4]] {
        let at = |step: usize| from + (to - from) * step as f64 / steps as f64;
        factors.extend((1..=steps).map(at));
    }
    let states = model.solve(&factors, NEWTON, &|_| ()).unwrap();
    let (mut external, mut before) = (0.0, [0.0; 2]);
    for state in &states {
        let force = model.reaction(state, "right")[0];
        external += 0.5 * (force + before[1]) * 30.0 * (state.factor - before[0]);
        before = [state.factor, force];
    }
    let work = model.work(states.last().unwrap()).unwrap();
    assert!(work.dissipated > 0.05 * work.stored && work.stored > 0.0);
    [external, work.stored + work.dissipated]
}

#[test]
fn the_work_of_the_grip_is_stored_or_dissipated() {
    let (mesh, problem) = (strip(CellShape::Quad9), clamped());
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    let [coarse, fine] = [16, 32].map(|steps| works(&model, steps));
    let error = |[external, internal]: [f64; 2]| external / internal - 1.0;
    // Trapezoids are right to second order.
    let extrapolated = (4.0 * fine[0] - coarse[0]) / 3.0;
    let (off, ratio) = (extrapolated / fine[1] - 1.0, error(coarse) / error(fine));
    let message = format!("{coarse:?} {fine:?}: {off:.1e}, {ratio:.2}");
    assert!(
        error(fine).abs() < 3e-3 && (3.4..4.6).contains(&ratio),
        "{message}"
    );
    assert!(off.abs() < 1e-4, "{message}");
    assert!((coarse[1] / fine[1] - 1.0).abs() < 1e-6, "{message}");
}

/// Load factors on the way change nothing, nor do the steps in which one is reached; while it is loaded for the first time the
/// plate is one that does not soften.
#[test]
fn what_is_found_depends_on_where_the_load_turns_alone() {
    let (mesh, problem) = (strip(CellShape::Quad9), clamped());
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    let force = |factors: &[f64]| {
        let last = model.reach(factors, NEWTON).unwrap();
        model.reaction(&last, "right")[0]
    };
    let few = force(&[0.8, 0.3, 0.5]);
    let many = force(&[0.2, 0.4, 0.8, 0.6, 0.5, 0.3, 0.4, 0.5]);
    assert!((few / many - 1.0).abs() < 1e-9, "{few} {many}");
    let first = force(&[0.5]);
    assert!(first > 1.05 * few, "{first} {few}");
    let virgin = BoundaryProblem {
        law: Arc::new(NeoHooke { c10: C10 }),
        ..clamped()
    };
    let energy = virgin.finite_elements(&mesh);
    let model = virgin.on(&mesh, &energy).unwrap();
    assert!(model.work(&model.reach(&[0.5], NEWTON).unwrap()).is_none());
    let last = model.reach(&[0.2, 0.5], NEWTON).unwrap();
    assert!((model.reaction(&last, "right")[0] / first - 1.0).abs() < 1e-12);
}

#[test]
fn residual_and_stiffness_of_a_softened_sheet_are_derivatives_of_its_energy() {
    let (mesh, problem) = (strip(CellShape::Quad9), clamped());
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    let states = model.solve(&[0.8, 0.6], NEWTON, &|_| ()).unwrap();
    let potential = model.potential(0.6, &states[1].history);
    let u = &states[1].displacement;
    let direction: Vec<f64> = (0..u.len()).map(|i| (1.3 * i as f64).sin()).collect();
    let errors = derivative_errors(&*potential, u, &direction);
    assert!(errors.iter().all(|error| *error < 1e-7), "{errors:?}");
}

/// Points are asked with the fields before.
#[test]
fn the_stress_at_a_point_knows_the_fields_before() {
    let (mesh, problem) = (strip(CellShape::Quad4), pulled(false));
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    let states = model.solve(&[0.9, 0.4], NEWTON, &|_| ()).unwrap();
    let sheet = problem.deformed(&mesh, &states[1]);
    let sheet = sheet.after(vec![states[0].displacement.clone()]);
    let stress = sheet.stress_at([12.0, 4.0]).unwrap().first_piola_kirchhoff[0];
    let [force, _] = model.reaction(&states[1], "right");
    crate::assert_near(20.0 * stress, force, 1e-10, &stress);
}
