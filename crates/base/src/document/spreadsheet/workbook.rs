//! The parts of a workbook that its sheets share.

use std::collections::{BTreeMap, BTreeSet};

use super::super::archive::Archive;
use super::super::converted::Unconvertible;
use super::xml::{Met, attribute, damaged, text, walk};

/// A sheet and its part of the archive.
#[derive(Debug)]
pub struct NamedSheet {
    pub name: String,
    pub path: String,
}

/// Sheets, texts and formats.
#[derive(Debug, Default)]
pub struct Workbook {
    pub sheets: Vec<NamedSheet>,
    /// Texts that cells refer to by number.
    pub texts: Vec<String>,
    /// Formats of cells whose numbers are dates or times of day.
    pub dates: BTreeSet<usize>,
}

impl Workbook {
    /// Reads all but the cells.
    ///
    /// # Errors
    /// [`Unconvertible`] where a part is damaged or too large.
    pub fn read(archive: &mut Archive) -> Result<Self, Unconvertible> {
        let names = archive.names();
        let main = names.iter().find(|name| name.ends_with("workbook.xml"));
        let main = main.ok_or_else(|| damaged("there is no list of its sheets"))?;
        let (folder, file) = main.rsplit_once('/').unwrap_or(("", main));
        let targets = targets(&text(
            archive.read(&in_folder(folder, &format!("_rels/{file}.rels")))?,
        )?)?;
        let mut book = Self {
            sheets: sheets(&text(archive.read(main)?)?, &targets, folder)?,
            ..Self::default()
        };
        let mut part = |name: &str| {
            let name = in_folder(folder, name);
            let there = names.contains(&name);
            there.then(|| text(archive.read(&name)?)).transpose()
        };
        if let Some(xml) = part("sharedStrings.xml")? {
            book.texts = texts(&xml)?;
        }
        if let Some(xml) = part("styles.xml")? {
            book.dates = dates(&xml)?;
        }
        Ok(book)
    }
}

/// The path of a part that another one names: absolute, or in the folder of that one.
fn in_folder(folder: &str, target: &str) -> String {
    match target.strip_prefix('/') {
        Some(absolute) => absolute.to_owned(),
        None if folder.is_empty() => target.to_owned(),
        None => format!("{folder}/{target}"),
    }
}

/// The parts that a part refers to, by the names of the references.
fn targets(xml: &str) -> Result<BTreeMap<String, String>, Unconvertible> {
    let mut all = BTreeMap::new();
    walk(xml, |met| {
        if let Met::Start(tag) = met
            && let (Some(id), Some(target)) = (attribute(tag, "Id"), attribute(tag, "Target"))
        {
            all.insert(id, target);
        }
        Ok(())
    })?;
    Ok(all)
}

fn sheets(
    xml: &str,
    targets: &BTreeMap<String, String>,
    folder: &str,
) -> Result<Vec<NamedSheet>, Unconvertible> {
    let mut all = Vec::new();
    walk(xml, |met| {
        // The attribute `id` of the references is the one with a prefix: `r:id`; `sheetId` is another.
        if let Met::Start(tag) = met
            && tag.local_name().as_ref() == "sheet"
            && let (Some(name), Some(id)) = (attribute(tag, "name"), attribute(tag, "id"))
            && let Some(target) = targets.get(&id)
        {
            let path = in_folder(folder, target);
            all.push(NamedSheet { name, path });
        }
        Ok(())
    })?;
    Ok(all)
}

/// The shared texts; runs of one text are joined, readings of Japanese ones (`rPh`) left out.
fn texts(xml: &str) -> Result<Vec<String>, Unconvertible> {
    let mut all: Vec<String> = Vec::new();
    let (mut is_text, mut is_reading) = (false, false);
    walk(xml, |met| {
        match met {
            Met::Start(tag) => match tag.local_name().as_ref() {
                "si" => all.push(String::new()),
                "t" => is_text = !is_reading,
                "rPh" => is_reading = true,
                _ => {}
            },
            Met::End("t") => is_text = false,
            Met::End("rPh") => is_reading = false,
            Met::Text(text) if is_text => all
                .last_mut()
                .into_iter()
                .for_each(|last| last.push_str(text)),
            _ => {}
        }
        Ok(())
    })?;
    Ok(all)
}

/// The formats of cells (`cellXfs`) that show dates or times of day.
fn dates(xml: &str) -> Result<BTreeSet<usize>, Unconvertible> {
    // 14–22 and 45–47 everywhere, the others in East Asian versions.
    let mut of_dates: BTreeSet<String> = (14..=22)
        .chain(27..=36)
        .chain(45..=47)
        .chain(50..=58)
        .map(|id| id.to_string())
        .collect();
    let (mut result, mut count, mut within) = (BTreeSet::new(), 0, false);
    walk(xml, |met| {
        match met {
            Met::Start(tag) => match tag.local_name().as_ref() {
                "numFmt" => {
                    let code = attribute(tag, "formatCode").unwrap_or_default();
                    of_dates.extend(attribute(tag, "numFmtId").filter(|_| is_date(&code)));
                }
                "cellXfs" => within = true,
                "xf" if within => {
                    let format = attribute(tag, "numFmtId").unwrap_or_default();
                    result.extend(of_dates.contains(&format).then_some(count));
                    count += 1;
                }
                _ => {}
            },
            Met::End("cellXfs") => within = false,
            _ => {}
        }
        Ok(())
    })?;
    Ok(result)
}

/// Whether a format has letters of dates or times outside of quotes, colours and escapes.
fn is_date(code: &str) -> bool {
    let (mut quoted, mut bracketed, mut escaped) = (false, false, false);
    let code = code.split(';').next().unwrap_or_default().to_lowercase();
    // Elapsed hours, minutes and seconds stand in brackets, as colours do.
    let elapsed = ["[h", "[m", "[s"]
        .iter()
        .any(|time| code.contains(time) && !code.contains("[magenta"));
    elapsed
        || code.chars().any(|letter| {
            let plain = !quoted && !bracketed && !escaped;
            escaped = plain && (letter == '\\' || letter == '_');
            quoted ^= letter == '"';
            bracketed = (bracketed || letter == '[') && letter != ']';
            plain && "ymdhs".contains(letter)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_of_dates_and_times_are_told_from_numbers() {
        for code in [
            "yyyy-mm-dd",
            "[h]:mm:ss",
            "mm:ss.0",
            "d. mmm",
            "[$-407]d/m/yy",
        ] {
            assert!(is_date(code), "{code}");
        }
        for code in [
            "0.00",
            "General",
            "#,##0.00\\ \"mm\"",
            "[Red]0.0",
            "0.0E+00;[Blue]0",
            "_-* #,##0_d",
        ] {
            assert!(!is_date(code), "{code}");
        }
    }

    #[test]
    fn formats_are_those_of_cells() {
        let xml = r#"<styleSheet><numFmts><numFmt numFmtId="164" formatCode="h:mm"/></numFmts>
            <cellStyleXfs><xf numFmtId="14"/></cellStyleXfs><cellXfs><xf numFmtId="0"/><xf numFmtId="164"/><xf numFmtId="22"/></cellXfs></styleSheet>"#;
        assert_eq!(dates(xml).unwrap(), [1, 2].into());
    }

    #[test]
    fn texts_are_joined_without_their_readings() {
        let xml = "<sst><si><t>force</t></si><si><r><t>&#963; </t></r><r><t>[kPa]</t></r><rPh><t>x</t></rPh></si></sst>";
        assert_eq!(texts(xml).unwrap(), ["force", "\u{3c3} [kPa]"]);
    }
}
