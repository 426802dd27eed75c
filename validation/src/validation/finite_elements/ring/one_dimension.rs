//! The ring as a problem of one dimension, without any of the code that it judges.
//!
//! A circle of radius R becomes one of radius r(R). With λ_r = dr/dR, λ_θ = r/R, λ₃ = 1/(λ_r λ_θ), a sheet in plane stress
//! with the energy Ψ(I₁) and Ψ₁ = dΨ/dI₁ has
//!
//! ```text
//! P_r = 2 Ψ₁ (λ_r − λ_r⁻³ λ_θ⁻²),   P_θ = 2 Ψ₁ (λ_θ − λ_θ⁻³ λ_r⁻²)                         [MPa]
//! dP_r/dR = (P_θ − P_r)/R,   P_r(a) = −p λ_θ(a),   P_r(b) = 0
//! ```
//!
//! where p acts on the thickness at rest and the deformed length. For a given stretch of the bore, λ_θ(a), the slope λ_r(a) at
//! which the outside is free is found by bisection; Runge and Kutta's method of fourth order integrates outward.

use crate::statistics::bisect;

/// Steps through the ring.
const STEPS: usize = 500;

/// A ring of an energy of I₁.
pub struct Ring<'a> {
    /// a and b in mm.
    pub radii: [f64; 2],
    /// Ψ₁ in MPa at I₁ − 3.
    pub slope: &'a dyn Fn(f64) -> f64,
}

impl Ring<'_> {
    /// The pressure in MPa that stretches the bore so far, and the displacement of the outside in mm.
    pub fn pressure(&self, bore_stretch: f64) -> [f64; 2] {
        // The bore gets thinner radially: between nothing and what an unloaded circle has.
        let [high, low] = bisect([bore_stretch.powf(-0.5), 0.05], 60, |radial| {
            self.outside(bore_stretch, radial)[0] > 0.0
        });
        let radial = 0.5 * (low + high);
        let pressure = -self.stresses([radial, bore_stretch])[0] / bore_stretch;
        let [_, position] = self.outside(bore_stretch, radial);
        [pressure, position - self.radii[1]]
    }

    /// P_r and r at the outside, from the stretches at the bore.
    fn outside(&self, bore_stretch: f64, radial: f64) -> [f64; 2] {
        let [a, b] = self.radii;
        let step = (b - a) / STEPS as f64;
        let mut stretch = radial;
        let mut state = [self.stresses([radial, bore_stretch])[0], a * bore_stretch];
        for number in 0..STEPS {
            let at = a + step * number as f64;
            let mut slope = |radius: f64, state: [f64; 2]| {
                stretch = self.radial_stretch(state[0], state[1] / radius, stretch);
                let [_, hoop] = self.stresses([stretch, state[1] / radius]);
                [(hoop - state[0]) / radius, stretch]
            };
            let along = |slope: [f64; 2], by: f64| [0, 1].map(|i| state[i] + by * slope[i]);
            let k1 = slope(at, state);
            let k2 = slope(at + 0.5 * step, along(k1, 0.5 * step));
            let k3 = slope(at + 0.5 * step, along(k2, 0.5 * step));
            let k4 = slope(at + step, along(k3, step));
            state = [0, 1].map(|i| state[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        state
    }

    /// P_r and P_θ.
    fn stresses(&self, [radial, hoop]: [f64; 2]) -> [f64; 2] {
        let through = 1.0 / (radial * hoop).powi(2);
        let twice = 2.0 * (self.slope)(radial.powi(2) + hoop.powi(2) + through - 3.0);
        [radial, hoop].map(|stretch| twice * (stretch - through / stretch))
    }

    /// λ_r of a radial stress at a hoop stretch, by the secant method from a guess.
    fn radial_stretch(&self, stress: f64, hoop: f64, guess: f64) -> f64 {
        let miss = |radial: f64| self.stresses([radial, hoop])[0] - stress;
        let (mut before, mut now) = (guess, guess * (1.0 + 1e-4));
        let (mut miss_before, mut miss_now) = (miss(before), miss(now));
        for _ in 0..50 {
            if miss_now == miss_before || (now - before).abs() < 1e-15 * now {
                break;
            }
            let next = now - miss_now * (now - before) / (miss_now - miss_before);
            (before, miss_before) = (now, miss_now);
            now = next.clamp(0.5 * now, 2.0 * now);
            miss_now = miss(now);
        }
        now
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A thin ring: p a λ = P_θ (b − a) with P_θ = 2 Ψ₁ (λ − λ⁻²).
    #[test]
    fn a_thin_ring_carries_what_a_strip_does() {
        let ring = Ring {
            radii: [1000.0, 1001.0],
            slope: &|_| 0.05,
        };
        for stretch in [1.01, 1.5_f64, 2.0] {
            let exact = 0.1 * (stretch - stretch.powi(-2)) / (1000.0 * stretch);
            let [actual, _] = ring.pressure(stretch);
            assert!(
                (actual / exact - 1.0).abs() < 2e-3,
                "{stretch} {actual} {exact}"
            );
        }
    }
}
