//! How a picture looks: its width, its colours, its letters.

use super::letters::Letters;
use super::marks::{Colour, Pen};
use crate::results::{PALETTE, Palette, PictureStyle, PictureWidth};

/// Millimetres of a printed picture for each point of the usual design: letters of 12 points become 7.2 of a printer's.
const MILLIMETRES: f64 = 0.2125;

/// Colours of a table.
const COLOURS: usize = 256;

/// ColorBrewer's `RdBu`, blue first: readable with every colour vision.
const BLUE_TO_RED: [Colour; 11] = [
    [5, 48, 97],
    [33, 102, 172],
    [67, 147, 195],
    [146, 197, 222],
    [209, 229, 240],
    [247, 247, 247],
    [253, 219, 199],
    [244, 165, 130],
    [214, 96, 77],
    [178, 24, 43],
    [103, 0, 31],
];

/// `cividis`: from blue over grey to yellow, lighter and lighter.
const BLUE_TO_YELLOW: [Colour; 9] = [
    [0, 34, 78],
    [26, 56, 111],
    [66, 78, 108],
    [95, 99, 110],
    [124, 123, 120],
    [155, 147, 117],
    [187, 173, 108],
    [221, 201, 88],
    [254, 232, 56],
];

/// `viridis`: from violet over green to yellow, lighter and lighter.
pub const VIRIDIS: [Colour; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// ColorBrewer's `YlGnBu`: the paper's colour for little, dark for much.
const LIGHT_TO_DARK: [Colour; 9] = [
    [255, 255, 217],
    [237, 248, 177],
    [199, 233, 180],
    [127, 205, 187],
    [65, 182, 196],
    [29, 145, 192],
    [34, 94, 168],
    [37, 52, 148],
    [8, 29, 88],
];

/// The colours of lines on black, in the order of [`PALETTE`]: Okabe's and Ito's, the darker ones lighter.
const ON_BLACK: [[u8; 3]; 6] = [
    [86, 160, 240],
    [255, 120, 40],
    [0, 190, 140],
    [225, 150, 195],
    [240, 220, 90],
    [150, 215, 245],
];

/// The colours of lines that even a printer without colours tells apart.
const PRINTED: [[u8; 3]; 6] = [
    [0, 68, 120],
    [176, 58, 0],
    [70, 150, 110],
    [70, 10, 60],
    [240, 205, 120],
    [155, 168, 235],
];

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
    fn tone(self, on_black: [u8; 3], on_white: [u8; 3]) -> Colour {
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
    pub fn line(self, colour: [u8; 3]) -> Colour {
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
    pub fn area(self, colour: [u8; 3]) -> Colour {
        self.mixed(colour, 4)
    }

    /// The colour of an area beside another one of the same line's colour.
    pub fn darker_area(self, colour: [u8; 3]) -> Colour {
        self.mixed(colour, 2)
    }

    /// One part in so many of a line's colour, the others of the paper's.
    fn mixed(self, colour: [u8; 3], parts: i32) -> Colour {
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

    const ALL: [Palette; 3] = [Palette::Default, Palette::Dark, Palette::Print];

    /// From every 32nd part of a bar to the next; what is smaller is rounding.
    fn rises(lightness: &[f64]) -> bool {
        const PART: usize = 8;
        let later = lightness.iter().skip(PART);
        lightness.iter().zip(later).all(|(now, later)| later > now)
    }

    #[test]
    fn one_signed_bars_change_their_lightness_in_one_direction_for_every_vision() {
        for (palette, vision) in ALL
            .iter()
            .flat_map(|all| Vision::ALL.map(|one| (*all, one)))
        {
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
        for (palette, vision) in ALL
            .iter()
            .flat_map(|all| Vision::ALL.map(|one| (*all, one)))
        {
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
        for (palette, vision) in ALL
            .iter()
            .flat_map(|all| Vision::ALL.map(|one| (*all, one)))
        {
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
