//! What is said of a study that cannot be run.

use super::{PULLED, STRIP, specimen};
use crate::common::{folder_with, gelbench, one_line, words};

#[test]
fn faults_of_a_specimen_are_told_with_their_place() {
    let strip = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    for (shape, rest, message) in [
        (
            strip,
            PULLED.replace("group = \"right\"", "group = \"rihgt\""),
            "the specimen has no group `rihgt`",
        ),
        (
            strip,
            PULLED.replace("\"clamp\"", "\"clmp\""),
            "did you mean \"clamp\"",
        ),
        (
            strip,
            PULLED.replace("measured_group = \"left\"", "measured_group = \"hole\""),
            "the specimen has no group `hole`",
        ),
        (
            "shape = \"strip-with-hole\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"10 mm\"\ncells = 6",
            PULLED.into(),
            "nine tenths",
        ),
        (
            "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 7",
            PULLED.into(),
            "specimen.cells: must be even",
        ),
        (
            "shape = \"mesh\"\nfile = \"nothing.msh\"\nfile_unit = \"1 mm\"",
            PULLED.into(),
            "nothing.msh",
        ),
        (
            strip,
            format!("{PULLED}[finite_element]\nadaptive = true\n"),
            "adaptive refinement needs triangles",
        ),
        (
            strip,
            format!(
                "{PULLED}[[support]]\ngroup = \"top\"\nkind = \"displacement\"\ny = \"1 mm\"\n"
            ),
            "support 1 on the group `left` (a clamp) and support 3 on the group `top` (y = 1 mm) contradict each other",
        ),
    ] {
        let folder = folder_with(&specimen(shape, &rest));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let result = one_line(&done.get_output().stderr);
        assert!(result.contains(message), "{message}: {result}");
    }
}

/// Nothing that a specimen is made of, held by or loaded with is taken from the study that comes along.
#[test]
fn what_a_study_does_not_say_is_not_done() {
    let complete = specimen(STRIP, PULLED);
    for (left_out, message) in [
        (
            "[material]\ncard = \"pva-10-yeoh\"\n",
            "material.card: is missing",
        ),
        ("thickness = \"2 mm\"\n", "specimen.thickness: is missing"),
        ("shape = \"strip\"\n", "specimen.shape: is missing"),
        ("length = \"20 mm\"\n", "specimen.length: is missing"),
        ("width = \"10 mm\"\n", "specimen.width: is missing"),
        ("factors = [0.5, 1.0]\n", "path.factors: is missing"),
        (
            "measured_group = \"left\"\n",
            "path.measured_group: is missing",
        ),
    ] {
        assert!(complete.contains(left_out), "{left_out}");
        let folder = folder_with(&complete.replace(left_out, ""));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let result = words(&done.get_output().stderr);
        assert!(result.contains(message), "{message}: {result}");
        assert!(result.contains("it has no default"), "{result}");
    }
    let unheld = &PULLED[..PULLED.find("[[support]]").unwrap()];
    let folder = folder_with(&specimen(STRIP, unheld));
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let result = words(&done.get_output().stderr);
    assert!(
        result.contains("support: is missing: nothing holds the specimen"),
        "{result}"
    );
    // A list that holds no tables is no list of supports.
    let listed = format!("support = [1, 2]\n{}", specimen(STRIP, unheld));
    let folder = folder_with(&listed);
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let result = words(&done.get_output().stderr);
    assert!(
        result.contains("support: must be a list of tables"),
        "{result}"
    );
}

/// A fault of a support points to that support, and one of a load to that load.
#[test]
fn a_fault_points_to_the_entry_that_it_is_about() {
    let upside = PULLED.replace("y = \"0 mm\"\n", "");
    let free = upside.replace("kind = \"clamp\"", "kind = \"displacement\"\nx = \"0 mm\"");
    for (rest, line, message) in [
        (
            format!("{PULLED}[[load]]\ngroup = \"botom\"\nkind = \"force\"\nx = \"1 N\"\n"),
            "group = \"botom\"",
            "did you mean `bottom`?",
        ),
        (
            format!(
                "{PULLED}[[support]]\ngroup = \"top\"\nkind = \"displacement\"\ny = \"1 mm\"\n"
            ),
            "group = \"top\"",
            "contradict each other",
        ),
        (free, "", "can move"),
    ] {
        let folder = folder_with(&specimen(STRIP, &rest));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let result = words(&done.get_output().stderr);
        assert!(
            result.contains(message) && result.contains(line),
            "{message}: {result}"
        );
    }
}
