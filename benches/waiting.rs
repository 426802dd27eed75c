//! What people wait for: `cargo bench --bench waiting` runs the commands as they are typed, and shows the least of three times, or the
//! first where it is long.
//!
//! With `GELBENCH_BEFORE=PROGRAM`, one built from an earlier commit, both programs run each command in turn. With a word behind `--`, as in
//! `cargo bench --bench waiting -- markers`, only the commands whose name has it are run. Markers are those of a strip with a hole from finite
//! elements (neo-Hooke, pulled by 40 %), with normal noise of 3 µm.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

use gelbench::material::NeoHooke;
use gelbench::mesh::{CellShape, Mesh};
use gelbench::problem::BoundaryProblem;
use gelbench::solve::NewtonSettings;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

#[expect(dead_code, reason = "other shapes are those of tests")]
#[path = "../tests/common/sheets.rs"]
mod sheets;

use sheets::{STRIP_WITH_HOLE, held, named};

/// Standard deviation of the markers' displacements in mm.
const NOISE: f64 = 0.003;

/// The number of frames.
const FRAMES: usize = 10;

/// Seconds from which on a command is run once.
const LONG: f64 = 30.0;

/// Radius of the hole in mm.
const RADIUS: f64 = 8.0;

const CORRECT: &str =
    "--material neo-hooke --thickness 2mm --outline outline.csv --rigid left,right";

/// The commands in words, and what is typed behind `gelbench`. Each word is one argument; `_` stands for a blank in it.
const COMMANDS: [[&str; 2]; 14] = [
    ["main job", "run examples/pva_plate.toml"],
    ["strip with a hole", "run examples/strip_with_hole.toml"],
    ["dog-bone", "run examples/dog_bone.toml"],
    ["released plate", "run examples/released_plate.toml"],
    [
        "every law, tensile test",
        "materials fit materials/data/treloar_1944_uniaxial.csv --all",
    ],
    [
        "Holzapfel-Gasser-Ogden, 1,020 stresses",
        "materials fit validation/measured/tissue_biaxial/protocols.csv --law holzapfel-gasser-ogden --one-specimen",
    ],
    [
        "Ogden-Hill, two terms",
        "materials fit materials/data/treloar_1944_uniaxial.csv --law ogden-hill-2",
    ],
    [
        "1,441 markers, parameter fitted",
        "correct 1441.csv CORRECT --fit c10 --force right_x_FORCE_N",
    ],
    [
        "1,441 markers without outline",
        "correct 1441.csv --material neo-hooke --thickness 2mm",
    ],
    [
        "630 markers, weighted physics",
        "correct 630.csv CORRECT --physics weighted",
    ],
    ["3,400 markers, gross errors", "correct gross.csv CORRECT"],
    ["10 frames of 5,000 markers", "correct frames.csv CORRECT"],
    [
        "100,000 markers",
        "correct 100000.csv CORRECT --allow-large",
    ],
    [
        "1,000,000 markers",
        "correct 1000000.csv CORRECT --allow-large",
    ],
];

/// The strip with a hole in equilibrium, on its way to the last load factor.
struct Truth {
    mesh: Mesh,
    displacements: Vec<Vec<f64>>,
    force: f64,
}

impl Truth {
    fn new() -> Self {
        let ends = named([("left", held(0.0, 0.0)), ("right", held(40.0, 0.0))]);
        let problem = BoundaryProblem::supported(2.0, Arc::new(NeoHooke { c10: 0.05 }), ends);
        let mesh = STRIP_WITH_HOLE.mesh(96, CellShape::Quad9);
        let energy = problem.finite_elements(&mesh);
        let model = problem.on(&mesh, &energy).expect("a problem");
        let factors: Vec<f64> = (1..=FRAMES)
            .map(|frame| frame as f64 / FRAMES as f64)
            .collect();
        let states = model.solve(&factors, NewtonSettings::default(), &|_| ());
        let states = states.expect("equilibria");
        let force = model.reaction(&states[FRAMES - 1], "right")[0];
        let displacements = states.into_iter().map(|state| state.displacement);
        let displacements = displacements.collect();
        drop(model);
        Self {
            displacements,
            force,
            mesh,
        }
    }

    /// So many markers in so many frames, the last ones, some of the markers with gross errors.
    fn write(&self, file: &Path, count: usize, frames: usize, gross: usize) {
        let mut random = ChaCha8Rng::seed_from_u64(count as u64);
        let mut out = BufWriter::new(File::create(file).expect("a file"));
        writeln!(out, "frame,x [mm],y [mm],ux [mm],uy [mm]").expect("written");
        let [low, high] = self.mesh.bounding_box();
        let spacing = ((high[0] - low[0]) * (high[1] - low[1]) / count as f64).sqrt();
        let lines = [0, 1].map(|axis| ((high[axis] - low[axis]) / spacing) as usize);
        let middle = [0, 1].map(|axis| (low[axis] + high[axis]) / 2.0);
        for frame in 1..=frames {
            let displacement = &self.displacements[FRAMES - frames + frame - 1];
            for number in 0..lines[0] * lines[1] {
                let at = [number / lines[1], number % lines[1]];
                let position = [0, 1].map(|axis| low[axis] + spacing * (at[axis] as f64 + 0.5));
                if (position[0] - middle[0]).hypot(position[1] - middle[1]) < 1.02 * RADIUS {
                    continue;
                }
                let wrong = if number < gross {
                    random.random_range(0.5..2.0)
                } else {
                    0.0
                };
                let u = self.mesh.displacement_at(displacement, position);
                let u = u.map(|u| {
                    let noise: f64 = StandardNormal.sample(&mut random);
                    u + NOISE * noise + wrong
                });
                let ([x, y], [ux, uy]) = (position, u);
                writeln!(out, "{frame},{x:.5},{y:.5},{ux:.6},{uy:.6}").expect("written");
            }
        }
    }

    /// The rectangle, and the hole as a polygon of the same area.
    fn write_outline(&self, file: &Path) {
        const CORNERS: usize = 256;
        let [[left, bottom], [right, top]] = self.mesh.bounding_box();
        let mut text = "x [mm],y [mm],line\n".to_owned();
        for [x, y] in [[left, bottom], [right, bottom], [right, top], [left, top]] {
            text += &format!("{x},{y},1\n");
        }
        let step = std::f64::consts::TAU / CORNERS as f64;
        let radius = RADIUS * (step / step.sin()).sqrt();
        for corner in 0..CORNERS {
            let (sine, cosine) = (step * corner as f64).sin_cos();
            let [x, y] = [0.5 * (left + right), 0.5 * (bottom + top)];
            text += &format!("{},{},2\n", x + radius * cosine, y - radius * sine);
        }
        fs::write(file, text).expect("written");
    }
}

/// Seconds of one run of a command in the repository.
///
/// # Panics
/// Where it fails in another way than by its verdict.
fn seconds(program: &Path, arguments: &[String]) -> f64 {
    let begin = Instant::now();
    let run = Command::new(program)
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("a program");
    let seconds = begin.elapsed().as_secs_f64();
    let words = String::from_utf8_lossy(&run.stderr);
    let is_done = matches!(run.status.code(), Some(0 | 1 | 5));
    assert!(is_done, "{arguments:?}: {words}");
    seconds
}

fn main() {
    let wanted = std::env::args().skip(1).find(|word| !word.starts_with('-'));
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let truth = Truth::new();
    truth.write_outline(&at("outline.csv"));
    for (name, count, frames, gross) in [
        ("630.csv", 630, 1, 0),
        ("1441.csv", 1_441, 1, 0),
        ("gross.csv", 3_400, 1, 60),
        ("frames.csv", 5_000, FRAMES, 0),
        ("100000.csv", 100_000, 1, 0),
        ("1000000.csv", 1_000_000, 1, 0),
    ] {
        truth.write(&at(name), count, frames, gross);
    }
    let argument = |word: &str| {
        let word = word.replace('_', if word.contains("FORCE") { " " } else { "_" });
        let word = word.replace("FORCE", &truth.force.to_string());
        let file = at(&word);
        if file.exists() {
            file.display().to_string()
        } else {
            word
        }
    };
    let programs: Vec<PathBuf> = std::env::var_os("GELBENCH_BEFORE")
        .map(PathBuf::from)
        .into_iter()
        .chain([PathBuf::from(env!("CARGO_BIN_EXE_gelbench"))])
        .collect();
    let before = if programs.len() > 1 {
        " before [s] |"
    } else {
        ""
    };
    println!("| command |{before} now [s] |");
    println!("|---|---|{}", before.replace(" before [s] ", "---"));
    for [name, typed] in COMMANDS {
        if wanted.as_ref().is_some_and(|word| !name.contains(&**word)) {
            continue;
        }
        let typed = typed.replace("CORRECT", CORRECT);
        let mut arguments: Vec<String> = typed.split(' ').map(&argument).collect();
        arguments.extend(["--output".to_owned(), at("out").display().to_string()]);
        let mut least = vec![f64::INFINITY; programs.len()];
        for round in 0..3 {
            if round > 0 && least.iter().any(|least| *least > LONG) {
                break;
            }
            for (least, program) in least.iter_mut().zip(&programs) {
                *least = least.min(seconds(program, &arguments));
            }
        }
        let cells = least.iter().map(|seconds| format!(" {seconds:.2} |"));
        println!("| {name} |{}", cells.collect::<String>());
    }
}
