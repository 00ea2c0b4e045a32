//! A bitmap of few colours, of which only so many points are kept as there is to see.

use std::borrow::Cow;

use plotters::style::RGBColor;

use super::canvas::{FigureError, failed};

/// A picture with a byte for every point.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Points along x.
    pub columns: usize,
    /// Points along y.
    pub rows: usize,
    /// Number of the colour of every point, row by row from the top.
    pub indices: Vec<u8>,
    /// The colours, at most 256.
    pub palette: Vec<RGBColor>,
}

impl Picture {
    /// The picture on so many pixels, three bytes a pixel, row by row from the top: every pixel has the colour of the
    /// point that its middle lies in.
    pub fn stretched(&self, width: u32, height: u32) -> Vec<u8> {
        let point = |pixel: u32, pixels: u32, points: usize| {
            ((2 * u64::from(pixel) + 1) * points as u64 / (2 * u64::from(pixels.max(1)))) as usize
        };
        let columns: Vec<usize> = (0..width).map(|pixel| point(pixel, width, self.columns)).collect();
        let mut bytes = Vec::with_capacity(3 * width as usize * height as usize);
        for line in 0..height {
            let row = &self.indices[point(line, height, self.rows) * self.columns..][..self.columns];
            for column in &columns {
                let colour = self.palette[usize::from(row[*column])];
                bytes.extend([colour.0, colour.1, colour.2]);
            }
        }
        bytes
    }

    /// The colours, three bytes each.
    pub fn palette_bytes(&self) -> Vec<u8> {
        self.palette.iter().flat_map(|colour| [colour.0, colour.1, colour.2]).collect()
    }

    /// The picture as PNG, a pixel for every point.
    pub fn png(&self) -> Result<Vec<u8>, FigureError> {
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, self.columns as u32, self.rows as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(Cow::Owned(self.palette_bytes()));
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&self.indices).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(png)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        let palette = vec![RGBColor(1, 2, 3), RGBColor(40, 50, 60), RGBColor(7, 8, 9)];
        Picture { columns: 3, rows: 2, indices: vec![0, 1, 2, 2, 1, 0], palette }
    }

    #[test]
    fn every_pixel_has_the_colour_of_the_point_in_its_middle() {
        let [a, b, c] = [[1, 2, 3], [40, 50, 60], [7, 8, 9]];
        assert_eq!(picture().stretched(3, 2), [a, b, c, c, b, a].concat());
        // By hand: the middles of 4 pixels over 3 points are at 0.375, 1.125, 1.875, 2.625 points.
        assert_eq!(picture().stretched(4, 1), [c, b, b, a].concat());
    }

    #[test]
    fn the_png_has_the_points() {
        let png = picture().png().unwrap();
        let mut decoder = png::Decoder::new(std::io::Cursor::new(png));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (3, 2));
        assert_eq!(pixels, picture().stretched(3, 2));
    }
}
