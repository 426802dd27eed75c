//! Remedies for faults of TOML's syntax.

use std::ops::Range;

/// What to write instead, where the text about a syntax fault shows it.
pub(super) fn remedy(text: &str, position: &Range<usize>, message: &str) -> Option<String> {
    if message.contains("duplicate key") {
        let key = text.get(position.clone()).unwrap_or_default().trim();
        return Some(match key {
            "law" => "a card has one law: remove one, or write a card for each".to_owned(),
            _ => {
                "a key or a [table] may appear only once: remove one; lists of tables are written [[key]]"
                    .to_owned()
            }
        });
    }
    if let Some(quote) = typographic_quote(text, position.start) {
        return Some(format!(
            "{quote} is a typographic quote: use the straight \" around texts"
        ));
    }
    let (key, value) = unquoted(text, position.start)?;
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

/// A quotation mark unknown to TOML in the line that contains a place.
fn typographic_quote(text: &str, at: usize) -> Option<char> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    let line = text[start..].lines().next()?;
    line.chars().find(|letter| "“”„‘’‚«»".contains(*letter))
}

/// Advice where the text about a fault does not show what the author intended.
pub(super) fn advice(message: &str) -> Option<String> {
    let closing = match message {
        _ if message.contains("array") => "a list that is opened by [ or a text in quotes",
        _ if message.contains("table") => "a heading that is opened by [",
        _ if message.contains("string") => "a text in quotes",
        _ => return None,
    };
    Some(format!(
        "{closing} must be closed: check this line and the lines before"
    ))
}

/// A place that can be displayed: at least one character of the text, the one before an empty place at the end of a line.
pub(super) fn visible(text: &str, position: Range<usize>) -> Range<usize> {
    let Some(before) = text.get(..position.start).filter(|_| position.is_empty()) else {
        return position;
    };
    let here = text[position.start..].chars().next();
    match here.filter(|letter| !letter.is_whitespace()) {
        Some(letter) => position.start..position.start + letter.len_utf8(),
        None => {
            let start = before.trim_end().char_indices().next_back();
            start.map_or(position, |(start, letter)| start..start + letter.len_utf8())
        }
    }
}

/// The value without quotes that contains a place, and the key before it with its equals sign.
fn unquoted(text: &str, at: usize) -> Option<(String, &str)> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    let with_remark = text[start..].lines().next().unwrap_or_default();
    let line = with_remark.split('#').next().unwrap_or_default();
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
    // The item of a list that contains the place.
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

    fn message(text: &str) -> String {
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
            ("[plate]\na = 1\na = 2\n", "remove one"),
            ("[plate]\na = 1\n[plate]\nb = 2\n", "only once"),
        ] {
            let message = message(text);
            assert!(message.contains(expected), "{text}: {message}");
        }
    }

    #[test]
    fn what_follows_from_an_open_bracket_or_quote_is_not_told() {
        for (text, line) in [
            (
                "[load]\nstretches = [\"15 %\", \"30 %\"\n[plate]\ncells = [60, 20]\n",
                "a.toml:3:",
            ),
            (
                "[load]\nstretches = [\"15 %\", \"30 %]\n[plate]\ncells = [60, 20]\n",
                "a.toml:3:",
            ),
            ("[load\nstretches = [\"15 %\"]\n[plate]\n", "a.toml:1:"),
        ] {
            let faults = Faults::default();
            let document = Document::parse("a.toml", text, &faults);
            document.root(None, &faults).unknown_keys();
            let message = faults.finish().expect_err(text).to_string();
            assert!(
                message.contains(line) && message.contains("TOML syntax"),
                "{message}"
            );
            assert!(
                message.lines().count() <= 3 && !message.contains("unknown"),
                "{message}"
            );
        }
    }

    #[test]
    fn a_text_that_is_no_toml_at_all_is_told_in_a_few_lines() {
        let message = message(&"1,2,3,4\n".repeat(500));
        assert!(message.lines().count() <= 6, "{message}");
        assert!(message.contains("further syntax errors"), "{message}");
    }
}
