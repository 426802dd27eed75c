//! Axes that are mirrored or exchanged, the commonest mistake with pictures: seen from the mean displacement gradient of the markers.
//!
//! A strip that is pulled narrows. With one component of the displacement mirrored it widens by as much; with both exchanged it shears as
//! nothing does that is pulled, H₂₁ and H₁₂ being the two strains.

use nalgebra::{Matrix2, Vector2};

use crate::markers::Frame;
use crate::material::HyperelasticLaw;
use crate::material::curve::Mode;

/// A strain along the pull below this tells nothing.
const SMALL: f64 = 0.02;

/// How far a strain across the pull may be from that of a strip with free edges, over it: grips hinder it.
const NEAR: f64 = 0.6;

/// How much smaller the other two components of H are.
const BESIDE: f64 = 0.3;

/// The mean of H = ∂u/∂X; `None` where the markers lie on a line.
fn mean_gradient(frame: &Frame) -> Option<Matrix2<f64>> {
    let count = frame.markers.len() as f64;
    let pairs = || {
        frame
            .markers
            .iter()
            .map(|one| (Vector2::from(one.place), Vector2::from(one.displacement)))
    };
    let (place, displacement): (Vec<Vector2<f64>>, Vec<Vector2<f64>>) = pairs().unzip();
    let [place, displacement] =
        [place, displacement].map(|all| all.into_iter().sum::<Vector2<f64>>() / count);
    let (mut squares, mut products) = (Matrix2::zeros(), Matrix2::zeros());
    for (x, u) in pairs() {
        squares += (x - place) * (x - place).transpose();
        products += (u - displacement) * (x - place).transpose();
    }
    Some(products * squares.try_inverse()?)
}

/// What seems wrong with the axes of a frame whose data are not explained, and what to do.
pub fn mistaken(frame: &Frame, law: &dyn HyperelasticLaw) -> Option<(String, &'static str)> {
    let h = mean_gradient(frame)?;
    let across = |along: f64| Some(Mode::Uniaxial.gradient(law, along)?[3]);
    let is_near = |found: f64, expected: f64| (found - expected).abs() < NEAR * expected.abs();
    // Whether the first is a pull, and the second what it would be across.
    let is_pull = |along: f64, other: f64| {
        along > SMALL && across(along).is_some_and(|expected| is_near(other, expected))
    };
    let (straight, turned) = ([h[(0, 0)], h[(1, 1)]], [h[(1, 0)], h[(0, 1)]]);
    let largest = |pair: [f64; 2]| pair[0].abs().max(pair[1].abs());
    let percent = |strain: f64| format!("{:.1} %", 100.0 * strain);
    if largest(turned) < BESIDE * largest(straight) {
        let [x, y] = straight;
        let mirrored = [(x, y, "y"), (y, x, "x")]
            .into_iter()
            .find(|(along, other, _)| is_pull(*along, -other));
        return mirrored.map(|(along, other, axis)| {
            let message = format!(
                "stretched by {}, the markers widen by {} in the transverse direction: displacements along {axis} seem to be mirrored, unless the specimen is \
                 pulled along both axes",
                percent(along),
                percent(other)
            );
            (message, "reverse the sign of that column, or state where y points in the file with `--y-axis`")
        });
    }
    let is_exchanged = is_pull(turned[0], turned[1]) || is_pull(turned[1], turned[0]);
    (largest(straight) < BESIDE * largest(turned) && is_exchanged).then(|| {
        let message = format!(
            "the markers shear by {} and {} and are hardly stretched: displacements along x and y seem to be exchanged",
            percent(turned[0]),
            percent(turned[1])
        );
        (message, "exchange the two columns")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::markers::Marker;
    use crate::material::NeoHooke;

    /// Markers on 6 × 4 places with a displacement of each.
    fn frame(displacement: impl Fn([f64; 2]) -> [f64; 2]) -> Frame {
        let places = (0..24).map(|i| [f64::from(i % 6), f64::from(i / 6)]);
        let markers = places.zip(0..).map(|(place, number)| Marker {
            number,
            place,
            displacement: displacement(place),
            standard_deviation: None,
        });
        Frame {
            number: 1,
            time: None,
            markers: markers.collect(),
        }
    }

    #[test]
    fn mirrored_and_exchanged_axes_are_told_and_other_motions_are_not() {
        let law = NeoHooke { c10: 0.05 };
        let told = |displacement: &dyn Fn([f64; 2]) -> [f64; 2]| {
            mistaken(&frame(displacement), &law).map(|(message, _)| message)
        };
        let mirrored = told(&|[x, y]| [0.3 * x, 0.1 * y]).unwrap();
        assert!(
            mirrored.contains("along y seem to be mirrored"),
            "{mirrored}"
        );
        let along_y = told(&|[x, y]| [0.1 * x, 0.3 * y]).unwrap();
        assert!(along_y.contains("along x seem to be mirrored"), "{along_y}");
        let exchanged = told(&|[x, y]| [-0.1 * y, 0.3 * x]).unwrap();
        assert!(exchanged.contains("seem to be exchanged"), "{exchanged}");
        let (sine, cosine) = 0.4_f64.sin_cos();
        let sound: [&dyn Fn([f64; 2]) -> [f64; 2]; 6] = [
            &|[x, y]| [0.3 * x, -0.12 * y],
            &|[x, y]| [0.3 * x, 0.3 * y],
            &|[x, _]| [0.3 * x, 0.0],
            &|[x, y]| [(cosine - 1.0) * x - sine * y, sine * x + (cosine - 1.0) * y],
            &|[_, y]| [0.4 * y, 0.0],
            &|[x, y]| [-0.2 * x, 0.08 * y],
        ];
        for (number, motion) in sound.into_iter().enumerate() {
            assert_eq!(told(motion), None, "{number}");
        }
    }
}
