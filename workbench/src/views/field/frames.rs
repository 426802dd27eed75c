//! The corrected frames of a field: verdict, forces, fields, residuals.

use eframe::egui::{RichText, Slider, Stroke, Ui};

use gelbench::results::Drawing;
use gelbench_report::results::{FieldFigure, Scale};

use super::Fields;
use crate::logic::field::CorrectedFrame;
use crate::views::colours::range;
use crate::views::report;

impl Fields {
    pub(super) fn frames(&mut self, ui: &mut Ui, frames: &[CorrectedFrame]) {
        self.frame = self.frame.min(frames.len().saturating_sub(1));
        if frames.len() > 1 {
            let number = |position: f64| {
                frames
                    .get(position as usize)
                    .map_or(0, |frame| frame.number)
            };
            let slider = Slider::new(&mut self.frame, 0..=frames.len() - 1)
                .custom_formatter(|position, _| number(position).to_string())
                .text("frame");
            ui.add(slider);
        }
        let Some(frame) = frames.get(self.frame) else {
            return;
        };
        let ink = if frame.explained {
            ui.visuals().strong_text_color()
        } else {
            ui.visuals().error_fg_color
        };
        ui.label(
            RichText::new(format!(
                "verdict, frame {}: {}",
                frame.number, frame.verdict
            ))
            .color(ink)
            .strong(),
        );
        forces(ui, frame);
        if let Some((photo, Drawing::Mesh(figure))) = &frame.photo {
            ui.label("the camera image, and the mesh as the corrected field moves it");
            let room = report::room(ui, photo.corners.iter());
            self.photographs.paint(ui, room, Some(self.frame), photo);
            report::mesh_in(ui, room, figure);
        }
        ui.horizontal_wrapped(|ui| {
            for (number, (name, _)) in frame.fields.iter().enumerate() {
                ui.selectable_value(&mut self.field, number, name);
            }
            ui.checkbox(&mut self.residuals, "residuals of the markers");
        });
        self.field = self.field.min(frame.fields.len().saturating_sub(1));
        if let Some((name, panel)) = frame.fields.get(self.field) {
            report::panels(ui, name, Scale::Linear, std::slice::from_ref(panel));
        }
        if self.residuals {
            residuals(ui, frame);
        }
    }

    /// The field that is shown, as the library draws it.
    pub(super) fn drawing(&self, frame: &CorrectedFrame) -> Option<Drawing> {
        let (name, panel) = frame.fields.get(self.field)?;
        let title = format!("Frame {}", frame.number);
        let figure = FieldFigure::new(title, name.clone(), [panel.clone()]);
        Some(Drawing::from(figure))
    }
}

/// The forces on the edges, with their intervals where the field is explained.
fn forces(ui: &mut Ui, frame: &CorrectedFrame) {
    let component = |[value, low, high]: &[f64; 3]| {
        if frame.explained {
            format!("{value:.4} N ({low:.4} … {high:.4})")
        } else {
            format!("{value:.4} N (no interval)")
        }
    };
    for (edge, [x, y]) in &frame.forces {
        let (x, y) = (component(x), component(y));
        ui.label(format!("force on {edge}: x {x}, y {y}"));
    }
}

/// What is left of every marker, enlarged; those that are far off in another colour.
fn residuals(ui: &mut Ui, frame: &CorrectedFrame) {
    let positions: Vec<[f64; 2]> = frame
        .residuals
        .iter()
        .map(|(position, ..)| *position)
        .collect();
    let sizes = frame.residuals.iter().filter(|(.., trust)| *trust > 0.5);
    let largest = sizes
        .map(|(_, residual, _)| residual[0].hypot(residual[1]))
        .fold(0.0, f64::max);
    let Some([low, high]) = range(positions.iter().map(|position| position[0])) else {
        return;
    };
    let enlarged = 0.04 * (high - low) / largest.max(1e-12);
    ui.label(format!("residuals of the markers at their rest positions, magnified {enlarged:.1} times; outliers in the colour of faults"));
    let (view, area) = report::room(ui, positions.iter());
    let painter = ui.painter().with_clip_rect(area);
    for (position, residual, trust) in &frame.residuals {
        let ink = if *trust > 0.5 {
            ui.visuals().text_color()
        } else {
            ui.visuals().error_fg_color
        };
        let to = [0, 1].map(|axis| position[axis] + enlarged * residual[axis]);
        painter.circle_filled(view.at(*position), 1.5, ink);
        painter.line_segment([view.at(*position), view.at(to)], Stroke::new(1.0, ink));
    }
}
