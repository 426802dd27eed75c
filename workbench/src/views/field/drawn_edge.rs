//! The specimen's edge drawn over the camera image at rest: a click for every corner.

use eframe::egui::{Button, Pos2, Role, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};

use super::{Fields, REACH};
use crate::logic::field::{DRAWN, Photo, lines_of};
use crate::views::report;
use crate::views::surface::View;

/// Lines of corners in mm.
#[derive(Default)]
pub struct DrawnEdge {
    /// Those that are closed, the edge first and then its holes.
    closed: Vec<Vec<[f64; 2]>>,
    /// The one that is being drawn.
    open: Vec<[f64; 2]>,
}

impl DrawnEdge {
    /// A corner; the first one again closes the line.
    fn click(&mut self, corner: [f64; 2], reach: f64) {
        let is_first =
            |first: &[f64; 2]| (first[0] - corner[0]).hypot(first[1] - corner[1]) < reach;
        if self.open.len() > 2 && self.open.first().is_some_and(is_first) {
            self.closed.push(std::mem::take(&mut self.open));
        } else {
            self.open.push(corner);
        }
    }

    /// Takes back the last corner; a line that was closed is open again.
    fn undo(&mut self) {
        if self.open.is_empty() {
            self.open = self.closed.pop().unwrap_or_default();
        } else {
            self.open.pop();
        }
    }

    fn is_complete(&self) -> bool {
        self.open.is_empty() && !self.closed.is_empty()
    }
}

impl Fields {
    /// Draws the edge if that was begun; whether it is being drawn.
    pub(super) fn draws_edge(&mut self, ui: &mut Ui, photo: &Photo) -> bool {
        if self.drawn.is_none() {
            if self.question.edge_file.is_none() && ui.button("draw the edge").clicked() {
                self.drawn = Some(DrawnEdge::default());
            }
            return false;
        }
        let mut drawn = self.drawn.take().unwrap_or_default();
        ui.label("Click the corners of the specimen one after the other, and the first one again to close the line. Further lines are holes.");
        self.corners(ui, photo, &mut drawn);
        let mut goes_on = true;
        ui.horizontal(|ui| {
            if ui.button("take back the last corner").clicked() {
                drawn.undo();
            }
            if ui
                .add_enabled(drawn.is_complete(), Button::new("use this edge"))
                .clicked()
            {
                goes_on = false;
                self.put_edge((DRAWN.to_owned(), lines_of(&drawn.closed)));
            }
            goes_on &= !ui.button("do not draw").clicked();
        });
        self.drawn = goes_on.then_some(drawn);
        true
    }

    /// The image, and the lines on it.
    fn corners(&mut self, ui: &mut Ui, photo: &Photo, drawn: &mut DrawnEdge) {
        let (view, area) = report::room(ui, photo.corners.iter());
        self.photographs.paint(ui, (view, area), None, photo);
        self.view = Some(view);
        let response = ui.interact(area, ui.scope_id().with("drawn edge"), Sense::click());
        response.widget_info(|| {
            let label = "camera image at rest: click the corners of the specimen";
            WidgetInfo::labeled(Role::Image, true, label)
        });
        if let Some(pointer) = response
            .interact_pointer_pos()
            .filter(|_| response.clicked())
        {
            let reach = view.vector(vec2(REACH, 0.0))[0];
            drawn.click(view.position(pointer), reach);
        }
        lines(ui, view, drawn, response.hover_pos());
    }
}

/// Closed lines, and the open one up to the pointer.
fn lines(ui: &Ui, view: View, drawn: &DrawnEdge, pointer: Option<Pos2>) {
    let stroke = Stroke::new(2.0, ui.visuals().warn_fg_color);
    let at =
        |line: &[[f64; 2]]| -> Vec<Pos2> { line.iter().map(|corner| view.at(*corner)).collect() };
    for line in &drawn.closed {
        ui.painter().add(Shape::closed_line(at(line), stroke));
    }
    let corners = at(&drawn.open);
    for corner in &corners {
        ui.painter().circle_filled(*corner, 3.0, stroke.color);
    }
    let to_pointer = pointer.filter(|_| !corners.is_empty());
    let line = corners.into_iter().chain(to_pointer).collect();
    ui.painter().add(Shape::line(line, stroke));
}
