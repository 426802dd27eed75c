//! Values and points of variables: distributions, fits, tables, and what is refused.

use std::path::Path;

use super::*;

#[test]
fn points_of_distributions_have_their_mean_and_spread() {
    for method in [Method::Sobol, Method::Random] {
        let mut sweep = sweep(
            &["material.c10=0.05+-0.002 MPa", "plate.width=45..55 mm"],
            Some(1024),
        );
        sweep.sampling.method = method;
        let runs = sweep.runs().unwrap();
        let column = |key: usize| -> Vec<f64> {
            runs.iter()
                .map(|run| run.settings[key].value().unwrap())
                .collect()
        };
        for (key, mean, deviation) in [(0, 0.05, 0.002), (1, 50.0, 10.0 / 12f64.sqrt())] {
            let values = column(key);
            let average = values.iter().sum::<f64>() / 1024.0;
            let square = values
                .iter()
                .map(|value| (value - average).powi(2))
                .sum::<f64>()
                / 1023.0;
            assert!(
                (average - mean).abs() < 0.15 * deviation,
                "{method:?}: {average}"
            );
            assert!(
                (square.sqrt() / deviation - 1.0).abs() < 0.1,
                "{method:?}: {square}"
            );
        }
    }
}

#[test]
fn parameters_of_a_fit_are_drawn_with_their_correlation() {
    let fit = r#"{"parameters": [
        {"key": "c10", "unit": "MPa", "value": 0.1, "standard_error": 0.01},
        {"key": "c20", "unit": "MPa", "value": 0.02, "standard_error": 0.004}],
        "correlation": [[1.0, -0.8], [-0.8, 1.0]]}"#;
    let fitted = FittedParameters::parse("fit.json", fit).unwrap();
    let sweep = Sweep {
        fitted: Some(fitted),
        ..sweep(&[], Some(2048))
    };
    assert_eq!(sweep.keys(), ["material.c10", "material.c20"]);
    let runs = sweep.runs().unwrap();
    let moment = |i: usize, j: usize| {
        let off = |run: &Run, key: usize, mean: f64| run.settings[key].value().unwrap() - mean;
        let means = [0.1, 0.02];
        let products = runs
            .iter()
            .map(|run| off(run, i, means[i]) * off(run, j, means[j]));
        products.sum::<f64>() / runs.len() as f64
    };
    assert!((moment(0, 0) / 1e-4 - 1.0).abs() < 0.05);
    assert!((moment(1, 1) / 1.6e-5 - 1.0).abs() < 0.05);
    assert!((moment(0, 1) / -3.2e-5 - 1.0).abs() < 0.05);
    let none = fit.replace("0.01}", "null}");
    let message = FittedParameters::parse("fit.json", &none)
        .unwrap_err()
        .to_string();
    assert!(message.contains("no standard errors"), "{message}");
}

#[test]
fn a_fit_without_standard_errors_is_refused_for_its_own_reason() {
    for (what, reason) in [
        (r#""verdict": {"answer": "systematic"}"#, "is systematic"),
        (
            r#""verdict": {"answer": "rounding"}"#,
            "the rounding of its data",
        ),
        (r#""verdict": {"answer": "white noise"}"#, "c10 at a bound"),
    ] {
        let bound = what.contains("white");
        let fit = format!(
            r#"{{"parameters": [{{"key": "c10", "unit": "MPa", "value": 0.1, "standard_error": null, "at_bound": {bound}}}], {what}}}"#
        );
        let fault = FittedParameters::parse("fit.json", &fit).unwrap_err();
        assert!(fault.to_string().contains(reason), "{fault}");
    }
}

#[test]
fn paths_and_names_are_values_too() {
    let texts = |text: &str| match Variable::parse(text).unwrap().values {
        Values::Listed(all) => all,
        other => panic!("{other:?}"),
    };
    let text = |text: &str| Setting::Text(text.to_owned());
    assert_eq!(
        texts("material.card=../gel.toml,pva-10"),
        [text("../gel.toml"), text("pva-10")]
    );
    assert_eq!(
        texts("material.card=cards/../gel.toml"),
        [text("cards/../gel.toml")]
    );
    assert_eq!(texts("load.stretches.0=\"15 %\""), [text("15 %")]);
}

#[test]
fn a_unit_behind_the_last_value_is_that_of_all() {
    let values = |text: &str| Variable::parse(text).unwrap();
    assert_eq!(values("a=1, 2.5,3 mm"), values("a=1 mm,2.5 mm,3 mm"));
}

#[test]
fn faults_name_what_to_write() {
    for (text, expected) in [
        ("material.c10", "there is no `=`"),
        ("a..b=1", "the key is incomplete"),
        ("a=2..1:3", "2 is not below 1"),
        ("a=1..2:one", "`one` is not a number of values"),
        ("a=1 mm..2 MPa", "two units"),
        ("a=1 mm,2 cm", "several units"),
        ("a=1 mm,2", "several units"),
        ("a=1+-0", "has to be positive"),
        ("a=x..2", "`x` is not a number"),
        ("a=1-3 mm", "written `1..3 mm`, or `1..3 mm:3`"),
        ("a=1 – 3", "written `1..3`"),
        ("a=1 to 3 mm", "written `1..3 mm`"),
    ] {
        let message = Variable::parse(text).unwrap_err().to_string();
        assert!(message.contains(expected), "{text}: {message}");
    }
    for (vary, samples, expected) in [
        (&[][..], None, "nothing is varied"),
        (&["a=1,2", "a.b=1,2"], None, "varied twice"),
        (&["a=1..2"], None, "--samples"),
        (&["a=1,2"], Some(4), "no distribution"),
        (&["a=1..2:1001", "b=1..2:1001"], None, "more than a million"),
    ] {
        let message = sweep(vary, samples).runs().unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    for (vary, expected) in [
        ("plate.cells.2=3,4", "list of 2"),
        ("title.x=3,4", "is a value, not a section"),
        ("plate.lenght=3 cm,4 cm", "lenght"),
        ("material.c01=1 MPa,2 MPa", "c01"),
    ] {
        let sweep = sweep(&[vary], None);
        let outcome = sweep.compute(&sweep.runs().unwrap(), HashMap::new(), &|_| Ok(()), &|| ());
        let message = outcome.unwrap_err().to_string();
        assert!(message.contains(expected), "{vary}: {message}");
    }
}

#[test]
fn points_of_another_program_are_run_in_every_combination() {
    let table = b"material.c10 [MPa],material.card\n0.05,neo-hooke\n0.1,neo-hooke\n";
    let points = Points::parse(Path::new("points.csv"), table).unwrap();
    let sweep = Sweep {
        points: Some(points),
        ..sweep(&["plate.thickness=1 mm,3 mm"], None)
    };
    assert_eq!(
        sweep.keys(),
        ["plate.thickness", "material.c10", "material.card"]
    );
    let forces: Vec<f64> = rows(&sweep)
        .iter()
        .map(|row| row.figure("finite_element.force_N@0.2").unwrap())
        .collect();
    for (force, factor) in forces.iter().zip([1.0, 2.0, 3.0, 6.0]) {
        assert!((force / forces[0] - factor).abs() < 1e-6, "{forces:?}");
    }
    let drawn = Sweep {
        points: sweep.points.clone(),
        ..super::tests::sweep(&["plate.width=40..60 mm"], Some(4))
    };
    let message = drawn.runs().unwrap_err().to_string();
    assert!(message.contains("others are to be drawn"), "{message}");
}

#[test]
fn tables_that_are_no_points_are_told() {
    for (table, expected) in [
        ("", "not a comma-separated table"),
        ("plate.width [mm]\n", "there are no points"),
        ("plate.width [mm]\n1,2\n", "not a comma-separated table"),
        ("plate.width [mm]\nwide\n", "`wide` is not a number"),
        ("plate.width [mm]\ninf\n", "`inf` is not a number"),
        ("plate.width,a\n1,\n", "`` is not a number"),
        ("plate.width\n40 mm\n5 cm\n", "several units"),
        ("plate..width\n1\n", "is not a key"),
        (". [mm]\n1\n", "is not a key"),
    ] {
        let fault = Points::parse(Path::new("p.csv"), table.as_bytes()).unwrap_err();
        let message = fault.to_string();
        assert!(
            message.contains(expected) && message.contains("p.csv"),
            "{table:?}: {message}"
        );
    }
}
