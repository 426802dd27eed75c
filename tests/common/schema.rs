//! Whether values follow a JSON Schema.

use serde_json::Value;

/// What of a value does not follow a schema, of the keywords that gelbench's schemas use.
pub fn faults(schema: &Value, value: &Value, position: &str) -> Vec<String> {
    let mut found = Vec::new();
    let matches = |name: &Value| match name.as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("number") => value.is_number(),
        Some("boolean") => value.is_boolean(),
        Some("null") => value.is_null(),
        Some("integer") => value.is_u64() || value.is_i64(),
        other => panic!("unknown type {other:?}"),
    };
    let of_type = match &schema["type"] {
        Value::Null => true,
        Value::Array(names) => names.iter().any(matches),
        name => matches(name),
    };
    if let Some(choices) = schema["anyOf"].as_array() {
        let mut each = choices.iter().map(|choice| faults(choice, value, position));
        if each.all(|found| !found.is_empty()) {
            found.push(format!("{position}: {value} is none of the choices"));
        }
    }
    let listed = schema["enum"].as_array();
    let constant = &schema["const"];
    let beyond = |limit: &str, beyond: fn(f64, f64) -> bool| {
        let limit = schema[limit].as_f64();
        value
            .as_f64()
            .zip(limit)
            .is_some_and(|(value, limit)| beyond(value, limit))
    };
    let outside = beyond("minimum", |value, least| value < least)
        || beyond("maximum", |value, most| value > most)
        || beyond("exclusiveMinimum", |value, least| value <= least);
    if outside || !constant.is_null() && constant != value {
        found.push(format!("{position}: {value}"));
    }
    if !of_type || listed.is_some_and(|listed| !listed.contains(value)) {
        found.push(format!("{position}: {value}"));
    }
    for (index, item) in value.as_array().into_iter().flatten().enumerate() {
        found.extend(faults(
            &schema["items"],
            item,
            &format!("{position}[{index}]"),
        ));
    }
    let Some(entries) = value.as_object() else {
        return found;
    };
    for key in schema["required"].as_array().into_iter().flatten() {
        if !entries.contains_key(key.as_str().unwrap()) {
            found.push(format!("{position}: lacks {key}"));
        }
    }
    for (key, own) in entries {
        let position = format!("{position}.{key}");
        match (&schema["properties"][key], &schema["additionalProperties"]) {
            (Value::Null, Value::Bool(false)) => found.push(format!("{position}: not allowed")),
            (Value::Null, other) => found.extend(faults(other, own, &position)),
            (known, _) => found.extend(faults(known, own, &position)),
        }
    }
    found
}
