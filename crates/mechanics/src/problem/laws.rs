//! The laws of a sheet: one of all cells, or several of named groups of its cells.

use std::sync::Arc;

use crate::material::HyperelasticLaw;
use crate::mesh::{CutMesh, Mesh};

/// The name of a group of cells, and the law of these cells.
pub type Region = (String, Arc<dyn HyperelasticLaw>);

/// The laws of a sheet on any of its meshes.
#[derive(Clone, Copy, Debug)]
pub struct SheetLaws<'a> {
    /// The law of all cells that belong to no region.
    pub law: &'a Arc<dyn HyperelasticLaw>,
    /// The regions of other laws, which share no cell.
    pub regions: &'a [Region],
}

/// The law of each cell of a mesh.
#[derive(Clone, Debug)]
pub struct CellLaws {
    laws: Vec<Arc<dyn HyperelasticLaw>>,
    /// The number of each cell's law; empty where there is one law.
    of_cells: Vec<u8>,
}

impl<'a> From<&'a Arc<dyn HyperelasticLaw>> for SheetLaws<'a> {
    fn from(law: &'a Arc<dyn HyperelasticLaw>) -> Self {
        Self { law, regions: &[] }
    }
}

/// The law of the cells that belong to no region, and the regions.
pub type LawAndRegions = (Arc<dyn HyperelasticLaw>, Vec<Region>);

impl<'a> From<&'a LawAndRegions> for SheetLaws<'a> {
    fn from((law, regions): &'a LawAndRegions) -> Self {
        Self { law, regions }
    }
}

impl<'a> SheetLaws<'a> {
    /// Every law: that of the cells of no region first, then those of the regions.
    pub fn all(self) -> impl Iterator<Item = &'a Arc<dyn HyperelasticLaw>> + Clone {
        let regions = self.regions.iter().map(|(_, law)| law);
        std::iter::once(self.law).chain(regions)
    }

    /// Whether the material of a cell softens.
    pub fn soften(self) -> bool {
        self.all().any(|law| law.softening().is_some())
    }

    /// The laws of the cells of a mesh; a region that the mesh lacks has no cells.
    pub fn in_cells(self, mesh: &Mesh) -> CellLaws {
        let mut of_cells = Vec::new();
        if !self.regions.is_empty() {
            of_cells.resize(mesh.cell_count(), 0);
        }
        for ((name, _), number) in self.regions.iter().zip(1..) {
            let group = mesh.groups().get(name).into_iter();
            for cell in group.flat_map(|group| &group.cells) {
                of_cells[*cell] = number;
            }
        }
        CellLaws {
            laws: self.all().cloned().collect(),
            of_cells,
        }
    }
}

impl From<Arc<dyn HyperelasticLaw>> for CellLaws {
    fn from(law: Arc<dyn HyperelasticLaw>) -> Self {
        Self {
            laws: vec![law],
            of_cells: Vec::new(),
        }
    }
}

impl<Law: HyperelasticLaw + 'static> From<Arc<Law>> for CellLaws {
    fn from(law: Arc<Law>) -> Self {
        let law: Arc<dyn HyperelasticLaw> = law;
        law.into()
    }
}

impl CellLaws {
    /// The number of a cell's law among all: 0 for cells of no region.
    pub fn number(&self, cell: usize) -> u8 {
        self.of_cells.get(cell).copied().unwrap_or(0)
    }

    /// The law of a cell.
    pub fn of(&self, cell: usize) -> &dyn HyperelasticLaw {
        &*self.laws[usize::from(self.number(cell))]
    }

    /// The laws with another one of the cells that belong to no region.
    #[must_use]
    pub fn with_law(&self, law: Arc<dyn HyperelasticLaw>) -> Self {
        let mut other = self.clone();
        other.laws[0] = law;
        other
    }

    /// The laws of the cells of a refined mesh, each of which has four in the place of one.
    #[must_use]
    pub fn refined(&self) -> Self {
        let parts = self.of_cells.iter().flat_map(|number| [*number; 4]);
        Self {
            laws: self.laws.clone(),
            of_cells: parts.collect(),
        }
    }

    /// All laws by their numbers.
    pub fn all(&self) -> &[Arc<dyn HyperelasticLaw>] {
        &self.laws
    }

    /// The mesh of these cells cut along the lines between different laws, across which gradients and stresses jump; `None` where there is one
    /// law.
    pub fn cut(&self, mesh: &Mesh) -> Option<CutMesh> {
        (!self.of_cells.is_empty()).then(|| mesh.cut_between(&self.of_cells))
    }
}
