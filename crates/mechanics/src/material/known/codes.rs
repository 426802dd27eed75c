//! Parameters of laws by their names in other codes.
//!
//! | code | energy of a change of volume | constant |
//! |---|---|---|
//! | Abaqus, CalculiX | (J − 1)²/D₁; (½ (J² − 1) − ln J)/D for Arruda-Boyce | κ = 2/D₁; D₁ = 0: incompressible |
//! | FEBio | ½ k ln² J | κ = k |

use super::Known;
use crate::error::Error;
use crate::material::code::Code;
use crate::material::volume::VolumeEnergy;
use crate::units::{self, Dimension};

// A name of the code, and a key of the card; `E`, `K` and `nu` are moduli, and `2/K` is D₁.
const ABAQUS_OGDEN: &str = "mu1=mu_1 alpha1=alpha_1 mu2=mu_2 alpha2=alpha_2 mu3=mu_3 alpha3=alpha_3 mu4=mu_4 alpha4=alpha_4 d1=2/K";
const ABAQUS_POLYNOMIAL: &str = "c10=c10 c01=c01 c20=c20 c11=c11 c02=c02 c30=c30 d1=2/K";
const ABAQUS_ARRUDA_BOYCE: &str = "mu=mu lambda_m=lambda_m d=2/K";

const FEBIO_OGDEN: &str =
    "c1=mu_1 m1=alpha_1 c2=mu_2 m2=alpha_2 c3=mu_3 m3=alpha_3 c4=mu_4 m4=alpha_4 k=K";

/// The names that a code has for the parameters of a law, each with its meaning; empty where it has no such law.
fn names(code: Code, law: &str) -> &'static str {
    match (code, law) {
        (Code::Abaqus | Code::CalculiX, "neo-hooke" | "mooney-rivlin" | "yeoh") => {
            ABAQUS_POLYNOMIAL
        }
        (Code::Abaqus | Code::CalculiX, "mooney-rivlin-3" | "mooney-rivlin-5") => ABAQUS_POLYNOMIAL,
        (Code::Abaqus | Code::CalculiX, "arruda-boyce") => ABAQUS_ARRUDA_BOYCE,
        (Code::Abaqus | Code::CalculiX, law) if law.starts_with("ogden-") && law.len() == 7 => {
            ABAQUS_OGDEN
        }
        (Code::FeBio, "neo-hooke") => "c1=c10 k=K",
        (Code::FeBio, "mooney-rivlin") => "c1=c10 c2=c01 k=K",
        (Code::FeBio, law) if law.starts_with("ogden-") && law.len() == 7 => FEBIO_OGDEN,
        (Code::FeBio, "gent") => "g=mu jm=jm k=K",
        (Code::FeBio, "veronda-westmann") => "c1=c c2=beta k=K",
        (Code::FeBio, "neo-hooke-simo-pister") => "e=E v=nu",
        _ => "",
    }
}

impl Known {
    /// Adds parameters by their names in another code, whose convention and volume energy they bring along.
    ///
    /// # Errors
    /// [`Error::Input`] where the code has no such law or parameter.
    pub fn with_parameters_of(
        mut self,
        code: Code,
        parameters: &[(String, String)],
    ) -> Result<Self, Error> {
        self.choose_forms(code);
        for (name, value) in parameters {
            match meaning(code, self.law.name, name)? {
                "K" => self.moduli.bulk = Some(quantity(name, value, Dimension::Stress)?),
                "E" => self.moduli.young = Some(quantity(name, value, Dimension::Stress)?),
                "2/K" => self.moduli.bulk = bulk_modulus(name, value)?,
                "nu" => self.moduli.poisson_ratio = Some(quantity(name, value, Dimension::Ratio)?),
                key => self.parameters.push((key.to_owned(), value.clone())),
            }
        }
        Ok(self)
    }

    /// Takes the code's factor of Ogden's law, and its energy of a change of volume.
    fn choose_forms(&mut self, code: Code) {
        let (law, is_febio) = (self.law.name, code == Code::FeBio);
        if law.starts_with("ogden-") {
            let convention = if is_febio {
                "mu/alpha^2"
            } else {
                "2mu/alpha^2"
            };
            self.convention = Some(convention.to_owned());
        }
        self.volume_energy = Some(match law {
            _ if is_febio => VolumeEnergy::Logarithmic,
            "arruda-boyce" => VolumeEnergy::SimoTaylor,
            _ => VolumeEnergy::Quadratic,
        });
    }
}

fn quantity(name: &str, text: &str, dimension: Dimension) -> Result<f64, Error> {
    units::parse(text, dimension).map_err(|fault| {
        let remedy = fault.remedy(text, dimension);
        Error::input(format!("{name}: \"{text}\" {fault}"), remedy)
    })
}

/// What a name of a code means in a law.
fn meaning(code: Code, law: &str, name: &str) -> Result<&'static str, Error> {
    let names = names(code, law).split(' ');
    let names: Vec<_> = names.filter_map(|name| name.split_once('=')).collect();
    if names.is_empty() {
        let message = format!("the parameters of {law} in {} are not known", code.name());
        let hint = "state the parameters by the card's keys, without --convention; `gelbench keys card` lists them";
        return Err(Error::input(message, hint));
    }
    // `mu_1` and `C10` are `mu1` and `c10`.
    let plain = name.to_lowercase();
    let short = plain.replace('_', "");
    let matched = names
        .iter()
        .find(|(known, _)| *known == plain || *known == short);
    matched.map(|(_, meaning)| *meaning).ok_or_else(|| {
        let code = code.name();
        let all: Vec<&str> = names.iter().map(|(known, _)| *known).collect();
        let coupled = match (law, &*plain) {
            ("neo-hooke", "e" | "v") => "; E and v are those of neo-hooke-simo-pister",
            _ => "",
        };
        let message = format!("{name} is not known as a parameter of {law} in {code}");
        Error::input(message, format!("known are {}{coupled}", all.join(", ")))
    })
}

/// κ = 2/D in MPa from D, such as `0.1 1/MPa`; `None` for D = 0, of an incompressible body.
fn bulk_modulus(name: &str, text: &str) -> Result<Option<f64>, Error> {
    let refused = || {
        let message = format!("{name}: \"{text}\" is no reciprocal of a stress");
        let hint = format!(
            "write it as \"0.1 1/MPa\": the bulk modulus is 2/{name}; leave {name} out of an incompressible material, of which it is 0"
        );
        Error::input(message, hint)
    };
    let (number, unit) = text.trim().split_once(' ').ok_or_else(refused)?;
    let number: f64 = number.parse().map_err(|_| refused())?;
    let unit = unit
        .trim()
        .strip_prefix("1/")
        .or((unit.trim() == "mm^2/N").then_some("MPa"))
        .ok_or_else(refused)?;
    let one = units::parse(&format!("1 {unit}"), Dimension::Stress).map_err(|_| refused())?;
    if !(number >= 0.0 && number.is_finite()) {
        return Err(refused());
    }
    Ok((number > 0.0).then(|| 2.0 * one / number))
}
