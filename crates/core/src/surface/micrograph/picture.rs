//! Pictures: pixels line by line.

/// A picture; its first line is at the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture<T> {
    /// Pixels of a line.
    pub width: usize,
    /// Lines.
    pub height: usize,
    /// Pixels, line by line.
    pub pixels: Vec<T>,
}

impl<T: Copy> Picture<T> {
    /// Turned counterclockwise by quarters of a turn.
    pub(super) fn turned(self, quarters: u8) -> Self {
        let Self { width, height, ref pixels } = self;
        let old = |x: usize, y: usize| pixels[y * width + x];
        match quarters % 4 {
            // What was the right edge is the new top.
            1 => Self::from_fn(height, width, |x, y| old(width - 1 - y, x)),
            2 => Self::from_fn(width, height, |x, y| old(width - 1 - x, height - 1 - y)),
            3 => Self::from_fn(height, width, |x, y| old(y, height - 1 - x)),
            _ => self,
        }
    }

    fn from_fn(width: usize, height: usize, pixel: impl Fn(usize, usize) -> T) -> Self {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        Self { width, height, pixels }
    }
}

impl Picture<bool> {
    /// Fraction of the pixels that are set.
    pub fn fraction(&self) -> f64 {
        self.pixels.iter().filter(|pixel| **pixel).count() as f64 / self.pixels.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_counterclockwise() {
        // numpy.rot90([[1, 2, 3], [4, 5, 6]], k)
        let picture = Picture { width: 3, height: 2, pixels: vec![1, 2, 3, 4, 5, 6] };
        for (quarters, width, pixels) in [
            (0, 3, [1, 2, 3, 4, 5, 6]),
            (1, 2, [3, 6, 2, 5, 1, 4]),
            (2, 3, [6, 5, 4, 3, 2, 1]),
            (3, 2, [4, 1, 5, 2, 6, 3]),
        ] {
            let turned = picture.clone().turned(quarters);
            assert_eq!((turned.width, turned.height), (width, 6 / width));
            assert_eq!(turned.pixels, pixels, "{quarters}");
        }
    }
}
