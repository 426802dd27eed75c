//! What is to be corrected, of what the command line says.

use super::options::Options;
use super::values::{Cells, Holds, Holes, Places, Weights, YAxis};
use crate::error::Error;
use crate::estimation::{EdgeCondition, Physics, Robust};
use crate::markers::{ChosenColumns, ReadSettings};
use crate::mesh::{CellShape, Exemptions, MeshReading};
use crate::studies::markers::{Conditions, MeshSource, Request};

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

/// What is to be corrected, and how.
pub fn request(options: Options) -> Result<Request, Error> {
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
    conditions.scale_deviation = options.scale_error.unwrap_or(conditions.scale_deviation);
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
