//! The façade: the names by which a program uses gelbench. A version keeps them, so there are few, and each is listed by hand.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::architecture::sources::{Sources, expand, production};
use crate::common::root;

/// Modules and items that users can name.
const MOST_NAMES: usize = 300;

/// A module whose own names are not counted: its pages contain text alone.
const GUIDE: &str = "guide";

/// The names of a source file in the order of their listing.
#[derive(Default)]
struct Listing {
    /// Modules and items, with the modules in which they are.
    names: Vec<String>,
    /// What is re-exported, by its path in the inner crate or in a private module.
    sources: Vec<String>,
    /// Modules that are files of their own.
    files: Vec<String>,
}

impl Listing {
    fn of(code: &str) -> Self {
        let mut listing = Self::default();
        let mut modules: Vec<String> = Vec::new();
        let mut lines = code.lines();
        while let Some(line) = lines.next() {
            let statement = line.trim();
            if let Some(module) = statement.strip_prefix("pub mod ") {
                let name = module.trim_end_matches([' ', '{', ';', '}']).to_owned();
                listing.add(&modules, &name);
                if statement.ends_with('{') {
                    modules.push(name);
                } else if statement.ends_with(';') {
                    listing.files.push(name);
                }
            } else if let Some(tree) = statement.strip_prefix("pub use ") {
                let mut tree = tree.to_owned();
                while !tree.ends_with(';') {
                    tree += lines
                        .next()
                        .expect("a statement ends with a semicolon")
                        .trim();
                }
                listing.reexport(&modules, tree.trim_end_matches(';'));
            } else if let Some(name) = declared(line) {
                listing.add(&modules, name);
            } else if statement == "}" {
                modules.pop();
            }
        }
        listing
    }

    fn reexport(&mut self, modules: &[String], tree: &str) {
        for (path, name) in expand(tree, &[]) {
            self.add(modules, &name);
            self.sources.push(path.join("::"));
        }
    }

    fn add(&mut self, modules: &[String], name: &str) {
        let modules = modules.iter().map(String::as_str);
        let path: Vec<&str> = modules.chain([name]).collect();
        self.names.push(path.join("::"));
    }
}

/// The item that a line declares in its module. Constants are indented where a macro makes them.
fn declared(line: &str) -> Option<&str> {
    let constant = line.trim_start().strip_prefix("pub const ");
    let item = constant.or_else(|| {
        let (kind, rest) = line.strip_prefix("pub ")?.split_once(' ')?;
        let kinds = ["enum", "fn", "static", "struct", "trait", "type"];
        kinds.contains(&kind).then_some(rest)
    })?;
    item.split(|c: char| !c.is_alphanumeric() && c != '_')
        .next()
}

fn listing(file: &Path) -> Listing {
    Listing::of(&production(&fs::read_to_string(file).unwrap()))
}

/// What is listed more than once.
fn repeated<'a>(paths: impl IntoIterator<Item = &'a String>) -> Vec<&'a String> {
    let mut counts: BTreeMap<&String, usize> = BTreeMap::new();
    for path in paths {
        *counts.entry(path).or_default() += 1;
    }
    counts.retain(|_, count| *count > 1);
    counts.into_keys().collect()
}

/// The modules of all crates that other crates can name.
fn public_modules() -> BTreeSet<String> {
    let sources = Sources::of_workspace();
    let is_public = |module: &[String]| {
        let (name, parent) = module.split_last()?;
        let declaration = format!("pub mod {name};");
        let declared = parent.is_empty() || sources.0[parent].code.contains(&declaration);
        declared.then(|| module.join("::"))
    };
    sources
        .0
        .keys()
        .filter_map(|module| is_public(module))
        .collect()
}

#[test]
fn the_facade_has_at_most_300_names_and_each_of_them_once() {
    let mut facade = listing(&root().join("src/lib.rs"));
    for module in facade.files.iter().filter(|module| *module != GUIDE) {
        let file = listing(&root().join("src").join(module).with_extension("rs"));
        let names = file.names.iter().map(|name| format!("{module}::{name}"));
        facade.names.extend(names);
    }
    assert!(facade.names.len() > 250, "lib.rs is not understood");
    let names = facade.names.len();
    assert!(names <= MOST_NAMES, "{names} names: {:#?}", facade.names);
    let twice = repeated(facade.names.iter().chain(&facade.sources));
    assert!(twice.is_empty(), "listed twice: {twice:?}");
}

#[test]
fn the_facade_re_exports_items_and_never_whole_modules() {
    let modules = public_modules();
    for source in listing(&root().join("src/lib.rs")).sources {
        let (inner, path) = source.split_once("::").unwrap();
        assert!(inner != "gelbench_validation", "{source} is not for users");
        assert!(
            path != "*" && !path.ends_with("::*"),
            "{source} names everything"
        );
        assert!(!modules.contains(path), "{source} is a module");
    }
}

#[test]
fn every_form_of_a_public_name_is_counted() {
    let code = "pub mod a;\npub mod b {\n    pub use x::b::{\n        C, d,\n    };\n    pub mod e {\n        pub use x::F;\n    }\n}\n\
                pub fn g() {\n    let h = 1;\n}\npub(crate) fn i() {}\n        pub const J: f64 = 1.0;\nimpl K {\n    pub fn l() {}\n}\n";
    let listing = Listing::of(code);
    let expected = ["a", "b", "b::C", "b::d", "b::e", "b::e::F", "g", "J"];
    assert_eq!(listing.names, expected);
    assert_eq!(listing.sources, ["x::b::C", "x::b::d", "x::F"]);
    assert_eq!(listing.files, ["a"]);
}
