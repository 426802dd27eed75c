//! Files that go out: into the folder in which the program was started, or as downloads of the browser.

#[cfg(target_arch = "wasm32")]
use crate::logic::outputs::archive;
use crate::logic::studies::NamedFile;

/// Gives a file to the user; says where it is.
///
/// # Errors
/// Says why it could not be written.
#[cfg(not(target_arch = "wasm32"))]
pub fn save(name: &str, content: &[u8]) -> Result<String, String> {
    let path =
        std::path::absolute(name).map_err(|cause| format!("cannot write {name}: {cause}"))?;
    std::fs::write(&path, content).map_err(|cause| {
        format!(
            "cannot write {}: {cause}; start the workbench in a folder with write permission",
            path.display()
        )
    })?;
    Ok(format!("saved as {}", path.display()))
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
