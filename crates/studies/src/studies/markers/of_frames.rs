//! What is said of frames: each message once, however many frames it is about.

use crate::error::Diagnostic;

/// What is said of one frame, and what to do.
pub struct OfFrame {
    /// The frame's number.
    pub frame: usize,
    /// What is said of it.
    pub message: String,
    /// What to do: the same for all that is of one kind; empty where there is nothing.
    pub hint: String,
}

/// One warning for each kind of messages, in the order of their first ones; of messages that differ in their figures the last stands for all.
/// `all` are the numbers of the frames in their order.
pub fn once(all: &[usize], messages: Vec<OfFrame>) -> Vec<Diagnostic> {
    let mut kinds: Vec<Vec<OfFrame>> = Vec::new();
    for message in messages {
        match kinds.iter_mut().find(|kind| kind[0].hint == message.hint) {
            Some(kind) => kind.push(message),
            None => kinds.push(vec![message]),
        }
    }
    kinds.iter().filter_map(|kind| warning(all, kind)).collect()
}

fn warning(all: &[usize], kind: &[OfFrame]) -> Option<Diagnostic> {
    let last = kind.last()?;
    let numbers: Vec<usize> = kind.iter().map(|one| one.frame).collect();
    let differs = kind.iter().any(|one| one.message != last.message);
    let example = if differs {
        format!(", as frame {}", last.frame)
    } else {
        String::new()
    };
    let frames = if numbers.len() == 1 {
        "frame"
    } else {
        "frames"
    };
    let message = format!(
        "{frames} {}{example}: {}",
        runs(all, &numbers),
        last.message
    );
    let warning = Diagnostic::warning("", message);
    Some(match last.hint.as_str() {
        "" => warning,
        hint => warning.hint(hint),
    })
}

/// Some of all numbers, those that follow each other in one: `4`, `4, 9`, `4 to 34`.
fn runs(all: &[usize], numbers: &[usize]) -> String {
    let place = |number: &usize| all.iter().position(|known| known == number);
    let runs = numbers.chunk_by(|a, b| place(a).map(|place| place + 1) == place(b));
    let words = runs.map(|run| match run {
        [first, _, .., last] => format!("{first} to {last}"),
        few => few
            .iter()
            .map(usize::to_string)
            .collect::<Vec<_>>()
            .join(", "),
    });
    words.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(frame: usize, message: &str, hint: &str) -> OfFrame {
        OfFrame {
            frame,
            message: message.to_owned(),
            hint: hint.to_owned(),
        }
    }

    #[test]
    fn fifty_equal_frames_are_one_line() {
        let all: Vec<usize> = (1..=60).collect();
        let equal = (1..=50).map(|frame| said(frame, "the noise is large", "check it"));
        let told = once(&all, equal.collect());
        assert_eq!(told.len(), 1);
        assert_eq!(told[0].message, "frames 1 to 50: the noise is large");
        assert_eq!(told[0].hint.as_deref(), Some("check it"));
    }

    #[test]
    fn kinds_keep_their_order_and_of_figures_that_differ_the_last_ones_stand_for_all() {
        let messages = vec![
            said(10, "p = 1e-9", "a"),
            said(30, "p = 1e-7", "a"),
            said(20, "lost", ""),
        ];
        let told = once(&[10, 20, 30, 40], messages);
        let messages: Vec<&str> = told.iter().map(|one| one.message.as_str()).collect();
        assert_eq!(
            messages,
            ["frames 10, 30, as frame 30: p = 1e-7", "frame 20: lost"]
        );
        assert_eq!(told[1].hint, None);
    }
}
