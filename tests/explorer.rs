//! The page of a report in a browser: fields can be explored, and without a program pictures are there.
//!
//! Needs `chromedriver` with Chromium or Chrome (Debian: `chromium-driver`); without it every test is listed as ignored, with the
//! reason.

use std::fs;
use std::process::{Command, ExitCode};

use libtest_mimic::{Arguments, Completion, Failed, Trial};
use tempfile::TempDir;

mod common;

use common::browser::Browser;
use common::{gelbench, machine_report, number};

const STUDY: &str = "[plate]\ncells = [12, 4]\n[load]\nstretches = [\"20 %\", \"50 %\"]\n[finite_element]\ncells = [24, 8]\n\
    [tolerances]\ndisplacement = \"5 %\"\ndeparture = \"30 %\"\nforce = \"5 %\"\n";

const TESTS: [(&str, fn()); 2] = [
    (
        "a_reader_points_drags_and_chooses",
        a_reader_points_drags_and_chooses,
    ),
    (
        "a_narrow_page_fits_and_needs_no_network",
        a_narrow_page_fits_and_needs_no_network,
    ),
];

fn main() -> ExitCode {
    let trial = |(name, test): (&str, fn())| {
        Trial::ignorable_test(name, move || -> Result<Completion, Failed> {
            if Command::new("chromedriver")
                .arg("--version")
                .output()
                .is_err()
            {
                let reason = "chromedriver is not installed (Debian: chromium-driver)";
                return Ok(Completion::ignored_with(reason));
            }
            test();
            Ok(Completion::Completed)
        })
    };
    let arguments = Arguments::from_args();
    libtest_mimic::run(&arguments, TESTS.map(trial).into()).exit_code()
}

fn report() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("small.toml"), STUDY).unwrap();
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    folder
}

fn browser() -> Browser {
    Browser::start().expect("chromedriver is there and answers")
}

/// The cells of a table's row whose first cell begins with some words.
fn row(browser: &Browser, table: &str, begin: &str) -> Vec<String> {
    let rows = browser.run(&format!(
        "return [...document.getElementById('{table}').rows].map(row => [...row.cells].map(cell => cell.textContent))"
    ));
    let rows: Vec<Vec<String>> = serde_json::from_value(rows).unwrap();
    let actual = rows.iter().find(|row| row[0].starts_with(begin));
    actual
        .unwrap_or_else(|| panic!("{begin}: {rows:?}"))
        .clone()
}

fn a_reader_points_drags_and_chooses() {
    let folder = report();
    let results = machine_report(&folder.path().join("out"));
    let browser = browser();
    browser.open(&folder.path().join("out/report.html"), [1400, 1000]);
    assert_eq!(
        browser.run("return document.getElementById('explorer').hidden"),
        false
    );

    // The middle of the sheet is at rest in the middle, and moves along the plate by half of the stretch.
    browser.point("#explorer-field", &[[0, 0]], false);
    let ux = row(&browser, "explorer-values", "displacement along x");
    for model in &ux[1..] {
        let actual: f64 = model.parse().unwrap();
        assert!((actual - 37.5).abs() < 0.3, "{ux:?}");
    }
    let head = row(&browser, "explorer-values", "at rest at (");
    assert_eq!(&head[1..], ["mass-spring", "corrected", "finite elements"]);

    // Its stress is that of the force over the deformed cross-section, nearly.
    let stress = row(
        &browser,
        "explorer-values",
        "largest principal Cauchy stress",
    );
    let force = number(&results["steps"][1], &["finite_element", "force_N"]);
    let mean = force / (50.0 * 2.0) * 1.5;
    let actual: f64 = stress[3].parse().unwrap();
    assert!((actual / mean - 1.0).abs() < 0.1, "{actual} {mean}");

    // Dragging over the curve to its first point goes to the first stretch.
    assert_eq!(
        row(&browser, "explorer-forces", "stretch")[0],
        "stretch 0.5"
    );
    browser.point("#explorer-curve", &[[500, 0], [100, 0], [-120, 0]], true);
    assert_eq!(
        row(&browser, "explorer-forces", "stretch")[0],
        "stretch 0.2"
    );
    let expected = number(&results["steps"][0], &["corrected", "force_N"]);
    let shown: f64 = row(&browser, "explorer-forces", "corrected")[1]
        .parse()
        .unwrap();
    assert!((shown / expected - 1.0).abs() < 1e-4, "{shown} {expected}");
    assert_eq!(
        browser.run("return document.getElementById('explorer-step').value"),
        "0"
    );

    // Another field has other colours, and the slider moves the step.
    let colours = "const c = document.getElementById('explorer-field'); return c.toDataURL().length + c.toDataURL().slice(-60)";
    let before = browser.run(colours);
    browser.run(
        "const s = document.getElementById('explorer-name'); s.value = 'uy'; \
         s.dispatchEvent(new Event('input'))",
    );
    assert_ne!(browser.run(colours), before);
    browser.run("const s = document.getElementById('explorer-step'); s.value = 1; s.dispatchEvent(new Event('input'))");
    assert_eq!(
        row(&browser, "explorer-forces", "stretch")[0],
        "stretch 0.5"
    );
}

fn a_narrow_page_fits_and_needs_no_network() {
    let folder = report();
    let page = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(
        page.contains("<section id=\"explorer\" hidden>"),
        "hidden until a program shows it"
    );
    assert!(page.matches("<img src=\"data:image/png;base64,").count() > 8);
    for outside in ["src=\"http", "href=\"http", "url(http", "fetch(", "import("] {
        assert!(!page.contains(outside), "{outside}");
    }
    let browser = browser();
    browser.open(&folder.path().join("out/report.html"), [500, 844]);
    let over = browser.run("return document.documentElement.scrollWidth - window.innerWidth");
    assert!(
        over.as_f64().unwrap() <= 0.0,
        "wider than the page by {over}"
    );
    assert!(browser.picture().len() > 10_000);
}
