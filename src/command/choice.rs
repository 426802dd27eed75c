//! Arguments that are one of some names, which help and completions list.

use clap::builder::{PossibleValuesParser, TypedValueParser};

/// The parser of what such names stand for.
pub fn one_of<T: Copy + Send + Sync + 'static>(
    names: &'static [(&'static str, T)],
) -> impl TypedValueParser<Value = T> {
    let known = names.iter().map(|(name, _)| *name);
    PossibleValuesParser::new(known).map(|name| {
        let mut all = names.iter();
        all.find(|(known, _)| *known == name)
            .expect("clap has found the name among them")
            .1
    })
}
