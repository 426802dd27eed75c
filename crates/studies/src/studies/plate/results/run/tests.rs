//! Corrected fields on cells of their own.

use std::path::Path;

use super::*;
use crate::studies::plate::figures::figures;
use crate::studies::plate::vtk::grids;

fn study(corrector: &str) -> Study {
    let text = format!(
        "[plate]\ncells = [36, 12]\n[load]\nstretches = [0.15, 0.5]\n[corrector]\n{corrector}\n"
    );
    Study::parse("graded", "graded.toml", Path::new("."), text).unwrap()
}

fn departures(results: &Results) -> Vec<f64> {
    let corrected = results
        .comparison
        .iter()
        .map(|step| step.corrected.unwrap());
    corrected.map(|own| own.departure_percent).collect()
}

/// With both methods, on cells of their own, the corrected fields of each scheme come nearer to the finite elements, and the springs
/// stay what they are.
#[test]
fn graded_cells_make_the_corrected_field_more_accurate() {
    for (scheme, gain) in [("biquadratic", 3.0), ("gauss", 2.0)] {
        let solve = |grading: f64, method: &str| {
            let settings =
                format!("scheme = \"{scheme}\"\ngrading = {grading}\nmethod = \"{method}\"");
            run(&study(&settings), Progress::silent()).unwrap()
        };
        let equal = solve(1.0, "climb");
        let [climbed, direct] = ["climb", "direct"].map(|method| solve(2.0, method));
        let pairs = departures(&climbed).into_iter().zip(departures(&equal));
        for (graded, equal) in pairs {
            assert!(gain * graded < equal, "{scheme}: {graded} {equal}");
        }
        for (climbed, direct) in departures(&climbed).iter().zip(departures(&direct)) {
            assert!(
                (climbed / direct - 1.0).abs() < 2e-3,
                "{scheme}: {climbed} {direct}"
            );
        }
        for (graded, equal) in climbed.comparison.iter().zip(&equal.comparison) {
            let [graded, equal] = [graded, equal].map(|step| step.mass_spring.unwrap());
            let ratio = graded.departure_percent / equal.departure_percent;
            assert!((ratio - 1.0).abs() < 1e-3, "{scheme}: {ratio}");
        }
    }
}

/// The bicubic scheme has nodes of its own even on equal cells; on graded ones it is more exact than the biquadratic.
#[test]
fn bicubic_cells_are_more_exact_by_both_methods() {
    let solve = |settings: &str| run(&study(settings), Progress::silent()).unwrap();
    let biquadratic = solve("scheme = \"biquadratic\"");
    let [climbed, direct] = ["climb", "direct"]
        .map(|method| solve(&format!("scheme = \"bicubic\"\nmethod = \"{method}\"")));
    let triples = departures(&climbed).into_iter().zip(departures(&direct));
    for ((climbed, direct), other) in triples.zip(departures(&biquadratic)) {
        assert!(1.2 * climbed < other, "{climbed} {other}");
        assert!((climbed / direct - 1.0).abs() < 5e-3, "{climbed} {direct}");
    }
    for (own, other) in climbed.comparison.iter().zip(&biquadratic.comparison) {
        let [own, other] = [own, other].map(|step| step.mass_spring.unwrap().departure_percent);
        assert!((own / other - 1.0).abs() < 1e-2, "{own} {other}");
    }
    let equal = solve("scheme = \"bicubic\"\ngrading = 1.0");
    assert_ne!(equal.corrected_mesh.nodes, equal.springs.mesh.nodes);
    let gauss = solve("scheme = \"gauss\"\ngrading = 1.0");
    for (own, other) in departures(&equal).iter().zip(departures(&gauss)) {
        assert!(2.0 * own < other, "{own} {other}");
    }
}

#[test]
fn fields_and_pictures_are_on_the_mesh_of_their_model() {
    let study = study("grading = 2.0");
    let results = run(&study, Progress::silent()).unwrap();
    assert_ne!(results.corrected_mesh.nodes, results.springs.mesh.nodes);
    for series in grids(&study, &results) {
        let mesh = match series.name.as_str() {
            "corrected" => &results.corrected_mesh,
            "finite_element" => &results.finest().model.mesh,
            _ => &results.springs.mesh,
        };
        for named in &series.grids {
            assert_eq!(named.grid.points, mesh.nodes, "{}", series.name);
        }
    }
    assert!(figures(&study, &results).len() > 5);
}
