//! What is drawn on a canvas, as the operators of a PDF page.

use std::collections::BTreeMap;
use std::convert::Infallible;

use pdf_writer::{Content, Name, Str};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontTransform,
};
use subsetter::GlyphRemapper;
use ttf_parser::{Face, GlyphId};

/// Height of the line over the size of the letters, as the drawing library's SVG has it.
const LINE_OVER_SIZE: f64 = 1.24;
/// Distance of the baseline from the place of a text that stands below it, beside it and above it, over the size of its
/// letters.
const BASELINE: [f64; 3] = [0.76, 0.27, -0.27];

/// The operators of a page, and what they need besides.
pub struct Operators<'a> {
    /// The operators; places are in pixels from the upper left corner.
    pub content: Content,
    /// Numbers of the glyphs that are used.
    pub glyphs: GlyphRemapper,
    /// The letters that they stand for, by their number in the font.
    pub letters: BTreeMap<u16, char>,
    /// The opacities that are used, per mille.
    pub opacities: Vec<u16>,
    /// The font.
    pub face: Face<'a>,
}

impl Operators<'_> {
    fn fill_colour(&mut self, colour: BackendColor) {
        let [red, green, blue] = levels(colour);
        self.content.set_fill_rgb(red, green, blue);
    }

    /// The name of an opacity among the resources of the page.
    fn opacity(&mut self, opacity: f64) -> String {
        let per_mille = (1000.0 * opacity).round() as u16;
        if !self.opacities.contains(&per_mille) {
            self.opacities.push(per_mille);
        }
        format!("O{per_mille}")
    }

    /// A path, to be stroked or filled.
    fn path(&mut self, places: impl IntoIterator<Item = BackendCoord>) {
        for (index, (x, y)) in places.into_iter().enumerate() {
            let (x, y) = (x as f32, y as f32);
            if index == 0 {
                self.content.move_to(x, y)
            } else {
                self.content.line_to(x, y)
            };
        }
    }

    /// The bytes that stand for a text, and its width over the size of its letters.
    fn encoded(&mut self, text: &str) -> (Vec<u8>, f64) {
        let mut bytes = Vec::new();
        let mut width = 0.0;
        for letter in text.chars() {
            let glyph = self.face.glyph_index(letter).unwrap_or(GlyphId(0));
            self.letters.entry(glyph.0).or_insert(letter);
            bytes.extend(self.glyphs.remap(glyph.0).to_be_bytes());
            width += f64::from(self.face.glyph_hor_advance(glyph).unwrap_or(0));
        }
        (bytes, width / f64::from(self.face.units_per_em()))
    }
}

fn levels(colour: BackendColor) -> [f32; 3] {
    let (red, green, blue) = colour.rgb;
    [red, green, blue].map(|level| f32::from(level) / 255.0)
}

/// Draws into operators.
pub struct PdfBackend<'a, 'b> {
    /// The operators.
    pub operators: &'a mut Operators<'b>,
    /// Width and height of the page, pixels.
    pub size: (u32, u32),
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for PdfBackend<'_, '_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> Drawn {
        self.operators.fill_colour(colour);
        self.operators.content.rect(x as f32, y as f32, 1.0, 1.0).fill_nonzero();
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn {
        let [red, green, blue] = levels(style.color());
        self.operators.content.set_stroke_rgb(red, green, blue).set_line_width(style.stroke_width() as f32);
        self.operators.path(path);
        self.operators.content.stroke();
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, corners: I, style: &S) -> Drawn {
        let opacity = self.operators.opacity(style.color().alpha);
        self.operators.content.save_state().set_parameters(Name(opacity.as_bytes()));
        self.operators.fill_colour(style.color());
        self.operators.path(corners);
        self.operators.content.close_path().fill_nonzero().restore_state();
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Drawn {
        let size = style.size() / LINE_OVER_SIZE;
        let (bytes, width) = self.operators.encoded(text);
        let along = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => -0.5 * width * size,
            HPos::Right => -width * size,
        };
        let down = size
            * match style.anchor().v_pos {
                VPos::Top => BASELINE[0],
                VPos::Center => BASELINE[1],
                VPos::Bottom => BASELINE[2],
            };
        // Columns of the matrix: along the text, up its letters, its place; y of the page grows downward.
        let (x, y) = (f64::from(x), f64::from(y));
        let matrix = match style.transform() {
            FontTransform::Rotate90 => [0.0, 1.0, 1.0, 0.0, x - down, y + along],
            FontTransform::Rotate180 => [-1.0, 0.0, 0.0, 1.0, x - along, y - down],
            FontTransform::Rotate270 => [0.0, -1.0, -1.0, 0.0, x + down, y - along],
            FontTransform::None => [1.0, 0.0, 0.0, -1.0, x + along, y + down],
        };
        self.operators.fill_colour(style.color());
        let content = &mut self.operators.content;
        content.begin_text().set_font(Name(b"F"), size as f32).set_text_matrix(matrix.map(|part| part as f32));
        content.show(Str(&bytes)).end_text();
        Ok(())
    }
}
