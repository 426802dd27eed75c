//! What the cases share: how they read their settings, draw noise, and judge and show what they found.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::document::Section;
use crate::error::{Error, SolveFault};
use crate::mesh::Mesh;
use crate::results::Wanted;
use crate::results::{Line, Stroke, mesh_outlines};
use crate::solve::vector::{difference, norm};
use crate::statistics::{larger, median};

pub use crate::results::{Block, Check, Claim, Figure, Outcome, limit};
pub use crate::studies::{Computation, Progress};
pub use crate::units::number;

/// Reads a section and reports its unknown keys.
pub fn section<'a, T>(
    root: &Section<'a>,
    key: &'static str,
    read: impl FnOnce(&Section<'a>) -> T,
) -> T {
    let section = root.section(key);
    let settings = read(&section);
    section.unknown_keys();
    settings
}

/// The error of a model at a step, of the fault that ended it.
pub fn failed<F: Into<SolveFault>>(model: &str, step: &str) -> impl FnOnce(F) -> Error {
    let (model, step) = (model.to_owned(), step.to_owned());
    move |fault| Error::Solve {
        model,
        step,
        fault: fault.into(),
    }
}

/// A computed quantity, about to be judged.
pub struct Quantity {
    name: String,
    unit: &'static str,
    computed: f64,
}

/// What was computed, before anything is demanded of it: `check(name, unit, value).at_most(limit, source)`.
pub fn check(name: impl Into<String>, unit: &'static str, computed: f64) -> Quantity {
    Quantity {
        name: name.into(),
        unit,
        computed,
    }
}

impl Quantity {
    /// It must not exceed a limit.
    pub fn at_most(self, limit: f64, source: &'static str) -> Check {
        self.must(Wanted::AtMost(limit), source)
    }

    /// It must not fall below a limit.
    pub fn at_least(self, limit: f64, source: &'static str) -> Check {
        self.must(Wanted::AtLeast(limit), source)
    }

    /// It must equal a value within a tolerance in percent.
    pub fn equal(self, expected: f64, tolerance: f64, source: &'static str) -> Check {
        self.must(Wanted::Equal(expected, tolerance), source)
    }

    fn must(self, wanted: Wanted, source: &'static str) -> Check {
        Check::new(self.name, self.unit, wanted, source, self.computed)
    }
}

/// A table; the column heads stand in one line, separated by ` | `.
pub fn table(head: &str, rows: impl IntoIterator<Item = Vec<String>>) -> Block {
    Block::table(&head.split(" | ").collect::<Vec<_>>(), rows)
}

/// A row of a table: a name and some numbers.
pub fn row(name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Vec<String> {
    let values = values.into_iter().map(number);
    [name.into()].into_iter().chain(values).collect()
}

/// A mesh as a figure of a case.
pub fn mesh_figure(name: &str, caption: &str, title: &str, mesh: &Mesh) -> Figure {
    Figure::new(name, caption, mesh_outlines(title, mesh))
}

/// A line of `y` over `x`.
pub fn line(label: &str, x: &[f64], y: &[f64], colour: [u8; 3], stroke: Stroke) -> Line {
    let points = x.iter().zip(y).map(|(x, y)| [*x, *y]);
    Line::new(label, points, colour, stroke)
}

/// Standard normal numbers, the same for the same seed.
pub fn normal_numbers(seed: u64) -> impl Iterator<Item = f64> {
    normal_numbers_of_stream(seed, 0)
}

/// Standard normal numbers of one of the independent streams of a seed.
pub fn normal_numbers_of_stream(seed: u64, stream: u64) -> impl Iterator<Item = f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(stream);
    StandardNormal.sample_iter(random)
}

/// Distance of two series over the size of the second, in relative L2, in %.
pub fn percent(values: &[f64], reference: &[f64]) -> f64 {
    100.0 * norm(&difference(values, reference)) / norm(reference)
}

/// Squares of errors and of exact values, integrated over a sheet.
#[derive(Default)]
pub struct Squares {
    error: f64,
    size: f64,
}

impl Squares {
    /// Adds those of some components with the area that they stand for.
    pub fn add(&mut self, area: f64, computed: &[f64], exact: &[f64]) {
        for (computed, exact) in computed.iter().zip(exact) {
            self.error += area * (computed - exact).powi(2);
            self.size += area * exact.powi(2);
        }
    }

    /// The root of their ratio.
    pub fn relative(&self) -> f64 {
        (self.error / self.size).sqrt()
    }
}

/// How much of a deviation a correction removes, in %.
pub fn removed_percent(before: f64, after: f64) -> f64 {
    100.0 * (1.0 - after / before)
}

/// Largest absolute value; NaN where one of them is none, so that no check passes by it.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let values = values.into_iter();
    values.fold(0.0, |most, value| larger(most, value.abs()))
}

/// Mean value.
pub fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values
        .into_iter()
        .fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Share of what holds, in %.
pub fn share(holds: impl IntoIterator<Item = bool>) -> f64 {
    100.0 * mean(holds.into_iter().map(|holds| f64::from(u8::from(holds))))
}

/// Least, median and largest value, of which ends are NaN where a value is none; of an even number of values the upper one of the two in the
/// middle.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    /// The least value.
    pub least: f64,
    /// The median.
    pub median: f64,
    /// The largest value.
    pub most: f64,
}

impl Spread {
    /// Of at least one value.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().collect();
        Self {
            least: -values
                .iter()
                .map(|value| -value)
                .fold(f64::NEG_INFINITY, larger),
            most: values.iter().copied().fold(f64::NEG_INFINITY, larger),
            median: median(values),
        }
    }
}
