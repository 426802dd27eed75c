//! VTK files: one `.vtu` per grid, and one `.pvd` per series, which plays its grids.
//!
//! Arrays are compressed as ParaView writes them: blocks of zlib behind a head of their sizes, both in base64.
//!
//! # References
//! VTK XML formats, <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::{Compress, Compression, FlushCompress};
use quick_xml::escape::escape;
use rayon::prelude::*;

use crate::results::{Array, Components, Grid, GridCell, GridSeries};

/// A program for ParaView that shows the models of the folder that it is in, side by side.
pub const VIEW: &str = include_str!("view.py");

/// The level of zlib's compression: that of ParaView.
const LEVEL: u32 = 5;
/// Bytes of a block before compression.
const BLOCK: usize = 1 << 15;

/// The files of a series, one after the other: `NAME_001.vtu` and so on, and `NAME.pvd` where its grids have times. As many at once are
/// made as there are threads.
pub fn files(series: &GridSeries) -> impl Iterator<Item = (String, Vec<u8>)> {
    let file = |name: &str| format!("{name}.vtu");
    let timed = series.grids.iter();
    let timed: Vec<_> = timed
        .filter_map(|named| Some((named.time?, named.name.clone())))
        .collect();
    let played = (!timed.is_empty()).then(|| (format!("{}.pvd", series.name), collection(&timed)));
    let at_once = series.grids.chunks(rayon::current_num_threads());
    let files = at_once.flat_map(move |grids| -> Vec<_> {
        let grids = grids.par_iter();
        let files = grids.map(|named| (file(&named.name), grid(&named.grid)));
        files.collect()
    });
    files.chain(played)
}

/// A grid as a `.vtu` file.
pub fn grid(grid: &Grid) -> Vec<u8> {
    let places = grid.points.iter().flat_map(|[x, y]| [*x, *y, 0.0]);
    let ends = grid.cells.iter().scan(0, |end, cell| {
        *end += cell.points();
        Some(*end as i64)
    });
    let kinds = grid.cells.iter().map(|cell| match cell {
        GridCell::Vertex => 1,
        GridCell::Line => 3,
        GridCell::Mesh(shape) => shape.vtk_number(),
    });
    // Numbers of points have a sign, as VTK and meshio expect them.
    let points = grid.connectivity.iter().map(|point| *point as i64);
    let file = format!(
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" compressor=\"vtkZLibDataCompressor\" \
         header_type=\"UInt64\"><UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">{}{}<Points>{}</Points>\
         <Cells>{}{}{}</Cells></Piece></UnstructuredGrid></VTKFile>",
        grid.points.len(),
        grid.cells.len(),
        arrays("PointData", &grid.at_points),
        arrays("CellData", &grid.in_cells),
        data_array(
            "Float64",
            "Points",
            &["X", "Y", "Z"],
            places.flat_map(f64::to_le_bytes)
        ),
        data_array(
            "Int64",
            "connectivity",
            &[],
            points.flat_map(i64::to_le_bytes)
        ),
        data_array("Int64", "offsets", &[], ends.flat_map(i64::to_le_bytes)),
        data_array("UInt8", "types", &[], kinds),
    );
    file.into_bytes()
}

/// Arrays with the names of those that programs show first.
fn arrays(tag: &str, arrays: &[Array]) -> String {
    let mut head = tag.to_owned();
    for (role, components) in [
        ("Scalars", Components::Scalar),
        ("Vectors", Components::Vector),
        ("Tensors", Components::Tensor),
    ] {
        let first = arrays.iter().find(|array| array.components == components);
        head += &first.map_or(String::new(), |first| format!(" {role}=\"{}\"", first.name));
    }
    let arrays: String = arrays.iter().map(array).collect();
    format!("<{head}>{arrays}</{tag}>")
}

/// Vectors and tensors in the plane become those of space.
fn array(array: &Array) -> String {
    let each = array.values.chunks_exact(array.components.count());
    let (names, values): (&[_], Vec<f64>) = match array.components {
        Components::Scalar => (&[], array.values.clone()),
        Components::Stretches => (&["larger", "smaller", "thickness"], array.values.clone()),
        Components::Vector => (
            &["X", "Y", "Z"],
            each.flat_map(|v| [v[0], v[1], 0.0]).collect(),
        ),
        Components::Tensor => (
            &["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"],
            each.flat_map(|t| [t[0], t[1], 0.0, t[2], t[3], 0.0, 0.0, 0.0, t[4]])
                .collect(),
        ),
        Components::Symmetric => (
            &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
            each.flat_map(|t| [t[0], t[1], t[2], t[3], 0.0, 0.0])
                .collect(),
        ),
    };
    let values = values.into_iter();
    // Displacements are read again with all digits; what follows from them is looked at.
    if array.name.ends_with("displacement_mm") {
        data_array(
            "Float64",
            array.name,
            names,
            values.flat_map(f64::to_le_bytes),
        )
    } else {
        let values = values.flat_map(|value| (value as f32).to_le_bytes());
        data_array("Float32", array.name, names, values)
    }
}

/// An array of numbers of a type from their bytes; scalars have no names of components.
fn data_array(kind: &str, name: &str, names: &[&str], bytes: impl Iterator<Item = u8>) -> String {
    let mut head = format!("type=\"{kind}\" Name=\"{name}\" format=\"binary\"");
    if !names.is_empty() {
        head += &format!(" NumberOfComponents=\"{}\"", names.len());
    }
    for (index, name) in names.iter().enumerate() {
        head += &format!(" ComponentName{index}=\"{name}\"");
    }
    let data = compressed(&bytes.collect::<Vec<u8>>());
    format!("<DataArray {head}>{data}</DataArray>")
}

/// Compressed blocks in base64; their head has the number of blocks, the size of a block, that of the last one, and the compressed size of each.
fn compressed(bytes: &[u8]) -> String {
    let mut zlib = Compress::new(Compression::new(LEVEL), true);
    let (mut sizes, mut blocks) = (Vec::new(), Vec::new());
    for block in bytes.chunks(BLOCK) {
        zlib.reset();
        let start = blocks.len();
        // Deflate adds five bytes to a stored block of this size, and zlib its own head and sum.
        blocks.reserve(block.len() + 64);
        zlib.compress_vec(block, &mut blocks, FlushCompress::Finish)
            .expect("compression in memory does not fail");
        sizes.push(blocks.len() - start);
    }
    let last = bytes.chunks(BLOCK).next_back().map_or(0, <[u8]>::len);
    let head = [sizes.len(), BLOCK, last].into_iter().chain(sizes);
    let head: Vec<u8> = head.flat_map(|size| (size as u64).to_le_bytes()).collect();
    STANDARD.encode(head) + &STANDARD.encode(blocks)
}

/// ParaView's collection of `.vtu` files by their names, with the stretch or the load factor as their times; with the number of the
/// step where those fall or come again, because ParaView shows one file at each time, in the order of the times.
pub fn collection(grids: &[(f64, String)]) -> Vec<u8> {
    let rising = grids.windows(2).all(|pair| pair[0].0 < pair[1].0);
    let steps = grids.iter().zip(1..).map(|((time, name), step)| {
        let time = if rising { *time } else { f64::from(step) };
        let name = escape(name.as_str());
        format!("    <DataSet timestep=\"{time}\" part=\"0\" file=\"{name}.vtu\"/>\n")
    });
    let steps: String = steps.collect();
    let file = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n{steps}  </Collection>\n</VTKFile>"
    );
    file.into_bytes()
}
