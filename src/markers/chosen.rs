//! Columns named by the user, with their roles.

use crate::document::{Column, Table, plain_name};
use crate::error::{Diagnostic, Error, nearest, suggestion};

/// The role of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The place along x.
    X,
    /// The place along y.
    Y,
    /// The displacement along x.
    Ux,
    /// The displacement along y.
    Uy,
    /// Standard deviation of each component of the displacement.
    StandardDeviation,
    /// The number of the frame.
    Frame,
    /// The time of the frame.
    Time,
    /// The number of the marker.
    Id,
}

impl Role {
    /// The roles by their names.
    pub const NAMES: [(&'static str, Self); 8] = [
        ("x", Self::X),
        ("y", Self::Y),
        ("ux", Self::Ux),
        ("uy", Self::Uy),
        ("standard_deviation", Self::StandardDeviation),
        ("frame", Self::Frame),
        ("time", Self::Time),
        ("id", Self::Id),
    ];
}

/// Columns by their roles, as the user names them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChosenColumns(Vec<(Role, String)>);

impl ChosenColumns {
    /// Reads parts such as `ux=disp_u`.
    ///
    /// # Errors
    /// A fault where a part is malformed, its role is unknown, or a role or a column occurs twice.
    pub fn parse<'a>(parts: impl IntoIterator<Item = &'a str>) -> Result<Self, Diagnostic> {
        let mut all: Vec<(Role, String)> = Vec::new();
        let fault = |message: String, hint: &str| Err(Diagnostic::error("", message).hint(hint));
        for part in parts {
            let Some((role, name)) = part.split_once('=') else {
                let hint = "write a quantity and the name of its column, as in --columns x=x_px,y=y_px,ux=disp_u,uy=disp_v";
                return fault(format!("`{part}` names no column"), hint);
            };
            let (role, name) = (role.trim(), name.trim());
            let found = Role::NAMES.iter().find(|(known, _)| *known == role);
            let Some((_, found)) = found else {
                let known = Role::NAMES.map(|(known, _)| known);
                let hint = suggestion(role, &known, "known quantities:");
                return fault(format!("`{role}` is not a known quantity"), &hint);
            };
            if name.is_empty() {
                return fault(
                    format!("`{role}=` names no column"),
                    "write its name after the =",
                );
            }
            if all.iter().any(|(known, _)| known == found) {
                let message = format!("two columns are named for `{role}`");
                return fault(message, "name one");
            }
            if all.iter().any(|(_, known)| known == name) {
                let message = format!("the column `{name}` is named twice");
                return fault(message, "assign each column to one quantity");
            }
            all.push((*found, name.to_owned()));
        }
        Ok(Self(all))
    }

    /// The columns of a table, in the order in which they were named.
    ///
    /// # Errors
    /// [`Error::Input`] with every name that the table does not have, or has twice.
    pub(super) fn on(&self, table: &Table) -> Result<FoundColumns, Error> {
        let (mut found, mut faults) = (Vec::new(), Vec::new());
        for (role, name) in &self.0 {
            match column_named(table, name) {
                Ok(index) => found.push((*role, index)),
                Err(fault) => faults.push(fault),
            }
        }
        match faults.is_empty() {
            true => Ok(FoundColumns(found)),
            false => Err(Error::Input(faults)),
        }
    }
}

/// Columns that the user named, by their places in a table.
#[derive(Debug, Default)]
pub(super) struct FoundColumns(Vec<(Role, usize)>);

impl FoundColumns {
    /// The column that was named for a role.
    pub fn of(&self, role: Role) -> Option<usize> {
        let mut all = self.0.iter();
        all.find(|(known, _)| *known == role)
            .map(|(_, index)| *index)
    }

    /// Whether a place or a displacement was named.
    pub fn any_length(&self) -> bool {
        let lengths = [Role::X, Role::Y, Role::Ux, Role::Uy];
        lengths.iter().any(|role| self.of(*role).is_some())
    }
}

/// The only column with a name: as written, with or without its unit, otherwise in any case.
///
/// # Errors
/// A fault with the columns that there are, where there is none of this name, or more than one.
pub fn column_named(table: &Table, name: &str) -> Result<usize, Diagnostic> {
    let ways: [&dyn Fn(&Column) -> bool; 3] = [
        &|column| column.head() == name,
        &|column| column.written == name,
        &|column| column.name == plain_name(name.split(['[', '(']).next().unwrap_or(name)),
    ];
    let heads: Vec<String> = table.columns.iter().map(Column::head).collect();
    let all = heads.join(", ");
    for way in ways {
        let of_name = table.columns.iter().enumerate();
        let of_name: Vec<usize> = of_name
            .filter(|(_, column)| way(column))
            .map(|(index, _)| index)
            .collect();
        match of_name[..] {
            [] => {}
            [index] => return Ok(index),
            _ => {
                let message = format!("the file has {} columns `{name}`", of_name.len());
                let hint = format!("name one of {all}, or rename one in the file");
                return Err(table.fault(table.columns_place.clone(), message, &hint));
            }
        }
    }
    let known = heads.iter().map(String::as_str);
    let hint = match heads.iter().all(String::is_empty) {
        true => {
            "the columns of this file have no names: write a line of names above the rows".into()
        }
        false => {
            let near = nearest(name, known).map(|near| format!("did you mean `{near}`? "));
            format!("{}the file has {all}", near.unwrap_or_default())
        }
    };
    let message = format!("there is no column `{name}`");
    Err(table.fault(table.columns_place.clone(), message, &hint))
}
