//! A page as PDF, with the letters of the font that it uses.

use pdf_writer::types::{CidFontType, FontFlags, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish as _, Name, Pdf, Rect, Ref, Str, TextStr};
use subsetter::GlyphRemapper;
use ttf_parser::{Face, GlyphId};

use super::pdf_backend::{Operators, PdfBackend};
use crate::deflate::deflate;
use crate::figure::canvas::{Canvas, FigureError, failed};
use crate::figure::font::FONT;
use crate::figure::page::{PER_MILLIMETRE, Page};

/// Points of a pixel: there are 72 in 25.4 mm.
const POINTS: f64 = 72.0 / 25.4 / PER_MILLIMETRE;
const FONT_NAME: Name = Name(b"PLATEA+DejaVuSans");
/// How glyphs are numbered: by bytes, as they are.
const IDENTITY: SystemInfo = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// The page as PDF.
pub fn pdf(page: &Page, title: &str) -> Result<Vec<u8>, FigureError> {
    let face = Face::parse(FONT, 0).map_err(failed)?;
    let (width, height) = page.pixels();
    let [wide, high] = page.size.map(|length| (POINTS * length) as f32);
    let mut operators = Operators {
        content: Content::new(),
        glyphs: GlyphRemapper::new(),
        letters: Default::default(),
        opacities: Vec::new(),
        face,
    };
    let scale = POINTS as f32;
    operators.content.transform([scale, 0.0, 0.0, -scale, 0.0, high]);
    operators.content.set_line_join(LineJoinStyle::RoundJoin);
    let mut document = Document { pdf: Pdf::new(), last: 0 };
    let images = document.images(page, &mut operators.content);
    let canvas = Canvas::clear(PdfBackend { operators: &mut operators, size: (width, height) });
    page.draw(&canvas)?;
    canvas.finish()?;
    let Operators { content, glyphs, letters, opacities, face } = operators;
    let font = document.font(&face, &glyphs, &letters)?;
    let [catalog, pages, sheet, operators, information] = [(); 5].map(|()| document.next());
    let Document { mut pdf, .. } = document;
    pdf.document_info(information).title(TextStr(title)).creator(TextStr("plateau"));
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([sheet]).count(1);
    let mut leaf = pdf.page(sheet);
    leaf.media_box(Rect::new(0.0, 0.0, wide, high)).parent(pages).contents(operators);
    let mut resources = leaf.resources();
    resources.fonts().pair(Name(b"F"), font);
    let mut objects = resources.x_objects();
    for (name, image) in &images {
        objects.pair(Name(name.as_bytes()), *image);
    }
    objects.finish();
    let mut states = resources.ext_g_states();
    for per_mille in opacities {
        let mut state =
            states.insert(Name(format!("O{per_mille}").as_bytes())).start::<pdf_writer::writers::ExtGraphicsState>();
        state.non_stroking_alpha(f32::from(per_mille) / 1000.0);
    }
    states.finish();
    resources.finish();
    leaf.finish();
    let content = deflate(&content.finish().into_vec());
    pdf.stream(operators, &content).filter(Filter::FlateDecode);
    Ok(pdf.finish())
}

/// A document in the making.
struct Document {
    pdf: Pdf,
    last: i32,
}

impl Document {
    /// A new reference.
    fn next(&mut self) -> Ref {
        self.last += 1;
        Ref::new(self.last)
    }

    /// Adds the bitmaps of the page and the operators that show them; gives their names.
    fn images(&mut self, page: &Page, content: &mut Content) -> Vec<(String, Ref)> {
        let mut names = Vec::new();
        for (number, (frame, picture)) in page.pictures().into_iter().enumerate() {
            let (name, reference) = (format!("M{number}"), self.next());
            let data = deflate(&picture.indices);
            let mut image = self.pdf.image_xobject(reference, &data);
            image.filter(Filter::FlateDecode);
            image.width(picture.columns as i32).height(picture.rows as i32);
            let last_colour = picture.palette.len() as i32 - 1;
            image.color_space().indexed(Name(b"DeviceRGB"), last_colour, &picture.palette_bytes());
            image.bits_per_component(8).interpolate(false);
            let place = [frame.width(), 0.0, 0.0, -frame.height(), frame.x[0], frame.y[1]];
            content.save_state().transform(place.map(|part| part as f32));
            content.x_object(Name(name.as_bytes())).restore_state();
            names.push((name, reference));
        }
        names
    }

    /// Adds the glyphs that are used.
    fn font(
        &mut self,
        face: &Face,
        glyphs: &GlyphRemapper,
        letters: &std::collections::BTreeMap<u16, char>,
    ) -> Result<Ref, FigureError> {
        let [font, cid_font, descriptor, file, unicode] = [(); 5].map(|()| self.next());
        let per_thousand = |units: f64| (1000.0 * units / f64::from(face.units_per_em())) as f32;
        self.pdf
            .type0_font(font)
            .base_font(FONT_NAME)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(cid_font)
            .to_unicode(unicode);
        let mut cid = self.pdf.cid_font(cid_font);
        cid.subtype(CidFontType::Type2).base_font(FONT_NAME).system_info(IDENTITY).font_descriptor(descriptor);
        cid.cid_to_gid_map_predefined(Name(b"Identity"));
        let advance = |glyph: u16| f64::from(face.glyph_hor_advance(GlyphId(glyph)).unwrap_or(0));
        cid.widths().consecutive(0, glyphs.remapped_gids().map(|glyph| per_thousand(advance(glyph))));
        cid.finish();
        let bounds = face.global_bounding_box();
        let [left, bottom, right, top] =
            [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(|units| per_thousand(f64::from(units)));
        self.pdf
            .font_descriptor(descriptor)
            .name(FONT_NAME)
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(left, bottom, right, top))
            .italic_angle(0.0)
            .ascent(per_thousand(f64::from(face.ascender())))
            .descent(per_thousand(f64::from(face.descender())))
            .cap_height(per_thousand(face.capital_height().map_or(0.0, f64::from)))
            .stem_v(80.0)
            .font_file2(file);
        let subset = subsetter::subset(FONT, 0, glyphs).map_err(failed)?;
        let data = deflate(&subset);
        self.pdf.stream(file, &data).filter(Filter::FlateDecode).pair(Name(b"Length1"), subset.len() as i32);
        let mut map = UnicodeCmap::new(Name(b"Custom"), IDENTITY);
        for (glyph, letter) in letters {
            if let Some(number) = glyphs.get(*glyph) {
                map.pair(number, *letter);
            }
        }
        self.pdf.cmap(unicode, &map.finish());
        Ok(font)
    }
}
