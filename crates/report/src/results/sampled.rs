//! Fields of a sheet at single points, as ParaView interpolates the arrays at the nodes.

use std::borrow::Cow;

use super::sheet::NodalSheet;
use super::{Deformed, SheetField};
use crate::mesh::{Mesh, vectors};
use crate::problem::SheetLaws;

/// The cells that contain a point, with its natural coordinates in each; none of a point that is not on the sheet.
pub type Position = Vec<(usize, [f64; 2])>;

/// The positions of points at rest in a mesh. A point may lie outside of its nearest cell by `margin`, in sizes of the cell.
pub fn positions(mesh: &Mesh, points: &[[f64; 2]], margin: f64) -> Vec<Position> {
    let points = points.iter();
    points.map(|point| mesh.cells_at(*point, margin)).collect()
}

impl Deformed<'_> {
    /// All fields, in the order of [`SheetField::NAMES`], at positions in its mesh.
    ///
    /// Values at the nodes are means over the adjacent cells, and are interpolated by the shape functions. Where materials meet, the value is
    /// the mean of their sides.
    pub fn sampled(
        &self,
        laws: SheetLaws,
        positions: &[Position],
    ) -> Vec<Option<[f64; SheetField::NAMES.len()]>> {
        if positions.is_empty() {
            return Vec::new();
        }
        let sheet = NodalSheet::new(laws, self);
        let displacement: Vec<[f64; 2]> = vectors(&sheet.displacement).collect();
        let in_cell = |(cell, local): (usize, [f64; 2])| {
            let weights = sheet.mesh.shape(cell).values(local);
            let nodes = || sheet.mesh.cell(cell).iter().zip(&weights);
            SheetField::NAMES.map(|(_, field)| {
                let value = |node: usize| field.value(&sheet.states[node], displacement[node]);
                let parts = nodes().map(|(node, weight)| weight * value(*node));
                parts.sum::<f64>()
            })
        };
        // Fields of a sheet that is not cut are the same in all cells at a point.
        let sides = if matches!(sheet.mesh, Cow::Owned(_)) {
            usize::MAX
        } else {
            1
        };
        let sample = |position: &Position| {
            let cells = &position[..position.len().min(sides)];
            let mut values = cells.iter().map(|cell| in_cell(*cell));
            let first = values.next()?;
            let sum = values.fold(first, |sum, side| {
                std::array::from_fn(|field| sum[field] + side[field])
            });
            Some(sum.map(|sum| sum / cells.len() as f64))
        };
        positions.iter().map(sample).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::material::{HyperelasticLaw, NeoHooke};
    use crate::mesh::{CellShape, Shape};
    use crate::results::displacements;

    #[test]
    fn fields_of_uniaxial_tension_are_exact_at_every_point_and_there_are_none_in_a_hole() {
        let shape = Shape::StripWithHole {
            size: [30.0, 20.0],
            radius: 4.0,
        };
        let law: Arc<dyn HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.5 });
        let (along, across) = (1.44_f64, 1.0 / 1.2);
        for (name, kind) in CellShape::NAMES {
            let mesh = shape.mesh(8, kind);
            let u = displacements(&mesh, |[x, y]| [(along - 1.0) * x, (across - 1.0) * y]);
            let sheet = Deformed::elastic("", &mesh, vec![&u]);
            let [low, high] = mesh.bounding_box();
            let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
            let points = [[low[0] + 2.3, low[1] + 1.7], high, middle];
            let positions = positions(&mesh, &points, 0.1);
            let sampled = sheet.sampled((&law).into(), &positions);
            assert!(sampled[2].is_none(), "{name}: a value in the hole");
            let stress = along * along - 1.0 / along;
            for (point, values) in points.iter().zip(&sampled[..2]) {
                let of = |field: SheetField| {
                    let index = SheetField::NAMES
                        .iter()
                        .position(|(_, other)| *other == field);
                    values.unwrap()[index.unwrap()]
                };
                let expected = [
                    (SheetField::CauchyXx, stress),
                    (SheetField::VonMises, stress),
                    (SheetField::CauchyYy, 0.0),
                    (SheetField::CauchyXy, 0.0),
                    (SheetField::GreenLagrangeXx, 0.5 * (along * along - 1.0)),
                    (SheetField::LargerStretch, along),
                    (SheetField::SmallerStretch, across),
                    (SheetField::DisplacementX, (along - 1.0) * point[0]),
                    (SheetField::DisplacementY, (across - 1.0) * point[1]),
                    (
                        SheetField::Energy,
                        0.5 * (along * along + 2.0 / along - 3.0),
                    ),
                ];
                for (field, expected) in expected {
                    let error = (of(field) - expected).abs();
                    assert!(error < 1e-10, "{name} {field:?} at {point:?}: {error}");
                }
            }
        }
    }
}
