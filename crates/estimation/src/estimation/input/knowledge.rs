//! The input of an estimate: the specimen, and what is known besides the displacements.

use serde::{Deserialize, Serialize};

use super::regressed_law::{RegressedLaw, UncertainLaw};
use crate::error::Diagnostic;
use crate::estimation::regression::Robust;
use crate::mesh::Mesh;
use crate::problem::CellLaws;

/// The sheet whose displacements were measured.
#[derive(Clone, Debug)]
pub struct Specimen<'a> {
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// The materials of its cells.
    pub laws: CellLaws,
    /// Its thickness at rest in mm.
    pub thickness: f64,
}

/// What is known besides the displacements. All of it may be left out.
#[derive(Clone, Debug, Default)]
pub struct Knowledge {
    /// What is known of named parts of the boundary. Holes that are not named are free.
    pub edges: Vec<(String, EdgeCondition)>,
    /// The assumption on the outer boundary where no part is named.
    pub unnamed: Unnamed,
    /// Forces that were measured.
    pub forces: Vec<MeasuredForce>,
    /// Whether the field is only compared with the measured forces, instead of including them. This is also done
    /// where no field near the markers has such forces.
    pub forces_are_checks: bool,
    /// Standard deviation of each component of the displacement of markers without one of their own, in mm; `None` where it is to be estimated.
    pub noise: Option<f64>,
    /// How markers with large residuals are weighted.
    pub robust: Robust,
    /// Whether an estimate without robust weights ends where gross errors make up the noise of the markers. Its result then has the markers'
    /// residuals only; robust weights are needed.
    pub ends_at_gross_errors: bool,
    /// Whether equilibrium is exact.
    pub physics: Physics,
    /// How far outside of the mesh free edges may lie, in mm, where only markers show the specimen's edge: the errors
    /// of displacement and stress include this.
    pub edge_gap: Option<f64>,
    /// How far to both sides of the mesh's the free edges may lie, in mm, where they were traced: all errors include this. Without effect beside
    /// a gap.
    pub edge_accuracy: f64,
    /// Relative standard deviation of the scale of the picture: a specimen that comes nearer to its camera appears to grow.
    pub scale_deviation: f64,
    /// A law with parameters that are found with the field; it replaces the specimen's law of the cells that belong to no region.
    pub law: Option<RegressedLaw>,
    /// The law of the cells that belong to no region with its uncertainty, which the errors include; not used where parameters are found.
    pub uncertain_law: Option<UncertainLaw>,
}

/// The assumption on the outer boundary, from corner to corner, where no part is named.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unnamed {
    /// All parts begin as loaded. One after the other, the longest first, is taken as free where the data do not contradict this:
    /// where the misfit grows by no more than noise would cause in ninety-nine of a hundred cases (F test). Two stay loaded.
    #[default]
    Tested,
    /// All parts are loaded: the mesh ends inside of the specimen.
    Loaded,
    /// All parts are free.
    Free,
}

impl Unnamed {
    /// The names that conditions use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("tested", Self::Tested),
        ("loaded", Self::Loaded),
        ("free", Self::Free),
    ];
}

/// How exactly the equations are satisfied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Physics {
    /// F(u) = 0.
    #[default]
    Exact,
    /// F(u) = f with smooth forces f on the interior, which represent what law, thickness and equations lack: the weight of ∫ f²
    /// relative to the misfit follows by restricted maximum likelihood. Where the physics is right, f tends to zero.
    Weighted,
}

impl Physics {
    /// The names that conditions use.
    pub const NAMES: [(&'static str, Self); 2] =
        [("exact", Self::Exact), ("weighted", Self::Weighted)];
}

/// Default standard deviation of a force relative to the force: the class of a load cell, the same in all frames.
pub const FORCE_CLASS: f64 = 0.01;

/// A force that was measured on an edge that is not free.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct MeasuredForce {
    /// The group of the edge.
    pub edge: String,
    /// 0 along x, 1 along y.
    pub axis: usize,
    /// The force of the grip on the sheet in N.
    pub force: f64,
    /// Its standard deviation in N.
    pub standard_deviation: f64,
    /// The relative standard deviation of a factor common to all measured forces, such as the gain of their load
    /// cell: parameters of a law found from several frames are as uncertain as this factor in all frames together.
    #[serde(default)]
    pub common_deviation: f64,
}

/// What is known of a part of the boundary.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub enum EdgeCondition {
    /// No traction.
    Free,
    /// Displacements ux, uy in mm; the edge is free along an axis without one.
    Known([Option<f64>; 2]),
    /// A rigid body that moved and turned by unknown amounts.
    Rigid,
    /// Loaded in an unknown way: the displacement is a smooth function along the edge.
    Unknown,
}

impl EdgeCondition {
    /// Where edges meet, the one with the least rank moves the node.
    pub(in crate::estimation) fn rank(self) -> usize {
        match self {
            Self::Known(_) => 0,
            Self::Rigid => 1,
            Self::Unknown | Self::Free => 2,
        }
    }
}

impl Knowledge {
    /// The measured forces that the field includes.
    pub(in crate::estimation) fn measured_forces(&self) -> &[MeasuredForce] {
        if self.forces_are_checks {
            &[]
        } else {
            &self.forces
        }
    }

    /// Whether forces and stresses are as large as the law makes them: no force is measured, and no parameter found.
    pub(in crate::estimation) fn is_given_the_law(&self) -> bool {
        self.law.is_none() && self.forces.is_empty()
    }

    /// The specimen's law with its uncertainty, where that is known and no parameter is found.
    pub(in crate::estimation) fn uncertain_law(&self) -> Option<&UncertainLaw> {
        self.uncertain_law.as_ref().filter(|_| self.law.is_none())
    }

    /// Checks the measured forces and the noise.
    pub(in crate::estimation) fn check(&self) -> Result<(), Diagnostic> {
        let refuse = |fault: String, hint: &str| Err(Diagnostic::error("", fault).hint(hint));
        for force in &self.forces {
            let (edge, value, deviation) = (&force.edge, force.force, force.standard_deviation);
            let condition = self.edges.iter().find(|(name, _)| name == edge);
            if condition.is_none_or(|(_, condition)| *condition == EdgeCondition::Free) {
                let fault = format!(
                    "the force on `{edge}` was measured, but the edge is not stated to be held"
                );
                return refuse(
                    fault,
                    "check its name, or state how it moved: rigid (--rigid), known or unknown (a file for --study)",
                );
            }
            if !(value.is_finite() && deviation.is_finite() && deviation > 0.0) {
                let fault = format!("the force on `{edge}` is {value} ± {deviation} N");
                return refuse(
                    fault,
                    "give finite numbers and a positive standard deviation",
                );
            }
        }
        if self.law.is_some() && self.forces.is_empty() {
            return refuse(
                "a parameter of the law is to be estimated without a measured force".into(),
                "give the force on an edge with its standard deviation: displacements alone do not determine a stiffness",
            );
        }
        let positive = |noise: f64| noise > 0.0 && noise.is_finite();
        if self.noise.is_none_or(positive) {
            Ok(())
        } else {
            refuse(
                "the noise is not positive".into(),
                "leave it out to have it estimated",
            )
        }
    }
}
