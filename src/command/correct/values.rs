//! How the values of the options of `gelbench correct` are parsed.

use std::path::Path;

use crate::command::arguments;
use gelbench_base::document::TextEncoding;
use gelbench_base::error::{Diagnostic, Error};
use gelbench_base::units::{self, Dimension};
use gelbench_estimation::estimation::MeasuredForce;
use gelbench_mechanics::material::Card;
use gelbench_mechanics::mesh::CellShape;
use gelbench_studies::studies::markers::{ForceColumn, measured_force};

/// Kinds of cells.
pub const CELLS: [(&str, CellShape); 4] = [
    ("triangle3", CellShape::Triangle3),
    ("triangle6", CellShape::Triangle6),
    ("quadrilateral4", CellShape::Quad4),
    ("quadrilateral9", CellShape::Quad9),
];
/// Whether the y axis points down.
pub const Y_AXIS: [(&str, bool); 2] = [("up", false), ("down", true)];
/// Whether the positions of markers are those in the frame.
pub const PLACES: [(&str, bool); 2] = [("rest", false), ("frame", true)];
/// Whether gaps among markers are holes.
pub const HOLES: [(&str, bool); 2] = [("found", true), ("closed", false)];

/// An edge, an axis, a force and its standard deviation.
pub fn force(text: &str) -> Result<MeasuredForce, Diagnostic> {
    let (edge, axis, value, deviation) = on_an_edge(text, "right x 1.2 N ± 0.02 N")?;
    Ok(measured_force(edge, axis, newtons(&value)?, deviation))
}

/// A region, and its card.
pub fn region(text: &str) -> Result<(String, Card), Diagnostic> {
    let (name, card) = text.split_once('=').ok_or_else(|| {
        let hint = "write the region and its card, as in \"inclusion=pva-10\"";
        Diagnostic::error("", "it is not a card for a region").hint(hint)
    })?;
    let card = Card::load(card.trim(), Path::new(".")).map_err(|fault| match fault {
        Error::Input(mut faults) if !faults.is_empty() => faults.swap_remove(0),
        other => Diagnostic::error("", other.to_string()),
    })?;
    Ok((name.trim().to_owned(), card))
}

/// An edge, an axis, a column of forces and its standard deviation.
pub fn force_column(text: &str) -> Result<ForceColumn, Diagnostic> {
    let (edge, axis, column, standard_deviation) = on_an_edge(text, "right x Load ± 0.02 N")?;
    Ok(ForceColumn {
        edge: edge.to_owned(),
        axis,
        column,
        standard_deviation,
    })
}

/// An edge, an axis, what acts there, and the standard deviation behind ±.
fn on_an_edge<'a>(
    text: &'a str,
    example: &str,
) -> Result<(&'a str, usize, String, Option<f64>), Diagnostic> {
    // Names of edges may have blanks, and so may what acts there.
    let axis = |axis: &str| text.find(axis).map(|at| (at, at + axis.len()));
    let positions = [axis(" x "), axis(" y ")].into_iter().enumerate();
    let axes = positions.filter_map(|(axis, place)| Some((place?, axis)));
    let Some(((end, begin), axis)) = axes.min().filter(|((end, _), _)| *end > 0) else {
        let hint = format!("write edge, axis and force, as in \"{example}\"");
        return Err(Diagnostic::error("", "it is not a force on an edge").hint(hint));
    };
    let (edge, what) = (&text[..end], &text[begin..]);
    let what = what.replace("+-", "±");
    let (what, deviation) = match what.split_once('±') {
        None => (&*what, None),
        Some((what, deviation)) => (what, Some(newtons(deviation)?)),
    };
    Ok((edge, axis, what.trim().to_owned(), deviation))
}

fn newtons(text: &str) -> Result<f64, Diagnostic> {
    arguments::quantity(text, Dimension::Force)
}

/// A time in s.
pub fn time(text: &str) -> Result<f64, Diagnostic> {
    quantity(text, Dimension::Time, f64::is_finite, "", "1.2 s")
}

/// A time greater than zero in s.
pub fn interval(text: &str) -> Result<f64, Diagnostic> {
    let wanted = "it must be greater than zero";
    quantity(text, Dimension::Time, |time| time > 0.0, wanted, "0.5 s")
}

/// A length of zero or more in mm.
pub fn gap(text: &str) -> Result<f64, Diagnostic> {
    within(text, |length| length >= 0.0, "it must not be negative")
}

/// A relative error of a scale.
pub fn scale_error(text: &str) -> Result<f64, Diagnostic> {
    let holds = |ratio: f64| (0.0..=0.5).contains(&ratio);
    let wanted = "it must be from 0 to 50 %";
    quantity(text, Dimension::Ratio, holds, wanted, "0.1 %")
}

/// The size of a thing in mm.
pub fn size(text: &str) -> Result<f64, Diagnostic> {
    let [least, most] = units::SIZES;
    let wanted = "it must be greater than zero, from 1 nm to 1 km";
    within(text, |size| (least..=most).contains(&size), wanted)
}

/// A length greater than zero in mm.
pub fn length(text: &str) -> Result<f64, Diagnostic> {
    within(text, |length| length > 0.0, "it must be greater than zero")
}

fn within(text: &str, holds: impl Fn(f64) -> bool, wanted: &str) -> Result<f64, Diagnostic> {
    quantity(text, Dimension::Length, holds, wanted, "1.5 mm")
}

fn quantity(
    text: &str,
    dimension: Dimension,
    holds: impl Fn(f64) -> bool,
    wanted: &str,
    example: &str,
) -> Result<f64, Diagnostic> {
    let value = arguments::quantity(text, dimension)?;
    if holds(value) {
        Ok(value)
    } else {
        Err(Diagnostic::error("", wanted).hint(format!("write it as in \"{example}\"")))
    }
}

/// An encoding by its name.
pub fn encoding(text: &str) -> Result<TextEncoding, Diagnostic> {
    TextEncoding::of_name(text).ok_or_else(|| {
        Diagnostic::error("", "it is not a known encoding").hint(
            "choose one such as utf-8, utf-16le, utf-16be, latin1, windows-1252, gb18030, big5, shift_jis or euc-kr",
        )
    })
}

/// The length in mm of a unit, or a length.
pub fn unit(text: &str) -> Result<f64, Diagnostic> {
    units::factor(text, Dimension::Length).or_else(|fault| {
        let number =
            text.starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first));
        let hint = fault.remedy(text, Dimension::Length);
        if number {
            length(text)
        } else {
            Err(Diagnostic::error("", format!("it {fault}")).hint(hint))
        }
    })
}
