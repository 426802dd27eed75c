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

/// What a name of another code stands for.
#[derive(Clone, Copy)]
enum Meaning {
    /// A key of the card.
    Key(&'static str),
    /// D₁ = 2/κ.
    Compliance,
    /// κ.
    BulkModulus,
    /// E.
    Young,
    /// ν.
    PoissonRatio,
}
use Meaning::{BulkModulus, Compliance, Key, PoissonRatio, Young};

type Names = &'static [(&'static str, Meaning)];

const ABAQUS_OGDEN: Names = &[
    ("mu1", Key("mu_1")),
    ("alpha1", Key("alpha_1")),
    ("mu2", Key("mu_2")),
    ("alpha2", Key("alpha_2")),
    ("mu3", Key("mu_3")),
    ("alpha3", Key("alpha_3")),
    ("mu4", Key("mu_4")),
    ("alpha4", Key("alpha_4")),
    ("d1", Compliance),
];
const ABAQUS_POLYNOMIAL: Names = &[
    ("c10", Key("c10")),
    ("c01", Key("c01")),
    ("c20", Key("c20")),
    ("c11", Key("c11")),
    ("c02", Key("c02")),
    ("c30", Key("c30")),
    ("d1", Compliance),
];
const ABAQUS_ARRUDA_BOYCE: Names = &[
    ("mu", Key("mu")),
    ("lambda_m", Key("lambda_m")),
    ("d", Compliance),
];

const FEBIO_MOONEY_RIVLIN: Names = &[("c1", Key("c10")), ("c2", Key("c01")), ("k", BulkModulus)];
const FEBIO_OGDEN: Names = &[
    ("c1", Key("mu_1")),
    ("m1", Key("alpha_1")),
    ("c2", Key("mu_2")),
    ("m2", Key("alpha_2")),
    ("c3", Key("mu_3")),
    ("m3", Key("alpha_3")),
    ("c4", Key("mu_4")),
    ("m4", Key("alpha_4")),
    ("k", BulkModulus),
];
const FEBIO_GENT: Names = &[("g", Key("mu")), ("jm", Key("jm")), ("k", BulkModulus)];
const FEBIO_VERONDA_WESTMANN: Names = &[("c1", Key("c")), ("c2", Key("beta")), ("k", BulkModulus)];
const FEBIO_NEO_HOOKE: Names = &[("c1", Key("c10")), ("k", BulkModulus)];
const FEBIO_COUPLED_NEO_HOOKE: Names = &[("e", Young), ("v", PoissonRatio)];

/// The names that a code has for the parameters of a law; empty where it has no such law.
fn names(code: Code, law: &str) -> Names {
    match (code, law) {
        (Code::Abaqus | Code::CalculiX, "neo-hooke" | "mooney-rivlin" | "yeoh") => {
            ABAQUS_POLYNOMIAL
        }
        (Code::Abaqus | Code::CalculiX, "mooney-rivlin-3" | "mooney-rivlin-5") => ABAQUS_POLYNOMIAL,
        (Code::Abaqus | Code::CalculiX, "arruda-boyce") => ABAQUS_ARRUDA_BOYCE,
        (Code::Abaqus | Code::CalculiX, law) if law.starts_with("ogden-") && law.len() == 7 => {
            ABAQUS_OGDEN
        }
        (Code::FeBio, "neo-hooke") => FEBIO_NEO_HOOKE,
        (Code::FeBio, "mooney-rivlin") => FEBIO_MOONEY_RIVLIN,
        (Code::FeBio, law) if law.starts_with("ogden-") && law.len() == 7 => FEBIO_OGDEN,
        (Code::FeBio, "gent") => FEBIO_GENT,
        (Code::FeBio, "veronda-westmann") => FEBIO_VERONDA_WESTMANN,
        (Code::FeBio, "neo-hooke-simo-pister") => FEBIO_COUPLED_NEO_HOOKE,
        _ => &[],
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
            let meaning = meaning(code, self.law.name, name)?;
            match meaning {
                Key(key) => self.parameters.push((key.to_owned(), value.clone())),
                BulkModulus => self.moduli.bulk = Some(quantity(name, value, Dimension::Stress)?),
                Young => self.moduli.young = Some(quantity(name, value, Dimension::Stress)?),
                Compliance => self.moduli.bulk = bulk_modulus(name, value)?,
                PoissonRatio => {
                    self.moduli.poisson_ratio = Some(quantity(name, value, Dimension::Ratio)?);
                }
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
fn meaning(code: Code, law: &str, name: &str) -> Result<Meaning, Error> {
    let names = names(code, law);
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
        Error::input(
            message,
            "write it as \"0.1 1/MPa\"; the bulk modulus is 2/D",
        )
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
