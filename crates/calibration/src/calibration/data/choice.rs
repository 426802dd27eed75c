//! Which columns of a table are read. Where several may be the same quantity and differ, the user is asked.

use super::columns::unit;
use super::readings::{Named, Readings, values};
use super::roles::{DISPLACEMENT, FORCE, Kind, Quantity, Role, of_kind};
use super::test_data::Test;
use crate::document::{ChosenColumns, Column, ColumnRole, FoundColumns, Head};
use crate::error::{Diagnostic, Error};
use crate::statistics::extremes;
use crate::units::{self, Dimension};

/// The key under which the columns are stated.
pub const COLUMNS: &str = "columns";

/// The columns that are stated.
fn chosen(head: &Head) -> Result<FoundColumns<Quantity>, Vec<Diagnostic>> {
    let text = head.text(COLUMNS).map_err(|fault| vec![*fault])?;
    let parts = text.iter().flat_map(|text| text.split(','));
    let chosen = ChosenColumns::parse(parts).map_err(|fault| vec![fault])?;
    chosen.on(head.table).map_err(|error| match error {
        Error::Input(faults) => faults,
        other => vec![Diagnostic::error("", other.to_string())],
    })
}

/// The role of a column that was stated: the measure is that of its name, or of its unit.
fn stated(head: &Head, column: usize, Quantity(kind, numbered): Quantity) -> Role {
    let column = &head.table.columns[column];
    let named = Role::of(column).0;
    let measure = Some(named.measure).filter(|_| named.kind == kind).flatten();
    Role::new(
        kind,
        measure.or_else(|| of_unit(head, column, kind)),
        numbered,
    )
}

/// The measure of a column that its unit shows: of lengths and forces.
fn of_unit(head: &Head, column: &Column, kind: Kind) -> Option<&'static str> {
    let unit = unit(head, column, kind)?;
    let is_of = |dimension| units::factor(&unit, dimension).is_ok();
    match kind {
        Kind::Strain if is_of(Dimension::Length) => Some(DISPLACEMENT),
        Kind::Stress if is_of(Dimension::Force) => Some(FORCE),
        _ => None,
    }
}

/// What each column is read as, with questions where more than one reading is possible.
pub struct Choice<'a> {
    head: &'a Head<'a>,
    test: Option<Test>,
    /// The role of each column.
    pub roles: Vec<Role>,
    /// The questions about strains and stresses.
    pub questions: Vec<Diagnostic>,
    /// The question about times, which few fits read.
    pub of_times: Option<Diagnostic>,
}

impl<'a> Choice<'a> {
    /// Chooses the columns of a table.
    ///
    /// # Errors
    /// The faults of the columns that are stated: what else the table lacks would follow from them.
    pub fn of(head: &'a Head<'a>, test: Option<Test>) -> Result<Self, Vec<Diagnostic>> {
        let columns = &head.table.columns;
        let mut choice = Self {
            head,
            test,
            roles: vec![Role::OTHER; columns.len()],
            questions: Vec::new(),
            of_times: None,
        };
        let chosen = chosen(head)?;
        for (_, quantity) in Quantity::NAMES {
            if let Some(column) = chosen.of(*quantity) {
                choice.roles[column] = stated(head, column, *quantity);
            }
        }
        if columns.iter().all(|column| column.name.is_empty()) {
            choice.order();
        } else {
            choice.sizes();
            for kind in [Kind::Strain, Kind::Stress, Kind::Time] {
                choice.of_names(kind);
            }
        }
        Ok(choice)
    }

    /// Whether a column of a kind has been chosen.
    fn has(&self, kind: Kind) -> bool {
        of_kind(&self.roles, kind).next().is_some()
    }

    /// The columns of the specimen's size, where its length is not stated.
    fn sizes(&mut self) {
        if matches!(self.head.text("length"), Ok(Some(_))) {
            return;
        }
        for column in 0..self.roles.len() {
            let named = self.named(Kind::Size, column);
            if let Some(candidate) = named.filter(|candidate| has_numbers(self.head, candidate)) {
                self.roles[column] = candidate.role;
            }
        }
    }

    /// Chooses by the names of columns.
    fn of_names(&mut self, kind: Kind) {
        if self.has(kind) {
            return;
        }
        let columns = 0..self.roles.len();
        let mut named: Vec<Named> = columns
            .filter_map(|column| self.named(kind, column))
            .collect();
        if named
            .iter()
            .any(|candidate| has_numbers(self.head, candidate))
        {
            named.retain(|candidate| has_numbers(self.head, candidate));
        }
        let name = kind.name();
        if self.is_one(kind, &named) {
            return self.of_candidates(name, &named);
        }
        let (second, first): (Vec<_>, _) = named
            .into_iter()
            .partition(|candidate| candidate.role.axis() == 1);
        match (self.test, second.is_empty()) {
            (Some(Test::Biaxial), _) | (_, false) => {
                self.of_candidates(&format!("{name}_1"), &first)
            }
            _ => self.of_candidates(name, &first),
        }
        self.of_candidates(&format!("{name}_2"), &second);
    }

    /// A column that is not chosen yet, where its name is one of a kind.
    fn named(&self, kind: Kind, column: usize) -> Option<Named> {
        let table_column = &self.head.table.columns[column];
        let (mut role, naming) = Role::of(table_column);
        let is_free = self.roles[column].kind == Kind::Other && role.kind == kind;
        role.measure = role
            .measure
            .or_else(|| of_unit(self.head, table_column, kind));
        is_free.then_some(Named {
            column,
            role,
            naming,
        })
    }

    /// Whether all columns of a kind stand for one quantity: a test of one axis has one stress, and only columns that are all numbered, or
    /// those of a biaxial test, are of two axes.
    fn is_one(&self, kind: Kind, named: &[Named]) -> bool {
        let numbered = named
            .iter()
            .filter(|candidate| candidate.role.numbered.is_some());
        let is_mixed = numbered.count() < named.len();
        match self.test {
            _ if kind == Kind::Time => true,
            None | Some(Test::Biaxial) => false,
            Some(Test::Uniaxial) if kind == Kind::Stress => true,
            _ => is_mixed,
        }
    }

    /// Chooses one of the columns that may be the same quantity; where others differ from it, the user is asked.
    fn of_candidates(&mut self, quantity: &str, candidates: &[Named]) {
        let readings = Readings {
            head: self.head,
            roles: &self.roles,
        };
        // Columns that need a dimension which is not stated count only where no other can be read.
        let mut possible = candidates.to_vec();
        if candidates
            .iter()
            .any(|candidate| readings.are_possible(candidate))
        {
            possible.retain(|candidate| readings.are_possible(candidate));
        }
        let Some(first) = possible.iter().min_by_key(|candidate| {
            let is_measured = readings.is_measured(candidate);
            (
                !is_measured,
                candidate.naming,
                candidate.role.numbered,
                candidate.column,
            )
        }) else {
            return;
        };
        self.roles[first.column] = first.role;
        let readings = Readings {
            head: self.head,
            roles: &self.roles,
        };
        let mut others = possible
            .iter()
            .filter(|candidate| candidate.column != first.column);
        if others.all(|other| readings.agree(first, other)) {
            return;
        }
        let each = possible.iter();
        let options = each.map(|candidate| self.option(&[(quantity, candidate.column)]));
        let message = format!(
            "{}: {} columns may be the {}, and they do not agree",
            self.head.table.source.name,
            possible.len(),
            first.role.kind.name()
        );
        let question = question(self.head, message, options.collect());
        match first.role.kind {
            Kind::Time => self.of_times = Some(question),
            _ => self.questions.push(question),
        }
    }

    /// Finds the columns of a table without names: their order is known where one alone is possible.
    fn order(&mut self) {
        let count = self.roles.len();
        let free = |kind: Kind, choice: &Self| -> Vec<usize> {
            match of_kind(&choice.roles, kind).next() {
                Some((column, _)) => vec![column],
                None => (0..count)
                    .filter(|column| choice.roles[*column].kind == Kind::Other)
                    .collect(),
            }
        };
        let stresses = free(Kind::Stress, self);
        let columns = free(Kind::Strain, self).into_iter();
        let strains = columns.filter(|column| self.may_be_strain(*column));
        let pairs: Vec<[usize; 2]> = strains
            .flat_map(|strain| stresses.iter().map(move |stress| [strain, *stress]))
            .filter(|[strain, stress]| strain != stress)
            .collect();
        let Some([strain, stress]) = pairs.first().copied() else {
            return;
        };
        for (column, kind) in [(strain, Kind::Strain), (stress, Kind::Stress)] {
            if !self.has(kind) {
                self.roles[column] = stated(self.head, column, Quantity(kind, None));
            }
        }
        if pairs.len() > 1 {
            let each = pairs.iter();
            let options = each
                .map(|[strain, stress]| self.option(&[("strain", *strain), ("stress", *stress)]));
            let message = format!(
                "{}: the columns have no names, and more than one reading is possible",
                self.head.table.source.name
            );
            let question = question(self.head, message, options.collect());
            self.questions.push(question);
        }
    }

    /// Whether a column's values are possible as what is stated of the strain: stretches are positive.
    fn may_be_strain(&self, column: usize) -> bool {
        let stated = self.head.setting("strain measure", None).ok().flatten();
        let percent = self.head.setting("strain unit", None).ok().flatten();
        let unit = units::factor(percent.as_deref().unwrap_or("-"), Dimension::Ratio);
        let least = extremes(values(self.head, (column, unit.unwrap_or(1.0))))[0];
        match stated.as_deref() {
            Some("stretch") => least > 0.0,
            Some("nominal") => least > -1.0,
            _ => true,
        }
    }

    /// How to state some columns on the command line, with the values that they have.
    fn option(&self, columns: &[(&str, usize)]) -> String {
        let table = self.head.table;
        let (mut written, mut ranges) = (Vec::new(), Vec::new());
        for (quantity, column) in columns {
            let [low, high] = extremes(values(self.head, (*column, 1.0)));
            let unit = table.columns[*column].unit.as_deref().unwrap_or_default();
            let range = format!("{quantity} from {low} to {high} {unit}");
            written.push(format!("{quantity}={}", self.written(*column)));
            ranges.push(range.trim_end().to_owned());
        }
        let written = written.join(",");
        let quoted = if written
            .contains(|letter: char| !letter.is_alphanumeric() && !"=,_".contains(letter))
        {
            format!("\"{written}\"")
        } else {
            written
        };
        format!("--columns {quoted} ({})", ranges.join(", "))
    }

    /// A column's name, or its number where the name cannot be stated.
    fn written(&self, column: usize) -> String {
        let columns = &self.head.table.columns;
        let head = columns[column].head();
        let alike = columns.iter().filter(|other| other.head() == head).count();
        if head.is_empty() || alike > 1 || head.contains([',', '"', '\\', '$', '`', ';']) {
            (column + 1).to_string()
        } else {
            head
        }
    }
}

/// Whether a column has numbers at all.
fn has_numbers(head: &Head, candidate: &Named) -> bool {
    let mut values = values(head, (candidate.column, 1.0)).into_iter();
    values.any(f64::is_finite)
}

/// The question which of several readings is the right one.
fn question(head: &Head, message: String, options: Vec<String>) -> Diagnostic {
    let mut hint = format!("choose one: {}", options.join(", or "));
    if head.table.is_text {
        hint += &format!("; or write `# {COLUMNS}: …` with it at the top of the file");
    }
    Diagnostic::error("", message).hint(hint)
}
