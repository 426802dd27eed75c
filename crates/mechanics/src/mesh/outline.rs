//! Closed lines around a specimen, found from the positions of its markers, and meshes inside them.
//!
//! The outline of scattered points is the boundary of those Delaunay triangles whose circumscribed circle has a
//! radius below 1.9 s, where the spacing s is the median length of all Delaunay edges (an α-shape). This closes gaps
//! of up to two by two points of a grid; a wider one inside is a hole. The lines are then straightened where this
//! moves them by less than 0.55 s, so that the staircase of a grid along an oblique edge becomes one edge, and
//! rounded where they are curved. An outer line that bridges dents of up to a spacing by few long sides is a polygon
//! of these, however a grid is turned against it. Where points are scattered, as where many points of a grid are lost,
//! gaps at the edge are wider: the outer line is then that of circles 1.6 times as large, and dents are deeper by as
//! much. Scattered points are reported as a doubt.
//!
//! Meshes have nodes in a triangular lattice inside and evenly along the lines; where an angle would be below 25°,
//! nodes are added (Ruppert's refinement).
//!
//! # References
//! H. Edelsbrunner, D. Kirkpatrick, R. Seidel, IEEE Trans. Inf. Theory 29 (1983) 551
//! J. Ruppert, J. Algorithms 18 (1995) 548

use std::collections::{BTreeMap, HashMap};

use super::cell_shape::CellShape;
use super::cells::Mesh;
use super::geometry::{self, check_size, distance, polygon_area};
use super::triangulate::fill;
use crate::statistics::{median, nearest};
use crate::units::SIZES;

mod alpha_shape;
mod corners;
mod envelope;
mod fault;
mod lattice;
mod polygon;
mod side_lines;
mod sides;
mod smoothing;

pub use corners::corners;
pub use fault::OutlineFault;
use polygon::Polygon;
pub use polygon::straightened;

/// Straightening moves lines by less than so many spacings.
const STRAIGHT: f64 = 0.55;

/// Closed lines around a specimen.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The outer line, with the specimen to its left.
    pub outer: Vec<[f64; 2]>,
    /// The lines around its holes, with the specimen to their left.
    pub holes: Vec<Vec<[f64; 2]>>,
}

/// An outline found around points.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineOfPoints {
    /// The lines.
    pub outline: Outline,
    /// The spacing of the points in mm.
    pub spacing: f64,
    /// Root mean square of the distance of the outermost points from the outer line in mm: nothing where they lie on it.
    pub roughness: f64,
    /// Whether the points lie irregularly, as where many of a grid are lost.
    pub is_scattered: bool,
    /// The reasons why the lines may not be those of the specimen.
    pub doubts: Vec<String>,
}

/// Points are scattered where the distance to the nearest other one, relative to the side of the square that each point has, is less than
/// this: 1 on a square grid, 1.07 on a triangular one, 0.87 where a quarter of a grid is lost, 0.5 where they lie at random.
const SCATTERED: f64 = 0.87;

/// Sides of polygons are straightened by so many times more and more, up to this share of the depth of dents.
const STRAIGHTENING_FACTOR: f64 = 1.6;
const LARGEST_STRAIGHTENING: f64 = 0.9;

/// Dents of the outer line no deeper than so many spacings are bridged.
const DEEPEST_BRIDGED: f64 = 1.05;

/// Factor of the circles' radius for the outer line of scattered points.
const RADIUS_FACTOR: f64 = 1.6;

impl Outline {
    /// The lines around points.
    ///
    /// # Errors
    /// An [`OutlineFault`].
    pub fn of_points(points: &[[f64; 2]]) -> Result<OutlineOfPoints, OutlineFault> {
        let mut points: Vec<[f64; 2]> = points.iter().map(|point| rounded(*point)).collect();
        check_size(points.iter().copied())?;
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        points.dedup();
        if points.len() < 6 {
            return Err(OutlineFault::TooFew(points.len()));
        }
        let (mut lines, spacing) = alpha_shape::lines(&points, 1.0)?;
        let mut outline = Self::behind(&lines, spacing, DEEPEST_BRIDGED * spacing)?;
        let mut doubts = Vec::new();
        let regular = regularity(&points, outline.area());
        let is_scattered = regular < SCATTERED;
        if is_scattered {
            doubts.push(format!(
                "the markers are irregularly spaced, as if many were lost (distance to the nearest marker relative to the spacing of an equally \
                 dense grid: {regular:.2}, on a grid 1)"
            ));
            // Gaps at the edge are wider then; holes are found as usual.
            let (wide_lines, _) = alpha_shape::lines(&points, RADIUS_FACTOR)?;
            let wide = Self::behind(
                &wide_lines,
                spacing,
                DEEPEST_BRIDGED * RADIUS_FACTOR * spacing,
            )?;
            let wider = Self {
                outer: wide.outer,
                holes: outline.holes.clone(),
            };
            if wider.check().is_ok() {
                outline = wider;
                lines = wide_lines;
            }
        }
        outline.check()?;
        Ok(OutlineOfPoints {
            roughness: roughness(&lines, &outline.outer),
            outline,
            spacing,
            is_scattered,
            doubts,
        })
    }

    /// The lines without the steps of a grid: polygons, which dents no deeper than `deep` do not make ragged, else smoothed.
    fn behind(lines: &[Vec<[f64; 2]>], spacing: f64, deep: f64) -> Result<Self, OutlineFault> {
        let near = STRAIGHT * spacing;
        let smooth = lines.iter().map(|line| {
            let polygon = polygon_behind(line, deep, spacing);
            polygon.unwrap_or_else(|| smoothing::smoothed(line, near, spacing))
        });
        let smooth = Self::of_each(smooth)?;
        // A smoothed line may come nearer to itself than the points do.
        if smooth.check().is_ok() {
            return Ok(smooth);
        }
        Self::of_each(lines.iter().map(|line| polygon::straightened(line, near)))
    }

    /// The outline from lines around the specimen and its holes; lines that nearly vanish are left out.
    fn of_each(lines: impl Iterator<Item = Vec<[f64; 2]>>) -> Result<Self, OutlineFault> {
        let (outer, holes): (Vec<_>, Vec<_>) = lines
            .filter(|line| line.len() > 2)
            .partition(|line| polygon_area(line) > 0.0);
        match outer.into_iter().next_back() {
            Some(outer) => Ok(Self { outer, holes }),
            None => Err(OutlineFault::TooFarApart),
        }
    }

    /// The lines moved outward by a distance: the outer one becomes wider, holes become narrower.
    ///
    /// # Errors
    /// An [`OutlineFault`].
    pub fn widened(&self, gap: f64) -> Result<Self, OutlineFault> {
        let outline = Self {
            outer: polygon::shifted(&self.outer, gap),
            holes: self
                .holes
                .iter()
                .map(|hole| polygon::shifted(hole, gap))
                .filter(|hole| polygon_area(hole) < 0.0)
                .collect(),
        };
        outline.check()?;
        Ok(outline)
    }

    /// The outline from lines in any direction and order: the one around the largest area is the outer one.
    ///
    /// # Errors
    /// An [`OutlineFault`].
    pub fn of_lines(mut lines: Vec<Vec<[f64; 2]>>) -> Result<Self, OutlineFault> {
        let count = lines.iter().map(Vec::len).sum();
        if count > OutlineFault::MOST_POINTS {
            return Err(OutlineFault::TooMany(count));
        }
        for point in lines.iter_mut().flatten() {
            *point = rounded(*point);
        }
        if count > 0 {
            check_size(lines.iter().flatten().copied())?;
        }
        for line in &mut lines {
            line.dedup();
            if line.len() > 1 && line.first() == line.last() {
                line.pop();
            }
            if line.len() < 3 || polygon::is_straight(line) {
                return Err(OutlineFault::NoArea);
            }
        }
        lines.sort_by(|a, b| polygon_area(b).abs().total_cmp(&polygon_area(a).abs()));
        for (index, line) in lines.iter_mut().enumerate() {
            if (polygon_area(line) > 0.0) != (index == 0) {
                line.reverse();
            }
        }
        let mut lines = lines.into_iter();
        let outer = lines.next().ok_or(OutlineFault::NoLine)?;
        let outline = Self {
            outer,
            holes: lines.collect(),
        };
        outline.check()?;
        Ok(outline)
    }

    /// Whether a point lies in one of the holes.
    pub fn has_in_a_hole(&self, point: [f64; 2]) -> bool {
        let mut holes = self.holes.iter();
        holes.any(|hole| Polygon(hole).contains(point))
    }

    fn lines(&self) -> impl Iterator<Item = &Vec<[f64; 2]>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Whether no line crosses itself or another one, and all holes lie inside.
    fn check(&self) -> Result<(), OutlineFault> {
        let lines: Vec<Polygon> = self.lines().map(|line| Polygon(line)).collect();
        if let Some(position) = polygon::crossing(&lines) {
            return Err(OutlineFault::Crossing(position));
        }
        match self.holes.iter().find(|hole| !lines[0].contains(hole[0])) {
            Some(hole) => Err(OutlineFault::SeparatedLines(hole[0])),
            None => Ok(()),
        }
    }

    /// The area inside in mm².
    pub fn area(&self) -> f64 {
        self.lines().map(|line| polygon_area(line)).sum()
    }

    /// The area inside the outer line in mm², holes included.
    pub fn outer_area(&self) -> f64 {
        polygon_area(&self.outer)
    }

    /// Length along x and along y in mm.
    pub fn extents(&self) -> [f64; 2] {
        geometry::sides(self.outer.iter().copied())
    }

    /// A mesh of cells of about the size `size` in mm (the length of their edges); `shape` is their kind, of three,
    /// six, four or nine nodes.
    ///
    /// The outer edges are the groups `left`, `right`, `bottom` and `top`, from corner to corner (a turn of more than
    /// 40°) by the direction that they face; the edges of holes `hole-1`, `hole-2` …, and all of them `boundary`.
    pub fn mesh(&self, size: f64, shape: CellShape) -> Mesh {
        // A triangle becomes three quadrilaterals of about half its size.
        let size = if shape.is_triangle() {
            size
        } else {
            2.0 * size
        };
        let (mut points, mut edges) = (Vec::new(), Vec::new());
        for line in self.lines() {
            let start = points.len();
            points.extend(polygon::divided(line, size));
            let count = points.len() - start;
            edges.extend((0..count).map(|i| [start + i, start + (i + 1) % count]));
        }
        let lines: Vec<Polygon> = self.lines().map(|line| Polygon(line)).collect();
        points.extend(lattice::inside(&lines, &points, size));
        let (nodes, triangles) = fill(&points, &edges);
        let linear = if shape.is_triangle() {
            let cells = triangles
                .iter()
                .map(|nodes| (CellShape::Triangle3, nodes.to_vec()));
            Mesh::new(nodes, cells)
        } else {
            quadrilaterals(nodes, &triangles)
        };
        let mut mesh = match shape.degree() {
            1 => linear,
            _ => linear.quadratic(),
        };
        self.name_sides(&mut mesh);
        mesh
    }

    fn name_sides(&self, mesh: &mut Mesh) {
        let of_side = |(side, edge): (Option<&str>, _)| (side.map(str::to_owned), edge);
        let mut sides: Vec<(Option<String>, [[f64; 2]; 2])> =
            sides::sides(&self.outer).into_iter().map(of_side).collect();
        for (hole, number) in self.holes.iter().zip(1..) {
            let edges = Polygon(hole).edges();
            sides.extend(edges.map(|edge| (Some(format!("hole-{number}")), edge)));
        }
        let mut groups: BTreeMap<&str, Vec<Vec<usize>>> = BTreeMap::new();
        for edge in mesh.boundary() {
            let [a, b] = [mesh.nodes[edge[0]], mesh.nodes[edge[1]]];
            let middle = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
            let far = |(_, edge): &&(Option<String>, _)| polygon::distance(*edge, middle);
            let nearest = sides.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
            if let Some((Some(side), _)) = nearest {
                groups.entry(side).or_default().push(edge.clone());
            }
        }
        for (name, edges) in groups {
            mesh.name_edges(name, edges);
        }
        mesh.name_boundary("boundary", |_| true);
    }
}

/// The polygon behind an outer line with dents up to `deep`, where it is one: as straight as can be.
fn polygon_behind(line: &[[f64; 2]], deep: f64, spacing: f64) -> Option<Vec<[f64; 2]>> {
    let is_outer = polygon_area(line) > 0.0;
    let bridged = is_outer.then(|| envelope::without_dents(line, deep, spacing))?;
    let next = |near: &f64| Some(STRAIGHTENING_FACTOR * near);
    let mut nears = std::iter::successors(Some(STRAIGHT * spacing), next)
        .take_while(|near| *near < LARGEST_STRAIGHTENING * deep);
    nears.find_map(|near| envelope::polygonal(&bridged, [near, deep], spacing))
}

/// A point with coordinates far below any size set to zero: triangulations cannot distinguish them from it.
fn rounded(point: [f64; 2]) -> [f64; 2] {
    point.map(|x| if x.abs() < 1e-6 * SIZES[0] { 0.0 } else { x })
}

/// How far the outermost of some closed lines of points lies from an outer line, as root mean square.
fn roughness(lines: &[Vec<[f64; 2]>], outer: &[[f64; 2]]) -> f64 {
    let largest =
        |a: &&Vec<[f64; 2]>, b: &&Vec<[f64; 2]>| polygon_area(a).total_cmp(&polygon_area(b));
    let points = lines.iter().max_by(largest).into_iter().flatten();
    let off = |point: &[f64; 2]| {
        let edges = Polygon(outer).edges();
        let off = edges.map(|edge| polygon::distance(edge, *point));
        off.fold(f64::INFINITY, f64::min)
    };
    let squares: Vec<f64> = points.map(|point| off(point).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// The median distance of points to their nearest neighbour over √(area/points); distances beyond twice that count as twice.
fn regularity(points: &[[f64; 2]], area: f64) -> f64 {
    let side = (area / points.len() as f64).sqrt();
    let near = nearest(points, 2).into_iter().zip(points);
    let near = near.map(|(others, point)| {
        let distances = others.iter().map(|other| distance(*point, points[*other]));
        distances.fold(2.0 * side, f64::min)
    });
    median(near) / side
}

/// Three quadrilaterals for each triangle, about its centre.
fn quadrilaterals(mut nodes: Vec<[f64; 2]>, triangles: &[[usize; 3]]) -> Mesh {
    let mut middles: HashMap<[usize; 2], usize> = HashMap::new();
    let mut cells = Vec::new();
    for corners in triangles {
        let middle = [0, 1, 2].map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                nodes.push([0, 1].map(|axis| (nodes[a][axis] + nodes[b][axis]) / 2.0));
                nodes.len() - 1
            })
        });
        nodes.push([0, 1].map(|axis| corners.iter().map(|n| nodes[*n][axis]).sum::<f64>() / 3.0));
        let centre = nodes.len() - 1;
        for i in 0..3 {
            let cell = vec![corners[i], middle[i], centre, middle[(i + 2) % 3]];
            cells.push((CellShape::Quad4, cell));
        }
    }
    Mesh::new(nodes, cells)
}

#[cfg(test)]
mod tests;
