//! The fields of all models compared with a displacement field of another program.
//!
//! ```text
//! displacement            100 √(Σ A |u − v|² / Σ A |v|²)                            [%]
//! largest difference      max |u − v|, and where                                   [mm]
//! ```
//!
//! v is the imported field. One on a mesh is interpolated at the nodes of the lattice, and A is the area that belongs
//! to each node; the fields are interpolated at scattered points, all with the same weight A = 1.

use std::path::Path;

use crate::document::{Table, is_table_path};
use crate::error::Error;
use crate::markers::{Mistake, unit_ratio};
use crate::mesh::geometry::sides;
use crate::mesh::{
    ImportedField, Mesh, import_field, largest_distance, weighted_distance, weighted_norm,
};
use crate::problem::RigidMotion;
use crate::units::{decimals, extents, length_unit};

mod table;

pub use table::{ImportSettings, Points};

/// A displacement field of another program.
#[derive(Clone, Debug)]
pub enum ExternalField {
    /// On a mesh of its own.
    OnMesh(Box<ImportedField>),
    /// At scattered points.
    AtPoints(Points),
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

/// The fields of all models at one load factor.
#[derive(Debug)]
pub struct ModelFields {
    /// Of finite elements, springs and corrected springs those that are computed and have a solution.
    pub fields: Vec<ModelField>,
    /// Why the others have no solution.
    pub ends: Vec<Error>,
    /// The finite elements' own error in relative L2 in %; `None` where it is not known.
    pub own_percent: Option<f64>,
}

impl ModelFields {
    /// The fields of finite elements, springs and corrected springs, as far as they are computed and have a solution, and why the others
    /// have none.
    ///
    /// # Errors
    /// The first of `ends`, if there is one, where the finite elements have no solution.
    pub fn of(
        fields: [Option<ModelField>; 3],
        mut ends: Vec<Error>,
        own_percent: Option<f64>,
    ) -> Result<Self, Error> {
        if fields[0].is_none() && !ends.is_empty() {
            return Err(ends.swap_remove(0));
        }
        Ok(Self {
            fields: fields.into_iter().flatten().collect(),
            ends,
            own_percent,
        })
    }
}

/// The points at which fields are compared, and the imported field there.
#[derive(Clone, Debug)]
pub struct Sites {
    /// Points in mm.
    pub positions: Vec<[f64; 2]>,
    weights: Vec<f64>,
    /// ux, uy of point after point in mm.
    pub expected: Vec<f64>,
    /// The mesh whose nodes the points are; `None` for scattered points.
    lattice: Option<Mesh>,
}

/// The difference of a field from the imported one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Relative L2 in %.
    pub percent: f64,
    /// The largest difference in mm.
    pub largest: f64,
    /// The point of the largest difference, in mm.
    pub position: [f64; 2],
    /// The factor by which the imported displacements come nearest to the model's: Σ A u·v / Σ A v².
    pub factor: f64,
    /// The remaining difference in relative L2 in % after multiplication by this factor.
    pub scaled_percent: f64,
    /// The motion of the whole body by which the imported field comes nearest to the model's, about the middle of all points.
    pub shift: RigidMotion,
    /// The remaining difference in relative L2 in % after this motion.
    pub shifted_percent: f64,
    /// The mistake in how the imported field was written that explains most of the difference.
    pub mistake: Option<Mistake>,
}

/// Differences in relative L2 in % up to which neither a factor nor a mistake is sought behind them.
const SMALL: f64 = 10.0;

/// Whether a change of the imported field that leaves the second of two differences in % explains most of the first one.
fn explains_most(percent: f64, left: f64) -> bool {
    left < percent.min(100.0) / 3.0
}

impl Difference {
    /// The ratio of two units of length that would explain most of the difference.
    pub fn other_unit(&self) -> Option<f64> {
        const LARGE: f64 = 50.0;
        unit_ratio(self.factor).filter(|_| self.percent > LARGE)
    }

    /// Whether a factor, as between two load factors, explains most of the difference.
    pub fn is_scaled(&self) -> bool {
        self.percent > SMALL && explains_most(self.percent, self.scaled_percent)
    }

    /// Whether a motion of the whole body, as of a camera or of other axes, explains most of the difference.
    pub fn is_shifted(&self) -> bool {
        const LARGE: f64 = 0.5;
        self.percent > LARGE && explains_most(self.percent, self.shifted_percent)
    }
}

/// Largest difference of shapes of the same specimen, in sizes of a cell: a circle and its polygon.
const NEAR_CELLS: f64 = 0.25;
/// Largest relative difference of the boxes around meshes of the same specimen.
const NEAR_SIZE: f64 = 0.02;
/// Least part of the specimen's length and width that points all over it span.
const NEARLY_ALL: f64 = 0.9;

/// Why a field cannot be compared with those of a specimen.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Mismatch {
    /// Meshes of different sizes in mm.
    #[error(
        "the field's mesh measures {}, the specimen {}",
        extents(*.actual), extents(*.expected)
    )]
    Size {
        /// Length and width of the field's mesh.
        actual: [f64; 2],
        /// Length and width of the specimen.
        expected: [f64; 2],
    },
    /// Points and specimen appear to be in two units of length.
    #[error(
        "the points span {} mm and the specimen {} mm: about a factor of {ratio}, as between two units of length",
        decimals(*.actual, 4), decimals(*.expected, 4)
    )]
    Unit {
        /// The size of the points in mm.
        actual: f64,
        /// The size of the specimen in mm.
        expected: f64,
        /// The nearest factor between two units.
        ratio: f64,
    },
    /// A point that only one of the two has.
    #[error("{what} at ({}, {}) mm", decimals(.position[0], 4), decimals(.position[1], 4))]
    Outside {
        /// The part that does not cover the other.
        what: &'static str,
        /// The point in mm.
        position: [f64; 2],
    },
    /// A field that is zero, so that no deviation can be related to it.
    #[error("is zero everywhere")]
    Zero,
}

impl ExternalField {
    /// Reads `.vtu`, `.vtk`, `.pvd`, `.msh`, `.frd` or a table.
    ///
    /// # Errors
    /// [`Error::Input`] with a description of the fault.
    pub fn read(path: &Path, settings: &ImportSettings) -> Result<Self, Error> {
        if is_table_path(path) {
            return table::read(&Table::read(path, Table::HINT)?, settings).map(Self::AtPoints);
        }
        let field = import_field(
            path,
            settings.unit.unwrap_or(1.0),
            settings.array.as_deref(),
            settings.time.unwrap_or(settings.factor),
        );
        field.map(|field| Self::OnMesh(Box::new(field))).map_err(|reason| {
            let hint = "a field is read from .vtu, .vtk (to version 4), .pvd, Gmsh's .msh with $NodeData, CalculiX' .frd (ASCII), or a table (.csv, .xlsx, .npz …) with X, Y, ux, uy";
            let hint = reason.remedy.as_deref().unwrap_or(hint);
            Error::input(format!("{} {reason}", path.display()), hint)
        })
    }

    /// Describes the field that was read.
    pub fn describe(&self) -> String {
        match self {
            Self::OnMesh(field) => format!("{} on {} cells", field.part, field.mesh.cell_count()),
            Self::AtPoints(points) => format!("{} points", points.positions.len()),
        }
    }

    /// The points at which the models are compared with it: the nodes of a lattice, or its own points.
    ///
    /// # Errors
    /// `Mismatch` where the field does not belong to the specimen.
    pub fn sites(&self, lattice: &Mesh) -> Result<Sites, Mismatch> {
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
                    positions: lattice.nodes.clone(),
                    weights: lattice.corner_areas(),
                    expected: field.mesh.displacement_on(&field.displacement, lattice),
                    lattice: Some(lattice.clone()),
                })
            }
            Self::AtPoints(Points {
                positions,
                displacement,
            }) => {
                covers(lattice, positions, "the specimen does not reach the point")?;
                near_in_size(positions, lattice)?;
                Ok(Sites {
                    positions: positions.clone(),
                    weights: vec![1.0; positions.len()],
                    expected: displacement.clone(),
                    lattice: None,
                })
            }
        }
    }
}

impl Sites {
    /// A model's field at the sites, ux, uy of point after point.
    pub fn at(&self, field: &ModelField) -> Vec<f64> {
        if let Some(lattice) = &self.lattice {
            return field.mesh.displacement_on(&field.displacement, lattice);
        }
        let positions = self.positions.iter();
        positions
            .flat_map(|position| field.mesh.displacement_at(&field.displacement, *position))
            .collect()
    }

    /// A remark on sites that cover only a window of the specimen; `None` where they cover all of it.
    pub fn window(&self, specimen: &Mesh) -> Option<String> {
        let (extent, full) = (sides(self.positions.iter().copied()), specimen.size());
        let is_window = (0..2).any(|axis| extent[axis] < NEARLY_ALL * full[axis]);
        is_window.then(|| {
            format!(
                "the points span {} of the specimen's {}, and the models are compared there alone",
                extents(extent),
                extents(full)
            )
        })
    }

    /// The unit of length, read as mm, in which the sites would span all of the specimen in both directions.
    pub fn other_unit(&self, specimen: &Mesh) -> Option<&'static str> {
        let (extent, full) = (sides(self.positions.iter().copied()), specimen.size());
        length_unit(|unit| {
            (0..2).all(|axis| {
                let part = unit * extent[axis] / full[axis];
                (NEARLY_ALL..=1.0 / NEARLY_ALL).contains(&part)
            })
        })
    }

    /// The difference of a model's field from the imported one.
    ///
    /// # Errors
    /// `Mismatch::Zero` where the imported field is zero, so that no difference can be related to it.
    pub fn difference(&self, field: &ModelField) -> Result<Difference, Mismatch> {
        let computed = self.at(field);
        if weighted_norm(&self.expected, &self.weights) == 0.0 {
            return Err(Mismatch::Zero);
        }
        let percent_from = |field: &[f64]| {
            let size = weighted_norm(field, &self.weights);
            100.0 * weighted_distance(&computed, field, &self.weights) / size
        };
        let percent = percent_from(&self.expected);
        let (largest, position) = largest_distance(&computed, &self.expected);
        let product = |a: &[f64], b: &[f64]| -> f64 {
            let terms = a.iter().zip(b).zip(0..);
            terms
                .map(|((a, b), index)| self.weights[index / 2] * a * b)
                .sum()
        };
        let factor = product(&computed, &self.expected) / product(&self.expected, &self.expected);
        let scaled: Vec<f64> = self.expected.iter().map(|u| factor * u).collect();
        let (shift, shifted) = self.shifted_to(&computed);
        let after = Mistake::ALL.map(|mistake| (percent_from(&self.without(mistake)), mistake));
        let nearest = after.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b));
        let mistake = nearest.filter(|(rest, _)| percent > SMALL && explains_most(percent, *rest));
        Ok(Difference {
            percent,
            largest,
            position: self.positions[position],
            factor,
            scaled_percent: percent_from(&scaled),
            shift,
            shifted_percent: percent_from(&shifted),
            mistake: mistake.map(|(_, mistake)| mistake),
        })
    }

    /// The imported field with a mistake undone.
    fn without(&self, mistake: Mistake) -> Vec<f64> {
        let intended = |(at, u): (&[f64; 2], &[f64])| mistake.intended(*at, [u[0], u[1]]);
        let sites = self.positions.iter().zip(self.expected.chunks(2));
        sites.flat_map(intended).collect()
    }

    /// The motion of the whole body by which the imported field comes nearest to another one by least squares, and the field so
    /// moved.
    fn shifted_to(&self, computed: &[f64]) -> (RigidMotion, Vec<f64>) {
        let now = |u: &[f64], site: usize| {
            [0, 1].map(|axis| self.positions[site][axis] + u[2 * site + axis])
        };
        let pair = |(site, weight): (usize, &f64)| {
            (*weight, now(&self.expected, site), now(computed, site))
        };
        let pairs: Vec<_> = self.weights.iter().enumerate().map(pair).collect();
        let (middle, motion) = RigidMotion::nearest(&pairs);
        let moved = (0..self.positions.len()).flat_map(|site| {
            let position = now(&self.expected, site);
            let more = motion.at([0, 1].map(|axis| position[axis] - middle[axis]));
            [0, 1].map(|axis| self.expected[2 * site + axis] + more[axis])
        });
        (motion, moved.collect())
    }
}

/// Whether two meshes have boxes of one size.
fn same_size(field: &Mesh, specimen: &Mesh) -> Result<(), Mismatch> {
    let (actual, expected) = (field.size(), specimen.size());
    if (0..2).all(|axis| (actual[axis] / expected[axis] - 1.0).abs() <= NEAR_SIZE) {
        return Ok(());
    }
    Err(Mismatch::Size { actual, expected })
}

/// Whether points and specimen are in one unit of length: no factor of a hundred or more lies between their sizes. A
/// field on a small window is not a fault.
fn near_in_size(positions: &[[f64; 2]], specimen: &Mesh) -> Result<(), Mismatch> {
    let [x, y] = sides(positions.iter().copied());
    let (actual, expected) = (x.hypot(y), specimen.diagonal());
    match unit_ratio(expected / actual).filter(|ratio| *ratio >= 100.0) {
        Some(ratio) => Err(Mismatch::Unit {
            actual,
            expected,
            ratio,
        }),
        None => Ok(()),
    }
}

/// Checks that all points lie in a mesh.
fn covers(mesh: &Mesh, positions: &[[f64; 2]], what: &'static str) -> Result<(), Mismatch> {
    match positions
        .iter()
        .find(|position| mesh.outside(**position) > NEAR_CELLS)
    {
        Some(position) => Err(Mismatch::Outside {
            what,
            position: *position,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
