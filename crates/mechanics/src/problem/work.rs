//! The work on a material with a memory.

/// The work done on a body, stored and dissipated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// The energy that unloading recovers, in mJ.
    pub stored: f64,
    /// The energy that softening has dissipated, in mJ.
    pub dissipated: f64,
}
