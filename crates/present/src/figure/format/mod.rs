//! Figures in the formats of files: every figure in each of them.

mod pdf;
mod pdf_backend;

use std::fmt::Write as _;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use plotters::prelude::{BitMapBackend, SVGBackend};

use super::canvas::{Canvas, FigureError, failed};
use super::page::{PER_MILLIMETRE, Page};

/// A format of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Pixels.
    Png,
    /// Lines and letters, for web pages and drawing programs.
    Svg,
    /// Lines and letters, for papers.
    Pdf,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Png, Self::Svg, Self::Pdf];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Pdf => "pdf",
        }
    }

    /// The format that the ending of a file tells.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?;
        Self::ALL.into_iter().find(|format| ending.eq_ignore_ascii_case(format.ending()))
    }
}

/// One figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its name, fit for a file.
    pub name: String,
    /// What it shows, in a few words.
    pub title: String,
    /// What it shows, in a sentence or two.
    pub caption: String,
    /// What is plotted where.
    pub(super) page: Page,
}

impl Figure {
    /// A figure on so many pages: each is a file of its own, and says which one it is. The first one has the name of the figure.
    pub(super) fn of_pages(name: &str, title: &str, caption: &str, pages: Vec<Page>) -> Vec<Self> {
        let most = pages.len();
        let of_page = |(number, page)| {
            let said = format!("{title}, page {number} of {most}");
            let (title, caption) = match number {
                1 if most == 1 => (title.to_owned(), caption.to_owned()),
                1 => (said, caption.to_owned()),
                _ => (said.clone(), format!("{said}.")),
            };
            Self { name: Self::name_of_page(name, number), title, caption, page }
        };
        (1..).zip(pages).map(of_page).collect()
    }

    /// The name of a page of a figure, counted from 1.
    pub fn name_of_page(figure: &str, number: usize) -> String {
        if number == 1 { figure.to_owned() } else { format!("{figure}-{number}") }
    }

    /// The content of a file with the figure.
    ///
    /// # Errors
    /// [`FigureError`] when it cannot be drawn.
    pub fn draw(&self, format: Format) -> Result<Vec<u8>, FigureError> {
        match format {
            Format::Png => png(&self.page),
            Format::Svg => self.svg().map(String::into_bytes),
            Format::Pdf => pdf::pdf(&self.page, &self.title),
        }
    }

    /// The figure as SVG text.
    ///
    /// # Errors
    /// [`FigureError`] when it cannot be drawn.
    pub fn svg(&self) -> Result<String, FigureError> {
        svg(&self.page)
    }
}

/// The page as PNG.
fn png(page: &Page) -> Result<Vec<u8>, FigureError> {
    let (width, height) = page.pixels();
    let mut pixels = vec![0; 3 * width as usize * height as usize];
    let canvas = Canvas::new(BitMapBackend::with_buffer(&mut pixels, (width, height)))?.in_pixels();
    for (frame, picture) in page.pictures() {
        let (width, height) = (frame.width().round() as u32, frame.height().round() as u32);
        canvas.bitmap((frame.x[0], frame.y[0]), (width, height), picture.stretched(width, height))?;
    }
    page.draw(&canvas)?;
    canvas.finish()?;
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, width, height);
    encoder.set_color(png::ColorType::Rgb);
    let per_metre = (PER_MILLIMETRE * 1e3) as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit: png::Unit::Meter }));
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(png)
}

/// The page as SVG: maps are pictures with a pixel for every cell.
fn svg(page: &Page) -> Result<String, FigureError> {
    let (width, height) = page.pixels();
    let mut drawing = String::new();
    let canvas = Canvas::clear(SVGBackend::with_string(&mut drawing, (width, height)));
    page.draw(&canvas)?;
    canvas.finish()?;
    // The drawing library knows pixels only, and would write a picture with as many as there are on the page.
    let (_, elements) = drawing.split_once(">\n").ok_or_else(|| failed("an SVG without a beginning"))?;
    let [wide, high] = page.size.map(|length| length / PER_MILLIMETRE);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide}mm\" height=\"{high}mm\" viewBox=\"0 0 {width} {height}\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n"
    );
    for (frame, picture) in page.pictures() {
        let ([left, _], [top, _]) = (frame.x, frame.y);
        let png = STANDARD.encode(picture.png()?);
        let (width, height) = (frame.width(), frame.height());
        // Writing to a String cannot fail.
        let _ = writeln!(
            svg,
            "<image x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
             style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{png}\"/>"
        );
    }
    svg.push_str(elements);
    Ok(svg)
}
