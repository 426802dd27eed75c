//! TOML documents in which some values are set.

use toml::{Table, Value};

/// A TOML document that is written again; its comments are lost.
#[derive(Clone, Debug)]
pub struct EditedDocument {
    table: Table,
}

/// A value to be set.
#[derive(Clone, Debug, PartialEq)]
pub enum NewValue {
    /// A whole number.
    Integer(i64),
    /// A number.
    Float(f64),
    /// A truth.
    Flag(bool),
    /// A text.
    Text(String),
}

impl NewValue {
    fn value(&self) -> Value {
        match self {
            Self::Integer(complete) => Value::Integer(*complete),
            Self::Float(number) => Value::Float(*number),
            Self::Flag(flag) => Value::Boolean(*flag),
            Self::Text(text) => Value::String(text.clone()),
        }
    }
}

impl EditedDocument {
    /// The document of a text.
    ///
    /// # Errors
    /// A description of why it is not TOML.
    pub fn parse(text: &str) -> Result<Self, String> {
        let table = text
            .parse()
            .map_err(|fault: toml::de::Error| fault.to_string())?;
        Ok(Self { table })
    }

    /// The text at a path of names and of places in lists from 0 on.
    pub fn text_of(&self, path: &[&str]) -> Option<&str> {
        self.at(path)?.as_str()
    }

    /// Sets the value at a path of names and of places in lists from 0 on; missing sections are created, missing places of lists are not.
    ///
    /// # Errors
    /// A description of why there is no such place.
    pub fn set(&mut self, path: &[&str], value: &NewValue) -> Result<(), String> {
        set(&mut self.table, path, value)
    }

    /// Removes a section or a value at the top, where there is one.
    pub fn remove(&mut self, key: &str) {
        self.table.remove(key);
    }

    /// Whether there is a value at a path of names and of places in lists from 0 on.
    pub fn holds(&self, path: &[&str]) -> bool {
        self.at(path).is_some()
    }

    fn at(&self, path: &[&str]) -> Option<&Value> {
        let (first, rest) = path.split_first()?;
        rest.iter()
            .try_fold(self.table.get(*first)?, |value, key| match value {
                Value::Array(all) => all.get(key.parse::<usize>().ok()?),
                _ => value.get(*key),
            })
    }

    /// The text of the document.
    pub fn text(&self) -> String {
        self.table.to_string()
    }
}

fn set(table: &mut Table, path: &[&str], value: &NewValue) -> Result<(), String> {
    match path {
        [] => Err("there is no key".to_owned()),
        [key] => {
            table.insert((*key).to_owned(), value.value());
            Ok(())
        }
        [key, rest @ ..] => {
            let inner = table
                .entry(*key)
                .or_insert_with(|| Value::Table(Table::new()));
            set_within(inner, key, rest, value)
        }
    }
}

fn set_within(
    inner: &mut Value,
    name: &str,
    rest: &[&str],
    value: &NewValue,
) -> Result<(), String> {
    match inner {
        Value::Table(table) => set(table, rest, value),
        Value::Array(list) => {
            let count = list.len();
            let entry = rest[0]
                .parse::<usize>()
                .ok()
                .and_then(|position| list.get_mut(position))
                .ok_or_else(|| {
                    format!(
                        "`{name}` is a list of {count} entries, and `{}` is not one of them",
                        rest[0]
                    )
                })?;
            match rest {
                [_] => {
                    *entry = value.value();
                    Ok(())
                }
                _ => set_within(entry, rest[0], &rest[1..], value),
            }
        }
        _ => Err(format!("`{name}` is a value, not a section")),
    }
}
