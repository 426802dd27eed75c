//! The three models of a sheet on their meshes, each with the state that it is in.

use std::path::Path;
use std::sync::Arc;

use gelbench::budget::Budget;
use gelbench::corrector::DifferenceScheme;
use gelbench::error::Error;
use gelbench::kinds;
use gelbench::mass_spring::{LatticeSettings, MassSpring};
use gelbench::material::HyperelasticLaw;
use gelbench::mesh::{Mesh, Side};
use gelbench::problem::{BoundaryProblem, ClampedPlate, Model as Problem, Support};
use gelbench_mechanics::material::softened_law::check_memory;
use gelbench_mechanics::problem::sheet_energy::SheetEnergy;
use gelbench_mechanics::solve::{Assembly, Remembering};
use gelbench_report::results::Finding;
use gelbench_studies::studies::findings_of_state;
use gelbench_studies::studies::specimen::{self, Along, Specimen};

use super::path;
use super::plate::Quick;
use crate::logic::scene::{Grip, Model, Outline, Scene};

/// A card that every study can name; the scene's own takes its place.
const ANY_CARD: &str = "neo-hooke";

/// What all models of a scene share.
#[derive(Clone)]
pub struct Sheet {
    /// The material.
    pub law: Arc<dyn HyperelasticLaw>,
    /// Thickness in mm.
    pub thickness: f64,
    /// Length between the grips in mm.
    pub length: f64,
    /// Height of the axis in mm.
    pub axis: f64,
}

/// The models of a scene.
pub struct Bodies {
    /// What they share.
    pub sheet: Sheet,
    /// The nodes of springs and corrected springs.
    pub lattice: Mesh,
    plate: Option<(ClampedPlate, [usize; 2])>,
    specimen: Specimen,
    elements: Mesh,
    built: [Option<Body>; 3],
}

/// The energy of a model.
pub(super) enum Energy {
    Springs(Box<MassSpring>),
    Sheet(Box<SheetEnergy>),
}

/// A model on its mesh in its last state.
pub struct Body {
    /// Its mesh.
    pub mesh: Mesh,
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// Where the grip was in the last state.
    pub grip: Grip,
    pub(super) energy: Energy,
    quick: Option<Quick>,
}

/// The meshes of a scene: of the lattice and of the finite elements.
///
/// # Errors
/// [`Error::Input`] with every fault of its measures.
pub fn meshes(scene: &Scene) -> Result<[Mesh; 2], Error> {
    Ok(meshes_of(&specimen(scene)?))
}

/// The specimen that a scene is, of any card.
fn specimen(scene: &Scene) -> Result<Specimen, Error> {
    let file = Path::new("scene.toml");
    // Any stretch is as good as another: meshes do not depend on it.
    let grip = Grip {
        displacement: [0.1 * scene.size[0], 0.0],
        angle: 0.0,
    };
    let text = scene.study_of(ANY_CARD, grip);
    Ok(kinds::read_sheet(file, &text, Budget::USUAL)?.content)
}

fn meshes_of(Specimen { outline, .. }: &Specimen) -> [Mesh; 2] {
    let elements = match outline {
        specimen::Outline::Grid(_) => outline.finest_mesh(),
        // Quadratic cells as many as the lattice has: twice as fine as its equations.
        _ => outline.reference_mesh(1),
    };
    [outline.lattice(), elements]
}

/// The last scene with its bodies, which are built again for a scene with another sheet.
#[derive(Default)]
pub struct LastBodies(Option<(Scene, Bodies)>);

impl LastBodies {
    /// Those of a scene.
    ///
    /// # Errors
    /// As [`Bodies::of`].
    pub fn of(&mut self, scene: &Scene) -> Result<&mut Bodies, Error> {
        let known = self.0.as_ref();
        if !known.is_some_and(|(known, _)| known.same_sheet(scene)) {
            // The memory of the former bodies is free while the next ones are built.
            self.0 = None;
            self.0 = Some((scene.clone(), Bodies::of(scene)?));
        }
        let (_, bodies) = self.0.as_mut().expect("bodies were made");
        Ok(bodies)
    }
}

impl Bodies {
    /// Prepares a scene.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault of its measures and of its card.
    pub fn of(scene: &Scene) -> Result<Self, Error> {
        let specimen = specimen(scene)?;
        let [lattice, elements] = meshes_of(&specimen);
        let card = scene.card.read()?;
        check_memory(&*card.law, "the workbench")?;
        let sheet = Sheet {
            law: Arc::clone(&card.law),
            thickness: scene.thickness,
            length: scene.size[0],
            axis: scene.axis(),
        };
        let plate = || ClampedPlate {
            size: scene.size,
            thickness: scene.thickness,
            law: Arc::clone(&sheet.law),
            stretches: Vec::new(),
        };
        let plate = (scene.outline == Outline::Plate).then(|| (plate(), scene.cells));
        Ok(Self {
            sheet,
            lattice,
            plate,
            specimen: specimen.with_card(card),
            elements,
            built: [None, None, None],
        })
    }

    /// A model, made when it is first asked for.
    ///
    /// # Errors
    /// [`Error::Solve`] where the corrector does not begin.
    pub fn body(&mut self, model: Model) -> Result<&mut Body, Error> {
        let index = model as usize;
        if self.built[index].is_none() {
            self.built[index] = Some(self.make(model)?);
        }
        Ok(self.built[index].as_mut().expect("a body was made"))
    }

    /// The plate, where the sheet is one.
    pub fn plate(&self) -> Option<&ClampedPlate> {
        self.plate.as_ref().map(|(plate, _)| plate)
    }

    /// A model that was made.
    pub fn built(&self, model: Model) -> &Body {
        self.built[model as usize]
            .as_ref()
            .expect("a body was made")
    }

    /// What the command would warn of in the last state of the finite elements: the range of the card, compression.
    pub fn warnings(&self) -> Vec<Finding> {
        let body = self.built(Model::Elements);
        let at = match self.specimen.along {
            Along::Stretch => body.grip.displacement[0] / self.sheet.length,
            Along::LoadFactor => 1.0,
        };
        let state = (&body.mesh, &body.displacement[..]);
        findings_of_state(&self.specimen, state, at)
    }

    fn make(&self, model: Model) -> Result<Body, Error> {
        let Sheet { law, thickness, .. } = &self.sheet;
        let finite_elements = |mesh: Mesh| {
            let energy = SheetEnergy::of_mesh(Arc::clone(law), &mesh, *thickness);
            Body::new(mesh, Energy::Sheet(Box::new(energy)))
        };
        Ok(match (model, &self.plate) {
            (Model::Elements, _) => finite_elements(self.elements.clone()),
            (Model::Springs, plate) => {
                let springs = match plate {
                    Some((plate, cells)) => {
                        MassSpring::new(plate, *cells, LatticeSettings::default())
                    }
                    None => MassSpring::on_mesh(law, *thickness, self.lattice.clone()),
                };
                Body::new(springs.mesh.clone(), Energy::Springs(Box::new(springs)))
            }
            (Model::Corrected, None) => finite_elements(self.lattice.clone()),
            (Model::Corrected, Some((plate, cells))) => {
                let mesh = DifferenceScheme::default().mesh(&self.lattice);
                let energy = SheetEnergy::of_mesh(Arc::clone(law), &mesh, *thickness);
                let quick = Quick::begin(plate, *cells)?;
                let mut body = Body::new(mesh, Energy::Sheet(Box::new(energy)));
                (body.displacement, body.grip) = (quick.displacement(), quick.grip());
                body.quick = Some(quick);
                body
            }
        })
    }
}

impl Sheet {
    /// The supports that the grips are.
    pub fn problem(&self, grip: Grip) -> BoundaryProblem {
        let [x, y] = grip.lines(self.axis).map(Some);
        let clamp = Support::Displacement([Some(0.0); 2]);
        let moved = Support::LinearDisplacement([x, y]);
        let supports = [(Side::Left, clamp), (Side::Right, moved)]
            .map(|(side, support)| (side.name().to_owned(), support));
        BoundaryProblem::supported(self.thickness, Arc::clone(&self.law), supports.into())
    }
}

impl Body {
    fn new(mesh: Mesh, energy: Energy) -> Self {
        Self {
            displacement: vec![0.0; 2 * mesh.nodes.len()],
            mesh,
            grip: Grip::default(),
            energy,
            quick: None,
        }
    }

    pub(super) fn potential(&self) -> &dyn Remembering {
        match &self.energy {
            Energy::Springs(springs) => springs.potential(),
            Energy::Sheet(sheet) => &**sheet,
        }
    }

    /// The boundary value problem with the grip at a place.
    ///
    /// # Errors
    /// [`Error::Input`] where the mesh cannot be held so.
    pub fn model(&self, sheet: &Sheet, grip: Grip) -> Result<Problem<'_>, Error> {
        Ok(sheet.problem(grip).on(&self.mesh, self.potential())?)
    }

    /// Follows the grip from where it was; the force along X in N where the quick path knows it.
    ///
    /// # Errors
    /// [`Error::Solve`]; the state before is kept.
    pub fn follow(
        &mut self,
        sheet: &Sheet,
        grip: Grip,
        exactly: bool,
    ) -> Result<Option<f64>, Error> {
        if let Some(quick) = &mut self.quick
            && !exactly
        {
            match quick.move_to(grip) {
                Ok(force) => {
                    (self.displacement, self.grip) = (quick.displacement(), grip);
                    return Ok(Some(force));
                }
                // Too far at once: load steps lead there.
                Err(_) if quick.grip() != grip => (),
                Err(error) => return Err(error),
            }
        }
        let displacement = path::reach(self, sheet, grip)?;
        (self.displacement, self.grip) = (displacement, grip);
        Ok(None)
    }

    /// The springs, where it consists of them.
    pub fn springs(&self) -> Option<&MassSpring> {
        match &self.energy {
            Energy::Springs(springs) => Some(springs),
            Energy::Sheet(_) => None,
        }
    }

    /// Force and moment on the right grip in N and N mm; `along` is the force along X where it is known better than the
    /// sum of the reactions.
    pub fn reaction(&self, sheet: &Sheet, grip: Grip, along: Option<f64>) -> ([f64; 2], f64) {
        let mut residual = vec![0.0; self.displacement.len()];
        if Assembly::residual(self.potential(), &self.displacement, &mut residual).is_err() {
            return ([f64::NAN; 2], f64::NAN);
        }
        let middle = [
            sheet.length + grip.displacement[0],
            sheet.axis + grip.displacement[1],
        ];
        let (mut force, mut moment) = ([0.0; 2], 0.0);
        for node in &self.mesh.groups()[Side::Right.name()].nodes {
            let [x, y] = [0, 1].map(|axis| {
                self.mesh.nodes[*node][axis] + self.displacement[2 * node + axis] - middle[axis]
            });
            let [fx, fy] = [0, 1].map(|axis| residual[2 * node + axis]);
            force = [force[0] + fx, force[1] + fy];
            moment += x * fy - y * fx;
        }
        ([along.unwrap_or(force[0]), force[1]], moment)
    }
}
