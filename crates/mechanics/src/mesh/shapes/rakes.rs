//! A rectangular sheet with the round holes of tines near its sides, as curved blocks.
//!
//! Lines through the sheet, on both sides of every row of tines, cut it into rectangles. Those around a tine become four blocks between
//! the tine and the rectangle, the others one block each.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::super::blocks::Block;
use super::super::cells::Mesh;
use super::super::strips::count;

/// A rectangular sheet with tines near its four sides: left, right, bottom and top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rakes {
    /// Length and width of the sheet in mm.
    pub size: [f64; 2],
    /// Tines at each side.
    pub tines: usize,
    /// Distance between neighbouring tines of one side in mm.
    pub spacing: f64,
    /// Distance of the tines' centres from their side in mm.
    pub inset: f64,
    /// Their radius in mm.
    pub radius: f64,
}

/// The sides with the groups of their tines.
pub const SIDES: [(&str, &str); 4] = [
    ("left", "left-tines"),
    ("right", "right-tines"),
    ("bottom", "bottom-tines"),
    ("top", "top-tines"),
];

/// Least distance of two rows of tines, and of tines from a side, in diameters.
pub const LEAST_GAP: f64 = 1.2;

/// Half the side of the square around a tine, in radii.
const HALF_SQUARE: f64 = 4.0;

/// One axis of the sheet: lines, and the cells between each and the next.
struct Lines {
    positions: Vec<f64>,
    cells: Vec<usize>,
}

impl Rakes {
    /// The tines' centres along an axis, of those that are moved along the other one.
    fn row(&self, axis: usize) -> impl Iterator<Item = f64> {
        let middle = [0.5 * self.size[0], 0.0][axis];
        let Self { tines, spacing, .. } = *self;
        (0..tines).map(move |tine| middle + (tine as f64 - 0.5 * (tines - 1) as f64) * spacing)
    }

    /// The first and the last position of the sheet along an axis.
    fn ends(&self, axis: usize) -> [f64; 2] {
        match axis {
            0 => [0.0, self.size[0]],
            _ => [-0.5 * self.size[1], 0.5 * self.size[1]],
        }
    }

    /// The centres of the tines of a side.
    pub fn centres(&self, side: usize) -> Vec<[f64; 2]> {
        let axis = side / 2;
        let [low, high] = self.ends(axis);
        let along = [low + self.inset, high - self.inset][side % 2];
        let row = self.row(1 - axis);
        row.map(|across| {
            if axis == 0 {
                [along, across]
            } else {
                [across, along]
            }
        })
        .collect()
    }

    /// All positions of centres along an axis, ascending.
    fn positions(&self, axis: usize) -> Vec<f64> {
        let [low, high] = self.ends(axis);
        let mut positions: Vec<f64> = self.row(axis).collect();
        positions.extend([low + self.inset, high - self.inset]);
        positions.sort_by(f64::total_cmp);
        positions
    }

    /// The least distance of two rows of tines, or of twice a row from a side, in mm.
    pub fn least_gap(&self) -> f64 {
        let gap = |axis: usize| {
            let (positions, [low, high]) = (self.positions(axis), self.ends(axis));
            let between = positions.windows(2).map(|pair| pair[1] - pair[0]);
            let from_sides = [
                2.0 * (positions[0] - low),
                2.0 * (high - positions[positions.len() - 1]),
            ];
            between.chain(from_sides).fold(f64::INFINITY, f64::min)
        };
        gap(0).min(gap(1))
    }

    /// Half the side of the squares around the tines.
    fn reach(&self) -> f64 {
        (0.5 * self.least_gap()).min(HALF_SQUARE * self.radius)
    }

    fn lines(&self, axis: usize, size: f64, around: usize) -> Lines {
        let (reach, [low, high]) = (self.reach(), self.ends(axis));
        let mut lines = Lines {
            positions: vec![low],
            cells: Vec::new(),
        };
        let mut add = |to: f64, cells: usize| {
            let from = lines.positions[lines.positions.len() - 1];
            if to - from > 1e-6 * size {
                lines.positions.push(to);
                lines.cells.push(cells);
            }
        };
        let between = |from: f64, to: f64| count((to - from) / size);
        let mut last = low;
        for centre in self.positions(axis) {
            add(centre - reach, between(last, centre - reach));
            add(centre + reach, around);
            last = centre + reach;
        }
        add(high, between(last, high));
        if let Some(end) = lines.positions.last_mut() {
            *end = high;
        }
        lines
    }

    /// The blocks of a mesh with about so many cells across the sheet.
    pub fn blocks(&self, across: usize) -> Vec<Block<'static>> {
        let size = self.size[0].min(self.size[1]) / across as f64;
        let around = count(2.0 * self.reach() / size).max(2);
        let [x, y] = [0, 1].map(|axis| self.lines(axis, size, around));
        let mut blocks = Vec::new();
        for (i, ends_x) in x.positions.windows(2).enumerate() {
            for (j, ends_y) in y.positions.windows(2).enumerate() {
                let [low, high] = [0, 1].map(|end| [ends_x[end], ends_y[end]]);
                let on = |is_on: bool, side: usize| if is_on { SIDES[side].0 } else { "" };
                let sides = [
                    on(j == 0, 2),
                    on(i + 1 == x.cells.len(), 1),
                    on(j + 1 == y.cells.len(), 3),
                    on(i == 0, 0),
                ];
                match self.tine_in(low, high) {
                    Some((side, centre)) => {
                        blocks.extend(self.around_tine(centre, SIDES[side].1, sides, around));
                    }
                    None => blocks.push(Block {
                        map: Box::new(move |share: [f64; 2]| {
                            [0, 1].map(|axis| low[axis] + share[axis] * (high[axis] - low[axis]))
                        }),
                        cells: [x.cells[i], y.cells[j]],
                        sides,
                    }),
                }
            }
        }
        blocks
    }

    /// The side of the tine within a rectangle, and its centre.
    fn tine_in(&self, low: [f64; 2], high: [f64; 2]) -> Option<(usize, [f64; 2])> {
        let is_in = |centre: &[f64; 2]| {
            [0, 1]
                .iter()
                .all(|a| low[*a] < centre[*a] && centre[*a] < high[*a])
        };
        (0..4).find_map(|side| {
            let centre = self.centres(side).into_iter().find(is_in)?;
            Some((side, centre))
        })
    }

    /// The four blocks between a tine and the square around it, whose cells grow away from the tine in proportion to their distance.
    fn around_tine(
        &self,
        centre: [f64; 2],
        tines: &'static str,
        sides: [&'static str; 4],
        around: usize,
    ) -> impl Iterator<Item = Block<'static>> {
        let (radius, reach) = (self.radius, self.reach());
        let growth = (reach / radius).ln();
        let radial = count(growth * 2.0 * around as f64 / std::f64::consts::PI).max(2);
        // The sides of the square in the directions 0°, 90°, 180° and 270°.
        let outer = [sides[1], sides[2], sides[3], sides[0]];
        outer.into_iter().enumerate().map(move |(quarter, outer)| {
            let (sine, cosine) = (quarter as f64 * FRAC_PI_2).sin_cos();
            Block {
                map: Box::new(move |[s, t]: [f64; 2]| {
                    let angle = (2.0 * t - 1.0) * FRAC_PI_4;
                    let share = match s {
                        1.0 => 1.0,
                        _ => (s * growth).exp_m1() / growth.exp_m1(),
                    };
                    let from = [radius * angle.cos(), radius * angle.sin()];
                    let to = [reach, reach * (2.0 * t - 1.0)];
                    let [x, y] = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
                    [
                        centre[0] + cosine * x - sine * y,
                        centre[1] + sine * x + cosine * y,
                    ]
                }),
                cells: [radial, around],
                sides: ["", outer, "", tines],
            }
        })
    }

    /// Names the nodes of each tine, such as `left-tine-1`, from the smallest coordinate on.
    pub fn name_tines(&self, mesh: &mut Mesh) {
        for (side, (name, group)) in SIDES.into_iter().enumerate() {
            for (tine, centre) in self.centres(side).into_iter().enumerate() {
                let nodes = mesh.groups()[group].nodes.iter().copied();
                let near = nodes.filter(|node| {
                    let [x, y] = mesh.nodes[*node];
                    (x - centre[0]).hypot(y - centre[1]) < 1.1 * self.radius
                });
                let near = near.collect();
                mesh.name_nodes(&format!("{name}-tine-{}", tine + 1), &near);
            }
        }
    }

    /// The position on the nearest tine of a group of tines; `None` for the straight sides.
    pub fn on_tine(&self, group: &str, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let side = SIDES.iter().position(|(_, tines)| *tines == group)?;
        let distance = |[a, b]: &[f64; 2]| (x - a).hypot(y - b);
        let centres = self.centres(side).into_iter();
        let centre = centres.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let share = self.radius / distance(&centre);
        Some([
            centre[0] + share * (x - centre[0]),
            centre[1] + share * (y - centre[1]),
        ])
    }
}
