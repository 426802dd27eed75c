//! Measured displacement fields.

use std::collections::BTreeMap;
use std::path::PathBuf;

use gelbench::document::{TextEncoding, with_files};
use gelbench::error::Error;
use gelbench::estimation::FieldEstimate;
use gelbench::markers::{ChosenColumns, Frame, ReadSettings};
use gelbench::material::Card;
use gelbench::mesh::{CellShape, Exemptions, MeshReading};
use gelbench::results::GridSeries;
use gelbench::studies::markers::{Conditions, MarkerStudy, MeshSource, Request};
use gelbench::units::{self, Dimension};
use gelbench_studies::studies::markers::worst_answer;
use gelbench_studies::studies::markers::written::{self, FrameFiles, SERIES};
use gelbench_studies::studies::pictures::Pictures;
use pyo3::prelude::*;
use std::time::Instant;

use crate::errors::{choice, input, refused};
use crate::images::ImageOptions;
use crate::material::{MaterialCard, watched};
use crate::results::{OfFrames, Results};
use crate::running::run;
use crate::study::budget;

/// How a field is read, and on which mesh it is corrected: everything but files, material, thickness and what is known.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Options {
    unit: Option<String>,
    array: Option<String>,
    grid: Option<f64>,
    ignore_columns: Vec<String>,
    columns: Vec<String>,
    encoding: Option<String>,
    y_axis: Option<String>,
    places: Option<String>,
    rest: Option<PathBuf>,
    mesh: Option<PathBuf>,
    mesh_unit: String,
    merge_nodes: Option<f64>,
    allow: Vec<String>,
    outline: Option<PathBuf>,
    forces: Option<PathBuf>,
    cell_size: Option<f64>,
    refine: bool,
    cells: String,
    holes: bool,
    regions: Vec<(String, Py<MaterialCard>)>,
    images: ImageOptions,
    /// Tables and meshes in memory, by the names that stand for them.
    in_memory: BTreeMap<PathBuf, Vec<u8>>,
    allow_large: bool,
}

impl Options {
    fn reading(&self) -> Result<ReadSettings, Error> {
        let columns = ChosenColumns::parse(self.columns.iter().map(String::as_str));
        let encoding = self.encoding.as_deref().map(|name| {
            let unknown = || {
                input(
                    format!("the encoding `{name}` is not known"),
                    "such as latin1",
                )
            };
            TextEncoding::of_name(name).ok_or_else(unknown)
        });
        Ok(ReadSettings {
            unit: self.unit.as_deref().map(length_unit).transpose()?,
            array: self.array.clone(),
            grid: self.grid,
            ignored_columns: self.ignore_columns.clone(),
            columns: columns?,
            encoding: encoding.transpose()?,
            downwards: either("y_axis", self.y_axis.as_deref(), ["down", "up"])?,
            deformed: either("places", self.places.as_deref(), ["frame", "rest"])?,
            rest: self.rest.clone(),
        })
    }

    fn mesh(&self) -> Result<MeshSource, Error> {
        Ok(match (&self.mesh, &self.outline) {
            (Some(_), Some(_)) => {
                return Err(input(
                    "mesh and outline are both given",
                    "leave out one of them",
                ));
            }
            (Some(mesh), None) => {
                let names = self.allow.iter().map(String::as_str);
                let allowed = Exemptions::of_names(names);
                let reading = MeshReading {
                    unit: length_unit(&self.mesh_unit)?,
                    merge_nodes: self.merge_nodes,
                    allowed: allowed.map_err(|unknown| refused(unknown.to_string()))?,
                    is_plane_strain: None,
                };
                MeshSource::File(mesh.clone(), reading)
            }
            (None, Some(outline)) => MeshSource::Outline(outline.clone()),
            (None, None) => MeshSource::Data,
        })
    }
}

/// The kinds of cells.
const CELLS: [(&str, CellShape); 4] = [
    ("triangle3", CellShape::Triangle3),
    ("triangle6", CellShape::Triangle6),
    ("quadrilateral4", CellShape::Quad4),
    ("quadrilateral9", CellShape::Quad9),
];

/// The length of a unit, or of a pixel, in mm.
pub fn length_unit(text: &str) -> Result<f64, Error> {
    let named = units::factor(text, Dimension::Length);
    let read = named.or_else(|_| units::parse(text, Dimension::Length));
    let factor = read.map_err(|fault| refused(format!("unit: \"{text}\" {fault}")))?;
    if factor > 0.0 {
        return Ok(factor);
    }
    Err(refused(format!(
        "unit: \"{text}\" is not greater than zero"
    )))
}

/// Whether a choice is the first of two.
fn either(what: &str, chosen: Option<&str>, [yes, no]: [&str; 2]) -> Result<Option<bool>, Error> {
    let names = [(yes, true), (no, false)];
    chosen.map(|name| choice(what, name, &names)).transpose()
}

/// Corrects the field of some files: the results and the worst verdict.
#[pyfunction]
#[pyo3(signature = (name, files, material, thickness, known, options, progress=None))]
#[expect(
    clippy::too_many_arguments,
    reason = "what is measured, and what is known of it"
)]
pub fn correct(
    py: Python<'_>,
    name: String,
    files: Vec<PathBuf>,
    material: &MaterialCard,
    thickness: f64,
    known: String,
    options: Options,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Results, String)> {
    let regions = options.regions.iter();
    let regions = regions
        .map(|(name, material_card)| (name.clone(), (*material_card.borrow(py).card).clone()));
    let regions: Vec<(String, Card)> = regions.collect();
    run(py, progress, |watch| {
        let card = watched((*material.card).clone(), watch);
        let mut conditions = Conditions::parse("conditions", &known)?;
        let regions = regions.into_iter();
        let regions = regions.map(|(name, card)| (name, watched(card, watch)));
        conditions.regions.extend(regions);
        let (reading, mesh) = (options.reading()?, options.mesh()?);
        let shape = choice("cells", &options.cells, &CELLS)?;
        let request = Request {
            reading,
            images: options.images.settings()?,
            material: card.name.clone(),
            thickness,
            mesh,
            cell_size: options.cell_size,
            shape,
            holes: options.holes,
            conditions,
            forces: options.forces.clone(),
            budget: budget(options.allow_large),
            files: files.clone(),
        };
        let start = Instant::now();
        let mut study = with_files(options.in_memory, || {
            if options.refine {
                MarkerStudy::prepare_refined(card, request, &|what| watch.report(what))
            } else {
                MarkerStudy::prepare_with(card, request, &|what| watch.report(what))
            }
        })?;
        let report = |frame: &Frame| watch.report(&format!("frame {}", frame.number));
        let estimates = study.estimate(&report)?;
        let seconds = start.elapsed().as_secs_f64();
        let pictures = Pictures::default();
        let results = written::results(&pictures, &study, &estimates, name, known, seconds);
        let file = files.into_iter().next().unwrap_or_default();
        let answer = worst_answer(&estimates).words().to_owned();
        let returned = Results {
            of_frames: of_frames(&study, &estimates),
            ..Results::new(results, file)
        };
        Ok((returned, answer))
    })
}

/// Fields and tables of all frames.
fn of_frames(study: &MarkerStudy, estimates: &[FieldEstimate]) -> OfFrames {
    let mut of_frames = OfFrames {
        series: SERIES
            .map(|name| GridSeries {
                name: name.to_owned(),
                grids: Vec::new(),
            })
            .to_vec(),
        tables: Vec::new(),
    };
    for (frame, estimate) in study.series.frames.iter().zip(estimates) {
        let frame_files = FrameFiles::new(study, frame, estimate);
        for (series, grid) in of_frames.series.iter_mut().zip(frame_files.grids) {
            series.grids.push(grid);
        }
        of_frames.tables.extend(frame_files.tables);
    }
    of_frames
}
