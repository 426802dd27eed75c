//! The moduli of an isotropic body at small strain: two of them determine the others.
//!
//! ```text
//! μ = E/(2 (1 + ν)),   K = E/(3 (1 − 2 ν)),   E = 9 K μ/(3 K + μ),   ν = (3 K − 2 μ)/(2 (3 K + μ))
//! ```
//!
//! An incompressible body has ν = ½ and μ = E/3, so that one modulus is enough.

use crate::error::Error;
use crate::material::volume::{LARGEST_POISSON_RATIO, POISSON_RATIO};

/// How near to ½ a Poisson's ratio that follows from two moduli is ½.
const ROUNDING: f64 = 1e-9;

/// The moduli that are stated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moduli {
    /// E in MPa.
    pub young: Option<f64>,
    /// ν.
    pub poisson_ratio: Option<f64>,
    /// μ in MPa.
    pub shear: Option<f64>,
    /// K in MPa.
    pub bulk: Option<f64>,
}

/// What follows from the moduli that are stated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SmallStrainModuli {
    /// μ in MPa.
    pub shear: Option<f64>,
    /// ν; ½ for an incompressible body.
    pub poisson_ratio: Option<f64>,
    /// K in MPa where it is stated and ν is not.
    pub bulk: Option<f64>,
}

impl SmallStrainModuli {
    /// Whether nothing is stated.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl Moduli {
    /// μ and ν or K.
    ///
    /// # Errors
    /// [`Error::Input`] where more than two moduli are stated, or two that contradict each other.
    pub(super) fn solved(&self) -> Result<SmallStrainModuli, Error> {
        self.check_signs()?;
        let (shear, ratio) = match (self.young, self.poisson_ratio, self.shear, self.bulk) {
            (Some(young), None, Some(shear), None) => {
                let ratio = 0.5 * young / shear - 1.0;
                let is_half = (ratio - 0.5).abs() < ROUNDING;
                (Some(shear), Some(if is_half { 0.5 } else { ratio }))
            }
            (Some(young), None, None, Some(bulk)) => {
                let ratio = 0.5 - young / (6.0 * bulk);
                (Some(3.0 * bulk * young / (9.0 * bulk - young)), Some(ratio))
            }
            (None, None, Some(shear), Some(bulk)) => {
                let ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
                (Some(shear), Some(ratio))
            }
            (None, Some(ratio), None, Some(bulk)) => {
                let shear = 1.5 * bulk * (1.0 - 2.0 * ratio) / (1.0 + ratio);
                (Some(shear).filter(|_| ratio != 0.5), Some(ratio))
            }
            (Some(young), ratio, None, None) => {
                (Some(0.5 * young / (1.0 + ratio.unwrap_or(0.5))), ratio)
            }
            (None, ratio, shear, None) => (shear, ratio),
            (None, None, None, Some(_)) => (None, None),
            _ => {
                let message = "more than two of Young's modulus, Poisson's ratio, shear modulus and bulk modulus are stated";
                return Err(Error::input(
                    message,
                    "two of them determine the others: leave out the rest",
                ));
            }
        };
        if let Some(ratio) = ratio {
            admitted(ratio, self.poisson_ratio.is_some())?;
        }
        if self.bulk.is_some() && ratio == Some(0.5) {
            let message = "a Poisson's ratio of 0.5 has no bulk modulus";
            return Err(Error::input(
                message,
                "leave out the bulk modulus, and state Young's modulus or the shear modulus",
            ));
        }
        Ok(SmallStrainModuli {
            shear,
            poisson_ratio: ratio,
            bulk: self.bulk.filter(|_| self.poisson_ratio.is_none()),
        })
    }
}

impl Moduli {
    /// Whether Young's modulus is stated and nothing else.
    pub(super) fn is_young_alone(&self) -> bool {
        let others = [self.poisson_ratio, self.shear, self.bulk];
        self.young.is_some() && others.iter().all(Option::is_none)
    }

    /// Refuses moduli that are not positive.
    fn check_signs(&self) -> Result<(), Error> {
        for (name, modulus) in [
            ("Young's modulus", self.young),
            ("the shear modulus", self.shear),
            ("the bulk modulus", self.bulk),
        ] {
            if modulus.is_some_and(|modulus| !(modulus > 0.0 && modulus.is_finite())) {
                return Err(Error::input(
                    format!("{name} must be greater than zero"),
                    "such as \"20 kPa\"",
                ));
            }
        }
        Ok(())
    }
}

/// Refuses a Poisson's ratio that no law takes.
fn admitted(ratio: f64, is_stated: bool) -> Result<(), Error> {
    if ratio == 0.5 || POISSON_RATIO.ends()[0] <= ratio && ratio <= POISSON_RATIO.ends()[1] {
        return Ok(());
    }
    let message = if is_stated {
        format!("a Poisson's ratio of {ratio} is not possible here")
    } else {
        format!("the moduli contradict each other: Poisson's ratio would be {ratio:.5}")
    };
    let hint = format!(
        "it lies between -0.9 and {LARGEST_POISSON_RATIO}, or is 0.5 for an incompressible material"
    );
    Err(Error::input(message, hint))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pair_of_moduli_gives_the_same_body() {
        let (young, ratio): (f64, f64) = (0.02, 0.45);
        let (shear, bulk) = (
            young / 2.0 / (1.0 + ratio),
            young / 3.0 / (1.0 - 2.0 * ratio),
        );
        let all = [Some(young), Some(ratio), Some(shear), Some(bulk)];
        for (one, two) in (0..4).flat_map(|one| (0..one).map(move |two| (one, two))) {
            let of = |index: usize| all[index].filter(|_| index == one || index == two);
            let stated = Moduli {
                young: of(0),
                poisson_ratio: of(1),
                shear: of(2),
                bulk: of(3),
            };
            let solved = stated.solved().unwrap();
            crate::assert_near(solved.shear.unwrap(), shear, 1e-14, &stated);
            assert!(
                (solved.poisson_ratio.unwrap() - ratio).abs() < 1e-14,
                "{stated:?}"
            );
        }
    }

    #[test]
    fn contradictions_are_refused() {
        let young = |poisson_ratio, shear, bulk| Moduli {
            young: Some(0.02),
            poisson_ratio,
            shear,
            bulk,
        };
        assert!(young(Some(0.5), None, None).solved().is_ok());
        for wrong in [
            young(Some(0.3), Some(0.01), None),
            young(Some(0.49999), None, None),
            young(Some(0.6), None, None),
            young(None, Some(0.005), None),
            young(None, None, Some(0.001)),
            Moduli {
                poisson_ratio: Some(0.5),
                bulk: Some(0.1),
                ..Moduli::default()
            },
        ] {
            assert!(wrong.solved().is_err(), "{wrong:?}");
        }
    }
}
