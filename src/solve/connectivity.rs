//! Which unknowns each element depends on.

use std::sync::LazyLock;

/// The unknowns of the elements of a sum, one element after the other.
#[derive(Clone, Debug)]
pub struct Connectivity {
    unknowns: usize,
    element_unknowns: Vec<usize>,
    /// Where the unknowns of each element begin.
    starts: Vec<usize>,
    /// The places of the nodes, with two unknowns each, if known.
    nodes: Vec<[f64; 2]>,
}

impl Connectivity {
    /// An empty list of elements over so many unknowns.
    pub fn new(unknowns: usize) -> Self {
        Self {
            unknowns,
            element_unknowns: Vec::new(),
            starts: vec![0],
            nodes: Vec::new(),
        }
    }

    /// One element with one unknown.
    pub fn single() -> &'static Self {
        static SINGLE: LazyLock<Connectivity> = LazyLock::new(|| {
            let mut single = Connectivity::new(1);
            single.push([0]);
            single
        });
        &SINGLE
    }

    /// Adds the places of the nodes: large systems are eliminated in an order by places.
    #[must_use]
    pub fn with_places(self, nodes: Vec<[f64; 2]>) -> Self {
        Self { nodes, ..self }
    }

    /// Adds the places of the nodes as far as `other` has them.
    #[must_use]
    pub fn with_places_of(self, other: &Self) -> Self {
        self.with_places(other.nodes.clone())
    }

    /// Appends an element that depends on some unknowns.
    pub fn push(&mut self, unknowns: impl IntoIterator<Item = usize>) {
        self.element_unknowns.extend(unknowns);
        self.starts.push(self.element_unknowns.len());
    }

    /// Appends an element that depends on the displacements of some nodes: unknowns 2 n and 2 n + 1 of node n.
    pub fn push_nodes(&mut self, nodes: &[usize]) {
        self.push(nodes.iter().flat_map(|node| [2 * node, 2 * node + 1]));
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.starts.len() - 1
    }

    /// The unknowns that an element depends on.
    pub fn of(&self, element: usize) -> &[usize] {
        &self.element_unknowns[self.starts[element]..self.starts[element + 1]]
    }

    /// The place of an unknown in the body, if known.
    pub fn place(&self, unknown: usize) -> Option<[f64; 2]> {
        self.nodes.get(unknown / 2).copied()
    }
}
