//! A chart as the library describes it, which can be zoomed and read under the pointer.

use eframe::egui::{Color32, Ui};
use egui_plot::{Corner, FilledArea, Legend, Line, LineStyle, Plot, PlotPoints, Points, Polygon};

use gelbench_report::results::{LineChart, Scale, Stroke};

/// The height from which a chart has room for its legend.
const LEGEND: f32 = 140.0;

/// The sum of red, green and blue below which a line is not seen on a dark background.
const DARK: u16 = 200;

/// Draws a chart of some height; `name` distinguishes it from others.
pub fn show(ui: &mut Ui, name: &str, chart: &LineChart, height: f32) {
    let of_x = scaled(chart.x.scale);
    let of_y = scaled(chart.y.scale);
    let (dark, strong) = (ui.visuals().dark_mode, ui.visuals().strong_text_color());
    let ink = |[r, g, b]: [u8; 3]| {
        if dark && u16::from(r) + u16::from(g) + u16::from(b) < DARK {
            strong
        } else {
            Color32::from_rgb(r, g, b)
        }
    };
    let mut plot = Plot::new(name.to_owned());
    if height > LEGEND {
        plot = plot.legend(Legend::default().position(Corner::LeftTop));
    }
    let plot = plot
        .height(height)
        .x_axis_label(labelled(&chart.x.label, chart.x.scale))
        .y_axis_label(labelled(&chart.y.label, chart.y.scale))
        .allow_scroll(false);
    plot.show(ui, |plot| {
        if let Some(([low, high], name)) = &chart.band {
            let values = chart.lines.iter().flat_map(|line| &line.points);
            let heights = values.map(|point| of_y(point[1]));
            if let Some([least, most]) = super::colours::range(heights) {
                let corners = [[*low, least], [*high, least], [*high, most], [*low, most]];
                let area: PlotPoints = corners.iter().map(|[x, y]| [of_x(*x), *y]).collect();
                let shade = Color32::from_rgba_unmultiplied(128, 128, 128, 30);
                plot.polygon(
                    Polygon::new(name.clone(), area)
                        .fill_color(shade)
                        .stroke((0.0, shade)),
                );
            }
        }
        for line in &chart.lines {
            let ink = ink(line.colour);
            let positions = || -> PlotPoints<'_> {
                let positions = line.points.iter().map(|[x, y]| [of_x(*x), of_y(*y)]);
                positions
                    .filter(|position| position.iter().all(|part| part.is_finite()))
                    .collect()
            };
            let through = |width: f32| {
                Line::new(line.label.clone(), positions())
                    .color(ink)
                    .width(width)
            };
            match line.stroke {
                Stroke::Points => plot.points(
                    Points::new(line.label.clone(), positions())
                        .color(ink)
                        .radius(2.5),
                ),
                Stroke::Filled => plot.add(between(line, of_x, of_y)),
                Stroke::Dashed => plot.line(through(1.5).style(LineStyle::dashed_dense())),
                Stroke::Thin => plot.line(through(0.8)),
                Stroke::Solid => plot.line(through(2.0)),
                Stroke::Marked | Stroke::Ringed => {
                    plot.line(through(0.8).style(LineStyle::dashed_loose()));
                    plot.points(
                        Points::new(line.label.clone(), positions())
                            .color(ink)
                            .filled(line.stroke == Stroke::Marked)
                            .radius(3.0),
                    );
                }
            }
        }
        if let Some(words) = chart.dashes() {
            let none = PlotPoints::from(Vec::<[f64; 2]>::new());
            plot.line(Line::new(words, none).style(LineStyle::dashed_loose()));
        }
    });
}

/// The area between the first half of a line and the second, which runs back over the same abscissas.
fn between(
    line: &gelbench_report::results::Line,
    of_x: fn(f64) -> f64,
    of_y: fn(f64) -> f64,
) -> FilledArea {
    let (there, back) = line.points.split_at(line.points.len() / 2);
    let pairs = there.iter().zip(back.iter().rev());
    let positions = pairs.map(|([x, one], [_, other])| [of_x(*x), of_y(*one), of_y(*other)]);
    let positions: Vec<[f64; 3]> = positions
        .filter(|position| position.iter().all(|part| part.is_finite()))
        .collect();
    let along = |axis: usize| {
        positions
            .iter()
            .map(|position| position[axis])
            .collect::<Vec<_>>()
    };
    let [r, g, b] = line.colour;
    let pale = Color32::from_rgba_unmultiplied(r, g, b, 50);
    FilledArea::new(line.label.clone(), &along(0), &along(1), &along(2)).fill_color(pale)
}

/// The name of a quantity as a scale shows it.
pub fn labelled(quantity: &str, scale: Scale) -> String {
    match scale {
        Scale::Logarithmic => format!("log₁₀ {quantity}"),
        Scale::Linear | Scale::Interval => quantity.to_owned(),
    }
}

/// From a value to its position on a scale.
pub fn scaled(scale: Scale) -> fn(f64) -> f64 {
    match scale {
        Scale::Logarithmic => f64::log10,
        Scale::Linear | Scale::Interval => |value| value,
    }
}
