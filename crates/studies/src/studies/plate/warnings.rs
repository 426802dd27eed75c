//! What a reader of a plate's figures must know about them.

use crate::finite_element::Element;
use crate::mass_spring;
use crate::problem::ClampedPlate;
use crate::studies::plate::problem::Study;
use crate::studies::plate::results::{MODELS, Results};

use crate::results::models::CORRECTED;
use crate::results::strained::{self, StrainedSheet};
use crate::results::{is_one_of_several, locking, one_of_several};

/// Reactions further from balance than this, relative to the largest, deserve a word: those of a residual that is solved for, and those of
/// the climb, which ends at a share of the discretisation error.
const BALANCED: f64 = 1e-9;
const BALANCED_BY_CLIMB: f64 = 1e-6;

/// The warnings about a run: a lattice of another ν, compression, a law of small strains, doubtful stability, reactions out of balance.
pub fn warnings(study: &Study, results: &Results) -> Vec<String> {
    let mut all = Vec::new();
    if !study.lattice.area_term {
        all.extend(mass_spring::warning_of_plate(&*study.problem.law));
    }
    let corrected = study.corrector.scheme.side() == 1;
    let finite_elements = study.reference.element == Element::Q1;
    let [_, names @ ..] = MODELS;
    let locking = names.into_iter().zip([corrected, finite_elements]);
    let remedies = [
        "Take the scheme \"biquadratic\" for the corrected field",
        locking::SECOND_DEGREE,
    ];
    let locking: Vec<(&str, &str)> = locking
        .zip(remedies)
        .filter_map(|((name, locks), remedy)| locks.then_some((name, remedy)))
        .collect();
    all.extend(locking::warning(&*study.problem.law, &locking));
    let left_out = study.card.viscosity.left_out();
    all.extend(left_out.map(|told| format!("{told}.")));
    all.extend(of_states(study, results));
    all.extend(instability(results));
    all.extend(imbalance(study, results));
    all
}

/// What is said of the states of the finite elements, or of those of the corrected field where there are none.
fn of_states(study: &Study, results: &Results) -> Vec<String> {
    let finest = results.finest();
    let model = if finest.solution.states.is_empty() {
        1
    } else {
        2
    };
    let steps = 0..results.comparison.len();
    let states = steps.filter_map(|step| {
        let solution = results.models(step)[model]?;
        Some(StrainedSheet {
            load: ClampedPlate::describe_step(solution.factor),
            sheet: study.sheet(),
            displacement: &solution.displacement,
        })
    });
    let states: Vec<_> = states.collect();
    strained::warnings(&study.card, MODELS[model], results.meshes()[model], &states)
}

/// States that were reached through tangents that are not positive definite.
fn instability(results: &Results) -> Option<String> {
    let mut found = Vec::new();
    for (model, name) in MODELS.into_iter().enumerate() {
        for step in 0..results.comparison.len() {
            let Some(solution) = results.models(step)[model] else {
                continue;
            };
            if is_one_of_several(solution) {
                let at = ClampedPlate::describe_step(solution.factor);
                found.push(format!("{name} at {at}"));
            }
        }
    }
    // Finer meshes begin with the states of coarser ones.
    let [coarser @ .., _] = &results.reference;
    for solution in coarser.iter().map(|own| &own.solution) {
        let states = solution.states.iter();
        for state in states.filter(|state| is_one_of_several(state)) {
            let at = ClampedPlate::describe_step(state.factor);
            found.push(format!("coarser {} at {at}", MODELS[2]));
        }
    }
    one_of_several(&found)
}

fn imbalance(study: &Study, results: &Results) -> Vec<String> {
    let told = |(model, name): (usize, &str)| {
        let (relative, stretch) = results.worst_balance(model)?;
        let limit = if name == CORRECTED.name && study.corrector.climb.is_some() {
            BALANCED_BY_CLIMB
        } else {
            BALANCED
        };
        (relative > limit).then(|| {
            format!(
                "{name}: the reactions of the grips are out of balance by {relative:.1e} of the largest at {}; take a \
                 smaller tolerance",
                ClampedPlate::describe_step(stretch)
            )
        })
    };
    MODELS.into_iter().enumerate().filter_map(told).collect()
}
