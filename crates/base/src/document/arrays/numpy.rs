//! Arrays in the format of NumPy (`.npy`): a head in the syntax of Python, and numbers.
//!
//! # References
//! NumPy Enhancement Proposal 1; `numpy.lib.format`, versions 1 to 3.

use super::super::binary::number;
use super::super::converted::{Unconvertible, afford};
use super::array::Array;

/// The type of a number and its name in a structure.
struct Field {
    name: String,
    big_endian: bool,
    /// `f`, `i`, `u` or `b`.
    kind: char,
    size: usize,
}

/// Reads an array.
///
/// # Errors
/// [`Unconvertible`] where it is damaged, too large, or not of numbers.
pub fn array(name: String, bytes: &[u8]) -> Result<Array, Unconvertible> {
    let cut_off = || damaged("it is cut off");
    let (version, wide) = (bytes.get(6), bytes.get(8..12).ok_or_else(cut_off)?);
    let (start, length) = match version {
        Some(1) => (10, usize::from(u16::from_le_bytes([wide[0], wide[1]]))),
        Some(2 | 3) => (
            12,
            u32::from_le_bytes([wide[0], wide[1], wide[2], wide[3]]) as usize,
        ),
        _ => return Err(damaged("its version is not known")),
    };
    let head = bytes.get(start..start + length).ok_or_else(cut_off)?;
    let tokens = tokens(std::str::from_utf8(head).map_err(|_| damaged("its head is no text"))?);
    let fields = fields(value(&tokens, "descr").ok_or_else(|| damaged("it names no type"))?)?;
    let shape = value(&tokens, "shape").ok_or_else(|| damaged("it names no shape"))?;
    let sizes = shape
        .iter()
        .take_while(|token| *token != ")")
        .filter_map(|token| token.parse().ok());
    let shape: Vec<usize> = sizes.collect();
    let is_transposed = value(&tokens, "fortran_order").is_some_and(|value| value[0] == "True");
    let size: usize = fields.iter().map(|field| field.size).sum();
    let data = &bytes[start + length..];
    let count = shape
        .iter()
        .try_fold(1_usize, |all, size| all.checked_mul(*size))
        .filter(|count| {
            count
                .checked_mul(size)
                .is_some_and(|needed| needed <= data.len())
        })
        .ok_or_else(cut_off)?;
    afford(0.0, (count * fields.len()) as f64)?;
    let entries = data.chunks_exact(size).take(count);
    let numbers: Vec<f64> = entries.flat_map(|entry| numbers(&fields, entry)).collect();
    let plain = fields.len() == 1 && fields[0].name.is_empty();
    Ok(Array {
        name,
        numbers: if is_transposed && plain {
            by_rows(&numbers, &shape)
        } else {
            numbers
        },
        fields: if plain {
            Vec::new()
        } else {
            fields.into_iter().map(|field| field.name).collect()
        },
        shape,
    })
}

fn damaged(reason: &str) -> Unconvertible {
    Unconvertible::new(
        format!("is a damaged file of NumPy: {reason}"),
        "save it again by numpy.save",
    )
}

/// The numbers of an array whose first index counts fastest, with the last index fastest.
pub fn by_rows(numbers: &[f64], shape: &[usize]) -> Vec<f64> {
    let &[rows, columns] = shape else {
        return numbers.to_vec();
    };
    let of_row = |row: usize| (0..columns).map(move |column| numbers[column * rows + row]);
    (0..rows).flat_map(of_row).collect()
}

/// Words, texts without their quotation marks, and signs.
fn tokens(head: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = head;
    while let Some(first) = rest.trim_start().chars().next() {
        rest = rest.trim_start();
        let length = match first {
            '\'' | '"' => {
                let end = rest[1..].find(first).map_or(rest.len(), |end| end + 1);
                tokens.push(rest[1..end].to_owned());
                (end + 1).min(rest.len())
            }
            letter if letter.is_alphanumeric() => {
                let end = rest
                    .find(|letter: char| !letter.is_alphanumeric())
                    .unwrap_or(rest.len());
                tokens.push(rest[..end].to_owned());
                end
            }
            sign => {
                tokens.push(sign.to_string());
                sign.len_utf8()
            }
        };
        rest = &rest[length..];
    }
    tokens
}

/// What follows a key and its colon; never empty.
fn value<'a>(tokens: &'a [String], key: &str) -> Option<&'a [String]> {
    let at = tokens
        .windows(2)
        .position(|pair| pair[0] == key && pair[1] == ":")?;
    tokens.get(at + 2..).filter(|rest| !rest.is_empty())
}

/// The types of an entry: `<f8`, or `[('x', '<f8'), ('y', '<f8')]`.
fn fields(descr: &[String]) -> Result<Vec<Field>, Unconvertible> {
    if descr[0] != "[" {
        return Ok(vec![field(String::new(), &descr[0])?]);
    }
    let mut all = Vec::new();
    let mut rest = &descr[1..];
    while rest.first().is_some_and(|token| token == "(") {
        match rest {
            [_, name, comma, of, end, after @ ..] if comma == "," && end == ")" => {
                all.push(field(name.clone(), of)?);
                rest = after.strip_prefix(&[",".to_owned()]).unwrap_or(after);
            }
            _ => {
                let hint = "save fields that are plain numbers: a[['x', 'y']]";
                return Err(Unconvertible::new(
                    "has a structure with arrays or structures in it",
                    hint,
                ));
            }
        }
    }
    if all.is_empty() {
        Err(damaged("its structure has no fields"))
    } else {
        Ok(all)
    }
}

fn field(name: String, of: &str) -> Result<Field, Unconvertible> {
    let (order, rest) = of.split_at(
        of.find(|letter: char| letter.is_ascii_alphabetic())
            .unwrap_or(0),
    );
    let kind = rest.chars().next().unwrap_or(' ');
    let size = rest
        .get(1..)
        .and_then(|size| size.parse().ok())
        .unwrap_or(0);
    match (kind, size) {
        ('f', 4 | 8) | ('i' | 'u', 1 | 2 | 4 | 8) | ('b', 1) => Ok(Field {
            name,
            big_endian: order == ">",
            kind,
            size,
        }),
        _ => {
            let of_field = if name.is_empty() {
                String::new()
            } else {
                format!(" in `{name}`")
            };
            let message = format!("has numbers of the type `{of}`{of_field}, which is not read");
            Err(Unconvertible::new(
                message,
                "save real numbers: numpy.save('a.npy', a.astype(float))",
            ))
        }
    }
}

fn numbers<'a>(fields: &'a [Field], entry: &'a [u8]) -> impl Iterator<Item = f64> + 'a {
    let mut rest = entry;
    fields.iter().map(move |field| {
        let (bytes, after) = rest.split_at(field.size);
        rest = after;
        number(field.kind, bytes, field.big_endian)
    })
}
