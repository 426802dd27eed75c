//! Arguments that several commands share.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use gelbench_base::budget::Budget;

/// The parser of an argument that is one of some names, which help and completions list.
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

/// What a command may use.
#[derive(Args, Debug)]
pub struct Large {
    /// Allow computations beyond a common machine: over a million cells, 20,000 instants or 8 GB of memory, as estimated
    /// before anything is built
    #[arg(long)]
    allow_large: bool,
}

impl Large {
    /// The budget that it stands for.
    pub fn budget(&self) -> Budget {
        if self.allow_large {
            Budget::LARGE
        } else {
            Budget::USUAL
        }
    }
}
