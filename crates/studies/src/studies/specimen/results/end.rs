//! Paths that end before their last load factor.

use super::measured::Measured;
use crate::error::{Error, SolveFault};
use crate::mesh::Mesh;
use crate::problem::{GroupState, Model};
use crate::results::{Block, Grid, GridSeries, Outcome};
use crate::solve::{PathEnd, State};
use crate::studies::Progress;
use crate::studies::specimen::problem::Specimen;
use crate::units::decimals;

/// A specimen whose models are computed one after the other, and where their paths have ended so far.
pub struct Run<'a> {
    pub specimen: &'a Specimen,
    pub progress: Progress<'a>,
    pub ends: Vec<End>,
}

impl<'a> Run<'a> {
    pub fn new(specimen: &'a Specimen, progress: Progress<'a>) -> Self {
        Self {
            specimen,
            progress,
            ends: Vec::new(),
        }
    }

    /// A separate run for auxiliary meshes, whose ends are not reported.
    pub fn unreported(&self) -> Self {
        Self::new(self.specimen, self.progress)
    }

    /// Reports that a model is solved at a load factor.
    pub fn report_solved(&self, model: &str, factor: f64) {
        let at = self.specimen.along.describe(factor);
        self.progress.tell(&format!("{model}, {at}"));
    }
}

/// Where the path of one model ended, and why.
pub struct End {
    model: String,
    step: String,
    fault: SolveFault,
    last: Option<Last>,
}

/// The last equilibrium of a path.
struct Last {
    /// The beginning of its file's name.
    file: String,
    mesh: Mesh,
    state: State,
    groups: Vec<GroupState>,
    /// Whether it lies between two load factors of the study, so that it is in no other file.
    between: bool,
    /// The fields before, where the material remembers them.
    past: Vec<Vec<f64>>,
}

impl End {
    /// The end of the path of a model; `file` is what its file's name begins with.
    pub fn of_path(specimen: &Specimen, model: &Model, file: &str, end: &PathEnd) -> Self {
        let state = end.last.as_deref().or(end.states.last());
        Self {
            model: model.name.clone(),
            step: specimen.along.describe_end(end),
            fault: end.fault.clone(),
            last: state.map(|state| Last {
                file: format!("{file}_end"),
                mesh: model.mesh.clone(),
                groups: model.reactions(state).at_groups(&specimen.groups()),
                state: state.clone(),
                between: end.last.is_some(),
                past: if specimen.problem.laws().soften() {
                    let states = end.states.iter();
                    states.map(|state| state.displacement.clone()).collect()
                } else {
                    Vec::new()
                },
            }),
        }
    }

    /// An end of the corrected field at a load factor that could not be reached.
    pub fn at(specimen: &Specimen, factor: f64, fault: SolveFault) -> Self {
        Self {
            model: "corrector".to_owned(),
            step: specimen.along.describe(factor),
            fault,
            last: None,
        }
    }

    /// Whether it is the end of a model of this name.
    pub fn is_of(&self, model: &str) -> bool {
        self.model == model
    }

    /// Whether not one equilibrium was found on the way.
    pub fn is_empty(&self) -> bool {
        self.last.is_none()
    }

    /// The end as an error.
    pub fn error(&self) -> Error {
        Error::Solve {
            model: self.model.clone(),
            step: self.step.clone(),
            fault: self.fault.clone(),
        }
    }
}

/// The groups in the last equilibrium of any path that ended, for the choice of what is measured.
pub fn last_groups(ends: &[End]) -> Option<(&Mesh, &[GroupState])> {
    let last = ends.iter().rev().find_map(|end| end.last.as_ref())?;
    Some((&last.mesh, &last.groups))
}

/// Adds the ends to an outcome: a requirement that is not met, a row of a table, a file.
pub fn report(specimen: &Specimen, measured: &Measured, ends: Vec<End>, outcome: &mut Outcome) {
    let mut rows = Vec::new();
    for end in ends {
        outcome.ended(&end.error());
        let Some(last) = end.last else { continue };
        let file = if last.between {
            format!("{}.vtu", last.file)
        } else {
            "–".to_owned()
        };
        rows.push(vec![
            end.model,
            format!("{:.4}", specimen.along.coordinate(last.state.factor)),
            end.fault.to_string(),
            decimals(measured.of(&last.groups), 5),
            file,
        ]);
        if last.between {
            let past: Vec<&[f64]> = last.past.iter().map(Vec::as_slice).collect();
            let sheet = specimen.sheet().after(&past);
            let grid = Grid::sheet(sheet, &last.mesh, &last.state.displacement);
            outcome.grids.push(GridSeries::single(&last.file, grid));
        }
    }
    if !rows.is_empty() {
        let text = "Paths that ended early: the last equilibrium of each, at the largest load reached. An equilibrium between the study's loads has \
                    a file of its own. The other models continued.";
        let what = format!("{} [{}]", measured.describe(), measured.unit());
        let head = [
            "model",
            &format!("reached: {}", specimen.along.head()),
            "why it ended",
            &what,
            "file",
        ];
        outcome.blocks.push(Block::Paragraph(text.into()));
        outcome.blocks.push(Block::table(&head, rows));
    }
}
