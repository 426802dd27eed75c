//! The lattice: isotropy, balance, derivatives, inversion.

use std::path::Path;

use super::*;
use crate::material::Card;
use crate::solve::assembly::derivative_errors;

fn problem(card: &str) -> ClampedPlate {
    let law = Card::load(card, Path::new(".")).unwrap().law;
    ClampedPlate {
        size: [30.0, 20.0],
        thickness: 2.0,
        law,
        stretches: vec![0.5],
    }
}

/// A smooth displacement of the nodes, of size `scale` times the plate.
fn field(mesh: &Mesh, scale: f64) -> Vec<f64> {
    let value = |[x, y]: &[f64; 2]| {
        [
            scale * (x + 0.1 * x * y / 20.0),
            scale * (2.0 * (x / 9.0).sin() - 0.4 * y),
        ]
    };
    mesh.nodes.iter().flat_map(value).collect()
}

#[test]
fn residual_and_stiffness_are_derivatives_of_the_energy() {
    for area_term in [false, true] {
        let plate = MassSpring::new(&problem("pva-10"), [6, 3], LatticeSettings { area_term });
        let u = field(&plate.mesh, 0.4);
        let direction: Vec<f64> = (0..u.len()).map(|i| (i as f64 * 1.7).sin()).collect();
        let [residual, stiffness] = derivative_errors(plate.potential(), &u, &direction);
        assert!(
            residual < 1e-8 && stiffness < 1e-8,
            "{area_term}: {residual:.1e} {stiffness:.1e}"
        );
    }
}

/// The small-strain energy of a homogeneous strain, per area and E t, against ½ C ε ε.
#[test]
fn the_lattice_is_isotropic_with_the_stated_poisson_ratio() {
    for (area_term, nu) in [(false, 1.0 / 3.0), (true, 0.5)] {
        let problem = problem("neo-hooke");
        let scale = problem.law.youngs_modulus() * problem.thickness;
        for cells in [[6, 4], [6, 3], [5, 4]] {
            let plate = MassSpring::new(&problem, cells, LatticeSettings { area_term });
            for [exx, eyy, gxy] in [
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [1.0, 0.7, 0.0],
                [0.0, 0.0, 1.0],
                [1.0, -1.0, 2.0],
            ] {
                let small = 1e-6;
                let u: Vec<f64> = plate
                    .mesh
                    .nodes
                    .iter()
                    .flat_map(|[x, y]| {
                        [
                            small * (exx * x + 0.5 * gxy * y),
                            small * (0.5 * gxy * x + eyy * y),
                        ]
                    })
                    .collect();
                let mut residual = vec![0.0; u.len()];
                let energy =
                    crate::solve::Assembly::residual(plate.potential(), &u, &mut residual).unwrap();
                let density = energy / (600.0 * scale * small * small);
                let shear = (1.0 - nu) / 2.0 * gxy * gxy;
                let expected = (exx * exx + eyy * eyy + 2.0 * nu * exx * eyy + shear)
                    / (2.0 * (1.0 - nu * nu));
                crate::assert_near(density, expected, 1e-5, &(&cells, &area_term));
            }
        }
    }
}

#[test]
fn internal_forces_balance_and_a_rigid_motion_is_free() {
    let plate = MassSpring::new(
        &problem("pva-10"),
        [6, 4],
        LatticeSettings { area_term: true },
    );
    let u = field(&plate.mesh, 0.3);
    let mut residual = vec![0.0; u.len()];
    crate::solve::Assembly::residual(plate.potential(), &u, &mut residual).unwrap();
    let size = crate::solve::vector::norm(&residual);
    for axis in 0..2 {
        assert!(residual.iter().skip(axis).step_by(2).sum::<f64>().abs() < 1e-12 * size);
    }
    let moment: f64 = plate
        .mesh
        .nodes
        .iter()
        .enumerate()
        .map(|(node, x)| {
            let (x, y) = (x[0] + u[2 * node], x[1] + u[2 * node + 1]);
            x * residual[2 * node + 1] - y * residual[2 * node]
        })
        .sum();
    assert!(moment.abs() < 1e-10 * size, "{moment:.1e}");
    let (sin, cos) = 0.8_f64.sin_cos();
    let turned: Vec<f64> = plate
        .mesh
        .nodes
        .iter()
        .flat_map(|[x, y]| [cos * x - sin * y - x + 3.0, sin * x + cos * y - y])
        .collect();
    let energy =
        crate::solve::Assembly::residual(plate.potential(), &turned, &mut residual).unwrap();
    assert!(
        energy.abs() < 1e-20 && crate::solve::vector::norm(&residual) < 1e-10,
        "{energy:.1e}"
    );
}

#[test]
fn a_stretch_too_large_for_one_go_is_reached_by_halves() {
    let problem = ClampedPlate {
        size: [150.0, 50.0],
        stretches: vec![0.5, 1.0, 2.0],
        ..problem("neo-hooke")
    };
    let plate = MassSpring::new(&problem, [60, 20], LatticeSettings { area_term: false });
    let settings = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 40,
    };
    let solutions = plate.solve(&problem, settings, &|_| ()).unwrap();
    assert_eq!(solutions[0].load_steps, 1);
    assert!(solutions[2].load_steps > 1 && solutions[2].factor == 2.0);
    assert!(solutions[2].convergence.residuals.last().unwrap() < &1e-10);
}

#[test]
fn an_inverted_cell_is_refused() {
    let plate = MassSpring::new(
        &problem("pva-10"),
        [3, 2],
        LatticeSettings { area_term: false },
    );
    let mut u = vec![0.0; 2 * plate.mesh.nodes.len()];
    u[2 * plate.mesh.cell(0)[0]] = 40.0;
    let mut residual = u.clone();
    assert!(crate::solve::Assembly::residual(plate.potential(), &u, &mut residual).is_err());
}
