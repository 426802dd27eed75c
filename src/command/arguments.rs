//! Arguments that several commands share.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use gelbench_base::budget::Budget;
use gelbench_base::error::Diagnostic;
use gelbench_base::units::{self, Dimension};

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

/// A value in the internal unit of its dimension.
pub fn quantity(text: &str, dimension: Dimension) -> Result<f64, Diagnostic> {
    units::parse(text, dimension).map_err(|fault| {
        let hint = fault.remedy(text, dimension);
        Diagnostic::error("", format!("it {fault}")).hint(hint)
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
