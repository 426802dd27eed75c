//! Pictures of fields, meshes and materials.

use super::picture::animation::{Animation, Frame};
use super::picture::fields::{Colours, FieldCell, FieldFigure, Panel, outlines};
use super::picture::lines::{Axis, Line, LineChart, Stroke};
use super::picture::{PALETTE, Scale};
use crate::material::Card;
use crate::material::curve::{Mode, simple_shear};
use crate::material::stability::{SEARCHED, stable_range};
use crate::mesh::Mesh;

const PUBLISHED: [u8; 3] = PALETTE[1];
const INK: [u8; 3] = [30, 30, 30];

/// The curves of a card in the three usual tests.
pub fn material_chart(card: &Card) -> LineChart {
    let [low, high] = card.stretch_range;
    let (from, to) = (low.min(1.0), high.max(1.0));
    let law = &*card.law;
    let samples = |nominal_stress: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        let stretch = |i: i32| from + (to - from) * 1.1 * f64::from(i) / 110.0;
        (0..=110)
            .map(|i| [stretch(i), nominal_stress(stretch(i))])
            .collect()
    };
    let curves = Mode::ALL.map(|(name, mode)| {
        let stress = move |stretch: f64| mode.nominal_stress(law, stretch - 1.0);
        (name, samples(&stress), stable_range(law, mode))
    });
    let shear = samples(&|stretch| simple_shear(law, stretch - 1.0));
    let curves = curves
        .into_iter()
        .chain([("simple shear", shear, SEARCHED)]);
    let curves: Vec<_> = curves.collect();
    // Equibiaxial tension is much stiffer: its curve ends where it would press the others flat.
    let uniaxial = curves[0].1.iter();
    let highest = uniaxial.fold(0.0, |most: f64, point| most.max(1.6 * point[1].abs()));
    let shown = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        let points = points.iter().copied();
        points.filter(|point| point[1].abs() <= highest).collect()
    };
    let mut lines = Vec::new();
    for ((name, points, stable), colour) in
        curves.iter().zip([0, 2, 3, 4].map(|index| PALETTE[index]))
    {
        lines.extend(Line::within(name, &shown(points), colour, *stable));
    }
    if lines.iter().any(|line| line.stroke == Stroke::Dashed) {
        lines.push(Line {
            label: "unstable (Drucker)".to_owned(),
            points: Vec::new(),
            colour: INK,
            stroke: Stroke::Dashed,
        });
    }
    if card.published_nominal_stress(1.0).is_some() {
        let published = |stretch| card.published_nominal_stress(stretch).unwrap_or(f64::NAN);
        lines.push(Line {
            label: "published curve (uniaxial)".to_owned(),
            points: shown(&samples(&published)),
            colour: PUBLISHED,
            stroke: Stroke::Dashed,
        });
    }
    LineChart {
        title: card.title.clone(),
        x: Axis {
            label: "stretch λ, in shear 1 + γ [–]".to_owned(),
            scale: Scale::Interval,
        },
        y: Axis::linear("nominal stress [MPa]"),
        lines,
        band: Some(([low, high], "range of the card".to_owned())),
    }
}

/// The uniaxial curves of several cards, each over its own range.
pub fn comparison_chart(cards: &[Card]) -> LineChart {
    let line = |(index, card): (usize, &Card)| {
        let [low, high] = card.stretch_range;
        let stretch = |i: i32| low + (high - low) * f64::from(i) / 100.0;
        let stress = |stretch: f64| Mode::Uniaxial.nominal_stress(&*card.law, stretch - 1.0);
        Line {
            label: card.name.clone(),
            points: (0..=100)
                .map(|i| [stretch(i), stress(stretch(i))])
                .collect(),
            colour: PALETTE[index % PALETTE.len()],
            // A colour that comes again is dashed.
            stroke: if index < PALETTE.len() {
                Stroke::Solid
            } else {
                Stroke::Dashed
            },
        }
    };
    LineChart {
        title: "Uniaxial tension".into(),
        x: Axis::stretch(),
        y: Axis::linear("nominal stress [MPa]"),
        lines: cards.iter().enumerate().map(line).collect(),
        band: None,
    }
}

/// A mesh; curved edges are drawn through their middles.
pub fn mesh_picture(title: &str, mesh: &Mesh) -> Vec<u8> {
    let outline = |cell: usize| {
        let nodes = mesh.cell(cell);
        let shape = mesh.shape(cell);
        let mut places = Vec::new();
        for edge in shape.edges() {
            let along = [0, 1, 2, 3].map(|i| f64::from(i) / 4.0);
            let [from, to] = [edge[0], edge[1]].map(|node| shape.reference_nodes()[node]);
            for share in along {
                let local = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
                let values = shape.values(local);
                places.push([0, 1].map(|axis| {
                    let shares = nodes.iter().zip(&values);
                    shares
                        .map(|(node, value)| value * mesh.nodes[*node][axis])
                        .sum()
                }));
            }
        }
        places.extend(places.first().copied());
        places
    };
    outlines(
        title,
        &(0..mesh.cell_count()).map(outline).collect::<Vec<_>>(),
    )
}

/// A field on a deformed mesh: label, mesh, displacement and a value for each node.
pub type Field<'a> = (&'a str, &'a Mesh, &'a [f64], Vec<f64>);

fn panel((label, mesh, displacement, values): &Field) -> Panel {
    Panel {
        label: (*label).to_owned(),
        cells: cells(mesh, displacement, &|node| values[node]),
    }
}

/// Fields on deformed meshes that move, as an animated PNG of some milliseconds a frame: time in s and fields of each.
pub fn field_animation(
    title: &str,
    quantity: &str,
    frames: &[(f64, Vec<Field>)],
    milliseconds: u16,
) -> Vec<u8> {
    let frame = |(time, fields): &(f64, Vec<Field>)| Frame {
        time: *time,
        panels: fields.iter().map(panel).collect(),
    };
    let animation = Animation {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        colours: Colours::Sequential,
        frames: frames.iter().map(frame).collect(),
        milliseconds,
    };
    animation.png()
}

/// Fields on deformed meshes below each other on one colour scale.
pub fn field_figure(title: &str, quantity: &str, scale: Scale, fields: &[Field]) -> Vec<u8> {
    let figure = FieldFigure {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        scale,
        colours: Colours::Sequential,
        panels: fields.iter().map(panel).collect(),
    };
    figure.png()
}

/// One value a cell on a deformed mesh.
pub fn cell_figure(
    (title, quantity): (&str, &str),
    scale: Scale,
    mesh: &Mesh,
    displacement: &[f64],
    values: &[f64],
) -> Vec<u8> {
    let figure = FieldFigure {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        scale,
        colours: Colours::Sequential,
        panels: vec![Panel {
            label: mesh.describe(),
            cells: deformed(mesh, displacement, &|cell| values[cell]),
        }],
    };
    figure.png()
}

/// Deformed cells with the mean of their corners' values.
pub fn cells(mesh: &Mesh, displacement: &[f64], value: &dyn Fn(usize) -> f64) -> Vec<FieldCell> {
    let mean = |cell: usize| {
        let corners = &mesh.cell(cell)[..mesh.shape(cell).corners()];
        let sum: f64 = corners.iter().map(|node| value(*node)).sum();
        sum / corners.len() as f64
    };
    deformed(mesh, displacement, &mean)
}

/// Deformed cells with their values.
pub fn deformed(mesh: &Mesh, displacement: &[f64], value: &dyn Fn(usize) -> f64) -> Vec<FieldCell> {
    let place =
        |node: usize| [0, 1].map(|axis| mesh.nodes[node][axis] + displacement[2 * node + axis]);
    let cell = |cell: usize| {
        // A triangle is a quadrilateral whose last two corners are one.
        let last = mesh.shape(cell).corners() - 1;
        let corners: [usize; 4] = std::array::from_fn(|corner| mesh.cell(cell)[corner.min(last)]);
        (corners.map(place), value(cell))
    };
    (0..mesh.cell_count()).map(cell).collect()
}
