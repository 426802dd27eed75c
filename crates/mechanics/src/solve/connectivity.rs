//! Which unknowns each element depends on.

use std::sync::{Arc, LazyLock};

/// The unknowns of the elements of a sum, one element after the other. Copies of a finished list share its memory.
#[derive(Clone, Debug)]
pub struct Connectivity {
    unknowns: usize,
    /// Elements that others may have too, followed by elements of this sum alone.
    common: Arc<Elements>,
    added: Elements,
    /// The positions of the nodes, with two unknowns each, if known.
    nodes: Arc<[[f64; 2]]>,
}

/// The unknowns of some elements.
#[derive(Clone, Debug)]
struct Elements {
    unknowns: Vec<u32>,
    /// Where the unknowns of each element begin.
    starts: Vec<u32>,
}

impl Elements {
    fn none() -> Self {
        Self {
            unknowns: Vec::new(),
            starts: vec![0],
        }
    }

    fn count(&self) -> usize {
        self.starts.len() - 1
    }

    fn of(&self, element: usize) -> &[u32] {
        let [start, end] = [element, element + 1].map(|index| self.starts[index] as usize);
        &self.unknowns[start..end]
    }
}

impl Connectivity {
    /// An empty list of elements over so many unknowns.
    ///
    /// # Panics
    /// When there are more than 2³² − 2 unknowns.
    pub fn new(unknowns: usize) -> Self {
        assert!(unknowns < u32::MAX as usize, "{unknowns} unknowns");
        Self {
            unknowns,
            common: Arc::new(Elements::none()),
            added: Elements::none(),
            nodes: Arc::new([]),
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

    /// Adds the positions of the nodes: large systems are eliminated in an order by positions.
    #[must_use]
    pub fn with_positions(mut self, nodes: impl Into<Arc<[[f64; 2]]>>) -> Self {
        self.nodes = nodes.into();
        self
    }

    /// The elements with memory that all copies share.
    ///
    /// # Panics
    /// When the elements of a copy are to be shared again.
    #[must_use]
    pub fn shared(mut self) -> Self {
        assert_eq!(self.common.count(), 0, "shared before");
        self.added.unknowns.shrink_to_fit();
        self.added.starts.shrink_to_fit();
        self.common = Arc::new(self.added);
        self.added = Elements::none();
        self
    }

    /// Reserves memory for the elements of another list.
    pub fn reserve_as(&mut self, other: &Self) {
        let unknowns = other.common.unknowns.len() + other.added.unknowns.len();
        self.added.unknowns.reserve_exact(unknowns);
        self.added.starts.reserve_exact(other.elements());
    }

    /// Appends an element that depends on some unknowns.
    ///
    /// # Panics
    /// When all elements together have 2³² unknowns or more.
    pub fn push(&mut self, unknowns: impl IntoIterator<Item = usize>) {
        let added = &mut self.added;
        added
            .unknowns
            .extend(unknowns.into_iter().map(|unknown| unknown as u32));
        let end = u32::try_from(added.unknowns.len());
        added.starts.push(end.expect("fewer than 2³² unknowns"));
    }

    /// Appends an element that depends on the displacements of some nodes: unknowns 2 n and 2 n + 1 of node n.
    pub fn push_nodes(&mut self, nodes: &[usize]) {
        self.push(nodes.iter().flat_map(|node| [2 * node, 2 * node + 1]));
    }

    /// Appends the elements of another list.
    pub fn append(&mut self, other: &Self) {
        for element in 0..other.elements() {
            self.push(other.of(element).iter().map(|unknown| *unknown as usize));
        }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.common.count() + self.added.count()
    }

    /// The unknowns that an element depends on.
    pub fn of(&self, element: usize) -> &[u32] {
        match element.checked_sub(self.common.count()) {
            None => self.common.of(element),
            Some(index) => self.added.of(index),
        }
    }

    /// The values of the unknowns that an element depends on.
    pub fn values(&self, element: usize, u: &[f64]) -> Vec<f64> {
        let unknowns = self.of(element).iter();
        unknowns.map(|unknown| u[*unknown as usize]).collect()
    }

    /// The positions of the nodes, with two unknowns each; none if they are not known.
    pub fn nodes(&self) -> &Arc<[[f64; 2]]> {
        &self.nodes
    }
}
