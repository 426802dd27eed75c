//! Names, texts and numbers that every code reads.

use std::collections::BTreeSet;

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
        let plain = match plain.chars().next() {
            Some('A'..='Z') => plain,
            _ => format!("G_{plain}"),
        };
        let numbered = (2..).map(|number| format!("{plain}_{number}"));
        let mut wishes = std::iter::once(plain.clone()).chain(numbered);
        let name = wishes.find(|name| !self.0.contains(name));
        let name = name.expect("numbers do not end");
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
    let short = [format!("{value}"), format!("{value:e}")];
    let short = short.into_iter().find(|text| text.len() <= 17);
    short.unwrap_or_else(|| format!("{value:.11e}"))
}
