//! Files that go out: into the folder in which the program was started, or as downloads of the browser.

#[cfg(not(target_arch = "wasm32"))]
use std::collections::BTreeMap;
#[cfg(not(target_arch = "wasm32"))]
use std::path::PathBuf;
#[cfg(not(target_arch = "wasm32"))]
use std::sync::{Mutex, PoisonError};

#[cfg(not(target_arch = "wasm32"))]
use gelbench_report::output::free_name;

#[cfg(target_arch = "wasm32")]
use crate::logic::outputs::archive;
use crate::logic::studies::NamedFile;

/// What the workbench has written itself since it was started, which it may replace.
#[cfg(not(target_arch = "wasm32"))]
static WRITTEN: Mutex<BTreeMap<PathBuf, Vec<u8>>> = Mutex::new(BTreeMap::new());

/// Gives a file to the user; says where it is. A file of that name with other words than the workbench has written is kept under
/// another one.
///
/// # Errors
/// Says why it could not be written.
#[cfg(not(target_arch = "wasm32"))]
pub fn save(name: &str, content: &[u8]) -> Result<String, String> {
    let path =
        std::path::absolute(name).map_err(|cause| format!("cannot write {name}: {cause}"))?;
    let unwritable = |cause: std::io::Error| {
        format!(
            "cannot write {}: {cause}; start the workbench in a folder with write permission",
            path.display()
        )
    };
    let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    let there = std::fs::read(&path).ok();
    let is_replaceable = |there: &Vec<u8>| there == content || written.get(&path) == Some(there);
    let mut kept = String::new();
    if there.is_some_and(|there| !is_replaceable(&there)) {
        let other = free_name(&path);
        std::fs::rename(&path, &other).map_err(unwritable)?;
        kept = format!("; the file that was there is kept as {}", other.display());
    }
    std::fs::write(&path, content).map_err(unwritable)?;
    let told = format!("saved as {}{kept}", path.display());
    written.insert(path, content.to_vec());
    Ok(told)
}

/// Gives files to the user: one by itself, several in a folder of a name; says where they are.
///
/// # Errors
/// Says why they could not be written.
#[cfg(not(target_arch = "wasm32"))]
pub fn give(name: &str, files: &[NamedFile]) -> Result<String, String> {
    if let [(name, content)] = files {
        return save(name, content);
    }
    let folder =
        std::path::absolute(name).map_err(|cause| format!("cannot write {name}: {cause}"))?;
    for (name, content) in files {
        let path = folder.join(name);
        let parent = path.parent().unwrap_or(&folder);
        let written = std::fs::create_dir_all(parent).and_then(|()| std::fs::write(&path, content));
        written.map_err(|cause| {
            format!(
                "cannot write {}: {cause}; start the workbench in a folder with write permission",
                path.display()
            )
        })?;
    }
    Ok(format!("{} files in {}", files.len(), folder.display()))
}

/// Gives files to the user as a download: one by itself, several as an archive of a name; says so.
///
/// # Errors
/// Says why they could not be given.
#[cfg(target_arch = "wasm32")]
pub fn give(name: &str, files: &[NamedFile]) -> Result<String, String> {
    match files {
        [(name, content)] => save(name, content),
        _ => save(&format!("{name}.zip"), &archive(files)?),
    }
}

/// Gives a file to the user as a download; says so.
///
/// # Errors
/// Says why it could not be given.
#[cfg(target_arch = "wasm32")]
pub fn save(name: &str, content: &[u8]) -> Result<String, String> {
    use wasm_bindgen::JsCast;
    let given = || -> Result<(), wasm_bindgen::JsValue> {
        let parts = js_sys::Array::of1(&js_sys::Uint8Array::from(content));
        let blob = web_sys::Blob::new_with_u8_array_sequence(&parts)?;
        let url = web_sys::Url::create_object_url_with_blob(&blob)?;
        let document = web_sys::window().and_then(|window| window.document());
        let document = document.ok_or("a page without a document")?;
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
