//! The mass-spring plate: springs along the edges and both diagonals of every cell.
//!
//! ```text
//! T = K(·) (|x| − x₀) = a P(λ),   λ = |x|/x₀                                          [N]
//! ```
//!
//! P is the nominal stress of a strip of the sheet cut along the spring, and a the cross-section assigned to the
//! spring, so that K(·) = a P(λ)/(x₀ (λ − 1)) follows the card's curve. The cross-sections make the lattice isotropic
//! at small strain. With the sides hx, hy of a cell, its diagonal d, the thickness t and s = 1:
//!
//! ```text
//! diagonal      k = s 3/16 E t d²/(hx hy)                 (square cells: 3/8 E t)
//! edge along X  k = s E t (9/8 hy/hx − 3/8 hx/hy)         (square cells: 3/4 E t; half on the border)
//! ```
//!
//! A lattice of springs alone has C₁₁₂₂ = C₁₂₁₂ (Cauchy's relation), hence ν = ⅓ whatever the
//! stiffnesses: this is the regular model. With s = 4/(3 (1 + ν)) and an area term ½ κ A₀ (A/A₀ − 1)² in each cell,
//! κ = E t (3 ν − 1)/(2 (1 − ν²)), the lattice has the ν of the sheet at small strain: s = 8/9 and κ = ⅓ E t for the
//! incompressible sheet, whose ν is ½.
//!
//! # References
//! A. Van Gelder, J. Graph. Tools 3(2), 21 (1998), doi:10.1080/10867651.1998.10487490

use std::sync::Arc;

use crate::error::Error;
use crate::material::law::HyperelasticLaw;
use crate::material::stability::in_plane_poisson_ratio;
use crate::mesh::{CellShape, Mesh, decimals_for};
use crate::problem::{ClampedPlate, Model, SheetLaws};
use crate::solve::{NewtonSettings, Potential, Remembering, State};

pub mod calibration;
mod lattice;
mod spring;
mod spring_law;
#[cfg(test)]
mod tests;

use lattice::Lattice;
use spring::CrossSections;
pub use spring::{Spring, SpringPose};
pub use spring_law::{DashpotLaw, SpringLaw};

/// A spring in a deformed lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringState {
    /// λ = |x|/x₀.
    pub stretch: f64,
    /// T in N, positive in tension.
    pub force: f64,
}

/// Options of the lattice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LatticeSettings {
    /// Whether each cell has the area term that gives the lattice the sheet's ν. Default: no.
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

/// The largest ratio of a cell's sides at which no edge has a negative stiffness: √3.
pub const LARGEST_ASPECT: f64 = 1.732;

/// The factor s of the springs and κ/E of the area terms that give a lattice the small-strain stiffness of an isotropic sheet.
///
/// Springs alone have ν = ⅓ with C₁₁₁₁ = 9/8 E and C₁₁₂₂ = C₁₂₁₂ = 3/8 E; areas add κ to C₁₁₁₁ and C₁₁₂₂:
///
/// ```text
/// springs 4/(3 (1 + ν)),   areas κ/E = (3 ν − 1)/(2 (1 − ν²))
/// ```
///
/// A law with fibres is taken to have ν = ½.
fn isotropic_shares(law: &dyn HyperelasticLaw) -> [f64; 2] {
    let nu = if law.is_isotropic() {
        in_plane_poisson_ratio(law)
    } else {
        0.5
    };
    [
        4.0 / (3.0 * (1.0 + nu)),
        (3.0 * nu - 1.0) / (2.0 * (1.0 - nu * nu)),
    ]
}

/// A warning where springs alone represent a sheet that changes its volume and whose in-plane ν differs from theirs.
pub fn warning(law: &dyn HyperelasticLaw) -> Option<String> {
    const NEGLIGIBLE: f64 = 0.005;
    law.bulk_modulus()?;
    let nu = in_plane_poisson_ratio(law);
    let off = (nu - 1.0 / 3.0).abs() > NEGLIGIBLE;
    off.then(|| {
        format!(
            "springs alone have ν = ⅓, and the sheet has ν = {nu:.3} in its plane at small strain"
        )
    })
}

/// [`warning`] of a plate's lattice, which may have an area term.
pub fn warning_of_plate(law: &dyn HyperelasticLaw) -> Option<String> {
    let message = warning(law)?;
    Some(message + "; an area term (`mass_spring.area_term`) gives them the sheet's ν")
}

impl MassSpring {
    /// Builds the lattice of a problem on `cells` cells.
    ///
    /// The ratio of a cell's sides must not exceed [`LARGEST_ASPECT`]; beyond it, an isotropic lattice
    /// would need edges of negative stiffness.
    pub fn new(problem: &ClampedPlate, cells: [usize; 2], settings: LatticeSettings) -> Self {
        let mesh = Mesh::plate(problem.size, cells, CellShape::Quad4);
        let [scale, area_stiffness] = if settings.area_term {
            isotropic_shares(&*problem.law)
        } else {
            [1.0, 0.0]
        };
        let [hx, hy] = mesh.cell_size(0);
        let diagonal = hx.hypot(hy);
        let edge =
            |along: f64, across: f64| 9.0 / 8.0 * across / along - 3.0 / 8.0 * along / across;
        // Cross-section: stiffness over E t, times rest length and thickness; each cell contributes half.
        let along_x = 0.5 * scale * problem.thickness * hx * edge(hx, hy);
        let along_y = 0.5 * scale * problem.thickness * hy * edge(hy, hx);
        let across =
            scale * problem.thickness * diagonal * 3.0 / 16.0 * diagonal * diagonal / (hx * hy);
        let mut sections = CrossSections::default();
        for cell in 0..mesh.cell_count() {
            let [a, b, c, d] = *mesh.cell(cell) else {
                unreachable!("four nodes")
            };
            let sides = [
                ([a, b], along_x),
                ([d, c], along_x),
                ([a, d], along_y),
                ([b, c], along_y),
            ];
            for (ends, area) in sides
                .into_iter()
                .chain([([a, c], across), ([d, b], across)])
            {
                sections.add(ends, 0, area);
            }
        }
        let springs = sections.springs(&mesh.nodes);
        let modulus = area_stiffness * problem.law.youngs_modulus();
        let laws = vec![Arc::clone(&problem.law)];
        Self::of(laws, mesh, springs, modulus * problem.thickness)
    }

    fn of(
        laws: Vec<Arc<dyn HyperelasticLaw>>,
        mesh: Mesh,
        springs: Vec<Spring>,
        area_stiffness: f64,
    ) -> Self {
        Self {
            lattice: Lattice::new(laws, &mesh, springs.clone(), area_stiffness),
            mesh,
            springs,
        }
    }

    /// The lattice on the corners of any mesh: springs along the edges of its cells and both diagonals of its
    /// quadrilaterals, with the cross-sections of [`calibration`]. Along the edge between two regions lies a spring of each law.
    pub fn on_mesh<'a>(laws: impl Into<SheetLaws<'a>>, thickness: f64, mesh: Mesh) -> Self {
        let laws = laws.into().in_cells(&mesh);
        let springs = calibration::springs(&mesh, &laws, thickness);
        Self::of(laws.all().to_vec(), mesh, springs, 0.0)
    }

    /// The lattice with other cross-sections in mm²; springs without a positive one are removed.
    #[must_use]
    pub fn with_areas(self, mut area: impl FnMut(&Spring) -> f64) -> Self {
        let change = |spring: Spring| Spring {
            area: area(&spring),
            ..spring
        };
        let springs = self.springs.into_iter().map(change);
        let springs = springs.filter(|spring| spring.area > 0.0).collect();
        Self::of(
            self.lattice.laws,
            self.mesh,
            springs,
            self.lattice.area_stiffness,
        )
        .with_spring_law(self.lattice.spring_law)
    }

    /// The lattice with the springs' stiffness from `law` in place of the material.
    #[must_use]
    pub fn with_spring_law(mut self, law: SpringLaw) -> Self {
        self.lattice.spring_law = law;
        self
    }

    /// Geometry of a spring with the displacements `u` of its ends.
    pub fn pose(&self, spring: usize, u: &[f64]) -> SpringPose {
        self.lattice.pose(spring, u)
    }

    /// The stiffness k = a E/x₀ of a spring at rest in N/mm.
    pub fn stiffness_at_rest(&self, spring: usize) -> f64 {
        let Spring {
            rest_length, area, ..
        } = self.springs[spring];
        area * self.pose(spring, &[0.0; 4]).response.slope / rest_length
    }

    /// κ of the area terms in N/mm; zero where there are none.
    pub fn area_stiffness(&self) -> f64 {
        self.lattice.area_stiffness
    }

    /// The lattice's energy as a potential of the nodal displacements.
    pub fn potential(&self) -> &dyn Remembering {
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
        let decimals = decimals_for(0.1 * self.mesh.diagonal());
        let [from, to] = spring.nodes.map(|node| {
            let [x, y] = self.mesh.nodes[node];
            format!("({x:.decimals$}, {y:.decimals$})")
        });
        format!("the spring from {from} to {to} mm")
    }

    /// Stretch and force of every spring of a lattice with a history, which is empty for a lattice that was never loaded.
    pub fn spring_states(&self, displacement: &[f64], history: &[f64]) -> Vec<SpringState> {
        let state = |(index, spring): (usize, &Spring)| {
            let displacements = self.lattice.connectivity().values(index, displacement);
            let pose = self.lattice.pose_after(index, &displacements, history);
            SpringState {
                stretch: pose.stretch,
                force: spring.area * pose.response.nominal_stress,
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
        model.reach_all(&plate.stretches, settings, progress)
    }
}
