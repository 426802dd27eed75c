//! The request for a correction, from the options of the command line.

use super::options::Options;
use gelbench_base::error::Error;
use gelbench_estimation::estimation::EdgeCondition;
use gelbench_mechanics::markers::{ChosenColumns, ReadSettings};
use gelbench_mechanics::mesh::{Exemptions, MeshReading};
use gelbench_studies::studies::markers::{Conditions, MeshSource, Request};

/// What is to be corrected, and how.
pub fn request(options: Options) -> Result<Request, Error> {
    let columns = ChosenColumns::parse(options.columns.iter().map(String::as_str));
    Ok(Request {
        conditions: conditions(&options)?,
        mesh: mesh_source(&options),
        reading: ReadSettings {
            unit: options.unit,
            array: options.array,
            grid: options.grid,
            ignored_columns: options.ignore_columns,
            columns: columns?,
            encoding: options.encoding,
            downwards: options.y_axis,
            deformed: options.places,
            rest: options.rest,
        },
        images: options.images.settings(),
        forces: options.forces,
        files: options.fields,
        material: options.material,
        thickness: options.thickness.unwrap_or_default(),
        cell_size: options.cell_size,
        shape: options.cells,
        holes: options.holes,
        budget: options.large.budget(),
    })
}

/// The known conditions of the file, completed by the command line.
fn conditions(options: &Options) -> Result<Conditions, Error> {
    let mut conditions = match &options.study {
        Some(path) => Conditions::of_file(path)?.without_specimen(path)?,
        None => Conditions::default(),
    };
    let free = options.free.iter().map(|name| (name, EdgeCondition::Free));
    let names = options.rigid.iter();
    let rigid = names.map(|name| (name, EdgeCondition::Rigid));
    let edges = free.chain(rigid);
    conditions
        .edges
        .extend(edges.map(|(name, condition)| (name.clone(), condition)));
    let forces = options.force.iter().map(|force| (None, force.clone()));
    conditions.forces.extend(forces);
    conditions
        .force_columns
        .extend_from_slice(&options.force_column);
    conditions.clock.interval = options.frame_interval.or(conditions.clock.interval);
    conditions.clock.offset = options.clock_offset.unwrap_or(conditions.clock.offset);
    conditions.fit.extend_from_slice(&options.fit);
    conditions.regions.extend_from_slice(&options.region);
    conditions.sheet = options.sheet.or(conditions.sheet);
    conditions.noise = options.noise.or(conditions.noise);
    conditions.edge_gap = options.edge_gap.or(conditions.edge_gap);
    conditions.scale_deviation = options.scale_error.unwrap_or(conditions.scale_deviation);
    conditions.robust = options.robust.or(conditions.robust);
    conditions.physics = options.physics.unwrap_or(conditions.physics);
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
                is_plane_strain: None,
            };
            MeshSource::File(mesh.clone(), reading)
        }
        (None, Some(outline)) => MeshSource::Outline(outline.clone()),
        (None, None) => MeshSource::Data,
    }
}
