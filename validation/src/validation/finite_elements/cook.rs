//! Cook's membrane: a tapered panel, clamped on the left and sheared on the right, at large strain. All
//! elements have to find the same deflection, until the panel hangs from its clamp like a rope.
//!
//! # References
//! R. D. Cook, J. Struct. Div. ASCE 100, 1851 (1974), doi:10.1061/JSDEAG.0003877

use std::path::Path;

use super::{held, solve};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::{Richardson, richardson};
use crate::mesh::{Block, CellShape, Mesh, mesh_of_blocks};
use crate::problem::Load;
use crate::validation::case::{
    Check, Computation, Outcome, Progress, check, mesh_figure, section, table,
};

/// A dead shear traction in MPa, and how well the elements have to agree under it, in %.
struct Shear {
    traction: f64,
    tolerance: f64,
}

/// 1/30, 0.4 and 21 times Young's modulus; on a sheet 1 mm thick the last one is 100 N. Under the second one most of the sheet
/// is compressed, the more so the finer the mesh is at the clamp's corner: the orders of the elements scatter from 0 to 1.2
/// there, and what they tend to is known less exactly.
const SHEARS: [Shear; 3] = [
    Shear {
        traction: 0.01,
        tolerance: 0.3,
    },
    Shear {
        traction: 0.125,
        tolerance: 0.5,
    },
    Shear {
        traction: 6.25,
        tolerance: 0.3,
    },
];

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let cells = section(root, "mesh", |mesh| mesh.count("coarsest", 2, 40));
    Box::new(move |progress| compute(cells, progress))
}

fn compute(coarsest: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    for shear in SHEARS {
        let mut result = Vec::new();
        for (name, shape) in CellShape::NAMES {
            progress.tell(name);
            result.push(Deflection::new(name, shape, coarsest, shear.traction)?);
        }
        result.sort_by_key(|deflection| !deflection.is_reference());
        outcome.checks.extend(shear.checks(&result));
        rows.extend(result.iter().map(Deflection::row));
    }
    let deflections = [1, 2, 4].map(|finer| {
        let cells = coarsest * finer;
        format!("deflection, {cells} × {cells} cells [mm]")
    });
    let deflections = deflections.join(" | ");
    let head = format!("traction [MPa] | element | {deflections} | order | extrapolated [mm]");
    outcome.blocks.push(table(&head, rows));
    outcome.figures.push(mesh_figure(
        "cook.png",
        "Cook's membrane; the left side is clamped, the right one pushed upward.",
        "Cook's membrane",
        &panel(6, CellShape::Quad9),
    ));
    Ok(outcome)
}

/// The deflection of an element on three meshes, each twice as fine as the one before.
struct Deflection {
    element: &'static str,
    traction: f64,
    values: [f64; 3],
    limit: Richardson,
}

impl Deflection {
    fn new(
        element: &'static str,
        shape: CellShape,
        coarsest: usize,
        traction: f64,
    ) -> Result<Self, Error> {
        let mut values = [0.0; 3];
        for (finer, value) in [1, 2, 4].into_iter().zip(&mut values) {
            *value = deflection(&panel(coarsest * finer, shape), traction)?;
        }
        Ok(Self {
            element,
            traction,
            values,
            limit: richardson(values),
        })
    }

    fn is_reference(&self) -> bool {
        self.element == "Q2"
    }

    fn row(&self) -> Vec<String> {
        let order = self.limit.order;
        let order = order.map_or("none".to_owned(), |order| format!("{order:.2}"));
        let [coarse, middle, fine] = self.values.map(|value| format!("{value:.4}"));
        let extrapolated = format!("{:.4}", self.limit.extrapolated);
        let (traction, element) = (self.traction.to_string(), self.element.to_owned());
        vec![traction, element, coarse, middle, fine, order, extrapolated]
    }
}

impl Shear {
    /// The first deflection is what the others are compared with.
    fn checks(&self, result: &[Deflection]) -> Vec<Check> {
        let reference = result[0].limit.extrapolated;
        let others = result[1..].iter().map(|other| {
            let (element, traction) = (other.element, self.traction);
            let what = format!("{element}: extrapolated deflection under {traction} MPa");
            let source = "Q2, extrapolated from three meshes";
            check(what, "mm", other.limit.extrapolated).equal(reference, self.tolerance, source)
        });
        others.collect()
    }
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
    let model = problem.on(mesh, &energy)?.named("Cook's membrane");
    let state = solve(&model, 2)?;
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
                let result = tip(shape);
                let off = (result / reference - 1.0).abs();
                assert!(off < tolerance, "{name}: {result} instead of {reference}");
            }
        }
    }
}
