//! A dialogue that must be answered before anything else can be done.

use eframe::egui::{Context, Id, Key, Modal};

/// Asks; the number of the answer that was chosen. Escape chooses the last one, which changes nothing.
pub fn ask(context: &Context, text: &str, answers: &[&str]) -> Option<usize> {
    let modal = Modal::new(Id::unique("question")).show(context, |ui| {
        ui.set_max_width(420.0);
        ui.label(text);
        ui.add_space(8.0);
        let mut chosen = None;
        ui.horizontal_wrapped(|ui| {
            for (number, answer) in answers.iter().enumerate() {
                if ui.button(*answer).clicked() {
                    chosen = Some(number);
                }
            }
        });
        chosen
    });
    let escaped = context.input(|input| input.key_pressed(Key::Escape));
    modal.inner.or_else(|| escaped.then(|| answers.len() - 1))
}
