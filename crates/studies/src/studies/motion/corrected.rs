//! The springs' motion, corrected in time.

use web_time::Instant as Clock;

use super::between::cubic;
use super::problem::MovingSheet;
use super::solution::{Correction, ModelMotion};
use crate::budget::Need;
use crate::corrector::motion::{EquationOfMotion, WindowSettings};
use crate::dynamics::{EnergyBalance, History, Instant, Motion, SheetViscosity, Viscosity};
use crate::error::{Error, SolveFault};
use crate::mesh::Mesh;
use crate::studies::{ModelKind, Progress};
use crate::units::number;

/// The instants that are written, from the displacements at all steps: an interval has `within` steps of `step` s.
///
/// # Errors
/// [`SolveFault::Inverted`].
fn instants(
    motion: &Motion,
    fine: &[Vec<f64>],
    within: usize,
    step: f64,
) -> Result<Vec<Instant>, SolveFault> {
    // The start alone is no motion.
    let count = if fine.len() > within { fine.len() } else { 0 };
    let marks = motion.marks(step * count as f64);
    let marks: Vec<f64> = marks.iter().map(|mark| mark / step).collect();
    let instant = |i: usize| {
        let velocity = match i {
            0 => motion.start.velocity.clone(),
            _ => velocity(fine, i, step, &marks),
        };
        // Where a velocity jumps, the forces are those before, as in the other models.
        let [time, before] = [0.0, 0.5].map(|back| step * (i as f64 - back));
        let support_forces = motion.support_forces(time, before, [&fine[i], &velocity])?;
        Ok(Instant {
            time,
            displacement: fine[i].clone(),
            velocity,
            acceleration: Vec::new(),
            energy: EnergyBalance::default(),
            support_forces,
        })
    };
    (0..count).step_by(within).map(instant).collect()
}

/// The least number of steps in a period of the first longitudinal vibration.
const STEPS: f64 = 200.0;
/// β of Newmark's average acceleration.
const AVERAGE_ACCELERATION: f64 = 0.25;

impl MovingSheet {
    /// The steps of the correction and the memory of its fields: the springs' at all steps, on their mesh and on that of the corrected
    /// motion, the corrected ones and the multipliers. Nothing where the motion is not corrected.
    pub(super) fn need_of_correction(&self) -> Need {
        const FIELDS: f64 = 4.0;
        let is_late = self.drive.release.is_some_and(|time| time > 0.0);
        if !self.is_corrected || is_late || !self.viscosity.relaxation.is_empty() {
            return Need::default();
        }
        let nodes: f64 = match self.specimen.grids() {
            Some(grids) => grids.cells.iter().map(|cells| (cells + 1) as f64).product(),
            None => self.specimen.outline.lattice().nodes.len() as f64,
        };
        let steps = STEPS * self.time.duration * self.bar_frequency();
        Need {
            steps,
            bytes: FIELDS * 8.0 * 2.0 * nodes * steps,
            ..Need::default()
        }
    }

    /// Corrects the motion of the springs on the mesh of the corrected field; only a note where the equation of motion cannot be written for three
    /// consecutive instants.
    pub fn correct(&self, springs: &ModelMotion, progress: Progress) -> Result<Correction, Error> {
        let uncorrected = |note: String| Correction {
            note,
            ..Correction::default()
        };
        if !self.is_corrected {
            let note = "The study disables the correction of the motion.";
            return Ok(uncorrected(note.into()));
        }
        let clock = Clock::now();
        let mesh = self.corrected_mesh();
        let energy = self.specimen.problem.finite_elements(&mesh);
        let viscosity = SheetViscosity::new(&energy, &self.viscosity);
        let viscosity = (!self.viscosity.is_none()).then_some(&viscosity as &dyn Viscosity);
        let model = self.specimen.on(&mesh, &energy)?.named("corrector");
        let model = model.describing(|element| format!("cell {element}"));
        let motion = self.motion(&model, viscosity)?;
        let interval = self.time.interval;
        let frequency = springs.frequency.unwrap_or_else(|| self.bar_frequency());
        let within = (STEPS * interval * frequency).ceil().max(1.0) as usize;
        let step = interval / within as f64;
        let equation = match EquationOfMotion::new(&motion, step, AVERAGE_ACCELERATION) {
            Ok(equation) => equation,
            Err(reason) => {
                let note = format!("The motion of the springs is not corrected: {reason}.");
                return Ok(uncorrected(note));
            }
        };
        let onto_mesh = springs.mesh.interpolation_on(&mesh);
        let data: Vec<Vec<f64>> = between(springs.instants(), within)
            .iter()
            .map(|field| onto_mesh.apply(field))
            .collect();
        let report = |count: usize| progress.tell(&self.at("corrector", step * (count - 1) as f64));
        let (corrected, fault) =
            match equation.correct(&data, &motion.start, self.windows(), &report) {
                Ok(corrected) => (corrected, None),
                Err(end) => (*end.corrected, Some(end.fault)),
            };
        let reached = step * (corrected.displacement.len() - 1) as f64;
        let error = |step: String, fault| Error::Solve {
            model: model.name.clone(),
            step,
            fault,
        };
        let instants = instants(&motion, &corrected.displacement, within, step);
        let instants =
            instants.map_err(|fault| error("the force of the supports".into(), fault))?;
        let end = fault.map(|fault| error(format!("time {} s", number(reached)), fault));
        Ok(Correction {
            note: format!(
                "The corrector moves the springs' motion to the nearest motion that satisfies the sheet's equation of motion at every three \
                 consecutive instants, with {within} steps per interval: {} Newton steps, {} factorisations. Because the start is known, the result \
                 does not depend on the springs.",
                corrected.iterations, corrected.factorisations
            ),
            motion: (!instants.is_empty()).then(|| self.corrected(&mesh, instants, clock)),
            end,
        })
    }

    /// The corrected motion on its mesh; its computing time is that since `clock` was started.
    fn corrected(&self, mesh: &Mesh, instants: Vec<Instant>, clock: Clock) -> ModelMotion {
        ModelMotion {
            kind: ModelKind::Corrected,
            mesh: mesh.clone(),
            groups: self.measured_states(mesh, &instants),
            history: History {
                instants,
                ..History::default()
            },
            end: None,
            frequency: None,
            seconds: clock.elapsed().as_secs_f64(),
            viscous: Vec::new(),
            expected: Vec::new(),
        }
    }

    /// The mesh of the corrected motion: elements of the second degree on about as many nodes as the lattice, where a plate has even numbers of
    /// cells; else of the first.
    fn corrected_mesh(&self) -> Mesh {
        let mesh = self.specimen.outline.corrected_mesh();
        match self.specimen.grids() {
            Some(grids) => grids.correction.scheme.mesh(&mesh),
            None => mesh,
        }
    }

    /// The settings of the correction in time.
    fn windows(&self) -> WindowSettings {
        let [length, width] = self.specimen.outline.size();
        WindowSettings {
            steps: 20,
            tolerance: 1e-9,
            max_iterations: 20,
            size: length.max(width),
        }
    }
}

/// The displacements at the instants and `within` − 1 times between each two of equal distance, by cubics through
/// displacements and velocities.
fn between(instants: &[Instant], within: usize) -> Vec<Vec<f64>> {
    let Some(first) = instants.first() else {
        return Vec::new();
    };
    let mut fields = vec![first.displacement.clone()];
    let interval = instants
        .get(1)
        .map_or(0.0, |second| second.time - first.time);
    for pair in instants.windows(2) {
        let length = pair[1].time - pair[0].time;
        if (length - interval).abs() > 1e-6 * interval {
            break;
        }
        fields.extend((1..=within).map(|part| hermite(pair, part as f64 / within as f64)));
    }
    fields
}

fn hermite(pair: &[Instant], s: f64) -> Vec<f64> {
    let [from, to] = [&pair[0], &pair[1]];
    let value = |unknown: usize| {
        let ends = [from, to].map(|end| [end.displacement[unknown], end.velocity[unknown]]);
        cubic(s, to.time - from.time, ends)
    };
    (0..from.displacement.len()).map(value).collect()
}

/// Differences of second order: central ones, and at the end and beside a mark (in steps), where velocities jump, those of one side. At a
/// mark they are those before it.
fn velocity(fields: &[Vec<f64>], instant: usize, step: f64, marks: &[f64]) -> Vec<f64> {
    const ROUNDING: f64 = 1e-6;
    let jumps = |after: f64, before: f64| {
        let mut marks = marks.iter().map(|mark| mark - instant as f64);
        marks.any(|mark| after < mark && mark < before)
    };
    let is_last = instant + 1 == fields.len();
    let weights: &[(isize, f64)] = match [jumps(-1.0, -ROUNDING), jumps(-ROUNDING, 1.0)] {
        [_, ahead] if (ahead || is_last) && instant >= 2 => &[(0, 1.5), (-1, -2.0), (-2, 0.5)],
        [_, ahead] if ahead || is_last => &[(0, 1.0), (-1, -1.0)],
        [true, _] if instant + 2 < fields.len() => &[(0, -1.5), (1, 2.0), (2, -0.5)],
        _ => &[(1, 0.5), (-1, -0.5)],
    };
    let value = |unknown: usize| {
        let terms = weights.iter().map(|(by, weight)| {
            let field = &fields[instant.saturating_add_signed(*by)];
            weight * field[unknown] / step
        });
        terms.sum()
    };
    (0..fields[instant].len()).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_keep_a_cubic_motion_and_stop_at_an_interval_of_another_length() {
        let position = |t: f64| 1.0 + t - 2.0 * t * t + 0.5 * t * t * t;
        let speed = |t: f64| 1.0 - 4.0 * t + 1.5 * t * t;
        let instant = |time: f64| Instant {
            time,
            displacement: vec![position(time)],
            velocity: vec![speed(time)],
            acceleration: vec![0.0],
            energy: crate::dynamics::EnergyBalance::default(),
            support_forces: Vec::new(),
        };
        let instants = [0.0, 0.5, 1.0, 1.2].map(instant);
        let fields = between(&instants, 5);
        assert_eq!(fields.len(), 11);
        for (i, field) in fields.iter().enumerate() {
            assert!((field[0] - position(0.1 * i as f64)).abs() < 1e-14, "{i}");
        }
        let computed = velocity(&fields, 5, 0.1, &[]);
        assert!((computed[0] - speed(0.5)).abs() < 6e-3);
    }

    /// The motion |t − mark|, with the mark at various points within a step; at the mark the velocity is the one before it.
    #[test]
    fn velocities_do_not_mix_both_sides_of_a_jump() {
        for mark in [4.5, 5.0, 5.3, 6.0 - 1e-9] {
            let fields: Vec<Vec<f64>> = (0..=10)
                .map(|i| vec![(f64::from(i) - mark).abs()])
                .collect();
            for instant in 3..=10 {
                let computed = velocity(&fields, instant, 1.0, &[mark])[0];
                let expected = if instant as f64 - 1e-6 > mark {
                    1.0
                } else {
                    -1.0
                };
                assert!(
                    (computed - expected).abs() < 1e-8,
                    "{mark} {instant}: {computed}"
                );
            }
        }
    }
}
