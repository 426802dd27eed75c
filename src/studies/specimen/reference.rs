//! The finite elements that a specimen's other models are held to, and their own error.

use super::end::{End, last_groups};
use super::measured::Measured;
use super::paths::solve;
use super::read::{Refinement, Specimen};
use super::solved::Solved;
use crate::compare::area_weighted_percent;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::finite_element::error_estimate::{self, ErrorEstimate, bulk};
use crate::finite_element::recovery::Recovery;
use crate::mesh::Mesh;
use crate::problem::Model;
use crate::results::Block;
use crate::results::{Check, Wanted};

/// The part of the squared error that is refined in a round.
const SHARE: f64 = 0.5;

/// Cells up to which the finite elements are refined once more where they are too coarse to judge.
const MOST_CELLS: usize = 30_000;

/// Begin of the names of the files of the meshes, from coarse to fine.
const FILES: [&str; 3] = ["finite_element_coarse", "finite_element_middle", FILE];
const FILE: &str = "finite_element";

/// A mesh and its solutions, as far as they go.
pub struct OnMesh {
    pub mesh: Mesh,
    pub solved: Solved,
}

/// The finest finite elements.
pub struct Reference {
    pub mesh: Mesh,
    pub solved: Solved,
    /// What is compared of all models.
    pub measured: Measured,
    /// One a load factor; `None` where the tangent of that state gives none.
    pub estimates: Vec<Option<ErrorEstimate>>,
    /// Up to two coarser meshes, from coarse to fine.
    coarser: Vec<OnMesh>,
    /// The rounds of local refinement; none where the meshes are halved.
    rounds: Vec<Round>,
    /// What the curves that a file's edges stand for change in what is measured at each load factor; `None` where there
    /// are no such edges.
    outline: Option<Vec<f64>>,
}

/// One mesh of local refinement, with its errors at the worst load factor.
struct Round {
    cells: usize,
    nodes: usize,
    energy_percent: f64,
    measured_percent: f64,
}

impl Reference {
    /// Solves the specimen on three meshes, or on as many as the goal of local refinement takes.
    pub fn solve(specimen: &Specimen, ends: &mut Vec<End>) -> Result<Self, Error> {
        match specimen.refinement {
            Some(goal) => Self::adaptive(specimen, goal, ends),
            None => Self::halved(specimen, ends),
        }
    }

    fn halved(specimen: &Specimen, ends: &mut Vec<End>) -> Result<Self, Error> {
        let meshes = specimen.outline.reference_meshes();
        let meshes = meshes.into_iter().zip(FILES);
        let solved = meshes.map(|(mesh, file)| OnMesh::solve(specimen, mesh, file, ends));
        let solved = solved.collect::<Result<Vec<_>, _>>()?;
        Self::of_meshes(specimen, solved, Vec::new(), ends)
    }

    /// The reference on the last of some meshes.
    fn of_meshes(
        specimen: &Specimen,
        mut meshes: Vec<OnMesh>,
        rounds: Vec<Round>,
        ends: &[End],
    ) -> Result<Self, Error> {
        let OnMesh { mesh, solved } = meshes.pop().expect("a mesh at least");
        let measured = measured(specimen, &mesh, &solved, ends);
        let estimates = estimate_all(specimen, &mesh, &solved, &measured)?;
        Ok(Self {
            mesh,
            solved,
            estimates,
            outline: outline_errors(specimen, &measured, meshes.last())?,
            measured,
            coarser: meshes,
            rounds,
        })
    }

    /// Whether one more halving of the cells is possible and not too much work.
    pub fn may_be_finer(&self, specimen: &Specimen) -> bool {
        specimen.outline.is_shape()
            && self.rounds.is_empty()
            && self.reached() == specimen.factors.len()
            && 4 * self.mesh.cell_count() <= MOST_CELLS
    }

    /// The reference with cells of half the size: the two finer ones of its meshes, and one more.
    ///
    /// # Errors
    /// [`Error::Input`] when a group of the mesh cannot be held or loaded as the study says.
    pub fn finer(mut self, specimen: &Specimen, ends: &mut Vec<End>) -> Result<Self, Error> {
        let mesh = specimen.outline.reference_mesh(3);
        let finest = OnMesh::solve(specimen, mesh, FILE, ends)?;
        let mut meshes = self.coarser.split_off(self.coarser.len() - 1);
        let (mesh, solved) = (self.mesh, self.solved);
        meshes.extend([OnMesh { mesh, solved }, finest]);
        Self::of_meshes(specimen, meshes, Vec::new(), ends)
    }

    fn adaptive(specimen: &Specimen, goal: Refinement, ends: &mut Vec<End>) -> Result<Self, Error> {
        let mut triangles = specimen.outline.first_triangles();
        let (mut rounds, mut meshes) = (Vec::new(), Vec::new());
        let ends_before = ends.len();
        loop {
            // A finer mesh may reach what a coarser one did not.
            ends.truncate(ends_before);
            let mesh = specimen.outline.elements_on(&triangles);
            let OnMesh { mesh, solved } = OnMesh::solve(specimen, mesh, FILE, ends)?;
            let measured = measured(specimen, &mesh, &solved, ends);
            let estimates = estimate_all(specimen, &mesh, &solved, &measured)?;
            rounds.push(Round::of(&mesh, &solved, &measured, &estimates));
            let reached = rounds[rounds.len() - 1].energy_percent <= goal.error_percent;
            // The error of the displacement takes two meshes.
            let done = estimates.iter().all(Option::is_none) || reached && rounds.len() > 1;
            let finer = || {
                let marked = bulk(&indicators(mesh.cell_count(), &estimates), SHARE);
                specimen.outline.fitted(triangles.refined_where(&marked))
            };
            let next = (!done).then(finer);
            match next.filter(|next| next.cell_count() <= goal.most_cells) {
                Some(next) => {
                    triangles = next;
                    meshes.push(OnMesh { mesh, solved });
                }
                None => {
                    let coarser = meshes.split_off(meshes.len().saturating_sub(2));
                    return Ok(Self {
                        mesh,
                        solved,
                        outline: outline_errors(specimen, &measured, None)?,
                        measured,
                        estimates,
                        coarser,
                        rounds,
                    });
                }
            }
        }
    }

    /// How many load factors the finest mesh has reached.
    pub fn reached(&self) -> usize {
        self.solved.reached()
    }

    /// `Q2 elements on 48 × 16 cells, the finest of three meshes`, for reports.
    pub fn describe(&self) -> String {
        let (elements, cells) = (self.mesh.element_names(), self.mesh.describe());
        match self.rounds.len() {
            0 => format!("{elements} elements on {cells}, the finest of three meshes"),
            rounds => format!(
                "{elements} elements on {cells}, refined locally in {} rounds",
                rounds - 1
            ),
        }
    }

    /// How the finite elements become better.
    pub fn remedy(&self) -> &'static str {
        let quadratic = self.mesh.shape(0).degree() == 2;
        match (self.rounds.is_empty(), quadratic) {
            (true, false) => "take finite elements of the second degree, such as \"Q2\"",
            (true, true) => "take more cells, or `adaptive = true` with \"T2\"",
            (false, _) => "take a smaller `finite_element.error`",
        }
    }

    /// The own error of what is measured at a load factor in %: by three meshes where there are three that were halved,
    /// otherwise by recovery, with that of a file's outline; `None` where it is not known.
    pub fn measured_percent(&self, step: usize) -> Option<f64> {
        let by_meshes = self.three_meshes_percent(step);
        let own = by_meshes.or_else(|| self.recovered_percent(step))?;
        match self.outline {
            Some(_) => Some(own + self.outline_percent(step)?),
            None => Some(own),
        }
    }

    /// What the curves that a file's edges stand for change in what is measured at a load factor, in %.
    fn outline_percent(&self, step: usize) -> Option<f64> {
        let change = self.outline.as_ref()?.get(step)?;
        let measured = self.solved.measured(&self.measured, step)?;
        Some(100.0 * (change / measured).abs())
    }

    /// What is said about a file's outline.
    fn outline_told(&self) -> Option<Block> {
        let steps = 0..self.outline.as_ref()?.len();
        let percents = steps.filter_map(|step| self.outline_percent(step));
        let most = percents.fold(0.0, f64::max);
        Some(Block::Paragraph(format!(
            "The outline: finite elements on meshes of the file have its edges, chords or parabolas. With the smooth \
             curves that these stand for the {} would change by up to {most:.2e} %; this is part of its own error.",
            self.measured.name()
        )))
    }

    /// The error of what is measured by three meshes at a load factor in %, where there are three.
    pub fn three_meshes_percent(&self, step: usize) -> Option<f64> {
        let [coarse, middle] = &self.coarser[..] else {
            return None;
        };
        if !self.rounds.is_empty() {
            return None;
        }
        let all = [&coarse.solved, &middle.solved, &self.solved];
        let all = all.map(|solved| solved.measured(&self.measured, step));
        let [Some(coarse), Some(middle), Some(fine)] = all else {
            return None;
        };
        Some(richardson([coarse, middle, fine]).error_percent)
    }

    /// The error of what is measured by recovery at a load factor in %.
    pub fn recovered_percent(&self, step: usize) -> Option<f64> {
        let estimate = self.estimates.get(step)?.as_ref()?;
        let measured = self.solved.measured(&self.measured, step)?;
        Some(100.0 * (estimate.force / measured).abs())
    }

    /// The error of the field by recovery in the energy norm at a load factor in %.
    pub fn energy_percent(&self, step: usize) -> Option<f64> {
        let estimate = self.estimates.get(step)?.as_ref()?;
        Some(estimate.energy.percent())
    }

    /// The error of the displacement at the nodes of a lattice by the coarser meshes, in relative L2 in %; `None` where no
    /// coarser mesh has the load factor.
    ///
    /// ```text
    /// e = ‖u₃ − u₂‖/(r − 1),   r = ‖u₂ − u₁‖/‖u₃ − u₂‖        ‖u₃ − u₂‖ where r ≤ 1
    /// ```
    pub fn displacement_percent(&self, step: usize, lattice: &Mesh) -> Option<f64> {
        let on_lattice = |mesh: &Mesh, solved: &Solved| {
            let state = solved.states.get(step)?;
            Some(mesh.displacement_on(&state.displacement, lattice))
        };
        let fine = on_lattice(&self.mesh, &self.solved)?;
        let coarser = self.coarser.iter();
        let coarser: Vec<_> = coarser
            .filter_map(|own| on_lattice(&own.mesh, &own.solved))
            .collect();
        let distance = |u: &[f64], v: &[f64]| area_weighted_percent(lattice, u, v);
        match &coarser[..] {
            [] => None,
            [only] => Some(distance(only, &fine)),
            [.., first, second] => {
                let (before, last) = (distance(first, second), distance(second, &fine));
                let ratio = before / last;
                let converges = ratio > 1.0 && ratio.is_finite();
                Some(if converges {
                    last / (ratio - 1.0)
                } else {
                    last
                })
            }
        }
    }

    /// Whether local refinement has come as far as the study wants.
    pub fn goal_check(&self, specimen: &Specimen) -> Option<Check> {
        let (goal, last) = (specimen.refinement?, self.rounds.last()?);
        let mut quantity = "finite elements' own error of the field, energy norm".to_owned();
        if last.energy_percent > goal.error_percent {
            quantity += &format!(
                "; {} cells and no more than most_cells = {} were allowed",
                last.cells, goal.most_cells
            );
        }
        let wanted = Wanted::AtMost(goal.error_percent);
        let source = "the study's goal";
        Some(Check::new(
            quantity,
            "%",
            wanted,
            source,
            last.energy_percent,
        ))
    }

    /// The outline's share of the error, and the rounds of local refinement.
    pub fn history(&self) -> Vec<Block> {
        let outline = self.outline_told();
        if self.rounds.is_empty() {
            return outline.into_iter().collect();
        }
        let head = [
            "round",
            "cells",
            "nodes",
            "error of the field by recovery, energy norm [%]",
            &format!("error of the {} by recovery [%]", self.measured.name()),
        ];
        let row = |(number, round): (usize, &Round)| {
            vec![
                number.to_string(),
                round.cells.to_string(),
                round.nodes.to_string(),
                format!("{:.4}", round.energy_percent),
                format!("{:.5}", round.measured_percent),
            ]
        };
        let text = "Local refinement: in every round the cells with half of the squared error are cut into four. Errors \
                    are those of the worst load factor.";
        let rounds = self.rounds.iter().enumerate().map(row);
        let history = [Block::Paragraph(text.into()), Block::table(&head, rounds)];
        outline.into_iter().chain(history).collect()
    }
}

/// The finest finite elements alone: without the coarser meshes that an error by three of them takes.
pub fn finest(specimen: &Specimen, ends: &mut Vec<End>) -> Result<OnMesh, Error> {
    if let Some(goal) = specimen.refinement {
        let Reference { mesh, solved, .. } = Reference::adaptive(specimen, goal, ends)?;
        return Ok(OnMesh { mesh, solved });
    }
    let [_, _, mesh] = specimen.outline.reference_meshes();
    OnMesh::solve(specimen, mesh, FILE, ends)
}

impl OnMesh {
    fn solve(
        specimen: &Specimen,
        mesh: Mesh,
        file: &str,
        ends: &mut Vec<End>,
    ) -> Result<Self, Error> {
        let energy = specimen.problem.finite_elements(&mesh);
        let model = specimen.on(&mesh, &energy)?;
        let name = format!("finite elements ({})", mesh.describe());
        let solved = solve(specimen, &model, [&name, file], &mesh, ends);
        drop(model);
        Ok(Self { mesh, solved })
    }
}

impl Round {
    fn of(
        mesh: &Mesh,
        solved: &Solved,
        measured: &Measured,
        estimates: &[Option<ErrorEstimate>],
    ) -> Self {
        let worst = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let known = || estimates.iter().enumerate();
        let known = || known().filter_map(|(step, estimate)| Some((step, estimate.as_ref()?)));
        let mut errors = known().filter_map(|(step, estimate)| {
            let own = solved.measured(measured, step)?;
            Some(100.0 * (estimate.force / own).abs())
        });
        let mut energies = known().map(|(_, estimate)| estimate.energy.percent());
        Self {
            cells: mesh.cell_count(),
            nodes: mesh.nodes.len(),
            energy_percent: worst(&mut energies),
            measured_percent: worst(&mut errors),
        }
    }
}

/// What is measured, by the last state on a mesh; where it has none, by that of another path.
fn measured(specimen: &Specimen, mesh: &Mesh, solved: &Solved, ends: &[End]) -> Measured {
    match (solved.last(), last_groups(ends)) {
        (Some(groups), _) => specimen.measured(mesh, groups),
        (None, Some((mesh, groups))) => specimen.measured(mesh, groups),
        (None, None) => specimen.measured_at_rest(),
    }
}

/// What the curves that a file's edges stand for change in what is measured at each load factor; `None` where there are
/// no such edges.
fn outline_errors(
    specimen: &Specimen,
    what: &Measured,
    middle: Option<&OnMesh>,
) -> Result<Option<Vec<f64>>, Error> {
    let Some((rounded, whole)) = specimen.outline.rounded_mesh() else {
        return Ok(None);
    };
    // Where a path ends is told of the meshes whose results are given.
    let mut untold = Vec::new();
    let measured = |own: &OnMesh| -> Vec<f64> {
        let steps = 0..own.solved.reached();
        steps
            .filter_map(|step| own.solved.measured(what, step))
            .collect()
    };
    let rounded = measured(&OnMesh::solve(specimen, rounded, FILE, &mut untold)?);
    let middle = match middle {
        Some(middle) => measured(middle),
        None => {
            let [_, mesh, _] = specimen.outline.reference_meshes();
            measured(&OnMesh::solve(specimen, mesh, FILE, &mut untold)?)
        }
    };
    let pairs = rounded.iter().zip(&middle);
    Ok(Some(pairs.map(|(r, m)| whole * (r - m)).collect()))
}

/// The squared relative error of each cell, summed over the load factors.
fn indicators(cells: usize, estimates: &[Option<ErrorEstimate>]) -> Vec<f64> {
    let mut sums = vec![0.0; cells];
    for estimate in estimates.iter().flatten() {
        for (sum, cell) in sums.iter_mut().zip(&estimate.energy.cells) {
            *sum += cell / estimate.energy.norm_squared;
        }
    }
    sums
}

fn estimate_all(
    specimen: &Specimen,
    mesh: &Mesh,
    solved: &Solved,
    measured: &Measured,
) -> Result<Vec<Option<ErrorEstimate>>, Error> {
    let energy = specimen.problem.finite_elements(mesh);
    let model: Model = specimen.on(mesh, &energy)?;
    let recovery = Recovery::new(mesh);
    let estimate = |state| {
        let influence = model.influence(state, &measured.group, measured.axis);
        let solved = error_estimate::SheetSolution {
            law: &*specimen.problem.law,
            thickness: specimen.problem.thickness,
            mesh,
            displacement: &state.displacement,
        };
        Some(solved.estimate(&recovery, &influence.ok()?))
    };
    Ok(solved.states.iter().map(estimate).collect())
}
