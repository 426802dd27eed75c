//! The publication's last claim: results of other methods are smoothed.
//!
//! The data come from converged finite elements on another mesh, never from the corrector's own equations.

use std::path::Path;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::plate::{CORRECTOR, Plate};
use super::{Check, Claim, Outcome, Prepared, Progress, Wanted, marked_line, number};
use crate::compare::{departure_percent, displacement_percent};
use crate::corrector::plate::KnownConditions;
use crate::corrector::{Corrector, CorrectorSettings, Linear, PlateCorrector};
use crate::document::{Bound, Section};
use crate::error::{Error, SolveFault};
use crate::finite_element::Element;
use crate::mass_spring::MassSpring;
use crate::mesh::{Mesh, Side};
use crate::output::picture::lines::{Axis, LineChart};
use crate::results::Block;
use crate::units::Dimension;

struct Settings {
    plate: Plate,
    coarse: [usize; 2],
    noise: Vec<f64>,
    seeds: u64,
    /// The largest noise whose correction has to reach the limit, in mm.
    checked_up_to: f64,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Prepared {
    let plate = Plate::read(root, folder);
    let section = root.section("data");
    let settings = Settings {
        plate,
        coarse: section.count_pair("coarse_cells", 1, 400).unwrap_or([1, 1]),
        noise: section.quantities("noise", Dimension::Length, Bound::Positive),
        seeds: section.count("seeds", 1, 10_000) as u64,
        checked_up_to: section.quantity("checked_up_to", Dimension::Length, Bound::Positive),
    };
    if settings.noise.is_empty() {
        section.fault("noise", "needs at least one value", "such as [\"0.5 mm\"]");
    }
    section.unknown_keys();
    Box::new(move |progress| compute(&settings, progress))
}

const UNKNOWN_GRIPS: KnownConditions = KnownConditions {
    grips: false,
    free_edges: true,
};

/// What all data are made of and compared with.
struct Fields {
    lattice: MassSpring,
    /// The uncorrected mass-spring field, where corrections of noisy data begin.
    start: Vec<f64>,
    reference: Vec<f64>,
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let plate = &settings.plate;
    progress("reference");
    let lattice = plate.lattice();
    let fields = Fields {
        start: plate.solve(&lattice)?.displacement,
        reference: plate.reference(&lattice)?,
        lattice,
    };
    let mut outcome = Outcome::default();
    let (mut rows, [known, unknown]) = coarse(settings, &fields, &mut outcome)?;
    let mut points = Vec::new();
    for noise in &settings.noise {
        let summary = |grips| noisy(settings, &fields, *noise, grips, progress);
        let (rigid, free) = (summary(Grips::Rigid)?, summary(Grips::Unknown)?);
        let row = |grips, summary: &Summary| {
            summary.row(&format!(
                "noise of {noise} mm, {grips}, median of {} seeds",
                settings.seeds
            ))
        };
        rows.extend([
            row("rigid grips that moved unknown ways", &rigid),
            row("grips unknown", &free),
        ]);
        points.push([*noise, rigid.before, rigid.after, free.after]);
        if *noise > settings.checked_up_to {
            continue;
        }
        let seeds = settings.seeds;
        outcome.checks.extend([
            rigid.check(*noise, "rigid grips", seeds),
            free.check(*noise, "grips unknown", seeds),
        ]);
        outcome.claims.push(Claim {
            claim: "The technique smooths results of other methods",
            reproduced: format!(
                "noise of {noise} mm: {} % becomes {} % in relative L2 with rigid grips, {} % with unknown ones; \
                 of a coarse finite-element field's departure {} % are corrected with known grips, {} % with rigid unknown ones",
                number(rigid.before), number(rigid.after), number(free.after), number(known),
                number(unknown)
            ),
        });
    }
    let head = [
        "data",
        "before [%]",
        "after [%]",
        "correction [%]",
        "seeds converged",
    ];
    outcome.blocks = vec![
        Block::Paragraph(EXPLANATION.into()),
        Block::table(&head, rows),
    ];
    outcome.figures.push(super::figure(
        "smoothing.png",
        "Noisy fields before and after.",
        &chart(&points),
    ));
    Ok(outcome)
}

const EXPLANATION: &str = "Relative L2 distance to converged finite elements, weighted by area; for the coarse \
    finite elements that of the departure from affine, for noisy fields that of the displacement. Corrections of noisy \
    fields begin at the uncorrected mass-spring field of the stretched plate, never at the noisy data. A seed whose \
    correction does not converge counts as the worst: where nothing is known of the grips, noise that is a good part \
    of a cell's size nearly folds the cells there.";

/// A coarse finite-element field corrected on the lattice's nodes, once with everything known and once with
/// rigid grips that moved unknown ways: two rows, and the two corrections in %.
fn coarse(
    settings: &Settings,
    fields: &Fields,
    outcome: &mut Outcome,
) -> Result<(Vec<Vec<String>>, [f64; 2]), Error> {
    let (plate, lattice) = (&settings.plate, &fields.lattice);
    let affine = plate.problem.affine(&lattice.mesh, plate.stretch());
    let (model, solution) = plate.finite_elements(settings.coarse, Element::Q1)?;
    let data = model
        .mesh
        .displacement_on(&solution.displacement, &lattice.mesh);
    let departure =
        |field: &[f64]| departure_percent(&lattice.mesh, field, &fields.reference, &affine);
    let known = plate.corrected(lattice, &data)?.solution.displacement;
    let plate_corrector = plate.corrector(lattice);
    let corrector = grips_corrector(
        &plate_corrector,
        &lattice.mesh,
        plate.stretch(),
        Grips::Rigid,
        CORRECTOR,
    );
    let rigid = corrector
        .correct(&data, &data)
        .map_err(|fault| plate.fault(fault))?;
    let before = departure(&data);
    let [nx, ny] = settings.coarse;
    let row = |grips: &str, after: f64| {
        let correction = 100.0 * (1.0 - after / before);
        let data = format!("bilinear finite elements, {nx} × {ny} cells, {grips}");
        vec![
            data,
            number(before),
            number(after),
            number(correction),
            "–".into(),
        ]
    };
    let (known, rigid) = (departure(&known), departure(rigid.field()));
    let corrections = [known, rigid].map(|after| 100.0 * (1.0 - after / before));
    let quantity = "coarse finite elements, grips known: correction of the departure";
    outcome.checks.push(Check::new(
        quantity,
        "%",
        Wanted::AtLeast(80.0),
        "publication: above 80 %",
        corrections[0],
    ));
    let rows = vec![
        row("grips known (the data have no say)", known),
        row("rigid grips that moved unknown ways", rigid),
    ];
    Ok((rows, corrections))
}

/// What is known of the grips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Grips {
    /// Each moved as a whole, by an unknown amount.
    Rigid,
    /// Nothing.
    Unknown,
}

/// Medians over all seeds; a seed that did not converge counts as the worst of all.
struct Summary {
    before: f64,
    after: f64,
    correction: f64,
    converged: usize,
}

/// A correction is done when the field would move by no more than this share of the noise.
const MOVEMENT: f64 = 0.01;
/// Seeds that need more steps than this are given up.
const MOST_STEPS: usize = 30;

impl Summary {
    fn row(&self, data: &str) -> Vec<String> {
        let numbers = [self.before, self.after, self.correction].map(number);
        let mut row = vec![data.to_owned()];
        row.extend(numbers);
        row.push(self.converged.to_string());
        row
    }

    fn check(&self, noise: f64, grips: &str, seeds: u64) -> Check {
        let quantity = format!("noise of {noise} mm, {grips}: correction, median of {seeds} seeds");
        Check::new(
            quantity,
            "%",
            Wanted::AtLeast(80.0),
            "publication: above 80 %",
            self.correction,
        )
    }
}

fn noisy(
    settings: &Settings,
    fields: &Fields,
    noise: f64,
    grips: Grips,
    progress: Progress,
) -> Result<Summary, Error> {
    progress(&format!("noise of {noise} mm, {grips:?} grips"));
    let plate = &settings.plate;
    let Fields {
        lattice,
        start,
        reference,
    } = fields;
    let correct = |seed: u64| -> Result<[f64; 2], Error> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let draw = |random: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(random) };
        let data: Vec<f64> = reference
            .iter()
            .map(|u| u + noise * draw(&mut random))
            .collect();
        let largest = reference.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        let limits = CorrectorSettings {
            movement: MOVEMENT * noise / largest,
            max_steps: MOST_STEPS,
            ..CORRECTOR
        };
        let plate_corrector = plate.corrector(lattice);
        let corrector = grips_corrector(
            &plate_corrector,
            &lattice.mesh,
            plate.stretch(),
            grips,
            limits,
        );
        let deviation = |field: &[f64]| displacement_percent(&lattice.mesh, field, reference);
        match corrector.correct(&data, start) {
            Ok(correction) => Ok([deviation(&data), deviation(correction.field())]),
            Err(SolveFault::Stalled { .. } | SolveFault::Inverted { .. }) => {
                Ok([deviation(&data), f64::INFINITY])
            }
            Err(fault) => Err(plate.fault(fault)),
        }
    };
    let seeds = 0..settings.seeds;
    let pairs = seeds
        .into_par_iter()
        .map(correct)
        .collect::<Result<Vec<_>, Error>>()?;
    let median = |which: fn(&[f64; 2]) -> f64| crate::statistics::median(pairs.iter().map(which));
    Ok(Summary {
        before: median(|pair| pair[0]),
        after: median(|pair| pair[1]),
        // The lower one of the middle two, as the deviation is the upper one.
        correction: -median(|pair| 100.0 * (pair[1] / pair[0] - 1.0)),
        converged: pairs.iter().filter(|pair| pair[1].is_finite()).count(),
    })
}

/// The corrector with equilibrium, free edges, and what is known of the grips.
fn grips_corrector<'a>(
    plate: &'a PlateCorrector<'_>,
    mesh: &Mesh,
    stretch: f64,
    grips: Grips,
    settings: CorrectorSettings,
) -> Corrector<'a> {
    let mut conditions = plate.conditions(stretch, UNKNOWN_GRIPS);
    if grips == Grips::Rigid {
        conditions.push(Box::new(rigid_grips(mesh)));
    }
    Corrector::new(conditions, vec![1.0; 2 * mesh.nodes.len()], settings)
}

/// Each grip moves as a whole, without turning.
fn rigid_grips(mesh: &Mesh) -> Linear {
    let grips = [Side::Left, Side::Right];
    let groups = grips.into_iter().flat_map(|side| {
        [0, 1].map(|axis| {
            let nodes = (0..mesh.nodes.len()).filter(|node| mesh.on(side, *node));
            nodes.map(|node| 2 * node + axis).collect::<Vec<_>>()
        })
    });
    Linear::together(
        "rigid grips",
        2 * mesh.nodes.len(),
        &groups.collect::<Vec<_>>(),
    )
}

fn chart(points: &[[f64; 4]]) -> LineChart {
    let line = |label, which, colour| marked_line(points, which, label, colour);
    LineChart {
        title: "Noisy fields smoothed".into(),
        x: Axis::linear("noise at every node [mm]"),
        y: Axis::logarithmic("deviation, relative L2 [%]"),
        lines: vec![
            line("before", 1, [213, 94, 0]),
            line("after, grips unknown", 3, [0, 158, 115]),
            line("after, rigid grips", 2, [0, 114, 178]),
        ],
        band: None,
    }
}
