//! The mass-spring plate: springs along the edges and both diagonals of every cell.
//!
//! ```text
//! T = K(·) (|x| − x₀) = a P(λ),   λ = |x|/x₀                                          [N]
//! ```
//!
//! P is the nominal stress of a strip of the sheet cut along the spring and a the cross-section that the spring stands for, so that
//! K(·) = a P(λ)/(x₀ (λ − 1)) follows the card's curve. The cross-sections make the lattice isotropic
//! at small strain. With hx, hy the sides of a cell, d its diagonal, t the thickness and s = 1:
//!
//! ```text
//! diagonal      k = s 3/16 E t d²/(hx hy)                 (square cells: 3/8 E t)
//! edge along X  k = s E t (9/8 hy/hx − 3/8 hx/hy)         (square cells: 3/4 E t; half on the border)
//! ```
//!
//! A lattice of springs alone has C₁₁₂₂ = C₁₂₁₂ (Cauchy's relation), hence ν = ⅓ whatever the
//! stiffnesses: this is the regular model. With s = 8/9 and an area term ½ κ A₀ (A/A₀ − 1)² in each cell,
//! κ = ⅓ E t, the lattice has ν = ½ at small strain, as the incompressible sheet has.
//!
//! # References
//! A. Van Gelder, J. Graph. Tools 3(2), 21 (1998), doi:10.1080/10867651.1998.10487490

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::error::Error;
use crate::material::law::{HyperelasticLaw, TensionResponse};
use crate::mesh::{CellShape, Mesh};
use crate::problem::{ClampedPlate, Model};
use crate::solve::{Connectivity, Inadmissible, Local, NewtonSettings, Potential, State};

/// One spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// The nodes at its ends.
    pub nodes: [usize; 2],
    /// Rest length x₀ in mm.
    pub rest_length: f64,
    /// Cross-section a in mm².
    pub area: f64,
}

/// A spring in a deformed lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringState {
    /// λ = |x|/x₀.
    pub stretch: f64,
    /// T in N, positive in tension.
    pub force: f64,
}

/// A spring in a deformed lattice, with what its forces follow from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringPose {
    /// λ = |x|/x₀.
    pub stretch: f64,
    /// x/|x|.
    pub unit: [f64; 2],
    /// The tension curve at λ.
    pub response: TensionResponse,
}

impl SpringPose {
    /// Adds a force in N along the spring, positive in tension, to those of its ends.
    pub fn add_force(&self, force: f64, ends: &mut [f64]) {
        let (near, far) = ends.split_at_mut(2);
        for (axis, direction) in self.unit.iter().enumerate() {
            near[axis] -= force * direction;
            far[axis] += force * direction;
        }
    }

    /// Adds stiffnesses along and across the spring in N/mm to those of its ends, row by row.
    pub fn add_stiffness(&self, [along, across]: [f64; 2], stiffness: &mut [f64]) {
        for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let identity = if i == k { 1.0 } else { 0.0 };
            let value = (along - across) * self.unit[i] * self.unit[k] + across * identity;
            stiffness[4 * i + k] += value;
            stiffness[4 * i + 2 + k] -= value;
            stiffness[4 * (2 + i) + k] -= value;
            stiffness[4 * (2 + i) + 2 + k] += value;
        }
    }
}

/// What the lattice consists of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LatticeSettings {
    /// Whether each cell has the area term that gives ν = ½ at small strain. Default: no.
    pub area_term: bool,
}

/// A mass-spring lattice on the cells of a plate.
#[derive(Clone, Debug)]
pub struct MassSpring {
    /// Nodes and cells of the lattice.
    pub mesh: Mesh,
    /// Edge springs and diagonal springs.
    pub springs: Vec<Spring>,
    lattice: Lattice,
}

#[derive(Clone, Debug)]
struct Lattice {
    law: Arc<dyn HyperelasticLaw>,
    spring_law: SpringLaw,
    /// Unknowns of the springs, then of the cells.
    connectivity: Connectivity,
    springs: Vec<(f64, f64)>,
    /// Reference components of each spring's direction, as for `springs`.
    directions: Vec<[f64; 2]>,
    corners: Vec<Vec<[f64; 2]>>,
    /// κ in N/mm.
    area_stiffness: f64,
}

/// The largest ratio of a cell's sides for which all springs pull: √3.
pub const LARGEST_ASPECT: f64 = 1.732;

impl MassSpring {
    /// Builds the lattice of a problem on `cells` cells.
    ///
    /// The ratio of a cell's sides must not exceed [`LARGEST_ASPECT`]; beyond it, an isotropic lattice
    /// would need edges of negative stiffness.
    pub fn new(problem: &ClampedPlate, cells: [usize; 2], settings: LatticeSettings) -> Self {
        let mesh = Mesh::plate(problem.size, cells, CellShape::Quad4);
        let scale = if settings.area_term { 8.0 / 9.0 } else { 1.0 };
        let [hx, hy] = mesh.cell_size();
        let diagonal = hx.hypot(hy);
        let edge =
            |along: f64, across: f64| 9.0 / 8.0 * across / along - 3.0 / 8.0 * along / across;
        // Stiffness over E t times rest length and thickness is the cross-section; half for each cell.
        let along_x = 0.5 * scale * problem.thickness * hx * edge(hx, hy);
        let along_y = 0.5 * scale * problem.thickness * hy * edge(hy, hx);
        let across =
            scale * problem.thickness * diagonal * 3.0 / 16.0 * diagonal * diagonal / (hx * hy);
        let mut areas = BTreeMap::new();
        for cell in 0..mesh.cell_count() {
            let [a, b, c, d] = mesh.cell(cell) else {
                unreachable!("four nodes")
            };
            let sides = [
                (a, b, along_x),
                (d, c, along_x),
                (a, d, along_y),
                (b, c, along_y),
            ];
            for (from, to, area) in sides.into_iter().chain([(a, c, across), (d, b, across)]) {
                *areas.entry([*from.min(to), *from.max(to)]).or_insert(0.0) += area;
            }
        }
        let springs: Vec<Spring> = areas
            .into_iter()
            .map(|(nodes, area)| {
                let [from, to] = nodes.map(|node| mesh.nodes[node]);
                Spring {
                    nodes,
                    rest_length: (to[0] - from[0]).hypot(to[1] - from[1]),
                    area,
                }
            })
            .collect();
        let modulus = if settings.area_term {
            problem.law.youngs_modulus() / 3.0
        } else {
            0.0
        };
        let lattice = Lattice::new(&problem.law, &mesh, &springs, modulus * problem.thickness);
        Self {
            mesh,
            springs,
            lattice,
        }
    }

    /// The lattice on the corners of any mesh: springs along the edges of its cells and both diagonals of its
    /// quadrilaterals, with the cross-sections of [`calibration`].
    pub fn on_mesh(law: &Arc<dyn HyperelasticLaw>, thickness: f64, mesh: Mesh) -> Self {
        let springs = calibration::springs(&mesh, thickness);
        let lattice = Lattice::new(law, &mesh, &springs, 0.0);
        Self {
            mesh,
            springs,
            lattice,
        }
    }

    /// The lattice with other cross-sections in mm²; springs that get none are left out.
    #[must_use]
    pub fn with_areas(self, problem: &ClampedPlate, mut area: impl FnMut(&Spring) -> f64) -> Self {
        let change = |spring: Spring| Spring {
            area: area(&spring),
            ..spring
        };
        let springs = self.springs.into_iter().map(change);
        let springs: Vec<Spring> = springs.filter(|spring| spring.area > 0.0).collect();
        let lattice = Lattice::new(
            &problem.law,
            &self.mesh,
            &springs,
            self.lattice.area_stiffness,
        );
        let lattice = Lattice {
            spring_law: self.lattice.spring_law,
            ..lattice
        };
        Self {
            mesh: self.mesh,
            springs,
            lattice,
        }
    }

    /// The lattice with springs of another stiffness than the material's.
    #[must_use]
    pub fn with_spring_law(mut self, law: SpringLaw) -> Self {
        self.lattice.spring_law = law;
        self
    }

    /// How a spring lies with the displacements `u` of its ends.
    pub fn pose(&self, spring: usize, u: &[f64]) -> SpringPose {
        self.lattice.pose(spring, u)
    }

    /// The lattice's energy as a potential of the nodal displacements.
    pub fn potential(&self) -> &dyn Potential {
        &self.lattice
    }

    /// The plate on this lattice.
    pub fn model(&self, plate: &ClampedPlate) -> Model<'_> {
        let name = format!("mass-spring ({})", self.mesh.describe());
        let model = plate.on(&self.mesh, &self.lattice).named(name);
        model.describing(|element| self.describe_element(element))
    }

    /// A spring by its ends, or a cell, for messages.
    pub fn describe_element(&self, element: usize) -> String {
        let Some(spring) = self.springs.get(element) else {
            return self.mesh.describe_cell(element - self.springs.len());
        };
        let [[x, y], [to_x, to_y]] = spring.nodes.map(|node| self.mesh.nodes[node]);
        format!("the spring from ({x:.1}, {y:.1}) to ({to_x:.1}, {to_y:.1}) mm")
    }

    /// Stretch and force of every spring.
    pub fn spring_states(&self, displacement: &[f64]) -> Vec<SpringState> {
        let state = |(index, spring): (usize, &Spring)| {
            let [from, to] = spring.nodes;
            let relative =
                [0, 1].map(|axis| displacement[2 * to + axis] - displacement[2 * from + axis]);
            let strain = strain(self.lattice.directions[index], relative);
            let tension = self.lattice.tension(index, strain);
            SpringState {
                stretch: 1.0 + strain,
                force: spring.area * tension.nominal_stress,
            }
        };
        self.springs.iter().enumerate().map(state).collect()
    }

    /// Solves all stretches of the plate.
    ///
    /// # Errors
    /// [`Error::Solve`] with the stretch at which no equilibrium was found.
    pub fn solve(
        &self,
        plate: &ClampedPlate,
        settings: NewtonSettings,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<State>, Error> {
        let model = self.model(plate);
        let states = model.solve(&plate.stretches, settings, progress);
        states.map_err(|end| model.error(&end))
    }
}

/// λ − 1 of a spring with direction n x₀ = `direction` over x₀², whose ends move by `relative`,
/// without cancellation at small displacements.
///
/// `direction` is the reference vector divided by the squared rest length.
fn strain(direction: [f64; 2], relative: [f64; 2]) -> f64 {
    let inverse = direction[0].hypot(direction[1]); // 1/x₀
    let linear = 2.0 * (direction[0] * relative[0] + direction[1] * relative[1]);
    let quadratic = (relative[0].powi(2) + relative[1].powi(2)) * inverse * inverse;
    let square = linear + quadratic; // λ² − 1
    square / (1.0 + (1.0 + square).max(0.0).sqrt())
}

impl Lattice {
    fn new(
        law: &Arc<dyn HyperelasticLaw>,
        mesh: &Mesh,
        springs: &[Spring],
        area_stiffness: f64,
    ) -> Self {
        let mut connectivity = Connectivity::new(2 * mesh.nodes.len());
        for spring in springs {
            connectivity.push_nodes(&spring.nodes);
        }
        let mut corners = Vec::new();
        for cell in 0..mesh.cell_count() {
            let nodes = &mesh.cell(cell)[..mesh.shape(cell).corners()];
            connectivity.push_nodes(nodes);
            corners.push(nodes.iter().map(|node| mesh.nodes[*node]).collect());
        }
        let direction = |spring: &Spring| {
            let [from, to] = spring.nodes.map(|node| mesh.nodes[node]);
            [0, 1].map(|axis| (to[axis] - from[axis]) / spring.rest_length.powi(2))
        };
        Self {
            law: Arc::clone(law),
            spring_law: SpringLaw::Material,
            connectivity,
            directions: springs.iter().map(direction).collect(),
            springs: springs
                .iter()
                .map(|spring| (spring.rest_length, spring.area))
                .collect(),
            corners,
            area_stiffness,
        }
    }

    /// The sheet's tension curve along a spring.
    fn tension(&self, spring: usize, strain: f64) -> TensionResponse {
        let unit = self.directions[spring].map(|component| component * self.springs[spring].0);
        self.spring_law.tension(&*self.law, unit, strain)
    }

    fn pose(&self, index: usize, u: &[f64]) -> SpringPose {
        let (rest_length, _) = self.springs[index];
        let direction = self.directions[index];
        let relative = [u[2] - u[0], u[3] - u[1]];
        let strain = strain(direction, relative);
        let current =
            [0, 1].map(|axis| direction[axis] * rest_length + relative[axis] / rest_length);
        let stretch = 1.0 + strain;
        SpringPose {
            stretch,
            unit: current.map(|component| component / stretch),
            response: self.tension(index, strain),
        }
    }

    /// Energy a x₀ Ψ(λ), force a P and stiffness of one spring.
    fn evaluate_spring(&self, index: usize, u: &[f64], local: Local<'_>) -> f64 {
        let (rest_length, area) = self.springs[index];
        let pose = self.pose(index, u);
        let response = pose.response;
        let force = area * response.nominal_stress;
        pose.add_force(force, local.residual);
        if let Some(stiffness) = local.stiffness {
            let along = area * response.slope / rest_length;
            let across = force / (pose.stretch * rest_length);
            pose.add_stiffness([along, across], stiffness);
        }
        area * rest_length * response.energy
    }

    /// Energy ½ κ A₀ (A/A₀ − 1)² of one cell; refuses a cell that has no positive area.
    ///
    /// ```text
    /// A = ½ Σ (xᵢ yᵢ₊₁ − xᵢ₊₁ yᵢ),   ∂A/∂xᵢ = ½ (yᵢ₊₁ − yᵢ₋₁),   ∂A/∂yᵢ = ½ (xᵢ₋₁ − xᵢ₊₁)
    /// ```
    fn evaluate_cell(&self, cell: usize, u: &[f64], local: Local<'_>) -> Option<f64> {
        let corners = &self.corners[cell];
        let count = corners.len();
        let next = |i: usize| (i + 1) % count;
        let before = |i: usize| (i + count - 1) % count;
        if self.area_stiffness == 0.0 {
            return (deformed_area(corners, u) > 0.0).then_some(0.0);
        }
        // Places relative to the first corner, so that no digit is lost far from the origin.
        let place = |i: usize| {
            let at = |axis: usize| corners[i][axis] - corners[0][axis] + u[2 * i + axis] - u[axis];
            [at(0), at(1)]
        };
        let rest = polygon_area(corners);
        let places: Vec<[f64; 2]> = (0..count).map(place).collect();
        let current = polygon_area(&places);
        if current.is_nan() || current <= 0.0 {
            return None;
        }
        let change = current / rest - 1.0;
        let slope: Vec<f64> = (0..count)
            .flat_map(|i| {
                let (from, to) = (places[before(i)], places[next(i)]);
                [0.5 * (to[1] - from[1]), 0.5 * (from[0] - to[0])]
            })
            .collect();
        for (r, slope) in local.residual.iter_mut().zip(&slope) {
            *r += self.area_stiffness * change * slope;
        }
        if let Some(stiffness) = local.stiffness {
            let size = 2 * count;
            for (i, k) in (0..size * size).map(|n| (n / size, n % size)) {
                stiffness[i * size + k] += self.area_stiffness / rest * slope[i] * slope[k];
            }
            for i in 0..count {
                for (other, sign) in [(next(i), 0.5), (before(i), -0.5)] {
                    let value = sign * self.area_stiffness * change;
                    let (x, y) = (2 * i, 2 * other + 1);
                    stiffness[x * size + y] += value;
                    stiffness[y * size + x] += value;
                }
            }
        }
        Some(0.5 * self.area_stiffness * rest * change * change)
    }
}

/// Area of a cell with the displacements `u` of its corners, relative to the first of them.
fn deformed_area(corners: &[[f64; 2]], u: &[f64]) -> f64 {
    let side = |i: usize| {
        let along = |axis: usize| corners[i][axis] - corners[0][axis] + u[2 * i + axis] - u[axis];
        [along(0), along(1)]
    };
    let triangles = (2..corners.len()).map(|i| {
        let ([ax, ay], [bx, by]) = (side(i - 1), side(i));
        0.5 * (ax * by - bx * ay)
    });
    triangles.sum()
}

/// Area of a polygon with its corners counter-clockwise.
fn polygon_area(corners: &[[f64; 2]]) -> f64 {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    0.5 * pairs.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>()
}

impl Potential for Lattice {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn evaluate_element(
        &self,
        element: usize,
        u: &[f64],
        local: Local<'_>,
    ) -> Result<f64, Inadmissible> {
        let energy = match element.checked_sub(self.springs.len()) {
            None => Some(self.evaluate_spring(element, u, local)),
            Some(cell) => self.evaluate_cell(cell, u, local),
        };
        energy
            .filter(|energy| energy.is_finite())
            .ok_or(Inadmissible { element })
    }

    /// A spring whose force falls while it grows.
    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        let direction = *self.directions.get(element)?;
        let strain = strain(direction, [u[2] - u[0], u[3] - u[1]]);
        let falls = self.tension(element, strain).slope < 0.0;
        falls.then(|| format!("stretch {:.2}", 1.0 + strain))
    }
}

pub mod calibration;
mod spring_law;

pub use spring_law::{DashpotLaw, SpringLaw};

#[cfg(test)]
mod tests;
