//! Images of grey values.

/// An image of grey values, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct GreyImage {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

/// The least and the largest of some values.
pub fn range(values: &[f32]) -> (f32, f32) {
    let ends = (f32::MAX, f32::MIN);
    values.iter().fold(ends, |(low, high), value| {
        (low.min(*value), high.max(*value))
    })
}

/// The luminance of red, green and blue (ITU-R BT.709).
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

impl GreyImage {
    /// Of `width` × `height` values in the unit of the camera.
    ///
    /// # Panics
    /// Where there are not as many values.
    pub fn new(width: usize, height: usize, values: Vec<f32>) -> Self {
        assert_eq!(values.len(), width * height, "one value for each pixel");
        Self {
            width,
            height,
            values,
        }
    }

    /// The value at each pixel centre (x, y).
    pub fn of(width: usize, height: usize, value: impl Fn(usize, usize) -> f32) -> Self {
        let values = (0..width * height).map(|index| value(index % width, index / width));
        Self::new(width, height, values.collect())
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// All values, row by row.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// All values, to change them.
    pub(super) fn values_mut(&mut self) -> &mut [f32] {
        &mut self.values
    }

    /// The value of a pixel.
    ///
    /// # Panics
    /// Where it is outside.
    pub fn value(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.width + x]
    }

    /// The largest value that the camera can give: the least 2ᵏ − 1 of at least 8 bits that no pixel exceeds.
    pub fn white(&self) -> f32 {
        let most = self.values.iter().copied().fold(0.0, f32::max);
        let levels = (8..=16).map(|bits| ((1_u32 << bits) - 1) as f32);
        levels
            .into_iter()
            .find(|white| most <= *white)
            .unwrap_or(most)
    }

    /// The values of the eight neighbours of a pixel that is not at the rim.
    pub(super) fn around(&self, x: usize, y: usize) -> [f32; 8] {
        let at = y * self.width + x;
        let (above, below) = (at - self.width, at + self.width);
        let positions = [
            above - 1,
            above,
            above + 1,
            at - 1,
            at + 1,
            below - 1,
            below,
            below + 1,
        ];
        positions.map(|position| self.values[position])
    }
}
