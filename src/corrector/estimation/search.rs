//! The search for the equilibrium nearest to the data.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::approach::approach;
use super::body_force::BodyForce;
use super::edge_motion::{EdgeMotion, Roughness};
use super::linearise::Linear;
use super::observations::Observations;
use super::regression::{Fit, Regression, Trade, Undetermined};
use super::robust::Robust;
use super::start::{DEGREE, Polynomial};
use super::{Edge, Physics, Specimen, Task};
use crate::error::{Error, SolveFault};
use crate::material::HyperelasticLaw;
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::vector::largest;
use crate::solve::{Assembly, Newton, NewtonSettings, Potential, Sum};

/// How equilibria on the way and at the end are solved.
const ON_THE_WAY: NewtonSettings = NewtonSettings {
    tolerance: 1e-3,
    max_iterations: 60,
};
const AT_THE_END: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 20,
};

/// Steps allowed.
pub const MOST_STEPS: usize = 40;

/// Steps after which the trade stays as it is: two of equal likelihood could take turns.
const TRADING: usize = 6;

/// Length of a step in standard errors that does not matter, where a trade that stays lets it become no shorter soon.
const NEAR: f64 = 0.03;

/// The shortest share of a step.
const SHORTEST: f64 = 1.0 / 64.0;

/// Part of the noise by which a last step may still move the field.
const MOVEMENT: f64 = 1e-3;

/// The search on one mesh with one set of conditions.
///
/// Its parameters p are those of the edges' motion, then those of the law, then those of the forces on the interior.
pub struct Search<'a> {
    pub task: Task<'a>,
    pub motion: EdgeMotion,
    pub law: Arc<dyn HyperelasticLaw>,
    pub energy: SheetEnergy,
    pub newton: Newton,
    /// Forces on the interior, where they are wanted, and their present values in N.
    pub body: Option<BodyForce>,
    pub forces: Vec<f64>,
}

/// Where the search is.
#[derive(Clone, Debug)]
pub struct Place {
    pub parameters: Vec<f64>,
    pub field: Vec<f64>,
}

/// The field where the search ends, with what was known on the last step.
pub struct Found<'a> {
    pub search: Search<'a>,
    pub field: Vec<f64>,
    pub residual: Vec<f64>,
    pub linear: Linear,
    pub fit: Fit,
    pub trade: Trade,
    /// p.
    pub parameters: Vec<f64>,
    /// ζ of node after node.
    pub multipliers: Vec<f64>,
    pub steps: usize,
}

impl<'a> Search<'a> {
    /// Prepares a search.
    ///
    /// # Errors
    /// [`Error::Input`] when nothing loads the specimen.
    pub fn new(task: &Task<'a>, edges: &[Edge]) -> Result<Self, Error> {
        let Specimen {
            mesh,
            law,
            thickness,
        } = task.specimen;
        let conditions: Vec<_> = edges
            .iter()
            .map(|edge| (edge.segment, edge.condition))
            .collect();
        let motion = EdgeMotion::new(mesh, &conditions, task.observations.spacing(mesh));
        let law = match &task.knowledge.law {
            Some(regressed) => regressed.at(&regressed.start()),
            None => Arc::clone(law),
        };
        let energy = SheetEnergy::of_mesh(Arc::clone(&law), mesh, *thickness);
        let held = motion
            .at(&vec![0.0; motion.parameters()])
            .held(energy.unknowns());
        if !held.iter().any(|held| *held) {
            return Err(Error::input(
                "all edges are free, so that nothing loads the specimen",
                "say which edges are held, or leave their conditions open",
            ));
        }
        let weighted = task.knowledge.physics == Physics::Weighted;
        let forces = vec![0.0; energy.unknowns()];
        let newton = match weighted {
            true => Newton::new(&Sum::with_forces(&energy, &forces), &held),
            false => Newton::new(&energy, &held),
        };
        Ok(Self {
            task: *task,
            motion,
            law,
            energy,
            newton: newton.map_err(solve)?,
            body: weighted.then(|| BodyForce::new(mesh, &held)),
            forces,
        })
    }

    /// Finds the equilibrium nearest to the data.
    ///
    /// # Errors
    /// [`Error::Input`] when the data do not determine it, [`Error::Solve`] when `most` steps do not reach it.
    pub fn run(mut self, most: usize) -> Result<Found<'a>, Error> {
        let (mut place, trust) = self.start()?;
        let mut trade = Trade {
            smoothing: Vec::new(),
            trust,
            variance: self.first_variance(&place.field),
            sound: 1.0,
        };
        let (mut moved, mut last, mut share) = (f64::NAN, f64::INFINITY, 1.0);
        for steps in 1..=most {
            let linear = self.linearise(&place)?;
            let fit = self.regress((&place, steps), &linear, &mut trade)?;
            let change = combined(&linear.still, &linear.sensitivities, fit.step.as_slice());
            let close = self.close(&trade, &place.field);
            moved = largest(&change) / largest(&place.field);
            // Steps that do not become shorter swing about the nearest field.
            if steps > TRADING && fit.length > 0.5 * last && share > SHORTEST {
                share *= 0.5;
            }
            last = fit.length;
            let near = fit.length <= NEAR && largest(&linear.still) <= close;
            let done = largest(&change) <= close || (steps > TRADING && near);
            let cut = self.advance(&mut place, &change, fit.step.as_slice(), share)?;
            if done && !cut {
                let multipliers = self.multipliers(&fit, &trade)?;
                let residual = self.settle(&mut place, AT_THE_END)?;
                return Ok(Found {
                    field: place.field,
                    parameters: place.parameters,
                    multipliers,
                    residual,
                    linear,
                    fit,
                    trade,
                    steps,
                    search: self,
                });
            }
        }
        Err(solve(SolveFault::Stalled {
            iterations: most,
            residual: moved,
            tolerance: MOVEMENT,
        }))
    }

    /// One linearised regression from the field of another search, with its trust of the markers.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn score(mut self, found: &Found) -> Result<(Fit, Trade), Error> {
        let mut parameters = self.nearest_parameters(&found.field);
        let others = &found.parameters[found.search.motion.parameters()..];
        parameters.extend_from_slice(others);
        let mut place = Place {
            parameters,
            field: found.field.clone(),
        };
        self.settle(&mut place, ON_THE_WAY)?;
        let mut trade = Trade {
            smoothing: Vec::new(),
            ..found.trade.clone()
        };
        let linear = self.linearise(&place)?;
        let fit = self.regress((&place, 1), &linear, &mut trade)?;
        Ok((fit, trade))
    }

    /// The largest move that does not matter, in mm.
    fn close(&self, trade: &Trade, field: &[f64]) -> f64 {
        let Observations {
            weights,
            known_noise,
            ..
        } = self.task.observations;
        let most = weights
            .iter()
            .fold(0.0, |most: f64, weight| most.max(*weight));
        let variance = if *known_noise { 1.0 } else { trade.variance };
        (MOVEMENT * (variance / most).sqrt()).max(1e-9 * largest(field))
    }

    /// A smooth field near the data, in equilibrium, and the markers that it trusts.
    fn start(&mut self) -> Result<(Place, Vec<f64>), Error> {
        let points = self.task.observations.points();
        let mut last = None;
        for degree in (1..=DEGREE).rev() {
            let polynomial = match self.task.knowledge.robust {
                Robust::No => Polynomial::nearest(&points, degree),
                _ => Polynomial::trimmed(&points, degree),
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
            let body = self.body.as_ref().map_or(0, |body| body.columns().len());
            parameters.resize(parameters.len() + body, 0.0);
            let mut place = Place { parameters, field };
            match self.settle(&mut place, ON_THE_WAY) {
                Ok(_) => {
                    let trust = match self.task.knowledge.robust {
                        Robust::No => vec![1.0; points.places.len()],
                        _ => polynomial.trust(&points),
                    };
                    return Ok((place, trust));
                }
                Err(fault) => last = Some(fault),
            }
        }
        Err(last.unwrap_or_else(|| {
            Error::input(
                "the markers do not determine even an affine field",
                "they need to be three at least, and not on one line",
            )
        }))
    }

    /// The parameters with which the edges come nearest to a field.
    fn nearest_parameters(&self, field: &[f64]) -> Vec<f64> {
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
            let step = factor.solve(&target);
            p.iter_mut()
                .zip(step.iter())
                .for_each(|(p, step)| *p += step);
        }
        p
    }

    /// Brings the inner nodes into equilibrium while the edges stay; the residual.
    fn settle(&mut self, place: &mut Place, settings: NewtonSettings) -> Result<Vec<f64>, Error> {
        self.take(&place.parameters);
        let mut wanted = place.field.clone();
        self.motion.at(&place.parameters).write(&mut wanted);
        let mut residual = vec![0.0; place.field.len()];
        let mesh = self.task.specimen.mesh;
        let describe = |cell: usize| mesh.describe_cell(cell);
        let (newton, energy) = (&mut self.newton, &self.energy);
        approach(newton, energy, &mut place.field, &wanted, &describe).map_err(solve)?;
        let field = &mut place.field;
        let solved = match self.body {
            Some(_) => {
                let pushed = Sum::with_forces(&self.energy, &self.forces);
                let newton = &mut self.newton;
                newton.solve(&pushed, field, &mut residual, settings, &describe)
            }
            None => {
                let newton = &mut self.newton;
                newton.solve(&self.energy, field, &mut residual, settings, &describe)
            }
        };
        solved.map_err(solve)?;
        Ok(residual)
    }

    /// What is held down: the roughness of the edges' motion, and the forces on the interior.
    pub fn priors(&self, parameters: &[f64]) -> Vec<Roughness> {
        let mut priors = self.motion.roughness(parameters);
        for prior in &mut priors {
            let slopes = std::mem::take(&mut prior.slopes);
            prior.slopes = slopes.resize_horizontally(parameters.len(), 0.0);
        }
        priors.extend(self.body.iter().flat_map(|body| body.roughness(parameters)));
        priors
    }

    fn regress(
        &self,
        (place, steps): (&Place, usize),
        linear: &Linear,
        trade: &mut Trade,
    ) -> Result<Fit, Error> {
        let Linear { still, design, .. } = linear;
        let ahead: Vec<f64> = place.field.iter().zip(still).map(|(u, s)| u + s).collect();
        let residual = self.task.observations.residual(&ahead);
        let priors = self.priors(&place.parameters);
        let regression = Regression {
            design,
            residual: &residual,
            weights: &self.task.observations.weights,
            known_noise: self.task.observations.known_noise,
            facts: (&linear.facts.0, &linear.facts.1),
            priors: &priors,
            robust: self.task.knowledge.robust,
            settled: steps > TRADING,
        };
        regression.fit(trade).map_err(|Undetermined| {
            Error::input(
                "the data do not determine how the edges moved, or the parameters of the law",
                "say more of the edges (free, rigid, known), measure more markers near them, or find fewer parameters",
            )
        })
    }

    /// K⁻¹ Hᵀ W (d − H u) by the last tangent, with weights relative to their mean.
    fn multipliers(&mut self, fit: &Fit, trade: &Trade) -> Result<Vec<f64>, Error> {
        let Observations { weights, .. } = self.task.observations;
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        let weight = |row: usize| weights[row / 2] * trade.trust[row / 2] / mean;
        let residual = fit.residual.iter().enumerate();
        let pull: Vec<f64> = residual.map(|(row, r)| -weight(row) * r).collect();
        let force = self
            .task
            .observations
            .interpolation
            .multiply_transposed(&pull);
        let mut changes = self.newton.tangent.changes(&[force]).map_err(solve)?;
        Ok(changes.remove(0))
    }

    /// The variance of the start.
    fn first_variance(&self, field: &[f64]) -> f64 {
        if self.task.observations.known_noise {
            return 1.0;
        }
        let residual = self.task.observations.residual(field);
        (residual.norm_squared() / residual.len() as f64).max(1e-12 * largest(field).powi(2))
    }

    /// Takes the step, or as much of it as leaves all cells admissible and the law's parameters near; equilibrium is restored
    /// where it is lost. At most the share `most` of it is taken; whether it was cut beyond that.
    fn advance(
        &mut self,
        place: &mut Place,
        change: &[f64],
        step: &[f64],
        most: f64,
    ) -> Result<bool, Error> {
        const WITHIN: f64 = 0.5;
        let values = self.law_values(&place.parameters).iter();
        let share = values
            .zip(self.law_values(step))
            .map(|(value, step)| (step / value).abs());
        let whole = 1.0 / share.fold(1.0, |most: f64, share| most.max(share / WITHIN));
        let mut length = whole.min(most);
        loop {
            let mut next = place.clone();
            let parameters = next.parameters.iter_mut().zip(step);
            parameters.for_each(|(p, step)| *p += length * step);
            let field = next.field.iter_mut().zip(change);
            field.for_each(|(u, change)| *u += length * change);
            match self.balance(&mut next) {
                Ok(()) => {
                    *place = next;
                    return Ok(length < most);
                }
                Err(fault) if length <= SHORTEST => return Err(fault),
                Err(_) => length *= 0.5,
            }
        }
    }

    /// Looks at the equilibrium of a place, and restores it where it is lost.
    fn balance(&mut self, place: &mut Place) -> Result<(), Error> {
        const LOST: f64 = 1e-2;
        self.take(&place.parameters);
        self.motion.at(&place.parameters).write(&mut place.field);
        let mut residual = vec![0.0; place.field.len()];
        let admissible = Assembly::residual(&*self.potential(), &place.field, &mut residual);
        admissible.map_err(|fault| self.inverted(fault))?;
        let free = self.newton.free().iter();
        let lost = free.fold(0.0, |most: f64, unknown| most.max(residual[*unknown].abs()));
        if lost > LOST * largest(&residual) {
            self.settle(place, ON_THE_WAY)?;
        }
        Ok(())
    }
}

/// still + Σ stepⱼ columnⱼ.
fn combined(still: &[f64], columns: &[Vec<f64>], step: &[f64]) -> Vec<f64> {
    let mut sum = still.to_vec();
    for (column, factor) in columns.iter().zip(step) {
        sum.iter_mut()
            .zip(column)
            .for_each(|(s, c)| *s += factor * c);
    }
    sum
}

/// A fault of the search.
pub fn solve(fault: SolveFault) -> Error {
    Error::Solve {
        model: "corrector".into(),
        step: "the field nearest to the markers".into(),
        fault,
    }
}
