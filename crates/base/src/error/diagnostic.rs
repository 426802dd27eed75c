//! Findings about an input: where they are, what is wrong, and what to do about it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A text that was read, kept so that messages can point into it.
#[derive(Debug, PartialEq, Eq)]
pub struct Source {
    /// The file's name as the user gave it.
    pub name: String,
    /// The file's content.
    pub text: String,
}

impl Source {
    /// One-based line of a byte offset.
    pub fn line(&self, offset: usize) -> usize {
        1 + self
            .text
            .bytes()
            .take(offset)
            .filter(|byte| *byte == b'\n')
            .count()
    }
}

/// Whether a finding stops the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The work goes on.
    Warning,
    /// The work cannot begin.
    Error,
}

/// One finding about an input: where it is, what is wrong, and what to do about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Whether this finding stops the program.
    pub severity: Severity,
    /// The text and the bytes in it that the finding is about.
    pub position: Option<(Arc<Source>, Range<usize>)>,
    /// The key's full path, such as `plate.length`.
    pub key: String,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// A finding that stops the program.
    pub fn error(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            position: None,
            key: key.into(),
            message: message.into(),
            hint: None,
        }
    }

    /// A finding that does not stop the program.
    pub fn warning(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(key, message)
        }
    }

    /// Says what to do.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Says before the message what it is about.
    #[must_use]
    pub fn prefixed(mut self, name: impl fmt::Display) -> Self {
        self.message = format!("{name}: {}", self.message);
        self
    }

    /// Says where.
    #[must_use]
    pub fn at(mut self, source: &Arc<Source>, span: Range<usize>) -> Self {
        let end = source.text.len();
        self.position = Some((Arc::clone(source), span.start.min(end)..span.end.min(end)));
        self
    }
}

impl fmt::Display for Diagnostic {
    /// One line: `file:line: key: message (hint)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((source, span)) = &self.position {
            write!(f, "{}:{}: ", source.name, source.line(span.start))?;
        }
        if !self.key.is_empty() {
            write!(f, "{}: ", self.key)?;
        }
        write!(f, "{}", self.message)?;
        match &self.hint {
            Some(hint) => write!(f, " ({hint})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Diagnostic {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagnostic_names_file_line_key_and_remedy() {
        let source = Arc::new(Source {
            name: "a.toml".into(),
            text: "x = 1\ny = 2\n".into(),
        });
        let diagnostic = Diagnostic::error("y", "must be below 2")
            .hint("write 1")
            .at(&source, 10..11);
        assert_eq!(
            diagnostic.to_string(),
            "a.toml:2: y: must be below 2 (write 1)"
        );
    }
}
