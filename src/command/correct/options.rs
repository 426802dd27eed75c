//! What the command line says about a correction.

use std::path::PathBuf;

use clap::Args;

use super::pictures::PictureOptions;
use super::values::{Cells, Holds, Holes, Places, Weights, YAxis};
use super::values::{encoding, force, force_column, gap, length, scale_error, size, unit};
use crate::command::large::Large;
use crate::command::terminal::Printed;
use crate::corrector::estimation::{JointSettings, MeasuredForce};
use crate::document::TextEncoding;
use crate::mesh::Exemptions;
use crate::studies::markers::ForceColumn;

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
    /// Further cards, with commas between, whose laws are compared with that of --material by forces of frames that are left out
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
    /// Standard deviation of the scale of the pictures, such as "0.1 %": a specimen 1 mm nearer to a camera 1 m away seems to grow by so much. Intervals
    /// hold it
    #[arg(long, value_name = "RATIO", value_parser = scale_error)]
    pub scale_error: Option<f64>,
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
    /// Halve the cells of a mesh that is made until its own error is a small part of the intervals of stress, and no longer why data are not
    /// explained
    #[arg(long, conflicts_with_all = ["together", "specimen", "laws"])]
    pub refine: bool,
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
    pub pictures: PictureOptions,
    #[command(flatten)]
    pub large: Large,
    #[command(flatten)]
    pub printed: Printed,
}

/// What stands below the help.
const AFTER_HELP: &str = "\
Verdict: \"explained\", what is left of the markers is white noise; \"explained with correlated noise\", its length is told and
intervals hold it; \"not explained by this law, thickness and conditions\", no interval is given, and what would mend it is ranked.

Exit codes: 0 explained, also with correlated noise; 1 explained, but something else is doubtful; 5 not explained; 2 wrong input,
3 no solution, 4 cannot write.";

impl Options {
    /// Whether parameters are found with all frames together.
    pub fn is_together(&self) -> bool {
        self.together || !self.specimen.is_empty() || !self.laws.is_empty()
    }

    /// The files that the results follow from.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let others = [&self.study, &self.mesh, &self.outline, &self.forces];
        let named = others.into_iter().flatten().cloned();
        let card = PathBuf::from(&self.material);
        self.fields
            .iter()
            .cloned()
            .chain(named)
            .chain([card])
            .collect()
    }
}
