//! The table: one row for each grid, scheme and number of threads of the climb.

use gelbench::corrector::DifferenceScheme;
use gelbench::output;
use gelbench::results::Drawing;
use gelbench_report::results::{Axis, Line, LineChart, PALETTE, Stroke, Table};

use super::measure::Run;
use super::method::{Method, element_name, scheme_name};
use super::opponent::Guess;

/// The climb on one grid beside its opponents; times in s.
pub struct Row<'a> {
    pub climb: &'a Run,
    pub scheme: DifferenceScheme,
    /// Finite elements with the same nodes and equations: from the affine and from the nested guess.
    pub same_nodes: [&'a Run; 2],
    /// The cheapest finite elements that are as accurate, of all meshes, equal and graded, and all elements.
    pub equal_accuracy: [Option<&'a Run>; 2],
}

/// How much larger an error still counts as equal: as much as the iterations of the climb leave.
const EQUAL: f64 = 1.02;

const GUESSES: [Guess; 2] = [Guess::Affine, Guess::Nested];

impl<'a> Row<'a> {
    pub fn all(runs: &'a [Run]) -> Vec<Self> {
        let climbs = runs.iter().filter_map(|run| match run.method {
            Method::Climb(scheme) => Some((run, scheme)),
            _ => None,
        });
        climbs
            .map(|(run, scheme)| Self::new(runs, run, scheme))
            .collect()
    }

    fn new(runs: &'a [Run], climb: &'a Run, scheme: DifferenceScheme) -> Self {
        let here = |method: Method| {
            runs.iter()
                .find(|run| run.method == method && run.layout == climb.layout)
        };
        let elements = |guess: Guess| {
            let result = here(Method::FiniteElements(scheme, guess));
            result.expect("finite elements are measured on every grid")
        };
        let cheapest = |guess: Guess| {
            let as_accurate = runs.iter().filter(|run| {
                matches!(run.method, Method::FiniteElements(_, start) if start == guess)
                    && run.departure_percent <= EQUAL * climb.departure_percent
            });
            as_accurate.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
        };
        Self {
            climb,
            scheme,
            same_nodes: GUESSES.map(elements),
            equal_accuracy: GUESSES.map(cheapest),
        }
    }

    /// Time of finite elements at the same nodes over that of the climb.
    pub fn ratio_same_nodes(&self, guess: Guess) -> f64 {
        self.same_nodes[guess as usize].seconds / self.climb.seconds
    }

    /// Time of the cheapest finite elements of equal accuracy over that of the climb.
    pub fn ratio_equal_accuracy(&self, guess: Guess) -> f64 {
        let seconds = self.equal_accuracy[guess as usize].map_or(f64::NAN, |run| run.seconds);
        seconds / self.climb.seconds
    }

    /// Element and mesh of the finite elements of equal accuracy.
    fn equal_mesh(&self) -> String {
        match self.equal_accuracy[0].map(|run| (run.method, &run.layout)) {
            Some((Method::FiniteElements(scheme, _), layout)) => {
                format!("{} {layout}", element_name(scheme))
            }
            _ => "–".to_owned(),
        }
    }
}

/// A column of figures.
type Column = (&'static str, fn(&Row) -> f64);

const FIGURES: [Column; 14] = [
    ("departure_percent", |row| row.climb.departure_percent),
    ("force_percent", |row| row.climb.force_percent),
    ("seconds", |row| row.climb.seconds),
    ("finite_elements_seconds", |row| row.same_nodes[0].seconds),
    ("ratio_same_nodes", |row| {
        row.ratio_same_nodes(Guess::Affine)
    }),
    ("ratio_same_nodes_nested", |row| {
        row.ratio_same_nodes(Guess::Nested)
    }),
    ("equal_accuracy_force_percent", |row| {
        row.equal_accuracy[0].map_or(f64::NAN, |run| run.force_percent)
    }),
    ("ratio_equal_accuracy", |row| {
        row.ratio_equal_accuracy(Guess::Affine)
    }),
    ("ratio_equal_accuracy_nested", |row| {
        row.ratio_equal_accuracy(Guess::Nested)
    }),
    ("difference_to_direct_percent", |row| {
        row.climb.difference_percent
    }),
    ("bytes_per_node", |row| row.climb.bytes_per_node),
    ("finite_elements_bytes_per_node", |row| {
        row.same_nodes[0].bytes_per_node
    }),
    ("work_units", |row| row.climb.work_units),
    ("same_bits_as_one_thread", |row| {
        f64::from(u8::from(row.climb.same_bits))
    }),
];

/// What is printed and written.
pub fn columns<'a>(rows: &'a [Row]) -> Table<&'a Row<'a>> {
    let table = Table::of(rows)
        .column("nodes", |row| row.climb.nodes.to_string())
        .column("grid", |row| row.climb.layout.to_string())
        .column("scheme", |row| scheme_name(row.scheme).to_owned())
        .column("threads", |row| row.climb.threads.to_string())
        .column("equal_accuracy_mesh", |row| row.equal_mesh());
    FIGURES.iter().fold(table, |table, (head, figure)| {
        table.column(*head, |row| format!("{:.4e}", figure(row)))
    })
}

/// One run as soon as it is measured.
pub fn print_run(run: &Run) {
    println!(
        "{:>8} nodes  {:<12} {:<38} {} thread{}  {:>10.5} s  {:>2} iterations  departure {:.2e} %  force {:.6} N ({:.1e} %)",
        run.nodes,
        run.layout.to_string(),
        run.method.name(),
        run.threads,
        if run.threads == 1 { " " } else { "s" },
        run.seconds,
        run.iterations,
        run.departure_percent,
        run.force,
        run.force_percent,
    );
}

/// Time against nodes, on equal cells, and against error, on the best of all grids.
pub fn picture(runs: &[Run]) -> Result<Vec<u8>, output::PictureFault> {
    let equal = |run: &Run| run.layout.grading == 1.0;
    output::png(&Drawing::Charts(vec![
        chart(
            "Plate at 100 %, equal cells: time against nodes",
            "nodes",
            |method| {
                let chosen = runs.iter().filter(|run| run.is(method) && equal(run));
                chosen.map(|run| [run.nodes as f64, run.seconds]).collect()
            },
        ),
        chart(
            "Best of equal and graded grids: time against error",
            "departure from affine: error [%]",
            |method| {
                let chosen = best(runs, |run| run.is(method));
                chosen
                    .iter()
                    .map(|run| [run.departure_percent, run.seconds])
                    .collect()
            },
        ),
    ]))
}

fn chart(title: &str, x: &str, points: impl Fn(Method) -> Vec<[f64; 2]>) -> (LineChart, u32) {
    let methods = [
        Method::Climb(DifferenceScheme::Gauss),
        Method::Climb(DifferenceScheme::Biquadratic),
        Method::Climb(DifferenceScheme::Bicubic),
        Method::FiniteElements(DifferenceScheme::Gauss, Guess::Nested),
        Method::FiniteElements(DifferenceScheme::Biquadratic, Guess::Nested),
        Method::FiniteElements(DifferenceScheme::Bicubic, Guess::Nested),
    ];
    let line = |(method, colour): (&Method, &[u8; 3])| {
        Line::new(method.name(), points(*method), *colour, Stroke::Marked)
    };
    let lines = methods.iter().zip(&PALETTE).map(line).collect();
    let axes = [x, "time [s]"].map(Axis::logarithmic);
    let [x, y] = axes;
    (LineChart::new(title, x, y, lines), 480)
}

/// The runs that no other is both quicker and more accurate than, from the most accurate on.
pub fn best(runs: &[Run], of: impl Fn(&Run) -> bool) -> Vec<&Run> {
    let mut selected: Vec<&Run> = runs.iter().filter(|run| of(run)).collect();
    selected.sort_by(|a, b| a.departure_percent.total_cmp(&b.departure_percent));
    let mut quickest = f64::INFINITY;
    selected.retain(|run| {
        let quicker = run.seconds < quickest;
        quickest = quickest.min(run.seconds);
        quicker
    });
    selected
}
