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

/// The least part of the room that is left for a name beside its unit.
const LEAST_NAME: f64 = 0.35;
/// What stands between the factors of an interaction.
const TIMES: &str = " \u{d7} ";
/// Letters of the last part of a key, at least: the ending of a file has fewer.
const LEAST_OF_KEY: usize = 4;

/// A text that is too long for its room, made shorter: of an interaction each factor is shortened, a unit behind the last comma stays whole,
/// of a key its last two parts tell what it is, of all else the middle is left out.
pub fn shortened(text: &str, size: u32, room: f64) -> String {
    if text_width(text, size) <= room {
        return text.to_owned();
    }
    let factors: Vec<&str> = text.split(TIMES).collect();
    if factors.len() > 1 {
        return of_factors(&factors, size, room);
    }
    if let Some((name, _)) = text.rsplit_once(", ") {
        let unit = &text[name.len()..];
        let left = room - text_width(unit, size);
        if left >= LEAST_NAME * room {
            return of_name(name, size, left) + unit;
        }
    }
    of_name(text, size, room)
}

/// A key with its last parts, two at least, any other name without its middle.
fn of_name(name: &str, size: u32, room: f64) -> String {
    if text_width(name, size) <= room {
        return name.to_owned();
    }
    let is_key = !name.contains(' ') && name.rsplit('.').next().is_some_and(|last| last.len() >= LEAST_OF_KEY);
    let dots: Vec<usize> = if is_key { name.match_indices('.').map(|(at, _)| at).collect() } else { Vec::new() };
    let ends = dots.split_last().map_or(&[][..], |(_, before)| before);
    let end = |at: &usize| &name[at + 1..];
    let fitting = ends.iter().map(|at| format!("\u{2026}{}", end(at))).find(|end| text_width(end, size) <= room);
    fitting.unwrap_or_else(|| without_middle(ends.last().map_or(name, end), size, room))
}

/// The factors of an interaction in so much room; what short ones leave is shared among the others.
fn of_factors(factors: &[&str], size: u32, room: f64) -> String {
    let count = factors.len() as f64;
    let each = ((room - (count - 1.0) * text_width(TIMES, size)) / count).max(0.0);
    let widths: Vec<f64> = factors.iter().map(|factor| text_width(factor, size)).collect();
    let spare: f64 = widths.iter().map(|width| (each - width).max(0.0)).sum();
    let long = widths.iter().filter(|width| **width > each).count().max(1) as f64;
    let within = |factor: &&str| shortened(factor, size, each + spare / long);
    factors.iter().map(within).collect::<Vec<_>>().join(TIMES)
}

fn without_middle(text: &str, size: u32, room: f64) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut kept = letters.len().saturating_sub(1);
    loop {
        let (begin, end) = (&letters[..kept.div_ceil(2)], &letters[letters.len() - kept / 2..]);
        let shown: String = begin.iter().chain(&['\u{2026}']).chain(end).collect();
        if kept == 0 || text_width(&shown, size) <= room {
            return shown;
        }
        kept -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_tells_texts_apart_stays() {
        let within = |text: &str, letters: &str| shortened(text, 40, text_width(letters, 40) + 1.0);
        assert_eq!(within("a short one", "a short one"), "a short one");
        assert_eq!(within("a name that is long", "a nam\u{2026} long"), "a nam\u{2026} long");
        assert_eq!(
            within(
                "wear rate of the pin, 10\u{207b}\u{b9}\u{2074} 1/Pa",
                "wea\u{2026}pin, 10\u{207b}\u{b9}\u{2074} 1/Pa"
            ),
            "wea\u{2026}pin, 10\u{207b}\u{b9}\u{2074} 1/Pa"
        );
        let key = "materials.pin_primary.poisson_ratio";
        assert_eq!(within(key, "\u{2026}pin_primary.poisson_ratio"), "\u{2026}pin_primary.poisson_ratio");
        // Its body is not left out, or keys of two bodies would look the same.
        assert_eq!(within(key, "pin_pri\u{2026}_ratio"), "pin_pri\u{2026}_ratio");
        // The ending of a file is not what it is called.
        assert_eq!(within("a_file_with_a_long_name.h5", "a_fil\u{2026}me.h5"), "a_fil\u{2026}me.h5");
        let both = format!("{key} \u{d7} load");
        assert_eq!(within(&both, "pin_pri\u{2026}_ratio \u{d7} load"), "pin_pri\u{2026}_ratio \u{d7} load");
        // Commas in names are not those before a unit, and what begins otherwise looks otherwise.
        assert_eq!(within("Ra 0.5 um, 5 N, seed 1", "Ra 0\u{2026} 5 N, seed 1"), "Ra 0\u{2026} 5 N, seed 1");
        assert_eq!(
            within("side A, hard \u{d7} load", "si\u{2026}A, hard \u{d7} load"),
            "si\u{2026}A, hard \u{d7} load"
        );
        // Nothing fits: what is left says that something was there.
        assert_eq!(shortened("name", 40, 0.0), "\u{2026}");
    }
}
