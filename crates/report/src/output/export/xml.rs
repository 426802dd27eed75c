//! XML, element by element.

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

/// A document, element by element.
pub struct Xml(Writer<Vec<u8>>);

impl Xml {
    pub fn new() -> Self {
        let mut file = Self(Writer::new_with_indent(Vec::new(), b' ', 2));
        file.event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)));
        file
    }

    pub fn event(&mut self, event: Event<'_>) {
        self.0
            .write_event(event)
            .expect("writing to memory does not fail");
    }

    pub fn within(
        &mut self,
        name: &str,
        attributes: &[(&str, &str)],
        content: impl FnOnce(&mut Self),
    ) {
        let start = BytesStart::new(name).with_attributes(attributes.iter().copied());
        self.event(Event::Start(start));
        content(self);
        self.event(Event::End(BytesEnd::new(name)));
    }

    pub fn empty(&mut self, name: &str, attributes: &[(&str, &str)]) {
        let start = BytesStart::new(name).with_attributes(attributes.iter().copied());
        self.event(Event::Empty(start));
    }

    pub fn text(&mut self, name: &str, attributes: &[(&str, &str)], text: &str) {
        self.within(name, attributes, |file| {
            file.event(Event::Text(BytesText::new(text)));
        });
    }

    /// A remark; two hyphens in a row would end it.
    pub fn comment(&mut self, text: &str) {
        let text = format!(" {} ", text.replace("--", "- -"));
        self.event(Event::Comment(BytesText::from_escaped(text)));
    }

    pub fn finish(self) -> String {
        let mut text = String::from_utf8(self.0.into_inner()).expect("texts are UTF-8");
        text.push('\n');
        text
    }
}
