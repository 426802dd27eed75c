//! What the targets of the campaign do with their inputs, and how many computations came to their end.

use std::sync::atomic::{AtomicU64, Ordering};

pub mod entries;

static INPUTS: AtomicU64 = AtomicU64::new(0);
static COMPLETE: AtomicU64 = AtomicU64::new(0);

/// Tries an input on a target. The file that the environment names in `GELBENCH_FUZZ_COUNTS` tells, every hundred inputs, how
/// many there were and how many of them were not refused.
pub fn count(target: &str, bytes: &[u8]) {
    let complete = entries::try_on(target, bytes) == entries::Became::Complete;
    let complete = COMPLETE.fetch_add(complete.into(), Ordering::Relaxed) + u64::from(complete);
    let inputs = 1 + INPUTS.fetch_add(1, Ordering::Relaxed);
    if inputs.is_multiple_of(100)
        && let Ok(file) = std::env::var("GELBENCH_FUZZ_COUNTS")
    {
        let _ = std::fs::write(file, format!("{inputs} inputs, {complete} complete\n"));
    }
}
