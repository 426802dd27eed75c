//! Export of files from a browser: downloads.

use std::path::Path;

use eframe::egui::Context;
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

use super::{Event, Outgoing};
use crate::logic::background::Wake;
use crate::logic::outputs::archive;

/// Files as downloads.
#[derive(Default)]
pub struct Files {
    events: Vec<Event>,
}

impl Files {
    /// Nothing yet.
    pub fn new(_: Wake) -> Self {
        Self::default()
    }

    /// Downloads files: a single one as it is, several as an archive.
    pub fn give(&mut self, outgoing: Outgoing) {
        let written = &outgoing.written;
        let given = match &written.files[..] {
            [(name, content)] => download(name, content),
            files => archive(files)
                .and_then(|content| download(&format!("{}.zip", written.name), &content)),
        };
        self.events.push(match given {
            Ok(message) => Event::Saved {
                outgoing,
                path: None,
                message,
            },
            Err(fault) => Event::Failed(fault),
        });
    }

    /// Gives files to the user: a browser has no paths.
    pub fn save(&mut self, _: &Path, outgoing: Outgoing) {
        self.give(outgoing);
    }

    /// What came of files since it was asked last.
    pub fn events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// The browser asks where a download goes.
    pub fn ask(&mut self, _: &Context) -> bool {
        false
    }
}

fn download(name: &str, content: &[u8]) -> Result<String, String> {
    let given = || -> Result<(), JsValue> {
        let parts = js_sys::Array::of1(&js_sys::Uint8Array::from(content));
        let blob = web_sys::Blob::new_with_u8_array_sequence(&parts)?;
        let url = web_sys::Url::create_object_url_with_blob(&blob)?;
        let document = web_sys::window()
            .and_then(|window| window.document())
            .ok_or("a page without a document")?;
        let link: web_sys::HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
        link.set_href(&url);
        link.set_download(name);
        link.click();
        web_sys::Url::revoke_object_url(&url)
    };
    match given() {
        Ok(()) => Ok(format!("{name} is among your downloads")),
        Err(cause) => Err(format!("the browser did not save {name}: {cause:?}")),
    }
}
