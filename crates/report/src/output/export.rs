//! A boundary-value problem exported to Abaqus, CalculiX or FEBio, so that it can be solved by a code that is
//! already trusted.
//!
//! What the codes share is worked out here once: node sets of the named groups, what holds which nodes, nodal
//! forces, loaded edges, the law. A writer puts it into words.
//!
//! | gelbench | goes out as |
//! |---|---|
//! | load factor s | one step for each: the total time is the load factor while it grows, else the way that it went |
//! | softening | `*MULLINS EFFECT` of Abaqus |
//! | clamp, displacement, roller, symmetry | prescribed on a node set |
//! | grip with a given force | nodes that follow one of them (`*EQUATION`), which takes the force; not for FEBio |
//! | rotation | prescribed node by node, in steps of 30° at most for Abaqus and CalculiX |
//! | traction, force (dead) | nodal forces of the finite elements |
//! | pressure | pressure on the edges, which follows them |
//! | incompressible sheet | plane stress, or one layer of solids over half the thickness (FEBio) |

use crate::error::Error;
use crate::material::Code;

mod abaqus;
mod febio;
mod model;
mod sofa;
mod text;
mod xml;

pub use model::Export;
use model::Model;
pub use sofa::Scene;
pub use text::InputFile;

impl Export<'_> {
    /// The problem as an input file of a code.
    ///
    /// # Errors
    /// [`Error::Input`] when the code lacks the law, or when a support or a load cannot be expressed in it.
    pub fn input_file(&self, code: Code) -> Result<InputFile, Error> {
        let model = Model::new(self, code)?;
        let text = match code {
            Code::Abaqus | Code::CalculiX => abaqus::write(&model),
            Code::FeBio => febio::write(&model),
        };
        Ok(InputFile {
            text,
            remarks: model.remarks(),
        })
    }
}

#[cfg(test)]
mod tests;
