//! How colours look to people who lack a kind of cones, and on paper without colours: what palettes are tested with.

/// A way to see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vision {
    /// With all three kinds of cones.
    Full,
    /// Without the cones for red.
    Protanopia,
    /// Without the cones for green.
    Deuteranopia,
    /// On paper without colours.
    Grey,
}

/// Red, green and blue of light, from 0 to 1.
pub type Light = [f64; 3];

impl Vision {
    pub const ALL: [Self; 4] = [Self::Full, Self::Protanopia, Self::Deuteranopia, Self::Grey];

    /// What is seen of a colour (Machado, Oliveira and Fernandes, IEEE Trans. Vis. Comput. Graph. 15, 1291 (2009), at full
    /// severity), as light.
    pub fn seen(self, colour: [u8; 3]) -> Light {
        let light = colour.map(|part| linear(f64::from(part) / 255.0));
        let matrix = match self {
            Self::Full => return light,
            Self::Protanopia => [
                [0.152286, 1.052583, -0.204868],
                [0.114503, 0.786281, 0.099216],
                [-0.003882, -0.048116, 1.051998],
            ],
            Self::Deuteranopia => [
                [0.367322, 0.860646, -0.227968],
                [0.280085, 0.672501, 0.047413],
                [-0.011820, 0.042940, 0.968881],
            ],
            Self::Grey => [[0.2126, 0.7152, 0.0722]; 3],
        };
        matrix.map(|row| {
            let seen: f64 = row
                .iter()
                .zip(light)
                .map(|(factor, part)| factor * part)
                .sum();
            seen.clamp(0.0, 1.0)
        })
    }
}

/// The light of a share of sRGB.
fn linear(share: f64) -> f64 {
    if share <= 0.04045 {
        share / 12.92
    } else {
        ((share + 0.055) / 1.055).powf(2.4)
    }
}

/// L*, a*, b* of CIE 1976 under D65.
fn lab([red, green, blue]: Light) -> [f64; 3] {
    let x = (0.4124 * red + 0.3576 * green + 0.1805 * blue) / 0.9505;
    let y = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    let z = (0.0193 * red + 0.1192 * green + 0.9505 * blue) / 1.089;
    let curve = |t: f64| {
        if t > 0.008856 {
            t.cbrt()
        } else {
            7.787 * t + 16.0 / 116.0
        }
    };
    let [x, y, z] = [x, y, z].map(curve);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// From 0 for black to 100 for white.
pub fn lightness(light: Light) -> f64 {
    lab(light)[0]
}

/// The distance of two colours; people see one above about 2.
pub fn difference(one: Light, other: Light) -> f64 {
    let (one, other) = (lab(one), lab(other));
    let squares = one.iter().zip(other).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}
