//! Statements that test data must make and do not.

use super::tests::read;
use crate::assertions::assert_contains;

#[test]
fn what_is_not_stated_is_asked_for_and_never_guessed() {
    let complete = "# test: uniaxial; stress measure: nominal\nstrain [-],stress [MPa]\n0.1,0.2";
    for (without, message) in [
        (
            complete.replace("test: uniaxial; ", ""),
            "the test is not stated",
        ),
        (
            complete.replace("; stress measure: nominal", ""),
            "the strain measure is not stated",
        ),
        (
            complete.replace("; stress measure: nominal", "; strain measure: nominal"),
            "the stress measure is not stated (write `# stress measure: nominal` at the top of the file, or give --stress nominal; it is one of nominal, cauchy, second-piola-kirchhoff)",
        ),
        (
            complete
                .replace("nominal", "nominal; strain measure: nominal")
                .replace(" [MPa]", ""),
            "the stress unit is not stated",
        ),
        (
            complete
                .replace("nominal", "nominal; strain measure: nominal")
                .replace(" [-]", ""),
            "the strain unit is not stated",
        ),
        (
            "# test: uniaxial\nextension [mm],load [N]\n1,2".into(),
            "the length is not stated",
        ),
        (
            "# test: biaxial\nstretch [-],nominal_stress [MPa]\n1.1,2".into(),
            "the strain ratio is not stated",
        ),
    ] {
        let result = read(&without, &[]).unwrap_err();
        assert!(result.contains(message), "{without}\n{result}");
    }
}

#[test]
fn all_that_is_missing_is_told_at_once() {
    let result = read("strain,stress\n0.1,0.2", &[]).unwrap_err();
    for key in ["test", "strain measure", "stress measure"] {
        assert_contains(&result, &format!("the {key} is not stated"));
    }
    let result = read("# test: uniaxial\nextension [mm],load [N]\n1,2", &[]).unwrap_err();
    assert_eq!(
        result.matches("the length is not stated").count(),
        1,
        "{result}"
    );
    assert_eq!(
        result.matches("the area is not stated").count(),
        1,
        "{result}"
    );
}

#[test]
fn stresses_against_the_strains_are_refused() {
    let text = "# test: uniaxial\nstretch,nominal_stress [MPa]\n1.0,0.001\n1.5,0.2";
    assert!(read(text, &[]).is_ok());
    let result = read(&text.replace("0.2", "-0.2"), &[]).unwrap_err();
    assert_contains(&result, "opposite to the strains");
}

#[test]
fn a_stretch_is_a_ratio_unless_it_may_be_in_percent() {
    let text = "# test: uniaxial\nstretch,nominal_stress [MPa]\n1.5,0.2";
    assert!((read(text, &[]).unwrap().observations[0].strains[0] - 0.5).abs() < 1e-15);
    let result = read(&text.replace("1.5", "150"), &[]).unwrap_err();
    assert_contains(&result, "the strain unit is not stated");
    let given = read(&text.replace("1.5", "150"), &[("strain unit", "%")]).unwrap();
    assert!((given.observations[0].strains[0] - 0.5).abs() < 1e-15);
}
