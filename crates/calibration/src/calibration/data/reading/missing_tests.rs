//! What test data must say and do not.

use super::tests::read;

#[test]
fn what_is_not_stated_is_asked_for_and_never_guessed() {
    let whole = "# test: uniaxial; stress measure: nominal\nstrain [-],stress [MPa]\n0.1,0.2";
    for (without, message) in [
        (
            whole.replace("test: uniaxial; ", ""),
            "the test is not stated",
        ),
        (
            whole.replace("; stress measure: nominal", ""),
            "the strain measure is not stated",
        ),
        (
            whole.replace("; stress measure: nominal", "; strain measure: nominal"),
            "the stress measure is not stated (write `# stress measure: nominal` at the top of the file, or give --stress nominal; it is one of nominal, cauchy, second-piola-kirchhoff)",
        ),
        (
            whole
                .replace("nominal", "nominal; strain measure: nominal")
                .replace(" [MPa]", ""),
            "the stress unit is not stated",
        ),
        (
            whole
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
        let found = read(&without, &[]).unwrap_err();
        assert!(found.contains(message), "{without}\n{found}");
    }
}

#[test]
fn all_that_is_missing_is_told_at_once() {
    let found = read("strain,stress\n0.1,0.2", &[]).unwrap_err();
    for key in ["test", "strain measure", "stress measure"] {
        assert!(
            found.contains(&format!("the {key} is not stated")),
            "{found}"
        );
    }
    let found = read("# test: uniaxial\nextension [mm],load [N]\n1,2", &[]).unwrap_err();
    assert_eq!(
        found.matches("the length is not stated").count(),
        1,
        "{found}"
    );
    assert_eq!(
        found.matches("the area is not stated").count(),
        1,
        "{found}"
    );
}

#[test]
fn stresses_against_the_strains_are_refused() {
    let text = "# test: uniaxial\nstretch,nominal_stress [MPa]\n1.0,0.001\n1.5,0.2";
    assert!(read(text, &[]).is_ok());
    let found = read(&text.replace("0.2", "-0.2"), &[]).unwrap_err();
    assert!(found.contains("opposite to the strains"), "{found}");
}

#[test]
fn a_stretch_is_a_ratio_unless_it_may_be_in_percent() {
    let text = "# test: uniaxial\nstretch,nominal_stress [MPa]\n1.5,0.2";
    assert!((read(text, &[]).unwrap().observations[0].strains[0] - 0.5).abs() < 1e-15);
    let found = read(&text.replace("1.5", "150"), &[]).unwrap_err();
    assert!(found.contains("the strain unit is not stated"), "{found}");
    let given = read(&text.replace("1.5", "150"), &[("strain unit", "%")]).unwrap();
    assert!((given.observations[0].strains[0] - 0.5).abs() < 1e-15);
}
