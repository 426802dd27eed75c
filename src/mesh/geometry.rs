//! Points of the plane: boxes, areas, distances.

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

/// The area inside a closed line of straight edges, positive where it runs counter-clockwise.
pub fn polygon_area(line: &[[f64; 2]]) -> f64 {
    let next = line.iter().cycle().skip(1);
    let twice = line
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - b[0] * a[1]);
    twice.sum::<f64>() / 2.0
}

/// The distance of two points.
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The determinant of a matrix of two rows.
pub fn determinant(map: &[[f64; 2]; 2]) -> f64 {
    map[0][0] * map[1][1] - map[0][1] * map[1][0]
}
