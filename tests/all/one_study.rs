//! One study of a sheet: the same strip as a plate and as a specimen; models, outputs and supports that every study has.

use std::collections::BTreeSet;
use std::path::Path;

use crate::common::{folder_with, gelbench};
use gelbench::budget::Budget;
use gelbench::kinds::read_given;
use gelbench::results::{Content, Drawing, Results};
use gelbench::studies::Progress;

fn computed(text: &str) -> Results {
    let read = read_given(Path::new("sheet.toml"), text.to_owned(), Budget::USUAL);
    let read = read.unwrap_or_else(|fault| panic!("{fault}"));
    read.compute(Progress::silent()).unwrap()
}

const PLATE: &str = "[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"2 mm\"\ncells = [24, 8]\n\
    [material]\ncard = \"pva-10\"\n[load]\nstretches = [\"15 %\", \"30 %\"]\n\
    [corrector]\ngrading = 1\nmethod = \"direct\"\n[finite_element]\ncells = [48, 16]\ngrading = 1\n";

const STRIP: &str = "kind = \"specimen\"\n[specimen]\nshape = \"strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"2 mm\"\n\
    cells = 8\n[material]\ncard = \"pva-10\"\n\
    [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
    [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"30 mm\"\ny = \"0 mm\"\n\
    [path]\nfactors = [0.15, 0.3]\nmeasured_group = \"right\"\n";

fn force(results: &Results, step: usize, model: &str) -> f64 {
    let of_model = &results.outcome.steps[step].models[model];
    of_model["groups"]["right"]["force_N"][0].as_f64().unwrap()
}

#[test]
fn a_plate_and_the_same_strip_have_the_same_forces_findings_and_files() {
    // So that the finite elements of neither are refined once more.
    let tolerant =
        "[tolerances]\ndisplacement = \"50 %\"\nforce = \"50 %\"\ncorrection = \"10 %\"\n";
    let [plate, strip] = [PLATE, STRIP].map(|text| computed(&format!("{text}{tolerant}")));
    for step in [0, 1] {
        for (model, digits) in [
            ("mass_spring", 1e-11),
            ("corrected", 1e-9),
            ("finite_element", 1e-9),
        ] {
            let [one, other] = [&plate, &strip].map(|results| force(results, step, model));
            assert!((one / other - 1.0).abs() < digits, "{model}: {one} {other}");
        }
    }
    let names = |results: &Results| {
        let figures = results.outcome.figures.iter();
        let figures = figures.map(|figure| figure.name.clone());
        let grids = results
            .outcome
            .grids
            .iter()
            .map(|series| series.name.clone());
        let files = results.outcome.files.iter().map(|(name, _)| name.clone());
        figures
            .chain(grids)
            .chain(files)
            .collect::<BTreeSet<String>>()
    };
    assert_eq!(names(&plate), names(&strip));
    let findings = |results: &Results| {
        let warnings = results.outcome.warnings();
        let at = |text: String| {
            text.replace("15 % stretch", "load factor 0.15")
                .replace("30 % stretch", "load factor 0.3")
                // Only plates have this remedy.
                .replace(
                    "; an area term (`mass_spring.area_term`) gives them the sheet's ν",
                    "",
                )
        };
        warnings.map(at).collect::<Vec<_>>()
    };
    assert_eq!(findings(&plate), findings(&strip));
    let quantities = |results: &Results| {
        let checks = results.outcome.checks.iter();
        let names = checks.map(|check| check.quantity.clone());
        names
            .filter(|name| !name.contains("departure"))
            .collect::<Vec<_>>()
    };
    assert_eq!(quantities(&plate), quantities(&strip));
    for (model, of_strip) in &strip.outcome.steps[0].models {
        let of_plate = plate.outcome.steps[0].models[model].as_object().unwrap();
        for key in of_strip.as_object().unwrap().keys() {
            assert!(of_plate.contains_key(key), "{model}.{key}");
        }
    }
}

#[test]
fn a_model_that_a_study_leaves_out_is_not_computed() {
    let tolerant = "[tolerances]\ndisplacement = \"5 %\"\nforce = \"5 %\"\ncorrection = \"10 %\"\n";
    for text in [PLATE, STRIP].map(|text| format!("{text}{tolerant}")) {
        let text = &text;
        let alone = computed(&format!("models = [\"finite-element\"]\n{text}"));
        let models = &alone.outcome.steps[1].models;
        assert!(models["mass_spring"].is_null() && models["corrected"].is_null());
        let complete = force(&computed(text), 1, "finite_element");
        assert_eq!(force(&alone, 1, "finite_element"), complete);
        assert!(alone.passed() && alone.outcome.checks.is_empty());
        assert!(!alone.outcome.headline.is_empty());
        let others = computed(&format!(
            "models = [\"mass-spring\", \"corrected\"]\n{text}"
        ));
        assert!(others.outcome.steps[1].models["finite_element"].is_null());
        assert!(force(&others, 1, "corrected") > 0.0 && others.passed());
    }
    let none = folder_with(&format!("models = []\n{PLATE}"));
    gelbench(none.path(), &["check", "small.toml"]).code(2);
}

#[test]
fn every_study_says_what_it_writes_and_where() {
    let output = "\n[output]\nfolder = \"there\"\nvtk = false\nplots = false\n";
    let motion = "kind = \"motion\"\n[material]\ncard = \"neo-hooke\"\ndensity = \"1000 kg/m^3\"\n\
        [plate]\nlength = \"20 mm\"\nwidth = \"10 mm\"\nthickness = \"1 mm\"\ncells = [8, 4]\n\
        [start]\nstretch = 0.1\n[grip]\nmotion = \"release\"\ntime = \"0 s\"\n[time]\nduration = \"1 ms\"\ninterval = \"0.5 ms\"\n\
        [finite_element]\ncells = [4, 2]\n";
    for text in [PLATE, STRIP, motion] {
        let folder = folder_with(&format!("{text}{output}"));
        gelbench(folder.path(), &["run", "small.toml"]);
        let there = folder.path().join("there");
        assert!(there.join("report.html").exists(), "{text}");
        let names = std::fs::read_dir(&there).unwrap();
        let names: Vec<String> = names
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        let is_drawn = |name: &String| name.ends_with(".png") && name != "small.png";
        assert!(
            !names.iter().any(|name| is_drawn(name) || name == "vtk"),
            "{names:?}"
        );
    }
}

/// A sector of a ring between two symmetry lines is the ring, whatever its angle: under pressure inside it widens alike.
#[test]
fn a_sector_of_any_angle_between_symmetry_lines_is_the_ring() {
    let widened = |angle: f64| {
        let text = format!(
            "kind = \"specimen\"\n[specimen]\nshape = \"ring-sector\"\ninner_radius = \"10 mm\"\nouter_radius = \"15 mm\"\n\
             angle = \"{angle} deg\"\nthickness = \"1 mm\"\ncells = 8\n[material]\ncard = \"neo-hooke\"\n\
             [[support]]\ngroup = \"start\"\nkind = \"symmetry\"\n[[support]]\ngroup = \"end\"\nkind = \"symmetry\"\n\
             [[load]]\ngroup = \"inside\"\nkind = \"pressure\"\npressure = \"5 kPa\"\n\
             [path]\nfactors = [1.0]\nmeasured_group = \"start\"\n"
        );
        let results = computed(&text);
        let models = &results.outcome.steps[0].models;
        let force = |model: &str| {
            let force = &models[model]["groups"]["start"]["force_N"];
            force[0].as_f64().unwrap().hypot(force[1].as_f64().unwrap())
        };
        let balance = results.outcome.balance.unwrap();
        assert!(balance < 1e-8, "{balance}");
        [force("corrected"), force("finite_element")]
    };
    let [_, right_angle] = widened(90.0);
    for angle in [37.0, 61.3, 120.0] {
        let [corrected, elements] = widened(angle);
        assert!(
            (elements / right_angle - 1.0).abs() < 1e-4,
            "{angle}: {elements} {right_angle}"
        );
        assert!(
            (corrected / right_angle - 1.0).abs() < 5e-3,
            "{angle}: {corrected} {right_angle}"
        );
    }
}

/// A line that is parallel to no axis is one to slide along, unless another support moves a node of it off that line.
#[test]
fn a_support_that_leaves_the_line_of_another_one_is_a_fault() {
    let text = "kind = \"specimen\"\n[specimen]\nshape = \"ring-sector\"\ninner_radius = \"10 mm\"\nouter_radius = \"15 mm\"\n\
        angle = \"37 deg\"\nthickness = \"1 mm\"\ncells = 4\n[material]\ncard = \"neo-hooke\"\n\
        [[support]]\ngroup = \"end\"\nkind = \"roller\"\n\
        [[support]]\ngroup = \"outside\"\nkind = \"displacement\"\nx = \"1 mm\"\ny = \"0 mm\"\n\
        [path]\nfactors = [1.0]\nmeasured_group = \"outside\"\n";
    let folder = folder_with(text);
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let messages = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(messages.contains("slides along a line"), "{messages}");
}

/// The rows of a table of a study as numbers behind the names of model and place.
fn rows(results: &Results, table: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut files = results.outcome.files.iter();
    let text = files.find_map(|(name, content)| match content {
        Content::Text(text) if name == table => Some(text),
        _ => None,
    });
    let mut lines = text.unwrap_or_else(|| panic!("no {table}")).lines();
    let cells = |line: &str| line.split(',').map(str::to_owned).collect();
    let head = cells(lines.next().unwrap());
    (head, lines.map(cells).collect())
}

#[test]
fn what_is_measured_within_a_sheet_in_uniaxial_tension_is_exact_in_every_model_that_is() {
    const MEASURED: &str = "[[probe]]\nname = \"off\"\nat = [\"7 mm\", \"2.5 mm\"]\n\
        [[line]]\nname = \"across\"\nfrom = [\"11 mm\", \"-9 mm\"]\nto = [\"11 mm\", \"9 mm\"]\npoints = 19\n\
        [[extensometer]]\nname = \"clip\"\nfrom = [\"5 mm\", \"1 mm\"]\nto = [\"20 mm\", \"1 mm\"]\n";
    let strip = STRIP.replace(
        "[[support]]\ngroup = \"left\"\nkind = \"clamp\"\n",
        SYMMETRIC,
    );
    let strip = strip.replace("x = \"30 mm\"\ny = \"0 mm\"", "x = \"30 mm\"");
    let results = computed(&(strip + MEASURED));
    let of = |head: &[String], row: &[String], name: &str| -> f64 {
        let column = head.iter().position(|entry| entry == name).unwrap();
        row[column].parse().unwrap()
    };
    let (head, probes) = rows(&results, "probes.csv");
    let (lengths, extensometers) = rows(&results, "extensometers.csv");
    let (_, lines) = rows(&results, "lines.csv");
    assert_eq!(
        (probes.len(), extensometers.len()),
        (6, 6),
        "three models, two steps"
    );
    // From −9 to 9 mm, of which the sheet takes −5 to 5 mm.
    let on_sheet = lines.iter().filter(|row| !row[6].is_empty()).count();
    assert_eq!((lines.len(), on_sheet), (6 * 19, 6 * 11));
    let exact = |row: &&Vec<String>| row[0] != "mass-spring";
    for (row, clip) in probes
        .iter()
        .zip(&extensometers)
        .filter(|(row, _)| exact(row))
    {
        let stretch = 1.0 + of(&head, row, "load_factor");
        let close = |name: &str, expected: f64| {
            let value = of(&head, row, name);
            assert!((value - expected).abs() < 1e-9, "{name} {value} {expected}");
        };
        close("stretch_1", stretch);
        close("stretch_2", stretch.powf(-0.5));
        close("displacement_x_mm", 7.0 * (stretch - 1.0));
        close("cauchy_xy_MPa", 0.0);
        assert!((of(&lengths, clip, "extensometer_stretch") - stretch).abs() < 1e-9);
        // σ A, with A = A₀ / λ of 10 × 2 mm².
        let force = 20.0 / stretch * of(&head, row, "cauchy_xx_MPa");
        assert!((of(&lengths, clip, "force_x_N") / force - 1.0).abs() < 1e-8);
    }
    let names: Vec<&str> = results
        .outcome
        .figures
        .iter()
        .map(|figure| &*figure.name)
        .collect();
    for name in [
        "sheet_probes.png",
        "sheet_line_across_002.png",
        "sheet_extensometers.png",
    ] {
        assert!(names.contains(&name), "{names:?}");
    }
}

/// A left end that slides along itself, on an axis of symmetry along x.
const SYMMETRIC: &str = "[[support]]\ngroup = \"left\"\nkind = \"displacement\"\nx = \"0 mm\"\n\
    [[support]]\ngroup = \"bottom\"\nkind = \"displacement\"\ny = \"0 mm\"\n";

#[test]
fn pictures_show_the_fields_models_range_and_title_that_a_study_wants() {
    let of = |pictures: &str| {
        let results = computed(&format!("{STRIP}[pictures]\n{pictures}"));
        let figures = results.outcome.figures.into_iter();
        let fields = figures.filter_map(|figure| match figure.drawing {
            Drawing::Field(field) if figure.name.contains("cauchy_xx") => Some(field),
            _ => None,
        });
        fields.collect::<Vec<_>>()
    };
    let [figure] = &of("fields = [\"cauchy-xx\"]\nmodels = [\"finite-element\"]\n\
        range = [\"0 kPa\", \"20 kPa\"]\ntitle = \"Stress\"\n")[..]
    else {
        panic!("one figure");
    };
    assert_eq!(
        (figure.range, &*figure.title),
        (Some([0.0, 0.02]), "Stress")
    );
    assert_eq!(figure.panels.len(), 1);
    let [figure] = &of("fields = [\"cauchy-xx\"]\n")[..] else {
        panic!("one figure");
    };
    assert_eq!((figure.range, figure.panels.len()), (None, 3));
    assert!(figure.title.starts_with("Cauchy stress along x at"));
    for (pictures, message) in [
        (
            "range = [\"0 MPa\", \"1 MPa\"]\n",
            "is the range of one field",
        ),
        (
            "fields = [\"cauchy-xx\"]\nrange = [\"1 MPa\", \"0 MPa\"]\n",
            "two ascending values",
        ),
        ("font_size = 40\n", "must be"),
        ("fields = [\"cauchy-zx\"]\n", "cauchy-zx"),
    ] {
        let text = format!("{STRIP}[pictures]\n{pictures}");
        let read = read_given(Path::new("sheet.toml"), text, Budget::USUAL);
        let fault = read
            .err()
            .map(|fault| fault.to_string())
            .unwrap_or_default();
        assert!(fault.contains(message), "{pictures}: {fault}");
    }
}

#[test]
fn a_measured_curve_is_drawn_over_that_of_the_models() {
    let folder = folder_with("");
    let path = folder.path().join("sheet.toml");
    let read = |text: String| read_given(&path, text, Budget::USUAL);
    let clip = "[[extensometer]]\nname = \"clip\"\nfrom = [\"5 mm\", \"0 mm\"]\nto = [\"25 mm\", \"0 mm\"]\n";
    for (columns, scale, more) in [
        ("Kraft [kN];Standardweg [mm]", 0.01, ""),
        ("force [N],displacement [cm]", 1.0, ""),
        ("force [N],stretch", 1.0, "extensometer = \"clip\"\n"),
        ("load [N],strain [%]", 1.0, "extensometer = \"clip\"\n"),
    ] {
        let between = if columns.contains(';') { ";" } else { "," };
        let rows: String = (0..4)
            .map(|row| format!("{}{between}{row}\n", scale * f64::from(row)))
            .collect();
        std::fs::write(folder.path().join("test.csv"), format!("{columns}\n{rows}")).unwrap();
        let text = format!("{STRIP}{clip}[measured]\nfile = \"test.csv\"\n{more}");
        let results = read(text).unwrap_or_else(|fault| panic!("{columns}: {fault}"));
        let results = results.compute(Progress::silent()).unwrap();
        let mut figures = results.outcome.figures.iter();
        let figure = figures
            .find(|figure| figure.name == "sheet_measured.png")
            .unwrap();
        let Drawing::Charts(charts) = &figure.drawing else {
            panic!("a chart");
        };
        let lines = &charts[0].0.lines;
        assert_eq!((lines.len(), &*lines[0].label), (4, "measured"));
        // The third row has 2 N or 20 N, and 2 mm, 2 cm, a stretch of 200 % from rest, or 2 %.
        let [moved, force] = lines[0].points[2];
        let expected = [
            ("Standardweg", 2.0),
            ("cm", 20.0),
            ("stretch", 200.0),
            ("strain", 2.0),
        ];
        let expected = expected
            .iter()
            .find(|(name, _)| columns.contains(name))
            .unwrap()
            .1;
        assert!((moved - expected).abs() < 1e-12, "{columns}: {moved}");
        assert!(
            (force - 2.0 * scale * if between == ";" { 1e3 } else { 1.0 }).abs() < 1e-12,
            "{force}"
        );
        // The grip of 3 mm by 0.3, or what the extensometer has of it.
        assert!(
            lines[1].points.len() == 3 && lines[1].points[2][0] > 5.0,
            "{:?}",
            lines[1]
        );
    }
    for (more, message) in [
        ("[measured]\nfile = \"none.csv\"\n", "none.csv"),
        ("[measured]\nfile = \"test.csv\"\n", "no length"),
        (
            "[measured]\nfile = \"test.csv\"\nextensometer = \"clap\"\n",
            "clap",
        ),
    ] {
        let fault = read(format!("{STRIP}{clip}{more}"))
            .err()
            .unwrap()
            .to_string();
        assert!(fault.contains(message), "{fault}");
    }
}
