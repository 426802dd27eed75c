//! The clamped plate with equal and with graded cells.

use crate::error::Error;
use crate::finite_element::convergence::{Richardson, richardson};
use crate::finite_element::error_estimate::ErrorEstimate;
use crate::finite_element::recovery::Recovery;
use crate::finite_element::{Element, FiniteElements};
use crate::problem::{ClampedPlate, Measures};
use crate::validation::case::{Block, Check, Outcome, Progress, check, failed, number, table};
use crate::validation::finite_elements::{NEWTON, sheet};

pub const SIZE: [f64; 2] = [150.0, 50.0];
pub const STRETCH: f64 = 0.5;

/// The plate's force in N at this stretch by dolfinx, scikit-fem and FElupe, extrapolated.
const OTHER_CODES: f64 = 10.7125;

/// What is exact for the plate.
#[derive(Clone, Copy)]
pub struct Exact {
    /// In N.
    pub force: f64,
    /// In mJ.
    energy: f64,
}

/// One mesh of the plate.
struct Plate {
    describe: String,
    measures: Measures,
    estimate: ErrorEstimate,
}

/// An element on three meshes, each twice as fine as the one before.
struct Series {
    element: Element,
    grading: f64,
    plates: [Plate; 3],
}

/// Elements and gradings; the first is the best of them.
const SERIES: [(Element, f64); 4] = [
    (Element::Q2, 3.0),
    (Element::Q2, 1.0),
    (Element::Q1, 1.5),
    (Element::Q1, 1.0),
];

/// Plates with equal and with graded cells; the exact values from the best of them.
pub fn compare(coarsest: usize, outcome: &mut Outcome, progress: Progress) -> Result<Exact, Error> {
    let mut series = Vec::new();
    for (element, grading) in SERIES {
        progress.tell(&format!("plate, {}, grading {grading}", element.name()));
        series.push(Series::new(coarsest, element, grading)?);
    }
    let exact = Exact {
        force: series[0].limit(|measures| measures.force).extrapolated,
        energy: series[0].limit(|measures| measures.energy).extrapolated,
    };
    let force = check("plate, graded, extrapolated force", "N", exact.force);
    let source = "dolfinx, scikit-fem, FElupe, extrapolated";
    outcome.checks.push(force.equal(OTHER_CODES, 1e-4, source));
    outcome.checks.extend(series.iter().map(Series::check));
    outcome.blocks.extend(report(&series, exact));
    Ok(exact)
}

impl Series {
    fn new(coarsest: usize, element: Element, grading: f64) -> Result<Self, Error> {
        let plate = |finer| Plate::new(finer * coarsest, element, grading);
        Ok(Self {
            element,
            grading,
            plates: [plate(1)?, plate(2)?, plate(4)?],
        })
    }

    fn limit(&self, value: fn(&Measures) -> f64) -> Richardson {
        richardson(self.plates.each_ref().map(|plate| value(&plate.measures)))
    }

    /// Of the order of the force.
    fn check(&self) -> Check {
        let (is_graded, element) = (self.grading > 1.0, self.element.name());
        let cells = if is_graded {
            format!("graded by {}", self.grading)
        } else {
            "equal cells".to_owned()
        };
        let order = self.limit(|measures| measures.force).order;
        let what = format!("plate, {element}, {cells}: order of the force");
        let order = check(what, "–", order.unwrap_or(f64::NAN));
        match (self.element, is_graded) {
            (Element::Q2, true) => order.at_least(3.7, "2p = 4"),
            (Element::Q1, true) => order.at_least(1.9, "2p = 2"),
            (Element::Q2, false) => order.at_most(2.3, "singular corners"),
            (Element::Q1, false) => order.at_most(1.9, "singular corners"),
        }
    }
}

impl Plate {
    fn new(across: usize, element: Element, grading: f64) -> Result<Self, Error> {
        let problem = ClampedPlate {
            size: SIZE,
            thickness: sheet().thickness,
            law: sheet().law,
            stretches: vec![STRETCH],
        };
        let model = FiniteElements::graded(&problem, [3 * across, across], element, grading);
        let state = model.model(&problem).reach(&[STRETCH], NEWTON)?;
        let recovery = Recovery::new(&model.mesh);
        let mut estimates = model.estimates(&problem, std::slice::from_ref(&state), &recovery);
        Ok(Self {
            describe: model.describe(),
            estimate: estimates.remove(0).map_err(failed(
                &model.describe(),
                &ClampedPlate::describe_step(STRETCH),
            ))?,
            measures: Measures::of(&model.mesh, &state),
        })
    }

    fn row(&self, exact: Exact) -> Vec<String> {
        let Self {
            measures, estimate, ..
        } = self;
        let surplus = 2.0 * (measures.energy - exact.energy);
        vec![
            self.describe.clone(),
            format!("{:.6}", measures.force),
            number(100.0 * (measures.force / exact.force - 1.0)),
            number(100.0 * estimate.force / exact.force),
            number(estimate.energy.percent()),
            number((estimate.energy.squared() / surplus).sqrt()),
        ]
    }
}

fn report(series: &[Series], exact: Exact) -> [Block; 2] {
    let text = "The clamped plate at 50 % stretch. True errors refer to the extrapolated graded Q2 plates; the error of the \
                field is the square root of twice the excess of the potential. Near a singular corner a recovered gradient \
                is no better than that of the elements: there the estimate is less accurate and is not checked.";
    let head = "clamped plate | force [N] | its error [%] | the same by recovery [%] | \
                error of the field by recovery, energy norm [%] | estimated over true error of the field";
    let plates = series.iter().flat_map(|series| &series.plates);
    let rows = plates.map(|plate| plate.row(exact));
    [Block::paragraph(text), table(head, rows)]
}
