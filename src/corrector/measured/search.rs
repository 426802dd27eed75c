//! The search for the equilibrium nearest to the data.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::edge_motion::EdgeMotion;
use super::regression::{Fit, Regression, Trade, Undetermined};
use super::robust::Robust;
use super::start::{DEGREE, Points, Polynomial};
use super::{Edge, MeasuredForce, OUTSIDE, Specimen, Task};
use crate::error::{Diagnostic, Error, SolveFault};
use crate::material::HyperelasticLaw;
use crate::measurement::Marker;
use crate::mesh::Mesh;
use crate::sheet_energy::SheetEnergy;
use crate::solve::sparse::largest;
use crate::solve::{Assembly, Inadmissible, Newton, NewtonSettings, Potential, SparseRows};

/// The markers on the mesh.
#[derive(Clone, Debug)]
pub struct Observations {
    /// Number of all markers.
    pub markers: usize,
    /// Index of each marker that lies on the mesh.
    pub chosen: Vec<usize>,
    /// Their places in mm.
    pub places: Vec<[f64; 2]>,
    /// Their displacements in mm.
    pub displacements: Vec<[f64; 2]>,
    /// Their weights: 1/variance in 1/mm² where the noise is known, else 1.
    pub weights: Vec<f64>,
    /// Whether the noise is known.
    pub known_noise: bool,
    /// H: two rows a marker.
    pub interpolation: SparseRows,
}

impl Observations {
    /// Finds the markers on a mesh; `noise` is the standard deviation in mm of those that have none.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a number is not finite, a standard deviation is not positive or known for some markers
    /// only, or fewer than three markers lie on the mesh.
    pub fn new(mesh: &Mesh, markers: &[Marker], noise: Option<f64>) -> Result<Self, Diagnostic> {
        let deviation = |marker: &Marker| marker.standard_deviation.or(noise);
        let known = markers
            .iter()
            .filter(|marker| deviation(marker).is_some())
            .count();
        if known > 0 && known < markers.len() {
            let fault = format!(
                "{known} of {} markers have a standard deviation",
                markers.len()
            );
            return Err(Diagnostic::error("", fault).hint("give all of them one, or none"));
        }
        let mut all = Self {
            markers: markers.len(),
            chosen: Vec::new(),
            places: Vec::new(),
            displacements: Vec::new(),
            weights: Vec::new(),
            known_noise: known > 0,
            interpolation: SparseRows::new(2 * mesh.nodes.len()),
        };
        for (index, marker) in markers.iter().enumerate() {
            all.add(mesh, index, marker, deviation(marker))?;
        }
        if all.chosen.len() < 3 {
            let fault = format!(
                "{} of {} markers lie on the mesh",
                all.chosen.len(),
                markers.len()
            );
            return Err(Diagnostic::error("", fault)
                .hint("look at the units and the origins of markers and mesh"));
        }
        Ok(all)
    }

    fn add(
        &mut self,
        mesh: &Mesh,
        index: usize,
        marker: &Marker,
        deviation: Option<f64>,
    ) -> Result<(), Diagnostic> {
        let Marker {
            number,
            place,
            displacement,
            ..
        } = *marker;
        let numbers = place.iter().chain(&displacement);
        if numbers.chain(&deviation).any(|value| !value.is_finite()) {
            let fault = format!("marker {number} has a value that is not a number");
            return Err(Diagnostic::error("", fault).hint("leave the marker out of the frame"));
        }
        let deviation = deviation.unwrap_or(1.0);
        if deviation <= 0.0 {
            let fault = format!("marker {number} has the standard deviation {deviation} mm");
            return Err(Diagnostic::error("", fault).hint("give a positive one, or none"));
        }
        let (cell, local) = mesh.locate(place);
        let shape = mesh.shape(cell);
        let size = if shape.is_triangle() { 1.0 } else { 2.0 };
        if shape.outside(local) / size > OUTSIDE {
            return Ok(());
        }
        let values = shape.values(local);
        for axis in [0, 1] {
            let nodes = mesh.cell(cell).iter().zip(&values);
            self.interpolation
                .push(nodes.map(|(node, value)| (2 * node + axis, *value)));
        }
        self.chosen.push(index);
        self.places.push(place);
        self.displacements.push(displacement);
        self.weights.push(deviation.powi(-2));
        Ok(())
    }

    /// The mean distance of neighbouring markers in mm, from the area of the mesh.
    pub fn spacing(&self, mesh: &Mesh) -> f64 {
        let area = |cell: usize| -> f64 {
            let points = mesh.shape(cell).quadrature().into_iter();
            points
                .map(|(local, weight)| weight * mesh.gradients(cell, local).1)
                .sum()
        };
        let area: f64 = (0..mesh.cell_count()).map(area).sum();
        (area / self.chosen.len() as f64).sqrt()
    }

    /// d − H u, two numbers a marker.
    fn residual(&self, field: &[f64]) -> DVector<f64> {
        let there = self.interpolation.multiply(field);
        let data = self.displacements.iter().flatten();
        DVector::from_iterator(there.len(), data.zip(there).map(|(d, u)| d - u))
    }

    fn points(&self) -> Points<'_> {
        Points {
            places: &self.places,
            displacements: &self.displacements,
        }
    }
}

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
const MOST_STEPS: usize = 40;

/// Steps after which the trade stays as it is: two of equal likelihood could take turns.
const TRADING: usize = 6;

/// Part of the noise by which a last step may still move the field.
const MOVEMENT: f64 = 1e-3;

/// The search on one mesh with one set of conditions.
///
/// Its parameters p are those of the edges' motion, then those of the law.
pub struct Search<'a> {
    pub task: Task<'a>,
    pub motion: EdgeMotion,
    pub law: Arc<dyn HyperelasticLaw>,
    pub energy: SheetEnergy,
    pub newton: Newton,
}

/// Where the search is.
#[derive(Clone, Debug)]
struct Place {
    parameters: Vec<f64>,
    field: Vec<f64>,
}

/// The equations and the observations linearised about a place.
pub struct Linear {
    /// −K⁻¹ F.
    still: Vec<f64>,
    /// ∂u/∂p of one parameter after the other.
    pub sensitivities: Vec<Vec<f64>>,
    /// H ∂u/∂p.
    pub design: DMatrix<f64>,
    /// The derivatives of the measured forces by p, and what is measured more than there, over the deviations.
    facts: (DMatrix<f64>, DVector<f64>),
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
        let newton = Newton::new(&energy, &held).map_err(solve)?;
        Ok(Self {
            task: *task,
            motion,
            law,
            energy,
            newton,
        })
    }

    /// The values of the law's parameters among all.
    pub fn law_values<'b>(&self, parameters: &'b [f64]) -> &'b [f64] {
        &parameters[self.motion.parameters()..]
    }

    /// Takes the law with the parameters.
    fn take_law(&mut self, parameters: &[f64]) {
        if let Some(regressed) = &self.task.knowledge.law {
            self.law = regressed.at(self.law_values(parameters));
            self.energy = self.energy.with_law(Arc::clone(&self.law));
        }
    }

    /// The laws with each of the law's parameters a little smaller and larger, and twice the difference.
    pub fn neighbours(&self, parameters: &[f64]) -> Vec<([Arc<dyn HyperelasticLaw>; 2], f64)> {
        const STEP: f64 = 1e-5;
        let Some(regressed) = &self.task.knowledge.law else {
            return Vec::new();
        };
        let values = self.law_values(parameters);
        let pair = |index: usize| {
            let step = STEP * values[index].abs();
            let moved = [-step, step].map(|step| {
                let mut moved = values.to_vec();
                moved[index] += step;
                regressed.at(&moved)
            });
            (moved, 2.0 * step)
        };
        (0..values.len()).map(pair).collect()
    }

    /// ∂F/∂θ of each parameter θ of the law, at held unknowns too.
    pub fn law_slopes(&self, parameters: &[f64], field: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        let mut slopes = Vec::new();
        for (laws, width) in self.neighbours(parameters) {
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

    /// Finds the equilibrium nearest to the data.
    pub fn run(mut self) -> Result<Found<'a>, Error> {
        let (mut place, trust) = self.start()?;
        let mut trade = Trade {
            smoothing: Vec::new(),
            trust,
            variance: self.first_variance(&place.field),
            sound: 1.0,
        };
        for steps in 1..=MOST_STEPS {
            let linear = self.linearise(&place)?;
            let fit = self.regress((&place, steps), &linear, &mut trade)?;
            let change = combined(&linear.still, &linear.sensitivities, fit.step.as_slice());
            let close = self.close(&trade, &place.field);
            let rest = largest(&change);
            let cut = self.advance(&mut place, &change, fit.step.as_slice())?;
            if rest <= close && !cut {
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
            iterations: MOST_STEPS,
            residual: f64::NAN,
            tolerance: MOVEMENT,
        }))
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
        self.take_law(&place.parameters);
        self.motion.at(&place.parameters).write(&mut place.field);
        let mut residual = vec![0.0; place.field.len()];
        let mesh = self.task.specimen.mesh;
        let describe = |cell: usize| mesh.describe_cell(cell);
        self.newton
            .solve(
                &self.energy,
                &mut place.field,
                &mut residual,
                settings,
                &describe,
            )
            .map_err(solve)?;
        Ok(residual)
    }

    fn linearise(&mut self, place: &Place) -> Result<Linear, Error> {
        let (mesh, field) = (self.task.specimen.mesh, &place.field);
        let describe = |cell: usize| mesh.describe_cell(cell);
        let residual = self
            .newton
            .tangent(&self.energy, field, &describe)
            .map_err(solve)?;
        let motions = self.motion.at(&place.parameters);
        let motions = motions.motions(self.motion.parameters(), field.len());
        let slopes = self.law_slopes(&place.parameters, field)?;
        let mut forces = vec![residual.clone()];
        for motion in &motions {
            let mut force = vec![0.0; field.len()];
            let added = Assembly::add_product(&self.energy, field, motion, &mut force);
            added.map_err(|fault| self.inverted(fault))?;
            forces.push(force);
        }
        forces.extend(slopes.iter().cloned());
        let mut changes = self.newton.changes(&forces).map_err(solve)?;
        let mut sensitivities = changes.split_off(1);
        for (sensitivity, motion) in sensitivities.iter_mut().zip(motions) {
            sensitivity
                .iter_mut()
                .zip(motion)
                .for_each(|(s, m)| *s += m);
        }
        let still = changes.remove(0);
        let interpolation = &self.task.observations.interpolation;
        let columns = sensitivities
            .iter()
            .flat_map(|column| interpolation.multiply(column));
        let design = DMatrix::from_iterator(interpolation.len(), sensitivities.len(), columns);
        let facts = self.facts(field, &residual, &still, &sensitivities, &slopes)?;
        Ok(Linear {
            still,
            sensitivities,
            design,
            facts,
        })
    }

    /// The measured forces, linearised.
    fn facts(
        &self,
        field: &[f64],
        residual: &[f64],
        still: &[f64],
        sensitivities: &[Vec<f64>],
        slopes: &[Vec<f64>],
    ) -> Result<(DMatrix<f64>, DVector<f64>), Error> {
        let measured = &self.task.knowledge.forces;
        let mut rows = DMatrix::zeros(measured.len(), sensitivities.len());
        let mut values = DVector::zeros(measured.len());
        for (row, measured) in measured.iter().enumerate() {
            let MeasuredForce {
                edge,
                axis,
                force,
                standard_deviation,
            } = measured;
            let nodes = &self.task.specimen.mesh.groups()[edge].nodes;
            let grip = self.grip(nodes, *axis, field)?;
            let there = dot(&grip.marks, residual) + dot(&grip.pull, still);
            values[row] = (force - there) / standard_deviation;
            let slopes = grip.slopes(sensitivities, slopes);
            for (column, slope) in slopes.into_iter().enumerate() {
                rows[(row, column)] = slope / standard_deviation;
            }
        }
        Ok((rows, values))
    }

    /// The force on nodes along an axis as a function of the field.
    pub fn grip(&self, nodes: &[usize], axis: usize, field: &[f64]) -> Result<Grip, Error> {
        let mut marks = vec![0.0; field.len()];
        nodes.iter().for_each(|node| marks[2 * node + axis] = 1.0);
        self.newton
            .free()
            .iter()
            .for_each(|unknown| marks[*unknown] = 0.0);
        let mut pull = vec![0.0; field.len()];
        let added = Assembly::add_product(&self.energy, field, &marks, &mut pull);
        added.map_err(|fault| self.inverted(fault))?;
        Ok(Grip { marks, pull })
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
        let mut priors = self.motion.roughness(&place.parameters);
        for prior in &mut priors {
            let rows = prior.slopes.nrows();
            prior.slopes.resize_mut(rows, design.ncols(), 0.0);
        }
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
        let mut changes = self.newton.changes(&[force]).map_err(solve)?;
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
    /// where it is lost. Whether the step was cut.
    fn advance(&mut self, place: &mut Place, change: &[f64], step: &[f64]) -> Result<bool, Error> {
        const SHORTEST: f64 = 1.0 / 64.0;
        const LOST: f64 = 1e-2;
        const NEAR: f64 = 0.5;
        let values = self.law_values(&place.parameters).iter();
        let share = values
            .zip(self.law_values(step))
            .map(|(value, step)| (step / value).abs());
        let mut length = 1.0 / share.fold(1.0, |most: f64, share| most.max(share / NEAR));
        loop {
            let mut next = place.clone();
            let parameters = next.parameters.iter_mut().zip(step);
            parameters.for_each(|(p, step)| *p += length * step);
            let field = next.field.iter_mut().zip(change);
            field.for_each(|(u, change)| *u += length * change);
            self.take_law(&next.parameters);
            self.motion.at(&next.parameters).write(&mut next.field);
            let mut residual = vec![0.0; change.len()];
            match Assembly::residual(&self.energy, &next.field, &mut residual) {
                Ok(_) => {
                    let free = self.newton.free().iter();
                    let lost = free.fold(0.0, |most: f64, i| most.max(residual[*i].abs()));
                    *place = next;
                    if lost > LOST * largest(&residual) {
                        self.settle(place, ON_THE_WAY)?;
                    }
                    return Ok(length < 1.0);
                }
                Err(fault) if length <= SHORTEST => return Err(self.inverted(fault)),
                Err(_) => length *= 0.5,
            }
        }
    }
}

/// The force g·∂Π/∂u of a grip.
pub struct Grip {
    /// g: one at the grip's held unknowns.
    pub marks: Vec<f64>,
    /// g·K.
    pub pull: Vec<f64>,
}

impl Grip {
    /// Its derivatives by p; the last parameters change the law.
    pub fn slopes(&self, sensitivities: &[Vec<f64>], law: &[Vec<f64>]) -> Vec<f64> {
        let columns = sensitivities.iter();
        let mut slopes: Vec<f64> = columns.map(|column| dot(&self.pull, column)).collect();
        let first = slopes.len() - law.len();
        for (slope, own) in slopes[first..].iter_mut().zip(law) {
            *slope += dot(&self.marks, own);
        }
        slopes
    }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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
