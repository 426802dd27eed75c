//! A plate corrected with a part of what is known at its boundary: what T decides.

use gelbench::corrector::DifferenceScheme;
use gelbench::corrector::plate::PlateCorrector;
use gelbench::error::Error;

use super::bodies::Bodies;
use crate::logic::scene::{Grip, Known, Model};

impl Bodies {
    /// The field nearest to that of the springs with equilibrium inside and what is known at the boundary.
    ///
    /// # Errors
    /// [`Error::Input`] where the sheet is no plate, or its grip does more than stretch it; [`Error::Solve`] when no
    /// field was found.
    pub fn partly_known(&mut self, grip: Grip, known: Known) -> Result<Vec<f64>, Error> {
        let stretched = grip.displacement[1] == 0.0 && grip.angle == 0.0;
        let plate = self.plate().filter(|_| stretched).cloned().ok_or_else(|| {
            Error::input(
                "conditions can be left out only for plates that are only stretched, without shear or rotation",
                "use a plate with a straight grip, or give the corrector all conditions",
            )
        })?;
        let sheet = self.sheet.clone();
        let springs = self.body(Model::Springs)?;
        springs.follow(&sheet, grip, true)?;
        let springs = springs.displacement.clone();
        let scheme = DifferenceScheme::default();
        let corrector = PlateCorrector::new(&plate, &self.lattice, scheme, Default::default());
        let stretch = grip.displacement[0] / sheet.length;
        let corrected = corrector.correct(&springs, stretch, known)?;
        Ok(corrected.state.displacement)
    }
}

#[cfg(test)]
mod tests {
    use crate::logic::background::Worker;
    use crate::logic::deviations::Deviation;
    use crate::logic::engine::{Engine, Task};
    use crate::logic::scene::{Known, Model, Scene};

    fn small(known: Known) -> Scene {
        let mut scene = Scene {
            cells: [24, 8],
            ..Scene::default()
        };
        scene.look.known = known;
        scene
    }

    fn departure(scene: &Scene, model: Model) -> f64 {
        let mut engine = Engine::default();
        let mut solved = |model| engine.answer(&Task::settled(scene, model)).result.unwrap();
        let (solution, elements) = (solved(model), solved(Model::Elements));
        let lattice = crate::logic::engine::meshes(scene).unwrap()[0].clone();
        let deviation = Deviation::of(scene, &lattice, &solution, &elements);
        deviation.unwrap().departure
    }

    #[test]
    fn what_is_known_of_the_boundary_decides_and_a_corrector_that_knows_all_is_the_usual_one() {
        let all = Known::ALL;
        let unfree = Known {
            free_edges: false,
            ..all
        };
        let springs = departure(&small(all), Model::Springs);
        let corrected = departure(&small(all), Model::Corrected);
        let without = departure(&small(unfree), Model::Corrected);
        assert!(
            corrected < 0.1 * springs && without > 0.5 * springs,
            "springs {springs} %, corrected {corrected} %, without free edges {without} %"
        );
    }

    #[test]
    fn what_cannot_be_left_out_is_told() {
        let mut scene = small(Known {
            grips: true,
            free_edges: false,
        });
        scene.grip.displacement[1] = 2.0;
        let task = Task::settled(&scene, Model::Corrected);
        let fault = Engine::default().answer(&task).result.unwrap_err();
        assert!(fault.message.contains("only stretched"), "{fault:?}");
    }
}
