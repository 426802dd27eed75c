//! Statistics over many runs: spreads, rank correlations, bands.

use std::collections::{HashMap, HashSet};

use serde_json::{Value, json};

use super::table::{Row, heads, names};
use gelbench_base::statistics::{quantile, rank_correlation};
use gelbench_base::units::number;
use gelbench_report::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING, ModelStyle};
use gelbench_report::results::{
    Axis, Block, Figure, Line, LineChart, PALETTE, Scale, Stroke, Table, or_dash,
};
use gelbench_studies::studies::Steps;

/// With fewer runs there is neither a spread nor a correlation.
const FEWEST: usize = 10;

/// A figure over all runs in which it exists.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    /// Its name.
    pub name: String,
    /// The number of runs in which it exists.
    pub runs: usize,
    /// The largest magnitude.
    pub largest: f64,
    /// The mean.
    pub mean: f64,
    /// The standard deviation; NaN for fewer than two runs.
    pub standard_deviation: f64,
    /// The values below which 5, 50 and 95 % of the runs lie.
    pub quantiles: [f64; 3],
    /// Spearman's rank correlation with each key; NaN where there are fewer than ten runs, or a key is not a number.
    pub rank_correlations: Vec<f64>,
}

/// All figures over all runs.
pub fn statistics(rows: &[Row]) -> Vec<Statistics> {
    let names = names(rows);
    let positions: HashMap<&str, usize> = names
        .iter()
        .enumerate()
        .map(|(position, name)| (*name, position))
        .collect();
    let mut columns: Vec<Vec<(usize, f64)>> = vec![Vec::new(); names.len()];
    for (index, row) in rows.iter().enumerate() {
        for (name, value) in &row.figures {
            columns[positions[name.as_str()]].push((index, *value));
        }
    }
    let pairs = names.iter().zip(&columns);
    pairs
        .map(|(name, column)| Statistics::of(name, column, rows))
        .collect()
}

impl Statistics {
    fn of(name: &str, column: &[(usize, f64)], rows: &[Row]) -> Self {
        let values: Vec<f64> = column.iter().map(|(_, value)| *value).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let keys = rows.first().map_or(0, |row| row.settings.len());
        let correlation = |key: usize| {
            let values_of_key = column
                .iter()
                .map(|(index, _)| rows[*index].settings[key].value());
            let settings: Option<Vec<f64>> = values_of_key.collect();
            let enough = settings.filter(|settings| settings.len() >= FEWEST);
            enough.map_or(f64::NAN, |settings| rank_correlation(&settings, &values))
        };
        Self {
            name: name.to_owned(),
            runs: values.len(),
            largest: values
                .iter()
                .fold(0.0, |most: f64, value| most.max(value.abs())),
            mean,
            standard_deviation: (square / (count - 1.0)).sqrt(),
            quantiles: [0.05, 0.5, 0.95].map(|share| quantile(&sorted, share)),
            rank_correlations: (0..keys).map(correlation).collect(),
        }
    }
}

/// The quantity and the step of a figure's name.
fn parts_of(name: &str) -> (&str, &str) {
    name.rsplit_once('@').unwrap_or((name, ""))
}

/// The figures except those that are rounding errors of the largest one of their quantity, such as a force across a symmetric plate.
fn without_rounding(all: &[Statistics]) -> impl Iterator<Item = &Statistics> {
    const ROUNDING: f64 = 1e-9;
    let mut largest: HashMap<&str, f64> = HashMap::new();
    for one in all {
        let most = largest.entry(quantity(&one.name)).or_default();
        *most = most.max(one.largest);
    }
    all.iter().filter(move |one| {
        let most = largest[quantity(&one.name)];
        one.largest > ROUNDING * most || most == 0.0
    })
}

/// The quantity of a figure, without its model, its group and its axis: `force_N` of `corrected.right.force_N.y@1`.
fn quantity(name: &str) -> &str {
    let (name, _) = parts_of(name);
    let name = name
        .strip_suffix(".x")
        .or(name.strip_suffix(".y"))
        .unwrap_or(name);
    name.rsplit('.').next().unwrap_or(name)
}

/// The figures of the last step alone. Where steps are varied, it differs between runs: the runs that reach it are taken together under one name.
fn at_last_step(rows: &[Row]) -> Vec<Row> {
    const LAST: &str = "the last step";
    let last = |row: &'_ Row| Some(parts_of(&row.figures.last()?.0).1.to_owned());
    let sound = rows.iter().filter(|row| row.fault.is_empty());
    let mut steps: Vec<String> = sound.filter_map(last).collect();
    steps.sort_unstable();
    steps.dedup();
    let common = match &steps[..] {
        [] => rows.last().and_then(last),
        [one] => Some(one.clone()),
        _ => None,
    };
    let named = common.as_deref().unwrap_or(LAST);
    let of_row = |row: &Row| {
        let last_step = last(row).filter(|_| row.fault.is_empty());
        let at = common.clone().or(last_step);
        let figures = row.figures.iter().filter_map(|(name, value)| {
            let (quantity, step) = parts_of(name);
            (at.as_deref() == Some(step)).then(|| (format!("{quantity}@{named}"), *value))
        });
        Row {
            number: row.number,
            settings: row.settings.clone(),
            figures: figures.collect(),
            passed: row.passed,
            fault: row.fault.clone(),
            warnings: Vec::new(),
        }
    };
    rows.iter().map(of_row).collect()
}

/// The report.
pub fn blocks(title: &str, keys: &[String], rows: &[Row], figures: &[Figure]) -> Vec<Block> {
    let all = statistics(&at_last_step(rows));
    let cell = |value: f64| or_dash(value.is_finite().then_some(value), number);
    let mut table = Table::of(without_rounding(&all))
        .column("figure of the last step", |one| one.name.clone())
        .column("runs", |one| one.runs.to_string())
        .column("mean", |one| cell(one.mean))
        .column("standard deviation", |one| cell(one.standard_deviation))
        .column("5 %", |one| cell(one.quantiles[0]))
        .column("median", |one| cell(one.quantiles[1]))
        .column("95 %", |one| cell(one.quantiles[2]));
    for (index, key) in keys.iter().enumerate() {
        let head = format!("rank correlation with {key}");
        table = table.column(head, |one| cell(one.rank_correlations[index]));
    }
    let varied = heads(keys, rows);
    let mut blocks = vec![
        Block::heading(title),
        Block::paragraph(format!(
            "{} runs; varied: {}. The figures of all runs are in sweep.csv, one line per run.",
            rows.len(),
            varied.join(", ")
        )),
        table.block(),
        Block::paragraph(format!(
            "Quantiles are interpolated linearly between runs. Rank correlations are Spearman's, from at least {FEWEST} runs: 1 if a figure always \
             rises with a key, −1 if it always falls."
        )),
    ];
    blocks.extend(cautions(rows).into_iter().map(Block::paragraph));
    let pictures = figures.iter().enumerate();
    blocks.extend(pictures.map(|(index, figure)| Block::Figure(index, figure.caption.clone())));
    blocks
}

/// Warnings about the runs together: figures that some lack, and the warnings of single runs, each once.
pub fn cautions(rows: &[Row]) -> Vec<String> {
    let failed = rows.iter().filter(|row| !row.fault.is_empty()).count();
    let biased = (failed > 0).then(|| {
        format!(
            "{failed} of {} runs have no solution, or none at their last steps, or were drawn outside the admissible range of a study (column \
             `fault` of sweep.csv): means, quantiles and bands there are computed from the other runs only, and are biased unless runs fail at \
             random.",
            rows.len()
        )
    });
    let mut kinds: Vec<(String, &Row, &str, usize)> = Vec::new();
    for row in rows {
        let mut seen = HashSet::new();
        for warning in &row.warnings {
            let kind = kind(warning);
            if !seen.insert(kind.clone()) {
                continue;
            }
            match kinds.iter_mut().find(|(known, ..)| *known == kind) {
                Some((.., count)) => *count += 1,
                None => kinds.push((kind, row, warning, 1)),
            }
        }
    }
    let warnings = kinds.into_iter().map(|(_, row, warning, count)| {
        let others = match count {
            1 => String::new(),
            2 => " and another".to_owned(),
            count => format!(" and {} others", count - 1),
        };
        format!("Run {}{others}: {warning}", row.number)
    });
    biased.into_iter().chain(warnings).collect()
}

/// A warning without its numbers: the same in runs in which they alone differ.
fn kind(warning: &str) -> String {
    let is_of_number = |c: char| c.is_ascii_digit() || ".,-−+e… ".contains(c);
    warning.chars().filter(|c| !is_of_number(*c)).collect()
}

/// For machines: the statistics of every figure.
pub fn json(keys: &[String], rows: &[Row]) -> Value {
    let figures = statistics(rows).into_iter().map(|one| {
        json!({
            "name": one.name,
            "runs": one.runs,
            "mean": one.mean,
            "standard_deviation": one.standard_deviation,
            "quantiles_5_50_95_percent": one.quantiles,
            "rank_correlations": one.rank_correlations,
        })
    });
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "keys": heads(keys, rows),
        "runs": rows.len(),
        "failed": rows.iter().filter(|row| !row.fault.is_empty()).count(),
        "warnings": cautions(rows),
        "figures": figures.collect::<Vec<_>>(),
    })
}

/// Pictures: the band of every model's force over the steps, and the force of the last step over each key.
/// `along` is what steps run along.
pub fn figures(keys: &[String], rows: &[Row], along: Steps) -> Vec<Figure> {
    let (all, heads) = (statistics(rows), heads(keys, rows));
    let forces: Vec<&Statistics> = all.iter().filter(|one| is_force(&one.name)).collect();
    let band = band(&forces, along).map(|chart| {
        Figure::new(
            "band.png",
            "The forces of all runs: medians, and the band between the 5 % and 95 % quantiles.",
            chart,
        )
    });
    let rows = at_last_step(rows);
    let at_last = statistics(&rows);
    let force = at_last
        .iter()
        .find(|one| is_force(&one.name) && one.name.starts_with("corrected"));
    let over = force.into_iter().flat_map(|force| {
        let at = along.describe(parts_of(&force.name).1);
        let keys_and_heads = keys.iter().zip(&heads).enumerate();
        let figures = keys_and_heads.filter_map(|(index, (key, head))| {
            let points = points_over(&rows, index, &force.name)?;
            Some(force_over(key, head, &at, points))
        });
        figures.collect::<Vec<_>>()
    });
    band.into_iter().chain(over).collect()
}

/// A figure over one of the settings, for all runs that have the figure; `None` where a setting is no number.
fn points_over(rows: &[Row], setting: usize, figure: &str) -> Option<Vec<[f64; 2]>> {
    rows.iter()
        .filter_map(|row| Some((row, row.figure(figure)?)))
        .map(|(row, value)| Some([row.settings[setting].value()?, value]))
        .collect()
}

/// The picture of the corrected model's force over a key.
fn force_over(key: &str, head: &str, at: &str, points: Vec<[f64; 2]>) -> Figure {
    let chart = LineChart::new(
        format!("Force over {key}"),
        Axis::new(head, Scale::Interval),
        Axis::new(&format!("force at {at} [N]"), Scale::Interval),
        vec![Line::new("", points, PALETTE[0], Stroke::Points)],
    );
    let caption =
        format!("The force of the corrected model at {at} over {key}: a point for each run.");
    let name = format!("force_over_{}.png", key.replace('.', "_"));
    Figure::new(name, caption, chart)
}

/// Whether a figure is the force of a model as a whole: not that of a group, nor an error.
fn is_force(name: &str) -> bool {
    let (quantity, _) = parts_of(name);
    matches!(
        quantity.split_once('.'),
        Some((_, "force_N" | "measured_N"))
    )
}

/// The medians of all models over the steps, and the band of the corrected model, or the first one; `None` where there are fewer than
/// two steps, or too few runs.
fn band(forces: &[&Statistics], along: Steps) -> Option<LineChart> {
    let mut lines = Vec::new();
    // The band of the corrected model is the filled one.
    for ModelStyle { name, key, colour } in [CORRECTED, MASS_SPRING, FINITE_ELEMENTS] {
        let band_forces = forces
            .iter()
            .filter(|one| one.name.split('.').next() == Some(key) && one.runs >= FEWEST);
        // In the order of the path: a load factor may occur again, its second time as `0.3#2`.
        let at = |one: &Statistics| {
            let (_, at) = one.name.rsplit_once('@')?;
            let at = at.split('#').next()?.parse().ok()?;
            Some(along.coordinate(at))
        };
        let steps: Vec<(f64, [f64; 3])> = band_forces
            .filter_map(|one| Some((at(one)?, one.quantiles)))
            .collect();
        if steps.len() < 2 {
            continue;
        }
        let stroke = if lines.is_empty() {
            let there = steps.iter().map(|(at, [low, ..])| [*at, *low]);
            let back = steps.iter().rev().map(|(at, [.., high])| [*at, *high]);
            let label = format!("{name}, 5 … 95 %");
            lines.push(Line::new(label, there.chain(back), colour, Stroke::Filled));
            Stroke::Solid
        } else {
            Stroke::Dashed
        };
        let middle = steps.iter().map(|(at, [_, middle, _])| [*at, *middle]);
        lines.push(Line::new(format!("{name}, median"), middle, colour, stroke));
    }
    (!lines.is_empty()).then(|| {
        LineChart::new(
            "Forces of all runs",
            Axis::new(along.head(), Scale::Interval),
            "force [N]",
            lines,
        )
    })
}
