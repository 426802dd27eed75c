//! What the command line says of pictures, as `[pictures]` does in a study.

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::results::{Palette, PictureFormat, PictureStyle, PictureWidth, SheetField};
use crate::studies::pictures::{Pictures, Shown};

/// What the command line says of pictures.
#[derive(Args, Debug)]
#[command(next_help_heading = "Pictures")]
pub struct PictureOptions {
    /// Fields of the corrected sheet to show
    #[arg(long, value_name = "FIELD", value_delimiter = ',', value_parser = names(&SheetField::NAMES),
        default_values = ["von-mises", "largest-principal-stress"])]
    picture_fields: Vec<String>,
    /// Formats of the pictures
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_parser = names(&PictureFormat::NAMES),
        default_value = "png")]
    picture_formats: Vec<String>,
    /// Width of the pictures: one column of a journal is 85 mm wide, two are 180 mm
    #[arg(long, value_name = "WIDTH", value_parser = names(&PictureWidth::NAMES), default_value = "screen")]
    picture_width: String,
    /// Colours of the pictures: dark for slides, print if lightness alone must distinguish them
    #[arg(long, value_name = "NAME", value_parser = names(&Palette::NAMES), default_value = "default")]
    palette: String,
}

fn names<T>(choices: &[(&'static str, T)]) -> PossibleValuesParser {
    PossibleValuesParser::new(choices.iter().map(|(name, _)| *name))
}

fn chosen<T: Copy>(names: &[String], choices: &[(&str, T)]) -> Vec<T> {
    let of_name = |name: &String| choices.iter().find(|(known, _)| known == name);
    names
        .iter()
        .filter_map(of_name)
        .map(|(_, one)| *one)
        .collect()
}

impl PictureOptions {
    /// What is chosen.
    pub fn chosen(&self) -> Pictures {
        let one = std::slice::from_ref;
        let usual = PictureStyle::default();
        Pictures {
            fields: chosen(&self.picture_fields, &SheetField::NAMES),
            shown: Shown::Last,
            style: PictureStyle {
                formats: chosen(&self.picture_formats, &PictureFormat::NAMES),
                width: *chosen(one(&self.picture_width), &PictureWidth::NAMES)
                    .first()
                    .unwrap_or(&usual.width),
                palette: *chosen(one(&self.palette), &Palette::NAMES)
                    .first()
                    .unwrap_or(&usual.palette),
            },
        }
    }
}
