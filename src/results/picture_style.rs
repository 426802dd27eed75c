//! How pictures are drawn, whatever they show.

/// Formats, width and colours of pictures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureStyle {
    /// The formats that are written.
    pub formats: Vec<PictureFormat>,
    /// How wide they are.
    pub width: PictureWidth,
    /// Their colours.
    pub palette: Palette,
}

impl Default for PictureStyle {
    fn default() -> Self {
        Self {
            formats: vec![PictureFormat::Png],
            width: PictureWidth::Screen,
            palette: Palette::Default,
        }
    }
}

/// The format of a picture. Pictures that move are always PNG.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Pixels.
    Png,
    /// Lines and letters as curves, shaded fields as pixels among them.
    Svg,
    /// The same.
    Pdf,
}

impl PictureFormat {
    /// All of them by their names, which are the endings of files too.
    pub const NAMES: [(&'static str, Self); 3] =
        [("png", Self::Png), ("svg", Self::Svg), ("pdf", Self::Pdf)];
}

/// How wide pictures are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureWidth {
    /// For a screen: about 200 mm.
    Screen,
    /// One column of a journal: 85 mm.
    OneColumn,
    /// Two columns: 180 mm.
    TwoColumns,
}

impl PictureWidth {
    /// All of them by their names.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("screen", Self::Screen),
        ("one-column", Self::OneColumn),
        ("two-columns", Self::TwoColumns),
    ];
}

/// The colours of pictures; all can be told apart with every colour vision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Palette {
    /// On white.
    Default,
    /// On black, for slides.
    Dark,
    /// Lightness alone tells the colours apart, as where a printer has but one.
    Print,
}

impl Palette {
    /// All of them by their names.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("default", Self::Default),
        ("dark", Self::Dark),
        ("print", Self::Print),
    ];
}
