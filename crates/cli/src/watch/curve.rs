//! A curve made of characters.

/// What the dots of a curve are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dots {
    /// Braille letters: two by four dots each.
    Braille,
    /// One star a character.
    Stars,
}

impl Dots {
    /// Dots of a character, in width and height.
    fn of_a_character(self) -> (usize, usize) {
        match self {
            Self::Braille => (2, 4),
            Self::Stars => (1, 1),
        }
    }

    /// The character with these dots, row by row from the top.
    fn character(self, dots: &[bool]) -> char {
        match self {
            // The dots of a Braille letter are numbered down the left column and down the right one, but for the
            // lowest two, which were added later.
            Self::Braille => {
                const BITS: [u32; 8] = [0x01, 0x08, 0x02, 0x10, 0x04, 0x20, 0x40, 0x80];
                let bits = dots.iter().zip(BITS).filter(|(dot, _)| **dot).map(|(_, bit)| bit).sum::<u32>();
                if bits == 0 { ' ' } else { char::from_u32(0x2800 + bits).unwrap_or(' ') }
            }
            Self::Stars => {
                if dots.contains(&true) {
                    '*'
                } else {
                    ' '
                }
            }
        }
    }
}

/// Draws values against times as lines of characters, the highest first; the first time is at the left, the last at the
/// right, `range` (low, high) at bottom and top.
pub fn curve(times: &[f64], values: &[f64], range: (f64, f64), size: (usize, usize), dots: Dots) -> Vec<String> {
    let ((columns, rows), (wide, high)) = (size, dots.of_a_character());
    let (width, height) = (columns * wide, rows * high);
    let mut marks = vec![false; width * height];
    let (Some(first), Some(last), false) = (times.first(), times.last(), marks.is_empty()) else {
        return vec![" ".repeat(columns); rows];
    };
    let place = |value: f64, (low, high): (f64, f64), dots: usize| {
        let part = if high > low { (value - low) / (high - low) } else { 0.5 };
        (part.clamp(0.0, 1.0) * dots.saturating_sub(1) as f64).round()
    };
    let mut previous = None;
    for (time, value) in times.iter().zip(values).filter(|(_, value)| value.is_finite()) {
        let x = place(*time, (*first, *last), width);
        let y = place(*value, range, height);
        let (from_x, from_y) = previous.unwrap_or((x, y));
        let steps = f64::max((x - from_x).abs(), (y - from_y).abs()).max(1.0);
        for step in 0..=steps as usize {
            let part = step as f64 / steps;
            let (x, y) = (from_x + part * (x - from_x), from_y + part * (y - from_y));
            // Rows are counted from the top.
            let mark = (height - 1 - y.round() as usize) * width + x.round() as usize;
            marks[mark] = true;
        }
        previous = Some((x, y));
    }
    let character = |column: usize, row: usize| {
        let dot = |index: usize| marks[(row * high + index / wide) * width + column * wide + index % wide];
        dots.character(&(0..wide * high).map(dot).collect::<Vec<_>>())
    };
    (0..rows).map(|row| (0..columns).map(|column| character(column, row)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_is_a_diagonal() {
        let lines = curve(&[0.0, 4.0], &[1.0, 5.0], (1.0, 5.0), (5, 5), Dots::Stars);
        assert_eq!(lines, ["    *", "   * ", "  *  ", " *   ", "*    "]);
        // In Braille, by the table of the Unicode standard: dots 7, 3+... going up one row and one column at a time.
        let lines = curve(&[0.0, 3.0], &[0.0, 3.0], (0.0, 3.0), (2, 1), Dots::Braille);
        assert_eq!(lines, ["\u{2860}\u{280a}"]); // dots 7 and 6, then 2 and 4
    }

    #[test]
    fn many_samples_in_one_column_are_all_seen() {
        let times: Vec<f64> = (0..1000).map(f64::from).collect();
        let values: Vec<f64> = (0..1000).map(|sample| f64::from(sample % 2)).collect();
        assert_eq!(curve(&times, &values, (0.0, 1.0), (3, 2), Dots::Stars), ["***", "***"]);
    }

    #[test]
    fn nothing_constant_and_not_finite_are_drawn() {
        assert_eq!(curve(&[], &[], (0.0, 1.0), (3, 1), Dots::Stars), ["   "]);
        assert_eq!(curve(&[1.0], &[2.0], (2.0, 2.0), (1, 1), Dots::Stars), ["*"]);
        let values = [1.0, f64::NAN, 1.0];
        assert_eq!(curve(&[0.0, 1.0, 2.0], &values, (0.0, 1.0), (3, 2), Dots::Stars), ["***", "   "]);
        assert_eq!(curve(&[0.0, 1.0], &[0.0, 1.0], (0.0, 1.0), (0, 0), Dots::Braille), [""; 0]);
    }
}
