//! The same numbers are read from every combination of separator, decimal mark, head, remarks, line ends and encoding.

use super::*;
use crate::document::encoding::decode;
use rand::{RngExt, SeedableRng};

const SEPARATORS: [&str; 6] = [",", ";", "\t", " ", "  ", "   "];
const LINE_ENDS: [&str; 3] = ["\n", "\r\n", "\r"];

/// The lines above the rows; `|` stands for the separator.
const HEADS: [&str; 12] = [
    "",
    "x|y|ux|uy\n",
    "x [mm]|y [mm]|ux [µm]|uy [µm]\n",
    "x|y|ux|uy\nmm|mm|µm|µm\n",
    "x|y|ux|uy\n[mm]|[mm]|[µm]|[µm]\n",
    "# test: uniaxial\nx|y|ux|uy\n",
    "# written by hand: yes\n# Größe\n",
    "% made by MATLAB\n% direction: 2\n",
    "# x|y|ux|uy\n",
    "% x|y|ux|uy\n",
    "# made by numpy\n# x [mm]|y [mm]|ux [µm]|uy [µm]\n",
    "%x|y|ux|uy\n\n",
];

#[derive(Clone, Copy)]
enum Numbers {
    Shortest,
    Scientific,
    Aligned,
}

fn written(value: f64, numbers: Numbers, comma: bool) -> String {
    let text = match numbers {
        Numbers::Shortest => format!("{value}"),
        Numbers::Scientific => {
            // As in C: a sign and two digits in the exponent.
            let text = format!("{value:.16e}");
            let (digits, exponent) = text.split_once('e').unwrap();
            let exponent: i32 = exponent.parse().unwrap();
            let sign = if exponent < 0 { '-' } else { '+' };
            format!("{digits}e{sign}{:02}", exponent.abs())
        }
        Numbers::Aligned => format!("{value:>20}"),
    };
    if comma { text.replace('.', ",") } else { text }
}

fn bytes(text: &str, encoding: usize) -> Vec<u8> {
    let wide = |mark: &str| format!("{mark}{text}").encode_utf16().collect::<Vec<_>>();
    match encoding {
        0 => text.as_bytes().to_vec(),
        1 => format!("\u{feff}{text}").into_bytes(),
        2 => text.chars().map(|letter| letter as u8).collect(),
        3 => wide("\u{feff}")
            .into_iter()
            .flat_map(u16::to_le_bytes)
            .collect(),
        _ => wide("\u{feff}")
            .into_iter()
            .flat_map(u16::to_be_bytes)
            .collect(),
    }
}

fn text_of(
    rows: &[Vec<f64>],
    separator: &str,
    head: &str,
    trailing: bool,
    numbers: Numbers,
    comma: bool,
) -> String {
    let mut text = head.replace('|', separator);
    for row in rows {
        let fields: Vec<String> = row
            .iter()
            .map(|value| written(*value, numbers, comma))
            .collect();
        text += &fields.join(separator);
        text += if trailing { separator } else { "" };
        text += "\n";
    }
    text
}

#[test]
fn the_same_numbers_are_read_from_every_dialect() {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    let mut failures = Vec::new();
    let mut count = 0;
    for separator in SEPARATORS {
        for head in HEADS {
            for numbers in [Numbers::Shortest, Numbers::Scientific, Numbers::Aligned] {
                for [comma, trailing] in
                    [[false, false], [true, false], [false, true], [true, true]]
                {
                    if comma && separator == "," {
                        continue;
                    }
                    let mut number = || random.random_range(-50.0..50.0_f64);
                    let rows: Vec<Vec<f64>> =
                        (0..5).map(|_| (0..4).map(|_| number()).collect()).collect();
                    let text = text_of(&rows, separator, head, trailing, numbers, comma);
                    for (line_end, encoding) in LINE_ENDS
                        .iter()
                        .flat_map(|end| (0..5).map(move |encoding| (end, encoding)))
                    {
                        count += 1;
                        let bytes = bytes(&text.replace('\n', line_end), encoding);
                        if let Err(reason) = check(&bytes, &rows, head) {
                            failures.push(format!(
                                "{reason}: {:?} {encoding}",
                                text.replace('\n', line_end)
                                    .chars()
                                    .take(120)
                                    .collect::<String>()
                            ));
                        }
                    }
                }
            }
        }
    }
    let message: Vec<&String> = failures.iter().step_by(1 + failures.len() / 40).collect();
    assert!(
        failures.is_empty(),
        "{} of {count}: {message:#?}",
        failures.len()
    );
}

/// What is wrong with a table that is read from these bytes.
fn check(bytes: &[u8], rows: &[Vec<f64>], head: &str) -> Result<(), String> {
    let (text, _) = decode(bytes, None).ok_or("no text")?;
    let table = Table::parse("a.txt", &text).map_err(|fault| fault.to_string())?;
    let read: Vec<Vec<f64>> = table.rows.iter().map(|(row, _)| row.clone()).collect();
    if read != rows {
        return Err(format!("{read:?}"));
    }
    let names: Vec<&str> = table.columns.iter().map(|column| &*column.name).collect();
    let expected = if head.contains('|') {
        ["x", "y", "ux", "uy"]
    } else {
        [""; 4]
    };
    if names != expected {
        return Err(format!("{names:?}"));
    }
    let units: Vec<_> = table
        .columns
        .iter()
        .map(|column| column.unit.as_deref())
        .collect();
    let unit = |unit| head.contains("µm").then_some(unit);
    if units != [unit("mm"), unit("mm"), unit("µm"), unit("µm")] {
        return Err(format!("{units:?}"));
    }
    Ok(())
}
