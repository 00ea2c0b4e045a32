//! Lines and words of a text that is read once, from front to back.

use std::io::{self, BufRead};

/// Longest line and longest word that are kept, in bytes; what is longer is cut off and then is no field or number.
const LONGEST: usize = 1000;

/// Lines and words of a text. A line ends with a line feed, a carriage return or both.
pub(super) struct Lexer<R> {
    source: R,
    line: usize,
    /// What stands after this byte in a line is skipped.
    pub(super) comment: Option<u8>,
    text: Vec<u8>,
}

impl<R: BufRead> Lexer<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source, line: 1, comment: None, text: Vec::new() }
    }

    /// Number of the line that is being read, from 1.
    pub(super) fn number(&self) -> usize {
        self.line
    }

    /// The next line, with its number, without comment and without blanks around it; nothing at the end.
    pub(super) fn line(&mut self) -> io::Result<Option<(usize, &[u8])>> {
        self.text.clear();
        let number = self.line;
        let Some(mut byte) = self.next()? else { return Ok(None) };
        let mut comment = false;
        while !self.ends_line(byte)? {
            comment |= Some(byte) == self.comment;
            if !comment {
                self.keep(byte);
            }
            let Some(next) = self.next()? else { break };
            byte = next;
        }
        Ok(Some((number, self.text.trim_ascii())))
    }

    /// The next word, with the number of its line; nothing at the end.
    pub(super) fn word(&mut self) -> io::Result<Option<(usize, &[u8])>> {
        self.text.clear();
        let (mut number, mut comment) = (self.line, false);
        while let Some(byte) = self.next()? {
            let ends_line = self.ends_line(byte)?;
            comment = !ends_line && (comment || Some(byte) == self.comment);
            if !comment && !byte.is_ascii_whitespace() {
                self.keep(byte);
            } else if !self.text.is_empty() {
                break;
            } else {
                number = self.line;
            }
        }
        Ok((!self.text.is_empty()).then_some((number, &self.text)))
    }

    fn keep(&mut self, byte: u8) {
        if self.text.len() < LONGEST {
            self.text.push(byte);
        }
    }

    fn next(&mut self) -> io::Result<Option<u8>> {
        let byte = self.source.fill_buf()?.first().copied();
        self.source.consume(usize::from(byte.is_some()));
        Ok(byte)
    }

    fn ends_line(&mut self, byte: u8) -> io::Result<bool> {
        if byte == b'\r' && self.source.fill_buf()?.first() == Some(&b'\n') {
            self.source.consume(1);
        }
        let ends = matches!(byte, b'\r' | b'\n');
        self.line += usize::from(ends);
        Ok(ends)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways_and_keep_their_numbers() {
        let mut lexer = Lexer::new(b"a \r\n\r\n b b\rc\nd".as_slice());
        for expected in [(1, "a"), (2, ""), (3, "b b"), (4, "c"), (5, "d")] {
            assert_eq!(lexer.line().unwrap(), Some((expected.0, expected.1.as_bytes())));
        }
        assert_eq!(lexer.line().unwrap(), None);
        let mut lexer = Lexer::new(b"\r\n 1 22\r\n\r3 ;4 5\n6".as_slice());
        lexer.comment = Some(b';');
        for expected in [(2, "1"), (2, "22"), (4, "3"), (5, "6")] {
            assert_eq!(lexer.word().unwrap(), Some((expected.0, expected.1.as_bytes())));
        }
        assert_eq!(lexer.word().unwrap(), None);
    }

    #[test]
    fn a_word_without_end_is_not_kept_as_a_whole() {
        let text = vec![b'7'; 100_000];
        assert_eq!(Lexer::new(text.as_slice()).word().unwrap().unwrap().1.len(), LONGEST);
        assert_eq!(Lexer::new(text.as_slice()).line().unwrap().unwrap().1.len(), LONGEST);
    }
}
