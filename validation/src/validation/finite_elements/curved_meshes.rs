//! Meshes of other programs with curved sides: the stated error of the force compared with the true one.
//!
//! A mesh that is read has parabolas for circles, and so have its refinements: the stated error consists of the
//! discretisation's, by three meshes, and the outline's, by the force on rounded sides. The true force is that of elements
//! on circles, extrapolated from three meshes; its error is below a hundredth of what is judged.

use std::f64::consts::PI;
use std::path::Path;

use super::{held, hole, solve};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::material::Card;
use crate::mesh::{CellShape, Mesh, Shape};
use crate::problem::BoundaryProblem;
use crate::studies::specimen::{self, Specimen};
use crate::validation::case::{
    Block, Check, Computation, Outcome, Progress, check, mesh_figure, number, section, table,
};

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
            name: "strip with a hole in tension",
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
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let [cells, exact] = section(root, "mesh", |mesh| {
        [mesh.count("cells", 2, 8), mesh.count("exact", 16, 64)]
    });
    Box::new(move |progress| compute(cells, exact, progress))
}

fn compute(cells: usize, exact: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    for body in bodies() {
        progress.tell(body.name);
        let truth = truth(&body, exact)?;
        for kind in KINDS {
            for cells in [cells, 2 * cells] {
                let stated = Stated::new(&body, kind, cells, truth)?;
                outcome.checks.push(stated.check());
                rows.push(stated.row());
            }
        }
    }
    let head = "specimen | cells of the file | force [N] | true force [N] | stated error [%] | true error [%] | stated error \
                over true error";
    let text = "The force on the finest of three meshes, each made by subdividing the cells of the file along their curved sides.";
    outcome.blocks = vec![Block::paragraph(text), table(head, rows)];
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
        let model = body.problem.on(&mesh, &energy)?.named(body.name);
        let state = solve(&model, 1)?;
        Ok::<f64, Error>(model.reaction(&state, body.measured)[0])
    };
    let forces = [force(cells / 4)?, force(cells / 2)?, force(cells)?];
    Ok(richardson(forces).extrapolated)
}

/// The stated error of a mesh as that of a file, compared with the true one.
struct Stated {
    body: &'static str,
    /// The cells of the file.
    cells: String,
    /// Forces in N.
    force: f64,
    truth: f64,
    /// Errors in %.
    stated: f64,
    error: f64,
}

impl Stated {
    fn new(body: &Body, kind: CellShape, cells: usize, truth: f64) -> Result<Self, Error> {
        let mesh = (body.mesh)(cells, kind);
        let cells = format!("{} {}", mesh.cell_count(), mesh.element_names());
        let card = Card::load("neo-hooke", Path::new("."))?;
        let specimen = Specimen::of_mesh(card, body.problem.clone(), mesh, kind, body.measured);
        let (force, stated) = specimen::force_with_error(&specimen)?;
        Ok(Self {
            body: body.name,
            cells,
            force,
            truth,
            stated,
            error: 100.0 * (force / truth - 1.0).abs(),
        })
    }

    fn ratio(&self) -> f64 {
        self.stated / self.error
    }

    fn check(&self) -> Check {
        let what = format!(
            "{}, {}: stated over true error or its inverse, whichever is larger",
            self.body, self.cells
        );
        let ratio = self.ratio();
        check(what, "–", ratio.max(1.0 / ratio)).at_most(2.0, "force on meshes with exact circles")
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.body.into(),
            self.cells.clone(),
            format!("{:.8}", self.force),
            format!("{:.8}", self.truth),
            number(self.stated),
            number(self.error),
            format!("{:.3}", self.ratio()),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stated_error_of_a_curved_mesh_holds_that_of_its_outline() {
        let [_, strip] = bodies();
        let truth = truth(&strip, 12).unwrap();
        for kind in [CellShape::Triangle6, CellShape::Quad8] {
            let stated = Stated::new(&strip, kind, 2, truth).unwrap();
            assert!(stated.check().passed(), "{:?}", stated.row());
        }
    }
}
