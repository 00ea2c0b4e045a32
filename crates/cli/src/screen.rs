//! Display of a run: a page of the terminal that is drawn anew, or line after line where there is no terminal.

use std::env;
use std::io::{self, Write};

use crate::watch::page::{self, Style};
use crate::watch::{Look, Pace};
use console::Term;

use crate::message;

/// Standard output.
#[derive(Debug)]
pub struct Screen {
    /// None where standard output is no terminal.
    terminal: Option<Term>,
    unicode: bool,
    /// Lines of the page that is shown.
    lines: usize,
    /// Lines and characters of the terminal when it was drawn.
    size: (u16, u16),
    /// Line that was said last, where there is no terminal.
    said: String,
    warned: bool,
}

impl Screen {
    /// Standard output as it is.
    pub fn new() -> Self {
        let terminal = Term::buffered_stdout();
        let can_move = env::var_os("TERM").is_some_and(|name| name != "dumb");
        Self {
            terminal: (terminal.is_term() && can_move).then_some(terminal),
            unicode: is_unicode(|name| env::var(name).ok()),
            lines: 0,
            size: (0, 0),
            said: String::new(),
            warned: false,
        }
    }

    /// Shows a look, and the warning if there is one.
    pub fn show(&mut self, look: &Look, pace: &Pace, warning: Option<&str>) -> io::Result<()> {
        match &self.terminal {
            Some(terminal) => {
                let size = terminal.size();
                let (height, width) = size;
                let style = Style { unicode: self.unicode, width: width.into(), height: height.into() };
                let lines = page::page(look, pace, warning, style);
                if self.lines > 0 && size != self.size {
                    // The terminal has broken the old lines anew: nobody knows how many they are now.
                    terminal.clear_screen()?;
                } else {
                    terminal.clear_last_lines(self.lines)?;
                }
                (self.lines, self.size) = (lines.len(), size);
                lines.iter().try_for_each(|line| terminal.write_line(line))?;
                terminal.flush()
            }
            None => {
                if let Some(warning) = warning.filter(|_| !self.warned) {
                    message::warning(warning);
                }
                self.warned = warning.is_some();
                let what = format!("{} {}", look.state.name(), look.times.len());
                if what == self.said {
                    return Ok(());
                }
                self.said = what;
                let mut out = io::stdout().lock();
                writeln!(out, "{}", page::line(look, pace, warning, self.unicode))?;
                out.flush()
            }
        }
    }
}

/// Tells whether the locale has letters beyond ASCII, as the C library finds out.
fn is_unicode(variable: impl Fn(&str) -> Option<String>) -> bool {
    let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(|name| variable(name).filter(|l| !l.is_empty()));
    locale.is_some_and(|locale| {
        let locale = locale.to_ascii_lowercase();
        locale.contains("utf-8") || locale.contains("utf8")
    })
}

#[cfg(test)]
#[path = "../tests/unit/screen.rs"]
mod tests;
