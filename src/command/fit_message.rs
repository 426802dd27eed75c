//! What the command prints about fits.

use gelbench_calibration::calibration::{Criterion, Fit, Test, TestData};
use gelbench_mechanics::material::Card;
use gelbench_mechanics::material::HyperelasticLaw;
use gelbench_mechanics::material::curve::{Mode, samples};
use gelbench_mechanics::material::parameters::Parameter;
use gelbench_report::results::{Table, digits};

/// Parameters, figures, stability, predictions and warnings of a fit.
pub fn fit(fit: &Fit, tests: &[TestData]) -> String {
    let quality = &fit.quality;
    let mut text = format!("{}: {}\n", fit.law.name, fit.law.formula);
    for test in tests {
        text += &format!(
            "  data         {} ({}, {} stress, {} points)\n",
            test.name,
            test.test.name(),
            test.stress_measure.name(),
            test.observations.len()
        );
        text += &format!("               {}\n", test.table.sentence());
        for remark in &test.remarks {
            text += &format!("               {remark}\n");
        }
    }
    text += &mounted(fit);
    text += &protocols(fit);
    text += &relaxation(fit);
    text += &softening(fit);
    text += &parameters(fit);
    text += &correlation(fit);
    text += &figures(fit);
    for range in &quality.stable {
        let ([low, high], name) = (range.stretches, range.mode.name());
        text += &format!("  stable       λ = {low:.3} … {high:.3} in {name} tests (Drucker)\n");
    }
    text += &curves(&*fit.fitted, quality.stretch_range, &|mode| match mode {
        Some(mode) if !quality.untested.contains(&mode) => "tested",
        None if tests.iter().any(|data| data.test == Test::SimpleShear) => "tested",
        _ => "predicted",
    });
    for warning in &quality.warnings {
        text += &format!("  warning: {warning}\n");
    }
    text
}

/// The parameters that a homogeneous reading of a mounted sheet gives, its error, and the parameters with another state at rest.
fn mounted(fit: &Fit) -> String {
    let mut text = String::new();
    if let Some(mounted) = &fit.mounted {
        let [first, second] = mounted.bias_percent;
        text += &format!(
            "  mounting     sheet and law solved together {} times; smaller cells change the forces by {:.2} %, which is taken into account\n",
            mounted.rounds, mounted.discretisation_percent
        );
        text += &format!(
            "  homogeneous  {}, whose equibiaxial stresses are up to {first:+.1} % and {second:+.1} % off\n",
            values(&mounted.homogeneous)
        );
    }
    if let Some((parameters, r_squared)) = &fit.at_rest_as_mounted {
        text += &format!(
            "  as mounted   {} if the sheet were homogeneous and at rest as mounted, R² {r_squared:.6}\n",
            values(parameters)
        );
    }
    text
}

/// How well the law predicts protocols that it was not fitted to, and which further one would tell most.
fn protocols(fit: &Fit) -> String {
    let Some(protocols) = &fit.protocols else {
        return String::new();
    };
    let percents = protocols.left_out_percent.iter();
    let each: Vec<String> = percents.map(|percent| format!("{percent:.2}")).collect();
    let mut text = format!(
        "  left out     each protocol is predicted by the law fitted to the others to {} % of the largest stress\n",
        each.join(", ")
    );
    if let Some(further) = protocols.further {
        let ([x, y], [today, then]) = (further.stretches, further.standard_error_percent);
        text += &format!(
            "  further      a protocol up to stretches of {x:.3} and {y:.3} would tell most: {} ± {today:.1} % today, ± {then:.1} % with it\n",
            further.key
        );
    }
    text
}

/// Some parameters with their values.
pub fn values(parameters: &[Parameter]) -> String {
    let each = parameters.iter().map(|parameter| {
        format!(
            "{} {} {}",
            parameter.key,
            digits(parameter.value, 4),
            parameter.unit()
        )
    });
    each.collect::<Vec<_>>().join(", ")
}

/// How many terms, and what the data cover.
fn relaxation(fit: &Fit) -> String {
    let Some(relaxed) = &fit.relaxed else {
        return String::new();
    };
    let tried = relaxed.tried.iter();
    let tried: Vec<_> = tried
        .map(|(terms, aicc)| format!("{terms}: {aicc:.1}"))
        .collect();
    let material = &relaxed.material;
    let mut text = format!(
        "  terms        {} of a Prony series (AICc {})\n",
        material.relaxation.len(),
        tried.join(", ")
    );
    if let Some([low, high]) = material.covered.times {
        text += &format!(
            "  times        {} to {} s are resolved\n",
            digits(low, 4),
            digits(high, 4)
        );
    }
    if let Some([low, high]) = material.covered.rates {
        text += &format!(
            "  rates        {} to {} 1/s\n",
            digits(low, 4),
            digits(high, 4)
        );
    }
    text + &format!(
        "  at once      instantaneous stress is {:.4} times the long-term stress, to which the parameters belong\n",
        material.relaxation_function(0.0)
    )
}

/// What the cycles dissipate.
fn softening(fit: &Fit) -> String {
    let Some(softened) = &fit.softened else {
        return String::new();
    };
    let mut text = String::new();
    for (number, cycle) in softened.cycles.iter().enumerate() {
        let work = |value: f64| digits(1e3 * value, 4);
        text += &format!(
            "  cycle {:<6} to λ = {:.3}: ∮ P dλ = {} measured, {} fitted (closed form {}), {} kJ/m³ dissipated by softening\n",
            number + 1,
            cycle.stretch,
            work(cycle.measured),
            work(cycle.fitted),
            work(cycle.closed_form),
            work(cycle.dissipated),
        );
    }
    text
}

fn parameters(fit: &Fit) -> String {
    if fit.parameters.is_empty() {
        return String::new();
    }
    let quality = &fit.quality;
    let mut text = format!("  weighting    {}\n", fit.settings.weighting.describe());
    if let Some(verdict) = &quality.verdict {
        text += &format!("  residuals    {}\n", verdict.sentence());
    }
    let keys = fit.parameters.iter().map(|parameter| parameter.key.len());
    let width = keys.max().unwrap_or(0).max(12);
    for (index, (parameter, estimate)) in fit.parameters.iter().zip(&quality.estimates).enumerate()
    {
        let (key, unit, value) = (parameter.key, parameter.unit(), digits(parameter.value, 6));
        let [low, high] = estimate.interval.map(|end| digits(end, 5));
        let error = digits(estimate.standard_error, 2);
        text += &match (quality.at_bound[index], quality.has_intervals()) {
            _ if quality.held[index] => {
                format!("  {key:<width$} {value} {unit}   held, not fitted\n")
            }
            (true, _) => format!("  {key:<width$} {value} {unit}   at a bound\n"),
            (_, false) => format!("  {key:<width$} {value} {unit}   no interval\n"),
            _ => format!("  {key:<width$} {value} ± {error} {unit}   95 % {low} … {high}\n"),
        };
    }
    text
}

fn figures(fit: &Fit) -> String {
    let quality = &fit.quality;
    let residuals = if fit.parameters.is_empty() {
        "  the curve is used as measured; nothing is fitted\n".to_owned()
    } else {
        format!(
            "  RMSE {:.4e} MPa, NMAD {:.3} %, R² {:.6}, AICc {}, largest relative error {:.2} %, sum of squares {} MPa²\n",
            quality.rmse,
            quality.nmad_percent,
            quality.r_squared,
            criterion(quality.aicc),
            quality.largest_relative_error_percent,
            digits(quality.sum_of_squares, 6)
        )
    };
    format!(
        "{residuals}  moduli       E₀ = {:.6} MPa, μ₀ = {:.6} MPa\n",
        fit.fitted.youngs_modulus(),
        fit.fitted.shear_modulus()
    )
}

fn correlation(fit: &Fit) -> String {
    let matrix = &fit.quality.correlation;
    let keys: Vec<&str> = fit.parameters.iter().map(|one| one.key).collect();
    if keys.len() < 2 {
        return String::new();
    }
    // Names may be wider than a column of figures.
    let table =
        Table::of(0..keys.len()).column("correlation", |i| format!("{} {}", i + 1, keys[*i]));
    let table = (0..keys.len()).fold(table, |table, j| {
        table.column((j + 1).to_string(), |i| match matrix[(*i, j)] {
            known if known.is_finite() => format!("{known:.4}"),
            _ => "–".to_owned(),
        })
    });
    indented(table)
}

/// A table below the lines of one law.
fn indented<T>(table: Table<T>) -> String {
    textwrap::indent(&table.block().plain(), "  ")
}

/// Nominal stresses of the usual tests; `note` says more about one of them.
pub fn curves(
    law: &dyn HyperelasticLaw,
    range: [f64; 2],
    note: &dyn Fn(Option<Mode>) -> &'static str,
) -> String {
    let samples = samples(law, range);
    let stretches: Vec<f64> = samples[0]
        .points
        .iter()
        .map(|[stretch, _]| *stretch)
        .collect();
    let table = Table::of(samples).column("nominal stress [MPa]", |sample| {
        let shear = if sample.mode.is_none() {
            ", γ = λ − 1"
        } else {
            ""
        };
        format!("{}{shear} {}", sample.name(), note(sample.mode))
    });
    let stretches = stretches.iter().enumerate();
    indented(stretches.fold(table, |table, (index, stretch)| {
        table.column(format!("λ = {stretch:.3}"), |sample| {
            digits(sample.points[index][1], 5)
        })
    }))
}

/// AICc, which parameters as many as points do not have.
fn criterion(aicc: f64) -> String {
    if aicc.is_finite() {
        format!("{aicc:.2}")
    } else {
        "none".to_owned()
    }
}

/// Why a law is written that is not the first one, of that name and value of the criterion; nothing where it is.
pub fn chosen(best: &Fit, criterion: Criterion, (first, value): (&str, f64)) -> String {
    if best.law.name == first {
        return String::new();
    }
    let reason = if best.quality.is_stable() && best.quality.is_identifiable() {
        "the first that is stable over the data and whose parameters are all identifiable"
    } else {
        "the first that is stable over the data"
    };
    format!(
        "{} is written, {reason}; its {} above that of {first}\n\n",
        best.law.name,
        match criterion {
            Criterion::Aicc => format!("AICc is {:.1}", best.quality.aicc - value),
            Criterion::LeftOut => format!(
                "error of protocols that were left out is {:.2} %",
                criterion.value(best) - value
            ),
        }
    )
}

/// The laws by their criterion.
pub fn ranking(fits: &[Fit], reasons: &[String]) -> String {
    let left_out = |fit: &Fit| {
        let percent = fit.protocols.as_ref().map(|all| all.all_left_out_percent());
        percent.map_or("–".to_owned(), |percent| format!("{percent:.2}"))
    };
    let table = Table::of(fits)
        .column("law", |fit| fit.law.name.to_owned())
        .column("parameters", |fit| fit.parameters.len().to_string())
        .column("AICc", |fit| criterion(fit.quality.aicc))
        .column("RMSE [MPa]", |fit| format!("{:.4e}", fit.quality.rmse))
        .column("NMAD [%]", |fit| format!("{:.3}", fit.quality.nmad_percent))
        .column("largest relative error [%]", |fit| {
            format!("{:.2}", fit.quality.largest_relative_error_percent)
        })
        .column("left out [%]", |fit| left_out(fit))
        .column("stable over the data", |fit| yes(fit.quality.is_stable()))
        .column("all parameters identifiable", |fit| {
            yes(fit.quality.is_identifiable())
        });
    let reasons = reasons.iter().map(|reason| format!("left out: {reason}\n"));
    table.block().plain() + &reasons.collect::<String>() + "\n"
}

fn yes(holds: bool) -> String {
    (if holds { "yes" } else { "no" }).to_owned()
}

/// Refitted parameters that differ by less than this share of their standard errors are the same.
const SAME: f64 = 1e-3;

/// The parameters of a card and those found again, and whether they are the same.
pub fn refit(card: &Card, fit: &Fit, tests: &[TestData]) -> (String, bool) {
    let mut text = format!("{}: {}\n", card.name, card.title);
    let mut worst = 0.0_f64;
    let old = card.fitted_values();
    let value = |key: &str| {
        let known = old.iter().find(|(known, _)| known == key);
        known.map_or(f64::INFINITY, |(_, value)| *value)
    };
    let parameters = fit.parameters.iter().map(|new| (value(new.key), new));
    for ((old, new), estimate) in parameters.zip(&fit.quality.estimates) {
        let change = (new.value - old).abs();
        // A parameter at a bound has no standard error.
        let scale = match estimate.standard_error {
            error if error > 0.0 => error,
            _ => 1e-3 * old.abs().max(f64::MIN_POSITIVE),
        };
        worst = worst.max(change / scale);
        text += &format!(
            "  {:<12} card {:.8e}   refitted {:.8e} {}   {:.1e} standard errors apart\n",
            new.key,
            old,
            new.value,
            new.unit(),
            change / scale
        );
    }
    for test in tests {
        for one in &test.observations {
            let [old, new] = [&*card.law, &*fit.fitted].map(|law| test.stress_of(law, one));
            worst = worst.max((old - new).abs() / (1e-3 * test.largest_stress));
        }
    }
    let same = worst <= SAME;
    let verdict = if same {
        "the card is the fit of its data"
    } else {
        "DIFFERENT: the card is not the fit of its data"
    };
    text += &format!("  {verdict}\n");
    (text, same)
}
