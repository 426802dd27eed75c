//! Laws of sheets with directions in planar biaxial tests.

use super::*;
use crate::material::registry::Law;
use crate::statistics::normal_numbers;

/// Laws with parameters of a soft tissue.
const TISSUES: [(&str, &[f64]); 5] = [
    ("holzapfel-gasser-ogden", &[0.02, 0.05, 8.0, 0.1, 0.5]),
    ("fung", &[0.02, 9.0, 5.0, 3.0, 10.0, 0.0]),
    ("may-newman", &[0.01, 0.004, 3.0, 120.0, 0.35]),
    ("lee-sacks", &[0.02, 0.01, 2.0, 5.0, 0.4, 0.35]),
    (
        "holzapfel-ogden",
        &[0.02, 4.0, 0.03, 6.0, 0.01, 4.0, 0.0, 1.0, 0.3],
    ),
];

/// Five protocols of a law with a noise of `share` of the largest stress.
fn noisy_protocols(law: &str, values: &[f64], share: f64, seed: u64) -> TestData {
    let ratios = [[1.0, 1.0], [1.0, 0.5], [0.5, 1.0], [1.0, 0.2], [0.2, 1.0]];
    record((law, values), (&ratios, 0.3), (share, seed))
}

/// Protocols of a law in some ratios of a largest strain, with a noise of `share` of the largest stress.
pub fn record(
    (law, values): (&str, &[f64]),
    (ratios, most): (&[[f64; 2]], f64),
    (share, seed): (f64, u64),
) -> TestData {
    let law = super::law(law, values);
    let mut normal = normal_numbers(seed);
    let states = ratios.iter().flat_map(|ratio| {
        (1..=30).map(move |row| ratio.map(|one| most * one * f64::from(row) / 30.0))
    });
    let states: Vec<[f64; 2]> = states.collect();
    let stresses: Vec<[f64; 2]> = states.iter().map(|state| law.biaxial(*state)).collect();
    let largest = stresses
        .iter()
        .flatten()
        .fold(0.0, |most: f64, one| most.max(*one));
    let mut noisy = |stress: f64| stress + share * largest * normal();
    let rows = states
        .iter()
        .zip(&stresses)
        .map(|([x, y], [p, q])| format!("{},{},{},{}\n", 1.0 + x, 1.0 + y, noisy(*p), noisy(*q)));
    let head = "# test: biaxial; one specimen: yes\nstretch_1,stretch_2,nominal_stress_1 [MPa],nominal_stress_2 [MPa]\n";
    parsed(&(head.to_owned() + &rows.collect::<String>()))
}

fn of(law: &str, data: &TestData, settings: &FitSettings) -> Fit {
    fit_with(law, std::slice::from_ref(data), settings).unwrap()
}

fn starts(starts: usize) -> FitSettings {
    FitSettings {
        starts,
        ..FitSettings::default()
    }
}

fn stated(key: &str, value: f64) -> FitSettings {
    bounded(key, [value; 2])
}

/// More rows than are fitted one by one: means are those of neighbours in one protocol, not of states that share one stretch.
#[test]
fn many_rows_are_gathered_within_each_protocol() {
    let (name, values) = TISSUES[1];
    let model = law(name, values);
    let ratios = [[1.0, 1.0], [1.0, 0.5], [0.5, 1.0]];
    let mut data = record((name, values), (&ratios, 0.3), (0.0, 0));
    data.observations.clear();
    for ratio in ratios {
        for row in 1..=900 {
            let strains = ratio.map(|one| 0.3 * one * f64::from(row) / 900.0);
            let stresses = model.biaxial(strains);
            data.observations.extend([0, 1].map(|axis| Observation {
                strains,
                axis,
                stress: stresses[axis],
            }));
        }
    }
    let fit = of(name, &data, &starts(8));
    assert_parameters(&fit, &values[..4], 1e-3);
}

/// The optima of 400 starts in a real tissue, from those of one usual run.
#[test]
fn one_run_ends_at_the_optimum_of_many_starts() {
    let data = read(helpers::TISSUE);
    for (law, sum) in [
        ("fung", 0.004_724_383),
        ("may-newman", 0.004_782_514),
        ("lee-sacks", 0.003_994_555),
        ("holzapfel-ogden", 0.002_532_484),
    ] {
        let actual = of(law, &data, &starts(8)).quality.sum_of_squares;
        assert!((actual / sum - 1.0).abs() < 1e-6, "{law}: {actual}");
    }
}

#[test]
fn parameters_of_made_tissue_lie_in_their_intervals_and_other_laws_do_not_explain_it() {
    for (law, truth) in TISSUES {
        let actual = of(law, &noisy_protocols(law, truth, 0.01, 0), &starts(8));
        let held: Vec<&str> = actual
            .parameters
            .iter()
            .zip(&actual.quality.held)
            .filter_map(|(parameter, held)| held.then_some(parameter.key))
            .collect();
        match law {
            "fung" => assert_eq!(held, ["a4", "angle"]),
            "holzapfel-ogden" => assert_eq!(held, ["a_fs", "b_fs"]),
            _ => assert!(held.is_empty(), "{law}: {held:?}"),
        }
        for (index, (estimate, truth)) in actual.quality.estimates.iter().zip(truth).enumerate() {
            let is_inside = estimate.holds(*truth) || actual.quality.held[index];
            assert!(is_inside, "{law} {index}: {estimate:?}");
        }
        let precise = noisy_protocols(law, truth, 5e-4, 1);
        for (other, _) in TISSUES {
            let verdict = of(other, &precise, &starts(8)).quality.verdict.unwrap();
            let explains = verdict.answer != Answer::Systematic;
            assert_eq!(explains, other == law, "{other} of {law}");
        }
    }
}

/// Biaxial protocols, simple shear and a strip of a sheet whose axes are turned to the other side. Without the strip, two sets of
/// parameters have the same stresses.
#[test]
fn shear_determines_the_angle_with_its_sign_and_the_shear_stiffness() {
    let truth = [0.02, 9.0, 5.0, 3.0, 4.0, -0.3];
    let sheet = law("fung", &truth);
    let test = |head: &str, stress: &dyn Fn(f64) -> f64| {
        let row = |x: f64| format!("{x},{}\n", stress(x));
        let rows: String = (1..=30).map(|row| 0.01 * f64::from(row)).map(row).collect();
        parsed(&(head.to_owned() + &rows))
    };
    let data = [
        noisy_protocols("fung", &truth, 1e-6, 0),
        test(
            "# test: simple-shear\nshear_strain [-],shear_stress [MPa]\n",
            &|amount| crate::material::curve::simple_shear(&*sheet, amount),
        ),
        test(
            "# test: uniaxial; direction: 1\nnominal_strain [-],nominal_stress [MPa]\n",
            &|strain| sheet.tension([1.0, 0.0], strain).nominal_stress,
        ),
    ];
    let actual = fitted("fung", &data);
    assert_parameters(&actual, &truth, 1e-3);
    assert!(!actual.quality.held.contains(&true));
}

/// Fibres at 45° couple both axes more than a convex energy of Fung can: a₃ ends at its limit √(a₁ a₂).
#[test]
fn a_convex_energy_is_the_best_one_within_its_limit() {
    let law = "holzapfel-gasser-ogden";
    let data = noisy_protocols(law, &[0.02, 0.05, 8.0, 0.0, 0.6], 0.01, 1);
    let [few, many] = [8, 60].map(|count| of("fung", &data, &starts(count)));
    let ratio = few.quality.sum_of_squares / many.quality.sum_of_squares;
    assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
    for actual in [few, many] {
        let [_, a1, a2, a3, ..] = &actual.parameters[..] else {
            panic!()
        };
        let share = a3.value / (a1.value * a2.value).sqrt();
        assert!(share < 1.0 && share > 1.0 - 1e-8, "{share}");
        assert!(actual.quality.at_bound[3]);
    }
}

/// Without shear, one family has the stresses of two of half the stiffness; the card says which it is, and leads to the law of its fit.
#[test]
fn one_family_of_fibres_is_fitted_where_it_is_stated() {
    let (name, truth) = TISSUES[0];
    let two = Law::named(name).unwrap();
    let one = two.choosing("families", "one").unwrap();
    assert!(two.choosing("families", "three").is_none());
    let tests = [noisy_protocols(name, truth, 1e-6, 0)];
    for (law, families, k1) in [(two, "two", 0.05), (one, "one", 0.1)] {
        let actual = crate::calibration::fit(law, &tests, &starts(8)).unwrap();
        assert_parameters(&actual, &[0.02, k1, 8.0, 0.1, 0.5], 1e-2);
        let text = card_text(&actual, &tests, &Provenance::default());
        assert_contains(&text, &format!("families = \"{families}\""));
        let card = Card::parse("card", "card", &text).unwrap();
        let again = Law::of_card(&card.law_name, &card.choices).unwrap();
        assert_eq!(again.unknown().1.choices, actual.choices);
    }
}

/// AICc grows by 2 and a little more for each parameter that is fitted, and a stated one is not counted.
#[test]
fn a_stated_parameter_is_not_fitted() {
    let (law, truth) = TISSUES[3];
    let data = noisy_protocols(law, truth, 0.01, 0);
    let free = of(law, &data, &starts(8));
    for (index, key) in [(0, "c10"), (5, "angle")] {
        let value = free.parameters[index].value;
        let actual = of(law, &data, &stated(key, value));
        assert_eq!(actual.parameters[index].value, value);
        let (quality, free) = (&actual.quality, &free.quality);
        assert!((quality.sum_of_squares / free.sum_of_squares - 1.0).abs() < 1e-9);
        assert!(
            (free.aicc - quality.aicc - 2.1).abs() < 0.1,
            "{}",
            quality.aicc
        );
        assert!(quality.held[index] && !quality.at_bound[index]);
        assert!(quality.estimates[index].standard_error.is_nan());
        let tests = std::slice::from_ref(&data);
        let text = card_text(&actual, tests, &Provenance::default());
        assert_contains(&text, "# held, not fitted");
        let again = Card::parse("card", "card", &text).unwrap();
        assert_eq!(
            again.fit.unwrap().bounds,
            [format!("{key}={value}..{value}")]
        );
    }
    // Parameters that are stresses are fitted given the stated one.
    let actual = of(law, &data, &stated("c10", 0.05));
    assert_eq!(actual.parameters[0].value, 0.05);
    assert!(actual.quality.sum_of_squares > free.quality.sum_of_squares);
    // A stated angle outside of the usual range is taken as it is.
    let actual = of(law, &data, &stated("angle", -0.35));
    assert_eq!(actual.parameters[5].value, -0.35);
    let refused = fit_with(law, std::slice::from_ref(&data), &stated("delta", 1.5));
    assert!(refused.unwrap_err().to_string().contains("delta"));
}
