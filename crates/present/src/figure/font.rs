//! The font of all figures, and how wide texts are in it.

use std::sync::Once;

use plotters::prelude::IntoFont as _;
use plotters::style::{FontStyle, register_font};

/// DejaVu Sans, which has the letters of most names that files have; its licence is beside it.
pub const FONT: &[u8] = include_bytes!("../../fonts/DejaVuSans.ttf");
/// What it is called in SVG, with what stands in for it where it is not installed: Verdana is as wide.
pub const FONT_NAME: &str = "DejaVu Sans, Verdana, sans-serif";

/// Makes the font known to the drawing library.
pub fn register() {
    static ONCE: Once = Once::new();
    // A font that is part of the program is a font; where it were not, drawing text would fail with a reason.
    ONCE.call_once(|| drop(register_font(FONT_NAME, FontStyle::Normal, FONT)));
}

/// Width of a text, pixels.
pub fn text_width(text: &str, size: u32) -> f64 {
    register();
    (FONT_NAME, size).into_font().box_size(text).map_or(0.0, |(width, _)| f64::from(width))
}

/// A text in lines of this room, broken between pieces; a piece that is too long has a line of its own.
pub fn lines<'a>(pieces: impl Iterator<Item = &'a str>, size: u32, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for piece in pieces {
        match lines.last_mut() {
            Some(line) if text_width(format!("{line}{piece}").trim_end(), size) <= room => line.push_str(piece),
            _ => lines.push(piece.to_owned()),
        }
    }
    lines.into_iter().map(|line| line.trim_end().to_owned()).collect()
}

/// A text that is too long for its room, with its middle left out.
pub fn shortened(text: &str, size: u32, room: f64) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut kept = letters.len();
    loop {
        let shown: String = if kept == letters.len() {
            text.to_owned()
        } else {
            let (begin, end) = (&letters[..kept.div_ceil(2)], &letters[letters.len() - kept / 2..]);
            begin.iter().chain(&['\u{2026}']).chain(end).collect()
        };
        if kept == 0 || text_width(&shown, size) <= room {
            return shown;
        }
        kept -= 1;
    }
}
