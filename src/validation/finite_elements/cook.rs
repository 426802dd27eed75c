//! Cook's membrane: a tapered panel, clamped on the left and sheared on the right, at large strain. All
//! elements have to find the same deflection.
//!
//! # References
//! R. D. Cook, J. Struct. Div. ASCE 100, 1851 (1974), doi:10.1061/JSDEAG.0003877

use std::path::Path;

use super::{held, misfit, solve};
use crate::boundary::Load;
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::mesh::{Block, CellShape, Mesh, mesh_of_blocks};
use crate::validation::{Check, Outcome, Prepared, Progress, Wanted, mesh_figure};

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("mesh");
    let cells = section.count("coarsest", 2, 40);
    section.unknown_keys();
    Box::new(move |progress| compute(cells, progress))
}

fn compute(coarsest: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let extrapolated = |shape: CellShape| -> Result<f64, Error> {
        let mut values = [0.0; 3];
        for (finer, value) in [1, 2, 4].into_iter().zip(&mut values) {
            *value = deflection(&panel(coarsest * finer, shape))?;
        }
        Ok(richardson(values).extrapolated)
    };
    progress("Q2");
    let reference = extrapolated(CellShape::Quad9)?;
    for (name, shape) in CellShape::NAMES {
        if shape == CellShape::Quad9 {
            continue;
        }
        progress(name);
        outcome.checks.push(Check::new(
            format!("{name}: extrapolated deflection"),
            "mm",
            Wanted::Equal(reference, 0.3),
            "Q2, extrapolated from three meshes",
            extrapolated(shape)?,
        ));
    }
    outcome.figures.push(mesh_figure(
        "cook.png",
        "Cook's membrane; the left side is clamped, the right one pushed upward.",
        "Cook's membrane",
        &panel(6, CellShape::Quad9),
    ));
    Ok(outcome)
}

fn panel(cells: usize, shape: CellShape) -> Mesh {
    let block = Block {
        map: Box::new(|[s, t]: [f64; 2]| {
            let (low, high) = (44.0 * s, 44.0 + 16.0 * s);
            [48.0 * s, low + t * (high - low)]
        }),
        cells: [cells; 2],
        sides: ["", "right", "", "left"],
    };
    mesh_of_blocks(&[block], shape)
}

/// Upward displacement of the upper right corner in mm.
fn deflection(mesh: &Mesh) -> Result<f64, Error> {
    let mut problem = held(&[("left", [Some(0.0); 2])]);
    problem
        .loads
        .push(("right".into(), Load::Traction([0.0, 0.01])));
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy).map_err(misfit)?;
    let state = solve(&model, "Cook's membrane", 2)?;
    Ok(mesh.displacement_at(&state.displacement, [48.0, 60.0])[1])
}
