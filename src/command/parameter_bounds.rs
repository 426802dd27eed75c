//! Bounds and stated values of a fit's parameters.

use clap::Args;

use super::terminal::together;
use gelbench_base::error::{Diagnostic, Error};
use gelbench_base::units::{self, Dimension};
use gelbench_calibration::calibration::Bounds;
use gelbench_mechanics::material::registry::Law;

/// What the command line says of the parameters of a fit.
#[derive(Args)]
pub struct ParameterBounds {
    /// Keep a parameter within limits, in MPa, rad or as a ratio
    #[arg(long = "bound", value_name = "KEY=LOW..HIGH")]
    bounds: Vec<String>,
    /// State a parameter instead of fitting it, such as angle="30 deg" or mu="2 kPa"; a bare number is in MPa, rad or a ratio. families=one
    /// gives the law of Holzapfel, Gasser and Ogden one family of fibres
    #[arg(long = "fix", value_name = "KEY=VALUE", value_parser = pair)]
    fixed: Vec<(String, String)>,
}

impl ParameterBounds {
    /// The law with its choices that are stated, and limits of the parameters; those of a stated one are equal.
    pub fn of(&self, law: &'static Law) -> Result<(&'static Law, Bounds), Error> {
        let (_, entries) = law.unknown();
        let chosen = |key: &str| entries.choices.iter().find(|(known, _)| *known == key);
        let (choices, values): (Vec<_>, Vec<_>) = self
            .fixed
            .iter()
            .cloned()
            .partition(|(key, _)| chosen(key).is_some());
        let mut law = law;
        for (key, choice) in &choices {
            law = law.choosing(key, choice).ok_or_else(|| {
                let taken = chosen(key).map_or("", |(_, taken)| taken.as_str());
                let message = format!("fits of {} cannot have {key} = {choice}", law.name);
                Error::input(message, format!("leave it out: they have {key} = {taken}"))
            })?;
        }
        Ok((law, [bounds(&self.bounds)?, stated(&values)?].concat()))
    }

    /// Limits of the parameters where no law is named.
    pub fn bounds(&self) -> Result<Bounds, Error> {
        Ok([bounds(&self.bounds)?, stated(&self.fixed)?].concat())
    }
}

/// A key with a value, as an option states it.
pub fn pair(text: &str) -> Result<(String, String), Diagnostic> {
    let split = text.split_once('=');
    let parts = split.map(|(key, value)| (key.trim(), value.trim()));
    match parts {
        Some((key, value)) if !key.is_empty() && !value.is_empty() => {
            Ok((key.to_owned(), value.to_owned()))
        }
        _ => {
            let hint = "write it as KEY=VALUE, such as jm=30 or mu=\"20 kPa\"";
            Err(Diagnostic::error("", "is no parameter with a value").hint(hint))
        }
    }
}

/// Bounds as `key=low..high`.
pub fn bounds(texts: &[String]) -> Result<Bounds, Error> {
    let bound = |text: &String| {
        let (key, range) = text.split_once('=')?;
        let (low, high) = range.split_once("..")?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|n| !n.is_nan());
        Some((key.trim().to_owned(), [number(low)?, number(high)?]))
    };
    let each = texts.iter().map(|text| {
        bound(text).ok_or_else(|| {
            Error::input(
                format!("the bound `{text}` cannot be read"),
                "write it as key=low..high, such as jm=5..200",
            )
        })
    });
    together(each)
}

/// Stated values as bounds that are equal.
fn stated(pairs: &[(String, String)]) -> Result<Bounds, Error> {
    let dimensions = [Dimension::Ratio, Dimension::Stress, Dimension::Angle];
    let each = pairs.iter().map(|(key, text)| {
        let value = dimensions
            .iter()
            .find_map(|dimension| units::parse(text, *dimension).ok())
            .ok_or_else(|| {
                let hint = "such as angle=\"30 deg\", mu=\"2 kPa\" or k2=0.8";
                Error::input(format!("the value `{text}` of {key} cannot be read"), hint)
            })?;
        Ok((key.clone(), [value; 2]))
    });
    together(each)
}
