//! The remarks on keys in the comments of a TOML file.

use std::collections::BTreeMap;

/// The remark behind each key and table of a file, by its path: `plate.length`, `support[].kind`. Indented lines with
/// only a remark belong to the key before them. Keys that are themselves commented out count too.
pub fn comments(text: &str) -> BTreeMap<String, String> {
    let mut result: BTreeMap<String, String> = BTreeMap::new();
    let (mut table, mut last) = (String::new(), None);
    for line in text.lines() {
        let remark = line.trim_start().strip_prefix('#');
        if let (true, Some(remark), Some(path)) = (line.starts_with(' '), remark, &last) {
            let known: &mut String = result.entry(String::clone(path)).or_default();
            *known += &format!(" {}", remark.trim());
            continue;
        }
        let statement = line.strip_prefix("# ").unwrap_or(line);
        let (statement, remark) = split(statement);
        last = path(statement, &mut table);
        if let (Some(path), false) = (&last, remark.is_empty()) {
            result.entry(path.clone()).or_insert(remark.to_owned());
        }
    }
    result
}

/// A statement and the remark behind it.
fn split(line: &str) -> (&str, &str) {
    let mut quoted = false;
    for (at, letter) in line.char_indices() {
        quoted ^= letter == '"';
        if letter == '#' && !quoted {
            return (line[..at].trim(), line[at + 1..].trim());
        }
    }
    (line.trim(), "")
}

/// The path of the key or table in a statement.
fn path(statement: &str, table: &mut String) -> Option<String> {
    let within = |statement: &str, begin: &str, end: &str| {
        let name = statement.strip_prefix(begin)?.strip_suffix(end)?;
        is_name(name).then(|| name.to_owned())
    };
    if let Some(name) = within(statement, "[[", "]]") {
        *table = format!("{name}[]");
        return Some(table.clone());
    }
    if let Some(name) = within(statement, "[", "]") {
        *table = name;
        return Some(table.clone());
    }
    let (key, _) = statement.split_once('=')?;
    let key = key.trim();
    is_name(key).then(|| {
        if table.is_empty() {
            key.to_owned()
        } else {
            format!("{table}.{key}")
        }
    })
}

fn is_name(name: &str) -> bool {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "_.".contains(letter);
    !name.is_empty() && name.chars().all(plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_belong_to_their_keys() {
        let text = "# A study.\ntitle = \"a # b\"  # shown above\n\n[plate]  # a rectangle\nlength = 1 # along x,\n   \
                    # between grips\n# to = 2   # a ramp\n\n[[support]]\nkind = \"clamp\" # or roller\n# [a.b] # more\n# c = 1 # c\n";
        let result = comments(text);
        for (path, remark) in [
            ("title", "shown above"),
            ("plate", "a rectangle"),
            ("plate.length", "along x, between grips"),
            ("plate.to", "a ramp"),
            ("support[].kind", "or roller"),
            ("a.b.c", "c"),
        ] {
            assert_eq!(result[path], remark, "{result:?}");
        }
        assert_eq!(result.len(), 7);
    }
}
