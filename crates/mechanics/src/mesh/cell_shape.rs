//! The kinds of cells: natural nodes, shape functions, quadrature.

/// The kind of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CellShape {
    /// Three nodes, linear.
    Triangle3,
    /// Six nodes, quadratic: corners, mid-sides.
    Triangle6,
    /// Four nodes, bilinear.
    Quad4,
    /// Eight nodes, serendipity: corners, mid-sides.
    Quad8,
    /// Nine nodes, biquadratic: corners, mid-sides, centre.
    Quad9,
}

/// A point in natural coordinates and its weight.
pub type QuadraturePoint = ([f64; 2], f64);

const QUAD: [[f64; 2]; 9] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
    [0.0, 0.0],
];
const TRIANGLE: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [0.5, 0.0],
    [0.5, 0.5],
    [0.0, 0.5],
];

/// Gauss's rule with two points on −1…1: point and weight.
pub const GAUSS_2: [(f64, f64); 2] = [
    (-0.577_350_269_189_625_8, 1.0),
    (0.577_350_269_189_625_8, 1.0),
];

/// Gauss's rule with three points on −1…1: point and weight.
pub const GAUSS_3: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];

/// Gauss's rule with four points on −1…1: point and weight.
pub const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// Gauss's rule with five points on −1…1: point and weight.
pub const GAUSS_5: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// The nodes along one axis of an element of a degree, on 0…1: Lobatto's points. Polynomials through them oscillate least, and the
/// stiffness of linear cells between them is near that of the element.
///
/// # Panics
/// When the degree is 0 or above 3.
///
/// # References
/// S. A. Orszag, J. Comput. Phys. 37, 70 (1980), doi:10.1016/0021-9991(80)90005-4
pub fn lobatto(degree: usize) -> &'static [f64] {
    match degree {
        1 => &[0.0, 1.0],
        2 => &[0.0, 0.5, 1.0],
        3 => &[0.0, 0.276_393_202_250_021, 0.723_606_797_749_978_9, 1.0],
        _ => panic!("degree {degree}"),
    }
}

impl CellShape {
    /// All kinds by the names of their finite elements.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("T1", Self::Triangle3),
        ("T2", Self::Triangle6),
        ("Q1", Self::Quad4),
        ("Q2", Self::Quad9),
        ("Q2 serendipity", Self::Quad8),
    ];

    /// VTK's numbers for the kinds.
    const VTK: [(u8, Self); 5] = [
        (5, Self::Triangle3),
        (9, Self::Quad4),
        (22, Self::Triangle6),
        (23, Self::Quad8),
        (28, Self::Quad9),
    ];

    /// VTK's number.
    pub fn vtk_number(self) -> u8 {
        let entry = Self::VTK.iter().find(|(_, shape)| *shape == self);
        entry.expect("a kind of the table").0
    }

    /// The kind with a number of VTK; `None` where gelbench has no such kind.
    pub fn of_vtk_number(number: u8) -> Option<Self> {
        let entry = Self::VTK.iter().find(|(known, _)| *known == number);
        entry.map(|(_, kind)| *kind)
    }

    /// Number of nodes of a cell.
    pub fn nodes(self) -> usize {
        match self {
            Self::Triangle3 => 3,
            Self::Triangle6 => 6,
            Self::Quad4 => 4,
            Self::Quad8 => 8,
            Self::Quad9 => 9,
        }
    }

    /// Number of corners of a cell.
    pub fn corners(self) -> usize {
        if self.is_triangle() { 3 } else { 4 }
    }

    /// Whether it has three corners.
    pub fn is_triangle(self) -> bool {
        matches!(self, Self::Triangle3 | Self::Triangle6)
    }

    /// Degree of the displacement along an edge.
    pub fn degree(self) -> usize {
        match self {
            Self::Triangle3 | Self::Quad4 => 1,
            Self::Triangle6 | Self::Quad8 | Self::Quad9 => 2,
        }
    }

    /// The kind with the same corners and no other nodes.
    pub fn linear(self) -> Self {
        if self.is_triangle() {
            Self::Triangle3
        } else {
            Self::Quad4
        }
    }

    /// Natural coordinates (ξ, η) of the nodes: corners counter-clockwise, then mid-sides beginning
    /// between the first two corners, then the centre. Quadrilaterals lie in −1…1, triangles in ξ, η ≥ 0, ξ + η ≤ 1.
    /// This is the order of VTK, Gmsh and Abaqus.
    pub fn natural_nodes(self) -> &'static [[f64; 2]] {
        if self.is_triangle() {
            &TRIANGLE[..self.nodes()]
        } else {
            &QUAD[..self.nodes()]
        }
    }

    /// The natural coordinates of the middle of a cell.
    pub fn centre(self) -> [f64; 2] {
        if self.is_triangle() {
            [1.0 / 3.0; 2]
        } else {
            [0.0; 2]
        }
    }

    /// The nodes of each edge within the cell: its ends, then its middle.
    pub fn edges(self) -> Vec<Vec<usize>> {
        let numbers = 0..self.corners();
        numbers.map(|number| self.edge(number)).collect()
    }

    /// The nodes of one edge within the cell: its ends, then its middle.
    pub(super) fn edge(self, number: usize) -> Vec<usize> {
        let corners = self.corners();
        let mut nodes = vec![number, (number + 1) % corners];
        if self.degree() == 2 {
            nodes.push(corners + number);
        }
        nodes
    }

    /// Points and weights that integrate the stiffness of an undistorted cell exactly.
    pub fn quadrature(self) -> Vec<QuadraturePoint> {
        match self {
            Self::Triangle3 => vec![([1.0 / 3.0; 2], 0.5)],
            Self::Triangle6 => {
                let (a, b) = (1.0 / 6.0, 2.0 / 3.0);
                [[a, a], [b, a], [a, b]].map(|point| (point, a)).to_vec()
            }
            Self::Quad4 => self.product_quadrature(&GAUSS_2),
            Self::Quad8 | Self::Quad9 => self.product_quadrature(&GAUSS_3),
        }
    }

    /// The product of a rule on −1…1 with itself, for integrands that the stiffness's own rule does not resolve, such
    /// as errors; triangles are squares with one side shrunk to a point.
    pub fn product_quadrature(self, line: &[(f64, f64)]) -> Vec<QuadraturePoint> {
        let pairs = line.iter().flat_map(|x| line.iter().map(move |y| (x, y)));
        let point = |((x, wx), (y, wy)): (&(f64, f64), &(f64, f64))| {
            if self.is_triangle() {
                let (s, t) = (0.5 * (1.0 + x), 0.5 * (1.0 + y));
                ([s, t * (1.0 - s)], 0.25 * wx * wy * (1.0 - s))
            } else {
                ([*x, *y], wx * wy)
            }
        };
        pairs.map(point).collect()
    }

    /// Values Nₐ of the shape functions at a point in natural coordinates.
    pub fn values(self, [x, y]: [f64; 2]) -> Vec<f64> {
        match self {
            Self::Triangle3 => vec![1.0 - x - y, x, y],
            Self::Triangle6 => {
                let z = 1.0 - x - y;
                let corner = |l: f64| l * (2.0 * l - 1.0);
                vec![
                    corner(z),
                    corner(x),
                    corner(y),
                    4.0 * z * x,
                    4.0 * x * y,
                    4.0 * y * z,
                ]
            }
            Self::Quad8 => QUAD[..8]
                .iter()
                .map(|node| serendipity(*node, [x, y]).0)
                .collect(),
            Self::Quad4 | Self::Quad9 => self
                .natural_nodes()
                .iter()
                .map(|node| self.factor(node[0], x)[0] * self.factor(node[1], y)[0])
                .collect(),
        }
    }

    /// Derivatives [∂Nₐ/∂ξ, ∂Nₐ/∂η] of the shape functions at a point in natural coordinates.
    pub fn derivatives(self, [x, y]: [f64; 2]) -> Vec<[f64; 2]> {
        match self {
            Self::Triangle3 => vec![[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]],
            Self::Triangle6 => {
                let z = 1.0 - x - y;
                vec![
                    [1.0 - 4.0 * z; 2],
                    [4.0 * x - 1.0, 0.0],
                    [0.0, 4.0 * y - 1.0],
                    [4.0 * (z - x), -4.0 * x],
                    [4.0 * y, 4.0 * x],
                    [-4.0 * y, 4.0 * (z - y)],
                ]
            }
            Self::Quad8 => QUAD[..8]
                .iter()
                .map(|node| serendipity(*node, [x, y]).1)
                .collect(),
            Self::Quad4 | Self::Quad9 => {
                let derivative = |node: &[f64; 2]| {
                    let [a, da] = self.factor(node[0], x);
                    let [b, db] = self.factor(node[1], y);
                    [da * b, a * db]
                };
                self.natural_nodes().iter().map(derivative).collect()
            }
        }
    }

    /// The one-dimensional Lagrange polynomial of the node at `node`, and its derivative.
    fn factor(self, node: f64, x: f64) -> [f64; 2] {
        match self.degree() {
            1 => [0.5 * (1.0 + node * x), 0.5 * node],
            _ if node == 0.0 => [1.0 - x * x, -2.0 * x],
            _ => [0.5 * x * (x + node), x + 0.5 * node],
        }
    }

    /// How far a point in natural coordinates lies outside of the cell; zero inside.
    pub fn outside(self, local: [f64; 2]) -> f64 {
        (-self.depth(local)).max(0.0)
    }

    /// How far a point in natural coordinates lies inside of the cell; negative outside.
    pub fn depth(self, [x, y]: [f64; 2]) -> f64 {
        if self.is_triangle() {
            x.min(y).min(1.0 - x - y)
        } else {
            (1.0 - x.abs()).min(1.0 - y.abs())
        }
    }
}

/// Value and derivatives of the serendipity function of a corner or mid-side node.
fn serendipity([a, b]: [f64; 2], [x, y]: [f64; 2]) -> (f64, [f64; 2]) {
    let (u, v) = (1.0 + a * x, 1.0 + b * y);
    if a == 0.0 {
        let w = 1.0 - x * x;
        (0.5 * w * v, [-x * v, 0.5 * w * b])
    } else if b == 0.0 {
        let w = 1.0 - y * y;
        (0.5 * u * w, [0.5 * a * w, -u * y])
    } else {
        let c = a * x + b * y - 1.0;
        (
            0.25 * u * v * c,
            [0.25 * a * v * (c + u), 0.25 * b * u * (c + v)],
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_functions_are_one_at_their_node_and_sum_up_to_one() {
        for (_, shape) in CellShape::NAMES {
            for (i, node) in shape.natural_nodes().iter().enumerate() {
                for (j, value) in shape.values(*node).into_iter().enumerate() {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!((value - expected).abs() < 1e-15, "{shape:?} {i} {j}");
                }
            }
            let point = [0.21, 0.34];
            let sum: f64 = shape.values(point).iter().sum();
            assert!((sum - 1.0).abs() < 1e-15, "{shape:?}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let (point, step) = ([0.21, 0.34], 1e-6);
        for (_, shape) in CellShape::NAMES {
            let derivatives = shape.derivatives(point);
            for axis in 0..2 {
                let at = |sign: f64| {
                    let mut moved = point;
                    moved[axis] += sign * step;
                    shape.values(moved)
                };
                for (node, (up, down)) in at(1.0).iter().zip(at(-1.0)).enumerate() {
                    let expected = (up - down) / (2.0 * step);
                    let error = (derivatives[node][axis] - expected).abs();
                    assert!(error < 1e-9, "{shape:?} {node} {axis}");
                }
            }
        }
    }

    #[test]
    fn quadrature_has_the_area_of_the_reference_cell() {
        for (_, shape) in CellShape::NAMES {
            let expected = if shape.is_triangle() { 0.5 } else { 4.0 };
            let rules = [
                shape.quadrature(),
                shape.product_quadrature(&GAUSS_3),
                shape.product_quadrature(&GAUSS_5),
            ];
            for rule in rules {
                let area: f64 = rule.iter().map(|(_, weight)| weight).sum();
                assert!((area - expected).abs() < 1e-14, "{shape:?}");
            }
        }
    }
}
