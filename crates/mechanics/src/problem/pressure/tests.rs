use super::super::boundary_conditions::Load;
use super::super::tests::samples::{CLAMP, problem, solved, strip, turned};
use crate::mesh::{CellShape, Mesh, Shape};
use crate::solve::assembly::derivative_errors;
use crate::solve::vector::{largest, norm};
use crate::solve::{Assembly, Connectivity, Evaluated, Loading, Local, Potential, Remembering};

/// A smooth field of a tenth of the strip's size.
fn bent(mesh: &Mesh) -> Vec<f64> {
    let field = |[x, y]: &[f64; 2]| {
        [
            0.15 * x + 0.02 * x * y,
            0.01 * x * x - 0.1 * y + 0.03 * y * y,
        ]
    };
    mesh.nodes.iter().flat_map(field).collect()
}

/// Without the strain energy, so that nothing hides the pressure.
struct Nothing(Connectivity);

impl Potential for Nothing {
    fn connectivity(&self) -> &Connectivity {
        &self.0
    }

    fn evaluate_element(
        &self,
        element: usize,
        _: &[f64],
        _: crate::solve::Local<'_>,
    ) -> Result<f64, crate::solve::Inadmissible> {
        Err(crate::solve::Inadmissible { element })
    }
}

impl Remembering for Nothing {
    fn evaluate_after(&self, _: usize, _: &[f64], _: Local<'_>, _: &[f64]) -> Evaluated {
        Ok(0.0)
    }

    fn remember(&self, _: &mut Vec<f64>, _: &[f64]) {}

    fn dissipated(&self, _: &[f64]) -> f64 {
        0.0
    }
}

/// Around the whole boundary a pressure has a potential: the pressure times the area.
#[test]
fn a_pressure_s_energy_force_and_stiffness_are_derivatives_at_finite_strain() {
    for (_, shape) in CellShape::NAMES {
        let mut mesh = strip(shape);
        mesh.name_boundary("boundary", |_| true);
        let problem = problem(&[], &[("boundary", Load::Pressure(0.04))]);
        let none = Nothing(Connectivity::new(2 * mesh.nodes.len()));
        let model = problem.on(&mesh, &none).unwrap();
        let u = bent(&mesh);
        let direction: Vec<f64> = (0..u.len()).map(|i| (1.0 + 3.7 * i as f64).sin()).collect();
        let errors = derivative_errors(&*model.potential(0.8, &[]), &u, &direction);
        assert!(
            errors[0] < 1e-9 && errors[1] < 1e-9,
            "{shape:?}: {errors:?}"
        );
    }
}

/// On a part of the boundary the tangent is not symmetric at its ends; with the skew part it is the derivative.
#[test]
fn the_tangent_of_a_pressure_that_ends_freely_is_complete() {
    for (_, shape) in CellShape::NAMES {
        let mesh = strip(shape);
        let problem = problem(
            &[],
            &[
                ("top", Load::Pressure(0.04)),
                ("right", Load::Pressure(0.01)),
            ],
        );
        let none = Nothing(Connectivity::new(2 * mesh.nodes.len()));
        let model = problem.on(&mesh, &none).unwrap();
        let potential = model.potential(1.0, &[]);
        let u = bent(&mesh);
        let size = u.len();
        let assembly = Assembly::new(&*potential, &vec![false; size]);
        let (mut residual, mut stiffness) = (vec![0.0; size], Vec::new());
        assembly
            .linearise(&*potential, &u, &mut residual, &mut stiffness)
            .unwrap();
        let direction: Vec<f64> = (0..size).map(|i| (1.0 + 3.7 * i as f64).sin()).collect();
        let mut product = assembly.pattern().multiply(&stiffness, &direction);
        let couplings = potential.skew_couplings();
        assert_eq!(
            couplings.len(),
            3,
            "the ends of both, and where the pressure changes"
        );
        for coupling in couplings {
            product[coupling.row] += coupling.stiffness * direction[coupling.column];
            product[coupling.column] -= coupling.stiffness * direction[coupling.row];
        }
        // Forces are quadratic in the positions: one long step is exact.
        let at = |sign: f64| {
            let mut residual = vec![0.0; size];
            let moved: Vec<f64> = u
                .iter()
                .zip(&direction)
                .map(|(u, d)| u + sign * d)
                .collect();
            Assembly::residual(&*potential, &moved, &mut residual).unwrap();
            residual
        };
        let misses: Vec<f64> = at(1.0)
            .into_iter()
            .zip(at(-1.0))
            .zip(&product)
            .map(|((up, down), p)| 0.5 * (up - down) - p)
            .collect();
        assert!(
            norm(&misses) < 1e-13 * norm(&product),
            "{shape:?}: {:.1e}",
            norm(&misses)
        );
        assert!(largest(&product) > 0.0);
    }
}

/// A slender beam that cannot stretch under a force q per length across its turned axis, from its free end, where all is
/// nothing, to its clamp, by Runge and Kutta's method; the displacement of the free end.
///
/// ```text
/// F' = −q n,   M' = −t × F,   θ' = M/(E I),   r' = t
/// ```
fn elastica(q: f64, stiffness: f64, length: f64) -> [f64; 2] {
    const STEPS: usize = 400;
    let slope = |[fx, fy, moment, angle, ..]: [f64; 6]| {
        let (sine, cosine) = angle.sin_cos();
        [
            q * sine,
            -q * cosine,
            sine * fx - cosine * fy,
            moment / stiffness,
            cosine,
            sine,
        ]
    };
    let step = length / STEPS as f64;
    let mut state = [0.0; 6];
    for _ in 0..STEPS {
        let along = |k: [f64; 6], by: f64| std::array::from_fn(|i| state[i] + by * k[i]);
        let k1 = slope(state);
        let k2 = slope(along(k1, 0.5 * step));
        let k3 = slope(along(k2, 0.5 * step));
        let k4 = slope(along(k3, step));
        state = std::array::from_fn(|i| {
            state[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])
        });
    }
    let [.., angle, x, y] = state;
    let [x, y] = turned([-x, -y], std::f64::consts::PI - angle);
    [x - length, y]
}

/// A slender cantilever under a pressure on one side up to its free end, where the tangent is not symmetric.
#[test]
fn a_pressure_may_end_at_a_free_corner() {
    let mesh = Shape::Strip { size: [100.0, 5.0] }.mesh(2, CellShape::Quad9);
    for pressure in [1e-8, 1.5e-5] {
        let problem = problem(&[("left", CLAMP)], &[("top", Load::Pressure(pressure))]);
        let solution = solved(&problem, &mesh, &[]);
        assert!(solution.balance.relative() < 1e-9, "{:?}", solution.balance);
        let log = &solution.state.convergence;
        assert!(log.iterations() <= 15, "{:?}", log.residuals);
        let [x, y] = mesh.displacement_at(&solution.state.displacement, [100.0, 0.0]);
        let beam = elastica(pressure, 0.3 * 5.0_f64.powi(3) / 12.0, 100.0);
        let off = (x - beam[0]).hypot(y - beam[1]) / beam[1].abs();
        assert!(off < 0.02, "{x} {y} {beam:?}");
    }
}
