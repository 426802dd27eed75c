//! The lines of a table: line ends, separators, remarks, names.

use std::ops::Range;

use super::decimals::is_number;

/// The number of lines by which separators, names, units and rows are distinguished.
pub(super) const SURVEYED: usize = 1000;

/// A text without byte-order mark and old line ends; lines that begin with stars, per cent signs or tags, as some programs write
/// them first, become remarks.
pub(super) fn plain_text(text: &str) -> String {
    let text = text.trim_start_matches('\u{feff}');
    let text = if text.contains('\n') {
        text.to_owned()
    } else {
        text.replace('\r', "\n")
    };
    if text.starts_with("***") {
        let remark = |line: &str| remark_of(line, '*').unwrap_or_else(|| line.to_owned());
        text.split_inclusive('\n').map(remark).collect()
    } else if text.starts_with('<') {
        // The sections of Mach-1: <INFO> … <DATA> … <END DATA>.
        let remark = |line: &str| remark_of(line, '<').unwrap_or_else(|| line.to_owned());
        text.split_inclusive('\n').map(remark).collect()
    } else if text.trim_start().starts_with('%') {
        matlab_remarks(&text)
    } else {
        text
    }
}

/// MATLAB's remarks above the rows; below them a per cent sign is a unit.
fn matlab_remarks(text: &str) -> String {
    let mut above = true;
    let line = |line: &str| {
        above &= line.trim().is_empty() || line.starts_with(['%', '#']);
        let remark = above.then(|| remark_of(line, '%')).flatten();
        remark.unwrap_or_else(|| line.to_owned())
    };
    text.split_inclusive('\n').map(line).collect()
}

/// A line that begins with a sign as a remark.
fn remark_of(line: &str, sign: char) -> Option<String> {
    line.strip_prefix(sign).map(|rest| format!("#{rest}"))
}

/// The separator of the columns: that of the first line that is not a comment, if it gives as many fields in most
/// lines; otherwise the first one that most lines have.
pub(super) fn delimiter(text: &str) -> Option<u8> {
    const ALL: [u8; 3] = [b';', b'\t', b','];
    let lines: Vec<&str> = text
        .split(['\n', '\r'])
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'))
        .take(SURVEYED)
        .collect();
    let count = |line: &str, delimiter: u8| {
        let bytes = line.as_bytes().iter();
        bytes.filter(|byte| **byte == delimiter).count()
    };
    let most = |holds: &dyn Fn(&str) -> bool| {
        2 * lines.iter().filter(|line| holds(line)).count() > lines.len()
    };
    let of_first = |delimiter: &u8| count(lines.first().unwrap_or(&""), *delimiter);
    let first = ALL.into_iter().find(|delimiter| of_first(delimiter) > 0);
    first
        .filter(|first| most(&|line| count(line, *first) == of_first(first)))
        .or_else(|| {
            let mut all = ALL.into_iter();
            all.find(|delimiter| most(&|line| count(line, *delimiter) > 0))
        })
        .or(first)
}

/// The text of a table whose columns are separated by blanks with a tab at the beginning of each gap, so that every place
/// stays; any other text as it is.
pub(super) fn blanks_to_tabs(text: String) -> String {
    let is_record = |line: &&str| !line.trim().is_empty() && !line.starts_with('#');
    let records: Vec<&str> = text.lines().filter(is_record).take(SURVEYED).collect();
    let mut widths: Vec<usize> = records.iter().filter_map(|line| numbers(line)).collect();
    widths.sort_unstable();
    if 2 * widths.len() <= records.len() {
        return text;
    }
    let width = widths[widths.len() / 2];
    let mut bytes = text.clone().into_bytes();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let fitting = fitting_gaps(line, width);
        for gap in fitting.filter(|_| is_record(&line)).unwrap_or_default() {
            bytes[start + gap] = b'\t';
        }
        start += line.len();
    }
    String::from_utf8(bytes).unwrap_or(text)
}

/// How many numbers with blanks between them a line has; `None` for any other line.
fn numbers(line: &str) -> Option<usize> {
    let is_plain = |field: &str| is_number(field) && !field.ends_with(',');
    let fields = || line.trim_end().split(' ').filter(|field| !field.is_empty());
    (fields().count() > 1 && fields().all(is_plain)).then(|| fields().count())
}

/// The gaps that make so many fields of a line.
fn fitting_gaps(line: &str, width: usize) -> Option<Vec<usize>> {
    let all = [gaps(line, 1), gaps(line, 2), gaps_of_units(line)];
    all.into_iter().find(|gaps| gaps.len() + 1 == width)
}

/// The gaps of a line of units in brackets; none in any other line.
fn gaps_of_units(line: &str) -> Vec<usize> {
    if !line
        .split_whitespace()
        .all(|field| field.starts_with(['[', '(']))
    {
        return Vec::new();
    }
    let before_next = [" [", " ("].map(|start| line.match_indices(start));
    let mut gaps: Vec<usize> = before_next
        .into_iter()
        .flatten()
        .map(|(at, _)| at)
        .collect();
    gaps.sort_unstable();
    gaps.retain(|gap| !line[..*gap].trim().is_empty());
    gaps
}

/// The names of so many columns in a remark without its sign, however they are separated.
pub(super) fn names_in_remark(remark: &str, width: usize) -> Option<Vec<&str>> {
    let by_signs = [';', '\t', ','].map(|sign| remark.split(sign).collect());
    let by_blanks = fitting_gaps(remark, width).map(|gaps| {
        let ends = gaps.iter().copied().chain([remark.len()]);
        let starts = std::iter::once(0).chain(gaps.iter().copied());
        starts
            .zip(ends)
            .map(|(start, end)| &remark[start..end])
            .collect()
    });
    let mut all = by_signs.into_iter().chain(by_blanks);
    all.find(|names: &Vec<&str>| {
        // A colon stands in statements, `key: value`, and in names that have a unit.
        let is_one = |name: &&str| {
            is_name(name.trim()) && (!name.contains(':') || name.trim_end().ends_with(']'))
        };
        names.len() == width && names.iter().all(is_one)
    })
}

/// Words that name quantities; other words above rows may be a sentence.
const QUANTITIES: &str = "x y z u v w ux uy uz u_x u_y id node point marker frame time t stress strain stretch force load \
    displacement extension position length lambda spannung dehnung kraft weg zeit";

/// Whether words are names of columns, and not a sentence: one has a unit, or two are quantities.
pub(super) fn are_quantities(names: &[&str]) -> bool {
    let is_known = |name: &&&str| {
        let name = name.trim().to_lowercase();
        QUANTITIES.split_whitespace().any(|known| known == name)
    };
    let has_unit = |name: &&str| name.trim_end().ends_with([']', ')']);
    names.iter().any(has_unit) || names.iter().filter(is_known).count() >= 2
}

/// Where the blanks between fields begin, at least so many: not within brackets or quotes, nor before a unit in brackets.
fn gaps(line: &str, least: usize) -> Vec<usize> {
    let (mut gaps, mut within) = (Vec::new(), false);
    let mut blanks: Option<usize> = None;
    for (at, letter) in line.trim_end().char_indices() {
        if letter == ' ' && !within {
            blanks.get_or_insert(at);
            continue;
        }
        let is_gap = |from: &usize| *from > 0 && at - from >= least && !"[(".contains(letter);
        gaps.extend(blanks.take().filter(is_gap));
        within = match letter {
            '"' => !within,
            '[' | '(' => true,
            ']' | ')' => false,
            _ => within,
        };
    }
    gaps
}

/// The place of the remark right above a place, apart from empty lines.
pub(super) fn remark_above(text: &str, below: usize) -> Option<Range<usize>> {
    let above = text[..below].trim_end();
    let start = above.rfind('\n').map_or(0, |end| end + 1);
    above[start..]
        .starts_with('#')
        .then_some(start..above.len())
}

/// The line of a record: csv points to the text before it, including remarks and empty lines.
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
