//! The known conditions decide: the same correction with more and more known conditions T.

use super::fields::{Fields, GRIPS};
use crate::corrector::plate::KnownConditions;
use crate::error::Error;
use crate::results::{Axis, Line, LineChart, Stroke};
use crate::validation::case::{
    Block, Check, Claim, Figure, Outcome, Progress, check, line, number, table,
};

/// Known conditions, and the line that shows them.
struct Ablation {
    name: &'static str,
    known: KnownConditions,
    colour: [u8; 3],
    stroke: Stroke,
}

const ABLATIONS: [Ablation; 4] = [
    Ablation {
        name: "none",
        known: KnownConditions {
            grips: false,
            free_edges: false,
        },
        colour: [150, 150, 150],
        stroke: Stroke::Marked,
    },
    Ablation {
        name: "grips",
        known: GRIPS,
        colour: [213, 94, 0],
        // Its line lies on that of the first one.
        stroke: Stroke::Dashed,
    },
    Ablation {
        name: "traction-free edges",
        known: KnownConditions {
            grips: false,
            free_edges: true,
        },
        colour: [0, 158, 115],
        stroke: Stroke::Marked,
    },
    Ablation {
        name: "grips and traction-free edges",
        known: KnownConditions::ALL,
        colour: [0, 114, 178],
        stroke: Stroke::Marked,
    },
];

/// A correction with some known conditions; deviations in %.
struct Correction {
    ablation: Ablation,
    /// Departure from affine of each iterate.
    departures: Vec<f64>,
    /// Deviation of the displacement at the end.
    displacement: f64,
    /// Departure from affine of the data.
    before: f64,
}

impl Correction {
    fn new(ablation: Ablation, fields: &Fields) -> Result<Self, Error> {
        let corrected = fields.correct(&fields.uncorrected, ablation.known)?;
        Ok(Self {
            ablation,
            departures: fields.departures(&corrected),
            displacement: fields.displacement(&corrected.state.displacement),
            before: fields.departure(&fields.uncorrected),
        })
    }

    fn after(&self) -> f64 {
        self.departures[self.departures.len() - 1]
    }

    fn row(&self) -> Vec<String> {
        let at = |step: usize| {
            let departure = self.departures.get(step);
            departure.map_or("–".into(), |value| number(*value))
        };
        vec![
            self.ablation.name.to_owned(),
            number(self.before),
            at(1),
            at(2),
            number(self.after()),
            number(self.displacement),
            (self.departures.len() - 1).to_string(),
        ]
    }

    fn line(&self) -> Line {
        let steps: Vec<f64> = (0..self.departures.len()).map(|step| step as f64).collect();
        let Ablation {
            name,
            colour,
            stroke,
            ..
        } = self.ablation;
        line(name, &steps, &self.departures, colour, stroke)
    }

    fn checks(&self) -> Vec<Check> {
        let displacement = "corrected displacement compared with converged finite elements";
        let remaining = "remaining departure error without the traction-free edges";
        match self.ablation.known {
            KnownConditions::ALL => vec![
                check(displacement, "%", self.displacement).at_most(0.1, "publication: below 5 %"),
                check("corrected departure from affine", "%", self.after())
                    .at_most(1.0, "design of the corrector"),
            ],
            GRIPS => {
                let remaining = check(remaining, "%", 100.0 * self.after() / self.before);
                vec![remaining.at_least(50.0, "T decides")]
            }
            _ => Vec::new(),
        }
    }

    fn claim(&self) -> Claim {
        let [before, after, displacement] =
            [self.before, self.after(), self.displacement].map(number);
        Claim {
            claim: "Example 1, Part II: the corrected plate is within 5 % of non-linear finite elements",
            reproduced: format!(
                "departure from affine {before} % before, {after} % after; displacement within {displacement} %"
            ),
        }
    }
}

/// The corrections of the springs' field with each set of known conditions.
pub fn compare(fields: &Fields, progress: Progress, outcome: &mut Outcome) -> Result<(), Error> {
    let mut corrections = Vec::new();
    for ablation in ABLATIONS {
        progress.tell(&format!("known: {}", ablation.name));
        corrections.push(Correction::new(ablation, fields)?);
    }
    let checks = corrections.iter().flat_map(Correction::checks);
    outcome.checks.extend(checks);
    outcome
        .claims
        .push(corrections[corrections.len() - 1].claim());
    let head = "known conditions T | before [%] | after one step [%] | after two [%] | at the end [%] | \
                displacement at the end [%] | steps";
    let text = "Departure from affine: relative L2 distance to the converged finite elements, for the known conditions T \
                that are imposed in addition to equilibrium inside:";
    let rows = corrections.iter().map(Correction::row);
    outcome
        .blocks
        .extend([Block::paragraph(text), table(head, rows)]);
    let (x, y) = (
        "step",
        Axis::logarithmic("departure from affine, relative L2 [%]"),
    );
    let lines: Vec<Line> = corrections.iter().map(Correction::line).collect();
    outcome.figures.push(Figure::new(
        "plate_ablation.png",
        "Deviation of each iterate, by the known conditions T that are imposed.",
        LineChart::new("The known conditions decide", x, y, lines),
    ));
    Ok(())
}
