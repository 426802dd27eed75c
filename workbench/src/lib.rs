//! The workbench: sheets that are pulled by hand, on the desktop and in the browser.
//!
//! | to … | use |
//! |---|---|
//! | know what lies on the table, act on it, undo it, save it as a study | [`logic`] |
//! | draw it | [`views`] |
//! | time its frames | [`measure`] |
//!
//! `logic` knows nothing of how it is drawn, and every action is a value; `views` computes nothing. Models are solved
//! in the background, by threads on the desktop and by web workers in the browser, so that no frame waits for them.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod logic;
pub mod measure;
#[cfg(target_arch = "wasm32")]
pub mod page;
pub mod views;
