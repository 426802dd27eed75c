//! Laws found again from the forces of sheets on their mountings, which a mesh of half the cell size has made.

use std::fmt::Write;
use std::sync::Arc;

use super::sheet::{MountedSheet, SheetLaw, SheetState};
use super::*;
use crate::calibration::data::Observation;
use crate::calibration::tests::helpers::{fitted, law, parsed};
use crate::material::{FungDemiray, HyperelasticLaw, NeoHooke};
use crate::statistics::normal_numbers;

const RAKES: &str = "# mounting: rakes\n# tines: 5\n# tine spacing: 1.3 mm\n# tine inset: 0.8 mm\n# tine diameter: 0.3 mm\n\
                     # length: 8.4 mm\n# width: 8.4 mm\n# thickness: 1 mm\n";

const CRUCIFORM: &str = "# mounting: cruciform\n# length: 30 mm\n# width: 30 mm\n# arm width: 10 mm\n# fillet: 3 mm\n# thickness: 1 mm\n";

/// The head of a record, and the mounting that it states.
fn mounting_of(head: &str) -> (String, Mounting) {
    let names = "strain_1,strain_2,nominal_stress_1 [MPa],nominal_stress_2 [MPa]\n";
    let head =
        format!("# test: biaxial\n# strain measure: nominal\n# strain unit: -\n{head}{names}");
    let test = parsed(&format!("{head}0.1,0.1,1,1\n"));
    (head, test.mounted.mounting.unwrap())
}

/// The record of a law on a mounting, pulled in some ratios up to a strain of the bars, with noise of the forces.
fn record(
    head: &str,
    law: &Arc<dyn HyperelasticLaw>,
    prestretch: [f64; 2],
    most_and_noise: (f64, f64),
) -> TestData {
    parsed(&recorded(head, law, prestretch, most_and_noise))
}

/// The same as text.
fn recorded(
    head: &str,
    law: &Arc<dyn HyperelasticLaw>,
    prestretch: [f64; 2],
    (most, noise): (f64, f64),
) -> String {
    const ROWS: usize = 12;
    let ratios = [[1.0, 1.0], [1.0, 0.5], [0.5, 1.0]];
    let ratios = ratios.iter().flat_map(|ratio| {
        (0..=ROWS).map(|row| ratio.map(|share| most * share * row as f64 / ROWS as f64))
    });
    let strains: Vec<[f64; 2]> = ratios.collect();
    let (head, mounting) = mounting_of(head);
    let sheet = MountedSheet::new(mounting, 1);
    let law = SheetLaw {
        law: Arc::clone(law),
        stretches: prestretch,
    };
    let states = sheet.states(&[law], &strains, &[]).unwrap();
    let states: Vec<SheetState> = states
        .into_iter()
        .map(|mut of_law| of_law.remove(0))
        .collect();
    let largest = states
        .iter()
        .map(|state| state.stresses[0])
        .fold(0.0, f64::max);
    let mut normal = normal_numbers(7);
    let mut text = head;
    for (strain, state) in strains.iter().zip(states) {
        let [first, second] = state
            .stresses
            .map(|stress| stress + noise * largest * normal());
        let _ = writeln!(
            text,
            "{:.5},{:.5},{first:.7},{second:.7}",
            strain[0], strain[1]
        );
    }
    text
}

fn error_percent(fit: &Fit, law: &dyn HyperelasticLaw, strain: f64) -> f64 {
    let [actual, right] = [&*fit.fitted, law].map(|law| law.biaxial([strain; 2]));
    let errors = [0, 1].map(|axis| 100.0 * (actual[axis] / right[axis] - 1.0).abs());
    errors[0].max(errors[1])
}

/// The fit to the record of a law, whose stresses must deviate from those of the law by less than `percent`.
fn accurate_fit(name: &str, right: &[f64], tests: &[TestData], percent: f64) -> Fit {
    let law = law(name, right);
    let actual = fitted(name, tests);
    let parameters = &actual.parameters;
    for strain in [0.03, 0.08] {
        let error = error_percent(&actual, &*law, strain);
        assert!(error < percent, "{error} % at {strain}: {parameters:?}");
    }
    actual
}

/// The homogeneous reading is off by a seventh.
#[test]
fn a_law_is_found_again_from_forces_on_rakes() {
    let law: Arc<dyn HyperelasticLaw> = Arc::new(FungDemiray { mu: 0.02, b: 4.0 });
    let tests = [record(RAKES, &law, [1.0; 2], (0.12, 0.003))];
    let actual = accurate_fit("fung-demiray", &[0.02, 4.0], &tests, 0.5);
    let mounted = actual.mounted.as_ref().unwrap();
    assert!(
        mounted.bias_percent[0].abs() > 10.0,
        "{:?}",
        mounted.bias_percent
    );
    assert!(mounted.rounds <= 5, "{}", mounted.rounds);
    for (estimate, right) in actual.quality.estimates.iter().zip([0.02, 4.0]) {
        assert!(estimate.holds(right), "{estimate:?} {right}");
        assert!(estimate.standard_error < 0.01 * right, "{estimate:?}");
    }
}

/// Tines that slide, and marker stretches of the middle: the sheet is another one, the law the same.
#[test]
fn mountings_that_slide_and_markers_give_the_same_law() {
    let law: Arc<dyn HyperelasticLaw> = Arc::new(FungDemiray { mu: 0.02, b: 4.0 });
    for more in ["# tine bars: sliding\n", "# markers: 2 mm\n"] {
        let tests = [record(
            &format!("{RAKES}{more}"),
            &law,
            [1.0; 2],
            (0.1, 0.003),
        )];
        accurate_fit("fung-demiray", &[0.02, 4.0], &tests, 1.0);
    }
}

#[test]
fn a_cruciform_gives_the_law_of_its_middle() {
    let law: Arc<dyn HyperelasticLaw> = Arc::new(FungDemiray { mu: 0.02, b: 4.0 });
    let tests = [record(CRUCIFORM, &law, [1.0; 2], (0.2, 0.003))];
    accurate_fit("fung-demiray", &[0.02, 4.0], &tests, 1.0);
}

/// All forces of a law with one modulus are in proportion to it, those next to rest too, and at rest there is none.
#[test]
fn the_effect_of_a_mounting_vanishes_with_the_strain() {
    let law: Arc<dyn HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
    let tests = [record(CRUCIFORM, &law, [1.0; 2], (0.2, 0.0))];
    let mut sheet = Solved::new(&tests, tests[0].mounted.mounting.unwrap(), NEAR);
    let middle = sheet.neo_hookean(&tests).unwrap();
    let rows = &tests[0].observations;
    let largest = rows
        .iter()
        .max_by(|a, b| a.stress.total_cmp(&b.stress))
        .unwrap();
    let factor = largest.stress / middle.modelled(largest);
    for one in rows {
        let off = (one.stress - factor * middle.modelled(one)) / largest.stress;
        assert!(off.abs() < 3e-3, "{one:?} {off}");
    }
    for axis in [0, 1] {
        let rest = Observation {
            strains: [0.0; 2],
            axis,
            stress: 0.0,
        };
        let stress = middle.of(&rest).stress;
        assert!(stress.abs() < 1e-9 * largest.stress, "{stress}");
    }
}

/// With one pair of bars the markers along both axes move, along the other one by up to as much.
#[test]
fn the_bars_of_an_anisotropic_sheet_are_found_by_its_markers() {
    let (_, mounting) = mounting_of(CRUCIFORM);
    let laws = [SheetLaw {
        law: law("holzapfel-gasser-ogden", &[0.008, 0.02, 2.0, 0.1, 0.6]).into(),
        stretches: [1.0; 2],
    }];
    let [by_bars, by_markers] = [None, Some(3.0)].map(|markers| {
        let mounting = Mounting {
            markers,
            ..mounting
        };
        MountedSheet::new(mounting, 0)
    });
    let ratios = [[1.0, 1.0], [1.0, 0.4], [0.4, 1.0]];
    let bars: Vec<[f64; 2]> = ratios
        .iter()
        .flat_map(|ratio| [0.0_f64, 0.1, 0.2].map(|most| ratio.map(|share| most * share)))
        .collect();
    let states = by_bars.states(&laws, &bars, &[]).unwrap().concat();
    let strains: Vec<[f64; 2]> = states
        .iter()
        .map(|state| by_markers.middle(&state.field))
        .collect();
    let located = by_markers.states(&laws, &strains, &[]).unwrap().concat();
    for (state, bars) in located.iter().zip(&bars) {
        for axis in [0, 1] {
            let off = state.bars[axis] - bars[axis];
            assert!(off.abs() < 1e-5, "{bars:?} {:?}", state.bars);
        }
    }
}

/// As mounted the sheet is stretched by 4 and 2 %: taken as at rest, its law is another one; estimated or stated it is the right one.
#[test]
fn the_stretch_as_mounted_is_found_with_the_law() {
    let law: Arc<dyn HyperelasticLaw> = Arc::new(FungDemiray { mu: 0.02, b: 6.0 });
    let head = format!("{RAKES}# rest state: estimated\n");
    let text = recorded(&head, &law, [1.04, 1.02], (0.12, 0.001));
    let stated = [text.replace("estimated", "1.04,1.02")].map(|text| parsed(&text));
    let tests = [parsed(&text)];
    let estimated = accurate_fit("fung-demiray", &[0.02, 6.0], &tests, 3.0);
    let stretches = estimated.quality.zeros.iter().map(|zero| &zero.by);
    for (stretch, right) in stretches.zip([0.04, 0.02]) {
        assert!(
            (stretch.value - right).abs() < 3.0 * stretch.standard_error,
            "{stretch:?}"
        );
    }
    let names = estimated.fitted_tests(&tests);
    assert!(
        names[0]
            .remarks
            .iter()
            .any(|remark| remark.contains("as mounted"))
    );
    accurate_fit("fung-demiray", &[0.02, 6.0], &stated, 1.0);
}
