//! What the command line says of pictures, as `[pictures]` does in a study.

use clap::Args;

use crate::command::choice::one_of;
use gelbench_report::results::{Palette, PictureFormat, PictureStyle, PictureWidth, SheetField};
use gelbench_studies::studies::pictures::{Pictures, Shown};

/// What the command line says of the pictures of fields.
#[derive(Args, Debug)]
#[command(next_help_heading = "Pictures")]
pub struct PictureOptions {
    /// Fields of the corrected sheet to show
    #[arg(long, value_name = "FIELD", value_delimiter = ',', value_parser = one_of(&SheetField::NAMES),
        default_values = ["von-mises", "largest-principal-stress"])]
    picture_fields: Vec<SheetField>,
    #[command(flatten)]
    style: StyleOptions,
}

/// What the command line says of how pictures are drawn.
#[derive(Args, Debug)]
#[command(next_help_heading = "Pictures")]
pub struct StyleOptions {
    /// Formats of the pictures
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_parser = one_of(&PictureFormat::NAMES),
        default_value = "png")]
    picture_formats: Vec<PictureFormat>,
    /// Width of the pictures: one column of a journal is 85 mm wide, two are 180 mm
    #[arg(long, value_name = "WIDTH", value_parser = one_of(&PictureWidth::NAMES), default_value = "screen")]
    picture_width: PictureWidth,
    /// Colours of the pictures: dark for slides, print if lightness alone must distinguish them
    #[arg(long, value_name = "NAME", value_parser = one_of(&Palette::NAMES), default_value = "default")]
    palette: Palette,
}

impl StyleOptions {
    /// The style that is chosen.
    pub fn style(&self) -> PictureStyle {
        PictureStyle {
            formats: self.picture_formats.clone(),
            width: self.picture_width,
            palette: self.palette,
        }
    }
}

impl PictureOptions {
    /// The pictures that are chosen.
    pub fn chosen(&self) -> Pictures {
        Pictures {
            fields: self.picture_fields.clone(),
            shown: Shown::Last,
            style: self.style.style(),
        }
    }
}
