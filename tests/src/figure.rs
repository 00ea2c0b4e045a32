//! Figures as their readers see them: values are read off an SVG by the numbers on its axes.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use roxmltree::{Document, Node};

/// Colour of axes and text.
const INK: &str = "#222222";
/// How far numbers stand lower than their ticks, pixels, so that their letters are in the middle.
const LOWERED: f64 = 5.0;

/// An SVG figure, taken apart.
#[derive(Debug, Clone)]
pub struct Figure {
    /// Width and height, mm.
    pub size: [f64; 2],
    /// Texts with their place and what their place is of them: `start`, `middle` or `end`.
    pub texts: Vec<Text>,
    /// Lines with their colour, in the order in which they are drawn.
    pub lines: Vec<(String, Vec<[f64; 2]>)>,
    /// Areas with their colour.
    pub areas: Vec<(String, Vec<[f64; 2]>)>,
    /// Bitmaps with their place and size on the page.
    pub images: Vec<(Frame, RgbImage)>,
}

/// A text.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    /// The text.
    pub text: String,
    /// Its place.
    pub place: [f64; 2],
    /// What the place is of it.
    pub anchor: String,
}

/// A rectangle: left and right, upper and lower end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Left and right end.
    pub x: [f64; 2],
    /// Upper and lower end.
    pub y: [f64; 2],
}

/// How places along an axis are values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Two places.
    places: [f64; 2],
    /// The values there, or their logarithms.
    values: [f64; 2],
    logarithmic: bool,
}

/// A box with axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// The box.
    pub frame: Frame,
    /// The axis below.
    pub x: Axis,
    /// The axis to the left.
    pub y: Axis,
}

impl Figure {
    /// Takes an SVG text apart.
    ///
    /// # Panics
    /// When it is no SVG as the program writes it; so do the functions below where they find something else.
    pub fn read(svg: &str) -> Self {
        let document = Document::parse(svg).expect("an SVG");
        let size = ["width", "height"].map(|name| {
            let length = attribute(document.root_element(), name);
            length.strip_suffix("mm").and_then(|length| length.parse().ok()).expect("a length in mm")
        });
        let mut figure = Self { size, texts: Vec::new(), lines: Vec::new(), areas: Vec::new(), images: Vec::new() };
        for node in document.root_element().children().filter(Node::is_element) {
            match node.tag_name().name() {
                "text" => figure.texts.push(Text {
                    text: node.text().unwrap_or_default().trim().to_owned(),
                    place: [number(node, "x"), number(node, "y")],
                    anchor: attribute(node, "text-anchor").to_owned(),
                }),
                "polyline" => figure.lines.push((attribute(node, "stroke").to_owned(), points(node))),
                "polygon" => figure.areas.push((attribute(node, "fill").to_owned(), points(node))),
                "image" => {
                    let data = attribute(node, "href").strip_prefix("data:image/png;base64,").expect("a PNG");
                    let png = STANDARD.decode(data).expect("base64");
                    let ([left, top], [width, height]) =
                        (["x", "y"].map(|name| number(node, name)), ["width", "height"].map(|name| number(node, name)));
                    let frame = Frame { x: [left, left + width], y: [top, top + height] };
                    figure.images.push((frame, image::load_from_memory(&png).expect("a PNG").into_rgb8()));
                }
                "rect" => {}
                other => panic!("an element {other}"),
            }
        }
        figure
    }

    /// The boxes, in the order in which they are drawn.
    pub fn boxes(&self) -> Vec<Frame> {
        let boxes = self.lines.iter().filter(|(colour, line)| colour == INK && line.len() == 5 && line[0] == line[4]);
        boxes.map(|(_, line)| Frame { x: [line[0][0], line[2][0]], y: [line[0][1], line[2][1]] }).collect()
    }

    /// The axes of a box that has numbers below and beside it.
    pub fn panel(&self, frame: Frame) -> Panel {
        Panel { frame, x: self.x_axis(frame), y: self.y_axis(frame) }
    }

    /// The axis below a box that has numbers there.
    pub fn x_axis(&self, frame: Frame) -> Axis {
        let bottom = frame.y[1];
        let below = self.texts.iter().filter(|text| {
            let [x, y] = text.place;
            text.anchor == "middle" && along(x, frame.x) && along(y, [bottom, bottom + 30.0])
        });
        let numbers: Vec<(f64, f64)> = below.filter_map(|text| Some((text.place[0], value(&text.text)?))).collect();
        Axis::of(&numbers)
    }

    /// The axis beside a box that has numbers there.
    pub fn y_axis(&self, frame: Frame) -> Axis {
        let left = frame.x[0];
        let beside = self.texts.iter().filter(|text| {
            let [x, y] = text.place;
            text.anchor == "end" && along(x, [left - 40.0, left]) && along(y - LOWERED, frame.y)
        });
        let numbers: Vec<(f64, f64)> =
            beside.filter_map(|text| Some((text.place[1] - LOWERED, value(&text.text)?))).collect();
        Axis::of(&numbers)
    }

    /// The middles of the dots of a colour that lie in a box, from the left.
    pub fn dots(&self, colour: &str, frame: Frame) -> Vec<[f64; 2]> {
        let dots = self.areas.iter().filter(|(other, corners)| other == colour && corners.len() > 12);
        let middle = |(_, corners): &(String, Vec<[f64; 2]>)| {
            [0, 1].map(|at| {
                let ends = corners.iter().map(|corner| corner[at]);
                let low = ends.clone().fold(f64::INFINITY, f64::min);
                0.5 * (low + ends.fold(f64::NEG_INFINITY, f64::max))
            })
        };
        let mut middles: Vec<[f64; 2]> =
            dots.map(middle).filter(|[x, y]| along(*x, frame.x) && along(*y, frame.y)).collect();
        middles.sort_by(|one, other| one[0].total_cmp(&other[0]));
        middles
    }

    /// The scale of a colour bar, by the numbers on its right.
    pub fn colour_scale(&self, bar: Frame) -> Axis {
        let right = bar.x[1];
        let numbers = self.texts.iter().filter(|text| {
            let [x, y] = text.place;
            text.anchor == "start" && x > right && x < right + 40.0 && y > bar.y[0] - 8.0 && y < bar.y[1] + 8.0
        });
        let numbers = numbers.filter_map(|text| Some((text.place[1] - LOWERED, value(&text.text)?)));
        Axis::of(&numbers.collect::<Vec<_>>())
    }

    /// The places of all lines of a colour that lie in a box, joined.
    pub fn line(&self, colour: &str, frame: Frame) -> Vec<[f64; 2]> {
        let inside = |place: &[f64; 2]| {
            (frame.x[0] - 1.0..=frame.x[1] + 1.0).contains(&place[0])
                && (frame.y[0] - 1.0..=frame.y[1] + 1.0).contains(&place[1])
        };
        let lines = self.lines.iter().filter(|(other, line)| other == colour && line.iter().all(inside));
        let mut joined: Vec<[f64; 2]> = lines.flat_map(|(_, line)| line.iter().copied()).collect();
        joined.dedup();
        joined
    }
}

impl Axis {
    /// The axis with these numbers at these places.
    fn of(numbers: &[(f64, f64)]) -> Self {
        let (first, last) = (numbers.first().expect("a number"), numbers.last().expect("a number"));
        // Three numbers tell whether equal differences or equal ratios are equally far.
        let middle = numbers[numbers.len() / 2];
        let part = (middle.0 - first.0) / (last.0 - first.0);
        let linear = (first.1 + part * (last.1 - first.1) - middle.1).abs() < 0.02 * (last.1 - first.1).abs();
        let values = [first.1, last.1].map(|value| if linear { value } else { value.ln() });
        Self { places: [first.0, last.0], values, logarithmic: !linear }
    }

    /// The value at a place.
    pub fn value(&self, place: f64) -> f64 {
        let part = (place - self.places[0]) / (self.places[1] - self.places[0]);
        let value = self.values[0] + part * (self.values[1] - self.values[0]);
        if self.logarithmic { value.exp() } else { value }
    }

    /// The place of a value.
    pub fn place(&self, value: f64) -> f64 {
        let value = if self.logarithmic { value.ln() } else { value };
        let part = (value - self.values[0]) / (self.values[1] - self.values[0]);
        self.places[0] + part * (self.places[1] - self.places[0])
    }
}

/// Whether a place lies between two others, or hardly beyond.
fn along(place: f64, ends: [f64; 2]) -> bool {
    place >= ends[0] - 2.0 && place <= ends[1] + 2.0
}

/// The number that a text is.
fn value(text: &str) -> Option<f64> {
    text.replace('\u{2212}', "-").parse().ok()
}

fn attribute<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    node.attribute(name).unwrap_or_else(|| panic!("no attribute {name}"))
}

fn number(node: Node, name: &str) -> f64 {
    attribute(node, name).parse().unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn points(node: Node) -> Vec<[f64; 2]> {
    let pairs = attribute(node, "points").split_whitespace();
    pairs
        .map(|pair| {
            let (x, y) = pair.split_once(',').expect("a pair");
            [x, y].map(|part| part.parse().expect("a number"))
        })
        .collect()
}
