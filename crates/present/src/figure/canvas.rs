//! A page and what is put on it, in pixels from the upper left corner.

use std::fmt;

use plotters::coord::Shift;
use plotters::element::{BitMapElement, PathElement, Polygon};
use plotters::prelude::{DrawingArea, DrawingBackend, IntoDrawingArea as _, IntoFont as _, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontTransform, RGBColor, ShapeStyle, WHITE};

use super::brush::{Place, covered};
use super::font::{self, FONT_NAME};
use crate::colour::INK;
use crate::label::on_one_line;

/// Height of a line of numbers and words, pixels: the drawing library's size of a font. Its letters are of 8 points, for the em is 1.24 times smaller.
pub const TEXT: u32 = 42;
/// Height of a line of a title, pixels.
pub const TITLE: u32 = 46;
/// Width of lines, pixels.
pub const LINE: u32 = 3;

/// Why a figure cannot be drawn.
#[derive(Debug)]
pub struct FigureError(String);

impl fmt::Display for FigureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the figure cannot be drawn: {}", self.0)
    }
}

/// Makes an error of whatever a drawing backend says.
pub fn failed(error: impl fmt::Display) -> FigureError {
    FigureError(error.to_string())
}

/// Where a text stands about its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Below it, in its middle.
    Below,
    /// To its left.
    Left,
    /// To its right.
    Right,
    /// Below it, to its right.
    BelowRight,
    /// Above it, in its middle, read upward.
    Upward,
}

impl Anchor {
    fn position(self) -> Pos {
        let (horizontal, vertical) = match self {
            Self::Below => (HPos::Center, VPos::Top),
            Self::Left => (HPos::Right, VPos::Center),
            Self::Right => (HPos::Left, VPos::Center),
            Self::BelowRight => (HPos::Left, VPos::Top),
            Self::Upward => (HPos::Center, VPos::Bottom),
        };
        Pos::new(horizontal, vertical)
    }
}

/// A page of any backend.
pub struct Canvas<B: DrawingBackend> {
    area: DrawingArea<B, Shift>,
    /// Whether it is made of pixels, of which a line covers parts.
    in_pixels: bool,
}

impl<B: DrawingBackend> Canvas<B> {
    /// A white page.
    pub fn new(backend: B) -> Result<Self, FigureError> {
        let canvas = Self::clear(backend);
        canvas.area.fill(&WHITE).map_err(failed)?;
        Ok(canvas)
    }

    /// A page without a ground, to be laid over what is there.
    pub fn clear(backend: B) -> Self {
        font::register();
        Self { area: backend.into_drawing_area(), in_pixels: false }
    }

    /// The same for a page that is made of pixels.
    #[must_use]
    pub fn in_pixels(self) -> Self {
        Self { in_pixels: true, ..self }
    }

    /// Finishes the page.
    pub fn finish(self) -> Result<(), FigureError> {
        self.area.present().map_err(failed)
    }

    /// A line through places.
    pub fn line(&self, places: &[Place], colour: RGBColor, width: u32) -> Result<(), FigureError> {
        if self.in_pixels {
            let (wide, high) = self.area.dim_in_pixel();
            for (place, part) in covered(places, f64::from(width)) {
                if (0..wide as i32).contains(&place.0) && (0..high as i32).contains(&place.1) {
                    self.area.draw_pixel(place, &colour.mix(part)).map_err(failed)?;
                }
            }
            return Ok(());
        }
        let style = ShapeStyle { color: colour.into(), filled: false, stroke_width: width };
        let places: Vec<_> = places.iter().map(pixels).collect();
        let mut begin = 0;
        for end in (1..places.len()).filter(|at| at + 1 == places.len() || turns_back(&places[at - 1..=at + 1])) {
            // The drawing library would draw the outer corner of a sharp turn far out.
            self.area.draw(&PathElement::new(&places[begin..=end], style)).map_err(failed)?;
            begin = end;
        }
        Ok(())
    }

    /// A filled polygon.
    pub fn area(&self, places: &[Place], colour: RGBColor) -> Result<(), FigureError> {
        let places: Vec<_> = places.iter().map(pixels).collect();
        self.area.draw(&Polygon::new(places, colour)).map_err(failed)
    }

    /// A filled polygon through which what is below can be seen.
    pub fn tint(&self, places: &[Place], colour: RGBColor, opacity: f64) -> Result<(), FigureError> {
        let places: Vec<_> = places.iter().map(pixels).collect();
        self.area.draw(&Polygon::new(places, colour.mix(opacity))).map_err(failed)
    }

    /// A bitmap with its upper left corner there; three bytes a pixel, row by row.
    pub fn bitmap(&self, place: Place, size: (u32, u32), bytes: Vec<u8>) -> Result<(), FigureError> {
        let element = BitMapElement::with_owned_buffer(pixels(&place), size, bytes);
        self.area.draw(&element.ok_or_else(|| failed("a bitmap of another size"))?).map_err(failed)
    }

    /// A text.
    pub fn text(&self, text: &str, place: Place, anchor: Anchor, size: u32) -> Result<(), FigureError> {
        if text.is_empty() {
            return Ok(());
        }
        // In SVG a control character would be an error of the whole file.
        let text = on_one_line(text);
        let turn = if anchor == Anchor::Upward { FontTransform::Rotate270 } else { FontTransform::None };
        let style = (FONT_NAME, size).into_font().transform(turn).color(&INK).pos(anchor.position());
        // Centred is the line with the room above its letters; the letters themselves shall be.
        let beside = matches!(anchor, Anchor::Left | Anchor::Right);
        let place = (place.0, if beside { place.1 + 0.12 * f64::from(size) } else { place.1 });
        self.area.draw(&Text::new(text.as_str(), pixels(&place), style)).map_err(failed)
    }
}

/// Whether a line through three places turns by more than 120 degrees in the middle.
fn turns_back(places: &[(i32, i32)]) -> bool {
    let step = |from: (i32, i32), to: (i32, i32)| (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
    let (before, after) = (step(places[0], places[1]), step(places[1], places[2]));
    before.0 * after.0 + before.1 * after.1 < -0.5 * before.0.hypot(before.1) * after.0.hypot(after.1)
}

fn pixels(place: &Place) -> (i32, i32) {
    (place.0.round() as i32, place.1.round() as i32)
}
