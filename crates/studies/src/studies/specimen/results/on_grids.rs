//! The corrected fields of a plate on its grids: by the climb, or by the direct method from the springs' field.

use super::corrected_fields::{Fields, Start};
use super::end::{End, Run};
use crate::corrector::PlateCorrector;
use crate::corrector::climb::Climb;
use crate::corrector::plate::KnownConditions;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::problem::{ClampedPlate, Solution};
use crate::studies::specimen::problem::PlateGrids;

/// Corrects as many stretches as can be, on a mesh to whose nodes the springs' field is interpolated. Where the springs have no field
/// the affine stretch takes its place, on which the multipliers and the start of the direct method depend.
///
/// # Errors
/// Any but [`Error::Solve`], which is an end.
pub fn correct(
    run: &mut Run,
    (plate, grids): (&ClampedPlate, &PlateGrids),
    mesh: &Mesh,
    springs: &Solution,
) -> Result<Fields, Error> {
    let mut fields = Fields::default();
    let settings = &grids.correction;
    let mut corrector = PlateCorrector::new(plate, mesh, settings.scheme, settings.direct);
    let mut climb = settings
        .climb
        .map(|climb| Climb::graded(plate, grids.cells, settings.scheme, settings.grading, climb));
    let onto_mesh = settings
        .is_graded()
        .then(|| springs.mesh.interpolation_on(mesh));
    for (step, stretch) in run.specimen.factors.iter().enumerate() {
        let data = match (springs.displacement(step), &onto_mesh) {
            (Some(field), Some(onto_mesh)) => onto_mesh.apply(field),
            (Some(field), None) => field.to_vec(),
            (None, _) => plate.affine(mesh, *stretch),
        };
        let corrected = match &mut climb {
            Some(climb) => corrector.climb(climb, &data, *stretch),
            None => corrector.correct(&data, *stretch, KnownConditions::ALL),
        };
        let field = match corrected {
            Ok(field) => field,
            Err(Error::Solve { fault, .. }) => {
                run.ends.push(End::at(run.specimen, *stretch, fault));
                break;
            }
            Err(other) => return Err(other),
        };
        run.report_solved("corrector", *stretch);
        corrector = corrector.after(&field.state);
        let start = match springs.displacement(step) {
            Some(_) => Start::Grids,
            None => Start::GridsAlone,
        };
        fields.push(field.state, start, field.multipliers);
        fields.correction.climbs.extend(field.provenance);
    }
    Ok(fields)
}
