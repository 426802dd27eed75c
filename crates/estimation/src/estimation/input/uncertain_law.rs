//! A law with the uncertainty that its card records.

use nalgebra::DMatrix;

use super::regressed_law::{Neighbours, RegressedLaw};
use crate::material::Card;

/// Parameters of a law with their covariance.
#[derive(Clone, Debug)]
pub struct UncertainLaw {
    law: RegressedLaw,
    covariance: DMatrix<f64>,
}

impl UncertainLaw {
    /// That of a card; `None` where it records none of its parameters' uncertainty, or its law is not defined by them.
    pub fn of_card(card: &Card) -> Option<Self> {
        let recorded = card.fit.as_ref()?.uncertainty.as_ref()?;
        let keys: Vec<&str> = recorded.keys.iter().map(String::as_str).collect();
        Some(Self {
            law: RegressedLaw::of_card(card, &keys).ok()?,
            covariance: recorded.covariance.clone(),
        })
    }

    /// The covariance of its parameters in internal units.
    pub(in crate::estimation) fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// The laws about that of the card, a pair for each parameter.
    pub(in crate::estimation) fn neighbours(&self) -> Vec<Neighbours> {
        self.law.neighbours(&self.law.start())
    }
}
