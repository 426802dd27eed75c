//! Point forces of a sheet in motion.

use crate::document::{Bound, Section};
use crate::dynamics::TimeFunction;
use crate::studies::motion::problem::PointForce;
use crate::studies::points::{Region, read_point, tables};
use crate::units::Dimension;

fn read_force(section: &Section, region: Option<&Region>) -> PointForce {
    let force = ["x", "y"].map(|axis| section.quantity(axis, Dimension::Force, Bound::Any));
    let time = if section.has("begin") || section.has("end") {
        let begin = section.optional_quantity("begin", Dimension::Time, Bound::NonNegative);
        let begin = begin.unwrap_or(0.0);
        let end = section.quantity("end", Dimension::Time, Bound::NonNegative);
        if end <= begin {
            section.fault("end", "must be after the begin", "give a later time");
        }
        TimeFunction::Ramp { begin, end }
    } else {
        TimeFunction::Constant(1.0)
    };
    let force = PointForce {
        at: read_point(section, "at", region),
        force,
        time,
    };
    section.unknown_keys();
    force
}

/// All point forces.
pub fn read_forces(root: &Section, region: Option<&Region>) -> Vec<PointForce> {
    tables(root, "force", |one| read_force(one, region))
}
