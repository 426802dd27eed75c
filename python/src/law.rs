//! Laws at whose evaluation a computation can be stopped.

use std::fmt;
use std::sync::Arc;

use gelbench::material::PlaneState;
use gelbench::material::sheet::{Kinematics, PlaneTensor, SheetResponse};
use gelbench::material::{Code, CodeLaw};
use gelbench::material::{HyperelasticLaw, Softening, Volume};
use gelbench_mechanics::forwarded;
use gelbench_mechanics::material::law::TensionResponse;
use gelbench_mechanics::material::sheet::COMPONENTS;

use crate::running::Watch;

/// A law as it is, which ends the computation that asks it if that is to end.
pub struct Watched {
    law: Arc<dyn HyperelasticLaw>,
    watch: Arc<Watch>,
}

impl Watched {
    /// A law under a watch.
    pub fn law(law: &Arc<dyn HyperelasticLaw>, watch: &Arc<Watch>) -> Arc<dyn HyperelasticLaw> {
        Arc::new(Self {
            law: Arc::clone(law),
            watch: Arc::clone(watch),
        })
    }
}

impl fmt::Debug for Watched {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.law.fmt(formatter)
    }
}

impl HyperelasticLaw for Watched {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        self.watch.check();
        self.law.stress(kinematics)
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        self.watch.check();
        self.law.response(kinematics)
    }

    fn tension(&self, direction: [f64; 2], strain: f64) -> TensionResponse {
        self.watch.check();
        self.law.tension(direction, strain)
    }

    fn stresses(&self, gradients: [&[f64]; 4], stresses: [&mut [f64]; 4]) -> bool {
        self.watch.check();
        self.law.stresses(gradients, stresses)
    }

    fn responses(
        &self,
        gradients: [&[f64]; 4],
        responses: [&mut [f64]; COMPONENTS],
        tangents: bool,
    ) -> bool {
        self.watch.check();
        self.law.responses(gradients, responses, tangents)
    }

    fn with_volume(self: Arc<Self>, volume: Volume) -> Option<Arc<dyn HyperelasticLaw>> {
        Arc::clone(&self.law).with_volume(volume)
    }

    forwarded! { law:
        fn biaxial(strains: [f64; 2]) -> [f64; 2];
        fn in_code(code: Code, bulk_modulus: f64) -> Option<CodeLaw>;
        fn softening() -> Option<Softening>;
        fn volume_ratio(kinematics: &Kinematics) -> f64;
        fn thickness_stretch(kinematics: &Kinematics) -> f64;
        fn thickness_gradient(kinematics: &Kinematics) -> PlaneTensor;
        fn thickness_stress(kinematics: &Kinematics) -> f64;
        fn cauchy_stress(kinematics: &Kinematics, stress: &PlaneTensor) -> [f64; 3];
        fn plane_state() -> PlaneState;
        fn is_for_small_strains() -> bool;
        fn in_plane_strain() -> Option<Arc<dyn HyperelasticLaw>>;
        fn bulk_modulus() -> Option<f64>;
        fn swelling_stretch() -> f64;
        fn statements() -> Vec<(&'static str, String)>;
        fn is_objective() -> bool;
        fn is_isotropic() -> bool;
        fn shear_modulus() -> f64;
        fn youngs_modulus() -> f64;
    }
}
