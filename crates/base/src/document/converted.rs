//! The result of converting a file of another program: the text of a table, or a refusal.

use crate::budget::{Budget, Need};

/// Why a file is not turned into a table, and the remedy.
#[derive(Debug)]
pub(super) struct Unconvertible {
    pub message: String,
    pub hint: String,
}

impl Unconvertible {
    pub fn new(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            hint: hint.into(),
        }
    }
}

/// A table's name within its file, if it has one, and its text: fields with tabs between them.
#[derive(Debug)]
pub(super) struct TableText {
    pub name: Option<String>,
    pub text: String,
}

/// Checks that a table of so many bytes of text and numbers has room in memory, before it is decoded.
///
/// # Errors
/// [`Unconvertible`] with the need.
pub(super) fn afford(bytes: f64, numbers: f64) -> Result<(), Unconvertible> {
    /// Bytes of a number: its digits twice, and its value with its share of the row.
    const OF_A_NUMBER: f64 = 80.0;
    let need = Need {
        bytes: 2.0 * bytes + OF_A_NUMBER * numbers,
        ..Need::default()
    };
    Budget::USUAL.afford(need).map_err(|excess| {
        Unconvertible::new(
            excess.to_string(),
            "keep the part that is wanted in a file of its own",
        )
    })
}
