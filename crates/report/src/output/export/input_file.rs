//! What is written for another code.

/// An input file of another code.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct InputFile {
    /// Its text.
    pub text: String,
    /// Where it differs from the study.
    pub remarks: Vec<String>,
}
