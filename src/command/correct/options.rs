//! The options of `gelbench correct`.

use std::path::PathBuf;

use clap::{ArgAction, Args};

use super::values::{CELLS, HOLES, PLACES, Y_AXIS};
use super::values::{
    encoding, force, force_column, gap, interval, length, region, scale_error, size, time, unit,
};
use crate::command::arguments::{Large, one_of};
use crate::command::images::ImageOptions;
use crate::command::pictures::PictureOptions;
use crate::command::terminal::Printed;
use gelbench_base::document::TextEncoding;
use gelbench_estimation::estimation::{JointSettings, MeasuredForce, Physics, Robust};
use gelbench_mechanics::material::{Card, PlaneState};
use gelbench_mechanics::mesh::{CellShape, Exemptions};
use gelbench_studies::studies::markers::ForceColumn;

/// What the command line says about a correction.
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The field: a table with x, y, ux, uy, or one of DICe, muDIC, pyALDIC, VIC, MatchID or GOM; two matrices of Ncorr; .vtu, .vtk,
    /// .pvd, .msh, .frd; or camera images, the first one at rest. Several files are frames
    #[arg(required_unless_present = "specimen", value_name = "FIELD")]
    pub fields: Vec<PathBuf>,
    /// The material: name or path of a card
    #[arg(long, value_name = "CARD")]
    pub material: String,
    /// Thickness at rest, such as "2 mm"
    #[arg(long, value_name = "LENGTH", value_parser = size, allow_hyphen_values = true, required_unless_present = "specimen")]
    pub thickness: Option<f64>,
    /// The card of a region of the mesh with a material of its own: its name, = and the card, such as inclusion=pva-10
    #[arg(long, value_name = "REGION=CARD", value_parser = region)]
    pub region: Vec<(String, Card)>,
    /// A thin sheet with free surfaces (plane stress, the default), or a thick body between walls (plane strain), whose card needs a
    /// `[volume]`
    #[arg(long, value_parser = one_of(&PlaneState::NAMES))]
    pub sheet: Option<PlaneState>,
    /// What else is known: a file with edge conditions and noise
    #[arg(long, value_name = "FILE")]
    pub study: Option<PathBuf>,
    /// Edges without traction
    #[arg(long, value_name = "EDGE", value_delimiter = ',')]
    pub free: Vec<String>,
    /// Edges that moved as rigid bodies by unknown amounts
    #[arg(long, value_name = "EDGE", value_delimiter = ',')]
    pub rigid: Vec<String>,
    /// A measured force of the grip on the specimen: edge, axis, force and standard deviation (1 % of the force if omitted), such as
    /// "right x 1.2 N ± 0.02 N"
    #[arg(long, value_name = "FORCE", value_parser = force)]
    pub force: Vec<MeasuredForce>,
    /// A testing machine's table for the frames: its rows are matched by a column `frame`, else by `time`
    #[arg(long, value_name = "FILE")]
    pub forces: Option<PathBuf>,
    /// A column of that table: edge, axis, name and standard deviation (1 % of its largest force if omitted), such as
    /// "right x Load ± 0.02 N"; a - before the name takes the negative force
    #[arg(long, value_name = "COLUMN", value_parser = force_column, requires = "forces")]
    pub force_column: Vec<ForceColumn>,
    /// Time from one frame to the next, such as "0.5 s", where frames have none: number n is taken at n times this
    #[arg(long, value_name = "TIME", value_parser = interval, requires = "forces", allow_hyphen_values = true)]
    pub frame_interval: Option<f64>,
    /// The time of the testing machine when that of the frames is at zero, such as "1.2 s"
    #[arg(long, value_name = "TIME", value_parser = time, requires = "forces", allow_hyphen_values = true)]
    pub clock_offset: Option<f64>,
    /// Parameters of the law to estimate with the field, or `all`; a force must be measured
    #[arg(long, value_name = "PARAMETER", value_delimiter = ',')]
    pub fit: Vec<String>,
    /// Estimate the parameters from all frames together, as many as the data determine; without --fit all of the law
    #[arg(long)]
    pub together: bool,
    /// A file with a specimen, see `gelbench new --kind markers`; several are pooled, as with --together
    #[arg(long, value_name = "FILE")]
    pub specimen: Vec<PathBuf>,
    /// Further cards, separated by commas, whose laws are compared with that of --material by predicting the forces of left-out frames
    #[arg(long, value_name = "CARD", value_delimiter = ',')]
    pub laws: Vec<String>,
    /// Into how many groups the frames are split; the groups are left out one after the other
    #[arg(long, value_name = "GROUPS", default_value_t = JointSettings::default().groups)]
    pub leave_out: usize,
    /// The specimen's mesh: .msh, .inp, .vtu or .vtk
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// The unit of the mesh
    #[arg(long, value_name = "UNIT", default_value = "mm", value_parser = unit)]
    pub mesh_unit: f64,
    /// Merge nodes of the mesh that are no farther apart than this, such as "1e-6 mm"
    #[arg(long, value_name = "LENGTH", requires = "mesh", value_parser = length, allow_hyphen_values = true)]
    pub merge_nodes: Option<f64>,
    /// Apparent faults of the mesh that are intended
    #[arg(long, value_name = "FAULT", requires = "mesh", value_delimiter = ',', value_parser = Exemptions::NAMES)]
    pub allow: Vec<String>,
    /// The specimen's edge as a table: x [mm], y [mm], and line where there are holes
    #[arg(long, value_name = "FILE", conflicts_with = "mesh")]
    pub outline: Option<PathBuf>,
    /// How far inside the specimen's edge the outermost markers lie, such as "1.5 mm" or "0 mm": an outline made from
    /// markers is widened by it
    #[arg(long, value_name = "LENGTH", value_parser = gap, allow_hyphen_values = true, conflicts_with_all = ["mesh", "outline"])]
    pub edge_gap: Option<f64>,
    /// Standard deviation of the scale of the pictures, such as "0.1 %": a specimen 1 mm nearer to a camera 1 m away seems to grow by this much. Intervals
    /// include it
    #[arg(long, value_name = "RATIO", value_parser = scale_error, allow_hyphen_values = true)]
    pub scale_error: Option<f64>,
    /// The field's unit or the length of a pixel, such as mm or "0.05 mm", if the file does not state it. It corrects the header
    /// of a table whose columns all state one other unit
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    pub unit: Option<f64>,
    /// Columns of a table to ignore; other unknown columns are refused
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    pub ignore_columns: Vec<String>,
    /// Columns of a table by their quantity, such as x=x_px,y=y_px,ux=disp_u,uy=disp_v; also standard_deviation, frame, time, id.
    /// If positions or displacements are named, other unknown columns are ignored
    #[arg(long, value_name = "WHAT=COLUMN", value_delimiter = ',')]
    pub columns: Vec<String>,
    /// Where the y axis of a table points, up as on paper or down as in an image, if not as usual for the program that wrote it
    #[arg(long, value_parser = one_of(&Y_AXIS))]
    pub y_axis: Option<bool>,
    /// The positions in a table, at rest or in the frame, if not as usual for the program that wrote it
    #[arg(long, value_parser = one_of(&PLACES))]
    pub places: Option<bool>,
    /// The positions at rest, if FIELD holds positions instead of displacements: tables with x, y, and id where points are numbered
    #[arg(long, value_name = "FILE")]
    pub rest: Option<PathBuf>,
    /// The encoding of a table, such as latin1, gb18030 or shift_jis, if its bytes do not show it
    #[arg(long, value_name = "NAME", value_parser = encoding)]
    pub encoding: Option<TextEncoding>,
    /// The distance between the points of Ncorr's matrices, such as "0.5 mm"
    #[arg(long, value_name = "LENGTH", value_parser = length, allow_hyphen_values = true)]
    pub grid: Option<f64>,
    /// The array of a VTK or Gmsh file
    #[arg(long, value_name = "NAME")]
    pub array: Option<String>,
    /// Size of the cells of a generated mesh [default: nodes as far apart as the markers, but at least 16 cells
    /// across; otherwise about 5,000 cells at most, 20,000 in slender specimens]
    #[arg(long, value_name = "LENGTH", value_parser = size, allow_hyphen_values = true)]
    pub cell_size: Option<f64>,
    /// Halve the cells of a generated mesh until its discretisation error is a small part of the stress intervals
    #[arg(long, conflicts_with_all = ["together", "specimen", "laws"])]
    pub refine: bool,
    /// Kind of the cells of a generated mesh: triangles or quadrilaterals, by their number of nodes
    #[arg(long, value_parser = one_of(&CELLS), default_value = "triangle6")]
    pub cells: CellShape,
    /// What gaps among the markers are, if a mesh is generated: holes if they are much wider than the spacing, or lost markers
    #[arg(long, value_parser = one_of(&HOLES), action = ArgAction::Set, default_value = "found")]
    pub holes: bool,
    /// Standard deviation of the displacement's components, such as "0.1 mm"; estimated if omitted
    #[arg(long, value_name = "LENGTH", value_parser = length, allow_hyphen_values = true)]
    pub noise: Option<f64>,
    /// Weights of outlying markers: full, decreasing with the residual (huber), or zero beyond one (tukey); tukey if some are farther off
    /// than noise can explain
    #[arg(long, value_parser = one_of(&Robust::NAMES))]
    pub robust: Option<Robust>,
    /// How equilibrium holds: exactly, or up to smooth forces that are weighted against the data, for a law that is not exact
    #[arg(long, value_parser = one_of(&Physics::NAMES))]
    pub physics: Option<Physics>,
    /// Write into this folder
    #[arg(long, value_name = "FOLDER", default_value = "output/correct")]
    pub output: PathBuf,
    #[command(flatten)]
    pub images: ImageOptions,
    #[command(flatten)]
    pub pictures: PictureOptions,
    #[command(flatten)]
    pub large: Large,
    #[command(flatten)]
    pub printed: Printed,
}

/// What stands below the help.
const AFTER_HELP: &str = "\
Verdict: \"explained\", the residuals of the markers are white noise; \"explained with correlated noise\", the correlation length is
reported and intervals include it; \"the data cannot judge\", too few values are independent to tell noise from a misfit, or gross
errors make up the noise; \"not explained by this law, thickness and conditions\", no interval is given, and the report ranks what
would improve the fit. Without a measured force, forces are given the card: as good as its stiffness.

Exit codes: 0 explained, also with correlated noise; 1 the data cannot judge, or something else is doubtful; 5 not explained; 2 wrong input,
3 no solution, 4 cannot write.";

impl Options {
    /// Whether parameters are estimated from all frames together.
    pub fn is_joint(&self) -> bool {
        self.together || !self.specimen.is_empty() || !self.laws.is_empty()
    }

    /// The files that the results follow from.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let others = [
            &self.study,
            &self.mesh,
            &self.outline,
            &self.forces,
            &self.rest,
        ];
        let files = others.into_iter().flatten().cloned();
        let named = files.chain(self.images.mask());
        let card = PathBuf::from(&self.material);
        self.fields
            .iter()
            .cloned()
            .chain(named)
            .chain([card])
            .collect()
    }
}
