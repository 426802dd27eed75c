//! Example 1, Part I: f = k u² from a linear trial.
//!
//! Eq. 20–23. F(u) = f − k u² = 0 at every force, so B = −2 k diag(u) is square and Y = 0: one step of the
//! linearised constraint is a Newton step from the trial. The trial is the secant ū = f u_max/f_max.

use std::path::Path;

use super::case::{
    Block, Check, Claim, Computation, Figure, Outcome, check, failed, largest, line, number,
    percent, row, section, table,
};
use crate::corrector::{Corrector, CorrectorSettings, Function, Linearisation, Solver};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::results::{LineChart, Stroke};
use crate::solve::SparseRows;
use crate::units::Dimension;

/// A spring with measured forces.
struct Spring {
    stiffness: f64,
    forces: Vec<f64>,
    iterates: usize,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let spring = section(root, "spring", |section| {
        let stiffness = section.number("stiffness", Bound::Positive);
        let largest = section.quantity("largest_force", Dimension::Force, Bound::Positive);
        let points = section.count("points", 2, 10_000);
        let force = |i| largest * i as f64 / points as f64;
        Spring {
            stiffness,
            forces: (1..=points).map(force).collect(),
            iterates: section.count("iterates", 2, 6),
        }
    });
    Box::new(move |_| compute(&spring))
}

fn compute(spring: &Spring) -> Result<Outcome, Error> {
    let (k, forces) = (spring.stiffness, &spring.forces);
    let exact: Vec<f64> = forces.iter().map(|f| (f / k).sqrt()).collect();
    let secant = exact[exact.len() - 1] / forces[forces.len() - 1];
    let trial: Vec<f64> = forces.iter().map(|f| f * secant).collect();
    let corrected = corrector(spring).correct(&trial, &trial);
    let correction = corrected.map_err(failed("corrector", "the parabolic spring"))?;
    let steps = correction.steps.iter();
    let iterates: Vec<&[f64]> = steps.map(|step| &step.field[..]).collect();
    let deviations = iterates.iter().map(|field| percent(field, &exact));
    let deviations: Vec<f64> = deviations.collect();
    // W (u − ū) + Bᵀ ψ = 0 with B = −2 k u.
    let closed_form = |(u, data): (&f64, &f64)| (u - data) / (2.0 * k * u);
    let closed_form = exact.iter().zip(&trial).map(closed_form);
    let psi = &correction.multipliers[0].values;
    let wrong_multipliers = largest(closed_form.zip(psi).map(|(a, b)| a - b));
    Ok(Outcome {
        checks: checks(&deviations, wrong_multipliers),
        claims: vec![claim(&deviations)],
        blocks: vec![deviation_table(&deviations[..=spring.iterates])],
        figures: figures(forces, &exact, &iterates, psi),
        ..Outcome::default()
    })
}

fn corrector(spring: &Spring) -> Corrector<'static> {
    let (k, forces) = (spring.stiffness, spring.forces.clone());
    let points = forces.len();
    let law = Function::new("f = k u²", points, move |u| {
        let mut jacobian = SparseRows::new(u.len());
        (0..u.len()).for_each(|i| jacobian.push([(i, -2.0 * k * u[i])]));
        let values = forces.iter().zip(u).map(|(f, u)| f - k * u * u).collect();
        Linearisation { values, jacobian }
    });
    let settings = CorrectorSettings {
        tolerance: 1e-12,
        movement: 1e-11,
        max_steps: 60,
        solver: Solver::Dense,
    };
    Corrector::new(vec![Box::new(law)], vec![1.0; points], settings)
}

fn checks(deviations: &[f64], wrong_multipliers: f64) -> Vec<Check> {
    vec![
        check("deviation after one step", "%", deviations[1])
            .at_most(10.0, "publication: below 10 %"),
        check("deviation after two steps", "%", deviations[2]).at_most(1.0, "Newton from a secant"),
        check(
            "deviation at the end",
            "%",
            deviations[deviations.len() - 1],
        )
        .at_most(1e-9, "u = √(f/k)"),
        check(
            "multipliers compared with (u − ū)/(2 k u)",
            "mm²/N",
            wrong_multipliers,
        )
        .at_most(1e-9, "closed form"),
    ]
}

fn claim(deviations: &[f64]) -> Claim {
    let (trial, first) = (number(deviations[0]), number(deviations[1]));
    let below = match deviations.iter().position(|deviation| *deviation < 10.0) {
        Some(step) => format!("below 10 % from step {step} on"),
        None => "never below 10 %".into(),
    };
    Claim {
        claim: "Example 1, Part I: the corrected parabolic spring deviates by less than 10 %",
        reproduced: format!(
            "the linear trial deviates by {trial} %, the first step by {first} %; {below}"
        ),
    }
}

fn deviation_table(deviations: &[f64]) -> Block {
    let rows = deviations.iter().enumerate();
    let rows = rows.map(|(step, deviation)| row(step.to_string(), [*deviation]));
    table("step | deviation, relative L2 [%]", rows)
}

fn figures(forces: &[f64], exact: &[f64], iterates: &[&[f64]], psi: &[f64]) -> Vec<Figure> {
    let line =
        |label: &str, values: &[f64], colour, stroke| line(label, forces, values, colour, stroke);
    let motion = LineChart::new(
        "Parabolic spring from a linear trial",
        "force [N]",
        "displacement [mm]",
        vec![
            line("exact", exact, [30, 30, 30], Stroke::Solid),
            line("uncorrected", iterates[0], [213, 94, 0], Stroke::Solid),
            line("after one step", iterates[1], [0, 158, 115], Stroke::Dashed),
            line(
                "after two steps",
                iterates[2],
                [0, 114, 178],
                Stroke::Points,
            ),
        ],
    );
    let multipliers = LineChart::new(
        "Lagrange multipliers of f − k u² = 0",
        "force [N]",
        "multiplier ζ [mm²/N]",
        vec![line("ζ", psi, [204, 121, 167], Stroke::Marked)],
    );
    vec![
        Figure::new(
            "nonlinear_spring.png",
            "Figure 1 of the publication: uncorrected, corrected and exact displacement.",
            motion,
        ),
        Figure::new(
            "nonlinear_spring_multipliers.png",
            "Figure 1 of the publication: the Lagrange multipliers.",
            multipliers,
        ),
    ]
}
