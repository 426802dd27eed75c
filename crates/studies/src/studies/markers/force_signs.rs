//! Whether measured forces have the sign that the strain of the markers shows.

use super::machine::FrameForces;
use crate::error::{Diagnostic, Error};
use crate::estimation::MeasuredForce;
use crate::markers::{Frame, MarkerSeries};
use crate::material::HyperelasticLaw;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::mesh::Mesh;

/// Components of the mean stress that are smaller than this part of the largest do not determine a sign.
const CLEAR: f64 = 0.5;

/// Refuses forces that push where the mean strain of their frame is that of a pull, or the other way round. This is judged where the mean stress,
/// that of the linear field nearest to the markers, has a large component along the force, and where the edge of the force lies at one end of
/// the specimen along that axis.
///
/// # Errors
/// [`Error::Input`] with every such force.
pub fn check(
    forces: &FrameForces,
    series: &MarkerSeries,
    mesh: &Mesh,
    law: &dyn HyperelasticLaw,
) -> Result<(), Error> {
    let faults = forces.iter().filter_map(|(number, force)| {
        let mut frames = series.frames.iter();
        let frame = frames.find(|frame| number.is_none_or(|number| number == frame.number))?;
        let expected = expected_sign(force, frame, mesh, law)?;
        (expected * force.force < 0.0).then(|| wrong_sign(force, expected))
    });
    let faults: Vec<Diagnostic> = faults.collect();
    Error::refuse(faults)
}

fn wrong_sign(force: &MeasuredForce, expected: f64) -> Diagnostic {
    let (edge, axis) = (&force.edge, ["x", "y"][force.axis]);
    let size = force.force.abs();
    let [sign, side] = if expected < 0.0 {
        ["-", "-"]
    } else {
        ["", "+"]
    };
    let message = format!(
        "the force on `{edge}` is {} N along {axis}, but the markers show that the grip acts on the specimen towards {side}{axis}",
        force.force,
    );
    let hint = format!(
        "a force is positive along the axis: write {sign}{size} N; if the sign is intended, the displacements have the reversed sign, or their axes or the name of the edge are wrong"
    );
    Diagnostic::error("", message).hint(hint)
}

/// The sign of the force of a grip on its edge; `None` where the markers do not show it clearly.
fn expected_sign(
    force: &MeasuredForce,
    frame: &Frame,
    mesh: &Mesh,
    law: &dyn HyperelasticLaw,
) -> Option<f64> {
    let axis = force.axis;
    let nodes = &mesh.groups().get(&force.edge)?.nodes;
    let mean = nodes
        .iter()
        .map(|node| mesh.nodes[*node][axis])
        .sum::<f64>()
        / nodes.len() as f64;
    let [low, high] = mesh.bounding_box();
    let side = (2.0 * mean - low[axis] - high[axis]) / (high[axis] - low[axis]);
    let h = frame.mean_gradient()?;
    let kinematics = Kinematics::new(&PlaneTensor::new(h.m11, h.m12, h.m21, h.m22)).ok()?;
    let (_, stress) = law.stress(&kinematics);
    let along = stress[3 * axis];
    let clear = side.abs() > 0.9 && along.abs() > CLEAR * stress.amax() && along != 0.0;
    clear.then(|| along.signum() * side.signum())
}
