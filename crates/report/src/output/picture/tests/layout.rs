//! No text of a picture is cut off or overlaps another one, however narrow the picture and whatever its texts.

use super::super::charts::Plan;
use super::super::look::Look;
use super::super::marks::{DrawResult, Mark, Size, Words};
use crate::mesh::{CellShape, Mesh};
use crate::results::{
    Axis, FieldFigure, Line, LineChart, MeshFigure, NamedLines, PALETTE, Panel, PictureFormat,
    PictureStyle, PictureWidth, Stroke,
};

const WORDS: [&str; 3] = [
    "σ",
    "largest principal Cauchy stress",
    "deviation of the displacement from the finite elements on twice as many cells",
];

fn looks() -> impl Iterator<Item = Look> {
    PictureWidth::NAMES.into_iter().map(|(_, width)| {
        Look::of(&PictureStyle {
            formats: vec![PictureFormat::Png],
            width,
            ..PictureStyle::default()
        })
    })
}

/// Panics where words reach beyond the picture or touch others.
fn check(size: Size, marks: &[Mark], what: &str) {
    let words: Vec<&Words> = marks
        .iter()
        .filter_map(|mark| match mark {
            Mark::Words(words) if !words.words.is_empty() => Some(words),
            _ => None,
        })
        .collect();
    assert!(words.len() > 4, "{what}");
    for (index, one) in words.iter().enumerate() {
        let bounds = one.bounds();
        let [width, height] = [f64::from(size.0), f64::from(size.1)];
        let is_inside = bounds.low[0] >= 0.0
            && bounds.low[1] >= 0.0
            && bounds.high[0] <= width
            && bounds.high[1] <= height;
        assert!(is_inside, "{what}: {one:?} {bounds:?} {size:?}");
        for other in &words[..index] {
            let theirs = other.bounds();
            let apart = (0..2).any(|axis| {
                bounds.low[axis] >= theirs.high[axis] || theirs.low[axis] >= bounds.high[axis]
            });
            assert!(apart, "{what}: {:?} on {:?}", one.words, other.words);
        }
    }
}

fn chart(words: &str, kind: usize, lines: usize) -> LineChart {
    let scale = [1.0, 1e-7, 37.0, 1e5][kind % 4];
    let line = |index: usize| {
        let point = |i: u32| {
            let x = f64::from(i) / 30.0;
            [
                x * scale,
                (1.0 + index as f64) * scale * x.powi(3) + 1e-9 * scale,
            ]
        };
        let stroke = [Stroke::Solid, Stroke::Marked, Stroke::Dashed][index % 3];
        let name = format!("{words} {index}");
        Line::new(name, (0..31).map(point), PALETTE[index], stroke)
    };
    let y = format!("{words} [MPa]");
    let y = if kind.is_multiple_of(2) {
        Axis::from(&*y)
    } else {
        Axis::logarithmic(&y)
    };
    let lines = (0..lines).map(line).collect();
    LineChart {
        notes: vec![format!("{words} = 3.14 ± 0.02 MPa")],
        ..LineChart::new(words, &*format!("{words} [mm]"), y, lines)
    }
}

#[test]
fn charts_have_all_words_apart_and_three_ticks_on_each_axis() {
    for look in looks() {
        for (words, count) in WORDS
            .iter()
            .flat_map(|words| (1..4).map(move |n| (words, n)))
        {
            for (kind, height) in (0..4).flat_map(|kind| [(kind, 220), (kind, 480)]) {
                let charts: Vec<_> = (0..count)
                    .map(|index| (chart(words, kind + index, 1 + index), height))
                    .collect();
                let plan = Plan::of(&charts, look);
                let what = format!("{look:?} {words} {count} {kind} {height}");
                check(plan.size, &plan.marks(look).unwrap(), &what);
                for frame in &plan.frames {
                    for axis in [&frame.x, &frame.y] {
                        assert!(axis.ticks.at.len() >= 3, "{what}");
                    }
                    let inside = frame.legend.as_ref().and_then(|legend| legend.inside);
                    let is_inside = inside.is_none_or(|part| {
                        (0..2).all(|axis| {
                            part.low[axis] >= frame.area.low[axis]
                                && part.high[axis] <= frame.area.high[axis]
                        })
                    });
                    assert!(is_inside, "{what}");
                }
            }
        }
    }
}

#[test]
fn fields_have_all_words_apart() -> DrawResult<()> {
    let sizes = [[30.0, 10.0], [150.0, 8.0], [10.0, 10.0], [8.0, 40.0]];
    for (look, size) in looks().flat_map(|look| sizes.map(|size| (look, size))) {
        let mesh = Mesh::plate(size, [6, 6], CellShape::Quad4);
        let at_rest = vec![0.0; 2 * mesh.nodes.len()];
        for (words, count) in WORDS
            .iter()
            .flat_map(|words| (1..4).map(move |n| (words, n)))
        {
            for factor in [1.0, 1e-7, 3e6] {
                // A peak at one corner, as at the end of a support.
                let value = |node: usize| {
                    let [x, y] = mesh.nodes[node];
                    factor * (x - y + if node == 0 { 1e3 } else { 0.0 })
                };
                let panel = |name| Panel::at_nodes(name, &mesh, &at_rest, &value);
                let names = [
                    "mass-spring",
                    "corrected",
                    "finite elements (Q2, 1,200 cells)",
                ];
                let panels = names.into_iter().take(count).map(panel);
                let figure = FieldFigure::new(*words, format!("{words} [MPa]"), panels);
                let plan = figure.plan(look, count)?;
                let what = format!("{look:?} {size:?} {words} {count} {factor}");
                check(plan.size(), &figure.marks(&plan), &what);
            }
        }
    }
    Ok(())
}

#[test]
fn meshes_have_all_words_apart() {
    for (look, words) in looks().flat_map(|look| WORDS.map(|words| (look, words))) {
        let group = |index: usize| NamedLines {
            name: format!("group {index}"),
            lines: vec![vec![[0.0, 0.0], [30.0, 0.0]]],
            cells: Vec::new(),
        };
        let figure = MeshFigure {
            title: words.to_owned(),
            cells: vec![vec![[0.0, 0.0], [30.0, 0.0], [30.0, 10.0], [0.0, 10.0]]],
            groups: (0..9).map(group).collect(),
        };
        let (size, marks) = figure.marks(&figure.layout(look));
        check(size, &marks, words);
    }
}
