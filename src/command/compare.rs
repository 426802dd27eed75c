//! `gelbench compare`: the models of a study compared with a displacement field of another program.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use serde_json::{Value, json};

use super::arguments::{Large, quantity};
use super::correct::values::unit;
use super::interrupt;
use super::progress::{Progress, report_files};
use super::terminal::{Outcome, Printed, print, print_report, warn};
use crate::kinds;
use gelbench_base::error::{Diagnostic, Error};
use gelbench_base::units::Dimension;
use gelbench_mechanics::markers::Mistake;
use gelbench_mechanics::material::HyperelasticLaw;
use gelbench_mechanics::mesh::Mesh;
use gelbench_mechanics::problem::{Region, SheetLaws};
use gelbench_report::compare::imported::{
    Difference, ExternalField, ImportSettings, Mismatch, ModelField, ModelFields, Sites,
};
use gelbench_report::output::{self, ResultFolder};
use gelbench_report::results::models::FINITE_ELEMENTS;
use gelbench_report::results::{Array, Block, Grid, GridSeries, Sheet, Table};
use gelbench_studies::studies;
use gelbench_studies::studies::sections;
use gelbench_studies::studies::specimen::{self, Along, Specimen};

/// What the command line says about a comparison.
#[derive(Args)]
pub struct Options {
    /// The study file, of kind plate or specimen
    pub study: PathBuf,
    /// The field: .vtu, .vtk, CalculiX' .frd, or .csv with X, Y, ux, uy
    pub field: PathBuf,
    /// The load factor or stretch, such as 0.5 or "50 %"; the last one of the study if omitted
    #[arg(long, visible_alias = "stretch", value_name = "FACTOR", value_parser = ratio, allow_hyphen_values = true)]
    pub factor: Option<f64>,
    /// The file's unit of length, mm if neither the file nor this option states it. It corrects the header of a table whose
    /// columns all state one other unit
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    pub unit: Option<f64>,
    /// Columns of a table to ignore; other unknown columns are refused
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    pub ignore_columns: Vec<String>,
    /// The array of a VTK file
    #[arg(long, value_name = "NAME")]
    pub array: Option<String>,
    /// The time of the step in a .frd file or of the rows in a column `time`, if it differs from the load factor
    #[arg(long, value_name = "TIME")]
    pub time: Option<f64>,
    /// Write a report and VTU files with the differences into this folder
    #[arg(long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub large: Large,
    #[command(flatten)]
    pub printed: Printed,
}

/// A larger stretch that the study does not reach was intended in percent.
const PERCENTAGE: f64 = 5.0;

/// What is compared, before and after it is computed.
struct Comparison {
    title: String,
    law: Arc<dyn HyperelasticLaw>,
    regions: Vec<Region>,
    thickness: f64,
    factor: f64,
    imported: ExternalField,
    sites: Sites,
    /// The doubt about the file's unit of length that its places raise.
    unit: Option<Diagnostic>,
    models: ModelFields,
}

/// Compares, prints, and writes the requested files.
pub fn run(options: Options) -> Outcome {
    options.printed.choose();
    let compared = compute(&options)?;
    for end in &compared.models.ends {
        let hint = "the other models are compared without it";
        warn(&[Diagnostic::warning("", end.to_string()).hint(hint)]);
    }
    let fields = compared.models.fields.iter();
    let differences = fields.map(|field| compared.sites.difference(field));
    let differences: Result<Vec<Difference>, Mismatch> = differences.collect();
    let differences = differences.map_err(|reason| {
        let message = format!("the field of {} {reason}", options.field.display());
        Error::input(
            message,
            "deviations relative to it do not exist; choose a step with a load",
        )
    })?;
    print(&summary(&compared, &differences))?;
    let doubts = doubts(&compared, &differences);
    warn(&doubts);
    print_report(|| json(&compared, &differences, &doubts, &options.field))?;
    if let Some(folder) = &options.output {
        let inputs = [&*options.study, &*options.field];
        let mut results = interrupt::guarded(|| ResultFolder::open(folder, "compare", &inputs))?;
        warn(results.replaces().as_slice());
        warn(&write(
            &compared,
            &differences,
            &doubts,
            &options.field,
            &mut results,
        )?);
        report_files(&results.finish()?);
        print(&format!("report: {}\n", folder.join("report.md").display()))?;
    }
    Ok(u8::from(!doubts.is_empty()))
}

/// Computes what is compared.
fn compute(options: &Options) -> Result<Comparison, Error> {
    let path = &options.study;
    let text = sections::read_text(path)?;
    let shown = Progress::of(0);
    let report = |what: &str| shown.report(what);
    let progress = studies::Progress::to(&report);
    let read = kinds::read_sheet(path, &text, options.large.budget())?;
    warn(&read.warnings);
    let (title, specimen) = (read.title, read.content);
    let last = specimen.factors[specimen.factors.len() - 1];
    let factor = options.factor.unwrap_or(last);
    check_factor(&specimen, factor, last)?;
    let lattice = specimen.outline.lattice();
    let (imported, sites) = import(options, factor, &lattice)?;
    let unit = window(options, &sites, &lattice);
    Ok(Comparison {
        title,
        law: Arc::clone(&specimen.problem.law),
        regions: specimen.problem.regions.clone(),
        thickness: specimen.problem.thickness,
        factor,
        imported,
        sites,
        unit,
        models: specimen::fields(specimen, factor, progress)?,
    })
}

/// Refuses load factors that a study does not have.
fn check_factor(specimen: &Specimen, factor: f64, last: f64) -> Result<(), Error> {
    let is_stretch = specimen.along == Along::Stretch;
    if is_stretch && factor.abs() > last.abs().max(PERCENTAGE) {
        let message = format!("--factor {factor} is a stretch of {} %", 100.0 * factor);
        let hint = format!("write --factor \"{factor} %\" if percent is meant");
        return Err(Error::input(message, hint));
    }
    if !is_stretch && factor < 0.0 {
        let message = format!(
            "the load factor {factor} is negative, and load factors of a specimen begin at zero"
        );
        return Err(Error::input(
            message,
            "reverse the signs of supports and loads in the study",
        ));
    }
    Ok(())
}

/// Reads the field, before anything is computed, and places it on the specimen.
fn import(options: &Options, factor: f64, lattice: &Mesh) -> Result<(ExternalField, Sites), Error> {
    let settings = ImportSettings {
        unit: options.unit,
        array: options.array.clone(),
        factor,
        time: options.time,
        ignored_columns: options.ignore_columns.clone(),
    };
    let imported = ExternalField::read(&options.field, &settings)?;
    let sites = imported.sites(lattice).map_err(|reason| {
        let message = format!("{}: {reason}", options.field.display());
        Error::input(
            message,
            "give places at rest in the axes of the study, and their unit with --unit",
        )
    })?;
    Ok((imported, sites))
}

/// Warns of places that span a part of the specimen; a doubt where in another unit of length, and none is stated, they would span all of it.
fn window(options: &Options, sites: &Sites, lattice: &Mesh) -> Option<Diagnostic> {
    let message = sites.window(lattice)?;
    let other = sites.other_unit(lattice).filter(|_| options.unit.is_none());
    let Some(unit) = other else {
        let hint = "if the field is that of a whole specimen, this study has another size";
        warn(&[Diagnostic::warning("", message).hint(hint)]);
        return None;
    };
    let message = format!("{message}; in {unit} they would span all of it");
    let hint =
        format!("state the file's unit with --unit {unit}, or with --unit mm if they are a window");
    Some(Diagnostic::warning("", message).hint(hint))
}

/// Displacements that all models find written with one mistake, or larger or smaller by one factor, be it the ratio of two
/// units or of two load factors.
fn doubts(compared: &Comparison, differences: &[Difference]) -> Vec<Diagnostic> {
    let ratios: Option<Vec<f64>> = differences.iter().map(Difference::other_unit).collect();
    let ratio = ratios.filter(|ratios| ratios.iter().all(|ratio| *ratio == ratios[0]));
    let of_places = compared.unit.clone();
    let of_displacements = ratio.map(|ratios| {
        let relation = if differences[0].factor.abs() > 1.0 { "small" } else { "large" };
        let message = format!(
            "the imported displacements are about {} times too {relation}, as if in another unit of length",
            ratios[0]
        );
        Diagnostic::warning("", message).hint("state the file's unit with --unit")
    });
    let mistake = differences.first().and_then(|first| first.mistake);
    let of_all = |mistake: &Mistake| differences.iter().all(|one| one.mistake == Some(*mistake));
    let of_writing = mistake.filter(of_all).map(|mistake| {
        let (seems, hint) = mistake.words();
        Diagnostic::warning("", format!("the imported field seems to be {seems}")).hint(hint)
    });
    let scaled = differences.iter().all(Difference::is_scaled);
    let doubt = of_places.or(of_writing).or(of_displacements).or_else(|| {
        let share = 1.0 / differences[0].factor;
        let at = compared.factor;
        scaled.then(|| {
            let message = format!(
                "the imported displacements are about {share:.3} times those of the models at the load factor {at}, as if at another load factor"
            );
            Diagnostic::warning("", message).hint("state the file's load factor with --factor")
        })
    });
    let pairs = compared.models.fields.iter().zip(differences);
    let shifted = pairs.filter(|(field, difference)| {
        doubt.is_none() && field.model == FINITE_ELEMENTS.name && difference.is_shifted()
    });
    let shifted = shifted.map(|(_, difference)| shift_doubt(difference));
    let shifted: Vec<Diagnostic> = shifted.collect();
    doubt.into_iter().chain(shifted).collect()
}

/// The difference of finite elements that is mostly a rigid-body motion, which does not concern the material.
fn shift_doubt(finite_elements: &Difference) -> Diagnostic {
    let Difference {
        shift,
        percent,
        shifted_percent,
        ..
    } = finite_elements;
    let [x, y] = shift.displacement;
    let message = format!(
        "most of the finite elements' difference is a rigid-body motion by ({x:.4}, {y:.4}) mm and {:.4} degrees: without it the difference is \
         {shifted_percent:.4} instead of {percent:.4} %",
        shift.angle.to_degrees()
    );
    Diagnostic::warning("", message)
        .hint("remove it from the file, or correct the axes or the supports of the study")
}

fn summary(compared: &Comparison, differences: &[Difference]) -> String {
    format!(
        "deviation from the imported field at the load factor {} ({})\n{}{}\n",
        compared.factor,
        compared.imported.describe(),
        table(compared, differences, false).plain(),
        discretisation_error(compared)
    )
}

/// The differences of all models, for the terminal and, with their meshes, for the report.
fn table(compared: &Comparison, differences: &[Difference], with_mesh: bool) -> Block {
    Table::of(compared.models.fields.iter().zip(differences))
        .column("model", |(field, _)| field.model.to_owned())
        .column_if(with_mesh, "mesh", |(field, _)| field.mesh.describe())
        .column("displacement [%]", |(_, difference)| {
            format!("{:.4}", difference.percent)
        })
        .column("largest difference [mm]", |(_, difference)| {
            format!("{:.5}", difference.largest)
        })
        .column("at (x, y) [mm]", |(_, difference)| {
            format!(
                "({:.3}, {:.3})",
                difference.position[0], difference.position[1]
            )
        })
        .block()
}

/// A sentence on the finite elements' own error.
fn discretisation_error(compared: &Comparison) -> String {
    match compared.models.own_percent {
        Some(percent) => format!("The finite elements' own error is estimated as {percent:.4} %."),
        None => "The finite elements' own error is not known.".to_owned(),
    }
}

fn write(
    compared: &Comparison,
    differences: &[Difference],
    doubts: &[Diagnostic],
    file: &Path,
    folder: &mut ResultFolder,
) -> Result<Vec<Diagnostic>, Error> {
    let laws = SheetLaws {
        law: &compared.law,
        regions: &compared.regions,
    };
    let sheet = Sheet::elastic(laws, compared.thickness);
    for field in &compared.models.fields {
        let grid = match &compared.imported {
            ExternalField::OnMesh(imported) => {
                let (mesh, u) = (&field.mesh, &field.displacement);
                let expected = imported.mesh.displacement_on(&imported.displacement, mesh);
                Grid::sheet(sheet, mesh, u).with(Array::imported(u, &expected))
            }
            ExternalField::AtPoints(points) => {
                let displacement = compared.sites.at(field);
                let grid = Grid::scattered(&points.positions, &displacement);
                grid.with(Array::imported(&displacement, &points.displacement))
            }
        };
        let name = field.model.replace([' ', '-'], "_");
        output::write_grids(folder, &GridSeries::single(&name, grid))?;
    }
    let figures = json(compared, differences, doubts, file);
    folder.add("comparison.json", format!("{figures:#}\n").as_bytes())?;
    let mut blocks = report(compared, differences, file);
    blocks.extend(
        doubts
            .iter()
            .map(|doubt| Block::Paragraph(doubt.to_string())),
    );
    output::write_document(folder, "report", &blocks, &[])
}

/// The comparison for machines.
fn json(
    compared: &Comparison,
    differences: &[Difference],
    doubts: &[Diagnostic],
    file: &Path,
) -> Value {
    let model = |(field, difference): (&ModelField, &Difference)| {
        json!({
            "model": field.model,
            "mesh": field.mesh.describe(),
            "displacement_percent": difference.percent,
            "largest_difference_mm": difference.largest,
            "at_mm": difference.position,
        })
    };
    let models = compared.models.fields.iter().zip(differences).map(model);
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "title": compared.title,
        "field": file.file_name().unwrap_or_default().to_string_lossy(),
        "read_as": compared.imported.describe(),
        "load_factor": compared.factor,
        "models": models.collect::<Vec<_>>(),
        "finite_elements_own_error_percent": compared.models.own_percent,
        "doubts": doubts.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}

fn report(compared: &Comparison, differences: &[Difference], file: &Path) -> Vec<Block> {
    let weighting = match compared.imported {
        ExternalField::OnMesh(_) => "at the nodes of the lattice, weighted by area",
        ExternalField::AtPoints(_) => "at the imported points, all with the same weight",
    };
    vec![
        Block::Heading(1, compared.title.clone()),
        Block::Paragraph(format!(
            "Deviation of the displacement from an imported field at the load factor {}: {}, {}. Relative L2 {weighting}.",
            compared.factor,
            file.file_name().unwrap_or_default().to_string_lossy(),
            compared.imported.describe()
        )),
        table(compared, differences, true),
        Block::Paragraph(discretisation_error(compared)),
        Block::Paragraph(format!("gelbench {}", env!("CARGO_PKG_VERSION"))),
    ]
}

/// A load factor, or a stretch, which is negative where a plate is compressed.
fn ratio(text: &str) -> Result<f64, Diagnostic> {
    match quantity(text, Dimension::Ratio)? {
        0.0 => Err(Diagnostic::error("", "it must not be zero")),
        factor => Ok(factor),
    }
}
