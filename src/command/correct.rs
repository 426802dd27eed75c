//! `gelbench correct`: a measured displacement field made to satisfy the physics.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::identity;
use super::interrupt;
use super::large::Large;
use super::progress::Progress;
use super::terminal::{Outcome, print, warn};
use crate::corrector::estimation::{
    Answer, EdgeCondition, FieldEstimate, JointSettings, MeasuredForce, Physics, Robust,
};
use crate::document::TextEncoding;
use crate::error::Error;
use crate::markers::{ChosenColumns, Frame, ReadSettings};
use crate::mesh::{CellShape, Exemptions, MeshReading};
use crate::output::{self, ResultFolder};
use crate::results::{NamedGrid, Results};
use crate::studies::markers::SHOWN;
use crate::studies::markers::written::{self, FrameFiles, SERIES, played};
use crate::studies::markers::{
    ComparedFrames, Conditions, ForceColumn, MarkerStudy, MeshSource, Request, worst_answer,
};
use crate::studies::name;
use crate::studies::sections::read_text;

pub mod together;
mod values;

use values::{Cells, Holds, Holes, Places, Weights, YAxis};
use values::{encoding, force, force_column, gap, length, size, unit};

/// What the command line says about a correction.
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The field: a table with x, y, ux, uy, or of DICe, muDIC, pyALDIC, VIC, MatchID or GOM; two matrices of Ncorr; .vtu, .vtk,
    /// .pvd, .msh, .frd. Several files are frames
    #[arg(required_unless_present = "specimen", value_name = "FIELD")]
    pub fields: Vec<PathBuf>,
    /// The material: name or path of a card
    #[arg(long, value_name = "CARD")]
    pub material: String,
    /// Thickness at rest, such as "2 mm"
    #[arg(long, value_name = "LENGTH", value_parser = size, required_unless_present = "specimen")]
    pub thickness: Option<f64>,
    /// What is known besides: a file with edges and noise
    #[arg(long, value_name = "FILE")]
    pub study: Option<PathBuf>,
    /// Edges without traction
    #[arg(long, value_name = "EDGE", value_delimiter = ',')]
    pub free: Vec<String>,
    /// Edges that moved as rigid bodies by unknown amounts
    #[arg(long, value_name = "EDGE", value_delimiter = ',')]
    pub rigid: Vec<String>,
    /// A measured force, the grip's on the specimen: edge, axis, force and, else 1 % of it, its standard deviation, such as
    /// "right x 1.2 N ± 0.02 N"
    #[arg(long, value_name = "FORCE", value_parser = force)]
    pub force: Vec<MeasuredForce>,
    /// A testing machine's table beside the frames: its forces are matched by a column `frame`, else by `time`
    #[arg(long, value_name = "FILE")]
    pub forces: Option<PathBuf>,
    /// A column of that table: edge, axis, name and, else 1 % of its largest force, the standard deviation, such as
    /// "right x Load ± 0.02 N"; a name with - before it for the negative force
    #[arg(long, value_name = "COLUMN", value_parser = force_column, requires = "forces")]
    pub force_column: Vec<ForceColumn>,
    /// Parameters of the law that are found with the field, or `all`; a force must be measured
    #[arg(long, value_name = "PARAMETER", value_delimiter = ',')]
    pub fit: Vec<String>,
    /// Find the parameters with all frames together, as many as the data determine; all of the law without --fit
    #[arg(long)]
    pub together: bool,
    /// A file with a specimen, see `gelbench new --kind markers`; several are taken together, as with --together
    #[arg(long, value_name = "FILE")]
    pub specimen: Vec<PathBuf>,
    /// Further cards whose laws are compared with that of --material by forces of frames that are left out
    #[arg(long, value_name = "CARD", value_delimiter = ',')]
    pub laws: Vec<String>,
    /// Into how many groups frames are split of which one after the other is left out
    #[arg(long, value_name = "GROUPS", default_value_t = JointSettings::default().groups)]
    pub leave_out: usize,
    /// The specimen's mesh: .msh, .vtu or .vtk
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// The unit of the mesh
    #[arg(long, value_name = "UNIT", default_value = "mm", value_parser = unit)]
    pub mesh_unit: f64,
    /// Nodes of the mesh that are not farther from each other become one, such as "1e-6 mm"
    #[arg(long, value_name = "LENGTH", requires = "mesh", value_parser = length)]
    pub merge_nodes: Option<f64>,
    /// What looks like a fault of the mesh but is meant
    #[arg(long, value_name = "FAULT", requires = "mesh", value_delimiter = ',', value_parser = Exemptions::NAMES)]
    pub allow: Vec<String>,
    /// The specimen's edge as a table: x [mm], y [mm], and line where there are holes
    #[arg(long, value_name = "FILE", conflicts_with = "mesh")]
    pub outline: Option<PathBuf>,
    /// How far inside of the specimen's edge the outermost markers lie, such as "1.5 mm" or "0 mm": an outline that is made of
    /// markers is widened by it
    #[arg(long, value_name = "LENGTH", value_parser = gap, conflicts_with_all = ["mesh", "outline"])]
    pub edge_gap: Option<f64>,
    /// The field's unit or the length of a pixel, such as mm or "0.05 mm", where the file does not say it. It corrects the head
    /// of a table whose columns all name one other unit
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    pub unit: Option<f64>,
    /// Columns of a table that are passed over; other columns that are not known are refused
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    pub ignore_columns: Vec<String>,
    /// Columns of a table by what they hold, such as x=x_px,y=y_px,ux=disp_u,uy=disp_v; also standard_deviation, frame, time, id.
    /// Where places or displacements are named, other columns that are not known are passed over
    #[arg(long, value_name = "WHAT=COLUMN", value_delimiter = ',')]
    pub columns: Vec<String>,
    /// Where the y axis of a table points, if not as the program that wrote it is known to do
    #[arg(long, value_enum)]
    pub y_axis: Option<YAxis>,
    /// What places in a table are, if not as the program that wrote it is known to do
    #[arg(long, value_enum)]
    pub places: Option<Places>,
    /// The encoding of a table, such as latin1, gb18030 or shift_jis, where its bytes do not show it
    #[arg(long, value_name = "NAME", value_parser = encoding)]
    pub encoding: Option<TextEncoding>,
    /// The distance of the points of Ncorr's matrices, such as "0.5 mm"
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub grid: Option<f64>,
    /// The array of a file of VTK or Gmsh
    #[arg(long, value_name = "NAME")]
    pub array: Option<String>,
    /// Size of the cells of a mesh that is made [default: the markers' spacing, at least 12 cells across and at most
    /// about 20,000]
    #[arg(long, value_name = "LENGTH", value_parser = size)]
    pub cell_size: Option<f64>,
    /// Kind of the cells of a mesh that is made
    #[arg(long, value_enum, default_value = "triangle6")]
    pub cells: Cells,
    /// What gaps among the markers are, if a mesh is made
    #[arg(long, value_enum, default_value = "found")]
    pub holes: Holes,
    /// Standard deviation of the displacement's components, such as "0.1 mm"; estimated where it is not given
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub noise: Option<f64>,
    /// Weights of markers that are far off; tukey where some are farther off than noise can be
    #[arg(long, value_enum)]
    pub robust: Option<Weights>,
    /// How far the physics holds
    #[arg(long, value_enum)]
    pub physics: Option<Holds>,
    /// Write into this folder
    #[arg(long, value_name = "FOLDER", default_value = "output/correct")]
    pub output: PathBuf,
    #[command(flatten)]
    pub large: Large,
}

impl Options {
    /// Whether parameters are found with all frames together.
    pub fn is_together(&self) -> bool {
        self.together || !self.specimen.is_empty() || !self.laws.is_empty()
    }
}

/// Corrects, prints, and writes.
pub fn run(options: Options) -> Outcome {
    let folder = options.output.clone();
    let inputs = inputs(&options);
    let study = options.study.as_deref();
    let text = study.map_or(Ok(String::new()), read_text)?;
    let name = name(study.unwrap_or(&options.fields[0]));
    let said = format!("{options:?}");
    let field = MarkerStudy::prepare(request(options)?)?;
    warn(&field.warnings);
    let told = Told {
        name,
        text,
        identity: identity::of(&said),
    };
    let (estimates, results) = correct(&field, (told, &inputs), &folder)?;
    let doubts = field.all_doubts(&estimates);
    warn(&doubts[..doubts.len().min(SHOWN)]);
    Ok(exit_code(worst_answer(&estimates), results.passed()))
}

fn exit_code(answer: Answer, passed: bool) -> u8 {
    match answer {
        Answer::NotExplained => NOT_EXPLAINED,
        _ => u8::from(!passed),
    }
}

/// What a correction is called, and what tells it from others.
struct Told {
    name: String,
    text: String,
    identity: String,
}

/// Corrects all frames of a field, writes into a folder, and prints.
fn correct(
    field: &MarkerStudy,
    (told, inputs): (Told, &[PathBuf]),
    folder: &Path,
) -> Result<(Vec<FieldEstimate>, Results), Error> {
    let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
    let mut results_folder = ResultFolder::resume(folder, "correct", &inputs, &told.identity)?;
    interrupt::guard(&results_folder);
    let progress = Progress::of(field.series.frames.len() as u64);
    let start = Instant::now();
    let estimates = estimates(field, &mut results_folder, &progress)?;
    let seconds = start.elapsed().as_secs_f64();
    progress.tell("files");
    let results = written::results(field, &estimates, (told.name, told.text), seconds);
    let warnings = output::write(&results, true, &mut results_folder)?;
    drop(progress);
    warn(&warnings);
    let files = results_folder.finish()?;
    print(&format!(
        "{}{} files in {}\n",
        results.outcome.summary,
        files.len(),
        folder.display()
    ))?;
    Ok((estimates, results))
}

/// The exit code where the data are not explained.
const NOT_EXPLAINED: u8 = 5;

/// What stands below the help.
const AFTER_HELP: &str = "\
Verdict: \"explained\", what is left of the markers is white noise; \"explained with correlated noise\", its length is told and
intervals hold it; \"not explained by this law, thickness and conditions\", no interval is given, and what would mend it is ranked.

Exit codes: 0 explained, also with correlated noise; 1 explained, but something else is doubtful; 5 not explained; 2 wrong input,
3 no solution, 4 cannot write.";

/// Corrects frame after frame and writes each as soon as the one after it is known; what a run of the same identity has done
/// is not done again.
fn estimates(
    field: &MarkerStudy,
    folder: &mut ResultFolder,
    progress: &Progress,
) -> Result<Vec<FieldEstimate>, Error> {
    let mut compared = ComparedFrames::default();
    let mut was_kept = false;
    for frame in &field.series.frames {
        progress.tell(&format!("frame {}", frame.number));
        let kept = folder.kept(&part(frame));
        let is_kept = kept.is_some();
        let estimate = kept.map_or_else(|| field.estimate_frame(frame), Ok)?;
        let settled = compared.push(frame, estimate);
        if let Some((before, estimate)) = settled.filter(|_| !was_kept) {
            write(field, before, estimate, folder)?;
        }
        was_kept = is_kept;
        progress.advance();
    }
    if let Some((last, estimate)) = compared.last().filter(|_| !was_kept) {
        write(field, last, estimate, folder)?;
    }
    for series in SERIES {
        let collection = output::vtk::collection(&played(field, series));
        folder.add(&format!("vtk/{series}.pvd"), &collection)?;
    }
    Ok(compared.into_estimates())
}

/// The name under which a frame is kept.
fn part(frame: &Frame) -> String {
    frame.number.to_string()
}

fn write(
    field: &MarkerStudy,
    frame: &Frame,
    estimate: &FieldEstimate,
    folder: &mut ResultFolder,
) -> Result<(), Error> {
    let files = FrameFiles::new(field, frame, estimate);
    for NamedGrid { name, grid, .. } in &files.grids {
        folder.add(&format!("vtk/{name}.vtu"), &output::vtk::grid(grid))?;
    }
    for (name, table) in &files.tables {
        folder.add(name, table.as_bytes())?;
    }
    folder.keep(&part(frame), estimate)
}

/// The files that the results follow from.
fn inputs(options: &Options) -> Vec<PathBuf> {
    let others = [
        &options.study,
        &options.mesh,
        &options.outline,
        &options.forces,
    ];
    let named = others.into_iter().flatten().cloned();
    let card = PathBuf::from(&options.material);
    options
        .fields
        .iter()
        .cloned()
        .chain(named)
        .chain([card])
        .collect()
}

/// How the files of the field are to be understood.
fn reading(options: &Options) -> Result<ReadSettings, Error> {
    let columns = ChosenColumns::parse(options.columns.iter().map(String::as_str));
    Ok(ReadSettings {
        unit: options.unit,
        array: options.array.clone(),
        grid: options.grid,
        ignored_columns: options.ignore_columns.clone(),
        columns: columns.map_err(|fault| Error::Input(vec![fault]))?,
        encoding: options.encoding,
        downwards: options.y_axis.map(|axis| axis == YAxis::Down),
        deformed: options.places.map(|places| places == Places::Frame),
    })
}

fn request(options: Options) -> Result<Request, Error> {
    Ok(Request {
        conditions: conditions(&options)?,
        mesh: mesh_source(&options),
        reading: reading(&options)?,
        forces: options.forces,
        files: options.fields,
        material: options.material,
        thickness: options.thickness.unwrap_or_default(),
        cell_size: options.cell_size,
        shape: match options.cells {
            Cells::Triangle3 => CellShape::Triangle3,
            Cells::Triangle6 => CellShape::Triangle6,
            Cells::Quadrilateral4 => CellShape::Quad4,
            Cells::Quadrilateral9 => CellShape::Quad9,
        },
        holes: options.holes == Holes::Found,
        budget: options.large.budget(),
    })
}

/// What the file says of the specimen, completed by the command line.
fn conditions(options: &Options) -> Result<Conditions, Error> {
    let mut conditions = match &options.study {
        Some(path) => Conditions::of_file(path)?.without_specimen(path)?,
        None => Conditions::default(),
    };
    let free = options.free.iter().map(|name| (name, EdgeCondition::Free));
    let rigid = options
        .rigid
        .iter()
        .map(|name| (name, EdgeCondition::Rigid));
    let edges = free
        .chain(rigid)
        .map(|(name, condition)| (name.clone(), condition));
    conditions.edges.extend(edges);
    let forces = options.force.iter().map(|force| (None, force.clone()));
    conditions.forces.extend(forces);
    let columns = options.force_column.iter().cloned();
    conditions.force_columns.extend(columns);
    conditions.fit.extend(options.fit.iter().cloned());
    conditions.noise = options.noise.or(conditions.noise);
    conditions.edge_gap = options.edge_gap.or(conditions.edge_gap);
    conditions.robust = match options.robust {
        None => conditions.robust,
        Some(Weights::No) => Some(Robust::No),
        Some(Weights::Huber) => Some(Robust::Huber),
        Some(Weights::Tukey) => Some(Robust::Tukey),
    };
    conditions.physics = match options.physics {
        None => conditions.physics,
        Some(Holds::Exact) => Physics::Exact,
        Some(Holds::Weighted) => Physics::Weighted,
    };
    Ok(conditions)
}

fn mesh_source(options: &Options) -> MeshSource {
    match (&options.mesh, &options.outline) {
        (Some(mesh), _) => {
            let names = options.allow.iter().map(String::as_str);
            let reading = MeshReading {
                unit: options.mesh_unit,
                merge_nodes: options.merge_nodes,
                allowed: Exemptions::of_names(names).unwrap_or_default(),
            };
            MeshSource::File(mesh.clone(), reading)
        }
        (None, Some(outline)) => MeshSource::Outline(outline.clone()),
        (None, None) => MeshSource::Data,
    }
}
