//! A law that softens, at a point and along a strip.

use std::sync::Arc;

use super::code::{Code, CodeLaw};
use super::law::{HyperelasticLaw, TensionResponse};
use super::sheet::{Kinematics, PlaneState, PlaneTensor, SheetResponse};
use super::softening::Softening;
use crate::error::Error;
use crate::forwarded;

/// A softening law in which all points have had the same largest energy, as in a load step that does not exceed it.
#[derive(Clone, Debug)]
pub struct SoftenedLaw {
    /// The law of the material that was never loaded.
    pub virgin: Arc<dyn HyperelasticLaw>,
    /// How it softens.
    pub softening: Softening,
    /// Wₘ in mJ/mm³.
    pub largest_energy: f64,
}

impl SoftenedLaw {
    /// A material that was never loaded.
    pub fn unloaded(virgin: Arc<dyn HyperelasticLaw>, softening: Softening) -> Self {
        Self {
            virgin,
            softening,
            largest_energy: 0.0,
        }
    }
}

impl HyperelasticLaw for SoftenedLaw {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        let virgin = self.virgin.stress(kinematics);
        self.softening.stress(virgin, self.largest_energy)
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let virgin = self.virgin.response(kinematics);
        self.softening.response(virgin, self.largest_energy)
    }

    fn tension(&self, direction: [f64; 2], strain: f64) -> TensionResponse {
        let virgin = self.virgin.tension(direction, strain);
        self.softening.tension(virgin, self.largest_energy)
    }

    fn thickness_stress(&self, kinematics: &Kinematics) -> f64 {
        let (energy, _) = self.virgin.stress(kinematics);
        let [factor, _] = self.softening.factor(energy, self.largest_energy);
        factor * self.virgin.thickness_stress(kinematics)
    }

    fn in_plane_strain(&self) -> Option<Arc<dyn HyperelasticLaw>> {
        Some(Arc::new(Self {
            virgin: self.virgin.in_plane_strain()?,
            ..self.clone()
        }))
    }

    /// The law of the first loading: the softening is [`HyperelasticLaw::softening`]'s.
    fn in_code(&self, code: Code, bulk_modulus: f64) -> Option<CodeLaw> {
        self.virgin.in_code(code, bulk_modulus)
    }

    fn softening(&self) -> Option<Softening> {
        Some(self.softening)
    }

    fn statements(&self) -> Vec<(&'static str, String)> {
        let Softening { r, m, beta } = self.softening;
        let statement =
            format!("r = {r}, m = {m} MPa, β = {beta} (Ogden and Roxburgh, of the whole energy)");
        let mut all = self.virgin.statements();
        all.push(("softening", statement));
        all
    }

    forwarded! { virgin:
        fn volume_ratio(kinematics: &Kinematics) -> f64;
        fn thickness_stretch(kinematics: &Kinematics) -> f64;
        fn thickness_gradient(kinematics: &Kinematics) -> PlaneTensor;
        fn cauchy_stress(kinematics: &Kinematics, stress: &PlaneTensor) -> [f64; 3];
        fn plane_state() -> PlaneState;
        fn is_for_small_strains() -> bool;
        fn bulk_modulus() -> Option<f64>;
        fn swelling_stretch() -> f64;
        fn is_objective() -> bool;
        fn is_isotropic() -> bool;
    }
}

impl Softening {
    /// Energy, stress and slope of a strip with free edges; softening leaves them free.
    pub fn tension(&self, virgin: TensionResponse, most: f64) -> TensionResponse {
        let [factor, slope] = self.factor(virgin.energy, most);
        let stress = virgin.nominal_stress;
        TensionResponse {
            energy: self.energy(virgin.energy, most),
            nominal_stress: factor * stress,
            slope: factor * virgin.slope + slope * stress * stress,
        }
    }
}

/// Checks that a material does not soften, for methods without memory of the largest load.
///
/// # Errors
/// [`Error::Input`] where it does.
pub fn check_memory(law: &dyn HyperelasticLaw, what: &str) -> Result<(), Error> {
    match law.softening() {
        None => Ok(()),
        Some(_) => {
            let message =
                format!("the material softens, and {what} has no memory of its largest load");
            Err(Error::input(message, NO_SOFTENING_ADVICE))
        }
    }
}

/// A law at a state that follows other states of its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressAfter {
    /// Ψ, the work that was done on the point, in mJ/mm³.
    pub energy: f64,
    /// First Piola–Kirchhoff stress in MPa.
    pub stress: PlaneTensor,
    /// η; 1 for a law without softening.
    pub factor: f64,
    /// The part of Ψ that is dissipated, in mJ/mm³; zero without softening.
    pub dissipated: f64,
}

impl StressAfter {
    /// The response softened by the largest of the energies before; without softening the law's own.
    pub fn new(
        law: &dyn HyperelasticLaw,
        now: &Kinematics,
        past: impl IntoIterator<Item = PlaneTensor>,
    ) -> Self {
        let virgin = law.stress(now);
        let Some(softening) = law.softening() else {
            return Self {
                energy: virgin.0,
                stress: virgin.1,
                factor: 1.0,
                dissipated: 0.0,
            };
        };
        let states = past.into_iter().filter_map(|h| Kinematics::new(&h).ok());
        let most = states.map(|state| law.stress(&state).0).fold(0.0, f64::max);
        let (energy, stress) = softening.stress(virgin, most);
        let [factor, _] = softening.factor(virgin.0, most);
        Self {
            energy,
            stress,
            factor,
            dissipated: softening.dissipated(most.max(virgin.0)),
        }
    }
}

/// Advice where a material must not soften.
pub const NO_SOFTENING_ADVICE: &str =
    "leave out the card's `[softening]`: its law then describes the first loading";

#[cfg(test)]
mod tests;
