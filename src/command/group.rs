//! `gelbench materials group`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::fit::a_law;
use super::fit_message::values;
use super::interrupt;
use super::parameter_bounds::ParameterBounds;
use super::pictures::StyleOptions;
use super::progress::report_files;
use super::terminal::{Outcome, Printed, print, print_report, warn};
use super::test_reading::{ReadingArguments, read_tests};
use gelbench_base::error::Error;
use gelbench_base::statistics::Estimate;
use gelbench_calibration::calibration::{
    Conversion, FitSettings, Group, GroupState, Provenance, StrainColumn, TestData, Weighting,
    card_text,
};
use gelbench_mechanics::material::registry::Law;
use gelbench_report::output::{ResultFolder, write_picture};
use gelbench_report::results::{
    NamedGroup, PictureStyle, Table, digits, group_json, group_picture, group_table,
};

#[derive(Args)]
pub struct GroupArguments {
    /// Files of test data, one a specimen
    #[arg(required = true, num_args = 2..)]
    data: Vec<PathBuf>,
    /// The specimens of another group, with which the first one is compared
    #[arg(long, num_args = 2.., value_name = "DATA")]
    against: Vec<PathBuf>,
    /// The law
    #[arg(long, value_parser = a_law())]
    law: &'static Law,
    /// Names of the groups
    #[arg(long, value_delimiter = ',', default_value = "first,second")]
    names: Vec<String>,
    #[command(flatten)]
    parameters: ParameterBounds,
    /// Name of the written files
    #[arg(long, default_value = "group")]
    name: String,
    /// Write into this folder
    #[arg(long, value_name = "FOLDER", default_value = "output/materials")]
    output: PathBuf,
    #[command(flatten)]
    reading: ReadingArguments,
    #[command(flatten)]
    printed: Printed,
    #[command(flatten)]
    style: StyleOptions,
}

/// Fits every specimen, averages, compares and writes.
pub fn group(arguments: GroupArguments) -> Outcome {
    arguments.printed.choose();
    let groups = if arguments.against.is_empty() { 1 } else { 2 };
    if arguments.names.len() < groups {
        let message = format!("--names has {} for {groups} groups", arguments.names.len());
        return Err(Error::input(message, "such as --names control,treated"));
    }
    if groups == 2 && arguments.names[0] == arguments.names[1] {
        let message = format!("both groups have the name `{}`", arguments.names[0]);
        return Err(Error::input(message, "such as --names control,treated"));
    }
    let (law, bounds) = arguments.parameters.of(arguments.law)?;
    let settings = FitSettings {
        weighting: Weighting::Absolute,
        bounds,
        ..FitSettings::default()
    };
    let reading = arguments.reading.reading()?;
    let files = [&arguments.data[..], &arguments.against[..]].concat();
    let mut tests = read_tests(&files, &reading)?;
    Group::check(&tests)?;
    let others = tests.split_off(arguments.data.len());
    let fitted = |tests: &[TestData]| Group::new(law, tests, &settings);
    let mut groups = vec![fitted(&tests)?];
    if !others.is_empty() {
        groups.push(fitted(&others)?);
    }
    let named = named(groups, arguments.names, &settings)?;
    write(
        (&arguments.output, &arguments.name),
        &arguments.style.style(),
        &files,
        &named,
    )?;
    print_report(|| group_json(&named))?;
    print(&message(&named))?;
    Ok(0)
}

/// The groups with their names, states and mean laws.
fn named(
    groups: Vec<Group>,
    names: Vec<String>,
    settings: &FitSettings,
) -> Result<Vec<NamedGroup>, Error> {
    let states: Vec<Vec<GroupState>> = match &groups[..] {
        [first, second] => vec![first.states(Some(second)), second.states(Some(first))],
        others => others.iter().map(|group| group.states(None)).collect(),
    };
    let pairs = groups.into_iter().zip(states).zip(names);
    pairs
        .map(|((group, states), name)| {
            Ok(NamedGroup {
                mean: group.mean_law(&states, settings)?,
                name,
                group,
                states,
            })
        })
        .collect()
}

/// Writes figures, table and picture, and of each group the mean as test data with its card.
fn write(
    (folder, name): (&Path, &str),
    style: &PictureStyle,
    files: &[PathBuf],
    groups: &[NamedGroup],
) -> Result<(), Error> {
    let inputs: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let mut results = interrupt::guarded(|| {
        ResultFolder::open(folder, &format!("materials group {name}"), &inputs)
    })?;
    results.add(&format!("{name}.csv"), group_table(groups).as_bytes())?;
    for entry in groups {
        let stem = format!("{name}-{}", entry.name);
        let test = entry.group.mean_test(&entry.name, &entry.states);
        let data = format!("{stem}.csv");
        let conversion = Conversion {
            stress: test.stress_measure,
            strain: StrainColumn::Stretch,
            unit: "MPa".to_owned(),
        };
        results.add(&data, conversion.table(&test)?.as_bytes())?;
        let provenance = Provenance {
            files: vec![data],
            reading: Default::default(),
            base_card: None,
        };
        let card = card_text(&entry.mean, &[test], &provenance);
        results.add(&format!("{stem}.toml"), card.as_bytes())?;
    }
    let text = format!("{:#}\n", group_json(groups));
    results.add(&format!("{name}.json"), text.as_bytes())?;
    let picture = group_picture(groups);
    let warning = write_picture(&mut results, name, &picture, style)?;
    report_files(&results.finish()?);
    warn(warning.as_slice());
    Ok(())
}

/// Mean stresses, their intervals and spread, and the difference of two groups, at a few stretches.
fn message(groups: &[NamedGroup]) -> String {
    let mut text = String::new();
    for entry in groups {
        let count = entry.group.fits.len();
        text += &format!(
            "{}: {count} specimens, {}, mean law {}\n",
            entry.name,
            entry.mean.law.name,
            values(&entry.mean.parameters)
        );
    }
    let axes = groups[0].group.tests[0].axes.len();
    let steps = usize::from(Group::STEPS);
    // The middle and the end of each protocol.
    let rows = (0..groups[0].states.len()).filter(|row| {
        let step = row / axes % steps + 1;
        step == steps / 2 || step == steps
    });
    let state = |row: &usize| &groups[0].states[*row];
    let mut table = Table::of(rows)
        .column("stretch along x", |row| {
            format!("{:.4}", 1.0 + state(row).strains[0])
        })
        .column("stretch along y", |row| {
            format!("{:.4}", 1.0 + state(row).strains[1])
        })
        .column("axis", |row| (state(row).axis + 1).to_string());
    for entry in groups {
        table = table.column(format!("{} [MPa], 95 %, spread", entry.name), |row| {
            let stress = entry.states[*row].stress;
            let between = digits(stress.between, 2);
            format!("{} {between}", with_interval(&stress.estimate(), 4))
        });
    }
    if let [first, second] = groups {
        table = table.column("difference [MPa], 95 %", |row| {
            let [first, second] = [first, second].map(|entry| &entry.states[*row].stress);
            with_interval(&first.difference(second), 3)
        });
    }
    text + &table.block().plain()
}

/// `0.0123 (0.011 … 0.014)`.
fn with_interval(estimate: &Estimate, value_digits: i32) -> String {
    let [low, high] = estimate.interval.map(|end| digits(end, 3));
    format!("{} ({low} … {high})", digits(estimate.value, value_digits))
}
