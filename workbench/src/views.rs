//! Panels, sheets and charts. Nothing here computes; what a user does becomes an action.

pub mod app;
pub mod chart;
pub mod colours;
pub mod controls;
pub mod exports;
pub mod field;
pub mod figures;
pub mod files;
pub mod fonts;
pub mod grip;
pub mod guide;
pub mod material;
pub mod question;
pub mod report;
pub mod sheet;
pub mod study;
pub mod surface;
