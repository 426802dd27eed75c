//! Round edges among markers, and corners that stay.

use super::super::Outline;
use crate::mesh::geometry::{distance, polygon_area};

/// Points of a grid of 1 mm, moved by less than a step, that a specimen of 40 × 30 mm with a round hole holds.
fn markers([ox, oy]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    let along = (0..40).flat_map(|i| (0..30).map(move |j| [f64::from(i) + ox, f64::from(j) + oy]));
    let is_held = |[x, y]: &[f64; 2]| (x - 20.0).hypot(y - 15.0) > radius;
    along.filter(is_held).collect()
}

#[test]
fn a_round_hole_among_markers_is_round_and_ends_at_the_innermost_ones() {
    for radius in [3.0, 5.0, 8.0] {
        for shift in [[0.0, 0.0], [0.3, 0.1], [0.5, 0.5], [0.77, 0.42]] {
            let points = markers(shift, radius);
            let outline = Outline::of_points(&points).unwrap().outline;
            assert_eq!(outline.holes.len(), 1);
            let hole = &outline.holes[0];
            let radii = hole.iter().map(|point| distance(*point, [20.0, 15.0]));
            let [low, high] = crate::statistics::extremes(radii);
            assert!(
                low > radius - 0.45 && high < radius + 0.8,
                "{radius} {shift:?}: {low} … {high}"
            );
            // No marker tells of what is nearer than the nearest one.
            let reached = points.iter().map(|point| distance(*point, [20.0, 15.0]));
            let nearest = reached.fold(f64::INFINITY, f64::min);
            let mean_radius = (-polygon_area(hole) / std::f64::consts::PI).sqrt();
            assert!(
                mean_radius > nearest - 0.1 && mean_radius < nearest + 0.3,
                "{radius} {shift:?}: {mean_radius} {nearest}"
            );
        }
    }
}

/// Markers along circles and an arched edge: the lines go through them.
#[test]
fn curves_go_through_markers_that_lie_on_them() {
    for spacing in [0.8, 1.6] {
        let rows = (16.0 / spacing) as usize;
        let rings = (0..=rows).flat_map(|row| {
            let radius = 8.0 + 16.0 * row as f64 / rows as f64;
            let count = (std::f64::consts::TAU * radius / spacing).round() as usize;
            (0..count).map(move |i| {
                let (sine, cosine) = (std::f64::consts::TAU * i as f64 / count as f64).sin_cos();
                [5000.0 + radius * cosine, radius * sine]
            })
        });
        let traced = Outline::of_points(&rings.collect::<Vec<_>>()).unwrap();
        let outline = traced.outline;
        assert_eq!(outline.holes.len(), 1);
        for (line, radius) in [(&outline.outer, 24.0), (&outline.holes[0], 8.0)] {
            for point in line {
                let off = distance(*point, [5000.0, 0.0]) - radius;
                assert!(
                    off.abs() < 2e-3 * traced.spacing,
                    "{spacing} {radius}: {off}"
                );
            }
            let mean_radius = (polygon_area(line).abs() / std::f64::consts::PI).sqrt();
            assert!(
                (mean_radius - radius).abs() < 4e-3 * traced.spacing,
                "{spacing}: {mean_radius}"
            );
        }
    }
    // A sheet with one arched edge between two corners.
    let sheet = (0..=40).flat_map(|i| {
        let x = f64::from(i);
        let height = 12.0 + 4.0 * (std::f64::consts::PI * x / 40.0).sin();
        (0..=12).map(move |j| [x, height * f64::from(j) / 12.0])
    });
    let traced = Outline::of_points(&sheet.collect::<Vec<_>>()).unwrap();
    let exact = 40.0 * (12.0 + 8.0 / std::f64::consts::PI);
    let area = polygon_area(&traced.outline.outer);
    assert!((area / exact - 1.0).abs() < 1e-3, "{area} {exact}");
}

#[test]
fn corners_of_small_specimens_stay() {
    for [across, along] in [
        [4, 4],
        [5, 10],
        [6, 6],
        [3, 20],
        [2, 20],
        [1, 8],
        [2, 5],
        [10, 10],
    ] {
        let points: Vec<[f64; 2]> = (0..=across)
            .flat_map(|i| (0..=along).map(move |j| [f64::from(i), f64::from(j)]))
            .collect();
        let outline = Outline::of_points(&points).unwrap().outline;
        assert_eq!(
            outline.outer.len(),
            4,
            "{across} {along}: {:?}",
            outline.outer
        );
        assert_eq!(polygon_area(&outline.outer), f64::from(across * along));
    }
}

#[test]
fn corners_and_straight_edges_stay() {
    let square = |[x, y]: &[f64; 2]| (x - 20.0).abs() > 6.5 || (y - 15.0).abs() > 4.5;
    let points: Vec<[f64; 2]> = markers([0.0, 0.0], 0.1)
        .into_iter()
        .filter(square)
        .collect();
    let outline = Outline::of_points(&points).unwrap().outline;
    assert_eq!(outline.outer.len(), 4);
    // Triangles of neighbours close the corners of a hole.
    for (axis, ends) in [[13.0, 27.0], [10.0, 20.0]].into_iter().enumerate() {
        let reached = crate::statistics::extremes(outline.holes[0].iter().map(|p| p[axis]));
        for (end, reached) in ends.into_iter().zip(reached) {
            assert!((end - reached).abs() < 0.05, "{:?}", outline.holes[0]);
        }
    }
    assert!((-polygon_area(&outline.holes[0]) / 140.0 - 1.0).abs() < 0.1);
}

/// A waist of circular arcs between straight edges, as a dog-bone has it.
#[test]
fn arcs_between_straight_edges_are_round() {
    let half = |x: f64| {
        let u = (x - 30.0) / 14.0;
        let waist = if u.abs() < 1.0 {
            5.0 * (1.0 - u * u).powi(2)
        } else {
            0.0
        };
        15.0 - waist
    };
    let points: Vec<[f64; 2]> = (0..=60)
        .flat_map(|i| (-15..=15).map(move |j| [f64::from(i), f64::from(j)]))
        .filter(|[x, y]| y.abs() <= half(*x) + 1e-9)
        .collect();
    let outline = Outline::of_points(&points).unwrap().outline;
    for [x, y] in &outline.outer {
        assert!(
            y.abs() < half(*x) + 0.6 && (*x <= 0.0 || *x >= 60.0 || y.abs() > half(*x) - 0.6),
            "{x} {y}"
        );
    }
    let area: f64 = (0..6000)
        .map(|i| 0.02 * half(f64::from(i) * 0.01 + 0.005))
        .sum();
    crate::assert_near(polygon_area(&outline.outer), area, 5e-3, &"");
}
