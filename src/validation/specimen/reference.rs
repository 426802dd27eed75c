//! The finite elements that a specimen's other models are held to, and their own error.

use super::read::Refinement;
use super::{End, Solved, Specimen, solve};
use crate::boundary::Discretised;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::finite_element::error_estimate::{self, ErrorEstimate, bulk};
use crate::finite_element::recovery::Recovery;
use crate::mesh::Mesh;
use crate::output::Block;
use crate::validation::{Check, Wanted};

/// The part of the squared error that is refined in a round.
const SHARE: f64 = 0.5;

/// Begin of the names of the finest finite elements' files.
const FILE: &str = "finite_element";

/// The finest finite elements.
pub struct Reference {
    pub mesh: Mesh,
    pub solved: Solved,
    /// One a load factor.
    pub estimates: Vec<ErrorEstimate>,
    history: History,
    /// What the curves that a file's edges stand for change in what is measured, where there are such edges.
    outline: Option<Vec<f64>>,
}

/// How the mesh was come by.
enum History {
    /// What is measured on meshes of a quarter and of half as many cells along each side.
    Halved([Vec<f64>; 2]),
    /// The rounds of local refinement.
    Adaptive(Vec<Round>),
}

/// One mesh of local refinement, with its errors at the worst load factor.
struct Round {
    cells: usize,
    nodes: usize,
    energy_percent: f64,
    measured_percent: f64,
}

/// A mesh, its solutions and their errors.
type Estimated = (Mesh, Solved, Vec<ErrorEstimate>);

impl Reference {
    /// Solves the specimen on three meshes, or on as many as the goal of local refinement takes.
    pub fn solve(specimen: &Specimen, ends: &mut Vec<End>) -> Result<Self, Error> {
        match specimen.refinement {
            Some(goal) => Self::adaptive(specimen, goal, ends),
            None => Self::halved(specimen, ends),
        }
    }

    fn halved(specimen: &Specimen, ends: &mut Vec<End>) -> Result<Self, Error> {
        let [coarse, middle, fine] = specimen.reference_meshes();
        let coarse = on_mesh(specimen, &coarse, "finite_element_coarse", ends)?;
        let middle = on_mesh(specimen, &middle, "finite_element_middle", ends)?;
        let (mesh, solved, estimates) = estimated(specimen, fine, ends)?;
        Ok(Self {
            mesh,
            solved,
            estimates,
            outline: outline_errors(specimen, Some(&middle.measured))?,
            history: History::Halved([coarse.measured, middle.measured]),
        })
    }

    fn adaptive(specimen: &Specimen, goal: Refinement, ends: &mut Vec<End>) -> Result<Self, Error> {
        let mut triangles = specimen.first_triangles();
        let mut rounds = Vec::new();
        let ends_before = ends.len();
        loop {
            // A finer mesh may reach what a coarser one did not.
            ends.truncate(ends_before);
            let mesh = specimen.elements_on(&triangles);
            let (mesh, solved, estimates) = estimated(specimen, mesh, ends)?;
            rounds.push(Round::of(&mesh, &solved, &estimates));
            let reached = estimates.is_empty()
                || rounds[rounds.len() - 1].energy_percent <= goal.error_percent;
            let finer = || {
                let finer = triangles.refined_where(&bulk(&indicators(&estimates), SHARE));
                specimen.fitted(finer)
            };
            let next = (!reached).then(finer);
            match next.filter(|next| next.cell_count() <= goal.most_cells) {
                Some(next) => triangles = next,
                None => {
                    return Ok(Self {
                        mesh,
                        solved,
                        estimates,
                        outline: outline_errors(specimen, None)?,
                        history: History::Adaptive(rounds),
                    });
                }
            }
        }
    }

    /// How many load factors all meshes have reached.
    pub fn reached(&self) -> usize {
        let all = self.solved.states.len();
        match &self.history {
            History::Halved(coarser) => coarser.iter().map(Vec::len).fold(all, usize::min),
            History::Adaptive(_) => all,
        }
    }

    /// `finest of three meshes`, for reports.
    pub fn kind(&self) -> String {
        match &self.history {
            History::Halved(_) => "finest of three meshes".to_owned(),
            History::Adaptive(rounds) => format!("refined locally in {} rounds", rounds.len() - 1),
        }
    }

    /// What the own error of the measured quantity follows from.
    pub fn by_what(&self) -> &'static str {
        match (&self.history, &self.outline) {
            (History::Halved(_), None) => "by three meshes",
            (History::Halved(_), Some(_)) => "by three meshes and a rounded outline",
            (History::Adaptive(_), None) => "by recovery",
            (History::Adaptive(_), Some(_)) => "by recovery and a rounded outline",
        }
    }

    /// The own error of what is measured at a load factor in %, with that of a file's outline.
    pub fn measured_percent(&self, step: usize) -> f64 {
        let estimated = || self.recovered_percent(step);
        let own = self.three_meshes_percent(step).unwrap_or_else(estimated);
        own + self.outline_percent(step).unwrap_or(0.0)
    }

    /// What the curves that a file's edges stand for change in what is measured at a load factor, in %.
    fn outline_percent(&self, step: usize) -> Option<f64> {
        let changes = self.outline.as_ref()?;
        let change = changes.get(step).copied().unwrap_or(f64::NAN);
        Some(100.0 * (change / self.solved.measured[step]).abs())
    }

    /// What is said about a file's outline.
    fn outline_told(&self, specimen: &Specimen) -> Option<Block> {
        let steps = 0..self.outline.as_ref()?.len();
        let percents = steps.filter_map(|step| self.outline_percent(step));
        let most = percents.fold(0.0, f64::max);
        Some(Block::Paragraph(format!(
            "The outline: finite elements on meshes of the file have its edges, chords or parabolas. With the smooth \
             curves that these stand for the {} would change by up to {most:.2e} %; this is part of its own error.",
            specimen.measured().name()
        )))
    }

    /// The error of what is measured by three meshes at a load factor in %, where there are three.
    pub fn three_meshes_percent(&self, step: usize) -> Option<f64> {
        let History::Halved([coarse, middle]) = &self.history else {
            return None;
        };
        let forces = [coarse[step], middle[step], self.solved.measured[step]];
        Some(richardson(forces).error_percent)
    }

    /// The error of what is measured by recovery at a load factor in %.
    pub fn recovered_percent(&self, step: usize) -> f64 {
        100.0 * (self.estimates[step].force / self.solved.measured[step]).abs()
    }

    /// Whether local refinement has come as far as the study wants.
    pub fn goal_check(&self, specimen: &Specimen) -> Option<Check> {
        let (Some(goal), History::Adaptive(rounds)) = (specimen.refinement, &self.history) else {
            return None;
        };
        let last = &rounds[rounds.len() - 1];
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
    pub fn history(&self, specimen: &Specimen) -> Vec<Block> {
        let outline = self.outline_told(specimen);
        let History::Adaptive(rounds) = &self.history else {
            return outline.into_iter().collect();
        };
        let what = specimen.measured().name();
        let head = [
            "round",
            "cells",
            "nodes",
            "error of the field by recovery, energy norm [%]",
            &format!("error of the {what} by recovery [%]"),
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
        let rounds = rounds.iter().enumerate().map(row);
        let history = [Block::Paragraph(text.into()), Block::table(&head, rounds)];
        outline.into_iter().chain(history).collect()
    }
}

/// The finest finite elements alone: without the coarser meshes that an error by three of them takes.
pub fn finest(specimen: &Specimen, ends: &mut Vec<End>) -> Result<(Mesh, Solved), Error> {
    if let Some(goal) = specimen.refinement {
        let reference = Reference::adaptive(specimen, goal, ends)?;
        return Ok((reference.mesh, reference.solved));
    }
    let [_, _, mesh] = specimen.reference_meshes();
    let solved = on_mesh(specimen, &mesh, FILE, ends)?;
    Ok((mesh, solved))
}

impl Round {
    fn of(mesh: &Mesh, solved: &Solved, estimates: &[ErrorEstimate]) -> Self {
        let worst = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let pairs = estimates.iter().zip(&solved.measured);
        let mut measured = pairs.map(|(estimate, own)| 100.0 * (estimate.force / own).abs());
        let mut energies = estimates.iter().map(|estimate| estimate.energy.percent());
        Self {
            cells: mesh.cell_count(),
            nodes: mesh.nodes.len(),
            energy_percent: worst(&mut energies),
            measured_percent: worst(&mut measured),
        }
    }
}

/// The squared relative error of each cell, summed over the load factors.
fn indicators(estimates: &[ErrorEstimate]) -> Vec<f64> {
    let mut sums = vec![
        0.0;
        estimates
            .first()
            .map_or(0, |first| first.energy.cells.len())
    ];
    for estimate in estimates {
        for (sum, cell) in sums.iter_mut().zip(&estimate.energy.cells) {
            *sum += cell / estimate.energy.norm_squared;
        }
    }
    sums
}

/// What the curves that a file's edges stand for change in what is measured at each load factor; `None` where there are
/// no such edges.
fn outline_errors(specimen: &Specimen, middle: Option<&[f64]>) -> Result<Option<Vec<f64>>, Error> {
    let Some((rounded, whole)) = specimen.rounded_mesh() else {
        return Ok(None);
    };
    // Where a path ends is told of the meshes whose results are given.
    let mut untold = Vec::new();
    let mut measured = |mesh: &Mesh| Ok(on_mesh(specimen, mesh, FILE, &mut untold)?.measured);
    let rounded = measured(&rounded)?;
    let middle = match middle {
        Some(middle) => middle.to_vec(),
        None => measured(&specimen.reference_meshes()[1])?,
    };
    let pairs = rounded.iter().zip(&middle);
    Ok(Some(pairs.map(|(r, m)| whole * (r - m)).collect()))
}

fn on_mesh(
    specimen: &Specimen,
    mesh: &Mesh,
    file: &str,
    ends: &mut Vec<End>,
) -> Result<Solved, Error> {
    let energy = specimen.problem.finite_elements(mesh);
    let model = specimen.on(&specimen.problem, mesh, &energy)?;
    Ok(solve(specimen, &model, [&name(mesh), file], mesh, ends))
}

fn name(mesh: &Mesh) -> String {
    format!("finite elements ({})", mesh.describe())
}

fn estimated(specimen: &Specimen, mesh: Mesh, ends: &mut Vec<End>) -> Result<Estimated, Error> {
    let solved = on_mesh(specimen, &mesh, FILE, ends)?;
    let problem = &specimen.problem;
    let energy = problem.finite_elements(&mesh);
    let model = specimen.on(problem, &mesh, &energy)?;
    let estimates = estimate_all(specimen, &model, &mesh, &solved)?;
    drop(model);
    Ok((mesh, solved, estimates))
}

fn estimate_all(
    specimen: &Specimen,
    model: &Discretised,
    mesh: &Mesh,
    solved: &Solved,
) -> Result<Vec<ErrorEstimate>, Error> {
    let states = solved.states.iter();
    let recovery = Recovery::new(mesh);
    let estimate = |state| {
        let (axis, _) = specimen.component(model, state);
        let influence = model.influence(state, &specimen.measured, axis);
        let influence = influence.map_err(|fault| Error::Solve {
            model: name(mesh),
            step: format!("load factor {}", state.factor),
            fault,
        })?;
        let solved = error_estimate::Solved {
            law: &*specimen.problem.law,
            thickness: specimen.problem.thickness,
            mesh,
            displacement: &state.displacement,
        };
        Ok(solved.estimate(&recovery, &influence))
    };
    states.map(estimate).collect()
}
