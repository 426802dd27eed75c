//! What the columns of a table mean, and the rows read by it.

use super::rounding::rounding;
use super::test_data::{Observation, StrainColumn, Test, TestData};
use crate::document::{Faulty, Head, Table};
use crate::error::Diagnostic;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::units::Dimension;

/// What the columns mean.
pub struct Layout {
    test: Test,
    stress_measure: StressMeasure,
    strain: StrainColumn,
    /// Column and factor to a ratio, along both axes.
    strains: [Option<(usize, f64)>; 2],
    stresses: Vec<StressColumn>,
    /// ε₂/ε₁ of nominal strains in a biaxial test without a second column.
    strain_ratio: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Strain,
    Stress,
    Other,
}

/// What a column's name says.
#[derive(Clone, Copy, Debug)]
struct Role {
    kind: Kind,
    measure: Option<&'static str>,
    axis: usize,
}

const DISPLACEMENT: &str = "displacement";
const FORCE: &str = "force";

impl Role {
    const fn strain(measure: Option<&'static str>, axis: usize) -> Self {
        let kind = Kind::Strain;
        Self {
            kind,
            measure,
            axis,
        }
    }

    const fn stress(measure: Option<&'static str>, axis: usize) -> Self {
        let kind = Kind::Stress;
        Self {
            kind,
            measure,
            axis,
        }
    }

    fn named(name: &str) -> Self {
        let (stem, axis) = match name.rsplit_once('_') {
            Some((stem, "1")) => (stem, 0),
            Some((stem, "2")) => (stem, 1),
            _ => (name, 0),
        };
        match stem {
            "stretch" | "lambda" | "λ" => Self::strain(Some("stretch"), axis),
            "strain" => Self::strain(None, axis),
            "nominal_strain" | "engineering_strain" => Self::strain(Some("nominal"), axis),
            "logarithmic_strain" | "true_strain" => Self::strain(Some("logarithmic"), axis),
            "displacement" | "extension" => Self::strain(Some(DISPLACEMENT), axis),
            "stress" => Self::stress(None, axis),
            "nominal_stress" | "engineering_stress" | "first_piola_kirchhoff_stress" => {
                Self::stress(Some("nominal"), axis)
            }
            "cauchy_stress" | "true_stress" => Self::stress(Some("cauchy"), axis),
            "force" | "load" => Self::stress(Some(FORCE), axis),
            _ => Self {
                kind: Kind::Other,
                measure: None,
                axis,
            },
        }
    }
}

/// The columns of some kind with what their names say.
fn of_kind(roles: &[Role], kind: Kind) -> impl Iterator<Item = (usize, &Role)> {
    let all = roles.iter().enumerate();
    all.filter(move |(_, role)| role.kind == kind)
}

impl Layout {
    /// Finds out what the columns mean.
    pub fn new(head: &Head) -> Faulty<Self> {
        let test = head.choice("test", None, &Test::NAMES)?;
        let roles = roles(head);
        check_columns(head, &roles, test)?;
        let (strain, strains) = strains(head, &roles)?;
        let (stress_measure, stresses) = stresses(head, &roles)?;
        let strain_ratio = if test == Test::Biaxial && strains[1].is_none() {
            Some(strain_ratio(head)?)
        } else {
            None
        };
        Ok(Self {
            test,
            stress_measure,
            strain,
            strains,
            stresses,
            strain_ratio,
        })
    }

    /// The columns that are read.
    pub fn columns(&self) -> impl Iterator<Item = usize> {
        let strains = self.strains.iter().flatten().map(|(column, _)| *column);
        strains.chain(self.stresses.iter().map(|(column, ..)| *column))
    }

    /// Reads the rows.
    pub fn read(&self, head: &Head) -> Faulty<TestData> {
        let table = head.table;
        let mut observations = Vec::with_capacity(table.rows.len() * self.stresses.len());
        let mut turns = Turns::default();
        for (index, (row, place)) in table.rows.iter().enumerate() {
            let [first, second] = self.strains_of(row);
            if [first, second].iter().any(|x| *x <= -1.0) {
                let message = format!("the stretch is {}", 1.0 + first.min(second));
                let hint = "stretches are greater than zero; is the column a strain?";
                return Err(head.fault(place.clone(), message, hint));
            }
            turns.add(index, first);
            for (column, factor, axis) in &self.stresses {
                let strains = if self.test == Test::Uniaxial && *axis == 1 {
                    [f64::NAN, first]
                } else {
                    [first, second]
                };
                observations.push(Observation {
                    strains,
                    axis: *axis,
                    stress: row[*column] * factor,
                });
            }
        }
        let stresses = observations.iter().map(|one| one.stress.abs());
        let largest_stress = stresses.fold(0.0, f64::max);
        check_signs(head, &observations)?;
        let widest = |axis: usize| {
            let strains = observations.iter().map(|one| one.strains[axis].abs());
            strains.fold(0.0, f64::max)
        };
        Ok(TestData {
            name: table.source.name.clone(),
            test: self.test,
            stress_measure: self.stress_measure,
            axes: self.stresses.iter().map(|(.., axis)| *axis).collect(),
            drawn_axis: usize::from(widest(1) > widest(0)),
            observations,
            largest_stress,
            rounding: self.rounding(table),
            head: head.written(),
            warnings: turns.warning(head).into_iter().collect(),
        })
    }

    /// What rounding took from strains and stresses.
    fn rounding(&self, table: &Table) -> [f64; 2] {
        let of = |column: usize, factor: f64| {
            let values: Vec<f64> = table.rows.iter().map(|(row, _)| row[column]).collect();
            factor.abs() * rounding(&values)
        };
        let strains = self.strains.iter().flatten();
        let strains = strains.map(|(column, factor)| of(*column, *factor));
        let stresses = self.stresses.iter();
        let stresses = stresses.map(|(column, factor, _)| of(*column, *factor));
        [strains.fold(0.0, f64::max), stresses.fold(0.0, f64::max)]
    }

    /// λ − 1 along both axes in a row.
    fn strains_of(&self, row: &[f64]) -> [f64; 2] {
        let strain = |axis: usize| {
            let read =
                |(column, factor): (usize, f64)| self.strain.to_nominal(row[column] * factor);
            self.strains[axis].map_or(f64::NAN, read)
        };
        let first = strain(0);
        let second = match self.test {
            Test::Uniaxial => f64::NAN,
            Test::Planar => 0.0,
            Test::Equibiaxial => first,
            Test::Biaxial => self
                .strain_ratio
                .map_or_else(|| strain(1), |ratio| ratio * first),
        };
        [first, second]
    }
}

/// Data that say nothing, or a test of compression that counts pressing as positive, are refused.
fn check_signs(head: &Head, observations: &[Observation]) -> Faulty<()> {
    let strains = || observations.iter().map(|one| one.strains[one.axis]);
    let nothing = observations.iter().all(|one| one.stress == 0.0)
        || observations
            .iter()
            .all(|one| one.strains.iter().all(|x| *x == 0.0 || x.is_nan()));
    if nothing {
        let hint = "look at the columns and their units";
        return Err(head.fault(0..0, "all strains or all stresses are zero", hint));
    }
    let compression = head.setting("test", None)?.as_deref() == Some("compression");
    if compression && strains().any(|x| x > 0.0) {
        let message = "a compression test has positive strains";
        let hint = "give strains and stresses of compression a minus sign, or stretches below 1";
        return Err(head.fault(head.place("test"), message, hint));
    }
    Ok(())
}

/// What the names of the columns say; the first two of a file without names are strain and stress.
fn roles(head: &Head) -> Vec<Role> {
    let columns = &head.table.columns;
    if columns.iter().all(|column| column.name.is_empty()) {
        let plain = [Role::strain(None, 0), Role::stress(None, 0)];
        return plain.into_iter().take(columns.len()).collect();
    }
    columns
        .iter()
        .map(|column| Role::named(&column.name))
        .collect()
}

/// Refuses columns that do not fit together: each axis has one strain and one stress, all strains and all
/// stresses have one measure.
fn check_columns(head: &Head, roles: &[Role], test: Test) -> Faulty<()> {
    let place = || head.table.columns_place.clone();
    for (kind, what) in [(Kind::Strain, "strain"), (Kind::Stress, "stress")] {
        let mut first: Option<&Role> = None;
        for (column, role) in of_kind(roles, kind) {
            let name = &head.table.columns[column].name;
            let earlier = of_kind(roles, kind).find(|(_, other)| other.axis == role.axis);
            if earlier.is_some_and(|(other, _)| other != column) {
                let message = format!(
                    "there are two columns of {what} along axis {}",
                    role.axis + 1
                );
                let hint = "leave one out, or name them with _1 and _2 for the two axes";
                return Err(head.fault(place(), message, hint));
            }
            if first.is_some_and(|first| first.measure != role.measure) {
                let message = format!("`{name}` has another measure than the column before it");
                let hint = format!("give every {what} in the same measure");
                return Err(head.fault(place(), message, &hint));
            }
            first = Some(role);
        }
    }
    let strains = of_kind(roles, Kind::Strain).count();
    if strains > 1 && test != Test::Biaxial {
        let message = format!("the strains of a {} test have one column", test.name());
        let hint = "leave the other out, or call the test biaxial";
        return Err(head.fault(place(), message, hint));
    }
    let numbered = of_kind(roles, Kind::Stress).any(|(_, role)| role.axis == 1);
    if numbered && head.setting("direction", None)?.is_some() {
        let hint = "leave the direction out";
        let message = "the columns of stress name their axes, and a direction is given too";
        return Err(head.fault(head.place("direction"), message, hint));
    }
    Ok(())
}

/// Column and factor to a ratio, or to MPa.
type Scaled = (usize, f64);

/// Column, factor to MPa and axis of a stress.
type StressColumn = (usize, f64, usize);

fn strains(head: &Head, roles: &[Role]) -> Faulty<(StrainColumn, [Option<Scaled>; 2])> {
    let Some((first, role)) = of_kind(roles, Kind::Strain).min_by_key(|(_, role)| role.axis) else {
        let names = "`stretch`, `nominal_strain` or `logarithmic_strain`";
        return Err(no_column(head, "strains", names));
    };
    let displaced = role.measure == Some(DISPLACEMENT);
    let measure = if displaced {
        StrainColumn::Strain(StrainMeasure::Nominal)
    } else {
        head.choice("strain measure", role.measure, &StrainColumn::NAMES)?
    };
    let scaled = |column: usize| -> Faulty<Scaled> {
        let named = &head.table.columns[column];
        let factor = if displaced {
            let unit = head.factor("strain unit", named, Dimension::Length)?;
            unit / head.required_quantity("length", Dimension::Length)?
        } else {
            head.factor("strain unit", named, Dimension::Ratio)?
        };
        Ok((column, factor))
    };
    let across = of_kind(roles, Kind::Strain).find(|(_, role)| role.axis == 1);
    let across = across.map(|(column, _)| scaled(column)).transpose()?;
    Ok((measure, [Some(scaled(first)?), across]))
}

fn stresses(head: &Head, roles: &[Role]) -> Faulty<(StressMeasure, Vec<StressColumn>)> {
    let Some((_, role)) = of_kind(roles, Kind::Stress).next() else {
        let names = "`nominal_stress`, `cauchy_stress` or `force`";
        return Err(no_column(head, "stresses", names));
    };
    let loaded = role.measure == Some(FORCE);
    let measure = if loaded {
        StressMeasure::Nominal
    } else {
        head.choice("stress measure", role.measure, &StressMeasure::NAMES)?
    };
    let direction = match head.setting("direction", None)?.as_deref() {
        None | Some("1") => 0,
        Some("2") => 1,
        Some(other) => {
            let message = format!("the direction {other} is not 1 or 2");
            let hint = "1 is the axis of the strain column, 2 the one across";
            return Err(head.fault(head.place("direction"), message, hint));
        }
    };
    let mut columns = Vec::new();
    for (column, role) in of_kind(roles, Kind::Stress) {
        let named = &head.table.columns[column];
        let factor = if loaded {
            let unit = head.factor("stress unit", named, Dimension::Force)?;
            unit / head.required_quantity("area", Dimension::Area)?
        } else {
            head.factor("stress unit", named, Dimension::Stress)?
        };
        columns.push((column, factor, role.axis.max(direction)));
    }
    Ok((measure, columns))
}

fn no_column(head: &Head, what: &str, names: &str) -> Box<Diagnostic> {
    let columns: Vec<_> = head.table.columns.iter().map(|one| &*one.name).collect();
    let hint = format!("name one {names}; the columns are: {}", columns.join(", "));
    let place = head.table.columns_place.clone();
    head.fault(place, format!("there is no column of {what}"), &hint)
}

/// ε₂/ε₁ of nominal strains, for a biaxial test without a second column.
fn strain_ratio(head: &Head) -> Faulty<f64> {
    const KEY: &str = "strain ratio";
    let Some(ratio) = head.setting(KEY, None)? else {
        return Err(head.missing(KEY, "0.5"));
    };
    let number = ratio.parse::<f64>().ok().filter(|ratio| ratio.is_finite());
    number.ok_or_else(|| {
        let message = format!("the strain ratio {ratio} is not a number");
        head.fault(head.place(KEY), message, "it is ε₂/ε₁ of nominal strains")
    })
}

/// Where a strain turns back: a curve of loading alone does not.
#[derive(Default)]
struct Turns {
    last: Option<f64>,
    /// Whether the strain rose at its last change.
    rising: Option<bool>,
    first: Option<usize>,
    count: usize,
}

impl Turns {
    fn add(&mut self, row: usize, strain: f64) {
        let changed = self.last.filter(|last| *last != strain);
        if let Some(last) = changed {
            let rising = strain > last;
            if self.rising.is_some_and(|before| before != rising) {
                self.first.get_or_insert(row);
                self.count += 1;
            }
            self.rising = Some(rising);
        }
        self.last = Some(strain);
    }

    fn warning(&self, head: &Head) -> Option<Diagnostic> {
        let row = self.first?;
        let times = if self.count == 1 {
            "once".to_owned()
        } else {
            format!("{} times", self.count)
        };
        let hint = "loading and unloading, or scatter, are fitted together; cut the file to the branch that you mean";
        let warning = Diagnostic::warning("", format!("the strain turns back {times}")).hint(hint);
        Some(warning.at(&head.table.source, head.table.rows[row].1.clone()))
    }
}
