//! The files of tracked images.
//!
//! ```text
//! markers.csv                       the points of all frames, as `gelbench correct` reads them
//! report.html, report.md, report.json
//! displacement_x.png …              pictures of the last frame
//! ```

use std::fmt::Write;

use serde_json::{Map, json};

use super::TrackedImages;
use crate::error::Diagnostic;
use crate::images::ImageFile;
use crate::markers::{Frame, Marker};
use crate::results::{
    Block, Content, FieldFigure, Figure, Finding, Outcome, Panel, Results, Step, Table, object,
};
use crate::studies::markers::finding::runs;
use crate::studies::markers::mistaken;
use crate::units::number;

/// The `kind` of these results.
const KIND: &str = "images";

/// The table with all markers.
pub const MARKERS: &str = "markers.csv";

/// The results of tracked images, after `seconds`.
pub fn results(tracked: &TrackedImages, name: String, seconds: f64) -> Results {
    let figures = tracked
        .series
        .frames
        .last()
        .map(|frame| figures(tracked, frame));
    let contradicted = tracked.contradiction(&tracked.series);
    let findings = findings(tracked, contradicted.as_ref());
    Results {
        name,
        title: "Tracked images".to_owned(),
        kind: KIND,
        read_warnings: tracked.warnings.iter().map(ToString::to_string).collect(),
        outcome: Outcome {
            problem: problem(tracked),
            along: "frame",
            steps: tracked
                .series
                .frames
                .iter()
                .map(|frame| step(tracked, frame))
                .collect(),
            headline: [frames(tracked).block(), Block::Paragraph(words(tracked))]
                .into_iter()
                .chain(contradicted.as_ref().map(mistaken))
                .collect(),
            figures: figures.unwrap_or_default(),
            files: vec![(MARKERS.to_owned(), Content::Text(table(tracked)))],
            findings,
            summary: format!(
                "markers of all frames: {MARKERS}, as `gelbench correct` reads them\n"
            ),
            ..Outcome::default()
        },
        seconds,
        ..Results::default()
    }
}

/// The markers of all frames, with seven decimals, or more where these would be coarser than a ten-thousandth of a pixel.
fn table(tracked: &TrackedImages) -> String {
    let decimals = (4.0 - tracked.pixel.log10().floor()).clamp(7.0, 20.0) as usize;
    let mut text = String::from("frame,id,x [mm],y [mm],ux [mm],uy [mm],standard_deviation [mm]\n");
    for frame in &tracked.series.frames {
        for Marker {
            number,
            position,
            displacement,
            standard_deviation,
        } in &frame.markers
        {
            let lengths: Vec<String> = position
                .iter()
                .chain(displacement)
                .chain(standard_deviation)
                .map(|value| format!("{value:.decimals$}"))
                .collect();
            let _ = writeln!(text, "{},{number},{}", frame.number, lengths.join(","));
        }
    }
    text
}

/// Root mean square of the standard deviations of a frame in pixels.
fn deviation(tracked: &TrackedImages, frame: &Frame) -> f64 {
    let deviations = frame
        .markers
        .iter()
        .filter_map(|marker| marker.standard_deviation);
    let sum: f64 = deviations.map(|deviation| deviation.powi(2)).sum();
    (sum / frame.markers.len().max(1) as f64).sqrt() / tracked.pixel
}

/// Mean stretches along x and y.
fn stretches(frame: &Frame) -> [f64; 2] {
    frame.mean_gradient().map_or([f64::NAN; 2], |gradient| {
        [0, 1].map(|axis| {
            let mut column = gradient.column(axis).into_owned();
            column[axis] += 1.0;
            column.norm()
        })
    })
}

fn frames(tracked: &TrackedImages) -> Table<&Frame> {
    Table::of(&tracked.series.frames)
        .column("frame", |frame| frame.number.to_string())
        .column("image", |frame| {
            let file = tracked.file(frame.number);
            file.map_or_else(String::new, ImageFile::name)
        })
        .column("points", |frame| frame.markers.len().to_string())
        .column("largest displacement [mm]", |frame| {
            number(frame.largest_displacement())
        })
        .column("mean stretch along x", |frame| {
            format!("{:.4}", stretches(frame)[0])
        })
        .column("mean stretch along y", |frame| {
            format!("{:.4}", stretches(frame)[1])
        })
        .column("standard deviation [pixels]", |frame| {
            number(deviation(tracked, frame))
        })
}

fn words(tracked: &TrackedImages) -> String {
    let noise = tracked.tracker.noise();
    let white = tracked.tracker.white();
    let [dark, light] = [0.0, f64::from(white)].map(|value| number(noise.variance(value).sqrt()));
    let subset = tracked.tracker.subset();
    format!(
        "{} points {} pixels apart, subsets of {subset} × {subset} pixels, pixels of {} mm. Noise of the pixels: {dark} grey values where it is dark, \
         {light} where it is white ({white}); the standard deviations of displacements follow from it. x points to the right, y up, from the centre of \
         the lower left pixel. Neighbouring subsets overlap where they are wider than the spacing: their errors are then correlated.",
        tracked.points(),
        tracked.settings.spacing,
        number(tracked.pixel),
    )
}

fn problem(tracked: &TrackedImages) -> Map<String, serde_json::Value> {
    let noise = tracked.tracker.noise();
    object(json!({
        "pixel_mm": tracked.pixel,
        "spacing_pixels": tracked.settings.spacing,
        "subset_pixels": tracked.tracker.subset(),
        "points": tracked.points(),
        "noise_variance_dark": noise.variance(0.0),
        "noise_variance_growth": noise.growth,
    }))
}

fn step(tracked: &TrackedImages, frame: &Frame) -> Step {
    let [x, y] = stretches(frame);
    let quantities = json!({
        "points": frame.markers.len(),
        "largest_displacement_mm": frame.largest_displacement(),
        "mean_stretch_x": x,
        "mean_stretch_y": y,
        "standard_deviation_pixels": deviation(tracked, frame),
    });
    Step {
        at: frame.number as f64,
        models: Map::from_iter([("tracked".to_owned(), quantities)]),
    }
}

/// Frames in which many points are lost, and a pattern that contradicts their displacements.
fn findings(tracked: &TrackedImages, contradicted: Option<&Diagnostic>) -> Vec<Finding> {
    const MANY: f64 = 0.1;
    // Where neither outline nor mask is given, the specimen seldom covers less than one in so many of the image's points.
    const LEAST: usize = 4;
    let frames = &tracked.series.frames;
    let tracked_points = frames.iter().map(|frame| frame.markers.len()).max();
    let most = tracked_points.unwrap_or(0).max(tracked.points() / LEAST);
    let has_few = |frame: &&Frame| ((most - frame.markers.len()) as f64) > MANY * most as f64;
    let all: Vec<usize> = frames.iter().map(|frame| frame.number).collect();
    let few: Vec<usize> = frames
        .iter()
        .filter(has_few)
        .map(|frame| frame.number)
        .collect();
    let message = || format!("many of the points are lost in frame {}", runs(&all, &few));
    let remedy = "look at these images: the pattern leaves them, is covered, or changes";
    let finding =
        (!few.is_empty()).then(|| Finding::warning("lost-points", (message(), remedy.to_owned())));
    let doubt = contradicted.map(|doubt| Finding::doubt_of("repeated-pattern", doubt.clone()));
    finding.into_iter().chain(doubt).collect()
}

fn figures(tracked: &TrackedImages, frame: &Frame) -> Vec<Figure> {
    let half = 0.5 * tracked.settings.spacing as f64 * tracked.pixel;
    let label = format!("frame {}, where the points are at rest", frame.number);
    let panel = |value: &dyn Fn(&Marker) -> f64| {
        let squares = frame.markers.iter().map(|marker| {
            let [x, y] = marker.position;
            let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
            (corners.map(|[dx, dy]| [x + dx, y + dy]), value(marker))
        });
        [Panel::quadrilaterals(&*label, &squares.collect::<Vec<_>>())]
    };
    let figure = |name: &str, caption: &str, quantity: &str, value: &dyn Fn(&Marker) -> f64| {
        Figure::new(
            format!("{name}.png"),
            caption,
            FieldFigure::new("Tracked points", quantity, panel(value)),
        )
    };
    vec![
        figure(
            "displacement_x",
            "The displacement along x of every point.",
            "ux [mm]",
            &|marker| marker.displacement[0],
        ),
        figure(
            "displacement_y",
            "The displacement along y of every point.",
            "uy [mm]",
            &|marker| marker.displacement[1],
        ),
        figure(
            "displacement_error",
            "The standard deviation of the displacement of every point from the noise of the pixels.",
            "standard deviation [mm]",
            &|marker| marker.standard_deviation.unwrap_or(f64::NAN),
        ),
    ]
}
