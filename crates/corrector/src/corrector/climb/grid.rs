//! A plate's grid: the coordinates of its nodes, and fields on them.

use super::sweep::{Part, sum};
use crate::mesh::{self, lobatto};
use crate::multigrid::{Interpolation, Lines, is_even};

/// Positions that differ by less, as a share of a side, are equal.
const POSITION_TOLERANCE: f64 = 1e-9;

/// The degree from which on elements' own polynomials interpolate as well as cubics.
const CUBIC: usize = 3;

/// The nodes of a plate along both axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Coordinates in mm.
    pub coordinates: [Vec<f64>; 2],
    /// The degree of the elements between them: cells along their sides.
    pub degree: usize,
}

impl Grid {
    /// A grid whose element boundaries are the given coordinates, each element with the nodes of a degree along each axis; see
    /// [`lobatto`].
    pub fn new(boundaries: [&[f64]; 2], degree: usize) -> Self {
        let nodes = &lobatto(degree)[..degree];
        let divide = |boundaries: &[f64]| {
            let within = |pair: &[f64]| -> Vec<f64> {
                let length = pair[1] - pair[0];
                nodes.iter().map(|node| pair[0] + node * length).collect()
            };
            let mut nodes: Vec<f64> = boundaries.windows(2).flat_map(within).collect();
            nodes.extend(boundaries.last());
            nodes
        };
        Self {
            coordinates: boundaries.map(divide),
            degree,
        }
    }

    /// A grid of equal cells.
    pub fn even(size: [f64; 2], cells: [usize; 2]) -> Self {
        Self::graded(size, cells, 1.0)
    }

    /// A grid of cells that become smaller towards the corners; see [`mesh::Grid`].
    pub fn graded(size: [f64; 2], cells: [usize; 2], grading: f64) -> Self {
        let grid = mesh::Grid::new(size, cells, grading);
        Self {
            coordinates: [0, 1].map(|axis| grid.lines(axis)),
            degree: 1,
        }
    }

    /// Whether its elements have cubics of their own.
    pub fn has_cubics(&self) -> bool {
        self.degree >= CUBIC
    }

    /// The grid's lines.
    pub fn lines(&self) -> Lines {
        Lines {
            count: self.coordinates[0].len(),
            nodes: self.coordinates[1].len(),
        }
    }

    /// Cells along X and Y.
    pub fn cells(&self) -> [usize; 2] {
        self.coordinates
            .each_ref()
            .map(|positions| positions.len() - 1)
    }

    /// Whether the cells are equal along both axes.
    pub fn is_even(&self) -> bool {
        self.coordinates.iter().all(|positions| is_even(positions))
    }

    /// The nodes along both axes that a coarser grid has too, if they are at least a third of the coarser grid's nodes and
    /// interpolation between them adds an error of its own.
    pub fn shared_with(&self, coarser: &Self) -> Option<[Vec<usize>; 2]> {
        if self.has_cubics() {
            return None;
        }
        let shared = [0, 1].map(|axis| -> Vec<usize> {
            let (coordinates, others) = (&self.coordinates[axis], &coarser.coordinates[axis]);
            let near = POSITION_TOLERANCE * coordinates[coordinates.len() - 1];
            let has = |node: &usize| {
                let after = others.partition_point(|other| *other < coordinates[*node] - near);
                others
                    .get(after)
                    .is_some_and(|other| *other <= coordinates[*node] + near)
            };
            (0..coordinates.len()).filter(has).collect()
        });
        let enough = |axis: usize| 3 * shared[axis].len() >= coarser.coordinates[axis].len();
        (enough(0) && enough(1)).then_some(shared)
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.coordinates[0].len() * self.coordinates[1].len()
    }

    /// Length of a span of nodes along an axis in mm.
    pub fn span(&self, axis: usize, from: usize, to: usize) -> f64 {
        self.coordinates[axis][to] - self.coordinates[axis][from]
    }
}

/// Both components of a field at the nodes of a grid, line by line.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Nodes on a line.
    pub width: usize,
    /// ux, uy or the forces along X, Y.
    pub components: [Vec<f64>; 2],
}

impl Field {
    /// A field of zeros.
    pub fn zeros(grid: &Grid) -> Self {
        let nodes = grid.nodes();
        Self {
            width: grid.coordinates[1].len(),
            components: [vec![0.0; nodes], vec![0.0; nodes]],
        }
    }

    /// A field from ux, uy of node after node.
    pub fn of_nodes(grid: &Grid, values: &[f64]) -> Self {
        let mut field = Self::zeros(grid);
        for (node, value) in values.chunks_exact(2).enumerate() {
            for (component, value) in field.components.iter_mut().zip(value) {
                component[node] = *value;
            }
        }
        field
    }

    /// ux, uy of node after node.
    pub fn to_nodes(&self) -> Vec<f64> {
        let [x, y] = &self.components;
        x.iter().zip(y).flat_map(|(x, y)| [*x, *y]).collect()
    }

    /// Multiplies all values.
    pub fn scale(&mut self, factor: f64) {
        let part = self.part();
        let [x, y] = &mut self.components;
        part.sweep([x, y], [], &|_, changed, []| {
            for u in changed.into_iter().flatten() {
                *u *= factor;
            }
            []
        });
    }

    /// Adds another field, multiplied.
    pub fn add(&mut self, factor: f64, other: &Self) {
        let part = self.part();
        for (component, other) in self.components.iter_mut().zip(&other.components) {
            part.sweep([component], [other], &|_, [component], [other]| {
                for (u, other) in component.iter_mut().zip(other) {
                    *u += factor * other;
                }
                []
            });
        }
    }

    /// All nodes, to be swept over.
    fn part(&self) -> Part {
        Part::all(Lines {
            count: self.components[0].len() / self.width,
            nodes: self.width,
        })
    }

    /// The sum of products of all values.
    pub fn product(&self, other: &Self) -> f64 {
        let pairs = self.components.iter().zip(&other.components);
        let of_component = |(component, other): (&Vec<f64>, &Vec<f64>)| {
            let [of_pairs] =
                self.part()
                    .sweep([], [component, other], &|_, [], [component, other]| {
                        sum(component.len(), |k| [component[k] * other[k]])
                    });
            of_pairs
        };
        pairs.map(of_component).sum()
    }

    /// The root mean square over the nodes.
    pub fn size(&self) -> f64 {
        (self.product(self) / self.components[0].len() as f64).sqrt()
    }

    /// The root mean square over the nodes of some lines and some positions on them.
    pub fn size_at(&self, [lines, nodes]: &[Vec<usize>; 2]) -> f64 {
        let line = |component: &[f64], line: usize| -> f64 {
            let line = &component[line * self.width..][..self.width];
            nodes.iter().map(|node| line[*node].powi(2)).sum()
        };
        let component = |component: &Vec<f64>| {
            lines
                .iter()
                .map(|position| line(component, *position))
                .sum::<f64>()
        };
        let sum: f64 = self.components.iter().map(component).sum();
        (sum / (lines.len() * nodes.len()) as f64).sqrt()
    }

    /// The nodes between the two grips.
    pub fn free(&self) -> std::ops::Range<usize> {
        self.width..self.components[0].len() - self.width
    }

    /// Interpolates the field on `grid` at the nodes of `finer` by cubics: those of its elements if they have them, otherwise those through
    /// the four nodes around each.
    pub fn onto(&self, grid: &Grid, finer: &Grid) -> Self {
        let [along_x, along_y] = [0, 1].map(|axis| {
            let [nodes, positions] = [grid, finer].map(|grid| &grid.coordinates[axis]);
            if grid.has_cubics() {
                Interpolation::of_elements(nodes, positions, grid.degree)
            } else {
                Interpolation::around(nodes, positions, 4)
            }
        });
        let mut field = Self::zeros(finer);
        let (width_here, width) = (self.width, field.width);
        for (from, to) in self.components.iter().zip(&mut field.components) {
            let part = Part::all(finer.lines());
            part.sweep([to], [], &|part, [to], []| {
                let mut between = vec![0.0; width_here];
                for (position, to) in to.chunks_exact_mut(width).enumerate() {
                    let (first, shares) = along_x.at(part.first / width + position);
                    between.fill(0.0);
                    for (share, from) in shares
                        .iter()
                        .zip(from[first * width_here..].chunks_exact(width_here))
                    {
                        for (sum, value) in between.iter_mut().zip(from) {
                            *sum += share * value;
                        }
                    }
                    for ((first, shares), to) in along_y.shares().zip(to) {
                        let pairs = shares.iter().zip(&between[first..]);
                        *to = pairs.map(|(share, value)| share * value).sum();
                    }
                }
                []
            });
        }
        field
    }
}
