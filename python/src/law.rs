//! Laws that let a computation end.

use std::fmt;
use std::sync::Arc;

use gelbench::material::PlaneState;
use gelbench::material::sheet::{Kinematics, PlaneTensor, SheetResponse};
use gelbench::material::{Code, CodeLaw};
use gelbench::material::{HyperelasticLaw, Softening, Volume};
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

    fn biaxial(&self, strains: [f64; 2]) -> [f64; 2] {
        self.law.biaxial(strains)
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

    fn in_code(&self, code: Code, bulk_modulus: f64) -> Option<CodeLaw> {
        self.law.in_code(code, bulk_modulus)
    }

    fn softening(&self) -> Option<Softening> {
        self.law.softening()
    }

    fn volume_ratio(&self, kinematics: &Kinematics) -> f64 {
        self.law.volume_ratio(kinematics)
    }

    fn thickness_stretch(&self, kinematics: &Kinematics) -> f64 {
        self.law.thickness_stretch(kinematics)
    }

    fn thickness_gradient(&self, kinematics: &Kinematics) -> PlaneTensor {
        self.law.thickness_gradient(kinematics)
    }

    fn thickness_stress(&self, kinematics: &Kinematics) -> f64 {
        self.law.thickness_stress(kinematics)
    }

    fn cauchy_stress(&self, kinematics: &Kinematics, stress: &PlaneTensor) -> [f64; 3] {
        self.law.cauchy_stress(kinematics, stress)
    }

    fn plane_state(&self) -> PlaneState {
        self.law.plane_state()
    }

    fn is_for_small_strains(&self) -> bool {
        self.law.is_for_small_strains()
    }

    fn in_plane_strain(&self) -> Option<Arc<dyn HyperelasticLaw>> {
        self.law.in_plane_strain()
    }

    fn bulk_modulus(&self) -> Option<f64> {
        self.law.bulk_modulus()
    }

    fn with_volume(self: Arc<Self>, volume: Volume) -> Option<Arc<dyn HyperelasticLaw>> {
        Arc::clone(&self.law).with_volume(volume)
    }

    fn swelling_stretch(&self) -> f64 {
        self.law.swelling_stretch()
    }

    fn statements(&self) -> Vec<(&'static str, String)> {
        self.law.statements()
    }

    fn is_objective(&self) -> bool {
        self.law.is_objective()
    }

    fn is_isotropic(&self) -> bool {
        self.law.is_isotropic()
    }

    fn shear_modulus(&self) -> f64 {
        self.law.shear_modulus()
    }

    fn youngs_modulus(&self) -> f64 {
        self.law.youngs_modulus()
    }
}
