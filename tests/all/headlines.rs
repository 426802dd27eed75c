//! What studies of sheets say first, and the curves that they draw.

use std::path::Path;

use gelbench::budget::Budget;
use gelbench::kinds::read_given;
use gelbench::material::Card;
use gelbench::material::curve::Mode;
use gelbench::results::{Block, Drawing, Results};
use gelbench::studies::Progress;
use gelbench_report::results::Line;
use serde_json::Value;

fn computed(text: &str) -> Results {
    let ready = read_given(Path::new("small.toml"), text.to_owned(), Budget::USUAL).unwrap();
    ready.compute(Progress::silent()).unwrap()
}

/// A plate with little to compute.
fn plate(stretches: &str, cells: [usize; 2]) -> Results {
    let [along, across] = cells;
    computed(&format!(
        "[plate]\ncells = [{along}, {across}]\n[load]\nstretches = {stretches}\n[finite_element]\ncells = [{}, {}]\n\
         [corrector]\nmethod = \"direct\"\n",
        2 * along,
        2 * across
    ))
}

/// A strip of 20 × 10 mm with little to compute.
fn strip(cells: usize, supports: &str) -> Results {
    computed(&format!(
        "kind = \"specimen\"\n[material]\ncard = \"pva-10-yeoh\"\n[specimen]\nshape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\n\
         thickness = \"2 mm\"\ncells = {cells}\n[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"right\"\n{supports}"
    ))
}

const CLAMPED: &str = "[[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
    [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"6 mm\"\ny = \"0 mm\"\n";

const FREE_ACROSS: &str = "[[support]]\ngroup = \"left\"\nkind = \"symmetry\"\n\
    [[support]]\ngroup = \"bottom\"\nkind = \"roller\"\n\
    [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"6 mm\"\n";

fn lines<'a>(results: &'a Results, picture: &str) -> &'a [Line] {
    let mut figures = results.outcome.figures.iter();
    match &figures
        .find(|figure| figure.name.ends_with(picture))
        .unwrap()
        .drawing
    {
        Drawing::Charts(charts) => &charts[0].0.lines,
        other => panic!("{other:?}"),
    }
}

/// The force along x of the right side at every step.
fn forces(results: &Results, model: &str) -> Vec<[f64; 2]> {
    let steps = results.outcome.steps.iter();
    let force = |figures: &Value| match results.kind {
        "plate" => figures["force_N"].as_f64(),
        _ => figures["groups"]["right"]["force_N"][0].as_f64(),
    };
    let scale = if results.kind == "plate" { 100.0 } else { 1.0 };
    steps
        .map(|step| [scale * step.at, force(&step.models[model]).unwrap()])
        .collect()
}

#[test]
fn curves_of_force_begin_at_rest_and_have_no_point_that_was_not_computed() {
    let plate = plate("[\"10 %\", \"100 %\"]", [12, 4]);
    let strip = strip(6, CLAMPED);
    let drawn = lines(&plate, "_forces.png")
        .iter()
        .map(|line| (&plate, line));
    let drawn = drawn.chain(
        lines(&strip, "_forces.png")
            .iter()
            .map(|line| (&strip, line)),
    );
    let mut count = 0;
    for (results, line) in drawn.filter(|(results, line)| {
        // Of the strip's groups the chart of the left one comes first.
        results.kind == "plate" || line.points.len() > 1
    }) {
        let key = line
            .label
            .replace('-', "_")
            .replace("finite elements", "finite_element");
        let mut expected = forces(results, &key);
        expected.insert(0, [0.0; 2]);
        assert_eq!(line.points.len(), expected.len(), "{}", line.label);
        for (actual, expected) in line.points.iter().zip(expected) {
            let size = expected[1].abs();
            assert_eq!(actual[0], expected[0]);
            assert!(
                (actual[1].abs() - size).abs() <= 1e-6 * size.max(1.0),
                "{actual:?} {expected:?}"
            );
        }
        assert!(line.is_dashed_between_points());
        count += 1;
    }
    assert_eq!(count, 6);
}

/// The cell of the last row of a table that begins with some words: of some groups at one step, the last one.
fn cell(block: &Block, row: &str, head: &str) -> f64 {
    let Block::Table(heads, rows) = block else {
        panic!("{block:?}");
    };
    let column = heads
        .iter()
        .position(|entry| entry.starts_with(head))
        .unwrap();
    let row = rows
        .iter()
        .rfind(|entry| entry[0].starts_with(row))
        .unwrap();
    row[column].parse().unwrap()
}

#[test]
fn the_headline_of_a_strip_in_uniaxial_tension_is_that_of_its_law() {
    let results = strip(4, FREE_ACROSS);
    let [forces, largest, note] = &results.outcome.headline[..] else {
        panic!("{:?}", results.outcome.headline);
    };
    let card = Card::load("pva-10-yeoh", Path::new(".")).unwrap();
    for (step, stretch) in [("0.5", 1.15), ("1", 1.3)] {
        let nominal = Mode::Uniaxial.nominal_stress(&*card.law, stretch - 1.0);
        let displacement = cell(forces, step, "displacement along x");
        assert!((displacement - 20.0 * (stretch - 1.0)).abs() < 1e-9);
        assert!((cell(forces, step, "force along x") / (20.0 * nominal) - 1.0).abs() < 1e-4);
        if stretch == 1.3 {
            for column in ["largest", "gauge"] {
                for stress in ["principal Cauchy", "von Mises"] {
                    assert!(
                        (cell(largest, stress, column) / (stretch * nominal) - 1.0).abs() < 1e-4
                    );
                }
                assert!((cell(largest, "principal stretch", column) - stretch).abs() < 1e-4);
            }
        }
    }
    // Symmetry lines end where stress has a bound.
    assert!(!note.plain().contains("no bound"), "{note:?}");
}

#[test]
fn the_largest_stress_beside_clamps_is_not_one_of_the_mesh() {
    let [coarse, fine] = [6, 8].map(|cells| strip(cells, CLAMPED));
    let most = |results: &Results| cell(&results.outcome.headline[1], "von Mises", "largest");
    assert!((most(&coarse) / most(&fine) - 1.0).abs() < 0.01);
    // The left side only balances the right one.
    let Block::Table(_, rows) = &coarse.outcome.headline[0] else {
        panic!("{:?}", coarse.outcome.headline);
    };
    assert!(rows.len() == 2 && rows[0][1] == "right", "{rows:?}");
    let note = coarse.outcome.headline[2].plain().replace('\n', " ");
    assert!(
        note.contains("farther than 2 mm from ends of supports"),
        "{note}"
    );
}

#[test]
fn reports_and_terminals_begin_with_the_headline_of_every_kind_of_sheet() {
    let moving = "kind = \"motion\"\n[material]\ncard = \"pva-10\"\ndensity = \"1020 kg/m^3\"\n[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\n\
        thickness = \"1 mm\"\ncells = [6, 2]\n[finite_element]\nelement = \"Q2\"\ncells = [8, 4]\n[start]\nstretch = \"10 %\"\n[grip]\n\
        motion = \"release\"\ntime = \"0 s\"\n[time]\nduration = \"4 ms\"\ninterval = \"2 ms\"\nstep = \"0.05 ms\"\n";
    for results in [
        plate("[\"20 %\"]", [12, 4]),
        strip(4, CLAMPED),
        computed(moving),
    ] {
        let report = results.report();
        assert!(
            matches!(report[0], Block::Heading(1, _)),
            "{}",
            results.kind
        );
        assert_eq!(
            report[1..4],
            results.outcome.headline[..],
            "{}",
            results.kind
        );
        let Block::Table(heads, _) = &report[1] else {
            panic!("{:?}", report[1]);
        };
        assert_eq!(
            heads[2..],
            ["displacement along x [mm]", "force along x [N]"]
        );
        let Block::Table(heads, _) = &report[2] else {
            panic!("{:?}", report[2]);
        };
        assert!(heads[0].starts_with("at ") && heads.len() == 4, "{heads:?}");
        let printed = results.summary();
        let position = |words: &str| {
            printed
                .find(words)
                .unwrap_or_else(|| panic!("{words}: {printed}"))
        };
        assert!(
            position("force along x") < position("von Mises stress")
                && position("von Mises stress") < position("checks passed")
        );
    }
}
