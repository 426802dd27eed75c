//! The viscous part of a sheet: Kelvin-Voigt, and a Prony series for quasi-linear viscoelasticity.
//!
//! ```text
//! σ_v = 2 η (d + tr d I),   d = sym(Ḟ F⁻¹),   P_v = σ_v F⁻ᵀ                              [MPa]
//! S = S∞ + Σ Qᵢ,   Q̇ᵢ + Qᵢ/τᵢ = βᵢ Ṡ∞,   βᵢ = gᵢ/(1 − Σ g)                              [MPa]
//! ```
//!
//! The first is an incompressible Newtonian fluid in parallel with the law, for a thin sheet with free surfaces: the viscosity of
//! a strip is 3 η. The second is Fung's convolution of the in-plane second Piola–Kirchhoff stress; the law of the card is that of
//! long times, and gᵢ is the share of the stress right after a sudden stretch that relaxes with the time constant τᵢ.
//!
//! # References
//! Y. C. Fung, Biomechanics: Mechanical Properties of Living Tissues, Springer (1993), § 7.6,
//! doi:10.1007/978-1-4757-2257-4; R. L. Taylor, K. S. Pister, G. L. Goudreau, Int. J. Numer. Methods Eng. 2, 45 (1970),
//! doi:10.1002/nme.1620020106

use nalgebra::Matrix4;

use super::sheet::{Kinematics, PlaneTensor};

/// One term of a Prony series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    /// gᵢ, its share of the stress right after a sudden stretch.
    pub share: f64,
    /// τᵢ in s.
    pub time: f64,
}

/// The viscous part of a material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViscousMaterial {
    /// η in MPa·s.
    pub shear_viscosity: f64,
    /// The Prony series.
    pub relaxation: Vec<Relaxation>,
    /// Times and rates that the data behind it cover.
    pub covered: Covered,
}

/// Times and rates within which a viscous material was measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Covered {
    /// The shortest interval and the longest duration of the data in s.
    pub times: Option<[f64; 2]>,
    /// The slowest and the fastest stretching in 1/s.
    pub rates: Option<[f64; 2]>,
}

/// Coefficients of a branch's recursion over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recursion {
    /// e^(−h/τ).
    pub keeps: f64,
    /// β (1 − e^(−h/τ))/(h/τ): exact where the long-time stress changes linearly in the step.
    pub takes: f64,
}

impl ViscousMaterial {
    /// Whether there are no viscous forces.
    pub fn is_none(&self) -> bool {
        self.shear_viscosity == 0.0 && self.relaxation.is_empty()
    }

    /// A sentence on the viscous effects that equilibria leave out; `None` without viscosity.
    pub fn left_out(&self) -> Option<String> {
        let at_once = self.relaxation_function(0.0);
        let sudden = if self.relaxation.is_empty() {
            String::new()
        } else {
            format!("; the stress right after a sudden load is {at_once:.4} times as large")
        };
        (!self.is_none()).then(|| {
            format!("the card's viscosity is ignored: results are for quasi-static (infinitely slow) loading{sudden}")
        })
    }

    /// S(t)/S∞ after a sudden stretch: 1 + Σ βᵢ e^(−t/τᵢ).
    pub fn relaxation_function(&self, time: f64) -> f64 {
        let terms = self.relaxation.iter().enumerate();
        let rest = terms.map(|(i, term)| self.beta(i) * (-time / term.time).exp());
        1.0 + rest.sum::<f64>()
    }

    /// Storage and loss modulus of a strip at small strain in MPa, at an angular frequency ω in rad/s, with its long-time modulus E∞:
    ///
    /// ```text
    /// E′ = E∞ (1 + Σ βᵢ x²/(1 + x²)),   E″ = E∞ Σ βᵢ x/(1 + x²) + 3 η ω,   x = ω τᵢ
    /// ```
    pub fn complex_modulus(&self, modulus: f64, angular_frequency: f64) -> [f64; 2] {
        let mut complex = [modulus, 3.0 * self.shear_viscosity * angular_frequency];
        for (i, term) in self.relaxation.iter().enumerate() {
            let x = angular_frequency * term.time;
            let part = modulus * self.beta(i) * x / (1.0 + x * x);
            complex[0] += part * x;
            complex[1] += part;
        }
        complex
    }

    /// βᵢ = gᵢ/(1 − Σ g).
    fn beta(&self, term: usize) -> f64 {
        let shares: f64 = self.relaxation.iter().map(|term| term.share).sum();
        self.relaxation[term].share / (1.0 - shares)
    }

    /// The recursion of each branch over a step of `elapsed` s.
    pub fn recursions(&self, elapsed: f64) -> impl Iterator<Item = Recursion> + '_ {
        self.relaxation.iter().enumerate().map(move |(i, term)| {
            let x = elapsed / term.time;
            let share = if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x };
            Recursion {
                keeps: (-x).exp(),
                takes: self.beta(i) * share,
            }
        })
    }

    /// Σ `takes` of all branches over a step of `elapsed` s: d(Σ Qᵢ)/dS∞ at its end.
    pub fn taken(&self, elapsed: f64) -> f64 {
        let takes = self.recursions(elapsed).map(|recursion| recursion.takes);
        takes.sum()
    }

    /// The stresses Qᵢ of all branches after a step of `elapsed` s that ends at S∞ = `now`, from the memory of S∞ and
    /// Qᵢ before the step, three components each.
    pub fn branches(&self, memory: &[f64], now: [f64; 3], elapsed: f64) -> Vec<[f64; 3]> {
        let before = &memory[..3];
        let branches = self.recursions(elapsed).zip(memory[3..].chunks_exact(3));
        branches
            .map(|(recursion, q)| {
                [0, 1, 2].map(|i| recursion.keeps * q[i] + recursion.takes * (now[i] - before[i]))
            })
            .collect()
    }

    /// P_v of the fluid for a rate Ḟ in 1/s.
    pub fn newtonian_stress(&self, kinematics: &Kinematics, rate: &PlaneTensor) -> PlaneTensor {
        let [a, b, c, d] = inverse(&kinematics.deformation_gradient);
        // L = Ḟ F⁻¹.
        let l = [
            rate[0] * a + rate[1] * c,
            rate[0] * b + rate[1] * d,
            rate[2] * a + rate[3] * c,
            rate[2] * b + rate[3] * d,
        ];
        let trace = l[0] + l[3];
        let shear = 0.5 * (l[1] + l[2]);
        let [s11, s12, s22] =
            [l[0] + trace, shear, l[3] + trace].map(|part| 2.0 * self.shear_viscosity * part);
        PlaneTensor::new(
            s11 * a + s12 * b,
            s11 * c + s12 * d,
            s12 * a + s22 * b,
            s12 * c + s22 * d,
        )
    }

    /// ∂P_v/∂Ḟ in MPa·s, symmetric and positive semi-definite.
    pub fn newtonian_tangent(&self, kinematics: &Kinematics) -> Matrix4<f64> {
        let mut tangent = Matrix4::zeros();
        for column in 0..4 {
            let mut rate = PlaneTensor::zeros();
            rate[column] = 1.0;
            tangent.set_column(column, &self.newtonian_stress(kinematics, &rate));
        }
        tangent
    }

    /// Nominal viscous stress 3 η λ̇/λ² of a strip with free edges in MPa, and its derivative with respect to λ̇ in MPa·s.
    pub fn newtonian_tension(&self, stretch: f64, rate: f64) -> [f64; 2] {
        let slope = 3.0 * self.shear_viscosity / (stretch * stretch);
        [slope * rate, slope]
    }
}

/// F⁻¹.
fn inverse(f: &PlaneTensor) -> [f64; 4] {
    let determinant = f[0] * f[3] - f[1] * f[2];
    [f[3], -f[1], -f[2], f[0]].map(|entry| entry / determinant)
}

/// S = F⁻¹ P: components 11, 12, 22 in MPa.
pub fn second_piola_kirchhoff(kinematics: &Kinematics, first: &PlaneTensor) -> [f64; 3] {
    let [a, b, c, d] = inverse(&kinematics.deformation_gradient);
    let mixed = 0.5 * (a * first[1] + b * first[3] + c * first[0] + d * first[2]);
    [
        a * first[0] + b * first[2],
        mixed,
        c * first[1] + d * first[3],
    ]
}

/// P = F S.
pub fn first_piola_kirchhoff(kinematics: &Kinematics, second: [f64; 3]) -> PlaneTensor {
    let f = &kinematics.deformation_gradient;
    let [s11, s12, s22] = second;
    PlaneTensor::new(
        f[0] * s11 + f[1] * s12,
        f[0] * s12 + f[1] * s22,
        f[2] * s11 + f[3] * s12,
        f[2] * s12 + f[3] * s22,
    )
}

/// ∂(F S)/∂F at constant S.
pub fn geometric_tangent(second: [f64; 3]) -> Matrix4<f64> {
    let [s11, s12, s22] = second;
    let mut tangent = Matrix4::zeros();
    for i in [0, 2] {
        tangent[(i, i)] = s11;
        tangent[(i, i + 1)] = s12;
        tangent[(i + 1, i)] = s12;
        tangent[(i + 1, i + 1)] = s22;
    }
    tangent
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material() -> ViscousMaterial {
        ViscousMaterial {
            shear_viscosity: 0.7,
            relaxation: vec![
                Relaxation {
                    share: 0.3,
                    time: 2.0,
                },
                Relaxation {
                    share: 0.2,
                    time: 0.1,
                },
            ],
            ..ViscousMaterial::default()
        }
    }

    #[test]
    fn a_strip_of_fluid_has_trouton_s_viscosity_and_rotation_no_stress() {
        let stretch: f64 = 1.4;
        let rate = 0.3;
        // F = diag(λ, λ^−½) as an incompressible strip with free edges.
        let across = stretch.powf(-0.5);
        let h = PlaneTensor::new(stretch - 1.0, 0.0, 0.0, across - 1.0);
        let kinematics = Kinematics::new(&h).unwrap();
        let rates = PlaneTensor::new(rate, 0.0, 0.0, -0.5 * across / stretch * rate);
        let p = material().newtonian_stress(&kinematics, &rates);
        let [expected, _] = material().newtonian_tension(stretch, rate);
        assert!((p[0] - expected).abs() < 1e-14 && p[3].abs() < 1e-14, "{p}");
        // Ḟ = W F with a spin W.
        let f = kinematics.deformation_gradient;
        let spin = PlaneTensor::new(-f[2], -f[3], f[0], f[1]);
        assert!(material().newtonian_stress(&kinematics, &spin).norm() < 1e-15);
    }

    #[test]
    fn the_fluid_only_dissipates() {
        let h = PlaneTensor::new(0.3, 0.2, -0.1, 0.4);
        let tangent = material().newtonian_tangent(&Kinematics::new(&h).unwrap());
        assert!((tangent - tangent.transpose()).norm() < 1e-14);
        assert!(tangent.symmetric_eigenvalues().min() > -1e-14);
    }

    #[test]
    fn stresses_are_converted_both_ways() {
        let kinematics = Kinematics::new(&PlaneTensor::new(0.3, 0.2, -0.1, 0.4)).unwrap();
        let s = [0.5, -0.2, 0.9];
        let back = second_piola_kirchhoff(&kinematics, &first_piola_kirchhoff(&kinematics, s));
        assert!(s.iter().zip(back).all(|(s, back)| (s - back).abs() < 1e-15));
    }

    #[test]
    fn the_recursion_is_the_relaxation_function() {
        let material = material();
        assert!((material.relaxation_function(0.0) - 2.0).abs() < 1e-15);
        // A jump to S∞ = 1, then seven uneven steps.
        let mut q: Vec<f64> = material.recursions(0.0).map(|r| r.takes).collect();
        let mut time = 0.0;
        for step in [0.1, 0.5, 0.01, 1.0, 0.3, 2.0, 0.07] {
            time += step;
            q.iter_mut()
                .zip(material.recursions(step))
                .for_each(|(q, r)| *q *= r.keeps);
        }
        let stress = 1.0 + q.iter().sum::<f64>();
        assert!((stress - material.relaxation_function(time)).abs() < 1e-14);
        // An even rise in τ: β (1 − e⁻¹).
        let rise = material.recursions(2.0).next().unwrap();
        assert!((rise.takes - 0.6 * (1.0 - (-1.0_f64).exp())).abs() < 1e-15);
    }
}
