//! Columns that machines name in their own way, and rows that are no measurements.

use super::tests::read;
use crate::calibration::Times;

/// As laboratories write them in German, where neither displacements nor forces stand beside.
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
    let told = data.warnings[0].to_string();
    assert!(
        told.contains("without a number for strain or stress: 2"),
        "{told}"
    );
    let fault = read(&(head.to_owned() + "1.1,0.1\n1.2,lost\n"), &[]).unwrap_err();
    assert!(
        fault.contains("a.csv:4") && fault.contains("lost"),
        "{fault}"
    );
    let fault = read(&(head.to_owned() + "1.1,\n1.2,\n"), &[]).unwrap_err();
    assert!(fault.contains("a.csv:3"), "{fault}");
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
    let told = data.warnings[0].to_string();
    assert!(told.contains("λ = 51") && told.contains("[%]"), "{told}");
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
