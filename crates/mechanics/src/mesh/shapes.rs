//! Flat specimens given by their dimensions, meshed with curved blocks.

use std::collections::BTreeSet;

use super::blocks::{Block, mesh_of_blocks};
use super::cell_shape::CellShape;
use super::cells::Mesh;
use super::strips::{Part, count, lengths, strip, with_hole};

mod cruciform;
mod measures;
mod rakes;
#[cfg(test)]
mod tests;

use cruciform::cruciform;
pub use measures::Misfit;
pub use rakes::Rakes;

/// A specimen by its dimensions in mm. All lie along X from 0, with the axis Y = 0 in their middle, except the ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A rectangle; groups `left`, `right`, `bottom`, `top`, and its corners, such as `bottom-left`.
    Strip {
        /// Length and width.
        size: [f64; 2],
    },
    /// A rectangle with a round hole in its middle; groups as a strip, and `hole`.
    StripWithHole {
        /// Length and width.
        size: [f64; 2],
        /// Radius of the hole.
        radius: f64,
    },
    /// A rectangle with two equal notches, arcs of circles, at mid length; groups as a strip.
    NotchedStrip {
        /// Length and width.
        size: [f64; 2],
        /// Depth of a notch.
        depth: f64,
        /// Half the length of a notch on the edge.
        half_length: f64,
    },
    /// Wide ends, a narrow middle and arcs of circles between them (ISO 37); groups as a strip.
    DogBone {
        /// Length and width of the ends.
        size: [f64; 2],
        /// Length and width of the narrow part.
        narrow: [f64; 2],
        /// Length of an arc's projection on X.
        shoulder: f64,
    },
    /// A sector of a ring about the origin that begins on the X axis; groups `inside`, `outside`, `start`, `end`, and the
    /// corners, such as `inside-start`.
    RingSector {
        /// Radii.
        radii: [f64; 2],
        /// Angle in rad.
        angle: f64,
    },
    /// A rectangle that is held by tines near its sides, as in a biaxial test; groups as a strip, `left-tines`, `right-tines`,
    /// `bottom-tines`, `top-tines`, and each tine, such as `left-tine-1`.
    SquareOnRakes(Rakes),
    /// A cross of four arms with fillets between them; groups `left`, `right`, `bottom`, `top` at the tips, `arms` and `fillets`.
    Cruciform {
        /// Length and width from tip to tip.
        size: [f64; 2],
        /// Width of the arms.
        arm_width: f64,
        /// Radius of the fillets.
        fillet: f64,
    },
}

/// The largest ratio of a shape's largest distance to its least: meshes distinguish nodes that are 1e-8 of the largest from each other.
const MOST_RATIO: f64 = 1e5;

impl Shape {
    /// A mesh with so many cells across the specimen, and as many along it as make cells about square.
    pub fn mesh(self, across: usize, kind: CellShape) -> Mesh {
        // At least two cells between a hole and a side.
        self.mesh_of([across, 2], 0, kind)
    }

    /// A mesh with so many cells across, at least one between a hole and a side, whose cells' sides are then halved so many
    /// times, with new nodes on the outline: such meshes are one family, whose errors fall with the size of their cells.
    pub fn mesh_halved(self, across: usize, halvings: usize, kind: CellShape) -> Mesh {
        self.mesh_of([across, 1], halvings, kind)
    }

    fn mesh_of(self, [across, adjacent]: [usize; 2], halvings: usize, kind: CellShape) -> Mesh {
        let mut blocks = self.blocks(across, adjacent);
        for block in &mut blocks {
            block.cells = block.cells.map(|count| count << halvings);
        }
        let mut mesh = mesh_of_blocks(&blocks, kind);
        name_corners(&mut mesh);
        if let Self::SquareOnRakes(rakes) = self {
            rakes.name_tines(&mut mesh);
        }
        mesh
    }

    /// The blocks of its mesh, with at least so many cells beside a hole.
    fn blocks(self, across: usize, adjacent: usize) -> Vec<Block<'static>> {
        match self {
            Self::Strip { size } | Self::NotchedStrip { size, .. } | Self::DogBone { size, .. } => {
                strip(&self.parts(size[0]), across, move |x| self.half_width(x))
            }
            Self::StripWithHole { size, radius } => with_hole(size, radius, across, adjacent),
            Self::SquareOnRakes(rakes) => rakes.blocks(across),
            Self::Cruciform {
                size,
                arm_width,
                fillet,
            } => cruciform(size, arm_width, fillet, across),
            Self::RingSector { radii, angle } => {
                let along = angle * (radii[0] + radii[1]) / 2.0;
                let cells = [across, count(along / (radii[1] - radii[0]) * across as f64)];
                vec![Block {
                    map: Box::new(move |[s, t]: [f64; 2]| {
                        let radius = radii[0] + s * (radii[1] - radii[0]);
                        let (sine, cosine) = (t * angle).sin_cos();
                        [radius * cosine, radius * sine]
                    }),
                    cells,
                    sides: ["start", "outside", "end", "inside"],
                }]
            }
        }
    }

    /// About how many quadrilaterals [`Self::mesh`] makes with so many cells across; twice as many triangles.
    pub fn cell_count(self, across: f64) -> f64 {
        let along = match self {
            Self::RingSector { radii, angle } => {
                angle * (radii[0] + radii[1]) / (2.0 * (radii[1] - radii[0]))
            }
            Self::SquareOnRakes(rakes) => {
                // Around each tine there are as many as in a sixth of the sheet.
                let [low, high] = [
                    rakes.size[0].min(rakes.size[1]),
                    rakes.size[0].max(rakes.size[1]),
                ];
                return across * across * high / low + 32.0 * 4.0 * rakes.tines as f64;
            }
            Self::Cruciform {
                size, arm_width, ..
            } => (size[0] + size[1]) / arm_width,
            // Around the hole there are about twice as many as in the strip.
            Self::StripWithHole { size, .. } => 2.0 + size[0].max(size[1]) / size[0].min(size[1]),
            Self::Strip { size } | Self::NotchedStrip { size, .. } | Self::DogBone { size, .. } => {
                lengths(size[0], &|x| self.half_width(x))
            }
        };
        across * (along * across).max(1.0)
    }

    /// Moves the nodes of the mesh's named sides onto the outline, where refinement has put them on chords.
    pub fn fit(self, mesh: &mut Mesh) {
        let groups = mesh.groups().iter();
        let moves: Vec<_> = groups
            .flat_map(|(name, group)| group.nodes.iter().map(move |node| (name.as_str(), *node)))
            .filter_map(|(name, node)| Some((node, self.on_outline(name, mesh.nodes[node])?)))
            .collect();
        for (node, position) in moves {
            mesh.nodes[node] = position;
        }
    }

    /// The position on a curved side that corresponds to a position beside it; `None` for a straight side.
    fn on_outline(self, side: &str, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let on_circle = |[a, b]: [f64; 2], radius: f64| {
            let (dx, dy) = (x - a, y - b);
            let share = radius / dx.hypot(dy);
            [a + share * dx, b + share * dy]
        };
        match (self, side) {
            (Self::SquareOnRakes(rakes), group) => rakes.on_tine(group, [x, y]),
            (
                Self::Cruciform {
                    size,
                    arm_width,
                    fillet,
                },
                "fillets",
            ) => {
                // The centre of the arc in the quarter of the point.
                let middle = size[0] / 2.0;
                let away = arm_width / 2.0 + fillet;
                let centre = [middle + away * (x - middle).signum(), away * y.signum()];
                Some(on_circle(centre, fillet))
            }
            (Self::StripWithHole { size, radius }, "hole") => {
                Some(on_circle([size[0] / 2.0, 0.0], radius))
            }
            (Self::RingSector { radii, .. }, "inside") => Some(on_circle([0.0; 2], radii[0])),
            (Self::RingSector { radii, .. }, "outside") => Some(on_circle([0.0; 2], radii[1])),
            (Self::NotchedStrip { .. } | Self::DogBone { .. }, "top") => {
                Some([x, self.half_width(x)])
            }
            (Self::NotchedStrip { .. } | Self::DogBone { .. }, "bottom") => {
                Some([x, -self.half_width(x)])
            }
            _ => None,
        }
    }

    /// The parts of a strip between corners of its outline, beginnings of arcs, and its middle.
    fn parts(self, length: f64) -> Vec<Part> {
        let middle = 0.5 * length;
        // From the middle on: where each part ends, and its least number of cells.
        let mut half = match self {
            Self::NotchedStrip {
                depth, half_length, ..
            } => vec![(half_length, cells_of_arc(half_length, depth))],
            Self::DogBone {
                size,
                narrow,
                shoulder,
            } => {
                let (begin, rise) = (0.5 * narrow[0], 0.5 * (size[1] - narrow[1]));
                let arc = (begin + shoulder, cells_of_arc(shoulder, rise));
                vec![(begin, 1), arc]
            }
            _ => Vec::new(),
        };
        half.push((middle, 1));
        let begins = [0.0].into_iter().chain(half.iter().map(|(end, _)| *end));
        let mirrored = begins.zip(&half).map(|(begin, (_, least))| Part {
            to: middle - begin,
            least: *least,
        });
        let mut parts: Vec<Part> = mirrored.collect();
        parts.reverse();
        parts.extend(half.into_iter().map(|(end, least)| Part {
            to: middle + end,
            least,
        }));
        parts
    }

    /// Half the width of a strip, with notches or of a dumb-bell, at a position along it.
    fn half_width(self, x: f64) -> f64 {
        match self {
            Self::NotchedStrip {
                size,
                depth,
                half_length,
            } => size[1] / 2.0 - notch(x - size[0] / 2.0, depth, half_length),
            Self::DogBone {
                size,
                narrow,
                shoulder,
            } => {
                let rise = (size[1] - narrow[1]) / 2.0;
                let over = (x - size[0] / 2.0).abs() - narrow[0] / 2.0;
                // An arc that leaves the narrow part smoothly.
                let radius = arc_radius(shoulder, rise);
                let risen = match over {
                    over if over <= 0.0 => 0.0,
                    over if over >= shoulder => rise,
                    over => radius - (radius * radius - over * over).sqrt(),
                };
                narrow[1] / 2.0 + risen
            }
            Self::Strip { size } | Self::StripWithHole { size, .. } => size[1] / 2.0,
            Self::RingSector { radii, .. } => (radii[1] - radii[0]) / 2.0,
            Self::SquareOnRakes(rakes) => rakes.size[1] / 2.0,
            Self::Cruciform { arm_width, .. } => arm_width / 2.0,
        }
    }

    /// All dimensions.
    pub fn measures(self) -> Vec<f64> {
        match self {
            Self::Strip { size } => size.to_vec(),
            Self::StripWithHole { size, radius } => vec![size[0], size[1], radius],
            Self::NotchedStrip {
                size,
                depth,
                half_length,
            } => vec![size[0], size[1], depth, half_length],
            Self::DogBone {
                size,
                narrow,
                shoulder,
            } => vec![size[0], size[1], narrow[0], narrow[1], shoulder],
            Self::RingSector { radii, angle } => vec![radii[0], radii[1], angle],
            Self::SquareOnRakes(rakes) => {
                let Rakes {
                    size,
                    spacing,
                    inset,
                    radius,
                    ..
                } = rakes;
                vec![size[0], size[1], spacing, inset, radius]
            }
            Self::Cruciform {
                size,
                arm_width,
                fillet,
            } => vec![size[0], size[1], arm_width, fillet],
        }
    }

    /// The least and the largest distance that a mesh must distinguish from zero.
    fn extremes(self) -> [f64; 2] {
        let distances = match self {
            Self::RingSector { radii, angle } => {
                vec![radii[1], radii[1] - radii[0], angle * radii[1]]
            }
            other => other.measures(),
        };
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        [least, distances.into_iter().fold(0.0, f64::max)]
    }
}

/// Names the corner of two sides after both: `bottom-left`, or `inside-start` of a ring.
fn name_corners(mesh: &mut Mesh) {
    let pairs = [["bottom", "top"], ["left", "right"]];
    let of_ring = [["inside", "outside"], ["start", "end"]];
    for [first, second] in [pairs, of_ring] {
        for (a, b) in first.into_iter().flat_map(|a| second.map(|b| (a, b))) {
            let nodes = |side| mesh.groups().get(side).map(|group| &group.nodes);
            let (Some(of_a), Some(of_b)) = (nodes(a), nodes(b)) else {
                continue;
            };
            let common = of_a.iter().filter(|node| of_b.contains(node));
            let corner: BTreeSet<usize> = common.copied().collect();
            if corner.len() == 1 {
                mesh.name_nodes(&format!("{a}-{b}"), &corner);
            }
        }
    }
}

/// Radius of an arc that begins along an edge and ends at a distance along it and a height.
fn arc_radius(along: f64, height: f64) -> f64 {
    (along * along + height * height) / (2.0 * height)
}

/// Least number of cells along such an arc: quadratic edges that turn further would fold the cells beside them.
fn cells_of_arc(along: f64, height: f64) -> usize {
    const MOST_TURN: f64 = 0.4;
    let turn = (along / arc_radius(along, height)).min(1.0).asin();
    (turn / MOST_TURN).ceil() as usize
}

/// Depth of a notch at a distance from its middle: an arc of a circle.
fn notch(x: f64, depth: f64, half_length: f64) -> f64 {
    let radius = arc_radius(half_length, depth);
    if x.abs() >= half_length {
        return 0.0;
    }
    (radius * radius - x * x).sqrt() - (radius - depth)
}
