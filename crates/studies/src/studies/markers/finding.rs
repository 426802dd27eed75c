//! A finding on frames, reported once with the numbers of the frames that it is about.

use crate::results::{Finding, Found};

/// A finding on one frame: its number, what was found, and what to do, which is the same for all findings of one kind.
pub type OfFrame = (usize, Found);

/// One doubt of a rule for each kind of findings, in the order of their first ones; messages that differ in their figures become one with their
/// ranges. `all` are the numbers of the frames in their order.
pub fn once(
    all: &[usize],
    rule: &'static str,
    findings: impl Iterator<Item = OfFrame>,
) -> Vec<Finding> {
    let mut kinds: Vec<Vec<OfFrame>> = Vec::new();
    for finding in findings {
        match kinds.iter_mut().find(|kind| kind[0].1.1 == finding.1.1) {
            Some(kind) => kind.push(finding),
            None => kinds.push(vec![finding]),
        }
    }
    let doubts = kinds.iter().filter_map(|kind| together(all, kind));
    doubts.map(|doubt| Finding::doubt(rule, doubt)).collect()
}

/// The doubt about all frames with one kind of finding.
fn together(all: &[usize], kind: &[OfFrame]) -> Option<Found> {
    let (frame, (last, remedy)) = kind.last()?;
    let numbers: Vec<usize> = kind.iter().map(|(frame, _)| *frame).collect();
    let frames = if numbers.len() == 1 {
        "frame"
    } else {
        "frames"
    };
    let messages: Vec<&str> = kind.iter().map(|(_, (message, _))| &**message).collect();
    let numbers = runs(all, &numbers);
    let message = match with_ranges(&messages) {
        Some(message) => format!("{frames} {numbers}: {message}"),
        None => format!("{frames} {numbers}, as frame {frame}: {last}"),
    };
    Some((message, remedy.clone()))
}

/// Messages that differ in numbers alone as one: `7 to 10 markers` of `10 markers` and `7 markers`.
fn with_ranges(messages: &[&str]) -> Option<String> {
    let first: Vec<&str> = messages.first()?.split(' ').collect();
    let all = messages.iter().map(|message| message.split(' ').collect());
    let all: Vec<Vec<&str>> = all.collect();
    if all.iter().any(|words| words.len() != first.len()) {
        return None;
    }
    let word =
        |position: usize| range(&all.iter().map(|words| words[position]).collect::<Vec<_>>());
    let words: Option<Vec<String>> = (0..first.len()).map(word).collect();
    Some(words?.join(" "))
}

/// One word for several: the same, or the range of numbers that all have the same punctuation behind them.
fn range(words: &[&str]) -> Option<String> {
    let first = words.first()?;
    if words.iter().all(|word| word == first) {
        return Some((*first).to_owned());
    }
    let mark = first.trim_start_matches(|letter: char| !",;:)".contains(letter));
    let number = |word: &&str| {
        let text = word.strip_suffix(mark)?.to_owned();
        Some((text.parse::<f64>().ok()?, text))
    };
    let mut numbers: Vec<(f64, String)> = words.iter().map(number).collect::<Option<_>>()?;
    numbers.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(format!("{} to {}{mark}", numbers[0].1, numbers.last()?.1))
}

/// Some of all numbers, those that follow each other in one: `4`, `4, 9`, `4 to 34`.
pub fn runs(all: &[usize], numbers: &[usize]) -> String {
    let index = |number: &usize| all.iter().position(|known| known == number);
    let runs = numbers.chunk_by(|a, b| index(a).map(|index| index + 1) == index(b));
    runs.map(span).collect::<Vec<_>>().join(", ")
}

/// Numbers that follow each other: `4`, `4, 9`, `4 to 34`.
pub fn span(run: &[usize]) -> String {
    match run {
        [first, _, .., last] => format!("{first} to {last}"),
        few => few
            .iter()
            .map(usize::to_string)
            .collect::<Vec<_>>()
            .join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(frame: usize, message: &str, remedy: &str) -> OfFrame {
        (frame, (message.to_owned(), remedy.to_owned()))
    }

    #[test]
    fn fifty_equal_frames_are_one_line() {
        let all: Vec<usize> = (1..=60).collect();
        let equal = (1..=50).map(|frame| finding(frame, "the noise is large", "check it"));
        let warnings = once(&all, "noise", equal);
        assert_eq!(warnings.len(), 1);
        assert_eq!(warnings[0].message, "frames 1 to 50: the noise is large");
        assert_eq!(warnings[0].remedy, "check it");
    }

    #[test]
    fn kinds_keep_their_order_and_figures_that_differ_become_ranges() {
        let messages = vec![
            finding(10, "p = 1e-9, 8 of 9", "a"),
            finding(30, "p = 1e-7, 10 of 9", "a"),
            finding(20, "lost", ""),
            finding(20, "near left", "b"),
            finding(40, "near right", "b"),
        ];
        let warnings = once(&[10, 20, 30, 40], "lost", messages.into_iter());
        let messages: Vec<&str> = warnings.iter().map(|one| one.message.as_str()).collect();
        assert_eq!(
            messages,
            [
                "frames 10, 30: p = 1e-9 to 1e-7, 8 to 10 of 9",
                "frame 20: lost",
                "frames 20, 40, as frame 40: near right"
            ]
        );
        assert!(warnings[1].remedy.is_empty());
    }
}
