//! Why a path of equilibria ends.
//!
//! Near a critical state the tangent K has a direction φ of vanishing stiffness. With q = ∂r/∂s, the change of
//! the loads with the load factor s, φ · q ≠ 0 is a limit point: the load has its maximum there. φ · q = 0 is
//! a bifurcation: the body may leave its path along φ, as in buckling or wrinkling.
//!
//! # References
//! P. Wriggers, Nonlinear Finite Element Methods, Springer (2008), § 7.1, doi:10.1007/978-3-540-71001-1

use super::assembly::Assembly;
use super::loading::{Loading, Stage, State};
use super::newton::Newton;
use super::potential::Potential;
use super::vector::{difference, dot, gather, largest, norm};
use crate::error::SolveFault;

/// How far from the last equilibrium a tangent describes it, relative to the largest displacement.
const NEAR: f64 = 0.1;

/// Share of the least stiffness at rest below which a stiffness counts as zero: it vanishes like the root of the
/// distance to a limit point, and a path comes within a thousandth of that point.
const SOFT: f64 = 0.1;

/// Share of the largest stiffness of an unknown below which a stiffness is rounding: slender strips of a thousand cells have modes of 1e-12.
const ROUNDED: f64 = 1e-14;

/// Cosine of the angle between mode and load above which the load drives the mode. For a mode that symmetry decouples
/// from the load it is rounding, about 1e-10; for the stretching of a bar some 0.1.
const DRIVEN: f64 = 1e-3;

/// The reason behind a fault at a stage after the equilibrium `previous`: a material that lost its stability, a load
/// that has its maximum, a mode of buckling; otherwise the fault itself.
pub fn diagnose(
    newton: &mut Newton,
    loading: &dyn Loading,
    previous: Option<&State>,
    stage: Stage<'_>,
    fault: SolveFault,
) -> SolveFault {
    if matches!(fault, SolveFault::NotFinite(_)) {
        return fault;
    }
    let potential = loading.potential(stage.factor, stage.history);
    let unstable = |u: &[f64]| {
        let (element, state) = unstable_element(&*potential, u)?;
        let element = loading.describe(element);
        Some(SolveFault::MaterialUnstable { element, state })
    };
    let rest = vec![0.0; potential.unknowns()];
    let last = previous.map_or(&rest, |state| &state.displacement);
    if let Some(instability) = previous.is_none().then(|| unstable(last)).flatten() {
        return instability;
    }
    let Some(u) = critical(newton, &*potential, previous, &fault) else {
        return fault;
    };
    if let Some(instability) = unstable(last).or_else(|| unstable(&u)) {
        return instability;
    }
    if !newton.tangent.skew.is_none() {
        // Modes of its symmetric part alone are not modes of the body.
        return fault;
    }
    let place_of = |mode: &[f64]| {
        let most = (0..mode.len()).max_by(|a, b| mode[*a].abs().total_cmp(&mode[*b].abs()));
        most.map_or_else(String::new, |unknown| loading.describe_unknown(unknown))
    };
    if let Some(mode) = unstable_at_rest(newton, loading, stage.history) {
        let position = place_of(&mode);
        return SolveFault::UnstableAtRest { position };
    }
    let Some(softest) = newton.tangent.softest_mode(&*potential, &u) else {
        return fault;
    };
    let mode = softest.displacement;
    let position = place_of(&mode);
    if !is_driven(newton, loading, stage, &u, &mode) {
        return SolveFault::Buckling { position };
    }
    let factor = previous.map_or(0.0, |state| state.factor);
    SolveFault::LoadMaximum { factor, position }
}

/// A mode that has no stiffness before any load acts, or a negative one, such as of a node that is held by a single spring: steps with shifted
/// tangents may lead away from rest all the same.
fn unstable_at_rest(
    newton: &mut Newton,
    loading: &dyn Loading,
    history: &[f64],
) -> Option<Vec<f64>> {
    let potential = loading.potential(0.0, history);
    let rest = vec![0.0; potential.unknowns()];
    let softest = newton.tangent.softest_mode(&*potential, &rest)?;
    (softest.stiffness <= ROUNDED * softest.stiffest).then_some(softest.displacement)
}

/// A state at or near the last equilibrium in which a direction has lost its stiffness.
fn critical(
    newton: &mut Newton,
    potential: &dyn Potential,
    previous: Option<&State>,
    fault: &SolveFault,
) -> Option<Vec<f64>> {
    let indefinite = newton.indefinite();
    let Some(previous) = previous else {
        let inverted = matches!(fault, SolveFault::Inverted { .. });
        return indefinite.filter(|_| !inverted).map(<[f64]>::to_vec);
    };
    let last = &previous.displacement;
    let near = |u: &&[f64]| largest(&difference(u, last)) <= NEAR * largest(last);
    if let Some(u) = indefinite.filter(near) {
        return Some(u.to_vec());
    }
    let mut softest = |u: &[f64]| Some(newton.tangent.softest_mode(potential, u)?.stiffness);
    let (now, rest) = (softest(last), softest(&vec![0.0; last.len()]));
    let soft = now
        .zip(rest)
        .is_some_and(|(now, rest)| now <= SOFT * rest.abs());
    soft.then(|| last.clone())
}

/// The first element that is unstable by itself, and its state.
fn unstable_element(potential: &dyn Potential, u: &[f64]) -> Option<(usize, String)> {
    (0..potential.elements()).find_map(|element| {
        let values = potential.connectivity().values(element, u);
        Some((element, potential.instability(element, &values)?))
    })
}

/// Whether the loads push along a mode.
fn is_driven(
    newton: &Newton,
    loading: &dyn Loading,
    stage: Stage<'_>,
    u: &[f64],
    mode: &[f64],
) -> bool {
    let residual = |factor: f64| {
        let mut residual = vec![0.0; u.len()];
        let potential = loading.potential(factor, stage.history);
        Assembly::residual(&*potential, u, &mut residual).map(|_| residual)
    };
    let (Ok(loaded), Ok(unloaded)) = (residual(stage.factor), residual(0.0)) else {
        return false;
    };
    let load = gather(newton.free(), &difference(&loaded, &unloaded));
    let product = dot(&gather(newton.free(), mode), &load);
    product.abs() > DRIVEN * norm(&load) * norm(mode)
}
