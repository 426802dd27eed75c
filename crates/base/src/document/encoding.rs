//! Texts in the encodings that instruments and editors write.
//!
//! A byte-order mark decides; otherwise UTF-16 shows by its zeros, and the text is UTF-8 where all bytes fit. The remaining texts are distinguished
//! by their pairs of bytes: GB18030 consists of pairs that begin as frequent characters do, Latin-1 has single letters among ASCII.

use encoding_rs::{Encoding, GB18030, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// An encoding by one of the names that browsers know, such as `latin1`, `gb18030`, `shift_jis`, `utf-16le`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextEncoding(&'static Encoding);

impl TextEncoding {
    /// The encoding with a name.
    pub fn of_name(name: &str) -> Option<Self> {
        Encoding::for_label(name.trim().as_bytes()).map(Self)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        if self.0 == WINDOWS_1252 {
            "Latin-1 (Windows-1252)"
        } else {
            self.0.name()
        }
    }
}

/// The text of bytes and their encoding, which is the `wanted` one if there is one; `None` where they are not a text in it.
pub fn decode(bytes: &[u8], wanted: Option<TextEncoding>) -> Option<(String, TextEncoding)> {
    let marked = Encoding::for_bom(bytes).map(|(encoding, _)| encoding);
    let encoding = match wanted {
        Some(TextEncoding(encoding)) => encoding,
        None => marked.unwrap_or_else(|| guess(bytes)),
    };
    let (text, _, malformed) = encoding.decode(bytes);
    (!malformed && !text.contains('\0')).then(|| (text.into_owned(), TextEncoding(encoding)))
}

fn guess(bytes: &[u8]) -> &'static Encoding {
    match () {
        () if zeros_at(bytes, 1) => UTF_16LE,
        () if zeros_at(bytes, 0) => UTF_16BE,
        () if std::str::from_utf8(bytes).is_ok() => UTF_8,
        () if is_gb18030(bytes) => GB18030,
        () => WINDOWS_1252,
    }
}

/// Whether a file begins with the mark of UTF-16, or every other byte of its beginning is zero.
pub(super) fn is_utf16(bytes: &[u8]) -> bool {
    let marks = [b"\xff\xfe", b"\xfe\xff"];
    marks.iter().any(|mark| bytes.starts_with(*mark)) || zeros_at(bytes, 0) || zeros_at(bytes, 1)
}

/// Whether the bytes at one side of each pair are zero at the beginning of a file, and the others are not.
fn zeros_at(bytes: &[u8], side: usize) -> bool {
    let every_other = |from: usize| bytes.iter().skip(from).step_by(2).take(20);
    bytes.len() >= 4
        && every_other(side).all(|byte| *byte == 0)
        && every_other(1 - side).all(|byte| *byte != 0)
}

/// Whether bytes that are not UTF-8 are GB18030 rather than Latin-1: most of their pairs begin as signs (A1–A9) or as
/// the 3755 frequent characters do (B0–D7), and not as small letters with accents would.
fn is_gb18030(bytes: &[u8]) -> bool {
    let (mut frequent, mut other, mut at) = (0usize, 0usize, 0);
    while let Some(first) = bytes.get(at) {
        let rest = &bytes[at + 1..];
        at += match (first, rest) {
            (0..0x80, _) => 1,
            (_, [b'0'..=b'9', 0x81..=0xfe, b'0'..=b'9', ..]) => 4,
            (0xa1..=0xa9 | 0xb0..=0xd7, [0xa1..=0xfe, ..]) => {
                frequent += 1;
                2
            }
            _ => {
                other += 1;
                1 + usize::from(rest.first().is_some_and(|second| *second >= 0x80))
            }
        };
    }
    frequent > other && !GB18030.decode(bytes).2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The encoding that is found of a text in an encoding, and what is read.
    fn decoded(text: &str, encoding: &'static Encoding) -> (String, &'static str) {
        let bytes = encoding.encode(text).0;
        let (text, encoding) = decode(&bytes, None).unwrap();
        (text, encoding.name())
    }

    #[test]
    fn european_and_chinese_heads_are_told_apart() {
        for text in [
            "x [µm],y [µm],ux [µm],uy [µm]\n1,2\n",
            "Größe;Höhe\n1;2\n",
            "température [°C];déplacement\n",
            "Verschiebung ± Straße",
            "posição;força",
            "Maß",
        ] {
            let expected = (text.to_owned(), "Latin-1 (Windows-1252)");
            assert_eq!(decoded(text, WINDOWS_1252), expected);
        }
        for text in [
            "时间,位移\n1,2\n",
            "X坐标 [mm],Y坐标 [mm]\n",
            "力",
            "x（毫米）,y（毫米）",
            "位移 [µm]",
        ] {
            assert_eq!(decoded(text, GB18030), (text.to_owned(), "gb18030"));
        }
    }

    #[test]
    fn marks_and_zeros_tell_utf_16_and_bytes_that_are_no_text_are_refused() {
        let text = "x [µm],位移\n1,2\n";
        for mark in ["", "\u{feff}"] {
            let marked = format!("{mark}x [mm],uy [mm]\n1,2\n");
            let wide = || marked.encode_utf16();
            let little: Vec<u8> = wide().flat_map(u16::to_le_bytes).collect();
            let big: Vec<u8> = wide().flat_map(u16::to_be_bytes).collect();
            for (bytes, name) in [(little, "UTF-16LE"), (big, "UTF-16BE")] {
                let (read, encoding) = decode(&bytes, None).unwrap();
                assert_eq!(
                    (read.as_str(), encoding.name()),
                    ("x [mm],uy [mm]\n1,2\n", name)
                );
            }
        }
        assert_eq!(decoded(text, UTF_8), (text.to_owned(), "UTF-8"));
        assert!(decode(b"\x7fELF\0\0\0\xff\xfe\xf0", None).is_none());
    }

    #[test]
    fn a_wanted_encoding_is_taken() {
        let wanted = TextEncoding::of_name("Shift_JIS").unwrap();
        let bytes = encoding_rs::SHIFT_JIS.encode("変位 [mm]").0;
        assert_eq!(decode(&bytes, Some(wanted)).unwrap().0, "変位 [mm]");
        assert!(TextEncoding::of_name("morse").is_none());
    }
}
