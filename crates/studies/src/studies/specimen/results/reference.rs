//! The finite elements with which a specimen's other models are compared, and their own error.

use super::lattice::OnLattice;
use super::measured::Measured;
use crate::compare::percent_at_all_nodes;
use crate::finite_element::convergence::{
    LOWEST_ORDER, at_most_of_order, corner_exponent, of_distances, richardson,
};
use crate::finite_element::error_estimate::ErrorEstimate;
use crate::mesh::{Mesh, REENTRANT};
use crate::problem::Solution;
use crate::results::Block;
use crate::statistics::larger;
use crate::studies::specimen::problem::Specimen;

/// The finest finite elements.
pub struct Reference {
    /// On the finest mesh.
    pub finest: Solution,
    /// The quantity that is compared in all models.
    pub measured: Measured,
    /// One a load factor; `None` where the tangent of that state gives none.
    pub estimates: Vec<Option<ErrorEstimate>>,
    /// On up to two coarser meshes, from coarse to fine.
    pub coarser: Vec<Solution>,
    /// Whether the meshes are a plate's grids, whose grading towards the corners lets three of them show the order that they have.
    pub(super) on_grids: bool,
    /// The rounds of local refinement; none where the meshes are halved.
    pub(super) rounds: Vec<Round>,
    /// Of local refinement with all cells of the last mesh halved, where these are not too many.
    pub(super) all_halved: Option<Solution>,
    /// The changes by the curves that a file's edges approximate, at each load factor; `None` where there are no such edges.
    pub(super) outline: Option<Vec<OutlineChange>>,
    /// The displacement's own error at each load factor without that of the outline, in relative L2 in %: at the nodes of the corrected field, and at all of
    /// the finest mesh.
    pub(super) displacement: Vec<Option<f64>>,
    pub(super) of_all_nodes: Vec<Option<f64>>,
}

/// The changes by the curves that a file's edges approximate, at a load factor.
pub struct OutlineChange {
    /// Of what is measured, in its unit.
    pub measured: f64,
    /// Of the displacement at the nodes of the corrected field, in relative L2 in %.
    pub displacement_percent: f64,
}

/// One mesh of local refinement, with its errors at the worst load factor.
pub struct Round {
    pub cells: usize,
    pub nodes: usize,
    /// Estimated error of the field in the energy norm in %; not a number where it is not known of all load factors.
    pub energy_percent: f64,
    /// Estimated error of what is measured in %.
    pub measured_percent: f64,
}

impl Reference {
    /// No finite elements, of a study that leaves them out: what is measured follows from the other models.
    pub fn left_out(specimen: &Specimen, on_lattice: &OnLattice) -> Self {
        let models = [&on_lattice.corrected, &on_lattice.uncorrected];
        let solved = models
            .into_iter()
            .find_map(|solution| Some((&solution.mesh, solution.last_groups()?)));
        Self {
            finest: Solution::empty(specimen.outline.coarse()),
            measured: match solved {
                Some((mesh, groups)) => specimen.measured(mesh, groups),
                None => specimen.measured_at_rest(),
            },
            estimates: Vec::new(),
            coarser: Vec::new(),
            on_grids: specimen.grids().is_some(),
            rounds: Vec::new(),
            all_halved: None,
            outline: None,
            displacement: Vec::new(),
            of_all_nodes: Vec::new(),
        }
    }

    /// How many load factors the finest mesh has reached.
    pub fn reached(&self) -> usize {
        self.finest.reached()
    }

    /// `Q2 elements on 48 × 16 cells, the finest of three meshes`, for reports.
    pub fn describe(&self) -> String {
        let (elements, cells) = (
            self.finest.mesh.element_names(),
            self.finest.mesh.describe(),
        );
        match self.rounds.len() {
            0 => {
                let others = [
                    "",
                    ", the finer of two meshes",
                    ", the finest of three meshes",
                ];
                format!(
                    "{elements} elements on {cells}{}",
                    others[self.coarser.len()]
                )
            }
            1 => format!("{elements} elements on {cells}, not refined locally"),
            rounds => format!(
                "{elements} elements on {cells}, refined locally in {} rounds",
                rounds - 1
            ),
        }
    }

    /// How the finite elements of a specimen become more accurate.
    pub fn remedy(&self, specimen: &Specimen) -> &'static str {
        let (problem, mesh) = (&specimen.problem, &self.finest.mesh);
        if !problem.forces_on_points(mesh).is_empty() || !problem.moved_points(mesh).is_empty() {
            return "results at single points do not converge with the mesh: load or move edges, a line or an area";
        }
        if self.is_outline() {
            return "take a mesh whose edges follow the curves: cells of the second degree, or finer ones there";
        }
        let is_shorter = |halved: &Solution| halved.reached() < self.reached();
        if self.all_halved.as_ref().is_some_and(is_shorter) {
            return "the mesh with all cells halved, by which it is judged, has no solution at some load factor: take a larger \
                    `finite_element.error`, or load factors that are closer together";
        }
        if specimen.grids().is_some() {
            return "take finer `finite_element.cells`, or a `finite_element.grading` near 2";
        }
        let quadratic = self.finest.mesh.shape(0).degree() == 2;
        match (self.rounds.is_empty(), quadratic) {
            (true, false) => "take finite elements of the second degree, such as \"Q2\"",
            (true, true) => "take more cells, or `adaptive = true` with \"T2\"",
            (false, _) if self.all_halved.is_none() => {
                "take fewer than 100,000 cells, with a larger `finite_element.error` or fewer `most_cells`"
            }
            (false, _) => "take a smaller `finite_element.error`",
        }
    }

    /// The own error of what is measured at a load factor in %: the larger of those by three meshes, whose differences may be small by
    /// chance, and by recovery, with that of a file's outline; on a plate's grids by three meshes alone where they converge. `None` where it
    /// is not known.
    pub fn measured_percent(&self, step: usize) -> Option<f64> {
        let by_meshes = self.three_meshes_percent(step);
        if self.on_grids && self.converge(step) {
            return by_meshes;
        }
        let known = by_meshes.into_iter().chain(self.recovered_percent(step));
        let error = known.reduce(larger)?;
        match self.outline {
            Some(_) => Some(error + self.outline_percent(step)?),
            None => Some(error),
        }
    }

    /// Whether what is measured is negligible at a load factor, so that it has no relative error.
    fn is_negligible(&self, step: usize) -> bool {
        self.measured
            .negligible_beside(&self.finest, step)
            .is_some()
    }

    /// The change of what is measured by the curves that a file's edges approximate, at a load factor in %.
    fn outline_percent(&self, step: usize) -> Option<f64> {
        if self.is_negligible(step) {
            return Some(0.0);
        }
        let change = self.outline.as_ref()?.get(step)?.measured;
        let measured = self.measured.at(&self.finest, step)?;
        Some(100.0 * (change / measured).abs())
    }

    /// Whether most of the own error is that of a file's outline, which more cells leave as it is.
    fn is_outline(&self) -> bool {
        let mut changes = self.outline.iter().flatten().enumerate();
        let most =
            |change: f64, error: Option<f64>| error.is_some_and(|error| change > 0.5 * error);
        let is_most = |(step, change): (usize, &OutlineChange)| {
            let of_measured = self.outline_percent(step).unwrap_or(0.0);
            most(change.displacement_percent, self.displacement_percent(step))
                || most(of_measured, self.measured_percent(step))
        };
        changes.any(is_most)
    }

    /// A note on a file's outline.
    pub(super) fn outline_note(&self) -> Option<Block> {
        let steps = 0..self.outline.as_ref()?.len();
        let percents = steps.filter_map(|step| self.outline_percent(step));
        let most = percents.reduce(larger)?;
        Some(Block::Paragraph(format!(
            "The outline: finite elements on meshes of the file have its edges, which are chords or parabolas. With the smooth curves that these \
             approximate, the {} would change by about {most:.2e} %; this is included in its own error.",
            self.measured.name()
        )))
    }

    /// The error of what is measured by three meshes at a load factor in %, where there are three.
    pub fn three_meshes_percent(&self, step: usize) -> Option<f64> {
        if self.coarser.len() != 2 || !self.rounds.is_empty() {
            return None;
        }
        if self.is_negligible(step) {
            return Some(0.0);
        }
        let values @ [_, middle, fine] = self.on_three_meshes(step)?;
        let estimate = richardson(values);
        let last = 100.0 * ((fine - middle) / estimate.extrapolated).abs();
        Some(self.beside_corners(estimate.error_percent, last))
    }

    /// Whether three meshes show an order at a load factor.
    fn converge(&self, step: usize) -> bool {
        let values = self.on_three_meshes(step);
        values.is_some_and(|values| richardson(values).order.is_some())
    }

    /// What is measured on three meshes at a load factor, from coarse to fine; `None` where there are not three.
    fn on_three_meshes(&self, step: usize) -> Option<[f64; 3]> {
        let all = self.coarser.iter().chain([&self.finest]);
        let all: Option<Vec<f64>> = all.map(|one| self.measured.at(one, step)).collect();
        all?.try_into().ok()
    }

    /// An error that is at least the one which the distance of the two finest meshes gives with the low order of convergence at re-entrant corners,
    /// whatever order the coarse meshes show.
    fn beside_corners(&self, error: f64, last: f64) -> f64 {
        match self.finest.mesh.largest_angle() {
            angle if angle > REENTRANT => {
                at_most_of_order(error, last, 2.0 * corner_exponent(angle))
            }
            _ => error,
        }
    }

    /// The error of what is measured by recovery at a load factor in %.
    pub fn recovered_percent(&self, step: usize) -> Option<f64> {
        if self.is_negligible(step) {
            return Some(0.0);
        }
        let estimate = self.estimates.get(step)?.as_ref()?;
        let measured = self.measured.at(&self.finest, step)?;
        Some(100.0 * (estimate.force / measured).abs())
    }

    /// The error of the field by recovery in the energy norm at a load factor in %.
    pub fn energy_percent(&self, step: usize) -> Option<f64> {
        let estimate = self.estimates.get(step)?.as_ref()?;
        Some(estimate.energy.percent())
    }

    /// The error of the displacement at the nodes of the corrected field at a load factor in relative L2 in %, with that of a file's outline, by which
    /// deviations there are judged; `None` where it is not known.
    pub fn displacement_percent(&self, step: usize) -> Option<f64> {
        self.with_outline(step, *self.displacement.get(step)?)
    }

    /// The same of the field as a whole: the larger of the errors at the nodes of the corrected field, which are nodes of several meshes, where
    /// quadratic elements are more exact than elsewhere, and at all nodes of the finest mesh, where coarser meshes show too high an order beside
    /// corners.
    pub fn field_percent(&self, step: usize) -> Option<f64> {
        let on_lattice = (*self.displacement.get(step)?)?;
        let of_all = (*self.of_all_nodes.get(step)?)?;
        self.with_outline(step, Some(larger(on_lattice, of_all)))
    }

    /// An error of the displacement with that of a file's outline.
    fn with_outline(&self, step: usize, error: Option<f64>) -> Option<f64> {
        match &self.outline {
            Some(changes) => Some(error? + changes.get(step)?.displacement_percent),
            None => error,
        }
    }

    /// The error of the displacement at each load factor at the nodes of a mesh, without that of a file's outline.
    pub(super) fn errors_at(&self, at: &Mesh) -> Vec<Option<f64>> {
        let is_refined = !self.rounds.is_empty();
        let others: Vec<&Solution> = if is_refined {
            self.all_halved.iter().collect()
        } else {
            self.coarser.iter().collect()
        };
        let all = others.into_iter().chain([&self.finest]);
        let on_nodes: Vec<_> = all
            .map(|solution| (solution, solution.mesh.interpolation_on(at)))
            .collect();
        let error = |step: usize| {
            let fields = on_nodes.iter().filter_map(|(solution, interpolation)| {
                Some(interpolation.apply(solution.displacement(step)?))
            });
            let fields: Vec<Vec<f64>> = fields.collect();
            let distance = |u: &[f64], v: &[f64]| percent_at_all_nodes(at, u, v);
            match &fields[..] {
                [halved, finest] if is_refined => Some(self.by_halving(distance(finest, halved))),
                [only, fine] => Some(distance(only, fine)),
                [first, second, fine] => {
                    Some(self.by_coarser(step, distance(first, second), distance(second, fine)))
                }
                _ => None,
            }
        };
        (0..self.finest.reached()).map(error).collect()
    }

    /// The error from the distances in % of meshes a quarter, half and as fine, see [`of_distances`], times [`Self::underestimation`]; at most that
    /// of an order of ½.
    fn by_coarser(&self, step: usize, before: f64, last: f64) -> f64 {
        let by_meshes = self.beside_corners(of_distances(before, last).0, last);
        let most = (last / (LOWEST_ORDER.exp2() - 1.0)).max(by_meshes);
        (by_meshes * self.underestimation(step)).min(most)
    }

    /// The error from the distance in % to the mesh with all cells halved, whose own error is between 2⁻ᵖ⁻¹ of it, where the solution is smooth, and
    /// a half, beside corners:
    ///
    /// ```text
    /// e = ‖u½ − u‖/(1 − 2⁻ᵖ)          p: degree of the elements
    /// ```
    ///
    /// Two meshes of local refinement do not show it: most of their cells are the same.
    fn by_halving(&self, distance: f64) -> f64 {
        let remainder = 0.5_f64.powi(self.finest.mesh.shape(0).degree() as i32);
        distance / (1.0 - remainder)
    }

    /// The error of what is measured by recovery over that by three meshes, at least 1: where a support ends within an edge, coarse cells show too
    /// high an order, of the displacement as well as of the force.
    fn underestimation(&self, step: usize) -> f64 {
        if self.on_grids && self.converge(step) {
            return 1.0;
        }
        let pair = self
            .recovered_percent(step)
            .zip(self.three_meshes_percent(step));
        let ratio = pair.map_or(1.0, |(recovered, by_meshes)| recovered / by_meshes);
        if ratio.is_finite() {
            ratio.max(1.0)
        } else {
            1.0
        }
    }
}
