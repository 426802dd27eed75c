//! How far a motion is from the finite elements', and how far these may be from the truth.

use super::corrected::CorrectedInstants;
use super::problem::MovingPlate;
use super::solution::ModelMotion;
use crate::compare::judgement::percent;
use crate::dynamics::{History, Integrator, Step, TimeSettings, lumped_mass};
use crate::finite_element::convergence::of_distances;
use crate::mesh::Mesh;
use crate::studies::Progress;

/// How far a motion on the lattice is from the finite elements'.
pub struct Deviations {
    /// Of the displacement at each instant, in relative L2 over the largest of all instants, in %.
    pub displacement: Vec<f64>,
    /// Over all instants, in %.
    pub whole: f64,
    /// Of the right grip's force over all instants, root mean squares, in %; `None` where the finite elements' has none.
    pub force: Option<f64>,
}

impl Deviations {
    /// Of fields on the lattice and forces of the right grip, at the first instants, from those of the finite elements.
    fn new<'a>(
        lattice: &Mesh,
        fields: impl Iterator<Item = &'a Vec<f64>>,
        forces: impl Iterator<Item = [f64; 2]>,
        expected: &[Vec<f64>],
        expected_forces: &[[f64; 2]],
    ) -> Self {
        let weights = lumped_mass(lattice, 1.0, 1.0);
        let square = |u: &[f64]| u.iter().zip(&weights).map(|(u, w)| w * u * u).sum::<f64>();
        let errors: Vec<f64> = fields
            .zip(expected)
            .map(|(now, expected)| {
                let both = now.iter().zip(expected);
                square(&both.map(|(u, v)| u - v).collect::<Vec<_>>())
            })
            .collect();
        let sizes: Vec<f64> = expected.iter().map(|u| square(u)).collect();
        let largest = sizes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let displacement = errors.iter().map(|error| 100.0 * (error / largest).sqrt());
        let [all, size] =
            [&errors, &sizes[..errors.len()]].map(|values| values.iter().sum::<f64>());
        let pairs = forces.zip(expected_forces).flat_map(|(now, expected)| {
            [0, 1].map(|axis| ((now[axis] - expected[axis]).powi(2), expected[axis].powi(2)))
        });
        let (wrong, force) = pairs.fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
        Self {
            displacement: displacement.collect(),
            whole: 100.0 * (all / size.max(f64::MIN_POSITIVE)).sqrt(),
            force: (force > 0.0).then(|| 100.0 * (wrong / force).sqrt()),
        }
    }

    /// Those of a model.
    fn of_model(
        lattice: &Mesh,
        model: &ModelMotion,
        expected: &[Vec<f64>],
        expected_forces: &[[f64; 2]],
    ) -> Self {
        let fields = displacements_on(lattice, model);
        let forces = right_forces(model);
        Self::new(lattice, fields.iter(), forces, expected, expected_forces)
    }

    /// Of the springs and of the corrected motion, from the finite elements at the nodes of the lattice.
    pub fn both(
        [springs, elements]: &[ModelMotion; 2],
        corrected: &CorrectedInstants,
        expected: &[Vec<f64>],
    ) -> [Self; 2] {
        let lattice = &springs.mesh;
        let forces: Vec<_> = right_forces(elements).collect();
        let fields = corrected.displacement.iter();
        let of_corrected = corrected.right_force.iter().copied();
        [
            Self::of_model(lattice, springs, expected, &forces),
            Self::new(lattice, fields, of_corrected, expected, &forces),
        ]
    }
}

/// A model's displacements at the nodes of the lattice at all instants.
pub fn displacements_on(lattice: &Mesh, model: &ModelMotion) -> Vec<Vec<f64>> {
    let instants = model.history.instants.iter();
    instants
        .map(|now| model.mesh.displacement_on(&now.displacement, lattice))
        .collect()
}

fn right_forces(model: &ModelMotion) -> impl Iterator<Item = [f64; 2]> + '_ {
    let instants = model.history.instants.iter();
    instants.map(|now| now.support_forces[1])
}

/// The finite elements' own error over all instants, by cells twice and four times as large and by steps half as long.
pub struct OwnError {
    /// Of the displacement, in %.
    pub displacement: f64,
    /// Of the right grip's force, in %.
    pub force: Option<f64>,
    /// Its share by the length of the steps, in % of the displacement; `None` where steps are far shorter than cells need, or half
    /// of them are too many.
    pub by_steps: Option<f64>,
    /// The cells by which it is estimated.
    pub cells: Vec<[usize; 2]>,
}

impl OwnError {
    /// Of the finite elements' motion; `None` where its cells cannot be larger, or larger ones have no solution.
    ///
    /// ```text
    /// e = |u₂ₕ − uₕ|/(2ᵖ − 1) + 4/3 |u₂ₕ(Δt) − u₂ₕ(Δt/2)|      p ≥ 1 from u₄ₕ where cells can be halved twice, else 1
    /// ```
    pub fn of(plate: &MovingPlate, elements: &ModelMotion, progress: Progress) -> Option<Self> {
        let (_, fine) = plate.element;
        let halves = |cells: [usize; 2]| {
            let even = cells.iter().all(|count| count.is_multiple_of(2));
            even.then(|| cells.map(|count| count / 2))
        };
        let larger = halves(fine).unwrap_or(fine.map(|count| count.div_ceil(2)));
        if larger == fine {
            return None;
        }
        let moved = |cells, time| {
            plate
                .elements_moved(cells, time, progress, "finite elements' own error")
                .ok()
        };
        let coarse = moved(larger, plate.time)?;
        let coarsest = halves(fine).and(halves(larger));
        let coarsest = coarsest.and_then(|cells| Some((cells, moved(cells, plate.time)?)));
        let quicker = plate.halved_steps(&coarse.history);
        let quicker = quicker.and_then(|time| moved(larger, time));
        let distance = |a: &ModelMotion, b: &ModelMotion| {
            let (fields, forces) = (
                displacements_on(&elements.mesh, b),
                right_forces(b).collect::<Vec<_>>(),
            );
            let found = Deviations::of_model(&elements.mesh, a, &fields, &forces);
            [Some(found.whole), found.force]
        };
        let last = distance(&coarse, elements);
        let before = coarsest.as_ref().map(|(_, own)| distance(own, &coarse));
        let steps = quicker.as_ref().map(|own| distance(&coarse, own));
        let both = [0, 1].map(|which| {
            let last = last[which]?;
            let before = before.and_then(|own| own[which]);
            // Of waves, coarse cells tell an order that is too low, and any error with it.
            let cells = before.map_or(last, |before| of_distances(before, last).0.min(last));
            let steps = steps.and_then(|own| own[which]).unwrap_or(0.0);
            Some(cells + BY_HALVED_STEPS * steps)
        });
        Some(Self {
            displacement: both[0]?,
            force: both[1],
            by_steps: steps.and_then(|own| Some(BY_HALVED_STEPS * own[0]?)),
            cells: [larger]
                .into_iter()
                .chain(coarsest.map(|(cells, _)| cells))
                .collect(),
        })
    }

    /// In a sentence.
    pub fn describe(&self) -> String {
        let cells = self.cells.iter().map(|[x, y]| format!("{x} × {y}"));
        let by_steps = self.by_steps.map_or_else(String::new, |share| {
            format!(" (of which {} % from the time steps)", percent(share))
        });
        let force = self.force.map_or_else(String::new, |force| {
            format!(", {} % of the right grip's force", percent(force))
        });
        format!(
            "The finite elements' own error over all instants, estimated from {} cells{}: {} % of the displacement{by_steps}{force}.",
            cells.collect::<Vec<_>>().join(" and "),
            self.by_steps.map_or("", |_| " and from steps half as long"),
            percent(self.displacement),
        )
    }
}

/// The error of second order in the steps, over the distance to steps half as long.
const BY_HALVED_STEPS: f64 = 4.0 / 3.0;

impl MovingPlate {
    /// The same time with twice as many steps as a motion took; `None` where the smallest cell's vibration limits them: they are far shorter
    /// then than what is seen of the motion needs.
    fn halved_steps(&self, history: &History) -> Option<TimeSettings> {
        /// A rounding error makes no step more.
        const BARELY: f64 = 1.0 - 1e-9;
        if let (Step::Automatic, Integrator::VelocityVerlet) =
            (self.time.step, self.time.integrator)
        {
            return None;
        }
        let step = history.instants.last()?.time / (2 * history.steps.max(1)) as f64;
        Some(TimeSettings {
            step: Step::AtMost(step / BARELY),
            ..self.time
        })
    }
}
