//! The file for another code, and the names, texts and numbers that every code reads.

use std::collections::BTreeSet;

/// An input file of another code.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct InputFile {
    /// Its text.
    pub text: String,
    /// Where it differs from the study.
    pub remarks: Vec<String>,
}

/// Names that the writers give themselves: codes unite sets of one name.
pub const ALL_NODES: &str = "ALL_NODES";
pub const SPECIMEN: &str = "SPECIMEN";
pub const MATERIAL: &str = "MATERIAL_1";
pub const FIBRES: &str = "FIBRES";
pub const FACTORS: &str = "FACTORS";
pub const MID_PLANE: &str = "MIDDLE_OF_THE_SHEET";
const OWN: [&str; 6] = [ALL_NODES, SPECIMEN, MATERIAL, FIBRES, FACTORS, MID_PLANE];

/// What numbered names of theirs begin with.
pub const TURNED: &str = "TURNED_";
pub const FORCE: &str = "FORCE_";
const OWN_NUMBERED: [&str; 2] = [TURNED, FORCE];

/// Names that every code understands: letters, digits and underscores, in capitals, each given once.
#[derive(Default)]
pub struct Names(BTreeSet<String>);

impl Names {
    pub fn give(&mut self, wish: &str) -> String {
        let plain: String = wish
            .chars()
            .map(|c| {
                if c.is_ascii_alphanumeric() {
                    c.to_ascii_uppercase()
                } else {
                    '_'
                }
            })
            .take(60)
            .collect();
        let is_reserved = OWN.contains(&&*plain)
            || OWN_NUMBERED
                .iter()
                .any(|reserved| plain.starts_with(reserved));
        let plain = match plain.chars().next() {
            Some('A'..='Z') if !is_reserved => plain,
            _ => format!("G_{plain}"),
        };
        let numbered = (2..).map(|number| format!("{plain}_{number}"));
        let mut wishes = std::iter::once(plain.clone()).chain(numbered);
        let free = wishes.find(|name| !self.0.contains(name));
        let name = free.expect("numbers do not end");
        self.0.insert(name.clone());
        name
    }
}

/// A text in ASCII, with question marks for everything else.
pub fn ascii(text: &str) -> String {
    let plain = |c: char| {
        if c.is_ascii() && !c.is_ascii_control() {
            c
        } else {
            '?'
        }
    };
    text.chars().map(plain).collect()
}

/// A number in at most 20 characters, of which CalculiX reads no more, to twelve digits at least.
pub fn number(value: f64) -> String {
    let forms = [format!("{value}"), format!("{value:e}")];
    let short = forms.into_iter().find(|text| text.len() <= 17);
    short.unwrap_or_else(|| format!("{value:.11e}"))
}

/// Numbers with blanks between them.
pub fn words<T: ToString>(numbers: impl IntoIterator<Item = T>) -> String {
    let words = numbers.into_iter().map(|number| number.to_string());
    words.collect::<Vec<_>>().join(" ")
}
