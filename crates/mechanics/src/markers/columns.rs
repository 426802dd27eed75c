//! The columns of a table of displacements: found by name, lengths with their units, and none of them overlooked.
//!
//! A reader names the columns that it takes. Columns that other programs write and that contain nothing about the
//! displacement ([`is_harmless`]) are ignored, and so are those that the user names; any other one is refused,
//! because a column that is silently ignored may contain what the user relies on.

use crate::document::{Column, Table, is_pixel, plain_name};
use crate::error::{Diagnostic, Error, nearest, suggestion};
use crate::statistics::extremes;
use crate::units::{self, Dimension};

/// Names that a column may have; one that begins with `=` is the exact name, with its capitals.
pub type Names = &'static [&'static str];

/// A column of lengths and its unit in mm.
pub type Length = (usize, f64);

/// Statements on units besides the heads of columns.
#[derive(Clone, Copy, Debug, Default)]
pub struct Units<'a> {
    /// The length of the unit in mm, or of a pixel.
    pub given: Option<f64>,
    /// A unit of heads that the given one corrects.
    pub corrected: Option<&'a str>,
    /// Whether lengths are in pixels where the head states no unit.
    pub pixels: bool,
}

/// The first column that has exactly one of the names.
pub fn plain(table: &Table, names: Names) -> Option<usize> {
    names.iter().find_map(|name| table.column(name))
}

/// A warning where the heads of x and y, or of ux and uy, name two units.
pub fn mixed_units<'a>(heads: impl Iterator<Item = Option<&'a str>>) -> Option<Diagnostic> {
    let heads: Vec<Option<&str>> = heads.collect();
    let mixed = heads.chunks_exact(2).find_map(|pair| match *pair {
        [Some(along), Some(across)] if along != across => Some([along, across]),
        _ => None,
    });
    mixed.map(|[along, across]| {
        let message = format!("the two columns of one vector are in different units, {along} and {across}: each is read in its own unit");
        Diagnostic::warning("", message).hint("check the header of the table")
    })
}

/// The first column with one of the names, and its unit: in brackets, or at the end of the name as in `ux_mm`.
pub fn find(table: &Table, names: Names) -> Option<(usize, Option<String>)> {
    names.iter().find_map(|name| {
        let mut columns = table.columns.iter().enumerate();
        columns.find_map(|(index, column)| match after(column, name)? {
            "" => Some((index, column.unit.clone())),
            rest => {
                let unit = rest.strip_prefix('_')?;
                (column.unit.is_none() && is_length(unit)).then(|| (index, Some(unit.to_owned())))
            }
        })
    })
}

/// The part of a column's name after one of [`Names`].
fn after<'a>(column: &'a Column, name: &str) -> Option<&'a str> {
    match name.strip_prefix('=') {
        Some(written) => column.written.strip_prefix(written),
        None => column.name.strip_prefix(name),
    }
}

/// The unit of a column: in brackets, or at the end of its name.
pub fn unit_of(table: &Table, index: usize) -> Option<String> {
    let Column { name, unit, .. } = &table.columns[index];
    let at_end = || {
        let (_, end) = name.rsplit_once('_')?;
        is_length(end).then(|| end.to_owned())
    };
    unit.clone().or_else(at_end)
}

fn is_length(unit: &str) -> bool {
    millimetres(unit).is_some() || is_pixel(unit)
}

/// The length of a unit in mm.
fn millimetres(unit: &str) -> Option<f64> {
    units::factor(unit, Dimension::Length).ok()
}

/// The unit that all these heads name, if it is the same.
pub fn common_unit<'a>(heads: impl IntoIterator<Item = Option<&'a str>>) -> Option<String> {
    let mut heads = heads.into_iter();
    let first = heads.next()??;
    heads
        .all(|head| head == Some(first))
        .then(|| first.to_owned())
        .filter(|unit| !is_pixel(unit))
}

/// The names of the columns of positions in a table without a known layout.
pub const POSITIONS: [Names; 2] = [&["x"], &["y"]];

/// The names of its columns of displacements.
pub const DISPLACEMENTS: [Names; 2] = [&["ux", "u", "u_x"], &["uy", "v", "u_y"]];

/// What to do where a column is not found, and may be assigned.
pub const ASSIGN: &str = "name the columns x [mm], y [mm], ux [mm] and uy [mm], with your own unit, or assign them: \
                          --columns x=NAME,y=NAME,ux=NAME,uy=NAME";

/// The first column with one of the names, and its unit.
///
/// # Errors
/// [`Error::Input`] with the existing columns where there is none, and what to do.
pub fn required(table: &Table, names: Names, hint: &str) -> Result<(usize, Option<String>), Error> {
    find(table, names).ok_or_else(|| {
        let headings: Vec<&str> = table.columns.iter().map(|column| &*column.name).collect();
        let headings = if headings.iter().all(|name| name.is_empty()) {
            "the columns have no names".to_owned()
        } else {
            format!("the file has {}", headings.join(", "))
        };
        let message = format!("there is no column `{}`: {headings}", first_name(names));
        table.refuse_columns(message, hint)
    })
}

/// The first of some names, for messages.
pub fn first_name(names: Names) -> &'static str {
    names
        .first()
        .map_or("", |name| name.trim_start_matches('='))
}

/// A column of lengths and its unit: that of its head, otherwise the given one.
///
/// # Errors
/// [`Error::Input`] where its unit is unknown.
pub fn length(
    table: &Table,
    (index, unit): (usize, Option<String>),
    units: Units,
) -> Result<Length, Error> {
    let name = &table.columns[index].written;
    let pixels = unit.as_deref().map_or(units.pixels, is_pixel);
    let known = unit.as_deref().filter(|_| !pixels);
    match (known, units.given) {
        (Some(unit), Some(given)) if units.corrected == Some(unit) => Ok((index, given)),
        (Some(unit), Some(given)) if !units::is_known(unit) => Ok((index, given)),
        (Some(unit), _) => millimetres(unit).map(|unit| (index, unit)).ok_or_else(|| {
            let message = format!("`{unit}` is not a unit of length");
            unknown_unit(table, unit, Dimension::Length, message)
        }),
        (None, Some(unit)) => Ok((index, unit)),
        (None, None) if pixels => Err(table.refuse_columns(
            format!("the column `{name}` is in pixels"),
            "give the length of a pixel, such as --unit \"0.05 mm\"",
        )),
        (None, None) => Err(table.refuse_columns(
            format!("the column `{name}` has no unit"),
            "write it in brackets, as in x [mm], or give --unit mm",
        )),
    }
}

/// The columns `x` and `y` of a table of positions, and the one of numbers that it may have; any other column is refused.
pub(super) fn of_positions(
    table: &Table,
    unit: Option<f64>,
    numbers: Names,
    ignored: &[String],
) -> Result<([Length; 2], Option<usize>), Error> {
    let units = Units {
        given: unit,
        ..Units::default()
    };
    let coordinate = |names: Names| length(table, required(table, names, ASSIGN)?, units);
    let [x, y] = [coordinate(&["x"])?, coordinate(&["y"])?];
    let number = plain(table, numbers);
    let used: Vec<usize> = [x.0, y.0].into_iter().chain(number).collect();
    check_all(table, &used, &["x", "y", first_name(numbers)], ignored)?;
    Ok(([x, y], number))
}

/// A remark where a given unit corrects the head of a file.
pub fn correction(table: &Table, head: Option<&str>, given: Option<f64>) -> Option<Diagnostic> {
    let (head, given) = (head?, given?);
    let stated = millimetres(head)?;
    ((given / stated - 1.0).abs() > 1e-12).then(|| {
        let message = format!(
            "{} states {head}, --unit states {given} mm: the latter is used",
            table.source.name
        );
        Diagnostic::warning("", message).hint("correct the header of the file")
    })
}

/// Results of other programs, and of this one, that contain nothing about the displacement: strains (`exx`, `e1`, all
/// names with `strain`), DICe's figures of its correlation, stretches, rotations and coordinates of other systems,
/// and what a correction writes in its tables of markers and nodes.
pub fn is_harmless(name: &str) -> bool {
    const NAMES: &str = "exx eyy exy e_xx e_yy e_xy e1 e2 gamma beta sigma contrast match noise_level active_pixels \
        iterations status_flag neighbor_id condition_number uncertainty uncertainty_angle corr correlation zncc \
        standardised_residual trust outlier residual_x_mm residual_y_mm ux_standard_error_mm uy_standard_error_mm \
        reaction_x_n reaction_y_n multiplier_x_mm2_per_n multiplier_y_mm2_per_n neighbour_id rotation_z";
    const BEGINNINGS: &str =
        "normal_stretch_ shear_stretch_ cross_corr_ stereo_ model_ epi_ field_value_";
    let begins = |beginning: &str| name.starts_with(beginning);
    name.contains("strain")
        || NAMES.split_whitespace().any(|known| known == name)
        || BEGINNINGS.split_whitespace().any(begins)
}

/// Whether the user ignores a column, by its name with or without its unit.
fn is_ignored(column: &Column, ignored: &[String]) -> bool {
    let head = plain_name(&column.head());
    ignored.iter().any(|ignored| {
        let ignored = plain_name(ignored);
        if ignored == head {
            return true;
        }
        let rest = column.name.strip_prefix(&*ignored);
        let unit = rest.map(|rest| rest.strip_prefix('_').unwrap_or(rest));
        rest == Some("") || unit.is_some_and(|unit| is_pixel(unit) || millimetres(unit).is_some())
    })
}

/// The columns that are neither used, nor harmless, nor ignored by the user.
pub fn others<'a>(table: &'a Table, used: &[usize], ignored: &[String]) -> Vec<&'a Column> {
    let columns = table.columns.iter().enumerate();
    let other = columns.filter(|(index, column)| {
        let passed = is_ignored(column, ignored) || is_harmless(&column.name);
        !used.contains(index) && !passed
    });
    other.map(|(_, column)| column).collect()
}

/// Checks that every column is used, harmless, or ignored by the user.
///
/// # Errors
/// [`Error::Input`] with every other column, and the `known` ones.
pub fn check_all(
    table: &Table,
    used: &[usize],
    known: &[&str],
    ignored: &[String],
) -> Result<(), Error> {
    let fault = |column: &Column| {
        let name = &column.name;
        let twice = known.contains(&&**name);
        let message = match (name.is_empty(), twice) {
            (true, _) => "a column has no name".to_owned(),
            (false, true) => format!("the column `{name}` repeats another column"),
            (false, false) => format!("the column `{name}` is not known here"),
        };
        let meant = nearest(name, known.iter().copied()).filter(|_| !twice);
        let meant = meant.map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let hint = format!(
            "{meant}known columns: {}; ignore it with --ignore-columns {name}",
            known.join(", ")
        );
        table.fault(table.columns_place.clone(), message, &hint)
    };
    let faults: Vec<Diagnostic> = others(table, used, ignored)
        .into_iter()
        .map(fault)
        .collect();
    Error::refuse(faults)
}

/// Numbers of frames.
pub const FRAME: Names = &["frame", "frame_number", "image"];
/// Times.
pub const TIME: Names = &["time", "t", "zeit"];

/// The unit of a column of times in s, which is 1 s where the head states none.
///
/// # Errors
/// [`Error::Input`] where it is not a unit of time.
pub fn seconds(table: &Table, column: usize) -> Result<f64, Error> {
    let Some(unit) = table.columns[column].unit.as_deref() else {
        return Ok(1.0);
    };
    units::factor(unit, Dimension::Time).map_err(|_| {
        let message = format!("`{unit}` is not a unit of time");
        unknown_unit(table, unit, Dimension::Time, message)
    })
}

/// The fault of a head whose unit is not one of a dimension, with the known ones.
pub fn unknown_unit(table: &Table, unit: &str, dimension: Dimension, message: String) -> Error {
    let known: Vec<_> = dimension.units().collect();
    let hint = suggestion(unit, &known, "known units:");
    table.refuse_columns(message, &hint)
}

/// Heights.
pub const HEIGHT: Names = &["z"];
/// Displacements out of the plane.
pub const LIFT: Names = &["uz", "w", "u_z"];

/// Heights and displacements out of the plane.
pub const OUT_OF_PLANE: [Names; 2] = [HEIGHT, LIFT];

/// The columns out of the plane that are present and not ignored.
pub fn out_of_plane(table: &Table, names: [Names; 2], ignored: &[String]) -> Vec<usize> {
    let indices = names.map(|names| find(table, names).map(|(index, _)| index));
    let wanted = |index: &usize| !is_ignored(&table.columns[*index], ignored);
    indices.into_iter().flatten().filter(wanted).collect()
}

/// Checks that the points of the rows that `is_found` chooses stay in a plane: heights differ by less than a hundredth of the field's
/// size, and no displacement out of the plane is more than a hundredth of the largest one. Both are compared in the unit of the columns
/// in the plane.
///
/// # Errors
/// [`Error::Input`] with how far they leave it.
pub fn check_flat(
    table: &Table,
    [positions, displacements]: [[Length; 2]; 2],
    names: [Names; 2],
    ignored: &[String],
    is_found: impl Fn(&[f64]) -> bool,
) -> Result<(), Error> {
    const FLAT: f64 = 0.01;
    let range = |column: usize| {
        let rows = table.rows.iter().filter(|(row, _)| is_found(row));
        let values = rows.map(|(row, _)| row[column]);
        extremes(values.filter(|value| value.is_finite()))
    };
    let span = |column: usize| range(column)[1] - range(column)[0];
    let largest = |column: usize| range(column)[1].max(-range(column)[0]);
    let size = positions.map(|(column, unit)| span(column) * unit / positions[0].1);
    let motion = displacements.map(|(column, unit)| largest(column) * unit / displacements[0].1);
    let [size, motion] = [size, motion].map(|both| both.into_iter().fold(0.0, f64::max));
    // The unit of a head over that of a column in the plane: 1 where it is the same, or not stated.
    let ratio = |column: usize, (plane, unit): Length| {
        let head =
            unit_of(table, column).filter(|head| unit_of(table, plane).as_ref() != Some(head));
        head.and_then(|head| millimetres(&head))
            .map_or(1.0, |own| own / unit)
    };
    for column in out_of_plane(table, names, ignored) {
        let name = &table.columns[column].name;
        let [most, what] = if find(table, names[1]).is_some_and(|(lift, _)| lift == column) {
            [largest(column) * ratio(column, displacements[0]), motion]
        } else {
            [span(column) * ratio(column, positions[0]), size]
        };
        if most / what > FLAT {
            let message = format!(
                "the points do not stay in a plane: `{name}` reaches {most:.4} compared with {what:.4} in the plane"
            );
            let hint = format!(
                "give a flat sheet in plane stress, or treat the field as flat with --ignore-columns {name}"
            );
            return Err(table.refuse_columns(message, &hint));
        }
    }
    Ok(())
}
