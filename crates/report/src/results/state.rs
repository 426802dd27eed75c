//! Stress and strain of a sheet at its nodes and in its cells.

use nalgebra::Vector4;

use crate::material::HyperelasticLaw;
use crate::material::sheet::Kinematics;
use crate::material::softened_law::StressAfter;
use crate::mesh::Mesh;
use crate::problem::CellLaws;

/// The state of the material at a displacement gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalState {
    /// First Piola–Kirchhoff stress in MPa: components 11, 12, 21, 22.
    pub first_piola_kirchhoff: [f64; 4],
    /// P₃₃ = J σ₃₃ in MPa, with the area ratio J in the plane: zero in plane stress.
    pub nominal_across: f64,
    /// Cauchy stress in MPa: components 11, 22, 33, 12.
    pub cauchy: [f64; 4],
    /// Green–Lagrange strain E = ½ (FᵀF − 1): components 11, 22, 33, 12.
    pub green_lagrange: [f64; 4],
    /// Principal stretches in the plane, the larger first, and that of the thickness.
    pub stretches: [f64; 3],
    /// I₁ = tr C = λ₁² + λ₂² + λ₃², with the sheet's own λ₃.
    pub first_invariant: f64,
    /// Energy per reference volume that is stored, in mJ/mm³.
    pub energy: f64,
    /// Energy per reference volume that softening has dissipated, in mJ/mm³.
    pub dissipated: f64,
    /// The share of the stress that softening leaves; 1 without softening.
    pub softening_factor: f64,
}

impl LocalState {
    /// The state at the last of some displacement gradients H₁₁, H₁₂, H₂₁, H₂₂, preceded by those that a law with a memory
    /// remembers, with a viscous part of the first Piola–Kirchhoff stress in MPa; NaN where the sheet is turned inside out.
    pub fn of(law: &dyn HyperelasticLaw, gradients: &[[f64; 4]], viscous: [f64; 4]) -> Self {
        let Some((gradient, past)) = gradients.split_last() else {
            return Self::mean(&[]);
        };
        // A cell may fold between the points at which a solution is checked.
        let Ok(kinematics) = Kinematics::new(&Vector4::from(*gradient)) else {
            return Self::mean(&[]);
        };
        let past = past.iter().map(|gradient| Vector4::from(*gradient));
        let after = StressAfter::new(law, &kinematics, past);
        let p = after.stress + Vector4::from(viscous);
        let [s11, s12, s22] = law.cauchy_stress(&kinematics, &p);
        let [c11, c12, c22] = kinematics.twice_green_lagrange;
        let thickness = law.thickness_stretch(&kinematics);
        let across = after.factor * law.thickness_stress(&kinematics);
        let [larger, smaller] = kinematics.principal_stretches();
        Self {
            first_piola_kirchhoff: p.into(),
            nominal_across: nominal_across(law, &kinematics, across),
            cauchy: [s11, s22, across, s12],
            green_lagrange: [c11, c22, thickness * thickness - 1.0, c12].map(|c| 0.5 * c),
            stretches: [larger, smaller, thickness],
            first_invariant: 2.0 + c11 + c22 + thickness * thickness,
            energy: after.energy - after.dissipated,
            dissipated: after.dissipated,
            softening_factor: after.factor,
        }
    }

    /// The mean of some states, component by component; NaN of none.
    fn mean(states: &[Self]) -> Self {
        let share = 1.0 / states.len() as f64;
        let mean = |value: &dyn Fn(&Self) -> f64| share * states.iter().map(value).sum::<f64>();
        let four =
            |value: fn(&Self) -> [f64; 4]| [0, 1, 2, 3].map(|i| mean(&|state| value(state)[i]));
        if let [one] = states {
            return *one;
        }
        Self {
            first_piola_kirchhoff: four(|state| state.first_piola_kirchhoff),
            nominal_across: mean(&|state| state.nominal_across),
            cauchy: four(|state| state.cauchy),
            green_lagrange: four(|state| state.green_lagrange),
            stretches: [0, 1, 2].map(|i| mean(&|state| state.stretches[i])),
            first_invariant: mean(&|state| state.first_invariant),
            energy: mean(&|state| state.energy),
            dissipated: mean(&|state| state.dissipated),
            softening_factor: mean(&|state| state.softening_factor),
        }
    }

    /// Von Mises' equivalent stress √(3/2 s : s) of the Cauchy stress with its deviator s, in MPa.
    pub fn von_mises(&self) -> f64 {
        let [s11, s22, s33, s12] = self.cauchy;
        let differences = (s11 - s22).powi(2) + (s22 - s33).powi(2) + (s33 - s11).powi(2);
        (0.5 * differences + 3.0 * s12 * s12).sqrt()
    }

    /// The principal Cauchy stresses in the plane in MPa, the larger first.
    pub fn principal_cauchy(&self) -> [f64; 2] {
        let [s11, s22, _, s12] = self.cauchy;
        principal([s11, s12, s22])
    }

    /// The unit vector of the smaller principal Cauchy stress in the plane.
    pub fn smaller_direction(&self) -> [f64; 2] {
        let [s11, s22, _, s12] = self.cauchy;
        let (sine, cosine) = (0.5 * (-s12).atan2(0.5 * (s22 - s11))).sin_cos();
        [cosine, sine]
    }

    /// The largest principal Green–Lagrange strain in the plane.
    pub fn largest_principal_strain(&self) -> f64 {
        let [e11, e22, _, e12] = self.green_lagrange;
        principal([e11, e12, e22])[0]
    }
}

/// P₃₃ in MPa of the Cauchy stress σ₃₃ = `stress`: J σ₃₃; of a law of small strains, whose stresses are one, σ₃₃ itself.
fn nominal_across(law: &dyn HyperelasticLaw, kinematics: &Kinematics, stress: f64) -> f64 {
    if law.is_objective() {
        kinematics.area_ratio() * stress
    } else {
        stress
    }
}

/// The principal values of a plane tensor with the components 11, 12, 22, the larger first.
fn principal([s11, s12, s22]: [f64; 3]) -> [f64; 2] {
    let (mean, radius) = (0.5 * (s11 + s22), (0.5 * (s11 - s22)).hypot(s12));
    [mean + radius, mean - radius]
}

/// The states in the centres of the cells, of displacement fields and viscous stresses as [`LocalState::of`] takes them; without viscous
/// stresses there are none.
pub fn cell_states(
    laws: &CellLaws,
    mesh: &Mesh,
    fields: &[&[f64]],
    viscous: &[[f64; 4]],
) -> Vec<LocalState> {
    let law = |cell| laws.of(cell);
    states(law, fields, viscous, |field| cell_gradients(mesh, field))
}

/// The states at the nodes: those of the mean of the displacement gradients that the cells around a node have there; between cells of
/// different laws, the mean of the states on either side.
pub fn nodal_states(
    laws: &CellLaws,
    mesh: &Mesh,
    fields: &[&[f64]],
    viscous: &[[f64; 4]],
) -> Vec<LocalState> {
    let Some(cut) = laws.cut(mesh) else {
        let law = |_| laws.of(0);
        return states(law, fields, viscous, |field| nodal_gradients(mesh, field));
    };
    let fields: Vec<Vec<f64>> = fields.iter().map(|field| cut.field(field)).collect();
    let on_sides = states_within_parts(laws, &cut.mesh, &fields);
    let mut at_nodes = vec![Vec::new(); mesh.nodes.len()];
    for (node, state) in cut.originals.iter().zip(on_sides) {
        at_nodes[*node].push(state);
    }
    at_nodes
        .iter()
        .map(|states| LocalState::mean(states))
        .collect()
}

/// The states at the nodes of a mesh each of whose nodes belongs to cells of one law.
pub(super) fn states_within_parts(
    laws: &CellLaws,
    mesh: &Mesh,
    fields: &[Vec<f64>],
) -> Vec<LocalState> {
    let fields: Vec<&[f64]> = fields.iter().map(Vec::as_slice).collect();
    let mut cell_of = vec![0; mesh.nodes.len()];
    for cell in 0..mesh.cell_count() {
        mesh.cell(cell)
            .iter()
            .for_each(|node| cell_of[*node] = cell);
    }
    let law = |node: usize| laws.of(cell_of[node]);
    states(law, &fields, &[], |field| nodal_gradients(mesh, field))
}

fn states<'a>(
    law: impl Fn(usize) -> &'a dyn HyperelasticLaw,
    fields: &[&[f64]],
    viscous: &[[f64; 4]],
    gradients: impl Fn(&[f64]) -> Vec<[f64; 4]>,
) -> Vec<LocalState> {
    let gradients: Vec<_> = fields.iter().map(|field| gradients(field)).collect();
    let state = |position: usize| {
        let local: Vec<[f64; 4]> = gradients.iter().map(|field| field[position]).collect();
        let viscous = viscous.get(position).copied().unwrap_or_default();
        LocalState::of(law(position), &local, viscous)
    };
    let positions = gradients.last().map_or(0, Vec::len);
    (0..positions).map(state).collect()
}

/// The displacement gradients in the centres of the cells.
pub fn cell_gradients(mesh: &Mesh, displacement: &[f64]) -> Vec<[f64; 4]> {
    let gradient = |cell| mesh.gradient_at(displacement, cell, mesh.shape(cell).centre());
    (0..mesh.cell_count()).map(gradient).collect()
}

/// The mean of the displacement gradients that the cells around each node have there.
pub fn nodal_gradients(mesh: &Mesh, displacement: &[f64]) -> Vec<[f64; 4]> {
    let mut sums = vec![([0.0; 4], 0.0); mesh.nodes.len()];
    for cell in 0..mesh.cell_count() {
        let locals = mesh.shape(cell).natural_nodes();
        for (node, local) in mesh.cell(cell).iter().zip(locals) {
            let (sum, count) = &mut sums[*node];
            let gradient = mesh.gradient_at(displacement, cell, *local);
            if gradient.iter().all(|part| part.is_finite()) {
                *count += 1.0;
                for (sum, part) in sum.iter_mut().zip(gradient) {
                    *sum += part;
                }
            }
        }
    }
    let means = sums.iter();
    means
        .map(|(sum, count)| sum.map(|sum| sum / count))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::material::volume::bulk_modulus;
    use crate::material::{NeoHooke, PlaneState, SoftenedLaw, Softening, Volume, VolumeEnergy};
    use crate::mesh::{CellShape, Shape};
    use crate::results::displacements;

    const LAW: NeoHooke = NeoHooke { c10: 0.5 };
    const NONE: [f64; 4] = [0.0; 4];

    fn laws() -> CellLaws {
        Arc::new(LAW).into()
    }

    #[test]
    fn softening_takes_its_factor_from_all_stresses() {
        let softening = Softening {
            r: 2.0,
            m: 0.01,
            beta: 0.1,
        };
        let law = SoftenedLaw::unloaded(Arc::new(LAW), softening);
        let [small, large] = [[0.2, 0.1, 0.0, -0.1], [0.6, 0.1, 0.0, -0.2]];
        let [virgin, soft] =
            [&[small][..], &[large, small]].map(|past| LocalState::of(&law, past, NONE));
        assert_eq!(virgin.softening_factor, 1.0);
        assert!((0.5..0.9).contains(&soft.softening_factor));
        for (soft_stress, stress) in soft.cauchy.iter().zip(virgin.cauchy) {
            assert!((soft_stress - soft.softening_factor * stress).abs() < 1e-14);
        }
    }

    #[test]
    fn uniaxial_tension_has_its_stress_and_strain_at_every_node_and_in_every_cell() {
        let (along, across) = (1.44_f64, 1.0 / 1.2);
        // σ = 2 C₁₀ (λ² − 1/λ), which is both the largest and the equivalent stress.
        let stress = along * along - 1.0 / along;
        for (name, kind) in CellShape::NAMES {
            let mesh = Shape::Strip { size: [3.0, 1.0] }.mesh(2, kind);
            let u = displacements(&mesh, |[x, y]| [(along - 1.0) * x, (across - 1.0) * y]);
            let [nodal, cells] =
                [nodal_states, cell_states].map(|of| of(&laws(), &mesh, &[&u], &[]));
            assert_eq!(
                (nodal.len(), cells.len()),
                (mesh.nodes.len(), mesh.cell_count())
            );
            for state in nodal.iter().chain(&cells) {
                let stresses = [
                    state.von_mises(),
                    state.principal_cauchy()[0],
                    state.cauchy[0],
                ];
                assert!(
                    stresses.iter().all(|s| (s - stress).abs() < 1e-12),
                    "{name} {stresses:?}"
                );
                let strain = 0.5 * (along * along - 1.0);
                assert!((state.largest_principal_strain() - strain).abs() < 1e-12);
                assert!((state.green_lagrange[2] - 0.5 * (1.0 / along - 1.0)).abs() < 1e-12);
            }
        }
    }

    /// C₁₀ (J₃^(−⅔) I₁ − 3) + ½ κ (J₃ − 1)², whose stress across the sheet is ∂W/∂λ₃ of stretches λ₁, λ₂, λ₃.
    #[test]
    fn a_sheet_that_changes_its_volume_has_the_first_invariant_and_the_stress_of_its_own_thickness()
    {
        let (c10, kappa) = (0.5, bulk_modulus(1.0, 0.3));
        let energy = |stretches: [f64; 3]| {
            let volume: f64 = stretches.iter().product();
            let squares: f64 = stretches.iter().map(|stretch| stretch * stretch).sum();
            c10 * (volume.powf(-2.0 / 3.0) * squares - 3.0) + 0.5 * kappa * (volume - 1.0).powi(2)
        };
        for plane in [PlaneState::Stress, PlaneState::Strain] {
            let volume = Volume {
                bulk_modulus: kappa,
                energy: VolumeEnergy::Quadratic,
                plane,
            };
            let law = Arc::new(NeoHooke { c10 }).with_volume(volume).unwrap();
            let state = LocalState::of(&*law, &[[0.25, 0.15, 0.1, -0.08]], NONE);
            let squares: f64 = state
                .stretches
                .iter()
                .map(|stretch| stretch * stretch)
                .sum();
            assert!((state.first_invariant - squares).abs() < 1e-12, "{plane:?}");
            let [first, second, third] = state.stretches;
            let at = |step: f64| energy([first, second, third + step]);
            let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!(
                (state.nominal_across - slope).abs() < 1e-8,
                "{plane:?} {slope}"
            );
            let is_strained = plane == PlaneState::Strain;
            assert_eq!(
                (third == 1.0, slope.abs() > 0.1),
                (is_strained, is_strained)
            );
        }
    }

    #[test]
    fn simple_shear_has_its_equivalent_stress() {
        // σ₁₁ = μ γ², σ₁₂ = μ γ with μ = 2 C₁₀.
        let state = LocalState::of(&LAW, &[[0.0, 0.4, 0.0, 0.0]], NONE);
        let expected = (0.16_f64.powi(2) + 3.0 * 0.16).sqrt();
        assert!((state.von_mises() - expected).abs() < 1e-12, "{state:?}");
        let [larger, smaller] = state.principal_cauchy();
        assert!((larger + smaller - 0.16).abs() < 1e-12 && (larger * smaller + 0.16).abs() < 1e-12);
    }

    #[test]
    fn the_mean_at_a_node_is_exact_in_the_middle_of_equal_cells() {
        let mesh = Mesh::plate([4.0, 4.0], [4, 4], CellShape::Quad4);
        let u = displacements(&mesh, |[x, _]| [0.02 * x * x, 0.0]);
        let states = nodal_states(&laws(), &mesh, &[&u], &[]);
        let inside = mesh.nodes.iter().zip(&states);
        for ([x, _], state) in inside.filter(|([x, _], _)| *x > 0.5 && *x < 3.5) {
            let stretch = 1.0 + 0.04 * x;
            assert!((state.green_lagrange[0] - 0.5 * (stretch * stretch - 1.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_inside_out_has_no_numbers() {
        let state = LocalState::of(&LAW, &[[-2.0, 0.0, 0.0, 0.0]], NONE);
        assert!(state.von_mises().is_nan() && state.largest_principal_strain().is_nan());
    }
}
