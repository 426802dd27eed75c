//! Nested dissection by coordinates: an order of elimination that keeps the factors of large meshes sparse.

use super::pattern::SymmetricPattern;
use crate::statistics::extremes;

/// Most vertices of a part that is not divided any more.
const LEAF: usize = 9;

/// An order of elimination of the unknowns of a pattern from the position of each one: the body is divided at the middle
/// of its longer side, the unknowns at the cut come after those of both halves, and so on in the halves.
///
/// Neighbouring unknowns of one position stay together.
///
/// # References
/// A. George, SIAM J. Numer. Anal. 10, 345 (1973), doi:10.1137/0710032
pub fn dissection(pattern: &SymmetricPattern, positions: &[[f64; 2]]) -> Vec<usize> {
    let mut graph = Graph::new(pattern, positions);
    let mut order = Vec::with_capacity(graph.positions.len());
    let mut vertices: Vec<usize> = (0..graph.positions.len()).collect();
    graph.dissect(&mut vertices, &mut order);
    let unknowns = order
        .into_iter()
        .flat_map(|vertex| graph.starts[vertex]..graph.starts[vertex + 1]);
    unknowns.collect()
}

/// Where a vertex is in the part that is being divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Half {
    Outside,
    Lower,
    Upper,
}

/// Runs of unknowns of one position, and their couplings.
struct Graph {
    /// Where the unknowns of each vertex begin.
    starts: Vec<usize>,
    positions: Vec<[f64; 2]>,
    /// For each vertex the later ones that it is coupled with.
    later: Vec<Vec<u32>>,
    halves: Vec<Half>,
    at_cut: Vec<bool>,
}

impl Graph {
    fn new(pattern: &SymmetricPattern, positions: &[[f64; 2]]) -> Self {
        let size = pattern.size();
        let mut starts: Vec<usize> = (0..size)
            .filter(|unknown| *unknown == 0 || positions[*unknown] != positions[unknown - 1])
            .collect();
        let positions: Vec<[f64; 2]> = starts.iter().map(|start| positions[*start]).collect();
        starts.push(size);
        let mut vertex_of = vec![0_u32; size];
        for vertex in 0..positions.len() {
            vertex_of[starts[vertex]..starts[vertex + 1]].fill(vertex as u32);
        }
        let later = |vertex: usize| {
            let columns = starts[vertex]..starts[vertex + 1];
            let rows = columns.flat_map(|column| pattern.column(column));
            let mut later: Vec<u32> = rows.map(|row| vertex_of[*row]).collect();
            later.sort_unstable();
            later.dedup();
            later.retain(|other| *other as usize != vertex);
            later.shrink_to_fit();
            later
        };
        Self {
            later: (0..positions.len()).map(later).collect(),
            halves: vec![Half::Outside; positions.len()],
            at_cut: vec![false; positions.len()],
            starts,
            positions,
        }
    }

    fn dissect(&mut self, vertices: &mut [usize], order: &mut Vec<usize>) {
        let Some(middle) = self.halve(vertices) else {
            vertices.sort_unstable();
            order.extend_from_slice(vertices);
            return;
        };
        let cut = self.cut(vertices, middle);
        for vertex in &cut {
            self.at_cut[*vertex] = true;
        }
        let (lower, upper) = vertices.split_at_mut(middle);
        for half in [lower, upper] {
            let mut rest: Vec<usize> = half.to_vec();
            rest.retain(|vertex| !self.at_cut[*vertex]);
            self.dissect(&mut rest, order);
        }
        order.extend(cut);
    }

    /// Moves the vertices below the middle of the longer side to the front and returns their number; `None` where the
    /// part is small or has no two sides.
    fn halve(&self, vertices: &mut [usize]) -> Option<usize> {
        if vertices.len() <= LEAF {
            return None;
        }
        let extent = |axis: usize| {
            let positions = vertices.iter().map(|vertex| self.positions[*vertex][axis]);
            let [low, high] = extremes(positions);
            high - low
        };
        let axis = usize::from(extent(1) > extent(0));
        let position = |vertex: usize| self.positions[vertex][axis];
        let half = vertices.len() / 2;
        let by_place = |a: &usize, b: &usize| position(*a).total_cmp(&position(*b));
        let middle = position(*vertices.select_nth_unstable_by(half, by_place).1);
        // All vertices of one line fall into one half.
        let mut lower: Vec<usize> = Vec::with_capacity(vertices.len());
        lower.extend(vertices.iter().filter(|vertex| position(**vertex) < middle));
        let count = lower.len();
        lower.extend(
            vertices
                .iter()
                .filter(|vertex| position(**vertex) >= middle),
        );
        vertices.copy_from_slice(&lower);
        (count > 0).then_some(count)
    }

    /// The vertices of one half that are coupled with the other one: of the two such sets the smaller one.
    fn cut(&mut self, vertices: &[usize], middle: usize) -> Vec<usize> {
        for (index, vertex) in vertices.iter().enumerate() {
            self.halves[*vertex] = if index < middle {
                Half::Lower
            } else {
                Half::Upper
            };
        }
        let mut sides = [Vec::new(), Vec::new()];
        for vertex in vertices {
            for other in &self.later[*vertex] {
                let pair = [*vertex, *other as usize];
                let halves = pair.map(|vertex| self.halves[vertex]);
                if !halves.contains(&Half::Outside) && halves[0] != halves[1] {
                    for (vertex, half) in pair.into_iter().zip(halves) {
                        sides[usize::from(half == Half::Upper)].push(vertex);
                    }
                }
            }
        }
        for vertex in vertices {
            self.halves[*vertex] = Half::Outside;
        }
        for side in &mut sides {
            side.sort_unstable();
            side.dedup();
        }
        let [lower, upper] = sides;
        if upper.len() < lower.len() {
            upper
        } else {
            lower
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two unknowns at each node of a grid of bilinear or biquadratic elements.
    fn grid(cells: usize, degree: usize) -> (SymmetricPattern, Vec<[f64; 2]>) {
        let side = cells * degree + 1;
        let mut columns = vec![Vec::new(); 2 * side * side];
        for element in 0..cells * cells {
            let corner = [element / cells * degree, element % cells * degree];
            let node =
                |k: usize| (corner[0] + k / (degree + 1)) * side + corner[1] + k % (degree + 1);
            let nodes = (0..(degree + 1) * (degree + 1)).map(node);
            let unknowns: Vec<usize> = nodes.flat_map(|node| [2 * node, 2 * node + 1]).collect();
            for column in &unknowns {
                columns[*column].extend_from_slice(&unknowns);
            }
        }
        let position = |unknown: usize| [(unknown / 2 / side) as f64, (unknown / 2 % side) as f64];
        let positions = (0..columns.len()).map(position).collect();
        (SymmetricPattern::new(columns.into_iter()), positions)
    }

    #[test]
    fn every_unknown_comes_once_and_the_first_cut_is_one_line_of_nodes() {
        // The middle falls on a boundary of biquadratic elements and into one.
        for (cells, degree) in [(12, 1), (12, 2), (13, 2)] {
            let (pattern, positions) = grid(cells, degree);
            let order = dissection(&pattern, &positions);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            let each = sorted.iter().enumerate();
            assert!(each.into_iter().all(|(index, unknown)| index == *unknown));
            let line = 2 * (cells * degree + 1);
            let cut = &order[order.len() - line..];
            let first = positions[cut[0]][0];
            assert!(cut.iter().all(|unknown| positions[*unknown][0] == first));
            // Before it one half comes as a whole, then the other one, and none reaches over the cut.
            let rest = &order[..order.len() - line];
            let below = |unknown: &usize| positions[*unknown][0] < first;
            let lower = rest.iter().take_while(|unknown| below(unknown)).count();
            assert!(lower > 0 && !rest[lower..].iter().any(below));
            for column in rest {
                let rows = pattern.column(*column).iter();
                let off_cut = rows.filter(|row| positions[**row][0] != first);
                off_cut.for_each(|row| assert_eq!(below(row), below(column)));
            }
        }
    }

    #[test]
    fn unknowns_of_one_place_are_one_part() {
        let (pattern, _) = grid(5, 1);
        let order = dissection(&pattern, &vec![[1.0, 2.0]; pattern.size()]);
        assert!(
            order
                .iter()
                .enumerate()
                .all(|(index, unknown)| index == *unknown)
        );
    }
}
