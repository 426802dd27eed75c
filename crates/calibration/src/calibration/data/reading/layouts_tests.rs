//! Tables of one specimen in the layouts that people have: each gives the right curve, or a question.

use super::tests::read;
use crate::assertions::assert_contains;
use crate::calibration::TestData;

/// The stress of the specimen, 20 mm long with 10 mm², at a strain.
pub fn stress(strain: f64) -> f64 {
    let stretch = 1.0 + strain;
    0.1 * (stretch - stretch.powi(-2))
}

/// The strains of the rows, from rest on.
fn strains() -> impl Iterator<Item = f64> {
    (0..40).map(|row| 0.02 * f64::from(row))
}

/// The value of a column as a function of the strain.
pub type Value = fn(f64) -> f64;

/// The name of a column, and its values.
type Column = (&'static str, Value);

/// A table of named columns with values by the strain, or of columns without names.
fn table(separator: &str, columns: &[Column], has_names: bool) -> String {
    let (names, values): (Vec<&str>, Vec<Value>) = columns.iter().copied().unzip();
    let rows = rows(separator, &values);
    if has_names {
        names.join(separator) + "\n" + &rows
    } else {
        rows
    }
}

/// The rows of a table with values by the strain; a separator of `;` comes with decimal commas.
pub fn rows(separator: &str, values: &[Value]) -> String {
    let row = |strain: f64| {
        let fields = values.iter().map(|value| format!("{:.9}", value(strain)));
        let row = fields.collect::<Vec<_>>().join(separator) + "\n";
        if separator == ";" {
            row.replace('.', ",")
        } else {
            row
        }
    };
    strains().map(row).collect()
}

/// Whether every row that was read lies on the specimen's curve.
pub fn is_right(data: &TestData) -> bool {
    let on_curve = data
        .observations
        .iter()
        .all(|one| (one.stress - stress(one.strain())).abs() < 1e-6);
    on_curve && data.observations.len() == strains().count()
}

pub const SPECIMEN: [(&str, &str); 3] = [
    ("test", "uniaxial"),
    ("length", "20 mm"),
    ("area", "10 mm^2"),
];

const MEASURES: [(&str, &str); 3] = [
    ("test", "uniaxial"),
    ("stress measure", "nominal"),
    ("stress unit", "MPa"),
];

/// The choices that a question offers.
fn options(question: &str) -> Vec<String> {
    let parts = question.split("--columns ").skip(1);
    let written = parts.map(|part| match part.strip_prefix('"') {
        Some(quoted) => quoted.split('"').next(),
        None => part.split(' ').next(),
    });
    written.flatten().map(str::to_owned).collect()
}

/// Reads a table that leaves a choice: the question's options are as many as expected, and one alone gives the right curve.
fn asks(text: &str, reading: &[(&str, &str)], count: usize) {
    let question = read(text, reading).unwrap_err();
    let options = options(&question);
    assert_eq!(options.len(), count, "{question}");
    let answers = options.iter().map(|columns| {
        let answer = [reading, &[("columns", columns)]].concat();
        read(text, &answer).is_ok_and(|data| is_right(&data))
    });
    assert_eq!(answers.filter(|right| *right).count(), 1, "{question}");
}

#[test]
fn columns_without_names_are_read_where_one_order_is_possible_and_asked_for_elsewhere() {
    let columns: [Column; 2] = [("", |x| 1.0 + x), ("", stress)];
    let strain: [Column; 2] = [("", |x| x), ("", stress)];
    for separator in [",", ";", "\t", "    ", " "] {
        for exchanged in [false, true] {
            let ordered = |mut columns: [Column; 2]| {
                if exchanged {
                    columns.reverse();
                }
                table(separator, &columns, false)
            };
            // A stress of zero is no stretch.
            let reading = [&MEASURES[..], &[("strain measure", "stretch")]].concat();
            let data = read(&ordered(columns), &reading).unwrap();
            assert!(is_right(&data), "{separator:?} {exchanged}");
            let stretch = if exchanged {
                "stretch from column 2"
            } else {
                "stretch from column 1"
            };
            assert!(data.table.sentence().starts_with(stretch));
            let nominal = [("strain measure", "nominal"), ("strain unit", "-")];
            asks(&ordered(strain), &[&MEASURES[..], &nominal].concat(), 2);
        }
    }
    let three: [Column; 3] = [("", |x| 7.0 * x), ("", stress), ("", |x| 1.0 + x)];
    asks(
        &table(",", &three, false),
        &[&MEASURES[..], &[("strain measure", "stretch")]].concat(),
        2,
    );
}

#[test]
fn columns_with_names_are_read_in_any_order_with_any_separator() {
    let columns: [Column; 2] = [
        ("nominal strain [-]", |x| x),
        ("nominal stress [MPa]", stress),
    ];
    for separator in [",", ";", "\t", "    "] {
        for exchanged in [false, true] {
            let mut columns = columns;
            if exchanged {
                columns.reverse();
            }
            let data = read(&table(separator, &columns, true), &MEASURES[..2]).unwrap();
            assert!(is_right(&data), "{separator:?} {exchanged}");
        }
    }
}

#[test]
fn of_two_loads_the_user_says_which_is_that_of_the_specimen() {
    let extension: Column = ("Extension (mm)", |x| 20.0 * x);
    for names in [
        ["Load 2 (N)", "Load (N)"],
        ["Load 1 (N)", "Load 2 (N)"],
        ["Load (N)", "Force (N)"],
        ["Load (N)", "Load (N)"],
    ] {
        for exchanged in [false, true] {
            let mut loads: [Column; 2] = [(names[0], |_| 0.0), (names[1], |x| 10.0 * stress(x))];
            if exchanged {
                loads.reverse();
            }
            asks(
                &table(",", &[loads[0], extension, loads[1]], true),
                &SPECIMEN,
                2,
            );
        }
    }
    // Both cells in series, and a stress that the machine evaluates.
    let alike: [Column; 4] = [
        extension,
        ("Load (N)", |x| 10.0 * stress(x)),
        ("Load 2 (N)", |x| 10.0 * stress(x)),
        ("Stress (kPa)", |x| 1e3 * stress(x)),
    ];
    assert!(is_right(
        &read(&table(",", &alike, true), &SPECIMEN).unwrap()
    ));
}

#[test]
fn an_extensometer_beside_the_crosshead_is_asked_for_and_an_evaluation_is_not() {
    let load: Column = ("Load (N)", |x| 10.0 * stress(x));
    for (displacement, strain) in [
        ("Extension (mm)", "Tensile strain (%)"),
        ("Crosshead (mm)", "Strain (%)"),
        ("Standardweg (mm)", "Dehnung (%)"),
    ] {
        let reading = [&SPECIMEN[..], &[("strain measure", "nominal")]].concat();
        for exchanged in [false, true] {
            let mut strains: [Column; 2] = [(displacement, |x| 25.0 * x), (strain, |x| 100.0 * x)];
            if exchanged {
                strains.reverse();
            }
            asks(
                &table(",", &[strains[0], strains[1], load], true),
                &reading,
                2,
            );
        }
        let evaluated: [Column; 3] = [(displacement, |x| 20.0 * x), (strain, |x| 100.0 * x), load];
        let data = read(&table(",", &evaluated, true), &reading).unwrap();
        assert!(is_right(&data), "{displacement}");
        assert!(
            data.table.sentence().contains("not read: "),
            "{}",
            data.table.sentence()
        );
    }
}

/// A line of units below names with remarks in brackets.
#[test]
fn a_remark_in_brackets_is_no_unit_where_a_line_below_has_units() {
    let text = "Load,Tensile strain (Strain 1)\n(N),(%)\n0,0\n0.5,10\n";
    let reading = [&SPECIMEN[..], &[("strain measure", "nominal")]].concat();
    let data = read(text, &reading).unwrap();
    assert!((data.observations[1].strains[0] - 0.1).abs() < 1e-15);
    let sentence = data.table.sentence();
    assert_contains(
        &sentence,
        "nominal strain from `Tensile strain (Strain 1)` [%], force from `Load` [N] over 10 mm²; lines 3 to 4",
    );
}

#[test]
fn columns_that_are_stated_are_taken_whatever_their_names_are() {
    let text = "channel 1 [mm],channel 2 [N],channel 3 [N],t [s],time [s]\n0,0,0,0,0\n2,0.5,9,1,7\n4,1,9,2,14\n";
    let stated = [
        &SPECIMEN[..],
        &[("columns", "strain=channel 1,stress=channel 2 [N],time=time")],
    ]
    .concat();
    let data = read(text, &stated).unwrap();
    assert!((data.observations[2].strains[0] - 0.2).abs() < 1e-15);
    assert!((data.observations[2].stress - 0.1).abs() < 1e-15);
    assert_eq!(data.known_times().unwrap().unwrap()[2], 14.0);
    // Times are asked for where they are read.
    let untimed = [
        &SPECIMEN[..],
        &[("columns", "strain=channel 1,stress=channel 2")],
    ]
    .concat();
    let question = read(text, &untimed)
        .unwrap()
        .known_times()
        .unwrap_err()
        .to_string();
    assert_eq!(options(&question).len(), 2, "{question}");
    for (columns, message) in [
        ("strain=channel 9", "there is no column `channel 9`"),
        (
            "stress=channel 2 [kN]",
            "there is no column `channel 2 [kN]`",
        ),
        ("strain", "names no column"),
        ("force=channel 2", "`force` is not a known quantity"),
    ] {
        let refused = read(text, &[&SPECIMEN[..], &[("columns", columns)]].concat()).unwrap_err();
        assert_contains(&refused, message);
        assert!(!refused.contains("there is no column of"), "{refused}");
    }
    let head = format!("# columns: strain=channel 1, stress=channel 2 [N]\n{text}");
    assert_eq!(read(&head, &SPECIMEN).unwrap().observations.len(), 3);
}

#[test]
fn a_strip_is_as_long_as_it_is_pulled_whatever_its_axis_is_called() {
    let stated = [
        ("test", "uniaxial"),
        ("zero", "none"),
        ("length", "50 mm"),
        ("width", "10 mm"),
        ("thickness", "2 mm"),
    ];
    for axis in ["", "_x", "_y"] {
        let text = format!("Displacement{axis} [mm],Force{axis} [N]\n0,0\n1,2\n2,4\n");
        let data = read(&text, &stated).unwrap();
        let last = data.observations[2];
        assert!((last.strain() - 0.04).abs() < 1e-15, "{text}: {last:?}");
        assert!((last.stress - 0.2).abs() < 1e-15, "{text}: {last:?}");
    }
}
