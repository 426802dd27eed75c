//! Assertions that many tests share.

/// Asserts that a text has a part, and shows it otherwise.
#[track_caller]
pub fn assert_contains(text: &str, part: &str) {
    assert!(text.contains(part), "{text}");
}
