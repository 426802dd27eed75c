//! The corrected plate while its grip is pulled: its climb, ready to follow the grip.

use self_cell::self_cell;

use gelbench::corrector::DifferenceScheme;
use gelbench::corrector::climb::{Climb, ClimbSettings, Grips, Interactive};
use gelbench::error::Error;
use gelbench::problem::ClampedPlate;

use crate::logic::scene::Grip;

self_cell!(
    struct Held {
        owner: ClampedPlate,
        #[not_covariant]
        dependent: Interactive,
    }
);

/// A plate that follows its grip within milliseconds.
pub struct Quick(Held);

/// The stretch that a plate begins at: there is nothing to climb at rest.
const BEGIN: f64 = 0.1;

impl Quick {
    /// Prepares a plate and stretches it a little.
    ///
    /// # Errors
    /// [`Error::Solve`] when no field was found there.
    pub fn begin(plate: &ClampedPlate, cells: [usize; 2]) -> Result<Self, Error> {
        let held = Held::try_new(plate.clone(), |plate| {
            let scheme = DifferenceScheme::default();
            let climb = Climb::even(plate, cells, scheme, ClimbSettings::default());
            Interactive::new(climb, BEGIN)
        });
        held.map(Self)
    }

    /// Moves the right grip; the force on it along X in N.
    ///
    /// # Errors
    /// [`Error::Solve`] when the field cannot follow; the state before is kept.
    pub fn move_to(&mut self, grip: Grip) -> Result<f64, Error> {
        let grips = Grips {
            right: grip,
            ..Grips::default()
        };
        self.0
            .with_dependent_mut(|_, plate| plate.move_grips(grips).map(|state| state.force))
    }

    /// ux, uy of node after node in mm.
    pub fn displacement(&self) -> Vec<f64> {
        self.0
            .with_dependent(|_, plate| plate.state().field.to_nodes())
    }

    /// Where the right grip is.
    pub fn grip(&self) -> Grip {
        self.0.with_dependent(|_, plate| plate.grips().right)
    }
}
