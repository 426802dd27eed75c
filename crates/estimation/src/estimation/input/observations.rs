//! The markers of a frame on a mesh.

use std::sync::OnceLock;

use nalgebra::DVector;

use super::start::{DEGREE, Points, Polynomial};
use crate::error::Diagnostic;
use crate::markers::Marker;
use crate::mesh::Mesh;
use crate::solve::SparseRows;

/// Distance outside of the mesh, relative to a cell's size, beyond which a marker is left out.
const OUTSIDE: f64 = 0.25;

/// The markers on the mesh.
#[derive(Clone, Debug)]
pub struct Observations {
    /// Number of all markers.
    pub markers: usize,
    /// Index of each marker that lies on the mesh.
    pub chosen: Vec<usize>,
    /// Their positions at rest in mm.
    pub positions: Vec<[f64; 2]>,
    /// Their displacements in mm.
    pub displacements: Vec<[f64; 2]>,
    /// The weights of their components, two numbers per marker: 1/variance in 1/mm² where the noise is known, otherwise 1.
    pub weights: Vec<f64>,
    pub known_noise: bool,
    /// The number of times that the weights were adapted to noise that varies over the sheet.
    pub reweighted: usize,
    /// H: two rows per marker.
    pub interpolation: SparseRows,
    /// The trimmed polynomial of each degree, computed when it is first needed: every search begins at one.
    trimmed: [OnceLock<Option<Polynomial>>; DEGREE],
}

impl Observations {
    /// Finds the markers on a mesh; `noise` is the standard deviation in mm of those that have none.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a number is not finite, a standard deviation is not positive or known for some markers
    /// only, or fewer than three markers lie on the mesh.
    pub fn new(mesh: &Mesh, markers: &[Marker], noise: Option<f64>) -> Result<Self, Diagnostic> {
        let deviation = |marker: &Marker| marker.standard_deviation.or(noise);
        let known = markers
            .iter()
            .filter(|marker| deviation(marker).is_some())
            .count();
        if known > 0 && known < markers.len() {
            let fault = format!(
                "only {known} of {} markers have a standard deviation",
                markers.len()
            );
            return Err(Diagnostic::error("", fault).hint("give all of them one, or none"));
        }
        let mut all = Self {
            markers: markers.len(),
            chosen: Vec::new(),
            positions: Vec::new(),
            displacements: Vec::new(),
            weights: Vec::new(),
            known_noise: known > 0,
            reweighted: 0,
            interpolation: SparseRows::new(2 * mesh.nodes.len()),
            trimmed: Default::default(),
        };
        for (index, marker) in markers.iter().enumerate() {
            all.add(mesh, index, marker, deviation(marker))?;
        }
        if all.chosen.len() < 3 {
            let (on_mesh, count) = (all.chosen.len(), markers.len());
            let fault = format!(
                "{on_mesh} of {count} markers lie on the mesh, and at least three are needed"
            );
            let hint = if on_mesh == count {
                "leave this frame out, or find out why its markers were lost"
            } else {
                "check the units and the origins of markers and mesh"
            };
            return Err(Diagnostic::error("", fault).hint(hint));
        }
        Ok(all)
    }

    fn add(
        &mut self,
        mesh: &Mesh,
        index: usize,
        marker: &Marker,
        deviation: Option<f64>,
    ) -> Result<(), Diagnostic> {
        let Marker {
            number,
            position,
            displacement,
            ..
        } = *marker;
        let numbers = position.iter().chain(&displacement);
        if numbers.chain(&deviation).any(|value| !value.is_finite()) {
            let fault = format!("marker {number} has a value that is not a number");
            return Err(Diagnostic::error("", fault).hint("leave the marker out of the frame"));
        }
        let deviation = deviation.unwrap_or(1.0);
        if deviation <= 0.0 {
            let fault = format!("marker {number} has the standard deviation {deviation} mm");
            return Err(Diagnostic::error("", fault).hint("give a positive one, or none"));
        }
        let Some((cell, local)) = mesh.locate_within(position, OUTSIDE) else {
            return Ok(());
        };
        let values = mesh.shape(cell).values(local);
        for axis in [0, 1] {
            let nodes = mesh.cell(cell).iter().zip(&values);
            self.interpolation
                .push(nodes.map(|(node, value)| (2 * node + axis, *value)));
        }
        self.chosen.push(index);
        self.positions.push(position);
        self.displacements.push(displacement);
        self.weights.extend([deviation.powi(-2); 2]);
        Ok(())
    }

    /// The mean distance of neighbouring markers in mm, from the area of the mesh.
    pub fn spacing(&self, mesh: &Mesh) -> f64 {
        (mesh.area() / self.chosen.len() as f64).sqrt()
    }

    /// d − H u, two numbers per marker.
    pub fn residual(&self, field: &[f64]) -> DVector<f64> {
        let computed = self.interpolation.multiply(field);
        let data = self.displacements.iter().flatten();
        DVector::from_iterator(computed.len(), data.zip(computed).map(|(d, u)| d - u))
    }

    /// The polynomial of a degree through the markers that gross errors do not affect.
    ///
    /// # Panics
    /// Where the degree is 0, or more than the largest.
    pub fn trimmed(&self, degree: usize) -> Option<Polynomial> {
        let known = &self.trimmed[degree - 1];
        known
            .get_or_init(|| Polynomial::trimmed(&self.points(), degree))
            .clone()
    }

    pub fn points(&self) -> Points<'_> {
        Points {
            positions: &self.positions,
            displacements: &self.displacements,
        }
    }
}
