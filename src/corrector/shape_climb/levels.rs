//! The meshes of a climb, with the data common to all of its states.

use std::cell::OnceCell;

use crate::error::{Diagnostic, Error};
use crate::mesh::{Interpolation, Mesh};
use crate::problem::sheet_energy::SheetEnergy;
use crate::problem::{BoundaryProblem, Model};
use crate::solve::{Assembly, Ladder, Loading, Newton, Remembering};

/// Meshes from coarse to fine.
pub struct Levels<'a> {
    pub problem: &'a BoundaryProblem,
    pub meshes: &'a [Mesh],
    energies: Vec<SheetEnergy>,
    /// Interpolations from each mesh to the next finer one.
    finer: Vec<Interpolation>,
    /// Interpolations from each mesh to the one before it, computed when first needed.
    coarser: OnceCell<Vec<Interpolation>>,
}

impl<'a> Levels<'a> {
    /// # Panics
    /// Without a mesh.
    pub fn new(problem: &'a BoundaryProblem, meshes: &'a [Mesh]) -> Self {
        assert!(!meshes.is_empty(), "a mesh");
        let energies = meshes.iter().map(|mesh| problem.finite_elements(mesh));
        let pairs = meshes.windows(2);
        Self {
            energies: energies.collect(),
            finer: pairs
                .map(|pair| pair[0].interpolation_on(&pair[1]))
                .collect(),
            coarser: OnceCell::new(),
            problem,
            meshes,
        }
    }

    /// The number of the finest mesh.
    pub fn finest(&self) -> usize {
        self.meshes.len() - 1
    }

    /// The problem on a mesh.
    ///
    /// # Errors
    /// [`Error::Input`] where the mesh does not suit it.
    pub fn model(&self, level: usize) -> Result<Model<'_>, Error> {
        let model = on(self.problem, &self.meshes[level], &self.energies[level])?;
        Ok(model.named("corrector"))
    }

    /// The strain energy of a field on a mesh in mJ; NaN where a cell is turned inside out.
    pub fn strain_energy(&self, level: usize, u: &[f64]) -> f64 {
        let found = Assembly::residual(&self.energies[level], u, &mut vec![0.0; u.len()]);
        found.unwrap_or(f64::NAN)
    }

    /// The interpolation from the mesh before to a mesh.
    pub fn to(&self, level: usize) -> &Interpolation {
        &self.finer[level - 1]
    }

    /// The tangents of all meshes but the finest at a field of the finest one, at a load factor; `None` where one of
    /// them is not positive definite, or does not exist.
    pub fn tangents_below(&self, factor: f64, field: &[f64]) -> Option<Ladder> {
        let coarser = self.coarser.get_or_init(|| {
            let pairs = self.meshes.windows(2);
            pairs
                .map(|pair| pair[1].interpolation_on(&pair[0]))
                .collect()
        });
        let mut fields = vec![field.to_vec()];
        for interpolation in coarser.iter().rev() {
            fields.push(interpolation.apply(&fields[fields.len() - 1]));
        }
        let mut ladder: Option<Ladder> = None;
        for level in 0..self.finest() {
            let model = self.model(level).ok()?;
            let (potential, held) = (model.potential(factor, &[]), model.held());
            let mut u = fields.pop()?;
            model.impose(factor, &mut u);
            let next = match ladder {
                None => Ladder::begin(&*potential, &held, &u),
                Some(below) => {
                    let carry = carrying(self.to(level));
                    let mut newton = Newton::above(&*potential, &held, below, &carry).ok()?;
                    newton.take_tangent(&*potential, &u)?;
                    newton.into_ladder()
                }
            };
            ladder = Some(next?.tied(model.ties()));
        }
        ladder
    }
}

/// The problem on a mesh with an energy of its nodal displacements.
///
/// # Errors
/// [`Error::Input`] where the mesh does not suit it.
pub fn on<'a>(
    problem: &BoundaryProblem,
    mesh: &'a Mesh,
    energy: &'a dyn Remembering,
) -> Result<Model<'a>, Error> {
    let found = problem.on(mesh, energy);
    found.map_err(|fault: Diagnostic| Error::Input(vec![fault]))
}

/// Writes the unknowns of the coarser mesh, with their shares, that make up an unknown of the finer one.
pub fn carrying(interpolation: &Interpolation) -> impl Fn(usize, &mut Vec<(usize, f64)>) + '_ {
    |unknown, terms| {
        let nodes = interpolation.of(unknown / 2);
        terms.extend(nodes.map(|(node, share)| (2 * node + unknown % 2, share)));
    }
}
