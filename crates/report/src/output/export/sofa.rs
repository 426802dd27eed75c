//! A lattice of springs as a scene of SOFA, the framework for surgical simulators.
//!
//! | gelbench | goes out as |
//! |---|---|
//! | nodes at rest | `MechanicalObject` in the plane |
//! | springs | `SpringForceField`: ends, k = a E/x₀ at rest, damping 3 η a/x₀, x₀ |
//! | clamp, displacement, roller, symmetry, rotation | fixed and moved nodes |
//! | traction, force (dead) | `LinearForceField` |
//! | density | `DiagonalMass` |
//! | load factor | time: the length of the path of load factors |
//!
//! The force of a spring of SOFA is linear in its extension:
//!
//! ```text
//! T = k (|x| − x₀) + d d|x|/dt                                                            [N]
//! ```
//!
//! gelbench's springs follow the curve of the material, and have this stiffness at rest.
//!
//! # References
//! F. Faure et al., SOFA: A Multi-Model Framework for Interactive Physical Simulation, Springer (2012), doi:10.1007/8415_2012_125

use super::text::{InputFile, ascii, words};
use super::xml::Xml;
use crate::dynamics::lumped_mass;
use crate::error::{Diagnostic, Error};
use crate::mass_spring::{MassSpring, Spring};
use crate::material::Card;
use crate::problem::{BoundaryProblem, Load};

mod held;

use held::{Held, KeyTimes, PLANE};

/// A study's lattice, ready for a scene.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The heading.
    pub title: &'a str,
    /// Thickness, supports and loads.
    pub problem: &'a BoundaryProblem,
    /// The card of all cells that belong to no region.
    pub card: &'a Card,
    /// The cards of the problem's regions, with their names.
    pub regions: &'a [(String, Card)],
    /// The springs.
    pub springs: &'a MassSpring,
    /// Load factors, in the order in which they are reached.
    pub factors: &'a [f64],
}

/// The components of SOFA's plugins that a scene uses.
const PLUGINS: [&str; 9] = [
    "Sofa.Component.Constraint.Projective",
    "Sofa.Component.LinearSolver.Iterative",
    "Sofa.Component.Mass",
    "Sofa.Component.MechanicalLoad",
    "Sofa.Component.ODESolver.Backward",
    "Sofa.Component.SolidMechanics.Spring",
    "Sofa.Component.StateContainer",
    "Sofa.Component.Topology.Container.Dynamic",
    "Sofa.Component.Visual",
];

impl Scene<'_> {
    /// The scene as XML.
    ///
    /// # Errors
    /// [`Error::Input`] when a support, a load or a term of the lattice cannot be expressed.
    pub fn input_file(&self) -> Result<InputFile, Error> {
        self.check()?;
        let mesh = &self.springs.mesh;
        let times = KeyTimes::new(self.problem, self.factors);
        let held = Held::of(self.problem, mesh, &times)?;
        let forces = self.problem.dead_forces(mesh)?;
        let mut file = Xml::new();
        for line in self.head() {
            file.comment(&line);
        }
        let step = (times.last() / 100.0).to_string();
        let root = [("name", "root"), ("dt", &*step), ("gravity", "0 0 0")];
        file.within("Node", &root, |file| {
            for plugin in PLUGINS {
                file.empty("RequiredPlugin", &[("name", plugin)]);
            }
            let flags = "showBehaviorModels showForceFields";
            file.empty("VisualStyle", &[("displayFlags", flags)]);
            file.empty("DefaultAnimationLoop", &[]);
            file.within("Node", &[("name", "sheet")], |file| {
                self.solvers(file);
                self.lattice(file);
                held.iter().for_each(|held| held.write(&times, file));
                write_forces(&forces, &times, file);
            });
        });
        Ok(InputFile {
            text: file.finish(),
            remarks: self.remarks(),
        })
    }

    /// Refuses what a scene of springs cannot express.
    fn check(&self) -> Result<(), Diagnostic> {
        let refused =
            |key: &str, message: &str, hint: &str| Err(Diagnostic::error(key, message).hint(hint));
        if self.springs.area_stiffness() != 0.0 {
            let message = "the lattice has area terms, which SOFA's springs do not have";
            return refused("mass_spring.area_term", message, "leave out `area_term`");
        }
        let is_pressure = |(_, load): &(String, Load)| matches!(load, Load::Pressure(_));
        if self.problem.loads.iter().any(is_pressure) {
            let message =
                "a pressure follows the edge, which no force of SOFA on the nodes of springs does";
            return refused(
                "load",
                message,
                "take a load of kind \"traction\" or \"force\"",
            );
        }
        if !self.problem.ties(&self.springs.mesh)?.is_empty() {
            let message = "a grip with a given force, or a roller along an inclined line, cannot be exported to SOFA";
            return refused(
                "support",
                message,
                "give the grip a displacement, or turn the mesh",
            );
        }
        Ok(())
    }

    /// The remarks at the head of the file.
    fn head(&self) -> Vec<String> {
        let mut lines = vec![
            format!("{}; written by gelbench {}", self.title, env!("CARGO_PKG_VERSION")),
            "for SOFA v24.06 to v25.12: runSofa FILE".to_owned(),
            "units: mm, N, MPa = N/mm^2, s, tonne; the time is the length of the path of load factors".to_owned(),
            "springs: first node, second node, stiffness [N/mm], damping [N s/mm], rest length [mm]".to_owned(),
            format!("material: card {}, law {}", self.card.name, self.card.law_name),
        ];
        let remarks = self.remarks().into_iter();
        lines.extend(remarks.map(|line| format!("remark: {line}")));
        lines.into_iter().map(|line| ascii(&line)).collect()
    }

    /// Where the scene differs from the study.
    fn remarks(&self) -> Vec<String> {
        let card = self.card;
        let mut remarks = vec![
            "the springs are linear, with the stiffness that those of gelbench have at rest: both lattices agree at small strains"
                .to_owned(),
        ];
        if card.density.is_none() {
            remarks.push("the card states no density: the scene has no masses, and only its static solver can be used".to_owned());
        }
        let in_time = |card: &Card| (card.density, card.viscosity.shear_viscosity);
        let mut of_regions = self.regions.iter().map(|(_, card)| card);
        if of_regions
            .clone()
            .any(|other| in_time(other) != in_time(card))
        {
            let name = &card.name;
            remarks.push(format!(
                "masses and damping are those of the card `{name}` in all regions"
            ));
        }
        let has_memory =
            |card: &Card| card.law.softening().is_some() || !card.viscosity.relaxation.is_empty();
        if has_memory(card) || of_regions.any(has_memory) {
            remarks.push("softening and relaxation of the card are left out".to_owned());
        }
        remarks
    }

    fn solvers(&self, file: &mut Xml) {
        file.comment("for a motion take EulerImplicitSolver in place of StaticSolver");
        file.empty("StaticSolver", &[("newton_iterations", "20")]);
        let iterations = [
            ("iterations", "1000"),
            ("tolerance", "1e-12"),
            ("threshold", "1e-30"),
        ];
        file.empty("CGLinearSolver", &iterations);
    }

    /// Nodes, masses and springs.
    fn lattice(&self, file: &mut Xml) {
        let (mesh, springs) = (&self.springs.mesh, &self.springs.springs);
        let ends = words(springs.iter().flat_map(|spring| spring.nodes));
        file.empty(
            "EdgeSetTopologyContainer",
            &[("name", "edges"), ("edges", &ends)],
        );
        let positions = words(mesh.nodes.iter().flatten());
        file.empty(
            "MechanicalObject",
            &[("name", "nodes"), PLANE, ("position", &positions)],
        );
        if let Some(density) = self.card.density {
            let mass = lumped_mass(mesh, density, self.problem.thickness);
            let mass = words(mass.iter().step_by(2));
            file.empty("DiagonalMass", &[PLANE, ("vertexMass", &mass)]);
        }
        let [_, viscosity] = self.card.viscosity.newtonian_tension(1.0, 0.0);
        let spring = |(index, spring): (usize, &Spring)| {
            let [one, two] = spring.nodes;
            let stiffness = self.springs.stiffness_at_rest(index);
            let damping = viscosity * spring.area / spring.rest_length;
            format!("{one} {two} {stiffness} {damping} {}", spring.rest_length)
        };
        let lines: Vec<String> = springs.iter().enumerate().map(spring).collect();
        let all = lines.join("  ");
        file.empty(
            "SpringForceField",
            &[("name", "springs"), PLANE, ("spring", &all)],
        );
    }
}

/// Dead forces in N at load factor 1, which grow with it: one component for all nodes with the same force.
fn write_forces(forces: &[f64], times: &KeyTimes, file: &mut Xml) {
    let mut all: Vec<([f64; 2], Vec<usize>)> = Vec::new();
    for (node, force) in forces.chunks_exact(2).enumerate() {
        let force = [force[0], force[1]];
        if force == [0.0; 2] {
            continue;
        }
        match all.iter_mut().find(|(known, _)| *known == force) {
            Some((_, nodes)) => nodes.push(node),
            None => all.push((force, vec![node])),
        }
    }
    for ([x, y], nodes) in all {
        let forces = words(times.factors().flat_map(|factor| [factor * x, factor * y]));
        let attributes = [
            PLANE,
            ("points", &words(nodes)),
            ("force", "1"),
            ("times", &words(times.times())),
            ("forces", &forces),
        ];
        file.empty("LinearForceField", &attributes);
    }
}

#[cfg(test)]
mod tests;
