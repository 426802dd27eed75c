//! The fields of all models beside a displacement field of another program.
//!
//! ```text
//! displacement            100 √(Σ A |u − v|² / Σ A |v|²)                            [%]
//! largest difference      max |u − v|, and where                                   [mm]
//! ```
//!
//! v is the imported field. One on a mesh is interpolated at the nodes of the lattice, and A is the area that belongs
//! to each node; the fields are interpolated at scattered points, all with the same weight A = 1.

use std::path::Path;

use super::{corner_areas, distance};
use crate::calibration::Table;
use crate::error::{Diagnostic, Error};
use crate::mesh::{ImportedField, Mesh, import_field};
use crate::units::{self, Dimension};

/// How a file is to be understood.
#[derive(Clone, Debug)]
pub struct ImportSettings {
    /// The length of the file's unit in mm, where the file does not say it.
    pub unit: f64,
    /// The array of a VTK file, where it must be named.
    pub array: Option<String>,
    /// The load factor.
    pub factor: f64,
    /// The time of a step, where it is not the load factor.
    pub time: Option<f64>,
}

/// A displacement field of another program.
#[derive(Clone, Debug)]
pub enum Imported {
    /// On a mesh of its own.
    OnMesh(Box<ImportedField>),
    /// At scattered points.
    AtPoints {
        /// Places in mm.
        places: Vec<[f64; 2]>,
        /// ux, uy of point after point in mm.
        displacement: Vec<f64>,
    },
}

/// A field of one of the models.
#[derive(Clone, Debug)]
pub struct ModelField {
    /// The model.
    pub model: &'static str,
    /// Its mesh.
    pub mesh: Mesh,
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
}

/// Where fields are compared, and what the imported one is there.
#[derive(Clone, Debug)]
pub struct Sites {
    /// Places in mm.
    pub places: Vec<[f64; 2]>,
    weights: Vec<f64>,
    /// ux, uy of place after place in mm.
    pub expected: Vec<f64>,
}

/// How far a field is from the imported one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Relative L2 in %.
    pub percent: f64,
    /// The largest difference in mm.
    pub largest: f64,
    /// Where it is, in mm.
    pub place: [f64; 2],
}

/// Shapes of the same specimen may differ by so much of a cell: a circle and its polygon.
const NEAR_CELLS: f64 = 0.25;
/// Boxes around meshes of the same specimen may differ by so much of their size.
const NEAR_SIZE: f64 = 0.02;

impl Imported {
    /// Reads `.vtu`, `.vtk`, `.pvd`, `.msh`, `.frd` or `.csv`.
    ///
    /// # Errors
    /// [`Error::Input`] with what is wrong.
    pub fn read(path: &Path, settings: &ImportSettings) -> Result<Self, Error> {
        let is_table = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        if is_table {
            return read_table(&Table::read(path)?, settings);
        }
        let field = import_field(
            path,
            settings.unit,
            settings.array.as_deref(),
            settings.time.unwrap_or(settings.factor),
        );
        field.map(|field| Self::OnMesh(Box::new(field))).map_err(|reason| {
            let hint = "a field stands in .vtu, .vtk (to version 4), .pvd, Gmsh's .msh with $NodeData, CalculiX' .frd (ASCII), or .csv with X, Y, ux, uy";
            Error::input(format!("{} {reason}", path.display()), hint)
        })
    }

    /// What was read.
    pub fn describe(&self) -> String {
        match self {
            Self::OnMesh(field) => format!("{} on {} cells", field.part, field.mesh.cell_count()),
            Self::AtPoints { places, .. } => format!("{} points", places.len()),
        }
    }

    /// Where the models are compared with it: at the nodes of a lattice, or at the points.
    ///
    /// # Errors
    /// Says where the field does not belong to the specimen.
    pub fn sites(&self, lattice: &Mesh) -> Result<Sites, String> {
        match self {
            Self::OnMesh(field) => {
                same_size(&field.mesh, lattice)?;
                covers(
                    &field.mesh,
                    &lattice.nodes,
                    "the field's mesh does not reach the specimen's node",
                )?;
                covers(
                    lattice,
                    &field.mesh.nodes,
                    "the specimen does not reach the field's node",
                )?;
                Ok(Sites {
                    places: lattice.nodes.clone(),
                    weights: corner_areas(lattice),
                    expected: field.mesh.displacement_on(&field.displacement, lattice),
                })
            }
            Self::AtPoints {
                places,
                displacement,
            } => {
                covers(lattice, places, "the specimen does not reach the point")?;
                Ok(Sites {
                    places: places.clone(),
                    weights: vec![1.0; places.len()],
                    expected: displacement.clone(),
                })
            }
        }
    }
}

impl Sites {
    /// A model's field at the sites, ux, uy of place after place.
    pub fn at(&self, field: &ModelField) -> Vec<f64> {
        let places = self.places.iter();
        places
            .flat_map(|place| field.mesh.displacement_at(&field.displacement, *place))
            .collect()
    }

    /// How far a model's field is from the imported one.
    ///
    /// # Errors
    /// Says that the imported field rests, so that nothing can be related to it.
    pub fn difference(&self, field: &ModelField) -> Result<Difference, String> {
        let found = self.at(field);
        let size = distance(&self.weights, &self.expected, &vec![0.0; found.len()]);
        if size == 0.0 {
            return Err("is zero everywhere".into());
        }
        let pairs = found.chunks_exact(2).zip(self.expected.chunks_exact(2));
        let distances = pairs.map(|(u, v)| (u[0] - v[0]).hypot(u[1] - v[1]));
        let (place, largest) =
            distances.enumerate().fold(
                (0, -1.0),
                |most, next| if next.1 > most.1 { next } else { most },
            );
        Ok(Difference {
            percent: 100.0 * distance(&self.weights, &found, &self.expected) / size,
            largest,
            place: self.places[place],
        })
    }
}

/// Whether two meshes have boxes of one size.
fn same_size(field: &Mesh, specimen: &Mesh) -> Result<(), String> {
    let size = |mesh: &Mesh| {
        let [low, high] = mesh.bounding_box();
        [0, 1].map(|axis| high[axis] - low[axis])
    };
    let (found, expected) = (size(field), size(specimen));
    if (0..2).all(|axis| (found[axis] / expected[axis] - 1.0).abs() <= NEAR_SIZE) {
        return Ok(());
    }
    Err(format!(
        "the field's mesh measures {:.4} × {:.4} mm, the specimen {:.4} × {:.4} mm",
        found[0], found[1], expected[0], expected[1]
    ))
}

/// Whether all places lie in a mesh.
fn covers(mesh: &Mesh, places: &[[f64; 2]], what: &str) -> Result<(), String> {
    match places
        .iter()
        .find(|place| mesh.outside(**place) > NEAR_CELLS)
    {
        Some([x, y]) => Err(format!("{what} at ({x:.4}, {y:.4}) mm")),
        None => Ok(()),
    }
}

/// Points from columns `X_mm`, `Y_mm`, `ux_mm`, `uy_mm`, their units in the name or in brackets. Of a table with a
/// column `stretch`, `load_factor`, `factor` or `time` the rows with the factor are taken.
fn read_table(table: &Table, settings: &ImportSettings) -> Result<Imported, Error> {
    let column = |name: &str| {
        let found = table
            .columns
            .iter()
            .enumerate()
            .find_map(|(index, column)| {
                let unit = match column.name.strip_prefix(name)? {
                    "" => column.unit.clone(),
                    rest => Some(rest.strip_prefix('_')?.to_owned()),
                };
                Some((index, unit))
            });
        let refuse = |message: String, hint: &str| {
            let fault = Diagnostic::error("", message).hint(hint);
            Error::Input(vec![fault.at(&table.source, table.columns_place.clone())])
        };
        let Some((index, unit)) = found else {
            let hint = "name the columns X_mm, Y_mm, ux_mm and uy_mm, with the unit of your own";
            return Err(refuse(format!("there is no column `{name}`"), hint));
        };
        if let Some((reason, place)) = table.fault(index) {
            let fault = Diagnostic::error("", reason).hint("every field of a column is a number");
            return Err(Error::Input(vec![fault.at(&table.source, place)]));
        }
        match unit {
            None => Ok((index, settings.unit)),
            Some(unit) => units::parse(&format!("1 {unit}"), Dimension::Length)
                .map(|unit| (index, unit))
                .map_err(|_| {
                    refuse(
                        format!("`{unit}` is no unit of length"),
                        "mm, cm, m, um or in",
                    )
                }),
        }
    };
    let columns = [column("x")?, column("y")?, column("ux")?, column("uy")?];
    let factor = table
        .columns
        .iter()
        .position(|column| ["stretch", "load_factor", "factor", "time"].contains(&&*column.name));
    let chosen = |row: &&Vec<f64>| {
        factor.is_none_or(|column| (row[column] - settings.factor).abs() <= 1e-6 * settings.factor)
    };
    let rows: Vec<&Vec<f64>> = table
        .rows
        .iter()
        .map(|(row, _)| row)
        .filter(chosen)
        .collect();
    if rows.is_empty() {
        let message = format!(
            "{} has no rows for the load factor {}",
            table.source.name, settings.factor
        );
        return Err(Error::input(
            message,
            "choose one that it has with --factor",
        ));
    }
    let values = |row: &&Vec<f64>, pair: [usize; 2]| pair.map(|i| row[columns[i].0] * columns[i].1);
    Ok(Imported::AtPoints {
        places: rows.iter().map(|row| values(row, [0, 1])).collect(),
        displacement: rows.iter().flat_map(|row| values(row, [2, 3])).collect(),
    })
}

#[cfg(test)]
mod tests;
