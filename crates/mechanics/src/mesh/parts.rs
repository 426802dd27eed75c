//! Which members of a set are connected with each other.

/// The connected parts of a set of members, at first each alone.
pub struct Parts(Vec<usize>);

impl Parts {
    /// So many members, each a part of its own.
    pub fn new(members: usize) -> Self {
        Self((0..members).collect())
    }

    /// Connects the parts of two members.
    pub fn join(&mut self, one: usize, other: usize) {
        let [one, other] = [one, other].map(|member| self.first(member));
        self.0[one.max(other)] = one.min(other);
    }

    /// The first member of a member's part.
    pub fn first(&mut self, mut member: usize) -> usize {
        while self.0[member] != member {
            self.0[member] = self.0[self.0[member]];
            member = self.0[member];
        }
        member
    }
}
