//! The displacement of a pattern between camera images, with its uncertainty from the noise of the pixels.
//!
//! ```text
//! files ─read─▶ GreyImage ─┬─▶ Reference (gradients, usable pixels) ─┐
//!                          └─▶ Spline (cubic B-spline of a frame) ───┼─ match ─▶ Tracked { displacement, covariance }
//! mask or outline ─▶ Region ─▶ grid of points ───────────────────────┘
//! ```
//!
//! Around each point of a grid in the first image, I₀(X) is compared with I₁(x) of a later one, with gain b and offset a of the light:
//!
//! ```text
//! minimise Σ (I₀(X) − a − b I₁(X + u(X)))²,   u(X) = Σₖ pₖ φₖ(X − X₀),   φ = 1, x, y (affine) and x², xy, y² (quadratic)
//! ```
//!
//! All lengths in this module are in pixels, with x to the right, y downwards, and the origin at the centre of the upper left pixel,
//! until [`series`] gives them in mm with y upwards. References: M. A. Sutton, J.-J. Orteu, H. Schreier, *Image Correlation for Shape,
//! Motion and Deformation Measurements*, Springer 2009; S. Baker, I. Matthews, Int. J. Comput. Vis. 56, 221 (2004); B. Pan, Appl. Opt. 48, 1535
//! (2009) for the order in which points are followed.

mod defects;
mod edge;
mod filter;
mod gradient;
mod grey;
mod grid;
mod image_before;
mod matrices;
mod noise;
mod patches;
mod read;
mod region;
mod seed;
mod speckle;
mod spline;
mod subset;
mod track;
mod tracked;
mod warp;

pub use gradient::Reference;
pub use grey::GreyImage;
pub use noise::Noise;
pub use patches::Patches;
pub use read::{ImageFile, in_order, is_image_path, list, of_bytes};
pub use region::Region;
pub use spline::Spline;
pub use track::{Settings, Tracker};
pub use tracked::{Tracked, series};
pub use warp::{Order, Warp};

#[cfg(test)]
mod tests;
