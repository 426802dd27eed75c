//! What is known of a specimen besides its displacements: a file, completed by the command line. `default.toml` shows its keys.

use std::path::Path;

use super::area::Area;
use super::machine::{self, ForceColumn, FrameClock, FrameForces};
use super::specimen_file::SpecimenFile;
use crate::error::{Diagnostic, Error, suggestion};
use crate::estimation::{
    EdgeCondition, FORCE_CLASS, Knowledge, MeasuredForce, Physics, RegressedLaw, Robust, Unnamed,
};
use crate::markers::MarkerSeries;
use crate::material::{Card, PlaneState};
use crate::mesh::Mesh;

/// What is known besides the displacements.
#[derive(Clone, Debug, Default)]
pub struct Conditions {
    /// Heading of the report; empty where it is not given.
    pub title: String,
    /// The edges by their names, with what is known of them.
    pub edges: Vec<(String, EdgeCondition)>,
    /// Pads on the sheet by their names.
    pub areas: Vec<(String, Area)>,
    /// Standard deviation of each component of the displacement in mm.
    pub noise: Option<f64>,
    /// How markers with large residuals are weighted; where it is not given, by Tukey's weights if some are farther off than noise can be.
    pub robust: Option<Robust>,
    /// Whether equilibrium holds exactly.
    pub physics: Physics,
    /// The condition of outer edges that are not named.
    pub unnamed: Unnamed,
    /// Measured forces, with the frame where it is stated.
    pub forces: FrameForces,
    /// Whether the measured forces are only compared with the fields, and not used to find them.
    pub forces_are_checks: bool,
    /// Columns of a testing machine's table with forces.
    pub force_columns: Vec<ForceColumn>,
    /// The relation of the frames' times to those of that table.
    pub clock: FrameClock,
    /// Parameters of the law that are estimated with the field.
    pub fit: Vec<String>,
    /// How far inside of the specimen's edge the outermost markers lie, in mm; unknown where it is not given.
    pub edge_gap: Option<f64>,
    /// Relative standard deviation of the scale of the pictures.
    pub scale_deviation: f64,
    /// The cards of regions of the mesh by their names; all other cells have the card of the request.
    pub regions: Vec<(String, Card)>,
    /// Plane stress or plane strain; plane stress where it is not given.
    pub sheet: Option<PlaneState>,
    /// The specimen itself, where the file holds it.
    pub specimen: Option<SpecimenFile>,
}

/// The file that `gelbench new --kind markers` writes.
pub const TEMPLATE: &str = include_str!("default.toml");

/// A measured force; without a standard deviation it has one of 1 %.
pub fn measured_force(
    edge: &str,
    axis: usize,
    force: f64,
    deviation: Option<f64>,
) -> MeasuredForce {
    MeasuredForce {
        edge: edge.to_owned(),
        axis,
        force,
        standard_deviation: deviation.unwrap_or(FORCE_CLASS * force.abs()),
        common_deviation: deviation.map_or(FORCE_CLASS, |_| 0.0),
    }
}

impl Conditions {
    /// Checks that the mesh has the edges that are named, each once.
    ///
    /// # Errors
    /// [`Error::Input`] with every name that is wrong.
    fn check(&self, mesh: &Mesh) -> Result<(), Error> {
        let known: Vec<&str> = mesh.groups().keys().map(String::as_str).collect();
        let mut faults = Vec::new();
        for (index, (name, _)) in self.edges.iter().enumerate() {
            if !known.contains(&&**name) {
                let hint = suggestion(name, &known, "its edges:");
                let fault = Diagnostic::error("", format!("the mesh has no edge `{name}`"));
                faults.push(fault.hint(hint));
            }
            if self.edges[..index].iter().any(|(other, _)| other == name) {
                let fault = Diagnostic::error("", format!("the edge `{name}` has two conditions"));
                faults.push(fault.hint("name it once"));
            }
        }
        Error::refuse(faults)
    }

    /// Leaves out the forces in frames at rest, gives edges with a measured force and no condition an unknown one, and checks that the mesh
    /// has all edges and the series all frames.
    ///
    /// # Errors
    /// [`Error::Input`] with edges that are missing or named twice, or the first force that belongs to no frame.
    pub fn suit(&mut self, mesh: &Mesh, series: &MarkerSeries) -> Result<(), Error> {
        let is_kept =
            |frame: &Option<usize>| frame.is_none_or(|number| !series.at_rest.contains(&number));
        self.forces.retain(|(frame, _)| is_kept(frame));
        for (_, force) in &self.forces {
            if !self.edges.iter().any(|(name, _)| *name == force.edge) {
                self.edges
                    .push((force.edge.clone(), EdgeCondition::Unknown));
            }
        }
        self.check(mesh)?;
        self.check_frames(series)
    }

    /// Checks that each force belongs to one frame, which must be the only one where none is stated.
    ///
    /// # Errors
    /// [`Error::Input`] with the first force that belongs to no frame.
    fn check_frames(&self, series: &MarkerSeries) -> Result<(), Error> {
        let numbers: Vec<usize> = series.frames.iter().map(|frame| frame.number).collect();
        let belongs = |frame: &Option<usize>| match frame {
            None => numbers.len() == 1,
            Some(number) => numbers.contains(number),
        };
        let Some((frame, force)) = self.forces.iter().find(|(frame, _)| !belongs(frame)) else {
            return Ok(());
        };
        let edge = &force.edge;
        let fault = match frame {
            None => format!(
                "there are {} frames, but the force on `{edge}` does not state in which it was measured",
                numbers.len()
            ),
            Some(number) => format!(
                "there is no frame {number}, in which the force on `{edge}` is stated to be measured"
            ),
        };
        let all: Vec<String> = numbers.iter().map(usize::to_string).collect();
        let hint = format!(
            "state it in the file of --study, with `frame = {}` under [[force]], or correct one frame alone; frames: {}",
            all.last().map_or("", String::as_str),
            all.join(", ")
        );
        Err(Error::input(fault, hint))
    }

    /// Takes the forces of a testing machine's table; returns a warning about frames without one.
    ///
    /// # Errors
    /// As [`machine::forces`]; [`Error::Input`] when columns are named and there is no table.
    pub(super) fn take_forces(
        &mut self,
        table: Option<&Path>,
        series: &MarkerSeries,
    ) -> Result<Option<Diagnostic>, Error> {
        match (table, self.force_columns.first()) {
            (None, None) => Ok(None),
            (None, Some(first)) => Err(Error::input(
                format!(
                    "the force on `{}` is to be read from the column `{}`, but no table is given",
                    first.edge, first.column
                ),
                "name the testing machine's table with --forces FILE",
            )),
            (Some(path), _) => {
                let (forces, warning) =
                    machine::forces(path, &self.force_columns, series, self.clock)?;
                self.forces.extend(forces);
                Ok(warning)
            }
        }
    }

    /// A warning about known conditions of measurements, where the field is a computed one.
    pub(super) fn ignored_for_computed_fields(&self) -> Option<Diagnostic> {
        let stated = [
            ("noise", self.noise.is_some()),
            ("robust", self.robust.is_some()),
            ("scale_error", self.scale_deviation > 0.0),
            ("edge_gap", self.edge_gap.is_some()),
            ("physics", self.physics != Physics::default()),
            ("force", !self.forces.is_empty()),
            ("fit", !self.fit.is_empty()),
        ];
        let ignored = stated.iter().filter(|(_, is_stated)| *is_stated);
        let keys: Vec<&str> = ignored.map(|(key, _)| *key).collect();
        let message = format!(
            "a field that is transferred from its own mesh to another one is treated as computed, without noise; ignored: {}",
            keys.join(", ")
        );
        let hint = "give a measured field as a table of its markers: x, y, ux, uy";
        (!keys.is_empty()).then(|| Diagnostic::warning("", message).hint(hint))
    }

    /// The law with parameters to be estimated, if there are any.
    ///
    /// # Errors
    /// [`Error::Input`] when the card has no such parameters.
    pub fn regressed_law(&self, card: &Card) -> Result<Option<RegressedLaw>, Error> {
        let keys: Vec<&str> = self.fit.iter().map(String::as_str).collect();
        let regressed = (!keys.is_empty()).then(|| RegressedLaw::of_card(card, &keys));
        Ok(regressed.transpose()?)
    }

    /// The conditions of a frame's estimate; the law is regressed only in frames with a force.
    pub fn knowledge(&self, frame: usize, law: Option<&RegressedLaw>) -> Knowledge {
        let is_of_frame = |number: Option<usize>| number.is_none_or(|number| number == frame);
        let of_frame = self.forces.iter().filter(|(of, _)| is_of_frame(*of));
        let forces: Vec<_> = of_frame.map(|(_, force)| force.clone()).collect();
        Knowledge {
            edges: self.edges.clone(),
            scale_deviation: self.scale_deviation,
            unnamed: self.unnamed,
            noise: self.noise,
            robust: self.robust.unwrap_or_default(),
            physics: self.physics,
            law: law
                .filter(|_| !forces.is_empty() || self.forces.is_empty())
                .cloned(),
            forces,
            forces_are_checks: self.forces_are_checks,
            ..Knowledge::default()
        }
    }
}
