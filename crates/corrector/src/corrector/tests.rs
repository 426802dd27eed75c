//! The corrector's properties, on a small plate.

use std::path::Path;

use super::*;
use crate::error::{Error, SolveFault};
use crate::mass_spring::{LatticeSettings, MassSpring};
use crate::material::Card;
use crate::mesh::{CellShape, Mesh};
use crate::problem::ClampedPlate;
use crate::solve::vector::{difference, largest};
use crate::solve::{Inadmissible, Newton, NewtonSettings, SparseRows, State};

use plate::KnownConditions;

mod closed_forms;
mod conditions;
mod instrument;
mod softening;

const SETTINGS: CorrectorSettings = CorrectorSettings {
    tolerance: 1e-11,
    movement: 1e-10,
    max_steps: 60,
    solver: Solver::Automatic,
};
const STRETCH: f64 = 0.5;

fn problem() -> ClampedPlate {
    ClampedPlate {
        size: [30.0, 20.0],
        thickness: 2.0,
        law: Card::load("pva-10", Path::new(".")).unwrap().law,
        stretches: vec![STRETCH],
    }
}

fn lattice(problem: &ClampedPlate) -> (MassSpring, State) {
    let plate = MassSpring::new(problem, [9, 6], LatticeSettings { area_term: false });
    let newton = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 30,
    };
    let solution = plate.solve(problem, newton, &|_| ()).unwrap().remove(0);
    (plate, solution)
}

/// Deterministic numbers in −1…1.
fn noise(size: usize) -> Vec<f64> {
    (0..size)
        .map(|i| (12.9898 * (i + 1) as f64).sin() * 43_758.545_3)
        .map(|x| 2.0 * (x - x.floor()) - 1.0)
        .collect()
}

fn plate_corrector<'a>(problem: &'a ClampedPlate, mesh: &'a Mesh) -> PlateCorrector<'a> {
    PlateCorrector::new(problem, mesh, DifferenceScheme::Gauss, SETTINGS)
}

/// The conditions hold at equilibria that are not stable, too.
#[test]
fn a_corrected_field_is_stable() {
    let plate = ClampedPlate {
        size: [150.0, 50.0],
        ..problem()
    };
    let mesh = Mesh::plate(plate.size, [24, 8], CellShape::Quad4);
    let corrector = plate_corrector(&plate, &mesh);
    let correct = |stretch: f64| {
        let data = plate.affine(&mesh, stretch);
        corrector.correct(&data, stretch, KnownConditions::ALL)
    };
    assert!(correct(-0.1).is_ok());
    assert!(correct(0.3).is_ok());
    let corrected = correct(-0.4).map(|corrected| corrected.measures.force);
    assert!(
        matches!(
            corrected,
            Err(Error::Solve {
                fault: SolveFault::NotPositiveDefinite,
                ..
            })
        ),
        "{corrected:?}"
    );
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    largest(&difference(a, b))
}

/// Grips unknown: fewer conditions than unknowns.
const FREE_GRIPS: KnownConditions = KnownConditions {
    grips: false,
    free_edges: true,
};

#[test]
fn without_conditions_the_field_stays_as_it_is() {
    let data = noise(20);
    let corrector = Corrector::new(Vec::new(), vec![1.0; 20], SETTINGS);
    let correction = corrector.correct(&data, &data).unwrap();
    assert_eq!(correction.field(), data);
}

#[test]
fn a_linear_correction_is_the_orthogonal_projection() {
    // u₀ = 2 with weights 1, 4: the other entries stay, the multiplier is W (ū − u).
    let known = Linear::prescribed("known", 3, [(0, 2.0), (2, -1.0)]);
    let corrector = Corrector::new(vec![Box::new(known)], vec![1.0, 4.0, 4.0], SETTINGS);
    let data = [3.0, 7.0, 1.0];
    let correction = corrector.correct(&data, &data).unwrap();
    assert!(largest_difference(correction.field(), &[2.0, 7.0, -1.0]) < 1e-14);
    assert!(largest_difference(&correction.multipliers[0].values, &[1.0, 8.0]) < 1e-13);
}

#[test]
fn the_corrected_plate_is_the_equilibrium_of_the_difference_scheme() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let corrector = plate_corrector(&problem, &springs.mesh);
    let data = &uncorrected.displacement;
    let corrected = corrector
        .correct(data, STRETCH, KnownConditions::ALL)
        .unwrap();
    let mut newton = Newton::new(corrector.energy(), &problem.held(&springs.mesh)).unwrap();
    let mut affine = problem.affine(&springs.mesh, STRETCH);
    let mut residual = vec![0.0; affine.len()];
    let settings = NewtonSettings {
        tolerance: 1e-12,
        max_iterations: 30,
    };
    newton
        .solve(
            corrector.energy(),
            &mut affine,
            &mut residual,
            settings,
            &|_| String::new(),
        )
        .unwrap();
    assert!(largest_difference(&corrected.state.displacement, &affine) < 1e-9);
    assert!(
        largest_difference(data, &affine) > 0.1,
        "the springs were wrong"
    );

    let again = corrector
        .correct(&corrected.state.displacement, STRETCH, KnownConditions::ALL)
        .unwrap();
    assert_eq!(again.steps.len(), 1, "idempotent");
    assert!(largest_difference(&again.state.displacement, &affine) < 1e-9);
}

#[test]
fn with_fewer_conditions_the_change_is_orthogonal_to_what_they_allow() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let corrector = plate_corrector(&problem, &springs.mesh);
    let start = &uncorrected.displacement;
    let noise = noise(start.len());
    let data: Vec<f64> = start.iter().zip(&noise).map(|(u, n)| u + 0.3 * n).collect();
    let general = Corrector::new(
        corrector.conditions(STRETCH, FREE_GRIPS),
        vec![1.0; data.len()],
        SETTINGS,
    );
    let correction = general.correct(&data, start).unwrap();
    let field = correction.field();
    // A feasible direction: the change of the corrected field that other data would bring.
    let other: Vec<f64> = data
        .iter()
        .enumerate()
        .map(|(i, u)| u + 1e-5 * (i as f64).cos())
        .collect();
    let moved = general.correct(&other, field).unwrap();
    let direction = difference(moved.field(), field);
    let change = difference(&data, field);
    let product: f64 = direction.iter().zip(&change).map(|(a, b)| a * b).sum();
    let size = crate::solve::vector::norm(&direction) * crate::solve::vector::norm(&change);
    assert!((product / size).abs() < 1e-5, "{:.1e}", product / size);
}

#[test]
fn multipliers_are_derivatives_of_the_minimum_by_the_right_hand_side() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let corrector = plate_corrector(&problem, &springs.mesh);
    let data = &uncorrected.displacement;
    for known in [KnownConditions::ALL, FREE_GRIPS] {
        let minimum = |offset: f64| {
            let mut conditions = corrector.conditions(STRETCH, known);
            let inner = conditions.remove(0);
            let row = inner.rows() / 2;
            conditions.insert(0, Box::new(Offset { inner, row, offset }));
            let general = Corrector::new(conditions, vec![1.0; data.len()], SETTINGS);
            let corrected = general.correct(data, data).unwrap();
            let distance = difference(corrected.field(), data);
            let square: f64 = distance.iter().map(|d| d * d).sum();
            (0.5 * square, corrected.multipliers[0].values[row])
        };
        let (step, (_, multiplier)) = (1e-4, minimum(0.0));
        let slope = (minimum(step).0 - minimum(-step).0) / (2.0 * step);
        assert!(
            (slope + multiplier).abs() < 1e-5 * multiplier.abs(),
            "{known:?}: {slope} {multiplier}"
        );
    }
}

/// A condition with the right-hand side of one row moved: c(u) = b.
struct Offset<'a> {
    inner: Box<dyn Condition + 'a>,
    row: usize,
    offset: f64,
}

impl Condition for Offset<'_> {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn rows(&self) -> usize {
        self.inner.rows()
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearisation, Inadmissible> {
        let mut linearised = self.inner.linearise(u)?;
        linearised.values[self.row] -= self.offset;
        Ok(linearised)
    }

    fn unknowns(&self) -> Option<&[usize]> {
        self.inner.unknowns()
    }
}

/// The known conditions decide: without the free edges the transverse error hardly falls.
#[test]
fn the_free_edges_are_needed() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let corrector = plate_corrector(&problem, &springs.mesh);
    let data = &uncorrected.displacement;
    let correct = |known| {
        corrector
            .correct(data, STRETCH, known)
            .unwrap()
            .state
            .displacement
    };
    let exact = correct(KnownConditions::ALL);
    let without = correct(KnownConditions {
        grips: true,
        free_edges: false,
    });
    let error = |field: &[f64]| crate::solve::vector::norm(&difference(field, &exact));
    assert!(
        error(&without) > 0.7 * error(data),
        "{} {}",
        error(&without),
        error(data)
    );
}

#[test]
fn an_inverted_start_is_refused_by_name() {
    let problem = problem();
    let (springs, mut uncorrected) = lattice(&problem);
    uncorrected.displacement[2 * springs.mesh.cell(0)[2]] = -40.0;
    let corrector = plate_corrector(&problem, &springs.mesh);
    let fault = corrector.correct(&uncorrected.displacement, STRETCH, KnownConditions::ALL);
    assert!(fault.unwrap_err().to_string().contains("cell 0 near"));
}
