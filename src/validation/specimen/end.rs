//! Paths that end before their last load factor.

use super::read::Specimen;
use crate::error::{Error, SolveFault};
use crate::mesh::Mesh;
use crate::output::{Block, vtk};
use crate::solve::{PathEnd, State};
use crate::validation::{Check, Outcome, Wanted};

/// Where the path of one model ended, and why.
pub struct End {
    model: String,
    step: String,
    fault: SolveFault,
    last: Option<Last>,
}

/// The last equilibrium of a path.
struct Last {
    /// Begin of the file's name.
    file: String,
    mesh: Mesh,
    state: State,
    measured: f64,
    /// Whether it lies between two load factors of the study, so that nothing else holds it.
    between: bool,
}

impl End {
    /// The end of a path at the model with the names `[model, file]`; `measured` is of the last equilibrium.
    pub fn of_path([model, file]: [&str; 2], mesh: &Mesh, end: &PathEnd, measured: f64) -> Self {
        let state = end.last.as_deref().or(end.states.last());
        Self {
            model: model.to_owned(),
            step: end.describe(),
            fault: end.fault.clone(),
            last: state.map(|state| Last {
                file: format!("{file}_end.vtu"),
                mesh: mesh.clone(),
                state: state.clone(),
                measured,
                between: end.last.is_some(),
            }),
        }
    }

    /// An end at a load factor that has no way to it.
    pub fn at(model: &str, factor: f64, fault: SolveFault) -> Self {
        Self {
            model: model.to_owned(),
            step: format!("load factor {factor}"),
            fault,
            last: None,
        }
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

/// The outcome where no load factor was reached by all models: empty, or the fault of the first where not
/// even an equilibrium on the way was found.
pub fn without_state(ends: &[End]) -> Result<Outcome, Error> {
    match ends.first() {
        Some(first) if ends.iter().all(|end| end.last.is_none()) => Err(first.error()),
        _ => Ok(Outcome::default()),
    }
}

/// Adds the ends to an outcome: a requirement that is not met, a row of a table, a file.
pub fn tell(specimen: &Specimen, ends: Vec<End>, outcome: &mut Outcome) {
    let mut rows = Vec::new();
    for end in ends {
        let wanted = Wanted::AtMost(0.0);
        let quantity = format!("{} ({})", end.error(), end.fault.advice());
        let check = Check::new(quantity, "–", wanted, "the whole path", f64::NAN);
        outcome.checks.push(check);
        let Some(last) = end.last else { continue };
        let file = if last.between { &*last.file } else { "–" };
        rows.push(vec![
            end.model,
            format!("{:.4}", last.state.factor),
            format!("{:.5}", last.measured),
            file.to_owned(),
        ]);
        if last.between {
            let displacement = &last.state.displacement;
            let sheet = specimen.sheet();
            let content = vtk::field_file(&specimen.name, &sheet, &last.mesh, displacement, None);
            outcome.vtk.push((last.file, content));
        }
    }
    if !rows.is_empty() {
        let text = "Paths that ended early: the last equilibrium of each, at the largest load factor reached. \
            One between the study's load factors has a file of its own.";
        let measured = specimen.measured();
        let head = vec![
            "model".into(),
            "load factor reached [–]".into(),
            format!("{} [{}]", measured.name(), measured.unit()),
            "file".into(),
        ];
        outcome.blocks.push(Block::Paragraph(text.into()));
        outcome.blocks.push(Block::Table(head, rows));
    }
}
