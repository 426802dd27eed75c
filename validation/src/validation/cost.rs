//! The cost of the corrected plate compared with finite elements, measured side by side in one run.
//!
//! Both paths of the corrector are measured: the direct one, which starts at the springs' field on the same nodes, and the
//! climb, which is the default of studies. Each is compared with the finite elements with the same equations on the same
//! nodes, solved with one sparse factorisation for each Newton iteration. Finite elements tuned as well as they
//! can be are in `cargo bench --bench corrected_plate`.

use std::path::Path;

use super::case::{Check, Claim, Computation, Outcome, Progress, check, number, section, table};
use super::plate::Plate;
use web_time::Instant;

use crate::compare::departure_percent;
use crate::corrector::DifferenceScheme;
use crate::corrector::climb::{Climb, ClimbSettings};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::Element;
use crate::mass_spring::MassSpring;

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let plate = Plate::read(root, folder);
    let repetitions = section(root, "measure", |measure| {
        measure.count("repetitions", 1, 1000)
    });
    Box::new(move |progress| compute(&plate, repetitions, progress))
}

/// Departures from the affine stretch are equal where one is larger than the other by at most this factor.
const EQUAL: f64 = 1.01;

/// One way to the field: its name, nodes, deviation in % and shortest time in s.
struct Method {
    name: &'static str,
    nodes: usize,
    departure: f64,
    seconds: f64,
}

/// A way of the corrector, and the finite elements with the same equations on the same nodes.
struct Comparison {
    corrected: Method,
    elements: Method,
}

/// What every way is measured with.
struct Bench<'a> {
    plate: &'a Plate,
    lattice: MassSpring,
    reference: Vec<f64>,
    affine: Vec<f64>,
    repetitions: usize,
    progress: Progress<'a>,
}

/// Where the times are, and what the finite elements of this comparison are not.
const TIMES: &str = "The times of a run are listed under Times; they depend on the machine and on its other load. These \
                     finite elements have equal cells and start from the affine stretch: graded meshes and better initial \
                     guesses make them faster; the bench `corrected_plate` compares the climb with the fastest of them";

impl<'a> Bench<'a> {
    fn new(plate: &'a Plate, repetitions: usize, progress: Progress<'a>) -> Result<Self, Error> {
        let lattice = plate.lattice();
        Ok(Self {
            plate,
            reference: plate.reference(&lattice)?,
            affine: plate.problem.affine(&lattice.mesh, plate.stretch()),
            lattice,
            repetitions,
            progress,
        })
    }

    /// The shortest time of some work that finds the field on the nodes of the lattice, and its departure.
    fn measure(
        &self,
        name: &'static str,
        work: impl Fn() -> Result<Vec<f64>, Error>,
    ) -> Result<Method, Error> {
        self.progress.tell(name);
        let (mut seconds, mut field) = (f64::INFINITY, Vec::new());
        for _ in 0..self.repetitions {
            let start = Instant::now();
            field = work()?;
            seconds = seconds.min(start.elapsed().as_secs_f64());
        }
        let mesh = &self.lattice.mesh;
        Ok(Method {
            name,
            nodes: mesh.nodes.len(),
            departure: departure_percent(mesh, &field, &self.reference, &self.affine),
            seconds,
        })
    }

    /// Finite elements with the nodes of the lattice.
    fn elements(
        &self,
        name: &'static str,
        cells: [usize; 2],
        element: Element,
    ) -> Result<Method, Error> {
        self.measure(name, || {
            let (model, solution) = self.plate.finite_elements(cells, element)?;
            let displacement = &solution.displacement;
            Ok(model.mesh.displacement_on(displacement, &self.lattice.mesh))
        })
    }
}

fn compute(plate: &Plate, repetitions: usize, progress: Progress) -> Result<Outcome, Error> {
    let bench = Bench::new(plate, repetitions, progress)?;
    let springs = bench.measure("mass-spring", || {
        Ok(plate.solve(&plate.lattice())?.displacement)
    })?;
    let directly = || {
        let lattice = plate.lattice();
        let field = plate.solve(&lattice)?.displacement;
        Ok(plate.corrected(&lattice, &field)?.state.displacement)
    };
    let (cells, halved) = (plate.cells, plate.cells.map(|cells| cells / 2));
    let direct = Comparison {
        corrected: bench.measure("mass-spring, corrected directly", directly)?,
        elements: bench.elements("finite elements, Q1, equal nodes", cells, Element::Q1)?,
    };
    let climb = Comparison {
        corrected: bench.measure("climb, the default", || climb(plate))?,
        elements: bench.elements("finite elements, Q2, equal nodes", halved, Element::Q2)?,
    };
    Ok(outcome(springs, [direct, climb]))
}

/// The field of the climb with the difference scheme of nine-node elements on the same nodes.
fn climb(plate: &Plate) -> Result<Vec<f64>, Error> {
    let (scheme, settings) = (DifferenceScheme::Biquadratic, ClimbSettings::FAST);
    let mut climb = Climb::even(&plate.problem, plate.cells, scheme, settings);
    Ok(climb.correct(plate.stretch())?.field.to_nodes())
}

impl Comparison {
    /// The departure over that of the finite elements.
    fn departure(&self) -> f64 {
        self.corrected.departure / self.elements.departure
    }

    /// In words, without times: these differ from run to run, and nothing that is written down may hang on them.
    fn verdict(&self) -> String {
        let accuracy = if self.departure() <= EQUAL {
            "as accurate as"
        } else {
            "less accurate than"
        };
        let [corrected, elements] = [&self.corrected, &self.elements].map(|method| method.name);
        format!("{corrected}: {accuracy} {elements}")
    }

    fn check(&self, quantity: &str) -> Check {
        let quantity =
            format!("consistency: departure error of {quantity} elements at equal nodes");
        check(quantity, "–", self.departure()).at_most(EQUAL, "the same equations")
    }
}

fn outcome(springs: Method, paths: [Comparison; 2]) -> Outcome {
    let [direct, climb] = &paths;
    let checks = vec![
        direct.check("the corrected plate over that of Q1"),
        climb.check("the climb over that of Q2"),
    ];
    let verdicts: Vec<_> = paths.iter().map(Comparison::verdict).collect();
    let claim = Claim {
        claim: "The accuracy of finite elements at 1/20 of their CPU time",
        reproduced: format!("{}. {TIMES}", verdicts.join("; ")),
    };
    let of_paths = paths
        .into_iter()
        .flat_map(|comparison| [comparison.corrected, comparison.elements]);
    let methods: Vec<Method> = [springs].into_iter().chain(of_paths).collect();
    let row = |method: &Method| {
        vec![
            method.name.to_owned(),
            method.nodes.to_string(),
            number(method.departure),
        ]
    };
    let head = "method | nodes | error of the departure from affine [%]";
    let times = methods
        .iter()
        .map(|method| (method.name.to_owned(), method.seconds));
    Outcome {
        checks,
        claims: vec![claim],
        blocks: vec![table(head, methods.iter().map(row))],
        times: times.collect(),
        ..Outcome::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of a direct path with these departures in % next to a climb that is as accurate as its elements.
    fn verdict(corrected: f64, elements: f64) -> (String, bool) {
        let method = |name, departure| Method {
            name,
            nodes: 9,
            departure,
            seconds: 1.0,
        };
        let comparison = |corrected, elements| Comparison {
            corrected: method("corrected", corrected),
            elements: method("Q1", elements),
        };
        let methods = [comparison(corrected, elements), comparison(0.2, 0.2)];
        let actual = outcome(method("springs", 30.0), methods);
        let passed = actual.checks.iter().all(Check::passed);
        (actual.claims[0].reproduced.clone(), passed)
    }

    #[test]
    fn the_verdict_follows_from_what_was_measured() {
        for (departure, words, passed) in [
            (0.3, "as accurate as", true),
            (0.31, "less accurate than", false),
        ] {
            let expected = format!("corrected: {words} Q1; corrected: as accurate as Q1. {TIMES}");
            assert_eq!(verdict(departure, 0.3), (expected, passed));
        }
    }
}
