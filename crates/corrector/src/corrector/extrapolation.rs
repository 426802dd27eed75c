//! Polynomial extrapolation through the last states of a path.
//!
//! ```text
//! u(s) ≈ Σ uₖ Lₖ(s),   Lₖ(s) = Π (s − sⱼ)/(sₖ − sⱼ)   over all j ≠ k
//! ```
//!
//! Where fewer than [`HISTORY`] states are known, the state of rest at s = 0 is one more.

/// Number of states from which the next one is extrapolated.
const HISTORY: usize = 3;

/// The last states of a path.
pub struct Known<F> {
    /// The parameter of each, none of them that of rest.
    pub parameters: Vec<f64>,
    /// Its field.
    pub fields: Vec<F>,
}

impl<F> Known<F> {
    /// No states.
    pub fn none() -> Self {
        Self {
            parameters: Vec::new(),
            fields: Vec::new(),
        }
    }

    /// Adds a state; one at the same parameter is replaced, and that of rest is always known.
    pub fn take(&mut self, parameter: f64, field: F) {
        let same = self.parameters.iter().position(|own| *own == parameter);
        let full = (self.parameters.len() == HISTORY).then_some(0);
        if let Some(left_out) = same.or(full) {
            self.parameters.remove(left_out);
            self.fields.remove(left_out);
        }
        if parameter != 0.0 {
            self.parameters.push(parameter);
            self.fields.push(field);
        }
    }
}

/// The shares of states at some parameters in the polynomial through them, at another parameter.
pub fn value_shares(known: &[f64], parameter: f64) -> Vec<f64> {
    shares(known, |others| {
        others.iter().map(|other| parameter - other).product()
    })
}

/// The shares of the states in that polynomial's derivative.
pub fn rate_shares(known: &[f64], parameter: f64) -> Vec<f64> {
    shares(known, |others| {
        let without = |left_out: usize| -> f64 {
            let kept = others
                .iter()
                .enumerate()
                .filter(|(place, _)| *place != left_out);
            kept.map(|(_, other)| parameter - other).product()
        };
        (0..others.len()).map(without).sum()
    })
}

/// For each state, the value of `product` for the parameters of the other states and of the state of rest, over the
/// denominator of its Lagrange polynomial.
fn shares(known: &[f64], product: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let at_rest = (known.len() < HISTORY).then_some(0.0);
    let share = |own: usize| {
        let others = known.iter().enumerate().filter(|(other, _)| *other != own);
        let others: Vec<f64> = others.map(|(_, other)| *other).chain(at_rest).collect();
        let own = known[own];
        product(&others) / others.iter().map(|other| own - other).product::<f64>()
    };
    (0..known.len()).map(share).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quadratic that is zero at rest is met by two states and by three.
    #[test]
    fn quadratics_are_met_by_two_states_and_rest_and_by_three() {
        let quadratic = |s: f64| 3.0 * s - 0.7 * s * s;
        let slope = |s: f64| 3.0 - 1.4 * s;
        for known in [&[0.2, 0.5][..], &[0.2, 0.5, 0.4]] {
            let sum = |shares: Vec<f64>| -> f64 {
                let pairs = shares.iter().zip(known);
                pairs.map(|(share, s)| share * quadratic(*s)).sum()
            };
            assert!((sum(value_shares(known, 0.9)) - quadratic(0.9)).abs() < 1e-14);
            assert!((sum(rate_shares(known, 0.9)) - slope(0.9)).abs() < 1e-14);
        }
    }
}
