//! The equations that the nearest field satisfies, and their dependence on the parameters.

use nalgebra::{DMatrix, DVector};

use super::edges::{Body, EdgeMotion, bodies};
use super::input::{
    DEGREE, Edge, Neighbours, Physics, Polynomial, Specimen, Task, singular_corners,
};
use super::regression::{Robust, Roughness};
use crate::error::{Error, SolveFault};
use crate::material::HyperelasticLaw;
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::vector::{add_scaled, largest};
use crate::solve::{Assembly, Inadmissible, Newton, NewtonSettings, Potential, Sum};

mod approach;
mod body_force;
mod linearise;

pub use approach::approach;
pub use body_force::{BodyForce, nodal_areas};
pub use linearise::{Grip, Linear};

/// How equilibria on the way and at the end are solved: what is near an equilibrium takes at most twenty steps.
pub const ON_THE_WAY: NewtonSettings = NewtonSettings {
    tolerance: 1e-3,
    max_iterations: 30,
};
pub const AT_THE_END: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 20,
};

/// The equations on one mesh with one set of conditions.
///
/// Its parameters p are those of the edges' motion, then those of the law, then those of the forces on the interior.
pub struct Equations<'a> {
    pub task: Task<'a>,
    /// The edges with their conditions; once the data have decided, with their probabilities and as edges of the body.
    pub edges: Vec<Edge>,
    pub motion: EdgeMotion,
    /// The bodies that hold the sheet.
    pub bodies: Vec<Body>,
    pub energy: SheetEnergy,
    pub newton: Newton,
    /// Forces on the interior, where requested, and their present values in N.
    pub body: Option<BodyForce>,
    pub forces: Vec<f64>,
}

#[derive(Clone, Debug)]
pub struct SearchState {
    pub parameters: Vec<f64>,
    pub field: Vec<f64>,
}

impl<'a> Equations<'a> {
    /// The equations of a task.
    ///
    /// # Errors
    /// [`Error::Input`] when nothing loads the specimen.
    pub fn new(task: &Task<'a>, edges: &[Edge]) -> Result<Self, Error> {
        let Specimen {
            mesh,
            laws,
            thickness,
        } = &task.specimen;
        let conditions: Vec<_> = edges
            .iter()
            .map(|edge| (&edge.segment, edge.condition))
            .collect();
        let spacing = task.observations.spacing(mesh);
        let motion = EdgeMotion::new(mesh, &conditions, &singular_corners(edges), spacing);
        let laws = match &task.knowledge.law {
            Some(regressed) => laws.with_law(regressed.at(&regressed.start())),
            None => laws.clone(),
        };
        let energy = SheetEnergy::of_mesh(laws, mesh, *thickness);
        let held = motion
            .at(&vec![0.0; motion.parameters()])
            .held(energy.unknowns());
        if !held.iter().any(|held| *held) {
            return Err(unloaded());
        }
        let weighted = task.knowledge.physics == Physics::Weighted;
        let forces = vec![0.0; energy.unknowns()];
        let newton = if weighted {
            Newton::new(&Sum::with_forces(&energy, &forces), &held)
        } else {
            Newton::new(&energy, &held)
        };
        Ok(Self {
            task: task.clone(),
            edges: edges.to_vec(),
            bodies: bodies(mesh, conditions.iter().copied()),
            motion,
            energy,
            newton: newton.map_err(solve)?,
            body: weighted.then(|| BodyForce::new(mesh, &held)),
            forces,
        })
    }

    pub fn law(&self, cell: usize) -> &dyn HyperelasticLaw {
        self.energy.laws().of(cell)
    }

    /// The number of all parameters.
    pub fn parameter_count(&self) -> usize {
        let body = self.body.as_ref().map_or(0, |body| body.columns().len());
        self.motion.parameters() + self.law_parameter_count() + body
    }

    fn law_parameter_count(&self) -> usize {
        let regressed = self.task.knowledge.law.as_ref();
        regressed.map_or(0, |law| law.parameters().len())
    }

    /// A smooth field near the data, in equilibrium, and its trust of the markers.
    pub fn start(&mut self) -> Result<(SearchState, Vec<f64>), Error> {
        let points = self.task.observations.points();
        let mut last = None;
        for degree in (1..=DEGREE).rev() {
            let polynomial = match self.task.knowledge.robust {
                Robust::No => Polynomial::nearest(&points, degree),
                _ => self.task.observations.trimmed(degree),
            };
            let Some(polynomial) = polynomial else {
                continue;
            };
            let nodes = self.task.specimen.mesh.nodes.iter();
            let field: Vec<f64> = nodes.flat_map(|node| polynomial.at(*node)).collect();
            let mut parameters = self.nearest_parameters(&field);
            if let Some(regressed) = &self.task.knowledge.law {
                parameters.extend(regressed.start());
            }
            parameters.resize(self.parameter_count(), 0.0);
            let mut state = SearchState { parameters, field };
            match self.settle(&mut state, ON_THE_WAY) {
                Ok(_) => {
                    let trust = match self.task.knowledge.robust {
                        Robust::No => vec![1.0; points.positions.len()],
                        _ => polynomial.trust(&points),
                    };
                    return Ok((state, trust));
                }
                Err(fault) => last = Some(fault),
            }
        }
        Err(last.unwrap_or_else(|| {
            Error::input(
                "the markers do not determine even an affine field",
                "give at least three that are not on one line",
            )
        }))
    }

    /// The parameters with which the edges are nearest to a field.
    pub fn nearest_parameters(&self, field: &[f64]) -> Vec<f64> {
        const ITERATIONS: usize = 8;
        const RIDGE: f64 = 1e-9;
        let count = self.motion.parameters();
        let mut p = vec![0.0; count];
        for _ in 0..ITERATIONS {
            let imposed = self.motion.at(&p);
            let (rows, values) = imposed.toward(field, count);
            let mut normal = rows.tr_mul(&rows);
            let mut target = rows.tr_mul(&values);
            let ridge = RIDGE * normal.trace() / count.max(1) as f64;
            for prior in self.motion.roughness(&p) {
                let values = DVector::from_column_slice(&prior.values);
                normal += prior.slopes.tr_mul(&prior.slopes) * ridge;
                target -= prior.slopes.tr_mul(&values) * ridge;
            }
            let diagonal = DMatrix::identity(count, count) * ridge;
            let Some(factor) = (normal + diagonal).cholesky() else {
                break;
            };
            add_scaled(&mut p, 1.0, factor.solve(&target).as_slice());
        }
        p
    }

    /// Brings the inner nodes into equilibrium while the edges stay; returns the residual.
    pub fn settle(
        &mut self,
        state: &mut SearchState,
        settings: NewtonSettings,
    ) -> Result<Vec<f64>, Error> {
        self.settle_from(state, settings, false)
    }

    /// The same; where the tangent is `near` that of the equilibrium it is kept.
    fn settle_from(
        &mut self,
        state: &mut SearchState,
        settings: NewtonSettings,
        near: bool,
    ) -> Result<Vec<f64>, Error> {
        self.set_parameters(&state.parameters);
        let mut wanted = state.field.clone();
        self.motion.at(&state.parameters).write(&mut wanted);
        let mut residual = vec![0.0; state.field.len()];
        let mesh = self.task.specimen.mesh;
        let describe = |cell: usize| mesh.describe_cell(cell);
        let (newton, energy) = (&mut self.newton, &self.energy);
        approach(newton, energy, &mut state.field, &wanted, &describe).map_err(solve)?;
        let field = &mut state.field;
        let solved = self.with_potential(|newton, potential| {
            let method = if near {
                Newton::solve_near
            } else {
                Newton::solve
            };
            method(newton, potential, field, &mut residual, settings, &describe)
        });
        solved.map_err(solve)?;
        Ok(residual)
    }

    /// Calls `work` with the energy and the forces on the interior.
    pub fn with_potential<T>(&mut self, work: impl FnOnce(&mut Newton, &dyn Potential) -> T) -> T {
        match self.body {
            Some(_) => {
                let forced = Sum::with_forces(&self.energy, &self.forces);
                work(&mut self.newton, &forced)
            }
            None => work(&mut self.newton, &self.energy),
        }
    }

    /// The penalised terms: the roughness of the edges' motion, and the forces on the interior.
    pub fn priors(&self, parameters: &[f64]) -> Vec<Roughness> {
        let mut priors = self.motion.roughness(parameters);
        for prior in &mut priors {
            let slopes = std::mem::take(&mut prior.slopes);
            prior.slopes = slopes.resize_horizontally(parameters.len(), 0.0);
        }
        priors.extend(self.body.iter().flat_map(|body| body.roughness(parameters)));
        priors
    }

    /// The values of the law's parameters among all parameters.
    pub fn law_values<'b>(&self, parameters: &'b [f64]) -> &'b [f64] {
        let first = self.motion.parameters();
        &parameters[first..first + self.law_parameter_count()]
    }

    /// The coefficients of the forces on the interior among all parameters.
    pub fn body_coefficients<'b>(&self, parameters: &'b [f64]) -> &'b [f64] {
        &parameters[self.motion.parameters() + self.law_parameter_count()..]
    }

    /// Sets the law and the forces on the interior from the parameters.
    fn set_parameters(&mut self, parameters: &[f64]) {
        if let Some(body) = &self.body {
            let coefficients = self.body_coefficients(parameters);
            self.forces = body.forces(coefficients, self.forces.len());
        }
        if let Some(regressed) = &self.task.knowledge.law {
            self.energy = self
                .energy
                .with_law(regressed.at(self.law_values(parameters)));
        }
    }

    /// For each of the law's parameters the laws with a little smaller and a little larger value.
    pub fn neighbours(&self, parameters: &[f64]) -> Vec<Neighbours> {
        let regressed = self.task.knowledge.law.as_ref();
        let values = self.law_values(parameters);
        regressed.map_or(Vec::new(), |law| law.neighbours(values))
    }

    /// ∂F/∂θ for each parameter θ of the law, including held unknowns.
    pub fn law_slopes(&self, parameters: &[f64], field: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        self.slopes_between(self.neighbours(parameters), field)
    }

    /// The derivatives of F between neighbouring laws, including held unknowns.
    pub fn slopes_between(
        &self,
        neighbours: Vec<Neighbours>,
        field: &[f64],
    ) -> Result<Vec<Vec<f64>>, Error> {
        let mut slopes = Vec::new();
        for (laws, width) in neighbours {
            let mut sides = laws.map(|law| (self.energy.with_law(law), vec![0.0; field.len()]));
            for (energy, residual) in &mut sides {
                Assembly::residual(energy, field, residual)
                    .map_err(|fault| self.inverted(fault))?;
            }
            let [(_, low), (_, high)] = sides;
            let slope = high
                .iter()
                .zip(&low)
                .map(|(high, low)| (high - low) / width);
            slopes.push(slope.collect());
        }
        Ok(slopes)
    }

    pub fn inverted(&self, fault: Inadmissible) -> Error {
        solve(SolveFault::Inverted {
            element: self.task.specimen.mesh.describe_cell(fault.element),
        })
    }

    /// Checks the equilibrium of a state, and restores it where it is lost.
    pub fn balance(&mut self, state: &mut SearchState) -> Result<(), Error> {
        const LOST: f64 = 1e-2;
        self.set_parameters(&state.parameters);
        self.motion.at(&state.parameters).write(&mut state.field);
        let mut residual = vec![0.0; state.field.len()];
        let admissible = self.with_potential(|_, potential| {
            Assembly::residual(potential, &state.field, &mut residual)
        });
        admissible.map_err(|fault| self.inverted(fault))?;
        let free = self.newton.free().iter();
        let lost = free.fold(0.0, |most: f64, unknown| most.max(residual[*unknown].abs()));
        if lost > LOST * largest(&residual) {
            // The tangent of the linearisation before is near.
            self.settle_from(state, ON_THE_WAY, true)?;
        }
        Ok(())
    }
}

/// The refusal of edges none of which is held.
pub fn unloaded() -> Error {
    Error::input(
        "all edges are free, so the specimen is not loaded",
        "state which edges are held, or leave their conditions open",
    )
}

/// A fault of the search as an error.
pub fn solve(fault: SolveFault) -> Error {
    Error::Solve {
        model: "corrector".into(),
        step: "the field nearest to the markers".into(),
        fault,
    }
}
