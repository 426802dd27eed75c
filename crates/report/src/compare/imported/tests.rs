use super::*;
use crate::mesh::CellShape;

const SETTINGS: ImportSettings = ImportSettings {
    unit: None,
    array: None,
    factor: 0.5,
    time: None,
    ignored_columns: Vec::new(),
};

/// ux = 0.1 X + 0.02 Y, uy = −0.05 Y.
fn field([x, y]: [f64; 2]) -> [f64; 2] {
    [0.1 * x + 0.02 * y, -0.05 * y]
}

fn model() -> ModelField {
    let mesh = Mesh::plate([30.0, 10.0], [6, 2], CellShape::Quad4);
    let displacement = mesh.nodes.iter().flat_map(|node| field(*node)).collect();
    ModelField {
        model: "test",
        mesh,
        displacement,
    }
}

fn written(name: &str, text: &str) -> tempfile::TempPath {
    let mut builder = tempfile::Builder::new();
    let file = builder.suffix(name).tempfile().unwrap();
    std::fs::write(file.path(), text).unwrap();
    file.into_temp_path()
}

fn refusal(name: &str, text: &str) -> String {
    match ExternalField::read(&written(name, text), &SETTINGS) {
        Err(error) => error.to_string(),
        Ok(imported) => imported.sites(&model().mesh).unwrap_err().to_string(),
    }
}

/// The points of a file, and the difference of the model from its field.
fn compared(name: &str, text: &str, settings: &ImportSettings) -> (Sites, Difference) {
    let model = model();
    let imported = ExternalField::read(&written(name, text), settings).unwrap();
    let sites = imported.sites(&model.mesh).unwrap();
    let difference = sites.difference(&model).unwrap();
    (sites, difference)
}

/// A file as CalculiX writes it for a sheet of 2 × 1 cells of solids: z = ±1, the same displacements above each other.
fn frd(scale: f64, last_x: &str) -> String {
    let mut text = String::from(
        "    1C\n    1Utest\n    2C                            12                                     1\n",
    );
    let mut nodes = Vec::new();
    for z in [-1.0, 1.0] {
        for y in [0.0, 10.0] {
            for x in [0.0, 15.0, 30.0] {
                nodes.push([x, y, z]);
            }
        }
    }
    for (i, [x, y, z]) in nodes.iter().enumerate() {
        text += &format!(
            " -1{:>10}{:>12}{:>12}{:>12}\n",
            i + 1,
            scale * x,
            scale * y,
            z
        );
    }
    text += " -3\n    3C                             2                                     1\n";
    for (number, corner) in [(1, 1), (2, 2)] {
        text += &format!(" -1{number:>10}    1    0    1\n -2");
        for node in [corner, corner + 1, corner + 4, corner + 3] {
            text += &format!("{node:>10}");
        }
        for node in [corner, corner + 1, corner + 4, corner + 3] {
            text += &format!("{:>10}", node + 6);
        }
        text.push('\n');
    }
    text += " -3\n";
    for (time, factor) in [("2.50000E-01", 0.5), ("5.00000E-01", 1.0)] {
        text += "    1PSTEP                         1           1           1\n";
        text += &format!(
            "  100CL  101{time:>12}{:>12}                     0    1           1\n",
            12
        );
        text += " -4  DISP        4    1\n -5  D1          1    2    1    0\n";
        for (i, [x, y, z]) in nodes.iter().enumerate() {
            let [ux, uy] = field([*x, *y]).map(|u| scale * factor * u);
            // Above and below the middle by as much: the mean is the sheet's.
            let ux = format!("{:.5E}", ux + scale * 0.01 * z);
            let ux = if i == 11 && factor == 1.0 && !last_x.is_empty() {
                last_x
            } else {
                &ux
            };
            text += &format!(
                " -1{:>10}{:>12}{:>12}{:>12}\n",
                i + 1,
                ux,
                format!("{uy:.5E}"),
                "0.00000E+00"
            );
        }
        text += " -3\n";
    }
    text + " 9999\n"
}

#[test]
fn a_result_of_calculix_is_the_mean_over_the_thickness_at_the_load_factor() {
    let (_, difference) = compared(".frd", &frd(1.0, ""), &SETTINGS);
    assert!(difference.percent < 1e-3, "{difference:?}");
    // The first step is half of it, by its load factor or by its time.
    for (factor, time) in [(0.25, None), (0.5, Some(0.25))] {
        let first = ImportSettings {
            factor,
            time,
            ..SETTINGS
        };
        let (_, difference) = compared(".frd", &frd(1.0, ""), &first);
        assert!((difference.percent - 100.0).abs() < 1e-3, "{difference:?}");
        assert_eq!(difference.position, [30.0, 10.0]);
        assert!(
            (difference.largest - 0.5 * 3.2_f64.hypot(0.5)).abs() < 1e-5,
            "{difference:?}"
        );
    }
    // The same in metres.
    let metres = ImportSettings {
        unit: Some(1000.0),
        ..SETTINGS
    };
    let (_, difference) = compared(".frd", &frd(1e-3, ""), &metres);
    assert!(difference.percent < 1e-3, "{difference:?}");
}

#[test]
fn points_of_a_table_are_compared_where_they_are() {
    for names in ["ux_mm,uy_mm", "U [mm],V [mm]"] {
        let table = format!(
            "stretch,X_cm,Y_cm,{names}\n0.25,1,0.5,9,9\n0.5,1,0.5,1.1,-0.25\n0.5,2,0.5,2.1,-0.45\n"
        );
        let (_, difference) = compared(".csv", &table, &SETTINGS);
        // Off by 0.2 mm at (20, 5) mm alone.
        assert!((difference.largest - 0.2).abs() < 1e-12 && difference.position == [20.0, 5.0]);
        let size = (1.1_f64 * 1.1 + 0.25 * 0.25 + 2.1 * 2.1 + 0.45 * 0.45).sqrt();
        assert!(
            (difference.percent - 20.0 / size).abs() < 1e-10,
            "{difference:?}"
        );
    }
}

/// Files that are refused: ending, text, and a part of the message.
fn refused() -> Vec<(&'static str, String, &'static str)> {
    let head = "X_mm,Y_mm,ux_mm,uy_mm\n";
    let sound = || frd(1.0, "");
    vec![
        (
            ".frd",
            frd(1e-3, ""),
            "measures 0.0300 × 0.0100 mm, the specimen 30.0000 × 10.0000 mm",
        ),
        (".frd", frd(1.0, "NaN"), "that is not a number"),
        (
            ".frd",
            sound().replace("5.00000E-01    ", "7.50000E-01    "),
            "no step at the time 0.5; it has 0.25, 0.75 (choose one of these with --factor",
        ),
        (
            ".frd",
            sound().replace("DISP", "STRE"),
            "contains no displacements",
        ),
        (
            ".frd",
            sound().replace("    1    0    1\n", "    3    0    1\n"),
            "elements of the kind 3",
        ),
        (
            ".csv",
            format!("{head}31,20,1,1\n"),
            "does not reach the point at (31.0000, 20.0000) mm",
        ),
        (".csv", format!("{head}3,2,nan,1\n"), "nan"),
        (".csv", "X_mm,Y_mm,ux_mm\n3,2,1\n".into(), "no column `uy`"),
        (
            ".csv",
            "X_mm,Y_mm,ux_MPa,uy_mm\n3,2,1,1\n".into(),
            "`MPa` is not a unit of length",
        ),
        (
            ".csv",
            "stretch,X_mm,Y_mm,ux_mm,uy_mm\n0.7,3,2,1,1\n".into(),
            "no rows for the load factor 0.5",
        ),
        (
            ".csv",
            format!("{}3,2,1,1,0.3\n", head.replace('\n', ",uz_mm\n")),
            "do not stay in a plane: `uz` reaches 0.3000 compared with 1.0000",
        ),
        (
            ".csv",
            format!("{}3,2,1,1,0.5\n", head.replace('\n', ",strech\n")),
            "column `strech` is not known here (did you mean `stretch`?",
        ),
        (
            ".csv",
            format!("{}3,2,1,1,7\n", head.replace('\n', ",temperature\n")),
            "known columns: x, y, ux, uy, stretch, load_factor, factor, time, node, z, uz; ignore it with --ignore-columns temperature",
        ),
        (
            ".csv",
            format!("{}3,2,1,1,7\n", head.replace('\n', ",ux\n")),
            "`ux` repeats another column",
        ),
        (
            ".csv",
            format!("{head}0.003,0.002,0.001,0\n0.03,0.01,0.001,0\n"),
            "about a factor of 1000",
        ),
        (
            ".csv",
            format!("{}3,2,1,1,0.7\n", head.replace('\n', ",time\n")),
            "no rows for the time 0.5 (choose one that it has with --time: 0.7",
        ),
        (
            ".csv",
            format!("{head}3,2,1,1\n4,2,1,1\n3,2,1,1\n4,2,1,0.9\n"),
            "two displacements at (4, 2) mm: (1, 1) and (1, 0.9) mm (leave the rows of one load factor",
        ),
        (
            ".docx",
            String::new(),
            "is not a .vtu, .vtk, .pvd, .msh, .frd or .csv file",
        ),
    ]
}

#[test]
fn fields_that_do_not_fit_are_refused_with_the_reason() {
    for (name, text, expected) in refused() {
        let message = refusal(name, &text);
        assert!(
            message.to_lowercase().contains(&expected.to_lowercase()),
            "{expected}: {message}"
        );
    }
}

#[test]
fn columns_choose_rows_and_are_passed_over_by_wish() {
    let table = "stretch [%],time,X_mm,Y_mm,ux_mm,uy_mm,uz_mm,note\n\
                 50,2,10,5,1.1,-0.25,0.9,3\n50,1,10,5,9,9,0,3\n25,2,10,5,9,9,0,3\n";
    let ignoring = |lift: &str| ImportSettings {
        time: Some(2.0),
        ignored_columns: vec![lift.into(), "note".into()],
        ..SETTINGS
    };
    for lift in ["uz", "uz_mm"] {
        let (sites, difference) = compared(".csv", table, &ignoring(lift));
        assert_eq!(sites.positions, [[10.0, 5.0]]);
        assert!(difference.percent < 1e-10);
    }
    let settings = ignoring("uz");
    let error =
        ExternalField::read(&written(".csv", "x,y,ux,uy\n1,2,3,4\n"), &settings).unwrap_err();
    assert!(error.to_string().contains("no column `time`"), "{error}");
}

#[test]
fn displacements_in_another_unit_are_told_by_their_magnitude() {
    let table = "X_mm,Y_mm,ux_mm,uy_mm\n10,5,0.0011,-0.00025\n20,5,0.0021,-0.00025\n";
    let (_, difference) = compared(".csv", table, &SETTINGS);
    assert_eq!(difference.other_unit(), Some(1000.0));
    // In metres as a whole, and labelled mm: --unit corrects the head.
    let metres = "X_mm,Y_mm,ux_mm,uy_mm\n0.01,0.005,0.0011,-0.00025\n0.02,0.005,0.0021,-0.00025\n";
    let settings = ImportSettings {
        unit: Some(1000.0),
        ..SETTINGS
    };
    let (_, right) = compared(".csv", metres, &settings);
    assert!(
        right.percent < 1e-10 && right.other_unit().is_none(),
        "{right:?}"
    );
}

#[test]
fn displacements_of_another_load_factor_are_told() {
    let half = "X_mm,Y_mm,ux_mm,uy_mm\n10,5,0.55,-0.125\n20,5,1.05,-0.125\n25,2,1.27,-0.05\n";
    let other = "X_mm,Y_mm,ux_mm,uy_mm\n10,5,0.55,0.125\n20,5,0.1,-0.9\n25,2,0.5,-0.05\n";
    for (table, scaled) in [(half, true), (other, false)] {
        let (_, difference) = compared(".csv", table, &SETTINGS);
        assert_eq!(difference.is_scaled(), scaled, "{difference:?}");
        if scaled {
            assert!((difference.factor - 2.0).abs() < 1e-10 && difference.scaled_percent < 1e-10);
        }
    }
}

#[test]
fn a_mistake_in_how_a_field_is_written_is_told() {
    let difference_of = |written: &dyn Fn([f64; 2], [f64; 2]) -> [f64; 2]| {
        let positions = [[10.0, 5.0], [20.0, 5.0], [25.0, 2.0], [3.0, 8.0]];
        let rows = positions.map(|[x, y]| {
            let [ux, uy] = written([x, y], field([x, y]));
            format!("{x},{y},{ux},{uy}\n")
        });
        let table = format!("X_mm,Y_mm,ux_mm,uy_mm\n{}", rows.concat());
        compared(".csv", &table, &SETTINGS).1
    };
    for mistake in Mistake::ALL {
        let difference = difference_of(&|[x, y]: [f64; 2], [ux, uy]: [f64; 2]| match mistake {
            Mistake::FinalPositions => [x + ux, y + uy],
            // The others undo themselves.
            _ => mistake.intended([x, y], [ux, uy]),
        });
        assert_eq!(difference.mistake, Some(mistake), "{difference:?}");
    }
    for factor in [1.0, 0.8, 3.0, 1e-3] {
        let difference = difference_of(&|_, u: [f64; 2]| u.map(|u| factor * u));
        assert_eq!(difference.mistake, None, "{difference:?}");
    }
}

#[test]
fn a_motion_of_the_whole_body_is_told_from_a_strain() {
    let (turn, offset) = (0.02, [0.3, -0.2]);
    let row = |[x, y]: [f64; 2], moved: bool| {
        let [ux, uy] = field([x, y]);
        let (x_now, y_now) = (x + ux, y + uy);
        let [dx, dy] = if moved {
            [offset[0] - turn * y_now, offset[1] + turn * x_now]
        } else {
            [0.02 * x, -0.02 * y]
        };
        format!("{x},{y},{},{}\n", ux - dx, uy - dy)
    };
    let positions = [
        [3.0, 2.0],
        [10.0, 5.0],
        [20.0, 5.0],
        [25.0, 2.0],
        [12.0, 9.0],
    ];
    for moved in [true, false] {
        let rows = positions.map(|position| row(position, moved)).concat();
        let table = format!("X_mm,Y_mm,ux_mm,uy_mm\n{rows}");
        let (_, difference) = compared(".csv", &table, &SETTINGS);
        assert!(difference.percent > 2.0);
        assert_eq!(difference.is_shifted(), moved, "{difference:?}");
        if moved {
            assert!(
                (difference.shift.angle / turn - 1.0).abs() < 1e-3,
                "{difference:?}"
            );
            // What is left is of the second order in the turn.
            assert!(difference.shifted_percent < 0.3, "{difference:?}");
        }
    }
}
