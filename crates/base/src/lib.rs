//! What all of gelbench stands on: units, errors, budgets, documents and statistics.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod budget;
pub mod document;
pub mod error;
pub mod statistics;
pub mod units;
