//! The base of the pin's cells, beside the micrograph that it comes from.

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::Base;
use plateau_core::surface::micrograph::{FibreMap, PinPlane};
use plotters::style::RGBColor;

use super::axes::{Axes, Axis, Frame};
use super::canvas::{Anchor, TEXT};
use super::chart::{MARGIN, Meaning, legend};
use super::format::Figure;
use super::page::{Content, KeyStyle, LINE_OF_TEXT, Page, Panel};
use super::picture::Picture;
use crate::colour::GROUND;

/// Length of the longer side of a box, pixels, and the points of its picture along it: two are beside each other in the width of a journal.
const LONGEST: f64 = 864.0;
/// Distance of the boxes, pixels.
const BETWEEN: f64 = 60.0;
const MILLIMETRES: f64 = 1e3;

/// Levels of grey: with the colours below, few enough that a byte tells which.
const GREYS: u8 = 250;
const OUTLINE: RGBColor = RGBColor(220, 30, 30);
const FIBRE: RGBColor = RGBColor(240, 190, 60);
const RESIN: RGBColor = RGBColor(60, 60, 70);
/// Their numbers, and that of what is nothing.
const OUTLINED: u8 = GREYS;
const FIBROUS: u8 = GREYS + 1;
const RESINOUS: u8 = GREYS + 2;
const NOTHING: u8 = GREYS + 3;

/// A micrograph as a scene takes it.
#[derive(Debug, Clone, Copy)]
pub struct Micrograph<'a> {
    /// What was made of it, before it is mirrored.
    pub map: &'a FibreMap,
    /// Width of a pixel, m.
    pub pixel: f64,
}

/// The figure: x along the sliding direction, y outward from the mean radius, at the true proportions of the pin. If the base
/// comes from a micrograph, that is on the left, with the outline of what was taken for fibre.
pub fn figure(mesh: &Mesh, base: &[Base], micrograph: Option<Micrograph>) -> Figure {
    let plane = PinPlane::new(mesh);
    let half = plane.half_extent();
    let extent = micrograph.map_or([2.0 * half.0, 2.0 * half.1], |micrograph| micrograph.extent());
    let scale = LONGEST / extent[0].max(extent[1]);
    let size = extent.map(|length| (length * scale).round().max(1.0));
    let within = |x: f64, y: f64| plane.cell(x, y).filter(|cell| mesh.is_present(*cell));
    let cell = |x: f64, y: f64| match within(x, y).and_then(|cell| base.get(cell)) {
        Some(Base::Primary) => FIBROUS,
        Some(Base::Resin) => RESINOUS,
        None => NOTHING,
    };
    let mut pictures = Vec::new();
    if let Some(micrograph) = micrograph {
        pictures.push(("micrograph", picture(size, extent, |x, y| micrograph.colour(x, y))));
    }
    pictures.push(("base of the pin", picture(size, extent, cell)));
    Figure {
        name: "fibre-map".to_owned(),
        title: "Fibre map of the pin".to_owned(),
        caption: "The base of the pin's cells, fibre or resin, beside the micrograph that it comes from.".to_owned(),
        page: page(pictures, size, extent),
    }
}

fn page(pictures: Vec<(&str, Picture)>, [width, height]: [f64; 2], extent: [f64; 2]) -> Page {
    let [x, y] = extent.map(|length| 0.5 * length * MILLIMETRES);
    let x = Axis::linear(-x..=x, "x, mm");
    let y = Axis::linear(-y..=y, "y, mm");
    let room = y.room_beside(height).ceil();
    let wide = (room + width + BETWEEN) * pictures.len() as f64 + MARGIN;
    let mut page = Page { size: [wide, 0.0], ..Page::default() };
    let mut meanings = vec![(FIBRE, "fibre"), (RESIN, "resin")];
    if pictures.len() > 1 {
        meanings.push((OUTLINE, "outline of what was taken for fibre"));
    }
    let meaning = |(colour, text): (RGBColor, &str)| Meaning { colour, style: KeyStyle::Area, text: text.to_owned() };
    let meanings: Vec<Meaning> = meanings.into_iter().map(meaning).collect();
    let top = legend(&mut page, &meanings, MARGIN) + LINE_OF_TEXT;
    for (number, (title, picture)) in pictures.into_iter().enumerate() {
        let left = MARGIN + number as f64 * (room + width + BETWEEN) + room;
        page.write(title, (left, top - LINE_OF_TEXT - 4.0), Anchor::BelowRight, TEXT);
        let frame = Frame { x: [left, left + width], y: [top, top + height] };
        let axes = Axes { frame, x: x.clone(), y: y.clone() };
        page.panels.push(Panel { axes, contents: vec![Content::Map(picture)] });
    }
    page.size[1] = (top + height + x.room_below() + MARGIN).ceil();
    page
}

/// The colours at the points of the plane, m, from the upper left one on.
fn picture([width, height]: [f64; 2], extent: [f64; 2], colour: impl Fn(f64, f64) -> u8) -> Picture {
    let (columns, rows) = (width as usize, height as usize);
    let mut indices = Vec::with_capacity(columns * rows);
    for line in 0..rows {
        let y = extent[1] * (0.5 - (line as f64 + 0.5) / height);
        indices.extend((0..columns).map(|column| colour(extent[0] * ((column as f64 + 0.5) / width - 0.5), y)));
    }
    let grey = |level: u8| {
        let level = (255.0 * f64::from(level) / f64::from(GREYS - 1)).round() as u8;
        RGBColor(level, level, level)
    };
    Picture { columns, rows, indices, palette: (0..GREYS).map(grey).chain([OUTLINE, FIBRE, RESIN, GROUND]).collect() }
}

impl Micrograph<'_> {
    /// Width and height, m.
    fn extent(&self) -> [f64; 2] {
        [self.map.grey.width, self.map.grey.height].map(|pixels| pixels as f64 * self.pixel)
    }

    /// Number of the colour at a point of the pin's plane, m.
    fn colour(&self, x: f64, y: f64) -> u8 {
        let (grey, fibre) = (&self.map.grey, &self.map.fibre);
        let (width, height) = (fibre.width, fibre.height);
        // The casts saturate.
        let column = ((x / self.pixel + 0.5 * width as f64) as usize).min(width - 1);
        let line = ((0.5 * height as f64 - y / self.pixel) as usize).min(height - 1);
        let at = |column: usize, line: usize| fibre.pixels[line * width + column];
        let is_edge = at(column, line)
            && (!at(column.saturating_sub(1), line)
                || !at((column + 1).min(width - 1), line)
                || !at(column, line.saturating_sub(1))
                || !at(column, (line + 1).min(height - 1)));
        let level = f64::from(grey.pixels[line * width + column]) * f64::from(GREYS - 1);
        if is_edge { OUTLINED } else { level.round() as u8 }
    }
}

#[cfg(test)]
mod tests {
    use plateau_core::surface::micrograph::Picture as Pixels;

    use super::*;

    fn pixels<T>(of: impl Fn(usize, usize) -> T) -> Pixels<T> {
        let (width, height) = (160, 120);
        Pixels { width, height, pixels: (0..width * height).map(|at| of(at % width, at / width)).collect() }
    }

    #[test]
    fn picture_outline_and_cells_are_shown() {
        // Square cells of 100 µm, a pin of 3 mm by 2 mm; fibre right of the middle, and a bar along the top of the picture.
        let mesh = Mesh::new(20, 1382, 30, 21e-3, 23e-3).unwrap();
        let fibre = |x: usize, line: usize| x >= 80 || line < 30;
        let base: Vec<Base> = (0..600).map(|cell| if cell / 20 >= 15 { Base::Primary } else { Base::Resin }).collect();
        let grey = pixels(|x, line| if fibre(x, line) { 200.0 / 255.0 } else { 50.0 / 255.0 });
        let map = FibreMap { base: base.clone(), grey, fibre: pixels(fibre), report: Vec::new() };
        let figure = figure(&mesh, &base, Some(Micrograph { map: &map, pixel: 20e-6 }));
        let pictures = figure.page.pictures();
        // 3.2 mm by 2.4 mm.
        assert!(pictures.iter().all(|(_, picture)| (picture.columns, picture.rows) == (864, 648)));
        // By pixels of the picture, each 864/160 points.
        let at = |panel: usize, x: f64, line: f64| {
            let picture = &pictures[panel].1;
            let point = [x, line].map(|place| (place * 864.0 / 160.0) as usize);
            let RGBColor(red, green, blue) = picture.palette[usize::from(picture.indices[point[1] * 864 + point[0]])];
            [red, green, blue]
        };
        assert_eq!((at(0, 140.5, 100.5), at(0, 20.5, 100.5)), ([200; 3], [50; 3]));
        assert_eq!((at(0, 80.5, 100.5), at(0, 20.5, 29.5)), ([220, 30, 30], [220, 30, 30]));
        assert_eq!((at(1, 100.5, 80.5), at(1, 60.5, 80.5)), ([240, 190, 60], [60, 60, 70]));
        assert_eq!((at(1, 0.5, 0.5), at(1, 159.5, 119.5)), ([255; 3], [255; 3]));
        let alone = super::figure(&mesh, &base, None).page.pictures();
        assert_eq!((alone.len(), alone[0].1.columns), (1, 864));
    }
}
