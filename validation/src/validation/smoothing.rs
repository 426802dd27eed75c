//! The publication's last claim: results of other methods are smoothed.
//!
//! The data come from converged finite elements on another mesh, never from the corrector's own equations.

use std::fmt;
use std::path::Path;

use rayon::prelude::*;

use super::case::{
    Block, Check, Claim, Computation, Figure, Outcome, Progress, check, largest, line,
    normal_numbers, number, removed_percent, row, section, table,
};
use super::plate::{CORRECTOR, Plate};
use crate::compare::{departure_percent, displacement_percent};
use crate::corrector::plate::KnownConditions;
use crate::corrector::{Corrector, CorrectorSettings, Linear, PlateCorrector};
use crate::document::{Bound, Section};
use crate::error::{Error, SolveFault};
use crate::finite_element::Element;
use crate::mass_spring::MassSpring;
use crate::mesh::{Mesh, Side};
use crate::results::{Axis, LineChart, Stroke};
use crate::statistics;
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
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let plate = Plate::read(root, folder);
    let settings = section(root, "data", |section| Settings {
        plate,
        coarse: section.count_pair("coarse_cells", 1, 400).unwrap_or([1, 1]),
        noise: super::plate::read_noise(section),
        seeds: section.count("seeds", 1, 10_000) as u64,
        checked_up_to: section.quantity("checked_up_to", Dimension::Length, Bound::Positive),
    });
    Box::new(move |progress| compute(&settings, progress))
}

/// What all data are made of and compared with.
struct Fields<'a> {
    settings: &'a Settings,
    lattice: MassSpring,
    /// The uncorrected mass-spring field, where corrections of noisy data begin.
    start: Vec<f64>,
    reference: Vec<f64>,
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let plate = &settings.plate;
    progress.tell("reference");
    let lattice = plate.lattice();
    let fields = Fields {
        settings,
        start: plate.solve(&lattice)?.displacement,
        reference: plate.reference(&lattice)?,
        lattice,
    };
    let coarse = fields.coarse()?;
    let mut outcome = Outcome {
        checks: vec![coarse.check()],
        ..Outcome::default()
    };
    let mut rows = coarse.rows(settings.coarse);
    let mut noisy = Vec::new();
    for noise in &settings.noise {
        let actual = Noisy {
            noise: *noise,
            seeds: settings.seeds,
            rigid: fields.noisy(*noise, Grips::Rigid, progress)?,
            unknown: fields.noisy(*noise, Grips::Unknown, progress)?,
        };
        rows.extend(actual.rows());
        if *noise <= settings.checked_up_to {
            outcome.checks.extend(actual.checks());
            outcome.claims.push(actual.claim(&coarse));
        }
        noisy.push(actual);
    }
    let head = "data | before [%] | after [%] | correction [%] | seeds converged";
    outcome.blocks = vec![Block::paragraph(EXPLANATION), table(head, rows)];
    outcome.figures.push(picture(&noisy));
    Ok(outcome)
}

const EXPLANATION: &str = "Relative L2 distance to converged finite elements, weighted by area: of the departure from affine \
    for the coarse finite elements, of the displacement for noisy fields. Corrections of noisy fields start from the \
    uncorrected mass-spring field of the stretched plate, never from the noisy data. A seed whose correction does not \
    converge counts as the worst: where the grips are unknown, noise comparable with the cell size nearly folds the cells \
    there.";

/// What is known of the grips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Grips {
    /// Each moved as a whole, by an unknown amount.
    Rigid,
    /// Nothing.
    Unknown,
}

impl fmt::Display for Grips {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rigid => "rigid grips",
            Self::Unknown => "grips unknown",
        })
    }
}

/// The deviation of a coarse finite-element field before and after its corrections, in %.
struct Coarse {
    before: f64,
    /// With everything known.
    known: f64,
    /// With rigid grips of unknown motion.
    rigid: f64,
}

impl Coarse {
    fn rows(&self, [nx, ny]: [usize; 2]) -> Vec<Vec<String>> {
        let row = |grips: &str, after: f64| {
            let data = format!("bilinear finite elements, {nx} × {ny} cells, {grips}");
            let numbers = [self.before, after, removed_percent(self.before, after)];
            let mut row = row(data, numbers);
            row.push("–".into());
            row
        };
        vec![
            row(
                "grips known (the data do not affect the result)",
                self.known,
            ),
            row("rigid grips of unknown motion", self.rigid),
        ]
    }

    fn check(&self) -> Check {
        let quantity = "coarse finite elements, grips known: correction of the departure";
        let removed = removed_percent(self.before, self.known);
        check(quantity, "%", removed).at_least(80.0, "publication: above 80 %")
    }
}

/// Medians over all seeds; a seed that did not converge counts as the worst of all.
struct Summary {
    grips: Grips,
    before: f64,
    after: f64,
    correction: f64,
    converged: usize,
}

/// Fields with one noise in mm, corrected with both kinds of grips.
struct Noisy {
    noise: f64,
    seeds: u64,
    rigid: Summary,
    unknown: Summary,
}

impl Noisy {
    fn rows(&self) -> [Vec<String>; 2] {
        [&self.rigid, &self.unknown].map(|summary| {
            let grips = match summary.grips {
                Grips::Rigid => "rigid grips of unknown motion",
                Grips::Unknown => "grips unknown",
            };
            let (noise, seeds) = (self.noise, self.seeds);
            let data = format!("noise of {noise} mm, {grips}, median of {seeds} seeds");
            let mut row = row(data, [summary.before, summary.after, summary.correction]);
            row.push(summary.converged.to_string());
            row
        })
    }

    fn checks(&self) -> [Check; 2] {
        [&self.rigid, &self.unknown].map(|summary| {
            let (noise, seeds, grips) = (self.noise, self.seeds, summary.grips);
            let what = format!("noise of {noise} mm, {grips}: correction, median of {seeds} seeds");
            check(what, "%", summary.correction).at_least(80.0, "publication: above 80 %")
        })
    }

    fn claim(&self, coarse: &Coarse) -> Claim {
        let of_coarse = |after| number(removed_percent(coarse.before, after));
        Claim {
            claim: "The technique smooths results of other methods",
            reproduced: format!(
                "noise of {} mm: {} % becomes {} % in relative L2 with rigid grips, {} % with unknown ones; \
                 of a coarse finite-element field's departure {} % are corrected with known grips, {} % with rigid unknown ones",
                self.noise,
                number(self.rigid.before),
                number(self.rigid.after),
                number(self.unknown.after),
                of_coarse(coarse.known),
                of_coarse(coarse.rigid)
            ),
        }
    }
}

/// A correction is done when the field would move by no more than this share of the noise.
const MOVEMENT: f64 = 0.01;
/// Seeds that need more steps than this are given up.
const MOST_STEPS: usize = 30;

impl Fields<'_> {
    /// A coarse finite-element field corrected on the lattice's nodes.
    fn coarse(&self) -> Result<Coarse, Error> {
        let (plate, mesh) = (&self.settings.plate, &self.lattice.mesh);
        let affine = plate.problem.affine(mesh, plate.stretch());
        let (model, solution) = plate.finite_elements(self.settings.coarse, Element::Q1)?;
        let data = model.mesh.displacement_on(&solution.displacement, mesh);
        let departure = |field: &[f64]| departure_percent(mesh, field, &self.reference, &affine);
        let known = plate.corrected(&self.lattice, &data)?.state.displacement;
        let rigid = self.correct(&data, &data, Grips::Rigid, CORRECTOR);
        let rigid = rigid.map_err(|fault| plate.fault(fault))?;
        Ok(Coarse {
            before: departure(&data),
            known: departure(&known),
            rigid: departure(&rigid),
        })
    }

    /// Noisy fields of all seeds, corrected.
    fn noisy(&self, noise: f64, grips: Grips, progress: Progress) -> Result<Summary, Error> {
        progress.tell(&format!("noise of {noise} mm, {grips}"));
        let seeds = (0..self.settings.seeds).into_par_iter();
        let pairs = seeds.map(|seed| self.one_seed(noise, grips, seed));
        let pairs = pairs.collect::<Result<Vec<_>, Error>>()?;
        let median = |which: fn(&[f64; 2]) -> f64| statistics::median(pairs.iter().map(which));
        Ok(Summary {
            grips,
            before: median(|pair| pair[0]),
            after: median(|pair| pair[1]),
            // The lower one of the middle two, as the deviation is the upper one.
            correction: -median(|pair| 100.0 * (pair[1] / pair[0] - 1.0)),
            converged: pairs.iter().filter(|pair| pair[1].is_finite()).count(),
        })
    }

    /// The deviation of a noisy field before and after its correction, in %; infinite where that does not converge.
    fn one_seed(&self, noise: f64, grips: Grips, seed: u64) -> Result<[f64; 2], Error> {
        let exact = self.reference.iter().zip(normal_numbers(seed));
        let data: Vec<f64> = exact.map(|(u, draw)| u + noise * draw).collect();
        let limits = CorrectorSettings {
            movement: MOVEMENT * noise / largest(self.reference.iter().copied()),
            max_steps: MOST_STEPS,
            ..CORRECTOR
        };
        let mesh = &self.lattice.mesh;
        let deviation = |field: &[f64]| displacement_percent(mesh, field, &self.reference);
        let after = match self.correct(&data, &self.start, grips, limits) {
            Ok(field) => deviation(&field),
            Err(SolveFault::Stalled { .. } | SolveFault::Inverted { .. }) => f64::INFINITY,
            Err(fault) => return Err(self.settings.plate.fault(fault)),
        };
        Ok([deviation(&data), after])
    }

    /// Imposes equilibrium, free edges, and what is known of the grips on data.
    fn correct(
        &self,
        data: &[f64],
        start: &[f64],
        grips: Grips,
        limits: CorrectorSettings,
    ) -> Result<Vec<f64>, SolveFault> {
        let plate = self.settings.plate.corrector(&self.lattice);
        let corrector = self.grips_corrector(&plate, grips, limits);
        Ok(corrector.correct(data, start)?.field().to_vec())
    }

    fn grips_corrector<'a>(
        &self,
        plate: &'a PlateCorrector<'_>,
        grips: Grips,
        limits: CorrectorSettings,
    ) -> Corrector<'a> {
        let known = KnownConditions {
            grips: false,
            free_edges: true,
        };
        let mesh = &self.lattice.mesh;
        let mut conditions = plate.conditions(self.settings.plate.stretch(), known);
        if grips == Grips::Rigid {
            conditions.push(Box::new(rigid_grips(mesh)));
        }
        Corrector::new(conditions, vec![1.0; 2 * mesh.nodes.len()], limits)
    }
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
    let groups: Vec<_> = groups.collect();
    Linear::together("rigid grips", 2 * mesh.nodes.len(), &groups)
}

fn picture(noisy: &[Noisy]) -> Figure {
    let of = |value: fn(&Noisy) -> f64| noisy.iter().map(value).collect::<Vec<_>>();
    let line = |label, deviation, colour| {
        let (noise, deviation) = (of(|noisy| noisy.noise), of(deviation));
        line(label, &noise, &deviation, colour, Stroke::Marked)
    };
    let (x, y) = (
        "noise at every node [mm]",
        Axis::logarithmic("deviation, relative L2 [%]"),
    );
    let lines = vec![
        line("before", |noisy| noisy.rigid.before, [213, 94, 0]),
        line(
            "after, grips unknown",
            |noisy| noisy.unknown.after,
            [0, 158, 115],
        ),
        line(
            "after, rigid grips",
            |noisy| noisy.rigid.after,
            [0, 114, 178],
        ),
    ];
    let chart = LineChart::new("Noisy fields smoothed", x, y, lines);
    Figure::new("smoothing.png", "Noisy fields before and after.", chart)
}
