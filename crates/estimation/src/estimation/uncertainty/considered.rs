//! The errors of a field due to parameters that the equations take as known: those of the law, as far as its card records their
//! uncertainty, and the distances of free edges ([`super::unknown_edges`]).
//!
//! ```text
//! sₖ = ∂u/∂cₖ = −K⁻¹ ∂F/∂cₖ
//! M Dₖ = −AᵀWHsₖ/v − Gᵀ∂f/∂cₖ/σ                  the response of the regression, which does not estimate c
//!
//! Cov(p, c) = [C + DΣDᵀ, DΣ; ΣDᵀ, Σ],   ∂u/∂(p, c) = [S, s]
//! ```
//!
//! with A, W, v, G, M of [`crate::estimation::regression`], Σ the covariance of c, and f the measured forces. The field remains
//! the one with the parameters as they are given: they are considered, but not estimated (Schmidt), so that data with little information on
//! them do not move the field. The information of the data r on the distances of edges changes Σ, whose entries are mean products about zero:
//!
//! ```text
//! J = Σ₀⁻¹ + (Hs)ᵀV(Hs) − (Hs)ᵀVA M⁻¹ AᵀV(Hs),   d = J⁻¹ (Hs)ᵀVr,   Σ = J⁻¹ + ddᵀ      Σ₀ before the data, V = W/v
//! ```
//!
//! # References
//! S. F. Schmidt, Adv. Control Syst. 3, 293 (1966), doi:10.1016/B978-1-4831-6716-9.50011-4

use std::ops::AddAssign;

use nalgebra::{DMatrix, DMatrixView, DVector};

use crate::error::Error;
use crate::estimation::equations::solve;
use crate::estimation::search::NearestField;
use crate::solve::vector::dot;

/// Parameters that are considered: those of the law, then the distances of edges.
pub struct Considered {
    /// ∂F/∂cₖ.
    slopes: Vec<Vec<f64>>,
    /// The number of the law's parameters.
    of_law: usize,
    /// The edge of each distance.
    edges: Vec<usize>,
    /// sₖ.
    changes: Vec<Vec<f64>>,
    /// D.
    responses: DMatrix<f64>,
    /// Σ.
    squares: DMatrix<f64>,
}

impl NearestField<'_> {
    /// The parameters that are considered; must be called before the covariance includes the noise found, because it has to be M⁻¹.
    pub(in crate::estimation) fn considered(&mut self) -> Result<Considered, Error> {
        let law = self.equations.task.knowledge.uncertain_law();
        let neighbours = law.map_or(Vec::new(), |law| law.neighbours());
        let slopes = self.equations.slopes_between(neighbours, &self.field)?;
        let (strips, of_edges) = self.edge_strips();
        let (edges, strips): (Vec<usize>, Vec<_>) = strips.into_iter().unzip();
        let (of_law, all) = (slopes.len(), slopes.len() + strips.len());
        let mut squares = DMatrix::zeros(all, all);
        if let Some(law) = law {
            let mut by_law = squares.view_range_mut(..of_law, ..of_law);
            by_law.copy_from(law.covariance());
        }
        let forces = [slopes, strips].concat();
        let tangent = &mut self.equations.newton.tangent;
        let changes = tangent.changes(&forces).map_err(solve)?;
        let mut responses = DMatrix::zeros(self.fit.covariance.nrows(), all);
        for (index, (change, force)) in changes.iter().zip(&forces).enumerate() {
            let target = self.target(change, force)?;
            responses.set_column(index, &(&self.fit.covariance * target));
        }
        let of_edges = self.given_the_data(
            of_edges,
            &changes[of_law..],
            &responses.columns_range(of_law..),
        );
        squares
            .view_range_mut(of_law.., of_law..)
            .copy_from(&of_edges);
        Ok(Considered {
            slopes: forces,
            of_law,
            edges,
            changes,
            responses,
            squares,
        })
    }

    /// The mean products of the distances given the data, from those before the data; unchanged where there is no distance or a matrix is singular.
    fn given_the_data(
        &self,
        before: DMatrix<f64>,
        changes: &[Vec<f64>],
        responses: &DMatrixView<f64>,
    ) -> DMatrix<f64> {
        let Some(factor) = before.clone().cholesky().filter(|_| !changes.is_empty()) else {
            return before;
        };
        let interpolation = &self.observations().interpolation;
        let columns = changes
            .iter()
            .map(|change| DVector::from_vec(interpolation.multiply(change)));
        let at_markers = DMatrix::from_columns(&columns.collect::<Vec<_>>());
        let target_of = |displacements: &[f64], design: &DMatrix<f64>| {
            self.equations
                .target_of(displacements, design, &self.variances)
        };
        let mut information = factor.inverse();
        for (index, column) in at_markers.column_iter().enumerate() {
            let column = column.as_slice();
            let by_field = responses.tr_mul(&target_of(column, &self.linear.design));
            let added = -target_of(column, &at_markers) - by_field;
            information.column_mut(index).add_assign(&added);
        }
        let slope = -target_of(self.fit.residual.as_slice(), &at_markers);
        information.cholesky().map_or(before, |factor| {
            let best = factor.solve(&slope);
            factor.inverse() + &best * best.transpose()
        })
    }

    /// −AᵀWHs/v − Gᵀ∂f/∂c/σ of one parameter.
    fn target(&self, change: &[f64], force: &[f64]) -> Result<DVector<f64>, Error> {
        let observations = self.observations();
        let at_markers = observations.interpolation.multiply(change);
        let equations = &self.equations;
        let measured = equations.task.knowledge.measured_forces().iter();
        let forces = measured.map(|measured| {
            let grip = equations.grip_of_edge(measured, &self.field)?;
            Ok(dot(&grip.gradient, change) + dot(&grip.factors, force))
        });
        let forces = forces.collect::<Result<Vec<f64>, Error>>()?;
        Ok(equations.target_with_forces(&at_markers, &forces, &self.linear, &self.variances))
    }

    /// The standard errors of the bodies' forces along x and y in N due to the law's parameters, empty where none is considered, and due to
    /// all considered parameters. Neither includes a distance that all points of an edge have in common, which only increases forces.
    pub(in crate::estimation) fn force_deviations(
        &self,
        considered: &Considered,
    ) -> Result<[Vec<[f64; 2]>; 2], Error> {
        let of_law = considered.of_law;
        let along = |body: usize, axis: usize| -> Result<[f64; 2], Error> {
            let (grip, row) = self.grip_of(body, axis, &[])?;
            let slope = |index: usize, _| {
                let direct = dot(&grip.factors, &considered.slopes[index])
                    + dot(&grip.gradient, &considered.changes[index]);
                direct + dot(&row, considered.responses.column(index).as_slice())
            };
            let mut slopes = DVector::from_fn(considered.slopes.len(), slope);
            if self.equations.task.knowledge.edge_gap.is_some() {
                subtract_means(&mut slopes.as_mut_slice()[of_law..], &considered.edges);
            }
            let squares = &considered.squares;
            let deviation = |slopes: &DVector<f64>| slopes.dot(&(squares * slopes)).max(0.0).sqrt();
            let all = deviation(&slopes);
            slopes.rows_range_mut(of_law..).fill(0.0);
            Ok([deviation(&slopes), all])
        };
        let deviations = self.by_body(along)?;
        let [by_law, by_all] = [0, 1].map(|which| {
            let each = deviations.iter();
            each.map(|both| both.map(|one| one[which])).collect()
        });
        Ok([if of_law > 0 { by_law } else { Vec::new() }, by_all])
    }

    /// Appends the considered parameters to those of the field.
    pub(in crate::estimation) fn consider(&mut self, considered: Considered) {
        let (responses, squares) = (&considered.responses, &considered.squares);
        let before = responses.nrows();
        let across = responses * squares;
        let of_field = &self.fit.covariance + &across * responses.transpose();
        let all = before + responses.ncols();
        let joined = DMatrix::from_fn(all, all, |i, j| match (i < before, j < before) {
            (true, true) => of_field[(i, j)],
            (true, false) => across[(i, j - before)],
            (false, true) => across[(j, i - before)],
            (false, false) => squares[(i - before, j - before)],
        });
        self.fit.covariance = joined;
        self.linear.sensitivities.extend(considered.changes);
    }
}

fn subtract_means(values: &mut [f64], edges: &[usize]) {
    let mut first = 0;
    for run in edges.chunk_by(|a, b| a == b) {
        let of_edge = &mut values[first..first + run.len()];
        let mean = of_edge.iter().sum::<f64>() / run.len() as f64;
        of_edge.iter_mut().for_each(|value| *value -= mean);
        first += run.len();
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::estimation::tests::{Truth, estimate_on, measured_force, right, with_grips};
    use crate::estimation::{EdgeCondition, FieldEstimate, Knowledge, MeasuredForce, UncertainLaw};
    use crate::material::Card;
    use crate::mesh::{CellShape, Mesh};

    /// The card of the plate's material with a recorded deviation of 3 %.
    fn recorded() -> Option<UncertainLaw> {
        let text = Card::load("neo-hooke", Path::new(".")).unwrap().text
            + "[fit]\ndata = [\"own.csv\"]\nweighting = \"absolute\"\nstarts = 1\n\
               parameters = [\"c10\"]\nstandard_deviations = [0.0015]\ncorrelations = []\n";
        UncertainLaw::of_card(&Card::parse("own", "own.toml", &text).unwrap())
    }

    #[test]
    fn intervals_hold_what_the_card_records_of_its_stiffness_unless_a_force_is_measured() {
        let (truth, mesh) = (
            Truth::new(),
            Mesh::plate([60.0, 30.0], [10, 6], CellShape::Quad9),
        );
        let of = |uncertain_law: Option<UncertainLaw>, forces: Vec<MeasuredForce>| {
            let knowledge = Knowledge {
                uncertain_law,
                forces,
                ..with_grips(EdgeCondition::Rigid)
            };
            estimate_on(&mesh, &truth.markers(0.1, 1), &knowledge)
        };
        let [plain, uncertain] = [of(None, Vec::new()), of(recorded(), Vec::new())];
        let index = right(&uncertain);
        let [before, after] = [&plain, &uncertain].map(|result| result.forces[index].force[0]);
        assert!(plain.is_given_the_law && plain.law_deviations.is_empty());
        // The force is proportional to the only parameter.
        let deviation = uncertain.law_deviations[index][0];
        assert!(
            (deviation / (0.03 * after.value) - 1.0).abs() < 1e-3,
            "{deviation}"
        );
        let wide = before.standard_error.hypot(deviation);
        assert!(before.value == after.value && (after.standard_error / wide - 1.0).abs() < 1e-9);
        let stress = |result: &FieldEstimate| {
            let middle = result.cells[result.cells.len() / 2];
            (
                middle.first_piola_kirchhoff_stress[0],
                middle.stress_error[0],
            )
        };
        let ((value, narrow), (_, wide)) = (stress(&plain), stress(&uncertain));
        assert!(
            (wide / narrow.hypot(0.03 * value) - 1.0).abs() < 1e-2,
            "{narrow} {wide}"
        );
        let measured = measured_force(truth.force, 0.001 * truth.force);
        assert!(!of(recorded(), vec![measured]).is_given_the_law);
    }
}
