//! The layouts of tables that other programs export, known by the names of their columns.
//!
//! | layout | known by | position | y axis |
//! |---|---|---|---|
//! | columns | nothing else | x, y at rest | as it is |
//! | DICe | `COORDINATE_X`, `DISPLACEMENT_X` | in pixels | downwards |
//! | DICe, stereo | `MODEL_DISPLACEMENT_X` | in the calibration's unit | as it is |
//! | muDIC | `ux`, `true_strain_xx` | in pixels, in the frame | downwards |
//! | pyALDIC | `x_px`, `disp_u` | in pixels | downwards |
//! | pyvale | `subset_x`, `displacement_u` | in pixels | downwards |
//! | OpenCorr | `u0`, `v0`, `ZNCC` | in pixels | downwards |
//! | VIC-3D | `X`, `Y`, `U`, `V` with `sigma` or `exx` | in the calibration's unit | as it is |
//! | VIC-2D | `x`, `y`, `u`, `v` with `sigma` and `exx`, in pixels | in pixels | downwards |
//! | MatchID | `disp.Horizontal Displacement U`, or `x_pic` and `u` | in mm or pixels | downwards |
//! | GOM, nodemap | `x_undef`, `u` | in mm | as it is |
//! | GOM Correlate | `x`, `displacement_x` with `displacement_z` or `epsilon_x` | in the frame | as it is |
//!
//! # References
//! DICe: `DICe_solution_*.txt` among the regression tests of github.com/dicengine/dice, and its maintainers on
//! SIGMA (issues 123 and 133: in pixels, one number for both directions, −1 where the correlation failed).
//! muDIC: `exportCSV` in `muDIC/IO/readWriteUtils.py` of github.com/PolymerGuy/muDIC; its `x`, `y` are the positions
//! *in the frame*, so that the displacement is subtracted from them.
//! pyALDIC: `export_csv` in `src/al_dic/export/export_csv.py` of github.com/zachtong/pyALDIC, which writes coordinates and
//! displacements of the image; `compute_strain.py` turns both signs for axes that point up.
//! pyvale: the tables of `pyvale.dic`, whose `converged` is 0 where no match was found. OpenCorr: `IO2D::saveTable2D` of
//! github.com/vincentjzy/OpenCorr; `ICGN2D1::compute` gives a ZNCC below zero to points outside of the image or without convergence.
//! VIC-3D: `DICreader2D` in `peripydic/IO/dic.py` of github.com/lm2-poly/PeriPyDIC (`sigma` = −1: not found) and
//! `pydictoolkit/dic/measurements.py` of github.com/ilyasst/pydictoolkit (`X`, `Y` in mm beside `x`, `y` in pixels); heads with
//! units such as `"X [mm]"`, `"sigma [pixel]"` are below a line of titles. VIC-2D: `read_vic2d_export` and `Vic2DDataset`,
//! which find `x`, `y`, `u`, `v`, `exx`, `eyy`, `exy` at the pixels of the image.
//! MatchID: `field_lookup` of `matchid_to_spatialdata`, which has the heads of versions 2023 and 2024.1 and turns y and V up.
//! GOM: nodemaps of github.com/dlr-wf/aramis-data-exporter; GOM Correlate's tables as
//! github.com/jaredvanblitterswyk/lce_tension_tests reads them (below five lines of preamble, positions in the frame).

use super::columns::{DISPLACEMENTS, HEIGHT, LIFT, Names, POSITIONS};
use crate::document::{Table, is_pixel};

/// The columns and conventions of a layout.
#[derive(Debug)]
pub(super) struct Layout {
    pub name: &'static str,
    pub positions: [Names; 2],
    pub displacements: [Names; 2],
    pub deviation: Names,
    /// Heights and displacements out of the plane.
    pub out_of_plane: [Names; 2],
    /// A column that is below zero where a point was not found.
    pub lost: Names,
    /// A column that is zero where a point was not found.
    pub converged: Names,
    /// Columns that the program writes and that contain nothing about the displacement.
    pub harmless: Names,
    /// Whether the y axis points downwards, as in an image.
    pub downwards: bool,
    /// Whether positions are those in the frame, instead of at rest.
    pub deformed: bool,
    /// Whether lengths are in pixels where the head states no unit.
    pub pixels: bool,
}

const COLUMNS: Layout = Layout {
    name: "columns",
    positions: POSITIONS,
    displacements: DISPLACEMENTS,
    deviation: &["standard_deviation", "sigma"],
    out_of_plane: [HEIGHT, LIFT],
    lost: &[],
    converged: &[],
    harmless: &[],
    downwards: false,
    deformed: false,
    pixels: false,
};

/// Columns named by the user; a column that a program calls `sigma` may then be anything.
pub(super) const NAMED: Layout = Layout {
    deviation: &["standard_deviation"],
    ..COLUMNS
};

/// A table of a program, which contains no standard deviation of the displacement in its unit.
const EXPORT: Layout = Layout {
    deviation: &[],
    ..COLUMNS
};

/// A table of a program with positions in the image.
const IN_IMAGE: Layout = Layout {
    downwards: true,
    pixels: true,
    ..EXPORT
};

const DICE: Layout = Layout {
    name: "DICe",
    positions: [&["coordinate_x"], &["coordinate_y"]],
    displacements: [&["displacement_x"], &["displacement_y"]],
    deviation: &["sigma"],
    lost: &["sigma"],
    ..IN_IMAGE
};

const DICE_STEREO: Layout = Layout {
    name: "DICe, stereo",
    positions: [&["model_coordinates_x"], &["model_coordinates_y"]],
    displacements: [&["model_displacement_x"], &["model_displacement_y"]],
    // SIGMA is in pixels, not in the calibration's unit: it only shows which points are lost.
    lost: &["sigma"],
    // The same in pixels of one camera.
    harmless: &[
        "coordinate_x",
        "coordinate_y",
        "displacement_x",
        "displacement_y",
    ],
    ..EXPORT
};

const MUDIC: Layout = Layout {
    name: "muDIC",
    deformed: true,
    ..IN_IMAGE
};

const PYALDIC: Layout = Layout {
    name: "pyALDIC",
    displacements: [&["disp_u"], &["disp_v"]],
    harmless: &["disp_magnitude"],
    ..IN_IMAGE
};

const PYVALE: Layout = Layout {
    name: "pyvale",
    positions: [&["subset_x"], &["subset_y"]],
    displacements: [&["displacement_u"], &["displacement_v"]],
    converged: &["converged"],
    harmless: &["displacement_mag", "cost", "ftol", "xtol", "num_iterations"],
    ..IN_IMAGE
};

const OPENCORR: Layout = Layout {
    name: "OpenCorr",
    displacements: [&["u"], &["v"]],
    lost: &["zncc"],
    // The initial values of the search, and how it ended.
    harmless: &[
        "u0",
        "v0",
        "iteration",
        "convergence",
        "feature",
        "subset_rx",
        "subset_ry",
    ],
    ..IN_IMAGE
};

const VIC_3D: Layout = Layout {
    name: "VIC-3D",
    positions: [&["=X"], &["=Y"]],
    displacements: [&["=U"], &["=V"]],
    out_of_plane: [&["=Z"], &["=W"]],
    // `sigma` is in pixels, not in the calibration's unit: it only shows which points are lost.
    lost: &["sigma"],
    harmless: &[
        "=x", "=y", "=u", "=v", "sigma_x", "sigma_y", "sigma_z", "index",
    ],
    ..EXPORT
};

const VIC_2D: Layout = Layout {
    name: "VIC-2D",
    positions: [&["=x"], &["=y"]],
    displacements: [&["=u"], &["=v"]],
    lost: &["sigma"],
    harmless: &["index"],
    ..IN_IMAGE
};

const MATCHID: Layout = Layout {
    name: "MatchID",
    positions: [
        &["coor.x", "coordinates.image_x", "x", "x_pic"],
        &["coor.y", "coordinates.image_y", "y", "y_pic"],
    ],
    displacements: [
        &["disp.horizontal_displacement_u", "u"],
        &["disp.vertical_displacement_v", "v"],
    ],
    out_of_plane: [&["coor.z", "z"], &["disp.out_of_plane:_w", "w"]],
    harmless: &[
        "coordinates.image_x",
        "coordinates.image_y",
        "x_pic",
        "y_pic",
        "deltathick:_dthick",
    ],
    downwards: true,
    ..EXPORT
};

const GOM_NODEMAP: Layout = Layout {
    name: "GOM, nodemap",
    positions: [&["x_undef"], &["y_undef"]],
    displacements: [&["u"], &["v"]],
    out_of_plane: [&["z_undef"], LIFT],
    harmless: &["epsx", "epsy", "epsxy", "epseqv"],
    ..EXPORT
};

const GOM_CORRELATE: Layout = Layout {
    name: "GOM Correlate",
    displacements: [&["displacement_x"], &["displacement_y"]],
    out_of_plane: [HEIGHT, &["displacement_z"]],
    harmless: &["epsilon_x", "epsilon_y", "epsilon_xy"],
    deformed: true,
    ..EXPORT
};

/// The layout that the names of the columns show.
pub(super) fn recognise(table: &Table) -> &'static Layout {
    let any = |name: &str| table.columns.iter().any(|column| column.name == name);
    let all = |names: &[&str]| names.iter().all(|name| any(name));
    let written = |names: [&str; 4]| {
        let is_there = |name: &&str| table.columns.iter().any(|column| column.written == **name);
        names.iter().all(is_there)
    };
    let in_pixels = table.column("x").is_some_and(|x| {
        let unit = table.columns[x].unit.as_deref();
        unit.is_none_or(is_pixel)
    });
    match () {
        () if any("model_displacement_x") => &DICE_STEREO,
        () if all(&["displacement_x", "coordinate_x"]) => &DICE,
        () if all(&["true_strain_xx", "ux"]) => &MUDIC,
        () if all(&["x_px", "disp_u"]) => &PYALDIC,
        () if all(&["subset_x", "displacement_u"]) => &PYVALE,
        () if all(&["x", "y", "u", "v", "u0", "v0", "zncc"]) => &OPENCORR,
        () if any("disp.horizontal_displacement_u") || all(&["x_pic", "u"]) => &MATCHID,
        () if all(&["x_undef", "u"]) => &GOM_NODEMAP,
        () if all(&["x", "displacement_x"]) && (any("displacement_z") || any("epsilon_x")) => {
            &GOM_CORRELATE
        }
        () if written(["X", "Y", "U", "V"]) && (any("sigma") || any("exx")) => &VIC_3D,
        () if written(["x", "y", "u", "v"]) && all(&["sigma", "exx"]) && in_pixels => &VIC_2D,
        () => &COLUMNS,
    }
}
