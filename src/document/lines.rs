//! What the lines of a table are: text without old line ends, separators, remarks, names.

use std::ops::Range;

use super::decimals::is_number;

/// A text without byte-order mark and old line ends; lines that begin with stars, as some programs write them first,
/// become remarks.
pub(super) fn plain_text(text: &str) -> String {
    let text = text.trim_start_matches('\u{feff}');
    let text = match text.contains('\n') {
        true => text.to_owned(),
        false => text.replace('\r', "\n"),
    };
    if !text.starts_with("***") {
        return text;
    }
    let remark = |line: &str| match line.strip_prefix('*') {
        Some(rest) => format!("#{rest}"),
        None => line.to_owned(),
    };
    text.split_inclusive('\n').map(remark).collect()
}

/// The separator of the first line that is no comment.
pub(super) fn delimiter(text: &str) -> Option<u8> {
    let line = text
        .split(['\n', '\r'])
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'))?;
    [b';', b'\t', b',']
        .into_iter()
        .find(|delimiter| line.as_bytes().contains(delimiter))
}

/// The line of a record: csv points to what stands before it, remarks and empty lines too.
pub(super) fn line_at(text: &str, from: usize) -> Range<usize> {
    let mut start = from;
    for line in text[from..].split_inclusive('\n') {
        if !line.trim().is_empty() && !line.starts_with('#') {
            return start..start + line.trim_end().len();
        }
        start += line.len();
    }
    from..from
}

/// Whether a field is a name or a unit: it does not begin as a number does.
pub(super) fn is_name(field: &str) -> bool {
    let digits = field.trim_start_matches(['+', '-', '.', ',']);
    !is_number(field) && !digits.starts_with(|first: char| first.is_ascii_digit())
}
