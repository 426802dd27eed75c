//! The compression that a part of a sheet bears before it wrinkles or buckles out of its plane.

use std::f64::consts::PI;

use nalgebra::{Matrix4, Vector4};

/// The bending of a sheet that is as stiff as at rest, in waves along one direction.
#[derive(Clone, Copy)]
pub struct Bending {
    /// C_kkkk in MPa along the direction k: E/(1 − ν²) of an isotropic sheet.
    stiffness: f64,
    /// C_kqkq in MPa with the direction q across it: the shear modulus.
    shear: f64,
}

/// A part of a sheet under compression.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its length a across the compression in mm.
    pub along: f64,
    /// Its length b along the compression in mm.
    pub across: f64,
    /// How many of the ends of a are free edges of the sheet: none, one or two.
    pub free_ends: usize,
    /// The mean stress T/h across the compression in MPa.
    pub tension: f64,
}

impl Bending {
    /// Of the tangent ∂P/∂F at rest, with a unit vector of the sheet at rest along which the waves run.
    pub fn new(tangent: &Matrix4<f64>, [x, y]: [f64; 2]) -> Self {
        let along = Vector4::new(x * x, x * y, y * x, y * y);
        let sheared = Vector4::new(-x * y, x * x, -y * y, x * y);
        Self {
            stiffness: along.dot(&(tangent * along)),
            shear: sheared.dot(&(tangent * sheared)),
        }
    }

    /// The critical compression N/h in MPa of a part of the thickness h in mm.
    ///
    /// A deflection w = sin(q x) sin(k y) of a plate that its surroundings hold has the energy of bending and of the membrane
    ///
    /// ```text
    /// B (q² + k²)² + T q² − N k² = 0,     B = C_kkkk h³/12,     q = π/a,   k ≥ π/b
    /// N = min over k of [B (q² + k²)² + T q²]/k²,     least at k² = √(q⁴ + T q²/B)
    /// ```
    ///
    /// | limit | N |
    /// |---|---|
    /// | T → ∞: wrinkles along the tension | 2 (π/a) √(B T) + 2 B (π/a)² |
    /// | T = 0, b ≥ a: a long plate | 4 B (π/a)² |
    /// | T = 0, a → ∞: a wide strut | B (π/b)² |
    ///
    /// A free edge holds nothing. Of a part with one, the edge deflects most, and the sheet beside it follows to the same depth; with two, the
    /// part is a strut:
    ///
    /// ```text
    /// N = min over k of B k² + C_kqkq h³/(2 a)² + T [π/(2 a)]²/k²,     N = B (π/b)²
    /// ```
    ///
    /// C is the tangent at rest: B = E h³/(12 (1 − ν²)) of an isotropic sheet, whose C_kqkq is the shear modulus μ.
    ///
    /// # References
    /// E. Cerda, L. Mahadevan, Phys. Rev. Lett. 90, 074302 (2003), doi:10.1103/PhysRevLett.90.074302 (wrinkles under tension);
    /// S. P. Timoshenko, J. M. Gere, Theory of Elastic Stability, 2nd ed. (1961), §9.2 (plates), §9.3 (one free edge).
    pub fn critical_stress(self, part: Part, thickness: f64) -> f64 {
        let Part {
            along,
            across,
            free_ends,
            tension,
        } = part;
        let bending = self.stiffness * thickness.powi(2) / 12.0;
        let (held, least) = ((PI / along).powi(2), (PI / across).powi(2));
        match free_ends {
            0 => {
                let best = (held * held + tension * held / bending).max(0.0).sqrt();
                let number = best.max(least);
                (bending * (held + number).powi(2) + tension * held) / number
            }
            1 => {
                let twist = self.shear * (thickness / (2.0 * along)).powi(2);
                let held = 0.25 * held * tension.max(0.0);
                let number = (held / bending).sqrt().max(least);
                bending * number + twist + held / number
            }
            _ => bending * least,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::sheet::Kinematics;
    use crate::material::{HyperelasticLaw, NeoHooke};

    #[test]
    fn plates_struts_and_wrinkles_have_the_compression_of_textbooks() {
        let law = NeoHooke { c10: 0.05 };
        let bending = Bending::new(&law.response(&Kinematics::rest()).tangent, [0.6, 0.8]);
        // E h²/(12 (1 − ν²)) with E = 0.3 MPa and ν = ½.
        let (thickness, per) = (0.1_f64, 0.3 * 0.1 * 0.1 / 9.0);
        let critical = |along: f64, across: f64, free_ends, tension| {
            let part = Part {
                along,
                across,
                free_ends,
                tension,
            };
            bending.critical_stress(part, thickness)
        };
        let close = |computed: f64, expected: f64| {
            assert!(
                (computed / expected - 1.0).abs() < 1e-3,
                "{computed} {expected}"
            );
        };
        close(critical(5.0, 5.0, 0, 0.0), 4.0 * per * PI * PI / 25.0);
        close(critical(5.0, 500.0, 0, 0.0), 4.0 * per * PI * PI / 25.0);
        close(critical(5000.0, 5.0, 0, 0.0), per * PI * PI / 25.0);
        close(critical(3.0, 5.0, 2, 0.2), per * PI * PI / 25.0);
        // Under the same compression both ways, a square bears half as much as under one.
        let both = 2.0 * per * PI * PI / 25.0;
        close(critical(5.0, 5.0, 0, -both), both);
        let wrinkles = 2.0 * PI / 50.0 * (per * 0.2_f64).sqrt();
        close(
            critical(50.0, 50.0, 0, 0.2),
            wrinkles + 2.0 * per * (PI / 50.0).powi(2),
        );
    }
}
