use super::*;
use crate::logic::engine::{Engine, Task};
use crate::logic::scene::{CardFile, Grip, Outline};

fn fields(scene: &Scene) -> Vec<ShownField> {
    let mut engine = Engine::default();
    let solved = |model: Model| {
        let solution = engine.answer(&Task::settled(scene, model)).result.unwrap();
        (model, solution.displacement, solution.values)
    };
    Model::ALL.map(solved).into()
}

fn scenes() -> Vec<Scene> {
    let all = Outline::all([90.0, 30.0]).into_iter();
    let scene = |(_, outline)| Scene {
        outline,
        size: [90.0, 30.0],
        cells: [12, 4],
        grip: Grip {
            displacement: [9.0, 2.0],
            angle: 0.05,
        },
        ..Scene::default()
    };
    all.map(scene).collect()
}

fn names(written: &Written) -> Vec<&str> {
    written
        .files
        .iter()
        .map(|(name, _)| name.as_str())
        .collect()
}

#[test]
fn sheets_of_every_shape_go_out_in_every_form() {
    for scene in scenes() {
        let fields = fields(&scene);
        let give = |wanted: Wanted| Writer.answer(&wanted).unwrap();
        let grids = give(Wanted::Vtk(scene.clone(), fields.clone()));
        assert_eq!(
            names(&grids),
            [
                "mass_spring.vtu",
                "springs.vtu",
                "corrected.vtu",
                "finite_element.vtu"
            ]
        );
        let nodes = give(Wanted::Nodes(scene.clone(), fields.clone()));
        for ((_, content), (_, displacement, _)) in nodes.files.iter().zip(&fields) {
            let text = std::str::from_utf8(content).unwrap();
            assert_eq!(text.lines().count(), 1 + displacement.len() / 2);
            let last = text.lines().last().unwrap();
            let parts: Vec<f64> = last.split(',').map(|part| part.parse().unwrap()).collect();
            assert_eq!(parts[3..5], displacement[displacement.len() - 2..]);
        }
        for (_, format) in FORMATS {
            let picture = give(Wanted::SheetPicture(scene.clone(), fields.clone(), format));
            let (name, content) = &picture.files[0];
            let begin: &[u8] = match format {
                PictureFormat::Svg => b"<svg",
                _ => b"\x89PNG",
            };
            assert!(content.starts_with(begin), "{name}");
        }
    }
}

#[test]
fn vtk_files_are_read_back_with_the_field_that_went_out() {
    let scene = scenes().remove(0);
    let fields = fields(&scene);
    let grids = Writer.answer(&Wanted::Vtk(scene, fields.clone())).unwrap();
    let (name, content) = &grids.files[2];
    let files = [(std::path::PathBuf::from(name), content.clone())];
    let read = with_files(files, || {
        gelbench::markers::read(
            &[std::path::PathBuf::from(name)],
            &gelbench::markers::ReadSettings::default(),
        )
    });
    let read = read.unwrap();
    let markers = &read.series.frames[0].markers;
    let corrected = &fields[1].1;
    assert_eq!(markers.len() * 2, corrected.len());
    let far = markers
        .iter()
        .zip(corrected.chunks_exact(2))
        .map(|(marker, u)| (marker.displacement[0] - u[0]).hypot(marker.displacement[1] - u[1]));
    assert!(far.fold(0.0, f64::max) < 1e-12);
}

#[test]
fn a_chart_goes_out_as_a_table() {
    let card = CardFile::shipped("pva-10").unwrap().read().unwrap();
    let chart = gelbench_report::results::material_chart(&card);
    let wanted = Wanted::Lines("curves".into(), chart.clone());
    let written = Writer.answer(&wanted).unwrap();
    let text = String::from_utf8(written.files[0].1.clone()).unwrap();
    let points: usize = chart.lines.iter().map(|line| line.points.len()).sum();
    assert_eq!(text.lines().count(), 1 + points);
}

fn field() -> FieldQuestion {
    let text = include_bytes!("../../../../examples/measured_plate.csv");
    let files = vec![("measured_plate.csv".into(), text.to_vec())];
    FieldQuestion {
        edge_gap: "0 mm".into(),
        cell_size: "10 mm".into(),
        edges: [
            ("left", field::Edge::Rigid),
            ("right", field::Edge::Rigid),
            ("top", field::Edge::Free),
            ("bottom", field::Edge::Free),
        ]
        .map(|(name, edge)| (name.to_owned(), edge))
        .into(),
        correct: true,
        ..FieldQuestion::of(files, CardFile::shipped("pva-10").unwrap())
    }
}

#[test]
fn a_correction_goes_out_as_the_command_writes_it() {
    let mut question = field();
    question.card.name = "my gel".into();
    question.card.text.push_str("\n# changed\n");
    let written = Writer
        .answer(&Wanted::Correction(Box::new(question)))
        .unwrap();
    assert_eq!(written.name, "measured_plate");
    let names = names(&written);
    for name in [
        "report.html",
        "report.md",
        "report.json",
        "forces.csv",
        "nodes_001.csv",
        "cells_001.csv",
        "markers_001.csv",
        "vtk/corrected.pvd",
        "vtk/corrected_001.vtu",
        "vtk/markers.pvd",
        "vtk/markers_001.vtu",
        "vtk/view.py",
        "known.toml",
        "command.txt",
        "my gel.toml",
    ] {
        assert!(names.contains(&name), "{name} is not among {names:?}");
    }
    assert!(names.iter().any(|name| name.ends_with(".png")));
    let command = written.files.iter().find(|(name, _)| name == "command.txt");
    assert_eq!(
        String::from_utf8_lossy(&command.unwrap().1),
        "gelbench correct measured_plate.csv --material 'my gel.toml' --thickness '2 mm' --cell-size '10 mm' --study known.toml\n"
    );
}

#[test]
fn a_study_goes_out_as_the_command_writes_it() {
    let text = "kind = \"plate\"\n[plate]\ncells = [12, 4]\n[load]\nstretches = [\"20 %\"]\n";
    let question = StudyQuestion {
        study: "small.toml".into(),
        files: vec![("small.toml".into(), text.into())],
    };
    let written = Writer.answer(&Wanted::Study(question)).unwrap();
    let names = names(&written);
    for name in ["report.html", "report.json", "vtk/corrected_001.vtu"] {
        assert!(names.contains(&name), "{name} is not among {names:?}");
    }
    let archived = archive(&written.files).unwrap();
    let mut read = zip::ZipArchive::new(Cursor::new(archived)).unwrap();
    assert_eq!(read.len(), written.files.len());
    for (name, content) in &written.files {
        let mut stored = Vec::new();
        let mut file = read.by_name(name).unwrap();
        std::io::Read::read_to_end(&mut file, &mut stored).unwrap();
        assert_eq!(&stored, content, "{name}");
    }
}

#[test]
fn faults_are_told() {
    let fault = Writer
        .answer(&Wanted::Correction(Box::new(FieldQuestion {
            thickness: String::new(),
            ..field()
        })))
        .unwrap_err();
    assert!(fault.message.contains("thickness"), "{fault:?}");
}
