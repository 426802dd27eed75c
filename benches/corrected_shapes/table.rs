//! The table: one row for each mesh and climb.

use gelbench::output;
use gelbench::results::{Axis, Drawing, Line, LineChart, PALETTE, Stroke};

use super::columns::{Columns, number, ratio};
use super::lines;
use super::measure::Run;
use super::meshes::element;
use super::verdict::{Verdicts, equal};
use super::way::Way;

/// A climb on one mesh beside its opponents.
pub struct Row<'a> {
    pub climb: &'a Run,
    /// Finite elements with the same nodes and equations: on one mesh and from the nested guess.
    same_nodes: [Option<&'a Run>; 2],
    /// The cheapest finite elements that are as accurate, of all meshes, equal and graded, and both elements; likewise.
    equal_accuracy: [Option<&'a Run>; 2],
    newton: Option<&'a Run>,
}

/// How much larger an error still counts as equal: as much as the iterations of the climb leave.
const EQUAL: f64 = 1.02;

const GUESSES: [Way; 2] = [Way::OneMesh, Way::Nested];

impl<'a> Row<'a> {
    pub fn all(runs: &'a [Run]) -> Vec<Self> {
        let climbs = runs.iter().filter(|run| run.way.is_climb());
        climbs.map(|run| Self::new(runs, run)).collect()
    }

    fn new(runs: &'a [Run], climb: &'a Run) -> Self {
        let own = || runs.iter().filter(|run| run.shape == climb.shape);
        let here = |way: Way| own().find(|run| run.way == way && run.layout == climb.layout);
        let cheapest = |way: Way| {
            let as_accurate = own()
                .filter(|run| run.way == way && run.error_percent <= EQUAL * climb.error_percent);
            as_accurate.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
        };
        Self {
            climb,
            same_nodes: GUESSES.map(here),
            equal_accuracy: GUESSES.map(cheapest),
            newton: here(Way::Multigrid),
        }
    }

    /// How many times longer than the climb a run takes.
    fn times(&self, run: Option<&Run>) -> f64 {
        run.map_or(f64::NAN, |run| run.seconds) / self.climb.seconds
    }

    /// What is printed and written: name and value; times in s, errors of the displacement in its root mean square, and of the
    /// force, or of the strain energy under loads.
    pub fn columns(&self) -> Columns {
        let climb = self.climb;
        let [one_mesh, nested] = self.same_nodes;
        let equal = self.equal_accuracy[1];
        let of = |run: Option<&Run>, value: fn(&Run) -> f64| run.map_or(f64::NAN, value);
        vec![
            ("shape", climb.shape.to_owned()),
            ("nodes", climb.nodes.to_string()),
            ("grid", climb.layout.to_string()),
            ("scheme", element(climb.layout.kind).to_owned()),
            ("climb", climb.way.name().to_owned()),
            ("threads", "1".to_owned()),
            ("departure_percent", number(climb.error_percent)),
            ("force_percent", number(climb.force_percent)),
            ("seconds", number(climb.seconds)),
            (
                "finite_elements_seconds",
                number(of(one_mesh, |run| run.seconds)),
            ),
            ("ratio_same_nodes", ratio(self.times(one_mesh))),
            ("ratio_same_nodes_nested", ratio(self.times(nested))),
            (
                "equal_accuracy_nodes",
                equal.map_or("-".to_owned(), |run| run.layout.to_string()),
            ),
            (
                "equal_accuracy_force_percent",
                number(of(equal, |run| run.force_percent)),
            ),
            (
                "ratio_equal_accuracy",
                ratio(self.times(self.equal_accuracy[0])),
            ),
            ("ratio_equal_accuracy_nested", ratio(self.times(equal))),
            ("ratio_newton", ratio(self.times(self.newton))),
            (
                "difference_to_direct_percent",
                number(climb.difference_percent),
            ),
            ("bytes_per_node", format!("{:.0}", climb.bytes_per_node)),
            (
                "finite_elements_bytes_per_node",
                format!("{:.0}", of(nested, |run| run.bytes_per_node)),
            ),
            ("work_units", format!("{:.1}", climb.work_units)),
            (
                "same_bits_as_one_thread",
                climb
                    .same_bits
                    .map_or("-".to_owned(), |same| same.to_string()),
            ),
        ]
    }
}

/// One run as soon as it is measured.
pub fn print_run(run: &Run) {
    println!(
        "{:<16} {:>8} nodes  {:<10} {:<29} {:>9.4} s  {:>2} iterations  {:>5.0} bytes a node  error {:.2e} % (force {:.1e} %), \
         difference to the direct path over it {:.4}",
        run.shape,
        run.nodes,
        run.layout.to_string(),
        run.way.name(),
        run.seconds,
        run.iterations,
        run.bytes_per_node,
        run.error_percent,
        run.force_percent,
        run.difference_share,
    );
}

/// What a chart shows of a shape, and of a way.
type Points<'a> = &'a dyn Fn(&str, Way) -> Vec<[f64; 2]>;

/// Time against nodes, how many times faster the climb is on the same nodes, and at equal accuracy.
pub fn picture(runs: &[Run], verdicts: &Verdicts) -> Result<Vec<u8>, output::PictureFault> {
    const HEIGHT: u32 = 430;
    let times = |shape: &str, way: Way| -> Vec<[f64; 2]> {
        let own = linear(runs, shape, way).into_iter();
        own.map(|run| [run.nodes as f64, run.seconds]).collect()
    };
    let faster = |shape: &str, way: Way| -> Vec<[f64; 2]> {
        let climbs = linear(runs, shape, Way::FastClimb);
        let others = linear(runs, shape, way).into_iter();
        let pairs = others.filter_map(|run| {
            let climb = climbs.iter().find(|climb| climb.layout == run.layout)?;
            Some([run.nodes as f64, run.seconds / climb.seconds])
        });
        pairs.collect()
    };
    let at_equal_accuracy = |shape: &str, _: Way| verdicts.faster_at_equal_accuracy(shape);
    let shapes = shapes(runs);
    let charts = [
        chart(
            "Linear elements, equal cells: time against nodes",
            ["nodes", "time [s]"],
            &shapes,
            &[Way::FastClimb, Way::Nested],
            &times,
        ),
        chart(
            "Time of finite elements over that of the climb (aim: 20)",
            ["nodes", "times faster [–]"],
            &shapes,
            &[Way::OneMesh, Way::Nested],
            &faster,
        ),
        chart(
            "The same at equal accuracy, best of all meshes (aim: 5)",
            ["error of the displacement [%]", "times faster [–]"],
            &shapes,
            &[Way::FastClimb],
            &at_equal_accuracy,
        ),
    ];
    let charts = charts.map(|chart| (chart, HEIGHT));
    output::png(&Drawing::Charts(charts.to_vec()))
}

/// The shapes by colours; the first way is solid, the second dashed.
fn chart(title: &str, axes: [&str; 2], shapes: &[&str], ways: &[Way], points: Points) -> LineChart {
    const INK: [u8; 3] = [30, 30, 30];
    let mut lines = Vec::new();
    for (way, stroke) in ways.iter().zip([Stroke::Marked, Stroke::Dashed]) {
        for (shape, colour) in shapes.iter().zip(&PALETTE) {
            let label = if stroke == Stroke::Marked { *shape } else { "" };
            lines.push(Line::new(label, points(shape, *way), *colour, stroke));
        }
        if ways.len() > 1 {
            lines.push(Line::new(way.name(), [], INK, stroke));
        }
    }
    let [x, y] = axes.map(Axis::logarithmic);
    LineChart::new(title, x, y, lines)
}

/// The runs of a way on equal linear cells of a shape, from the fewest nodes on.
fn linear<'a>(runs: &'a [Run], shape: &str, way: Way) -> Vec<&'a Run> {
    let own = runs
        .iter()
        .filter(|run| run.shape == shape && run.way == way && equal(run));
    let mut own: Vec<&Run> = own.filter(|run| run.layout.kind.degree() == 1).collect();
    own.sort_by_key(|run| run.nodes);
    own
}

/// The names of all shapes, in the order in which they were measured.
pub fn shapes(runs: &[Run]) -> Vec<&'static str> {
    let mut names: Vec<&str> = runs.iter().map(|run| run.shape).collect();
    names.dedup();
    names
}

/// The runs of a shape that no other is both quicker and more accurate than, from the most accurate on.
pub fn best<'a>(runs: &'a [Run], shape: &str, of: impl Fn(Way) -> bool) -> Vec<&'a Run> {
    let own = runs.iter().filter(|run| run.shape == shape && of(run.way));
    lines::best(own, |run| [run.seconds, run.error_percent])
}
