//! The normal equations of a frame without its edges.

use nalgebra::{DMatrix, DVector};

use super::found::Step;
use crate::error::{Error, SolveFault};
use crate::estimation::equations::solve;
use crate::estimation::regression::NormalEquations;
use crate::statistics::inverse;

/// The least pivot of the edges' part of a matrix scaled to a unit diagonal.
const LEAST_PIVOT: f64 = 1e-8;

/// Where the law's parameters stand among all.
pub struct Order {
    /// Place of the first.
    pub first: usize,
    /// How many there are.
    pub law: usize,
    /// How many parameters there are at all.
    pub all: usize,
}

/// Normal equations with the law's parameters behind all others.
pub type Ordered = NormalEquations;

impl Order {
    fn places(&self) -> Vec<usize> {
        let law = self.first..self.first + self.law;
        let others = (0..self.all).filter(|place| !law.contains(place));
        others.chain(law.clone()).collect()
    }

    /// A matrix with its columns in that order.
    pub fn columns(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        matrix.select_columns(&self.places())
    }

    /// A vector in that order.
    pub fn rows(&self, vector: &DVector<f64>) -> DVector<f64> {
        vector.select_rows(&self.places())
    }

    /// Equations in that order.
    pub fn of(&self, equations: NormalEquations) -> Ordered {
        let places = self.places();
        NormalEquations {
            matrix: equations
                .matrix
                .select_columns(&places)
                .select_rows(&places),
            target: self.rows(&equations.target),
            ..equations
        }
    }
}

/// Normal equations without the edges.
pub struct Reduced {
    /// Sₖ.
    pub information: DMatrix<f64>,
    /// tₖ.
    pub score: Step,
    /// Qₖ.
    pub misfit: f64,
    /// (F − f)²/(σ² + s²): s is what noise leaves of the force.
    pub force_misfit: f64,
    /// M_θp M_pp⁻¹.
    follow: DMatrix<f64>,
}

impl Reduced {
    /// # Errors
    /// Where the data do not determine how the edges moved.
    pub fn new(equations: &Ordered, law: usize) -> Result<Self, Error> {
        let edges = equations.matrix.nrows() - law;
        let part = |row: usize, column: usize, shape: (usize, usize)| {
            equations.matrix.view((row, column), shape).into_owned()
        };
        let own = part(0, 0, (edges, edges));
        let mixed = part(edges, 0, (law, edges));
        let covariance = match edges {
            0 => own,
            _ => inverse(&own, LEAST_PIVOT).ok_or_else(|| solve(SolveFault::Singular))?,
        };
        let follow = &mixed * &covariance;
        let of_edges = equations.target.rows(0, edges);
        let force_misfit = equations.force_misfit - of_edges.dot(&(covariance * of_edges));
        Ok(Self {
            information: part(edges, edges, (law, law)) - &follow * mixed.transpose(),
            score: score(&follow, &equations.target),
            misfit: equations.misfit + force_misfit,
            force_misfit,
            follow,
        })
    }

    /// What another right-hand side makes of the score.
    pub fn score_of(&self, target: &DVector<f64>) -> Step {
        score(&self.follow, target)
    }

    /// [−M_θp M_pp⁻¹, 1] V [−M_θp M_pp⁻¹, 1]ᵀ.
    pub fn project(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let law = self.follow.nrows();
        let mut rows = -&self.follow;
        rows = rows.resize_horizontally(self.follow.ncols() + law, 0.0);
        (0..law).for_each(|index| rows[(index, self.follow.ncols() + index)] = 1.0);
        &rows * matrix * rows.transpose()
    }
}

/// t_θ − M_θp M_pp⁻¹ t_p.
fn score(follow: &DMatrix<f64>, target: &DVector<f64>) -> Step {
    let (law, edges) = follow.shape();
    target.rows(edges, law) - follow * target.rows(0, edges)
}
