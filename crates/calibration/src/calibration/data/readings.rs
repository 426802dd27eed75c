//! The values of a column in each of the measures that it may have.

use super::columns::{Scaled, strain_factor, stress_factor};
use super::roles::{DISPLACEMENT, FORCE, Kind, Naming, Role, of_kind};
use super::strain_column::StrainColumn;
use crate::document::Head;
use crate::material::parameters::StrainMeasure;
use crate::units::Dimension;

/// A column whose name indicates its role.
#[derive(Clone, Copy)]
pub struct Named {
    pub column: usize,
    pub role: Role,
    pub naming: Naming,
}

/// The values of a column times a factor.
pub fn values(head: &Head, (column, factor): Scaled) -> Vec<f64> {
    let rows = head.table.rows.iter();
    rows.map(|(row, _)| row[column] * factor).collect()
}

/// The possible readings of the columns of a table, given the columns that are chosen already.
pub struct Readings<'a> {
    pub head: &'a Head<'a>,
    pub roles: &'a [Role],
}

impl Readings<'_> {
    /// Whether two columns have the same values in one of their possible measures.
    pub fn agree(&self, first: &Named, other: &Named) -> bool {
        /// Differences below this share of the largest value are rounding.
        const ROUNDING: f64 = 5e-3;
        let readings = [first, other].map(|candidate| self.readings(candidate));
        let is_same = |a: &Vec<f64>, b: &Vec<f64>| {
            let pairs = || a.iter().zip(b).filter(|(a, b)| (*a - *b).is_finite());
            let far = pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let largest = pairs().map(|(a, _)| a.abs()).fold(0.0, f64::max);
            pairs().next().is_some() && far <= ROUNDING * largest
        };
        let [of_first, of_other] = &readings;
        let mut pairs = of_first
            .iter()
            .flat_map(|a| of_other.iter().map(move |b| (a, b)));
        pairs.any(|(a, b)| is_same(a, b))
    }

    /// Whether a column can be read: its unit and the dimensions of the specimen that it needs are stated.
    pub fn are_possible(&self, candidate: &Named) -> bool {
        !self.readings(candidate).is_empty()
    }

    /// Whether the measure of a column is known: by its name, its unit, or a statement.
    pub fn is_measured(&self, candidate: &Named) -> bool {
        let key = format!("{} measure", candidate.role.kind.name());
        candidate.role.measure.is_some() || matches!(self.head.setting(&key, None), Ok(Some(_)))
    }

    /// The values of a column in each of the measures that it may have: λ − 1, nominal stresses in MPa, or times in s from the first one on;
    /// none where units or the dimensions of the specimen are not stated.
    fn readings(&self, candidate: &Named) -> Vec<Vec<f64>> {
        match candidate.role.kind {
            Kind::Strain => self.strains((candidate.column, &candidate.role)),
            Kind::Stress => self.stresses(candidate),
            Kind::Time | Kind::Size | Kind::Other => {
                let column = &self.head.table.columns[candidate.column];
                let Ok(factor) = self.head.factor("time unit", column, Dimension::Time) else {
                    return Vec::new();
                };
                let times = values(self.head, (candidate.column, factor));
                let first = times.first().copied().unwrap_or(0.0);
                vec![times.iter().map(|time| time - first).collect()]
            }
        }
    }

    fn strains(&self, column: (usize, &Role)) -> Vec<Vec<f64>> {
        let measure = column.1.measure;
        let known = StrainColumn::NAMES.iter().filter(|(name, as_read)| {
            if measure == Some(DISPLACEMENT) {
                *as_read == StrainColumn::Strain(StrainMeasure::Nominal)
            } else {
                measure.map_or(*as_read != StrainColumn::Stretch, |stated| stated == *name)
            }
        });
        let read = |(_, measure): &(&str, StrainColumn)| {
            let factor = strain_factor(self.head, self.roles, column, *measure).ok()?;
            let values = values(self.head, (column.0, factor)).into_iter();
            Some(values.map(|value| measure.to_nominal(value)).collect())
        };
        known.filter_map(read).collect()
    }

    fn stresses(&self, candidate: &Named) -> Vec<Vec<f64>> {
        let Ok(factor) = stress_factor(self.head, self.roles, (candidate.column, &candidate.role))
        else {
            return Vec::new();
        };
        let values = values(self.head, (candidate.column, factor));
        let measure = candidate.role.measure;
        if measure == Some(FORCE) || measure == Some("nominal") {
            return vec![values];
        }
        let axis = candidate.role.axis();
        let strains = of_kind(self.roles, Kind::Strain).find(|(_, role)| role.axis() == axis);
        let Some(strains) = strains.and_then(|column| self.strains(column).into_iter().next())
        else {
            return vec![values];
        };
        let times = |power: i32| -> Vec<f64> {
            let pairs = values.iter().zip(&strains);
            pairs
                .map(|(stress, x)| stress * (1.0 + x).powi(power))
                .collect()
        };
        match measure {
            Some("cauchy") => vec![times(-1)],
            Some(_) => vec![times(1)],
            None => vec![times(0), times(-1), times(1)],
        }
    }
}
