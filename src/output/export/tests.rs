use std::path::Path;

use super::*;
use crate::mesh::Shape;

const DATA: &str = "[data]\nstress_measure = \"nominal\"\nstrain_measure = \"nominal\"\noffset = \"subtract\"\n\
    test = \"uniaxial tension\"\nstretch_range = [1.0, 2.0]\n[source]\ncitation = \"none\"\nspecimen = \"none\"\n";

fn card(law: &str, parameters: &str) -> Card {
    let text = format!("title = \"test\"\nlaw = \"{law}\"\n[parameters]\n{parameters}\n{DATA}");
    Card::parse("test", "test.toml", &text).unwrap()
}

/// A strip of 2 × 1 cells under everything that a study can say.
fn problem(card: &Card) -> BoundaryProblem {
    let displacement = |x, y| Support::Displacement([x, y]);
    BoundaryProblem {
        thickness: 2.0,
        law: card.law.clone(),
        supports: vec![
            ("left".into(), displacement(Some(0.0), Some(0.0))),
            (
                "right".into(),
                Support::Rotation {
                    centre: [0.0, 0.0],
                    angle: 0.5,
                },
            ),
        ],
        loads: vec![
            ("bottom".into(), Load::Pressure(0.01)),
            ("top".into(), Load::Traction([0.0, 0.03])),
        ],
    }
}

fn written(card: &Card, code: Code, shape: CellShape) -> Result<Written, Error> {
    let mesh = Shape::Strip { size: [4.0, 2.0] }.mesh(2, shape);
    let given = HandOver {
        title: "strip",
        problem: &problem(card),
        card,
        mesh: &mesh,
        factors: &[0.5, 1.0],
        bulk_ratio: 1000.0,
    };
    hand_over(&given, code)
}

/// The data lines that follow a keyword.
fn data(text: &str, keyword: &str) -> Vec<Vec<f64>> {
    let after = text
        .split_once(keyword)
        .unwrap_or_else(|| panic!("no {keyword}"))
        .1;
    let lines = after
        .lines()
        .skip(1)
        .take_while(|line| !line.starts_with('*'));
    let fields = |line: &str| {
        line.split(',')
            .map(|field| field.trim().parse().unwrap())
            .collect()
    };
    lines.map(fields).collect()
}

/// The text of an element of XML.
fn value(text: &str, name: &str) -> f64 {
    let found = text
        .split_once(&format!("<{name}>"))
        .unwrap_or_else(|| panic!("no {name}"))
        .1;
    found.split_once('<').unwrap().0.parse().unwrap()
}

/// Nominal stresses of an energy of the principal stretches in a sheet, by differences.
fn nominal(energy: &dyn Fn([f64; 3]) -> f64, [a, b]: [f64; 2]) -> [f64; 2] {
    let h = 1e-6;
    let at = |a: f64, b: f64| energy([a, b, 1.0 / (a * b)]);
    [
        (at(a + h, b) - at(a - h, b)) / (2.0 * h),
        (at(a, b + h) - at(a, b - h)) / (2.0 * h),
    ]
}

fn assert_same_law(card: &Card, what: &str, energy: &dyn Fn([f64; 3]) -> f64) {
    for stretches in [[1.4, 0.9], [1.2, 1.3], [0.8, 1.5]] {
        let found = nominal(energy, stretches);
        let expected = card.law.biaxial(stretches.map(|stretch| stretch - 1.0));
        for (found, expected) in found.iter().zip(expected) {
            let error = (found - expected).abs();
            assert!(
                error < 1e-7,
                "{what} at {stretches:?}: {found} for {expected}"
            );
        }
    }
}

fn i1([a, b, c]: [f64; 3]) -> f64 {
    a * a + b * b + c * c
}

fn i2([a, b, c]: [f64; 3]) -> f64 {
    i1([1.0 / a, 1.0 / b, 1.0 / c])
}

/// The energy that the manuals of Abaqus and of CalculiX give to a keyword and its data.
fn manual_energy(keyword: &str, c: &[f64], stretches: [f64; 3]) -> f64 {
    let (x, y) = (i1(stretches) - 3.0, i2(stretches) - 3.0);
    match keyword {
        "NEO HOOKE" => c[0] * x,
        "MOONEY-RIVLIN" => c[0] * x + c[1] * y,
        "POLYNOMIAL, N=2" => c[0] * x + c[1] * y + c[2] * x * x + c[3] * x * y + c[4] * y * y,
        "YEOH" => c[0] * x + c[1] * x * x + c[2] * x.powi(3),
        "OGDEN, N=2" => (0..2)
            .map(|i| {
                let (mu, alpha) = (c[2 * i], c[2 * i + 1]);
                let sum: f64 = stretches.iter().map(|stretch| stretch.powf(alpha)).sum();
                2.0 * mu / (alpha * alpha) * (sum - 3.0)
            })
            .sum(),
        "ARRUDA-BOYCE" => {
            let terms = [
                1.0 / 2.0,
                1.0 / 20.0,
                11.0 / 1050.0,
                19.0 / 7000.0,
                519.0 / 673_750.0,
            ];
            let term = |(i, factor): (i32, f64)| {
                factor / c[1].powi(2 * i - 2) * (i1(stretches).powi(i) - 3.0_f64.powi(i))
            };
            c[0] * (1..).zip(terms).map(term).sum::<f64>()
        }
        other => panic!("{other}"),
    }
}

#[test]
fn laws_go_out_in_the_conventions_of_abaqus_and_calculix() {
    for (law, parameters, keyword) in [
        ("neo-hooke", "c10 = \"0.05 MPa\"", "NEO HOOKE"),
        (
            "mooney-rivlin",
            "c10 = \"0.03 MPa\"\nc01 = \"0.02 MPa\"",
            "MOONEY-RIVLIN",
        ),
        (
            "mooney-rivlin-3",
            "c10 = \"0.03 MPa\"\nc01 = \"0.02 MPa\"\nc11 = \"0.004 MPa\"",
            "POLYNOMIAL, N=2",
        ),
        (
            "mooney-rivlin-5",
            "c10 = \"0.03 MPa\"\nc01 = \"0.02 MPa\"\nc20 = \"0.001 MPa\"\nc11 = \"0.002 MPa\"\nc02 = \"0.003 MPa\"",
            "POLYNOMIAL, N=2",
        ),
        (
            "yeoh",
            "c10 = \"0.05 MPa\"\nc20 = \"0.01 MPa\"\nc30 = \"0.002 MPa\"",
            "YEOH",
        ),
        (
            "ogden-2",
            "convention = \"2mu/alpha^2\"\nmu_1 = \"0.06 MPa\"\nalpha_1 = 3.0\nmu_2 = \"0.04 MPa\"\nalpha_2 = -2.5",
            "OGDEN, N=2",
        ),
        (
            "ogden-2",
            "convention = \"mu/alpha\"\nmu_1 = \"0.06 MPa\"\nalpha_1 = 3.0\nmu_2 = \"-0.04 MPa\"\nalpha_2 = -2.5",
            "OGDEN, N=2",
        ),
        (
            "arruda-boyce",
            "mu = \"0.05 MPa\"\nlambda_m = 1.5",
            "ARRUDA-BOYCE",
        ),
    ] {
        let card = card(law, parameters);
        for code in [Code::Abaqus, Code::CalculiX] {
            let text = written(&card, code, CellShape::Quad4).unwrap().text;
            let lines = data(&text, &format!("*HYPERELASTIC, {keyword}"));
            let values = lines.concat();
            assert_same_law(&card, law, &|stretches| {
                manual_energy(keyword, &values, stretches)
            });
            // K = 2/D₁ in CalculiX, no compressibility in Abaqus.
            let expected = match code {
                Code::Abaqus => 0.0,
                _ => 2.0 / (1000.0 * card.law.shear_modulus()),
            };
            let d = values[values.len() - 1];
            assert!(
                (d - expected).abs() <= 1e-10 * expected,
                "{law}: {d} for {expected}"
            );
        }
    }
}

#[test]
fn laws_go_out_in_the_conventions_of_febio() {
    let text = |card: &Card| written(card, Code::FeBio, CellShape::Quad4).unwrap().text;
    let ogden = card(
        "ogden-2",
        "convention = \"2mu/alpha^2\"\nmu_1 = \"0.06 MPa\"\nalpha_1 = 3.0\nmu_2 = \"0.04 MPa\"\nalpha_2 = -2.5",
    );
    let file = text(&ogden);
    let terms = [("c1", "m1"), ("c2", "m2")].map(|(c, m)| [value(&file, c), value(&file, m)]);
    assert_same_law(&ogden, "Ogden", &|stretches| {
        let term = |[c, m]: [f64; 2]| {
            let sum: f64 = stretches.iter().map(|stretch| stretch.powf(m)).sum();
            c / (m * m) * (sum - 3.0)
        };
        terms.into_iter().map(term).sum()
    });
    assert!((value(&file, "k") - 1000.0 * 0.1).abs() < 1e-9);

    let gent = card("gent", "mu = \"0.1 MPa\"\njm = 8.0");
    let file = text(&gent);
    let [g, jm] = ["G", "Jm"].map(|name| value(&file, name));
    assert_same_law(&gent, "Gent", &|s| {
        -0.5 * g * jm * (1.0 - (i1(s) - 3.0) / jm).ln()
    });

    let veronda = card("veronda-westmann", "c = \"0.147 MPa\"\nbeta = 0.31");
    let file = text(&veronda);
    let [c1, c2] = ["c1", "c2"].map(|name| value(&file, name));
    assert_same_law(&veronda, "Veronda", &|s| {
        c1 * ((c2 * (i1(s) - 3.0)).exp() - 1.0) - 0.5 * c1 * c2 * (i2(s) - 3.0)
    });

    for (families, sign) in [("one", 1.0), ("two", -1.0)] {
        let parameters = format!(
            "mu = \"0.02 MPa\"\nk1 = \"0.05 MPa\"\nk2 = 1.5\nkappa = 0.1\nangle = \"0 deg\"\nfamilies = \"{families}\""
        );
        let fibres = card("holzapfel-gasser-ogden", &parameters);
        let file = text(&fibres);
        let [c, k1, k2, kappa, gamma] =
            ["c", "k1", "k2", "kappa", "gamma"].map(|name| value(&file, name));
        assert_eq!(file.contains("<mat_axis type=\"vector\">"), sign > 0.0);
        assert_same_law(&fibres, families, &|s| {
            let (sine, cosine) = gamma.to_radians().sin_cos();
            let i4 = (cosine * s[0]).powi(2) + (sine * s[1]).powi(2);
            let e = (kappa * (i1(s) - 3.0) + (1.0 - 3.0 * kappa) * (i4 - 1.0)).max(0.0);
            // FEBio has two families always.
            c / 2.0 * (i1(s) - 3.0) + 2.0 * k1 / (2.0 * k2) * ((k2 * e * e).exp() - 1.0)
        });
    }
}

#[test]
fn laws_of_the_first_invariant_go_out_as_marlows_law() {
    for (law, parameters) in [
        ("gent", "mu = \"0.1 MPa\"\njm = 3.0"),
        ("fung-demiray", "mu = \"0.1 MPa\"\nb = 0.4"),
        (
            "marlow-exponential",
            "amplitude = \"0.0611 MPa\"\nexponent = 2.2347",
        ),
    ] {
        let card = card(law, parameters);
        let text = written(&card, Code::Abaqus, CellShape::Quad4).unwrap().text;
        assert!(text.contains("*HYPERELASTIC, MARLOW\n"), "{law}");
        let curve = data(&text, "*UNIAXIAL TEST DATA");
        assert_eq!(curve[0], [0.0, 0.0]);
        assert!(curve.len() > 100, "{law}: {} points", curve.len());
        for point in curve {
            let expected = card.law.tension([1.0, 0.0], point[1]).nominal_stress;
            assert!(
                (point[0] - expected).abs() <= 1e-10 * expected,
                "{law}: {point:?}"
            );
        }
    }
}

#[test]
fn a_law_that_a_code_lacks_is_refused_with_what_it_has() {
    let fung = card("fung-demiray", "mu = \"0.1 MPa\"\nb = 0.4");
    let yeoh = card(
        "yeoh",
        "c10 = \"0.05 MPa\"\nc20 = \"0.01 MPa\"\nc30 = \"0.002 MPa\"",
    );
    let veronda = card("veronda-westmann", "c = \"0.147 MPa\"\nbeta = 0.31");
    for (card, code) in [
        (&fung, Code::CalculiX),
        (&yeoh, Code::FeBio),
        (&veronda, Code::Abaqus),
    ] {
        let told = written(card, code, CellShape::Quad4)
            .unwrap_err()
            .to_string();
        for expected in [
            code.name(),
            card.law_name,
            "Ogden",
            "gelbench materials fit",
        ] {
            assert!(told.contains(expected), "{told}");
        }
    }
}

/// ```text
///   4───5───6      cells 1 and 2, each 2 × 2 mm: left clamped, right turned by 0.5, pressure from below,
///   │ 1 │ 2 │      traction on top
///   1───2───3
/// ```
#[test]
fn supports_loads_and_steps_are_those_of_the_study() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    let mesh = Mesh::new(
        vec![
            [0.0, 0.0],
            [2.0, 0.0],
            [4.0, 0.0],
            [0.0, 2.0],
            [2.0, 2.0],
            [4.0, 2.0],
        ],
        [
            (CellShape::Quad4, vec![0, 1, 4, 3]),
            (CellShape::Quad4, vec![1, 2, 5, 4]),
        ],
    );
    let mut mesh = mesh;
    mesh.name_boundary("left", |[x, _]| x == 0.0);
    mesh.name_boundary("right", |[x, _]| x == 4.0);
    mesh.name_boundary("bottom", |[_, y]| y == 0.0);
    mesh.name_boundary("top", |[_, y]| y == 2.0);
    let given = HandOver {
        title: "Zwei Zellen, μ",
        problem: &problem(&card),
        card: &card,
        mesh: &mesh,
        factors: &[0.5, 1.0],
        bulk_ratio: 100.0,
    };
    let text = hand_over(&given, Code::CalculiX).unwrap().text;
    assert!(text.is_ascii(), "no code reads other letters everywhere");
    for expected in [
        "gelbench: Zwei Zellen, ?\n",
        "*ELEMENT, TYPE=CPS4, ELSET=SPECIMEN\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n",
        "*NSET, NSET=RIGHT\n3, 6\n",
        "*SURFACE, NAME=BOTTOM_EDGES, TYPE=ELEMENT\n1, S1\n2, S1\n",
        "*SURFACE, NAME=TOP_EDGES, TYPE=ELEMENT\n1, S3\n2, S3\n",
        "MATERIAL=MATERIAL_1\n2\n",
        "*BOUNDARY\nLEFT, 1, 1, 0\nLEFT, 2, 2, 0\n3, 1, 1,",
        // Traction 0.03 MPa on 2 mm × 2 mm for each edge, half of it at the first load factor.
        "*CLOAD\n4, 2, 0.03\n5, 2, 0.06\n6, 2, 0.03\n*DLOAD\n1, P1, 0.005\n2, P1, 0.005\n",
        "*CLOAD\n4, 2, 0.06\n5, 2, 0.12\n6, 2, 0.06\n*DLOAD\n1, P1, 0.01\n2, P1, 0.01\n",
    ] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    assert_eq!(text.matches("*STEP, NLGEOM").count(), 2);
    // The node (4, 2) mm turned by 0.25 and by 0.5 about the origin.
    let turned = |angle: f64| 4.0 * (angle.cos() - 1.0) - 2.0 * angle.sin();
    let lines = text
        .lines()
        .filter_map(|line| line.strip_prefix("6, 1, 1, "));
    let found: Vec<f64> = lines.map(|line| line.parse().unwrap()).collect();
    for (found, angle) in found.iter().zip([0.25, 0.5]) {
        assert!((found - turned(angle)).abs() < 1e-10, "{found}");
    }
    assert_eq!(found.len(), 2);
    let abaqus = hand_over(&given, Code::Abaqus).unwrap().text;
    assert!(
        abaqus.contains("*HYPERELASTIC, NEO HOOKE\n0.05, 0\n"),
        "{abaqus}"
    );
}

/// A `.feb` file as its lists of numbers by tag and number.
struct Solids {
    text: String,
    places: BTreeMap<usize, Vec<f64>>,
}

impl Solids {
    fn new(text: String) -> Self {
        let places = rows(&text, "node").into_iter().collect();
        Self { text, places }
    }

    fn place(&self, node: f64) -> &[f64] {
        &self.places[&(node as usize)]
    }

    /// Whether one node stands in the middle between two others.
    fn assert_middle(&self, node: f64, ends: [f64; 2]) {
        let [a, b] = ends.map(|end| self.place(end));
        for (axis, found) in self.place(node).iter().enumerate() {
            assert!(
                (found - 0.5 * (a[axis] + b[axis])).abs() < 1e-9,
                "{node} between {ends:?}"
            );
        }
    }
}

/// The lists of numbers in all elements of a tag, by their `id`.
fn rows(text: &str, tag: &str) -> Vec<(usize, Vec<f64>)> {
    let start = format!("<{tag} id=\"");
    let lines = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix(&start));
    let row = |line: &str| {
        let (id, rest) = line.split_once("\">").unwrap();
        let values = rest.split('<').next().unwrap().split(',');
        (
            id.parse().unwrap(),
            values.map(|value| value.parse().unwrap()).collect(),
        )
    };
    lines.map(row).collect()
}

/// The nodes of the solids are in FEBio's order, on half the sheet.
#[test]
fn febio_gets_half_the_sheet_as_solids() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    for (_, shape) in CellShape::NAMES {
        let file = Solids::new(written(&card, Code::FeBio, shape).unwrap().text);
        let solids = rows(&file.text, "elem");
        assert!(!solids.is_empty());
        for (_, nodes) in &solids {
            let n = shape.corners();
            for i in 0..n {
                let next = (i + 1) % n;
                let (below, above) = (file.place(nodes[i]), file.place(nodes[n + i]));
                assert_eq!((below[2], above[2]), (0.0, 1.0), "{shape:?}");
                assert_eq!(below[..2], above[..2], "{shape:?}");
                if shape.degree() == 2 {
                    file.assert_middle(nodes[2 * n + i], [nodes[i], nodes[next]]);
                    file.assert_middle(nodes[3 * n + i], [nodes[n + i], nodes[n + next]]);
                    file.assert_middle(nodes[4 * n + i], [nodes[i], nodes[n + i]]);
                }
            }
            if shape == CellShape::Quad9 {
                assert_eq!(nodes.len(), 27);
                for side in 0..4 {
                    file.assert_middle(nodes[20 + side], [nodes[8 + side], nodes[12 + side]]);
                }
                for (face, corners) in [(24, [0, 2]), (25, [4, 6]), (26, [0, 6])] {
                    file.assert_middle(nodes[face], corners.map(|corner: usize| nodes[corner]));
                }
            }
        }
    }
}

#[test]
fn febio_gets_half_of_the_loads_on_faces_that_look_outwards() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    for (_, shape) in CellShape::NAMES {
        let file = Solids::new(written(&card, Code::FeBio, shape).unwrap().text);
        let loads = file.text.split("<nodal_load").skip(1);
        let up = |load: &str| -> f64 {
            let value = load.split("lc=\"1\">").nth(1).unwrap();
            value.split([',', '<']).nth(1).unwrap().parse().unwrap()
        };
        // 0.03 MPa on 4 mm × 2 mm of the top.
        let sum: f64 = loads.map(up).sum();
        assert!(
            (sum - 0.5 * 0.03 * 4.0 * 2.0).abs() < 1e-9,
            "{shape:?}: {sum}"
        );
        let surface = file
            .text
            .split_once("<Surface name=\"BOTTOM_EDGES\">")
            .unwrap()
            .1;
        let face = surface
            .lines()
            .nth(1)
            .unwrap()
            .split(['>', '<'])
            .nth(2)
            .unwrap();
        let face: Vec<f64> = face.split(',').map(|node| node.parse().unwrap()).collect();
        let [a, b, c] = [0, 1, 2].map(|corner| file.place(face[corner]));
        assert!(b[0] > a[0] && c[2] > b[2], "{shape:?}");
        assert!(file.text.contains("<pressure lc=\"1\">0.01</pressure>"));
    }
}

/// A displacement that is linear in the place goes out node by node.
#[test]
fn linear_displacements_go_out_with_the_value_of_every_node() {
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    let mesh = Shape::Strip { size: [4.0, 2.0] }.mesh(2, CellShape::Quad4);
    let field = crate::units::parse_linear_length("0.1 * X + 0.05 * Y").unwrap();
    let mut problem = problem(&card);
    problem.supports[1].1 = Support::LinearDisplacement([Some(field), None]);
    let given = HandOver {
        title: "strip",
        problem: &problem,
        card: &card,
        mesh: &mesh,
        factors: &[1.0],
        bulk_ratio: 100.0,
    };
    for code in [Code::CalculiX, Code::FeBio] {
        assert!(hand_over(&given, code).is_ok());
    }
    let text = hand_over(&given, Code::CalculiX).unwrap().text;
    for node in &mesh.groups()["right"].nodes {
        let line = format!("\n{}, 1, 1, ", node + 1);
        let (_, after) = text.split_once(&line).expect("a line of the node");
        let value: f64 = after.lines().next().unwrap().parse().unwrap();
        assert!(
            (value - field.at(mesh.nodes[*node])).abs() < 1e-12,
            "{value}"
        );
    }
}
