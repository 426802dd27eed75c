//! Whether values follow a JSON Schema.

use serde_json::Value;

/// What of a value does not follow a schema, of the keywords that gelbench's schemas use.
pub fn faults(schema: &Value, value: &Value, position: &str) -> Vec<String> {
    let mut result = Vec::new();
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
        if each.all(|result| !result.is_empty()) {
            result.push(format!("{position}: {value} is none of the choices"));
        }
    }
    let listed = schema["enum"].as_array();
    let constant = &schema["const"];
    let farther = |limit: &str, farther: fn(f64, f64) -> bool| {
        let limit = schema[limit].as_f64();
        value
            .as_f64()
            .zip(limit)
            .is_some_and(|(value, limit)| farther(value, limit))
    };
    let outside = farther("minimum", |value, least| value < least)
        || farther("maximum", |value, most| value > most)
        || farther("exclusiveMinimum", |value, least| value <= least);
    if outside || !constant.is_null() && constant != value {
        result.push(format!("{position}: {value}"));
    }
    if !of_type || listed.is_some_and(|listed| !listed.contains(value)) {
        result.push(format!("{position}: {value}"));
    }
    for (index, item) in value.as_array().into_iter().flatten().enumerate() {
        result.extend(faults(
            &schema["items"],
            item,
            &format!("{position}[{index}]"),
        ));
    }
    let Some(entries) = value.as_object() else {
        return result;
    };
    for key in schema["required"].as_array().into_iter().flatten() {
        if !entries.contains_key(key.as_str().unwrap()) {
            result.push(format!("{position}: lacks {key}"));
        }
    }
    for (key, entry) in entries {
        let position = format!("{position}.{key}");
        match (&schema["properties"][key], &schema["additionalProperties"]) {
            (Value::Null, Value::Bool(false)) => result.push(format!("{position}: not allowed")),
            (Value::Null, other) => result.extend(faults(other, entry, &position)),
            (known, _) => result.extend(faults(known, entry, &position)),
        }
    }
    result
}
