//! The option that lets large studies pass.

use clap::Args;

use gelbench_base::budget::Budget;

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
