//! Parts of a model of stresses in addition to those of its law: linear in its values, or quadratic along one direction.

/// A part of the stresses that is linear in the values: Σ ∂σᵢ/∂pⱼ (pⱼ − pⱼ₀).
#[derive(Clone, Debug)]
pub struct Linear {
    /// p₀.
    pub at: Vec<f64>,
    /// The derivatives of each row in MPa.
    pub rows: Vec<Vec<f64>>,
    /// A part that is quadratic along one direction: Dᵢ (w · (p − p₀))².
    pub bend: Option<Bend>,
}

/// The weights w of the values, and D of each row in MPa.
#[derive(Clone, Debug)]
pub struct Bend {
    pub weights: Vec<f64>,
    pub rows: Vec<f64>,
}

impl Linear {
    /// What is added to the stress of a row.
    pub fn at(&self, row: usize, values: &[f64]) -> f64 {
        let sum = |slopes: &[f64]| -> f64 {
            let changes = values.iter().zip(&self.at).map(|(now, at)| now - at);
            slopes
                .iter()
                .zip(changes)
                .map(|(slope, by)| slope * by)
                .sum()
        };
        let bend = self.bend.as_ref();
        sum(&self.rows[row]) + bend.map_or(0.0, |bend| bend.rows[row] * sum(&bend.weights).powi(2))
    }
}
