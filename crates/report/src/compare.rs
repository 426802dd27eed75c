//! How far a field on the lattice is from converged finite elements, in percent.
//!
//! All sums run over the nodes of the lattice with the area A that belongs to each; v is the reference
//! field interpolated at the node and a the affine stretch:
//!
//! ```text
//! displacement            100 √(Σ A |u − v|² / Σ A |v|²)                            [%]
//! departure from affine   100 √(Σ A |u − v|² / Σ A |v − a|²)                        [%]
//! largest difference      max |u − v|                                              [mm]
//! nominal stress          100 √(Σ A |P(u) − P(v)|² / Σ A |P(v)|²)                   [%]
//! ```
//!
//! The affine stretch is a large part of the displacement of any stretched plate and is right in every model: the
//! departure from it is the strict measure. Nominal stresses follow from the material law at the fields' gradients,
//! at the centres of the cells that lie more than a fifth of the plate's width away from the corners, where the
//! stress is singular. The nominal stress is the transpose of P and has the same norm.

use nalgebra::Vector4;

use crate::finite_element::FiniteElements;
use crate::finite_element::convergence::{Richardson, of_distances, richardson};
use crate::material::sheet::Kinematics;
use crate::material::softened_law::StressAfter;
use crate::mesh::{Mesh, NodalField};
use crate::problem::{ClampedPlate, Measures};
use crate::solve::State;

pub mod imported;
pub mod judgement;

/// Deviation of one field from the reference at one stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// Difference in displacement, relative L2 norm, in %.
    pub displacement_percent: f64,
    /// Difference in displacement relative to the departure from the affine stretch, L2 norm, in %.
    pub departure_percent: f64,
    /// Largest difference in the displacement of a node, in mm.
    pub max_difference: f64,
    /// Difference in grip force, signed, in %.
    pub force_percent: f64,
    /// Difference in width at mid length, signed, in %.
    pub width_percent: f64,
    /// Difference in nominal stress away from the corners, relative L2 norm, in %.
    pub nominal_stress_percent: f64,
}

/// The finite elements' own error at one stretch, from three meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfConvergence {
    /// Convergence of the grip force.
    pub force: Richardson,
    /// Convergence of the width at mid length.
    pub width: Richardson,
    /// Error of the displacement, relative L2 norm, in %: the difference of the two finer meshes over 2ᵖ − 1.
    pub displacement_percent: f64,
    /// The same error relative to the departure from the affine stretch, in %.
    pub departure_percent: f64,
    /// Observed order p of the displacement.
    pub displacement_order: Option<f64>,
}

/// Comparison at one stretch, for the fields that exist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepComparison {
    /// Grip displacement divided by the length.
    pub stretch: f64,
    /// Deviation of the mass-spring field, before the correction.
    pub mass_spring: Option<Deviation>,
    /// Deviation of the corrected field.
    pub corrected: Option<Deviation>,
    /// The reference's own error; `None` where one of its meshes has no solution.
    pub reference: Option<SelfConvergence>,
}

impl StepComparison {
    /// The deviations before and after the correction, where there are both.
    pub fn pair(&self) -> Option<[&Deviation; 2]> {
        Some([self.mass_spring.as_ref()?, self.corrected.as_ref()?])
    }

    /// 100 (1 − e_corrected/e_mass-spring) of one measure, in %.
    pub fn correction_percent(&self, measure: impl Fn(&Deviation) -> f64) -> Option<f64> {
        let [before, after] = self.pair()?.map(|deviation| measure(deviation).abs());
        Some(100.0 * (1.0 - after / before))
    }
}

/// Converged finite elements: the same problem on three meshes, each twice as fine as the one before.
pub struct Reference<'a> {
    problem: &'a ClampedPlate,
    meshes: [(&'a Mesh, &'a [State]); 3],
}

impl<'a> Reference<'a> {
    /// The reference from three meshes, coarse to fine, and their solutions at all stretches.
    pub fn new(problem: &'a ClampedPlate, meshes: [(&'a FiniteElements, &'a [State]); 3]) -> Self {
        Self {
            problem,
            meshes: meshes.map(|(model, solutions)| (&model.mesh, solutions)),
        }
    }

    /// Deviation of a field on `mesh`, with its past fields, from the finest mesh at stretch number `step`; `None` where that mesh has no solution.
    pub fn deviation(
        &self,
        mesh: &Mesh,
        state: &State,
        past: &[&[f64]],
        measures: Measures,
        step: usize,
    ) -> Option<Deviation> {
        let (fine, solutions) = self.meshes[2];
        let reference = solutions.get(step)?;
        let expected = fine.displacement_on(&reference.displacement, mesh);
        let affine = self.problem.affine(mesh, state.factor);
        let field = &state.displacement;
        let expected_measures = Measures::of(fine, reference);
        let beyond = |value: f64, expected: f64| 100.0 * (value / expected - 1.0);
        Some(Deviation {
            displacement_percent: displacement_percent(mesh, field, &expected),
            departure_percent: departure_percent(mesh, field, &expected, &affine),
            max_difference: field.largest_distance(&expected).0,
            force_percent: beyond(measures.force, expected_measures.force),
            width_percent: beyond(measures.mid_width, expected_measures.mid_width),
            nominal_stress_percent: self.stress_deviation(mesh, field, past, step),
        })
    }

    /// The reference displacements at the nodes of `mesh` in mm, for all stretches that were solved.
    pub fn displacements_on(&self, mesh: &Mesh) -> Vec<Vec<f64>> {
        let (fine, solutions) = self.meshes[2];
        let solutions = solutions.iter();
        solutions
            .map(|solution| fine.displacement_on(&solution.displacement, mesh))
            .collect()
    }

    /// The reference's own error at stretch number `step`; `None` where one of its meshes has no solution.
    pub fn self_convergence(&self, step: usize) -> Option<SelfConvergence> {
        let of_mesh =
            |(mesh, solutions): (&'a Mesh, &'a [State])| Some((mesh, solutions.get(step)?));
        let [coarse, middle, fine] = self.meshes.map(of_mesh);
        let meshes = [coarse?, middle?, fine?];
        let measures = meshes.map(|(mesh, state)| Measures::of(mesh, state));
        let of = |value: fn(Measures) -> f64| richardson(measures.map(value));
        // The nodes of the finest mesh include points between the nodes of a coarser one, where the error of a coarser field is larger.
        let common = meshes[2].0;
        let [first, second, third] =
            meshes.map(|(mesh, state)| mesh.displacement_on(&state.displacement, common));
        let areas = common.nodal_areas();
        let affine = self.problem.affine(common, meshes[2].1.factor);
        let [before, last] = [(&first, &second), (&third, &second)]
            .map(|(one, other)| one.weighted_distance(other, &areas));
        let (error, order) = of_distances(before, last);
        Some(SelfConvergence {
            force: of(|measures| measures.force),
            width: of(|measures| measures.mid_width),
            displacement_percent: 100.0 * error / third.weighted_norm(&areas),
            departure_percent: 100.0 * error / third.weighted_distance(&affine, &areas),
            displacement_order: order,
        })
    }

    fn stress_deviation(
        &self,
        mesh: &Mesh,
        displacement: &[f64],
        past: &[&[f64]],
        step: usize,
    ) -> f64 {
        let (fine, solutions) = self.meshes[2];
        let (mut error, mut size) = (0.0, 0.0);
        for cell in 0..mesh.cell_count() {
            let centre = mesh.centre(cell);
            if near_corner(self.problem.size, centre) {
                continue;
            }
            let (there, local) = fine.locate(centre);
            let before = solutions[..step].iter().map(|state| &state.displacement);
            let before = before.map(|field| fine.gradient_at(field, there, local));
            let expected = fine.gradient_at(&solutions[step].displacement, there, local);
            let expected = self.stress(expected, before);
            let before = past
                .iter()
                .map(|field| mesh.gradient_at(field, cell, [0.0, 0.0]));
            let found = mesh.gradient_at(displacement, cell, [0.0, 0.0]);
            let found = self.stress(found, before);
            error += (found - expected).norm_squared();
            size += expected.norm_squared();
        }
        100.0 * (error / size).sqrt()
    }

    /// First Piola–Kirchhoff stress in MPa; NaN where the field is inverted.
    fn stress(&self, gradient: [f64; 4], past: impl Iterator<Item = [f64; 4]>) -> Vector4<f64> {
        match Kinematics::new(&Vector4::from(gradient)) {
            Ok(kinematics) => {
                StressAfter::new(&*self.problem.law, &kinematics, past.map(Vector4::from)).stress
            }
            Err(_) => Vector4::repeat(f64::NAN),
        }
    }
}

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
    let departure = reference.weighted_distance(affine, &areas);
    100.0 * field.weighted_distance(reference, &areas) / departure
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
    let [low, high] = mesh.bounding_box();
    let size = (high[0] - low[0]).max(high[1] - low[1]) * areas.iter().sum::<f64>().sqrt();
    let rests = |field: &[f64]| field.weighted_norm(areas) <= ROUNDING * size;
    if rests(field) && rests(reference) {
        0.0
    } else {
        percent(areas, field, reference)
    }
}

fn percent(areas: &[f64], field: &[f64], reference: &[f64]) -> f64 {
    100.0 * field.weighted_distance(reference, areas) / reference.weighted_norm(areas)
}

/// Whether a point lies within a fifth of the width of a corner.
fn near_corner(size: [f64; 2], point: [f64; 2]) -> bool {
    let [x, y] = [0, 1].map(|axis| point[axis].min(size[axis] - point[axis]));
    x.hypot(y) < size[1] / 5.0
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::finite_element::Element;
    use crate::material::Card;
    use crate::mesh::CellShape;
    use crate::solve::NewtonSettings;

    #[test]
    fn a_known_deviation_is_measured_as_stated() {
        let problem = ClampedPlate {
            size: [30.0, 20.0],
            thickness: 2.0,
            law: Card::load("neo-hooke", Path::new(".")).unwrap().law,
            stretches: vec![0.2],
        };
        let settings = NewtonSettings {
            tolerance: 1e-10,
            max_iterations: 20,
        };
        let solve = |cells| {
            let model = FiniteElements::new(&problem, cells, Element::Q2);
            let solutions = model.solve(&problem, settings, &|_| ()).unwrap();
            (model, solutions)
        };
        let [coarse, middle, fine] = [[3, 2], [6, 4], [12, 8]].map(solve);
        let meshes = [&coarse, &middle, &fine].map(|(model, found)| (model, &found[..]));
        let reference = Reference::new(&problem, meshes);

        let lattice = Mesh::plate(problem.size, [12, 8], CellShape::Quad4);
        let exact = reference.displacements_on(&lattice).remove(0);
        let same = State {
            displacement: exact.clone(),
            ..fine.1[0].clone()
        };
        let measures = Measures::of(&fine.0.mesh, &fine.1[0]);
        let zero = reference
            .deviation(&lattice, &same, &[], measures, 0)
            .unwrap();
        assert_eq!(zero.displacement_percent, 0.0);
        assert_eq!((zero.max_difference, zero.force_percent), (0.0, 0.0));

        // Everything 1 % larger: 1 % in displacement and force, more in the departure from affine.
        let larger = State {
            displacement: exact.iter().map(|u| 1.01 * u).collect(),
            ..same
        };
        let increased = Measures {
            force: 1.01 * measures.force,
            ..measures
        };
        let found = reference
            .deviation(&lattice, &larger, &[], increased, 0)
            .unwrap();
        assert!((found.displacement_percent - 1.0).abs() < 1e-10);
        assert!((found.force_percent - 1.0).abs() < 1e-10);
        assert!((found.max_difference - 0.06).abs() < 1e-12);
        assert!(found.departure_percent > 3.0);
        assert!(found.nominal_stress_percent > 0.5 && found.nominal_stress_percent < 2.0);

        let own = reference.self_convergence(0).unwrap();
        assert!(
            own.force.order > Some(1.0) && own.displacement_order > Some(1.0),
            "{own:?}"
        );
        assert!(own.displacement_percent < 0.1, "{own:?}");
    }
}
