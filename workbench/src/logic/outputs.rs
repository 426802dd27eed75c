//! Exports of a view, written in the background by the library's own writers.

use std::io::{Cursor, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use gelbench::budget::Budget;
use gelbench::document::with_files;
use gelbench::error::Error;
use gelbench::kinds;
use gelbench::output::{self, vtk};
use gelbench::results::{Drawing, Grid, Sheet};
use gelbench::studies::Progress;
use gelbench_base::document::name_of;
use gelbench_report::results::models::MODELS;
use gelbench_report::results::{FieldFigure, LineChart, Panel, PictureFormat, PictureStyle};

use super::background::Worker;
use super::engine::{Bodies, Fault};
use super::field::{self, FieldQuestion};
use super::scene::{Colour, Model, Scene};
use super::studies::{NamedFile, StudyQuestion, paths};

/// The formats that are offered.
pub const FORMATS: [(&str, PictureFormat); 2] =
    [("PNG", PictureFormat::Png), ("SVG", PictureFormat::Svg)];

/// The field of a model as it is shown: ux, uy of node after node in mm, and the values that colour the nodes.
pub type ShownField = (Model, Vec<f64>, Vec<f64>);

/// What is to be exported.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub enum Wanted {
    /// A picture under a name without its ending.
    Picture(String, Drawing, PictureFormat),
    /// The lines of a chart as a table, under a name without its ending.
    Lines(String, LineChart),
    /// A sheet: the fields of its models, with the stresses and strains that follow, as VTK files.
    Vtk(Scene, Vec<ShownField>),
    /// Places, displacements and colours of the nodes of its models as tables.
    Nodes(Scene, Vec<ShownField>),
    /// A sheet as it is shown.
    SheetPicture(Scene, Vec<ShownField>, PictureFormat),
    /// Everything that `gelbench correct` writes.
    Correction(Box<FieldQuestion>),
    /// Everything that `gelbench run` writes.
    Study(StudyQuestion),
}

/// An export: its name, and its files.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Written {
    /// The name of a folder for them.
    pub name: String,
    /// The files.
    pub files: Vec<NamedFile>,
}

impl Written {
    /// A single file.
    pub fn file(file: NamedFile) -> Self {
        Self {
            name: file.0.clone(),
            files: vec![file],
        }
    }
}

/// Writes an export.
#[derive(Default)]
pub struct Writer;

impl Worker for Writer {
    type Question = Wanted;
    type Answer = Result<Written, Fault>;
    const NAME: &'static str = "writer";

    fn answer(&mut self, wanted: &Wanted) -> Result<Written, Fault> {
        let written = |name: &str, files| {
            Ok(Written {
                name: name.to_owned(),
                files,
            })
        };
        match wanted {
            Wanted::Picture(name, drawing, format) => {
                written(name, vec![picture(name, drawing, *format)?])
            }
            Wanted::Lines(name, chart) => written(
                name,
                vec![(format!("{name}.csv"), lines(chart).into_bytes())],
            ),
            Wanted::Vtk(scene, fields) => written("sheet", grids(scene, fields)?),
            Wanted::Nodes(scene, fields) => written("sheet", nodes(scene, fields)?),
            Wanted::SheetPicture(scene, fields, format) => {
                let figure = Drawing::from(figure(scene, fields)?);
                written("sheet", vec![picture("sheet", &figure, *format)?])
            }
            Wanted::Correction(question) => written(question.stem(), field::files(question)?),
            Wanted::Study(question) => {
                let name = question.study.trim_end_matches(".toml");
                written(name, study(question)?)
            }
        }
    }
}

fn picture(name: &str, drawing: &Drawing, format: PictureFormat) -> Result<NamedFile, Fault> {
    let ending = name_of(&PictureFormat::NAMES, format);
    match output::picture(drawing, format, &PictureStyle::default()) {
        Ok(bytes) => Ok((format!("{name}.{ending}"), bytes)),
        Err(fault) => Err(Fault {
            message: format!("the picture cannot be drawn: {fault}"),
            advice: "its numbers can be saved as a table".to_owned(),
        }),
    }
}

/// Every point of every line: `line, x, y` with the words of the axes.
fn lines(chart: &LineChart) -> String {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut text = format!(
        "line,{},{}\n",
        quoted(&chart.x.label),
        quoted(&chart.y.label)
    );
    for line in &chart.lines {
        let label = quoted(&line.label);
        text.extend(
            line.points
                .iter()
                .map(|[x, y]| format!("{label},{x},{y}\n")),
        );
    }
    text
}

/// The name of a model in names of files, as `gelbench run` writes it.
fn file_name(model: Model) -> &'static str {
    MODELS[model as usize].key
}

fn grids(scene: &Scene, fields: &[ShownField]) -> Result<Vec<NamedFile>, Error> {
    let mut bodies = Bodies::of(scene)?;
    let mut files = Vec::new();
    for (model, displacement, _) in fields {
        bodies.body(*model)?;
        let sheet = Sheet {
            laws: (&bodies.sheet.law).into(),
            thickness: bodies.sheet.thickness,
            past: &[],
            viscous: None,
        };
        let body = bodies.built(*model);
        let grid = Grid::sheet(sheet, &body.mesh, displacement);
        files.push((format!("{}.vtu", file_name(*model)), vtk::grid(&grid)));
        if let Some(springs) = body.springs() {
            let bars = Grid::springs(springs, displacement, &[]);
            files.push(("springs.vtu".to_owned(), vtk::grid(&bars)));
        }
    }
    Ok(files)
}

/// The column of what colours a sheet.
fn column(colour: Colour) -> &'static str {
    match colour {
        Colour::Displacement => "displacement_mm",
        Colour::Stretch => "larger_principal_stretch",
        Colour::Stress => "von_mises_stress_MPa",
        Colour::Distance => "distance_to_finite_elements_mm",
    }
}

fn nodes(scene: &Scene, fields: &[ShownField]) -> Result<Vec<NamedFile>, Error> {
    let mut bodies = Bodies::of(scene)?;
    let mut files = Vec::new();
    for (model, displacement, values) in fields {
        let mesh = &bodies.body(*model)?.mesh;
        let mut text = format!("node,X_mm,Y_mm,ux_mm,uy_mm,{}\n", column(scene.look.colour));
        let rows = mesh.nodes.iter().zip(displacement.chunks_exact(2));
        for (node, ([x, y], u)) in rows.enumerate() {
            let value = values.get(node).map_or(String::new(), f64::to_string);
            text += &format!("{node},{x},{y},{},{},{value}\n", u[0], u[1]);
        }
        let name = format!("nodes_{}.csv", file_name(*model));
        files.push((name, text.into_bytes()));
    }
    Ok(files)
}

fn figure(scene: &Scene, fields: &[ShownField]) -> Result<FieldFigure, Error> {
    let mut bodies = Bodies::of(scene)?;
    let mut panels = Vec::new();
    for (model, displacement, values) in fields {
        let mesh = &bodies.body(*model)?.mesh;
        let value = |node: usize| values.get(node).copied().unwrap_or(f64::NAN);
        panels.push(Panel::at_nodes(model.name(), mesh, displacement, &value));
    }
    let title = format!("The grip at {}", scene.grip);
    Ok(FieldFigure::new(title, scene.look.colour.name(), panels))
}

/// Everything that the command writes for a study.
fn study(question: &StudyQuestion) -> Result<Vec<NamedFile>, Error> {
    with_files(paths(&question.files), || {
        let study = kinds::read(Path::new(&question.study), Budget::USUAL)?;
        let results = study.compute(Progress::silent())?;
        let mut files = Vec::new();
        output::write(&results, true, &mut files)?;
        Ok(files)
    })
}

/// Files as one archive, as a browser gives them out.
///
/// # Errors
/// Why there is none, such as two files of one name.
pub fn archive(files: &[NamedFile]) -> Result<Vec<u8>, String> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default();
    for (name, content) in files {
        let begun = archive.start_file(name.as_str(), options);
        begun.map_err(|cause| format!("{name}: {cause}"))?;
        let written = archive.write_all(content);
        written.map_err(|cause| format!("{name}: {cause}"))?;
    }
    let finished = archive.finish();
    finished
        .map(Cursor::into_inner)
        .map_err(|cause| cause.to_string())
}

#[cfg(test)]
mod tests;
