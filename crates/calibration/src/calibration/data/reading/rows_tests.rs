//! Columns with the names of machines, and rows that are no measurements.

use super::tests::{SPECIMEN, read, record};
use crate::assertions::assert_contains;
use crate::calibration::{Observation, TestData, Times};

const NAMES: &str = "Time [s],Displacement [mm],Force [N]";

fn stresses(data: &TestData) -> Vec<f64> {
    data.observations.iter().map(|one| one.stress).collect()
}

/// Rows of a record may begin and end anywhere in its cycles of 200 rows, the first at line 3.
#[test]
fn rows_that_are_cut_within_a_cycle_have_the_loading_branches_that_are_whole() {
    let text = record(1.3, NAMES);
    let with = |rows: &str| read(&text, &[&SPECIMEN[..], &[("rows", rows)]].concat());
    let complete = read(&text, &[&SPECIMEN[..], &[("cycle", "2")]].concat()).unwrap();
    for rows in ["84..380", "100..380", "120..380"] {
        let data = with(rows).unwrap();
        assert_eq!(stresses(&data), stresses(&complete), "{rows}");
    }
    let refused = with("110..180").unwrap_err();
    assert!(
        refused.contains("the specimen is only unloaded") && refused.contains("`--cycle all`"),
        "{refused}"
    );
}

/// The displacements of the last two rows over the length, interpolated, exceed the last one by rounding.
#[test]
fn a_zero_at_the_last_row_leaves_that_row_or_is_refused() {
    let text = "Displacement [mm],Force [N]\n0,0\n0.02,0.1\n0.05,0.2\n0.48,1\n";
    let stated = [
        ("test", "uniaxial"),
        ("length", "50 mm"),
        ("area", "10 mm^2"),
        ("zero", "0.48 mm"),
    ];
    let rows = read(text, &stated).map(|data| data.observations.len());
    assert!(rows.is_err() || rows == Ok(1), "{rows:?}");
}

/// Some programs write what was measured last into the first line.
#[test]
fn rows_whose_times_decrease_are_read_from_the_last_to_the_first() {
    let text = record(1.3, NAMES);
    let lines: Vec<&str> = text.lines().collect();
    let rows = lines[2..].iter().rev().copied();
    let reversed: Vec<&str> = lines[..2].iter().copied().chain(rows).collect();
    let [forward, backward] = [text.clone(), reversed.join("\n")];
    let [forward, backward] = [forward, backward].map(|text| read(&text, &SPECIMEN).unwrap());
    assert_eq!(stresses(&backward), stresses(&forward));
    for (one, other) in backward.rounding.iter().zip(forward.rounding) {
        assert!((one - other).abs() <= 1e-12 * other, "{one} {other}");
    }
    let is_told = |data: &TestData| {
        data.remarks
            .iter()
            .any(|one| one.contains("times decrease"))
    };
    assert!(is_told(&backward) && !is_told(&forward));
}

/// Two specimens in one file, between them a title and the names again, and words in the last line.
#[test]
fn lines_that_are_not_chosen_are_not_at_fault() {
    let rows = |stiffness: f64| -> String {
        let row = |i: u8| format!("{i},{},{}\n", 0.1 * f64::from(i), stiffness * f64::from(i));
        (0..40).map(row).collect()
    };
    let [first, second] = [0.01, 0.02].map(rows);
    let text = format!("{NAMES}\n{first}\n\nSpecimen 2\n{NAMES}\n{second}lost,x,y\n");
    let stated = [("test", "uniaxial"), ("zero", "none")];
    let with = |text: &str, more: &[(&str, &str)]| {
        read(text, &[&SPECIMEN[..], &stated[..], more].concat())
    };
    assert!(with(&text, &[]).unwrap_err().contains("a.csv:44: 1 fields"));
    for (lines, expected) in [("2..41", first), ("46..85", second)] {
        let alone = with(&format!("{NAMES}\n{expected}"), &[]).unwrap();
        let data = with(&text, &[("rows", lines)]).unwrap();
        assert_eq!(stresses(&data), stresses(&alone), "{lines}");
        let Times::Known(times) = &data.times else {
            panic!("{:?}", data.times)
        };
        assert_eq!(times.len(), 40);
        assert!(data.warnings.is_empty(), "{:?}", data.warnings);
    }
    let written = format!("# rows: 3..42\n{text}");
    assert_eq!(with(&written, &[]).unwrap().observations.len(), 40);
    let refused = with(&text, &[("rows", "2..85")]).unwrap_err();
    assert!(refused.contains("a.csv:44: 1 fields"), "{refused}");
    let refused = with(&text, &[("rows", "900..")]).unwrap_err();
    assert!(refused.contains("the rows leave no row"), "{refused}");
}

/// A strain range counts from the zero of the specimen, which the rows outside of it show.
#[test]
fn a_range_of_strains_is_that_of_the_strains_that_are_fitted() {
    let text = record(1.3, NAMES);
    let with = |range: &str| read(&text, &[&SPECIMEN[..], &[("strain range", range)]].concat());
    let complete = read(&text, &SPECIMEN).unwrap();
    let part = with("0..0.1").unwrap();
    assert_eq!(part.remarks, complete.remarks);
    let within = |one: &&Observation| one.strains[0] <= 0.1;
    let expected = complete.observations.iter().filter(within);
    let expected: Vec<f64> = expected.map(|one| one.stress).collect();
    assert_eq!(stresses(&part), expected);
    let Times::Known(times) = &part.times else {
        panic!("{:?}", part.times)
    };
    assert_eq!(times.len(), expected.len());
    let refused = with("0.3..").unwrap_err();
    assert_contains(&refused, "the strains go from 0.00");
}

#[test]
fn rows_behind_a_rupture_are_left_out_and_told() {
    let pull = (0..60).map(|i| 0.1 * f64::from(i));
    let behind = (0..20).map(|i| format!("{},0.01\n", 6.0 + 0.1 * f64::from(i)));
    let pull = pull.map(|u| format!("{u},{}\n", 0.1 * u));
    let text: String = pull.chain(behind).collect();
    let text = format!("# test: uniaxial\nextension [mm],load [N]\n{text}");
    let data = read(&text, &SPECIMEN).unwrap();
    assert_eq!(data.observations.len(), 60);
    let output = data.warnings[0].to_string();
    assert!(
        output.contains("a.csv:63: rows behind a rupture") && output.contains(": 20"),
        "{output}"
    );
}

/// As German laboratories write them, without columns of displacements and forces.
#[test]
fn strains_and_stresses_that_machines_evaluate_are_read_alone_and_are_no_second_ones() {
    let stated = [
        ("test", "uniaxial"),
        ("strain measure", "nominal"),
        ("stress measure", "nominal"),
    ];
    let data = read("Dehnung [%];Spannung [kPa]\n10,5;4,0\n21;8\n", &stated).unwrap();
    assert!((data.observations[0].strains[0] - 0.105).abs() < 1e-15);
    assert!((data.observations[1].stress - 8e-3).abs() < 1e-15);
    let head = "# test: uniaxial; length: 20 mm; area: 10 mm^2\n";
    let text = "Tensile extension [mm],Tensile strain [%],Load [N],Tensile stress [MPa]\n2,10,1,0.1\n4,20,2,0.2\n";
    let data = read(&(head.to_owned() + text), &[]).unwrap();
    assert!((data.observations[0].strains[0] - 0.1).abs() < 1e-15);
    assert!((data.observations[0].stress - 0.1).abs() < 1e-15);
}

#[test]
fn rows_without_a_number_are_left_out_and_a_word_is_refused() {
    let head = "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n";
    let data = read(
        &(head.to_owned() + "1.1,0.1\n1.2,NaN\n,0.3\n1.4,0.4\n"),
        &[],
    )
    .unwrap();
    let strains: Vec<f64> = data.observations.iter().map(|one| one.strains[0]).collect();
    assert_eq!(strains.len(), 2);
    assert!((strains[1] - 0.4).abs() < 1e-15);
    let output = data.warnings[0].to_string();
    assert_contains(&output, "without a number for strain or stress: 2");
    let fault = read(&(head.to_owned() + "1.1,0.1\n1.2,lost\n"), &[]).unwrap_err();
    assert!(
        fault.contains("a.csv:4") && fault.contains("lost"),
        "{fault}"
    );
    let fault = read(&(head.to_owned() + "1.1,\n1.2,\n"), &[]).unwrap_err();
    assert_contains(&fault, "a.csv:3");
}

/// Of a record over time, whose time is not read where a row has none.
#[test]
fn a_row_that_was_left_out_hides_no_time_that_is_missing() {
    let timed = "# test: uniaxial; time unit: s\ntime,stretch [-],nominal_stress [MPa]\n";
    for (rows, is_known) in [
        ("0,1.1,0.1\n1,,0.1\n2,1.2,0.2\n", true),
        ("0,1.1,0.1\n1,,0.1\n,1.2,0.2\n", false),
        (",,0.1\n1,1.1,0.1\n2,1.2,0.2\n", true),
        (",,0.1\n1,1.1,0.1\n,1.2,0.2\n", false),
    ] {
        let data = read(&(timed.to_owned() + rows), &[]).unwrap();
        assert_eq!(data.observations.len(), 2);
        assert_eq!(matches!(data.times, Times::Known(_)), is_known, "{rows}");
    }
}

#[test]
fn strains_that_may_be_in_percent_deserve_a_word() {
    let head = "# test: uniaxial\nnominal_strain [-],nominal_stress [MPa]\n";
    let data = read(&(head.to_owned() + "10,0.1\n50,0.2\n"), &[]).unwrap();
    let output = data.warnings[0].to_string();
    assert!(
        output.contains("λ = 51") && output.contains("[%]"),
        "{output}"
    );
    let data = read(&(head.to_owned() + "1,0.1\n5,0.2\n"), &[]).unwrap();
    assert!(data.warnings.is_empty());
}

#[test]
fn strains_that_begin_at_one_may_be_stretches() {
    let warned = |column: &str, first: &str| {
        let text = format!(
            "# test: uniaxial\n{column} [-],nominal_stress [MPa]\n{first}\n1.5,0.1\n2,0.2\n"
        );
        let warnings = read(&text, &[]).unwrap().warnings;
        warnings
            .iter()
            .any(|one| one.message.contains("as stretches do"))
    };
    assert!(warned("nominal_strain", "1,0") && warned("nominal_strain", "1.02,0.003"));
    assert!(
        !warned("stretch", "1,0")
            && !warned("nominal_strain", "1,0.05")
            && !warned("nominal_strain", "0,0")
    );
}

/// Positions of a machine's crosshead count from anywhere; no sign that is reversed makes strains of them.
#[test]
fn positions_of_a_press_count_from_a_stated_place() {
    let rows = (0..50).map(|i| {
        let u = 0.1 * f64::from(i);
        let l = 1.0 - u / 20.0;
        format!("{},{}\n", 35.1 - u, l.powi(-2) - l)
    });
    let text = format!("extension [mm],load [N]\n{}", rows.collect::<String>());
    let with = |zero: &str| {
        let stated = [("test", "compression"), ("zero", zero)];
        read(&text, &[&SPECIMEN[..], &stated].concat())
    };
    let refused = with("none").unwrap_err();
    assert!(
        refused.contains("positive strains (displacements count from where pressing begins")
            && refused.contains("--zero \"… mm\""),
        "{refused}"
    );
    let data = with("35.1 mm").unwrap();
    assert!(data.observations.iter().all(|one| one.strains[0] <= 0.0));
}
