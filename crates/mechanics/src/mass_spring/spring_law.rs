//! The stiffness K(·) of springs and the damping D(·) of dashpots, Eq. 1–4 of the publication.
//!
//! ```text
//! F = [K(λ) (|x| − x₀) + D(λ, λ̇) d|x|/dt] x/|x|                                          [N]
//! K(λ) = a E(λ)/x₀,   D(λ, λ̇) = a η(λ, λ̇)/x₀
//! ```
//!
//! a is a spring's cross-section in mm² and x₀ its rest length in mm, so that springs of all lengths represent one
//! material with the secant modulus E(·) in MPa and the viscosity η(·) in MPa·s.

use crate::material::law::{HyperelasticLaw, TensionResponse};
use crate::material::scalar_function::ScalarFunction;
use crate::material::viscosity::ViscousMaterial;

/// The stiffness of springs.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SpringLaw {
    /// E(λ) = P(λ)/(λ − 1) with the tension curve P of the sheet's material along the spring.
    #[default]
    Material,
    /// E as a function of λ − 1, in MPa.
    SecantModulus(ScalarFunction),
}

/// The damping of dashpots, one in parallel to each spring.
#[derive(Clone, Debug, PartialEq)]
pub enum DashpotLaw {
    /// The viscous part of the sheet's material along the spring: η(·) = 3 η/λ², and its Prony series.
    Material(ViscousMaterial),
    /// η(·) in MPa·s as the product of a function of λ − 1 and one of λ̇ in 1/s.
    Viscosity {
        /// The factor that depends on λ − 1.
        by_stretch: ScalarFunction,
        /// The factor that depends on λ̇.
        by_rate: ScalarFunction,
    },
}

impl SpringLaw {
    /// Energy, nominal stress and its slope of a spring along the unit vector `direction` of a sheet of `law`.
    pub fn tension(
        &self,
        law: &dyn HyperelasticLaw,
        direction: [f64; 2],
        strain: f64,
    ) -> TensionResponse {
        match self {
            Self::Material => law.tension(direction, strain),
            Self::SecantModulus(modulus) => {
                let [value, rise] = modulus.at(strain);
                TensionResponse {
                    energy: modulus.moment(strain),
                    nominal_stress: value * strain,
                    slope: value + rise * strain,
                }
            }
        }
    }
}

impl DashpotLaw {
    /// The nominal stress in MPa that depends on the rate alone, and its derivative with respect to λ̇ in MPa·s.
    pub fn stress(&self, stretch: f64, rate: f64) -> [f64; 2] {
        match self {
            Self::Material(material) => material.newtonian_tension(stretch, rate),
            Self::Viscosity {
                by_stretch,
                by_rate,
            } => {
                let [factor, _] = by_stretch.at(stretch - 1.0);
                let [value, rise] = by_rate.at(rate);
                [factor * value * rate, factor * (value + rise * rate)]
            }
        }
    }

    /// The material whose stresses relax, if there is one.
    pub fn relaxing(&self) -> Option<&ViscousMaterial> {
        match self {
            Self::Material(material) if !material.relaxation.is_empty() => Some(material),
            _ => None,
        }
    }
}
