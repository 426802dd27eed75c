//! Camera images of a strip with a hole, whose field is known, corrected to stress and force.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gelbench::budget::Budget;
use gelbench::estimation::{Answer, EdgeCondition, FieldEstimate};
use gelbench::markers::ReadSettings;
use gelbench::material::NeoHooke;
use gelbench::mesh::{CellShape, Mesh};
use gelbench::problem::BoundaryProblem;
use gelbench::solve::NewtonSettings;
use gelbench::studies::markers::{Conditions, MarkerStudy, MeshSource, Request};
use gelbench_base::statistics::normal_numbers;
use gelbench_images::images::ImageFile;
use gelbench_studies::studies::images::ImageSettings;
use rayon::prelude::*;

use crate::common::sheets::{STRIP_WITH_HOLE, held, named};
use patterns::{speckle, tags, weave};

#[expect(
    dead_code,
    reason = "other patterns are those of the tests of tracking"
)]
#[path = "../../crates/images/src/images/tests/patterns.rs"]
mod patterns;

/// Pixels of a mm.
const PIXELS: f64 = 4.0;

/// Columns and rows of the images.
const PIXEL_COUNTS: [usize; 2] = [688, 208];

/// Where the specimen's middle lies in the image, in mm.
const MIDDLE: [f64; 2] = [56.0, 26.0];

const RADIUS: f64 = 8.0;
const SIZE: [f64; 2] = [100.0, 40.0];
const C10: f64 = 0.05;

/// The strip in equilibrium, its right end pulled.
struct Truth {
    mesh: Mesh,
    displacement: Vec<f64>,
    force: f64,
    /// The place of the mesh's middle.
    centre: [f64; 2],
}

impl Truth {
    fn pulled(by: f64) -> Self {
        let problem = BoundaryProblem {
            thickness: 2.0,
            law: Arc::new(NeoHooke { c10: C10 }),
            regions: Vec::new(),
            supports: named([("left", held(0.0, 0.0)), ("right", held(by, 0.0))]),
            loads: Vec::new(),
        };
        let mesh = STRIP_WITH_HOLE.mesh(32, CellShape::Quad9);
        let energy = problem.finite_elements(&mesh);
        let model = problem.on(&mesh, &energy).unwrap();
        let states = model.solve(&[0.5, 1.0], NewtonSettings::default(), &|_| ());
        let state = states.unwrap().remove(1);
        let force = model.reaction(&state, "right")[0];
        drop(model);
        let [low, high] = mesh.bounding_box();
        Self {
            displacement: state.displacement,
            centre: [0, 1].map(|axis| 0.5 * (low[axis] + high[axis])),
            mesh,
            force,
        }
    }

    /// The displacement of a point at rest, in the coordinates of the image.
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let centre = self.centre;
        let position = [x - MIDDLE[0] + centre[0], y - MIDDLE[1] + centre[1]];
        self.mesh.displacement_at(&self.displacement, position)
    }

    /// The point at rest, in pixels, that is seen in each quarter of a pixel, row by row from the top, at rest or pulled.
    fn seen(&self, pulled: bool) -> Vec<Option<[f64; 2]>> {
        let mut moved = self.mesh.clone();
        for (node, u) in moved.nodes.iter_mut().zip(self.displacement.chunks(2)) {
            *node = [0, 1].map(|axis| node[axis] + if pulled { u[axis] } else { 0.0 });
        }
        let mut seen = vec![None; 4 * PIXEL_COUNTS[0] * PIXEL_COUNTS[1]];
        for cell in 0..moved.cell_count() {
            let corners = moved.cell(cell).iter().map(|node| moved.nodes[*node]);
            let quarters: Vec<[f64; 2]> = corners.map(|corner| self.quarter(corner)).collect();
            let [columns, rows] = [0, 1].map(|axis| {
                let along = quarters.iter().map(|quarter| quarter[axis]);
                let low = along.clone().fold(f64::MAX, f64::min).floor() as usize;
                low..=along.fold(f64::MIN, f64::max).ceil() as usize
            });
            for (row, column) in
                rows.flat_map(|row| columns.clone().map(move |column| (row, column)))
            {
                if let Some(local) = self.local(&moved, cell, [column as f64, row as f64]) {
                    let at = self.mesh.position(cell, local);
                    seen[row * 2 * PIXEL_COUNTS[0] + column] =
                        Some(at.map(|along| PIXELS * along + 1000.0));
                }
            }
        }
        seen
    }

    /// Column and row of the quarter of a pixel that shows a place of the mesh.
    fn quarter(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let centre = self.centre;
        let column = PIXELS * (x - centre[0] + MIDDLE[0]);
        let row = (PIXEL_COUNTS[1] - 1) as f64 - PIXELS * (y - centre[1] + MIDDLE[1]);
        [column, row].map(|pixel| 2.0 * pixel + 0.5)
    }

    /// Natural coordinates in a cell of what is seen in the middle of a quarter of a pixel, where that lies in it.
    fn local(&self, moved: &Mesh, cell: usize, quarter: [f64; 2]) -> Option<[f64; 2]> {
        const STEP: f64 = 1e-5;
        let at = |local| self.quarter(moved.position(cell, local));
        let mut local = [0.0; 2];
        for _ in 0..6 {
            let (here, [x, y]) = (at(local), local);
            let [along, across] = [at([x + STEP, y]), at([x, y + STEP])];
            let [a, c] = [0, 1].map(|axis| (along[axis] - here[axis]) / STEP);
            let [b, d] = [0, 1].map(|axis| (across[axis] - here[axis]) / STEP);
            let off = [0, 1].map(|axis| quarter[axis] - here[axis]);
            let determinant = a * d - b * c;
            local[0] += (d * off[0] - b * off[1]) / determinant;
            local[1] += (a * off[1] - c * off[0]) / determinant;
        }
        let [x, y] = local.map(f64::abs);
        (x <= 1.0 && y <= 1.0).then_some(local)
    }
}

/// An image of what is seen, blurred, with noise of a share of white.
fn image(
    name: &str,
    seen: &[Option<[f64; 2]>],
    pattern: &(dyn Fn([f64; 2]) -> f64 + Sync),
    blur: usize,
    noise: f64,
) -> ImageFile {
    const DARK: f64 = 0.05;
    let light = |quarter: usize| seen[quarter].map_or(DARK, pattern);
    let pixel = |row: usize, column: usize| {
        let first = 2 * row * 2 * PIXEL_COUNTS[0] + 2 * column;
        let below = first + 2 * PIXEL_COUNTS[0];
        0.25 * [first, first + 1, below, below + 1]
            .map(light)
            .iter()
            .sum::<f64>()
    };
    let row = |row: usize| {
        (0..PIXEL_COUNTS[0])
            .map(|column| pixel(row, column))
            .collect()
    };
    let mut rows: Vec<Vec<f64>> = (0..PIXEL_COUNTS[1]).into_par_iter().map(row).collect();
    for _ in 0..blur {
        rows = blurred(&rows);
    }
    let mut normal = normal_numbers(name.len() as u64);
    let values = rows.concat().into_iter().map(|value| {
        let error = normal();
        (255.0 * (value + noise * error)).round().clamp(0.0, 255.0) as f32
    });
    ImageFile::of_values(name, PIXEL_COUNTS, values.collect()).unwrap()
}

/// Weights 1, 2, 1 along both axes.
fn blurred(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let near =
        |index: usize, step: isize, count: usize| index.saturating_add_signed(step).min(count - 1);
    let value = |row: usize, column: usize| {
        let mut sum = 0.0;
        for (i, j) in (-1..=1).flat_map(|j| (-1..=1).map(move |i| (i, j))) {
            let weight = f64::from((2 - i32::abs(i)) * (2 - i32::abs(j)));
            let row = &rows[near(row, j as isize, rows.len())];
            sum += weight / 16.0 * row[near(column, i as isize, row.len())];
        }
        sum
    };
    let columns = rows[0].len();
    let row = |row: usize| (0..columns).map(|column| value(row, column)).collect();
    (0..rows.len()).map(row).collect()
}

/// The edge of the strip in the image, with the hole as a polygon of its area, everywhere so many mm farther out.
fn outline(folder: &Path, farther: f64) -> PathBuf {
    const CORNERS: usize = 128;
    let mut text = "x [mm],y [mm],line\n".to_owned();
    for [x, y] in [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] {
        let _ = writeln!(
            text,
            "{},{},1",
            MIDDLE[0] + x * (SIZE[0] + 2.0 * farther),
            MIDDLE[1] + y * (SIZE[1] + 2.0 * farther)
        );
    }
    let step = TAU / CORNERS as f64;
    let radius = (RADIUS - farther) * (step / step.sin()).sqrt();
    for corner in 0..CORNERS {
        let (sine, cosine) = (step * corner as f64).sin_cos();
        let _ = writeln!(
            text,
            "{},{},2",
            MIDDLE[0] + radius * cosine,
            MIDDLE[1] - radius * sine
        );
    }
    let path = folder.join("edge.csv");
    std::fs::write(&path, text).unwrap();
    path
}

fn corrected(folder: &Path, images: Vec<ImageFile>, card: &str) -> (MarkerStudy, FieldEstimate) {
    corrected_within(folder, outline(folder, 0.0), &[], (images, card))
}

fn corrected_within(
    folder: &Path,
    edge: PathBuf,
    free: &[&str],
    (images, card): (Vec<ImageFile>, &str),
) -> (MarkerStudy, FieldEstimate) {
    let request = request(folder, edge, free, (images, card));
    let mut study = MarkerStudy::prepare(request, &|_| ()).unwrap();
    let estimate = study.estimate(&|_| ()).unwrap().remove(0);
    (study, estimate)
}

fn request(
    folder: &Path,
    edge: PathBuf,
    free: &[&str],
    (images, card): (Vec<ImageFile>, &str),
) -> Request {
    let grips = ["left", "right"].map(|name| (name, EdgeCondition::Rigid));
    let free = free.iter().map(|name| (*name, EdgeCondition::Free));
    let edges = grips.into_iter().chain(free);
    let edges = edges.map(|(name, condition)| (name.to_owned(), condition));
    std::fs::write(folder.join("card.toml"), card).unwrap();
    Request {
        files: Vec::new(),
        reading: ReadSettings {
            unit: Some(1.0 / PIXELS),
            ..ReadSettings::default()
        },
        images: ImageSettings {
            in_memory: images,
            ..ImageSettings::default()
        },
        material: folder.join("card.toml").display().to_string(),
        thickness: 2.0,
        mesh: MeshSource::Outline(edge),
        cell_size: None,
        shape: CellShape::Triangle6,
        holes: true,
        conditions: Conditions {
            edges: edges.collect(),
            ..Conditions::default()
        },
        forces: None,
        budget: Budget::USUAL,
    }
}

/// The images of a truth at rest and pulled.
fn pair(
    truth: &Truth,
    pattern: &(dyn Fn([f64; 2]) -> f64 + Sync),
    blur: usize,
    noise: f64,
) -> Vec<ImageFile> {
    let states = [("rest", false), ("pulled", true)];
    let of_state =
        states.map(|(name, pulled)| image(name, &truth.seen(pulled), pattern, blur, noise));
    of_state.to_vec()
}

/// The 95 % interval of the force along x on the right side.
fn right_interval(estimate: &FieldEstimate) -> [f64; 2] {
    let mut forces = estimate.forces.iter();
    let right = forces.find(|force| force.edge == "right").unwrap();
    right.force[0].interval
}

/// The share of displacements within their intervals.
fn covered(study: &MarkerStudy, estimate: &FieldEstimate, truth: &Truth) -> f64 {
    let mut inside = 0;
    for (node, position) in study.mesh.nodes.iter().enumerate() {
        for (axis, exact) in truth.at(*position).into_iter().enumerate() {
            let row = 2 * node + axis;
            let error = (estimate.displacement[row] - exact).abs();
            inside += usize::from(error <= estimate.reach * estimate.displacement_error[row]);
        }
    }
    inside as f64 / estimate.displacement.len() as f64
}

const NEO_HOOKE: &str = "law = \"neo-hooke\"\n[parameters]\nc10 = \"0.05 MPa\"\n";

/// Root mean square of the nodes' errors in pixels.
fn error(study: &MarkerStudy, estimate: &FieldEstimate, truth: &Truth) -> f64 {
    let nodes = study.mesh.nodes.iter().zip(estimate.displacement.chunks(2));
    let squares = nodes.map(|(node, u)| {
        let exact = truth.at(*node);
        (u[0] - exact[0]).powi(2) + (u[1] - exact[1]).powi(2)
    });
    PIXELS * (squares.sum::<f64>() / study.mesh.nodes.len() as f64).sqrt()
}

/// Threads have edges sharper than a pixel, between which no interpolation is exact: fewer displacements lie in their intervals. Beside a hole of 64
/// pixels that is pulled far, patches do not follow the stretch to 0.02 pixels: displacements and force are right, but the verdict may refute them.
#[test]
fn images_of_a_strip_with_a_hole_lead_to_its_field_and_force() {
    let folder = tempfile::tempdir().unwrap();
    for (name, pattern, pull, blur, noise, least_covered) in [
        ("much noise", speckle(1), 20.0, 0, 0.1, 0.9),
        ("blur", speckle(1), 10.0, 3, 0.02, 0.9),
        ("far", speckle(1), 60.0, 0, 0.02, 0.9),
        ("weave", weave(2), 10.0, 0, 0.02, 0.7),
    ] {
        let truth = Truth::pulled(pull);
        let images = pair(&truth, &*pattern, blur, noise);
        let (study, estimate) = corrected(folder.path(), images, NEO_HOOKE);
        let [low, high] = right_interval(&estimate);
        let covered = covered(&study, &estimate, &truth);
        let error = error(&study, &estimate, &truth);
        println!(
            "{name}: {:?}, error {error:.4} pixels, {covered:.3} covered, {low:.4} < {:.4} N < {high:.4}",
            estimate.verdict.answer, truth.force
        );
        if name != "far" {
            assert_ne!(estimate.verdict.answer, Answer::NotExplained, "{name}");
        }
        assert!(low < truth.force && truth.force < high, "{name}");
        assert!(error < 0.05, "{name}: {error} pixels");
        assert!(covered > least_covered, "{name}: {covered}");
    }
}

/// The same images are not those of a law that becomes softer.
#[test]
fn images_refute_a_wrong_law() {
    let folder = tempfile::tempdir().unwrap();
    let truth = Truth::pulled(30.0);
    let images = pair(&truth, &*speckle(1), 0, 0.05);
    let softer = "law = \"mooney-rivlin\"\n[parameters]\nc10 = \"0 MPa\"\nc01 = \"0.05 MPa\"\n";
    let (_, estimate) = corrected(folder.path(), images, softer);
    assert_eq!(estimate.verdict.answer, Answer::NotExplained);
}

/// No traced edge is exact: a fifth of a pixel on all sides refutes no law, and the force's interval holds what it changes.
#[test]
fn an_edge_that_is_traced_to_a_fifth_of_a_pixel_refutes_no_law() {
    let folder = tempfile::tempdir().unwrap();
    let truth = Truth::pulled(20.0);
    let images = pair(&truth, &*speckle(1), 0, 0.02);
    for farther in [-0.2, 0.2] {
        let edge = outline(folder.path(), farther / PIXELS);
        let (_, estimate) = corrected_within(
            folder.path(),
            edge,
            &["bottom", "top"],
            (images.clone(), NEO_HOOKE),
        );
        assert_ne!(estimate.verdict.answer, Answer::NotExplained, "{farther}");
        let [low, high] = right_interval(&estimate);
        println!("{farther}: {low:.4} < {:.4} N < {high:.4}", truth.force);
        assert!(low < truth.force && truth.force < high, "{farther}");
        assert!(high - low < 0.03 * truth.force);
    }
}

/// Such as the outline of another scale, or with exchanged columns: what it holds shows no specimen, and where it does the law may hold.
#[test]
fn an_outline_that_reaches_beyond_the_images_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let truth = Truth::pulled(20.0);
    let images = pair(&truth, &*speckle(1), 0, 0.02);
    let edge = outline(folder.path(), 0.0);
    let text = std::fs::read_to_string(&edge).unwrap();
    let exchanged = text.lines().skip(1).map(|line| {
        let [x, y, number] = line.split(',').collect::<Vec<_>>()[..] else {
            unreachable!()
        };
        format!("{y},{x},{number}\n")
    });
    let exchanged: String = exchanged.collect();
    std::fs::write(&edge, format!("x [mm],y [mm],line\n{exchanged}")).unwrap();
    let request = request(folder.path(), edge, &[], (images, NEO_HOOKE));
    let fault = MarkerStudy::prepare(request, &|_| ()).unwrap_err();
    let message = fault.to_string();
    assert!(
        message.contains("beyond the images, which show 171.750 × 51.750 mm"),
        "{message}"
    );
}

/// Tags that move by more than half of their distance are matched with others; the stretch of the tags themselves shows it.
#[test]
fn tags_that_are_matched_with_their_neighbours_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let truth = Truth::pulled(30.0);
    let images = pair(&truth, &*tags(8.0), 0, 0.02);
    let (study, estimate) = corrected(folder.path(), images, NEO_HOOKE);
    let error = error(&study, &estimate, &truth);
    let message = study.mistake.map(|mistake| mistake.message);
    println!("{error} pixels: {message:?}");
    assert!(
        error < 0.1 || message.is_some_and(|message| message.contains("others that look alike"))
    );
}
