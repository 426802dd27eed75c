//! The mesh of a field with its edges: after a click on an edge its conditions can be stated.

use eframe::egui::{
    Align2, Color32, ComboBox, FontId, Grid, Id, Popup, PopupAnchor, PopupCloseBehavior, Pos2,
    Rect, Response, RichText, Role, Sense, Shape, Stroke, TextEdit, Ui, WidgetInfo, vec2,
};

use gelbench::results::Drawing;
use gelbench_report::results::MeshFigure;

use super::{Fields, REACH};
use crate::logic::field::{Edge, Preview, middle, nearest};
use crate::views::colours::range;
use crate::views::report;
use crate::views::surface::View;

/// The edge that is asked about, and where on the screen.
pub type Asked = Option<(String, Pos2)>;

impl Fields {
    /// One line for every edge, for those who use no mouse.
    pub(super) fn edges(&mut self, ui: &mut Ui, preview: &Preview) {
        let Drawing::Mesh(figure) = &preview.drawing else {
            return;
        };
        Grid::new("edges").num_columns(3).show(ui, |ui| {
            for name in &preview.edges {
                let ink = report::edge_colour(figure, name);
                let label = ui.label(RichText::new(name).color(ink).strong());
                let edge = self.question.edges.entry(name.clone()).or_default();
                let chosen = ComboBox::from_id_salt(("edge", name))
                    .width(120.0)
                    .selected_text(edge.name())
                    .show_ui(ui, |ui| kinds(ui, edge));
                chosen.response.labelled_by(label.id);
                displacements(ui, name, edge);
                ui.end_row();
            }
        });
    }

    /// The mesh, its edges and the markers of the last frame.
    pub(super) fn mesh(&mut self, ui: &mut Ui, preview: &Preview) {
        let Drawing::Mesh(figure) = &preview.drawing else {
            return;
        };
        let (view, area) = report::room(ui, figure.cells.iter().flatten());
        if let Some(photo) = &preview.photo {
            self.photographs.paint(ui, (view, area), None, photo);
        }
        report::mesh_in(ui, (view, area), figure);
        self.view = Some(view);
        let response = ui.interact(
            area.expand(6.0),
            ui.scope_id().with("edges"),
            Sense::click(),
        );
        response.widget_info(|| {
            let label = "mesh of the field: click an edge and state what is known about it";
            WidgetInfo::labeled(Role::Image, true, label)
        });
        markers(ui, view, area, preview);
        let reach = view.vector(vec2(REACH, 0.0))[0];
        let at = |pointer: Pos2| nearest(figure, view.position(pointer), reach);
        let under = response.hover_pos().and_then(at);
        for name in &preview.edges {
            let asked = self.asked.as_ref().is_some_and(|(asked, _)| asked == name);
            let edge = self.question.edges.get(name);
            let stated = edge.filter(|edge| **edge != Edge::Unnamed);
            draw(ui, view, figure, name, stated, asked || under == Some(name));
        }
        if under.is_some() {
            let icon = eframe::egui::CursorIcon::PointingHand;
            ui.ctx().set_cursor_icon(icon);
        }
        if response.clicked() {
            let pointer = response.interact_pointer_pos();
            let clicked = pointer.and_then(|pointer| Some((at(pointer)?.to_owned(), pointer)));
            self.asked = clicked;
        } else {
            self.ask_of_edge(ui, &response);
        }
    }

    /// Asks for the conditions of the edge that was clicked.
    fn ask_of_edge(&mut self, ui: &Ui, response: &Response) {
        let Some((name, position)) = self.asked.clone() else {
            return;
        };
        let edge = self.question.edges.entry(name.clone()).or_default();
        let mut open = true;
        let popup = Popup::new(
            Id::unique(("edge is asked about", &name)),
            ui.ctx().clone(),
            PopupAnchor::Position(position),
            response.layer_id,
        );
        popup
            .open_bool(&mut open)
            .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
            .show(|ui| {
                ui.label(RichText::new(format!("the edge {name}")).strong());
                kinds(ui, edge);
                ui.horizontal(|ui| displacements(ui, &name, edge));
            });
        if !open {
            self.asked = None;
        }
    }
}

/// What may be known of an edge, to choose from.
fn kinds(ui: &mut Ui, edge: &mut Edge) {
    for kind in Edge::all() {
        let chosen = edge.is_like(&kind);
        let hint = match kind {
            Edge::Unnamed => "not stated: the data determine whether it is free",
            Edge::Free => "no traction acts on it",
            Edge::Rigid => "it moved as a rigid body by unknown amounts: a grip",
            Edge::Known(_) => "its displacement is known",
            Edge::Unknown => "its load is unknown and its displacement smooth",
        };
        let label = ui.selectable_label(chosen, kind.name()).on_hover_text(hint);
        if label.clicked() && !chosen {
            *edge = kind;
        }
    }
}

/// The displacement of a known edge.
fn displacements(ui: &mut Ui, name: &str, edge: &mut Edge) {
    let Edge::Known(axes) = edge else {
        return;
    };
    ui.horizontal(|ui| {
        for (axis, text) in ["ux", "uy"].into_iter().zip(axes) {
            let label = ui.label(axis);
            let field = TextEdit::singleline(text)
                .id_salt((name, axis))
                .hint_text("free")
                .desired_width(64.0);
            ui.add(field).labelled_by(label.id);
        }
    });
}

/// The markers at rest, and how they moved: half of the arrows are no longer than markers are apart.
fn markers(ui: &mut Ui, view: View, area: Rect, preview: &Preview) {
    let displacement = |[rest, moved]: &[[f64; 2]; 2]| [moved[0] - rest[0], moved[1] - rest[1]];
    let displacements = preview.markers.iter().map(displacement);
    let mut lengths: Vec<f64> = displacements.map(|[x, y]| x.hypot(y)).collect();
    lengths.sort_by(f64::total_cmp);
    let usual = lengths.get(lengths.len() / 2).copied().unwrap_or(0.0);
    let along = |axis: usize| range(preview.markers.iter().map(|marker| marker[0][axis]));
    let (Some([left, right]), Some([bottom, top])) = (along(0), along(1)) else {
        return;
    };
    let apart = ((right - left) * (top - bottom) / preview.markers.len() as f64).sqrt();
    let shown = (apart / usual.max(1e-12)).min(1.0);
    let painter = ui.painter().with_clip_rect(area);
    let ink = ui.visuals().strong_text_color();
    for marker in &preview.markers {
        let (rest, displacement) = (marker[0], displacement(marker));
        let to = [0, 1].map(|axis| rest[axis] + shown * displacement[axis]);
        let (from, to) = (view.at(rest), view.at(to));
        painter.circle_filled(from, 1.5, ink);
        painter.line_segment([from, to], Stroke::new(1.0, ink.gamma_multiply(0.6)));
    }
    let words = if shown < 1.0 {
        format!("displacements magnified {shown:.2} times")
    } else {
        "their displacements".to_owned()
    };
    let words = format!("points: the markers of the last frame at rest; lines: {words}");
    ui.label(RichText::new(words).small());
}

/// An edge with what is stated about it; thicker where it is pointed at.
fn draw(
    ui: &Ui,
    view: View,
    figure: &MeshFigure,
    name: &str,
    stated: Option<&Edge>,
    pointed: bool,
) {
    let painter = ui.painter();
    let ink = report::edge_colour(figure, name);
    let Some(group) = figure.groups.iter().find(|group| group.name == name) else {
        return;
    };
    if pointed {
        for line in &group.lines {
            let positions = line.iter().map(|position| view.at(*position)).collect();
            painter.add(Shape::line(positions, Stroke::new(7.0, ink)));
        }
    }
    let Some(middle) = middle(&group.lines) else {
        return;
    };
    let text = match stated {
        Some(edge) => format!("{name}: {}", edge.name()),
        None => name.to_owned(),
    };
    let letters = painter.layout_no_wrap(text, FontId::proportional(12.0), Color32::PLACEHOLDER);
    let clip = ui.clip_rect().shrink(2.0);
    let position = Align2::CENTER_CENTER.anchor_size(view.at(middle), letters.size());
    let inside = position.min.max(clip.min).min(clip.max - letters.size());
    let paper = ui.visuals().panel_fill.gamma_multiply(0.85);
    let back = Rect::from_min_size(inside, letters.size()).expand(2.0);
    painter.rect_filled(back, 3.0, paper);
    painter.galley(inside, letters, ui.visuals().strong_text_color());
}
