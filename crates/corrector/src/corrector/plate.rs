//! The corrector of a clamped plate, with the nodes at which each condition is imposed.
//!
//! | condition | nodes | rows | multiplier |
//! |---|---|---|---|
//! | F: equilibrium | inside | balance of forces in N | ζ in mm²/N |
//! | T: grips | on the short sides | known displacement in mm | η in mm |
//! | T: traction-free edges | on the long sides, without corners | balance of forces in N | η in mm²/N |

use serde::{Deserialize, Serialize};

use super::climb::{Climb, Provenance, at_stretch};
use super::condition::{Condition, Equilibrium, Linear};
pub use super::specimen::EQUILIBRIUM;
use super::specimen::{CorrectedField, correct_by, state_at};
use super::{Corrector, CorrectorSettings, Describe, DifferenceScheme, Multipliers, Step};
use crate::error::Error;
use crate::mesh::{Mesh, Side};
use crate::problem::sheet_energy::SheetEnergy;
use crate::problem::{ClampedPlate, Measures, Model};
use crate::solve::vector::largest;
use crate::solve::{Assembly, Convergence, Remembering, Stage, State};

/// Name of the condition T at the grips.
pub const GRIPS: &str = "grips";
/// Name of the condition T at the free edges.
pub const FREE_EDGES: &str = "traction-free edges";

/// Which of the known conditions T are imposed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub struct KnownConditions {
    /// The displacement of the grips.
    pub grips: bool,
    /// That no traction acts on the long sides.
    pub free_edges: bool,
}

impl KnownConditions {
    /// Everything that is known about the plate.
    pub const ALL: Self = Self {
        grips: true,
        free_edges: true,
    };
}

impl Default for KnownConditions {
    fn default() -> Self {
        Self::ALL
    }
}

/// A corrected plate at one stretch.
#[derive(Debug)]
#[non_exhaustive]
pub struct CorrectedState {
    /// The corrected field; its residual is that of the difference scheme.
    pub state: State,
    /// The measures of the field.
    pub measures: Measures,
    /// The start and the field after each step of the direct method; empty where the field climbed.
    pub steps: Vec<Step>,
    /// The multipliers, condition after condition.
    pub multipliers: Vec<Multipliers>,
    /// How the climb came to the field; `None` where the method was direct.
    pub provenance: Option<Provenance>,
}

/// The difference scheme of a plate on the nodes of a lattice, ready to correct fields on them.
pub struct PlateCorrector<'a> {
    problem: &'a ClampedPlate,
    mesh: &'a Mesh,
    energy: SheetEnergy,
    assembly: Assembly,
    settings: CorrectorSettings,
    /// The scheme's elements, which messages name.
    elements: Mesh,
}

/// Names of the plate's elements and nodes by their coordinates.
impl Describe for PlateCorrector<'_> {
    fn element(&self, element: usize) -> String {
        self.elements.describe_cell(element)
    }

    fn unknown(&self, unknown: usize) -> String {
        self.mesh.describe_unknown(unknown)
    }
}

impl<'a> PlateCorrector<'a> {
    /// Prepares the corrector on a mesh of four-node cells.
    pub fn new(
        problem: &'a ClampedPlate,
        mesh: &'a Mesh,
        scheme: DifferenceScheme,
        settings: CorrectorSettings,
    ) -> Self {
        let energy = scheme.energy(problem, mesh);
        let assembly = Assembly::new(&energy, &vec![false; 2 * mesh.nodes.len()]);
        Self {
            problem,
            mesh,
            energy,
            assembly,
            settings,
            elements: scheme.elements(mesh),
        }
    }

    /// The corrector after the plate has reached a corrected state, for a material that remembers it.
    #[must_use]
    pub fn after(self, state: &State) -> Self {
        let mut history = state.history.clone();
        self.energy.remember(&mut history, &state.displacement);
        Self {
            energy: self.energy.with_history(history),
            ..self
        }
    }

    /// The difference scheme's energy.
    pub fn energy(&self) -> &SheetEnergy {
        &self.energy
    }

    /// Corrects a displacement field at one stretch, beginning at the field itself.
    ///
    /// # Errors
    /// [`Error::Solve`] when no corrected field was found.
    pub fn correct(
        &self,
        data: &[f64],
        stretch: f64,
        known: KnownConditions,
    ) -> Result<CorrectedState, Error> {
        let model = self.problem.on(self.mesh, &self.energy);
        let stage = self.stage(stretch);
        let corrector = self.corrector(stretch, known);
        let all = known == KnownConditions::ALL;
        let corrected = correct_by(&corrector, &model, data, data, stage, all);
        let CorrectedField { state, correction } =
            corrected.map_err(at_stretch("corrector", stretch))?;
        Ok(CorrectedState {
            steps: correction.steps,
            multipliers: correction.multipliers,
            ..Self::corrected(&model, state)
        })
    }

    /// A stretch after what the plate remembers.
    fn stage(&self, stretch: f64) -> Stage<'_> {
        Stage {
            factor: stretch,
            history: self.energy.history(),
        }
    }

    /// Names of the plate's cells and nodes, for messages.
    pub fn names(&self) -> &dyn Describe {
        self
    }

    /// The corrector of fields at one stretch, all nodes with the weight 1.
    pub fn corrector(&self, stretch: f64, known: KnownConditions) -> Corrector<'_> {
        let weights = vec![1.0; 2 * self.mesh.nodes.len()];
        Corrector::new(self.conditions(stretch, known), weights, self.settings).named(self)
    }

    /// F and the known part of T at one stretch.
    pub fn conditions(&self, stretch: f64, known: KnownConditions) -> Vec<Box<dyn Condition + '_>> {
        let mesh = self.mesh;
        let on_edge = |node: &usize| mesh.on(Side::Bottom, *node) || mesh.on(Side::Top, *node);
        let nodes = || 0..mesh.nodes.len();
        let balance = |name, nodes: Vec<usize>| -> Box<dyn Condition + '_> {
            let unknowns = nodes.iter().flat_map(|node| [2 * node, 2 * node + 1]);
            Box::new(Equilibrium::new(
                name,
                &self.energy,
                &self.assembly,
                unknowns.collect(),
            ))
        };
        let off_grips = nodes().filter(|node| !mesh.on_grip(*node));
        let (edge, inside): (Vec<_>, Vec<_>) = off_grips.partition(on_edge);
        let mut conditions = vec![balance(EQUILIBRIUM, inside)];
        if known.grips {
            let imposed = nodes().filter_map(|node| {
                let held = self.problem.grip_displacement(mesh, node, stretch)?;
                Some([(2 * node, held[0]), (2 * node + 1, held[1])])
            });
            let size = 2 * mesh.nodes.len();
            conditions.push(Box::new(Linear::prescribed(GRIPS, size, imposed.flatten())));
        }
        if known.free_edges {
            conditions.push(balance(FREE_EDGES, edge));
        }
        conditions
    }

    /// Corrects a displacement field at one stretch by the climb, which finds the result by itself: the field
    /// influences only the multipliers, because everything is known.
    ///
    /// # Errors
    /// [`Error::Solve`] when no corrected field was found.
    pub fn climb(
        &self,
        climb: &mut Climb,
        data: &[f64],
        stretch: f64,
    ) -> Result<CorrectedState, Error> {
        let climbed = climb.correct(stretch)?;
        let provenance = climbed.provenance.clone();
        let all = climb.multipliers(data, &climbed, stretch)?;
        let of_condition = |condition: &dyn Condition| {
            let unknowns = condition.unknowns().unwrap_or_default();
            Multipliers {
                name: condition.name().to_owned(),
                values: unknowns.iter().map(|unknown| all[*unknown]).collect(),
                unknowns: Some(unknowns.to_vec()),
            }
        };
        let conditions = self.conditions(stretch, KnownConditions::ALL);
        let multipliers = conditions.iter().map(|c| of_condition(&**c)).collect();
        let field = climbed.field.to_nodes();
        let size = largest(&field);
        let convergence = Convergence {
            residuals: climbed.corrections.iter().map(|z| z / size).collect(),
            ..Convergence::default()
        };
        let model = self.problem.on(self.mesh, &self.energy);
        let state = state_at(&model, self.stage(stretch), field, convergence);
        let mut corrected =
            Self::corrected(&model, state.map_err(at_stretch("corrector", stretch))?);
        corrected.measures.force = climbed.force;
        Ok(CorrectedState {
            multipliers,
            provenance: Some(provenance),
            ..corrected
        })
    }

    /// The results that follow from a corrected state.
    fn corrected(model: &Model, state: State) -> CorrectedState {
        CorrectedState {
            measures: Measures::of(model.mesh, &state),
            state,
            steps: Vec::new(),
            multipliers: Vec::new(),
            provenance: None,
        }
    }
}
