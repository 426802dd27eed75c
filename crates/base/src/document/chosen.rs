//! Columns named by the user, with their roles.

use super::{Column, Table};
use crate::error::{Diagnostic, Error, nearest, suggestion};

/// What a column of a table may be for some reader.
pub trait ColumnRole: Copy + PartialEq + 'static {
    /// The roles by the names that users write.
    const NAMES: &'static [(&'static str, Self)];
    /// A choice as a user writes it.
    const EXAMPLE: &'static str;
}

/// Names of columns by what they mean, in lower case with underscores for spaces; those of one meaning are separated by spaces.
pub type ColumnNames<R> = [(R, &'static str)];

/// What a column's name means.
pub fn meaning<R: Copy>(names: &ColumnNames<R>, name: &str) -> Option<R> {
    let is_among = |(_, all): &&(R, &str)| all.split(' ').any(|known| known == name);
    names.iter().find(is_among).map(|(meaning, _)| *meaning)
}

/// The first column of a table whose name has a meaning, by the order of the names.
pub fn column_meaning<R: Copy + PartialEq>(
    names: &ColumnNames<R>,
    meaning: R,
    table: &Table,
) -> Option<usize> {
    names
        .iter()
        .filter(|(known, _)| *known == meaning)
        .flat_map(|(_, names)| names.split(' '))
        .find_map(|name| table.column(name))
}

/// Names that people and testing machines give to the time.
pub const TIMES: &str =
    "time t step_time elapsed_time total_time test_time running_time prüfzeit zeit temps 时间";

/// Names that testing machines give to the displacement of their grip.
pub const MACHINE_DISPLACEMENTS: &str = "tensile_extension compressive_extension tensile_displacement compressive_displacement axial_displacement crosshead \
     crosshead_displacement crosshead_position position stroke disp standardweg traversenweg traversenweg_absolut weg 位移";

/// Names that testing machines give to the force.
pub const MACHINE_FORCES: &str = "tensile_load compressive_load tensile_force compressive_force axial_load axial_force static_force normal_force fz standard_force standardkraft kraft 力 载荷";

/// Columns by their roles, as the user names them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChosenColumns<R>(Vec<(R, String)>);

impl<R> Default for ChosenColumns<R> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<R: ColumnRole> ChosenColumns<R> {
    /// Reads parts such as `ux=disp_u`.
    ///
    /// # Errors
    /// A fault where a part is malformed, its role is unknown, or a role or a column occurs twice.
    pub fn parse<'a>(parts: impl IntoIterator<Item = &'a str>) -> Result<Self, Diagnostic> {
        let mut all: Vec<(R, String)> = Vec::new();
        let fault = |message: String, hint: &str| Err(Diagnostic::error("", message).hint(hint));
        for part in parts {
            let Some((role, name)) = part.split_once('=') else {
                let hint = format!(
                    "write a quantity and the name of its column, as in --columns {}",
                    R::EXAMPLE
                );
                return fault(format!("`{part}` names no column"), &hint);
            };
            let (role, name) = (role.trim(), name.trim());
            let actual = R::NAMES.iter().find(|(known, _)| *known == role);
            let Some((_, actual)) = actual else {
                let known: Vec<_> = R::NAMES.iter().map(|(known, _)| *known).collect();
                let hint = suggestion(role, &known, "known quantities:");
                return fault(format!("`{role}` is not a known quantity"), &hint);
            };
            if name.is_empty() {
                return fault(
                    format!("`{role}=` names no column"),
                    "write its name after the =",
                );
            }
            if all.iter().any(|(known, _)| known == actual) {
                let message = format!("two columns are named for `{role}`");
                return fault(message, "name one");
            }
            if all.iter().any(|(_, known)| known == name) {
                let message = format!("the column `{name}` is named twice");
                return fault(message, "assign each column to one quantity");
            }
            all.push((*actual, name.to_owned()));
        }
        Ok(Self(all))
    }

    /// The columns of a table, in the order in which they were named.
    ///
    /// # Errors
    /// [`Error::Input`] with every name that the table does not have, or has twice.
    pub fn on(&self, table: &Table) -> Result<FoundColumns<R>, Error> {
        let (mut actual, mut faults) = (Vec::new(), Vec::new());
        for (role, name) in &self.0 {
            match column_named(table, name) {
                Ok(index) => actual.push((*role, index)),
                Err(fault) => faults.push(fault),
            }
        }
        Error::refuse(faults)?;
        Ok(FoundColumns(actual))
    }
}

/// Columns that the user named, by their places in a table.
#[derive(Debug)]
pub struct FoundColumns<R>(Vec<(R, usize)>);

impl<R: ColumnRole> FoundColumns<R> {
    /// The column that was named for a role.
    pub fn of(&self, role: R) -> Option<usize> {
        let mut all = self.0.iter();
        all.find(|(known, _)| *known == role)
            .map(|(_, index)| *index)
    }

    /// Whether a column was named for one of some roles.
    pub fn any(&self, roles: &[R]) -> bool {
        roles.iter().any(|role| self.of(*role).is_some())
    }
}

/// The only column with a name: as written, with or without its unit, otherwise in any case, with the column's own unit or none; of columns
/// that their names do not tell apart, the one of a number from 1 on.
///
/// # Errors
/// A fault with the columns that there are, where there is none of this name, or more than one.
pub fn column_named(table: &Table, name: &str) -> Result<usize, Diagnostic> {
    let criteria: [&dyn Fn(&Column) -> bool; 3] = [
        &|column| column.head() == name,
        &|column| column.written == name,
        &|column| column.answers_to(name),
    ];
    let heads: Vec<String> = table.columns.iter().map(Column::head).collect();
    let all = heads.join(", ");
    for criterion in criteria {
        let of_name = table.columns.iter().enumerate();
        let of_name: Vec<usize> = of_name
            .filter(|(_, column)| criterion(column))
            .map(|(index, _)| index)
            .collect();
        match of_name[..] {
            [] => {}
            [index] => return Ok(index),
            _ => {
                let numbers: Vec<_> = of_name.iter().map(|at| (at + 1).to_string()).collect();
                let message = format!("the file has {} columns `{name}`", of_name.len());
                let hint = format!(
                    "name one of {all}, or write its number: {}",
                    numbers.join(" or ")
                );
                return Err(table.fault(table.columns_place.clone(), message, &hint));
            }
        }
    }
    let number = name.parse::<usize>().ok();
    if let Some(number) = number.filter(|number| (1..=heads.len()).contains(number)) {
        return Ok(number - 1);
    }
    let known = heads.iter().map(String::as_str);
    let hint = if heads.iter().all(String::is_empty) {
        format!(
            "the columns of this file have no names: write their numbers, 1 to {}",
            heads.len()
        )
    } else {
        let near = nearest(name, known).map(|near| format!("did you mean `{near}`? "));
        format!("{}the file has {all}", near.unwrap_or_default())
    };
    let message = format!("there is no column `{name}`");
    Err(table.fault(table.columns_place.clone(), message, &hint))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit or a gauge that is not the column's names another column, which the file does not have.
    #[test]
    fn a_column_is_meant_with_its_own_unit_and_gauge_or_with_neither() {
        let heads = "Load [N];Tensile strain (Strain 1);Strain (Strain 2) (%);X (mm)";
        let table = Table::parse("a.csv", &format!("{heads}\n1;2;3;4\n5;6;7;8")).unwrap();
        for (name, expected) in [
            ("load", Some(0)),
            ("Load (N)", Some(0)),
            ("load, newton", Some(0)),
            ("Load (kN)", None),
            ("Load [px]", None),
            ("tensile strain", Some(1)),
            ("tensile strain [strain 1]", Some(1)),
            ("Tensile strain (Strain 2)", None),
            ("Strain", Some(2)),
            ("Strain [%]", Some(2)),
            ("Strain (Strain 2)", Some(2)),
            ("Strain (Strain 3) (%)", None),
            ("X (px)", None),
            ("2", Some(1)),
        ] {
            assert_eq!(column_named(&table, name).ok(), expected, "{name}");
        }
        let fault = column_named(&table, "Load (kN)").unwrap_err();
        assert!(fault.message.contains("there is no column `Load (kN)`"));
        assert!(fault.hint.unwrap().contains("did you mean `Load [N]`"));
    }

    #[test]
    fn a_gauge_that_the_file_has_not_is_none_of_two() {
        let heads = "Tensile strain (Strain 1);Tensile strain (Strain 2)";
        let table = Table::parse("a.csv", &format!("{heads}\n1;2\n5;6")).unwrap();
        let output = |name: &str| column_named(&table, name).unwrap_err().message;
        assert!(output("Tensile strain (Strain 3)").starts_with("there is no column"));
        assert!(output("Tensile strain").contains("the file has 2 columns"));
    }
}
