//! The motion of the loaded edges of a specimen, in as few numbers as their conditions allow.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::DMatrix;

use super::edge_displacements::{Combination, EdgeDisplacements};
use crate::estimation::input::{EdgeCondition, Segment};
use crate::estimation::regression::Roughness;
use crate::mesh::Mesh;
use crate::statistics::{BSpline, Ends};

/// The largest number of spans of a spline along one edge; 1.5 times as many where they become shorter towards both ends.
const MOST_SPANS: usize = 12;

/// The length of a span in spacings of the markers.
const SPACINGS: f64 = 1.5;

/// The root-mean-square distance from the nearest smooth curve, in spacings, above which an edge is not smooth.
const UNEVEN: f64 = 0.05;

/// A coefficient of a spline along one axis: a parameter, or an unknown of the field that another part moves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Coefficient {
    Parameter(usize),
    Unknown(usize),
}

/// The coefficient that moves an unknown of the field.
type Movers = BTreeMap<usize, Coefficient>;

#[derive(Clone, Debug)]
enum Part {
    Known {
        nodes: Vec<usize>,
        displacement: [Option<f64>; 2],
    },
    /// Translation in mm and angle in rad about the centre begin at parameter `first`.
    Rigid {
        nodes: Vec<usize>,
        centre: [f64; 2],
        first: usize,
    },
    Smooth {
        name: String,
        spline: BSpline,
        /// Along x and along y.
        coefficients: [Vec<Coefficient>; 2],
        nodes: Vec<SmoothNode>,
        /// The first parameter of G₁₁, G₁₂, G₂₁, G₂₂, which times a node's offset from the smooth curve adds to its displacement; `None` where
        /// the edge is smooth.
        gradient: Option<usize>,
    },
}

/// A node that a smooth edge moves.
#[derive(Clone, Debug)]
struct SmoothNode {
    node: usize,
    /// The arc length over that of the edge.
    position: f64,
    /// From the smooth curve that is nearest to the edge, in mm.
    offset: [f64; 2],
}

/// The displacements of all edges that are not free, as a function u_B(p) of parameters p in mm and rad.
#[derive(Clone, Debug)]
pub struct EdgeMotion {
    positions: Vec<[f64; 2]>,
    parts: Vec<Part>,
    parameters: usize,
}

impl EdgeMotion {
    /// The motion of segments under one condition each. Where segments meet, known displacements take precedence over
    /// rigid ones and these over unknown ones; at the nodes `singular` displacements may be singular, as beside a
    /// clamp. `spacing` is the distance of the markers in mm.
    pub fn new(
        mesh: &Mesh,
        segments: &[(&Segment, EdgeCondition)],
        singular: &BTreeSet<usize>,
        spacing: f64,
    ) -> Self {
        let mut motion = Self {
            positions: mesh.nodes.clone(),
            parts: Vec::new(),
            parameters: 0,
        };
        let mut moved = Movers::new();
        for (segment, condition) in segments {
            if let EdgeCondition::Known(displacement) = condition {
                motion.known(segment, *displacement, &mut moved);
            }
        }
        let rigid =
            |(_, condition): &&(&Segment, EdgeCondition)| *condition == EdgeCondition::Rigid;
        let mut rigid: Vec<_> = segments.iter().filter(rigid).map(|pair| pair.0).collect();
        while let Some(first) = rigid.first().copied() {
            // All sides with one name are one body.
            let is_one = |other: &&Segment| {
                std::ptr::eq(*other, first)
                    || (first.condition.is_some() && other.condition == first.condition)
            };
            let (body, others): (Vec<&Segment>, _) = rigid.into_iter().partition(is_one);
            motion.rigid(&body, &mut moved);
            rigid = others;
        }
        for (segment, condition) in segments {
            if *condition == EdgeCondition::Unknown {
                let singular = segment.ends().map(|node| singular.contains(&node));
                motion.smooth(segment, singular, spacing, &mut moved);
            }
        }
        motion
    }

    fn known(&mut self, segment: &Segment, displacement: [Option<f64>; 2], moved: &mut Movers) {
        for axis in [0, 1]
            .into_iter()
            .filter(|axis| displacement[*axis].is_some())
        {
            hold(&segment.nodes, axis, moved);
        }
        self.parts.push(Part::Known {
            nodes: segment.nodes.clone(),
            displacement,
        });
    }

    fn rigid(&mut self, sides: &[&Segment], moved: &mut Movers) {
        let all = sides.iter().flat_map(|side| &side.nodes);
        let nodes: Vec<usize> = match sides {
            [one] => one.nodes.clone(),
            _ => all.copied().collect::<BTreeSet<_>>().into_iter().collect(),
        };
        [0, 1]
            .into_iter()
            .for_each(|axis| hold(&nodes, axis, moved));
        let centre = [0, 1].map(|axis| {
            let positions = nodes.iter().map(|node| self.positions[*node][axis]);
            positions.sum::<f64>() / nodes.len() as f64
        });
        let first = self.add_parameters(3);
        self.parts.push(Part::Rigid {
            nodes,
            centre,
            first,
        });
    }

    /// A smooth edge, whose displacement may be singular at its ends. Where the edge is not smooth, because it follows markers, a spline of the
    /// arc length does not include uniform deformations; then u = Σ qₖBₖ + G (X − Σ xₖBₖ), with the nearest curve Σ xₖBₖ.
    fn smooth(&mut self, segment: &Segment, singular: [bool; 2], spacing: f64, moved: &mut Movers) {
        let length = segment.length();
        let edges = segment.nodes.len() - 1;
        let even_spans = (length / (SPACINGS * spacing)).round() as usize;
        // Spans that become shorter towards an end are longer elsewhere.
        let more = 1.0 + singular.map(f64::from).iter().sum::<f64>() / 4.0;
        let graded_spans = even_spans.clamp(1, MOST_SPANS) as f64 * more;
        let spans = (graded_spans.round() as usize).min(edges);
        let spline = BSpline::new([0.0, 1.0], spans, 3, Ends::Clamped).graded(singular);
        let coefficients = [0, 1].map(|axis| {
            let [first, last] = segment.ends().map(|node| 2 * node + axis);
            let mut end = |motion: &mut Self, unknown: usize| {
                let parameter = || Coefficient::Parameter(motion.add_parameters(1));
                *moved.entry(unknown).or_insert_with(parameter)
            };
            let mut coefficients = vec![end(self, first)];
            for _ in 1..spline.count() - 1 {
                coefficients.push(Coefficient::Parameter(self.add_parameters(1)));
            }
            coefficients.push(end(self, last));
            coefficients
        });
        let along: Vec<f64> = segment.positions.iter().map(|arc| arc / length).collect();
        let points: Vec<[f64; 2]> = segment.nodes.iter().map(|n| self.positions[*n]).collect();
        let offsets = offsets(&spline, &along, &points).unwrap_or(vec![[0.0; 2]; along.len()]);
        let square: f64 = offsets.iter().flatten().map(|offset| offset * offset).sum();
        let is_uneven = square > (UNEVEN * spacing).powi(2) * offsets.len() as f64;
        let gradient = is_uneven.then(|| self.add_parameters(4));
        let triples = segment.nodes.iter().zip(along).zip(offsets);
        let nodes = triples.map(|((node, position), offset)| SmoothNode {
            node: *node,
            position,
            offset,
        });
        self.parts.push(Part::Smooth {
            name: segment.name.clone(),
            spline,
            coefficients,
            nodes: nodes.collect(),
            gradient,
        });
    }

    /// Adds parameters; returns the index of the first.
    fn add_parameters(&mut self, count: usize) -> usize {
        self.parameters += count;
        self.parameters - count
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// The displacements at parameters p.
    pub fn at(&self, p: &[f64]) -> EdgeDisplacements {
        let mut unknowns: BTreeMap<usize, Combination> = BTreeMap::new();
        for part in &self.parts {
            match part {
                Part::Known {
                    nodes,
                    displacement,
                } => impose_known(&mut unknowns, nodes, *displacement),
                Part::Rigid {
                    nodes,
                    centre,
                    first,
                } => self.impose_rigid(&mut unknowns, nodes, *centre, *first, p),
                Part::Smooth {
                    spline,
                    coefficients,
                    nodes,
                    gradient,
                    ..
                } => {
                    for axis in [0, 1] {
                        let q = combinations(&unknowns, &coefficients[axis], p);
                        let slopes = gradient.map(|first| {
                            [0, 1].map(|j| Combination::parameter(first + 2 * axis + j, p))
                        });
                        for node in nodes {
                            let unknown = unknowns.entry(2 * node.node + axis);
                            unknown.or_insert_with(|| node.moved(spline, &q, &slopes));
                        }
                    }
                }
            }
        }
        EdgeDisplacements { unknowns }
    }

    fn impose_rigid(
        &self,
        unknowns: &mut BTreeMap<usize, Combination>,
        nodes: &[usize],
        centre: [f64; 2],
        first: usize,
        p: &[f64],
    ) {
        let (sine, cosine) = p[first + 2].sin_cos();
        for node in nodes {
            let [x, y] = [0, 1].map(|axis| self.positions[*node][axis] - centre[axis]);
            let turned = [cosine * x - sine * y - x, sine * x + cosine * y - y];
            let slope = [-sine * x - cosine * y, cosine * x - sine * y];
            for axis in [0, 1] {
                let moved = Combination {
                    value: p[first + axis] + turned[axis],
                    slopes: vec![(first + axis, 1.0), (first + 2, slope[axis])],
                };
                unknowns.entry(2 * node + axis).or_insert(moved);
            }
        }
    }

    /// The roughness of all smooth edges at parameters p, along one axis after the other.
    pub fn roughness(&self, p: &[f64]) -> Vec<Roughness> {
        let imposed = self.at(p);
        let mut all = Vec::new();
        for part in &self.parts {
            let Part::Smooth {
                name,
                spline,
                coefficients,
                ..
            } = part
            else {
                continue;
            };
            for axis in [0, 1] {
                let q = combinations(&imposed.unknowns, &coefficients[axis], p);
                let sum = |row: Vec<(usize, f64)>| Combination::sum(&q, row.into_iter());
                let rows: Vec<_> = spline.roughness().map(sum).collect();
                let mut slopes = DMatrix::zeros(rows.len(), self.parameters);
                for (row, combination) in rows.iter().enumerate() {
                    for (index, slope) in &combination.slopes {
                        slopes[(row, *index)] += slope;
                    }
                }
                all.push(Roughness {
                    edge: name.clone(),
                    axis,
                    values: rows.iter().map(|row| row.value).collect(),
                    slopes,
                    rank: spline.count() - 2,
                });
            }
        }
        all
    }
}

impl SmoothNode {
    /// The displacement along one axis, by the spline's coefficients and the gradient's.
    fn moved(
        &self,
        spline: &BSpline,
        q: &[Combination],
        gradient: &Option<[Combination; 2]>,
    ) -> Combination {
        let mut moved = Combination::sum(q, spline.derivatives(self.position, 0));
        for (slope, offset) in gradient.iter().flatten().zip(self.offset) {
            moved.add(offset, slope);
        }
        moved
    }
}

/// The vectors to points from the spline through the first and the last of them that is nearest to the others; `None` where they do not
/// determine it.
fn offsets(spline: &BSpline, along: &[f64], points: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    let (count, last) = (spline.count(), points.len() - 1);
    let mut values = DMatrix::zeros(points.len(), count);
    for (row, position) in along.iter().enumerate() {
        for (index, value) in spline.derivatives(*position, 0) {
            values[(row, index)] = value;
        }
    }
    let mut rest = DMatrix::from_fn(points.len(), 2, |row, axis| points[row][axis]);
    for (column, end) in [(0, 0), (count - 1, last)] {
        rest -= values.column(column) * DMatrix::from_row_slice(1, 2, &points[end]);
    }
    let inner = values.columns(1, count - 2);
    let factor = inner.tr_mul(&inner).cholesky()?;
    rest -= inner * factor.solve(&inner.tr_mul(&rest));
    Some(rest.row_iter().map(|row| [row[0], row[1]]).collect())
}

/// Records that nodes are held along an axis, unless another part already moves them.
fn hold(nodes: &[usize], axis: usize, moved: &mut Movers) {
    for unknown in nodes.iter().map(|node| 2 * node + axis) {
        moved
            .entry(unknown)
            .or_insert(Coefficient::Unknown(unknown));
    }
}

fn impose_known(
    unknowns: &mut BTreeMap<usize, Combination>,
    nodes: &[usize],
    displacement: [Option<f64>; 2],
) {
    for (axis, value) in displacement.into_iter().enumerate() {
        let Some(value) = value else { continue };
        for node in nodes {
            let slopes = Vec::new();
            let known = Combination { value, slopes };
            unknowns.entry(2 * node + axis).or_insert(known);
        }
    }
}

/// The coefficients of a spline along one axis.
fn combinations(
    unknowns: &BTreeMap<usize, Combination>,
    coefficients: &[Coefficient],
    p: &[f64],
) -> Vec<Combination> {
    let combination = |coefficient: &Coefficient| match coefficient {
        Coefficient::Parameter(index) => Combination::parameter(*index, p),
        Coefficient::Unknown(unknown) => unknowns[unknown].clone(),
    };
    coefficients.iter().map(combination).collect()
}

#[cfg(test)]
mod tests;
