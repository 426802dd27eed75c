//! ParaView's collections of files (`.pvd`).

use super::raw::ImportFault;
use super::vtu::attributes;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// The times and the files that the text of a collection names, in its order.
pub fn read(text: &str) -> Result<Vec<(f64, String)>, ImportFault> {
    let mut reader = Reader::from_str(text);
    let mut files = Vec::new();
    loop {
        match reader.read_event() {
            Ok(Event::Empty(tag) | Event::Start(tag)) if tag.name().as_ref() == "DataSet" => {
                files.push(data_set(&tag)?);
            }
            Ok(Event::Eof) => return Ok(files),
            Ok(_) => {}
            Err(cause) => return Err(format!("is not XML: {cause}").into()),
        }
    }
}

fn data_set(tag: &BytesStart) -> Result<(f64, String), ImportFault> {
    let attributes = attributes(tag)?;
    let value = |name: &str| {
        let text = attributes.get(name).cloned();
        text.ok_or_else(|| format!("has a DataSet without `{name}`"))
    };
    let time = value("timestep")?;
    let number = time.parse().ok().filter(|time: &f64| time.is_finite());
    let number = number.ok_or_else(|| format!("has the time `{time}`, which is not a number"))?;
    Ok((number, value("file")?))
}
