//! The work on a material with a memory.

/// The work on a body, and what it has become.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// What can be had back by unloading, in mJ.
    pub stored: f64,
    /// What softening has dissipated, in mJ.
    pub dissipated: f64,
}
