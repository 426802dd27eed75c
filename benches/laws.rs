//! The time of stresses, and of energies, stresses and tangents at many points, of laws that keep their volume and of the same laws with a bulk modulus.
//!
//! ```text
//! cargo bench --bench laws
//! ```
//!
//! 4096 states with stretches of up to ±40 %, shortest of 30 rounds in turn. The last columns are the ratio to the law that keeps
//! its volume; laws with a volume change of their own are compared with neo-Hooke. The last lines are whole plates of 60 × 20
//! quadratic elements, stretched by 50 % in five steps.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use gelbench::finite_element::{Element, FiniteElements};
use gelbench::material::{HyperelasticLaw, PlaneState, Volume, VolumeEnergy};
use gelbench::problem::ClampedPlate;
use gelbench::solve::NewtonSettings;
use gelbench_mechanics::material::samples;
use gelbench_mechanics::material::sheet::COMPONENTS;
use gelbench_mechanics::material::volume::bulk_modulus;

const POINTS: usize = 4096;
const ROUNDS: usize = 30;

type Law = Arc<dyn HyperelasticLaw>;

fn main() {
    let gradients: [Vec<f64>; 4] = std::array::from_fn(|component| {
        let value = |point: usize| ((point * 37 + component * 101) % 997) as f64 / 997.0;
        let scale = [0.4, 0.2, 0.2, 0.4][component];
        (0..POINTS)
            .map(|point| scale * (2.0 * value(point) - 1.0))
            .collect()
    });
    let all = samples::all();
    let neo_hooke = all.iter().find(|(name, _)| *name == "neo-hooke");
    let (_, neo_hooke) = neo_hooke.expect("a shipped card").clone();
    let split = all.into_iter().filter_map(|(name, law)| {
        let volume = Volume {
            bulk_modulus: bulk_modulus(law.shear_modulus(), 0.4),
            energy: VolumeEnergy::Quadratic,
            plane: PlaneState::Stress,
        };
        Some((name.to_owned(), Arc::clone(&law).with_volume(volume)?, law))
    });
    let compressible = samples::changing_volume().into_iter();
    let compressible = compressible.map(|card| (card.law_name, card.law, Arc::clone(&neo_hooke)));
    println!(
        "{:<26} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7}",
        "ns a point", "stress", "volume", "tangent", "volume", "ratio", "ratio"
    );
    let mut pairs: Vec<(String, Law, Law)> = split.chain(compressible).collect();
    for (name, sheet, law) in &pairs {
        let mut best = [f64::INFINITY; 4];
        for _ in 0..ROUNDS {
            let rounds = [
                stress(law, &gradients),
                stress(sheet, &gradients),
                tangent(law, &gradients),
                tangent(sheet, &gradients),
            ];
            for (best, time) in best.iter_mut().zip(rounds) {
                *best = best.min(time);
            }
        }
        let [a, b, c, d] = best.map(|seconds| 1e9 * seconds / POINTS as f64);
        println!(
            "{name:<26} {a:>9.1} {b:>9.1} {c:>9.1} {d:>9.1} {:>7.2} {:>7.2}",
            b / a,
            d / c
        );
    }
    println!(
        "{:<26} {:>9} {:>9} {:>7}",
        "plate, ms", "elements", "volume", "ratio"
    );
    pairs.retain(|(name, ..)| {
        ["neo-hooke", "yeoh", "ogden-1", "neo-hooke-ciarlet"].contains(&&**name)
    });
    for (name, sheet, law) in &pairs {
        let mut best = [f64::INFINITY; 2];
        for _ in 0..5 {
            for (best, time) in best.iter_mut().zip([plate(law), plate(sheet)]) {
                *best = best.min(time);
            }
        }
        let [a, b] = best.map(|seconds| 1e3 * seconds);
        println!("{name:<26} {a:>9.1} {b:>9.1} {:>7.2}", b / a);
    }
}

fn plate(law: &Law) -> f64 {
    let plate = ClampedPlate {
        size: [150.0, 50.0],
        thickness: 2.0,
        law: Arc::clone(law),
        stretches: vec![0.1, 0.2, 0.3, 0.4, 0.5],
    };
    let elements = FiniteElements::new(&plate, [60, 20], Element::Q2);
    let settings = NewtonSettings {
        tolerance: 1e-8,
        max_iterations: 30,
    };
    let start = Instant::now();
    let states = elements.solve(&plate, settings, &|_| ());
    let seconds = start.elapsed().as_secs_f64();
    assert_eq!(black_box(states).map_or(0, |states| states.len()), 5);
    seconds
}

fn stress(law: &Law, gradients: &[Vec<f64>; 4]) -> f64 {
    let mut result: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; POINTS]);
    let start = Instant::now();
    law.stresses(
        gradients.each_ref().map(|line| &line[..]),
        result.each_mut().map(|line| &mut line[..]),
    );
    let seconds = start.elapsed().as_secs_f64();
    black_box(&result);
    seconds
}

fn tangent(law: &Law, gradients: &[Vec<f64>; 4]) -> f64 {
    let mut result: [Vec<f64>; COMPONENTS] = std::array::from_fn(|_| vec![0.0; POINTS]);
    let start = Instant::now();
    law.responses(
        gradients.each_ref().map(|line| &line[..]),
        result.each_mut().map(|line| &mut line[..]),
        true,
    );
    let seconds = start.elapsed().as_secs_f64();
    black_box(&result);
    seconds
}
