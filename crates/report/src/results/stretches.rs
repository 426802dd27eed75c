//! The principal stretches of a sheet beside those at which its card was calibrated.

use nalgebra::Matrix2;

use crate::material::curve::Mode;
use crate::material::{Card, HyperelasticLaw, PlaneState};
use crate::mesh::Mesh;

/// The share of the area that may lie beyond the range of a card, or be unlike the rest: beside a clamped corner stretches have no bound.
pub const BESIDE_CORNERS: f64 = 0.01;

/// Stretches are outside of the range from this multiple of its limit on: the middle of a sheet that is pulled to the limit by clamped ends
/// exceeds it by up to 1.5 %.
const OUTSIDE: f64 = 1.02;

/// The share of the area outside of the range that is worth a warning: of a sheet twice as long as wide that clamped ends pull to the limit,
/// the corners, with stretches without bound, are 2 %.
const WORTH_A_WARNING: f64 = 0.05;

/// The principal stretches in the plane at the centres of the cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretches {
    /// The smallest one.
    pub smallest: f64,
    /// The largest one.
    pub largest: f64,
    /// The share of the area at rest outside of the range.
    pub share: f64,
}

impl Stretches {
    /// The stretches of a displacement field in some cells of a mesh beside the range of a card.
    ///
    /// A card of tests from λ₁ to λ₂ has seen principal stretches in the plane between the smallest and the largest of both and of those
    /// across the samples, λ₁^−½ and λ₂^−½ where the volume stays as it is.
    pub fn new(card: &Card, (mesh, cells): (&Mesh, &[usize]), displacement: &[f64]) -> Self {
        let [low, high] = card.stretch_range;
        let [above, below] = [low, high].map(|along| across(&*card.law, along));
        let (least, most) = (low.min(below), high.max(above));
        let mut all = Self {
            smallest: f64::INFINITY,
            largest: 0.0,
            share: 0.0,
        };
        let (mut outside, mut total) = (0.0, 0.0);
        for cell in cells.iter().copied() {
            let centre = mesh.shape(cell).centre();
            let [xx, xy, yx, yy] = mesh.gradient_at(displacement, cell, centre);
            let stretches = Matrix2::new(1.0 + xx, xy, yx, 1.0 + yy).singular_values();
            let excess = (stretches.max() / most).max(least / stretches.min());
            let area = mesh.cell_area(cell);
            total += area;
            if excess > OUTSIDE {
                outside += area;
            }
            all.smallest = all.smallest.min(stretches.min());
            all.largest = all.largest.max(stretches.max());
        }
        all.share = outside / total;
        all
    }

    /// The reason for a warning about the stretches at `load`, such as ` at 30 % stretch`; `None` where at most corners are outside of the range.
    pub fn reason(&self, card: &Card, load: &str) -> Option<String> {
        let [low, high] = card.stretch_range;
        (card.range_is_stated && self.share > WORTH_A_WARNING).then(|| {
            format!(
                "principal stretches in the plane reach {:.3} … {:.3}{load}; on {:.1} % of the area they are outside the range of the card `{}` (by more than {:.0} %), which \
                 was calibrated from λ = {low} to {high}{}",
                self.smallest,
                self.largest,
                100.0 * self.share,
                card.name,
                100.0 * (OUTSIDE - 1.0),
                card.in_tests()
            )
        })
    }
}

/// The stretch across a strip that is stretched along the sheet's first axis; in plane strain, of which the tests of cards are not, at constant
/// volume.
fn across(law: &dyn HyperelasticLaw, along: f64) -> f64 {
    let free = match law.plane_state() {
        PlaneState::Stress => Mode::Uniaxial.gradient(law, along - 1.0),
        PlaneState::Strain => None,
    };
    free.map_or(along.powf(-0.5), |gradient| 1.0 + gradient[3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::NeoHooke;
    use crate::material::body::BodySheet;
    use crate::material::{FoamTerm, OgdenHill};
    use crate::mesh::CellShape;
    use crate::results::displacements;
    use std::sync::Arc;

    #[test]
    fn what_tests_have_seen_is_their_stretch_and_the_contraction_across() {
        let mesh = Mesh::plate([4.0, 1.0], [4, 2], CellShape::Quad4);
        let cells: Vec<usize> = (0..mesh.cell_count()).collect();
        let card = |range| Card::of_law("gel", Arc::new(NeoHooke { c10: 0.05 }), range);
        let of = |range, [along, across]: [f64; 2]| {
            let u = displacements(&mesh, |[x, y]| [(along - 1.0) * x, (across - 1.0) * y]);
            Stretches::new(&card(range), (&mesh, &cells), &u)
        };
        let tension = [1.0, 1.21];
        // A clamped sheet that is pulled to the limit exceeds it in its middle by this much.
        assert_eq!(of(tension, [1.015 * 1.21, 0.9]).share, 0.0);
        assert_eq!(of(tension, [1.2, 1.2_f64.powf(-0.5)]).share, 0.0);
        assert_eq!(of(tension, [1.3, 1.0]).share, 1.0);
        assert_eq!(of(tension, [1.0, 0.85]).share, 1.0);
        // Pressed to 0.64, a sample becomes wider by 1.25.
        let pressed = [0.64, 1.0];
        assert_eq!(of(pressed, [1.24, 0.7]).share, 0.0);
        let outside = of(pressed, [1.3, 0.7]);
        assert!(outside.share == 1.0);
        let message = outside.reason(&card(pressed), " at load factor 1").unwrap();
        assert!(
            message.contains("0.700 … 1.300 at load factor 1; on 100.0 % of the area"),
            "{message}"
        );
        // A foam without Poisson's ratio keeps its width, so that a pressed sample is not wider.
        let foam = FoamTerm {
            modulus: 0.1,
            exponent: 8.0,
            volume_exponent: 0.0,
        };
        let foam = OgdenHill { terms: vec![foam] };
        let foam = Arc::new(BodySheet::new(foam, PlaneState::Stress));
        let foam = Card::of_law("foam", foam, [0.4, 1.0]);
        let pulled = displacements(&mesh, |[x, _]| [0.5 * x, 0.0]);
        assert_eq!(Stretches::new(&foam, (&mesh, &cells), &pulled).share, 1.0);
        // A turn stretches nothing.
        let turned = displacements(&mesh, |[x, y]| [-y - x, x - y]);
        let rotated = Stretches::new(&card(tension), (&mesh, &cells), &turned);
        assert!(rotated.share == 0.0 && (rotated.largest - 1.0).abs() < 1e-12);
    }
}
