//! Numbers from their bytes.

/// A number from one, two, four or eight bytes: `f` with a floating point, `i` whole with a sign, any other kind whole without one.
pub fn number(kind: char, bytes: &[u8], big_endian: bool) -> f64 {
    let mut little = [0; 8];
    little[..bytes.len()].copy_from_slice(bytes);
    if big_endian {
        little[..bytes.len()].reverse();
    }
    let complete = u64::from_le_bytes(little);
    match (kind, bytes.len()) {
        ('f', 4) => f64::from(f32::from_bits(complete as u32)),
        ('f', _) => f64::from_bits(complete),
        ('i', size) => {
            let unused = 64 - 8 * size as u32;
            ((complete << unused) as i64 >> unused) as f64
        }
        _ => complete as f64,
    }
}
