//! The units in which pictures are designed.

/// Units of the drawing for each point of the design. plotters rounds to whole units: they must be small.
pub(super) const FINE: u32 = 8;

/// The letters of all pictures.
pub(super) const FAMILY: &str = "sans-serif";

/// Why a picture could not be drawn.
pub(super) type DrawResult<T> = Result<T, Box<dyn std::error::Error>>;

/// Points of the design in units of the drawing.
pub(super) fn units(points: i32) -> i32 {
    points * FINE as i32
}
