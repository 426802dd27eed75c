//! Cook's membrane: a tapered panel, clamped on the left and sheared on the right, at large strain. All
//! elements have to find the same deflection, until the panel hangs from its clamp like a rope.
//!
//! # References
//! R. D. Cook, J. Struct. Div. ASCE 100, 1851 (1974), doi:10.1061/JSDEAG.0003877

use std::path::Path;

use super::{held, misfit, solve};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::mesh::{Block, CellShape, Mesh, mesh_of_blocks};
use crate::problem::Load;
use crate::results;
use crate::validation::{Check, Outcome, Prepared, Progress, Wanted, mesh_figure};

/// Dead shear tractions in MPa: 1/30, 0.4 and 21 times Young's modulus, and the agreement that is wanted in %. On a sheet 1 mm
/// thick the last one is 100 N. Under the second one most of the sheet is compressed, the more so the finer the mesh is at the
/// clamp's corner: the orders of the elements scatter from 0 to 1.2 there, and what they tend to is known less exactly.
const TRACTIONS: [(f64, f64); 3] = [(0.01, 0.3), (0.125, 0.5), (6.25, 0.3)];

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("mesh");
    let cells = section.count("coarsest", 2, 40);
    section.unknown_keys();
    Box::new(move |progress| compute(cells, progress))
}

fn compute(coarsest: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    for (traction, tolerance) in TRACTIONS {
        let checks = compare(coarsest, (traction, tolerance), progress, &mut rows)?;
        outcome.checks.extend(checks);
    }
    let heads = [1, 2, 4].map(|finer| {
        let cells = coarsest * finer;
        format!("deflection, {cells} × {cells} cells [mm]")
    });
    let mut head = vec!["traction [MPa]".to_owned(), "element".to_owned()];
    head.extend(heads);
    head.extend(["order".to_owned(), "extrapolated [mm]".to_owned()]);
    outcome.blocks.push(results::Block::Table(head, rows));
    outcome.figures.push(mesh_figure(
        "cook.png",
        "Cook's membrane; the left side is clamped, the right one pushed upward.",
        "Cook's membrane",
        &panel(6, CellShape::Quad9),
    ));
    Ok(outcome)
}

/// The deflections of all elements under a traction in MPa beside that of Q2, with the agreement wanted in %; a row of the table for each element.
fn compare(
    coarsest: usize,
    (traction, tolerance): (f64, f64),
    progress: Progress,
    rows: &mut Vec<Vec<String>>,
) -> Result<Vec<Check>, Error> {
    let mut extrapolated = |name: &str, shape: CellShape| -> Result<f64, Error> {
        progress(name);
        let mut values = [0.0; 3];
        for (finer, value) in [1, 2, 4].into_iter().zip(&mut values) {
            *value = deflection(&panel(coarsest * finer, shape), traction)?;
        }
        let found = richardson(values);
        let mut row = vec![traction.to_string(), name.to_owned()];
        row.extend(values.map(|value| format!("{value:.4}")));
        row.extend([
            found
                .order
                .map_or("none".to_owned(), |order| format!("{order:.2}")),
            format!("{:.4}", found.extrapolated),
        ]);
        rows.push(row);
        Ok(found.extrapolated)
    };
    let reference = extrapolated("Q2", CellShape::Quad9)?;
    let others = CellShape::NAMES.into_iter();
    let others = others.filter(|(_, shape)| *shape != CellShape::Quad9);
    let check = |(name, shape)| {
        Ok(Check::new(
            format!("{name}: extrapolated deflection under {traction} MPa"),
            "mm",
            Wanted::Equal(reference, tolerance),
            "Q2, extrapolated from three meshes",
            extrapolated(name, shape)?,
        ))
    };
    others.map(check).collect()
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

/// Upward displacement of the upper right corner in mm under a traction in MPa.
fn deflection(mesh: &Mesh, traction: f64) -> Result<f64, Error> {
    let mut problem = held(&[("left", [Some(0.0); 2])]);
    problem
        .loads
        .push(("right".into(), Load::Traction([0.0, traction])));
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy).map_err(misfit)?;
    let state = solve(&model, "Cook's membrane", 2)?;
    Ok(mesh.displacement_at(&state.displacement, [48.0, 60.0])[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The panel is stretched to some fifty times its length by 100 N on 1 mm of thickness; six cells along a side leave
    /// T1 with an error of one per cent.
    #[test]
    fn all_elements_reach_very_large_loads() {
        for (traction, tolerance) in [(0.125, 0.03), (6.25, 0.02)] {
            let tip = |shape| deflection(&panel(6, shape), traction).unwrap();
            let reference = tip(CellShape::Quad9);
            assert!(reference > 40.0, "{reference}");
            for (name, shape) in CellShape::NAMES {
                let found = tip(shape);
                let off = (found / reference - 1.0).abs();
                assert!(off < tolerance, "{name}: {found} beside {reference}");
            }
        }
    }
}
