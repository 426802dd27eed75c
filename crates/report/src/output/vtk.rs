//! VTK files: one `.vtu` per grid, and one `.pvd` per series, which plays its grids.

use quick_xml::escape::escape;
use rayon::prelude::*;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataArray, DataSet, ElementType, IOBuffer,
    UnstructuredGridPiece, Version, VertexNumbers, Vtk,
};
use vtkio::xml::Compressor;

use self::compressed::{COMPRESSOR, compressed};
use crate::mesh::CellShape;
use crate::results::{Array, Components, Grid, GridCell, GridSeries};

mod compressed;

/// A program for ParaView that shows the models of the folder that it is in, side by side.
pub const VIEW: &str = include_str!("view.py");

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
    let positions = grid.points.iter();
    let piece = UnstructuredGridPiece {
        points: IOBuffer::F64(positions.flat_map(|[x, y]| [*x, *y, 0.0]).collect()),
        cells: cells(grid),
        data: Attributes {
            point: grid.at_points.iter().map(attribute).collect(),
            cell: grid.in_cells.iter().map(attribute).collect(),
        },
    };
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        data: DataSet::inline(piece),
        file_path: None,
    };
    let mut bytes = Vec::new();
    let file = file.try_into_xml_format(Compressor::None, 0);
    file.and_then(|file| file.write(&mut bytes))
        .expect("a grid with matching arrays can be written to memory");
    finished(&bytes, grid)
}

/// The file with compressed arrays, which vtkio writes number by number, with the names of the components, which it does not write, and with
/// numbers of points that have a sign, as VTK and meshio expect them.
fn finished(file: &[u8], grid: &Grid) -> Vec<u8> {
    let file = String::from_utf8_lossy(file);
    let arrays = || grid.at_points.iter().chain(&grid.in_cells);
    let named = |head: &str| {
        let name = head.split("Name=\"").nth(1)?.split('"').next()?;
        arrays().find(|array| array.name == name)
    };
    let mut output = String::with_capacity(file.len() + 4096);
    let mut parts = file.split("<DataArray ");
    let first = parts.next().unwrap_or_default();
    output += &first.replacen("header_type=", &format!("{COMPRESSOR} header_type="), 1);
    for part in parts {
        let (head, rest) = part.split_once('>').unwrap_or((part, ""));
        output += "<DataArray ";
        output += &head
            .trim_end_matches('/')
            .replace("\"UInt64\"", "\"Int64\"");
        let names = named(head).map_or(&[][..], |array| names(array.components));
        for (index, name) in names.iter().enumerate() {
            output += &format!(" ComponentName{index}=\"{name}\"");
        }
        output += if head.ends_with('/') { "/>" } else { ">" };
        let (array, after) = rest.split_at(rest.find('<').unwrap_or(rest.len()));
        match compressed(array).filter(|_| !head.ends_with('/')) {
            Some(array) => output += &array,
            None => output += array,
        }
        output += after;
    }
    output.into_bytes()
}

fn names(components: Components) -> &'static [&'static str] {
    match components {
        Components::Scalar => &[],
        Components::Vector => &["X", "Y", "Z"],
        Components::Tensor => &["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"],
        Components::Symmetric => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
        Components::Stretches => &["larger", "smaller", "thickness"],
    }
}

fn cells(grid: &Grid) -> Cells {
    let ends = grid.cells.iter().scan(0, |end, cell| {
        *end += cell.points() as u64;
        Some(*end)
    });
    let points = grid.connectivity.iter();
    Cells {
        types: grid.cells.iter().map(|cell| kind(*cell)).collect(),
        cell_verts: VertexNumbers::XML {
            connectivity: points.map(|point| *point as u64).collect(),
            offsets: ends.collect(),
        },
    }
}

fn kind(cell: GridCell) -> CellType {
    match cell {
        GridCell::Vertex => CellType::Vertex,
        GridCell::Line => CellType::Line,
        GridCell::Mesh(CellShape::Triangle3) => CellType::Triangle,
        GridCell::Mesh(CellShape::Triangle6) => CellType::QuadraticTriangle,
        GridCell::Mesh(CellShape::Quad4) => CellType::Quad,
        GridCell::Mesh(CellShape::Quad8) => CellType::QuadraticQuad,
        GridCell::Mesh(CellShape::Quad9) => CellType::BiquadraticQuad,
    }
}

/// Vectors and tensors in the plane become those of space.
fn attribute(array: &Array) -> Attribute {
    let values = &array.values;
    let (elem, data) = match array.components {
        Components::Scalar => {
            let (num_comp, lookup_table) = (1, None);
            let scalars = ElementType::Scalars {
                num_comp,
                lookup_table,
            };
            (scalars, values.clone())
        }
        Components::Vector => {
            let planar = values.chunks_exact(2);
            let padded = planar.flat_map(|v| [v[0], v[1], 0.0]);
            (ElementType::Vectors, padded.collect())
        }
        Components::Stretches => (ElementType::Generic(3), values.clone()),
        Components::Tensor => {
            let fives = values.chunks_exact(5);
            let padded = fives.flat_map(|t| [t[0], t[1], 0.0, t[2], t[3], 0.0, 0.0, 0.0, t[4]]);
            (ElementType::Tensors, padded.collect())
        }
        Components::Symmetric => {
            let fours = values.chunks_exact(4);
            let padded = fours.flat_map(|t| [t[0], t[1], t[2], t[3], 0.0, 0.0]);
            (ElementType::Generic(6), padded.collect())
        }
    };
    // Displacements are read again with all digits; what follows from them is looked at.
    let data = if array.name.ends_with("displacement_mm") {
        IOBuffer::F64(data)
    } else {
        IOBuffer::F32(data.into_iter().map(|value| value as f32).collect())
    };
    Attribute::DataArray(DataArray {
        name: array.name.to_owned(),
        elem,
        data,
    })
}

/// ParaView's collection of `.vtu` files by their names, with the stretch or the load factor as their times; with the number of the
/// step where those fall or come again, because ParaView shows one file at each time, in the order of the times.
pub fn collection(grids: &[(f64, String)]) -> Vec<u8> {
    let rising = grids.windows(2).all(|pair| pair[0].0 < pair[1].0);
    let data_set = |(step, (time, name)): (usize, &(f64, String))| {
        let time = if rising { *time } else { (step + 1) as f64 };
        let name = escape(name);
        format!("    <DataSet timestep=\"{time}\" part=\"0\" file=\"{name}.vtu\"/>\n")
    };
    let data_sets: String = grids.iter().enumerate().map(data_set).collect();
    let head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">";
    let file = format!("{head}\n  <Collection>\n{data_sets}  </Collection>\n</VTKFile>");
    file.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tensors_have_nine_components_with_the_one_across_the_plane() {
        let stress = Array::tensors("stress_MPa", [1.0, 2.0, 3.0, 4.0, 5.0]);
        let Attribute::DataArray(DataArray { data, .. }) = attribute(&stress) else {
            panic!("an array");
        };
        let expected = vec![1.0, 2.0, 0.0, 3.0, 4.0, 0.0, 0.0, 0.0, 5.0];
        assert_eq!(data.into_vec::<f32>(), Some(expected));
    }

    #[test]
    fn symmetric_tensors_have_six_named_components() {
        let stress = Array::new("stress_MPa", Components::Symmetric, [1.0, 2.0, 3.0, 4.0]);
        let grid = Grid::scattered(&[[1.0, 2.0]], &[0.5, 0.0]).with([stress]);
        let text = String::from_utf8(super::grid(&grid)).unwrap();
        let heads: Vec<_> = text.split("<DataArray ").skip(1).collect();
        let stress = heads
            .iter()
            .find(|head| head.contains("stress_MPa"))
            .unwrap();
        let names = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];
        for (index, name) in names.iter().enumerate() {
            assert!(
                stress.contains(&format!(" ComponentName{index}=\"{name}\"")),
                "{stress}"
            );
        }
        assert!(stress.contains("NumberOfComponents=\"6\""), "{stress}");
        assert!(text.contains("vtkZLibDataCompressor"), "{text}");
        let vtk = Vtk::parse_xml(text.as_bytes()).unwrap();
        assert!(matches!(vtk.data, DataSet::UnstructuredGrid { .. }));
    }

    /// 4096 cells have an array of whole blocks.
    #[test]
    fn arrays_of_whole_blocks_are_read_again() {
        for count in [4095, 4096, 4097] {
            let points: Vec<[f64; 2]> = (0..count).map(|i| [f64::from(i), 0.0]).collect();
            let field: Vec<f64> = (0..2 * count).map(|i| f64::from(i).sin()).collect();
            let file = super::grid(&Grid::scattered(&points, &field));
            let compressed = String::from_utf8_lossy(&file).contains("vtkZLibDataCompressor");
            assert!(compressed, "{count}");
            assert!(Vtk::parse_xml(&file[..]).is_ok());
        }
    }

    #[test]
    fn files_of_a_motion_have_stable_names_and_a_collection_of_their_times() {
        let point = Grid::scattered(&[[1.0, 2.0]], &[0.5, 0.0]);
        let grids = [(0.0, point.clone()), (0.25, point.clone())];
        let files: Vec<_> = files(&GridSeries::instants("corrected", grids)).collect();
        let names: Vec<&str> = files.iter().map(|(name, _)| &**name).collect();
        assert_eq!(
            names,
            [
                "corrected_00001.vtu",
                "corrected_00002.vtu",
                "corrected.pvd"
            ]
        );
        let collection = String::from_utf8(files[2].1.clone()).unwrap();
        assert!(
            collection.contains("timestep=\"0.25\" part=\"0\" file=\"corrected_00002.vtu\""),
            "{collection}"
        );
        let back = [0.5, 1.0, 0.5].map(|factor| (factor, "a".to_owned()));
        let collection = String::from_utf8(super::collection(&back)).unwrap();
        for step in 1..=3 {
            assert!(
                collection.contains(&format!("timestep=\"{step}\"")),
                "{collection}"
            );
        }
        let end = GridSeries::single("corrected_end", point);
        assert_eq!(super::files(&end).count(), 1);
    }
}
