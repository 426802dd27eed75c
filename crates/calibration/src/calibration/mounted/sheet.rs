//! The mounted sheet of a biaxial test as finite elements: the forces of its bars and the stretches of its middle.

use std::sync::Arc;

use crate::calibration::data::Mounting;
use crate::material::HyperelasticLaw;
use crate::material::prestretched::PrestretchedLaw;
use crate::mesh::{CellShape, Mesh, Shape};
use crate::problem::{BoundaryProblem, Drive, Support, sheet_energy::SheetEnergy};

/// Cells across the sheet: the finite elements are quadratic.
const CELLS: usize = 8;

/// What a mounted sheet shows when its bars, or the markers in its middle, are at some strains.
#[derive(Clone, Debug)]
pub struct SheetState {
    /// Forces over the cross-sections as mounted, along both axes, in MPa.
    pub stresses: [f64; 2],
    /// λ − 1 of the markers in the middle along both axes, relative to the sheet as mounted.
    pub middle: [f64; 2],
    /// λ − 1 of the bars.
    pub bars: [f64; 2],
    /// The displacements of the nodes in mm.
    pub field: Vec<f64>,
}

/// The finite elements of a mounted sheet.
pub struct MountedSheet {
    pub mounting: Mounting,
    pub mesh: Mesh,
    pub energy: SheetEnergy,
    /// The nodes by which the second bar of each axis pulls.
    pub pulled: [Vec<usize>; 2],
}

/// The sides along both axes: from the first to the second one.
const SIDES: [[&str; 2]; 2] = [["left", "right"], ["bottom", "top"]];

/// The groups that are moved along an axis by each of both bars.
fn groups(mounting: &Mounting, axis: usize, end: usize) -> Vec<String> {
    let side = SIDES[axis][end];
    match mounting.shape {
        Shape::SquareOnRakes(rakes) if mounting.slides => {
            let tines = 1..=rakes.tines;
            tines.map(|tine| format!("{side}-tine-{tine}")).collect()
        }
        Shape::SquareOnRakes(_) => vec![format!("{side}-tines")],
        _ => vec![side.to_owned()],
    }
}

impl MountedSheet {
    /// The sheet of a mounting, with cells that are halved `halvings` times.
    pub fn new(mounting: Mounting, halvings: usize) -> Self {
        let cells = match mounting.shape {
            Shape::Cruciform { .. } => CELLS / 2,
            _ => CELLS,
        };
        let mesh = mounting
            .shape
            .mesh_halved(cells, halvings, CellShape::Quad9);
        let nothing: Arc<dyn HyperelasticLaw> = Arc::new(crate::material::NeoHooke { c10: 1.0 });
        let energy = SheetEnergy::of_mesh(nothing, &mesh, mounting.thickness);
        let nodes = |name: &String| mesh.groups()[name].nodes.clone();
        let pulled = [0, 1].map(|axis| groups(&mounting, axis, 1).iter().flat_map(nodes).collect());
        Self {
            mounting,
            mesh,
            energy,
            pulled,
        }
    }

    /// The same sheet with cells of half the size.
    pub fn halved(&self) -> Self {
        Self::new(self.mounting, 1)
    }

    /// States of this sheet on the mesh of another one.
    pub fn on(&self, other: &Self, states: &[SheetState]) -> Vec<SheetState> {
        let interpolation = self.mesh.interpolation_on(&other.mesh);
        let on_mesh = |state: &SheetState| SheetState {
            field: interpolation.apply(&state.field),
            ..state.clone()
        };
        states.iter().map(on_mesh).collect()
    }

    /// The problem with both pairs of bars at some strains: each bar is moved by half of the change of their distance.
    pub fn problem(&self, law: &Arc<dyn HyperelasticLaw>, bars: [f64; 2]) -> BoundaryProblem {
        let mut supports = Vec::new();
        for axis in [0, 1] {
            for (end, sign) in [-0.5, 0.5].into_iter().enumerate() {
                let moved = sign * bars[axis] * self.mounting.lengths[axis];
                let support = if self.mounting.slides {
                    let mut drives = [Drive::Force(0.0); 2];
                    drives[axis] = Drive::Displacement(moved);
                    Support::Grip(drives)
                } else {
                    let mut displacement = [Some(0.0); 2];
                    displacement[axis] = Some(moved);
                    Support::Displacement(displacement)
                };
                let groups = groups(&self.mounting, axis, end).into_iter();
                supports.extend(groups.map(|group| (group, support)));
            }
        }
        BoundaryProblem::supported(self.mounting.thickness, Arc::clone(law), supports)
    }

    /// λ − 1 between the markers at the corners of a square in the middle along both axes.
    pub fn middle(&self, field: &[f64]) -> [f64; 2] {
        /// Of the least distance of the bars, where no markers were measured.
        const USUAL: f64 = 0.25;
        let [low, high] = self.mesh.bounding_box();
        let least = self.mounting.lengths[0].min(self.mounting.lengths[1]);
        let side = self.mounting.markers.unwrap_or(USUAL * least);
        let at = |signs: [f64; 2]| {
            let position = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis] + signs[axis] * side));
            self.mesh.displacement_at(field, position)
        };
        [0, 1].map(|axis| {
            let pair = |other: f64| {
                let mut signs = [[other; 2]; 2];
                (signs[0][axis], signs[1][axis]) = (-1.0, 1.0);
                at(signs[1])[axis] - at(signs[0])[axis]
            };
            0.5 * (pair(-1.0) + pair(1.0)) / side
        })
    }
}

/// A law, and the stretches of the sheet along both axes as it is mounted.
#[derive(Clone, Debug)]
pub struct SheetLaw {
    pub law: Arc<dyn HyperelasticLaw>,
    pub stretches: [f64; 2],
}

impl SheetLaw {
    /// The stresses of a homogeneous sheet over the cross-sections as mounted, at strains from the mounted state on.
    pub fn stresses(&self, strains: [f64; 2]) -> [f64; 2] {
        let from_rest = [0, 1].map(|axis| self.stretches[axis] * (1.0 + strains[axis]) - 1.0);
        let stresses = self.law.biaxial(from_rest);
        [0, 1].map(|axis| self.stretches[axis] * stresses[axis])
    }

    /// The law from the mounted state on.
    pub fn mounted(&self) -> Arc<dyn HyperelasticLaw> {
        if self.stretches == [1.0; 2] {
            return Arc::clone(&self.law);
        }
        Arc::new(PrestretchedLaw {
            law: Arc::clone(&self.law),
            stretches: self.stretches,
        })
    }
}
