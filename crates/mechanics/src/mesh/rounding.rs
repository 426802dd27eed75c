//! The smooth curve that the edges of a boundary represent.
//!
//! An edge of two nodes is a chord, one of three nodes a parabola; where neighbouring edges continue in nearly the
//! same direction a curve is meant, and the small turn δ from the end of one to the start of the next tells how far
//! the edges are from it. Each of the two edges takes its share of the turn, ψ, and the curve lies beside the edge by
//! c(s) along the left normal of its chord, −1 ≤ s ≤ 1, with c'(±1) = ½ ℓ ψ:
//!
//! ```text
//! two nodes     c = (1 − s²) (A + B s)       shares of δ as the lengths ℓ                     [mm]
//! three nodes   c = s (1 − s²) (A + B s)     shares of δ as the third powers of the turns along the edges
//! ```
//!
//! Both are exact to leading order: a chord of a circle is ℓ²/(8 R) beside it, a parabola through three points of an arc of the angle 2α at
//! most R α⁴/32. Where the turn at one end of an edge is that of a corner, the turn of the other end is taken, mirrored.

use std::collections::BTreeMap;

use super::cells::Mesh;
use super::geometry::turn;
use crate::error::Diagnostic;

/// A turn between straight edges that may belong to a curve, in rad: up to an octagon's.
const TURNS: std::ops::Range<f64> = 0.003..0.8;
/// Straight edges represent a curve where so many nodes in a row turn alike.
const LEAST_TURNS: usize = 3;
/// Turns per length of neighbouring nodes on a curve do not differ more than by this factor.
const LARGEST_TURN_RATIO: f64 = 3.0;
/// Ratio of the turn between parabolas to the turns along them, up to which they are one curve.
const SMOOTH: f64 = 0.4;

/// A distance to the curve, relative to the edge's length, that is rounding.
const ROUNDING_ERROR: f64 = 1e-10;

/// A part of the boundary that is drawn with straight edges where a curve may be meant.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// The group of edges.
    pub group: String,
    /// Edges that may be chords.
    pub edges: usize,
    /// The largest distance of the curve from an edge, in mm.
    pub sagitta: f64,
    /// The gain in the specimen's area with the curve, in mm².
    pub area: f64,
}

impl Polygon {
    /// A warning of the consequences if a curve is meant.
    pub fn warning(&self, mesh: &Mesh) -> Diagnostic {
        let message = format!(
            "the boundary `{}` is a polygon: {} straight edges turn like chords of a curve. If a curve is meant, it lies up to {:.2e} mm away from \
             them, and the area is wrong by {:.2} %",
            self.group,
            self.edges,
            self.sagitta,
            100.0 * (self.area / mesh.area()).abs()
        );
        let hint = "save the mesh with elements of the second order, whose sides are curved; if a polygon is meant, allow \"polygons\"";
        Diagnostic::warning("", message).hint(hint)
    }
}

/// An edge with its neighbours, and the turns of the curve's ends relative to its own, in rad.
struct Piece<'a> {
    edge: &'a [usize],
    /// The vector from the first end to the last one.
    chord: [f64; 2],
    /// Direction at both ends.
    tangents: [[f64; 2]; 2],
    turns: [Option<f64>; 2],
}

impl Piece<'_> {
    fn length(&self) -> f64 {
        self.chord[0].hypot(self.chord[1])
    }

    /// The turn along the edge itself.
    fn turning(&self) -> f64 {
        turn(self.tangents[0], self.tangents[1])
    }

    /// The turn at each end if the edge were that of a circle.
    fn circular(&self) -> f64 {
        let half = 0.5 * self.turning();
        2.0 * (0.5 * half.tan()).atan() - half
    }

    /// A and B of the distance to the curve.
    fn bump(&self) -> Option<[f64; 2]> {
        let [begin, end] = match self.turns {
            [Some(begin), Some(end)] => [begin, end],
            [Some(begin), None] => [begin, -begin],
            [None, Some(end)] => [-end, end],
            [None, None] if self.edge.len() == 3 => [-self.circular(), self.circular()],
            [None, None] => return None,
        };
        let [begin, end] = [begin, end].map(|turn| 0.5 * self.length() * turn);
        let (odd, even) = (-0.25 * (begin + end), 0.25 * (begin - end));
        Some(match self.edge.len() {
            2 => [even, odd],
            _ => [odd, even],
        })
        .filter(|[a, b]| a.abs() + b.abs() > ROUNDING_ERROR * self.length())
    }

    /// The vector from the edge to the curve at s in mm.
    fn offset(&self, [a, b]: [f64; 2], s: f64) -> [f64; 2] {
        let odd = if self.edge.len() == 2 { 1.0 } else { s };
        let height = odd * (1.0 - s * s) * (a + b * s) / self.length();
        [-height * self.chord[1], height * self.chord[0]]
    }

    /// The area that the specimen to the left gains with the curve, in mm².
    fn area(&self, [a, b]: [f64; 2]) -> f64 {
        let mean = match self.edge.len() {
            2 => 4.0 / 3.0 * a,
            _ => 4.0 / 15.0 * b,
        };
        -0.5 * self.length() * mean
    }
}

impl Mesh {
    /// The mesh with every cell cut into four, its new boundary nodes on the smooth curves that its edges represent;
    /// [`Self::refined`] leaves them on the edges. `None` where no edge represents a curve.
    pub fn rounded(&self) -> Option<Self> {
        let pieces = self.pieces();
        let bumps: Vec<_> = pieces.iter().filter_map(|p| Some((p, p.bump()?))).collect();
        if bumps.is_empty() {
            return None;
        }
        let mut finer = self.quartered();
        for (piece, bump) in bumps {
            let (a, b) = (piece.edge[0], piece.edge[1]);
            let positions: &[_] = match piece.edge {
                [_, _, m] => &[(a, *m, -0.5), (*m, b, 0.5)],
                _ => &[(a, b, 0.0)],
            };
            for (from, to, s) in positions {
                let offset = piece.offset(bump, *s);
                if let Some(node) = finer.between(*from, *to) {
                    for (axis, offset) in offset.into_iter().enumerate() {
                        finer.nodes[node][axis] += offset;
                    }
                }
            }
        }
        Some(finer.finish(super::refine::Subdivision::halves))
    }

    /// The groups of straight edges where a curve may be meant; the group of the whole boundary only where no other contains such edges.
    pub fn polygons(&self) -> Vec<Polygon> {
        let pieces = self.pieces();
        let straight = pieces.iter().filter(|piece| piece.edge.len() == 2);
        let bumps: BTreeMap<&[usize], _> = straight
            .filter_map(|piece| Some((piece.edge, (piece, piece.bump()?))))
            .collect();
        let of_group = |(name, group): (&String, &super::cells::Group)| {
            let bumps_of_group = group.edges.iter().filter_map(|edge| bumps.get(&edge[..]));
            let mut polygon = Polygon {
                group: name.clone(),
                edges: 0,
                sagitta: 0.0,
                area: 0.0,
            };
            for (piece, bump) in bumps_of_group {
                polygon.edges += 1;
                polygon.sagitta = polygon.sagitta.max(bump[0].abs());
                polygon.area += piece.area(*bump);
            }
            (polygon.edges > 0).then_some(polygon)
        };
        let polygons: Vec<Polygon> = self.groups().iter().filter_map(of_group).collect();
        let named = |polygon: &&Polygon| polygon.group != "boundary";
        if polygons.iter().any(|polygon| named(&polygon)) {
            polygons.iter().filter(named).cloned().collect()
        } else {
            polygons
        }
    }

    /// The edges of the boundary with the turns at their ends of the curves that they represent.
    fn pieces(&self) -> Vec<Piece<'_>> {
        let edges = self.boundary().iter();
        let mut pieces: Vec<Piece> = edges.map(|edge| self.piece(edge)).collect();
        let next = neighbours(&pieces);
        let kinks: Vec<Option<f64>> = pieces
            .iter()
            .zip(&next)
            .map(|(piece, next)| Some(turn(piece.tangents[1], pieces[(*next)?].tangents[0])))
            .collect();
        let mut before = vec![None; pieces.len()];
        for (piece, next) in next.iter().enumerate() {
            if let Some(next) = next {
                before[*next] = Some(piece);
            }
        }
        for piece in 0..pieces.len() {
            let (Some(after), Some(kink)) = (next[piece], kinks[piece]) else {
                continue;
            };
            let shares = match [&pieces[piece], &pieces[after]].map(|piece| piece.edge.len()) {
                [3, 3] => parabolas(kink, [&pieces[piece], &pieces[after]]),
                [2, 2] => chords(piece, &pieces, &kinks, &[&next, &before]),
                _ => None,
            };
            if let Some([mine, other]) = shares {
                pieces[piece].turns[1] = Some(mine);
                pieces[after].turns[0] = Some(-other);
            }
        }
        pieces
    }

    fn piece<'a>(&self, edge: &'a [usize]) -> Piece<'a> {
        let at = |i: usize| self.nodes[edge[i]];
        let (a, b) = (at(0), at(1));
        let chord = [0, 1].map(|axis| b[axis] - a[axis]);
        let tangents = match edge.len() {
            2 => [chord; 2],
            _ => {
                let m = at(2);
                let bow = [0, 1].map(|axis| 4.0 * m[axis] - 2.0 * (a[axis] + b[axis]));
                [1.0, -1.0].map(|sign| [0, 1].map(|axis| chord[axis] + sign * bow[axis]))
            }
        };
        Piece {
            edge,
            chord,
            tangents,
            turns: [None; 2],
        }
    }
}

/// The edge that continues at the end of each one; `None` where several do.
fn neighbours(pieces: &[Piece]) -> Vec<Option<usize>> {
    let mut begins: BTreeMap<usize, Option<usize>> = BTreeMap::new();
    for (index, piece) in pieces.iter().enumerate() {
        let begin = begins.entry(piece.edge[0]);
        begin
            .and_modify(|known| *known = None)
            .or_insert(Some(index));
    }
    let next = |piece: &Piece| begins.get(&piece.edge[1]).copied().flatten();
    pieces.iter().map(next).collect()
}

/// The shares of the end of one parabola and of the beginning of the next in the turn between them, if they are one curve.
fn parabolas(kink: f64, pair: [&Piece; 2]) -> Option<[f64; 2]> {
    let turns = pair.map(|piece| piece.turning().abs());
    let most = turns[0].max(turns[1]);
    if most < TURNS.start || kink.abs() > SMOOTH * most {
        return None;
    }
    let weights = turns.map(|turn| turn.powi(3));
    let share = kink / (weights[0] + weights[1]);
    Some(weights.map(|weight| share * weight))
}

/// The shares of a chord and the next one in the turn between them, if it is one of several alike in a row.
fn chords(
    piece: usize,
    pieces: &[Piece],
    kinks: &[Option<f64>],
    directions: &[&[Option<usize>]; 2],
) -> Option<[f64; 2]> {
    // The turn at the end of an edge per length of the edges beside it.
    let curvature = |piece: usize| {
        let (kink, after) = (kinks[piece]?, directions[0][piece]?);
        let curved = TURNS.contains(&kink.abs()) && pieces[after].edge.len() == 2;
        curved.then(|| kink / (pieces[piece].length() + pieces[after].length()))
    };
    let mut alike = 1;
    for direction in directions {
        let (mut at, mut bend) = (piece, curvature(piece)?);
        while let Some(to) = direction[at].filter(|_| alike < LEAST_TURNS) {
            let Some(other) = curvature(to) else { break };
            if !(1.0 / LARGEST_TURN_RATIO..=LARGEST_TURN_RATIO).contains(&(other / bend)) {
                break;
            }
            alike += 1;
            (at, bend) = (to, other);
        }
    }
    let (kink, after) = (kinks[piece]?, directions[0][piece]?);
    let lengths = [piece, after].map(|piece| pieces[piece].length());
    let share = kink / (lengths[0] + lengths[1]);
    (alike >= LEAST_TURNS).then(|| lengths.map(|length| share * length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cell_shape::CellShape;
    use crate::mesh::shapes::Shape;

    const RING: Shape = Shape::RingSector {
        radii: [10.0, 20.0],
        angle: 2.0,
    };

    /// How far the nodes of the inner edge are from the circle.
    fn radial_deviation(mesh: &Mesh) -> f64 {
        let nodes = mesh.groups()["inside"].nodes.iter();
        let radii = nodes.map(|node| mesh.nodes[*node][0].hypot(mesh.nodes[*node][1]));
        radii.fold(0.0, |most, radius| f64::max(most, (radius - 10.0).abs()))
    }

    #[test]
    fn edges_of_circles_are_rounded_to_them() {
        for (_, kind) in CellShape::NAMES {
            let mesh = RING.mesh(4, kind);
            let edges = radial_deviation(&mesh.refined());
            let rounded = radial_deviation(&mesh.rounded().expect("arcs"));
            assert!(
                edges > 1e-5 && rounded < 0.03 * edges,
                "{kind:?}: {rounded} of {edges}"
            );
        }
    }

    #[test]
    fn straight_boundaries_with_corners_are_no_curves() {
        for (_, kind) in CellShape::NAMES {
            let mesh = Shape::Strip { size: [30.0, 10.0] }.mesh(4, kind);
            assert_eq!(mesh.rounded(), None);
            assert_eq!(mesh.polygons(), []);
        }
    }

    #[test]
    fn polygons_are_told_with_what_they_lack() {
        let hole = Shape::StripWithHole {
            size: [30.0, 10.0],
            radius: 2.0,
        };
        let mesh = hole.mesh(8, CellShape::Triangle3);
        let [polygon] = &mesh.polygons()[..] else {
            panic!("{:?}", mesh.polygons());
        };
        let corners = mesh.groups()["hole"].edges.len();
        assert_eq!((polygon.group.as_str(), polygon.edges), ("hole", corners));
        let angle = std::f64::consts::PI / corners as f64;
        let sagitta = 2.0 * (1.0 - angle.cos());
        crate::assert_near(polygon.sagitta, sagitta, 0.3, &"");
        let lacking = 300.0 - 4.0 * std::f64::consts::PI - mesh.area();
        crate::assert_near(polygon.area, lacking, 0.05, &"");
        assert_eq!(hole.mesh(8, CellShape::Triangle6).polygons(), []);
    }
}
