//! How large and how small quantities of each dimension may be: what lies outside is a mistake of units or of writing.

use super::Dimension;

/// From 1 nm to 1 km: how long a thing may be, in mm.
pub const SIZES: [f64; 2] = [1e-6, 1e6];

/// A number, or the end of a range where only the rounding of a conversion lies between them: ends are inside.
///
/// ```text
/// 1e-6 kg/m³ · 1e-12 = 9.999…e-19 tonne/mm³   →   1e-18
/// ```
pub fn on_the_end(value: f64, ends: [f64; 2]) -> f64 {
    let near = |end: &f64| (value - end).abs() <= 4.0 * f64::EPSILON * end.abs();
    ends.into_iter().find(near).unwrap_or(value)
}

impl Dimension {
    /// The least and the largest magnitude that a quantity other than zero may have, in the internal unit.
    ///
    /// | dimension | from | to |
    /// |---|---|---|
    /// | length | 1 fm | 1 km |
    /// | area | 1 fm × 1 fm | 1 km × 1 km |
    /// | force | 1e-18 N | 1e12 N |
    /// | stress | 1e-30 MPa | 1e9 MPa |
    /// | density | 1e-6 kg/m³ | 1e9 kg/m³ |
    /// | mass | 1e-24 tonne | 1e9 tonne |
    /// | time | 1 ps | 1e11 s |
    /// | frequency | 1e-12 Hz | 1e12 Hz |
    /// | acceleration | 1e-12 mm/s² | 1e12 mm/s² |
    /// | viscosity | 1e-18 MPa·s | 1e12 MPa·s |
    /// | temperature | 1 mK | 1e6 K |
    /// | molar volume | 1e-3 mm³/mol | 1e12 mm³/mol |
    /// | concentration | 1e-9 mol/m³ | 1e9 mol/m³ |
    /// | angle | 1e-12 rad | 1e6 rad |
    /// | ratio | 1e-100 | 1e100 |
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::Length => [1e-12, SIZES[1]],
            Self::Area => [1e-24, SIZES[1] * SIZES[1]],
            Self::Force => [1e-18, 1e12],
            Self::Stress => [1e-30, 1e9],
            Self::Density => [1e-18, 1e-3],
            Self::Mass => [1e-24, 1e9],
            Self::Time => [1e-12, 1e11],
            Self::Frequency | Self::Acceleration => [1e-12, 1e12],
            Self::Viscosity => [1e-18, 1e12],
            Self::Temperature => [1e-3, 1e6],
            Self::MolarVolume => [1e-3, 1e12],
            Self::Concentration => [1e-18, 1.0],
            Self::Angle => [1e-12, 1e6],
            Self::Ratio => [1e-100, 1e100],
        }
    }

    /// A quantity in the internal unit where it is zero or of a possible magnitude.
    pub fn admitted(self, value: f64) -> Option<f64> {
        let ends = self.range();
        let [least, most] = ends;
        let size = on_the_end(value.abs(), ends);
        let possible = size == 0.0 || (least..=most).contains(&size);
        possible.then(|| size.copysign(value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::parse;

    #[test]
    fn ends_of_ranges_are_inside_in_every_unit() {
        for (text, dimension, end) in [
            ("1e-6 kg/m³", Dimension::Density, 1e-18),
            ("1e9 kg/m³", Dimension::Density, 1e-3),
            ("1e-6 nm", Dimension::Length, 1e-12),
            ("1 km", Dimension::Length, 1e6),
            ("-1e-27 kPa", Dimension::Stress, -1e-30),
            ("1e-9 ms", Dimension::Time, 1e-12),
            ("1e-98 %", Dimension::Ratio, 1e-100),
        ] {
            assert_eq!(parse(text, dimension), Ok(end), "{text}");
        }
        for text in ["9.999999e-7 kg/m³", "1.000001e9 kg/m³"] {
            assert!(parse(text, Dimension::Density).is_err(), "{text}");
        }
    }

    #[test]
    fn only_rounding_is_taken_for_an_end() {
        assert_eq!(on_the_end(0.1 + 0.2, [0.0, 0.3]), 0.3);
        assert_eq!(on_the_end(1.0 + 1e-14, [0.0, 1.0]), 1.0 + 1e-14);
        assert_eq!(on_the_end(5e-324, [0.0, 1.0]), 5e-324);
    }
}
