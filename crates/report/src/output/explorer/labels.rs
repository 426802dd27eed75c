//! Names of arrays and models for the page.

use crate::results::models::MODELS;

/// `von_mises_stress_at_nodes_MPa` as people write it.
pub fn label(name: &str) -> String {
    const UNITS: [(&str, &str); 8] = [
        ("_mm_per_s", "mm/s"),
        ("_mm2_per_N", "mm²/N"),
        ("_percent", "%"),
        ("_MPa", "MPa"),
        ("_mm", "mm"),
        ("_mJ", "mJ"),
        ("_N", "N"),
        ("_s", "s"),
    ];
    let name = name.replace("_at_nodes", "");
    let matched = UNITS
        .iter()
        .find_map(|(end, unit)| Some((name.strip_suffix(end)?, format!(" [{unit}]"))));
    let (words, unit) = matched.unwrap_or((&name, String::new()));
    let words = words
        .replace('_', " ")
        .replace("mises", "Mises")
        .replace("cauchy", "Cauchy")
        .replace("green lagrange", "Green-Lagrange");
    format!("{words}{unit}")
}

/// A model as reports call it.
pub fn model_label(name: &str) -> String {
    let known = MODELS.into_iter().find(|style| style.key == name);
    known.map_or_else(|| name.replace('_', " "), |style| style.name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_arrays_are_words_with_units() {
        assert_eq!(
            label("von_mises_stress_at_nodes_MPa"),
            "von Mises stress [MPa]"
        );
        assert_eq!(label("grip_force_N"), "grip force [N]");
        assert_eq!(label("wrinkling"), "wrinkling");
        assert_eq!(
            label("difference_to_finite_elements_mm"),
            "difference to finite elements [mm]"
        );
        assert_eq!(model_label("finite_element"), "finite elements");
    }
}
