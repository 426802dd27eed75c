//! The scale of the picture of the deformed specimen, which differs from that of the specimen at rest: a sheet that
//! comes nearer to its camera by a thousandth of the distance appears to have grown by a thousandth.
//!
//! ```text
//! d = H u + e q,   q = X + H u − c                e the relative error of the scale, c the middle of the markers
//! M ∂p/∂e = AᵀWq/v
//! Cov(p) = C + σₑ² (∂p/∂e)(∂p/∂e)ᵀ
//! ```
//!
//! with A, W, v, M of [`crate::estimation::regression`]. A scale error resembles a uniform stretch, so that data which are explained do
//! not show it.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::estimation::equations::Equations;
use crate::estimation::search::NearestField;
use crate::solve::vector::dot;

/// The changes due to an error of the scale, per relative error.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct ScaleChange {
    /// The force of each body along x and y in N, in the order of the forces.
    pub forces: Vec<[f64; 2]>,
}

impl Equations<'_> {
    /// q of a field, two numbers per marker, in mm.
    pub fn magnified(&self, field: &[f64]) -> Vec<f64> {
        let observations = self.task.observations;
        let displacements = observations.interpolation.multiply(field);
        let at_rest = observations.positions.iter().flatten();
        let mut positions: Vec<f64> = at_rest.zip(displacements).map(|(x, u)| x + u).collect();
        let count = observations.positions.len() as f64;
        let middle = [0, 1].map(|axis| positions.iter().skip(axis).step_by(2).sum::<f64>() / count);
        let rows = positions.iter_mut().enumerate();
        rows.for_each(|(row, position)| *position -= middle[row % 2]);
        positions
    }
}

impl NearestField<'_> {
    /// q as a column.
    pub(in crate::estimation) fn magnification(&self) -> DMatrix<f64> {
        let column = self.equations.magnified(&self.field);
        DMatrix::from_vec(column.len(), 1, column)
    }

    /// ∂p/∂e; must be called before the covariance includes the noise found, because it has to be M⁻¹.
    pub(in crate::estimation) fn scale_response(&self) -> DVector<f64> {
        let column = self.equations.magnified(&self.field);
        let target = self
            .equations
            .target_of(&column, &self.linear.design, &self.variances);
        -(&self.fit.covariance * target)
    }

    /// The changes that follow from ∂p/∂e.
    pub(in crate::estimation) fn scale_change(
        &self,
        response: &DVector<f64>,
    ) -> Result<ScaleChange, Error> {
        let slopes = self.equations.law_slopes(&self.parameters, &self.field)?;
        let along = |body: usize, axis: usize| -> Result<f64, Error> {
            let (_, row) = self.grip_of(body, axis, &slopes)?;
            Ok(dot(&row, response.as_slice()))
        };
        Ok(ScaleChange {
            forces: self.by_body(along)?,
        })
    }

    /// Adds the variance of the scale to the covariance.
    pub(in crate::estimation) fn include_scale(&mut self, response: &DVector<f64>) {
        let deviation = self.equations.task.knowledge.scale_deviation;
        self.fit.covariance += response * response.transpose() * (deviation * deviation);
    }
}

#[cfg(test)]
mod tests {
    use crate::estimation::tests::{SIZE, Truth, estimate_on, measured_force, right, with_grips};
    use crate::estimation::{Alternative, Answer, EdgeCondition, FieldEstimate, Knowledge};
    use crate::markers::Marker;
    use crate::mesh::{CellShape, Mesh};

    const NOISE: f64 = 0.1;

    /// The estimate of a plate in pictures that show it larger by a relative `error`.
    fn seen(truth: &Truth, error: f64, deviation: f64, seed: u64) -> FieldEstimate {
        let mut markers = truth.markers(NOISE, seed);
        let moved = |marker: &Marker, axis: usize| {
            let middle = 0.5 * SIZE[axis];
            error * (marker.position[axis] + marker.displacement[axis] - middle)
        };
        for marker in &mut markers {
            let by = [moved(marker, 0), moved(marker, 1)];
            (0..2).for_each(|axis| marker.displacement[axis] += by[axis]);
        }
        let mesh = Mesh::plate(SIZE, [20, 10], CellShape::Quad9);
        let knowledge = Knowledge {
            scale_deviation: deviation,
            ..with_grips(EdgeCondition::Rigid)
        };
        estimate_on(&mesh, &markers, &knowledge)
    }

    #[test]
    fn the_reported_change_is_that_of_a_larger_picture() {
        let truth = Truth::new();
        let [plain, larger] = [0.0, 1e-3].map(|error| seen(&truth, error, 0.0, 2));
        let index = right(&plain);
        let change = larger.forces[index].force[0].value - plain.forces[index].force[0].value;
        let predicted = 1e-3 * plain.scale_change.forces[index][0];
        assert!(
            (change / predicted - 1.0).abs() < 0.05,
            "{change} {predicted}"
        );
    }

    /// A scale error of ± 0.3 %: most intervals miss the force unless its standard deviation is stated.
    #[test]
    fn intervals_hold_a_stated_error_of_the_scale() {
        let truth = Truth::new();
        let held = |deviation: f64| {
            let errors = [-3e-3, 3e-3].into_iter();
            let cases = errors.flat_map(|error| (0..4).map(move |seed| (error, seed)));
            let holds = cases.filter(|(error, seed)| {
                let result = seen(&truth, *error, deviation, *seed);
                let [low, high] = result.forces[right(&result)].force[0].interval;
                low < truth.force && truth.force < high
            });
            holds.count()
        };
        let (without, with) = (held(0.0), held(3e-3));
        assert!(without < 4 && with == 8, "{without} {with}");
    }

    /// The stated deviation of the scale explains its effects on the markers and on a measured force.
    #[test]
    fn a_stated_error_of_the_scale_is_explained() {
        let truth = Truth::new();
        let mut markers = truth.markers(0.01, 3);
        for marker in &mut markers {
            for axis in [0, 1] {
                let position = marker.position[axis] + marker.displacement[axis];
                marker.displacement[axis] += 5e-3 * (position - 0.5 * SIZE[axis]);
            }
        }
        let mesh = Mesh::plate(SIZE, [20, 10], CellShape::Quad9);
        let answer = |scale_deviation: f64| {
            let knowledge = Knowledge {
                forces: vec![measured_force(truth.force, 0.01 * truth.force)],
                scale_deviation,
                ..with_grips(EdgeCondition::Rigid)
            };
            estimate_on(&mesh, &markers, &knowledge).verdict.answer
        };
        assert_eq!(answer(0.0), Answer::NotExplained);
        assert_ne!(answer(5e-3), Answer::NotExplained);
    }

    #[test]
    fn a_scale_that_is_far_off_is_named() {
        let result = seen(&Truth::new(), 0.05, 0.0, 1);
        assert_eq!(result.verdict.answer, Answer::NotExplained);
        assert_eq!(
            result.verdict.trials[0].alternative,
            Alternative::Scale,
            "{:?}",
            result.verdict.trials
        );
    }
}
