//! A clamped plate of PVA hydrogel stretched by a half: how far springs are from finite elements, before and after the
//! correction. The departure is the displacement less the uniform stretch that the grips impose.
//!
//!     cargo run --release --example corrected_plate
//!
//! ```text
//! mass-spring departure  30.72 %   force  2.74 %
//! corrected   departure   0.10 %   force  0.01 %
//! ```
use std::{error::Error, path::Path};

use gelbench::compare::departure_percent;
use gelbench::corrector::plate::{KnownConditions, PlateCorrector};
use gelbench::corrector::{CorrectorSettings, DifferenceScheme};
use gelbench::finite_element::{Element, FiniteElements};
use gelbench::mass_spring::{LatticeSettings, MassSpring};
use gelbench::{material::Card, problem::ClampedPlate, problem::Measures, solve::NewtonSettings};

const STRETCH: f64 = 0.5;

pub fn report() -> Result<String, Box<dyn Error>> {
    let plate = ClampedPlate {
        size: [150.0, 50.0],
        thickness: 2.0,
        law: Card::load("pva-10", Path::new("."))?.law,
        stretches: vec![STRETCH],
    };
    let newton = NewtonSettings::default();
    let springs = MassSpring::new(&plate, [60, 20], LatticeSettings::default());
    let lattice = &springs.mesh;
    let uncorrected = &springs.solve(&plate, newton, &|_| ())?[0];

    let (scheme, settings) = (DifferenceScheme::default(), CorrectorSettings::default());
    let corrector = PlateCorrector::new(&plate, lattice, scheme, settings);
    let corrected = corrector.correct(&uncorrected.displacement, STRETCH, KnownConditions::ALL)?;

    let elements = FiniteElements::graded(&plate, [36, 20], Element::Q2, 2.0);
    let reference = &elements.solve(&plate, newton, &|_| ())?[0];
    let exact = elements
        .mesh
        .displacement_on(&reference.displacement, lattice);
    let affine = plate.affine(lattice, STRETCH);

    let expected = Measures::of(&elements.mesh, reference).force;
    let mut text = String::new();
    for (model, state) in [
        ("mass-spring", uncorrected),
        ("corrected", &corrected.state),
    ] {
        let departure = departure_percent(lattice, &state.displacement, &exact, &affine);
        let force = 100.0 * (Measures::of(lattice, state).force / expected - 1.0);
        text += &format!("{model:<12}departure {departure:>6.2} %   force {force:>5.2} %\n");
    }
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", report()?);
    Ok(())
}
