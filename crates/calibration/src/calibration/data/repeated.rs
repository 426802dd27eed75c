//! Tests that are given more than once.

use super::test_data::{Observation, TestData};
use crate::error::Error;

/// Refuses tests of which two are one: it would count twice.
///
/// # Errors
/// [`Error::Input`] with the first of them.
pub fn refuse_repeated(tests: &[TestData]) -> Result<(), Error> {
    for (index, test) in tests.iter().enumerate() {
        let first = tests[..index].iter().find(|first| are_same(first, test));
        if let Some(first) = first {
            let (name, first) = (&test.name, &first.name);
            let message = if name == first {
                format!("{name} is given twice")
            } else {
                format!("{name} has the same rows as {first}")
            };
            let hint = "each file counts as a measurement of its own: give each test once";
            return Err(Error::input(message, hint));
        }
    }
    Ok(())
}

fn times(data: &TestData) -> Option<&[f64]> {
    data.known_times().ok().flatten()
}

/// Whether two tests are one, whatever their files are called: no measurement is repeated to the last digit.
fn are_same(one: &TestData, other: &TestData) -> bool {
    let row = |one: &Observation| {
        let [first, second] = one.strains;
        ([first, second, one.stress].map(f64::to_bits), one.axis)
    };
    let rows = one.observations.iter().map(row);
    one.test == other.test
        && rows.eq(other.observations.iter().map(row))
        && times(one) == times(other)
}
