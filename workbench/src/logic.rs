//! The state of the workbench and the actions that change it, without any drawing: both are values.

pub mod background;
pub mod deviations;
pub mod engine;
pub mod field;
pub mod history;
pub mod kind;
pub mod material;
pub mod outputs;
pub mod playing;
pub mod scene;
pub mod studies;
pub mod study;
pub mod table;
