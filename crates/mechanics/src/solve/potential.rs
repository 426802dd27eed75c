//! A potential energy that is a sum over elements.

use super::connectivity::Connectivity;
use crate::error::SolveFault;

/// An element that has turned inside out, collapsed, or left the range of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("element {element} is turned inside out, has collapsed, or is not finite")]
pub struct Inadmissible {
    /// The element's index.
    pub element: usize,
}

impl Inadmissible {
    /// The fault of a solution, with the element's name.
    pub fn named(self, describe: impl Fn(usize) -> String) -> SolveFault {
        SolveFault::Inverted {
            element: describe(self.element),
        }
    }
}

/// An energy in mJ, or the first element that is inverted.
pub type Evaluated = Result<f64, Inadmissible>;

/// Where an element writes its derivatives: residual rᵢ = ∂Π/∂uᵢ and stiffness Kᵢₖ = ∂²Π/∂uᵢ∂uₖ,
/// row by row, both set to zero before the call. Without `stiffness` only the residual is wanted.
#[derive(Debug)]
pub struct Local<'a> {
    /// Residual, one number for each of the element's unknowns.
    pub residual: &'a mut [f64],
    /// Stiffness, symmetric, row by row; the lower triangle at least.
    pub stiffness: Option<&'a mut [f64]>,
}

/// A part of the tangent that is not symmetric: K_rc += k, K_cr −= k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkewCoupling {
    /// The unknown r.
    pub row: usize,
    /// The unknown c.
    pub column: usize,
    /// k in N/mm.
    pub stiffness: f64,
}

/// Receives each element with its stiffness, row by row, the lower triangle at least; `None` where stiffnesses are not wanted.
pub type Take<'a> = Option<&'a mut dyn FnMut(usize, &[f64])>;

/// A potential energy Π(u) = Σ Πₑ(u), one term for each element.
///
/// Mass-spring lattices, finite elements, loads and the corrector's difference scheme are all of this kind,
/// so that one assembly, one Newton method and one derivative check serve them all.
pub trait Potential: Sync {
    /// Which unknowns each element depends on.
    fn connectivity(&self) -> &Connectivity;

    /// Πₑ at the element's own unknowns `u`; its derivatives are written to `local`.
    ///
    /// # Errors
    /// [`Inadmissible`] when the element is inverted.
    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated;

    /// Π; adds ∂Π/∂u at all unknowns, and passes on the stiffnesses of all elements where they are wanted.
    ///
    /// # Errors
    /// [`Inadmissible`] with an element that is inverted.
    fn evaluate(&self, u: &[f64], forces: &mut [f64], take: Take<'_>) -> Evaluated {
        evaluate_by_elements(self, u, forces, take)
    }

    /// What the derivatives of the residual have in addition to the symmetric stiffness of the elements: forces without a
    /// potential, such as a pressure that follows an edge up to its free end. None for a true potential.
    fn skew_couplings(&self) -> Vec<SkewCoupling> {
        Vec::new()
    }

    /// The state of an element that is unstable by itself at its own unknowns `u`, described; `None` where it is
    /// stable, or where only the sum has a stability.
    fn instability(&self, _element: usize, _u: &[f64]) -> Option<String> {
        None
    }

    /// Number of unknowns, the length of u.
    fn unknowns(&self) -> usize {
        self.connectivity().unknowns()
    }

    /// Number of elements.
    fn elements(&self) -> usize {
        self.connectivity().elements()
    }

    /// The unknowns that an element depends on.
    fn element_unknowns(&self, element: usize) -> &[u32] {
        self.connectivity().of(element)
    }
}

/// The potential of a body that may remember its loading, such as a material that softens. Potentials composed of
/// others do not remember: a body with a history is an [`After`](super::After).
pub trait Remembering: Potential {
    /// [`Potential::evaluate_element`] of the body with a history.
    ///
    /// # Errors
    /// As [`Potential::evaluate_element`].
    fn evaluate_after(
        &self,
        element: usize,
        u: &[f64],
        local: Local<'_>,
        history: &[f64],
    ) -> Evaluated;

    /// Adds the state `u` to a history, which stays empty where the material has no memory.
    fn remember(&self, history: &mut Vec<f64>, u: &[f64]);

    /// The energy that the body has dissipated so far, in mJ.
    fn dissipated(&self, history: &[f64]) -> f64;

    /// Whether rotations leave the energy unchanged, so that moments balance on the deformed body; otherwise they balance on the body at rest.
    fn is_objective(&self) -> bool {
        true
    }
}

/// [`Potential::evaluate`], element by element.
///
/// # Errors
/// [`Inadmissible`] with the first inverted element.
pub fn evaluate_by_elements<P: Potential + ?Sized>(
    potential: &P,
    u: &[f64],
    forces: &mut [f64],
    mut take: Take<'_>,
) -> Evaluated {
    let mut terms = ElementTerms::default();
    let mut energy = 0.0;
    for element in 0..potential.elements() {
        energy += terms.evaluate(potential, element, u, take.is_some())?;
        let unknowns = potential.element_unknowns(element);
        for (unknown, force) in unknowns.iter().zip(&terms.residual) {
            forces[*unknown as usize] += force;
        }
        if let Some(take) = &mut take {
            take(element, &terms.stiffness);
        }
    }
    Ok(energy)
}

/// Residual and stiffness of one element after the other, in the same memory.
#[derive(Default)]
pub struct ElementTerms {
    values: Vec<f64>,
    residual: Vec<f64>,
    /// Row by row; the lower triangle at least.
    pub stiffness: Vec<f64>,
}

impl ElementTerms {
    /// Evaluates an element's terms at `u`, with its stiffness where it is wanted; returns its energy.
    ///
    /// # Errors
    /// [`Inadmissible`] when the element is inverted.
    pub fn evaluate<P: Potential + ?Sized>(
        &mut self,
        potential: &P,
        element: usize,
        u: &[f64],
        with_stiffness: bool,
    ) -> Evaluated {
        let unknowns = potential.element_unknowns(element);
        let size = unknowns.len();
        self.values.clear();
        self.values
            .extend(unknowns.iter().map(|unknown| u[*unknown as usize]));
        self.residual.clear();
        self.residual.resize(size, 0.0);
        if with_stiffness {
            self.stiffness.clear();
            self.stiffness.resize(size * size, 0.0);
        }
        let local = Local {
            residual: &mut self.residual,
            stiffness: with_stiffness.then_some(&mut self.stiffness),
        };
        potential.evaluate_element(element, &self.values, local)
    }
}
