//! What all parts of a picture are made with.

/// Why a picture could not be drawn, in the words of a library.
pub(super) type DrawResult<T> = Result<T, Box<dyn std::error::Error>>;

/// Width and height in points of the design.
pub(super) type Size = (u32, u32);
