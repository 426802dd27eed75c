//! The displacements of edges that are not free as linear combinations of parameters.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

/// A linear combination of parameters and a constant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Combination {
    pub value: f64,
    pub slopes: Vec<(usize, f64)>,
}

impl Combination {
    /// Σ factor · q[index].
    pub fn sum(q: &[Self], terms: impl Iterator<Item = (usize, f64)>) -> Self {
        let mut sum = Self::default();
        terms.for_each(|(index, factor)| sum.add(factor, &q[index]));
        sum
    }

    pub fn parameter(index: usize, values: &[f64]) -> Self {
        Self {
            value: values[index],
            slopes: vec![(index, 1.0)],
        }
    }

    /// Adds a multiple of another one.
    pub fn add(&mut self, factor: f64, other: &Self) {
        self.value += factor * other.value;
        let slopes = other.slopes.iter();
        self.slopes
            .extend(slopes.map(|(index, slope)| (*index, factor * slope)));
    }
}

/// u_B and its derivatives at some p.
#[derive(Clone, Debug)]
pub struct EdgeDisplacements {
    pub unknowns: BTreeMap<usize, Combination>,
}

impl EdgeDisplacements {
    /// Writes u_B into a field.
    pub fn write(&self, field: &mut [f64]) {
        for (unknown, combination) in &self.unknowns {
            field[*unknown] = combination.value;
        }
    }

    /// ∂u_B/∂p, and the difference of a field from u_B.
    pub fn toward(&self, field: &[f64], parameters: usize) -> (DMatrix<f64>, DVector<f64>) {
        let count = self.unknowns.len();
        let (mut rows, mut values) = (DMatrix::zeros(count, parameters), DVector::zeros(count));
        for (row, (unknown, combination)) in self.unknowns.iter().enumerate() {
            values[row] = field[*unknown] - combination.value;
            for (index, slope) in &combination.slopes {
                rows[(row, *index)] += slope;
            }
        }
        (rows, values)
    }

    /// Marks the unknowns of u_B among `count`.
    pub fn held(&self, count: usize) -> Vec<bool> {
        let unknowns = 0..count;
        unknowns
            .map(|unknown| self.unknowns.contains_key(&unknown))
            .collect()
    }

    /// ∂u_B/∂p of one parameter after the other, as fields of `count` unknowns.
    pub fn motions(&self, parameters: usize, count: usize) -> Vec<Vec<f64>> {
        let mut motions = vec![vec![0.0; count]; parameters];
        for (unknown, combination) in &self.unknowns {
            for (index, slope) in &combination.slopes {
                motions[*index][*unknown] += slope;
            }
        }
        motions
    }
}
