//! Fields that are computed, not measured.

use super::conditions::Conditions;
use crate::error::Diagnostic;
use crate::estimation::Physics;

/// A warning about what is told of measurements, where the field is a computed one, which has none.
pub fn told(conditions: &Conditions) -> Option<Diagnostic> {
    let told = [
        ("noise", conditions.noise.is_some()),
        ("robust", conditions.robust.is_some()),
        ("scale_error", conditions.scale_deviation > 0.0),
        ("edge_gap", conditions.edge_gap.is_some()),
        ("physics", conditions.physics != Physics::default()),
        ("force", !conditions.forces.is_empty()),
        ("fit", !conditions.fit.is_empty()),
    ];
    let told = told.iter().filter(|(_, told)| *told);
    let told: Vec<&str> = told.map(|(key, _)| *key).collect();
    let message = format!(
        "a field that is transferred from its own mesh to another one is treated as computed, without noise; ignored: {}",
        told.join(", ")
    );
    let hint = "give a measured field as a table of its markers: x, y, ux, uy";
    (!told.is_empty()).then(|| Diagnostic::warning("", message).hint(hint))
}
