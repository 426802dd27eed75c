//! Forces that depend on rates and on the past.

use crate::error::SolveFault;
use crate::solve::{Inadmissible, Potential};

/// An element on its way: its own unknowns, their velocities, and what it remembers.
#[derive(Clone, Copy, Debug)]
pub struct Passing<'a> {
    /// In mm.
    pub displacement: &'a [f64],
    /// In mm/s.
    pub velocity: &'a [f64],
    /// What the element knew at the end of the step before.
    pub memory: &'a [f64],
    /// Time since then in s.
    pub elapsed: f64,
}

/// Where an element adds its viscous forces f_v and the symmetric parts of ∂f_v/∂u and ∂f_v/∂u̇, row by row; the lower
/// triangle at least.
#[derive(Debug)]
pub struct ViscousLocal<'a> {
    /// f_v in N.
    pub force: &'a mut [f64],
    /// ∂f_v/∂u in N/mm and ∂f_v/∂u̇ in N·s/mm, where they are wanted.
    pub tangents: Option<[&'a mut [f64]; 2]>,
}

/// Viscous forces f_v(u, u̇, past) of the elements of a potential.
pub trait Viscosity: Sync {
    /// How many numbers an element remembers.
    fn memory(&self, _element: usize) -> usize {
        0
    }

    /// Adds the forces of an element, which are those of the potential's element of the same number.
    ///
    /// # Errors
    /// [`Inadmissible`] when the element is inverted.
    fn add_element(
        &self,
        element: usize,
        passing: Passing<'_>,
        local: ViscousLocal<'_>,
    ) -> Result<(), Inadmissible>;

    /// What an element remembers at the end of a step.
    ///
    /// # Errors
    /// [`Inadmissible`] when the element is inverted.
    fn remember(
        &self,
        _element: usize,
        _passing: Passing<'_>,
        _next: &mut [f64],
    ) -> Result<(), Inadmissible> {
        Ok(())
    }

    /// What an element remembers after a long rest at its displacement.
    ///
    /// # Errors
    /// [`Inadmissible`] when the element is inverted.
    fn relaxed(
        &self,
        _element: usize,
        _displacement: &[f64],
        _memory: &mut [f64],
    ) -> Result<(), Inadmissible> {
        Ok(())
    }

    /// Whether the forces depend on the velocities, and not on the past alone.
    fn depends_on_rates(&self) -> bool {
        true
    }
}

/// The memories of all elements, one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Memory {
    starts: Vec<usize>,
    values: Vec<f64>,
}

impl Memory {
    /// The memories of a body that rests at a displacement.
    pub fn relaxed(
        potential: &dyn Potential,
        viscosity: &dyn Viscosity,
        displacement: &[f64],
    ) -> Result<Self, Inadmissible> {
        let mut starts = vec![0];
        for element in 0..potential.elements() {
            starts.push(starts[element] + viscosity.memory(element));
        }
        let mut values = vec![0.0; starts[potential.elements()]];
        for element in 0..potential.elements() {
            let own = gather(potential.element_unknowns(element), displacement);
            let memory = &mut values[starts[element]..starts[element + 1]];
            viscosity.relaxed(element, &own, memory)?;
        }
        Ok(Self { starts, values })
    }

    pub fn of(&self, element: usize) -> &[f64] {
        &self.values[self.starts[element]..self.starts[element + 1]]
    }

    /// The memories after a step that ends at u, u̇.
    pub fn after(
        &self,
        potential: &dyn Potential,
        viscosity: &dyn Viscosity,
        at: Whole<'_>,
    ) -> Result<Self, Inadmissible> {
        let mut next = self.clone();
        if next.values.is_empty() {
            return Ok(next);
        }
        for element in 0..potential.elements() {
            let range = self.starts[element]..self.starts[element + 1];
            let [u, v] = at.of(potential, element);
            let passing = Passing {
                displacement: &u,
                velocity: &v,
                memory: &self.values[range.clone()],
                elapsed: at.elapsed,
            };
            viscosity.remember(element, passing, &mut next.values[range])?;
        }
        Ok(next)
    }
}

/// The displacement and the velocity of all unknowns some time after the step before.
#[derive(Clone, Copy)]
pub(super) struct Whole<'a> {
    pub displacement: &'a [f64],
    pub velocity: &'a [f64],
    pub elapsed: f64,
}

impl Whole<'_> {
    pub fn of(&self, potential: &dyn Potential, element: usize) -> [Vec<f64>; 2] {
        let unknowns = potential.element_unknowns(element);
        [self.displacement, self.velocity].map(|values| gather(unknowns, values))
    }
}

/// The viscous forces on all unknowns in N.
pub(super) fn forces(
    potential: &dyn Potential,
    viscosity: &dyn Viscosity,
    memory: &Memory,
    at: Whole<'_>,
) -> Result<Vec<f64>, Inadmissible> {
    let mut sum = vec![0.0; at.displacement.len()];
    let mut force = Vec::new();
    for element in 0..potential.elements() {
        let unknowns = potential.element_unknowns(element);
        let [u, v] = at.of(potential, element);
        force.clear();
        force.resize(unknowns.len(), 0.0);
        let passing = Passing {
            displacement: &u,
            velocity: &v,
            memory: memory.of(element),
            elapsed: at.elapsed,
        };
        let local = ViscousLocal {
            force: &mut force,
            tangents: None,
        };
        viscosity.add_element(element, passing, local)?;
        for (unknown, force) in unknowns.iter().zip(&force) {
            sum[*unknown] += force;
        }
    }
    Ok(sum)
}

pub(super) fn gather(unknowns: &[usize], values: &[f64]) -> Vec<f64> {
    unknowns.iter().map(|unknown| values[*unknown]).collect()
}

/// An element's fault with its name.
pub(super) fn inverted<'a>(
    describe: &'a dyn Fn(usize) -> String,
) -> impl Fn(Inadmissible) -> SolveFault + 'a {
    |fault| SolveFault::Inverted {
        element: describe(fault.element),
    }
}
