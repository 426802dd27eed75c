//! Fields as two tables of positions: those at rest, and those in a frame.
//!
//! Points are matched by their numbers (`id`, `marker`, `node`) where both tables have them, otherwise by their order.

use std::collections::HashMap;
use std::path::Path;

use super::columns;
use super::rows::{FileRows, ReadSettings, Row};
use super::table::NAME;
use super::understood::Understood;
use crate::document::Table;
use crate::error::Error;

/// A point's own number, where the table has one, and its position in mm; NaN where it was not found.
type Point = (Option<u64>, [f64; 2]);

/// Reads a frame's positions and subtracts those at rest.
///
/// # Errors
/// [`Error::Input`] with file, line and reason; where points of the frame are not those at rest.
pub(super) fn read(frame: &Path, settings: &ReadSettings) -> Result<FileRows, Error> {
    let rest_file = settings.rest.as_deref().unwrap_or(frame);
    let [(rest, _), (moved, table)] = [points(rest_file, settings)?, points(frame, settings)?];
    let numbered = |points: &[Point]| points.iter().all(|(number, _)| number.is_some());
    let moved = if numbered(&rest) && numbered(&moved) {
        by_number(&rest, &moved, &table)?
    } else if rest.len() == moved.len() {
        moved
    } else {
        let message = format!(
            "{} positions, but there are {} at rest in {}",
            moved.len(),
            rest.len(),
            rest_file.display()
        );
        let hint = "give the same points in the same order, or number them in a column `id`";
        return Err(table.refuse(0..0, message, hint));
    };
    let rows = rest
        .into_iter()
        .zip(moved)
        .map(|((name, position), (_, moved))| Row {
            name,
            position,
            displacement: [moved[0] - position[0], moved[1] - position[1]],
            ..Row::default()
        });
    Ok(FileRows {
        rows: rows.collect(),
        understood: Understood {
            encoding: table.encoding.map(|encoding| encoding.name()),
            turned_up: settings.downwards == Some(true),
            ..Understood::of("positions")
        },
        ..FileRows::default()
    })
}

/// The positions in the frame of the points at rest, in their order; NaN where the frame lacks a point.
fn by_number(rest: &[Point], moved: &[Point], table: &Table) -> Result<Vec<Point>, Error> {
    let positions: HashMap<Option<u64>, [f64; 2]> = moved.iter().copied().collect();
    let known: HashMap<Option<u64>, [f64; 2]> = rest.iter().copied().collect();
    let hint = "each point needs one number, the same in all files";
    if positions.len() < moved.len() || known.len() < rest.len() {
        return Err(table.refuse(0..0, "two points have the same number", hint));
    }
    if let Some((Some(number), _)) = moved.iter().find(|(number, _)| !known.contains_key(number)) {
        return Err(table.refuse(
            0..0,
            format!("the point {number} has no position at rest"),
            hint,
        ));
    }
    let in_frame = |(number, _): &Point| {
        (
            *number,
            positions.get(number).copied().unwrap_or([f64::NAN; 2]),
        )
    };
    Ok(rest.iter().map(in_frame).collect())
}

fn points(path: &Path, settings: &ReadSettings) -> Result<(Vec<Point>, Table), Error> {
    let mut table = Table::read_as(path, settings.encoding, Table::HINT)?;
    table.name_by_remark();
    let ignored = &settings.ignored_columns;
    let ([x, y], name) = columns::of_positions(&table, settings.unit, NAME, ignored)?;
    let read = [x.0, y.0].into_iter().chain(name);
    table.check_numbers_or_holes(
        read,
        "give positions as numbers x, y, and a number id where points have one",
    )?;
    let up = if settings.downwards == Some(true) {
        -1.0
    } else {
        1.0
    };
    let point = |(row, _): &(Vec<f64>, _)| {
        let number = name.map(|column| row[column]);
        let integer = number.filter(|number| *number >= 0.0 && number.fract() == 0.0);
        (
            integer.map(|number| number as u64),
            [row[x.0] * x.1, up * row[y.0] * y.1],
        )
    };
    let points = table.rows.iter().map(point).collect();
    Ok((points, table))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::markers::read as read_files;

    fn markers_of(rest: &str, frame: &str) -> Result<Vec<[f64; 4]>, Error> {
        let folder = tempfile::tempdir().unwrap();
        let [at_rest, moved] = ["rest.csv", "frame_1.csv"].map(|name| folder.path().join(name));
        std::fs::write(&at_rest, rest).unwrap();
        std::fs::write(&moved, frame).unwrap();
        let settings = ReadSettings {
            rest: Some(at_rest),
            ..ReadSettings::default()
        };
        let files: [PathBuf; 1] = [moved];
        let series = read_files(&files, &settings)?.series;
        let markers = series.frames[0].markers.iter();
        Ok(markers
            .map(|marker| {
                [marker.position, marker.displacement]
                    .concat()
                    .try_into()
                    .unwrap()
            })
            .collect())
    }

    #[test]
    fn positions_are_matched_by_number_else_by_order() {
        let expected = [[0.0, 0.0, 0.5, 0.25], [10.0, 0.0, 1.0, 0.0]];
        let by_order = markers_of(
            "x [mm],y [mm]\n0,0\n10,0\n",
            "x [mm],y [mm]\n0.5,0.25\n11,0\n",
        );
        assert_eq!(by_order.unwrap(), expected);
        let rest = "id,x [mm],y [mm]\n7,0,0\n8,10,0\n9,20,0\n";
        let by_number = markers_of(rest, "id,x [mm],y [mm]\n8,11,0\n7,0.5,0.25\n");
        assert_eq!(by_number.unwrap(), expected);
    }

    #[test]
    fn points_that_are_not_those_at_rest_are_refused() {
        let rest = "id,x [mm],y [mm]\n7,0,0\n8,10,0\n";
        for (frame, reason) in [
            (
                "id,x [mm],y [mm]\n9,0,0\n",
                "the point 9 has no position at rest",
            ),
            (
                "id,x [mm],y [mm]\n7,0,0\n7,0,1\n",
                "two points have the same number",
            ),
            (
                "x [mm],y [mm]\n0,0\n",
                "1 positions, but there are 2 at rest",
            ),
            (
                "x [mm],y [mm],z\n0,0,1\n",
                "the column `z` is not known here",
            ),
        ] {
            let error = markers_of(rest, frame).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
    }
}
