//! Where a sheet is under more compression than its bending stiffness bears: there it wrinkles or buckles out of its plane.

mod critical;
mod regions;

use nalgebra::Matrix4;

use super::BESIDE_CORNERS;
use super::sheet::Sheet;
use super::state::{LocalState, cell_states};
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::material::{HyperelasticLaw, PlaneState};
use crate::mesh::Mesh;
use crate::units::number;
use critical::Bending;
use regions::Deformed;

/// Compression below this share of E₀ is what rounding leaves.
const ROUNDING: f64 = 1e-10;

/// The share of the critical compression from which on a sheet may wrinkle: the critical one is an estimate within a factor of two.
const CERTAIN: f64 = 0.5;

/// The compression of a sheet, cell by cell, at the centres of the cells, beside the one that is critical there.
///
/// Each connected part under compression is taken for a plate of its deformed thickness with the moduli at rest, which the sheet around it
/// holds; see `Bending::critical_stress`. The thicknesses at which clamped, stretched sheets begin to wrinkle in an eigenvalue analysis of the
/// whole plate come out within a factor of two.
#[derive(Clone, Debug)]
pub struct Wrinkling {
    /// The smaller principal Cauchy stress in the plane in MPa.
    pub smallest: Vec<f64>,
    /// Whether a cell of a thin sheet is under more than half of the critical compression; never in plane strain.
    pub exceeded: Vec<bool>,
    /// The share of these cells in the reference area in %.
    pub area_percent: f64,
    /// Compression and critical compression in MPa in the cell where their ratio is largest.
    pub worst: [f64; 2],
}

impl Wrinkling {
    /// The compression of a displacement field.
    pub fn new(sheet: Sheet, mesh: &Mesh, displacement: &[f64]) -> Self {
        let viscous = sheet.viscous.map_or(&[][..], |stress| &stress.in_cells);
        let states = cell_states(&sheet.laws.in_cells(mesh), mesh, &[displacement], viscous);
        Self::of_cells(sheet, mesh, displacement, &states)
    }

    /// The compression of the states in the cells; a cell that is folded at its centre has no stress and counts nowhere.
    pub fn of_cells(
        sheet: Sheet,
        mesh: &Mesh,
        displacement: &[f64],
        states: &[LocalState],
    ) -> Self {
        let stresses: Vec<[f64; 2]> = states.iter().map(LocalState::principal_cauchy).collect();
        let laws = sheet.laws.in_cells(mesh);
        let limits = laws.all().iter().map(|law| match law.plane_state() {
            PlaneState::Stress => -ROUNDING * law.youngs_modulus(),
            PlaneState::Strain => f64::NEG_INFINITY,
        });
        let limits: Vec<f64> = limits.collect();
        let number = |cell: usize| usize::from(laws.number(cell));
        let compressed = stresses.iter().enumerate();
        let compressed = compressed.map(|(cell, [_, smaller])| *smaller < limits[number(cell)]);
        let compressed: Vec<bool> = compressed.collect();
        // Isotropic sheets have one tangent at rest.
        let tangents = laws.all().iter().map(|law| {
            let at_rest = || law.response(&Kinematics::rest()).tangent;
            law.is_isotropic().then(at_rest)
        });
        let tangents: Vec<Option<Matrix4<f64>>> = tangents.collect();
        let parts = Deformed::new(mesh, displacement, states).parts(&compressed);
        let mut worst = [0.0, f64::INFINITY];
        let mut exceeded = vec![false; states.len()];
        for (cell, part) in parts.into_iter().enumerate() {
            let Some(part) = part else { continue };
            let [_, smaller] = stresses[cell];
            let thickness = sheet.thickness * states[cell].stretches[2];
            let gradient = mesh.gradient_at(displacement, cell, mesh.shape(cell).centre());
            let waves = direction_at_rest(&gradient, states[cell].smaller_direction());
            let tangent = tangents[number(cell)]
                .unwrap_or_else(|| tangent_with_fibres(laws.of(cell), &states[cell]));
            let bending = Bending::new(&tangent, waves);
            let critical = bending.critical_stress(part, thickness).max(0.0);
            exceeded[cell] = -smaller > CERTAIN * critical;
            if -smaller * worst[1] > worst[0] * critical {
                worst = [-smaller, critical];
            }
        }
        Self {
            smallest: stresses.iter().map(|[_, smaller]| *smaller).collect(),
            area_percent: area_percent(mesh, &exceeded),
            exceeded,
            worst,
        }
    }
}

/// ∂P/∂F in MPa at a millionth of the strain of a state: at rest, but with fibres in the tension or compression that they have.
fn tangent_with_fibres(law: &dyn HyperelasticLaw, state: &LocalState) -> Matrix4<f64> {
    let [e11, e22, _, e12] = state.green_lagrange.map(|strain| 1e-6 * strain);
    let kinematics = Kinematics::new(&PlaneTensor::new(e11, e12, e12, e22));
    law.response(&kinematics.unwrap_or(Kinematics::rest()))
        .tangent
}

/// The direction Fᵀ k at rest, of length one, of waves along k in the deformed sheet.
fn direction_at_rest(gradient: &[f64; 4], [x, y]: [f64; 2]) -> [f64; 2] {
    let [h11, h12, h21, h22] = gradient;
    let (x, y) = ((1.0 + h11) * x + h21 * y, h12 * x + (1.0 + h22) * y);
    let length = x.hypot(y);
    [x / length, y / length]
}

/// The share of some cells in the reference area in %.
fn area_percent(mesh: &Mesh, cells: &[bool]) -> f64 {
    let (mut some, mut all) = (0.0, 0.0);
    for (cell, is_one) in cells.iter().enumerate() {
        let area = mesh.cell_area(cell);
        all += area;
        some += if *is_one { area } else { 0.0 };
    }
    100.0 * some / all
}

/// The warning about the states of a model, each at a load that is named: about the one that exceeds the critical compression most. A
/// hundredth of the area may, as beside a force on a point, where no compression is the largest.
pub fn warning(states: impl Iterator<Item = (String, Wrinkling)>) -> Option<String> {
    let wrinkled = states.filter(|(_, wrinkling)| wrinkling.area_percent > 100.0 * BESIDE_CORNERS);
    let (load, worst) = wrinkled.max_by(|(_, one), (_, other)| {
        let [one, other] = [one.worst, other.worst];
        (one[0] * other[1]).total_cmp(&(other[0] * one[1]))
    })?;
    let [compression, critical] = worst.worst;
    Some(format!(
        "a sheet of this thickness may wrinkle or buckle on {:.1} % of its area at {load}, and lose stress that the plane solution still \
         carries: the compression reaches {} MPa, and about {} MPa are critical (to a factor of {} by local plate theory; array `wrinkling` of \
         the finite elements' VTK files).",
        worst.area_percent,
        number(compression),
        number(critical),
        1.0 / CERTAIN
    ))
}

#[cfg(test)]
mod tests;
