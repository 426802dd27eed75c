//! Measured fields: files of markers are read, shown and then corrected, in the background.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use web_time::Instant;

use gelbench::document::with_files;
use gelbench::error::Error;
use gelbench::estimation::FieldEstimate;
use gelbench::markers::Frame;
use gelbench::mesh::Mesh;
use gelbench::results::{Block, Drawing, Results};
use gelbench::studies::markers::MarkerStudy;
use gelbench_mechanics::problem::SheetLaws;
use gelbench_report::output::{self, vtk};
use gelbench_report::results::{Panel, mesh_outlines, nodal_states};
use gelbench_studies::studies::markers::written::{self, FrameFiles, SERIES, played};
use gelbench_studies::studies::pictures::Pictures;

use super::background::Worker;
use super::engine::Fault;
use super::scene::CardFile;
use super::studies::{NamedFile, Report, paths};

mod edges;
mod photo;
mod request;
pub mod settings;

pub use edges::{DRAWN, Edge, lines_of, middle, nearest};
pub use photo::Photo;
use photo::Photos;
use request::{length, request};

/// A measured field and what is stated about it, in the texts of the user.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct FieldQuestion {
    /// The files of the field, or camera images, the first one at rest.
    pub files: Vec<NamedFile>,
    /// The specimen's edge: a table of lines, or an image of its region, white on black.
    pub edge_file: Option<NamedFile>,
    /// The material.
    pub card: CardFile,
    /// Thickness at rest, such as `2 mm`.
    pub thickness: String,
    /// The length of the files' unit or pixel where they do not state it; may be empty.
    pub unit: String,
    /// Columns by what they hold, such as `x=x_px,y=y_px,ux=u,uy=v`; may be empty.
    pub columns: String,
    /// Whether y points down in the files, if not as usual for their layout.
    pub downwards: Option<bool>,
    /// How far inside of the edge the outermost markers lie; may be empty.
    pub edge_gap: String,
    /// Size of the cells; may be empty.
    pub cell_size: String,
    /// The edges by name.
    pub edges: BTreeMap<String, Edge>,
    /// Whether the field is corrected, or only looked at.
    pub correct: bool,
}

impl FieldQuestion {
    /// Files about which nothing is stated yet, to be looked at.
    pub fn of(files: Vec<NamedFile>, card: CardFile) -> Self {
        Self {
            files,
            edge_file: None,
            card,
            thickness: "2 mm".to_owned(),
            unit: String::new(),
            columns: String::new(),
            downwards: None,
            edge_gap: String::new(),
            cell_size: String::new(),
            edges: BTreeMap::new(),
            correct: false,
        }
    }
}

/// What is seen of the files before they are corrected.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Preview {
    /// A description of the layout, the columns, the units and the axes.
    pub understood: Vec<String>,
    /// Where the mesh comes from.
    pub mesh: String,
    /// The mesh and its edges by name.
    pub drawing: Drawing,
    /// Names of the edges.
    pub edges: Vec<String>,
    /// Places of the markers of the last frame, and where they were found, in mm.
    pub markers: Vec<[[f64; 2]; 2]>,
    /// What deserves attention.
    pub warnings: Vec<String>,
    /// The first camera image, where there are images.
    pub photo: Option<Photo>,
}

/// A corrected frame.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct CorrectedFrame {
    /// Its number.
    pub number: usize,
    /// Displacement, stress, thickness and their standard errors on the deformed sheet, with what they show.
    pub fields: Vec<(String, Panel)>,
    /// Place and residual of every marker in mm, and its weight: 1 for a marker like the others, 0 for one far off.
    pub residuals: Vec<([f64; 2], [f64; 2], f64)>,
    /// The verdict as a text.
    pub verdict: String,
    /// Whether the data are explained.
    pub explained: bool,
    /// Force on each edge that is not free: name, x, y with their 95 % intervals in N.
    pub forces: Vec<(String, [[f64; 3]; 2])>,
    /// The frame's camera image with the deformed mesh, where there are images.
    pub photo: Option<(Photo, Drawing)>,
}

/// What came of a question.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct FieldAnswer {
    /// What is seen of the files.
    pub preview: Preview,
    /// The frames and the report, once they are corrected.
    pub corrected: Option<(Vec<CorrectedFrame>, Report)>,
}

/// Looks at measured fields and corrects them.
#[derive(Default)]
pub struct FieldCorrector;

impl Worker for FieldCorrector {
    type Question = FieldQuestion;
    type Answer = Result<FieldAnswer, Fault>;
    const NAME: &'static str = "corrector";

    fn answer(&mut self, question: &FieldQuestion) -> Result<FieldAnswer, Fault> {
        let answered = with_files_of(question, || answer(question));
        answered.map_err(|error| settings::fault(error.into()))
    }
}

/// Does something with the files of a question, and with no others.
fn with_files_of<T>(question: &FieldQuestion, work: impl FnOnce() -> T) -> T {
    let files = question.files.iter().chain(&question.edge_file).cloned();
    let files: Vec<NamedFile> = files.chain([card_file(&question.card)]).collect();
    with_files(paths(&files), work)
}

fn card_file(card: &CardFile) -> NamedFile {
    (card.reference(), card.text.clone().into_bytes())
}

fn answer(question: &FieldQuestion) -> Result<FieldAnswer, Error> {
    let begun = Instant::now();
    let mut study = MarkerStudy::prepare(request(question)?, &|_| ())?;
    let photos = Photos::of(question)?;
    let preview = Preview {
        photo: photos.at_rest()?,
        ..preview(&study)
    };
    if !question.correct {
        return Ok(FieldAnswer {
            preview,
            corrected: None,
        });
    }
    let estimates = study.estimate(&|_| ())?;
    let results = results(question, &study, &estimates, begun);
    let mut report = Report::from(results);
    for block in &mut report.blocks {
        if let Block::Paragraph(text) = block {
            *text = settings::worded(text);
        }
    }
    let frames = || study.series.frames.iter().zip(&estimates);
    for (frame, estimate) in frames() {
        let files = FrameFiles::new(&study, frame, estimate);
        output::write_frame(&mut report.files, &files.grids, &files.tables)?;
    }
    let corrected = frames().map(|(frame, estimate)| {
        let photo = photos.of_frame(frame.number)?;
        Ok(CorrectedFrame {
            photo: photo.map(|photo| (photo, deformed(&study.mesh, &estimate.displacement))),
            ..corrected(&study, frame, estimate)
        })
    });
    Ok(FieldAnswer {
        preview,
        corrected: Some((corrected.collect::<Result<_, Error>>()?, report)),
    })
}

fn results(
    question: &FieldQuestion,
    study: &MarkerStudy,
    estimates: &[FieldEstimate],
    begun: Instant,
) -> Results {
    let known = edges::written(&question.edges, &question.edge_gap);
    let seconds = begun.elapsed().as_secs_f64();
    let pictures = Pictures::default();
    let stem = question.stem().to_owned();
    written::results(&pictures, study, estimates, stem, known, seconds)
}

/// Everything that `gelbench correct` writes, the file of the conditions, and the command line that repeats the correction.
///
/// # Errors
/// As of the correction itself.
pub fn files(question: &FieldQuestion) -> Result<Vec<NamedFile>, Error> {
    with_files_of(question, || {
        let begun = Instant::now();
        let mut study = MarkerStudy::prepare(request(question)?, &|_| ())?;
        let estimates = study.estimate(&|_| ())?;
        let mut files: Vec<NamedFile> = Vec::new();
        for (frame, estimate) in study.series.frames.iter().zip(&estimates) {
            let frame_files = FrameFiles::new(&study, frame, estimate);
            output::write_frame(&mut files, &frame_files.grids, &frame_files.tables)?;
        }
        let players = SERIES.map(|series| {
            let player = vtk::collection(&played(&study, series));
            (format!("vtk/{series}.pvd"), player)
        });
        files.extend(players);
        files.push(("vtk/view.py".to_owned(), vtk::VIEW.as_bytes().to_vec()));
        let results = results(question, &study, &estimates, begun);
        output::write(&results, true, &mut files)?;
        let known = edges::written(&question.edges, &question.edge_gap);
        files.push((KNOWN.to_owned(), known.into_bytes()));
        let edge = question.edge_file.iter();
        files.extend(edge.filter(|(name, _)| name == DRAWN).cloned());
        let card = &question.card;
        files.extend((!card.is_shipped()).then(|| card_file(card)));
        let again = format!("{}\n", question.command());
        files.push(("command.txt".to_owned(), again.into_bytes()));
        Ok(files)
    })
}

/// The file of the conditions, among those that are saved.
const KNOWN: &str = "known.toml";

impl FieldQuestion {
    /// The name of the first file without its ending.
    pub fn stem(&self) -> &str {
        let name = self.files.first().map_or("field", |(name, _)| name);
        name.rsplit_once('.').map_or(name, |(stem, _)| stem)
    }

    /// The line of the command that does the same.
    pub fn command(&self) -> String {
        let plain = |letter: char| letter.is_alphanumeric() || "_-+=,.:/%@".contains(letter);
        let quoted = |text: &str| {
            if text.chars().all(plain) {
                text.to_owned()
            } else {
                format!("'{}'", text.replace('\'', "'\\''"))
            }
        };
        let names = self.files.iter().map(|(name, _)| quoted(name));
        let mut words = vec!["gelbench correct".to_owned()];
        words.extend(names);
        let card = self.card.reference();
        let edge = self.mask_and_outline().map(Option::unwrap_or_default);
        let mut question = self.clone();
        // The gap is in the file of what is known.
        question.edge_gap.clear();
        let texts = settings::TEXTS.iter().zip(question.texts());
        let options = [(settings::MATERIAL.option, card.as_str())]
            .into_iter()
            .chain(texts.map(|(setting, text)| (setting.option, text.as_str())))
            .chain(["--mask", "--outline"].into_iter().zip(edge))
            .chain([("--study", KNOWN)]);
        for (option, value) in options {
            if !value.trim().is_empty() {
                words.extend([option.to_owned(), quoted(value.trim())]);
            }
        }
        if let Some(down) = self.downwards {
            let axis = if down { "down" } else { "up" };
            words.extend([settings::Y_AXIS.option, axis].map(str::to_owned));
        }
        words.join(" ")
    }
}

/// The mesh with its edges where the field moves them.
fn deformed(mesh: &Mesh, displacement: &[f64]) -> Drawing {
    let mut moved = mesh.clone();
    for (node, moves) in moved.nodes.iter_mut().zip(displacement.chunks_exact(2)) {
        *node = [node[0] + moves[0], node[1] + moves[1]];
    }
    outlines(&moved)
}

/// The mesh with its edges.
fn outlines(mesh: &Mesh) -> Drawing {
    let mut drawing = mesh_outlines("", mesh);
    if let Drawing::Mesh(figure) = &mut drawing {
        figure.groups.retain(|group| group.name != "boundary");
    }
    drawing
}

/// The names of a mesh's edges, without the group of the complete boundary.
fn edges(mesh: &Mesh) -> Vec<String> {
    let names = mesh.groups().keys().filter(|name| *name != "boundary");
    names.cloned().collect()
}

fn preview(study: &MarkerStudy) -> Preview {
    let understood = &study.understood;
    let column = |taken: &gelbench_mechanics::markers::ColumnTaken| {
        let unit = taken
            .unit
            .map(|unit| format!(" in {unit} mm, {}", taken.unit_source));
        format!(
            "{} from {}{}",
            taken.holds,
            taken.head,
            unit.unwrap_or_default()
        )
    };
    let columns = understood.columns.iter().map(column);
    let axes = [Some(understood.axes()), understood.positions()];
    let last = study.series.frames.last();
    let markers = last.map_or(&[][..], |frame| &frame.markers);
    Preview {
        understood: [understood.layout.to_owned()]
            .into_iter()
            .chain(columns)
            .chain(axes.into_iter().flatten().map(str::to_owned))
            .collect(),
        mesh: study.mesh_origin.clone(),
        drawing: outlines(&study.mesh),
        edges: edges(&study.mesh),
        markers: markers
            .iter()
            .map(|marker| {
                let moved = [0, 1].map(|axis| marker.position[axis] + marker.displacement[axis]);
                [marker.position, moved]
            })
            .collect(),
        warnings: study.warnings.iter().map(settings::warning_text).collect(),
        photo: None,
    }
}

fn corrected(study: &MarkerStudy, frame: &Frame, estimate: &FieldEstimate) -> CorrectedFrame {
    let (mesh, u) = (&study.mesh, &estimate.displacement[..]);
    let laws = SheetLaws::from(&study.laws(estimate)).in_cells(&study.mesh);
    let states = nodal_states(&laws, mesh, &[u], &[]);
    let at_nodes = |name: &str, value: &dyn Fn(usize) -> f64| {
        (name.to_owned(), Panel::at_nodes(name, mesh, u, value))
    };
    let size = |values: &[f64], node: usize| values[2 * node].hypot(values[2 * node + 1]);
    let residuals = frame.markers.iter().zip(&estimate.markers);
    let residual = |(marker, marker_estimate): (
        &gelbench::markers::Marker,
        &Option<gelbench::estimation::MarkerEstimate>,
    )| {
        let marker_estimate = marker_estimate.as_ref()?;
        Some((
            marker.position,
            marker_estimate.residual,
            marker_estimate.trust,
        ))
    };
    let forces = estimate.forces.iter().map(|force| {
        let axes = force
            .force
            .map(|along| [along.value, along.interval[0], along.interval[1]]);
        (force.edge.clone(), axes)
    });
    CorrectedFrame {
        number: frame.number,
        fields: vec![
            at_nodes("displacement [mm]", &|node| size(u, node)),
            at_nodes("standard error of the displacement [mm]", &|node| {
                size(&estimate.displacement_error, node)
            }),
            at_nodes("von Mises stress [MPa]", &|node| states[node].von_mises()),
            at_nodes("larger principal stretch [–]", &|node| {
                states[node].stretches[0]
            }),
            at_nodes("thickness [mm]", &|node| {
                study.thickness * states[node].stretches[2]
            }),
        ],
        residuals: residuals.filter_map(residual).collect(),
        verdict: estimate.verdict.answer.words().to_owned(),
        explained: estimate.has_intervals(),
        forces: forces.collect(),
        photo: None,
    }
}
