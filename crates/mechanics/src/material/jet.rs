//! Functions of the strains of a sheet together with their first and second derivatives, so that a law is written as its
//! formula alone (automatic differentiation, forward and of second order).

use std::ops::{Add, Mul};

use nalgebra::{Matrix4, Vector4};

/// A function f of four variables x at a point: its 2-jet.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    /// f.
    pub value: f64,
    /// ∂f/∂x.
    pub gradient: Vector4<f64>,
    /// ∂²f/∂x².
    pub hessian: Matrix4<f64>,
}

impl Jet {
    /// The variables with some values.
    #[inline(always)]
    pub fn variables(values: [f64; 4]) -> [Self; 4] {
        std::array::from_fn(|index| Self {
            value: values[index],
            gradient: Vector4::ith(index, 1.0),
            hessian: Matrix4::zeros(),
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

impl Add for Jet {
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

impl Mul<Jet> for f64 {
    type Output = Jet;

    #[inline(always)]
    fn mul(self, jet: Jet) -> Jet {
        Jet {
            value: self * jet.value,
            gradient: self * jet.gradient,
            hessian: self * jet.hessian,
        }
    }
}
