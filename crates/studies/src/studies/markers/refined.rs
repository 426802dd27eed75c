//! Cells that are small enough for the data.

use super::{MarkerStudy, Request};
use crate::error::{Diagnostic, Error};
use crate::estimation::{FieldEstimate, MOST_REFINED_CELLS};
use crate::material::Card;
use crate::units::decimals;

/// Share of the area on which the discretisation error may be the larger part of the error of stress.
const COARSE: f64 = 0.05;

impl MarkerStudy {
    /// Reads everything but the material, as [`Self::prepare_with`], and halves the cells until, in the frame that moves most, the
    /// discretisation error is the larger part of the error of stress on 5 % of the area at most. Where that would take more cells than can be
    /// refined, a warning states the share that remains.
    ///
    /// # Errors
    /// As [`Self::prepare`] and [`Self::estimate_frame`]; [`Error::Input`] where the mesh is not made inside an outline.
    pub fn prepare_refined(
        card: Card,
        mut request: Request,
        watch: &dyn Fn(&str),
    ) -> Result<Self, Error> {
        let mut study = Self::prepare_with(card.clone(), request.clone(), watch)?;
        loop {
            let Some(size) = study.cell_size else {
                return Err(Error::input(
                    "cells cannot be refined, because the mesh is given",
                    "leave out --refine (refine), or the mesh",
                ));
            };
            watch(&format!("cells of {} mm", decimals(size, 4)));
            let frame = study
                .most_moved()
                .ok_or_else(|| Error::input("there are no frames", "give a field with markers"))?;
            let estimate = study.estimate_frame(frame)?;
            let share = estimate.coarse_share(&study.mesh);
            if share <= COARSE {
                return Ok(study);
            }
            request.cell_size = Some(0.5 * size);
            let finer = if 4 * study.mesh.cell_count() > MOST_REFINED_CELLS {
                let size = decimals(size, 4);
                Err(format!("cells smaller than {size} mm are too many"))
            } else {
                let finer = Self::prepare_with(card.clone(), request.clone(), watch);
                finer.map_err(|fault| fault.to_string())
            };
            match finer {
                Ok(finer) => study = finer,
                Err(reason) => {
                    let coarse = format!(
                        "on {:.0} % of the area, the mesh's discretisation error is still the larger part of the stress error: {reason}",
                        100.0 * share
                    );
                    study.warnings.push(Diagnostic::warning("", coarse));
                    return Ok(study);
                }
            }
        }
    }
}

/// A remark where the mesh rather than the noise makes the intervals of stress wide.
pub(super) fn remark(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Option<String> {
    let frames = field.frames_with(estimates);
    let shares = frames.map(|(frame, estimate)| (frame.number, estimate.coarse_share(&field.mesh)));
    let (number, share) = shares.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (share > COARSE).then(|| {
        let remedy = match field.cell_size {
            Some(size) => format!(
                "cells smaller than {} mm make intervals narrower there (--refine, or --cell-size)",
                decimals(size, 4)
            ),
            None => "a finer mesh makes intervals narrower there".to_owned(),
        };
        format!(
            "In frame {number}, the mesh's discretisation error is the larger part of the stress error on {:.0} % of the area: {remedy}.",
            100.0 * share
        )
    })
}
