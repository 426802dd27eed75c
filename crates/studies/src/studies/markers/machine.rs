//! Forces of a testing machine's table beside the frames.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use crate::document::{Table, column_named};
use crate::error::{Diagnostic, Error};
use crate::estimation::{FORCE_CLASS, MeasuredForce};
use crate::markers::{Frame, MarkerSeries, columns};
use crate::solve::vector::largest;
use crate::units::{self, Dimension};

/// A column of a testing machine's table and the force that it holds.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceColumn {
    /// The group on which the grip acts.
    pub edge: String,
    /// 0 along x, 1 along y.
    pub axis: usize,
    /// Its name; one that begins with `-` stands for the negative force.
    pub column: String,
    /// In N; 1 % of the largest force of the column where it is not given.
    pub standard_deviation: Option<f64>,
}

/// The relation of the frames' times to those of the testing machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameClock {
    /// Time in s from one frame to the next where frames have no time: number n is taken at n times this.
    pub interval: Option<f64>,
    /// Time in s on the machine's clock when that of the frames is at zero.
    pub offset: f64,
}

impl FrameClock {
    /// When a frame was taken, on the machine's clock.
    fn time(&self, frame: &Frame) -> Option<f64> {
        let counted = self.interval.map(|interval| interval * frame.number as f64);
        Some(self.offset + frame.time.or(counted)?)
    }
}

/// Measured forces, each with its frame where that is stated.
pub type FrameForces = Vec<(Option<usize>, MeasuredForce)>;

/// What the rows of a table are matched to frames by, one value a row.
enum Match {
    /// The row of each frame.
    Frames(HashMap<u64, usize>),
    /// In s, ascending.
    Times(Vec<f64>),
}

/// The forces of all frames of a series, and a warning about frames without one.
///
/// # Errors
/// [`Error::Input`] with the line of the file and what to do, where columns are missing or rows cannot be matched.
pub fn forces(
    path: &Path,
    wanted: &[ForceColumn],
    series: &MarkerSeries,
    clock: FrameClock,
) -> Result<(FrameForces, Option<Diagnostic>), Error> {
    let table = Table::read(path, Table::HINT)?;
    if wanted.is_empty() {
        let heads: Vec<String> = table.columns.iter().map(|column| column.head()).collect();
        let hint = "name edge, axis and column, as in --force-column \"right x Load\", or `column` under [[force]] in the file of --study";
        let message = format!(
            "no column of this table is chosen as a force; it has {}",
            heads.join(", ")
        );
        return Err(table.refuse_columns(message, hint));
    }
    let rows = matching(&table)?;
    let mut measured = Vec::new();
    let mut without = BTreeSet::new();
    for one in wanted {
        let forces = newtons(&table, one)?;
        let stated = one.standard_deviation;
        for frame in &series.frames {
            let Some(force) = rows.at(&table, frame, clock.time(frame), &forces)? else {
                without.insert(frame.number);
                continue;
            };
            let force = MeasuredForce {
                edge: one.edge.clone(),
                axis: one.axis,
                force,
                standard_deviation: stated.unwrap_or_else(|| FORCE_CLASS * largest(&forces)),
                common_deviation: stated.map_or(FORCE_CLASS, |_| 0.0),
            };
            measured.push((Some(frame.number), force));
        }
    }
    if measured.is_empty() {
        let hint = "number the frames identically in both files, or give the time in both";
        return Err(table.refuse_columns("no row belongs to a frame of the field", hint));
    }
    let names: Vec<String> = without.iter().map(usize::to_string).collect();
    let warning = (!without.is_empty()).then(|| {
        let message = format!(
            "{} has no force for the frames {}",
            path.display(),
            names.join(", ")
        );
        Diagnostic::warning("", message).hint("they are corrected without one")
    });
    Ok((measured, warning))
}

/// The forces of a column in N.
fn newtons(table: &Table, wanted: &ForceColumn) -> Result<Vec<f64>, Error> {
    let name = wanted.column.trim_start_matches('-').trim();
    let column = column_named(table, name)?;
    table.check_numbers([column], "every row needs a force")?;
    let name = &table.columns[column].written;
    let Some(unit) = table.columns[column].unit.as_deref() else {
        let hint = format!("write it in brackets, as in {name} [N], or in a second line");
        return Err(table.refuse_columns(format!("the column `{name}` has no unit"), &hint));
    };
    let factor = units::factor(unit, Dimension::Force).map_err(|_| {
        let message = format!("`{unit}` of the column `{name}` is not a unit of force");
        columns::unknown_unit(table, unit, Dimension::Force, message)
    })?;
    let sign = if wanted.column.starts_with('-') {
        -1.0
    } else {
        1.0
    };
    let rows = table.rows.iter();
    Ok(rows.map(|(row, _)| factor * sign * row[column]).collect())
}

/// What the rows are matched by: a column `frame`, else a column `time`.
fn matching(table: &Table) -> Result<Match, Error> {
    let values = |column: usize| -> Result<Vec<f64>, Error> {
        table.check_numbers([column], "every row needs a frame or a time")?;
        Ok(table.rows.iter().map(|(row, _)| row[column]).collect())
    };
    if let Some(column) = columns::plain(table, columns::FRAME) {
        let mut rows = HashMap::new();
        for (row, number) in values(column)?.into_iter().enumerate() {
            if rows.insert(key(number), row).is_some() {
                let position = table.rows[row].1.clone();
                let message = format!("frame {number} occurs twice");
                return Err(table.refuse(position, message, "give each frame one row"));
            }
        }
        return Ok(Match::Frames(rows));
    }
    let Some(column) = columns::plain(table, columns::TIME) else {
        let hint = "name the column of frame numbers `frame`, or the column of times `time [s]`";
        return Err(table.refuse_columns("there is neither a column `frame` nor `time`", hint));
    };
    let second = columns::seconds(table, column)?;
    let mut times = values(column)?;
    times.iter_mut().for_each(|time| *time *= second);
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        None => Ok(Match::Times(times)),
        Some(row) => {
            let hint = "sort the rows by time, each time once";
            let position = table.rows[row + 1].1.clone();
            Err(table.refuse(position, "the time does not increase here", hint))
        }
    }
}

/// The bits of a number by which frames are found, the same for both zeros.
fn key(number: f64) -> u64 {
    (number + 0.0).to_bits()
}

impl Match {
    /// The force in a frame: that of its row, or between the rows before and after its time.
    fn at(
        &self,
        table: &Table,
        frame: &Frame,
        time: Option<f64>,
        forces: &[f64],
    ) -> Result<Option<f64>, Error> {
        let times = match self {
            Self::Frames(rows) => {
                let row = rows.get(&key(frame.number as f64));
                return Ok(row.map(|row| forces[*row]));
            }
            Self::Times(times) => times,
        };
        let Some(time) = time else {
            let message = format!(
                "rows are matched by time, but frame {} has none",
                frame.number
            );
            let hint = "state the time from frame to frame, such as --frame-interval \"0.5 s\" (frame_interval), or give the field a column `time [s]` or this table \
                        a column `frame`";
            return Err(table.refuse_columns(message, hint));
        };
        let after = times.partition_point(|known| *known < time);
        if times.get(after) == Some(&time) {
            return Ok(Some(forces[after]));
        }
        if after == 0 || after == times.len() {
            let row = after.min(times.len() - 1);
            let message = format!(
                "frame {} was taken at {} s, but the machine's times run from {} to {} s",
                frame.number,
                (1e6 * time).round() / 1e6,
                times[0],
                times[times.len() - 1]
            );
            let hint = "state the machine's time when that of the frames is at zero, such as --clock-offset \"1.2 s\" (clock_offset)";
            return Err(table.refuse(table.rows[row].1.clone(), message, hint));
        }
        let share = (time - times[after - 1]) / (times[after] - times[after - 1]);
        Ok(Some(
            (1.0 - share) * forces[after - 1] + share * forces[after],
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(frames: &[(usize, Option<f64>)]) -> MarkerSeries {
        let frame = |(number, time): &(usize, Option<f64>)| Frame {
            number: *number,
            time: *time,
            markers: Vec::new(),
        };
        MarkerSeries {
            frames: frames.iter().map(frame).collect(),
            ..MarkerSeries::default()
        }
    }

    type Found = Result<(FrameForces, Option<Diagnostic>), Error>;

    fn of(text: &str, column: &str, frames: &[(usize, Option<f64>)]) -> Found {
        on_clock(text, column, frames, FrameClock::default())
    }

    fn on_clock(
        text: &str,
        column: &str,
        frames: &[(usize, Option<f64>)],
        clock: FrameClock,
    ) -> Found {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("machine.csv");
        std::fs::write(&path, text).unwrap();
        let column = ForceColumn {
            edge: "right".into(),
            axis: 0,
            column: column.into(),
            standard_deviation: None,
        };
        forces(&path, &[column], &series(frames), clock)
    }

    const BY_TIME: &str = "time [ms];Weg [mm];Load [kN]\n0;0;0\n1000;1;0,002\n3000;2;0,006\n";

    #[test]
    fn forces_are_matched_by_frame_or_between_times() {
        let by_frame = "frame,ux [mm],Load [N]\n2,1,-5\n7,2,8\n";
        let (forces, warning) = of(by_frame, "-Load", &[(7, None), (2, None), (3, None)]).unwrap();
        let values: Vec<_> = forces
            .iter()
            .map(|(frame, one)| (frame.unwrap(), one.force))
            .collect();
        assert_eq!(values, [(7, -8.0), (2, 5.0)]);
        assert!((forces[0].1.standard_deviation - 0.08).abs() < 1e-12);
        let warning = warning.unwrap().to_string();
        assert!(warning.contains("no force for the frames 3"), "{warning}");
        let (forces, warning) = of(BY_TIME, "load", &[(1, Some(1.0)), (2, Some(1.5))]).unwrap();
        let values: Vec<f64> = forces.iter().map(|(_, one)| one.force).collect();
        assert!(
            (values[0] - 2.0).abs() < 1e-12 && (values[1] - 3.0).abs() < 1e-12,
            "{values:?}"
        );
        assert_eq!(warning, None);
        let late = FrameClock {
            interval: Some(0.5),
            offset: 0.5,
        };
        let frames = [(2, None), (1, Some(0.25))];
        let (forces, _) = on_clock(BY_TIME, "load", &frames, late).unwrap();
        let values: Vec<f64> = forces.iter().map(|(_, one)| one.force).collect();
        assert!(
            (values[0] - 3.0).abs() < 1e-12 && (values[1] - 1.5).abs() < 1e-12,
            "{values:?}"
        );
    }

    #[test]
    fn what_cannot_be_matched_is_told_with_its_place() {
        let frame = &[(1, Some(1.0))][..];
        for (text, column, frames, expected) in [
            (
                BY_TIME,
                "Kraft",
                frame,
                "machine.csv:1: there is no column `Kraft`",
            ),
            (
                BY_TIME,
                "Weg",
                frame,
                "`mm` of the column `Weg` is not a unit of force",
            ),
            (
                "frame,Load\n1,2\n",
                "Load",
                frame,
                "the column `Load` has no unit",
            ),
            (
                "step,Load [N]\n1,2\n",
                "Load",
                frame,
                "neither a column `frame` nor `time`",
            ),
            (
                "frame,Load [N]\n1,2\n1,3\n",
                "Load",
                frame,
                "machine.csv:3: frame 1 occurs twice",
            ),
            (
                "time [s],Load [N]\n1,2\n1,3\n",
                "Load",
                frame,
                "machine.csv:3: the time does not increase",
            ),
            (
                "time [N],Load [N]\n1,2\n",
                "Load",
                frame,
                "`N` is not a unit of time",
            ),
            (
                "frame,Load [N]\n1,lost\n",
                "Load",
                frame,
                "machine.csv:2: column `load`: \"lost\"",
            ),
            (
                "frame,Load [N]\n5,2\n",
                "Load",
                frame,
                "no row belongs to a frame",
            ),
            (
                BY_TIME,
                "Load",
                &[(4, Some(9.0))],
                "frame 4 was taken at 9 s, but the machine's times run from 0 to 3 s",
            ),
            (
                BY_TIME,
                "Load",
                &[(4, None)],
                "matched by time, but frame 4 has none",
            ),
        ] {
            let message = of(text, column, frames).unwrap_err().to_string();
            assert!(message.contains(expected), "{expected}: {message}");
        }
    }
}
