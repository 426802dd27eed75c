//! The load factors of a study, and the group that is measured.

use super::supports::check_group;
use crate::budget::Need;
use crate::document::{Bound, Section};
use crate::mesh::Mesh;

/// The load factors and the measured group.
pub fn read_path(path: &Section, remembers: bool) -> (Vec<f64>, String) {
    let factors = read_factors(path, remembers);
    let group = path.text("measured_group");
    path.unknown_keys();
    let need = Need {
        instants: factors.len() as f64,
        ..Need::default()
    };
    path.affords("factors", need, "take fewer");
    (factors, group)
}

/// Load factors above the first may be percentages, above the second they hardly are anything else.
const LARGE_FACTORS: [f64; 2] = [5.0, 10.0];

/// The load factors, ascending unless the material remembers how it was loaded.
fn read_factors(path: &Section, remembers: bool) -> Vec<f64> {
    let bound = if remembers {
        Bound::NonNegative
    } else {
        Bound::Positive
    };
    let factors = path.multiples("factors", bound, f64::INFINITY);
    if factors.contains(&0.0) {
        let hint =
            "at rest there is nothing to solve; to unload, take a small factor, such as 0.001";
        path.fault("factors", "must be greater than zero", hint);
        return factors;
    }
    let falls = factors.windows(2).any(|pair| {
        if remembers {
            pair[1] == pair[0]
        } else {
            pair[1] <= pair[0]
        }
    });
    if remembers && falls {
        let message = "must differ from one to the next";
        path.fault("factors", message, "such as [0.5, 1.0, 0.5]");
        return factors;
    }
    if path.has("factors") && (factors.is_empty() || falls) {
        let message = "must be one or more ascending load factors";
        let hint =
            "such as [0.5, 1.0]; only a card with `[softening]` depends on the loading history";
        path.fault("factors", message, hint);
    }
    let largest = factors.iter().copied().fold(0.0, f64::max);
    if largest > LARGE_FACTORS[0] {
        let message = format!(
            "{largest} means {} % of the stated loads and motions",
            100.0 * largest
        );
        let hint = format!(
            "write \"{largest} %\" if percent is meant; otherwise state larger loads instead"
        );
        if largest > LARGE_FACTORS[1] {
            path.fault("factors", &message, &hint);
        } else {
            path.warning("factors", &message, &hint);
        }
    }
    factors
}

/// Records a measured group that the specimen does not have.
pub fn check_measured(path: &Section, group: &str, mesh: &Mesh) {
    if path.has("measured_group") {
        check_group(path, "measured_group", group, mesh);
    }
}
