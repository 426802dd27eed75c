//! A point in one image after another.

use nalgebra::Matrix2;

use super::subset::Match;
use super::warp::Warp;

/// A point of the first image in a later one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracked {
    /// Its place in the first image in pixels.
    pub position: [f64; 2],
    /// Its displacement in pixels.
    pub displacement: [f64; 2],
    /// ∂u/∂X.
    pub gradient: Matrix2<f64>,
    /// The covariance of the displacement in pixels².
    pub covariance: Matrix2<f64>,
    /// The part of the pattern's variance that is found again.
    pub similarity: f64,
}

impl Tracked {
    /// The displacement about the point.
    pub fn warp(&self) -> Warp {
        Warp::affine(self.displacement, self.gradient)
    }
}

/// What is known of a point in the image before.
#[derive(Clone, Copy, Debug)]
pub struct State {
    pub warp: Warp,
    /// The covariance that has been gathered on the way over other images.
    pub covariance: Matrix2<f64>,
    pub similarity: f64,
}

impl State {
    pub fn of(fit: &Match) -> Self {
        Self {
            warp: fit.warp,
            covariance: fit.covariance,
            similarity: fit.similarity,
        }
    }

    pub fn position(&self, point: [usize; 2]) -> [f64; 2] {
        let [u, v] = self.warp.displacement();
        [point[0] as f64 + u, point[1] as f64 + v]
    }

    /// The step from another state to this one, as if it had been matched.
    pub fn since(&self, then: &Self) -> Option<Match> {
        let inverse = then.warp.deformation_gradient().try_inverse()?;
        let ([a, b], [c, d]) = (self.warp.displacement(), then.warp.displacement());
        let gradient = self.warp.deformation_gradient() * inverse - Matrix2::identity();
        Some(Match {
            warp: Warp::affine([a - c, b - d], gradient),
            covariance: Matrix2::zeros(),
            similarity: self.similarity,
            gain: 1.0,
            offset: 0.0,
            misfit: 0.0,
        })
    }

    /// This state and a step from a pixel near its place.
    pub fn followed_by(&self, step: &Match, point: [usize; 2], centre: [usize; 2]) -> Self {
        let [x, y] = self.position(point);
        let [u, v] = step.warp.at(x - centre[0] as f64, y - centre[1] as f64, 6);
        let f = step.warp.deformation_gradient() * self.warp.deformation_gradient();
        Self {
            warp: Warp::affine(
                [x + u - point[0] as f64, y + v - point[1] as f64],
                f - Matrix2::identity(),
            ),
            covariance: self.covariance + step.covariance,
            similarity: step.similarity,
        }
    }

    pub fn tracked(&self, point: [usize; 2]) -> Tracked {
        Tracked {
            position: point.map(|x| x as f64),
            displacement: self.warp.displacement(),
            gradient: self.warp.deformation_gradient() - Matrix2::identity(),
            covariance: self.covariance,
            similarity: self.similarity,
        }
    }
}
