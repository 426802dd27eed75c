//! The sheets of the models, each by itself or superimposed.

use std::sync::Arc;

use eframe::egui::{
    Align2, Color32, FontId, Label, Margin, Mesh as Triangles, Painter, Pos2, Rect, RichText,
    Sense, Shape, Stroke, Ui, UiBuilder, vec2,
};

use gelbench::mesh::Mesh;

use super::colours::{Span, colour, colour_bar, most_of};
use super::figures::headline;
use super::grip::{self, Held};
use super::surface::{Closer, View, draw, triangles};
use crate::logic::scene::{Layout, Model, Scene};
use crate::logic::table::{Drawn, Table};

/// Multipliers that are drawn at most.
const ARROWS: usize = 300;

/// The heights of the scale of the colours, and of the row of warnings above it.
const BAR: f32 = 34.0;
const WARNINGS: f32 = 18.0;

/// What is free around a sheet for its name and the knob of its grip.
const AROUND: Margin = Margin {
    left: 14,
    right: 14,
    top: 26,
    bottom: 8,
};

/// What was drawn last: it is drawn again where nothing changed.
#[derive(Default)]
pub struct Sheets {
    drawn: [Option<Painted>; 3],
    triangles: [Option<(usize, Vec<u32>)>; 3],
    span: Option<(u64, Span)>,
    /// The largest stretch and motion across that the view has room for.
    room: [f64; 2],
    closer: Closer,
}

/// Where and how one sheet is drawn.
struct Place<'a> {
    ui: &'a Ui,
    painter: Painter,
    table: &'a Table,
    view: View,
    range: [f64; 2],
    /// Whether another one lies below.
    outline_only: bool,
}

struct Painted {
    revision: u64,
    view: View,
    range: [f64; 2],
    surface: Arc<Triangles>,
}

impl Sheets {
    /// Draws what is on the table into all the room that there is; what was done to the grip, where there is one to be seen.
    pub fn show(&mut self, ui: &mut Ui, table: &Table) -> Option<Held> {
        let mut held: Option<Held> = None;
        // Not by Tab: the grips are.
        let sense = Sense::CLICK | Sense::DRAG;
        let (area, background) = ui.allocate_exact_size(ui.available_size(), sense);
        let models: Vec<Model> = Model::ALL
            .into_iter()
            .filter(|model| table.scene().look.models[*model as usize])
            .collect();
        let span = self.span(table, &models);
        let range = span.range;
        let (above, bar) = area.split_top_bottom_at_y(area.bottom() - BAR);
        let (sheets, row) = above.split_top_bottom_at_y(above.bottom() - WARNINGS);
        let overlaid = table.scene().look.layout == Layout::Over;
        let areas = rows(sheets, if overlaid { 1 } else { models.len() });
        let is_hovered = |row: &&Rect| background.hover_pos().is_some_and(|at| row.contains(at));
        if let Some(row) = areas.iter().find(is_hovered).or(areas.first()) {
            self.closer.follow(ui, &background, row.center());
        }
        for (number, model) in models.iter().enumerate() {
            let row_area = areas[if overlaid { 0 } else { number }];
            let line = if overlaid { 15.0 * number as f32 } else { 0.0 };
            let position = Place {
                ui,
                painter: ui.painter().with_clip_rect(row_area),
                table,
                view: self.view(table.scene(), row_area - AROUND),
                range,
                outline_only: overlaid && number > 0,
            };
            self.sheet(&position, *model);
            label(&position, *model, row_area.min + vec2(6.0, 4.0 + line));
            let view = position.view;
            if table.played().is_some() {
                held = Some(Held {
                    to: None,
                    holding: false,
                    released: false,
                    at: view.at([table.scene().size[0], 0.0]),
                });
            } else if number == 0 || !overlaid {
                let mut inside = ui.new_child(UiBuilder::new().max_rect(row_area));
                inside.shrink_clip_rect(row_area);
                let grip = grip::show(&inside, table.scene(), view, model.name());
                if held.is_none() || grip.to.is_some() || grip.holding || grip.released {
                    held = Some(grip);
                }
            }
        }
        let untouched = table.steps() == [false; 2] && table.moving().is_none();
        if let Some(held) = held.as_ref().filter(|_| untouched) {
            invite(ui, held.at);
        }
        warnings(ui, table, row);
        colour_bar(ui, table.shown_colour().name(), span, bar);
        if !held.as_ref().is_some_and(|held| held.holding) {
            self.room = room(table.scene());
        }
        held
    }

    /// The span of the colours of all models that are shown, which is computed when they change.
    fn span(&mut self, table: &Table, models: &[Model]) -> Span {
        if let Some((_, span)) = self.span.filter(|(known, _)| *known == table.revision()) {
            return span;
        }
        let span = most_of(table.spanned(models)).unwrap_or(Span {
            range: [0.0, 1.0],
            exceeded: [false; 2],
        });
        self.span = Some((table.revision(), span));
        span
    }

    /// The part of the plane that is seen: while the grip is pulled it only grows.
    fn view(&mut self, scene: &Scene, screen: Rect) -> View {
        let now = room(scene);
        self.room = [0, 1].map(|axis| f64::max(self.room[axis], now[axis]));
        let [length, width] = scene.size;
        let (axis, across) = (scene.axis(), 0.5 * width + self.room[1]);
        let right = length * (1.0 + self.room[0]);
        let full = View::fit([[0.0, axis - across], [right, axis + across]], screen);
        self.closer.of(full, screen.center())
    }

    fn sheet(&mut self, position: &Place, model: Model) {
        let table = position.table;
        let (Some(mesh), Some(drawn)) = (table.mesh(model), table.drawn(model)) else {
            return;
        };
        let displacement = &drawn.displacement[..];
        if displacement.len() != 2 * mesh.nodes.len() {
            return;
        }
        if !position.outline_only {
            position
                .painter
                .add(Shape::Mesh(self.surface(position, model, mesh, &drawn)));
        }
        let ink = match table.scene().look.layout {
            Layout::Over => model_colour(model),
            Layout::Beside => position.ui.visuals().text_color(),
        };
        let lines = Lines {
            position,
            mesh,
            displacement,
        };
        lines.outline(Stroke::new(1.5, ink));
        if table.scene().look.cells && !position.outline_only {
            lines.cells();
        }
        if model == Model::Springs && table.scene().look.multipliers && table.played().is_none() {
            lines.multipliers();
        }
    }

    fn surface(
        &mut self,
        position: &Place,
        model: Model,
        mesh: &Mesh,
        now: &Drawn,
    ) -> Arc<Triangles> {
        let Place {
            table, view, range, ..
        } = *position;
        let slot = &mut self.drawn[model as usize];
        let known = slot.as_ref().filter(|drawn| {
            (drawn.revision, drawn.view, drawn.range) == (table.revision(), view, range)
        });
        if let Some(drawn) = known {
            return Arc::clone(&drawn.surface);
        }
        let corners = &mut self.triangles[model as usize];
        if corners
            .as_ref()
            .is_none_or(|(sheet, _)| *sheet != table.sheet_number())
        {
            *corners = Some((table.sheet_number(), triangles(mesh)));
        }
        let (_, corners) = corners.as_ref().expect("triangles were made");
        let values = table.drawn_values(model);
        let value = |node: usize| values.as_ref().map_or(f64::NAN, |values| values[node]);
        let surface = draw(mesh, corners, &now.displacement, view, |node| {
            colour(value(node), range)
        });
        let surface = Arc::new(surface);
        *slot = Some(Painted {
            revision: table.revision(),
            view,
            range,
            surface: Arc::clone(&surface),
        });
        surface
    }
}

/// An area in rows of the same height.
fn rows(area: Rect, count: usize) -> Vec<Rect> {
    let height = area.height() / count.max(1) as f32;
    let row = |number: usize| {
        let corner = area.min + vec2(0.0, number as f32 * height);
        Rect::from_min_size(corner, vec2(area.width(), height))
    };
    (0..count).map(row).collect()
}

/// The stretch and the motion across that a scene needs room for, in lengths and in mm.
fn room(scene: &Scene) -> [f64; 2] {
    let Scene { size, grip, .. } = scene;
    let stretch = scene.stretch().max(0.3) + 0.1;
    let turned = 0.5 * size[1] * grip.angle.sin().abs() / size[0];
    let across = grip.displacement[1].abs();
    [stretch + turned, across]
}

/// The colour of a model's lines, in charts and where models lie over each other.
pub fn model_colour(model: Model) -> Color32 {
    let [r, g, b] = model.colour();
    Color32::from_rgb(r, g, b)
}

fn label(position: &Place, model: Model, at: Pos2) {
    let Place { table, ui, .. } = position;
    let fault = match table.moving() {
        Some(moving) => moving.fault(model),
        None => table.fault(model),
    };
    let follows = match table.drawn(model) {
        Some(drawn) if drawn.follows => "",
        _ if fault.is_some() => " – no solution here, see the message",
        _ => " – follow …",
    };
    let ink = match table.scene().look.layout {
        Layout::Over => model_colour(model),
        Layout::Beside => ui.visuals().strong_text_color(),
    };
    let text = format!("{}{follows}", model.name());
    let font = FontId::proportional(13.0);
    position.painter.text(at, Align2::LEFT_TOP, text, font, ink);
}

/// Says beside the grip what to do first.
fn invite(ui: &Ui, grip: Pos2) {
    let font = FontId::proportional(15.0);
    let ink = ui.visuals().hyperlink_color;
    let position = grip + vec2(16.0, 0.0);
    ui.painter()
        .text(position, Align2::LEFT_CENTER, "pull me", font, ink);
}

/// What the command would warn of, in a row that is there without warnings too, so that they move nothing; in full below the sheets
/// and under the pointer.
fn warnings(ui: &mut Ui, table: &Table, row: Rect) {
    let warnings = table.warnings();
    if warnings.is_empty() {
        return;
    }
    let headlines: Vec<String> = warnings.iter().map(headline).collect();
    let sentences: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    let ink = ui.visuals().warn_fg_color;
    let words = RichText::new(format!("warning: {}", headlines.join(" · "))).color(ink);
    let mut row = ui.new_child(UiBuilder::new().max_rect(row.shrink2(vec2(6.0, 0.0))));
    let label = row.add(Label::new(words).truncate());
    label.on_hover_text(sentences.join("\n\n"));
}

/// The lines on a deformed mesh.
struct Lines<'a> {
    position: &'a Place<'a>,
    mesh: &'a Mesh,
    displacement: &'a [f64],
}

impl Lines<'_> {
    /// Where a node is, in mm.
    fn moved(&self, node: usize) -> [f64; 2] {
        [0, 1].map(|axis| self.mesh.nodes[node][axis] + self.displacement[2 * node + axis])
    }

    fn at(&self, node: usize) -> Pos2 {
        self.position.view.at(self.moved(node))
    }

    fn outline(&self, stroke: Stroke) {
        for edge in self.mesh.boundary() {
            let nodes = [Some(&edge[0]), edge.get(2), Some(&edge[1])];
            let points = nodes.into_iter().flatten().map(|node| self.at(*node));
            self.position
                .painter
                .add(Shape::line(points.collect(), stroke));
        }
    }

    fn cells(&self) {
        let ink = self.position.ui.visuals().text_color().gamma_multiply(0.35);
        for cell in 0..self.mesh.cell_count() {
            let corners = self.mesh.corners(cell);
            let points = corners.iter().map(|node| self.at(*node)).collect();
            let line = Shape::closed_line(points, Stroke::new(0.5, ink));
            self.position.painter.add(line);
        }
    }

    /// Arrows of the multipliers at some of the nodes; the longest is a seventh of the width.
    fn multipliers(&self) {
        let Place {
            table,
            ui,
            painter,
            view,
            ..
        } = self.position;
        let corrected = table.shown(Model::Corrected);
        let computed = corrected.and_then(|shown| shown.solved.multipliers.as_ref());
        let Some(values) = computed.filter(|values| values.len() == self.displacement.len()) else {
            return;
        };
        let sizes = values.chunks_exact(2).map(|value| value[0].hypot(value[1]));
        let longest = sizes.fold(0.0, f64::max);
        if longest <= 0.0 {
            return;
        }
        let scale = 0.15 * table.scene().size[1] / longest;
        let every = self.mesh.nodes.len().div_ceil(ARROWS).max(1);
        let stroke = Stroke::new(1.3, ui.visuals().error_fg_color);
        for node in (0..self.mesh.nodes.len()).step_by(every) {
            let from = self.moved(node);
            let to = [0, 1].map(|axis| from[axis] + scale * values[2 * node + axis]);
            let arrow = view.at(to) - view.at(from);
            if arrow.length() > 1.5 {
                painter.arrow(view.at(from), arrow, stroke);
            }
        }
    }
}
