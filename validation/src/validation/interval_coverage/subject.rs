//! The specimens that are estimated.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::truth::{Markers, Truth};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::estimation::{
    EdgeCondition, FieldEstimate, Knowledge, MeasuredForce, RegressedLaw, Specimen, estimate,
};
use crate::markers::Marker;
use crate::material::Card;
use crate::mesh::{CellShape, Grid, Mesh, Shape};
use crate::statistics::nearest;
use crate::units::Dimension;
use crate::validation::case::{mean, normal_numbers_of_stream, section};
use crate::validation::plate::Plate;

/// The noise at which stress, gross errors and modulus are looked at, in mm.
pub const MIDDLE: f64 = 0.5;

/// The name of the specimen that is drawn.
pub const PLATE: &str = "plate";

/// What all data are made of.
pub struct Data {
    /// The plate; its cells are those of the estimate.
    pub plate: Plate,
    /// Of the hole in the strip, in mm.
    pub radius: f64,
    /// Markers along and across.
    pub markers: [usize; 2],
}

impl Data {
    /// The plate of a study, and what its sections `hole` and `data` say.
    pub fn read(plate: Plate, root: &Section, data: &Section) -> Self {
        Self {
            plate,
            radius: section(root, "hole", |hole| {
                hole.quantity("radius", Dimension::Length, Bound::Positive)
            }),
            markers: data.count_pair("markers", 3, 400).unwrap_or([3, 3]),
        }
    }
}

/// The law of a card, whose first parameter is to be found.
pub fn first_parameter(card: &Card) -> Option<RegressedLaw> {
    let first = card.parameters.first().map(|parameter| parameter.key);
    RegressedLaw::of_card(card, &first.into_iter().collect::<Vec<_>>()).ok()
}

/// What separates data from the truth.
#[derive(Clone, Copy)]
pub struct Disturbance {
    /// Standard deviation in mm.
    pub noise: f64,
    /// Share of the markers with a gross error.
    pub outliers: f64,
}

impl Disturbance {
    /// Noise without gross errors.
    pub fn noise(noise: f64) -> Self {
        Self {
            noise,
            outliers: 0.0,
        }
    }
}

/// A specimen with its truth and the mesh of the estimate.
pub struct Subject {
    /// For the report.
    pub name: &'static str,
    /// What is to be found.
    pub truth: Truth,
    /// The mesh of the estimate.
    pub mesh: Mesh,
    positions: Vec<[f64; 2]>,
    thickness: f64,
}

impl Subject {
    /// The clamped plate.
    pub fn plate(data: &Data) -> Result<Self, Error> {
        let mesh = |cells: [usize; 2]| {
            let grid = Grid::new(data.plate.problem.size, cells, 2.0);
            Mesh::of_grid(grid, CellShape::Quad9)
        };
        let cells = data.plate.cells;
        Self::new(
            data,
            PLATE,
            mesh(cells.map(|cells| 2 * cells + 3)),
            mesh(cells),
        )
    }

    /// A strip with a hole, of the plate's size.
    pub fn strip(data: &Data) -> Result<Self, Error> {
        let shape = Shape::StripWithHole {
            size: data.plate.problem.size,
            radius: data.radius,
        };
        shape
            .check()
            .map_err(|misfit| Error::input(misfit.reason, "look at the section `hole`"))?;
        let mesh = |across| shape.mesh(across, CellShape::Quad9);
        let across = data.plate.cells[1];
        Self::new(
            data,
            "strip with a hole",
            mesh(5 * across + 3),
            mesh(across),
        )
    }

    fn new(data: &Data, name: &'static str, fine: Mesh, mesh: Mesh) -> Result<Self, Error> {
        let problem = &data.plate.problem;
        let truth = Truth::new(fine, problem, data.plate.stretch())?;
        Ok(Self {
            name,
            positions: truth.positions(data.markers),
            truth,
            mesh,
            thickness: problem.thickness,
        })
    }

    /// The same with markers that end half a spacing inside of the edges.
    pub fn with_markers_inside(mut self, counts: [usize; 2]) -> Self {
        self.positions = self.truth.places_inside(counts);
        self
    }

    /// The places of the markers.
    pub fn positions(&self) -> &[[f64; 2]] {
        &self.positions
    }

    /// Markers without noise.
    pub fn exact_markers(&self) -> Vec<Marker> {
        self.truth.markers(&self.positions, 0.0, 0.0, 0).markers
    }

    /// Disturbed markers.
    pub fn data(&self, disturbance: Disturbance, seed: u64) -> Markers {
        let Disturbance { noise, outliers } = disturbance;
        self.truth.markers(&self.positions, noise, outliers, seed)
    }

    /// The truth's force on the right grip, so many standard deviations off; these are a share of it.
    pub fn measured_force(&self, relative_deviation: f64, off: f64) -> MeasuredForce {
        let deviation = relative_deviation * self.truth.force;
        MeasuredForce {
            edge: "right".into(),
            axis: 0,
            force: self.truth.force + deviation * off,
            standard_deviation: deviation,
            common_deviation: 0.0,
        }
    }

    /// The field estimated from markers.
    pub fn estimate(&self, data: &Markers, knowledge: &Knowledge) -> Result<FieldEstimate, Error> {
        let specimen = Specimen {
            mesh: &self.mesh,
            laws: Arc::clone(&self.truth.law).into(),
            thickness: self.thickness,
        };
        estimate(&specimen, &data.markers, knowledge)
    }
}

/// Nothing is known of the grips, the long edges are free.
pub fn unknown_grips() -> Knowledge {
    let edge = |(name, condition): (&str, EdgeCondition)| (name.to_owned(), condition);
    let grips = ["left", "right"].map(|name| (name, EdgeCondition::Unknown));
    let free = ["bottom", "top"].map(|name| (name, EdgeCondition::Free));
    Knowledge {
        edges: grips.into_iter().chain(free).map(edge).collect(),
        ..Knowledge::default()
    }
}

/// What makes noise of markers, which may correlate over some of their spacings, of white numbers.
pub struct CorrelatedDraws {
    /// The root of e^(−d/ℓ) of all pairs; nothing where the noise is white.
    root: Option<DMatrix<f64>>,
}

impl CorrelatedDraws {
    /// Noise at places that correlates as e^(−d/ℓ), ℓ so many times the mean spacing of the places.
    pub fn new(positions: &[[f64; 2]], length: Option<f64>) -> Self {
        let distance = |i: usize, j: usize| {
            let [a, b]: [[f64; 2]; 2] = [positions[i], positions[j]];
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        let nearest = nearest(positions, 1).into_iter().enumerate();
        let spacing = mean(nearest.map(|(i, others)| distance(i, others[0])));
        let root = length.and_then(|length| {
            let correlation = |i: usize, j: usize| (-distance(i, j) / (length * spacing)).exp();
            let all = DMatrix::from_fn(positions.len(), positions.len(), correlation);
            all.cholesky().map(|factor| factor.unpack())
        });
        Self { root }
    }

    /// Adds noise of a standard deviation in mm to both components.
    pub fn disturb(&self, markers: &mut [Marker], noise: f64, seed: u64) {
        for axis in [0, 1] {
            let draws = normal_numbers_of_stream(seed, 1 + axis as u64).take(markers.len());
            let white = DVector::from_iterator(markers.len(), draws);
            let values = match &self.root {
                Some(root) => root * white,
                None => white,
            };
            for (marker, value) in markers.iter_mut().zip(values.iter()) {
                marker.displacement[axis] += noise * value;
            }
        }
    }
}
