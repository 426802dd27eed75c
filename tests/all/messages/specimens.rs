//! Groups and measures of specimens.

use super::{checked, example};

#[test]
fn misspelt_groups_are_told_at_their_place() {
    let strip = example("strip_with_hole.toml").replacen("\"right\"", "\"rihgt\"", 1);
    checked(
        &strip,
        &["support[2].group", "a.toml:42:9", "did you mean `right`?"],
    );
}

/// The names of a shape's groups do not depend on measures that are still at fault.
#[test]
fn misspelt_groups_are_told_beside_misspelt_measures() {
    let strip = example("strip_with_hole.toml").replace("\nlength", "\nlenght");
    let strip = strip.replace("\"left\"", "\"lft\"");
    checked(
        &strip.replace("\"right\"", "\"rihgt\""),
        &[
            "specimen.lenght",
            "the specimen has no group `lft`",
            "did you mean `left`?",
            "support[2].group",
            "path.measured_group",
            "did you mean `right`?",
        ],
    );
}

#[test]
fn measures_that_do_not_fit_are_told_at_their_key_with_what_would() {
    let strip = example("strip_with_hole.toml");
    let notched = |depth: &str, length: &str| {
        let notches =
            format!("\"notched-strip\"\nnotch_depth = \"{depth}\"\nnotch_length = \"{length}\"");
        strip.replace("\"strip-with-hole\"", &notches)
    };
    checked(
        &notched("20 mm", "60 mm"),
        &["specimen.notch_depth", "less than \"13.5 mm\""],
    );
    checked(
        &notched("6 mm", "10 mm"),
        &["specimen.notch_depth", "less than \"4.75 mm\""],
    );
    checked(
        &strip.replace("12 mm", "28 mm"),
        &["specimen.hole_diameter", "less than \"27 mm\""],
    );
    checked(
        &example("dog_bone.toml").replace("\"4 mm\"", "\"14 mm\""),
        &["specimen.narrow_width", "less than \"12.5 mm\""],
    );
}
