//! How often the 95 % intervals hold the truth, or the verdict says that they mean nothing: white noise, noise correlated over
//! some spacings of the markers, and equations that are wrong in law, thickness or edge.

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;

use super::coverage_trial::{CoverageTrial, Shares};
use super::subject::{CorrelatedDraws, Data, Subject, first_parameter, unknown_grips};
use super::trials::TARGET;
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::estimation::{
    EdgeCondition, FieldEstimate, Knowledge, RegressedLaw, Specimen, estimate,
};
use crate::markers::Marker;
use crate::material::Card;
use crate::mesh::{CellShape, Grid, Mesh};
use crate::results::Block;
use crate::studies::card::read_card;
use crate::units::Dimension;
use crate::validation::case::{
    Check, Computation, Outcome, Progress, check, normal_numbers_of_stream, number, section, table,
};
use crate::validation::plate::{Plate, read_noise};

/// Correlation lengths in spacings of the markers.
const LENGTHS: [f64; 3] = [1.0, 3.0, 6.0];

/// The law that is wrong.
const WRONG_LAW: &str = "neo-hooke";

/// What part of the plate's length the estimate takes for all of it where an edge is wrong.
const PART: f64 = 0.7;

struct Settings {
    data: Data,
    noise: f64,
    seeds: u64,
    force_deviation: f64,
    wrong_thickness: f64,
    law: Option<RegressedLaw>,
    wrong_law: Option<RegressedLaw>,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let law = read_card(&root.section("plate"), folder)
        .as_ref()
        .and_then(first_parameter);
    let plate = Plate::read(root, folder);
    let settings = section(root, "data", |section| {
        let ratio = |key| section.quantity(key, Dimension::Ratio, Bound::Positive);
        Settings {
            data: Data::read(plate, root, section),
            noise: read_noise(section).first().copied().unwrap_or_default(),
            seeds: section.count("seeds", 1, 10_000) as u64,
            force_deviation: ratio("force_deviation"),
            wrong_thickness: ratio("wrong_thickness"),
            law,
            wrong_law: Card::load(WRONG_LAW, folder)
                .ok()
                .as_ref()
                .and_then(first_parameter),
        }
    });
    Box::new(move |progress| compute(&settings, progress))
}

/// What is wrong with the equations.
#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    Nothing,
    Law,
    Thickness,
    Edge,
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let strip = Subject::strip(&settings.data)?.with_markers_inside(settings.data.markers);
    let plate = Subject::plate(&settings.data)?.with_markers_inside(settings.data.markers);
    let white = (None, "white noise".to_owned(), Wrong::Nothing);
    let correlated = LENGTHS.map(|length| {
        let name = format!("noise correlated over {length} spacings");
        (Some(length), name, Wrong::Nothing)
    });
    let wrong = [
        (Wrong::Law, "wrong law"),
        (Wrong::Thickness, "wrong thickness"),
        (Wrong::Edge, "wrong edge"),
    ];
    let wrong = wrong.map(|(wrong, name)| (None, name.to_owned(), wrong));
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    for (length, name, wrong) in [white].into_iter().chain(correlated).chain(wrong) {
        progress.tell(&name);
        let subject = if wrong == Wrong::Edge { &plate } else { &strip };
        let draws = CorrelatedDraws::new(subject.positions(), length);
        let trial = |seed: u64| settings.trial(subject, &draws, seed, wrong);
        let all: Result<Vec<CoverageTrial>, Error> =
            (0..settings.seeds).into_par_iter().map(trial).collect();
        let shares = Shares::of(&all?);
        rows.push(row(&name, &shares));
        let case_checks = checks(&name, &shares, wrong == Wrong::Nothing);
        outcome.checks.extend(case_checks);
    }
    outcome.blocks = vec![Block::paragraph(EXPLANATION), table(HEAD, rows)];
    Ok(outcome)
}

const HEAD: &str = "data | explained [%] | with correlated noise [%] | undecided [%] | not explained [%] | displacements [%] | stresses [%] | \
                    stresses near the hole [%] | force [%] | parameter [%]";

const EXPLANATION: &str = "Marker displacements from converged finite elements on a strip with a hole (for the wrong edge, \
    on a plate); the outermost markers lie half a spacing inside the edges, and the grips are unknown. After the verdicts \
    come the shares of true values within their 95 % intervals, over the seeds that have intervals: displacements of all nodes, stresses more than a fifth of the width from a corner, stresses within 1.6 radii \
    of the hole's centre, the force and the law's first parameter, which is estimated in a second correction with the force \
    measured to 1 %. The wrong law is neo-Hookean, with its parameter fitted to the force; the wrong thickness is combined \
    with the right law and a measured force; the wrong edge is a rigid grip stated at 70 % of the plate. Noise correlated \
    over three spacings or more leaves few independent values of these 209 markers: with fewer than a hundred of them the data \
    refute the equations only where an alternative is likelier by far, else they cannot judge, and intervals include the widest \
    correlation that they allow.";

fn row(name: &str, shares: &Shares) -> Vec<String> {
    let answers = shares.answers.map(number);
    let none = || "none".to_owned();
    let covered = shares
        .covered()
        .map(|share| share.map_or_else(none, number));
    [vec![name.to_owned()], answers.to_vec(), covered.to_vec()].concat()
}

/// Of the right equations a coverage of at least 90 %, of wrong ones a verdict of "not explained" in 95 % of all seeds.
fn checks(name: &str, shares: &Shares, right: bool) -> Vec<Check> {
    let [.., not] = shares.answers;
    let refuted = check(format!("{name}: judged not explained"), "%", not);
    if !right {
        return vec![refuted.at_least(95.0, TARGET)];
    }
    let what = [
        "displacements",
        "stresses",
        "stresses near the hole",
        "forces",
        "parameters",
    ];
    let held = what.into_iter().zip(shares.covered());
    let held = held.filter_map(|(what, share)| Some((what, share?)));
    let check = |(what, share): (&str, f64)| {
        let what = format!("{name}: {what} in their 95 % intervals");
        check(what, "%", share).at_least(90.0, TARGET)
    };
    let held = held.map(check);
    std::iter::once(refuted.at_most(5.0, TARGET))
        .chain(held)
        .collect()
}

impl Settings {
    fn trial(
        &self,
        subject: &Subject,
        draws: &CorrelatedDraws,
        seed: u64,
        wrong: Wrong,
    ) -> Result<CoverageTrial, Error> {
        let mut markers = subject.exact_markers();
        draws.disturb(&mut markers, self.noise, seed);
        let draw = normal_numbers_of_stream(seed, 7).next().unwrap_or(0.0);
        let force = subject.measured_force(self.force_deviation, draw);
        let with_force = |law: Option<&RegressedLaw>| Knowledge {
            forces: vec![force.clone()],
            law: law.cloned(),
            ..unknown_grips()
        };
        let thickness = self.data.plate.problem.thickness;
        let specimen = Specimen {
            mesh: &subject.mesh,
            laws: Arc::clone(&subject.truth.law).into(),
            thickness,
        };
        let actual = match wrong {
            Wrong::Nothing => {
                let actual = estimate(&specimen, &markers, &unknown_grips())?;
                let law = self.law.as_ref().map(|law| law.scaled(1.1));
                let fitted = estimate(&specimen, &markers, &with_force(law.as_ref()))?;
                let truth = self.law.as_ref().map(|law| law.start()[0]);
                let radius = self.data.radius;
                return Ok(CoverageTrial::new(subject, radius, &actual, &fitted, truth));
            }
            Wrong::Law => estimate(&specimen, &markers, &with_force(self.wrong_law.as_ref()))?,
            Wrong::Thickness => {
                let thickness = self.wrong_thickness * thickness;
                let specimen = Specimen {
                    thickness,
                    ..specimen
                };
                estimate(&specimen, &markers, &with_force(None))?
            }
            Wrong::Edge => self.with_wrong_edge(specimen, markers)?,
        };
        Ok(CoverageTrial::verdict(&actual))
    }

    /// The plate as if it ended at a rigid grip before its end: it is narrower there than at its grips, so that this line across it has
    /// not kept its length.
    fn with_wrong_edge(
        &self,
        specimen: Specimen,
        mut markers: Vec<Marker>,
    ) -> Result<FieldEstimate, Error> {
        let [length, width] = self.data.plate.problem.size;
        let [along, across] = self.data.plate.cells;
        let cells = [(PART * along as f64) as usize, across];
        let grid = Grid::new([PART * length, width], cells, 2.0);
        let mesh = Mesh::of_grid(grid, CellShape::Quad9);
        markers.retain(|marker| marker.position[0] < PART * length);
        let mut knowledge = unknown_grips();
        for (name, condition) in &mut knowledge.edges {
            if name == "right" {
                *condition = EdgeCondition::Rigid;
            }
        }
        let specimen = Specimen {
            mesh: &mesh,
            ..specimen
        };
        estimate(&specimen, &markers, &knowledge)
    }
}
