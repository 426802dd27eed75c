//! The viscous part of the stresses of a sheet that moves, from its displacement fields.

use nalgebra::Vector4;

use super::state::{cell_gradients, nodal_gradients};
use crate::material::HyperelasticLaw;
use crate::material::sheet::Kinematics;
use crate::material::viscosity::{ViscousMaterial, first_piola_kirchhoff, second_piola_kirchhoff};
use crate::mesh::Mesh;

/// The viscous part of the first Piola–Kirchhoff stress in MPa, components 11, 12, 21, 22; nothing where the material has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViscousStress {
    /// In the centres of the cells.
    pub in_cells: Vec<[f64; 4]>,
    /// At the nodes, of the mean of the displacement gradients that the cells around each have there.
    pub at_nodes: Vec<[f64; 4]>,
}

impl ViscousStress {
    /// The stress at each of some times in s, from the displacements in mm and the velocities in mm/s at these times, of a sheet that was fully
    /// relaxed at the first one. Between two times the long-term stress is taken as linear in time.
    pub fn over_time(
        law: &dyn HyperelasticLaw,
        material: &ViscousMaterial,
        mesh: &Mesh,
        times: &[f64],
        motion: &[[&[f64]; 2]],
    ) -> Vec<Self> {
        if material.is_none() {
            return vec![Self::default(); motion.len()];
        }
        let positions = [cell_gradients, nodal_gradients];
        let mut memories = positions.map(|_| Vec::new());
        let mut last = times.first().copied().unwrap_or_default();
        let at_instant = |(time, fields): (&f64, &[&[f64]; 2])| {
            let elapsed = time - last;
            last = *time;
            let mut positions = positions
                .iter()
                .zip(&mut memories)
                .map(|(gradients, memory)| {
                    let [now, rate] = fields.map(|field| gradients(mesh, field));
                    memory.resize_with(now.len(), Vec::new);
                    let pairs = now.iter().zip(&rate).zip(memory);
                    pairs
                        .map(|((now, rate), memory)| {
                            stress(law, material, [now, rate], memory, elapsed)
                        })
                        .collect()
                });
            let mut next = || positions.next().expect("cells and nodes");
            Self {
                in_cells: next(),
                at_nodes: next(),
            }
        };
        times.iter().zip(motion).map(at_instant).collect()
    }
}

/// The viscous stress at a point. `memory` holds S∞ and Qᵢ at the time before, `elapsed` s ago, and receives those of now; it is empty for a
/// material that is fully relaxed. NaN where the sheet is turned inside out.
fn stress(
    law: &dyn HyperelasticLaw,
    material: &ViscousMaterial,
    [gradient, rate]: [&[f64; 4]; 2],
    memory: &mut Vec<f64>,
    elapsed: f64,
) -> [f64; 4] {
    let Ok(kinematics) = Kinematics::new(&Vector4::from(*gradient)) else {
        return [f64::NAN; 4];
    };
    let (_, long) = law.stress(&kinematics);
    let now = second_piola_kirchhoff(&kinematics, &long);
    let branches = if memory.is_empty() {
        vec![[0.0; 3]; material.relaxation.len()]
    } else {
        material.branches(memory, now, elapsed)
    };
    let q = [0, 1, 2].map(|i| branches.iter().map(|q| q[i]).sum());
    *memory = now
        .into_iter()
        .chain(branches.into_iter().flatten())
        .collect();
    let newtonian = material.newtonian_stress(&kinematics, &Vector4::from(*rate));
    (newtonian + first_piola_kirchhoff(&kinematics, q)).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::NeoHooke;
    use crate::material::viscosity::Relaxation;
    use crate::mesh::CellShape;
    use crate::results::displacements;

    const LAW: NeoHooke = NeoHooke { c10: 0.05 };

    /// ux, uy of a strip that is stretched without a stress across.
    fn stretched(mesh: &Mesh, stretch: f64) -> Vec<f64> {
        let across = stretch.powf(-0.5) - 1.0;
        displacements(mesh, |[x, y]| [(stretch - 1.0) * x, across * y])
    }

    /// A sudden stretch, S(t) = S∞ (1 + Σ βᵢ e^(−t/τᵢ)), in cells and at nodes.
    #[test]
    fn a_sudden_stretch_relaxes_as_the_series_says() {
        let branch = |share, time| Relaxation { share, time };
        let material = ViscousMaterial {
            relaxation: vec![branch(0.3, 0.5), branch(0.1, 5.0)],
            ..ViscousMaterial::default()
        };
        let mesh = Mesh::plate([4.0, 2.0], [4, 2], CellShape::Quad4);
        let [rest, held] = [1.0, 1.4].map(|stretch| stretched(&mesh, stretch));
        let still = vec![0.0; rest.len()];
        let times = [0.0, 1e-9, 0.4, 1.7, 12.0];
        let motion: Vec<_> = [&rest, &held, &held, &held, &held]
            .map(|field| [&field[..], &still[..]])
            .into();
        let stresses = ViscousStress::over_time(&LAW, &material, &mesh, &times, &motion);
        let long = 2.0 * LAW.c10 * (1.4 - 1.4_f64.powi(-2));
        assert!(
            stresses[0]
                .in_cells
                .iter()
                .flatten()
                .all(|part| *part == 0.0)
        );
        for (time, stress) in times.iter().zip(&stresses).skip(1) {
            let expected = long * (material.relaxation_function(*time) - 1.0);
            for p in stress.in_cells.iter().chain(&stress.at_nodes) {
                assert!(
                    (p[0] - expected).abs() < 1e-8 * long,
                    "{time}: {p:?} {expected}"
                );
                assert!(p[1..].iter().all(|part| part.abs() < 1e-8 * long));
            }
        }
    }

    /// 3 η λ̇/λ² of a Newtonian strip.
    #[test]
    fn a_fluid_resists_by_its_rate() {
        let material = ViscousMaterial {
            shear_viscosity: 0.7,
            ..ViscousMaterial::default()
        };
        let mesh = Mesh::plate([4.0, 2.0], [4, 2], CellShape::Quad4);
        let (u, rate) = (stretched(&mesh, 1.2), 0.3);
        let across = -0.5 * 1.2_f64.powf(-1.5) * rate;
        let v = displacements(&mesh, |[x, y]| [rate * x, across * y]);
        let stresses = ViscousStress::over_time(&LAW, &material, &mesh, &[0.0], &[[&u, &v]]);
        let expected = material.newtonian_tension(1.2, rate)[0];
        assert!((stresses[0].in_cells[0][0] - expected).abs() < 1e-12);
    }
}
