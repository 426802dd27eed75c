//! The fields of a plate for other programs.

use super::problem::Study;
use super::results::Results;
use crate::corrector::Multipliers;
use crate::corrector::plate::{CorrectedState, EQUILIBRIUM, FREE_EDGES, GRIPS};
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::results::{Array, Grid, GridSeries};
use crate::solve::State;

/// The fields of every model, as far as it has solutions.
pub fn grids(study: &Study, results: &Results) -> Vec<GridSeries> {
    let sheet = study.sheet();
    let finest = results.finest();
    let meshes = results.meshes();
    let compared = |model: usize, step: usize, solution: &State| {
        let u = &solution.displacement;
        let past = results.past(model, step);
        let reference = results.reference_on[model].get(step);
        let difference = reference.map(|reference| Array::to_finite_elements(u, reference));
        Grid::sheet(sheet.after(&past), meshes[model], u).with(difference)
    };
    let springs = |step: usize| Some((step, results.uncorrected.states.get(step)?));
    let steps = || 0..study.problem.stretches.len();
    let mass_spring = steps().filter_map(springs);
    let mass_spring = mass_spring.map(|(step, solution)| (step, compared(0, step, solution)));
    let bars = steps().filter_map(springs);
    let bars = bars.map(|(step, own)| {
        (
            step,
            Grid::springs(&results.springs, &own.displacement, &own.history),
        )
    });
    let corrected = steps().filter_map(|step| Some((step, results.corrected[step].as_ref()?)));
    let corrected = corrected.map(|(step, state)| {
        let grid = compared(1, step, &state.state);
        (step, grid.with(multipliers(state)))
    });
    let elements = finest
        .solution
        .states
        .iter()
        .enumerate()
        .map(|(step, solution)| {
            let error = results.estimates[step].as_ref();
            let error = error.map(|estimate| Array::estimated_error(&estimate.energy));
            let past = results.past(2, step);
            let sheet = sheet.after(&past);
            let grid = Grid::sheet(sheet, &finest.model.mesh, &solution.displacement);
            (step, grid.with_in_cells(error))
        });
    let series = |name, grids: Vec<(usize, Grid)>| {
        let stretches = &study.problem.stretches;
        let grids = grids.into_iter();
        let grids = grids.map(|(step, grid)| (step + 1, stretches[step], grid));
        GridSeries::numbered(name, 3, grids)
    };
    let mut all = vec![
        series(MASS_SPRING.key, mass_spring.collect()),
        series("springs", bars.collect()),
        series(CORRECTED.key, corrected.collect()),
        series(FINITE_ELEMENTS.key, elements.collect()),
    ];
    all.retain(|series| !series.grids.is_empty());
    all
}

/// The multipliers of every condition at the nodes; zero where the condition does not hold.
fn multipliers(state: &CorrectedState) -> impl Iterator<Item = Array> {
    let size = state.state.displacement.len();
    let groups = state.multipliers.iter();
    groups.filter_map(move |group| multiplier_array(group, size))
}

fn multiplier_array(group: &Multipliers, size: usize) -> Option<Array> {
    let name = match group.name.as_str() {
        EQUILIBRIUM => "multiplier_zeta_equilibrium_mm2_per_N",
        GRIPS => "multiplier_eta_grips_mm",
        FREE_EDGES => "multiplier_eta_free_edges_mm2_per_N",
        _ => return None,
    };
    let mut values = vec![0.0; size];
    for (unknown, value) in group.unknowns.iter().flatten().zip(&group.values) {
        values[*unknown] = *value;
    }
    Some(Array::vectors(name, values))
}
