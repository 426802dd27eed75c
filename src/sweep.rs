//! Many runs of one study with some of its keys changed.
//!
//! ```text
//! study ──────┐
//! variables ──┼─▶ Sweep ─run─▶ one Row per run ─▶ table, bands, rank correlations
//! sampling ───┘
//! ```
//!
//! A variable is a key of the study, or a parameter of the study's card written as `material.KEY`. It has a list of values, of which every
//! combination is run, or a distribution, from which points are drawn. Points come from Sobol's sequence with Owen's scrambling, are
//! random, or are given. A point u in (0, 1)ⁿ is mapped to the distributions by their inverse cumulative functions, and to the correlated
//! parameters of a fit by x = x̂ + L z, with the Cholesky factor L of their covariance and normal z.
//!
//! # References
//! I. M. Sobol', USSR Comput. Math. Math. Phys. 7, 86 (1967), doi:10.1016/0041-5553(67)90144-9;
//! A. B. Owen, in Monte Carlo and Quasi-Monte Carlo Methods, Springer 1995, doi:10.1007/978-1-4612-2552-2_19

use std::collections::{HashMap, HashSet};
use std::slice::from_ref;

use rayon::prelude::*;

use gelbench_base::error::{Diagnostic, Error};
use gelbench_studies::studies::{PreparedStudy, Progress};

mod altered;
#[cfg(feature = "pictures")]
mod folder;
mod plan;
mod points;
mod results;
mod table;
mod variable;

pub use altered::BaseStudy;
#[cfg(feature = "pictures")]
pub use folder::{Shard, Share, SweepFolder, free_folder, join};
pub use plan::{FittedParameters, Method, Run, Sampling};
pub use points::Points;
pub use results::{Statistics, blocks, cautions, figures, json, statistics};
pub use table::{Row, names, read, write};
pub use variable::{Setting, Values, Variable, headed};

/// A study and how it is varied.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The study.
    pub study: BaseStudy,
    /// The variables.
    pub variables: Vec<Variable>,
    /// Points chosen by another program, in place of drawn ones.
    pub points: Option<Points>,
    /// Fitted parameters that are drawn with their correlation.
    pub fitted: Option<FittedParameters>,
    /// How points are drawn.
    pub sampling: Sampling,
}

impl Sweep {
    /// The varied keys.
    pub fn keys(&self) -> Vec<String> {
        let fitted = self.fitted.iter().flat_map(FittedParameters::keys);
        let varied = self.variables.iter().map(|variable| variable.key.clone());
        let points = self.points.iter().flat_map(Points::keys);
        varied.chain(points).chain(fitted).collect()
    }

    /// All runs.
    ///
    /// # Errors
    /// [`Error::Input`] where no key is varied, a key is varied twice, distributions have no number of samples, or there are more than a million
    /// runs.
    pub fn runs(&self) -> Result<Vec<Run>, Error> {
        plan::check_keys(&self.keys())?;
        let rows = plan::rows(
            &self.variables,
            self.points.as_ref(),
            self.fitted.as_ref(),
            self.sampling,
        );
        let rows = rows?.into_iter().enumerate();
        let run = |(index, settings)| Run {
            number: index + 1,
            settings,
        };
        Ok(rows.map(run).collect())
    }

    /// Reads the files that the values name, such as cards, before a run needs them. A file that cannot be read is reported by its run.
    pub fn read_files(&self) {
        let read = |key: &String, value: &Setting| {
            if value.value().is_none() {
                drop(self.study.with(from_ref(key), from_ref(value)));
            }
        };
        for variable in &self.variables {
            if let Values::Listed(values) = &variable.values {
                values.iter().for_each(|value| read(&variable.key, value));
            }
        }
        if let Some(points) = &self.points {
            for (position, key) in points.keys().enumerate() {
                let texts = points.rows().iter().map(|row| &row[position]);
                let texts = texts.filter(|value| value.value().is_none());
                let mut known = HashSet::new();
                let new = texts.filter(|value| known.insert(value.plain_text()));
                new.for_each(|value| read(&key, value));
            }
        }
    }

    /// Computes the runs that are not yet done, several in parallel; each is handed to `keep` when it ends. `attend`
    /// is called between the steps of each run, and may unwind.
    ///
    /// # Errors
    /// [`Error::Input`] for a run whose study has faults, with its number, unless it is one of few that were drawn;
    /// errors of `keep`. A model without a solution is not an error: it is recorded in the run's row.
    pub fn compute(
        &self,
        runs: &[Run],
        mut done: HashMap<usize, Row>,
        keep: &(dyn Fn(&Row) -> Result<(), Error> + Sync),
        attend: &(dyn Fn() + Sync),
    ) -> Result<Vec<Row>, Error> {
        let done: Vec<(&Run, Option<Row>)> = runs
            .iter()
            .map(|run| (run, done.remove(&run.number)))
            .collect();
        self.check(
            done.iter()
                .filter(|(_, row)| row.is_none())
                .map(|(run, _)| *run),
        )?;
        let row = |(run, done): (&Run, Option<Row>)| match done {
            Some(row) => Ok(row),
            None => {
                let row = self.row(run, attend)?;
                keep(&row)?;
                Ok(row)
            }
        };
        done.into_par_iter().map(row).collect()
    }

    /// Reports faults before anything is computed, the same ones each time. In a complete sweep a few drawn runs may
    /// have inadmissible values, such as parameters that no law admits: such a run is reported in its row.
    fn check<'a>(&self, runs: impl Iterator<Item = &'a Run>) -> Result<(), Error> {
        /// One in so many drawn runs may be inadmissible.
        const FEW: usize = 5;
        let wanted: Vec<&Run> = runs.collect();
        let fault_of = |run: &Run| self.ready(run).err();
        let Some(fault) = wanted.par_iter().find_map_first(|run| fault_of(run)) else {
            return Ok(());
        };
        if !self.is_drawn() {
            return Err(fault);
        }
        // Runs that differ only in drawn values are adjacent.
        let samples = self.sampling.samples.unwrap_or(1);
        let all = self.runs()?;
        let too_many = all.par_chunks(samples).find_map_first(|drawn| {
            let faults: Vec<Error> = drawn.iter().filter_map(fault_of).collect();
            let few = FEW * faults.len() <= drawn.len();
            faults.into_iter().next().filter(|_| !few)
        });
        too_many.map_or(Ok(()), Err)
    }

    /// Whether values are drawn from distributions without bounds.
    fn is_drawn(&self) -> bool {
        let mut variables = self.variables.iter();
        self.fitted.is_some()
            || variables.any(|variable| matches!(variable.values, Values::Normal(..)))
    }

    /// Reads the study of a run.
    fn ready(&self, run: &Run) -> Result<PreparedStudy, Error> {
        // Line numbers of a run's study differ from those of the file.
        let of_run = |fault: Diagnostic| Diagnostic {
            position: None,
            ..fault.prefixed(format_args!("run {}", run.number))
        };
        let study = self.study.with(&self.keys(), &run.settings);
        study.map_err(|error| error.map_faults(of_run))
    }

    fn row(&self, run: &Run, attend: &dyn Fn()) -> Result<Row, Error> {
        attend();
        let study = match self.ready(run) {
            Err(Error::Input(faults)) if self.is_drawn() => {
                let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
                return Ok(Row::failed(run, faults.join("; "), Vec::new()));
            }
            read => read?,
        };
        let warnings = study.warnings.iter().map(ToString::to_string).collect();
        match study.compute(Progress::to(&|_| attend())) {
            Ok(results) => Ok(Row::of(run, &results)),
            Err(fault @ Error::Solve { .. }) => Ok(Row::failed(run, fault.to_string(), warnings)),
            Err(other) => Err(other),
        }
    }
}

#[cfg(test)]
mod tests;
