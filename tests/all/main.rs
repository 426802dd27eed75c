//! The tests of gelbench as a whole: its command, its files, its examples and documents, and its architecture.

#[path = "../common/mod.rs"]
mod common;

mod architecture;
mod bounds;
mod command;
mod corpus;
mod documents;
mod doubtful_fields;
mod examples;
mod faults;
mod finite_element_reference;
mod golden;
mod gross_errors;
mod headlines;
mod identify;
mod joint_parameters;
mod keys;
mod load_paths;
mod marker_dialects;
mod materials;
mod measured_fields;
mod mesh_faults;
mod messages;
mod mistaken_fields;
mod motions;
mod multigrid;
mod nested_correction;
mod one_study;
mod other_codes;
mod own_errors;
mod own_laws;
mod regions;
mod relaxation;
mod report_schema;
mod resume;
mod sheets;
mod softening;
mod specimens;
mod study_never_panics;
mod sweep;
mod validation;
mod volume;
