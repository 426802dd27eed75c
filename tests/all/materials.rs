//! From a file of test data to a card, as a user meets it.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{SMALL, folder_with, gelbench, number, root, words};

/// From a file of test data to a card that drives a study; the guide shows what is printed.
#[test]
fn a_law_is_fitted_and_its_card_is_used() {
    let folder = folder_with(&format!("{SMALL}[material]\ncard = \"pva.toml\"\n"));
    let data = root().join("materials/data/pva_10_uniaxial.csv");
    let data = data.to_str().unwrap();
    let fit = "--law yeoh --name pva --output .".split(' ');
    let fit: Vec<&str> = ["materials", "fit", data].into_iter().chain(fit).collect();
    let printed = words(&gelbench(folder.path(), &fit).code(0).get_output().stdout);
    let guide = fs::read_to_string(root().join("src/guide/materials.md")).unwrap();
    let shown = |line: &&str| line.contains("no interval") || line.contains("RMSE");
    assert_eq!(printed.lines().filter(shown).count(), 5);
    for line in printed.lines().filter(shown) {
        assert!(guide.contains(line), "the guide does not show: {line}");
    }
    let figures = fs::read_to_string(folder.path().join("pva.json")).unwrap();
    let figures: Value = serde_json::from_str(&figures).unwrap();
    assert!((number(&figures, &["r_squared"]) - 0.999_925).abs() < 1e-6);
    assert_eq!(figures["verdict"]["answer"], "systematic");
    assert!(figures["parameters"][0]["standard_error"].is_null());
    let card = fs::read_to_string(folder.path().join("pva.toml")).unwrap();
    assert_eq!(card.matches("# no interval").count(), 3);
    assert!(card.contains("; residuals: systematic, a smooth pattern"));
    assert!(
        fs::read(folder.path().join("pva.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    gelbench(folder.path(), &["check", "small.toml"]).code(0);
    gelbench(folder.path(), &["materials", "refit", "pva.toml"]).code(0);

    // The same again gives the same bytes, but a card that no fit has written is left alone.
    let card = fs::read(folder.path().join("pva.toml")).unwrap();
    gelbench(folder.path(), &fit).code(0);
    assert_eq!(fs::read(folder.path().join("pva.toml")).unwrap(), card);
    let text = words(&card);
    let other = [
        text.replace("pva_10_uniaxial.csv", "other.csv"),
        text.replace("c10 = \"", "c10 = \"1"),
    ];
    for (text, why) in other.iter().zip(["fitted to", "changed since its fit"]) {
        fs::write(folder.path().join("pva.toml"), text).unwrap();
        let refused = gelbench(folder.path(), &fit).code(4);
        assert!(words(&refused.get_output().stderr).contains(why));
        assert_eq!(
            words(&fs::read(folder.path().join("pva.toml")).unwrap()),
            *text
        );
    }
    fs::write(folder.path().join("pva.toml"), &card).unwrap();
    fs::write(folder.path().join("pva.toml"), "mine").unwrap();
    let refused = gelbench(folder.path(), &fit).code(4);
    assert!(words(&refused.get_output().stderr).contains("choose another --name"));
    assert_eq!(fs::read(folder.path().join("pva.toml")).unwrap(), b"mine");
}

#[test]
fn a_card_that_was_changed_is_not_found_again() {
    let folder = TempDir::new().unwrap();
    let card = fs::read_to_string(root().join("materials/treloar-ogden-3.toml")).unwrap();
    let data = root().join("materials/data/");
    let card = card
        .replace("alpha_2 = 1.89", "alpha_2 = 1.88")
        .replace("data/", &data.display().to_string());
    fs::write(folder.path().join("a.toml"), card).unwrap();
    let done = gelbench(folder.path(), &["materials", "refit", "a.toml"]).code(1);
    assert!(words(&done.get_output().stdout).contains("DIFFERENT"));
    let none = gelbench(folder.path(), &["materials", "refit", "pva-10"]).code(2);
    assert!(words(&none.get_output().stderr).contains("has no [fit]"));
}

#[test]
fn all_laws_are_ranked_and_the_best_stable_one_that_the_data_tell_is_written() {
    let folder = TempDir::new().unwrap();
    let data = root().join("materials/data/treloar_1944_uniaxial.csv");
    let arguments = ["materials", "fit", data.to_str().unwrap(), "--all"];
    let done = gelbench(folder.path(), &arguments).code(0);
    let printed = words(&done.get_output().stdout);
    assert_eq!(
        printed
            .lines()
            .filter(|line| line.ends_with("yes") || line.ends_with("no"))
            .count(),
        14
    );
    assert!(printed.contains("uniaxial only: planar and equibiaxial stresses are predictions"));
    assert!(
        folder
            .path()
            .join("output/materials/treloar_1944_uniaxial-yeoh.toml")
            .exists()
    );
}

#[test]
fn test_data_that_cannot_be_trusted_are_refused_with_line_and_remedy() {
    let folder = TempDir::new().unwrap();
    let fit = |text: &str, options: &[&str]| {
        fs::write(folder.path().join("a.csv"), text).unwrap();
        let arguments = ["materials", "fit", "a.csv", "--law", "neo-hooke"];
        let all: Vec<&str> = arguments.iter().chain(options).copied().collect();
        words(&gelbench(folder.path(), &all).code(2).get_output().stderr)
    };
    for (text, options, message) in [
        (
            "stretch [-],nominal_stress [MPa]\n1.1,0.1\n",
            &[][..],
            "give --test uniaxial",
        ),
        (
            "stretch [-],nominal_stress [MPa]\n1.1,0.1\n",
            &["--test", "uniaxial"],
            "neo-hooke: 1 parameters need at least 2 points",
        ),
        (
            "stretch [-],stress\n1.1,0.1\n",
            &["--test", "uniaxial", "--stress", "nominal"],
            "stress unit is not stated",
        ),
        (
            "stretch [-],stress [MPa]\n1.1,0.1\n",
            &["--test", "uniaxial", "--stress", "true"],
            "it must be one of nominal, cauchy",
        ),
        ("", &["--test", "uniaxial"], "there are no columns"),
    ] {
        let actual = fit(text, options);
        let actual = actual.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(actual.contains(message), "{text:?}: {actual}");
    }
    let mixed = "# test: uniaxial\nstretch [-];nominal_stress [MPa]\n1,1;0.1\n1,2;0.2\n";
    assert!(fit(mixed, &[]).contains("mixed"));
    fs::write(folder.path().join("b.csv"), b"stretch,\0\xff\n").unwrap();
    let arguments = ["materials", "fit", "b.csv", "--all"];
    let refused = gelbench(folder.path(), &arguments).code(2);
    assert!(words(&refused.get_output().stderr).contains("is not a text file"));
}

/// The terminal, the card and the figures say what was read; a card that was changed by hand is a warning.
#[test]
fn what_was_read_stands_with_the_fit_and_a_changed_card_is_told() {
    let folder = TempDir::new().unwrap();
    let text = "Extension (mm),Load 2 (N),Load (N)\n0,0,0\n2,0,0.27\n4,0,0.5\n6,0,0.7\n8,0,0.9\n";
    fs::write(folder.path().join("a.csv"), text).unwrap();
    let fit = "materials fit a.csv --law neo-hooke --test uniaxial --name a --output .";
    let mut arguments: Vec<&str> = fit.split(' ').collect();
    arguments.extend(["--length", "20 mm", "--area", "10 mm^2"]);
    let asked = gelbench(folder.path(), &arguments).code(2);
    let asked = words(&asked.get_output().stderr);
    assert!(asked.contains("--columns \"stress=Load (N)\""), "{asked}");
    arguments.extend(["--columns", "stress=Load [N]"]);
    let printed = words(
        &gelbench(folder.path(), &arguments)
            .code(0)
            .get_output()
            .stdout,
    );
    let read = "displacement from `Extension` [mm] over 20 mm, force from `Load` [N] over 10 mm²; lines 2 to 6; not read: `Load 2`";
    assert!(printed.contains(read), "{printed}");
    let card = fs::read_to_string(folder.path().join("a.toml")).unwrap();
    assert!(
        card.contains(read) && card.contains("values = [\"c10 = "),
        "{card}"
    );
    let figures = fs::read_to_string(folder.path().join("a.json")).unwrap();
    let figures: Value = serde_json::from_str(&figures).unwrap();
    assert_eq!(figures["data"][0]["columns"][1]["column"], "`Load`");
    assert_eq!(figures["data"][0]["lines"], serde_json::json!([2, 6]));
    let refit = gelbench(folder.path(), &["materials", "refit", "a.toml"]).code(0);
    assert!(!words(&refit.get_output().stderr).contains("was changed"));
    let parameter = card
        .lines()
        .find(|line| line.starts_with("c10 = "))
        .unwrap();
    let changed = card.replace(parameter, "c10 = \"0.06 MPa\"");
    fs::write(folder.path().join("a.toml"), changed).unwrap();
    let shown = gelbench(folder.path(), &["materials", "show", "a.toml"]).code(0);
    let warned = words(&shown.get_output().stderr);
    assert!(
        warned.contains("was changed since its fit: c10 = 0.06 where the fit"),
        "{warned}"
    );
}

#[test]
fn test_data_are_converted() {
    let folder = TempDir::new().unwrap();
    let text = "# test: uniaxial\nnominal_strain [%];nominal_stress [kPa]\n50,0;200,0\n";
    fs::write(folder.path().join("a.csv"), text).unwrap();
    let arguments = ["materials", "convert", "a.csv", "--to-stress", "cauchy"];
    let done = gelbench(folder.path(), &arguments).code(0);
    let expected = "# test: uniaxial\nstretch [-],cauchy_stress [MPa]\n1.5,0.30000000000000004\n";
    assert_eq!(words(&done.get_output().stdout), expected);
}

/// `--fix` takes units, and a card with a stated angle is made again.
#[test]
fn a_stated_parameter_is_held_and_stands_on_the_card() {
    let folder = TempDir::new().unwrap();
    let data = root().join("validation/measured/tissue_biaxial/protocols.csv");
    let data = data.to_str().unwrap();
    let fit = |fixed: &'static str| {
        let fixed = [
            "--law",
            "lee-sacks",
            "--name",
            "a",
            "--output",
            ".",
            "--fix",
            fixed,
        ];
        let arguments = [&["materials", "fit", data, "--one-specimen"][..], &fixed].concat();
        gelbench(folder.path(), &arguments)
    };
    let done = fit("angle=3 deg").code(0);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("rad   held, not fitted"), "{printed}");
    let figures = fs::read_to_string(folder.path().join("a.json")).unwrap();
    let figures: Value = serde_json::from_str(&figures).unwrap();
    let angle = &figures["parameters"][5];
    assert_eq!([&angle["held"], &angle["at_bound"]], [true, false]);
    assert!((angle["value"].as_f64().unwrap() - 3_f64.to_radians()).abs() < 1e-12);
    gelbench(folder.path(), &["materials", "refit", "a.toml"]).code(0);
    for (wrong, why) in [("angle=3 mm", "cannot be read"), ("kappa=1", "`kappa`")] {
        let message = words(&fit(wrong).code(2).get_output().stderr);
        assert!(message.contains(why), "{message}");
    }
    let law = ["--law", "holzapfel-gasser-ogden", "--fix", "families=three"];
    let refused = gelbench(
        folder.path(),
        &[&["materials", "fit", data][..], &law].concat(),
    );
    let message = words(&refused.code(2).get_output().stderr);
    assert!(
        message.contains("cannot have families = three"),
        "{message}"
    );
}

/// Two groups of uniaxial tests: means, spread and difference in one table, a picture, and a card of each mean law, which a fit of its data
/// is again; a single specimen, tests of two kinds and a test that is given twice are refused.
#[test]
fn groups_of_specimens_are_averaged_and_compared() {
    let folder = tempfile::TempDir::new().unwrap();
    let write = |name: &str, head: &str, c10: f64| {
        let rows = (0..=20).map(|row| {
            let stretch = 1.0 + 0.05 * f64::from(row);
            let noise = 1e-4 * f64::from((row * 7) % 5 - 2);
            let stress = 2.0 * c10 * (stretch - stretch.powi(-2)) + noise;
            format!("{stretch},{stress}\n")
        });
        let text = format!(
            "# test: {head}\nstretch [-],nominal_stress [MPa]\n{}",
            rows.collect::<String>()
        );
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    for (number, c10) in [0.09, 0.1, 0.11, 0.14, 0.15, 0.16].into_iter().enumerate() {
        write(&format!("{number}.csv"), "uniaxial", c10);
    }
    write("planar.csv", "planar", 0.1);
    write("planar-2.csv", "planar", 0.12);
    write("copy.csv", "uniaxial", 0.1);
    let group = |files: &[&str]| {
        let more = [
            "--names",
            "control,treated",
            "--law",
            "neo-hooke",
            "--output",
            "out",
        ];
        gelbench(
            folder.path(),
            &[&["materials", "group"], files, &more].concat(),
        )
    };
    group(&[
        "0.csv",
        "1.csv",
        "2.csv",
        "--against",
        "3.csv",
        "4.csv",
        "5.csv",
    ])
    .code(0);
    let text = std::fs::read_to_string(folder.path().join("out/group.json")).unwrap();
    let figures: serde_json::Value = serde_json::from_str(&text).unwrap();
    for (number, c10) in [0.1, 0.15].into_iter().enumerate() {
        let group = &figures["groups"][number];
        let mean = group["mean_law"][0]["value"].as_f64().unwrap();
        assert!((mean - c10).abs() < 1e-3 * c10, "{mean}");
        let last = &group["states"][19];
        let between = last["between_specimens_MPa"].as_f64().unwrap();
        let right = 2.0 * 0.01 * (2.0 - 0.25);
        assert!((between - right).abs() < 0.02 * right, "{between} {right}");
    }
    for file in ["group.csv", "group.png", "group-control.csv"] {
        assert!(folder.path().join("out").join(file).exists(), "{file}");
    }
    gelbench(
        folder.path(),
        &["materials", "refit", "out/group-treated.toml"],
    )
    .code(0);
    for (files, message) in [
        (&["0.csv", "planar.csv"][..], "a test of another kind"),
        (
            &["0.csv", "1.csv", "--against", "planar.csv", "planar-2.csv"],
            "a test of another kind",
        ),
        (
            &["0.csv", "1.csv", "--against", "2.csv"],
            "2 values required",
        ),
        (&["0.csv", "0.csv", "1.csv"], "0.csv is given twice"),
        (
            &["0.csv", "1.csv", "--against", "2.csv", "copy.csv"],
            "copy.csv has the same rows as 1.csv",
        ),
    ] {
        let run = group(files).code(2);
        let printed = crate::common::words(&run.get_output().stderr);
        assert!(printed.contains(message), "{printed}");
    }
    let fit = ["materials", "fit", "0.csv", "0.csv", "--law", "neo-hooke"];
    let run = gelbench(folder.path(), &fit).code(2);
    assert!(words(&run.get_output().stderr).contains("0.csv is given twice"));
}
