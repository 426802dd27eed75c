//! The solution of a specimen's finite elements: on three meshes, each twice as fine as the one before, or by local
//! refinement.

use super::end::{End, Run, last_groups};
use super::lattice::solve;
use super::measured::Measured;
use super::reference::{OutlineChange, Reference, Round};
use crate::compare::area_weighted_percent;
use crate::error::Error;
use crate::finite_element::Quarter;
use crate::finite_element::error_estimate::{ErrorEstimate, SheetSolution, bulk, side_by_side};
use crate::finite_element::recovery::Recovery;
use crate::mesh::Mesh;
use crate::problem::Solution;
use crate::results::models::FINITE_ELEMENTS;
use crate::statistics::larger;
use crate::studies::specimen::problem::{Refinement, Specimen};

/// The part of the squared error that is refined in a round.
const SHARE: f64 = 0.5;

/// Cells up to which the finite elements are refined once more where they are too coarse to judge.
const MOST_CELLS: usize = 30_000;

/// The beginnings of the names of the meshes' files, from coarse to fine.
const FILES: [&str; 3] = ["finite_element_coarse", "finite_element_middle", FILE];
const FILE: &str = FINITE_ELEMENTS.key;

impl Reference {
    /// Solves the specimen on three meshes, or on as many as the goal of local refinement takes.
    pub fn solve(run: &mut Run) -> Result<Self, Error> {
        match run.specimen.refinement {
            Some(goal) => Self::adaptive(run, goal),
            None => {
                let solutions = nested(run)?;
                Self::of_meshes(run, solutions, Vec::new(), None)
            }
        }
    }

    /// The reference on the last of some meshes; of local refinement with its rounds, and the solution with all cells halved.
    fn of_meshes(
        run: &Run,
        mut meshes: Vec<Solution>,
        rounds: Vec<Round>,
        all_halved: Option<Solution>,
    ) -> Result<Self, Error> {
        let specimen = run.specimen;
        let finest = meshes.pop().expect("a mesh at least");
        let measured = measured(specimen, &finest, &run.ends);
        let once_halved = meshes.get(1).or(Some(&finest));
        let once_halved = once_halved.filter(|_| rounds.is_empty());
        let mut reference = Self {
            displacement: Vec::new(),
            of_all_nodes: Vec::new(),
            estimates: complete(estimates(specimen, &finest, &measured)?),
            outline: outline_changes(run, &measured, once_halved)?,
            all_halved,
            coarser: meshes.split_off(meshes.len().saturating_sub(2)),
            on_grids: specimen.grids().is_some(),
            finest,
            measured,
            rounds,
        };
        reference.displacement = reference.errors_at(&specimen.outline.corrected_mesh());
        reference.of_all_nodes = reference.errors_at(&reference.finest.mesh);
        Ok(reference)
    }

    /// Whether one more halving of the cells is possible and not too much work.
    pub fn may_be_finer(&self, specimen: &Specimen) -> bool {
        specimen.outline.is_shape()
            && self.rounds.is_empty()
            && self.reached() == specimen.factors.len()
            && 4 * self.finest.mesh.cell_count() <= MOST_CELLS
    }

    /// The reference with cells of half the size: the two finer ones of its meshes, and one more.
    ///
    /// # Errors
    /// [`Error::Input`] when a group of the mesh cannot be held or loaded as the study says.
    pub fn finer(mut self, run: &mut Run) -> Result<Self, Error> {
        let mesh = run.specimen.outline.reference_mesh(3);
        let finer = on_mesh(run, &mesh, Some(&self.finest), FILE)?;
        let mut meshes = self.coarser.split_off(self.coarser.len() - 1);
        meshes.extend([self.finest, finer]);
        Self::of_meshes(run, meshes, Vec::new(), None)
    }

    fn adaptive(run: &mut Run, goal: Refinement) -> Result<Self, Error> {
        let Refined {
            triangles,
            meshes,
            rounds,
        } = refined(run, goal)?;
        let finest = meshes.last().expect("a mesh at least");
        let is_small = 4 * triangles.cell_count() <= Refinement::MOST_HALVED;
        let all_halved = (is_small && finest.reached() > 0).then(|| {
            // By their longest edges, as locally: cells cut into four by the middles of all would lock where these do not.
            let all = vec![true; triangles.cell_count()];
            let outline = &run.specimen.outline;
            let mesh = outline.elements_on(&outline.fitted(triangles.refined_where(&all)));
            on_mesh(&mut run.unreported(), &mesh, Some(finest), FILE)
        });
        let all_halved = all_halved.transpose()?;
        Self::of_meshes(run, meshes, rounds, all_halved)
    }
}

/// The meshes of local refinement.
struct Refined {
    /// The cells of the last mesh.
    triangles: Mesh,
    meshes: Vec<Solution>,
    rounds: Vec<Round>,
}

/// Refines where the error is, until it is as small as wanted.
fn refined(run: &mut Run, goal: Refinement) -> Result<Refined, Error> {
    let specimen = run.specimen;
    let mut triangles = specimen.outline.first_triangles();
    let (mut rounds, mut meshes): (Vec<Round>, Vec<Solution>) = (Vec::new(), Vec::new());
    let ends_before = run.ends.len();
    loop {
        // A finer mesh may reach what a coarser one did not.
        run.ends.truncate(ends_before);
        let mesh = specimen.outline.elements_on(&triangles);
        let solution = on_mesh(run, &mesh, meshes.last(), FILE)?;
        let measured = measured(specimen, &solution, &run.ends);
        let estimates = estimates(specimen, &solution, &measured)?;
        rounds.push(Round::of(&solution, &measured, &estimates));
        meshes.push(solution);
        let reached = rounds[rounds.len() - 1].energy_percent <= goal.error_percent;
        let done = estimates.iter().all(Option::is_none) || reached;
        let finer = || {
            let marked = bulk(&indicators(mesh.cell_count(), &estimates), SHARE);
            specimen.outline.fitted(triangles.refined_where(&marked))
        };
        let next = (!done).then(finer);
        match next.filter(|next| next.cell_count() <= goal.most_cells) {
            Some(next) => triangles = next,
            None => {
                return Ok(Refined {
                    triangles,
                    meshes,
                    rounds,
                });
            }
        }
    }
}

/// The finite elements on all meshes, each with first guesses of the one before.
fn nested(run: &mut Run) -> Result<Vec<Solution>, Error> {
    let outline = &run.specimen.outline;
    let finest = outline.halvings();
    let mut solutions: Vec<Solution> = Vec::new();
    for level in 0..=finest {
        let file = FILES[FILES.len() - 1 - finest + level];
        let mesh = outline.reference_mesh(level);
        solutions.push(on_mesh(run, &mesh, solutions.last(), file)?);
    }
    Ok(solutions)
}

/// The finest finite elements alone, with first guesses of the coarser ones as in a run.
pub fn finest(run: &mut Run) -> Result<Solution, Error> {
    if let Some(goal) = run.specimen.refinement {
        let finest = refined(run, goal)?.meshes.pop();
        return Ok(finest.expect("a mesh at least"));
    }
    let mut all = run.unreported();
    let finest = nested(&mut all)?.pop();
    let finest = finest.expect("a mesh at least");
    let is_complete = finest.reached() == run.specimen.factors.len();
    run.ends.extend(all.ends.pop().filter(|_| !is_complete));
    Ok(finest)
}

/// The finite elements on a mesh, with first guesses of a coarser one; `file` is the beginning of the names of their files.
fn on_mesh(
    run: &mut Run,
    mesh: &Mesh,
    coarser: Option<&Solution>,
    file: &str,
) -> Result<Solution, Error> {
    let specimen = run.specimen;
    let energy = specimen.problem.finite_elements(mesh);
    let mut model = specimen
        .on(mesh, &energy)?
        .solved_by(specimen.linear_solver);
    if let Some(coarser) = coarser {
        model = model.near(&coarser.mesh, &coarser.states);
    }
    let settings = specimen.elements_newton;
    let by_quarter = quarter(specimen, mesh).and_then(|quarter| {
        let report = |factor: f64| run.report_solved(&model.name, factor);
        let coarser = coarser.map(|solution| (&solution.mesh, &solution.states[..]));
        let attendance = run.progress.along(&report);
        quarter.states(&model, &specimen.factors, coarser, settings, attendance)
    });
    if let Some(states) = by_quarter {
        return Ok(Solution::new(&model, &specimen.groups(), states));
    }
    Ok(solve(run, &model, file, settings))
}

/// The quarter of a plate's finite elements, which is quicker to solve; `None` where the specimen is not a plate that stays symmetric.
fn quarter(specimen: &Specimen, mesh: &Mesh) -> Option<Quarter> {
    let (plate, _) = specimen.plate()?;
    Quarter::of(&plate, mesh, specimen.linear_solver)
}

impl Round {
    fn of(solution: &Solution, measured: &Measured, estimates: &[Option<ErrorEstimate>]) -> Self {
        let worst =
            |values: &mut dyn Iterator<Item = f64>| values.reduce(larger).unwrap_or(f64::NAN);
        let known = || estimates.iter().enumerate();
        let known = || known().filter_map(|(step, estimate)| Some((step, estimate.as_ref()?)));
        let mut errors = known().filter_map(|(step, estimate)| {
            let value = measured.at(solution, step)?;
            Some(100.0 * (estimate.force / value).abs())
        });
        let mut energies = known().map(|(_, estimate)| estimate.energy.percent());
        Self {
            cells: solution.mesh.cell_count(),
            nodes: solution.mesh.nodes.len(),
            energy_percent: worst(&mut energies),
            measured_percent: worst(&mut errors),
        }
    }
}

/// What is measured, by the last state on a mesh; where it has none, by that of another path.
fn measured(specimen: &Specimen, solution: &Solution, ends: &[End]) -> Measured {
    match (solution.last_groups(), last_groups(ends)) {
        (Some(groups), _) => specimen.measured(&solution.mesh, groups),
        (None, Some((mesh, groups))) => specimen.measured(mesh, groups),
        (None, None) => specimen.measured_at_rest(),
    }
}

/// The changes by the curves that a file's edges approximate, at each load factor; `None` where there are no such edges.
fn outline_changes(
    run: &Run,
    what: &Measured,
    middle: Option<&Solution>,
) -> Result<Option<Vec<OutlineChange>>, Error> {
    let specimen = run.specimen;
    let Some((rounded, factor)) = specimen.outline.rounded_mesh() else {
        return Ok(None);
    };
    let on = |mesh: &Mesh| on_mesh(&mut run.unreported(), mesh, middle, FILE);
    let rounded = on(&rounded)?;
    let halved;
    let middle = match middle {
        Some(middle) => middle,
        None => {
            halved = on(&specimen.outline.reference_mesh(1))?;
            &halved
        }
    };
    let corrected = specimen.outline.corrected_mesh();
    let change = |step| {
        let on_nodes = |solution: &Solution| {
            let displacement = solution.displacement(step)?;
            Some(solution.mesh.displacement_on(displacement, &corrected))
        };
        let (curved, straight) = (on_nodes(&rounded)?, on_nodes(middle)?);
        Some(OutlineChange {
            measured: factor * (what.at(&rounded, step)? - what.at(middle, step)?),
            displacement_percent: factor.abs()
                * area_weighted_percent(&corrected, &curved, &straight),
        })
    };
    let steps = 0..rounded.reached().min(middle.reached());
    Ok(Some(steps.filter_map(change).collect()))
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

/// The estimates that cover all points.
fn complete(estimates: Vec<Option<ErrorEstimate>>) -> Vec<Option<ErrorEstimate>> {
    let complete = |one: Option<ErrorEstimate>| one.filter(|estimate| estimate.energy.is_complete);
    estimates.into_iter().map(complete).collect()
}

/// The estimated errors of a solution at each load factor; `None` where the tangent of that state gives none.
fn estimates(
    specimen: &Specimen,
    solution: &Solution,
    measured: &Measured,
) -> Result<Vec<Option<ErrorEstimate>>, Error> {
    if specimen.problem.laws().soften() {
        // Recovery does not account for a history.
        return Ok(vec![None; solution.reached()]);
    }
    let mesh = &solution.mesh;
    let energy = specimen.problem.finite_elements(mesh);
    let model = specimen
        .on(mesh, &energy)?
        .solved_by(specimen.linear_solver);
    let laws = specimen.problem.laws().in_cells(mesh);
    // Between regions gradients jump: they are recovered on either side alone.
    let cut = laws.cut(mesh);
    let recovery = Recovery::new(cut.as_ref().map_or(mesh, |cut| &cut.mesh));
    let on_sides = |field: &[f64]| match &cut {
        Some(cut) => cut.field(field),
        None => field.to_vec(),
    };
    let states = &solution.states;
    let is_of_grip = measured.group == specimen.group && measured.axis == 0;
    let by_quarter = quarter(specimen, mesh).filter(|_| is_of_grip);
    let by_quarter = by_quarter.and_then(|quarter| quarter.influences(states));
    let of_full = || model.influences(states, &measured.group, measured.axis);
    let influences = by_quarter.unwrap_or_else(of_full).into_iter();
    let influences = influences.map(|influence| influence.map(|field| on_sides(&field)));
    let fields = states.iter().map(|state| on_sides(&state.displacement));
    let fields: Vec<Vec<f64>> = fields.collect();
    let solved = fields.iter().map(|displacement| SheetSolution {
        laws: &laws,
        thickness: specimen.problem.thickness,
        mesh: cut.as_ref().map_or(mesh, |cut| &cut.mesh),
        displacement,
    });
    let estimates = side_by_side(solved.collect(), &recovery, influences.collect());
    Ok(estimates.into_iter().map(Result::ok).collect())
}
