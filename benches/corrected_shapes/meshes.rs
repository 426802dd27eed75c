//! Meshes of the shapes, equal and graded towards their singular places.
//!
//! ```text
//! x_i/L = (i/n)ᵍ                                 from a clamped end
//! y_i/W = ½ (2 i/n)ᵍ for i ≤ n/2, and mirrored   across it: towards both corners          [–]
//! ```
//!
//! The exponent g is the grading: with 1 all cells are equal. Nodes within a cell lie evenly between its lines.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4};
use std::fmt;

use gelbench::mesh::{Block, CellShape, Mesh, Outline, Shape, mesh_of_blocks};

/// A mesh of a shape by its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    pub kind: CellShape,
    /// Cells across the shape.
    pub across: usize,
    pub grading: f64,
}

impl Layout {
    /// How many cells stand along a distance of so many widths from a clamped end: more of them where they are graded.
    fn along(self, widths: f64) -> usize {
        let more = 0.5 * (1.0 + self.grading);
        count(more * widths * self.across as f64)
    }

    /// A share of the way from a clamped end, of so many cells.
    fn along_from_end(self, share: f64, cells: usize) -> f64 {
        between_lines(share, cells, |share| share.powf(self.grading))
    }

    /// A share of the way from corner to corner.
    fn across(self, share: f64, cells: usize) -> f64 {
        between_lines(share, cells, |share| {
            let near = 0.5 * (2.0 * share.min(1.0 - share)).powf(self.grading);
            if share <= 0.5 { near } else { 1.0 - near }
        })
    }
}

/// The element of finite elements that have these cells.
pub fn element(kind: CellShape) -> &'static str {
    match kind {
        CellShape::Triangle3 => "T1",
        CellShape::Triangle6 => "T2",
        CellShape::Quad4 => "Q1",
        CellShape::Quad8 | CellShape::Quad9 => "Q2",
    }
}

impl fmt::Display for Layout {
    /// `Q1 48`, the cells across, and `Q2 24^1.5` where they are graded.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", element(self.kind), self.across)?;
        match self.grading == 1.0 {
            true => Ok(()),
            false => write!(f, "^{}", self.grading),
        }
    }
}

/// The place of a share between lines whose places are those of `line`: evenly between two of them.
fn between_lines(share: f64, cells: usize, line: impl Fn(f64) -> f64) -> f64 {
    let place = share * cells as f64;
    let index = (place as usize).min(cells - 1);
    let [from, to] = [index, index + 1].map(|index| line(index as f64 / cells as f64));
    from + (to - from) * (place - index as f64)
}

fn count(cells: f64) -> usize {
    (cells.round() as usize).max(1)
}

/// A strip with a round hole in its middle, its blocks those of [`Shape::StripWithHole`].
pub fn strip_with_hole(shape: Shape, layout: Layout) -> Mesh {
    let Shape::StripWithHole { size, radius } = shape else {
        unreachable!("a strip with a hole");
    };
    if layout.grading == 1.0 {
        return shape.mesh(layout.across, layout.kind);
    }
    let [middle, half] = [size[0] / 2.0, size[1] / 2.0];
    let around = 2 * count(layout.across as f64 / 2.0);
    let radial = count((half - radius) / size[1] * layout.across as f64 * 1.2).max(2);
    let ends = layout.along((middle - half) / size[1]);
    let graded = move |t: f64| (2.0 * layout.across(t, around) - 1.0) * FRAC_PI_4;
    let mut blocks = around_hole(middle, [radius, half], [radial, around], graded);
    let from_end = move |[s, t]: [f64; 2]| {
        let x = (middle - half) * layout.along_from_end(s, ends);
        [x, half * graded(t).tan()]
    };
    let length = size[0];
    blocks.push(Block {
        map: Box::new(from_end),
        cells: [ends, around],
        sides: ["bottom", "", "top", "left"],
    });
    blocks.push(Block {
        map: Box::new(move |[s, t]| {
            let [x, y] = from_end([1.0 - s, t]);
            [length - x, y]
        }),
        cells: [ends, around],
        sides: ["bottom", "right", "top", ""],
    });
    mesh_of_blocks(&blocks, layout.kind)
}

/// The blocks between a hole about (`middle`, 0) and a square; those that look along the strip have their lines at graded angles.
fn around_hole<'a>(
    middle: f64,
    [radius, half]: [f64; 2],
    cells: [usize; 2],
    graded: impl Fn(f64) -> f64 + Copy + 'a,
) -> Vec<Block<'a>> {
    let quarters = [(0.0_f64, ""), (1.0, "top"), (2.0, ""), (3.0, "bottom")];
    let block = |(quarter, outer): (f64, &'a str)| {
        let along = outer.is_empty();
        let map = move |[s, t]: [f64; 2]| {
            let angle = match along {
                true => graded(t),
                false => (2.0 * t - 1.0) * FRAC_PI_4,
            };
            let from = [radius * angle.cos(), radius * angle.sin()];
            let to = [half, half * angle.tan()];
            let [x, y] = [0, 1].map(|axis| from[axis] + s * (to[axis] - from[axis]));
            let (sine, cosine) = (quarter * FRAC_PI_2).sin_cos();
            [middle + cosine * x - sine * y, sine * x + cosine * y]
        };
        Block {
            map: Box::new(map),
            cells,
            sides: ["", outer, "", "hole"],
        }
    };
    quarters.into_iter().map(block).collect()
}

/// The outline of half a dog-bone by its distance from an end, in mm.
#[derive(Clone, Copy)]
struct Bone {
    length: f64,
    /// Widths of the ends and of the narrow part.
    wide: f64,
    slim: f64,
    shoulder: f64,
    /// Where the narrow part begins.
    begin: f64,
}

impl Bone {
    fn new(shape: Shape) -> Self {
        let Shape::DogBone {
            size,
            narrow,
            shoulder,
        } = shape
        else {
            unreachable!("a dog-bone");
        };
        Self {
            length: size[0],
            wide: size[1],
            slim: narrow[1],
            shoulder,
            begin: (size[0] - narrow[0]) / 2.0,
        }
    }

    /// A point at a share of an arc from the narrow part, and half the width there. Cells are as long as they are wide: dx/ds grows
    /// with the width.
    fn on_arc(self, share: f64) -> [f64; 2] {
        let [mean, more] = [1.0, -1.0].map(|sign| (self.wide + sign * self.slim) / 2.0);
        let over = self.shoulder * (self.slim * share + more * share * share) / mean;
        let radius = (self.shoulder * self.shoulder + more * more) / (2.0 * more);
        let fallen = (radius * radius - over * over).max(0.0).sqrt();
        [self.begin - over, self.slim / 2.0 + radius - fallen]
    }

    /// The length of an arc over its width in the mean.
    fn arcs(self) -> f64 {
        2.0 * self.shoulder / (self.wide + self.slim)
    }
}

/// A place along a dog-bone, and half the width there, at a share of one of its parts.
type Part = Box<dyn Fn(f64) -> [f64; 2]>;

/// Wide ends, arcs of circles and a narrow middle, each of its own cells, so that the outline's corners are nodes.
pub fn dog_bone(shape: Shape, layout: Layout) -> Mesh {
    let bone = Bone::new(shape);
    let (end, middle) = (bone.begin - bone.shoulder, bone.length - 2.0 * bone.begin);
    let ends = layout.along(end / bone.wide);
    let across = layout.across as f64;
    let shoulders = count(bone.arcs() * across);
    let middles = 2 * count(middle / bone.slim * across / 2.0);
    let mirrored = |of: Part| -> Part {
        Box::new(move |s| {
            let [x, half] = of(1.0 - s);
            [bone.length - x, half]
        })
    };
    let at_end =
        || -> Part { Box::new(move |s| [end * layout.along_from_end(s, ends), bone.wide / 2.0]) };
    let arc = || -> Part { Box::new(move |s| bone.on_arc(1.0 - s)) };
    let narrow: Part = Box::new(move |s| [bone.begin + middle * s, bone.slim / 2.0]);
    let parts = [
        (at_end(), ends, ["left", ""]),
        (arc(), shoulders, ["", ""]),
        (narrow, middles, ["", ""]),
        (mirrored(arc()), shoulders, ["", ""]),
        (mirrored(at_end()), ends, ["", "right"]),
    ];
    let block = |(part, along, [left, right]): (Part, usize, [&'static str; 2])| Block {
        map: Box::new(move |[s, t]: [f64; 2]| {
            let [x, half] = part(s);
            [x, (2.0 * layout.across(t, layout.across) - 1.0) * half]
        }),
        cells: [along, layout.across],
        sides: ["bottom", right, "top", left],
    };
    mesh_of_blocks(&parts.map(block), layout.kind)
}

/// Cook's membrane, clamped at its left side.
pub fn cook(layout: Layout) -> Mesh {
    let (along, across) = (layout.along(1.0), layout.across);
    let block = Block {
        map: Box::new(move |[s, t]| {
            let (s, t) = (layout.along_from_end(s, along), layout.across(t, across));
            [48.0 * s, (1.0 - t) * 44.0 * s + t * (44.0 + 16.0 * s)]
        }),
        cells: [along, across],
        sides: ["bottom", "right", "top", "left"],
    };
    mesh_of_blocks(&[block], layout.kind)
}

/// The plate with two hexagonal holes: its outline, and all of its corners.
fn corners() -> Vec<Vec<[f64; 2]>> {
    let hexagon = |x: f64, y: f64, r: f64| -> Vec<[f64; 2]> {
        let corner = |k: i32| f64::from(k) * FRAC_PI_3;
        let place = |k| [x + r * f64::cos(corner(k)), y + r * f64::sin(corner(k))];
        (0..6).map(place).collect()
    };
    let outer = vec![[0.0, 0.0], [60.0, 0.0], [60.0, 40.0], [0.0, 40.0]];
    vec![outer, hexagon(18.0, 24.0, 7.0), hexagon(42.0, 14.0, 5.0)]
}

/// Distance from a corner in mm within which triangles are halved.
const REACH: f64 = 16.0;

/// Triangles that a mesh generator made, halved some times, and near the corners (g − 1) times as often again:
///
/// ```text
/// h(r) is halved for the j-th time where r ≤ R 2^(−j g/(g−1)),   R = 16 mm
/// ```
pub fn unstructured(base: usize, layout: Layout) -> Mesh {
    let outline = Outline::of_lines(corners()).expect("lines that do not cross");
    let first = outline.mesh(40.0 / base as f64, CellShape::Triangle3);
    let levels = (layout.across / base).ilog2();
    let mut mesh = (0..levels).fold(first, |mesh, _| mesh.refined());
    let corners = corners().concat();
    let times = (f64::from(levels) * (layout.grading - 1.0)).round() as i32;
    for time in 1..=times {
        let rate = layout.grading / (layout.grading - 1.0);
        let reach = REACH * (-rate * f64::from(time)).exp2();
        let near = |cell: usize| {
            let [x, y] = mesh.centre(cell);
            let mut far = corners.iter().map(|[a, b]| (x - a).hypot(y - b));
            far.any(|far| far <= reach)
        };
        let marked: Vec<bool> = (0..mesh.cell_count()).map(near).collect();
        mesh = mesh.refined_where(&marked);
    }
    match layout.kind {
        CellShape::Triangle3 => mesh,
        _ => mesh.quadratic(),
    }
}
