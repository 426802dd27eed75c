//! Dimensions of physical quantities, the units that are understood of each, and how large and how small they may be: what lies outside is a
//! mistake of units or of writing.

/// The kind of a physical quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Internal unit mm.
    Length,
    /// Internal unit mm².
    Area,
    /// Internal unit N.
    Force,
    /// Internal unit MPa = N/mm².
    Stress,
    /// Internal unit tonne/mm³.
    Density,
    /// Internal unit tonne.
    Mass,
    /// Internal unit s.
    Time,
    /// Internal unit Hz = 1/s.
    Frequency,
    /// Internal unit mm/s².
    Acceleration,
    /// Internal unit MPa·s.
    Viscosity,
    /// Internal unit K.
    Temperature,
    /// Internal unit mm³/mol.
    MolarVolume,
    /// Internal unit mol/mm³.
    Concentration,
    /// Internal unit rad.
    Angle,
    /// A ratio, written as a bare number or in percent, per mille or microstrain.
    Ratio,
}

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

/// The unit of temperature with another zero than K: a factor alone does not convert it.
pub const CELSIUS: [&str; 2] = ["°C", "degC"];

impl Dimension {
    /// All dimensions.
    pub const ALL: [Self; 15] = [
        Self::Length,
        Self::Area,
        Self::Force,
        Self::Stress,
        Self::Density,
        Self::Mass,
        Self::Time,
        Self::Frequency,
        Self::Acceleration,
        Self::Viscosity,
        Self::Temperature,
        Self::MolarVolume,
        Self::Concentration,
        Self::Angle,
        Self::Ratio,
    ];

    /// Name, unit inside the program, an example, and the range of magnitudes.
    fn entry(self) -> (&'static str, &'static str, &'static str, [f64; 2]) {
        match self {
            Self::Length => ("length", "mm", "\"2 mm\"", [1e-12, SIZES[1]]),
            Self::Area => ("area", "mm^2", "\"20 mm^2\"", [1e-24, SIZES[1] * SIZES[1]]),
            Self::Force => ("force", "N", "\"1.5 N\"", [1e-18, 1e12]),
            Self::Stress => ("stress", "MPa", "\"1 MPa\"", [1e-30, 1e9]),
            Self::Density => ("density", "tonne/mm^3", "\"1020 kg/m^3\"", [1e-18, 1e-3]),
            Self::Mass => ("mass", "tonne", "\"5 g\"", [1e-24, 1e9]),
            Self::Time => ("time", "s", "\"10 s\"", [1e-12, 1e11]),
            Self::Frequency => ("frequency", "Hz", "\"2 Hz\"", [1e-12, 1e12]),
            Self::Acceleration => ("acceleration", "mm/s^2", "\"9.81 m/s^2\"", [1e-12, 1e12]),
            Self::Viscosity => ("viscosity", "MPa·s", "\"50 Pa·s\"", [1e-18, 1e12]),
            Self::Temperature => ("temperature", "K", "\"298.15 K\"", [1e-3, 1e6]),
            Self::MolarVolume => (
                "molar volume",
                "mm^3/mol",
                "\"18.07 cm^3/mol\"",
                [1e-3, 1e12],
            ),
            Self::Concentration => ("concentration", "mol/mm^3", "\"20 mol/m^3\"", [1e-18, 1.0]),
            Self::Angle => ("angle", "rad", "\"30 deg\"", [1e-12, 1e6]),
            Self::Ratio => ("ratio", "", "0.5 or \"50 %\"", [1e-100, 1e100]),
        }
    }

    /// The quantity's name as used in messages.
    pub fn name(self) -> &'static str {
        self.entry().0
    }

    /// The units that are understood for this dimension.
    pub fn units(self) -> impl Iterator<Item = &'static str> {
        UNITS
            .iter()
            .filter(move |(_, dimension, _)| *dimension == self)
            .map(|(symbol, ..)| *symbol)
            .chain(
                CELSIUS
                    .into_iter()
                    .filter(move |_| self == Self::Temperature),
            )
    }

    /// The unit of this dimension inside the program; empty for a ratio.
    pub fn internal_unit(self) -> &'static str {
        self.entry().1
    }

    /// A quantity of this dimension as written in a file, its number left out: a number in a hint would be another material's.
    pub fn blank(self) -> String {
        let example = self.example().trim_matches('"');
        match example.split_once(' ') {
            Some((_, unit)) if self != Self::Ratio => format!("\"… {unit}\""),
            _ => "…".to_owned(),
        }
    }

    /// An example of a well-formed quantity, for hints.
    pub fn example(self) -> &'static str {
        self.entry().2
    }

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
        self.entry().3
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

/// `(symbol, dimension, factor to the internal unit)`; the first symbol of a dimension is the
/// one that error messages suggest.
pub const UNITS: &[(&str, Dimension, f64)] = &[
    ("mm", Dimension::Length, 1.0),
    ("cm", Dimension::Length, 10.0),
    ("m", Dimension::Length, 1e3),
    ("km", Dimension::Length, 1e6),
    ("nm", Dimension::Length, 1e-6),
    ("um", Dimension::Length, 1e-3),
    ("µm", Dimension::Length, 1e-3),
    ("in", Dimension::Length, 25.4),
    ("ft", Dimension::Length, 304.8),
    ("mm^2", Dimension::Area, 1.0),
    ("cm^2", Dimension::Area, 100.0),
    ("m^2", Dimension::Area, 1e6),
    ("in^2", Dimension::Area, 645.16),
    ("N", Dimension::Force, 1.0),
    ("mN", Dimension::Force, 1e-3),
    ("kN", Dimension::Force, 1e3),
    ("µN", Dimension::Force, 1e-6),
    ("gf", Dimension::Force, 9.80665e-3),
    ("kgf", Dimension::Force, 9.80665),
    ("lbf", Dimension::Force, 4.448_221_615_260_5),
    ("ozf", Dimension::Force, 0.278_013_850_953_781_2),
    ("cN", Dimension::Force, 1e-2),
    ("dyn", Dimension::Force, 1e-5),
    ("MPa", Dimension::Stress, 1.0),
    ("kPa", Dimension::Stress, 1e-3),
    ("Pa", Dimension::Stress, 1e-6),
    ("GPa", Dimension::Stress, 1e3),
    ("N/mm^2", Dimension::Stress, 1.0),
    ("N/m^2", Dimension::Stress, 1e-6),
    ("kN/m^2", Dimension::Stress, 1e-3),
    ("MN/m^2", Dimension::Stress, 1.0),
    ("N/cm^2", Dimension::Stress, 1e-2),
    ("gf/mm^2", Dimension::Stress, 9.80665e-3),
    ("kgf/cm^2", Dimension::Stress, 0.098_066_5),
    ("kgf/mm^2", Dimension::Stress, 9.80665),
    ("dyn/cm^2", Dimension::Stress, 1e-7),
    ("hPa", Dimension::Stress, 1e-4),
    ("mbar", Dimension::Stress, 1e-4),
    ("bar", Dimension::Stress, 0.1),
    ("atm", Dimension::Stress, 0.101_325),
    ("mmHg", Dimension::Stress, 133.322_387_415e-6),
    ("psi", Dimension::Stress, 6.894_757_293_168e-3),
    ("ksi", Dimension::Stress, 6.894_757_293_168),
    ("kg/m^3", Dimension::Density, 1e-12),
    ("g/cm^3", Dimension::Density, 1e-9),
    ("tonne/mm^3", Dimension::Density, 1.0),
    ("g", Dimension::Mass, 1e-6),
    ("kg", Dimension::Mass, 1e-3),
    ("mg", Dimension::Mass, 1e-9),
    ("tonne", Dimension::Mass, 1.0),
    ("s", Dimension::Time, 1.0),
    ("ms", Dimension::Time, 1e-3),
    ("us", Dimension::Time, 1e-6),
    ("µs", Dimension::Time, 1e-6),
    ("min", Dimension::Time, 60.0),
    ("h", Dimension::Time, 3600.0),
    ("Hz", Dimension::Frequency, 1.0),
    ("kHz", Dimension::Frequency, 1e3),
    ("1/s", Dimension::Frequency, 1.0),
    ("m/s^2", Dimension::Acceleration, 1e3),
    ("mm/s^2", Dimension::Acceleration, 1.0),
    ("Pa·s", Dimension::Viscosity, 1e-6),
    ("mPa·s", Dimension::Viscosity, 1e-9),
    ("kPa·s", Dimension::Viscosity, 1e-3),
    ("MPa·s", Dimension::Viscosity, 1.0),
    ("K", Dimension::Temperature, 1.0),
    ("cm^3/mol", Dimension::MolarVolume, 1e3),
    ("mL/mol", Dimension::MolarVolume, 1e3),
    ("mm^3/mol", Dimension::MolarVolume, 1.0),
    ("m^3/mol", Dimension::MolarVolume, 1e9),
    ("mol/m^3", Dimension::Concentration, 1e-9),
    ("mol/L", Dimension::Concentration, 1e-6),
    ("mmol/L", Dimension::Concentration, 1e-9),
    ("mol/cm^3", Dimension::Concentration, 1e-3),
    ("mol/mm^3", Dimension::Concentration, 1.0),
    ("deg", Dimension::Angle, std::f64::consts::PI / 180.0),
    ("rad", Dimension::Angle, 1.0),
    ("°", Dimension::Angle, std::f64::consts::PI / 180.0),
    ("%", Dimension::Ratio, 1e-2),
    ("‰", Dimension::Ratio, 1e-3),
    ("µε", Dimension::Ratio, 1e-6),
];

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
