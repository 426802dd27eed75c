//! The values of a column in each of the measures that it may have.

use super::columns::{Scaled, area, ratio, unit};
use super::roles::{DISPLACEMENT, FORCE, Kind, Naming, Role, of_kind};
use super::test_data::StrainColumn;
use crate::document::Head;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::units::{self, Dimension};

/// A column whose name says what it may be.
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

/// The columns of a table as they may be read beside those that are chosen.
pub struct Readings<'a> {
    pub head: &'a Head<'a>,
    pub roles: &'a [Role],
}

impl Readings<'_> {
    /// Whether two columns say the same in one of the measures that they may have.
    pub fn agree(&self, first: &Named, other: &Named) -> bool {
        /// Differences below this share of the largest value are rounding.
        const ROUNDING: f64 = 5e-3;
        let readings = [first, other].map(|own| self.readings(own));
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

    /// The values of a column in each of the measures that it may have: λ − 1, nominal stresses in MPa, or times in s from the first one on;
    /// none where units or the dimensions of the specimen are not stated.
    fn readings(&self, own: &Named) -> Vec<Vec<f64>> {
        match own.role.kind {
            Kind::Strain => self.strains(own),
            Kind::Stress => self.stresses(own),
            Kind::Time | Kind::Other => {
                let rise = |values: Vec<f64>| {
                    let first = values.first().copied().unwrap_or(0.0);
                    values.iter().map(|value| value - first).collect()
                };
                let factor = self.factor(own, Dimension::Time);
                let scaled = factor.map(|factor| values(self.head, (own.column, factor)));
                scaled.map(rise).into_iter().collect()
            }
        }
    }

    fn strains(&self, own: &Named) -> Vec<Vec<f64>> {
        if own.role.measure == Some(DISPLACEMENT) {
            let length = self.head.quantity("length", Dimension::Length);
            let factor = self.factor(own, Dimension::Length);
            let strains = factor.zip(length.ok().flatten());
            let strains =
                strains.map(|(unit, length)| values(self.head, (own.column, unit / length)));
            return strains.into_iter().collect();
        }
        let measures: Vec<StrainColumn> = match own.role.measure {
            None => vec![
                StrainColumn::Strain(StrainMeasure::Nominal),
                StrainColumn::Strain(StrainMeasure::Logarithmic),
            ],
            Some(name) => {
                let known = StrainColumn::NAMES.iter();
                let known = known.filter(|(known, _)| *known == name);
                known.map(|(_, measure)| *measure).collect()
            }
        };
        let read = |measure: StrainColumn| {
            let factor = ratio(self.head, own.column, measure).ok()?;
            let values = values(self.head, (own.column, factor)).into_iter();
            Some(values.map(|value| measure.to_nominal(value)).collect())
        };
        measures.into_iter().filter_map(read).collect()
    }

    fn stresses(&self, own: &Named) -> Vec<Vec<f64>> {
        if own.role.measure == Some(FORCE) {
            let factor = self.factor(own, Dimension::Force);
            let stresses = factor.zip(area(self.head).ok());
            let stresses =
                stresses.map(|(unit, area)| values(self.head, (own.column, unit / area)));
            return stresses.into_iter().collect();
        }
        let Some(factor) = self.factor(own, Dimension::Stress) else {
            return Vec::new();
        };
        let values = values(self.head, (own.column, factor));
        let axis = own.role.axis();
        let strains = of_kind(self.roles, Kind::Strain).find(|(_, role)| role.axis() == axis);
        let strains = strains.and_then(|(column, role)| {
            let named = Named {
                column,
                role: *role,
                naming: Naming::Usual,
            };
            self.strains(&named).into_iter().next()
        });
        let as_cauchy = strains.map(|strains| {
            let pairs = values.iter().zip(strains);
            pairs
                .map(|(stress, x)| StressMeasure::Cauchy.to_nominal(*stress, x))
                .collect()
        });
        match own.role.measure {
            Some("nominal") => vec![values],
            Some(_) => as_cauchy.into_iter().collect(),
            None => [values].into_iter().chain(as_cauchy).collect(),
        }
    }

    /// The factor from a column's unit, or from the stated one, to the internal unit.
    fn factor(&self, own: &Named, dimension: Dimension) -> Option<f64> {
        let column = &self.head.table.columns[own.column];
        let unit = unit(self.head, column, own.role.kind)?;
        units::factor(&unit, dimension).ok()
    }
}
