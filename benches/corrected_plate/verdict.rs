//! What the bench must show, each with what was measured.

use super::measure::{Run, SCHEMES};
use super::method::{Method, scheme_name};
use super::opponent::Guess;
use super::reference::{PUBLISHED_FORCE, Reference};
use super::table::{Row, best};
use gelbench::corrector::DifferenceScheme;

/// Departures from affine in percent at which times are compared, and how many times faster the climb has to be.
const ACCURACIES: [f64; 10] = [0.1, 0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4];
const TIMES_FASTER: f64 = 5.0;

fn is_equal(row: &Row) -> bool {
    row.climb.layout.grading == 1.0
}

/// Lines that pass or fail, each with what was measured.
pub struct Verdicts {
    lines: Vec<(bool, String)>,
    error_percent: f64,
}

/// Nodes between which the exponent of time is fitted; the largest grid has a little more than a million.
const FITTED: std::ops::RangeInclusive<usize> = 10_000..=1_300_000;

impl Verdicts {
    pub fn new(reference: &Reference) -> Self {
        let deviation = 100.0 * (reference.force / PUBLISHED_FORCE - 1.0).abs();
        let mut verdicts = Self {
            lines: Vec::new(),
            error_percent: reference.error_percent,
        };
        let text = format!(
            "force of the reference: {:.6} N, {deviation:.1e} % from the published {PUBLISHED_FORCE} N (at most 1e-4 %)",
            reference.force
        );
        verdicts.put(deviation <= 1e-4, text);
        verdicts
    }

    /// At least, or at most, over some rows; the worst one decides.
    fn worst(
        &mut self,
        what: &str,
        rows: &[&Row],
        limit: f64,
        least: bool,
        value: impl Fn(&Row) -> f64,
    ) {
        let Some(worst) = rows.iter().min_by(|a, b| {
            let order = value(a).total_cmp(&value(b));
            if least { order } else { order.reverse() }
        }) else {
            return;
        };
        let measured = value(worst);
        let pass = if least {
            measured >= limit
        } else {
            measured <= limit
        };
        let bound = if least { "at least" } else { "at most" };
        let text = format!(
            "{what}: {measured:.4} ({bound} {limit}), worst at {} cells, {}",
            worst.climb.layout,
            scheme_name(worst.scheme)
        );
        self.put(pass, text);
    }

    /// All that is seen from the table.
    pub fn rows(&mut self, rows: &[Row]) {
        let one: Vec<&Row> = rows.iter().filter(|row| row.climb.threads == 1).collect();
        let at = |cells: usize| -> Vec<&Row> {
            let layout = |row: &&&Row| row.climb.layout.cells[0] == cells && is_equal(row);
            let chosen = one.iter().filter(layout);
            chosen.copied().collect()
        };
        for (cells, limit, name) in [
            (600, 20.0, "600 × 200 cells"),
            (1920, 50.0, "1920 × 640 cells"),
        ] {
            for guess in [Guess::Affine, Guess::Nested] {
                let what = format!(
                    "times faster at the same nodes, {name}, {} guess",
                    guess.name()
                );
                self.worst(&what, &at(cells), limit, true, |row| {
                    row.ratio_same_nodes(guess)
                });
            }
        }
        let of = |scheme: DifferenceScheme| -> Vec<&Row> {
            let chosen = one
                .iter()
                .filter(|row| row.scheme == scheme && is_equal(row));
            chosen.copied().collect()
        };
        for scheme in SCHEMES {
            self.exponent(scheme, &of(scheme));
        }
        self.worst("bytes a node", &one, 1024.0, false, |row| {
            row.climb.bytes_per_node
        });
        let large: Vec<&Row> = one
            .iter()
            .filter(|row| row.climb.nodes >= 10_000)
            .copied()
            .collect();
        self.worst(
            "evaluations of F, in time, from 10⁴ nodes on",
            &large,
            30.0,
            false,
            |row| row.climb.work_units,
        );
        self.worst(
            "evaluations of F, in time, all grids",
            &one,
            30.0,
            false,
            |row| row.climb.work_units,
        );
        self.worst(
            "difference to the direct path over the discretisation error",
            &one,
            0.1,
            false,
            |row| row.climb.difference_percent / row.same_nodes[0].departure_percent,
        );
        let reference_error = self.error_percent;
        self.worst(
            "error of the reference over that of a row",
            &one,
            0.1,
            false,
            |row| reference_error / row.climb.departure_percent,
        );
        let same = rows.iter().all(|row| row.climb.same_bits);
        self.put(same, "the same bits with one and two threads".to_owned());
    }

    /// The quickest climb of some accuracy beside the quickest finite elements, each on the best of all its grids.
    pub fn equal_accuracy(&mut self, runs: &[Run]) {
        let is_climb = |run: &Run| matches!(run.method, Method::Climb(_)) && run.threads == 1;
        let climbs = best(runs, is_climb);
        let elements = best(runs, |run| matches!(run.method, Method::FiniteElements(..)));
        println!();
        let mut worst: Option<(f64, f64)> = None;
        for accuracy in ACCURACIES {
            let [climb, other] = [&climbs, &elements].map(|runs| {
                let accurate = runs.iter().rev();
                accurate
                    .copied()
                    .find(|run| run.departure_percent <= accuracy)
            });
            let (Some(climb), Some(other)) = (climb, other) else {
                println!("at most {accuracy:.0e} %: not reached");
                continue;
            };
            let ratio = other.seconds / climb.seconds;
            println!(
                "at most {accuracy:.0e} %: {} on {}, {:.2} ms; {} on {}, {:.2} ms: {ratio:.2} times faster",
                climb.method.name(),
                climb.layout,
                1e3 * climb.seconds,
                other.method.name(),
                other.layout,
                1e3 * other.seconds,
            );
            if worst.is_none_or(|(least, _)| ratio < least) {
                worst = Some((ratio, accuracy));
            }
        }
        let (ratio, accuracy) = worst.unwrap_or((f64::NAN, f64::NAN));
        let text = format!(
            "times faster at equal accuracy from 0.1 to 1e-4 %, against the quickest of all finite elements: {ratio:.2} (at \
             least {TIMES_FASTER}), worst at {accuracy:.0e} %"
        );
        self.put(ratio >= TIMES_FASTER, text);
    }

    /// The least-squares slope of ln t over ln n.
    fn exponent(&mut self, scheme: DifferenceScheme, rows: &[&Row]) {
        let points = rows.iter().filter(|row| FITTED.contains(&row.climb.nodes));
        let points: Vec<[f64; 2]> = points
            .map(|row| [row.climb.nodes as f64, row.climb.seconds])
            .collect();
        let slope = exponent(&points);
        let text = format!(
            "exponent of time against nodes, {} climb, {} grids: {slope:.3} (at most 1.05)",
            scheme_name(scheme),
            points.len()
        );
        self.put(slope <= 1.05, text);
    }

    fn put(&mut self, pass: bool, text: String) {
        self.lines.push((pass, text));
    }

    /// Prints all lines; the number of those that fail.
    pub fn print(&self) -> usize {
        println!();
        for (pass, text) in &self.lines {
            println!("{} {text}", if *pass { "pass" } else { "FAIL" });
        }
        self.lines.iter().filter(|(pass, _)| !pass).count()
    }
}

/// The least-squares slope of ln y over ln x.
fn exponent(points: &[[f64; 2]]) -> f64 {
    let points: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
    let mean =
        |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let covariance: f64 = points
        .iter()
        .map(|point| (point[0] - x) * (point[1] - y))
        .sum();
    let variance: f64 = points.iter().map(|point| (point[0] - x).powi(2)).sum();
    covariance / variance
}
