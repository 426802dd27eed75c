use nalgebra::{Matrix2, Vector2};

#[expect(dead_code, reason = "a weave is for the tests of corrected images")]
mod patterns;
mod render;

use super::*;
use patterns::{Pattern, natural, speckle, tags};
use render::Camera;

/// A homogeneous deformation x = m + F (X − m) + t about the middle of an image.
struct Homogeneous {
    f: Matrix2<f64>,
    middle: Vector2<f64>,
    shift: Vector2<f64>,
}

impl Homogeneous {
    fn new(size: [usize; 2], f: Matrix2<f64>, shift: [f64; 2]) -> Self {
        Self {
            f,
            middle: Vector2::new(size[0] as f64 / 2.0, size[1] as f64 / 2.0),
            shift: shift.into(),
        }
    }

    fn material(&self, x: [f64; 2]) -> [f64; 2] {
        (self.middle
            + self.f.try_inverse().unwrap() * (Vector2::from(x) - self.middle - self.shift))
            .into()
    }

    fn displacement(&self, x: [f64; 2]) -> [f64; 2] {
        let arm = Vector2::from(x) - self.middle;
        (self.f * arm - arm + self.shift).into()
    }
}

/// How well a known displacement is found.
#[derive(Debug)]
struct Accuracy {
    /// Root mean square of the errors in pixels.
    error: f64,
    /// The share of components within 1.96 standard deviations.
    covered: f64,
    /// The share of points inside of the frame that are found.
    followed: f64,
}

impl Accuracy {
    /// Of points at `positions` in images of a size with a known displacement.
    fn new(
        tracked: &[Option<Tracked>],
        positions: &[[f64; 2]],
        size: [usize; 2],
        truth: &dyn Fn([f64; 2]) -> [f64; 2],
    ) -> Self {
        const MARGIN: f64 = 15.0;
        let (mut squares, mut within, mut count, mut seen) = (0.0, 0.0, 0.0, 0.0);
        for (tracked, position) in tracked.iter().zip(positions) {
            let [u, v] = truth(*position);
            let inside = |at: f64, length: usize| at > MARGIN && at < length as f64 - 1.0 - MARGIN;
            let is_seen = inside(position[0] + u, size[0]) && inside(position[1] + v, size[1]);
            seen += f64::from(u8::from(is_seen));
            let Some(tracked) = tracked.filter(|_| is_seen) else {
                continue;
            };
            count += 1.0;
            for (axis, true_value) in [u, v].into_iter().enumerate() {
                let off = tracked.displacement[axis] - true_value;
                squares += off * off;
                let is_within = off.abs() <= 1.96 * tracked.covariance[(axis, axis)].sqrt();
                within += f64::from(u8::from(is_within));
            }
        }
        Self {
            error: (squares / (2.0 * count)).sqrt(),
            covered: within / (2.0 * count),
            followed: count / seen,
        }
    }
}

/// A pattern that was followed from one image into another.
struct Followed {
    other: GreyImage,
    tracker: Tracker,
    tracked: Vec<Option<Tracked>>,
}

impl Followed {
    /// From the first camera's frame at rest to the second one's, in which `material` gives the material point that is seen at a position.
    fn new(
        pattern: &Pattern,
        cameras: [Camera; 2],
        material: impl Fn([f64; 2]) -> [f64; 2] + Sync,
    ) -> Self {
        let first = cameras[0].frame(pattern, |x| x);
        let other = cameras[1].frame(pattern, material);
        let region = Region::full(first.size());
        let mut tracker = Tracker::new(&first, &other, &region, Settings::default()).unwrap();
        let tracked = tracker.follow(&other).unwrap();
        Self {
            other,
            tracker,
            tracked,
        }
    }

    fn accuracy(&self, truth: &dyn Fn([f64; 2]) -> [f64; 2]) -> Accuracy {
        let positions = self.tracker.positions().iter();
        let centres: Vec<[f64; 2]> = positions
            .map(|position| position.map(|x| x as f64))
            .collect();
        Accuracy::new(&self.tracked, &centres, self.other.size(), truth)
    }
}

fn follow(pattern: &Pattern, cameras: [Camera; 2], motion: &Homogeneous) -> Accuracy {
    let followed = Followed::new(pattern, cameras, |x| motion.material(x));
    followed.accuracy(&|x| motion.displacement(x))
}

fn cameras(size: [usize; 2], noise: f64) -> [Camera; 2] {
    [Camera::new(size, noise, 1), Camera::new(size, noise, 2)]
}

#[test]
fn small_motions_are_followed_with_intervals_that_hold() {
    let size = [300, 300];
    let gradients = [
        ("shift", Matrix2::identity()),
        ("stretch", Matrix2::new(1.05, 0.0, 0.0, 0.98)),
        ("shear", Matrix2::new(1.0, 0.1, 0.0, 1.0)),
    ];
    for (name, f) in gradients {
        for (kind, pattern) in [("speckle", speckle(1)), ("natural", natural(2))] {
            for noise in [0.01, 0.1] {
                let motion = Homogeneous::new(size, f, [0.37, -1.61]);
                let accuracy = follow(&pattern, cameras(size, noise), &motion);
                let case = format!("{name} {kind} {noise}: {accuracy:?}");
                assert!(accuracy.followed > 0.97 && accuracy.error < 0.1, "{case}");
                assert!((0.90..=0.985).contains(&accuracy.covered), "{case}");
            }
        }
    }
}

/// The error of affine subsets is larger than the noise where the displacement is curved.
#[test]
fn intervals_hold_where_the_strain_varies() {
    let size = [300, 300];
    let wave = |y: f64| 3.0 * (y / 25.0).sin();
    for pattern in [speckle(1), natural(2)] {
        let followed = Followed::new(&pattern, cameras(size, 0.02), |[x, y]| [x - wave(y), y]);
        let accuracy = followed.accuracy(&|[_, y]| [wave(y), 0.0]);
        assert!((0.88..0.99).contains(&accuracy.covered), "{accuracy:?}");
    }
}

#[test]
fn patches_share_no_pixel_and_their_intervals_hold() {
    let size = [400, 400];
    let large = Matrix2::new(1.2, 0.1, 0.0, 0.9);
    // Tags repeat: no point may move by half of their distance.
    let small = Matrix2::new(1.01, 0.005, 0.0, 0.99);
    for (kind, pattern, f) in [
        ("speckle", speckle(3), large),
        ("natural", natural(4), large),
        ("tags", tags(10.0), small),
    ] {
        for noise in [0.02, 0.1] {
            let motion = Homogeneous::new(size, f, [1.3, 2.2]);
            let followed = Followed::new(&pattern, cameras(size, noise), |x| motion.material(x));
            let patches = followed.tracker.patches();
            let about = |point: usize| Some(followed.tracked[point]?.warp());
            let measured = patches.measure(&patches.spline(&followed.other), &about);
            let truth = |x| motion.displacement(x);
            let positions: Vec<[f64; 2]> = measured
                .iter()
                .map(|one| one.map_or([0.0; 2], |one| one.position))
                .collect();
            let accuracy = Accuracy::new(&measured, &positions, size, &truth);
            // Tags have edges sharper than a pixel, between which no interpolation is exact.
            let holds = kind == "tags" || (0.88..=0.985).contains(&accuracy.covered);
            let case = format!("{kind} {noise}: {accuracy:?}");
            assert!(holds && accuracy.error < 0.3, "{case}");
        }
    }
}

#[test]
fn large_motions_are_found_without_a_guess() {
    let size = [400, 400];
    let turn = |degrees: f64| nalgebra::Rotation2::new(degrees.to_radians()).into_inner();
    let motions = [
        ("turned by 35°", turn(35.0), [5.0, 3.0]),
        (
            "stretched to 2",
            Matrix2::new(2.0, 0.0, 0.0, 0.71),
            [3.0, -2.0],
        ),
        (
            "turned and stretched",
            turn(-50.0) * Matrix2::new(1.5, 0.0, 0.0, 0.8),
            [0.0, 9.0],
        ),
        ("shifted", Matrix2::identity(), [61.3, -47.9]),
    ];
    for (name, f, shift) in motions {
        let motion = Homogeneous::new(size, f, shift);
        let accuracy = follow(&speckle(5), cameras(size, 0.01), &motion);
        let is_found = accuracy.followed > 0.95 && accuracy.error < 0.05;
        assert!(is_found, "{name}: {accuracy:?}");
    }
}

#[test]
fn noise_that_grows_light_that_changes_and_a_megapixel() {
    let size = [1000, 1000];
    let mut cameras = cameras(size, 0.03);
    for camera in &mut cameras {
        camera.photons = true;
    }
    cameras[1].light = [0.75, 1.1];
    let motion = Homogeneous::new(size, Matrix2::new(1.08, 0.03, 0.0, 0.97), [2.0, 1.0]);
    let accuracy = follow(&speckle(7), cameras, &motion);
    let is_covered = (0.90..=0.985).contains(&accuracy.covered);
    assert!(accuracy.followed > 0.97 && is_covered, "{accuracy:?}");
}
