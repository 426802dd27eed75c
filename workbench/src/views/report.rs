//! A report on the screen: tables, charts, fields and meshes as the library describes them.

use std::sync::Arc;

use eframe::egui::{
    Align, Color32, Grid, Label, Mesh as Triangles, Rect, RichText, ScrollArea, Sense, Shape,
    Stroke, Ui, vec2,
};

use gelbench::results::{Block, Drawing};
use gelbench_report::results::{MeshFigure, PALETTE, Panel, Scale, Values};

use super::chart;
use super::colours::{Span, colour, colour_bar, range};
use super::surface::View;
use crate::logic::studies::Report;

/// Rows of a table that are shown.
const ROWS: usize = 200;

/// Shows a report with its contents, whose entries lead to its headings; `name` distinguishes its charts from those of other reports.
pub fn show(ui: &mut Ui, name: &str, report: &Report) {
    ui.heading(&report.title);
    let (verdict, ink) = if report.passed {
        ("passed", ui.visuals().strong_text_color())
    } else {
        ("not passed", ui.visuals().error_fg_color)
    };
    ui.colored_label(
        ink,
        format!("{verdict}, computed in {:.1} s", report.seconds),
    );
    let chosen = contents(ui, &report.blocks);
    for (number, block) in report.blocks.iter().enumerate() {
        if chosen == Some(number) {
            ui.scroll_to_cursor(Some(Align::TOP));
        }
        show_block(ui, &format!("{name} {number}"), block, &report.figures);
    }
}

/// The headings of a report; the number of the block that was chosen.
fn contents(ui: &mut Ui, blocks: &[Block]) -> Option<usize> {
    let headings = blocks
        .iter()
        .enumerate()
        .filter_map(|(number, block)| match block {
            Block::Heading(level, text) => Some((number, *level, text)),
            _ => None,
        });
    let mut chosen = None;
    for (number, level, text) in headings {
        ui.horizontal(|ui| {
            ui.add_space(12.0 * f32::from(level));
            if ui.link(text).clicked() {
                chosen = Some(number);
            }
        });
    }
    chosen
}

fn show_block(ui: &mut Ui, name: &str, block: &Block, figures: &[Drawing]) {
    match block {
        Block::Heading(1, text) => drop(ui.heading(text)),
        Block::Heading(_, text) => {
            ui.add_space(8.0);
            ui.label(RichText::new(text).strong().size(16.0));
        }
        Block::Paragraph(text) => drop(ui.label(text)),
        Block::Code(_, text) => drop(ui.monospace(text)),
        Block::Table(head, rows) => table(ui, name, head, rows),
        Block::Figure(index, caption) => {
            if let Some(drawing) = figures.get(*index) {
                picture(ui, name, drawing);
            }
            ui.label(RichText::new(caption).small().weak());
        }
    }
}

fn table(ui: &mut Ui, name: &str, head: &[String], rows: &[Vec<String>]) {
    let cells = Grid::new(name.to_owned())
        .striped(true)
        .num_columns(head.len());
    let room = ScrollArea::horizontal().id_salt((name, "room"));
    room.show(ui, |ui| {
        cells.show(ui, |ui| {
            for cell in head {
                ui.label(RichText::new(cell).small().strong());
            }
            ui.end_row();
            for row in rows.iter().take(ROWS) {
                for cell in row {
                    ui.add(Label::new(cell).extend());
                }
                ui.end_row();
            }
        });
    });
    if rows.len() > ROWS {
        ui.label(format!("… and {} more rows", rows.len() - ROWS));
    }
}

/// Draws a picture of the library's.
pub fn picture(ui: &mut Ui, name: &str, drawing: &Drawing) {
    match drawing {
        Drawing::Charts(charts) => {
            for (number, (chart, height)) in charts.iter().enumerate() {
                ui.label(RichText::new(&chart.title).small().strong());
                let height = (0.6 * *height as f32).clamp(120.0, 300.0);
                chart::show(ui, &format!("{name} {number}"), chart, height);
            }
        }
        Drawing::Field(figure) => {
            ui.label(RichText::new(&figure.title).small().strong());
            panels(ui, &figure.quantity, figure.scale, &figure.panels);
        }
        Drawing::Animation(moving) => {
            let Some(frame) = moving.frames.last() else {
                return;
            };
            ui.label(format!("{}, at {} s", moving.title, frame.time));
            panels(ui, &moving.quantity, Scale::Linear, &frame.panels);
        }
        Drawing::Mesh(figure) => {
            let room = room(ui, figure.cells.iter().flatten());
            mesh_in(ui, room, figure);
        }
    }
}

/// Fields one below the other on one colour scale.
pub fn panels(ui: &mut Ui, quantity: &str, scale: Scale, panels: &[Panel]) {
    let shown = chart::scaled(scale);
    let values = panels.iter().flat_map(Panel::corners).flatten().map(shown);
    let range = range(values).unwrap_or([0.0, 1.0]);
    for panel in panels {
        ui.label(&panel.label);
        let lines = panel.surface.outline.iter().chain(&panel.surface.rest);
        let (view, area) = room(ui, lines.flatten().chain(&panel.surface.points));
        let painter = ui.painter().with_clip_rect(area);
        painter.add(Shape::Mesh(Arc::new(surface(panel, view, |value| {
            colour(shown(value), range)
        }))));
        let ink = ui.visuals().text_color();
        for line in &panel.surface.outline {
            let positions = line.iter().map(|position| view.at(*position)).collect();
            painter.add(Shape::line(positions, Stroke::new(1.0, ink)));
        }
    }
    let (bar, _) =
        ui.allocate_exact_size(vec2(ui.available_width().min(600.0), 34.0), Sense::hover());
    let span = Span {
        range,
        exceeded: [false; 2],
    };
    colour_bar(ui, &chart::labelled(quantity, scale), span, bar);
}

fn surface(panel: &Panel, view: View, ink: impl Fn(f64) -> Color32) -> Triangles {
    let mut drawn = Triangles::default();
    let points = &panel.surface.points;
    match &panel.values {
        Values::AtPoints(values) => {
            for (position, value) in points.iter().zip(values) {
                drawn.colored_vertex(view.at(*position), ink(*value));
            }
            drawn.indices = panel.surface.triangles.iter().flatten().copied().collect();
        }
        Values::InCells(values) => {
            for (triangle, cell) in panel.surface.triangles.iter().zip(&panel.surface.cells) {
                let first = drawn.vertices.len() as u32;
                for point in triangle {
                    drawn.colored_vertex(
                        view.at(points[*point as usize]),
                        ink(values[*cell as usize]),
                    );
                }
                drawn.add_triangle(first, first + 1, first + 2);
            }
        }
    }
    drawn
}

/// Room for places in true proportions, as wide as there is and at most half as high.
pub fn room<'a>(
    ui: &mut Ui,
    positions: impl Iterator<Item = &'a [f64; 2]> + Clone,
) -> (View, Rect) {
    let along =
        |axis: usize| range(positions.clone().map(|position| position[axis])).unwrap_or([0.0, 1.0]);
    let ([left, right], [bottom, top]) = (along(0), along(1));
    let width = ui.available_width().min(760.0);
    let height = width * ((top - bottom) / (right - left).max(1e-9)) as f32 + 12.0;
    let (area, _) = ui.allocate_exact_size(vec2(width, height.clamp(40.0, 420.0)), Sense::hover());
    (
        View::fit([[left, bottom], [right, top]], area.shrink(6.0)),
        area,
    )
}

/// The colour of an edge: those of a mesh differ, whatever their order.
pub fn edge_colour(figure: &MeshFigure, name: &str) -> Color32 {
    let groups = figure.groups.iter();
    let position = groups.filter(|group| *group.name < *name).count();
    let [r, g, b] = PALETTE[position % PALETTE.len()];
    Color32::from_rgb(r, g, b)
}

/// Draws a mesh and its edges, each in a colour, in a room that has been allocated for them.
pub fn mesh_in(ui: &Ui, (view, area): (View, Rect), figure: &MeshFigure) {
    let painter = ui.painter().with_clip_rect(area.expand(8.0));
    let faint = Stroke::new(0.5, ui.visuals().text_color().gamma_multiply(0.4));
    let positions = |line: &[[f64; 2]]| line.iter().map(|position| view.at(*position)).collect();
    for cell in &figure.cells {
        painter.add(Shape::closed_line(positions(cell), faint));
    }
    for group in &figure.groups {
        let ink = edge_colour(figure, &group.name);
        for line in &group.lines {
            painter.add(Shape::line(positions(line), Stroke::new(3.0, ink)));
        }
    }
}
