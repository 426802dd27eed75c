//! Points of the plane: boxes, areas, distances.

use crate::units::{SIZES, on_the_end};

/// Lower left and upper right corner of the box around points.
pub fn bounding_box(points: impl IntoIterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.into_iter().fold(start, |[low, high], [x, y]| {
        [
            [low[0].min(x), low[1].min(y)],
            [high[0].max(x), high[1].max(y)],
        ]
    })
}

/// Sides of the box around points.
pub fn sides(points: impl IntoIterator<Item = [f64; 2]>) -> [f64; 2] {
    let [low, high] = bounding_box(points);
    [high[0] - low[0], high[1] - low[1]]
}

/// Points whose size is not that of a specimen: length and width of the box around them in mm, and the largest coordinate.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "span {:.1e} × {:.1e} mm and reach to {reach:.1e} mm from the origin, but specimens must measure 1 nm to 1 km and lie within 1 km of the origin: check the unit",
    .span[0],
    .span[1]
)]
pub struct OutOfSize {
    /// Length and width of the box around the points in mm.
    pub span: [f64; 2],
    /// The largest coordinate in mm.
    pub reach: f64,
}

/// Checks that points have the size of a specimen.
///
/// # Errors
/// [`OutOfSize`] where they do not have it.
pub fn check_size(points: impl IntoIterator<Item = [f64; 2]>) -> Result<(), OutOfSize> {
    let [low, high] = bounding_box(points);
    let span = [high[0] - low[0], high[1] - low[1]];
    let reach = [low, high]
        .as_flattened()
        .iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let [least, most] = SIZES;
    // NaN is out of size too.
    let sized =
        on_the_end(span[0].max(span[1]), SIZES) >= least && on_the_end(reach, SIZES) <= most;
    sized.then_some(()).ok_or(OutOfSize { span, reach })
}

/// The area inside a closed line of straight edges, positive where it runs counter-clockwise.
pub fn polygon_area(line: &[[f64; 2]]) -> f64 {
    let next = line.iter().cycle().skip(1);
    let twice = line
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - b[0] * a[1]);
    twice.sum::<f64>() / 2.0
}

/// The numbers of the points that are corners of their convex hull, counter-clockwise (Andrew's monotone chain).
pub fn convex_hull(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| {
        let [p, q] = [points[*a], points[*b]];
        p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1]))
    });
    let half = |order: &mut dyn Iterator<Item = usize>| {
        let mut half: Vec<usize> = Vec::new();
        for next in order {
            while let [.., before, last] = half[..]
                && polygon_area(&[points[before], points[last], points[next]]) <= 0.0
            {
                half.pop();
            }
            half.push(next);
        }
        half.pop();
        half
    };
    let mut corners = half(&mut order.iter().copied());
    corners.extend(half(&mut order.iter().rev().copied()));
    corners
}

/// The least distance of two parallel lines that have all points between them: the smaller side of a rectangle, however it lies.
pub fn least_width(points: &[[f64; 2]]) -> f64 {
    let corners = convex_hull(points).into_iter().map(|corner| points[corner]);
    let corners: Vec<[f64; 2]> = corners.collect();
    let next = corners.iter().cycle().skip(1);
    // Whatever the direction, no extent across it is less than the least one.
    let least = corners.iter().zip(next).map(|(a, b)| {
        let along = [b[0] - a[0], b[1] - a[1]].map(|x| x / distance(*a, *b));
        let across = corners.iter().map(|[x, y]| along[0] * y - along[1] * x);
        let [least, most] = across.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| {
            [least.min(x), most.max(x)]
        });
        most - least
    });
    let least = least.fold(f64::INFINITY, f64::min);
    let [along_x, along_y] = sides(points.iter().copied());
    let along_axes = along_x.min(along_y);
    // Of sides along the axes rounding makes no difference.
    if least < along_axes * (1.0 - 1e-9) {
        least
    } else {
        along_axes
    }
}

/// The distance of two points.
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The angle in rad by which a vector must turn to point along another one, from −π to π.
pub fn turn(from: [f64; 2], to: [f64; 2]) -> f64 {
    determinant(&[from, to]).atan2(from[0] * to[0] + from[1] * to[1])
}

/// The determinant of a 2 × 2 matrix, by rows.
pub fn determinant(map: &[[f64; 2]; 2]) -> f64 {
    map[0][0] * map[1][1] - map[0][1] * map[1][0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_width_does_not_depend_on_how_points_lie() {
        for degrees in [0.0, 17.5, 45.0, 90.0, 200.0_f64] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let turned = |x: f64, y: f64| [cosine * x - sine * y, sine * x + cosine * y];
            let points = (0..=20).flat_map(|i| (0..=4).map(move |k| [i, k]));
            let points = points.map(|[i, k]| turned(5.0 * f64::from(i), f64::from(k)));
            // Nodes on a side that rounding moves out of line, to and fro.
            let moved = points.enumerate().map(|(number, [x, y])| {
                let rounding = 1e-14 * f64::from(u8::from(number % 3 == 0));
                [x + rounding, y - rounding]
            });
            let width = least_width(&moved.collect::<Vec<_>>());
            assert!((width - 4.0).abs() < 1e-12, "{degrees}: {width}");
        }
    }
}
