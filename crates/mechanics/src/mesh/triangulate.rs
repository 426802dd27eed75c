//! Delaunay triangulations: of points, and of the inside of closed lines.

use std::collections::{HashMap, HashSet};

use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, DelaunayTriangulation, Point2,
    RefinementParameters, Triangulation,
};

/// No triangle has a smaller angle, unless the closed lines themselves have one.
const SMALLEST_ANGLE: f64 = 25.0;

fn vertices(points: &[[f64; 2]]) -> Vec<Point2<f64>> {
    points.iter().map(|[x, y]| Point2::new(*x, *y)).collect()
}

/// The Delaunay triangles of different points, each counter-clockwise.
pub fn delaunay(points: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let mesh: DelaunayTriangulation<Point2<f64>> =
        DelaunayTriangulation::bulk_load_stable(vertices(points)).expect("finite places");
    let faces = mesh.inner_faces();
    let mut triangles: Vec<[usize; 3]> = faces
        .map(|face| first_least(face.vertices().map(|vertex| vertex.fix().index())))
        .collect();
    triangles.sort_unstable();
    triangles
}

/// Nodes and triangles between closed lines, through points inside. `edges` are pieces of the lines, pairs of points;
/// points are added where triangles would be badly shaped.
pub fn fill(points: &[[f64; 2]], edges: &[[usize; 2]]) -> (Vec<[f64; 2]>, Vec<[usize; 3]>) {
    let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::bulk_load_cdt(
        vertices(points),
        edges.to_vec(),
    )
    .expect("finite places");
    let parameters = RefinementParameters::<f64>::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(SMALLEST_ANGLE))
        .with_max_additional_vertices(10 * points.len());
    let outside: HashSet<_> = mesh.refine(parameters).excluded_faces.into_iter().collect();
    let faces = mesh
        .inner_faces()
        .filter(|face| !outside.contains(&face.fix()));
    let mut triangles: Vec<[usize; 3]> = faces
        .map(|face| face.vertices().map(|vertex| vertex.fix().index()))
        .collect();
    let positions: Vec<[f64; 2]> = mesh
        .vertices()
        .map(|vertex| [vertex.position().x, vertex.position().y])
        .collect();
    // The nodes used by triangles only, from left to right.
    let mut used: Vec<usize> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    used.sort_by(|a, b| {
        positions[*a][0]
            .total_cmp(&positions[*b][0])
            .then(positions[*a][1].total_cmp(&positions[*b][1]))
    });
    let order: HashMap<usize, usize> = used
        .iter()
        .enumerate()
        .map(|(new, old)| (*old, new))
        .collect();
    for triangle in &mut triangles {
        *triangle = first_least(triangle.map(|node| order[&node]));
    }
    triangles.sort_unstable();
    (
        used.iter().map(|node| positions[*node]).collect(),
        triangles,
    )
}

/// A triangle, turned so that it begins at its point with the smallest number.
fn first_least(mut triangle: [usize; 3]) -> [usize; 3] {
    let least = (0..3).min_by_key(|corner| triangle[*corner]).unwrap_or(0);
    triangle.rotate_left(least);
    triangle
}
