//! Meshes of other programs with curved sides: the stated error of the force beside the true one.
//!
//! A mesh that is read has parabolas for circles, and so have its refinements: the stated error consists of the
//! discretisation's, by three meshes, and the outline's, by the force on rounded sides. The true force is that of elements
//! on circles, extrapolated from three meshes; its error is below a hundredth of what is judged.

use std::f64::consts::PI;
use std::path::Path;

use super::{held, hole, misfit, solve};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::material::Card;
use crate::mesh::{CellShape, Mesh, Shape};
use crate::problem::BoundaryProblem;
use crate::results::Block;
use crate::studies::specimen::{self, Specimen};
use crate::validation::{Check, Outcome, Prepared, Progress, Wanted, mesh_figure, number};

/// Kinds of cells with curved sides.
const KINDS: [CellShape; 3] = [CellShape::Triangle6, CellShape::Quad9, CellShape::Quad8];

/// A specimen with round sides.
struct Body {
    name: &'static str,
    problem: BoundaryProblem,
    /// The group whose force is compared, along X.
    measured: &'static str,
    mesh: fn(usize, CellShape) -> Mesh,
}

fn bodies() -> [Body; 2] {
    let ring = held(&[
        ("start", [None, Some(0.0)]),
        ("end", [None, Some(0.0)]),
        ("outside", [Some(0.0); 2]),
        ("inside", [Some(1.0), Some(0.0)]),
    ]);
    let strip = held(&[
        ("symmetry_x", [Some(0.0), None]),
        ("symmetry_y", [None, Some(0.0)]),
        ("right", [Some(16.0), None]),
    ]);
    [
        Body {
            name: "half of a ring, its inner edge moved",
            problem: ring,
            measured: "inside",
            mesh: half_ring,
        },
        Body {
            name: "strip with a hole, pulled",
            problem: strip,
            measured: "right",
            mesh: |cells, kind| hole::quarter(10.0, cells, kind),
        },
    ]
}

fn half_ring(cells: usize, kind: CellShape) -> Mesh {
    let ring = Shape::RingSector {
        radii: [10.0, 20.0],
        angle: PI,
    };
    ring.mesh(cells, kind)
}

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("mesh");
    let cells = section.count("cells", 2, 8);
    let exact = section.count("exact", 16, 64);
    section.unknown_keys();
    Box::new(move |progress| compute(cells, exact, progress))
}

fn compute(cells: usize, exact: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    for body in bodies() {
        progress(body.name);
        let truth = truth(&body, exact)?;
        for kind in KINDS {
            for cells in [cells, 2 * cells] {
                rows.push(judge(&body, kind, cells, truth, &mut outcome)?);
            }
        }
    }
    let head = [
        "specimen",
        "cells of the file",
        "force [N]",
        "true force [N]",
        "stated error [%]",
        "true error [%]",
        "stated over true",
    ];
    let text = "The force on the finest of three meshes, each cut out of the cells of the file along their curved sides.";
    outcome.blocks.push(Block::Paragraph(text.into()));
    outcome.blocks.push(Block::table(&head, rows));
    outcome.figures.push(mesh_figure(
        "curved_meshes.png",
        "The coarsest mesh of the ring, of six-node triangles: its sides are parabolas.",
        "Half of a ring",
        &half_ring(cells, CellShape::Triangle6),
    ));
    Ok(outcome)
}

/// The force in N on circles, extrapolated from three meshes.
fn truth(body: &Body, cells: usize) -> Result<f64, Error> {
    let force = |cells: usize| {
        let mesh = (body.mesh)(cells, CellShape::Quad9);
        let energy = body.problem.finite_elements(&mesh);
        let model = body.problem.on(&mesh, &energy).map_err(misfit)?;
        let state = solve(&model, body.name, 1)?;
        Ok(model.reaction(&state, body.measured)[0])
    };
    let forces = [force(cells / 4)?, force(cells / 2)?, force(cells)?];
    Ok(richardson(forces).extrapolated)
}

/// The stated error of a mesh as that of a file, checked beside the true one.
fn judge(
    body: &Body,
    kind: CellShape,
    cells: usize,
    truth: f64,
    outcome: &mut Outcome,
) -> Result<Vec<String>, Error> {
    let mesh = (body.mesh)(cells, kind);
    let what = format!("{} {}", mesh.cell_count(), mesh.element_names());
    let card = Card::load("neo-hooke", Path::new("."))?;
    let specimen = Specimen::of_mesh(card, body.problem.clone(), mesh, kind, body.measured);
    let (force, stated) = specimen::force_with_error(&specimen)?;
    let error = 100.0 * (force / truth - 1.0).abs();
    let ratio = stated / error;
    outcome.checks.push(Check::new(
        format!(
            "{}, {what}: stated over true error or its inverse",
            body.name
        ),
        "–",
        Wanted::AtMost(2.0),
        "the force on circles",
        ratio.max(1.0 / ratio),
    ));
    Ok(vec![
        body.name.into(),
        what,
        format!("{force:.8}"),
        format!("{truth:.8}"),
        number(stated),
        number(error),
        format!("{ratio:.3}"),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stated_error_of_a_curved_mesh_holds_that_of_its_outline() {
        let [_, strip] = bodies();
        let truth = truth(&strip, 12).unwrap();
        for kind in [CellShape::Triangle6, CellShape::Quad8] {
            let mut outcome = Outcome::default();
            let row = judge(&strip, kind, 2, truth, &mut outcome).unwrap();
            assert!(outcome.checks[0].passed(), "{row:?}");
        }
    }
}
