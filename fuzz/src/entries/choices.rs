//! Bytes read as choices, so that an input becomes a study that is mostly sound and strange in a few places.

/// What is left of an input; when nothing is left, the first of everything is chosen.
pub struct Choices<'a>(&'a [u8]);

impl<'a> Choices<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        *first
    }

    /// One of some.
    pub fn one<'b, T: ?Sized>(&mut self, of: &[&'b T]) -> &'b T {
        of[usize::from(self.byte()) % of.len()]
    }

    /// A whole number from 0 to below `most`.
    pub fn below(&mut self, most: usize) -> usize {
        usize::from(self.byte()) % most
    }

    /// Whether something rare happens: once in sixteen bytes.
    pub fn rarely(&mut self) -> bool {
        self.byte() % 16 == 15
    }

    /// Whether something happens: every other byte.
    pub fn maybe(&mut self) -> bool {
        self.byte() % 2 == 1
    }

    /// A number between two, in 255 steps; rarely one that nobody expects.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        const STRANGE: [f64; 12] = [
            0.0, -1.0, 1e-6, 1e6, 1e-12, -1e9, 1e-30, 1e30, 1e150, 0.5, 1.0, 1e3,
        ];
        if self.rarely() {
            STRANGE[self.below(STRANGE.len())]
        } else {
            low + (high - low) * f64::from(self.byte()) / 255.0
        }
    }
}
