//! How a picture looks: its width, its colours, its letters.

use super::letters::Letters;
use super::marks::{Colour, Pen};
use crate::results::{PALETTE, Palette, PictureStyle, PictureWidth};

/// Millimetres of a printed picture for each point of the usual design: letters of 12 points become 7.2 of a printer's.
const MILLIMETRES: f64 = 0.2125;

/// Colours of a table.
const COLOURS: usize = 256;

/// ColorBrewer's `RdBu`, blue first: readable with every colour vision.
const BLUE_TO_RED: [Colour; 11] = colours([
    0x053061, 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d,
    0xb2182b, 0x67001f,
]);

/// `cividis`: from blue over grey to yellow, lighter and lighter.
const BLUE_TO_YELLOW: [Colour; 9] = colours([
    0x00224e, 0x1a386f, 0x424e6c, 0x5f636e, 0x7c7b78, 0x9b9375, 0xbbad6c, 0xddc958, 0xfee838,
]);

/// `viridis`: from violet over green to yellow, lighter and lighter.
pub const VIRIDIS: [Colour; 9] = colours([
    0x440154, 0x472c7a, 0x3b518b, 0x2c718e, 0x21908d, 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725,
]);

/// ColorBrewer's `YlGnBu`: the paper's colour for little, dark for much.
const LIGHT_TO_DARK: [Colour; 9] = colours([
    0xffffd9, 0xedf8b1, 0xc7e9b4, 0x7fcdbb, 0x41b6c4, 0x1d91c0, 0x225ea8, 0x253494, 0x081d58,
]);

/// The colours of lines on black, in the order of [`PALETTE`]: Okabe's and Ito's, the darker ones lighter.
const ON_BLACK: [Colour; 6] = colours([0x56a0f0, 0xff7828, 0x00be8c, 0xe196c3, 0xf0dc5a, 0x96d7f5]);

/// The colours of lines that differ in a print without colours too.
const PRINTED: [Colour; 6] = colours([0x004478, 0xb03a00, 0x46966e, 0x460a3c, 0xf0cd78, 0x9ba8eb]);

/// Colours from their hexadecimal numbers.
const fn colours<const N: usize>(numbers: [u32; N]) -> [Colour; N] {
    let mut all = [[0; 3]; N];
    let mut index = 0;
    while index < N {
        let [_, red, green, blue] = numbers[index].to_be_bytes();
        all[index] = [red, green, blue];
        index += 1;
    }
    all
}

/// How a picture looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    width: PictureWidth,
    palette: Palette,
    /// The size of a point of the design, of that of the usual letters.
    enlarged: f64,
}

impl Look {
    pub fn of(style: &PictureStyle) -> Self {
        Self {
            width: style.width,
            palette: style.palette,
            enlarged: style.font_size / PictureStyle::FONT_SIZE,
        }
    }

    /// Whether the picture has the width of a single column, in which there is no room beside an area.
    pub fn is_narrow(self) -> bool {
        self.width == PictureWidth::OneColumn
    }

    /// Whether the picture is made for paper.
    pub fn is_printed(self) -> bool {
        self.width != PictureWidth::Screen
    }

    /// The same colours at the width of a screen.
    pub fn on_screen(self) -> Self {
        Self {
            width: PictureWidth::Screen,
            ..self
        }
    }

    /// The width in points of the design; pictures for a screen have their own.
    pub fn points(self, on_screen: u32) -> u32 {
        let usual = match self.width {
            PictureWidth::Screen => on_screen,
            PictureWidth::OneColumn => 400,
            PictureWidth::TwoColumns => 848,
        };
        (f64::from(usual) / self.enlarged).round() as u32
    }

    /// Pixels for each point of the design: about 600 an inch where it is to be printed.
    pub fn pixels(self) -> f32 {
        let usual = match self.width {
            PictureWidth::Screen => 2.0,
            PictureWidth::OneColumn | PictureWidth::TwoColumns => 5.0,
        };
        usual * self.enlarged as f32
    }

    /// Millimetres of a printed picture for each point of the design.
    pub fn millimetres(self) -> f64 {
        MILLIMETRES * self.enlarged
    }

    fn is_dark(self) -> bool {
        self.palette == Palette::Dark
    }

    /// A colour on black or on white paper.
    fn tone(self, on_black: Colour, on_white: Colour) -> Colour {
        if self.is_dark() { on_black } else { on_white }
    }

    /// Behind everything.
    pub fn paper(self) -> Colour {
        self.tone([18, 20, 24], [255; 3])
    }

    /// Text and axes.
    pub fn ink(self) -> Colour {
        self.tone([232; 3], [38; 3])
    }

    /// Grid lines.
    pub fn pale(self) -> Colour {
        self.tone([58, 62, 70], [225; 3])
    }

    /// A band behind lines.
    pub fn band(self) -> Colour {
        self.tone([34, 44, 58], [229, 237, 246])
    }

    /// Outlines at rest.
    pub fn rest(self) -> Colour {
        self.tone([150; 3], [120; 3])
    }

    /// A line's colour, which the data give for white paper.
    pub fn line(self, colour: Colour) -> Colour {
        let table = match self.palette {
            Palette::Default => PALETTE,
            Palette::Dark => ON_BLACK,
            Palette::Print => PRINTED,
        };
        let index = PALETTE.iter().position(|known| *known == colour);
        match index {
            Some(index) => table[index],
            // Black and its shades.
            None if self.is_dark() => colour.map(|part| 255 - part),
            None => colour,
        }
    }

    /// The colour of a line as an area has it: mixed with the paper.
    pub fn area(self, colour: Colour) -> Colour {
        self.mixed(colour, 4)
    }

    /// The colour of an area beside another one of the same line's colour.
    pub fn darker_area(self, colour: Colour) -> Colour {
        self.mixed(colour, 2)
    }

    /// One of so many parts in a line's colour, the others in the paper's.
    fn mixed(self, colour: Colour, parts: i32) -> Colour {
        let (line, paper) = (self.line(colour), self.paper());
        [0, 1, 2].map(|part| {
            let (line, paper) = (i32::from(line[part]), i32::from(paper[part]));
            (paper - (paper - line) / parts) as u8
        })
    }

    /// The colours of a bar from its lower to its upper end.
    pub fn bar(self, is_signed: bool) -> Vec<Colour> {
        match (self.palette, is_signed) {
            (Palette::Print, true) => between(&BLUE_TO_YELLOW),
            (Palette::Print, false) => between(&LIGHT_TO_DARK),
            (_, true) => between(&BLUE_TO_RED),
            (_, false) => between(&VIRIDIS),
        }
    }

    /// The letters of titles.
    pub fn title(self) -> Letters {
        Letters::bold(if self.is_narrow() { 14 } else { 17 })
    }

    /// The letters of names: of axes, lines and panels.
    pub fn name(self) -> Letters {
        Letters::regular(if self.is_narrow() { 12 } else { 13 })
    }

    /// The letters of numbers and remarks.
    pub fn number(self) -> Letters {
        Letters::regular(12)
    }

    /// A thin line in the colour of the axes.
    pub fn axis(self) -> Pen {
        Pen::new(self.ink(), 1.0)
    }
}

/// A table of colours between some that are evenly apart.
fn between(anchors: &[Colour]) -> Vec<Colour> {
    let at = |index: usize| {
        let along = (index as f64 + 0.5) / COLOURS as f64 * (anchors.len() - 1) as f64;
        let first = along as usize;
        let [from, to] = [anchors[first], anchors[first + 1]];
        [0, 1, 2].map(|part| {
            let (from, to) = (f64::from(from[part]), f64::from(to[part]));
            (from + (along - first as f64) * (to - from)).round() as u8
        })
    };
    (0..COLOURS).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::picture::tests::vision::{Vision, difference, lightness};
    use crate::results::PictureFormat;

    fn look(palette: Palette) -> Look {
        Look::of(&PictureStyle {
            palette,
            width: PictureWidth::Screen,
            formats: vec![PictureFormat::Png],
            ..PictureStyle::default()
        })
    }

    fn combinations() -> impl Iterator<Item = (Palette, Vision)> {
        let palettes = [Palette::Default, Palette::Dark, Palette::Print].into_iter();
        palettes.flat_map(|palette| Vision::ALL.map(|vision| (palette, vision)))
    }

    /// From every 32nd part of a bar to the next; what is smaller is rounding.
    fn rises(lightness: &[f64]) -> bool {
        const PART: usize = 8;
        let later = lightness.iter().skip(PART);
        lightness.iter().zip(later).all(|(now, later)| later > now)
    }

    #[test]
    fn one_signed_bars_change_their_lightness_in_one_direction_for_every_vision() {
        for (palette, vision) in combinations() {
            let bar = look(palette).bar(false);
            let mut light: Vec<f64> = bar.iter().map(|one| lightness(vision.seen(*one))).collect();
            if light[0] > light[255] {
                light.reverse();
            }
            assert!(rises(&light), "{palette:?} {vision:?}");
            assert!(light[255] - light[0] > 60.0, "{palette:?} {vision:?}");
        }
    }

    #[test]
    fn bars_of_both_signs_get_lighter_towards_zero_and_their_sides_differ_or_rise_throughout() {
        for (palette, vision) in combinations() {
            let bar = look(palette).bar(true);
            let seen: Vec<_> = bar.iter().map(|one| vision.seen(*one)).collect();
            let light: Vec<f64> = seen.iter().map(|one| lightness(*one)).collect();
            if palette == Palette::Print {
                assert!(rises(&light), "{vision:?}");
                continue;
            }
            let from_the_end: Vec<f64> = light.iter().copied().rev().take(128).collect();
            assert!(rises(&light[..128]) && rises(&from_the_end), "{vision:?}");
            for index in 0..64 {
                let apart = difference(seen[index], seen[255 - index]);
                assert!(
                    apart > 15.0 || vision == Vision::Grey,
                    "{vision:?} {index}: {apart}"
                );
            }
        }
    }

    #[test]
    fn lines_differ_from_one_another_and_from_the_paper_for_every_vision() {
        for (palette, vision) in combinations() {
            if vision == Vision::Grey && palette != Palette::Print {
                continue;
            }
            let look = look(palette);
            let mut all: Vec<Colour> = PALETTE.map(|one| look.line(one)).into();
            all.push(look.paper());
            for (index, one) in all.iter().enumerate() {
                for other in &all[..index] {
                    let apart = difference(vision.seen(*one), vision.seen(*other));
                    assert!(
                        apart > 8.0,
                        "{palette:?} {vision:?} {one:?} {other:?}: {apart}"
                    );
                }
            }
        }
    }
}
