//! VTK's unstructured grids, and its legacy files (`.vtk`); the XML files are read by [`super::vtu`].

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use vtkio::model::{
    Attribute, DataSet, IOBuffer, Piece, UnstructuredGridPiece, VertexNumbers, Vtk,
};

use super::raw::{ImportFault, Raw, read_bytes};
use super::unstructured::{Arrays, CUT_OFF, UnstructuredGrid};
use super::vtu;

/// Reads a `.vtu` or `.vtk` file.
pub fn read(path: &Path) -> Result<Raw, ImportFault> {
    grid(path)?.raw()
}

/// Reads a file with its arrays of vectors at the points.
pub fn read_with_arrays(path: &Path) -> Result<(Raw, Arrays), ImportFault> {
    let grid = grid(path)?;
    let raw = grid.raw()?;
    let points = raw.positions.len();
    let is_vector =
        |(_, values): &(String, Vec<f64>)| [2 * points, 3 * points].contains(&values.len());
    let arrays = grid.point_arrays.into_iter().filter(is_vector);
    Ok((raw, arrays.collect()))
}

fn grid(path: &Path) -> Result<UnstructuredGrid, ImportFault> {
    let bytes = read_bytes(path)?;
    let is_legacy = bytes.starts_with(b"# vtk DataFile");
    if is_legacy {
        legacy(&bytes)
    } else {
        vtu::read(&bytes)
    }
}

/// A legacy file.
fn legacy(bytes: &[u8]) -> Result<UnstructuredGrid, ImportFault> {
    check_legacy(bytes)?;
    // The library panics on some files that are cut off.
    let parsed = catch_unwind(AssertUnwindSafe(|| Vtk::parse_legacy_be(bytes)));
    let file = match parsed {
        Ok(Ok(file)) => file,
        Ok(Err(cause)) => return Err(format!("cannot be read as VTK: {cause}").into()),
        Err(_) => return Err("cannot be read as VTK: it is cut off or damaged".into()),
    };
    let DataSet::UnstructuredGrid { pieces, .. } = file.data else {
        return Err("is not an unstructured grid".into());
    };
    match pieces.into_iter().next() {
        Some(Piece::Inline(piece)) => of_piece(&piece),
        _ => Err("refers to other files; save it as one".into()),
    }
}

/// Refuses legacy files of the version 5, which list their cells in another way, and numbers of points or cells that
/// the file cannot hold.
fn check_legacy(bytes: &[u8]) -> Result<(), ImportFault> {
    if bytes.starts_with(b"# vtk DataFile Version 5") {
        return Err(
            "is a legacy VTK file of the version 5; save it as .vtu or in version 4.2".into(),
        );
    }
    for line in bytes.split(|byte| *byte == b'\n') {
        let Ok(line) = std::str::from_utf8(line) else {
            continue;
        };
        let mut words = line.split_ascii_whitespace();
        let counted = [
            "POINTS",
            "CELLS",
            "CELL_TYPES",
            "POINT_DATA",
            "CELL_DATA",
            "FIELD",
        ];
        if !words.next().is_some_and(|word| counted.contains(&word)) {
            continue;
        }
        // A value takes a byte at least.
        let mut numbers = words.filter_map(|word| word.parse::<u64>().ok());
        if let Some(number) = numbers.find(|number| *number > bytes.len() as u64) {
            return Err(format!("says `{}`, and is too short for {number}", line.trim()).into());
        }
    }
    Ok(())
}

fn of_piece(piece: &UnstructuredGridPiece) -> Result<UnstructuredGrid, ImportFault> {
    let points = numbers(&piece.points).ok_or("has points that are not numbers")?;
    let kinds = piece.cells.types.iter().map(|kind| *kind as u8);
    Ok(UnstructuredGrid {
        points,
        cells: kinds.zip(cells(&piece.cells.cell_verts)?).collect(),
        point_arrays: arrays(&piece.data.point),
        cell_arrays: arrays(&piece.data.cell),
    })
}

fn arrays(attributes: &[Attribute]) -> Arrays {
    let arrays = attributes.iter().flat_map(|attribute| match attribute {
        Attribute::DataArray(array) => vec![(&array.name, &array.data)],
        Attribute::Field { data_array, .. } => {
            let arrays = data_array.iter();
            arrays.map(|array| (&array.name, &array.data)).collect()
        }
    });
    arrays
        .filter_map(|(name, data)| Some((name.clone(), numbers(data)?)))
        .collect()
}

fn numbers(buffer: &IOBuffer) -> Option<Vec<f64>> {
    buffer.cast_into::<f64>()
}

/// The nodes of each cell.
fn cells(vertices: &VertexNumbers) -> Result<Vec<Vec<u64>>, ImportFault> {
    let mut cells = Vec::new();
    match vertices {
        VertexNumbers::XML {
            connectivity,
            offsets,
        } => {
            let mut start = 0;
            for end in offsets {
                let nodes = usize::try_from(*end)
                    .ok()
                    .and_then(|end| connectivity.get(start..end))
                    .ok_or(CUT_OFF)?;
                cells.push(nodes.to_vec());
                start = *end as usize;
            }
        }
        VertexNumbers::Legacy { vertices, .. } => {
            let mut rest = &vertices[..];
            while let Some((count, more)) = rest.split_first() {
                let count = *count as usize;
                let nodes = more.get(..count).ok_or(CUT_OFF)?;
                cells.push(nodes.iter().map(|node| u64::from(*node)).collect());
                rest = &more[count..];
            }
        }
    }
    Ok(cells)
}
