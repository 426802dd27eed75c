//! The cycles of a record: the rows where a strain turns back, and the branches between.

use std::ops::Range;

use super::test_data::{Observation, Test, TestData, Times};
use crate::document::{Faulty, Head};
use crate::error::Diagnostic;
use crate::statistics::{extremes, farthest, median};
use crate::units::Dimension;

/// The part of a record that is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cycle {
    /// The loading branch of the first cycle.
    First,
    /// The loading branch of the last cycle.
    Last,
    /// The loading branch of a cycle, counted from 1.
    Number(usize),
    /// All rows.
    All,
}

/// The key of this setting in a file or on the command line.
pub const CYCLE: &str = "cycle";

impl Cycle {
    /// The stated setting, if there is one.
    pub fn stated(head: &Head) -> Faulty<Option<Self>> {
        let Some(text) = head.setting(CYCLE, None)? else {
            return Ok(None);
        };
        let number = || text.parse().ok().filter(|number| *number > 0);
        let cycle = match &*text {
            "first" => Some(Self::First),
            "last" => Some(Self::Last),
            "all" => Some(Self::All),
            _ => number().map(Self::Number),
        };
        let hint = "first, last, all, or the number of a cycle";
        let message = || format!("the cycle `{text}` is not known");
        cycle
            .map(Some)
            .ok_or_else(|| head.fault_of(CYCLE, message(), hint))
    }
}

/// The key of the name of the specimen: files of one name are one specimen.
pub const SPECIMEN_NAME: &str = "specimen name";

/// The key of the stretch to which a specimen was stretched before its record.
pub const PRECONDITIONED: &str = "preconditioned";

/// The strain to which a specimen was stretched before a record that goes to the strain `far`, where it is stated.
pub fn preconditioned(head: &Head, test: Test, far: f64) -> Faulty<Option<f64>> {
    let Some(stretch) = head.quantity(PRECONDITIONED, Dimension::Ratio)? else {
        return Ok(None);
    };
    let fault = |message: &str, hint| Err(head.fault_of(PRECONDITIONED, message, hint));
    if test == Test::Biaxial {
        let message = "one earlier stretch does not state the earlier state of a biaxial test";
        let hint = "state it for uniaxial, planar and equibiaxial tests; or give the record from the first loading on";
        return fault(message, hint);
    }
    if (stretch > 1.0) != (far > 0.0) {
        let message = format!(
            "the record goes to λ = {}, and the earlier stretch is {stretch}",
            1.0 + far
        );
        let hint = "state the stretch λ = l/L, such as 1.5 for 50 %, with a strain of the sign of the record's";
        return fault(&message, hint);
    }
    Ok(Some(stretch - 1.0))
}

/// A swing of the strain below this share of its range does not count as a reversal.
const SMALLEST_SWING: f64 = 0.05;
/// Strains within this share of a branch's end belong to a hold there.
const HOLD: f64 = 1e-3;
/// A hold has at least this share of the rows.
const HOLD_ROWS: f64 = 0.03;

/// A record, split.
#[derive(Clone, Debug, PartialEq)]
pub struct Branches {
    /// The rows of each loading branch, without the holds at its ends.
    pub loading: Vec<Range<usize>>,
    /// The strain at the end of each.
    pub ends: Vec<f64>,
    /// Whether the strain neither turns back nor rests.
    pub is_one_pull: bool,
    /// Whether the strain moves, but never away from rest.
    pub only_unloads: bool,
    rows: usize,
}

impl Branches {
    /// Splits the strains of a record that begins at rest; away from the first one is loading.
    pub fn of(strains: &[f64]) -> Self {
        let first = strains.first().copied().unwrap_or(0.0);
        let far = farthest(strains.iter().map(|x| x - first));
        Self::along(strains, far.signum())
    }

    /// Splits a record of which any rows may be missing: where it does not begin at zero strain, loading is away from the end of the strains
    /// at which the specimen carries less.
    pub fn of_part(strains: &[f64], stresses: &[f64]) -> Self {
        let first = strains.first().copied().unwrap_or(0.0);
        let [low, high] = extremes(strains.iter().copied());
        let near = SMALLEST_SWING * (high - low);
        if first.abs() <= near {
            return Self::of(strains);
        }
        let at = |end: f64| {
            let rows = strains.iter().zip(stresses);
            let at_end = rows.filter(|(x, _)| (*x - end).abs() <= near);
            median(at_end.map(|(_, stress)| stress.abs()))
        };
        Self::along(strains, if at(low) <= at(high) { 1.0 } else { -1.0 })
    }

    /// Splits strains that grow in the direction of a sign under load.
    fn along(strains: &[f64], sign: f64) -> Self {
        let away: Vec<f64> = strains.iter().map(|x| x * sign).collect();
        let turns = turns(&away);
        let pairs = turns
            .windows(2)
            .filter(|pair| away[pair[0]] < away[pair[1]]);
        let loading: Vec<_> = pairs.map(|pair| between_holds(&away, pair)).collect();
        let moving: usize = loading.iter().map(|(rows, _)| rows.len()).sum();
        let few = (HOLD_ROWS * away.len() as f64).max(3.0);
        let is_one_pull = turns.len() <= 2 && (away.len() - moving) as f64 <= few;
        Self {
            ends: loading.iter().map(|(_, end)| strains[*end]).collect(),
            only_unloads: loading.is_empty() && turns.len() > 1,
            loading: loading.into_iter().map(|(rows, _)| rows).collect(),
            is_one_pull,
            rows: away.len(),
        }
    }

    /// The rows of the chosen part; `None` where there is no such cycle.
    pub fn rows(&self, cycle: Cycle) -> Option<Range<usize>> {
        match cycle {
            Cycle::All => Some(0..self.rows),
            Cycle::Number(2..) if self.is_one_pull => None,
            _ if self.is_one_pull => Some(0..self.rows),
            Cycle::First => self.loading.first().cloned(),
            Cycle::Last => self.loading.last().cloned(),
            Cycle::Number(number) => self.loading.get(number - 1).cloned(),
        }
    }
}

/// The rows at which values turn back by more than a small swing, with both ends.
fn turns(values: &[f64]) -> Vec<usize> {
    let [low, high] = extremes(values.iter().copied());
    let swing = SMALLEST_SWING * (high - low);
    let mut turns = Vec::new();
    let (mut lowest, mut highest) = (0, 0);
    let mut rising = None;
    for (row, value) in values.iter().enumerate() {
        if *value < values[lowest] {
            lowest = row;
        }
        if *value > values[highest] {
            highest = row;
        }
        let turned_up = rising != Some(true) && value - values[lowest] > swing;
        let turned_down = rising != Some(false) && values[highest] - value > swing;
        if turned_up || turned_down {
            turns.push(if turned_up { lowest } else { highest });
            rising = Some(turned_up);
            (lowest, highest) = (row, row);
        }
    }
    turns.push(match rising {
        Some(false) => lowest,
        _ => highest,
    });
    turns
}

/// The rows of each pull away from rest and back: a new one begins where values that are zero at rest turn up again.
fn pulls(values: &[f64]) -> Vec<Range<usize>> {
    let turns = turns(values);
    let rising = turns
        .windows(2)
        .filter(|pair| values[pair[0]] < values[pair[1]]);
    let begins = rising.map(|pair| pair[0]).filter(|row| *row > 0);
    let edges: Vec<usize> = [0]
        .into_iter()
        .chain(begins)
        .chain([values.len()])
        .collect();
    edges.windows(2).map(|pair| pair[0]..pair[1]).collect()
}

impl TestData {
    /// The observations of each protocol: a biaxial test is pulled at several ratios, in one file or in several; any other is one.
    pub fn protocols(&self) -> Vec<&[Observation]> {
        if self.test != Test::Biaxial {
            return vec![&self.observations];
        }
        let each = self.axes.len();
        let rows = self.observations.chunks(each);
        let sizes: Vec<f64> = rows.map(|row| farthest(row[0].strains).abs()).collect();
        let pulls = pulls(&sizes).into_iter();
        pulls
            .map(|rows| &self.observations[each * rows.start..each * rows.end])
            .collect()
    }

    /// The test as one for each of its [`Self::protocols`].
    pub fn by_protocol(&self) -> Vec<Self> {
        let protocols = self.protocols();
        if protocols.len() < 2 {
            return vec![self.clone()];
        }
        let of_protocol = |observations: &[Observation]| Self {
            observations: observations.to_vec(),
            drawn_axis: Observation::drawn_axis(Observation::farthest_strains(observations)),
            times: Times::None,
            left_out: Vec::new(),
            ..self.clone()
        };
        protocols.into_iter().map(of_protocol).collect()
    }
}

/// The rows between two turns without the holds there, and the row of the end.
fn between_holds(values: &[f64], pair: &[usize]) -> (Range<usize>, usize) {
    let (from, to) = (pair[0], pair[1]);
    let near = HOLD * (values[to] - values[from]);
    let arrives = (from..=to).find(|row| values[*row] >= values[to] - near);
    let end = arrives.unwrap_or(to);
    let leaves = (from..=end).rfind(|row| values[*row] <= values[from] + near);
    (leaves.unwrap_or(from)..end + 1, to)
}

/// The warning about rows with strains that turn back: those of loading alone do not. A user who states which cycles are taken knows that
/// there are some.
pub fn reversals(head: &Head, test: Test, rows: &[(usize, f64)]) -> Option<Diagnostic> {
    /// A protocol begins with a strain below this share of the largest.
    const BEGINS: f64 = 0.05;
    let far = farthest(rows.iter().map(|(_, strain)| *strain)).abs();
    // The next protocol of a biaxial test begins at rest: no specimen was unloaded within one row.
    let begins =
        |pair: &[(usize, f64)]| pair[1].1.abs() <= BEGINS * far && pair[0].1.abs() > 0.5 * far;
    let moving = rows
        .windows(2)
        .filter(|pair| pair[0].1 != pair[1].1 && !(test == Test::Biaxial && begins(pair)));
    let changes: Vec<(usize, bool)> = moving
        .map(|pair| (pair[1].0, pair[1].1 > pair[0].1))
        .collect();
    let reversed = changes.windows(2).filter(|pair| pair[0].1 != pair[1].1);
    let turns: Vec<usize> = reversed.map(|pair| pair[1].0).collect();
    let first = *turns.first()?;
    if !matches!(Cycle::stated(head), Ok(None)) {
        return None;
    }
    let times = if turns.len() == 1 {
        "once".to_owned()
    } else {
        format!("{} times", turns.len())
    };
    let hint = "loading and unloading, or scatter, are fitted together; `--cycle last` or `--cycle first` takes a loading \
                branch alone";
    let warning = Diagnostic::warning("", format!("the strain reverses {times}")).hint(hint);
    Some(warning.at(&head.table.source, head.table.rows[first].1.clone()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight lines through some values with `rows` rows each.
    fn path(values: &[f64], rows: usize) -> Vec<f64> {
        let pieces = values.windows(2).flat_map(|pair| {
            let (from, to) = (pair[0], pair[1]);
            (0..rows).map(move |i| from + (to - from) * i as f64 / rows as f64)
        });
        pieces.chain(values.last().copied()).collect()
    }

    #[test]
    fn cycles_holds_and_single_pulls_are_told_apart() {
        for sign in [1.0, -1.0] {
            let cycles = path(&[0.0, 1.0, 0.1, 1.0, 0.0, 2.0], 40)
                .iter()
                .map(|x| sign * x)
                .collect::<Vec<_>>();
            let result = Branches::of(&cycles);
            assert_eq!(result.loading.len(), 3);
            assert_eq!(result.rows(Cycle::First), Some(0..41));
            assert_eq!(result.rows(Cycle::Last), Some(160..201));
            assert_eq!(result.rows(Cycle::Number(2)), Some(80..121));
            assert_eq!(result.rows(Cycle::Number(4)), None);
            assert_eq!(result.rows(Cycle::All), Some(0..201));
            assert_eq!(result.ends[2], sign * 2.0);
        }
        let hold = path(&[0.0, 1.0, 1.0, 1.0], 30);
        let result = Branches::of(&hold);
        assert!(!result.is_one_pull);
        assert_eq!(result.rows(Cycle::Last), Some(0..31));
        let pull = Branches::of(&path(&[0.0, 1.0], 50));
        assert_eq!(pull.rows(Cycle::Last), Some(0..51));
        assert_eq!(pull.rows(Cycle::Number(1)), Some(0..51));
        assert_eq!(pull.rows(Cycle::Number(2)), None);
    }

    /// Rows that are cut from a record begin anywhere; stresses have the sign of the pull, or that of pressing.
    #[test]
    fn a_part_of_a_record_is_split_at_its_rest_wherever_it_begins() {
        for (sign, pressed) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let all = path(&[0.0, 1.0, 0.0, 1.0, 0.0], 40);
            let strains: Vec<f64> = all.iter().map(|x| sign * x).collect();
            let stresses: Vec<f64> = all.iter().map(|x| sign * pressed * x * x).collect();
            let of =
                |rows: Range<usize>| Branches::of_part(&strains[rows.clone()], &stresses[rows]);
            for first in [41, 50, 70] {
                let result = of(first..150);
                assert_eq!(result.loading.len(), 1, "{first}");
                assert_eq!(result.loading[0], 80 - first..121 - first, "{first}");
            }
            assert_eq!(of(20..150).loading, [0..21, 60..101]);
            assert!(of(45..75).only_unloads && !of(85..115).only_unloads);
        }
    }

    /// Noise of a fiftieth of the range is no cycle.
    #[test]
    fn scatter_is_no_cycle() {
        let mut noisy = path(&[0.0, 1.0, 0.0, 1.0], 100);
        for (row, value) in noisy.iter_mut().enumerate() {
            *value += 0.01 * (12.9898 * row as f64).sin();
        }
        assert_eq!(Branches::of(&noisy).loading.len(), 2);
    }
}
