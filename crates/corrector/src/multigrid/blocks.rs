//! Where the coefficients of a node stand: the block of the node with itself, and those with the neighbours that come after it, row by row.

/// Couples a node with itself; symmetric.
pub const ITSELF: [usize; 4] = [0, 1, 1, 2];
/// Couples a node with the next one of its line.
pub const NORTH: [usize; 4] = [3, 4, 5, 6];
/// Couples a node with its neighbour on the next line.
pub const EAST: [usize; 4] = [7, 8, 9, 10];
/// Couples a node with the one after its neighbour on the next line; symmetric.
pub const NORTH_EAST: [usize; 4] = [11, 12, 12, 13];
/// Couples a node with the one before its neighbour on the next line; symmetric.
pub const SOUTH_EAST: [usize; 4] = [14, 15, 15, 16];
/// The inverse of the block that couples a node with itself; symmetric.
pub const INVERSE: [usize; 4] = [17, 18, 18, 19];

/// The block that couples the neighbour with the node.
pub const fn transposed([a, b, c, d]: [usize; 4]) -> [usize; 4] {
    [a, c, b, d]
}
