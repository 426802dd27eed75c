//! Files that are dropped on the window.

use std::sync::{Arc, Mutex};

use eframe::egui;

/// Files that were dropped and read: name and content.
pub type Inbox = Arc<Mutex<Vec<(String, Vec<u8>)>>>;

/// Reads a dropped file into the inbox.
#[cfg(not(target_arch = "wasm32"))]
pub fn read(file: &egui::DroppedFileHandle, inbox: &Inbox, _: &egui::Context) {
    // The whole path: what a study names stands beside it.
    let name = file.path().display().to_string();
    if let (Ok(content), Ok(mut files)) = (file.bytes(), inbox.lock()) {
        files.push((name, content));
    }
}

/// Reads a dropped file into the inbox, as soon as the browser gives it.
#[cfg(target_arch = "wasm32")]
pub fn read(file: &egui::DroppedFileHandle, inbox: &Inbox, context: &egui::Context) {
    let (file, inbox, context) = (Arc::clone(file), Arc::clone(inbox), context.clone());
    wasm_bindgen_futures::spawn_local(async move {
        let name = file.path().display().to_string();
        if let (Ok(content), Ok(mut files)) = (file.bytes_async().await, inbox.lock()) {
            files.push((name, content));
        }
        context.request_repaint();
    });
}
