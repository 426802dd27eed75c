//! How far a field is from another one, in percent.
//!
//! All sums run over the nodes of a mesh with the area A that belongs to each; v is the reference field interpolated at the node and a
//! the affine stretch:
//!
//! ```text
//! displacement            100 √(Σ A |u − v|² / Σ A |v|²)                            [%]
//! departure from affine   100 √(Σ A |u − v|² / Σ A |v − a|²)                        [%]
//! ```
//!
//! The affine stretch is a large part of the displacement of any stretched plate and is right in every model: the
//! departure from it is the strict measure.

use crate::mesh::{Mesh, weighted_distance, weighted_norm};

pub mod imported;
pub mod judgement;

/// Distance of two fields on the mesh of a plate in relative L2, weighted by area, in %.
///
/// # Panics
/// When the mesh is not that of a plate.
pub fn displacement_percent(mesh: &Mesh, field: &[f64], reference: &[f64]) -> f64 {
    percent(&mesh.nodal_areas(), field, reference)
}

/// Distance of two fields on the mesh of a plate relative to the departure of the reference from `affine`, in %.
///
/// # Panics
/// When the mesh is not that of a plate.
pub fn departure_percent(mesh: &Mesh, field: &[f64], reference: &[f64], affine: &[f64]) -> f64 {
    let areas = mesh.nodal_areas();
    let departure = weighted_distance(reference, affine, &areas);
    100.0 * weighted_distance(field, reference, &areas) / departure
}

/// Distance of two fields on the corners of any mesh in relative L2, weighted by area, in %. The area of a cell is
/// divided equally among its corners. The distance is zero where both fields are as small as rounding compared with
/// the mesh.
pub fn area_weighted_percent(mesh: &Mesh, field: &[f64], reference: &[f64]) -> f64 {
    weighted_percent(mesh, &mesh.corner_areas(), field, reference)
}

/// The same distance over all nodes, among which the area of a cell is divided equally.
pub fn percent_at_all_nodes(mesh: &Mesh, field: &[f64], reference: &[f64]) -> f64 {
    weighted_percent(mesh, &mesh.areas_of_all_nodes(), field, reference)
}

fn weighted_percent(mesh: &Mesh, areas: &[f64], field: &[f64], reference: &[f64]) -> f64 {
    const ROUNDING: f64 = 1e-15;
    let [x, y] = mesh.size();
    let size = x.max(y) * areas.iter().sum::<f64>().sqrt();
    let rests = |field: &[f64]| weighted_norm(field, areas) <= ROUNDING * size;
    if rests(field) && rests(reference) {
        0.0
    } else {
        percent(areas, field, reference)
    }
}

fn percent(areas: &[f64], field: &[f64], reference: &[f64]) -> f64 {
    100.0 * weighted_distance(field, reference, areas) / weighted_norm(reference, areas)
}
