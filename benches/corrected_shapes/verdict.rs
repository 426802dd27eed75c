//! What the bench must show of every shape, each with what was measured.

use super::COMPARED;
use super::lines::{Lines, exponent};
use super::measure::{Run, SURE};
use super::meshes::element;
use super::reference::Reference;
use super::table::best;
use super::way::Way;

/// Errors of the displacement in percent at which times are compared.
const ACCURACIES: [f64; 13] = [
    1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4,
];
/// Nodes between which the exponent of time is fitted; the largest meshes have about a million.
const FITTED: std::ops::RangeInclusive<usize> = 10_000..=1_300_000;

/// How many times faster the climb has to be at the same nodes and at equal accuracy, and what else it must keep to.
const SAME_NODES: f64 = 20.0;
const EQUAL_ACCURACY: f64 = 5.0;
const EXPONENT: f64 = 1.1;
const SHARE: f64 = 0.1;
const BYTES: f64 = 1536.0;

/// Whether a run's cells are equal.
pub fn equal(run: &Run) -> bool {
    run.layout.grading == 1.0
}

/// Accuracy in percent and how many times faster the climb is there.
type Faster = [f64; 2];

/// All lines.
#[derive(Default)]
pub struct Verdicts {
    lines: Lines,
    /// Of each shape.
    equal_accuracy: Vec<(&'static str, Vec<Faster>)>,
}

impl Verdicts {
    /// All that a shape must show.
    pub fn shape(&mut self, name: &'static str, runs: &[Run], reference: &Reference) {
        let own: Vec<&Run> = runs.iter().filter(|run| run.shape == name).collect();
        self.same_nodes(name, &own);
        self.equal_accuracy(name, runs, reference.own_percent);
        self.exponents(name, &own);
        let climbs = || own.iter().copied().filter(|run| run.way.is_climb());
        let what = "difference to the direct path over the discretisation error";
        self.at_most(name, what, climbs(), SHARE, |run| run.difference_share);
        let what = "the same over the error that the climb states";
        self.at_most(name, what, climbs(), SHARE, |run| run.stated_share);
        let fast = climbs().filter(|run| run.way == Way::FastClimb);
        self.at_most(name, "bytes a node", fast, BYTES, |run| run.bytes_per_node);
        let same = climbs().all(|run| run.same_bits != Some(false));
        let text = format!("{name}: the same bits with one and two threads");
        self.lines.put(same, text);
    }

    /// The worst of some runs, of which one decides; those where the value is not known are left out.
    fn at_most<'a>(
        &mut self,
        name: &str,
        what: &str,
        runs: impl Iterator<Item = &'a Run>,
        limit: f64,
        value: impl Fn(&Run) -> f64,
    ) {
        let known = runs.filter(|run| !value(run).is_nan());
        let Some(worst) = known.max_by(|a, b| value(a).total_cmp(&value(b))) else {
            return;
        };
        let measured = value(worst);
        let text = format!(
            "{name}: {what}: {measured:.4} (at most {limit}), worst at {}, {} nodes, {}",
            worst.layout,
            worst.nodes,
            worst.way.name()
        );
        self.lines.put(measured <= limit, text);
    }

    /// At about 10⁵ nodes, on equal cells of each kind; the worst decides.
    fn same_nodes(&mut self, name: &str, own: &[&Run]) {
        for way in [Way::OneMesh, Way::Nested] {
            let mut worst: Option<(f64, &Run)> = None;
            for kind in kinds(own) {
                let others = own
                    .iter()
                    .filter(|run| run.way == way && equal(run) && run.layout.kind == kind);
                let far = |run: &Run| (run.nodes as f64 / COMPARED).ln().abs();
                let Some(other) = others.min_by(|a, b| far(a).total_cmp(&far(b))) else {
                    continue;
                };
                let climb = own
                    .iter()
                    .find(|run| run.way == Way::FastClimb && run.layout == other.layout);
                let times = other.seconds / climb.map_or(f64::NAN, |run| run.seconds);
                if worst.is_none_or(|(least, _)| times < least) {
                    worst = Some((times, other));
                }
            }
            let Some((times, run)) = worst else {
                continue;
            };
            let text = format!(
                "{name}: times faster at the same nodes than {}: {times:.2} (at least {SAME_NODES}), worst at {}, {} nodes",
                way.name(),
                run.layout,
                run.nodes
            );
            self.lines.put(times >= SAME_NODES, text);
        }
    }

    /// The quickest climb of some accuracy beside the quickest finite elements and Newton's method with multigrid, each on the best of
    /// all its meshes.
    fn equal_accuracy(&mut self, name: &'static str, runs: &[Run], own_percent: f64) {
        println!("\n{name}, at equal accuracy:");
        let of: [&dyn Fn(Way) -> bool; 3] = [&Way::is_climb, &Way::is_finite_elements, &|way| {
            way == Way::Multigrid
        }];
        let best = of.map(|of| best(runs, name, of));
        let mut faster: Vec<Faster> = Vec::new();
        for accuracy in ACCURACIES {
            let found = best.each_ref().map(|runs| {
                let accurate = runs.iter().rev().copied();
                accurate
                    .into_iter()
                    .find(|run| run.error_percent <= accuracy)
            });
            let [Some(climb), Some(other), newton] = found else {
                println!("at most {accuracy:.0e} %: not reached");
                continue;
            };
            if accuracy < SURE * own_percent {
                println!("at most {accuracy:.0e} %: too near to the reference's own error");
                continue;
            }
            let ratio = other.seconds / climb.seconds;
            let newton = newton.map_or("-".to_owned(), told);
            println!(
                "at most {accuracy:.0e} %: {}; {}: {ratio:.2} times faster; {newton}",
                told(climb),
                told(other),
            );
            faster.push([accuracy, ratio]);
        }
        let worst = faster.iter().min_by(|a, b| a[1].total_cmp(&b[1]));
        let [accuracy, ratio] = worst.copied().unwrap_or([f64::NAN; 2]);
        let text = format!(
            "{name}: times faster at equal accuracy than the quickest of all finite elements: {ratio:.2} (at least \
             {EQUAL_ACCURACY}), worst at {accuracy:.0e} %"
        );
        self.lines.put(ratio >= EQUAL_ACCURACY, text);
        self.equal_accuracy.push((name, faster));
    }

    /// How many times faster at the accuracies that were compared.
    pub fn faster_at_equal_accuracy(&self, shape: &str) -> Vec<Faster> {
        let own = self.equal_accuracy.iter().find(|(name, _)| *name == shape);
        own.map_or_else(Vec::new, |(_, faster)| faster.clone())
    }

    /// Of the fast climb on equal cells of each kind; the largest decides.
    fn exponents(&mut self, name: &str, own: &[&Run]) {
        let of = |kind| -> Vec<[f64; 2]> {
            let own = own
                .iter()
                .filter(|run| run.way == Way::FastClimb && equal(run) && run.layout.kind == kind);
            let points = own.filter(|run| FITTED.contains(&run.nodes));
            points.map(|run| [run.nodes as f64, run.seconds]).collect()
        };
        let slopes = kinds(own).into_iter().map(|kind| {
            let points = of(kind);
            let most = points
                .iter()
                .fold(0.0, |most: f64, [nodes, _]| most.max(*nodes));
            (exponent(&points), kind, points.len(), most)
        });
        let slopes = slopes.filter(|(_, _, count, _)| *count >= 3);
        let Some((slope, kind, count, most)) = slopes.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            return;
        };
        let text = format!(
            "{name}: exponent of time against nodes from 10⁴ to {most:.1e}, {count} meshes: {slope:.3} (at most {EXPONENT}), worst for {}",
            element(kind)
        );
        self.lines.put(slope <= EXPONENT, text);
    }

    /// Prints all lines; the number of those that fail.
    pub fn print(&self) -> usize {
        self.lines.print()
    }
}

fn kinds(runs: &[&Run]) -> Vec<gelbench::mesh::CellShape> {
    let mut kinds = Vec::new();
    for run in runs {
        if !kinds.contains(&run.layout.kind) {
            kinds.push(run.layout.kind);
        }
    }
    kinds
}

/// A way with its mesh and time.
fn told(run: &Run) -> String {
    format!(
        "{} on {}, {:.2} ms",
        run.way.name(),
        run.layout,
        1e3 * run.seconds
    )
}
