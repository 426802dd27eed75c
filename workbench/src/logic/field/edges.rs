//! The edges of a measured sheet: what is stated about them, and which one lies under the pointer.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use gelbench::error::Error;
use gelbench::estimation::EdgeCondition;
use gelbench_base::document::quoted;
use gelbench_report::results::MeshFigure;

use super::length;

/// What is known of an edge.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
pub enum Edge {
    /// Nothing is stated: the data decide.
    #[default]
    Unnamed,
    /// No traction acts on it.
    Free,
    /// It moved as a rigid body.
    Rigid,
    /// Its displacement along X and Y, as a user writes it; along an axis without one the edge is free.
    Known([String; 2]),
    /// Its displacement is unknown.
    Unknown,
}

impl Edge {
    /// One of each kind.
    pub fn all() -> [Self; 5] {
        let known = Self::Known(["0 mm", "0 mm"].map(str::to_owned));
        [Self::Unnamed, Self::Free, Self::Rigid, known, Self::Unknown]
    }

    /// The name of its kind.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Unnamed => "the data decide",
            Self::Free => "free",
            Self::Rigid => "rigid",
            Self::Known(_) => "known",
            Self::Unknown => "unknown",
        }
    }

    /// Whether another one is of the same kind.
    pub fn is_like(&self, other: &Self) -> bool {
        self.name() == other.name()
    }

    /// The condition of the edge called `name` for the corrector; nothing where the data decide.
    ///
    /// # Errors
    /// [`Error::Input`] where a displacement is no length, or none is stated.
    pub fn condition(&self, name: &str) -> Result<Option<EdgeCondition>, Error> {
        Ok(Some(match self {
            Self::Unnamed => return Ok(None),
            Self::Free => EdgeCondition::Free,
            Self::Rigid => EdgeCondition::Rigid,
            Self::Unknown => EdgeCondition::Unknown,
            Self::Known([x, y]) => {
                let x = length(&format!("ux of the edge {name}"), x)?;
                let y = length(&format!("uy of the edge {name}"), y)?;
                if (x, y) == (None, None) {
                    return Err(Error::input(
                        format!("the edge {name} is known, but its displacement is not stated"),
                        "write ux, uy, or both, such as \"5 mm\"",
                    ));
                }
                EdgeCondition::Known([x, y])
            }
        }))
    }

    /// The edge in a file of `gelbench correct --study`; nothing where the data decide.
    fn written(&self, name: &str) -> Option<String> {
        let displacements = match self {
            Self::Unnamed => return None,
            Self::Known(axes) => {
                let components = ["ux", "uy"].into_iter().zip(axes);
                let stated = components.filter(|(_, text)| !text.trim().is_empty());
                stated
                    .map(|(key, text)| format!("{key} = {}\n", quoted(text.trim())))
                    .collect()
            }
            _ => String::new(),
        };
        Some(format!(
            "\n[[edges]]\nnames = [{}]\ncondition = \"{}\"\n{displacements}",
            quoted(name),
            self.name()
        ))
    }
}

/// The conditions of a specimen as the file that `gelbench correct --study` takes.
pub fn written(edges: &BTreeMap<String, Edge>, edge_gap: &str) -> String {
    let mut text = String::from("# What is known of the specimen besides its markers.\n");
    if !edge_gap.trim().is_empty() {
        text += &format!("edge_gap = {}\n", quoted(edge_gap.trim()));
    }
    let tables = edges.iter().filter_map(|(name, edge)| edge.written(name));
    text.extend(tables);
    text
}

/// The name of an edge that was drawn in the window.
pub const DRAWN: &str = "drawn_edge.csv";

/// Closed lines of corners in mm as the table that `gelbench correct --outline` takes.
pub fn lines_of(lines: &[Vec<[f64; 2]>]) -> Vec<u8> {
    let mut text = String::from("x [mm],y [mm],line\n");
    for (line, corners) in (1..).zip(lines) {
        for [x, y] in corners {
            text += &format!("{x:.6},{y:.6},{line}\n");
        }
    }
    text.into_bytes()
}

/// The edge that is nearest to a place in mm, where one is within reach.
pub fn nearest(figure: &MeshFigure, position: [f64; 2], reach: f64) -> Option<&str> {
    let distances = figure.groups.iter().flat_map(|group| {
        let parts = group.lines.iter().flat_map(|line| line.windows(2));
        parts.map(|part| (distance(position, [part[0], part[1]]), &group.name))
    });
    let (distance, name) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (distance <= reach).then_some(name)
}

/// From a place to a straight line between two others.
fn distance([x, y]: [f64; 2], [[ax, ay], [bx, by]]: [[f64; 2]; 2]) -> f64 {
    let ([lx, ly], [px, py]) = ([bx - ax, by - ay], [x - ax, y - ay]);
    let square = lx * lx + ly * ly;
    let share = if square > 0.0 {
        ((px * lx + py * ly) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (px - share * lx).hypot(py - share * ly)
}

/// Where the name of an edge is written: the place on it that is nearest to the middle of all its places.
pub fn middle(lines: &[Vec<[f64; 2]>]) -> Option<[f64; 2]> {
    let positions = || lines.iter().flatten();
    let count = positions().count().max(1) as f64;
    let mean = [0, 1].map(|axis| positions().map(|position| position[axis]).sum::<f64>() / count);
    let far = |position: &[f64; 2]| (position[0] - mean[0]).hypot(position[1] - mean[1]);
    positions()
        .copied()
        .min_by(|a, b| far(a).total_cmp(&far(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gelbench::mesh::{CellShape, Shape};
    use gelbench::results::Drawing;
    use gelbench::studies::markers::Conditions;
    use gelbench_report::results::mesh_outlines;

    fn strip() -> MeshFigure {
        let mesh = Shape::Strip { size: [30.0, 10.0] }.mesh(4, CellShape::Quad9);
        let Drawing::Mesh(mut figure) = mesh_outlines("", &mesh) else {
            panic!("a mesh is drawn as one")
        };
        figure.groups.retain(|group| group.name != "boundary");
        figure
    }

    #[test]
    fn the_nearest_edge_is_hit_and_none_from_far_away() {
        let figure = strip();
        for (position, name) in [
            ([0.5, 0.3], Some("left")),
            ([31.0, -1.0], Some("right")),
            ([12.0, 5.5], Some("top")),
            ([12.0, -4.4], Some("bottom")),
            ([15.0, 0.0], None),
            ([50.0, 0.0], None),
        ] {
            assert_eq!(nearest(&figure, position, 1.2), name, "{position:?}");
        }
        assert_eq!(nearest(&figure, [f64::NAN; 2], 1.2), None);
        let edge = figure.groups.iter().find(|group| group.name == "left");
        let [x, y] = middle(&edge.unwrap().lines).unwrap();
        assert!(x.abs() < 1e-9 && y.abs() < 2.6, "{x} {y}");
    }

    #[test]
    fn what_is_written_is_what_the_command_reads() {
        let known = Edge::Known(["12 mm".into(), " ".into()]);
        let stated = [
            ("left", Edge::Rigid),
            ("right", known),
            ("top", Edge::Free),
            ("a \"quoted\" edge", Edge::Unknown),
            ("bottom", Edge::Unnamed),
        ];
        let edges = stated.map(|(name, edge)| (name.to_owned(), edge)).into();
        let text = written(&edges, "1.5 mm");
        let read = Conditions::parse("known.toml", &text).unwrap();
        assert_eq!(read.edge_gap, Some(1.5));
        assert_eq!(read.edges.len(), 4, "{text}");
        for (name, condition) in &read.edges {
            assert_eq!(
                edges[name].condition(name).unwrap().as_ref(),
                Some(condition),
                "{text}"
            );
        }
        for (x, fault) in [
            ("twelve", "ux of the edge right"),
            (" ", "the edge right is known"),
        ] {
            let wrong = Edge::Known([x.into(), String::new()]);
            let message = wrong.condition("right").unwrap_err().to_string();
            assert!(message.contains(fault), "{message}");
        }
    }
}
