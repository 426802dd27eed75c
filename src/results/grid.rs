//! Grids with named arrays as data: what a VTK file holds.
//!
//! Units are part of the arrays' names. Stresses and what belongs to them are those of the material at
//! the field's gradient in the centre of each cell; tensors go row by row, and the nominal stress is Pᵀ: its first
//! index is the reference direction.

use nalgebra::Vector4;

use super::wrinkling::Wrinkling;
use crate::finite_element::error_estimate::EnergyError;
use crate::mass_spring::{MassSpring, SpringState};
use crate::material::HyperelasticLaw;
use crate::material::sheet::Kinematics;
use crate::mesh::{CellShape, Mesh};

/// What the stresses of a sheet follow from.
#[derive(Clone, Copy)]
pub struct Sheet<'a> {
    /// The material.
    pub law: &'a dyn HyperelasticLaw,
    /// Thickness in mm.
    pub thickness: f64,
}

/// Named numbers at the points or in the cells of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Its name with the unit.
    pub name: &'static str,
    /// Its values.
    pub values: Vec<f64>,
    /// How many belong to one point or cell: 1, 2 (x, y), 3 (x, y, z) or 4 (xx, xy, yx, yy).
    pub components: usize,
}

impl Array {
    /// One number each.
    pub fn scalars(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, 1, values)
    }

    /// Vectors in the plane.
    pub fn vectors(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, 2, values)
    }

    /// Tensors in the plane.
    pub fn tensors(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, 4, values)
    }

    fn new(name: &'static str, components: usize, values: impl IntoIterator<Item = f64>) -> Self {
        Self {
            name,
            values: values.into_iter().collect(),
            components,
        }
    }

    /// The difference of a displacement field from the finite elements' at the same nodes.
    pub fn to_finite_elements(displacement: &[f64], reference: &[f64]) -> Self {
        let pairs = displacement.iter().zip(reference);
        Self::vectors(
            "difference_to_finite_elements_mm",
            pairs.map(|(u, v)| u - v),
        )
    }

    /// An imported displacement field, and the difference of another from it.
    pub fn imported(displacement: &[f64], imported: &[f64]) -> [Self; 2] {
        let pairs = displacement.iter().zip(imported);
        [
            Self::vectors("imported_displacement_mm", imported.iter().copied()),
            Self::vectors("difference_to_imported_mm", pairs.map(|(u, v)| u - v)),
        ]
    }

    /// The estimated error in each cell, η_c/‖u_h‖: the root of the sum of their squares is the error of the field in %.
    pub fn estimated_error(error: &EnergyError) -> Self {
        Self::scalars(
            "estimated_error_percent_of_energy_norm",
            error.cell_percents(),
        )
    }

    fn displacement(values: &[f64]) -> Self {
        Self::vectors("displacement_mm", values.iter().copied())
    }
}

/// The kind of a cell of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridCell {
    /// A point.
    Vertex,
    /// Two points.
    Line,
    /// A cell of a mesh.
    Mesh(CellShape),
}

impl GridCell {
    /// How many points it has.
    pub fn points(self) -> usize {
        match self {
            Self::Vertex => 1,
            Self::Line => 2,
            Self::Mesh(shape) => shape.nodes(),
        }
    }
}

/// Points, cells, and arrays at both.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Places at rest in mm.
    pub points: Vec<[f64; 2]>,
    /// The kinds of the cells.
    pub cells: Vec<GridCell>,
    /// The points of cell after cell.
    pub connectivity: Vec<usize>,
    /// Arrays at the points.
    pub at_points: Vec<Array>,
    /// Arrays in the cells.
    pub in_cells: Vec<Array>,
}

impl Grid {
    fn new(points: &[[f64; 2]], cells: Vec<GridCell>, connectivity: Vec<usize>) -> Self {
        Self {
            points: points.to_vec(),
            cells,
            connectivity,
            at_points: Vec::new(),
            in_cells: Vec::new(),
        }
    }

    /// Scattered points.
    pub fn scattered(places: &[[f64; 2]], displacement: &[f64]) -> Self {
        let cells = vec![GridCell::Vertex; places.len()];
        let grid = Self::new(places, cells, (0..places.len()).collect());
        grid.with([Array::displacement(displacement)])
    }

    /// A displacement field on the mesh of a sheet, with the stresses that follow.
    ///
    /// # Panics
    /// When a cell is inverted at its centre.
    pub fn sheet(sheet: Sheet, mesh: &Mesh, displacement: &[f64]) -> Self {
        let cells = 0..mesh.cell_count();
        let kinds = cells.clone().map(|cell| GridCell::Mesh(mesh.shape(cell)));
        let connectivity = cells.flat_map(|cell| mesh.cell(cell)).copied().collect();
        Self::new(&mesh.nodes, kinds.collect(), connectivity)
            .with([Array::displacement(displacement)])
            .with_in_cells(material_state(sheet, mesh, displacement))
    }

    /// The springs of a lattice.
    pub fn springs(model: &MassSpring, displacement: &[f64]) -> Self {
        let connectivity = model.springs.iter().flat_map(|spring| spring.nodes);
        let cells = vec![GridCell::Line; model.springs.len()];
        let states = model.spring_states(displacement);
        let of =
            |name, value: fn(&SpringState) -> f64| Array::scalars(name, states.iter().map(value));
        Self::new(&model.mesh.nodes, cells, connectivity.collect())
            .with([Array::displacement(displacement)])
            .with_in_cells([
                of("force_N", |state| state.force),
                of("stretch_1", |state| state.stretch),
            ])
    }

    /// With more arrays at its points.
    #[must_use]
    pub fn with(mut self, arrays: impl IntoIterator<Item = Array>) -> Self {
        self.at_points.extend(arrays);
        self
    }

    /// With more arrays in its cells.
    #[must_use]
    pub fn with_in_cells(mut self, arrays: impl IntoIterator<Item = Array>) -> Self {
        self.in_cells.extend(arrays);
        self
    }
}

/// Stresses, stretches, thickness and energy in the centres of the cells; no numbers where a cell is folded there.
fn material_state(sheet: Sheet, mesh: &Mesh, displacement: &[f64]) -> [Array; 8] {
    let (mut nominal, mut cauchy, mut stretches) = (Vec::new(), Vec::new(), Vec::new());
    let (mut i1, mut thickness, mut energy) = (Vec::new(), Vec::new(), Vec::new());
    for cell in 0..mesh.cell_count() {
        let gradient = mesh.gradient_at(displacement, cell, mesh.shape(cell).centre());
        // A cell may fold between the points where a solution is held to be sound.
        let Ok(kinematics) = Kinematics::new(&Vector4::from(gradient)) else {
            nominal.extend([f64::NAN; 4]);
            cauchy.extend([f64::NAN; 4]);
            stretches.extend([f64::NAN; 3]);
            for values in [&mut i1, &mut thickness, &mut energy] {
                values.push(f64::NAN);
            }
            continue;
        };
        let (density, p) = sheet.law.stress(&kinematics);
        nominal.extend([p[0], p[2], p[1], p[3]]);
        let [s11, s12, s22] = sheet.law.cauchy_stress(&kinematics, &p);
        cauchy.extend([s11, s12, s12, s22]);
        let thickness_stretch = sheet.law.thickness_stretch(&kinematics);
        stretches.extend(kinematics.principal_stretches());
        stretches.push(thickness_stretch);
        i1.push(3.0 + kinematics.invariants.i1_minus_3);
        thickness.push(sheet.thickness * thickness_stretch);
        energy.push(density);
    }
    let wrinkling = Wrinkling::new(sheet.law, mesh, displacement);
    let compressed = wrinkling.compressed.iter();
    let compressed = compressed.map(|is| f64::from(u8::from(*is)));
    [
        Array::tensors("nominal_stress_MPa", nominal),
        Array::tensors("cauchy_stress_MPa", cauchy),
        Array::scalars("smallest_principal_cauchy_stress_MPa", wrinkling.smallest),
        Array::scalars("wrinkling_1", compressed),
        Array::new("principal_stretches_1", 3, stretches),
        Array::scalars("first_invariant_I1_1", i1),
        Array::scalars("thickness_mm", thickness),
        Array::scalars("energy_density_mJ_per_mm3", energy),
    ]
}

/// Grids that belong together: those of one model at load factors, stretches, instants or frames.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSeries {
    /// The model's name for files.
    pub name: String,
    /// Its grids; those with a time are played one after the other.
    pub grids: Vec<NamedGrid>,
}

/// A grid of a series.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedGrid {
    /// The name of its file, without extension.
    pub name: String,
    /// Where it stands in its series: a load factor, a stretch, or a time in s.
    pub time: Option<f64>,
    /// The grid.
    pub grid: Grid,
}

impl GridSeries {
    /// Grids with their numbers and times; the numbers in the names of the files have so many digits.
    pub fn numbered(
        name: &str,
        digits: usize,
        grids: impl IntoIterator<Item = (usize, f64, Grid)>,
    ) -> Self {
        let named = |(number, time, grid)| NamedGrid {
            name: format!("{name}_{number:0digits$}"),
            time: Some(time),
            grid,
        };
        Self {
            name: name.to_owned(),
            grids: grids.into_iter().map(named).collect(),
        }
    }

    /// Grids at load factors or stretches: `NAME_001` and so on.
    pub fn steps(name: &str, grids: impl IntoIterator<Item = (f64, Grid)>) -> Self {
        let grids = grids.into_iter().zip(1..);
        Self::numbered(
            name,
            3,
            grids.map(|((time, grid), number)| (number, time, grid)),
        )
    }

    /// Grids at instants: `NAME_00001` and so on.
    pub fn instants(name: &str, grids: impl IntoIterator<Item = (f64, Grid)>) -> Self {
        let grids = grids.into_iter().zip(1..);
        Self::numbered(
            name,
            5,
            grids.map(|((time, grid), number)| (number, time, grid)),
        )
    }

    /// A grid that stands for itself.
    pub fn single(name: &str, grid: Grid) -> Self {
        let grid = NamedGrid {
            name: name.to_owned(),
            time: None,
            grid,
        };
        Self {
            name: name.to_owned(),
            grids: vec![grid],
        }
    }
}
