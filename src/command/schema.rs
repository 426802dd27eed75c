//! The JSON Schema of a kind of files, by which editors complete and check them.

use serde_json::{Map, Value, json};

use super::reference::FileKind;
use super::terminal::{Outcome, print_data};
use gelbench_base::document::{Bound, FoundKey, Presence, Takes, comments};
use gelbench_base::units::Dimension;

/// Prints the schema of a kind of files.
pub fn print_schema(kind: FileKind) -> Outcome {
    print_data(&format!("{:#}\n", schema(kind)))?;
    Ok(0)
}

/// The schema of a kind of files.
pub fn schema(kind: FileKind) -> Value {
    let remarks = comments(kind.template());
    let mut root = object();
    for entry in kind.keys() {
        let mut property = any_of(&entry);
        if let Some(remark) = remarks.get(&entry.key.path) {
            property["description"] = json!(about(&entry, remark));
        }
        if let (Presence::Default, Some(value)) = (entry.key.presence, default(&entry)) {
            property["default"] = value;
        }
        put(&mut root, &entry, property);
    }
    root["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    root["title"] = json!(format!("gelbench: {}", kind.name()));
    root
}

fn object() -> Value {
    json!({ "type": "object", "properties": {}, "additionalProperties": false })
}

fn about(entry: &FoundKey, remark: &str) -> String {
    match &entry.only_with {
        None => remark.to_owned(),
        Some((choice, names)) => format!("{remark} (with {choice} = {})", names.join(", ")),
    }
}

/// The default, where it is a value of JSON too.
fn default(entry: &FoundKey) -> Option<Value> {
    serde_json::from_str(entry.key.example.as_deref()?).ok()
}

/// Puts the schema of a key into that of its table.
fn put(root: &mut Value, entry: &FoundKey, property: Value) {
    let mut table = root;
    let mut parts: Vec<&str> = entry.key.path.split('.').collect();
    let name = parts.pop().unwrap_or_default();
    for part in parts {
        let next = &mut table["properties"][part.trim_end_matches("[]")];
        table = if part.ends_with("[]") {
            &mut next["items"]
        } else {
            next
        };
        if table.is_null() {
            *table = object();
        }
    }
    table["properties"][name] = property;
    if entry.key.presence == Presence::Required && entry.only_with.is_none() {
        match table["required"].as_array_mut() {
            Some(required) => required.push(json!(name)),
            None => table["required"] = json!([name]),
        }
    }
}

fn any_of(entry: &FoundKey) -> Value {
    let mut all: Vec<Value> = entry.key.takes.iter().map(of_value).collect();
    match all.len() {
        0 => Value::Object(Map::new()),
        _ if entry.key.takes == [Takes::Section, Takes::Sections] => {
            // Each keyword concerns tables or lists alone.
            let mut table = object();
            table["type"] = json!(["object", "array"]);
            table["items"] = object();
            table
        }
        1 => all.swap_remove(0),
        _ => json!({ "anyOf": all }),
    }
}

fn of_value(takes: &Takes) -> Value {
    let integer =
        |[low, high]: &[usize; 2]| json!({ "type": "integer", "minimum": low, "maximum": high });
    let pair =
        |limits| json!({ "type": "array", "items": integer(limits), "minItems": 2, "maxItems": 2 });
    match takes {
        Takes::Text | Takes::LinearLength => json!({ "type": "string" }),
        Takes::Texts => json!({ "type": "array", "items": { "type": "string" } }),
        Takes::Flag => json!({ "type": "boolean" }),
        Takes::Choice(names) => json!({ "enum": names }),
        Takes::Choices(names) => json!({ "type": "array", "items": { "enum": names } }),
        Takes::Count(limits) => integer(limits),
        Takes::Counts(limits, None) => pair(limits),
        Takes::Counts(limits, Some(word)) => json!({ "anyOf": [pair(limits), { "const": word }] }),
        Takes::Number(bound) => number(*bound),
        Takes::Quantity(dimension, bound) => quantity(*dimension, *bound),
        Takes::Quantities(dimension, bound) => {
            json!({ "type": "array", "items": quantity(*dimension, *bound) })
        }
        Takes::Unit(_) => json!({ "type": "string" }),
        Takes::Section => object(),
        Takes::Sections => json!({ "type": "array", "items": object() }),
    }
}

fn number(bound: Bound) -> Value {
    match bound {
        Bound::Any => json!({ "type": "number" }),
        Bound::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Bound::NonNegative => json!({ "type": "number", "minimum": 0 }),
        Bound::Within(low, high) | Bound::Range(low, high, _) => {
            json!({ "type": "number", "minimum": low, "maximum": high })
        }
    }
}

/// A number with one of the units of a dimension, or a bare ratio.
fn quantity(dimension: Dimension, bound: Bound) -> Value {
    let escaped = dimension.units().map(|unit| {
        let letters = unit.chars();
        letters.fold(String::new(), |text, letter| match letter {
            '^' | '/' | '.' | '*' => format!("{text}\\{letter}"),
            letter => format!("{text}{letter}"),
        })
    });
    let units = escaped.collect::<Vec<_>>().join("|");
    let units = units
        .replace("\\^2", "(\\^2|²)")
        .replace("\\^3", "(\\^3|³)");
    let unit = match dimension {
        Dimension::Ratio => format!("({units})?"),
        _ => format!("({units})"),
    };
    let pattern = format!(r"^\s*[+-]?[0-9.]+([eE][+-]?[0-9]+)?\s*{unit}\s*$");
    let text = json!({ "type": "string", "pattern": pattern });
    match dimension {
        Dimension::Ratio => json!({ "anyOf": [number(bound), text] }),
        _ => text,
    }
}
