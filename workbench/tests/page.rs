//! The page in a browser without a display: it loads, the grip is pulled, files are dropped, and the figures are those of the
//! desktop. It needs Chromium and the page in `target/page` (`workbench/page/build`); where one of them is missing every test
//! is listed as ignored, with the reason. With `GELBENCH_SCREENSHOTS=FOLDER` it leaves pictures of all views there.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use gelbench_workbench::logic::background::Worker;
use gelbench_workbench::logic::engine::{Engine, Task};
use gelbench_workbench::logic::field::{Edge, FieldCorrector, FieldQuestion};
use gelbench_workbench::logic::material::{FitQuestion, Fitter, TestFile};
use gelbench_workbench::logic::scene::{CardFile, Model, Scene};
use libtest_mimic::{Arguments, Completion, Failed, Trial};
use serde_json::{Value, json};

mod browser;
use browser::Browser;

const TESTS: [(&str, fn()); 5] = [
    (
        "the_page_loads_follows_the_hand_and_finds_what_the_desktop_finds",
        the_page_loads_follows_the_hand_and_finds_what_the_desktop_finds,
    ),
    (
        "a_finger_pulls_the_grip_where_pixels_are_small",
        a_finger_pulls_the_grip_where_pixels_are_small,
    ),
    (
        "a_link_restores_the_sheet_with_a_card_of_its_own",
        a_link_restores_the_sheet_with_a_card_of_its_own,
    ),
    (
        "the_sheet_is_let_go_and_held_again_in_the_browser",
        the_sheet_is_let_go_and_held_again_in_the_browser,
    ),
    (
        "pictures_tables_and_fields_go_out_of_the_browser",
        pictures_tables_and_fields_go_out_of_the_browser,
    ),
];

/// What takes minutes, and is there to be looked at: times of frames, and pictures. `-- --ignored` runs it.
const LOOKS: [(&str, fn()); 2] = [
    ("frames_are_timed", frames_are_timed),
    ("the_first_two_minutes", the_first_two_minutes),
];

fn main() -> ExitCode {
    let trial = |(name, test): (&str, fn())| {
        Trial::ignorable_test(name, move || -> Result<Completion, Failed> {
            if let Some(reason) = Browser::missing() {
                return Ok(Completion::ignored_with(reason));
            }
            test();
            Ok(Completion::Completed)
        })
    };
    let tests = TESTS.map(trial).into_iter();
    let looks = LOOKS.map(trial).map(|look| look.with_ignored_flag(true));
    libtest_mimic::run(&Arguments::from_args(), tests.chain(looks).collect()).exit_code()
}

/// How far figures may differ between the browser and the desktop, relative to themselves.
const SAME: f64 = 1e-9;

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// The force of a model with the study that the page tells, computed here.
fn native(study: &str, model: Model) -> [f64; 2] {
    let scene = Scene::open("page.toml".as_ref(), study, &[]).unwrap();
    let task = Task::settled(&scene, model);
    Engine::default().answer(&task).result.unwrap().force
}

fn compare_forces(state: &Value) {
    let study = state["study"].as_str().unwrap();
    for (name, model) in ["springs", "corrected", "elements"]
        .into_iter()
        .zip(Model::ALL)
    {
        let here = native(study, model);
        let there = &state[name]["force"];
        assert!(
            same(there[0].as_f64().unwrap(), here[0]),
            "{name}: {there} in the browser, {here:?} here"
        );
    }
}

fn settled(state: &Value) -> bool {
    state["settled"] == json!(true)
}

fn the_page_loads_follows_the_hand_and_finds_what_the_desktop_finds() {
    let mut page = Browser::open([1400, 900]);
    let loaded = page.loaded();
    let state = page.until(settled);
    println!(
        "loaded in {:.2} s, solved {:.2} s after that",
        loaded.as_secs_f64(),
        page.since_loaded().as_secs_f64()
    );
    assert!(loaded < Duration::from_secs(10), "{loaded:?}");
    compare_forces(&state);
    let at = [0, 1].map(|axis| state["grip_at"][axis].as_f64().unwrap());
    let before = state["stretch"].as_f64().unwrap();
    page.drag(at, [at[0] + 90.0, at[1] - 15.0]);
    let pulled =
        page.until(|state| settled(state) && state["stretch"].as_f64().unwrap() > before + 0.05);
    compare_forces(&pulled);
    page.picture("sheet_pulled");
    page.press_with_control("z");
    let back = page.until(|state| settled(state) && state["stretch"] == json!(before));
    assert_eq!(back["study"], state["study"]);
    tests_are_fitted(&mut page);
    fields_are_corrected(&mut page);
    studies_are_run(&mut page);
    every_view_is_seen_in_every_size_and_light(&mut page);
}

fn tests_are_fitted(page: &mut Browser) {
    let text = include_str!("../../materials/data/treloar_1944_uniaxial.csv");
    page.drop_file("treloar_1944_uniaxial.csv", text);
    page.until(|state| state["tab"] == json!("Material"));
    page.press_with_control("Enter");
    let state = page.until(|state| state["fits"].is_array());
    let question = FitQuestion {
        tests: vec![TestFile {
            name: "treloar_1944_uniaxial.csv".into(),
            text: text.into(),
        }],
        fit: true,
        ..FitQuestion::default()
    };
    let here = Fitter.answer(&question).unwrap().ranking.unwrap();
    let laws: Vec<&str> = here.fits.iter().map(|fit| fit.law.as_str()).collect();
    let there = state["fits"].as_array().unwrap();
    let there: Vec<&str> = there.iter().map(|fit| fit[0].as_str().unwrap()).collect();
    assert_eq!(there, laws);
}

fn fields_are_corrected(page: &mut Browser) {
    let text = include_str!("../../examples/measured_plate.csv");
    page.drop_file("measured_plate.csv", text);
    page.until(|state| state["tab"] == json!("Field"));
    page.press_with_control("Enter");
    let state = page.until(|state| state["verdicts"].is_array());
    let files = vec![("measured_plate.csv".into(), text.into())];
    let question = FieldQuestion {
        edges: ["bottom", "left", "right", "top"]
            .map(|name| (name.to_owned(), Edge::Unnamed))
            .into(),
        correct: true,
        ..FieldQuestion::of(files, CardFile::shipped("pva-10").unwrap())
    };
    let here = FieldCorrector.answer(&question).unwrap();
    let (frames, _) = here.corrected.unwrap();
    for (frame, there) in frames.iter().zip(state["verdicts"].as_array().unwrap()) {
        assert_eq!(there[0], json!(frame.verdict));
        for (number, (edge, forces)) in frame.forces.iter().enumerate() {
            let value = there[1][number][1][0][0].as_f64().unwrap();
            assert!(
                (value - forces[0][0]).abs() < 1e-7 * forces[0][0].abs(),
                "{edge}: {value} {forces:?}"
            );
        }
    }
}

fn studies_are_run(page: &mut Browser) {
    let text = include_str!("../../examples/nonlinear_spring.toml");
    page.drop_file("nonlinear_spring.toml", text);
    page.until(|state| state["tab"] == json!("Study"));
    page.press_with_control("Enter");
    let state = page.until(|state| state["report"].is_array());
    assert_eq!(state["report"][1], json!(true), "{}", state["report"]);
}

/// What is there to be pressed stands inside of the window; whether it can be read is for people to see in the pictures.
fn every_view_is_seen_in_every_size_and_light(page: &mut Browser) {
    for (size, light) in [
        ([1400, 900], false),
        ([1400, 900], true),
        ([800, 700], true),
        ([800, 700], false),
    ] {
        page.show(size, light);
        for (tab, name) in [
            ("study", "Study"),
            ("measured field", "Field"),
            ("material", "Material"),
            ("sheet", "Sheet"),
        ] {
            page.press_button(tab);
            let state = page.until(|state| state["tab"] == json!(name));
            for label in ["sheet", "material", "measured field", "study", "export"] {
                let at = [0, 1].map(|axis| state["places"][label][axis].as_f64());
                let inside = |axis: usize| {
                    let position = at[axis].unwrap();
                    0.0 < position && position < f64::from(size[axis])
                };
                assert!(inside(0) && inside(1), "{label} at {at:?} in {size:?}");
            }
            let shade = if light { "light" } else { "dark" };
            page.picture(&format!("{}_{shade}_{}", name.to_lowercase(), size[0]));
        }
    }
}

fn a_finger_pulls_the_grip_where_pixels_are_small() {
    let scene = Scene {
        cells: [24, 8],
        ..Scene::default()
    };
    let mut page = Browser::open_fine([800, 700], 2.0, &scene.study());
    let state = page.until(settled);
    let number = |value: &Value| value.as_f64().unwrap();
    assert_eq!(number(&state["pixels_per_point"]), 2.0);
    assert_eq!(
        [0, 1].map(|axis| number(&state["size"][axis])),
        [800.0, 700.0]
    );
    let at = [0, 1].map(|axis| number(&state["grip_at"][axis]));
    let before = number(&state["stretch"]);
    page.drag_with_a_finger(at, [at[0] + 40.0, at[1] + 4.0]);
    let pulled = page.until(|state| settled(state) && number(&state["stretch"]) > before + 0.05);
    let force = |state: &Value| number(&state["corrected"]["force"][0]);
    assert!(force(&pulled) > force(&state), "{pulled}");
    page.picture("sheet_touched_800_fine");
}

fn frames_are_timed() {
    for cells in [[54, 18], [118, 40], [172, 58], [346, 116]] {
        let scene = Scene {
            cells,
            ..Scene::default()
        };
        let mut page = Browser::open_with([1200, 800], &scene.study(), 600);
        let begun = Instant::now();
        let state = page.until_within(Duration::from_secs(240), |state| {
            state["frames"].is_string()
        });
        println!(
            "{} × {} cells: {} ({:.0} s)",
            cells[0],
            cells[1],
            state["frames"],
            begun.elapsed().as_secs_f64()
        );
    }
}

fn a_link_restores_the_sheet_with_a_card_of_its_own() {
    let mut scene = Scene {
        cells: [24, 8],
        ..Scene::default()
    };
    let card = scene.card.read().unwrap();
    let parameter = &card.parameters[0];
    let moved = scene
        .card
        .with_parameter(&card, parameter.key, 1.2 * parameter.value);
    scene.card = moved.unwrap();
    scene.grip.displacement = [30.0, 6.0];
    scene.grip.angle = 0.1;
    let mut page = Browser::open_with([1000, 700], &scene.study(), 0);
    let state = page.until(settled);
    let study = state["study"].as_str().unwrap();
    let restored = Scene::open("link.toml".as_ref(), study, &[]).unwrap();
    assert!((restored.grip.angle - scene.grip.angle).abs() < 1e-12);
    let grip = scene.grip;
    assert_eq!(Scene { grip, ..restored }, scene);
    compare_forces(&state);
}

fn the_sheet_is_let_go_and_held_again_in_the_browser() {
    let mut page = Browser::open([1000, 700]);
    page.until(settled);
    page.press("l");
    page.until(|state| {
        state["moving"][0]
            .as_f64()
            .is_some_and(|clock| clock > 0.02)
    });
    page.picture("sheet_let_go");
    page.press("Escape");
    page.until(|state| state["moving"].is_null());
}

fn pictures_tables_and_fields_go_out_of_the_browser() {
    let mut page = Browser::open([1400, 900]);
    page.until(settled);
    let folder = page.downloads();
    for (offer, file, begin) in [
        ("the fields as VTK", "sheet.zip", &b"PK"[..]),
        ("the sheets as PNG", "sheet.png", b"\x89PNG"),
        ("the sheets as SVG", "sheet.svg", b"<svg"),
        ("force over stretch as CSV", "force.csv", b"line,"),
        ("force over stretch as PNG", "force.png", b"\x89PNG"),
    ] {
        page.press_button("export");
        page.until(|state| state["places"][offer].is_array());
        page.picture("export");
        page.press_button(offer);
        page.until(|state| {
            state["told"]
                .as_str()
                .is_some_and(|message| message.starts_with(file))
        });
        let path = folder.join(file);
        let begun = Instant::now();
        while std::fs::metadata(&path).map_or(0, |about| about.len()) == 0 {
            assert!(
                begun.elapsed() < Duration::from_secs(60),
                "{offer} was told to be written, and is not there"
            );
            std::thread::sleep(Duration::from_millis(50));
        }
        page.until(|state| state["places"][offer].is_null());
        assert!(std::fs::read(&path).unwrap().starts_with(begin), "{offer}");
    }
}

fn the_first_two_minutes() {
    let mut page = Browser::open([1400, 900]);
    page.picture("newcomer_0_at_once");
    let state = page.until(settled);
    page.picture("newcomer_1_settled");
    let at = [0, 1].map(|axis| state["grip_at"][axis].as_f64().unwrap());
    page.drag(at, [at[0] + 120.0, at[1] - 30.0]);
    page.picture("newcomer_2_while_it_follows");
    page.until(settled);
    page.picture("newcomer_3_pulled");
    page.press_button("release");
    page.until(|state| {
        state["moving"][0]
            .as_f64()
            .is_some_and(|clock| clock > 0.01)
    });
    page.picture("newcomer_4_let_go");
    page.press("Escape");
    for (number, scene) in [
        "1 Why springs are wrong",
        "2 Effect of one correction",
        "3 Effect of T",
        "5 Few springs, then climb",
        "4 Noisy field",
    ]
    .into_iter()
    .enumerate()
    {
        page.press_button(scene);
        std::thread::sleep(Duration::from_millis(300));
        match scene.starts_with('4') {
            true => page.until(|state| state["verdicts"].is_array()),
            false => page.until(settled),
        };
        page.picture(&format!("newcomer_{}_{}", 5 + number, &scene[..1]));
    }
    for (number, tab) in ["material", "study"].into_iter().enumerate() {
        page.press_button(tab);
        std::thread::sleep(Duration::from_millis(500));
        page.picture(&format!("newcomer_{}_{tab}", 10 + number));
    }
    page.press_button("sheet");
    page.press_button("export");
    page.picture("newcomer_12_export");
}
