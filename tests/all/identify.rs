//! From a recording to a spring law that a study takes.

use std::fs;

use tempfile::TempDir;

use crate::common::{gelbench, words};

#[test]
fn an_identified_law_is_taken_by_a_study() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    gelbench(here, &["identify", "--sample", "spring.csv", "--seed", "7"]).code(0);
    let options = [
        "identify",
        "spring.csv",
        "--area",
        "20 mm^2",
        "--output",
        "law",
    ];
    let done = gelbench(here, &options).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("K(·) in N/mm") && printed.contains("misfit: "),
        "{printed}"
    );
    assert!(printed.contains("verdict: explained\n"), "{printed}");
    // With another mass, spring and dashpot do not explain the recording, though the misfit is small.
    let right = fs::read_to_string(here.join("spring.csv")).unwrap();
    let wrong = right.replace("# mass: 200 g", "# mass: 230 g");
    fs::write(here.join("wrong.csv"), wrong).unwrap();
    let refused = gelbench(here, &["identify", "wrong.csv"]).code(5);
    let printed = words(&refused.get_output().stdout);
    assert!(
        printed.contains("verdict: not explained by one spring with one dashpot")
            && printed.contains("a mass that is smaller by")
            && !printed.contains("95 %"),
        "{printed}"
    );
    for ending in ["png", "json"] {
        assert!(here.join("law/spring").with_extension(ending).exists());
    }
    let law = fs::read_to_string(here.join("law/spring.toml")).unwrap();
    let plate = "[material]\ncard = \"pva-10\"\ndensity = \"1020 kg/m^3\"\n\
        [plate]\nlength = \"15 cm\"\nwidth = \"5 cm\"\nthickness = \"2 mm\"\n\
        [start]\nstretch = \"10 %\"\n[grip]\nmotion = \"hold\"\n[time]\nduration = \"1 s\"\n";
    let study = format!("kind = \"motion\"\n{plate}{law}");
    fs::write(here.join("study.toml"), study).unwrap();
    gelbench(here, &["check", "study.toml"]).code(0);
}

#[test]
fn a_recording_that_cannot_be_read_is_refused_and_nothing_is_written() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fs::write(here.join("bad.csv"), "time [s],force [N]\n0,1\n1,2\n").unwrap();
    let refused = gelbench(here, &["identify", "bad.csv", "--output", "law"]).code(2);
    let message = words(&refused.get_output().stderr);
    assert!(
        message.contains("there is no column of the motion"),
        "{message}"
    );
    assert!(!here.join("law").exists());
    gelbench(here, &["identify"]).code(2);
    gelbench(here, &["identify", "bad.csv", "--stiffness", "cubic"]).code(2);
}
