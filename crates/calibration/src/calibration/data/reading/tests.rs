//! Reading of test data.

use super::*;
use crate::assertions::assert_contains;
use crate::calibration::{Observation, Times};

pub fn read(text: &str, reading: &[(&str, &str)]) -> Result<TestData, String> {
    let reading = reading
        .iter()
        .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
        .collect();
    TestData::parse("a.csv", text, &reading).map_err(|fault| fault.to_string())
}

#[test]
fn measures_and_units_are_read_from_names_head_or_command_line() {
    let expected = Observation {
        strains: [0.5, 0.0],
        axis: 0,
        stress: 0.2,
    };
    for (text, reading) in [
        (
            "# test: planar\nstretch [-],nominal_stress [MPa]\n1.5,0.2",
            &[][..],
        ),
        (
            "# test: planar; stress measure: nominal (engineering)\nstretch [-],stress [kPa]\n1.5,200",
            &[],
        ),
        (
            "nominal_strain [%],engineering_stress [Pa]\n50,2e5",
            &[("test", "planar")],
        ),
        (
            "1.5,0.2\n",
            &[
                ("test", "planar"),
                ("strain measure", "stretch"),
                ("strain unit", "-"),
                ("stress measure", "nominal"),
                ("stress unit", "MPa"),
                ("columns", "strain=1,stress=2"),
            ],
        ),
        (
            "# test: planar; area: 20 mm^2; length: 5 cm\nTime [s],extension [mm],load [N]\n1,25,4",
            &[],
        ),
    ] {
        let data = read(text, reading).unwrap();
        let actual = data.observations[0];
        assert_eq!(actual.axis, expected.axis);
        assert!(
            (actual.strains[0] - 0.5).abs() < 1e-15 && actual.strains[1] == 0.0,
            "{text}"
        );
        assert!(
            (actual.stress - expected.stress).abs() < 1e-15,
            "{text}: {actual:?}"
        );
    }
}

#[test]
fn contradictions_and_impossible_values_are_refused_with_their_place() {
    for (text, message) in [
        (
            "# test: uniaxial; stress measure: cauchy\nstretch [-],nominal_stress [MPa]\n1.1,1",
            "the stress measure is nominal according to the name of a column and cauchy according to the header",
        ),
        (
            "# test: uniaxial; stress unit: kPa\nstretch [-],nominal_stress [MPa]\n1.1,1",
            "the stress unit is MPa according to the name of a column and kPa according to the header",
        ),
        (
            "# test: uniaxal\nstretch [-],nominal_stress [MPa]\n1.1,1",
            "did you mean `uniaxial`",
        ),
        (
            "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n1,0\n0,1",
            "a.csv:4: the stretch is 0",
        ),
        (
            "# test: uniaxial\nstretch [-],nominal_stress [mm]\n1,0",
            "measures length",
        ),
        (
            "# test: uniaxial\nstretch [-],nominal_stress [mPa]\n1,0",
            "the unknown unit `mPa` (`mPa` is a thousandth of a Pa: if MPa is meant, correct it or give --stress-unit MPa; if not, give --stress-unit mPa)",
        ),
        (
            "# test: uniaxial\nnominal_strain [foo],nominal_stress [MPa]\n1,0",
            "known units: %, ‰, µε; `-` or mm/mm of a plain ratio",
        ),
        (
            "# test: uniaxial\nstretch [-],strss [MPa]\n1,0",
            "there is no column of stresses",
        ),
        (
            "# test: biaxial; strain ratio: 0,5\nstretch [-],nominal_stress [MPa]\n1.1,1",
            "the strain ratio 0,5 is not a number",
        ),
    ] {
        let actual = read(text, &[]).unwrap_err();
        assert!(actual.contains(message), "{text}\n{actual}");
    }
}

/// Units whose capitals are more often wrong than meant are taken from who names them again.
#[test]
fn a_rare_unit_is_taken_where_it_is_stated() {
    let stress = "# test: uniaxial\nstretch [-],nominal_stress [mPa]\n1.1,1\n1.2,2";
    let force = "# test: uniaxial\nextension [mm],load [MN]\n0,0\n1,2\n2,4";
    for (text, unit, expected) in [
        (stress, "MPa", 1.0),
        (stress, "mPa", 1e-9),
        (force, "mN", 2e-4),
        (force, "MN", 2e5),
    ] {
        let stated = [&SPECIMEN[..], &[("stress unit", unit)]].concat();
        let data = read(text, &stated).unwrap();
        let largest = data.observations.iter().find(|one| one.stress > 0.0);
        assert!(
            (largest.unwrap().stress / expected - 1.0).abs() < 1e-12,
            "{unit}"
        );
        let output = data.table.sentence();
        assert_contains(&output, &format!("` [{unit}]"));
    }
    assert!(
        read(force, &SPECIMEN)
            .unwrap_err()
            .contains("a million N: if mN is meant")
    );
}

#[test]
fn both_axes_of_a_biaxial_test_are_read() {
    let text = "# test: biaxial\nstretch_1 [-],stretch_2 [-],nominal_stress_1 [kPa],nominal_stress_2 [kPa]\n1.2,1.1,30,20";
    let data = read(text, &[]).unwrap();
    assert_eq!(data.observations.len(), 2);
    assert_eq!(data.observations[1].axis, 1);
    assert!((data.observations[1].stress - 0.02).abs() < 1e-15);
    let text = "# test: biaxial; strain ratio: 0.5; direction: 2\nstretch [-],nominal_stress [kPa]\n1.2,20";
    let data = read(text, &[]).unwrap();
    assert_eq!(data.observations[0].axis, 1);
    assert!((data.observations[0].strains[1] - 0.1).abs() < 1e-15);
}

#[test]
fn a_loop_of_loading_and_unloading_is_told() {
    let text =
        "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n1,0\n1.2,1\n1.4,2\n1.2,0.8\n1,0";
    let data = read(text, &[]).unwrap();
    assert_eq!(data.observations.len(), 5);
    let warning = data.warnings[0].to_string();
    assert_contains(&warning, "a.csv:6: the strain reverses once");
}

/// Columns that do not fit together would be read in the measure of the first of them.
#[test]
fn columns_that_do_not_fit_together_are_refused() {
    for (text, message) in [
        (
            "# test: uniaxial\nstretch [-],nominal_stress [MPa],cauchy_stress [MPa]\n1.1,1,1.2",
            "2 columns may be the stress, and they do not agree",
        ),
        (
            "# test: biaxial\nstretch_1 [-],stretch_2 [-],nominal_stress_1 [MPa],cauchy_stress_2 [MPa]\n1.1,1.1,1,1",
            "`cauchy_stress_2` has another measure",
        ),
        (
            "# test: uniaxial; length: 10 mm\ndisplacement [mm],stretch [-],nominal_stress [MPa]\n1,1.2,1",
            "2 columns may be the strain, and they do not agree",
        ),
        (
            "# test: equibiaxial\nstretch_1 [-],stretch_2 [-],nominal_stress [MPa]\n1.1,1.2,1",
            "the strains of a equibiaxial test have one column",
        ),
        (
            "# test: biaxial; direction: 2\nstretch_1 [-],stretch_2 [-],nominal_stress_1 [MPa],nominal_stress_2 [MPa]\n1.1,1.2,1,1",
            "a direction is given too",
        ),
        (
            "# test: uniaxial\n# test: planar\nstretch [-],nominal_stress [MPa]\n1.1,1",
            "the test is stated twice",
        ),
        (
            "# test: compression\nnominal_strain [-],nominal_stress [MPa]\n0.1,1",
            "a compression test has positive strains (--flip both gives strains and stresses",
        ),
        (
            "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n1.1,0\n1.2,0",
            "all strains or all stresses are zero",
        ),
        (
            "# test: uniaxial\n# a remark\nstretch [-],nominal_stress [mPa]\n1,0",
            "a.csv:3: the stress unit has the unknown unit",
        ),
    ] {
        let actual = read(text, &[]).unwrap_err();
        assert!(actual.contains(message), "{text}\n{actual}");
    }
}

#[test]
fn the_second_axis_may_stand_first_and_other_columns_may_hold_words() {
    let text = "# test: biaxial\nsample,stretch_2 [-],stretch_1 [-],nominal_stress_1 [kPa],\nA,1.1,1.2,30,\n";
    let data = read(text, &[]).unwrap();
    let [first, second] = data.observations[0].strains;
    assert!((first - 0.2).abs() < 1e-15 && (second - 0.1).abs() < 1e-15);
}

#[test]
fn a_test_stretched_across_is_drawn_over_that_axis() {
    let text =
        "# test: biaxial\nstretch_1 [-],stretch_2 [-],nominal_stress_1 [kPa]\n1,1.1,3\n1,1.2,6\n";
    let data = read(text, &[]).unwrap();
    assert_eq!(data.drawn_axis, 1);
    assert!((data.stretch_range()[1] - 1.2).abs() < 1e-15);
    let path = data.path(0, 10);
    assert!((path[10].strains[1] - 0.2).abs() < 1e-15 && path[10].strains[0] == 0.0);
}

/// Force and displacement of neo-Hooke with E = 0.3 MPa: a specimen of 20 mm × 5 mm × 2 mm that is slack over `slack` mm.
fn force(u: f64, slack: f64) -> f64 {
    let l = 1.0 + (u - slack).max(0.0) / 20.0;
    10.0 * 0.1 * (l - l.powi(-2))
}

/// Three cycles to 6 mm with a hold at each end, as a machine records them.
pub fn record(slack: f64, names: &str) -> String {
    let mut text = format!("# test: uniaxial\n{names}\n");
    let mut row = |time: f64, u: f64| {
        let scatter = 1e-3 * ((12.9898 * time).sin() + (78.233 * time).cos());
        text += &format!("{time},{u},{}\n", force(u, slack) + 0.02 + scatter);
    };
    for i in 0..600 {
        let t = 0.1 * f64::from(i);
        let phase = t % 20.0;
        row(
            t,
            if phase < 8.0 {
                0.75 * phase
            } else if phase < 10.0 {
                6.0
            } else if phase < 18.0 {
                0.75 * (18.0 - phase)
            } else {
                0.0
            },
        );
    }
    text
}

pub const SPECIMEN: [(&str, &str); 3] = [
    ("length", "20 mm"),
    ("width", "5 mm"),
    ("thickness", "2 mm"),
];

#[test]
fn cycles_and_slack_of_a_record_are_found_and_told() {
    for names in [
        "Time [s],Displacement [mm],Force [N]",
        "Zeit (s),Standardweg (mm),Standardkraft (N)",
        "时间,位移,力\n(s),(mm),(N)",
    ] {
        let data = read(&record(1.3, names), &SPECIMEN).unwrap();
        let output = data.remarks.join("\n");
        assert_contains(&output, "3 cycles found");
        assert_contains(&output, "the loading branch of the last is fitted");
        assert_contains(&output, "slack up to 1.3");
        let (first, last) = (
            &data.observations[0],
            &data.observations[data.observations.len() - 1],
        );
        assert!(
            first.strains[0] >= 0.0 && first.strains[0] < 0.01,
            "{first:?}"
        );
        assert!((last.strains[0] - 4.7 / 20.0).abs() < 2e-3, "{last:?}");
        for one in &data.observations {
            let expected = force(20.0 * one.strains[0], 0.0) / 10.0;
            assert!((one.stress - expected).abs() < 1e-3, "{one:?} {expected}");
        }
        let Times::Known(times) = &data.times else {
            panic!("{:?}", data.times)
        };
        assert_eq!(times.len(), data.observations.len());
        assert!(times[0] > 40.0 && times[times.len() - 1] < 49.0);
        assert_eq!(data.observations.len() + data.left_out.len(), 600);
        assert!(data.warnings.is_empty(), "{:?}", data.warnings);
    }
}

#[test]
fn the_cycle_and_the_zero_can_be_chosen() {
    let text = record(1.3, "Time [s],Displacement [mm],Force [N]");
    let with = |more: &[(&str, &str)]| read(&text, &[&SPECIMEN, more].concat());
    let first = with(&[("cycle", "first"), ("zero", "none")]).unwrap();
    let Times::Known(times) = &first.times else {
        panic!()
    };
    assert!(times[times.len() - 1] <= 8.1, "{}", times[times.len() - 1]);
    assert!((first.observations[1].strains[0] - 0.075 / 20.0).abs() < 1e-15);
    let all = with(&[("cycle", "all"), ("zero", "1.3 mm")]).unwrap();
    assert!(
        all.observations.len() > 580 && all.remarks[0].contains("all rows"),
        "{:?}",
        all.remarks
    );
    let by_force = with(&[("cycle", "2"), ("zero", "0.1 N")]).unwrap();
    assert!(
        by_force.remarks[1].contains("1.8"),
        "{:?}",
        by_force.remarks
    );
    for (key, value, message) in [
        ("cycle", "4", "there is no such cycle: 3 cycles ("),
        ("cycle", "lst", "the cycle `lst` is not known"),
        ("zero", "0.3", "the zero `0.3` is not known"),
        ("zero", "900 N", "does not pass the stated zero"),
        ("area", "10 mm^2", "width or thickness too"),
    ] {
        let output = with(&[(key, value)]).unwrap_err();
        assert_contains(&output, message);
    }
    let output = read(&text, &[("length", "20 mm")]).unwrap_err();
    assert!(
        output.contains("the area is not stated") && output.contains("width and thickness"),
        "{output}"
    );
    let output = read(&text, &SPECIMEN[..2]).unwrap_err();
    assert_contains(&output, "the thickness is not stated");
    let strains =
        "# test: uniaxial; zero: 1 mm\nstretch [-],nominal_stress [MPa]\n1.1,0.1\n1.2,0.2\n";
    assert!(
        read(strains, &[])
            .unwrap_err()
            .contains("only in tables of displacements and forces")
    );
}

/// Compression that a machine counts as positive; a tension test with the same file would stay as it is.
#[test]
fn compression_is_negative_here_and_one_pull_stays_as_it_is() {
    let rows: String = (0..50)
        .map(|i| {
            let u = 0.1 * f64::from(i);
            let l = 1.0 - u / 20.0;
            format!("{u},{}\n", 10.0 * 0.1 * (l.powi(-2) - l))
        })
        .collect();
    let text = format!("extension [mm],load [N]\n{rows}");
    let pressed = read(&text, &[&SPECIMEN[..], &[("test", "compression")]].concat()).unwrap();
    assert!(
        pressed
            .observations
            .iter()
            .all(|one| one.strains[0] <= 0.0 && one.stress <= 0.0)
    );
    assert!(pressed.remarks[0].contains("counts compression as positive"));
    let pulled = read(&text, &[&SPECIMEN[..], &[("test", "uniaxial")]].concat()).unwrap();
    assert!(
        pulled.remarks.is_empty() && pulled.left_out.is_empty(),
        "{:?}",
        pulled.remarks
    );
    assert_eq!(pulled.observations.len(), 50);
    let more = [("test", "compression"), ("zero", "0.5 mm")];
    let stated = read(&text, &[&SPECIMEN[..], &more].concat()).unwrap();
    let shifted = |one: &Observation| (one.strains[0] + 0.1 / 20.0).abs() < 1e-12;
    assert!(stated.observations.iter().any(shifted));
    let scattered = text
        .replacen("0,0\n", "0.0002,0\n-0.0002,0\n", 1)
        .replace(",-0", ",0");
    assert!(read(&scattered, &[&SPECIMEN[..], &more[..1]].concat()).is_ok());
    assert_eq!(pulled.observations[7].strains[0], 0.1 * 7.0 * (1.0 / 20.0));
}

#[test]
fn a_time_without_a_known_unit_is_no_fault_of_the_rest() {
    let text =
        "# test: uniaxial\ntime [sek],stretch [-],nominal_stress [MPa]\n0,1.1,0.1\n1,1.2,0.2\n";
    let data = read(text, &[]).unwrap();
    let Times::Unknown(fault) = &data.times else {
        panic!("{:?}", data.times)
    };
    assert!(fault.to_string().contains("the time unit"), "{fault}");
}
