//! Homogeneous fields under markers that end where they happen to: right ones are not refuted, and a mistake is.

use std::fs;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::measured::{NOT_EXPLAINED, right_force};
use crate::common::{gelbench, report_of_correction as report, words};

const STRETCH: f64 = 1.3;

/// Neo-Hookean markers pulled to 1.3 along x, with noise of 0.01 mm, on a grid of a spacing turned by some degrees, or anywhere, as far as they
/// lie within.
fn pulled(spacing: f64, degrees: Option<f64>, lies_within: fn([f64; 2]) -> bool) -> Vec<[f64; 4]> {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let (sine, cosine) = degrees.unwrap_or_default().to_radians().sin_cos();
    let all = (-40..=40).flat_map(|i| (-40..=40).map(move |j| [i, j].map(f64::from)));
    let mut markers = Vec::new();
    for [i, j] in all {
        let turned = [cosine * i - sine * j, sine * i + cosine * j];
        let position = match degrees {
            Some(_) => turned.map(|x| spacing * x + 0.4),
            None => [0, 1].map(|_| 80.0 * spacing * (random.random::<f64>() - 0.5)),
        };
        if !lies_within(position) {
            continue;
        }
        let [x, y] = position;
        let moved = [(STRETCH - 1.0) * x, (STRETCH.sqrt().recip() - 1.0) * y];
        let [ux, uy] = moved.map(|moved| {
            let drawn: f64 = StandardNormal.sample(&mut random);
            moved + 0.01 * drawn
        });
        markers.push([x, y, ux, uy]);
    }
    markers
}

/// The code, what was printed, and the report of a correction of these markers.
fn corrected(markers: &[[f64; 4]], more: &str) -> (i32, String, Value) {
    let rows = markers.iter();
    let rows = rows.map(|[x, y, ux, uy]| format!("{x},{y},{ux},{uy}\n"));
    let text = "x [mm],y [mm],ux [mm],uy [mm]\n".to_owned() + &rows.collect::<String>();
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), text).unwrap();
    let usual = "correct plate.csv --material neo-hooke".split(' ');
    let usual = usual.chain(["--thickness", "2 mm", "--cell-size", "4 mm"]);
    let arguments: Vec<&str> = usual.chain(more.split_whitespace()).collect();
    let done = gelbench(folder.path(), &arguments);
    let output = done.get_output();
    let code = output.status.code().unwrap();
    (code, words(&output.stdout), report(folder.path()))
}

fn strip([x, y]: [f64; 2]) -> bool {
    x.abs() <= 50.0 && y.abs() <= 20.0
}

/// The force is 2 c10 (λ − λ⁻²) × 80 mm².
#[test]
fn right_fields_are_not_refuted_because_a_grid_is_turned_or_markers_lie_anywhere() {
    let expected = 80.0 * 2.0 * 0.05 * (STRETCH - STRETCH.powi(-2));
    for degrees in [Some(2.0), Some(8.0), Some(20.0), Some(45.0), None] {
        let markers = pulled(1.6, degrees, strip);
        let (code, _, report) = corrected(&markers, "--free top,bottom");
        assert!(code < 2, "{degrees:?}: {code}");
        let [_, low, high] = right_force(&report, "y_N");
        assert!(low < 0.0 && 0.0 < high, "{degrees:?}: {low} … {high}");
        let [force, low, high] = right_force(&report, "x_N");
        let named = format!("{degrees:?}: {force} in {low} … {high}, expected {expected}");
        assert!((force / expected - 1.0).abs() < 0.04, "{named}");
        assert!(low < expected && expected < high, "{named}");
    }
}

/// The outline of a disc follows its markers, so that it is uneven, and all of it is loaded.
#[test]
fn right_fields_are_not_refuted_because_their_outline_is_round() {
    for degrees in [Some(0.0), Some(20.0), None] {
        let markers = pulled(2.0, degrees, |[x, y]| x.hypot(y) <= 25.0);
        let (code, printed, _) = corrected(&markers, "");
        assert!(code < 2, "{degrees:?}: {printed}");
    }
}

/// With nothing stated of the edges a mirrored field has a solution with loads on all of them.
#[test]
fn a_mirrored_field_is_refuted_on_a_turned_grid_too() {
    for degrees in [0.0, 20.0] {
        let mut markers = pulled(2.8, Some(degrees), strip);
        markers.iter_mut().for_each(|[_, _, ux, _]| *ux = -*ux);
        let (code, printed, _) = corrected(&markers, "");
        assert_eq!(code, NOT_EXPLAINED, "{degrees}: {printed}");
        assert!(printed.contains("mirrored along x"), "{printed}");
    }
}
