//! Forces that depend on rates and on the past.

use crate::solve::{Connectivity, Inadmissible};

/// The motion of an element: its own unknowns, their velocities, and its memory.
#[derive(Clone, Copy, Debug)]
pub struct ElementMotion<'a> {
    /// Displacement in mm.
    pub displacement: &'a [f64],
    /// Velocity in mm/s.
    pub velocity: &'a [f64],
    /// The memory of the element at the end of the step before.
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
    /// The number of values that an element stores.
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
        motion: ElementMotion<'_>,
        local: ViscousLocal<'_>,
    ) -> Result<(), Inadmissible>;

    /// The memory of an element at the end of a step.
    ///
    /// # Errors
    /// [`Inadmissible`] when the element is inverted.
    fn remember(
        &self,
        _element: usize,
        _motion: ElementMotion<'_>,
        _next: &mut [f64],
    ) -> Result<(), Inadmissible> {
        Ok(())
    }

    /// Whether the forces depend on the velocities, and not on the past alone.
    fn depends_on_rates(&self) -> bool {
        true
    }
}

/// The memories of all elements, one after the other; empty where elements have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    starts: Vec<usize>,
    values: Vec<f64>,
}

impl Memory {
    /// The memories of a body that has rested at a displacement for long.
    ///
    /// # Errors
    /// [`Inadmissible`] with the first inverted element.
    pub fn relaxed(
        connectivity: &Connectivity,
        viscosity: &dyn Viscosity,
        displacement: &[f64],
    ) -> Result<Self, Inadmissible> {
        let mut starts = vec![0];
        for element in 0..connectivity.elements() {
            starts.push(starts[element] + viscosity.memory(element));
        }
        let values = vec![0.0; starts[connectivity.elements()]];
        let velocity = vec![0.0; displacement.len()];
        let before = Self { starts, values };
        before.after(
            connectivity,
            viscosity,
            [displacement, &velocity],
            f64::INFINITY,
        )
    }

    /// The memory of an element.
    pub fn of(&self, element: usize) -> &[f64] {
        if self.values.is_empty() {
            &[]
        } else {
            &self.values[self.starts[element]..self.starts[element + 1]]
        }
    }

    /// The memories after a step of a length in s that ends at displacements u and velocities u̇.
    ///
    /// # Errors
    /// [`Inadmissible`] with the first inverted element.
    pub fn after(
        &self,
        connectivity: &Connectivity,
        viscosity: &dyn Viscosity,
        [u, v]: [&[f64]; 2],
        elapsed: f64,
    ) -> Result<Self, Inadmissible> {
        let mut next = self.clone();
        if next.values.is_empty() {
            return Ok(next);
        }
        for element in 0..connectivity.elements() {
            let motion = ElementMotion {
                displacement: &connectivity.values(element, u),
                velocity: &connectivity.values(element, v),
                memory: self.of(element),
                elapsed,
            };
            let range = self.starts[element]..self.starts[element + 1];
            viscosity.remember(element, motion, &mut next.values[range])?;
        }
        Ok(next)
    }
}
