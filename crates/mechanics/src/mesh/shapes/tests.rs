//! Outlines, areas and corners of all shapes.

use std::f64::consts::FRAC_PI_2;

use super::*;

/// Whether the map of no cell is turned inside out at a point of its quadrature.
fn is_unfolded(mesh: &Mesh) -> bool {
    (0..mesh.cell_count()).all(|cell| {
        let mut rule = mesh.shape(cell).quadrature().into_iter();
        rule.all(|(point, _)| mesh.gradients(cell, point).1 > 0.0)
    })
}

const SHAPES: [Shape; 7] = [
    Shape::Strip { size: [30.0, 10.0] },
    Shape::StripWithHole {
        size: [30.0, 10.0],
        radius: 2.5,
    },
    Shape::NotchedStrip {
        size: [30.0, 10.0],
        depth: 2.0,
        half_length: 4.0,
    },
    Shape::DogBone {
        size: [75.0, 12.5],
        narrow: [25.0, 4.0],
        shoulder: 8.0,
    },
    Shape::RingSector {
        radii: [10.0, 20.0],
        angle: FRAC_PI_2,
    },
    Shape::SquareOnRakes(Rakes {
        size: [10.0, 10.0],
        tines: 5,
        spacing: 1.7,
        inset: 0.9,
        radius: 0.15,
    }),
    Shape::Cruciform {
        size: [30.0, 24.0],
        arm_width: 8.0,
        fillet: 2.0,
    },
];

#[test]
fn every_shape_is_meshed_by_every_kind_of_cell_without_folds() {
    for shape in SHAPES {
        shape.check().unwrap();
        for (_, kind) in CellShape::NAMES {
            let mesh = shape.mesh(6, kind);
            assert!(is_unfolded(&mesh), "{shape:?} {kind:?}");
            // Single tines belong to a group of their own and to that of their side.
            let groups = mesh.groups().iter();
            let sides = groups.filter(|(name, _)| !name.contains("-tine-"));
            let edges: usize = sides.map(|(_, group)| group.edges.len()).sum();
            assert_eq!(edges, mesh.boundary().len(), "{shape:?} {kind:?}");
        }
    }
}

#[test]
fn areas_are_those_of_the_outlines() {
    let exact = |shape: Shape| match shape {
        Shape::StripWithHole { size, radius } => {
            size[0] * size[1] - std::f64::consts::PI * radius * radius
        }
        Shape::RingSector { radii, angle } => {
            angle * (radii[1] * radii[1] - radii[0] * radii[0]) / 2.0
        }
        Shape::Strip { size } => size[0] * size[1],
        Shape::SquareOnRakes(Rakes {
            size,
            tines,
            radius,
            ..
        }) => size[0] * size[1] - 4.0 * tines as f64 * std::f64::consts::PI * radius * radius,
        Shape::Cruciform {
            size,
            arm_width,
            fillet,
        } => {
            let corners = (4.0 - std::f64::consts::PI) * fillet * fillet;
            arm_width * (size[0] + size[1] - arm_width) + corners
        }
        _ => f64::NAN,
    };
    for shape in SHAPES {
        let (area, exact) = (shape.mesh(64, CellShape::Quad9).area(), exact(shape));
        assert!(
            exact.is_nan() || (area / exact - 1.0).abs() < 1e-5,
            "{shape:?}: {area} {exact}"
        );
    }
}

/// The corners of notches and of wide ends are nodes of every mesh; chords across them would leave out some of the load on an edge.
#[test]
fn corners_of_the_outline_are_nodes() {
    let [notched, dog_bone] = [SHAPES[2], SHAPES[3]];
    // An arc of a circle with a height on half a chord.
    let arc = |half_chord: f64, height: f64| {
        let radius = (half_chord * half_chord + height * height) / (2.0 * height);
        radius * (half_chord / radius).asin()
    };
    let of_notched = 22.0 + 2.0 * arc(4.0, 2.0);
    let of_dog_bone = 75.0 - 16.0 + 2.0 * arc(8.0, 4.25);
    let cases = [
        (notched, [11.0, 5.0], of_notched),
        (dog_bone, [17.0, 6.25], of_dog_bone),
    ];
    for (shape, corner, length) in cases {
        for across in 2..24 {
            for (name, kind) in CellShape::NAMES {
                let mesh = shape.mesh(across, kind);
                assert!(mesh.nodes.contains(&corner), "{shape:?} {name} {across}");
                let edges = mesh.groups()["top"].edges.iter();
                let chord = |edge: &Vec<usize>| {
                    let [[x, y], [to_x, to_y]] = [edge[0], edge[1]].map(|node| mesh.nodes[node]);
                    (to_x - x).hypot(to_y - y)
                };
                let short = 1.0 - edges.map(chord).sum::<f64>() / length;
                assert!(
                    (0.0..0.04).contains(&short),
                    "{shape:?} {name} {across}: {short}"
                );
                assert!(
                    across < 20 || short < 4e-4,
                    "{shape:?} {name} {across}: {short}"
                );
            }
        }
    }
}

#[test]
fn refined_meshes_come_back_to_the_outline() {
    for shape in SHAPES {
        let mut mesh = shape.mesh(6, CellShape::Triangle3).refined();
        shape.fit(&mut mesh);
        let mut mesh = mesh.quadratic();
        shape.fit(&mut mesh);
        let direct = shape.mesh(12, CellShape::Triangle6).area();
        let fitted = mesh.area();
        crate::assert_near(fitted, direct, 2e-4, &shape);
    }
}

#[test]
fn measures_that_do_not_fit_are_told() {
    let hole = Shape::StripWithHole {
        size: [30.0, 10.0],
        radius: 5.0,
    };
    let fault = |shape: Shape| shape.check().unwrap_err();
    assert_eq!(fault(hole).measure, "hole_diameter");
    assert!(fault(hole).remedy().contains("less than \"9 mm\""));
    let bone = Shape::DogBone {
        size: [75.0, 12.5],
        narrow: [60.0, 4.0],
        shoulder: 8.0,
    };
    assert!(fault(bone).reason.contains("shorter"));
    assert!(fault(bone).remedy().contains("less than \"59 mm\""));
    let notch = Shape::NotchedStrip {
        size: [30.0, 10.0],
        depth: 4.0,
        half_length: 4.0,
    };
    assert_eq!(fault(notch).measure, "notch_depth");
    assert!(fault(notch).remedy().contains("less than \"3.8 mm\""));
    let shoulder = Shape::DogBone {
        size: [75.0, 30.0],
        narrow: [25.0, 4.0],
        shoulder: 8.0,
    };
    assert!(fault(shoulder).remedy().contains("more than \"13 mm\""));
    let small = Shape::StripWithHole {
        size: [1e-3; 2],
        radius: 1e-3,
    };
    assert!(fault(small).remedy().contains("take less than"));
}

/// Steep arcs on the coarsest meshes, whose quadratic edges turn far.
#[test]
fn coarse_meshes_of_steep_arcs_have_no_folds() {
    let notched = |share: f64, half_length: f64| Shape::NotchedStrip {
        size: [60.0, 20.0],
        depth: share * half_length,
        half_length,
    };
    let notches =
        [1.0, 3.0, 6.0, 9.0].map(|half| [0.1, 0.5, 0.67, 0.9].map(|share| notched(share, half)));
    let dog_bone = |shoulder: f64| Shape::DogBone {
        size: [60.0, 20.0],
        narrow: [10.0, 8.0],
        shoulder,
    };
    let dog_bones = [6.1, 10.0, 20.0].map(dog_bone);
    for shape in notches.into_iter().flatten().chain(dog_bones) {
        if shape.check().is_err() {
            continue;
        }
        for across in [1, 2, 3, 4, 6, 8] {
            for (name, kind) in CellShape::NAMES {
                let mesh = shape.mesh_halved(across, 0, kind);
                assert!(is_unfolded(&mesh), "{shape:?} {name} {across}");
            }
        }
    }
}
