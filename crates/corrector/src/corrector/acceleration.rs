//! Corrections with a retained factor: Anderson's acceleration.
//!
//! A factor taken at another field gives the step δ(u) only roughly; repeating u ← u + δ(u) converges slowly or
//! not at all, since the tangent of a hydrogel grows ninefold on the way to 100 % stretch. The steps and
//! the changes of the last iterates are therefore combined:
//!
//! ```text
//! minimise ‖δₖ − ΔD γ‖ over γ,   uₖ₊₁ = uₖ + δₖ − (ΔU + ΔD) γ
//! ```
//!
//! where the columns of ΔU and ΔD are the differences of successive fields and steps.
//!
//! # References
//! D. G. Anderson, J. ACM 12, 547 (1965), doi:10.1145/321296.321305

use nalgebra::{DMatrix, DVector};

use super::correction::Step;
use super::factor::{Factor, row_scales};
use super::system::{Corrector, SHORTEST_STEP};
use crate::error::SolveFault;
use crate::solve::vector::{difference, largest, moved, norm};

/// Number of iterates that are combined.
const DEPTH: usize = 12;
/// The steps have stalled when so many of them have not reduced the residual to a tenth.
const PATIENCE: usize = 16;
/// A step may let the residual grow by this factor.
const WORST_GROWTH: f64 = 2.0;
/// Singular values below this share of the largest are left out of the combination.
const CUTOFF: f64 = 1e-10;

/// Steps with `factor` from `start` until the corrector's tolerance is met or they stall; the field that
/// was reached and the log.
pub fn accelerate(
    corrector: &Corrector,
    data: &[f64],
    start: &[f64],
    factor: &mut Factor,
) -> Result<(Vec<f64>, Vec<Step>), SolveFault> {
    let scales = row_scales(factor.jacobian(), factor.weights());
    let values = |field: &[f64]| {
        corrector
            .values(field)
            .map_err(|fault| corrector.inverted(fault))
    };
    let residual = |field: &[f64], values: &[f64]| {
        let scaled: Vec<f64> = values.iter().zip(&scales).map(|(c, s)| c * s).collect();
        largest(&scaled) / largest(field).max(f64::MIN_POSITIVE)
    };
    let mut field = start.to_vec();
    let mut current = values(&field)?;
    let mut history = History::default();
    let mut steps: Vec<Step> = Vec::new();
    let mut best = (residual(&field, &current), field.clone());
    loop {
        let now = residual(&field, &current);
        let stalled = steps.len() >= PATIENCE && now > 0.1 * steps[steps.len() - PATIENCE].residual;
        if now < best.0 {
            best = (now, field.clone());
        }
        let step = factor.project(&current, &difference(data, &field));
        let step = step.map_err(SolveFault::from)?.step;
        let moved = largest(&step) / largest(&field).max(f64::MIN_POSITIVE);
        let settings = corrector.settings;
        if now <= settings.tolerance && moved <= settings.movement {
            return Ok((field, steps));
        }
        if stalled || !now.is_finite() || steps.len() >= corrector.settings.max_steps {
            return Ok((best.1, steps));
        }
        let proposed = history.combine(&field, &step);
        let acceptable =
            |field: &[f64], values: &[f64]| residual(field, values) <= WORST_GROWTH * now;
        let Some((next, next_values, length)) =
            shortened(corrector, &field, &proposed, &acceptable)
        else {
            return Ok((best.1, steps));
        };
        steps.push(Step {
            field: std::mem::replace(&mut field, next),
            residual: now,
            length,
            retained: true,
        });
        current = next_values;
    }
}

/// The longest share of the way to `proposed` that inverts no cell and is acceptable.
fn shortened(
    corrector: &Corrector,
    field: &[f64],
    proposed: &[f64],
    acceptable: &dyn Fn(&[f64], &[f64]) -> bool,
) -> Option<(Vec<f64>, Vec<f64>, f64)> {
    let mut length = 1.0;
    while length > SHORTEST_STEP {
        let way = field.iter().zip(proposed);
        let next: Vec<f64> = way.map(|(from, to)| from + length * (to - from)).collect();
        if let Ok(values) = corrector.values(&next)
            && acceptable(&next, &values)
        {
            return Some((next, values, length));
        }
        length *= 0.5;
    }
    None
}

/// The last fields and steps.
#[derive(Default)]
struct History {
    last: Option<(Vec<f64>, Vec<f64>)>,
    field_changes: Vec<Vec<f64>>,
    step_changes: Vec<Vec<f64>>,
}

impl History {
    /// Adds a field with its step and returns the combined next field.
    fn combine(&mut self, field: &[f64], step: &[f64]) -> Vec<f64> {
        if let Some((last_field, last_step)) = self.last.replace((field.to_vec(), step.to_vec())) {
            self.field_changes.push(difference(field, &last_field));
            self.step_changes.push(difference(step, &last_step));
            if self.field_changes.len() > DEPTH {
                self.field_changes.remove(0);
                self.step_changes.remove(0);
            }
        }
        let mut next = moved(field, 1.0, step);
        for (index, gamma) in self.coefficients(step).into_iter().enumerate() {
            let changes = self.field_changes[index]
                .iter()
                .zip(&self.step_changes[index]);
            for (next, (field, step)) in next.iter_mut().zip(changes) {
                *next -= gamma * (field + step);
            }
        }
        next
    }

    /// γ.
    fn coefficients(&self, step: &[f64]) -> Vec<f64> {
        if self.step_changes.is_empty() {
            return Vec::new();
        }
        // Columns of unit length: the changes shrink by orders of magnitude as the steps converge.
        let norms: Vec<f64> = self
            .step_changes
            .iter()
            .map(|change| norm(change).max(f64::MIN_POSITIVE))
            .collect();
        let entry = |row: usize, column: usize| self.step_changes[column][row] / norms[column];
        let changes = DMatrix::from_fn(step.len(), norms.len(), entry);
        let svd = changes.svd(true, true);
        let cutoff = CUTOFF * svd.singular_values.max();
        match svd.solve(&DVector::from_column_slice(step), cutoff) {
            Ok(gamma) => gamma
                .iter()
                .zip(&norms)
                .map(|(gamma, norm)| gamma / norm)
                .collect(),
            Err(_) => vec![0.0; norms.len()],
        }
    }
}
