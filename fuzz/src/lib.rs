//! What the targets of the campaign do with their inputs, and how many computations came to their end.

use std::sync::atomic::{AtomicU64, Ordering};

pub mod entries;

use entries::Became;

static INPUTS: AtomicU64 = AtomicU64::new(0);
static COMPLETE: AtomicU64 = AtomicU64::new(0);
static UNSOLVED: AtomicU64 = AtomicU64::new(0);

/// Tries an input on a target. The file that the environment names in `GELBENCH_FUZZ_COUNTS` tells, every ten inputs, how many
/// there were, how many of them were read or computed to the end, and how many to where there is no solution.
pub fn count(target: &str, bytes: &[u8]) {
    match entries::try_on(target, bytes) {
        Became::Complete => COMPLETE.fetch_add(1, Ordering::Relaxed),
        Became::Unsolved => UNSOLVED.fetch_add(1, Ordering::Relaxed),
        Became::Refused => 0,
    };
    let inputs = 1 + INPUTS.fetch_add(1, Ordering::Relaxed);
    if inputs.is_multiple_of(10)
        && let Ok(file) = std::env::var("GELBENCH_FUZZ_COUNTS")
    {
        let [complete, unsolved] = [&COMPLETE, &UNSOLVED].map(|count| count.load(Ordering::Relaxed));
        let message = format!("{inputs} inputs, {complete} complete, {unsolved} without a solution\n");
        let _ = std::fs::write(file, message);
    }
}
