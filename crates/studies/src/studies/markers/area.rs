//! Pads on a sheet that a study names by their areas.

use std::collections::BTreeSet;

use crate::error::{Diagnostic, Error};
use crate::mesh::Mesh;

/// A part of the sheet, in mm at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Area {
    /// Its lower left and its upper right corner.
    Rectangle([[f64; 2]; 2]),
    /// Its centre and its radius.
    Disc([f64; 2], f64),
}

impl Area {
    /// Of x, y, x, y of two corners, or of x, y of a centre and a radius.
    pub fn of(lengths: &[f64]) -> Option<Self> {
        match *lengths {
            [a, b, c, d] if a < c && b < d => Some(Self::Rectangle([[a, b], [c, d]])),
            [x, y, radius] if radius > 0.0 => Some(Self::Disc([x, y], radius)),
            _ => None,
        }
    }

    /// Whether it contains a position, up to rounding.
    fn contains(self, [x, y]: [f64; 2]) -> bool {
        const NEAR: f64 = 1e-9;
        match self {
            Self::Rectangle([[a, b], [c, d]]) => {
                let near = NEAR * (c - a + d - b);
                (a - near..=c + near).contains(&x) && (b - near..=d + near).contains(&y)
            }
            Self::Disc([a, b], radius) => (x - a).hypot(y - b) <= (1.0 + NEAR) * radius,
        }
    }
}

/// Names the nodes within areas.
///
/// # Errors
/// [`Error::Input`] with every area that contains too few nodes for a pad, or whose name the mesh has already.
pub fn name(mesh: &mut Mesh, areas: &[(String, Area)]) -> Result<(), Error> {
    const LEAST: usize = 2;
    let mut faults = Vec::new();
    for (name, area) in areas {
        let nodes: BTreeSet<usize> = (0..mesh.nodes.len())
            .filter(|node| area.contains(mesh.nodes[*node]))
            .collect();
        if mesh.groups().contains_key(name) {
            let fault = Diagnostic::error("", format!("the mesh already has a group `{name}`"));
            faults.push(fault.hint("leave out the area, or give it another name"));
        } else if nodes.len() < LEAST {
            let message = format!(
                "the area `{name}` contains too few nodes of the mesh: {}",
                nodes.len()
            );
            let hint = "check its position, which is in the mesh's axes, or use smaller cells with --cell-size";
            faults.push(Diagnostic::error("", message).hint(hint));
        } else {
            mesh.name_nodes(name, &nodes);
        }
    }
    Error::refuse(faults)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::CellShape;

    #[test]
    fn areas_name_the_nodes_that_they_hold() {
        let mut mesh = Mesh::plate([6.0, 4.0], [6, 4], CellShape::Quad4);
        let square = Area::of(&[1.0, 1.0, 3.0, 3.0]).unwrap();
        let disc = Area::of(&[5.0, 2.0, 1.0]).unwrap();
        name(
            &mut mesh,
            &[("square".into(), square), ("disc".into(), disc)],
        )
        .unwrap();
        let count = |name: &str| mesh.groups()[name].nodes.len();
        assert_eq!((count("square"), count("disc")), (9, 5));
        let message = name(&mut mesh, &[("left".into(), disc)])
            .unwrap_err()
            .to_string();
        assert!(message.contains("already has a group `left`"), "{message}");
        let far = Area::of(&[50.0, 2.0, 1.0]).unwrap();
        let message = name(&mut mesh, &[("far".into(), far)])
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("too few nodes of the mesh: 0"),
            "{message}"
        );
        assert_eq!(Area::of(&[3.0, 1.0, 1.0, 3.0]), None);
    }
}
