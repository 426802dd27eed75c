//! The search for the equilibrium nearest to the data.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::edge_motion::{EdgeMotion, Imposed};
use super::regression::{Fit, Regression, Trade, Undetermined};
use super::robust::Robust;
use super::start::{DEGREE, Points, Polynomial};
use super::{OUTSIDE, Specimen};
use crate::error::{Diagnostic, Error, SolveFault};
use crate::material::HyperelasticLaw;
use crate::measurement::Marker;
use crate::mesh::Mesh;
use crate::sheet_energy::SheetEnergy;
use crate::solve::sparse::largest;
use crate::solve::{Assembly, Newton, NewtonSettings, Potential, SparseRows};

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
pub struct Search<'a> {
    pub specimen: &'a Specimen<'a>,
    pub observations: &'a Observations,
    pub motion: EdgeMotion,
    pub energy: SheetEnergy,
    pub newton: Newton,
    pub law: Arc<dyn HyperelasticLaw>,
    pub robust: Robust,
}

/// Where the search is.
#[derive(Clone, Debug)]
struct Place {
    parameters: Vec<f64>,
    field: Vec<f64>,
}

/// The field where the search ends, with what was known on the last step.
pub struct Found<'a> {
    pub search: Search<'a>,
    pub field: Vec<f64>,
    pub residual: Vec<f64>,
    /// ∂u/∂p of one parameter after the other.
    pub sensitivities: Vec<Vec<f64>>,
    pub design: DMatrix<f64>,
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
    /// [`Error::Input`] when nothing loads the specimen, or markers are too few for what is unknown.
    pub fn new(
        specimen: &'a Specimen<'a>,
        observations: &'a Observations,
        motion: EdgeMotion,
        robust: Robust,
    ) -> Result<Self, Error> {
        let mesh = specimen.mesh;
        let energy = SheetEnergy::of_mesh(Arc::clone(&specimen.law), mesh, specimen.thickness);
        let count = energy.unknowns();
        let held = motion.at(&vec![0.0; motion.parameters()]).held(count);
        if !held.iter().any(|held| *held) {
            return Err(Error::input(
                "all edges are free, so that nothing loads the specimen",
                "say which edges are held, or leave their conditions open",
            ));
        }
        let newton = Newton::new(&energy, &held).map_err(solve)?;
        Ok(Self {
            specimen,
            observations,
            motion,
            energy,
            newton,
            law: Arc::clone(&specimen.law),
            robust,
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
        let mut steps = 0;
        loop {
            steps += 1;
            let (still, sensitivities) = self.sensitivities(&place)?;
            let ahead: Vec<f64> = place.field.iter().zip(&still).map(|(u, s)| u + s).collect();
            let columns = sensitivities.iter();
            let columns = columns.map(|column| self.observations.interpolation.multiply(column));
            let columns: Vec<f64> = columns.flatten().collect();
            let rows = 2 * self.observations.chosen.len();
            let design = DMatrix::from_vec(rows, sensitivities.len(), columns);
            let fit = self.regress((&place, steps), &ahead, &design, &mut trade)?;
            let change = combined(&still, &sensitivities, fit.step.as_slice());
            let scale = if self.observations.known_noise {
                self.observations.finest()
            } else {
                trade.variance.sqrt()
            };
            let close = (MOVEMENT * scale).max(1e-9 * largest(&place.field));
            let done = largest(&change) <= close;
            self.advance(&mut place, &change, fit.step.as_slice())?;
            if done || self.motion.parameters() == 0 {
                let multipliers = self.multipliers(&fit, &trade)?;
                let residual = self.settle(&mut place, AT_THE_END)?;
                return Ok(Found {
                    field: place.field,
                    parameters: place.parameters,
                    multipliers,
                    residual,
                    sensitivities,
                    design,
                    fit,
                    trade,
                    steps,
                    search: self,
                });
            }
            if steps == MOST_STEPS {
                return Err(solve(SolveFault::Stalled {
                    iterations: steps,
                    residual: largest(&change) / largest(&place.field),
                    tolerance: close / largest(&place.field),
                }));
            }
        }
    }

    /// A smooth field near the data, in equilibrium, and the markers that it trusts.
    fn start(&mut self) -> Result<(Place, Vec<f64>), Error> {
        let points = self.observations.points();
        let mut last = None;
        for degree in (1..=DEGREE).rev() {
            let polynomial = match self.robust {
                Robust::No => Polynomial::nearest(&points, degree),
                _ => Polynomial::trimmed(&points, degree),
            };
            let Some(polynomial) = polynomial else {
                continue;
            };
            let nodes = self.specimen.mesh.nodes.iter();
            let field: Vec<f64> = nodes.flat_map(|node| polynomial.at(*node)).collect();
            let parameters = self.nearest_parameters(&field);
            let mut place = Place { parameters, field };
            match self.settle(&mut place, ON_THE_WAY) {
                Ok(_) => {
                    let trust = match self.robust {
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
        self.motion.at(&place.parameters).write(&mut place.field);
        let mut residual = vec![0.0; place.field.len()];
        let mesh = self.specimen.mesh;
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

    /// −K⁻¹ F, and ∂u/∂p.
    fn sensitivities(&mut self, place: &Place) -> Result<(Vec<f64>, Vec<Vec<f64>>), Error> {
        let mesh = self.specimen.mesh;
        let describe = |cell: usize| mesh.describe_cell(cell);
        let field = &place.field;
        let residual = self
            .newton
            .tangent(&self.energy, field, &describe)
            .map_err(solve)?;
        let imposed: Imposed = self.motion.at(&place.parameters);
        let motions = imposed.motions(self.motion.parameters(), field.len());
        let mut forces = vec![residual];
        for motion in &motions {
            let mut force = vec![0.0; field.len()];
            Assembly::add_product(&self.energy, field, motion, &mut force).map_err(|fault| {
                solve(SolveFault::Inverted {
                    element: describe(fault.element),
                })
            })?;
            forces.push(force);
        }
        let mut changes = self.newton.changes(&forces).map_err(solve)?;
        let mut sensitivities = changes.split_off(1);
        for (sensitivity, motion) in sensitivities.iter_mut().zip(motions) {
            sensitivity
                .iter_mut()
                .zip(motion)
                .for_each(|(s, m)| *s += m);
        }
        Ok((changes.remove(0), sensitivities))
    }

    fn regress(
        &self,
        (place, steps): (&Place, usize),
        ahead: &[f64],
        design: &DMatrix<f64>,
        trade: &mut Trade,
    ) -> Result<Fit, Error> {
        let residual = self.observations.residual(ahead);
        let none = (DMatrix::zeros(0, design.ncols()), DVector::zeros(0));
        let regression = Regression {
            design,
            residual: &residual,
            weights: &self.observations.weights,
            known_noise: self.observations.known_noise,
            facts: (&none.0, &none.1),
            priors: &self.motion.roughness(&place.parameters),
            robust: self.robust,
            settled: steps > TRADING,
        };
        regression.fit(trade).map_err(|Undetermined| {
            Error::input(
                "the markers do not determine how the edges moved",
                "say more of the edges (free, rigid, known), or measure more markers near them",
            )
        })
    }

    /// K⁻¹ Hᵀ W (d − H u) by the last tangent, with weights relative to their mean.
    fn multipliers(&mut self, fit: &Fit, trade: &Trade) -> Result<Vec<f64>, Error> {
        let Observations { weights, .. } = self.observations;
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        let weight = |row: usize| weights[row / 2] * trade.trust[row / 2] / mean;
        let residual = fit.residual.iter().enumerate();
        let pull: Vec<f64> = residual.map(|(row, r)| -weight(row) * r).collect();
        let force = self.observations.interpolation.multiply_transposed(&pull);
        let mut changes = self.newton.changes(&[force]).map_err(solve)?;
        Ok(changes.remove(0))
    }

    /// The variance of the start.
    fn first_variance(&self, field: &[f64]) -> f64 {
        if self.observations.known_noise {
            return 1.0;
        }
        let residual = self.observations.residual(field);
        (residual.norm_squared() / residual.len() as f64).max(1e-12 * largest(field).powi(2))
    }

    /// Takes the step, or as much of it as leaves all cells admissible; equilibrium is restored where it is lost.
    fn advance(&mut self, place: &mut Place, change: &[f64], step: &[f64]) -> Result<(), Error> {
        const SHORTEST: f64 = 1.0 / 64.0;
        const LOST: f64 = 1e-2;
        let mut length = 1.0;
        let mesh = self.specimen.mesh;
        loop {
            let mut next = place.clone();
            let parameters = next.parameters.iter_mut().zip(step);
            parameters.for_each(|(p, step)| *p += length * step);
            let field = next.field.iter_mut().zip(change);
            field.for_each(|(u, change)| *u += length * change);
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
                    return Ok(());
                }
                Err(fault) if length <= SHORTEST => {
                    return Err(solve(SolveFault::Inverted {
                        element: mesh.describe_cell(fault.element),
                    }));
                }
                Err(_) => length *= 0.5,
            }
        }
    }
}

impl Observations {
    /// The least standard deviation in mm.
    fn finest(&self) -> f64 {
        let most = self.weights.iter().fold(0.0, |most: f64, w| most.max(*w));
        1.0 / most.sqrt()
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
