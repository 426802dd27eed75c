//! Least squares with bounds: the only module that uses rmpfit, a Levenberg–Marquardt method after MPFIT.
//!
//! # References
//! C. B. Markwardt, ADASS XVIII, ASP Conf. Ser. 411, 251 (2009); J. J. Moré, Lect. Notes Math. 630, 105 (1978)

use nalgebra::{DMatrix, DVector};
use rmpfit::{MPConfig, MPError, MPFitter, MPPar, MPResult, MPSide};

/// Residuals of a model as a function of its parameters.
pub trait Residuals {
    /// The number of residuals.
    fn count(&self) -> usize;

    /// Writes the residuals; returns whether all of them are finite.
    fn evaluate(&self, parameters: &[f64], residuals: &mut [f64]) -> bool;
}

/// Sum of squares; infinite where the model has no value.
pub fn sum_of_squares(model: &dyn Residuals, parameters: &[f64]) -> f64 {
    let mut residuals = vec![0.0; model.count()];
    if !model.evaluate(parameters, &mut residuals) {
        return f64::INFINITY;
    }
    residuals.iter().map(|r| r * r).sum()
}

struct Problem<'a> {
    model: &'a dyn Residuals,
    parameters: Vec<MPPar>,
    config: MPConfig,
    /// The value that replaces residuals which are not finite, so that the step is refused.
    refused: f64,
}

impl MPFitter for Problem<'_> {
    fn eval(&mut self, parameters: &[f64], residuals: &mut [f64]) -> MPResult<()> {
        if residuals.len() != self.model.count() {
            return Err(MPError::Eval);
        }
        if !self.model.evaluate(parameters, residuals) {
            residuals.fill(self.refused);
        }
        Ok(())
    }

    fn number_of_points(&self) -> usize {
        self.model.count()
    }

    fn config(&self) -> &MPConfig {
        &self.config
    }

    fn parameters(&self) -> &[MPPar] {
        &self.parameters
    }
}

/// The precision of the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Until minima can be distinguished.
    Rough,
    /// Until rounding stops it.
    Full,
}

/// The least significant size of a parameter, where no better one is known.
pub const LEAST_SIZE: f64 = 1e-9;

/// Improves `start` within `bounds`; `None` where the method fails from there.
pub fn minimise(
    model: &dyn Residuals,
    start: &[f64],
    bounds: &[[f64; 2]],
    precision: Precision,
) -> Option<Vec<f64>> {
    let begin = sum_of_squares(model, start);
    if !begin.is_finite() {
        return None;
    }
    if bounds.iter().all(|[low, high]| low == high) {
        return Some(start.to_vec());
    }
    let parameter = |[low, high]: &[f64; 2]| MPPar {
        fixed: low == high,
        limited_low: low.is_finite(),
        limited_up: high.is_finite(),
        limit_low: *low,
        limit_up: *high,
        side: MPSide::Both,
        rel_step: 6e-6,
        ..MPPar::new()
    };
    let (tolerance, iterations) = match precision {
        Precision::Rough => (1e-7, 60),
        Precision::Full => (1e-13, 200),
    };
    let mut problem = Problem {
        model,
        parameters: bounds.iter().map(parameter).collect(),
        config: MPConfig {
            ftol: tolerance,
            xtol: tolerance,
            gtol: tolerance,
            max_iter: iterations,
            step_factor: 1.0,
            ..MPConfig::new()
        },
        refused: 1e3 * (begin / model.count() as f64).sqrt().max(1.0),
    };
    let mut result = start.to_vec();
    problem.mpfit(&mut result).ok()?;
    (sum_of_squares(model, &result) <= begin).then_some(result)
}

/// Improves `start` within `bounds` until it is a minimum, or for ten turns; `None` where the method fails from there.
pub fn descend(model: &dyn Residuals, start: &[f64], bounds: &[[f64; 2]]) -> Option<Vec<f64>> {
    const TURNS: usize = 10;
    let mut values = minimise(model, start, bounds, Precision::Full)?;
    for _ in 0..TURNS {
        let Some(lower) = lower(model, &values, bounds) else {
            break;
        };
        values = minimise(model, &lower, bounds, Precision::Full).unwrap_or(lower);
    }
    Some(values)
}

/// Values nearby whose sum of squares S is smaller by more than a millionth of k S/ν, with k values and ν degrees of freedom; `None` at a
/// minimum. Tried are a Gauss–Newton step, halved as often as needed, and a small step of each value away from its bound.
///
/// # References
/// D. M. Bates, D. G. Watts, Technometrics 23, 179 (1981), whose criterion the millionth is the square of
pub fn lower(model: &dyn Residuals, values: &[f64], bounds: &[[f64; 2]]) -> Option<Vec<f64>> {
    const HALVINGS: i32 = 12;
    const INSIDE: [f64; 3] = [1e-3, 1e-5, 1e-7];
    let at = Tangent::new(model, values, bounds)?;
    let limit = at.significantly_smaller()?;
    let is_lower = |tried: &Vec<f64>| sum_of_squares(model, tried) < limit;
    let along = |halvings: i32| at.moved(0.5_f64.powi(halvings));
    let at_bound = (0..values.len()).filter(|index| !at.free.contains(index));
    let bounded = at_bound.filter(|index| (bounds[*index][1] - bounds[*index][0]).is_finite());
    let trials = bounded.flat_map(|index| INSIDE.map(|share| (index, share)));
    let inside = trials.map(|(index, share)| {
        let mut moved = values.to_vec();
        let middle = 0.5 * (bounds[index][0] + bounds[index][1]);
        moved[index] += share * (middle - values[index]);
        moved
    });
    let mut steps = (0..HALVINGS).map(along).chain(inside);
    steps.find(is_lower)
}

/// The residuals at some values, and their derivatives with respect to those that are not at a bound.
struct Tangent<'a> {
    values: &'a [f64],
    bounds: &'a [[f64; 2]],
    free: Vec<usize>,
    jacobian: DMatrix<f64>,
    residual: DVector<f64>,
}

impl<'a> Tangent<'a> {
    fn new(model: &dyn Residuals, values: &'a [f64], bounds: &'a [[f64; 2]]) -> Option<Self> {
        let mut residual = DVector::zeros(model.count());
        if !model.evaluate(values, residual.as_mut_slice()) {
            return None;
        }
        let pairs = values.iter().zip(bounds);
        let is_held = pairs.map(|(value, [low, high])| value <= low || value >= high);
        let held: Vec<bool> = is_held.collect();
        let jacobian = jacobian(model, values, &held, &vec![LEAST_SIZE; values.len()])?;
        let has_effect = |index: &usize| jacobian.column(*index).iter().any(|entry| *entry != 0.0);
        let free: Vec<usize> = (0..values.len()).filter(has_effect).collect();
        Some(Self {
            values,
            bounds,
            jacobian: jacobian.select_columns(&free),
            free,
            residual,
        })
    }

    /// The limit below which a sum of squares is significantly smaller; `None` where the residuals are as small as rounding.
    fn significantly_smaller(&self) -> Option<f64> {
        const SHARE: f64 = 1e-6;
        const NEGLIGIBLE: f64 = 1e-6;
        let sum = self.residual.norm_squared();
        let columns = self.free.iter().zip(self.jacobian.column_iter());
        let sizes = columns.map(|(index, column)| column.norm() * self.values[*index].abs());
        let scale = sizes.fold(0.0, f64::max);
        let freedom = self.residual.len().saturating_sub(self.values.len()).max(1);
        let limit = sum * (1.0 - SHARE * self.values.len() as f64 / freedom as f64);
        (sum > (NEGLIGIBLE * scale).powi(2)).then_some(limit)
    }

    /// The values after a share of the Gauss–Newton step, within the bounds.
    fn moved(&self, share: f64) -> Vec<f64> {
        let mut moved = self.values.to_vec();
        if self.free.is_empty() {
            return moved;
        }
        let step = linear(&self.jacobian, &self.residual);
        for (index, change) in self.free.iter().zip(step.iter().flat_map(|own| own.iter())) {
            let [low, high] = self.bounds[*index];
            moved[*index] = (self.values[*index] - share * change).clamp(low, high);
        }
        moved
    }
}

/// ∂rᵢ/∂pⱼ by central differences, of second order in the step, or by a one-sided one where the model has no value on the other
/// side; columns of `fixed` parameters are zero. Steps are proportional to the parameters, or to their `least` sizes where these are
/// larger. `None` where the model has a value on neither side.
pub fn jacobian(
    model: &dyn Residuals,
    at: &[f64],
    fixed: &[bool],
    least: &[f64],
) -> Option<DMatrix<f64>> {
    let residuals = |parameters: &[f64]| {
        let mut residuals = vec![0.0; model.count()];
        let has_value = model.evaluate(parameters, &mut residuals);
        has_value.then_some(residuals)
    };
    let mut jacobian = DMatrix::zeros(model.count(), at.len());
    for (column, value) in at.iter().enumerate() {
        if fixed[column] {
            continue;
        }
        let step = 6e-6 * value.abs().max(least[column]);
        let moved = |step: f64| {
            let mut moved = at.to_vec();
            moved[column] = value + step;
            residuals(&moved)
        };
        let (below, above, width) = match (moved(-step), moved(step)) {
            (Some(below), Some(above)) => (below, above, 2.0 * step),
            (Some(below), None) => (below, residuals(at)?, step),
            (None, Some(above)) => (residuals(at)?, above, step),
            (None, None) => return None,
        };
        for (row, (above, below)) in above.iter().zip(&below).enumerate() {
            jacobian[(row, column)] = (above - below) / width;
        }
    }
    Some(jacobian)
}

/// The coefficients of columns that come nearest to a target; `None` where a column is not finite.
pub fn linear(columns: &DMatrix<f64>, target: &DVector<f64>) -> Option<DVector<f64>> {
    if columns.ncols() == 0 {
        return Some(DVector::zeros(0));
    }
    if !columns.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let scales: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
    if scales.contains(&0.0) {
        return None;
    }
    let mut scaled = columns.clone();
    for (mut column, scale) in scaled.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    let mut result = scaled.svd(true, true).solve(target, 1e-13).ok()?;
    for (value, scale) in result.iter_mut().zip(&scales) {
        *value /= scale;
    }
    Some(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ln p − ln 0.01, which has no value where p is not positive.
    struct Logarithm;

    impl Residuals for Logarithm {
        fn count(&self) -> usize {
            2
        }

        fn evaluate(&self, parameters: &[f64], residuals: &mut [f64]) -> bool {
            residuals.fill((parameters[0] / 0.01).ln());
            residuals[0].is_finite()
        }
    }

    /// The first step from 5 leads to −26, where there is nothing.
    #[test]
    fn a_step_to_where_the_model_has_no_value_is_refused() {
        let free = [[f64::NEG_INFINITY, f64::INFINITY]];
        let result = minimise(&Logarithm, &[5.0], &free, Precision::Full).unwrap();
        assert!((result[0] / 0.01 - 1.0).abs() < 1e-6, "{result:?}");
        assert!(minimise(&Logarithm, &[-1.0], &free, Precision::Full).is_none());
    }
}
