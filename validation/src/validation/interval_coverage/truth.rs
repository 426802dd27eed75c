//! Converged finite elements, and markers read from them.

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::error::Error;
use crate::markers::Marker;
use crate::material::HyperelasticLaw;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::mesh::Mesh;
use crate::problem::ClampedPlate;
use crate::problem::{BoundaryProblem, Support};
use crate::validation::plate::NEWTON;

/// A specimen pulled between clamps at its sides `left` and `right`.
pub struct Truth {
    /// Its mesh, which no estimate uses.
    pub mesh: Mesh,
    /// Its law.
    pub law: Arc<dyn HyperelasticLaw>,
    displacement: Vec<f64>,
    /// The force in N.
    pub force: f64,
}

/// Markers with noise.
pub struct Markers {
    /// The markers.
    pub markers: Vec<Marker>,
    /// Which of them have a gross error.
    pub wrong: Vec<bool>,
}

impl Truth {
    /// Solves the specimen of the plate's material with its ends pulled apart.
    pub fn new(mesh: Mesh, plate: &ClampedPlate, stretch: f64) -> Result<Self, Error> {
        let [length, _] = mesh.size();
        let clamp = |x: f64| Support::Displacement([Some(x), Some(0.0)]);
        let clamps = vec![
            ("left".into(), clamp(0.0)),
            ("right".into(), clamp(stretch * length)),
        ];
        let problem = BoundaryProblem::supported(plate.thickness, Arc::clone(&plate.law), clamps);
        let energy = problem.finite_elements(&mesh);
        let model = problem.on(&mesh, &energy)?.named("finite elements");
        let state = model.reach(&[1.0], NEWTON)?;
        let force = model.reaction(&state, "right")[0];
        drop(model);
        Ok(Self {
            law: problem.law,
            mesh,
            displacement: state.displacement,
            force,
        })
    }

    /// The displacement at a place in mm.
    pub fn displacement(&self, position: [f64; 2]) -> [f64; 2] {
        self.mesh.displacement_at(&self.displacement, position)
    }

    /// First Piola–Kirchhoff stress at a place in MPa.
    pub fn stress(&self, position: [f64; 2]) -> Option<[f64; 4]> {
        let (cell, local) = self.mesh.locate(position);
        self.stress_of(self.mesh.gradient_at(&self.displacement, cell, local))
    }

    /// First Piola–Kirchhoff stress of a displacement gradient; nothing where a cell is turned inside out.
    pub fn stress_of(&self, gradient: [f64; 4]) -> Option<[f64; 4]> {
        let kinematics = Kinematics::new(&PlaneTensor::from(gradient)).ok()?;
        Some(self.law.stress(&kinematics).1.into())
    }

    /// The places of a grid of markers over the specimen; those in a hole are left out.
    pub fn positions(&self, counts: [usize; 2]) -> Vec<[f64; 2]> {
        self.grid(counts, &|index, count| index / (count - 1.0))
    }

    /// The same, half a spacing inside of the specimen's box.
    pub fn places_inside(&self, counts: [usize; 2]) -> Vec<[f64; 2]> {
        self.grid(counts, &|index, count| (index + 0.5) / count)
    }

    fn grid(&self, counts: [usize; 2], share: &dyn Fn(f64, f64) -> f64) -> Vec<[f64; 2]> {
        let [low, high] = self.mesh.bounding_box();
        let line = |axis: usize, index: usize| {
            let share = share(index as f64, counts[axis] as f64);
            low[axis] + share * (high[axis] - low[axis])
        };
        let grid = (0..counts[0]).flat_map(|i| (0..counts[1]).map(move |j| (i, j)));
        grid.map(|(i, j)| [line(0, i), line(1, j)])
            .filter(|position| self.mesh.outside(*position) < 1e-6)
            .collect()
    }

    /// Markers with normal noise in mm, a share of them with a gross error of 6 to 40 times the noise in any direction.
    pub fn markers(&self, positions: &[[f64; 2]], noise: f64, outliers: f64, seed: u64) -> Markers {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let (mut markers, mut wrong) = (Vec::new(), Vec::new());
        for (number, position) in positions.iter().enumerate() {
            let mut displacement = self.displacement(*position);
            for value in &mut displacement {
                let draw: f64 = StandardNormal.sample(&mut random);
                *value += noise * draw;
            }
            let is_wrong = random.random::<f64>() < outliers;
            let angle = std::f64::consts::TAU * random.random::<f64>();
            let size = noise * (6.0 + 34.0 * random.random::<f64>());
            if is_wrong {
                displacement[0] += size * angle.cos();
                displacement[1] += size * angle.sin();
            }
            wrong.push(is_wrong);
            markers.push(Marker {
                number,
                position: *position,
                displacement,
                standard_deviation: None,
            });
        }
        Markers { markers, wrong }
    }
}
