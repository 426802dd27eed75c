//! Stress, strain and related quantities as arrays of a grid.

use super::sheet::Sheet;
use super::state::{LocalState, cell_states, nodal_states};
use super::wrinkling::Wrinkling;
use super::{Array, Components};
use crate::mesh::Mesh;

/// Arrays at the nodes, from the mean of the displacement gradients that the cells around each node have there.
pub fn nodal(sheet: Sheet, mesh: &Mesh, displacement: &[f64]) -> [Array; 5] {
    let viscous = sheet.viscous.map_or(&[][..], |stress| &stress.at_nodes);
    let laws = sheet.laws.in_cells(mesh);
    let states = nodal_states(&laws, mesh, &sheet.fields(displacement), viscous);
    let of = |name, value: fn(&LocalState) -> f64| Array::scalars(name, states.iter().map(value));
    let tensors = |name, value: fn(&LocalState) -> [f64; 4]| {
        Array::new(name, Components::Symmetric, states.iter().flat_map(value))
    };
    [
        tensors("cauchy_stress_at_nodes_MPa", |state| state.cauchy),
        of("von_mises_stress_at_nodes_MPa", LocalState::von_mises),
        of("largest_principal_cauchy_stress_at_nodes_MPa", |state| {
            state.principal_cauchy()[0]
        }),
        tensors("green_lagrange_strain_at_nodes", |state| {
            state.green_lagrange
        }),
        of(
            "largest_principal_green_lagrange_strain_at_nodes",
            LocalState::largest_principal_strain,
        ),
    ]
}

/// Arrays in the cells, from the displacement gradients in their centres. The nominal stress is Pᵀ: its first index is the
/// reference direction. For a softening material there are two more: the dissipated energy and the remaining share of the stress; for a sheet of
/// several regions, the number of each cell's.
pub fn in_cells(sheet: Sheet, mesh: &Mesh, displacement: &[f64]) -> Vec<Array> {
    let viscous = sheet.viscous.map_or(&[][..], |stress| &stress.in_cells);
    let laws = sheet.laws.in_cells(mesh);
    let states = cell_states(&laws, mesh, &sheet.fields(displacement), viscous);
    let wrinkling = Wrinkling::of_cells(sheet, mesh, displacement, &states);
    let states = || states.iter();
    let of = |name, value: fn(&LocalState) -> f64| Array::scalars(name, states().map(value));
    let nominal = states().flat_map(|state| {
        let [p11, p12, p21, p22] = state.first_piola_kirchhoff;
        [p11, p21, p12, p22, state.nominal_across]
    });
    let tensors = |name, value: fn(&LocalState) -> [f64; 4]| {
        Array::new(name, Components::Symmetric, states().flat_map(value))
    };
    let exceeded = wrinkling.exceeded.iter();
    let exceeded = exceeded.map(|is| f64::from(u8::from(*is)));
    let thickness = states().map(|state| sheet.thickness * state.stretches[2]);
    let mut arrays = vec![
        Array::tensors("nominal_stress_MPa", nominal),
        tensors("cauchy_stress_MPa", |state| state.cauchy),
        of("von_mises_stress_MPa", LocalState::von_mises),
        of("largest_principal_cauchy_stress_MPa", |state| {
            state.principal_cauchy()[0]
        }),
        Array::scalars("smallest_principal_cauchy_stress_MPa", wrinkling.smallest),
        Array::scalars("wrinkling", exceeded),
        tensors("green_lagrange_strain", |state| state.green_lagrange),
        of(
            "largest_principal_green_lagrange_strain",
            LocalState::largest_principal_strain,
        ),
        Array::new(
            "principal_stretches",
            Components::Stretches,
            states().flat_map(|state| state.stretches),
        ),
        of("first_invariant_I1", |state| state.first_invariant),
        Array::scalars("thickness_mm", thickness),
        of("energy_density_mJ_per_mm3", |state| state.energy),
    ];
    if sheet.laws.soften() {
        arrays.push(of("dissipated_energy_density_mJ_per_mm3", |state| {
            state.dissipated
        }));
        arrays.push(of("softening_factor", |state| state.softening_factor));
    }
    if !sheet.laws.regions.is_empty() {
        let numbers = (0..mesh.cell_count()).map(|cell| f64::from(laws.number(cell)));
        arrays.push(Array::scalars("region", numbers));
    }
    arrays
}
