//! Many states, each near the one before: a path of stretches, and grips that are moved by hand.

use std::fmt;

use super::{Climb, ClimbSolution, Ending, Field, Inverted, Iteration, Start, Way, Work, inverted};
use crate::corrector::extrapolation::{Known, rate_shares, value_shares};
use crate::error::{Error, SolveFault};
use crate::problem::{DeformedSheet, RigidMotion};

/// Excess cycles after which the operators are assembled anew.
const BEYOND: usize = 2;

/// The positions of both grips.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grips {
    /// The grip at X = 0.
    pub left: RigidMotion,
    /// The grip at X = length.
    pub right: RigidMotion,
}

impl fmt::Display for Grips {
    /// `(0, 0) mm turned by 0° and (75, 0) mm turned by 2°`, left and right.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { left, right } = self;
        write!(f, "{left} and {right}")
    }
}

impl Climb<'_> {
    /// Corrects at many stretches, one after the other: the first and the last by a climb, which also gives the
    /// discretisation error, the others from the states before them, extrapolated, with the operators of an earlier
    /// state as long as they serve.
    ///
    /// # Errors
    /// [`Error::Solve`] with the stretch at which no field was found.
    pub fn follow(
        &mut self,
        stretches: &[f64],
        told: &mut dyn FnMut(&ClimbSolution),
    ) -> Result<(), Error> {
        let [first, between @ .., last] = stretches else {
            for stretch in stretches {
                told(&self.correct(*stretch)?);
            }
            return Ok(());
        };
        let ends = [self.correct(*first)?, self.correct(*last)?];
        let [at_first, at_last] = [0, 1].map(|end| {
            let stretch = [first, last][end];
            ends[end].discretisation_error / self.departure(&ends[end].field, *stretch)
        });
        let relative_error = at_first.min(at_last);
        let [first_state, last_state] = ends;
        told(&first_state);
        let mut known = Known::none();
        known.take(*first, first_state.field);
        // Cycles beyond those that fresh operators, which are those of linear cells, take: as many as an element's
        // side has cells. Assembling the operators anew costs about as much as a few of them.
        let mut beyond = usize::MAX;
        for stretch in between.iter().copied() {
            let anew = beyond > BEYOND;
            let near = (!known.fields.is_empty())
                .then(|| self.near_known(&known, stretch, relative_error, anew));
            let climbed = match near {
                Some(Ok(climbed)) => {
                    let (_, work) = climbed.work[0];
                    beyond = if anew { 0 } else { beyond };
                    beyond += work.cycles.saturating_sub(self.scheme.side());
                    climbed
                }
                // Too far from the states before: a climb of its own.
                _ => {
                    beyond = usize::MAX;
                    self.correct(stretch)?
                }
            };
            told(&climbed);
            known.take(stretch, climbed.field);
        }
        told(&last_state);
        Ok(())
    }

    /// The state at one stretch from those before, extrapolated; the operators are assembled anew where they no longer serve.
    fn near_known(
        &mut self,
        known: &Known<Field>,
        stretch: f64,
        relative_error: f64,
        anew: bool,
    ) -> Result<ClimbSolution, SolveFault> {
        let mut field = combine(&known.fields, &value_shares(&known.parameters, stretch));
        if anew {
            self.linearise_below(self.levels.len() - 1, &field)?;
        }
        let error = relative_error * self.departure(&field, stretch);
        let reached = self.near(&mut field, error)?;
        let rate = combine(&known.fields, &rate_shares(&known.parameters, stretch));
        let force = self.force_along(&rate);
        Ok(ClimbSolution::near(field, force, error, reached))
    }

    /// The root mean square over the nodes of a field's departure from the affine stretch in mm.
    pub(super) fn departure(&self, field: &Field, stretch: f64) -> f64 {
        let places = &self.grid().coordinates[0];
        let lines = field.components[0].chunks_exact(field.width).zip(places);
        let along: f64 = lines
            .map(|(line, x)| line.iter().map(|u| (u - stretch * x).powi(2)).sum::<f64>())
            .sum();
        let across: f64 = field.components[1].iter().map(|u| u * u).sum();
        ((along + across) / self.grid().nodes() as f64).sqrt()
    }

    /// Corrects a field that is near the result, with the operators assembled before, to a share of its discretisation error.
    fn near(&mut self, field: &mut Field, error: f64) -> Result<Iteration, SolveFault> {
        self.check_operators()?;
        let finest = self.levels.len() - 1;
        let limit = self.settings.tolerance * error;
        let (sheet, most) = (self.sheet(), self.settings.max_iterations);
        let level = &mut self.levels[finest];
        let ending = Ending {
            most,
            weakest: self.weakest,
            enough: &|_, left| left <= limit,
        };
        let iterated = level.iterate(sheet, field, &mut self.multigrid, &ending);
        let reached = iterated.map_err(|Inverted| inverted())?;
        if reached.fall.left() > limit {
            return Err(SolveFault::Stalled {
                iterations: most,
                residual: reached.fall.left(),
                tolerance: limit,
            });
        }
        Ok(reached)
    }

    /// The force on the moving grip in N from the F that the last iteration left, r = F(u + z): r · w with the
    /// field's rate w with respect to the stretch. Equilibrium is kept along the path, K w = 0 between the grips: the
    /// correction z, which r does not include yet, does not change r · w, and no evaluation is needed.
    fn force_along(&self, rate: &Field) -> f64 {
        let residual = &self.levels[self.levels.len() - 1].residual;
        residual.product(rate) / self.problem.size[0]
    }
}

impl ClimbSolution {
    /// A state found near another one.
    fn near(field: Field, force: f64, discretisation_error: f64, reached: Iteration) -> Self {
        let nodes = field.components[0].len();
        let cells = [nodes / field.width - 1, field.width - 1];
        Self {
            field,
            force,
            discretisation_error,
            error_is_sure: false,
            work: vec![(nodes, reached.work)],
            corrections: reached.fall.corrections,
            way: Way::from_start(Start::StatesBefore, cells),
        }
    }
}

/// The sum of the known fields, each with its share.
fn combine(known: &[Field], shares: &[f64]) -> Field {
    let mut field = known[0].clone();
    field.scale(shares[0]);
    for (own, share) in known.iter().zip(shares).skip(1) {
        field.add(*share, own);
    }
    field
}

/// A plate moved by hand: its grips are moved, and the corrected field follows.
#[derive(Debug)]
pub struct Interactive<'a> {
    climb: Climb<'a>,
    grips: Grips,
    climbed: ClimbSolution,
    /// The discretisation error relative to the size of the field.
    relative_error: f64,
}

impl<'a> Interactive<'a> {
    /// Begins at one stretch.
    ///
    /// # Errors
    /// [`Error::Solve`] when no field was found there.
    pub fn new(mut climb: Climb<'a>, stretch: f64) -> Result<Self, Error> {
        let climbed = climb.correct(stretch)?;
        let grips = Grips {
            right: RigidMotion {
                displacement: [stretch * climb.problem.size[0], 0.0],
                angle: 0.0,
            },
            ..Grips::default()
        };
        Ok(Self {
            relative_error: climbed.discretisation_error / climbed.field.size(),
            climb,
            grips,
            climbed,
        })
    }

    /// The present corrected field and forces at the grips.
    pub fn state(&self) -> &ClimbSolution {
        &self.climbed
    }

    /// The present corrected field, to be evaluated at any point of the plate.
    pub fn deformed(&self) -> DeformedSheet {
        self.climb.deformed(&self.climbed)
    }

    /// The positions of the grips.
    pub fn grips(&self) -> Grips {
        self.grips
    }

    /// Moves the grips by a few mm or degrees; the field between them follows. A motion that is too large for one step is divided.
    ///
    /// # Errors
    /// [`Error::Solve`] when the field cannot follow; the state before is kept.
    pub fn move_grips(&mut self, grips: Grips) -> Result<&ClimbSolution, Error> {
        const PARTS: [usize; 4] = [1, 2, 4, 8];
        let mut found = Err(SolveFault::Singular);
        for parts in PARTS {
            found = self.move_in(parts, grips);
            if found.is_ok() {
                break;
            }
        }
        self.climbed = found.map_err(|fault| Error::Solve {
            model: "corrector (climb)".into(),
            step: format!(
                "a motion of the grips from {} to {grips} (also in {} parts; the previous field is kept: move them \
                 in smaller steps, or start anew at that stretch)",
                self.grips, PARTS[PARTS.len() - 1]
            ),
            fault,
        })?;
        self.grips = grips;
        Ok(&self.climbed)
    }

    fn move_in(&mut self, parts: usize, grips: Grips) -> Result<ClimbSolution, SolveFault> {
        let mut field = self.climbed.field.clone();
        let mut work = Work::default();
        let mut reached = None;
        for part in 1..=parts {
            let share = 1.0 / (parts - part + 1) as f64;
            self.impose(grips, share, &mut field);
            self.climb
                .linearise_below(self.climb.levels.len() - 1, &field)?;
            let error = self.relative_error * field.size();
            let mut own = self.climb.near(&mut field, error)?;
            own.work.add(work);
            work = own.work;
            reached = Some((error, own));
        }
        let (error, mut reached) = reached.expect("one part at least");
        reached.work.evaluations += 1;
        let force = self.climb.force(&field).map_err(|Inverted| inverted())?;
        Ok(ClimbSolution::near(field, force, error, reached))
    }

    /// Moves the grips by a share of the remaining way, and the nodes between them in proportion.
    fn impose(&self, grips: Grips, share: f64, field: &mut Field) {
        let grid = self.climb.grid();
        let [length, width] = self.climb.problem.size;
        let last = grid.lines().count - 1;
        for (node, y) in grid.coordinates[1].iter().enumerate() {
            let targets = [grips.left, grips.right].map(|grip| grip.at([0.0, y - 0.5 * width]));
            for axis in [0, 1] {
                let component = &mut field.components[axis];
                let at = |line: usize| line * grid.lines().nodes + node;
                let left = share * (targets[0][axis] - component[at(0)]);
                let right = share * (targets[1][axis] - component[at(last)]);
                for (line, x) in grid.coordinates[0].iter().enumerate() {
                    component[at(line)] += left + (right - left) * x / length;
                }
            }
        }
    }
}
