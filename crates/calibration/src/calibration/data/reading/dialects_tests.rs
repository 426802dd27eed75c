//! The same specimen in the dialects of testing machines: units in names, in brackets, or in a line of their own; columns in any order; force,
//! stress or both; one axis or two.

use super::layouts_tests::{SPECIMEN, Value, is_right, rows, stress};
use super::tests::read;
use crate::assertions::assert_contains;

/// A quantity with its unit, and its values by the strain.
type Quantity = (&'static str, &'static str, Value);

/// The columns of a table, and what is stated of it.
type Case<'a> = (&'a [Quantity], &'a [(&'a str, &'a str)]);

/// How a dialect writes a name with its unit.
type Dialect = fn(&str, &str) -> String;

const DIALECTS: [Dialect; 7] = [
    |name, unit| format!("{name} ({unit})"),
    |name, unit| format!("{name}_{unit}"),
    |name, unit| format!("{name}/{unit}"),
    |name, unit| format!("\"{name} [{unit}]\""),
    |name, unit| format!("{name} in {unit}"),
    |name, unit| format!("{name}..{unit}."),
    |name, _| name.to_owned(),
];

/// A table of some columns; the last dialect writes its units in a second line.
fn table(columns: &[Quantity], dialect: usize, separator: &str) -> String {
    let names = columns
        .iter()
        .map(|(name, unit, _)| DIALECTS[dialect](name, unit));
    let units = columns.iter().map(|(_, unit, _)| format!("({unit})"));
    let mut text = names.collect::<Vec<_>>().join(separator) + "\n";
    if dialect + 1 == DIALECTS.len() {
        text += &(units.collect::<Vec<_>>().join(separator) + "\n");
    }
    let values: Vec<Value> = columns.iter().map(|(.., value)| *value).collect();
    text + &rows(separator, &values)
}

const TIME: Quantity = ("Time", "s", |x| 50.0 * x);
const EXTENSION: Quantity = ("Extension", "mm", |x| 20.0 * x);
const CROSSHEAD: Quantity = ("Crosshead", "um", |x| 2e4 * x);
const LOAD: Quantity = ("Load", "mN", |x| 1e4 * stress(x));
const STRAIN: Quantity = ("Strain", "%", |x| 100.0 * x);
const STRESS: Quantity = ("Stress", "KPa", |x| 1e3 * stress(x));

const MEASURES: [(&str, &str); 3] = [
    ("test", "uniaxial"),
    ("strain measure", "nominal"),
    ("stress measure", "nominal"),
];

#[test]
fn every_dialect_gives_the_same_curve() {
    let both = [&SPECIMEN[..], &MEASURES[1..]].concat();
    let cases: [Case; 5] = [
        (&[TIME, EXTENSION, LOAD], &SPECIMEN),
        (&[STRAIN, STRESS, TIME], &MEASURES),
        (&[EXTENSION, LOAD, STRAIN, STRESS], &both),
        (&[TIME, CROSSHEAD, LOAD, STRAIN, STRESS], &SPECIMEN),
        // Without the dimensions of the specimen only the machine's evaluation can be read.
        (&[TIME, EXTENSION, LOAD, STRAIN, STRESS], &MEASURES),
    ];
    for (columns, reading) in cases {
        for dialect in 0..DIALECTS.len() {
            for separator in [",", ";", "\t"] {
                for turned in 0..columns.len() {
                    let mut columns = columns.to_vec();
                    columns.rotate_left(turned);
                    let text = table(&columns, dialect, separator);
                    let data = read(&text, reading);
                    let data = data.unwrap_or_else(|fault| panic!("{fault}\n{text}"));
                    assert!(is_right(&data), "{text}\n{}", data.table.sentence());
                }
            }
        }
    }
}

/// λ of an equibiaxial sheet gives the stress 0.1 (λ − λ⁻⁵) along both axes.
#[test]
fn two_axes_of_displacements_and_forces_need_the_thickness_alone_where_sizes_are_columns() {
    fn force(x: f64, across: f64) -> f64 {
        let stretch = 1.0 + x;
        1e3 * across * 0.1 * (stretch - stretch.powi(-5))
    }
    let columns: [Quantity; 6] = [
        ("XSize", "um", |x| 1e4 * (1.0 + x)),
        ("YSize", "um", |x| 8e3 * (1.0 + x)),
        ("XDisplacement", "um", |x| 1e4 * x),
        ("YDisplacement", "um", |x| 8e3 * x),
        ("XForce", "mN", |x| force(x, 8.0)),
        ("YForce", "mN", |x| force(x, 10.0)),
    ];
    for turned in 0..6 {
        let mut columns = columns;
        columns.rotate_left(turned);
        let data = read(&table(&columns, 1, ","), &[("thickness", "1 mm")]).unwrap();
        assert_eq!(data.observations.len(), 80);
        for one in &data.observations {
            let [first, second] = one.strains;
            let expected = force(first, 1.0) / 1e3;
            assert!((first - second).abs() < 1e-9, "{one:?}");
            assert!((one.stress - expected).abs() < 1e-8, "{one:?} {expected}");
        }
    }
    let missing = read(&table(&columns[2..], 1, ","), &[("thickness", "1 mm")]).unwrap_err();
    assert_contains(&missing, "the length is not stated");
}

/// A size less its displacement is the length at rest in every row, within the digits of both columns.
#[test]
fn sizes_and_displacements_that_contradict_are_refused_with_the_first_line() {
    let text = |head: &str| {
        let rows = (0..25).map(|row| {
            let x = 0.01 * f64::from(row);
            let [first, second] = [8.0 * x, 7.0 * x];
            format!(
                "{:.2},{:.2},{first:.4},{second:.4},{x},{x}\n",
                8.0 + first,
                7.0 + second
            )
        });
        format!("{head},XForce_N,YForce_N\n{}", rows.collect::<String>())
    };
    let thickness = [("thickness", "1 mm")];
    let right = "XSize_mm,YSize_mm,XDisplacement_mm,YDisplacement_mm";
    assert!(read(&text(right), &thickness).is_ok());
    for (head, size, displacement, line) in [
        (
            right.replace("XDisplacement_mm", "XDisplacement_um"),
            "XSize_mm",
            "XDisplacement_um",
            3,
        ),
        (
            right.replace("YSize_mm", "YSize_cm"),
            "YSize_cm",
            "YDisplacement_mm",
            3,
        ),
        (
            "YSize_mm,XSize_mm,XDisplacement_mm,YDisplacement_mm".to_owned(),
            "XSize_mm",
            "XDisplacement_mm",
            4,
        ),
    ] {
        let refused = read(&text(&head), &thickness).unwrap_err();
        assert_contains(&refused, &format!("`{size}` less `{displacement}` is"));
        assert_contains(&refused, &format!("a.csv:{line}"));
        let stated = [("thickness", "1 mm"), ("length", "8 mm"), ("width", "7 mm")];
        assert!(read(&text(&head), &stated).is_ok(), "{head}");
    }
}

/// Two protocols of three cycles each, of which the second one moves the first axis little: a cycle is one of its protocol.
#[test]
fn the_cycle_of_a_biaxial_record_is_chosen_in_each_protocol() {
    let text = |names: &str| {
        let mut text = format!("{names},stretch_1,stretch_2,P1 [MPa],P2 [MPa]\n");
        for (name, ratio) in [("equal", [1.0, 1.0]), ("across", [0.1, 1.0])] {
            for row in 0..120 {
                let share = f64::from(20 - (row % 40 - 20_i32).abs()) / 20.0;
                let [x, y] = ratio.map(|one| 0.2 * one * share);
                text += &format!("{name},{},{},{},{}\n", 1.0 + x, 1.0 + y, x + 0.1 * y, y);
            }
        }
        text
    };
    let with = |names: &str, cycle: &str| {
        read(&text(names), &[("test", "biaxial"), ("cycle", cycle)]).unwrap()
    };
    for (cycle, lines) in [
        ("last", ["lines 82 to 102", "lines 202 to 222"]),
        ("first", ["lines 2 to 22", "lines 122 to 142"]),
        ("2", ["lines 42 to 62", "lines 162 to 182"]),
    ] {
        for names in ["SetName", "Protocol"] {
            let data = with(names, cycle);
            assert_eq!(data.observations.len(), 2 * 2 * 21);
            assert_eq!(data.protocols().len(), 2);
            for (index, name) in ["equal", "across"].into_iter().enumerate() {
                let remark = &data.remarks[index];
                assert_contains(remark, &format!("protocol `{name}`: 3 cycles found"));
                assert_contains(remark, lines[index]);
            }
        }
        assert_eq!(with("Sample", cycle).remarks.len(), 1);
    }
}

#[test]
fn measures_of_lagrange_and_of_the_second_piola_kirchhoff_stress_are_converted() {
    let text = |head: &str, strain: fn(f64) -> f64, factor: fn(f64) -> f64| {
        let rows = (0..40).map(|row| {
            let x = 0.02 * f64::from(row);
            format!("{:.12},{:.12}\n", strain(x), factor(1.0 + x) * stress(x))
        });
        format!("{head}\n{}", rows.collect::<String>())
    };
    let uniaxial = [("test", "uniaxial")];
    let green: fn(f64) -> f64 = |x| x + 0.5 * x * x;
    for (head, strain, factor) in [
        (
            "green_strain [-],pk2 [MPa]",
            green,
            (|l| 1.0 / l) as fn(f64) -> f64,
        ),
        (
            "true_strain [-],true_stress [MPa]",
            |x: f64| x.ln_1p(),
            |l| l,
        ),
        ("lambda,P [MPa]", |x| 1.0 + x, |_| 1.0),
    ] {
        let data = read(&text(head, strain, factor), &uniaxial).unwrap();
        let measure = data.stress_measure;
        let on_curve = data.observations.iter().all(|one| {
            let nominal = measure.to_nominal(one.stress, one.strains[0]);
            (nominal - stress(one.strains[0])).abs() < 1e-9
        });
        assert!(on_curve, "{head}");
    }
}

#[test]
fn rows_are_chosen_by_lines_columns_and_strains_and_signs_are_reversed() {
    let text = "SetName,Extension_mm,Load_N\nPrecond,0,0\nPrecond,2,0.9\nTest,0,0\nTest,2,-0.5\nTest,4,-1\n";
    for (key, value, count) in [
        ("rows", "SetName=Test", 3),
        ("rows", "4..", 3),
        ("rows", "5..6", 2),
        ("rows", "SetName=Test,5..5", 1),
        ("strain range", "5 %..", 3),
        ("strain range", "0..0.1", 4),
    ] {
        let reading = [
            &SPECIMEN[..],
            &[(key, value), ("cycle", "all"), ("zero", "none")],
        ]
        .concat();
        let data = read(text, &reading)
            .or_else(|_| read(text, &[&reading[..], &[("flip", "stress")]].concat()));
        assert_eq!(data.unwrap().observations.len(), count, "{key} {value}");
    }
    let flipped = [
        &SPECIMEN[..],
        &[
            ("rows", "SetName=Test"),
            ("flip", "stress"),
            ("zero", "none"),
        ],
    ];
    let data = read(text, &flipped.concat()).unwrap();
    assert_eq!(data.observations[2].stress, 0.1);
    for (key, value, message) in [
        ("rows", "SetName=Other", "the rows leave no row"),
        ("rows", "abc", "cannot be read"),
        ("rows", "Set=Test", "there is no column `Set`"),
        ("strain range", "0.3", "cannot be read"),
        ("flip", "time", "the flip `time` is not known"),
    ] {
        let fault = read(text, &[&SPECIMEN[..], &[(key, value)]].concat()).unwrap_err();
        assert_contains(&fault, message);
    }
}

#[test]
fn rows_that_are_stated_in_the_file_are_kept_whatever_they_hold() {
    let table = table(&[EXTENSION, LOAD], 0, ",").replacen("0.000000000,0.000000000", "0,9999", 1);
    let count = |head: &str| {
        let data = read(
            &format!("{head}{table}"),
            &[&SPECIMEN[..], &[("zero", "none")]].concat(),
        );
        data.unwrap().observations.len()
    };
    assert_eq!([count(""), count("# rows: 1..\n")], [39, 40]);
}
