//! What ū decides: the same corrections from the springs' field and from the affine stretch, side by side.

use super::Fields;
use crate::compare::{departure_percent, displacement_percent};
use crate::corrector::Multipliers;
use crate::corrector::plate::{CorrectedState, KnownConditions};
use crate::error::Error;
use crate::results::Block;
use crate::validation::case::{Check, Outcome, Wanted, number};
use crate::validation::plate::Plate;

/// The grips alone: fewer conditions than unknowns.
const GRIPS: KnownConditions = KnownConditions {
    grips: true,
    free_edges: false,
};

/// Corrections of the springs' field and of the affine stretch with the same conditions.
struct Pair {
    springs: CorrectedState,
    affine: CorrectedState,
}

impl Pair {
    fn new(plate: &Plate, fields: &Fields, known: KnownConditions) -> Result<Self, Error> {
        let corrector = plate.corrector(&fields.lattice);
        let correct = |data: &[f64]| corrector.correct(data, plate.stretch(), known);
        Ok(Self {
            springs: correct(&fields.uncorrected)?,
            affine: correct(&fields.affine)?,
        })
    }

    /// Distance of the fields over the departure from affine of the first, in %.
    fn fields_percent(&self, fields: &Fields) -> f64 {
        let [springs, affine] =
            [&self.springs, &self.affine].map(|state| &state.state.displacement[..]);
        departure_percent(&fields.lattice.mesh, affine, springs, &fields.affine)
    }

    /// Distance of the multipliers over those of the first, in %.
    fn multipliers_percent(&self) -> f64 {
        let values = |all: &[Multipliers]| -> Vec<f64> {
            all.iter()
                .flat_map(|own| own.values.iter().copied())
                .collect()
        };
        let [springs, affine] =
            [&self.springs, &self.affine].map(|state| values(&state.multipliers));
        crate::validation::case::percent(&affine, &springs)
    }

    fn row(&self, name: &str, fields: &Fields) -> Vec<String> {
        let departure =
            |state: &CorrectedState| number(fields.departure(&state.state.displacement));
        vec![
            name.to_owned(),
            number(self.fields_percent(fields)),
            number(self.multipliers_percent()),
            departure(&self.springs),
            departure(&self.affine),
        ]
    }
}

/// With as many conditions as unknowns ū has a say in the multipliers alone; with fewer it decides the field.
pub fn side_by_side(plate: &Plate, fields: &Fields, outcome: &mut Outcome) -> Result<(), Error> {
    let all = Pair::new(plate, fields, KnownConditions::ALL)?;
    let grips = Pair::new(plate, fields, GRIPS)?;
    let head = [
        "known conditions T",
        "fields apart [%]",
        "multipliers apart [%]",
        "from springs, to finite elements [%]",
        "from the affine stretch, to finite elements [%]",
    ];
    outcome.blocks.push(Block::Paragraph(
        "What the springs decide: the same correction once from their field and once from the affine stretch, departure \
         from affine. With as many conditions as unknowns ū has a say in the multipliers alone, with fewer it decides the \
         field (the affine stretch is in equilibrium inside already and stays as it is):"
            .into(),
    ));
    let rows = vec![
        all.row("grips and traction-free edges: as many as unknowns", fields),
        grips.row("grips: fewer than unknowns", fields),
    ];
    outcome.blocks.push(Block::table(&head, rows));
    let far = displacement_percent(
        &fields.lattice.mesh,
        &all.affine.state.displacement,
        &all.springs.state.displacement,
    );
    let check =
        |quantity: &str, wanted, source, value| Check::new(quantity, "%", wanted, source, value);
    outcome.checks.extend([
        check(
            "everything known: corrected from springs and from affine beside each other",
            Wanted::AtMost(1e-6),
            "ū has no say in the field",
            far,
        ),
        check(
            "everything known: their multipliers beside each other",
            Wanted::AtLeast(1.0),
            "ū decides the multipliers",
            all.multipliers_percent(),
        ),
        check(
            "grips alone known: corrected from springs and from affine beside each other",
            Wanted::AtLeast(10.0),
            "ū decides the field",
            grips.fields_percent(fields),
        ),
    ]);
    Ok(())
}
