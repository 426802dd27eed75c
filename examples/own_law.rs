//! A material law that gelbench does not have: its energy and derivatives, and nothing more. A strip with a hole is
//! stretched by a half; the stress at the edge of the hole follows.
//!
//!     cargo run --release --example own_law
//!
//! ```text
//! force 4.040 N, stress at the hole 0.4654 MPa
//! ```
use std::{error::Error, sync::Arc};

use gelbench::material::{EnergyDerivatives, InvariantLaw, Invariants};
use gelbench::mesh::{CellShape, Shape};
use gelbench::problem::{BoundaryProblem, Support};
use gelbench::solve::NewtonSettings;

/// Ψ = C₁₀ (I₁ − 3) + C₂₀ (I₁ − 3)², all in MPa.
#[derive(Debug)]
struct Quadratic(f64, f64);

impl InvariantLaw for Quadratic {
    fn evaluate(&self, at: Invariants) -> EnergyDerivatives {
        let (Self(c10, c20), i1) = (self, at.i1_minus_3);
        EnergyDerivatives {
            energy: (c10 + c20 * i1) * i1,
            d1: c10 + 2.0 * c20 * i1,
            d11: 2.0 * c20,
            ..Default::default()
        }
    }
}

pub fn report() -> Result<String, Box<dyn Error>> {
    let (size, radius) = ([90.0, 30.0], 6.0);
    let mesh = Shape::StripWithHole { size, radius }.mesh(8, CellShape::Quad9);
    let clamp = |ux| Support::Displacement([Some(ux), Some(0.0)]);
    let problem = BoundaryProblem {
        thickness: 2.0,
        law: Arc::new(Quadratic(0.03, 0.004)),
        regions: Vec::new(),
        supports: vec![("left".into(), clamp(0.0)), ("right".into(), clamp(45.0))],
        loads: vec![],
    };
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy)?;
    let states = model.solve(&[0.5, 1.0], NewtonSettings::default(), &|_| ())?;
    let end = &states[1];
    let force = model.reaction(end, "right")[0];
    let stress = problem
        .deformed(&mesh, end)
        .stress_at([45.0, radius])?
        .cauchy[0];
    Ok(format!(
        "force {force:.3} N, stress at the hole {stress:.4} MPa\n"
    ))
}

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", report()?);
    Ok(())
}
