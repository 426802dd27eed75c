//! The viscous forces of a sheet of finite elements.

use super::viscosity::{ElementMotion, Viscosity, ViscousLocal};
use nalgebra::Matrix4;

use crate::material::HyperelasticLaw;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::material::viscosity::{
    ViscousMaterial, first_piola_kirchhoff, geometric_tangent, second_piola_kirchhoff,
};
use crate::problem::sampling_point::SamplingPoint;
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::Inadmissible;

/// The viscous part of a material at the sampling points of an energy. A point stores S∞ and the stress Qᵢ of every branch of the Prony series.
#[derive(Clone, Copy, Debug)]
pub struct SheetViscosity<'a> {
    energy: &'a SheetEnergy,
    material: &'a ViscousMaterial,
}

impl<'a> SheetViscosity<'a> {
    /// The viscous forces of `energy`.
    pub fn new(energy: &'a SheetEnergy, material: &'a ViscousMaterial) -> Self {
        Self { energy, material }
    }

    /// Number of values that a point stores: S∞ and Qᵢ, three components each.
    fn of_point(&self) -> usize {
        match self.material.relaxation.len() {
            0 => 0,
            branches => 3 * (1 + branches),
        }
    }

    /// The viscous stress at a point, and its derivatives with respect to F and Ḟ.
    fn point_stress(
        &self,
        law: &dyn HyperelasticLaw,
        kinematics: &Kinematics,
        rate: &PlaneTensor,
        memory: &[f64],
        elapsed: f64,
        with_tangents: bool,
    ) -> (PlaneTensor, Option<[Matrix4<f64>; 2]>) {
        let material = self.material;
        let mut stress = material.newtonian_stress(kinematics, rate);
        let mut by_displacement = Matrix4::zeros();
        if !material.relaxation.is_empty() {
            let (long, tangent) = if with_tangents {
                let response = law.response(kinematics);
                (response.first_piola_kirchhoff_stress, response.tangent)
            } else {
                (law.stress(kinematics).1, by_displacement)
            };
            let now = second_piola_kirchhoff(kinematics, &long);
            let branches = material.branches(memory, now, elapsed);
            let q = [0, 1, 2].map(|i| branches.iter().map(|q| q[i]).sum());
            stress += first_piola_kirchhoff(kinematics, q);
            if with_tangents {
                let taken = material.taken(elapsed);
                let rest = [0, 1, 2].map(|i| q[i] - taken * now[i]);
                by_displacement = taken * tangent + geometric_tangent(rest);
            }
        }
        let tangents = || [by_displacement, material.newtonian_tangent(kinematics)];
        (stress, with_tangents.then(tangents))
    }

    /// Sampling points of an element with their kinematics and their part of the element's memory.
    fn points(
        &self,
        element: usize,
        u: &[f64],
    ) -> Result<Vec<(SamplingPoint<'a>, Kinematics)>, Inadmissible> {
        let points = self.energy.cell_points(element);
        points
            .map(|point| {
                let kinematics = Kinematics::new(&point.gradient(u));
                Ok((point, kinematics.map_err(|_| Inadmissible { element })?))
            })
            .collect()
    }

    fn part<'m>(&self, memory: &'m [f64], point: usize) -> &'m [f64] {
        &memory[point * self.of_point()..(point + 1) * self.of_point()]
    }
}

impl Viscosity for SheetViscosity<'_> {
    fn memory(&self, element: usize) -> usize {
        self.of_point() * self.energy.cell_points(element).len()
    }

    fn depends_on_rates(&self) -> bool {
        self.material.shear_viscosity > 0.0
    }

    fn add_element(
        &self,
        element: usize,
        motion: ElementMotion<'_>,
        mut local: ViscousLocal<'_>,
    ) -> Result<(), Inadmissible> {
        let law = self.energy.laws().of(element);
        let points = self.points(element, motion.displacement)?;
        for (index, (point, kinematics)) in points.into_iter().enumerate() {
            let (stress, tangents) = self.point_stress(
                law,
                &kinematics,
                &point.gradient(motion.velocity),
                self.part(motion.memory, index),
                motion.elapsed,
                local.tangents.is_some(),
            );
            point.add_force(&stress, local.force);
            if let (Some(sums), Some(tangents)) = (&mut local.tangents, tangents) {
                for (sum, tangent) in sums.iter_mut().zip(tangents) {
                    point.add_stiffness(tangent.as_slice(), sum);
                }
            }
        }
        Ok(())
    }

    fn remember(
        &self,
        element: usize,
        motion: ElementMotion<'_>,
        next: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let law = self.energy.laws().of(element);
        let points = self.points(element, motion.displacement)?;
        for (index, (_, kinematics)) in points.into_iter().enumerate() {
            let (_, long) = law.stress(&kinematics);
            let now = second_piola_kirchhoff(&kinematics, &long);
            let part = self.part(motion.memory, index);
            let branches = self.material.branches(part, now, motion.elapsed);
            let values = now.into_iter().chain(branches.into_iter().flatten());
            let start = index * self.of_point();
            for (to, value) in next[start..].iter_mut().zip(values) {
                *to = value;
            }
        }
        Ok(())
    }
}
