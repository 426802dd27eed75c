//! Files that are dropped on the window.

use std::sync::{Arc, Mutex};

use eframe::egui;

use crate::logic::studies::NamedFile;

/// Files that were dropped and read: name and content, or why they cannot be read.
pub type Inbox = Arc<Mutex<Vec<Result<NamedFile, String>>>>;

fn put<E: std::fmt::Display>(inbox: &Inbox, name: String, content: Result<Vec<u8>, E>) {
    let read = match content {
        Ok(content) => Ok((name, content)),
        Err(cause) => Err(format!("cannot read {name}: {cause}")),
    };
    if let Ok(mut files) = inbox.lock() {
        files.push(read);
    }
}

/// Reads a dropped file into the inbox.
#[cfg(not(target_arch = "wasm32"))]
pub fn read(file: &egui::DroppedFileHandle, inbox: &Inbox, _: &egui::Context) {
    // The complete path: files that a study names are looked for in its folder.
    let name = file.path().display().to_string();
    put(inbox, name, file.bytes());
}

/// Reads a dropped file into the inbox, as soon as the browser gives it.
#[cfg(target_arch = "wasm32")]
pub fn read(file: &egui::DroppedFileHandle, inbox: &Inbox, context: &egui::Context) {
    let (file, inbox, context) = (Arc::clone(file), Arc::clone(inbox), context.clone());
    wasm_bindgen_futures::spawn_local(async move {
        let name = file.path().display().to_string();
        put(&inbox, name, file.bytes_async().await);
        context.request_repaint();
    });
}
