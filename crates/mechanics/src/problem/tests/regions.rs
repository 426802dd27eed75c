//! Sheets of several laws: strips in series and in parallel by closed forms, and what does not depend on the division.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::samples::{NEWTON, problem, solved};
use crate::mass_spring::MassSpring;
use crate::material::curve::Mode;
use crate::material::{HyperelasticLaw, NeoHooke, Ogden, SoftenedLaw, Softening, Yeoh};
use crate::mesh::{CellShape, Mesh, Shape};
use crate::problem::{BoundaryProblem, Region, Support};
use crate::solve::State;
use crate::statistics::bisect;

const SIZE: [f64; 2] = [24.0, 12.0];

fn laws() -> [Arc<dyn HyperelasticLaw>; 2] {
    let stiff = Yeoh {
        coefficients: [0.18, -0.004, 0.002],
    };
    [Arc::new(NeoHooke { c10: 0.05 }), Arc::new(stiff)]
}

/// A strip whose cells left of or below its middle are the region `first`, the others `second`.
fn halves(axis: usize, shape: CellShape) -> Mesh {
    let mut mesh = Shape::Strip { size: SIZE }.mesh(4, shape);
    let middle = mesh.middle()[axis];
    for (name, side) in [("first", -1.0), ("second", 1.0)] {
        let within = |node: &usize| side * (mesh.nodes[*node][axis] - middle) > -1e-9;
        let nodes: BTreeSet<usize> = (0..mesh.nodes.len()).filter(within).collect();
        mesh.name_nodes(name, &nodes);
    }
    mesh
}

fn region(name: &str, law: &Arc<dyn HyperelasticLaw>) -> Region {
    (name.to_owned(), Arc::clone(law))
}

/// A strip between frictionless supports that is pulled by 40 %, with the upper side free or held.
fn pulled(regions: Vec<Region>, is_free: bool) -> BoundaryProblem {
    let right = Support::Displacement([Some(0.4 * SIZE[0]), None]);
    let mut supports = vec![
        ("left", Support::Roller),
        ("bottom", Support::Roller),
        ("right", right),
    ];
    if !is_free {
        supports.push(("top", Support::Roller));
    }
    BoundaryProblem {
        regions,
        ..problem(&supports, &[])
    }
}

fn both(of: [&Arc<dyn HyperelasticLaw>; 2]) -> Vec<Region> {
    vec![region("first", of[0]), region("second", of[1])]
}

/// The state of springs on the corners of a mesh, and their force on the right.
fn springs(problem: &BoundaryProblem, mesh: &Mesh) -> (State, f64) {
    let lattice = MassSpring::on_mesh(problem.laws(), problem.thickness, mesh.linear());
    let model = problem.on(&lattice.mesh, lattice.potential()).unwrap();
    let state = model.solve(&[0.5, 1.0], NEWTON, &|_| ()).unwrap().remove(1);
    let force = model.reactions(&state).at_group("right").force[0];
    (state, force)
}

/// Both halves have the same uniaxial stretch, and incompressible laws the same width at it: F = t Σ hᵢ Pᵢ(λ).
#[test]
fn forces_of_strips_in_parallel_add() {
    let laws = laws();
    let [soft, stiff] = laws
        .each_ref()
        .map(|law| Mode::Uniaxial.nominal_stress(&**law, 0.4));
    let exact = 2.0 * 6.0 * (soft + stiff);
    for (_, shape) in CellShape::NAMES {
        let mesh = halves(1, shape);
        let problem = pulled(both([&laws[0], &laws[1]]), true);
        let solution = solved(&problem, &mesh, &["right"]);
        crate::assert_near(solution.reactions[0][0], exact, 1e-8, &shape);
        // Each position has the stress of its own law.
        let sheet = problem.deformed(&mesh, &solution.state);
        let middle = mesh.middle()[1];
        for (y, stress) in [(middle - 3.0, soft), (middle + 3.0, stiff)] {
            let p = sheet.stress_at([10.0, y]).unwrap().first_piola_kirchhoff;
            crate::assert_near(p[0], stress, 1e-8, &(&shape, &p));
        }
    }
}

/// The width is held, so that each half is in planar tension: P₁(λ₁) = P₂(λ₂), λ₁ + λ₂ = 2 λ.
#[test]
fn strips_in_series_carry_the_same_force() {
    let laws = laws();
    let stress = |law: usize, strain: f64| Mode::Planar.nominal_stress(&*laws[law], strain);
    let [low, high] = bisect([0.0, 0.8], 200, |first| {
        stress(0, first) < stress(1, 0.8 - first)
    });
    let first = 0.5 * (low + high);
    let exact = 2.0 * SIZE[1] * stress(0, first);
    assert!(first > 0.5, "the soft half is stretched more: {first}");
    for (_, shape) in CellShape::NAMES {
        let mesh = halves(0, shape);
        let problem = pulled(both([&laws[0], &laws[1]]), false);
        let solution = solved(&problem, &mesh, &["right"]);
        crate::assert_near(solution.reactions[0][0], exact, 1e-8, &shape);
        let sheet = problem.deformed(&mesh, &solution.state);
        let [ux, _] = sheet.displacement_at([12.0, mesh.middle()[1]]).unwrap();
        assert!((ux / (12.0 * first) - 1.0).abs() < 1e-8, "{shape:?}: {ux}");
    }
}

/// Of proportional laws, one lattice has the width of the other at every stretch: its force is the mean of both, whatever the springs' own error.
#[test]
fn forces_of_lattices_in_parallel_add() {
    let [soft, stiff]: [Arc<dyn HyperelasticLaw>; 2] =
        [0.05, 0.2].map(|c10| Arc::new(NeoHooke { c10 }) as Arc<dyn HyperelasticLaw>);
    for shape in [CellShape::Quad4, CellShape::Triangle3] {
        let mesh = halves(1, shape);
        let of = |laws| springs(&pulled(laws, true), &mesh).1;
        let [soft_force, stiff_force] = [&soft, &stiff].map(|law| of(both([law, law])));
        let mixed = of(both([&soft, &stiff]));
        let mean = 0.5 * (soft_force + stiff_force);
        let difference = (mixed / mean - 1.0).abs();
        let rounding = if shape == CellShape::Quad4 {
            1e-10
        } else {
            0.02
        };
        assert!(difference < rounding, "{shape:?}: {difference}");
        // The error is that of springs of one law.
        let exact = |law: &Arc<dyn HyperelasticLaw>| {
            2.0 * SIZE[1] * Mode::Uniaxial.nominal_stress(&**law, 0.4)
        };
        let usual = soft_force / exact(&soft);
        let ratio = mixed / (0.5 * (exact(&soft) + exact(&stiff)));
        crate::assert_near(ratio, usual, rounding, &shape);
    }
}

#[test]
fn regions_of_one_law_are_the_sheet_of_that_law() {
    let law: Arc<dyn HyperelasticLaw> = Arc::new(Ogden {
        terms: vec![[0.03, 2.4], [0.01, -1.7]],
    });
    for shape in [CellShape::Quad9, CellShape::Triangle3] {
        let mesh = halves(0, shape);
        let one = BoundaryProblem {
            law: Arc::clone(&law),
            ..pulled(Vec::new(), true)
        };
        let several = pulled(both([&law, &law]), true);
        let [one_state, several_state] =
            [&one, &several].map(|problem| solved(problem, &mesh, &[]).state.displacement);
        let [one_lattice, several_lattice] =
            [&one, &several].map(|problem| springs(problem, &mesh).0.displacement);
        for (one, several) in [(one_state, several_state), (one_lattice, several_lattice)] {
            for (one, several) in one.iter().zip(&several) {
                assert!((one - several).abs() < 1e-12 * SIZE[0], "{shape:?}");
            }
        }
    }
}

#[test]
fn names_and_laws_are_exchanged_without_effect() {
    let [soft, stiff] = laws();
    let mesh = halves(0, CellShape::Quad9);
    let problems = [
        vec![region("first", &soft), region("second", &stiff)],
        vec![region("second", &stiff), region("first", &soft)],
        vec![region("second", &stiff)],
    ]
    .map(|regions| pulled(regions, true));
    // The law of the cells of no region is the soft one.
    let [one, other, rest] = problems
        .each_ref()
        .map(|problem| solved(problem, &mesh, &[]));
    let [spring, other_spring, rest_spring] =
        problems.each_ref().map(|problem| springs(problem, &mesh).0);
    for (one, other) in [
        (&one.state, &other.state),
        (&one.state, &rest.state),
        (&spring, &other_spring),
        (&spring, &rest_spring),
    ] {
        for (one, other) in one.displacement.iter().zip(&other.displacement) {
            assert!((one - other).abs() < 1e-11, "{one} {other}");
        }
    }
}

/// Only the softening half dissipates, by the energy of its own largest stretch.
#[test]
fn each_region_softens_by_its_own_law() {
    let softening = Softening {
        r: 2.0,
        m: 0.01,
        beta: 0.1,
    };
    let [soft, stiff] = laws();
    let softened: Arc<dyn HyperelasticLaw> =
        Arc::new(SoftenedLaw::unloaded(Arc::clone(&soft), softening));
    let mesh = halves(1, CellShape::Quad9);
    let problem = pulled(both([&softened, &stiff]), true);
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    let states = model.solve(&[0.5, 1.0, 0.5], NEWTON, &|_| ()).unwrap();
    let work = model.work(&states[2]).unwrap();
    let most = soft.tension([1.0, 0.0], 0.4).energy;
    let exact = 0.5 * SIZE[0] * SIZE[1] * 2.0 * softening.dissipated(most);
    crate::assert_near(work.dissipated, exact, 1e-8, &work);
}
