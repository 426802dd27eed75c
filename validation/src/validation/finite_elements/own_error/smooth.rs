//! Estimated over true error on smooth problems.

use crate::error::Error;
use crate::finite_element::error_estimate::{EnergyError, SheetSolution};
use crate::finite_element::recovery::Recovery;
use crate::mesh::{CellShape, Mesh};
use crate::validation::case::{Block, Check, check, row, table};
use crate::validation::finite_elements::{manufactured, ring, sheet};

/// Amplitude of the manufactured solutions.
const AMPLITUDE: f64 = 0.05;

fn effectivity_check(name: &str, what: &str, effectivity: f64) -> Check {
    let what = format!("{name}: estimated over true error, {what}");
    check(what, "–", effectivity).equal(1.0, 20.0, "exact in the limit")
}

/// Estimated over true error of an element in the energy norm.
pub fn checks(name: &str, shape: CellShape, cells: usize) -> Result<[Check; 2], Error> {
    let manufactured::Solved { mesh, state, field } =
        manufactured::Solved::new(shape, cells, AMPLITUDE)?;
    let solved = on(&mesh, &state.displacement, |solved| {
        let exact = solved.distance(|cell, local| field.gradient(mesh.position(cell, local)));
        effectivity(solved, &exact)
    });
    let (mesh, state) = ring::blown_up(cells, shape)?;
    let (fine, exact) = ring::blown_up(3 * cells, CellShape::Quad9)?;
    let blown_up = on(&mesh, &state.displacement, |solved| {
        let exact = solved.distance(|cell, local| {
            let (there, local) = fine.locate(mesh.position(cell, local));
            fine.gradient_at(&exact.displacement, there, local)
        });
        effectivity(solved, &exact)
    });
    Ok([
        effectivity_check(name, "manufactured solution", solved),
        effectivity_check(name, "ring under pressure", blown_up),
    ])
}

/// Calls with a solution of the case's sheet.
pub fn on<T>(mesh: &Mesh, displacement: &[f64], call: impl FnOnce(&SheetSolution) -> T) -> T {
    let problem = sheet();
    call(&SheetSolution {
        laws: &problem.laws().in_cells(mesh),
        thickness: problem.thickness,
        mesh,
        displacement,
    })
}

fn effectivity(solved: &SheetSolution, exact: &EnergyError) -> f64 {
    (solved.energy_estimate().squared() / exact.squared()).sqrt()
}

/// True and estimated error of the force on a manufactured solution between rollers, in N.
pub struct Force {
    element: String,
    shape: CellShape,
    exact: f64,
    error: f64,
    estimate: f64,
}

impl Force {
    /// Of an element on some cells along a side.
    pub fn new(name: &str, shape: CellShape, cells: usize) -> Result<Self, Error> {
        let pull = manufactured::Pull::new(shape, cells, AMPLITUDE)?;
        let estimate = on(&pull.mesh, &pull.state.displacement, |solved| {
            solved.estimate(&Recovery::new(&pull.mesh), &pull.influence)
        });
        Ok(Self {
            element: name.to_owned(),
            shape,
            exact: pull.exact,
            error: pull.computed - pull.exact,
            estimate: estimate.force,
        })
    }

    fn effectivity(&self) -> f64 {
        self.estimate / self.error
    }

    /// Of all elements but T2, whose two integrals nearly cancel.
    pub fn check(&self) -> Option<Check> {
        let what = "force on a manufactured solution";
        let is_checked = self.shape != CellShape::Triangle6;
        is_checked.then(|| effectivity_check(&self.element, what, self.effectivity()))
    }

    fn row(&self) -> Vec<String> {
        let percent = |error: f64| 100.0 * error / self.exact;
        let errors = [percent(self.error), percent(self.estimate)];
        row(
            &self.element,
            [self.exact, errors[0], errors[1], self.effectivity()],
        )
    }
}

/// The forces of all elements.
pub fn force_table(forces: &[Force]) -> [Block; 2] {
    let text = "The force on the right side for a manufactured solution between four rollers. T2 is not checked: the two \
                integrals of its estimate nearly cancel.";
    let head = "element | exact force [N] | error of the force [%] | the same by recovery [%] | estimated over true error";
    [
        Block::paragraph(text),
        table(head, forces.iter().map(Force::row)),
    ]
}
