//! The options about pictures, which are those of `[pictures]` in a study.

use clap::Args;

use crate::command::arguments::one_of;
use gelbench_report::results::{
    Palette, PictureFormat, PictureStyle, PictureWidth, SheetField, ShownFields,
};
use gelbench_studies::studies::pictures::Pictures;

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
    /// Size of the numbers in points, in print
    #[arg(long, value_name = "POINTS", value_parser = font_size, default_value_t = PictureStyle::FONT_SIZE)]
    font_size: f64,
}

/// The size of letters, as studies bound it.
fn font_size(text: &str) -> Result<f64, String> {
    let number = text.trim_end_matches("pt").trim().parse();
    let size = number.ok().filter(|size| (5.0..=12.0).contains(size));
    size.ok_or_else(|| "must be a number of points from 5 to 12, such as 9".to_owned())
}

impl StyleOptions {
    /// The style that is chosen.
    pub fn style(&self) -> PictureStyle {
        PictureStyle {
            formats: self.picture_formats.clone(),
            width: self.picture_width,
            palette: self.palette,
            font_size: self.font_size,
        }
    }
}

impl PictureOptions {
    /// The pictures that are chosen.
    pub fn chosen(&self) -> Pictures {
        Pictures {
            fields: ShownFields {
                fields: self.picture_fields.clone(),
                ..Pictures::default().fields
            },
            style: self.style.style(),
            ..Pictures::default()
        }
    }
}
