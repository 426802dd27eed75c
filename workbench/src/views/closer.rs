//! The magnification of sheets: the wheel, two fingers and a pulled background.

use eframe::egui::{InputState, Pos2, Response, Ui, Vec2};

use super::surface::View;

/// The magnification of a sheet, and the shift of its middle in points.
#[derive(Clone, Copy, PartialEq)]
pub struct Closer {
    factor: f32,
    shift: Vec2,
}

impl Default for Closer {
    fn default() -> Self {
        Self {
            factor: 1.0,
            shift: Vec2::ZERO,
        }
    }
}

/// The factors within which a sheet is looked at, and the points of a wheel that make e of one.
const FACTORS: [f32; 2] = [0.5, 50.0];
const WHEEL: f32 = 250.0;

impl Closer {
    /// The magnified part of a view of the complete sheet; `middle` is that of the sheet.
    pub fn of(self, full: View, middle: Pos2) -> View {
        full.closer(middle, self.factor, self.shift)
    }

    /// Follows the wheel, two fingers, and the pointer that pulls the background; a double click shows the complete sheet again.
    pub fn follow(&mut self, ui: &Ui, background: &Response, middle: Pos2) {
        if background.double_clicked() {
            *self = Self::default();
        }
        self.shift += background.drag_delta();
        let pointer = background.hover_pos();
        let Some(pointer) = pointer.filter(|_| background.contains_pointer()) else {
            return;
        };
        let wheel = ui.input(|input| input.smooth_scroll_delta().y);
        let factor = ui.input(InputState::zoom_delta) * (wheel / WHEEL).exp();
        let [least, most] = FACTORS.map(|factor| factor / self.factor);
        let factor = factor.clamp(least, most);
        self.factor *= factor;
        // What lies under the pointer stays there.
        let from_middle = pointer - middle;
        self.shift = from_middle - factor * (from_middle - self.shift);
    }
}
