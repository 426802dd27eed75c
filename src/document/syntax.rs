//! What to do about faults of TOML's syntax.

use std::ops::Range;

/// What to write instead, where the text about a syntax fault tells it.
pub(super) fn remedy(text: &str, place: &Range<usize>, message: &str) -> Option<String> {
    if message.contains("duplicate key") {
        let key = text.get(place.clone()).unwrap_or_default().trim();
        return Some(match key {
            "law" => "a card has one law: leave one out, or write a card for each".to_owned(),
            _ => {
                "a key and a [table] stand once: leave one out; lists of tables are written [[key]]"
                    .to_owned()
            }
        });
    }
    let (key, value) = unquoted(text, place.start)?;
    let comma = value.replacen(',', ".", 1);
    if let Ok(number) = comma.parse::<f64>() {
        return value
            .contains(',')
            .then(|| format!("write {key}{number}, with a decimal point"));
    }
    let plain = |letter: char| letter.is_alphanumeric() || " .,+-_/%^*²³°·µ±\\".contains(letter);
    let usable = !value.is_empty() && value.chars().all(plain);
    usable.then(|| format!("write texts and quantities with units in quotes: {key}\"{value}\""))
}

/// The value without quotes that holds a place, and the key before it with its equals sign.
fn unquoted(text: &str, at: usize) -> Option<(String, &str)> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    let line = text[start..].lines().next().unwrap_or_default();
    let line = line.split('#').next().unwrap_or_default();
    let within = at - start;
    let (key, values) = line.split_once('=')?;
    let offset = key.len() + 1;
    if within < offset || line.contains(['"', '\'']) && !values.trim_start().starts_with('[') {
        return None;
    }
    let listed = values.trim_start().starts_with('[');
    if !listed {
        return Some((format!("{} = ", key.trim()), values.trim()));
    }
    // The item of a list that holds the place.
    let edge = |letter: char| "[],".contains(letter);
    let begin = line[..within.min(line.len())]
        .rfind(edge)
        .map_or(offset, |end| end + 1);
    let end = line[begin..]
        .find(edge)
        .map_or(line.len(), |end| begin + end);
    let item = line[begin..end].trim();
    (!item.contains(['"', '\''])).then(|| (String::new(), item))
}

#[cfg(test)]
mod tests {
    use crate::document::{Document, Faults};

    fn told(text: &str) -> String {
        let faults = Faults::default();
        Document::parse("a.toml", text, &faults);
        faults.finish().expect_err(text).to_string()
    }

    #[test]
    fn values_without_quotes_are_told_with_quotes() {
        for (text, expected) in [
            ("width = 5 cm\n", "in quotes: width = \"5 cm\""),
            ("width = 5cm # wide\n", "in quotes: width = \"5cm\""),
            ("a = 1\nwidth = 5 %\n", "width = \"5 %\""),
            ("card = pva-10\n", "card = \"pva-10\""),
            ("stretches = [15 %, 30 %]\n", "in quotes: \"15 %\""),
            ("at = [\"1 mm\", 2 mm]\n", "in quotes: \"2 mm\""),
            (
                "grading = 2,5\n",
                "write grading = 2.5, with a decimal point",
            ),
            ("density = 1020 kg/m³\n", "density = \"1020 kg/m³\""),
            ("law = \"yeoh\"\nlaw = \"gent\"\n", "a card has one law"),
            ("[plate]\na = 1\na = 2\n", "leave one out"),
            ("[plate]\na = 1\n[plate]\nb = 2\n", "stand once"),
        ] {
            let told = told(text);
            assert!(told.contains(expected), "{text}: {told}");
        }
    }

    #[test]
    fn a_text_that_is_no_toml_at_all_is_told_in_a_few_lines() {
        let told = told(&"1,2,3,4\n".repeat(500));
        assert!(told.lines().count() <= 6, "{told}");
        assert!(told.contains("more faults of syntax"), "{told}");
    }
}
