//! Where the coefficients of a node stand: its own block and those of the neighbours that come after it, row by row.

/// Couples a node with itself; symmetric.
pub const ITSELF: [usize; 4] = [0, 1, 1, 2];
/// With the next node of its line.
pub const NORTH: [usize; 4] = [3, 4, 5, 6];
/// With its neighbour on the next line.
pub const EAST: [usize; 4] = [7, 8, 9, 10];
/// With the node after that neighbour; symmetric.
pub const NORTH_EAST: [usize; 4] = [11, 12, 12, 13];
/// With the node before that neighbour; symmetric.
pub const SOUTH_EAST: [usize; 4] = [14, 15, 15, 16];
/// The inverse of its own block; symmetric.
pub const INVERSE: [usize; 4] = [17, 18, 18, 19];

/// The block that couples the neighbour with the node.
pub const fn transposed([a, b, c, d]: [usize; 4]) -> [usize; 4] {
    [a, c, b, d]
}
