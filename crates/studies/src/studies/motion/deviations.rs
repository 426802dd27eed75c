//! Deviations of a motion from the finite elements', and the discretisation error of these.

use super::functions::rates;
use super::problem::MovingSheet;
use super::solution::{ModelMotion, Motions};
use crate::compare::judgement::percent;
use crate::dynamics::{History, Integrator, Step, TimeSettings, lumped_mass};
use crate::finite_element::convergence::of_distances;
use crate::mesh::Mesh;
use crate::solve::vector::difference;
use crate::studies::Progress;

/// The deviations of a motion on the lattice from the finite elements', of all that [`since_start`] says.
pub struct Deviations {
    /// Of the displacement at each instant, in relative L2 over the largest of all instants, in %.
    pub displacement: Vec<f64>,
    /// Over all instants, in %.
    pub total: f64,
    /// Of the right grip's force over all instants, root mean squares, in %; `None` where the finite elements' has none.
    pub force: Option<f64>,
}

impl Deviations {
    /// Of the motion of a model from the finite elements', at the nodes of a lattice and the instants of both.
    fn between(
        sheet: &MovingSheet,
        lattice: &Mesh,
        [model, elements]: [&ModelMotion; 2],
        expected: &[Vec<f64>],
    ) -> Self {
        let weights = lumped_mass(lattice, 1.0, 1.0);
        let square = |u: &[f64]| u.iter().zip(&weights).map(|(u, w)| w * u * u).sum::<f64>();
        let is_change = since_start(sheet);
        let fields = model.displacements_on(lattice);
        let errors: Vec<f64> = measured(is_change, &fields)
            .zip(measured(is_change, expected))
            .map(|(now, expected)| square(&difference(&now, &expected)))
            .collect();
        let sizes: Vec<f64> = measured(is_change, expected).map(|u| square(&u)).collect();
        let largest = sizes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let displacement = errors.iter().map(|error| 100.0 * (error / largest).sqrt());
        let [all, size] =
            [&errors, &sizes[..errors.len()]].map(|values| values.iter().sum::<f64>());
        let [forces, expected_forces] = [model, elements].map(|model| sheet.measured_forces(model));
        let pairs = measured(is_change, &forces)
            .zip(measured(is_change, &expected_forces))
            .flat_map(|(now, expected)| {
                [0, 1].map(|axis| ((now[axis] - expected[axis]).powi(2), expected[axis].powi(2)))
            });
        let (wrong, force) = pairs.fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
        Self {
            displacement: displacement.collect(),
            total: 100.0 * (all / size.max(f64::MIN_POSITIVE)).sqrt(),
            force: (force > 0.0).then(|| 100.0 * (wrong / force).sqrt()),
        }
    }

    /// Of the springs and of the corrected motion, where there is one, from the finite elements at the nodes of the lattice.
    pub fn all(sheet: &MovingSheet, motions: &Motions) -> (Self, Option<Self>) {
        let Motions {
            springs, elements, ..
        } = motions;
        let of = |model: &ModelMotion| {
            let models = [model, elements];
            Self::between(sheet, &springs.mesh, models, &springs.expected)
        };
        (of(springs), motions.correction.motion.as_ref().map(of))
    }
}

/// Whether deviations are of the changes since the start: those of a sheet that its supports hold at a load factor, and that forces or
/// gravity alone set in motion. The state in which it is held is no part of its motion, and may be a hundred times larger.
pub fn since_start(sheet: &MovingSheet) -> bool {
    let is_held = sheet.drive.release.is_none() && rates(&sheet.drive.factor).is_none();
    is_held && !sheet.specimen.factors.is_empty() && sheet.is_loaded()
}

/// Fields or forces at the instants, or their changes since the first.
fn measured<V: AsRef<[f64]>>(is_change: bool, values: &[V]) -> impl Iterator<Item = Vec<f64>> {
    let start = values.first().filter(|_| is_change);
    values.iter().map(move |now| match start {
        Some(start) => difference(now.as_ref(), start.as_ref()),
        None => now.as_ref().to_vec(),
    })
}

/// The finite elements' discretisation error over all instants, estimated from cells twice and four times as large and from steps half as long.
pub struct DiscretisationError {
    /// Of the displacement, in %.
    pub displacement: f64,
    /// Of the right grip's force, in %.
    pub force: Option<f64>,
    /// The share of the time steps, in % of the displacement; `None` where steps are far shorter than cells need, or halved ones are too many.
    pub by_steps: Option<f64>,
    /// Descriptions of the meshes from which it is estimated.
    pub meshes: Vec<String>,
}

impl DiscretisationError {
    /// Of the finite elements' motion; `None` where its cells cannot be larger, or larger ones have no solution.
    ///
    /// ```text
    /// e = |u₂ₕ − uₕ|/(2ᵖ − 1) + 4/3 |u₂ₕ(Δt) − u₂ₕ(Δt/2)|      p ≥ 1 from u₄ₕ where cells can be halved twice, else 1
    /// ```
    pub fn of(sheet: &MovingSheet, elements: &ModelMotion, progress: Progress) -> Option<Self> {
        let moved = |coarser: usize, time| {
            let mesh = sheet.elements_mesh(coarser)?;
            let moved = sheet.elements_moved(&mesh, time, progress, "finite elements' own error");
            moved.ok()
        };
        let coarse = moved(1, sheet.time)?;
        let coarsest = moved(2, sheet.time);
        let quicker = sheet.halved_steps(&coarse.history);
        let quicker = quicker.and_then(|time| moved(1, time));
        let distance = |a: &ModelMotion, b: &ModelMotion| {
            let expected = b.displacements_on(&elements.mesh);
            let deviations = Deviations::between(sheet, &elements.mesh, [a, b], &expected);
            [Some(deviations.total), deviations.force]
        };
        let last = distance(&coarse, elements);
        let before = coarsest.as_ref().map(|motion| distance(motion, &coarse));
        let steps = quicker.as_ref().map(|motion| distance(&coarse, motion));
        let both = [0, 1].map(|which| {
            let last = last[which]?;
            let before = before.and_then(|distances| distances[which]);
            // For waves, coarse cells show an order that is too low, and with it an error that is too large.
            let cells = before.map_or(last, |before| of_distances(before, last).0.min(last));
            let steps = steps.and_then(|distances| distances[which]).unwrap_or(0.0);
            Some(cells + BY_HALVED_STEPS * steps)
        });
        Some(Self {
            displacement: both[0]?,
            force: both[1],
            by_steps: steps.and_then(|distances| Some(BY_HALVED_STEPS * distances[0]?)),
            meshes: [&coarse]
                .into_iter()
                .chain(&coarsest)
                .map(|motion| motion.mesh.describe())
                .collect(),
        })
    }

    /// In a sentence.
    pub fn describe(&self) -> String {
        let by_steps = self.by_steps.map_or_else(String::new, |share| {
            format!(" (of which {} % from the time steps)", percent(share))
        });
        let force = self.force.map_or_else(String::new, |force| {
            format!(", {} % of the force", percent(force))
        });
        format!(
            "The finite elements' own error over all instants, estimated from {}{}: {} % of the displacement{by_steps}{force}.",
            self.meshes.join(" and "),
            self.by_steps.map_or("", |_| " and from steps half as long"),
            percent(self.displacement),
        )
    }
}

/// The error of second order in the steps, over the distance to steps half as long.
const BY_HALVED_STEPS: f64 = 4.0 / 3.0;

impl MovingSheet {
    /// The same time with twice as many steps as a motion took; `None` where the vibration of the smallest cell limits them: they are then far
    /// shorter than the resolved motion needs.
    fn halved_steps(&self, history: &History) -> Option<TimeSettings> {
        /// So that rounding errors do not add a step.
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
