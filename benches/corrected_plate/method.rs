//! Ways to the field, each from nothing but the problem, with their times.

use std::fmt;
use std::time::Instant;

use gelbench::corrector::DifferenceScheme;
use gelbench::corrector::climb::{Climb, ClimbSettings};
use gelbench::error::Error;
use gelbench::problem::ClampedPlate;
use gelbench_corrector::corrector::climb::{Field, Grid};

use super::opponent::{Guess, Opponent};

/// A grid of nodes: its cells along X and Y, and how they become smaller towards the corners; 1 where they are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    pub cells: [usize; 2],
    pub grading: f64,
}

impl Layout {
    /// Equal cells.
    pub fn equal(cells: [usize; 2]) -> Self {
        Self {
            cells,
            grading: 1.0,
        }
    }

    /// Whether a scheme can take its cells together.
    pub fn suits(self, scheme: DifferenceScheme) -> bool {
        self.cells.iter().all(|n| n.is_multiple_of(scheme.side()))
    }

    /// Half as many elements of so many cells a side along both axes, graded in the same way; nothing where their number is odd.
    pub fn halved(self, side: usize) -> Option<Self> {
        let halves = self.cells.iter().all(|n| n.is_multiple_of(2 * side));
        halves.then_some(Self {
            cells: self.cells.map(|n| n / 2),
            ..self
        })
    }

    /// The grid of a plate whose elements have so many cells a side.
    pub fn grid(self, size: [f64; 2], side: usize) -> Grid {
        let elements = self.cells.map(|n| n / side);
        let boundaries = Grid::graded(size, elements, self.grading).coordinates;
        Grid::new(boundaries.each_ref().map(|positions| &positions[..]), side)
    }
}

impl fmt::Display for Layout {
    /// `240x80`, and `240x80^1.5` where the cells are graded.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.cells;
        write!(f, "{x}x{y}")?;
        if self.grading == 1.0 {
            Ok(())
        } else {
            write!(f, "^{}", self.grading)
        }
    }
}

/// A way to the field at one stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Springs and climb.
    Climb(DifferenceScheme),
    /// Finite elements with the equations of a scheme.
    FiniteElements(DifferenceScheme, Guess),
}

impl Method {
    pub fn name(self) -> String {
        match self {
            Self::Climb(scheme) => format!("climb, {}", scheme_name(scheme)),
            Self::FiniteElements(scheme, guess) => format!(
                "finite elements {}, {} guess",
                element_name(scheme),
                guess.name()
            ),
        }
    }
}

pub fn scheme_name(scheme: DifferenceScheme) -> &'static str {
    let named = DifferenceScheme::NAMES
        .iter()
        .find(|(_, candidate)| *candidate == scheme);
    named.expect("a scheme of the table").0
}

/// The name of the finite elements with the same equations.
pub fn element_name(scheme: DifferenceScheme) -> &'static str {
    ["Q1", "Q2", "Q3"][scheme.side() - 1]
}

/// What a way came to.
pub struct Solution {
    pub grid: Grid,
    pub field: Field,
    pub force: f64,
    /// From the problem to field and force, grids, meshes and analysis included, in s.
    pub seconds: f64,
    /// Newton iterations on the finest mesh, or cycles on the finest grid.
    pub iterations: usize,
    /// Time of one evaluation of F on the finest grid in s.
    pub evaluation: f64,
}

/// Evaluations of F that are timed, of which the shortest counts.
const EVALUATIONS: usize = 3;

/// Goes one way. `error` is the mesh's own error relative to the departure from the affine stretch, which tells the
/// finite elements when to stop; the climb finds it out for itself.
pub fn go(
    method: Method,
    problem: &ClampedPlate,
    layout: Layout,
    stretch: f64,
    error: f64,
) -> Result<Solution, Error> {
    let start = Instant::now();
    let scheme = match method {
        Method::FiniteElements(scheme, guess) => {
            let mut opponent = Opponent::new(problem, layout, scheme);
            let mut u = opponent.start(guess, stretch, error);
            let iterations = opponent.solve(&mut u, stretch, error);
            let force = opponent.force(&u);
            let seconds = start.elapsed().as_secs_f64();
            return Ok(Solution {
                field: Field::of_nodes(&opponent.grid, &u),
                grid: opponent.grid,
                force,
                seconds,
                iterations,
                evaluation: f64::NAN,
            });
        }
        Method::Climb(scheme) => scheme,
    };
    let settings = ClimbSettings::FAST;
    let mut climb = if layout.grading == 1.0 {
        Climb::even(problem, layout.cells, scheme, settings)
    } else {
        Climb::graded(problem, layout.cells, scheme, layout.grading, settings)
    };
    let climbed = climb.correct(stretch)?;
    let seconds = start.elapsed().as_secs_f64();
    let evaluations = (0..EVALUATIONS).map(|_| {
        let start = Instant::now();
        assert!(climb.forces(&climbed.field).is_some(), "admissible fields");
        start.elapsed().as_secs_f64()
    });
    let evaluation = evaluations.fold(f64::INFINITY, f64::min);
    Ok(Solution {
        grid: climb.grid().clone(),
        force: climbed.force,
        iterations: climbed.corrections.len(),
        field: climbed.field,
        seconds,
        evaluation,
    })
}
