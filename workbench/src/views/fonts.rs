//! Letters: those of egui, and for mathematics those of DejaVu Sans.

use std::sync::Arc;

use eframe::egui::{Context, FontData, FontDefinitions, FontId, TextStyle};

const NAME: &str = "symbols";
const SYMBOLS: &[u8] = include_bytes!("../../fonts/dejavu-sans-symbols.ttf");

/// The size of small letters in points: what egui takes is too small for notes that are to be read.
const SMALL: f32 = 10.5;

/// Lets all texts take from DejaVu Sans what egui's own letters lack.
pub fn install(context: &Context) {
    let mut fonts = FontDefinitions::default();
    let data = Arc::new(FontData::from_static(SYMBOLS));
    fonts.font_data.insert(NAME.to_owned(), data);
    for family in fonts.families.values_mut() {
        family.push(NAME.to_owned());
    }
    context.set_fonts(fonts);
    context.all_styles_mut(|style| {
        style
            .text_styles
            .insert(TextStyle::Small, FontId::proportional(SMALL));
    });
}
