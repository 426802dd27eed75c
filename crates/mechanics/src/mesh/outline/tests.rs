use std::f64::consts::{PI, TAU};

use super::*;
use crate::statistics::normal_numbers;

/// A grid of points over 150 × 50 with the spacing 5, where `keep` holds.
fn grid(keep: impl Fn([f64; 2]) -> bool) -> Vec<[f64; 2]> {
    let all =
        (0..=30).flat_map(|i| (0..=10).map(move |j| [5.0 * f64::from(i), 5.0 * f64::from(j)]));
    all.filter(|point| keep(*point)).collect()
}

fn in_hole([x, y]: [f64; 2]) -> bool {
    (x - 75.0).hypot(y - 25.0) < 12.0
}

fn smallest_angle(mesh: &Mesh) -> f64 {
    let angle = |cell: usize, corner: usize| {
        let corners = mesh.corners(cell);
        let count = corners.len();
        let [a, b, c] = [0, 1, count - 1].map(|i| mesh.nodes[corners[(corner + i) % count]]);
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]) * 180.0 / PI
    };
    let cells = (0..mesh.cell_count())
        .flat_map(|cell| (0..mesh.shape(cell).corners()).map(move |corner| (cell, corner)));
    cells
        .map(|(cell, corner)| angle(cell, corner))
        .fold(180.0, f64::min)
}

fn mesh_area(mesh: &Mesh) -> f64 {
    let points = |cell| {
        mesh.shape(cell)
            .quadrature()
            .into_iter()
            .map(move |point| (cell, point))
    };
    let all = (0..mesh.cell_count()).flat_map(points);
    all.map(|(cell, (position, weight))| weight * mesh.gradients(cell, position).1)
        .sum()
}

#[test]
fn a_grid_of_points_has_the_outline_of_the_plate() {
    let traced = Outline::of_points(&grid(|_| true)).unwrap();
    assert_eq!(traced.spacing, 5.0);
    assert_eq!(traced.outline.outer.len(), 4);
    assert!((traced.outline.area() - 7500.0).abs() < 1e-9);
    assert!(traced.outline.holes.is_empty());
    for shape in [
        CellShape::Triangle3,
        CellShape::Triangle6,
        CellShape::Quad4,
        CellShape::Quad9,
    ] {
        let mesh = traced.outline.mesh(5.0, shape);
        assert!((mesh_area(&mesh) - 7500.0).abs() < 1e-6, "{shape:?}");
        assert_eq!(mesh.shape(0), shape);
        let least = smallest_angle(&mesh);
        assert!(least > 24.9, "{shape:?} {least}");
        let left = &mesh.groups()["left"];
        assert!(left.nodes.iter().all(|node| mesh.nodes[*node][0] < 1e-9) && left.nodes.len() > 10);
        let named: usize = ["left", "right", "bottom", "top"]
            .map(|name| mesh.groups()[name].edges.len())
            .iter()
            .sum();
        assert_eq!(named, mesh.boundary().len());
    }
}

#[test]
fn gaps_are_closed_and_holes_are_found() {
    let lost = |[x, y]: [f64; 2]| [40.0, 45.0].contains(&x) && [20.0, 25.0].contains(&y);
    let gap = Outline::of_points(&grid(|point| !lost(point))).unwrap();
    assert!(gap.outline.holes.is_empty());
    let hole = Outline::of_points(&grid(|point| !in_hole(point)))
        .unwrap()
        .outline;
    assert_eq!(hole.holes.len(), 1);
    let inside = -polygon_area(&hole.holes[0]);
    // Between the circle and the points around it.
    assert!(inside > 144.0 * PI && inside < 17.0 * 17.0 * PI, "{inside}");
    let mesh = hole.mesh(4.0, CellShape::Triangle6);
    assert!((mesh_area(&mesh) - hole.area()).abs() < 1e-6);
    assert!(mesh.groups()["hole-1"].edges.len() >= 12);
    assert!(smallest_angle(&mesh) > 24.9);
    assert_eq!(hole.mesh(4.0, CellShape::Triangle6), mesh);
}

#[test]
fn scattered_points_and_round_specimens_have_outlines() {
    // A quasi-random set in a disc of radius 10.
    let points: Vec<[f64; 2]> = (0..500)
        .map(|i| {
            let (radius, angle) = (
                10.0 * (f64::from(i) / 500.0).sqrt(),
                f64::from(i) * 2.399_963,
            );
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    let traced = Outline::of_points(&points).unwrap();
    crate::assert_near(traced.outline.area(), 100.0 * PI, 0.08, &"");
    assert!(traced.outline.holes.is_empty());
    let mesh = traced.outline.mesh(1.0, CellShape::Triangle3);
    assert!(smallest_angle(&mesh) > 20.0);
    assert!(mesh.groups().contains_key("left") && mesh.groups().contains_key("top"));
}

#[test]
fn lines_of_any_direction_make_an_outline() {
    let square = |size: f64| {
        vec![
            [-size, -size],
            [size, -size],
            [size, size],
            [-size, size],
            [-size, -size],
        ]
    };
    let mut reversed = square(10.0);
    reversed.reverse();
    let circle = (0..40)
        .map(|i| TAU * f64::from(i) / 40.0)
        .map(|a| [3.0 * a.cos(), 3.0 * a.sin()]);
    let outline = Outline::of_lines(vec![circle.collect(), reversed]).unwrap();
    assert!(
        (outline.area() - (400.0 - 28.16)).abs() < 0.05,
        "{}",
        outline.area()
    );
    let mesh = outline.mesh(1.0, CellShape::Quad9);
    assert!((mesh_area(&mesh) - outline.area()).abs() < 1e-6);
}

#[test]
fn bad_outlines_are_refused_in_words() {
    let bow = vec![[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 3.0]];
    let square = |x: f64| vec![[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]];
    for (lines, reason) in [
        (vec![bow], "crosses itself near"),
        (vec![square(0.0), square(0.5)], "crosses itself near"),
        (vec![square(0.0), square(5.0)], "two separated parts"),
        (
            vec![vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]],
            "encloses no area",
        ),
    ] {
        let fault = Outline::of_lines(lines).unwrap_err().to_string();
        assert!(fault.contains(reason), "{fault}");
    }
    let apart = grid(|[x, _]| !(60.0..90.0).contains(&x));
    let fault = Outline::of_points(&apart).unwrap_err().to_string();
    assert!(fault.contains("two separated parts"), "{fault}");
    let line: Vec<_> = (0..20).map(|i| [f64::from(i), 2.0]).collect();
    let fault = Outline::of_points(&line).unwrap_err();
    assert_eq!(fault, OutlineFault::OneLine);
}

#[test]
fn a_row_of_markers_lost_at_an_edge_is_bridged() {
    let lost = grid(|[x, y]| y > 0.0 || !(50.0..100.0).contains(&x));
    for points in [grid(|_| true), lost] {
        let traced = Outline::of_points(&points).unwrap();
        assert!(traced.doubts.is_empty(), "{:?}", traced.doubts);
        assert!((traced.outline.area() - 7500.0).abs() < 1e-9);
    }
}

#[test]
fn half_of_a_grid_keeps_its_outline_with_a_word() {
    use rand::{RngExt, SeedableRng};
    for seed in 0..12 {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let kept: Vec<bool> = (0..341).map(|_| random.random::<f64>() < 0.5).collect();
        let all = grid(|_| true).into_iter().zip(kept);
        let points: Vec<[f64; 2]> = all
            .filter(|(_, kept)| *kept)
            .map(|(point, _)| point)
            .collect();
        let traced = Outline::of_points(&points).unwrap();
        assert!(
            traced.doubts[0].contains("irregularly spaced"),
            "{seed}: {:?}",
            traced.doubts
        );
        assert!(
            traced.outline.area() > 0.9 * 7500.0,
            "{seed}: {}",
            traced.outline.area()
        );
        let margin = traced.outline.widened(traced.spacing).unwrap();
        assert!(margin.area() > 7500.0, "{seed}: {}", margin.area());
    }
}

#[test]
fn an_outline_moves_out_by_a_gap_and_its_holes_narrow() {
    let square = |low: f64, high: f64| vec![[low, low], [high, low], [high, high], [low, high]];
    let outline = Outline::of_lines(vec![square(0.0, 10.0), square(4.0, 6.0)]).unwrap();
    let wider = outline.widened(0.5).unwrap();
    assert!(
        (wider.area() - (121.0 - 1.0)).abs() < 1e-9,
        "{}",
        wider.area()
    );
    assert_eq!(wider.outer.len(), 4);
    // A hole narrower than twice the gap is closed.
    assert!(outline.widened(1.0).unwrap().holes.is_empty());
}

/// Small grids are rectangles too, whatever their spacings, jitter and turn; the points of a small disc are none.
#[test]
fn small_grids_have_four_corners() {
    for (columns, rows) in [
        (3, 3),
        (4, 3),
        (5, 3),
        (3, 5),
        (4, 4),
        (5, 5),
        (6, 4),
        (9, 3),
    ] {
        for (ratio, turn, jitter) in [
            (1.0, 0.0, 0.0),
            (1.25, 0.0, 0.0),
            (0.8, 0.5, 0.0),
            (1.4, 1.2, 0.02),
        ] {
            let (sine, cosine) = f64::sin_cos(turn);
            let positions =
                (0..columns).flat_map(|i| (0..rows).map(move |j| [i, j].map(f64::from)));
            let points: Vec<[f64; 2]> = positions
                .map(|[x, y]| {
                    let moved = jitter * (12.9898 * x + 78.233 * y).sin();
                    let [x, y] = [20.0 * (ratio * x + moved), 20.0 * (y - moved)];
                    [300.0 + cosine * x - sine * y, sine * x + cosine * y]
                })
                .collect();
            let outline = Outline::of_points(&points).unwrap().outline;
            let area = 400.0 * ratio * f64::from((columns - 1) * (rows - 1));
            let named = format!(
                "{columns} × {rows}, {ratio}, {turn}, {jitter}: {:?}",
                outline.outer
            );
            assert_eq!(outline.outer.len(), 4, "{named}");
            assert!((outline.area() / area - 1.0).abs() < 0.05, "{named}");
        }
    }
    let disc = grid(|[x, y]| (x - 75.0).hypot(y - 25.0) < 13.0);
    let outline = Outline::of_points(&disc).unwrap().outline;
    assert!(outline.outer.len() > 8, "{:?}", outline.outer);
}

/// Markers a little off their grid leave the edge as sure as all of a row make it, and say how rough their rows are.
#[test]
fn edges_are_nearest_to_all_markers_of_their_rows() {
    for seed in 0..8 {
        let mut normal = normal_numbers(seed);
        let moved = |point: [f64; 2]| point.map(|x| x + 0.2 * normal());
        let points: Vec<[f64; 2]> = grid(|_| true).into_iter().map(moved).collect();
        let traced = Outline::of_points(&points).unwrap();
        let outer = &traced.outline.outer;
        assert_eq!(outer.len(), 4, "{seed}: {outer:?}");
        for [[a, b], [c, d]] in polygon::Polygon(outer).edges() {
            let [x, y] = [(a + c) / 2.0, (b + d) / 2.0];
            // Four of the deviations 0.2/√31 and 0.2/√11 mm.
            let (off, far) = if (c - a).abs() > (d - b).abs() {
                (y.min(50.0 - y), 0.15)
            } else {
                (x.min(150.0 - x), 0.25)
            };
            assert!(off.abs() < far, "{seed}: {outer:?}");
        }
        assert!(
            (0.1..0.3).contains(&traced.roughness),
            "{}",
            traced.roughness
        );
    }
    let exact = Outline::of_points(&grid(|_| true)).unwrap();
    assert!(exact.roughness < 1e-12, "{}", exact.roughness);
}

#[test]
fn scattered_markers_have_four_sides() {
    use rand::{RngExt, SeedableRng};
    for seed in 0..12 {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let mut point = || {
            [
                150.0 * random.random::<f64>(),
                50.0 * random.random::<f64>(),
            ]
        };
        let points: Vec<[f64; 2]> = (0..400).map(|_| point()).collect();
        let traced = Outline::of_points(&points).unwrap();
        let mesh = traced.outline.mesh(4.0, CellShape::Triangle3);
        for (side, axis, extent) in [
            ("left", 1, 50.0),
            ("right", 1, 50.0),
            ("bottom", 0, 150.0),
            ("top", 0, 150.0),
        ] {
            let group = mesh.groups().get(side);
            let nodes = group.map_or(&[][..], |group| &group.nodes);
            let [low, high] =
                crate::statistics::extremes(nodes.iter().map(|node| mesh.nodes[*node][axis]));
            assert!(high - low > 0.5 * extent, "{seed} {side}: {low} {high}");
        }
    }
}

/// Points of a grid turned by some degrees, or scattered, that a shape about the origin holds; their spacing is 1.
fn turned_or_scattered(
    degrees: Option<f64>,
    seed: u64,
    holds: impl Fn([f64; 2]) -> bool,
) -> Vec<[f64; 2]> {
    use rand::{RngExt, SeedableRng};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let mut drawn = || random.random::<f64>();
    let all = (-60..=60).flat_map(|i| (-60..=60).map(move |j| [i, j].map(f64::from)));
    let shift = [drawn(), drawn()];
    let (sine, cosine) = degrees.unwrap_or_default().to_radians().sin_cos();
    let placed = all.map(|[x, y]| match degrees {
        Some(_) => [
            cosine * x - sine * y + shift[0],
            sine * x + cosine * y + shift[1],
        ],
        None => [120.0 * (drawn() - 0.5), 120.0 * (drawn() - 0.5)],
    });
    placed.filter(|point| holds(*point)).collect()
}

/// Grids end in steps at an edge that they are turned against, and scattered markers at any.
#[test]
fn rectangles_under_turned_or_scattered_markers_have_four_straight_sides() {
    let size = [60.0, 24.0];
    let holds = |point: [f64; 2]| (0..2).all(|axis| point[axis].abs() <= size[axis] / 2.0);
    let turns = [0.0, 0.5, 2.0, 5.0, 8.0, 20.0, 33.0, 45.0].map(Some);
    let (mut four, mut all) = (0, 0);
    for degrees in turns.into_iter().chain([None]) {
        for seed in 0..6 {
            let points = turned_or_scattered(degrees, seed, holds);
            let outer = Outline::of_points(&points).unwrap().outline.outer;
            all += 1;
            if outer.len() != 4 {
                continue;
            }
            four += 1;
            // No corner is farther off than the markers are apart, and two where they are scattered.
            let most = if degrees.is_some() { 1.5 } else { 3.0 };
            for point in outer {
                let off = [0, 1].map(|axis| point[axis].abs() - size[axis] / 2.0);
                let far = off[0].abs().max(off[1].abs());
                assert!(far < most, "{degrees:?} {seed}: {point:?}");
            }
        }
    }
    assert!(four * 10 >= all * 9, "{four} of {all}");
}

#[test]
fn discs_under_turned_or_scattered_markers_are_round() {
    for degrees in [Some(0.0), Some(10.0), Some(33.0), None] {
        for (seed, radius) in (0..).zip([3.0, 5.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0]) {
            let holds = |[x, y]: [f64; 2]| x.hypot(y) <= radius;
            let points = turned_or_scattered(degrees, seed, holds);
            let outline = Outline::of_points(&points).unwrap().outline;
            let named = format!("{degrees:?} {radius}: {:?}", outline.outer);
            assert!(outline.outer.len() > 8, "{named}");
            let least = radius - if degrees.is_some() { 1.3 } else { 2.6 };
            for point in &outline.outer {
                let far = point[0].hypot(point[1]);
                assert!(far < radius + 1.0 && far > least, "{named}");
            }
        }
    }
}
