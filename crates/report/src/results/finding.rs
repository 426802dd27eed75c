//! Warnings and doubts about results.

use std::fmt;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::document::stored::{StaticText, static_text};
use crate::error::Diagnostic;

/// How much a finding weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Weight {
    /// It deserves attention.
    Warning,
    /// It makes figures doubtful: a study with such a finding has not passed.
    Doubt,
}

/// A finding: the rule that it follows from, what was found with its figures, and what to do.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    /// The name of the rule, such as `locking`.
    #[serde(deserialize_with = "static_text")]
    pub rule: StaticText,
    /// How much it weighs.
    pub weight: Weight,
    /// What was found.
    pub message: String,
    /// What to do; empty where there is nothing.
    pub remedy: String,
}

/// What a rule has found and what to do, which may be nothing.
pub type Found = (String, String);

impl Finding {
    /// A finding that deserves attention.
    pub fn warning(rule: &'static str, (message, remedy): Found) -> Self {
        Self {
            rule,
            weight: Weight::Warning,
            message,
            remedy,
        }
    }

    /// A finding that makes figures doubtful.
    pub fn doubt(rule: &'static str, finding: Found) -> Self {
        Self {
            weight: Weight::Doubt,
            ..Self::warning(rule, finding)
        }
    }

    /// A doubt with the message and the hint of a diagnostic.
    pub fn doubt_of(rule: &'static str, diagnostic: Diagnostic) -> Self {
        let remedy = diagnostic.hint.unwrap_or_default();
        Self::doubt(rule, (diagnostic.message, remedy))
    }

    /// Whether it makes figures doubtful.
    pub fn is_doubt(&self) -> bool {
        self.weight == Weight::Doubt
    }

    /// For machines.
    pub fn json(&self) -> Value {
        let remedy = (!self.remedy.is_empty()).then_some(&self.remedy);
        json!({
            "rule": self.rule,
            "is_doubt": self.is_doubt(),
            "message": self.message,
            "remedy": remedy,
        })
    }
}

impl fmt::Display for Finding {
    /// A warning in sentences, a doubt with its remedy in brackets.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            message, remedy, ..
        } = self;
        match self.weight {
            _ if remedy.is_empty() => write!(f, "{message}"),
            Weight::Warning => write!(f, "{message}. {remedy}"),
            Weight::Doubt => write!(f, "{message} ({remedy})"),
        }
    }
}
