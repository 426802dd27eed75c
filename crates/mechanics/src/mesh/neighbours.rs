//! The neighbours of cells.

/// The neighbours of the cells of a mesh, by the numbers of their edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbours(Vec<[Option<usize>; 4]>);

impl Neighbours {
    /// The neighbours of so many cells, by pairs of edges that are one: each by its cell and its number there.
    pub fn new(cells: usize, pairs: impl Iterator<Item = [(usize, usize); 2]>) -> Self {
        let mut across = vec![[None; 4]; cells];
        for [(one, edge), (other, edge_of_other)] in pairs {
            across[one][edge] = Some(other);
            across[other][edge_of_other] = Some(one);
        }
        Self(across)
    }

    /// The cell on the other side of an edge of a cell; `None` on the boundary.
    pub fn across(&self, cell: usize, edge: usize) -> Option<usize> {
        self.0[cell][edge]
    }
}
