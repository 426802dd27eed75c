//! The solids that represent a sheet in FEBio.

use std::collections::BTreeMap;

use super::*;

/// A `.feb` file as its lists of numbers by tag and number.
struct Solids {
    text: String,
    positions: BTreeMap<usize, Vec<f64>>,
}

impl Solids {
    fn new(text: String) -> Self {
        let positions = rows(&text, "node").into_iter().collect();
        Self { text, positions }
    }

    fn position(&self, node: f64) -> &[f64] {
        &self.positions[&(node as usize)]
    }

    /// Whether one node is in the middle between two others.
    fn assert_middle(&self, node: f64, ends: [f64; 2]) {
        let [a, b] = ends.map(|end| self.position(end));
        for (axis, coordinate) in self.position(node).iter().enumerate() {
            assert!(
                (coordinate - 0.5 * (a[axis] + b[axis])).abs() < 1e-9,
                "{node} between {ends:?}"
            );
        }
    }
}

/// The lists of numbers in all elements of a tag, by their `id`.
fn rows(text: &str, tag: &str) -> Vec<(usize, Vec<f64>)> {
    let start = format!("<{tag} id=\"");
    let lines = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix(&start));
    let row = |line: &str| {
        let (id, rest) = line.split_once("\">").unwrap();
        let values = rest.split('<').next().unwrap().split(',');
        (
            id.parse().unwrap(),
            values.map(|value| value.parse().unwrap()).collect(),
        )
    };
    lines.map(row).collect()
}

/// The nodes of the solids are in FEBio's order, on half the sheet.
#[test]
fn febio_gets_half_the_sheet_as_solids() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    for (_, shape) in CellShape::NAMES {
        let file = Solids::new(written(&card, Code::FeBio, shape).unwrap().text);
        let solids = rows(&file.text, "elem");
        assert!(!solids.is_empty());
        for (_, nodes) in &solids {
            let n = shape.corners();
            for i in 0..n {
                let next = (i + 1) % n;
                let (below, above) = (file.position(nodes[i]), file.position(nodes[n + i]));
                assert_eq!((below[2], above[2]), (0.0, 1.0), "{shape:?}");
                assert_eq!(below[..2], above[..2], "{shape:?}");
                if shape.degree() == 2 {
                    file.assert_middle(nodes[2 * n + i], [nodes[i], nodes[next]]);
                    file.assert_middle(nodes[3 * n + i], [nodes[n + i], nodes[n + next]]);
                    file.assert_middle(nodes[4 * n + i], [nodes[i], nodes[n + i]]);
                }
            }
            if shape == CellShape::Quad9 {
                assert_eq!(nodes.len(), 27);
                for side in 0..4 {
                    file.assert_middle(nodes[20 + side], [nodes[8 + side], nodes[12 + side]]);
                }
                for (face, corners) in [(24, [0, 2]), (25, [4, 6]), (26, [0, 6])] {
                    file.assert_middle(nodes[face], corners.map(|corner: usize| nodes[corner]));
                }
            }
        }
    }
}

#[test]
fn febio_gets_half_of_the_loads_on_faces_that_look_outwards() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    for (_, shape) in CellShape::NAMES {
        let file = Solids::new(written(&card, Code::FeBio, shape).unwrap().text);
        let loads = file.text.split("<nodal_load").skip(1);
        let up = |load: &str| -> f64 {
            let value = load.split("lc=\"1\">").nth(1).unwrap();
            value.split([',', '<']).nth(1).unwrap().parse().unwrap()
        };
        // 0.03 MPa on 4 mm × 2 mm of the top.
        let sum: f64 = loads.map(up).sum();
        assert!(
            (sum - 0.5 * 0.03 * 4.0 * 2.0).abs() < 1e-9,
            "{shape:?}: {sum}"
        );
        let surface = file
            .text
            .split_once("<Surface name=\"BOTTOM_EDGES\">")
            .unwrap()
            .1;
        let face = surface
            .lines()
            .nth(1)
            .unwrap()
            .split(['>', '<'])
            .nth(2)
            .unwrap();
        let face: Vec<f64> = face.split(',').map(|node| node.parse().unwrap()).collect();
        let [a, b, c] = [0, 1, 2].map(|corner| file.position(face[corner]));
        assert!(b[0] > a[0] && c[2] > b[2], "{shape:?}");
        assert!(file.text.contains("<pressure lc=\"1\">0.01</pressure>"));
    }
}
