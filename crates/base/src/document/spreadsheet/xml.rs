//! Elements, attributes and texts of XML.

use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::super::converted::Unconvertible;

/// What is met in a text, in its order.
pub enum Met<'a> {
    /// An element begins.
    Start(&'a BytesStart<'a>),
    /// An element ends, by its name without prefix.
    End(&'a str),
    /// A part of a text.
    Text(&'a str),
}

/// The text of a part of a workbook.
///
/// # Errors
/// [`Unconvertible`] where it is not UTF-8.
pub fn text(bytes: Vec<u8>) -> Result<String, Unconvertible> {
    String::from_utf8(bytes).map_err(|_| damaged("it is not UTF-8"))
}

/// Calls a function with all that a text contains.
///
/// # Errors
/// [`Unconvertible`] where it is not XML, and what the function returns.
pub fn walk(
    xml: &str,
    mut on: impl FnMut(Met) -> Result<(), Unconvertible>,
) -> Result<(), Unconvertible> {
    let mut reader = Reader::from_str(xml);
    loop {
        match reader.read_event() {
            Ok(Event::Start(tag)) => on(Met::Start(&tag))?,
            Ok(Event::Empty(tag)) => {
                on(Met::Start(&tag))?;
                on(Met::End(tag.local_name().as_ref()))?;
            }
            Ok(Event::End(tag)) => on(Met::End(tag.local_name().as_ref()))?,
            Ok(Event::Text(text)) => on(Met::Text(&text))?,
            Ok(Event::CData(text)) => on(Met::Text(&text))?,
            Ok(Event::GeneralRef(entity)) => {
                let letter = entity.resolve_char_ref().ok().flatten().map(String::from);
                let named = || resolve_predefined_entity(&entity).map(str::to_owned);
                on(Met::Text(&letter.or_else(named).unwrap_or_default()))?;
            }
            Ok(Event::Eof) => return Ok(()),
            Ok(_) => {}
            Err(cause) => return Err(damaged(&cause.to_string())),
        }
    }
}

/// An attribute of an element, by its name without prefix.
pub fn attribute(tag: &BytesStart, name: &str) -> Option<String> {
    let mut attributes = tag.attributes();
    let mut attributes = attributes.with_checks(false).filter_map(Result::ok);
    let attribute = attributes.find(|attribute| attribute.key.local_name().as_ref() == name)?;
    let value = attribute.normalized_value(XmlVersion::Explicit1_0).ok()?;
    Some(value.into_owned())
}

/// The fault of a workbook that is damaged.
pub fn damaged(reason: &str) -> Unconvertible {
    Unconvertible::new(
        format!("is a damaged workbook: {reason}"),
        "save it again, or save the sheet as .csv",
    )
}
