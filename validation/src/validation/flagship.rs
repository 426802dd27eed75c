//! The plate's climb for every law, shape, number of cells and stretch: which start led where, and how far the result is
//! from the direct method's.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;

use super::case::{Block, Computation, Outcome, Progress, check, number, section, table};
use super::plate::NEWTON;
use crate::corrector::DifferenceScheme;
use crate::corrector::climb::{Climb, ClimbSettings, ClimbSolution};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::material::samples;
use crate::mesh::{CellShape, Mesh};
use crate::problem::ClampedPlate;
use crate::solve::State;
use crate::statistics::larger;
use crate::units::Dimension;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let plates = section(root, "plates", |plates| {
        let length = |shape: &Section, key| shape.quantity(key, Dimension::Length, Bound::Positive);
        let sizes = plates.tables("shape").into_iter().map(|shape| {
            let size = [length(&shape, "length"), length(&shape, "width")];
            shape.unknown_keys();
            size
        });
        let cells = plates.tables("mesh").into_iter().filter_map(|mesh| {
            let cells = mesh.count_pair("cells", 2, 400);
            mesh.unknown_keys();
            cells
        });
        Plates {
            sizes: sizes.collect(),
            cells: cells.collect(),
            stretches: plates.quantities("stretches", Dimension::Ratio, Bound::Positive),
        }
    });
    Box::new(move |progress| Ok(outcome(&plates.compute(progress))))
}

/// The shapes and meshes of all plates, and their stretches.
struct Plates {
    sizes: Vec<[f64; 2]>,
    cells: Vec<[usize; 2]>,
    stretches: Vec<f64>,
}

impl Plates {
    /// All shapes on all meshes, of every law.
    fn compute(&self, progress: Progress) -> Vec<StretchResult> {
        let mut result = Vec::new();
        for (law, material) in samples::all() {
            progress.tell(law);
            let pairs = self.sizes.iter();
            let pairs = pairs.flat_map(|size| self.cells.iter().map(|cells| (*size, *cells)));
            let plate = |(size, cells)| Plate {
                law,
                problem: ClampedPlate {
                    size,
                    thickness: 2.0,
                    law: Arc::clone(&material),
                    stretches: self.stretches.clone(),
                },
                cells,
            };
            let plates: Vec<Plate> = pairs.map(plate).collect();
            result.par_extend(plates.par_iter().flat_map_iter(Plate::compute));
        }
        result
    }
}

/// A plate whose law, size and cells are chosen.
struct Plate {
    law: &'static str,
    problem: ClampedPlate,
    cells: [usize; 2],
}

/// What became of a plate at one stretch.
struct StretchResult {
    law: &'static str,
    climbed: Result<ClimbSolution, Error>,
    /// Distance to the direct method's field over the discretisation error, where there are both.
    share: Option<f64>,
    /// Whether the direct method has a field.
    direct: bool,
    /// The plate and the stretch, for messages.
    position: String,
}

impl Plate {
    fn compute(&self) -> Vec<StretchResult> {
        let settings = ClimbSettings::FAST;
        let mut climb = Climb::even(&self.problem, self.cells, DifferenceScheme::Gauss, settings);
        let direct = self.direct();
        let stretches = self.problem.stretches.iter().enumerate();
        let result = |(step, stretch): (usize, &f64)| {
            let climbed = climb.correct(*stretch);
            let direct: Option<&State> = direct.get(step);
            let share = match (&climbed, direct) {
                (Ok(climbed), Some(direct)) => Some(share(climbed, &direct.displacement)),
                _ => None,
            };
            StretchResult {
                law: self.law,
                climbed,
                share,
                direct: direct.is_some(),
                position: self.describe(*stretch),
            }
        };
        stretches.map(result).collect()
    }

    /// The fields of the same equations by Newton's method from stretch to stretch, as far as there are any.
    fn direct(&self) -> Vec<State> {
        let mesh = Mesh::plate(self.problem.size, self.cells, CellShape::Quad4);
        let energy = DifferenceScheme::Gauss.energy(&self.problem, &mesh);
        let model = self.problem.on(&mesh, &energy);
        let result = model.solve(&self.problem.stretches, NEWTON, &|_| ());
        result.unwrap_or_else(|end| end.states)
    }

    fn describe(&self, stretch: f64) -> String {
        let ([length, width], [along, across]) = (self.problem.size, self.cells);
        format!(
            "{}, {length} × {width} mm, {along} × {across} cells, {}",
            self.law,
            ClampedPlate::describe_step(stretch)
        )
    }
}

/// Root mean square distance of a climbed field to another one over its discretisation error.
fn share(climbed: &ClimbSolution, direct: &[f64]) -> f64 {
    let field = climbed.field.to_nodes();
    let squares = field.iter().zip(direct).map(|(a, b)| (a - b).powi(2));
    let distance = (squares.sum::<f64>() / (0.5 * direct.len() as f64)).sqrt();
    distance / climbed.discretisation_error
}

fn outcome(result: &[StretchResult]) -> Outcome {
    let lost = result.iter();
    let lost = lost.filter(|result| result.direct && result.climbed.is_err());
    let missing = "plates where the direct method converges and the climb does not";
    let distance = "largest distance to the direct method's field over the discretisation error";
    let explanation = "What each climb started from, and the largest distance between its field and that of Newton's method \
                       on the same equations (root mean square over the nodes), relative to the discretisation error that \
                       the climb states:";
    let mut blocks = vec![Block::paragraph(explanation), table_of_laws(result)];
    let positions = lost
        .clone()
        .map(|lost| format!("No field from the climb: {}", lost.position));
    blocks.extend(positions.map(Block::paragraph));
    Outcome {
        checks: vec![
            check(missing, "–", lost.count() as f64)
                .at_most(0.0, "result independent of the start"),
            check(distance, "–", worst_share(result.iter())).at_most(0.1, "the same equations"),
        ],
        blocks,
        ..Outcome::default()
    }
}

/// The largest share, one that is not a number where no field can be compared.
fn worst_share<'a>(result: impl Iterator<Item = &'a StretchResult>) -> f64 {
    let shares = result.filter_map(|result| result.share);
    shares.reduce(larger).unwrap_or(f64::NAN)
}

/// A row for each law: how often each start led to the field, and the largest share.
fn table_of_laws(result: &[StretchResult]) -> Block {
    let mut laws: Vec<&str> = result.iter().map(|result| result.law).collect();
    laws.dedup();
    let row = |law: &&str| {
        let of_law = || result.iter().filter(|result| result.law == *law);
        let mut starts = BTreeMap::new();
        for climbed in of_law().filter_map(|result| result.climbed.as_ref().ok()) {
            let by_path = if climbed.provenance.by_load_path.is_empty() {
                ""
            } else {
                ", finer grids by load steps"
            };
            *starts
                .entry(format!("{}{by_path}", climbed.provenance.start))
                .or_insert(0) += 1;
        }
        let starts: Vec<String> = starts
            .iter()
            .map(|(start, count)| format!("{start}: {count}"))
            .collect();
        let neither = of_law().filter(|result| !result.direct).count();
        vec![
            (*law).to_owned(),
            of_law().count().to_string(),
            starts.join("; "),
            neither.to_string(),
            number(worst_share(of_law())),
        ]
    };
    let head = "law | plates | start | direct method without a field | largest distance over discretisation error";
    table(head, laws.iter().map(row))
}
