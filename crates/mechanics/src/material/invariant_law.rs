//! Laws of the first two invariants.

use std::marker::PhantomData;
use std::sync::Arc;

use pulp::{Arch, NullaryFnOnce};

use super::code::{Code, CodeLaw};
use super::flory::{self, IsochoricLaw};
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::{HyperelasticLaw, LANES, TensionResponse, store};
use super::measures::Derivatives;
use super::sheet::{COMPONENTS, Kinematics, PlaneTensor, SheetResponse};
use super::volume::Volume;

/// An isotropic law Ψ(I₁, I₂).
///
/// A law whose Ψ₁₁ is unbounded at rest (as Marlow's) returns zero for it there: every use multiplies it
/// by a factor that vanishes faster.
pub trait InvariantLaw: Send + Sync + std::fmt::Debug {
    /// Ψ and its derivatives at the given invariants.
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives;

    /// As [`HyperelasticLaw::in_code`].
    fn in_code(&self, _code: Code, _bulk_modulus: f64) -> Option<CodeLaw> {
        None
    }
}

impl<L: InvariantLaw> HyperelasticLaw for L {
    fn stresses(&self, gradients: [&[f64]; 4], computed: [&mut [f64]; 4]) -> bool {
        Arch::new().dispatch(PointLoop {
            law: self,
            gradients,
            computed,
            kind: PhantomData::<Stress>,
        })
    }

    fn responses(
        &self,
        gradients: [&[f64]; 4],
        computed: [&mut [f64]; COMPONENTS],
        _tangents: bool,
    ) -> bool {
        Arch::new().dispatch(PointLoop {
            law: self,
            gradients,
            computed,
            kind: PhantomData::<Response>,
        })
    }

    fn with_volume(self: Arc<Self>, volume: Volume) -> Option<Arc<dyn HyperelasticLaw>>
    where
        Self: 'static,
    {
        Some(flory::sheet(self, volume))
    }

    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        kinematics.stress(&self.evaluate(kinematics.invariants))
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        kinematics.response(&self.evaluate(kinematics.invariants))
    }

    /// ```text
    /// P = 2 (Ψ₁ + Ψ₂/λ) (λ − λ⁻²),   I₁ = λ² + 2/λ,   I₂ = 2λ + λ⁻²
    /// ```
    fn tension(&self, _: [f64; 2], strain: f64) -> TensionResponse {
        let x = strain;
        let lambda = 1.0 + x;
        let cubic = 3.0 + 3.0 * x + x * x;
        let i1_minus_3 = x * x * (3.0 + x) / lambda;
        let i2_minus_3 = x * x * (3.0 + 2.0 * x) / (lambda * lambda);
        let w = self.evaluate(Invariants {
            i1_minus_3,
            i2_minus_3,
        });
        // λ − λ⁻² and its derivative; dI₁/dλ = 2 h, dI₂/dλ = 2 h/λ.
        let h = x * cubic / (lambda * lambda);
        let dh = 1.0 + 2.0 / lambda.powi(3);
        let secant = w.d1 + w.d2 / lambda;
        let secant_slope = 2.0 * h * (w.d11 + 2.0 * w.d12 / lambda + w.d22 / (lambda * lambda))
            - w.d2 / (lambda * lambda);
        TensionResponse {
            energy: w.energy,
            nominal_stress: 2.0 * secant * h,
            slope: 2.0 * (secant * dh + secant_slope * h),
        }
    }

    fn in_code(&self, code: Code, bulk_modulus: f64) -> Option<CodeLaw> {
        InvariantLaw::in_code(self, code, bulk_modulus)
    }

    /// μ₀ = 2 (Ψ₁ + Ψ₂) at rest.
    fn shear_modulus(&self) -> f64 {
        let rest = self.evaluate(Invariants {
            i1_minus_3: 0.0,
            i2_minus_3: 0.0,
        });
        2.0 * (rest.d1 + rest.d2)
    }

    fn youngs_modulus(&self) -> f64 {
        3.0 * self.shear_modulus()
    }
}

/// With x = e^s:
///
/// ```text
/// Ī₁ − 3 = 2 x z + (x − 1)² (2 x + 1)/x²,   Ī₂ − 3 = 2 z/x + (x − 1)² (x + 2)/x
/// ```
impl<L: InvariantLaw> IsochoricLaw for L {
    type Shape = f64;

    #[inline(always)]
    fn shape(&self, z: f64) -> f64 {
        z
    }

    #[inline(always)]
    fn at(&self, d: f64, z: f64) -> Derivatives {
        let x = 1.0 + d;
        let (square, inverse) = (x * x, 1.0 / x);
        let inverse_square = inverse * inverse;
        // x − x⁻²
        let r = d * (1.0 + x + square) * inverse_square;
        let w = self.evaluate(Invariants {
            i1_minus_3: 2.0 * x * z + d * d * (2.0 * x + 1.0) * inverse_square,
            i2_minus_3: 2.0 * z * inverse + d * d * (x + 2.0) * inverse,
        });
        let [s1, z1] = [2.0 * (x * z + r), 2.0 * x];
        let [s2, z2] = [2.0 * (x * r - z * inverse), 2.0 * inverse];
        let ss1 = z1 * (1.0 + z) + 4.0 * inverse_square;
        let ss2 = z2 * (1.0 + z) + 4.0 * square;
        Derivatives {
            energy: w.energy,
            m: w.d1 * s1 + w.d2 * s2,
            z: w.d1 * z1 + w.d2 * z2,
            mm: w.d11 * s1 * s1 + 2.0 * w.d12 * s1 * s2 + w.d22 * s2 * s2 + w.d1 * ss1 + w.d2 * ss2,
            mz: w.d11 * s1 * z1 + w.d12 * (s1 * z2 + s2 * z1) + w.d22 * s2 * z2 + w.d1 * z1
                - w.d2 * z2,
            zz: w.d11 * z1 * z1 + 2.0 * w.d12 * z1 * z2 + w.d22 * z2 * z2,
        }
    }
}

/// A result computed from the kinematics and derivatives at a point.
trait Computed<const N: usize> {
    /// The components of the result.
    fn of(kinematics: &Kinematics, w: &EnergyDerivatives) -> [f64; N];
}

struct Stress;

impl Computed<4> for Stress {
    #[inline(always)]
    fn of(kinematics: &Kinematics, w: &EnergyDerivatives) -> [f64; 4] {
        kinematics.stress(w).1.into()
    }
}

struct Response;

impl Computed<COMPONENTS> for Response {
    #[inline(always)]
    fn of(kinematics: &Kinematics, w: &EnergyDerivatives) -> [f64; COMPONENTS] {
        kinematics.response(w).components()
    }
}

/// Straight-line code for each point: the compiler handles several points with one instruction, with the widest
/// vectors that the machine has. No operation is fused with another, so that all machines give the same bits.
struct PointLoop<'a, L, M, const N: usize> {
    law: &'a L,
    gradients: [&'a [f64]; 4],
    computed: [&'a mut [f64]; N],
    kind: PhantomData<M>,
}

impl<L: InvariantLaw, M: Computed<N>, const N: usize> NullaryFnOnce for PointLoop<'_, L, M, N> {
    type Output = bool;

    #[inline(always)]
    fn call(mut self) -> bool {
        let points = self.gradients[0].len();
        let mut inverted = 0_u64;
        for first in (0..points).step_by(LANES) {
            let count = LANES.min(points - first);
            // Local copies, which no store aliases; entries behind the last point are at rest.
            let mut gradients = [[0.0; LANES]; 4];
            for (lanes, component) in gradients.iter_mut().zip(&self.gradients) {
                lanes[..count].copy_from_slice(&component[first..first + count]);
            }
            let [h11, h12, h21, h22] = &gradients;
            let mut block = [[0.0; LANES]; N];
            for lane in 0..LANES {
                let h = PlaneTensor::new(h11[lane], h12[lane], h21[lane], h22[lane]);
                let kinematics = Kinematics::unchecked(&h);
                let computed = M::of(&kinematics, &self.law.evaluate(kinematics.invariants));
                for (component, value) in block.iter_mut().zip(computed) {
                    component[lane] = value;
                }
                inverted |= u64::from(!kinematics.is_admissible());
            }
            store(&mut self.computed, &block, first, count);
        }
        inverted == 0
    }
}
