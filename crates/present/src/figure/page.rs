//! A page as plain data: what is plotted where, before any of it is drawn.

use std::f64::consts::PI;

use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;

use super::axes::{Axes, Frame};
use super::brush::Place;
use super::canvas::{Anchor, Canvas, FigureError, LINE, TEXT};
use super::colour_bar::ColourBar;
use super::picture::Picture;
use super::simplify::simplified;
use super::stroke::{Dashes, Stroke};
use crate::colour::{APART, APART_OF_GREYS, COLOURS, ColourMap};

/// Pixels of a millimetre on paper: letters are of 8 points then.
pub const PER_MILLIMETRE: f64 = 12.0;

/// A page; lengths and places in pixels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Width and height.
    pub size: [f64; 2],
    /// Texts beside the panels.
    pub texts: Vec<Words>,
    /// Explanations of colours.
    pub keys: Vec<Key>,
    /// Boxes with axes.
    pub panels: Vec<Panel>,
    /// Scales of the maps.
    pub colour_bars: Vec<ColourBar>,
}

/// A text at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Words {
    /// The text.
    pub text: String,
    /// Where.
    pub place: Place,
    /// How it stands there.
    pub anchor: Anchor,
    /// Height of its letters.
    pub size: u32,
}

/// A sample of a colour; what it means is one of the page's texts.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// Where.
    pub frame: Frame,
    /// The colour.
    pub colour: RGBColor,
    /// How it is shown.
    pub style: KeyStyle,
}

/// Radius of dots, pixels.
const DOT: f64 = 6.6;

/// What a colour is the colour of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KeyStyle {
    /// A line with these dashes; without gaps where there are none.
    Line(Dashes),
    /// An area.
    Area,
    /// Nothing: the text says it.
    Words,
}

/// A box with axes and what is in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Box and axes.
    pub axes: Axes,
    /// What is in it, from below.
    pub contents: Vec<Content>,
}

/// What a panel shows; values in the units of its axes.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// A line through points.
    Line {
        /// The points.
        points: Vec<[f64; 2]>,
        /// How it is drawn.
        stroke: Stroke,
    },
    /// What lies between two values.
    Band {
        /// x with the lower and the upper value there.
        spans: Vec<[f64; 3]>,
        /// Its colour.
        colour: RGBColor,
        /// Whether one sees through it.
        opacity: f64,
    },
    /// Small dots, of which there may be many.
    Dots {
        /// The points.
        points: Vec<[f64; 2]>,
        /// Their colour.
        colour: RGBColor,
    },
    /// A map that fills the box.
    Map(Picture),
}

impl Page {
    /// Width and height in whole pixels.
    pub fn pixels(&self) -> (u32, u32) {
        let [width, height] = self.size.map(|length| length.round() as u32);
        (width, height)
    }

    /// The bitmaps of the page, which lie below all else.
    pub fn pictures(&self) -> Vec<(Frame, Picture)> {
        let maps = self.panels.iter().flat_map(|panel| {
            panel.contents.iter().filter_map(|content| match content {
                Content::Map(picture) => Some((panel.axes.frame, picture.clone())),
                _ => None,
            })
        });
        maps.chain(self.colour_bars.iter().map(|bar| (bar.frame, bar.strip()))).collect()
    }

    /// Draws all but the bitmaps.
    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), FigureError> {
        self.panels.iter().try_for_each(|panel| panel.draw(canvas))?;
        self.colour_bars.iter().try_for_each(|bar| bar.draw_scale(canvas))?;
        self.keys.iter().try_for_each(|key| key.draw(canvas))?;
        self.texts.iter().try_for_each(|words| canvas.text(&words.text, words.place, words.anchor, words.size))
    }

    /// Shows ranges in other colours.
    pub fn recolour(&mut self, colours: ColourMap) {
        let contents = self.panels.iter_mut().flat_map(|panel| &mut panel.contents);
        for content in contents {
            // A smaller palette is that of kinds, not of a range.
            if let Content::Map(Picture { palette, .. }) = content
                && palette.len() >= COLOURS
            {
                palette.splice(..COLOURS, colours.colours());
            }
        }
        if colours == ColourMap::Greys && !self.colour_bars.is_empty() {
            self.replace(APART, APART_OF_GREYS);
        }
        self.colour_bars.iter_mut().for_each(|bar| bar.colours = colours);
    }

    /// Shows one colour of maps and of what they mean as another.
    fn replace(&mut self, from: RGBColor, to: RGBColor) {
        let contents = self.panels.iter_mut().flat_map(|panel| &mut panel.contents);
        let maps = contents.filter_map(|content| match content {
            Content::Map(picture) => Some(&mut picture.palette),
            _ => None,
        });
        let keys = self.keys.iter_mut().map(|key| &mut key.colour);
        maps.flat_map(|palette| palette.iter_mut().skip(COLOURS))
            .chain(keys)
            .filter(|colour| **colour == from)
            .for_each(|colour| *colour = to);
    }

    /// Adds a text.
    pub fn write(&mut self, text: impl Into<String>, place: Place, anchor: Anchor, size: u32) {
        self.texts.push(Words { text: text.into(), place, anchor, size });
    }
}

impl Key {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), FigureError> {
        let middle = 0.5 * (self.frame.y[0] + self.frame.y[1]);
        match self.style {
            KeyStyle::Line(dashes) => {
                let stroke = Stroke { dashes, ..Stroke::solid(self.colour, LINE + 2) };
                stroke.draw(canvas, &self.frame.x.map(|x| (x, middle)))
            }
            KeyStyle::Area => canvas.area(&self.frame.corners(), self.colour),
            KeyStyle::Words => Ok(()),
        }
    }
}

impl Panel {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), FigureError> {
        for content in &self.contents {
            match content {
                Content::Line { points, stroke } => {
                    let places: Vec<Place> = points.iter().map(|[x, y]| self.axes.place_within(*x, *y)).collect();
                    match simplified(&places)[..] {
                        [place] => canvas.area(&around(place, stroke.width), stroke.colour)?,
                        ref places => stroke.draw(canvas, places)?,
                    }
                }
                Content::Band { spans, colour, opacity } => {
                    let lower = spans.iter().map(|[x, low, _]| self.axes.place_within(*x, *low));
                    let upper = spans.iter().rev().map(|[x, _, high]| self.axes.place_within(*x, *high));
                    canvas.tint(&lower.chain(upper).collect::<Vec<_>>(), *colour, *opacity)?;
                }
                Content::Dots { points, colour } => {
                    let mut places = points.iter().map(|[x, y]| self.axes.place_within(*x, *y));
                    places.try_for_each(|place| canvas.area(&dot(place), *colour))?;
                }
                Content::Map(_) => {}
            }
        }
        self.axes.draw(canvas)
    }
}

/// The corners of a dot.
fn dot((x, y): Place) -> [Place; 24] {
    std::array::from_fn(|part| {
        let (sine, cosine) = (part as f64 * PI / 12.0).sin_cos();
        (x + DOT * cosine, y + DOT * sine)
    })
}

/// The corners of a dot for a line of this width: a line through one place only would not be seen.
fn around((x, y): Place, width: u32) -> [Place; 4] {
    let side = [-1.0, 1.0].map(|side| side * f64::from(width));
    Frame { x: side.map(|side| x + side), y: side.map(|side| y + side) }.corners()
}

/// The letters of a text, in lines of their own.
pub const LINE_OF_TEXT: f64 = 1.35 * TEXT as f64;
