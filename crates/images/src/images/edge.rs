//! The edge of a region of pixels as closed lines.

use std::collections::BTreeMap;

use gelbench_mechanics::mesh::geometry::polygon_area;
use gelbench_mechanics::mesh::straightened;

use super::region::Region;

/// Lines that enclose less than this share of the area of the largest one are specks.
const SPECK: f64 = 1e-3;

/// How far a smoothed line may lie from the one that replaces it, in pixels.
const FAR: f64 = 0.25;

/// Number of sides of pixels before and behind each one that are averaged with it: this smooths the steps of a line that is not along the
/// pixels.
const AROUND: usize = 4;

impl Region {
    /// Its edge as closed lines in pixels from the centre of the upper left one, y down: the outer one and those of its holes, straight
    /// where pixels only step along a line. Specks are left out.
    pub fn edge(&self) -> Vec<Vec<[f64; 2]>> {
        let steps = self.steps();
        let straight = |line: &Vec<[f64; 2]>| straightened(&smoothed(line), FAR);
        let mut lines: Vec<Vec<[f64; 2]>> = steps.iter().map(straight).collect();
        let largest = lines.iter().map(|line| area(line)).fold(0.0, f64::max);
        lines.retain(|line| line.len() > 2 && area(line) > SPECK * largest);
        lines
    }

    /// Closed lines along the sides between pixels inside and outside, from corner to corner.
    fn steps(&self) -> Vec<Vec<[f64; 2]>> {
        let [width, height] = self.size();
        // Corners of pixels by their numbers; each side runs with the inside on its right.
        let mut next: BTreeMap<(usize, usize), Vec<(usize, usize)>> = BTreeMap::new();
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            if !self.has(x, y) {
                continue;
            }
            let mut side = |is_edge: bool, from, to| {
                if is_edge {
                    next.entry(from).or_default().push(to);
                }
            };
            side(y == 0 || !self.has(x, y - 1), (x, y), (x + 1, y));
            side(!self.has(x + 1, y), (x + 1, y), (x + 1, y + 1));
            side(!self.has(x, y + 1), (x + 1, y + 1), (x, y + 1));
            side(x == 0 || !self.has(x - 1, y), (x, y + 1), (x, y));
        }
        let mut lines = Vec::new();
        while let Some(first) = next.keys().next().copied() {
            let (mut line, mut at) = (Vec::new(), first);
            while let Some(ends) = next.get_mut(&at) {
                let to = ends.pop().expect("a corner without sides is removed");
                if ends.is_empty() {
                    next.remove(&at);
                }
                line.push([at.0 as f64 - 0.5, at.1 as f64 - 0.5]);
                at = to;
            }
            lines.push(line);
        }
        lines
    }
}

fn area(line: &[[f64; 2]]) -> f64 {
    polygon_area(line).abs()
}

/// The middles of the sides of a closed line, each the mean of those around; a corner between long straight sides stays where it is.
fn smoothed(line: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let count = line.len();
    let at = |index: usize| line[index % count];
    let middle = |index: usize| [0, 1].map(|axis| 0.5 * (at(index)[axis] + at(index + 1)[axis]));
    let step = |index: usize| [0, 1].map(|axis| at(index + 1)[axis] - at(index)[axis]);
    let is_straight = |from: usize| (1..AROUND).all(|side| step(from + side) == step(from));
    let is_corner = |index: usize| {
        let before = index + count * AROUND - AROUND;
        step(before) != step(index) && is_straight(before) && is_straight(index)
    };
    let corners: Vec<bool> = (0..count).map(is_corner).collect();
    let mut positions = Vec::new();
    for index in 0..count {
        if corners[index] {
            positions.push(line[index]);
        }
        let around = || (0..=2 * AROUND).map(|side| index + side + count * AROUND - AROUND);
        if count < 4 * AROUND || around().any(|side| corners[side % count]) {
            positions.push(middle(index));
            continue;
        }
        let share = 1.0 / (2 * AROUND + 1) as f64;
        positions
            .push([0, 1].map(|axis| share * around().map(|side| middle(side)[axis]).sum::<f64>()));
    }
    positions
}

#[cfg(test)]
mod tests {
    use gelbench_mechanics::mesh::geometry::distance;

    use super::*;

    #[test]
    fn the_edge_of_lines_is_found_again_from_their_pixels() {
        let (size, angle) = ([220, 160], 0.3_f64);
        let turned = |x: f64, y: f64| {
            let (sine, cosine) = angle.sin_cos();
            [110.0 + cosine * x - sine * y, 80.0 + sine * x + cosine * y]
        };
        let rectangle = [[-80.0, -35.0], [80.0, -35.0], [80.0, 35.0], [-80.0, 35.0]];
        let rectangle = rectangle.map(|[x, y]| turned(x, y)).to_vec();
        let circle = (0..90).map(|corner| {
            let (sine, cosine) = (f64::from(corner) * std::f64::consts::TAU / 90.0).sin_cos();
            [110.0 + 20.0 * cosine, 80.0 + 20.0 * sine]
        });
        let speck = vec![[5.0, 5.0], [6.5, 5.0], [6.5, 6.5], [5.0, 6.5]];
        let region = Region::of_lines(&[rectangle.clone(), circle.collect(), speck], size).unwrap();
        let mut lines = region.edge();
        lines.sort_by(|a, b| area(b).total_cmp(&area(a)));
        assert_eq!(lines.len(), 2, "the speck is left out");
        assert!((area(&lines[0]) / (160.0 * 70.0) - 1.0).abs() < 0.005);
        assert!((area(&lines[1]) / (std::f64::consts::PI * 400.0) - 1.0).abs() < 0.03);
        assert!(
            lines[0].len() < 30 && lines[1].len() < 60,
            "{} {}",
            lines[0].len(),
            lines[1].len()
        );
        for corner in &rectangle {
            let nearest = lines[0].iter().map(|position| distance(*corner, *position));
            assert!(nearest.fold(f64::MAX, f64::min) < 2.0, "{corner:?}");
        }
    }

    #[test]
    fn pixels_that_touch_at_a_corner_and_the_rim_of_an_image_have_closed_edges() {
        let full = Region::full([6, 4]);
        let edge = full.edge();
        assert!((area(&edge[0]) / 24.0 - 1.0).abs() < 0.1, "{edge:?}");
        let full = Region::full([60, 40]).edge();
        assert_eq!((area(&full[0]), full[0].len()), (2400.0, 4));
        let both = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let shifted = both.map(|[x, y]| [x + 3.0, y + 3.0]);
        let region = Region::of_lines(&[both.to_vec(), shifted.to_vec()], [8, 8]).unwrap();
        assert!(region.steps().iter().all(|line| line.len() > 3));
    }
}
