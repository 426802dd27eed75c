//! Stresses and tangents of a sheet at many points at once.

use std::marker::PhantomData;

use pulp::{Arch, NullaryFnOnce};

use super::{BodyLaw, BodySheet, BodyStretches};
use crate::material::law::{LANES, store};
use crate::material::measures::{Derivatives, Measures};
use crate::material::sheet::{COMPONENTS, Kinematics, PlaneTensor};

impl<L: BodyLaw> BodySheet<L> {
    /// As [`HyperelasticLaw::stresses`](crate::material::HyperelasticLaw::stresses).
    pub(super) fn stresses_at(&self, gradients: [&[f64]; 4], computed: [&mut [f64]; 4]) -> bool {
        self.each::<Stress, 4>(gradients, computed)
    }

    /// As [`HyperelasticLaw::responses`](crate::material::HyperelasticLaw::responses).
    pub(super) fn responses_at(
        &self,
        gradients: [&[f64]; 4],
        computed: [&mut [f64]; COMPONENTS],
    ) -> bool {
        self.each::<Response, COMPONENTS>(gradients, computed)
    }

    fn each<M: Computed<N>, const N: usize>(
        &self,
        gradients: [&[f64]; 4],
        computed: [&mut [f64]; N],
    ) -> bool {
        with_avx2(PointLoop {
            sheet: self,
            gradients,
            computed,
            kind: PhantomData::<M>,
        })
    }
}

/// Runs a loop with vectors of four numbers where the machine has them. A third version with longer ones, for each of all laws, takes longer to
/// compile than it saves.
fn with_avx2<F: NullaryFnOnce>(work: F) -> F::Output {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    match Arch::new() {
        Arch::V4(simd) => return (*simd).vectorize(work),
        Arch::V3(simd) => return simd.vectorize(work),
        _ => {}
    }
    work.call()
}

/// Some points of a loop; entries behind the last one are at rest.
struct Lanes<S> {
    gradients: [[f64; LANES]; 4],
    shapes: [S; LANES],
    volume_root_change: [f64; LANES],
    admissible: bool,
}

impl<S: Copy> Lanes<S> {
    #[inline(always)]
    fn new<L: BodyLaw<Shape = S>>(
        sheet: &BodySheet<L>,
        all: &[&[f64]; 4],
        first: usize,
        count: usize,
    ) -> Self {
        let mut gradients = [[0.0; LANES]; 4];
        for (lanes, component) in gradients.iter_mut().zip(all) {
            lanes[..count].copy_from_slice(&component[first..first + count]);
        }
        let [mut area_change, mut z] = [[0.0; LANES]; 2];
        let mut inverted = 0_u64;
        let [h11, h12, h21, h22] = &gradients;
        for lane in 0..LANES {
            let h = PlaneTensor::new(h11[lane], h12[lane], h21[lane], h22[lane]);
            let kinematics = Kinematics::unchecked(&h);
            inverted |= u64::from(!kinematics.is_admissible());
            area_change[lane] = kinematics.area_change;
            z[lane] = Measures::new(&kinematics).z;
        }
        let admissible = inverted == 0;
        let shapes = sheet.shapes(&area_change, &z);
        let volume_root_change = if admissible {
            sheet.at(&area_change, &z, &shapes)
        } else {
            [f64::NAN; LANES]
        };
        Self {
            gradients,
            shapes,
            volume_root_change,
            admissible,
        }
    }

    #[inline(always)]
    fn point<L: BodyLaw<Shape = S>>(
        &self,
        sheet: &BodySheet<L>,
        lane: usize,
    ) -> (Measures, Derivatives) {
        let [h11, h12, h21, h22] = &self.gradients;
        let h = PlaneTensor::new(h11[lane], h12[lane], h21[lane], h22[lane]);
        let kinematics = Kinematics::unchecked(&h);
        let measures = Measures::new(&kinematics);
        let w = sheet.law.evaluate(BodyStretches {
            area_change: kinematics.area_change,
            shape: self.shapes[lane],
            volume_root_change: self.volume_root_change[lane],
        });
        (measures, sheet.condensed(&w))
    }
}

/// A result computed from the measures and derivatives at a point.
trait Computed<const N: usize> {
    /// The components of the result.
    fn of(measures: &Measures, w: &Derivatives) -> [f64; N];
}

struct Stress;

impl Computed<4> for Stress {
    #[inline(always)]
    fn of(measures: &Measures, w: &Derivatives) -> [f64; 4] {
        measures.stress(w).into()
    }
}

struct Response;

impl Computed<COMPONENTS> for Response {
    #[inline(always)]
    fn of(measures: &Measures, w: &Derivatives) -> [f64; COMPONENTS] {
        measures.response(w).components()
    }
}

/// Computes the result for every point of a list; `false` where one is turned inside out.
///
/// Straight-line code for each point, as for laws that keep their volume: no operation is fused with another, so that all
/// machines give the same bits.
struct PointLoop<'a, L, M, const N: usize> {
    sheet: &'a BodySheet<L>,
    gradients: [&'a [f64]; 4],
    computed: [&'a mut [f64]; N],
    kind: PhantomData<M>,
}

impl<L: BodyLaw, M: Computed<N>, const N: usize> NullaryFnOnce for PointLoop<'_, L, M, N> {
    type Output = bool;

    #[inline(always)]
    fn call(mut self) -> bool {
        // A copy that no store in the loop can reach.
        let sheet = &self.sheet.clone();
        let points = self.gradients[0].len();
        for first in (0..points).step_by(LANES) {
            let count = LANES.min(points - first);
            let lanes = Lanes::new(sheet, &self.gradients, first, count);
            if !lanes.admissible {
                return false;
            }
            let mut block = [[0.0; LANES]; N];
            for lane in 0..LANES {
                let (measures, w) = lanes.point(sheet, lane);
                for (component, value) in block.iter_mut().zip(M::of(&measures, &w)) {
                    component[lane] = value;
                }
            }
            store(&mut self.computed, &block, first, count);
        }
        true
    }
}
