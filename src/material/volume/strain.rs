//! The strains of a body whose thickness changes on its own.

use crate::material::invariants::Invariants;
use crate::material::sheet::Kinematics;

/// Strains of the body, free of cancellation.
#[derive(Clone, Copy)]
pub struct BodyStrain {
    /// λ₃ − 1.
    pub z: f64,
    /// tr C − 2 in the plane.
    pub trace_change: f64,
    /// J₃ − 1.
    pub volume_change: f64,
    /// I₁ − 3 and I₂ − 3.
    pub invariants: [f64; 2],
    /// Ī₁ − 3 and Ī₂ − 3.
    pub isochoric: Invariants,
}

impl BodyStrain {
    /// With E = C − I, its trace 3 t, minors II and III and ½ dev E : dev E = 3 t² − II:
    ///
    /// ```text
    /// (Ī₁/3)³ − 1 = (3 t² − II + t³ − III)/J₃²
    /// (Ī₂/3)³ − 1 = (3 t² − II − 2 III + II (s + 2 t) − (II + III)(6 t + II + III) + s³)/J₃⁴,   s = 2 t + II/3
    /// ```
    pub fn new(kinematics: &Kinematics, z: f64) -> Self {
        let [e11, e12, e22] = kinematics.stretch_change;
        let e33 = z * (2.0 + z);
        let trace_change = e11 + e22;
        let t = (trace_change + e33) / 3.0;
        let minor = e11 * e22 - e12 * e12;
        let (second, third) = (minor + trace_change * e33, minor * e33);
        let [d11, d22, d33] = [e11 - t, e22 - t, e33 - t];
        let deviator = 0.5 * (d11 * d11 + d22 * d22 + d33 * d33) + e12 * e12;
        let j = kinematics.area_change;
        let volume_change = j + z + j * z;
        let square = (1.0 + volume_change).powi(2);
        let s = 2.0 * t + second / 3.0;
        let first = (deviator + t.powi(3) - third) / square;
        let other = deviator - 2.0 * third + second * (s + 2.0 * t)
            - (second + third) * (6.0 * t + second + third)
            + s.powi(3);
        let root = |q: f64| 3.0 * (q.ln_1p() / 3.0).exp_m1();
        Self {
            z,
            trace_change,
            volume_change,
            invariants: [3.0 * t, 6.0 * t + second],
            isochoric: Invariants {
                i1_minus_3: root(first),
                i2_minus_3: root(other / (square * square)),
            },
        }
    }
}

impl BodyStrain {
    /// J₃^(−⅔) and J₃^(−4/3).
    pub fn scales(&self) -> [f64; 2] {
        let first = (1.0 + self.volume_change).powf(-2.0 / 3.0);
        [first, first * first]
    }
}
