//! Which of the edges that nobody names are free: the data say it.

use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use super::edge_motion::EdgeCondition;
use super::search::{Found, Search};
use super::{Edge, Task};
use crate::error::Error;

/// Probability of the misfit under which a free edge is refused.
const LEVEL: f64 = 0.01;

/// Searches with the edges as they are, then with those to be tested free one after the other, the longest first.
///
/// # Errors
/// As the search with the edges as they are.
pub fn search<'a>(
    task: &Task<'a>,
    mut edges: Vec<Edge<'a>>,
) -> Result<(Found<'a>, Vec<Edge<'a>>), Error> {
    let mut found = Search::new(task, &edges)?.run()?;
    let mut open: Vec<usize> = (0..edges.len())
        .filter(|edge| edges[*edge].tested)
        .collect();
    open.sort_by(|a, b| {
        edges[*b]
            .segment
            .length()
            .total_cmp(&edges[*a].segment.length())
    });
    for index in open {
        let mut freed = edges.clone();
        freed[index].condition = EdgeCondition::Free;
        if freed
            .iter()
            .all(|edge| edge.condition == EdgeCondition::Free)
        {
            break;
        }
        // Where no equilibrium with the free edge is found, it is not free.
        let trial = Search::new(task, &freed).and_then(Search::run);
        let probability = trial
            .as_ref()
            .map_or(0.0, |trial| probability(&found, trial));
        edges[index].probability = Some(probability);
        if let (Ok(trial), true) = (trial, probability >= LEVEL) {
            edges[index].condition = EdgeCondition::Free;
            found = trial;
        }
    }
    Ok((found, edges))
}

/// How probable it is that the misfit grows so much by noise, when an edge that is free is taken as such.
fn probability(loaded: &Found, free: &Found) -> f64 {
    let count = loaded.fit.residual.len() as f64;
    let more = (loaded.fit.effective - free.fit.effective).max(1.0);
    let rest = (count - loaded.fit.effective).max(1.0);
    let (before, after) = (loaded.misfit(loaded), free.misfit(loaded));
    let ratio = (after - before).max(0.0) / more / (before / rest).max(f64::MIN_POSITIVE);
    FisherSnedecor::new(more, rest).map_or(0.0, |law| law.sf(ratio))
}

impl Found<'_> {
    /// Σ w ω r² with the trust ω of another search.
    fn misfit(&self, other: &Found) -> f64 {
        let residual = self.fit.residual.as_slice().chunks_exact(2);
        let weights = self
            .search
            .task
            .observations
            .weights
            .iter()
            .zip(&other.trade.trust);
        residual
            .zip(weights)
            .map(|(r, (weight, trust))| weight * trust * (r[0] * r[0] + r[1] * r[1]))
            .sum()
    }
}
