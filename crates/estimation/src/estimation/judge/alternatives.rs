//! Possible defects of the equations, as the small changes of the field that they would cause.
//!
//! ```text
//! ∂u/∂c = K⁻¹ f,   fᵢ = ∫ Nᵢ φ dA (a force),   −∫ φ P ∇Nᵢ dV (a stiffness that varies),   −∫ P* ∇Nᵢ dV (another law's P*)
//! ```
//!
//! and likewise possible defects of the picture: its scale ([`crate::estimation::uncertainty`]).

use nalgebra::DMatrix;

use crate::error::Error;
use crate::estimation::equations::nodal_areas;
use crate::estimation::outcome::Alternative;
use crate::estimation::search::NearestField;
use crate::material::sheet::{Kinematics, PlaneTensor, cofactor};
use crate::material::{HyperelasticLaw, MooneyRivlin, NeoHooke, Yeoh};

/// An alternative with the displacements of the markers due to its parameters: two rows per marker.
pub type Column = (Alternative, DMatrix<f64>);

/// Several stresses of a cell at its centre, from the kinematics at a point.
type StressesAt<'a> = dyn Fn(usize, [f64; 2], &Kinematics) -> Vec<PlaneTensor> + 'a;

impl NearestField<'_> {
    /// The alternatives of forces, stiffness, law and picture, with all edges as they are.
    pub(super) fn alternatives(&mut self) -> Result<Vec<Column>, Error> {
        let mut all = Vec::new();
        if self.equations.body.is_none() {
            all.push((Alternative::BodyForce, self.smooth_forces()));
        }
        all.push((Alternative::Stiffness, self.varied_stiffness()));
        all.push((Alternative::Law, self.other_laws()));
        all.push((Alternative::Direction, self.directions()));
        all.push((Alternative::Volume, self.volume_change()));
        let mut columns: Vec<Column> = Vec::new();
        for (alternative, forces) in all {
            columns.push((alternative, self.marker_changes(&forces)?));
        }
        if self.equations.task.knowledge.scale_deviation == 0.0 {
            columns.push((Alternative::Scale, self.magnification()));
        }
        Ok(columns)
    }

    /// Forces along x and along y with smooth densities.
    fn smooth_forces(&self) -> Vec<Vec<f64>> {
        let mesh = self.equations.task.specimen.mesh;
        let (areas, bounds) = (nodal_areas(mesh), mesh.bounding_box());
        let mut forces = vec![vec![0.0; self.field.len()]; 12];
        for (node, position) in mesh.nodes.iter().enumerate() {
            for (shape, value) in shapes(*position, bounds).into_iter().enumerate() {
                for axis in [0, 1] {
                    forces[6 * axis + shape][2 * node + axis] = areas[node] * value;
                }
            }
        }
        forces
    }

    fn varied_stiffness(&self) -> Vec<Vec<f64>> {
        let bounds = self.equations.task.specimen.mesh.bounding_box();
        self.stresses(5, &|cell, position, kinematics| {
            let stress = self.equations.law(cell).stress(kinematics).1;
            let shapes = shapes(position, bounds);
            shapes[1..].iter().map(|shape| stress * *shape).collect()
        })
    }

    fn other_laws(&self) -> Vec<Vec<f64>> {
        let laws: [Box<dyn HyperelasticLaw>; 4] = [
            Box::new(NeoHooke { c10: 1.0 }),
            Box::new(MooneyRivlin { c10: 0.0, c01: 1.0 }),
            Box::new(Yeoh {
                coefficients: [0.0, 1.0, 0.0],
            }),
            Box::new(Yeoh {
                coefficients: [0.0, 0.0, 1.0],
            }),
        ];
        self.stresses(4, &|_, _, kinematics| {
            laws.iter().map(|law| law.stress(kinematics).1).collect()
        })
    }

    /// Fibres along x and y, and shear between them: F S with one component of S = E each.
    fn directions(&self) -> Vec<Vec<f64>> {
        self.stresses(3, &|_, _, kinematics| {
            let f = kinematics.deformation_gradient;
            let [xx, xy, yy] = kinematics.twice_green_lagrange.map(|change| change / 2.0);
            vec![
                PlaneTensor::new(f[0] * xx, 0.0, f[2] * xx, 0.0),
                PlaneTensor::new(0.0, f[1] * yy, 0.0, f[3] * yy),
                PlaneTensor::new(f[1] * xy, f[0] * xy, f[3] * xy, f[2] * xy),
            ]
        })
    }

    /// ½ (ln J)².
    fn volume_change(&self) -> Vec<Vec<f64>> {
        self.stresses(1, &|_, _, kinematics| {
            let area = kinematics.area_ratio();
            vec![cofactor(&kinematics.deformation_gradient) * (area.ln() / area)]
        })
    }

    /// ∫ P* ∇N dV of several stresses.
    fn stresses(&self, count: usize, stresses: &StressesAt) -> Vec<Vec<f64>> {
        let mesh = self.equations.task.specimen.mesh;
        let mut forces = vec![vec![0.0; self.field.len()]; count];
        for cell in 0..mesh.cell_count() {
            let nodes = mesh.cell(cell);
            let motion: Vec<f64> = nodes
                .iter()
                .flat_map(|node| [self.field[2 * node], self.field[2 * node + 1]])
                .collect();
            let centre = mesh.position(cell, mesh.shape(cell).centre());
            for point in self.equations.energy.cell_points(cell) {
                let Ok(kinematics) = Kinematics::new(&point.gradient(&motion)) else {
                    continue;
                };
                let all = stresses(cell, centre, &kinematics).into_iter();
                for (stress, force) in all.zip(&mut forces) {
                    let mut added = vec![0.0; motion.len()];
                    point.add_force(&stress, &mut added);
                    for (pair, node) in added.chunks_exact(2).zip(nodes) {
                        force[2 * node] += pair[0];
                        force[2 * node + 1] += pair[1];
                    }
                }
            }
        }
        forces
    }
}

/// 1, x, y, x², xy, y² of a position, from −1 to 1 between the lower left and the upper right corner of the specimen.
fn shapes(position: [f64; 2], [low, high]: [[f64; 2]; 2]) -> [f64; 6] {
    let [x, y] = [0, 1].map(|axis| {
        let size = (high[axis] - low[axis]).max(f64::MIN_POSITIVE);
        2.0 * (position[axis] - low[axis]) / size - 1.0
    });
    [1.0, x, y, x * x, x * y, y * y]
}
