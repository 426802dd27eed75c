//! VTK's unstructured grids.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use vtkio::model::{
    Attribute, CellType, DataSet, IOBuffer, Piece, UnstructuredGridPiece, VertexNumbers, Vtk,
};

use super::Raw;
use crate::mesh::CellShape;

/// Cell arrays in which meshio and Gmsh keep the numbers of physical groups.
const GROUPS: [&str; 3] = ["gmsh:physical", "physical", "CellEntityIds"];

/// Reads a `.vtu` or `.vtk` file.
///
/// # Errors
/// Says what is wrong or cannot be read.
pub fn read(path: &Path) -> Result<Raw, String> {
    grid(&piece(path)?)
}

/// Arrays of vectors by name: two or three components of point after point.
pub type Arrays = Vec<(String, Vec<f64>)>;

/// Reads a file with its arrays of vectors at the points.
///
/// # Errors
/// Says what is wrong or cannot be read.
pub fn read_with_arrays(path: &Path) -> Result<(Raw, Arrays), String> {
    let piece = piece(path)?;
    let raw = grid(&piece)?;
    let points = raw.places.len();
    let all = piece
        .data
        .point
        .iter()
        .flat_map(|attribute| match attribute {
            Attribute::DataArray(array) => vec![(&array.name, &array.data)],
            Attribute::Field { data_array, .. } => {
                let arrays = data_array.iter();
                arrays.map(|array| (&array.name, &array.data)).collect()
            }
        });
    let vectors = all.filter(|(_, data)| [2 * points, 3 * points].contains(&data.len()));
    let arrays = vectors.filter_map(|(name, data)| Some((name.clone(), numbers(data)?)));
    let arrays = arrays.collect();
    Ok((raw, arrays))
}

/// The only piece of a file.
fn piece(path: &Path) -> Result<UnstructuredGridPiece, String> {
    refuse_legacy_5(path)?;
    let file = Vtk::import(path).map_err(|cause| format!("cannot be read as VTK: {cause}"))?;
    let DataSet::UnstructuredGrid { pieces, .. } = file.data else {
        return Err("is no unstructured grid".into());
    };
    let mut pieces = pieces.into_iter();
    let (Some(piece), None) = (pieces.next(), pieces.next()) else {
        return Err("has several pieces; merge them into one".into());
    };
    match piece {
        Piece::Inline(piece) => Ok(*piece),
        _ => Err("refers to other files; save it as one".into()),
    }
}

/// Legacy files of the version 5 list their cells in another way, which the library does not know.
fn refuse_legacy_5(path: &Path) -> Result<(), String> {
    let mut first = String::new();
    let file = File::open(path).map_err(|cause| format!("cannot be read: {cause}"))?;
    // A file that is no text has no such line.
    let _ = BufReader::new(file).take(100).read_line(&mut first);
    match first.trim().strip_prefix("# vtk DataFile Version 5") {
        Some(_) => {
            Err("is a legacy VTK file of the version 5; save it as .vtu or in version 4.2".into())
        }
        None => Ok(()),
    }
}

fn grid(piece: &UnstructuredGridPiece) -> Result<Raw, String> {
    let mut raw = Raw::default();
    let places = numbers(&piece.points).ok_or("has points that are no numbers")?;
    for (name, place) in places.chunks_exact(3).enumerate() {
        raw.places
            .insert(name as u64, [place[0], place[1], place[2]]);
    }
    let groups = piece
        .data
        .cell
        .iter()
        .find_map(|attribute| match attribute {
            Attribute::DataArray(array) if GROUPS.contains(&&*array.name) => numbers(&array.data),
            _ => None,
        });
    let cells = cells(&piece.cells.cell_verts)?;
    for (index, (kind, nodes)) in piece.cells.types.iter().zip(cells).enumerate() {
        let shape = match kind {
            CellType::Triangle => CellShape::Triangle3,
            CellType::QuadraticTriangle => CellShape::Triangle6,
            CellType::Quad => CellShape::Quad4,
            CellType::QuadraticQuad => CellShape::Quad8,
            CellType::BiquadraticQuad => CellShape::Quad9,
            CellType::Vertex => continue,
            CellType::Line | CellType::QuadraticEdge => {
                let tag = groups.as_ref().and_then(|groups| groups.get(index));
                if let (Some(tag), [a, b, ..]) = (tag, &nodes[..]) {
                    let group = format!("physical-{tag}");
                    raw.lines.entry(group).or_default().push([*a, *b]);
                }
                continue;
            }
            other => {
                return Err(format!(
                    "has cells of the kind {other:?}, which is not flat"
                ));
            }
        };
        if nodes.len() != shape.nodes() {
            return Err(format!(
                "has a cell of {} nodes where {} belong",
                nodes.len(),
                shape.nodes()
            ));
        }
        raw.cells.push((shape, nodes));
    }
    Ok(raw)
}

fn numbers(buffer: &IOBuffer) -> Option<Vec<f64>> {
    buffer.cast_into::<f64>()
}

/// The nodes of each cell.
fn cells(vertices: &VertexNumbers) -> Result<Vec<Vec<u64>>, String> {
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
                    .and_then(|end| connectivity.get(start..end));
                let nodes = nodes.ok_or("has a list of cells that is cut off")?;
                cells.push(nodes.to_vec());
                start = *end as usize;
            }
        }
        VertexNumbers::Legacy { vertices, .. } => {
            let mut rest = &vertices[..];
            while let Some((count, more)) = rest.split_first() {
                let count = *count as usize;
                let nodes = more
                    .get(..count)
                    .ok_or("has a list of cells that is cut off")?;
                cells.push(nodes.iter().map(|node| u64::from(*node)).collect());
                rest = &more[count..];
            }
        }
    }
    Ok(cells)
}
