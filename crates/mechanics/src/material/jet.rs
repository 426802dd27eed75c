//! Functions of the strains of a sheet together with their first and second derivatives, so that a law is written as its
//! formula alone (automatic differentiation, forward and of second order).

use std::ops::{Add, Mul};

use nalgebra::{SMatrix, SVector};

/// A function f of N variables x at a point: its 2-jet.
#[derive(Clone, Copy, Debug)]
pub struct Jet<const N: usize = 4> {
    /// f.
    pub value: f64,
    /// ∂f/∂x.
    pub gradient: SVector<f64, N>,
    /// ∂²f/∂x².
    pub hessian: SMatrix<f64, N, N>,
}

impl<const N: usize> Jet<N> {
    /// A number that depends on no variable.
    #[inline(always)]
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            gradient: SVector::zeros(),
            hessian: SMatrix::zeros(),
        }
    }

    /// The variables with some values.
    #[inline(always)]
    pub fn variables(values: [f64; N]) -> [Self; N] {
        std::array::from_fn(|index| {
            let mut variable = Self::constant(values[index]);
            variable.gradient[index] = 1.0;
            variable
        })
    }

    /// g(f) from g, g′ and g″ at f.
    #[inline(always)]
    pub fn composed(self, [g, slope, curvature]: [f64; 3]) -> Self {
        Self {
            value: g,
            gradient: slope * self.gradient,
            hessian: slope * self.hessian + self.gradient * (curvature * self.gradient).transpose(),
        }
    }

    /// f².
    #[inline(always)]
    pub fn squared(self) -> Self {
        self.composed([self.value * self.value, 2.0 * self.value, 2.0])
    }

    /// e^f − 1, without cancellation where f is small.
    #[inline(always)]
    pub fn exponential_less_one(self) -> Self {
        let growth = self.value.exp();
        self.composed([self.value.exp_m1(), growth, growth])
    }

    /// ⟨f⟩ = max(f, 0); where f = 0, with the derivatives of f.
    #[inline(always)]
    pub fn positive(self) -> Self {
        if self.value < 0.0 { 0.0 * self } else { self }
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            gradient: self.gradient + other.gradient,
            hessian: self.hessian + other.hessian,
        }
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mixed = self.gradient * other.gradient.transpose();
        Self {
            value: self.value * other.value,
            gradient: self.value * other.gradient + other.value * self.gradient,
            hessian: self.value * other.hessian
                + other.value * self.hessian
                + mixed
                + mixed.transpose(),
        }
    }
}

impl<const N: usize> Mul<Jet<N>> for f64 {
    type Output = Jet<N>;

    #[inline(always)]
    fn mul(self, jet: Jet<N>) -> Jet<N> {
        Jet {
            value: self * jet.value,
            gradient: self * jet.gradient,
            hessian: self * jet.hessian,
        }
    }
}
