//! How large and how small quantities of each dimension may be: what lies outside is a mistake of units or of writing.

use super::Dimension;

/// From 1 nm to 1 km: how long a thing may be, in mm.
pub const SIZES: [f64; 2] = [1e-6, 1e6];

impl Dimension {
    /// The least and the largest magnitude that a quantity other than zero may have, in the internal unit.
    ///
    /// | dimension | from | to |
    /// |---|---|---|
    /// | length | 1 fm | 1 km |
    /// | area | 1 fm × 1 fm | 1 km × 1 km |
    /// | force | 1e-18 N | 1e12 N |
    /// | stress | 1e-15 MPa | 1e9 MPa |
    /// | density | 1e-6 kg/m³ | 1e9 kg/m³ |
    /// | mass | 1e-24 tonne | 1e9 tonne |
    /// | time | 1 ps | 1e11 s |
    /// | frequency | 1e-12 Hz | 1e12 Hz |
    /// | acceleration | 1e-12 mm/s² | 1e12 mm/s² |
    /// | viscosity | 1e-18 MPa·s | 1e12 MPa·s |
    /// | angle | 1e-12 rad | 1e6 rad |
    /// | ratio | 1e-100 | 1e100 |
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::Length => [1e-12, SIZES[1]],
            Self::Area => [1e-24, SIZES[1] * SIZES[1]],
            Self::Force => [1e-18, 1e12],
            Self::Stress => [1e-15, 1e9],
            Self::Density => [1e-18, 1e-3],
            Self::Mass => [1e-24, 1e9],
            Self::Time => [1e-12, 1e11],
            Self::Frequency | Self::Acceleration => [1e-12, 1e12],
            Self::Viscosity => [1e-18, 1e12],
            Self::Angle => [1e-12, 1e6],
            Self::Ratio => [1e-100, 1e100],
        }
    }

    /// Whether a quantity in the internal unit is zero or of a possible magnitude.
    pub fn admits(self, value: f64) -> bool {
        let [least, most] = self.range();
        value == 0.0 || (least..=most).contains(&value.abs())
    }
}
