//! Texts with figures, compared number by number.

/// Relative difference of figures that are the same, and size below which they are rounding.
const SAME: f64 = 1e-4;
const NOTHING: f64 = 1e-6;

/// Whether two lines say the same; figures far below what is asked for are rounding and may differ.
pub fn agree(line: &str, other: &str) -> bool {
    let words = |line: &str| {
        line.split_whitespace()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let (these, those) = (words(line), words(other));
    these.len() == those.len() && these.iter().zip(&those).all(|(a, b)| same(a, b))
}

fn same(word: &str, other: &str) -> bool {
    let number = |word: &str| {
        let bare = word.trim_matches(['(', ')', ';', ',', ':']);
        bare.parse::<f64>()
    };
    match (number(word), number(other)) {
        (Ok(a), Ok(b)) => (a - b).abs() <= SAME * b.abs() || a.abs().max(b.abs()) < NOTHING,
        _ => word == other,
    }
}
