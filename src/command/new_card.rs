//! `gelbench materials new` and `check`: cards from known moduli or parameters, and checks of cards that are to be shared.

use std::path::{Path, PathBuf};

use clap::{ArgAction, Args};

use super::arguments::{one_of, quantity};
use super::fit::{a_law, shipped};
use super::message::along;
use super::parameter_bounds::pair;
use super::terminal::{Outcome, print, save};
use gelbench_base::document::{file, read_text};
use gelbench_base::error::{Diagnostic, Error};
use gelbench_base::units::{Dimension, brief};
use gelbench_mechanics::material::registry::Law;
use gelbench_mechanics::material::{Card, Code, Known, Moduli, VolumeEnergy};

pub const NEW_HELP: &str = "\
Samples:
  gelbench materials new --law neo-hooke --young \"20 kPa\"
  gelbench materials new --law neo-hooke --young \"20 kPa\" --poisson 0.45 --name gel
  gelbench materials new --law gent --shear-modulus \"20 kPa\" --parameter jm=30
  gelbench materials new --law ogden-1 --convention mu/alpha --parameter mu_1=\"20 kPa\" --parameter alpha_1=4
  gelbench materials new --law mooney-rivlin --convention febio --parameter c1=\"8 kPa\" --parameter c2=\"2 kPa\" --parameter k=\"5 MPa\"
  gelbench materials new --law yeoh --convention abaqus --parameter C10=\"8 kPa\" --parameter C20=\"1 kPa\" --parameter C30=\"0 kPa\" --parameter D1=\"0.4 1/MPa\"

A Poisson's ratio of 0.5, or none, is that of an incompressible law. With one modulus, one parameter of the law that is a stress
follows from it; the others are stated. `gelbench materials list` shows the laws, `gelbench keys card` their parameters.";

/// The form in which the parameters are stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// The factor of Ogden's law.
    Ogden(&'static str),
    /// Names, factor and volume energy of another code.
    OfCode(Code),
}

const FORMS: [(&str, Form); 6] = [
    ("2mu/alpha^2", Form::Ogden("2mu/alpha^2")),
    ("mu/alpha", Form::Ogden("mu/alpha")),
    ("mu/alpha^2", Form::Ogden("mu/alpha^2")),
    ("abaqus", Form::OfCode(Code::Abaqus)),
    ("calculix", Form::OfCode(Code::CalculiX)),
    ("febio", Form::OfCode(Code::FeBio)),
];

#[derive(Args)]
pub struct NewCard {
    /// The law
    #[arg(long, value_parser = a_law())]
    law: &'static Law,
    /// Young's modulus at rest, such as "20 kPa"
    #[arg(long, value_name = "STRESS", value_parser = stress)]
    young: Option<f64>,
    /// Poisson's ratio at rest; 0.5 if the material is incompressible
    #[arg(long, value_name = "RATIO", value_parser = ratio, allow_hyphen_values = true)]
    poisson: Option<f64>,
    /// Shear modulus at rest
    #[arg(long, value_name = "STRESS", value_parser = stress)]
    shear_modulus: Option<f64>,
    /// Bulk modulus at rest
    #[arg(long, value_name = "STRESS", value_parser = stress)]
    bulk_modulus: Option<f64>,
    /// A parameter of the law by its key on a card, such as jm=30 or mu="20 kPa"
    #[arg(long = "parameter", value_name = "KEY=VALUE", value_parser = pair, action = ArgAction::Append)]
    parameters: Vec<(String, String)>,
    /// The factor before the sums of Ogden's law, or the code whose names, factor and volume energy the parameters follow
    #[arg(long, value_parser = one_of(&FORMS))]
    convention: Option<Form>,
    /// The energy of a change of volume
    #[arg(long, value_parser = one_of(&VolumeEnergy::NAMES))]
    volume_energy: Option<VolumeEnergy>,
    /// Mass density, such as "1020 kg/m^3", which motions need
    #[arg(long)]
    density: Option<String>,
    /// Name of the written card; the law's and what is stated if omitted
    #[arg(long)]
    name: Option<String>,
    /// Write into this folder
    #[arg(long, value_name = "FOLDER", default_value = "output/materials")]
    output: PathBuf,
}

impl NewCard {
    /// What is known of the material.
    fn known(&self) -> Result<Known, Error> {
        let known = Known {
            moduli: Moduli {
                young: self.young,
                poisson_ratio: self.poisson,
                shear: self.shear_modulus,
                bulk: self.bulk_modulus,
            },
            density: self.density.clone(),
            ..Known::of(self.law)
        };
        let known = match self.convention {
            Some(Form::OfCode(code)) => known.with_parameters_of(code, &self.parameters)?,
            other => Known {
                parameters: self.parameters.clone(),
                convention: match other {
                    Some(Form::Ogden(convention)) => Some(convention.to_owned()),
                    _ => None,
                },
                ..known
            },
        };
        Ok(Known {
            volume_energy: self.volume_energy.or(known.volume_energy),
            ..known
        })
    }

    /// What is stated, in words: `E = 0.02 MPa, ν = 0.45, jm = 30`.
    fn statement(&self) -> String {
        let moduli = [
            ("E", self.young, " MPa"),
            ("ν", self.poisson, ""),
            ("μ", self.shear_modulus, " MPa"),
            ("K", self.bulk_modulus, " MPa"),
        ];
        let moduli = moduli.into_iter().filter_map(|(symbol, value, unit)| {
            value.map(|value| format!("{symbol} = {value}{unit}"))
        });
        let parameters = self.parameters.iter();
        let parameters = parameters.map(|(key, value)| format!("{key} = {value}"));
        let mut forms = FORMS.iter();
        let chosen = forms.find(|(_, form)| self.convention == Some(*form));
        let form = chosen.map(|(name, _)| format!("convention {name}"));
        moduli
            .chain(parameters)
            .chain(form)
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// The path of the card: from its name, else from the law and the stated values.
    fn path(&self, statement: &str) -> Result<PathBuf, Error> {
        let name = self.name.clone().unwrap_or_else(|| {
            let plain = |c: char| {
                if c.is_ascii_alphanumeric() || c == '.' {
                    c
                } else {
                    '-'
                }
            };
            let stated = statement.replace('ν', "nu").replace('μ', "mu");
            let words: String = format!("{} {stated}", self.law.name)
                .chars()
                .map(plain)
                .collect();
            let words = words.split('-').filter(|word| !word.is_empty());
            words.collect::<Vec<_>>().join("-")
        });
        let name = name.strip_suffix(".toml").unwrap_or(&name);
        let path = self.output.join(format!("{name}.toml"));
        if Path::new(name).file_name().is_none() {
            let hint = "such as --name my-gel";
            return Err(Error::input(
                format!("--name \"{name}\" names no file"),
                hint,
            ));
        }
        Ok(path)
    }
}

/// Writes a card of known moduli or parameters.
pub fn new_card(options: &NewCard) -> Outcome {
    let statement = options.statement();
    let title = format!("{}: {statement}", options.law.name);
    let text = options.known()?.card_text(&title)?;
    let head = "# Written by `gelbench materials new`: nothing was measured, so that no range and no source are stated.\n\n";
    let text = format!("{head}{text}");
    let path = options.path(&statement)?;
    let there = std::fs::read_to_string(&path).ok();
    if path.exists() && there.as_ref() != Some(&text) {
        let cause = "another file of this name exists; choose another --name or --output";
        return Err(Error::write(path, cause));
    }
    let shown = path.display().to_string();
    let card = Card::parse(&shown, &shown, &text)?;
    if there.is_none() {
        save(&path, text.as_bytes())?;
    }
    print(&described(&card))?;
    print(&format!(
        "\nwritten: {shown}; use it in a study as material.card = \"{shown}\", where the path is relative to the study\n\
         curves and stable ranges: gelbench materials show {shown}\n"
    ))?;
    Ok(0)
}

/// The energy that is computed, with its numbers, and the moduli at rest.
fn described(card: &Card) -> String {
    let moduli = card.small_strain();
    let bulk = match moduli.bulk_modulus {
        infinite if infinite.is_infinite() => "K infinite: the volume is constant".to_owned(),
        bulk => format!("K = {} MPa", brief(bulk)),
    };
    let [young, ratio, shear] = [
        moduli.youngs_modulus,
        moduli.poisson_ratio,
        moduli.shear_modulus,
    ]
    .map(brief);
    format!(
        "{}\n\n  energy     {}\n  with       {}\n  at rest    E = {young} MPa{}, ν = {ratio}, μ = {shear} MPa, {bulk}\n",
        card.title,
        card.energy(),
        card.symbols().join(", "),
        along(card)
    )
}

#[derive(Args)]
pub struct CheckCards {
    /// Cards ending in .toml, or names of shipped ones
    #[arg(required = true, value_name = "CARD")]
    cards: Vec<String>,
    /// Also require what others need to know: title, test, measures, range, citation and specimen
    #[arg(long)]
    share: bool,
}

/// Reads cards and reports every fault of all of them.
pub fn check_cards(options: &CheckCards) -> Outcome {
    let mut faults: Vec<Diagnostic> = Vec::new();
    let mut lines = String::new();
    for name in &options.cards {
        match check_card(name, options.share) {
            Ok(line) => lines += &line,
            Err(Error::Input(wrong)) => faults.extend(wrong),
            Err(other) => return Err(other),
        }
    }
    print(&lines)?;
    Error::refuse(faults)?;
    Ok(0)
}

/// Reads a card, and returns a line about it.
fn check_card(name: &str, is_shared: bool) -> Result<String, Error> {
    if shipped(name) || !is_shared {
        let card = Card::load(name, Path::new("."))?;
        let remark = if card.range_is_stated && card.citation != "not stated" {
            ""
        } else {
            "; to share it, state range and source: gelbench materials check --share"
        };
        return Ok(format!("{name}: no faults{remark}\n"));
    }
    let hint = "a card is TOML in UTF-8";
    let text = read_text(Path::new(name), file::MOST_OF_A_STUDY, hint)?;
    Card::parse_shared(name, name, &text)?;
    Ok(format!(
        "{name}: no faults, and what others need to know is stated\n"
    ))
}

fn stress(text: &str) -> Result<f64, Diagnostic> {
    quantity(text, Dimension::Stress)
}

fn ratio(text: &str) -> Result<f64, Diagnostic> {
    quantity(text, Dimension::Ratio)
}
