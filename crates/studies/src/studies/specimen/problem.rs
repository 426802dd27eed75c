//! The content of a specimen's study: the problem, its outline and meshes, the measured group.

use std::sync::Arc;

use super::along::Along;
use super::measurements::{MeasuredCurve, Measurements};
use crate::error::Error;
use crate::mass_spring::MassSpring;
use crate::material::Card;
use crate::mesh::{CellShape, Mesh};
use crate::problem::sheet_energy::SheetEnergy;
use crate::problem::{BoundaryProblem, ClampedPlate, Drive, GroupState, Model, Support};
use crate::results::Sheet;
use crate::solve::{LinearSolver, NewtonSettings, Remembering};
use crate::studies::ModelKind;
use crate::studies::pictures::Pictures;
use crate::studies::regions::{NumberedRegion, SheetCards};
use crate::studies::sections::Tolerances;

mod grids;
mod outline;

pub use grids::{GridCorrection, GridElements, HALVINGS, PlateGrids};
pub use outline::Outline;

/// The shape that is read from a file.
pub const MESH: &str = "mesh";

/// When local refinement ends.
#[derive(Clone, Copy)]
pub struct Refinement {
    /// Estimated error in the energy norm in % at the worst load factor.
    pub error_percent: f64,
    /// Cells that are not exceeded.
    pub most_cells: usize,
}

impl Refinement {
    /// Cells up to which all cells of the last mesh are halved, for the error of the displacement.
    pub(super) const MOST_HALVED: usize = 400_000;
}

/// The way in which the springs' field is corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Nested where that is quicker: for corrected fields of a shape that are large.
    Automatic,
    /// Springs on a coarser mesh of the shape, corrected there, from mesh to mesh.
    Nested,
    /// From the lattice's own springs.
    Direct,
}

impl Method {
    /// The names that studies use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("automatic", Self::Automatic),
        ("nested", Self::Nested),
        ("direct", Self::Direct),
    ];
}

/// Unknowns of a corrected field from which on its multipliers are not computed, and nested meshes are quicker.
pub const LARGE: usize = 20_000;

/// How springs and finite elements are solved where the study does not state it.
pub const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// A specimen, its supports and loads, and how finely it is meshed.
#[non_exhaustive]
pub struct Specimen {
    /// For file names.
    pub name: String,
    /// Thickness, material, supports and loads.
    pub problem: BoundaryProblem,
    /// The card of its material; of several that of the cells that belong to no region.
    pub card: Card,
    /// The cards of the problem's regions, with their names.
    pub regions: Vec<(String, Card)>,
    /// The parameter along its path.
    pub along: Along,
    /// Load factors, ascending unless the material has a memory.
    pub factors: Vec<f64>,
    /// The models that are computed.
    pub models: Vec<ModelKind>,
    /// How the springs are solved.
    pub springs_newton: NewtonSettings,
    /// How the finite elements are solved.
    pub elements_newton: NewtonSettings,
    /// The group that is measured.
    pub group: String,
    /// The requirements on the corrected field.
    pub tolerances: Tolerances,
    /// How far the finite elements are refined locally; `None` where they have three meshes.
    pub refinement: Option<Refinement>,
    /// How the springs' field is corrected.
    pub correction: Method,
    /// How the systems of the finite elements are solved.
    pub linear_solver: LinearSolver,
    /// The outline, and how finely it is meshed.
    pub outline: Outline,
    /// The pictures of its fields.
    pub pictures: Pictures,
    /// The measurements within the sheet.
    pub measurements: Measurements,
    /// A measured curve of force that is drawn beside the models; `None` where there is none.
    pub measured_curve: Option<MeasuredCurve>,
}

impl Specimen {
    /// The specimen of another material, such as one made by [`Card::of_law`].
    #[must_use]
    pub fn with_card(mut self, card: Card) -> Self {
        self.problem.law = Arc::clone(&card.law);
        self.card = card;
        self
    }

    /// A step of the path in words: by the only motion or force that grows along it, or by the load factor where there are several.
    pub fn describe_step(&self, step: usize) -> String {
        let factor = self.factors[step];
        let moved: Vec<&Support> = self
            .problem
            .supports
            .iter()
            .map(|(_, support)| support)
            .filter(|support| !support.rests())
            .collect();
        let sizes: Vec<(f64, &str)> = match moved[..] {
            _ if self.along == Along::Stretch || !self.problem.loads.is_empty() => Vec::new(),
            [Support::Displacement(given)] => {
                given.iter().flatten().map(|size| (*size, "mm")).collect()
            }
            [Support::Grip(drives)] => drives
                .iter()
                .map(|drive| match drive {
                    Drive::Displacement(size) => (*size, "mm"),
                    Drive::Force(size) => (*size, "N"),
                })
                .collect(),
            _ => Vec::new(),
        };
        let mut sizes = sizes.into_iter().filter(|(size, _)| *size != 0.0);
        match (sizes.next(), sizes.next()) {
            // Without the rounding of the product.
            (Some((size, unit)), None) => format!("{} {unit}", (1e9 * size * factor).round() / 1e9),
            _ => self.along.describe(factor),
        }
    }

    /// A specimen with all loads at once and the usual settings.
    pub fn of(
        name: &str,
        card: Card,
        problem: BoundaryProblem,
        outline: Outline,
        group: &str,
    ) -> Self {
        Self {
            name: name.into(),
            problem,
            card,
            regions: Vec::new(),
            along: Along::LoadFactor,
            factors: vec![1.0],
            models: ModelKind::ALL.to_vec(),
            springs_newton: NEWTON,
            elements_newton: NEWTON,
            group: group.into(),
            tolerances: Tolerances {
                displacement_percent: 1.0,
                departure_percent: None,
                force_percent: 1.0,
                correction_percent: 1.0,
            },
            refinement: None,
            correction: Method::Automatic,
            linear_solver: LinearSolver::Automatic,
            pictures: Pictures::default(),
            measurements: Measurements::default(),
            measured_curve: None,
            outline,
        }
    }

    /// A specimen on a mesh, as if it had been read from a file.
    pub fn of_mesh(
        card: Card,
        problem: BoundaryProblem,
        mesh: Mesh,
        element: CellShape,
        group: &str,
    ) -> Self {
        let outline = Outline::File {
            mesh: Box::new(mesh),
            element,
            polygons: false,
            halvings: HALVINGS,
        };
        Self::of(MESH, card, problem, outline, group)
    }

    /// Whether a corrected field with so many unknowns comes from nested meshes.
    pub fn is_nested(&self, unknowns: usize) -> bool {
        let able = self.outline.is_shape() && !self.problem.laws().soften();
        able && match self.correction {
            Method::Automatic => unknowns >= LARGE,
            Method::Nested => true,
            Method::Direct => false,
        }
    }

    /// A description of what the study computes.
    pub fn describe(&self) -> String {
        let models: Vec<&str> = self.models.iter().map(|kind| kind.style().name).collect();
        format!(
            "{}; {}; {}",
            self.describe_sheet(),
            self.along.list(self.factors.iter().copied()),
            models.join(", ")
        )
    }

    /// Its shape, thickness and material.
    pub fn describe_sheet(&self) -> String {
        format!(
            "{}, {} mm thick, of the {}",
            self.outline.describe(),
            self.problem.thickness,
            self.describe_cards()
        )
    }

    /// The cards of its cells.
    pub fn cards(&self) -> SheetCards<'_> {
        SheetCards {
            card: &self.card,
            regions: &self.regions,
        }
    }

    /// The regions that have cells, each with its number, its name and its card; empty where all cells have one card.
    pub fn numbered_regions(&self) -> Vec<NumberedRegion<'_>> {
        self.cards().numbered(&self.outline.coarse())
    }

    /// A description of the card, or of the cards with their regions.
    fn describe_cards(&self) -> String {
        let regions = self.numbered_regions().into_iter();
        let regions = regions.map(|(_, name, card)| format!("{} on {name}", card.name));
        match &regions.collect::<Vec<_>>()[..] {
            [] => format!("card {}", self.card.name),
            several => format!("cards {}", several.join(", ")),
        }
    }

    /// How often a computation reports progress: three meshes, springs and corrected field at every load factor.
    pub(super) fn progress_steps(&self) -> usize {
        let of = |kind: &ModelKind| match kind {
            ModelKind::FiniteElement => 1 + self.outline.halvings(),
            ModelKind::MassSpring | ModelKind::Corrected => 1,
        };
        if self.refinement.is_some() {
            return 0;
        }
        self.factors.len() * self.models.iter().map(of).sum::<usize>()
    }

    /// The data that determine its stresses.
    pub fn sheet(&self) -> Sheet<'_> {
        Sheet::elastic(self.problem.laws(), self.problem.thickness)
    }

    /// The plate's grids, where the specimen is one.
    pub fn grids(&self) -> Option<&PlateGrids> {
        match &self.outline {
            Outline::Grid(grids) => Some(grids),
            Outline::Shape { .. } | Outline::File { .. } => None,
        }
    }

    /// The plate between its grips with its grids, where the specimen is one.
    pub fn plate(&self) -> Option<(ClampedPlate, &PlateGrids)> {
        let grids = self.grids()?;
        let plate = ClampedPlate {
            size: grids.size,
            thickness: self.problem.thickness,
            law: Arc::clone(&self.problem.law),
            stretches: self.factors.clone(),
        };
        Some((plate, grids))
    }

    /// Whether a model is computed.
    pub fn computes(&self, model: ModelKind) -> bool {
        self.models.contains(&model)
    }

    /// The springs on the lattice.
    pub fn springs(&self) -> MassSpring {
        match self.plate() {
            Some((plate, grids)) => MassSpring::new(&plate, grids.cells, grids.lattice),
            None => {
                let BoundaryProblem { thickness, .. } = self.problem;
                MassSpring::on_mesh(self.problem.laws(), thickness, self.outline.lattice())
            }
        }
    }

    /// The energy of the corrected fields on their mesh.
    pub fn corrected_energy(&self, mesh: &Mesh) -> SheetEnergy {
        match self.plate() {
            Some((plate, grids)) => grids.correction.scheme.energy(&plate, mesh),
            None => self.problem.finite_elements(mesh),
        }
    }

    /// The problem on a mesh; groups were checked when the study was read. First guesses of a plate are affine.
    pub fn on<'a>(&self, mesh: &'a Mesh, energy: &'a dyn Remembering) -> Result<Model<'a>, Error> {
        if let Some((plate, _)) = self.plate() {
            return Ok(plate.on(mesh, energy));
        }
        Ok(self.problem.on(mesh, energy)?)
    }

    /// All groups that are held, loaded or measured, in the order of the study.
    pub fn groups(&self) -> Vec<&str> {
        let supports = self.problem.supports.iter().map(|(group, _)| group);
        let loads = self.problem.loads.iter().map(|(group, _)| group);
        let mut all: Vec<&str> = Vec::new();
        for group in supports.chain(loads).chain([&self.group]) {
            if !all.contains(&group.as_str()) {
                all.push(group);
            }
        }
        all
    }

    /// The number of the measured group among [`Self::groups`], of which it is one.
    pub fn group_index(&self) -> usize {
        let groups = self.groups();
        let before = groups.iter().take_while(|group| **group != self.group);
        before.count()
    }

    /// The force in N of supports and loads on the measured group in the state of a load factor, whose groups are those of [`Self::groups`].
    pub fn force_on_group(
        &self,
        step: usize,
        mesh: &Mesh,
        u: &[f64],
        groups: &[GroupState],
    ) -> [f64; 2] {
        let load = self
            .problem
            .load_on(mesh, &self.group, (self.factors[step], u));
        let load = load.unwrap_or_default();
        let supports = groups[self.group_index()].force;
        [0, 1].map(|axis| supports[axis] + load[axis])
    }
}
