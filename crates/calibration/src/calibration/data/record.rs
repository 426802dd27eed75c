//! The record of a testing machine: displacement and force over time, with several cycles, slack and preload.

use std::ops::Range;

use super::cycles::{Branches, CYCLE, Cycle};
use super::row_choice::ROWS;
use super::zero::{Beginning, FoundZero};
use crate::document::{Faulty, Head};
use crate::statistics::farthest;
use crate::units::{self, Dimension};

/// The key of the displacement or force at which stretching begins, in a file or on the command line.
pub const ZERO: &str = "zero";

/// A table of displacements and forces.
#[derive(Clone, Copy, Debug)]
pub struct Machine {
    /// Length of the specimen in mm.
    pub length: f64,
    /// Its cross-section in mm².
    pub area: f64,
    /// Whether the test is one of compression, which machines often count as positive.
    pub presses: bool,
}

/// The part of a record that is fitted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// The rows, in their order.
    pub rows: Vec<usize>,
    /// The sign of strains and stresses.
    pub signs: [f64; 2],
    /// The strain of the record at which the specimen begins to be stretched.
    pub zero: f64,
    /// The stress of the record there, in MPa.
    pub offset: f64,
    /// Which of them was found from the record, and is uncertain.
    pub found_zero: Option<FoundZero>,
    /// Descriptions of the choices that were made.
    pub remarks: Vec<String>,
}

/// The curve of a protocol, or of a record without protocols.
pub struct Curve {
    /// What messages about it begin with; empty where it is the only one.
    pub title: String,
    /// Its rows.
    pub rows: Range<usize>,
    /// Their strains along the axis that shows the cycles.
    pub strains: Vec<f64>,
    /// Their stresses in MPa.
    pub stresses: Vec<f64>,
}

/// Where the zero of displacement is.
#[derive(Clone, Copy)]
enum Zero {
    Automatic,
    AsWritten,
    Displacement(f64),
    Force(f64),
}

impl Part {
    /// All rows as they are.
    pub fn all_rows(rows: usize) -> Self {
        Self {
            rows: (0..rows).collect(),
            signs: [1.0; 2],
            ..Self::default()
        }
    }

    /// A strain of the record, from the zero on.
    pub fn strain(&self, x: f64) -> f64 {
        self.signs[0] * (x - self.zero)
    }

    /// A stress of the record less the offset.
    pub fn stress(&self, y: f64) -> f64 {
        self.signs[1] * (y - self.offset)
    }

    /// The chosen part of a record with these curves: a cycle is chosen in each of them.
    pub fn of(
        head: &Head,
        machine: Option<Machine>,
        curves: impl FnOnce() -> Vec<Curve>,
    ) -> Faulty<Self> {
        let stated = Cycle::stated(head)?;
        let zero = Zero::stated(head, machine)?;
        let mut part = Self::all_rows(head.table.rows.len());
        if machine.is_none() && matches!(stated, None | Some(Cycle::All)) {
            return Ok(part);
        }
        let curves = curves();
        part.rows.clear();
        for curve in &curves {
            let branches = Branches::of_part(&curve.strains, &curve.stresses);
            let cycle = stated.unwrap_or(Cycle::Last);
            part.choose((head, curve), &branches, cycle, machine)?;
            // Unloading alone shows neither the zero nor the sign.
            if let Some(machine) = machine.filter(|_| !branches.only_unloads) {
                let loading = match (&branches.loading[..], part.rows.len() < curve.rows.len()) {
                    ([first, ..], false) if !branches.is_one_pull => first.clone(),
                    _ => part.rows[0]..part.rows[part.rows.len() - 1] + 1,
                };
                let values = [&curve.strains[..], &curve.stresses[..]];
                machine.turn_signs(&mut part, &loading, values);
                part.begin(head, machine, zero, loading, values)?;
            }
        }
        Ok(part)
    }

    /// Adds the rows of a curve's cycle.
    fn choose(
        &mut self,
        (head, curve): (&Head, &Curve),
        branches: &Branches,
        cycle: Cycle,
        machine: Option<Machine>,
    ) -> Faulty<()> {
        let (count, title) = (branches.loading.len(), &curve.title);
        if branches.only_unloads && cycle != Cycle::All {
            let message =
                format!("{title}these rows have no loading branch: the specimen is only unloaded");
            let hint = "take rows that begin before a loading branch; `--cycle all` fits the unloading as it is in the file";
            return Err(head.fault_of(ROWS, message, hint));
        }
        if count == 0 {
            self.rows.extend(curve.rows.clone());
            return Ok(());
        }
        let Some(rows) = branches.rows(cycle) else {
            let message = format!("{title}there is no such cycle: {}", cycles(count));
            let hint = "first, last, all, or a number up to that";
            return Err(head.fault_of(CYCLE, message, hint));
        };
        let begin = curve.rows.start;
        let rows = begin + rows.start..begin + rows.end;
        self.rows.extend(rows.clone());
        if branches.is_one_pull {
            return Ok(());
        }
        let ends = branches.ends.iter().take(5);
        let end = |x: &f64| match machine {
            Some(machine) => format!("{:.2} mm", machine.length * x),
            None => format!("λ = {:.3}", 1.0 + x),
        };
        let ends: Vec<_> = ends.map(end).collect();
        let more = if count > 5 { ", …" } else { "" };
        let counted = format!(
            "{title}{} found (to {}{more})",
            cycles(count),
            ends.join(", ")
        );
        let line = |row: usize| {
            let position = &head.table.rows[row.min(head.table.rows.len() - 1)].1;
            head.table.source.line(position.start)
        };
        let taken = match cycle {
            Cycle::All => "all rows are fitted".to_owned(),
            _ => format!(
                "the loading branch of the {} is fitted, lines {} to {}",
                match cycle {
                    _ if count == 1 => "only one".to_owned(),
                    Cycle::First => "first".to_owned(),
                    Cycle::Number(number) => format!("cycle {number}"),
                    _ => "last".to_owned(),
                },
                line(rows.start),
                line(rows.end - 1)
            ),
        };
        let others = "`--cycle first`, `last`, `all` or a number takes another part";
        self.remarks.push(format!("{counted}; {taken} ({others})"));
        Ok(())
    }

    /// Finds the zero of displacement of a loading branch.
    fn begin(
        &mut self,
        head: &Head,
        machine: Machine,
        zero: Zero,
        loading: Range<usize>,
        [strains, stresses]: [&[f64]; 2],
    ) -> Faulty<()> {
        let (x, y) = (&strains[loading.clone()], &stresses[loading.clone()]);
        let Machine { length, area, .. } = machine;
        match zero {
            Zero::AsWritten => {}
            Zero::Automatic => self.set_right(machine, Beginning::of(x, y), y),
            Zero::Displacement(u) => {
                let position = either(x, u / length);
                self.take_stated(head, machine, [x, y], position)?;
                self.found_zero = Some(FoundZero::Stress { area });
            }
            Zero::Force(f) => {
                let position = either(y, f / area);
                self.take_stated(head, machine, [x, y], position)?;
                self.found_zero = Some(FoundZero::strain(length));
            }
        }
        // Rows before the zero are not fitted.
        let direction = (x[x.len() - 1] - x[0]).signum();
        let before = x
            .iter()
            .take_while(|x| (**x - self.zero) * direction < 0.0)
            .count();
        // By rounding, a zero at the last row may lie behind it.
        let before = before.min(x.len() - 1);
        if self.zero != 0.0 && self.rows[0] <= loading.start {
            self.rows.retain(|row| *row >= loading.start + before);
        }
        Ok(())
    }

    /// Takes the zero at a stated point of a branch, given as a row and the share of the step to the next one. A single row's reading
    /// scatters, so that the strain or the stress there is determined again with the law.
    fn take_stated(
        &mut self,
        head: &Head,
        machine: Machine,
        [x, y]: [&[f64]; 2],
        position: Option<(usize, f64)>,
    ) -> Faulty<()> {
        let Some(position) = position else {
            let message = "the loading branch does not pass the stated zero";
            let hint = "give a displacement or a force that it passes through, or none";
            return Err(head.fault_of(ZERO, message, hint));
        };
        (self.zero, self.offset) = (at(x, position), at(y, position));
        self.remarks.push(format!(
            "the zero of displacement is {:.4} mm as stated, and the force there, {:.4} N, is subtracted",
            machine.length * self.zero,
            machine.area * self.offset
        ));
        Ok(())
    }

    /// Subtracts the offsets that were found at the beginning of a branch with these stresses, and records a remark.
    fn set_right(&mut self, machine: Machine, beginning: Beginning, stresses: &[f64]) {
        let mm = |strain: f64| machine.length * strain;
        let largest = farthest(stresses.iter().copied()).abs();
        let force = |stress: f64| {
            let percent = 100.0 * (stress / largest).abs();
            let newton = machine.area * stress;
            format!("{newton:.4} N, {percent:.2} % of the largest force,")
        };
        let strain = FoundZero::strain(machine.length);
        let done = match beginning {
            Beginning::Clean => return,
            Beginning::Elsewhere(zero) => {
                self.zero = zero;
                format!(
                    "the first row has no force at a displacement of {:.4} mm: this is the zero of displacement",
                    mm(zero)
                )
            }
            Beginning::Slack {
                zero,
                error,
                offset,
                offset_error,
            } => {
                (self.zero, self.offset) = (zero, offset);
                self.found_zero = Some(FoundZero::Strain {
                    length: machine.length,
                    offset_error,
                });
                format!(
                    "slack up to {:.4} ± {:.4} mm is removed: this is the zero of displacement, and the reading before it, {:.4} N, that of force",
                    mm(zero),
                    mm(error),
                    machine.area * offset
                )
            }
            Beginning::Preload { zero, stress } => {
                self.zero = zero;
                self.found_zero = Some(strain);
                format!(
                    "preload of {} at the first row: the zero of displacement is {:.4} mm, where the extrapolated curve has no force; a load cell \
                     that was not set to zero reads the same: in that case subtract the force in the file",
                    force(stress),
                    mm(zero)
                )
            }
            Beginning::Offset(stress) => {
                self.offset = stress;
                self.found_zero = Some(FoundZero::Stress { area: machine.area });
                format!(
                    "{} at the first row act against the pull: this is the load cell's zero, and it is subtracted",
                    force(stress)
                )
            }
        };
        let kept = "`--zero none` keeps the file's zero";
        self.remarks.push(format!("{done} ({kept})"));
    }
}

impl Machine {
    /// Machines often count compression as positive.
    fn turn_signs(self, part: &mut Part, loading: &Range<usize>, [x, y]: [&[f64]; 2]) {
        if !self.presses {
            return;
        }
        let rises = |values: &[f64]| {
            let branch = &values[loading.clone()];
            branch[branch.len() - 1] > branch[0]
        };
        for (sign, values) in part.signs.iter_mut().zip([x, y]) {
            *sign = if rises(values) { -1.0 } else { 1.0 };
        }
        if part.signs != [1.0; 2] {
            let remark = "the file counts compression as positive; here it is negative";
            part.remarks.push(remark.to_owned());
        }
    }
}

impl Zero {
    fn stated(head: &Head, machine: Option<Machine>) -> Faulty<Self> {
        let Some(text) = head.setting(ZERO, None)? else {
            return Ok(Self::Automatic);
        };
        let fault = |message: String, hint: &str| Err(head.fault_of(ZERO, message, hint));
        if machine.is_none() {
            let message = "the zero is found only in tables of displacements and forces".to_owned();
            return fault(message, "leave it out, or shift the strains in the file");
        }
        let parsed = |dimension| units::parse(&text, dimension).ok();
        match &*text {
            "automatic" => Ok(Self::Automatic),
            "none" => Ok(Self::AsWritten),
            _ => match (parsed(Dimension::Length), parsed(Dimension::Force)) {
                (Some(u), _) => Ok(Self::Displacement(u)),
                (_, Some(f)) => Ok(Self::Force(f)),
                _ => fault(
                    format!("the zero `{text}` is not known"),
                    "automatic, none, a displacement such as \"0.4 mm\", or the force at which stretching begins, such as \"0.05 N\"",
                ),
            },
        }
    }
}

fn cycles(count: usize) -> String {
    match count {
        1 => "one cycle or hold".to_owned(),
        _ => format!("{count} cycles"),
    }
}

/// Where values first pass a wanted one, or, where they fall, its negative: compression may be stated without its sign.
fn either(values: &[f64], wanted: f64) -> Option<(usize, f64)> {
    let falls = values.last() < values.first();
    passes(values, wanted).or_else(|| passes(values, -wanted).filter(|_| falls && wanted > 0.0))
}

/// Where values first pass a wanted one, as a row and the share of the step to the next one; up to the rounding of units.
fn passes(values: &[f64], wanted: f64) -> Option<(usize, f64)> {
    const ROUNDING: f64 = 1e-9;
    let step = |row: usize| {
        let (from, to) = (values[row], values[row + 1]);
        let share = (wanted - from) / (to - from);
        let is_within = (-ROUNDING..=1.0 + ROUNDING).contains(&share);
        is_within.then_some((row, share.clamp(0.0, 1.0)))
    };
    (0..values.len().saturating_sub(1)).find_map(step)
}

fn at(values: &[f64], (row, share): (usize, f64)) -> f64 {
    values[row] + share * (values[row + 1] - values[row])
}
