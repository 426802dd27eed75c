//! What ū decides: the same corrections from the springs' field and from the affine stretch, side by side.

use super::fields::{Fields, GRIPS};
use crate::compare::{departure_percent, displacement_percent};
use crate::corrector::plate::{CorrectedState, KnownConditions};
use crate::error::Error;
use crate::validation::case::{Block, Outcome, check, percent, row, table};

/// Corrections of the springs' field and of the affine stretch with the same conditions.
struct Pair {
    springs: CorrectedState,
    affine: CorrectedState,
}

impl Pair {
    fn new(fields: &Fields, known: KnownConditions) -> Result<Self, Error> {
        Ok(Self {
            springs: fields.correct(&fields.uncorrected, known)?,
            affine: fields.correct(&fields.affine, known)?,
        })
    }

    /// The fields from the springs and from the affine stretch.
    fn displacements(&self) -> [&[f64]; 2] {
        [&self.springs, &self.affine].map(|state| &state.state.displacement[..])
    }

    /// Distance of the fields over the departure from affine of the first, in %.
    fn fields_percent(&self, fields: &Fields) -> f64 {
        let [springs, affine] = self.displacements();
        departure_percent(&fields.lattice.mesh, affine, springs, &fields.affine)
    }

    /// Distance of the multipliers over those of the first, in %.
    fn multipliers_percent(&self) -> f64 {
        let [springs, affine] = [&self.springs, &self.affine].map(|state| {
            let values = state
                .multipliers
                .iter()
                .map(|multiplier| &multiplier.values[..]);
            values.collect::<Vec<_>>().concat()
        });
        percent(&affine, &springs)
    }

    fn row(&self, name: &str, fields: &Fields) -> Vec<String> {
        let [springs, affine] = self.displacements().map(|field| fields.departure(field));
        let apart = [self.fields_percent(fields), self.multipliers_percent()];
        row(name, [apart[0], apart[1], springs, affine])
    }
}

/// With as many conditions as unknowns ū has a say in the multipliers alone; with fewer it decides the field.
pub fn compare(fields: &Fields, outcome: &mut Outcome) -> Result<(), Error> {
    let all = Pair::new(fields, KnownConditions::ALL)?;
    let grips = Pair::new(fields, GRIPS)?;
    let head = "known conditions T | difference of the fields [%] | difference of the multipliers [%] | from springs, to \
                finite elements [%] | from the affine stretch, to finite elements [%]";
    let text = "Influence of the springs: the same correction of their field and of the affine stretch, departure from \
         affine. With as many conditions as unknowns, ū affects only the multipliers; with fewer it determines the field \
         (the affine stretch already satisfies equilibrium inside and stays unchanged):";
    let rows = vec![
        all.row("grips and traction-free edges: as many as unknowns", fields),
        grips.row("grips: fewer than unknowns", fields),
    ];
    outcome
        .blocks
        .extend([Block::paragraph(text), table(head, rows)]);
    let [springs, affine] = all.displacements();
    let far = displacement_percent(&fields.lattice.mesh, affine, springs);
    let adjacent = "field corrected from springs compared with field corrected from affine";
    outcome.checks.extend([
        check(format!("everything known: {adjacent}"), "%", far)
            .at_most(1e-6, "ū does not affect the field"),
        check(
            "everything known: multipliers of the two fields compared",
            "%",
            all.multipliers_percent(),
        )
        .at_least(1.0, "ū determines the multipliers"),
        check(
            format!("grips alone known: {adjacent}"),
            "%",
            grips.fields_percent(fields),
        )
        .at_least(10.0, "ū determines the field"),
    ]);
    Ok(())
}
