//! How results are stored for a command that goes on after an interrupt: texts of the program itself, and JSON, in a format that is neither.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A text of the program itself.
pub type StaticText = &'static str;

/// Reads a text of the program, which stays in memory until it ends: a few hundred words.
///
/// # Errors
/// Those of the deserializer.
pub fn static_text<'a, D: Deserializer<'a>>(from: D) -> Result<StaticText, D::Error> {
    String::deserialize(from).map(|text| &*text.leak())
}

/// Reads a text of the program where there may be none.
///
/// # Errors
/// As [`static_text`].
pub fn optional_static_text<'a, D: Deserializer<'a>>(
    from: D,
) -> Result<Option<StaticText>, D::Error> {
    let text = Option::<String>::deserialize(from)?;
    Ok(text.map(|text| &*text.leak()))
}

/// JSON as its text.
pub mod json {
    use super::*;

    /// Writes the text.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<T: Serialize, S: Serializer>(value: &T, to: S) -> Result<S::Ok, S::Error> {
        let text = serde_json::to_string(value).map_err(serde::ser::Error::custom)?;
        text.serialize(to)
    }

    /// Reads the text.
    ///
    /// # Errors
    /// Those of the deserializer, and where the text is no such JSON.
    pub fn deserialize<'a, T: serde::de::DeserializeOwned, D: Deserializer<'a>>(
        from: D,
    ) -> Result<T, D::Error> {
        let text = String::deserialize(from)?;
        serde_json::from_str(&text).map_err(D::Error::custom)
    }
}
