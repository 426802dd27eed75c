//! Named numbers of grids.

use crate::finite_element::error_estimate::EnergyError;

/// The components at one point or cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Components {
    /// One number.
    Scalar,
    /// x, y of a vector in the plane.
    Vector,
    /// 11, 12, 21, 22, 33 of a tensor without shear across the plane.
    Tensor,
    /// 11, 22, 33, 12 of a symmetric tensor without shear across the plane.
    Symmetric,
    /// The larger and the smaller principal stretch in the plane, and that of the thickness.
    Stretches,
}

impl Components {
    /// The number of values.
    pub fn count(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector => 2,
            Self::Stretches => 3,
            Self::Symmetric => 4,
            Self::Tensor => 5,
        }
    }
}

/// Named numbers at the points or in the cells of a grid.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Array {
    /// Its name with the unit.
    pub name: &'static str,
    /// Its values.
    pub values: Vec<f64>,
    /// The components at one point or cell.
    pub components: Components,
}

impl Array {
    /// An array with one number each.
    pub fn scalars(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, Components::Scalar, values)
    }

    /// An array of vectors in the plane.
    pub fn vectors(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, Components::Vector, values)
    }

    /// Tensors without shear across the plane: 11, 12, 21, 22, 33.
    pub fn tensors(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, Components::Tensor, values)
    }

    /// Numbers, those of one point or cell after the other.
    pub fn new(
        name: &'static str,
        components: Components,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
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

    /// A displacement field.
    pub fn displacement(values: &[f64]) -> Self {
        Self::vectors("displacement_mm", values.iter().copied())
    }
}
