//! Newton's method in time with a known start: windows, a retained factor, and multipliers.

use super::{EquationOfMotion, Interval};
use crate::dynamics::Start;
use crate::error::SolveFault;
use crate::solve::Cholesky;
use crate::solve::vector::{add_scaled, difference, largest, spread};
use crate::statistics::larger;

/// Settings of the correction of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowSettings {
    /// Steps of time that are corrected together; fewer where that fails.
    pub steps: usize,
    /// Largest residual relative to the largest force.
    pub tolerance: f64,
    /// Newton steps allowed for a window.
    pub max_iterations: usize,
    /// The size of the body in mm: forces of tiny strains are rounding of its stiffness times this size.
    pub size: f64,
}

/// A corrected motion.
#[derive(Clone, Debug)]
pub struct CorrectedMotion {
    /// The displacement at every instant, in mm.
    pub displacement: Vec<Vec<f64>>,
    /// The multipliers of the equation that determines each instant, zero at the first and where unknowns are held, in
    /// mm²/N: where and when ū contradicts the equation of motion.
    pub multipliers: Vec<Vec<f64>>,
    /// Newton steps of all windows.
    pub iterations: usize,
    /// Factorisations.
    pub factorisations: usize,
    /// Windows that were corrected.
    pub windows: usize,
}

/// The end of a correction before the last instant.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{fault}")]
pub struct CorrectionEnd {
    /// The fault.
    pub fault: SolveFault,
    /// The instants before it.
    pub corrected: Box<CorrectedMotion>,
}

/// Consecutive instants of a motion that is being corrected.
struct Window {
    /// The number of the first instant, which is known.
    first: usize,
    /// The first row: 0 at the start, else 1.
    begin: usize,
    states: Vec<Vec<f64>>,
}

/// The factor of ∂F/∂u of the newest instant.
struct RetainedFactor {
    cholesky: Cholesky,
    fresh: bool,
    factorisations: usize,
}

impl RetainedFactor {
    /// Sets the factor of a matrix.
    fn take(&mut self, values: &[f64]) -> Result<(), SolveFault> {
        let factor = self.cholesky.factorise(values);
        factor.map_err(|fault| fault.or(SolveFault::NotPositiveDefinite))?;
        self.fresh = true;
        self.factorisations += 1;
        Ok(())
    }
}

/// A factor is renewed when the residual after an iteration exceeds this share of the one before.
const SLOW_CONVERGENCE: f64 = 0.2;

/// A residual that stagnates below this share of the forces is rounding.
const ROUNDING_FLOOR: f64 = 1e-8;

/// Forces below this share of the body's stiffness times its size count as so large: next to those of a motion that has hardly begun,
/// rounding of the strains is large.
const LEAST_FORCE: f64 = 2e-6;

impl EquationOfMotion<'_> {
    /// Corrects a motion that is given at instants from time 0 on, with a known start; `progress` is called with the number of corrected instants.
    ///
    /// # Errors
    /// [`CorrectionEnd`] with the instants before it when a window of a single step fails.
    pub fn correct(
        &self,
        data: &[Vec<f64>],
        start: &Start,
        settings: WindowSettings,
        progress: &dyn Fn(usize),
    ) -> Result<CorrectedMotion, CorrectionEnd> {
        let size = self.motion.energy.unknowns();
        let mut corrected = CorrectedMotion {
            displacement: vec![self.all_unknowns(0, &self.free(&start.displacement))],
            multipliers: vec![vec![0.0; size]],
            iterations: 0,
            factorisations: 0,
            windows: 0,
        };
        match self.correct_onwards(data, start, settings, progress, &mut corrected) {
            Ok(()) => Ok(corrected),
            Err(fault) => Err(CorrectionEnd {
                fault,
                corrected: Box::new(corrected),
            }),
        }
    }

    /// Corrects the remaining instants, window after window.
    fn correct_onwards(
        &self,
        data: &[Vec<f64>],
        start: &Start,
        settings: WindowSettings,
        progress: &dyn Fn(usize),
        corrected: &mut CorrectedMotion,
    ) -> Result<(), SolveFault> {
        let mut retained = RetainedFactor {
            cholesky: self.assembly.analyse()?,
            fresh: false,
            factorisations: 0,
        };
        let velocity = self.free(&start.velocity);
        let largest_stiffness = self.largest_stiffness(&start.displacement);
        let least_force = LEAST_FORCE * settings.size * largest_stiffness;
        let mut steps = settings.steps.max(1);
        while corrected.displacement.len() < data.len() {
            let done = corrected.displacement.len();
            let count = steps.min(data.len() - done);
            let mut window = self.window(&corrected.displacement, data, count);
            let solved = self.solve(&mut window, &velocity, &mut retained, settings, least_force);
            corrected.factorisations = retained.factorisations;
            match solved {
                Ok((interval, iterations)) => {
                    self.append(&window, data, &interval, &mut retained, corrected)?;
                    corrected.iterations += iterations;
                    corrected.windows += 1;
                    progress(corrected.displacement.len());
                    steps = (2 * steps).min(settings.steps.max(1));
                }
                Err(fault) if count == 1 => return Err(fault),
                Err(_) => steps = count / 2,
            }
        }
        Ok(())
    }

    /// The next instants: those of ū, shifted by the correction of their last known instants.
    fn window(&self, known: &[Vec<f64>], data: &[Vec<f64>], count: usize) -> Window {
        let last = known.len() - 1;
        let (first, begin) = if last == 0 { (0, 0) } else { (last - 1, 1) };
        let mut states: Vec<Vec<f64>> = known[first..]
            .iter()
            .map(|field| self.free(field))
            .collect();
        let wrong = |instant: usize| -> Vec<f64> {
            difference(&self.free(&known[instant]), &self.free(&data[instant]))
        };
        let (before, now) = (wrong(first), wrong(last));
        for ahead in 1..=count {
            let data = self.free(&data[last + ahead]).into_iter();
            let guess = data.zip(now.iter().zip(&before));
            states.push(
                guess
                    .map(|(u, (now, before))| u + now + ahead as f64 * (now - before))
                    .collect(),
            );
        }
        Window {
            first,
            begin,
            states,
        }
    }

    /// Newton steps: each is one sweep through the blocks of a row, with the retained factor of the newest instant.
    fn solve(
        &self,
        window: &mut Window,
        velocity: &[f64],
        retained: &mut RetainedFactor,
        settings: WindowSettings,
        least_force: f64,
    ) -> Result<(Interval, usize), SolveFault> {
        let mut last = f64::INFINITY;
        for iteration in 0..=settings.max_iterations {
            let interval = self.linearise(window.first, &window.states);
            let interval = interval.map_err(|fault| fault.named(&self.motion.describe))?;
            let values = self.values(window, &interval, velocity);
            let residual = values
                .iter()
                .fold(0.0, |most: f64, row| larger(most, largest(row)))
                / self.scale(&interval, window).max(least_force);
            if !residual.is_finite() {
                return Err(SolveFault::NotFinite("the corrected motion".into()));
            }
            let settled = residual < ROUNDING_FLOOR && residual > 0.5 * last;
            if residual <= settings.tolerance || settled {
                return Ok((interval, iteration));
            }
            if !retained.fresh || residual > SLOW_CONVERGENCE * last {
                let newest = self.block(window.begin, window.begin + 1, &interval);
                retained.take(&newest)?;
            }
            self.sweep(window, &interval, &values, &mut retained.cholesky);
            last = residual;
        }
        Err(SolveFault::Stalled {
            iterations: settings.max_iterations,
            residual: last,
            tolerance: settings.tolerance,
        })
    }

    /// F of all rows.
    fn values(&self, window: &Window, interval: &Interval, velocity: &[f64]) -> Vec<Vec<f64>> {
        let rows = window.begin..window.states.len() - 1;
        let mut values: Vec<Vec<f64>> = rows
            .map(|row| self.value(row, interval, &window.states))
            .collect();
        if window.begin == 0 {
            let unknowns = values[0].iter_mut().zip(self.assembly.free()).zip(velocity);
            unknowns
                .for_each(|((value, unknown), v)| *value -= self.inertia(*unknown) * self.step * v);
        }
        values
    }

    /// The largest stiffness of a free unknown at the first instant in N/mm.
    fn largest_stiffness(&self, first: &[f64]) -> f64 {
        let Ok(frame) = self.frame(0, first) else {
            return 0.0;
        };
        let diagonal = self.assembly.pattern().diagonal().iter();
        diagonal.fold(0.0, |most: f64, position| {
            most.max(frame.stiffness[*position])
        })
    }

    /// The largest force in N: elastic, including reactions, or inertial.
    fn scale(&self, interval: &Interval, window: &Window) -> f64 {
        let forces = interval.frames.iter().map(|frame| frame.size);
        let second = window.states.windows(3).map(|three| {
            let free = self.assembly.free().iter().enumerate();
            free.fold(0.0, |most: f64, (i, unknown)| {
                let change = three[0][i] - 2.0 * three[1][i] + three[2][i];
                most.max((self.inertia(*unknown) * change).abs())
            })
        });
        forces.chain(second).fold(f64::MIN_POSITIVE, f64::max)
    }

    /// B δ = −F, forward in time.
    fn sweep(
        &self,
        window: &mut Window,
        interval: &Interval,
        values: &[Vec<f64>],
        cholesky: &mut Cholesky,
    ) {
        let pattern = self.assembly.pattern();
        let mut changes: Vec<Vec<f64>> = vec![vec![0.0; values[0].len()]; window.states.len()];
        for (row, value) in (window.begin..).zip(values) {
            let mut right: Vec<f64> = value.iter().map(|f| -f).collect();
            let earliest = (window.begin + 1).max(row.saturating_sub(1));
            for (instant, change) in changes.iter().enumerate().take(row + 1).skip(earliest) {
                let moved = pattern.multiply(&self.block(row, instant, interval), change);
                add_scaled(&mut right, -1.0, &moved);
            }
            cholesky.substitute(&mut right);
            add_scaled(&mut window.states[row + 1], 1.0, &right);
            changes[row + 1] = right;
        }
    }

    /// Appends a window's instants and multipliers.
    fn append(
        &self,
        window: &Window,
        data: &[Vec<f64>],
        interval: &Interval,
        retained: &mut RetainedFactor,
        corrected: &mut CorrectedMotion,
    ) -> Result<(), SolveFault> {
        if !retained.fresh {
            // The motion is in equilibrium already: no step was needed.
            retained.take(&self.block(window.begin, window.begin + 1, interval))?;
        }
        let multipliers = self.multipliers(window, data, interval, &mut retained.cholesky)?;
        for (row, psi) in (window.begin..).zip(multipliers) {
            let instant = window.first + row + 1;
            corrected
                .displacement
                .push(self.all_unknowns(instant, &window.states[row + 1]));
            let all_unknowns = spread(self.assembly.free(), &psi, self.motion.energy.unknowns());
            corrected.multipliers.push(all_unknowns);
        }
        Ok(())
    }

    /// u − ū + Bᵀ ψ = 0 in the window, backward in time.
    fn multipliers(
        &self,
        window: &Window,
        data: &[Vec<f64>],
        interval: &Interval,
        cholesky: &mut Cholesky,
    ) -> Result<Vec<Vec<f64>>, SolveFault> {
        let pattern = self.assembly.pattern();
        let rows = window.states.len() - 1;
        let mut psi: Vec<Vec<f64>> = vec![Vec::new(); rows];
        for row in (window.begin..rows).rev() {
            let instant = row + 1;
            let data = self.free(&data[window.first + instant]);
            let mut right = difference(&data, &window.states[instant]);
            for (later, psi) in psi.iter().enumerate().skip(instant).take(2) {
                let moved = pattern.multiply(&self.block(later, instant, interval), psi);
                add_scaled(&mut right, -1.0, &moved);
            }
            psi[row] = self.refined(&self.block(row, instant, interval), &right, cholesky)?;
        }
        Ok(psi.split_off(window.begin))
    }

    /// A⁻¹ b by the retained factor, with refinement on its defect.
    fn refined(
        &self,
        values: &[f64],
        right: &[f64],
        cholesky: &mut Cholesky,
    ) -> Result<Vec<f64>, SolveFault> {
        const REPEATS: usize = 40;
        const TOLERANCE: f64 = 1e-10;
        let mut solution = vec![0.0; right.len()];
        let mut defect = right.to_vec();
        let scale = largest(right);
        for _ in 0..REPEATS {
            if largest(&defect) <= TOLERANCE * scale {
                return Ok(solution);
            }
            cholesky.substitute(&mut defect);
            add_scaled(&mut solution, 1.0, &defect);
            let product = self.assembly.pattern().multiply(values, &solution);
            defect = difference(right, &product);
        }
        Err(SolveFault::Singular)
    }
}
