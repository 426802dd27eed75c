//! Every key that a reader knows, collected by letting it read.
//!
//! A file is read, every key that the reader looks up is added to it with a suitable value, and it is read again
//! until no new key is looked up. Then every choice is given each of its names in turn, and keys that are looked up
//! only then belong to that choice.

use std::collections::VecDeque;

use toml::{Table, Value};

use super::keys::note;
use super::{Key, Takes};

/// Choices and the names given to them.
type Assignment = Vec<(String, String)>;

/// A key with the choices under which it is looked up.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundKey {
    /// The key.
    pub key: Key,
    /// The choice and those of its names for which the key is read; `None` for keys that are always read.
    pub only_with: Option<(String, Vec<String>)>,
}

/// The keys that are looked up when a choice is given one of its names.
struct Reading {
    choice: String,
    name: String,
    paths: Vec<String>,
}

/// All keys that a reader looks up, in its order; `read` reads a text and returns the keys that were looked up.
pub fn explore(read: &dyn Fn(&str) -> Vec<Key>) -> Vec<FoundKey> {
    let (mut result, mut readings): (Vec<Key>, Vec<Reading>) = (Vec::new(), Vec::new());
    let mut open = VecDeque::from([Assignment::new()]);
    while let Some(assignment) = open.pop_front() {
        let keys = complete(read, &assignment);
        if let Some((choice, name)) = assignment.last().cloned() {
            let paths = keys.iter().map(|key| key.path.clone()).collect();
            readings.push(Reading {
                choice,
                name,
                paths,
            });
        }
        for key in keys {
            let is_new = result.iter().all(|known| known.path != key.path);
            if let (true, Some(Takes::Choice(names))) = (is_new, key.takes.first())
                && names.len() > 1
            {
                open.extend(names.iter().map(|name| with(&assignment, &key.path, name)));
            }
            note(&mut result, key);
        }
    }
    let result = result.into_iter();
    result
        .map(|key| FoundKey {
            only_with: only_with(&key.path, &readings),
            key,
        })
        .collect()
}

fn with(assignment: &Assignment, path: &str, name: &str) -> Assignment {
    let mut more = assignment.clone();
    more.push((path.to_owned(), name.to_owned()));
    more
}

/// The last choice for which some names make the reader look up a key, and others do not.
fn only_with(path: &str, readings: &[Reading]) -> Option<(String, Vec<String>)> {
    let mut choices: Vec<&str> = readings.iter().map(|reading| &*reading.choice).collect();
    choices.dedup();
    let decides = |choice: &&&str| {
        let of_choice = || readings.iter().filter(|reading| reading.choice == **choice);
        let asks = |reading: &Reading| reading.paths.iter().any(|known| known == path);
        of_choice().any(asks) && !of_choice().all(asks)
    };
    let choice = *choices.iter().rev().find(decides)?;
    let names = readings.iter().filter(|reading| {
        reading.choice == choice && reading.paths.iter().any(|known| known == path)
    });
    Some((
        choice.to_owned(),
        names.map(|reading| reading.name.clone()).collect(),
    ))
}

/// The keys that are looked up in a file that has all of them, with some choices made.
fn complete(read: &dyn Fn(&str) -> Vec<Key>, assignment: &Assignment) -> Vec<Key> {
    let mut file = Table::new();
    for (path, name) in assignment {
        put(&mut file, path, Value::String(name.clone()));
    }
    let mut all = fill(read, &mut file, assignment);
    alone(read, &file, &mut all);
    as_lists(read, &file, assignment, &mut all);
    all
}

/// Gives every key that is looked up a value, until no new key is; returns these keys.
fn fill(read: &dyn Fn(&str) -> Vec<Key>, file: &mut Table, assignment: &Assignment) -> Vec<Key> {
    const ROUNDS: usize = 16;
    for _ in 0..ROUNDS {
        let before = file.clone();
        let keys = read(&file.to_string());
        for key in &keys {
            let chosen = assignment.iter().find(|(path, _)| *path == key.path);
            let value = match chosen {
                Some((_, name)) => Value::String(name.clone()),
                None => value(key),
            };
            put(file, &key.path, value);
        }
        if *file == before {
            return keys;
        }
    }
    Vec::new()
}

/// Keys of tables that may be lists: each is given as one.
fn as_lists(
    read: &dyn Fn(&str) -> Vec<Key>,
    file: &Table,
    assignment: &Assignment,
    all: &mut Vec<Key>,
) {
    let may_be_list = |key: &&Key| key.takes == [Takes::Section, Takes::Sections];
    let lists: Vec<String> = all
        .iter()
        .filter(may_be_list)
        .map(|key| key.path.clone())
        .collect();
    for path in lists {
        let mut file = file.clone();
        file.insert(path, Value::Array(vec![Value::Table(Table::new())]));
        for key in fill(read, &mut file, assignment) {
            note(all, key);
        }
    }
}

/// Keys that exclude each other: each is given without the others that are still unknown.
fn alone(read: &dyn Fn(&str) -> Vec<Key>, file: &Table, all: &mut Vec<Key>) {
    let unknown: Vec<String> = all
        .iter()
        .filter(|key| key.takes.is_empty())
        .map(|key| key.path.clone())
        .collect();
    for path in &unknown {
        let mut file = file.clone();
        for other in unknown.iter().filter(|other| *other != path) {
            remove(&mut file, other);
        }
        for key in read(&file.to_string()) {
            note(all, key);
        }
    }
}

/// A suitable value for a key.
fn value(key: &Key) -> Value {
    let takes = key.takes.first();
    let example = key
        .example
        .clone()
        .or_else(|| takes.map(Takes::example))
        .unwrap_or_default();
    let document = format!("value = {example}").parse::<Table>().ok();
    let parsed = document.and_then(|mut table| table.remove("value"));
    match takes {
        Some(Takes::Section) => Value::Table(Table::new()),
        Some(Takes::Sections) => Value::Array(vec![Value::Table(Table::new())]),
        _ => parsed.unwrap_or_else(|| Value::String("?".to_owned())),
    }
}

/// The table that a path leads to and the name in it; tables on the way are made where they are missing.
fn position<'a, 'b>(file: &'a mut Table, path: &'b str) -> Option<(&'a mut Table, &'b str)> {
    let Some((first, rest)) = path.split_once('.') else {
        return Some((file, path));
    };
    let list = first.ends_with("[]");
    let entry = file.entry(first.trim_end_matches("[]").to_owned());
    let empty = Value::Table(Table::new());
    let entry = entry.or_insert(if list {
        Value::Array(vec![empty])
    } else {
        empty
    });
    let inner = match entry {
        Value::Array(tables) => tables.first_mut(),
        other => Some(other),
    };
    position(inner?.as_table_mut()?, rest)
}

/// Gives a key a value; existing tables are kept.
fn put(file: &mut Table, path: &str, value: Value) {
    let Some((table, name)) = position(file, path) else {
        return;
    };
    let holds_tables = |value: &Value| match value {
        Value::Table(_) => true,
        Value::Array(items) => items.iter().any(Value::is_table),
        _ => false,
    };
    let kept = table.get(name).is_some_and(holds_tables) && holds_tables(&value);
    if !kept {
        table.insert(name.to_owned(), value);
    }
}

fn remove(file: &mut Table, path: &str) {
    if let Some((table, name)) = position(file, path) {
        table.remove(name);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Bound, Document, Faults, Presence, Section};
    use super::*;
    use crate::units::Dimension;

    fn length(section: &Section, key: &'static str) {
        section.quantity(key, Dimension::Length, Bound::Positive);
    }

    /// One of two keys, keys of choices within choices, lists of tables, tables that may be lists, keys that may be missing.
    fn read(text: &str) -> Vec<Key> {
        let faults = Faults::default();
        let document = Document::parse("", text, &faults);
        let root = document.root(None, &faults);
        length(&root, "always");
        if root.has("more") {
            length(&root.section("more"), "inside");
        }
        for part in root.section_or_sections("part") {
            length(&part, "each");
            if root.is_list("part") {
                length(&part, "several");
            }
        }
        if root.has("item") {
            for item in root.tables("item") {
                match item.choice("kind", &[("a", 0), ("b", 1)]) {
                    Some(0) => length(&item, "of_a"),
                    Some(_) => match (item.has("one"), item.has("other")) {
                        (true, false) => length(&item, "one"),
                        (false, true) => drop(item.flag("other")),
                        _ => {}
                    },
                    None => {}
                }
            }
        }
        faults.keys()
    }

    #[test]
    fn every_key_is_found_with_what_it_takes_and_when() {
        let result = explore(&read);
        let key = |path: &str| {
            let entry = result.iter().find(|entry| entry.key.path == path);
            entry.unwrap_or_else(|| panic!("{path}: {result:#?}"))
        };
        let takes = |path: &str| key(path).key.takes.clone();
        let length = [Takes::Quantity(Dimension::Length, Bound::Positive)];
        assert_eq!(takes("always"), length);
        assert_eq!(key("always").key.presence, Presence::Required);
        assert_eq!(takes("more.inside"), length);
        assert_eq!(key("more").key.presence, Presence::Optional);
        assert_eq!(takes("part.each"), length);
        assert_eq!(takes("part[].several"), length);
        assert_eq!(takes("item[].one"), length);
        assert_eq!(takes("item[].other"), [Takes::Flag]);
        let only = |path: &str| key(path).only_with.clone();
        let with = |name: &str| Some(("item[].kind".to_owned(), vec![name.to_owned()]));
        assert_eq!(only("item[].of_a"), with("a"));
        assert_eq!(only("item[].other"), with("b"));
        assert_eq!(only("item[].kind"), None);
        assert_eq!(result.len(), 12);
    }
}
