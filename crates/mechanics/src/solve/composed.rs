//! Potentials composed of others: of a body with a history, sums, and dead forces.

use super::connectivity::Connectivity;
use super::potential::{
    Evaluated, Inadmissible, Local, Potential, Remembering, SkewCoupling, Take,
    evaluate_by_elements,
};

/// An energy of a body with a history, which is empty where the body was never loaded or has no memory.
pub struct After<'a> {
    energy: &'a dyn Remembering,
    history: &'a [f64],
}

impl<'a> After<'a> {
    /// Π of a body with the history that [`Remembering::remember`] has recorded.
    pub fn new(energy: &'a dyn Remembering, history: &'a [f64]) -> Self {
        Self { energy, history }
    }
}

impl Potential for After<'_> {
    fn connectivity(&self) -> &Connectivity {
        self.energy.connectivity()
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        if self.history.is_empty() {
            self.energy.evaluate_element(element, u, local)
        } else {
            let history = self.history;
            self.energy.evaluate_after(element, u, local, history)
        }
    }

    fn evaluate(&self, u: &[f64], forces: &mut [f64], take: Take<'_>) -> Evaluated {
        if self.history.is_empty() {
            self.energy.evaluate(u, forces, take)
        } else {
            evaluate_by_elements(self, u, forces, take)
        }
    }

    fn skew_couplings(&self) -> Vec<SkewCoupling> {
        self.energy.skew_couplings()
    }

    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        self.energy.instability(element, u)
    }
}

/// The sum of two potentials of the same unknowns: the elements of the first, then those of the second.
pub struct Sum<'a> {
    first: Box<dyn Potential + 'a>,
    second: Box<dyn Potential + 'a>,
    connectivity: Connectivity,
}

impl<'a> Sum<'a> {
    /// Π₁ + Π₂; the positions of the unknowns are taken from the first potential.
    pub fn new(first: impl Potential + 'a, second: impl Potential + 'a) -> Self {
        let mut connectivity = first.connectivity().clone();
        connectivity.append(second.connectivity());
        Self {
            first: Box::new(first),
            second: Box::new(second),
            connectivity,
        }
    }

    /// Π − f·u of a body without a history, with a force in N on every unknown.
    pub fn with_forces(energy: &'a dyn Remembering, forces: &[f64]) -> Self {
        let forces = forces.iter().copied().enumerate();
        let forces = DeadForces::new(energy.unknowns(), forces);
        Self::new(After::new(energy, &[]), forces)
    }

    /// The part to which an element belongs, and its number there.
    fn part(&self, element: usize) -> (&dyn Potential, usize) {
        match element.checked_sub(self.first.elements()) {
            Some(index) => (&*self.second, index),
            None => (&*self.first, element),
        }
    }
}

impl Potential for Sum<'_> {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        let (part, index) = self.part(element);
        let energy = part.evaluate_element(index, u, local);
        energy.map_err(|_| Inadmissible { element })
    }

    fn evaluate(&self, u: &[f64], forces: &mut [f64], take: Take<'_>) -> Evaluated {
        let before = self.first.elements();
        let (first, second) = match take {
            None => {
                let first = self.first.evaluate(u, forces, None)?;
                (first, self.second.evaluate(u, forces, None))
            }
            Some(take) => {
                let mut forward = |element, stiffness: &[f64]| take(element, stiffness);
                let first = self.first.evaluate(u, forces, Some(&mut forward))?;
                let mut forward = |element, stiffness: &[f64]| take(before + element, stiffness);
                (first, self.second.evaluate(u, forces, Some(&mut forward)))
            }
        };
        let of_second = |fault: Inadmissible| Inadmissible {
            element: before + fault.element,
        };
        Ok(first + second.map_err(of_second)?)
    }

    fn skew_couplings(&self) -> Vec<SkewCoupling> {
        let mut all = self.first.skew_couplings();
        all.extend(self.second.skew_couplings());
        all
    }

    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        let (part, index) = self.part(element);
        part.instability(index, u)
    }
}

/// The potential −f·u of dead forces: each is an element of its own.
pub struct DeadForces {
    connectivity: Connectivity,
    forces: Vec<f64>,
}

impl DeadForces {
    /// Forces in N on some of so many unknowns.
    pub fn new(unknowns: usize, forces: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let mut point_forces = Self {
            connectivity: Connectivity::new(unknowns),
            forces: Vec::new(),
        };
        for (unknown, force) in forces {
            point_forces.connectivity.push([unknown]);
            point_forces.forces.push(force);
        }
        point_forces
    }
}

impl Potential for DeadForces {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        let force = self.forces[element];
        local.residual[0] = -force;
        Ok(-force * u[0])
    }
}
