//! `plateau watch`: follow a run file that is being written, in a line or as a page of the terminal with a curve made of characters.

use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};
use std::{env, fs, thread};

use console::{Term, style};
use plateau_io::number;
use plateau_io::run_file::{ReadError, State};

use crate::arguments::WatchArguments;
use crate::failure::Failure;
use crate::look::{Look, Pace};
use crate::message;
use crate::output::on_one_line;
use crate::terminal::Interrupt;

/// Time between two looks, at least.
const INTERVAL: Duration = Duration::from_secs(1);
/// Least pause after a look, as a multiple of the time that the look took.
const PART: u32 = 5;
/// Time between two questions whether a signal has come.
const NAP: Duration = Duration::from_millis(50);
/// Time for which a file may look damaged: its writer closes it, or replaces it.
const MENDING: Duration = Duration::from_secs(3);
/// Time for which a file is waited for unless a timeout is given.
const ARRIVAL: Duration = Duration::from_secs(10);

/// Shows a run until it ends.
pub fn watch(arguments: &WatchArguments) -> Result<(), Failure> {
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    let mut watcher = Watcher::new(arguments);
    let mut screen = Screen::new();
    if !arguments.once && !arguments.run.exists() {
        message::note(format_args!("waiting for {}", arguments.run.display()));
    }
    loop {
        let start = Instant::now();
        if let Some(look) = watcher.look()? {
            let warning = watcher.warning(&look);
            match screen.show(&look, &watcher.pace, warning.as_deref()) {
                // Nobody is left to be shown anything.
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
                shown => shown.map_err(Failure::run)?,
            }
            if arguments.once {
                return Ok(());
            }
            if look.state != State::Running {
                return ended(&look);
            }
            watcher.last = Some(look);
        }
        watcher.check_timeout()?;
        let next = Instant::now() + INTERVAL.max(start.elapsed() * PART);
        while Instant::now() < next {
            if let Some(signal) = interrupt.signal() {
                return Err(Failure::stopped(signal, None));
            }
            thread::sleep(NAP);
        }
    }
}

/// Meaning of the end of a run for the exit status.
fn ended(look: &Look) -> Result<(), Failure> {
    match look.state {
        State::Failed => {
            let reason = look.error.as_deref().unwrap_or("its file does not say why");
            Err(Failure::run(format_args!("the run failed: {reason}")))
        }
        State::Interrupted => {
            Err(Failure::run(format_args!("the run was stopped at {} s", number::short(look.time()))))
        }
        State::Finished | State::Running => Ok(()),
    }
}

/// Looks at a run file again and again.
struct Watcher<'a> {
    path: &'a Path,
    once: bool,
    timeout: Option<Duration>,
    pace: Pace,
    last: Option<Look>,
    /// Size and time of the file that was looked at last, and how often it was.
    stamp: (Option<(u64, SystemTime)>, u32),
    /// Moment since which the file cannot be read.
    unreadable: Option<Instant>,
}

impl<'a> Watcher<'a> {
    fn new(arguments: &'a WatchArguments) -> Self {
        Self {
            path: &arguments.run,
            once: arguments.once,
            timeout: arguments.timeout.map(Duration::from_secs),
            pace: Pace::new(Instant::now()),
            last: None,
            stamp: (None, 0),
            unreadable: None,
        }
    }

    /// Content of the file now; nothing while it is not there, or is just being closed.
    fn look(&mut self) -> Result<Option<Look>, Failure> {
        let stamp = fs::metadata(self.path).and_then(|file| Ok((file.len(), file.modified()?))).ok();
        // Twice, for a file system may give two changes shortly after one another the same time.
        let seen = if stamp == self.stamp.0 { self.stamp.1 } else { 0 };
        if let (Some(last), Some((_, written)), 2..) = (&self.last, stamp, seen) {
            return Ok(Some(Look { age: written.elapsed().unwrap_or_default(), ..last.clone() }));
        }
        self.stamp = (stamp, seen + 1);
        match Look::at(self.path) {
            Ok(look) => {
                self.unreadable = None;
                self.pace.note(&look, Instant::now());
                Ok(Some(look))
            }
            Err(error) => self.unreadable(error),
        }
    }

    /// Tells whether a file that cannot be read is worth waiting for.
    fn unreadable(&mut self, error: ReadError) -> Result<Option<Look>, Failure> {
        let since = *self.unreadable.get_or_insert_with(Instant::now);
        let absent = !self.path.exists();
        let patience = match error {
            ReadError::System { .. } if absent && self.once => Duration::ZERO,
            ReadError::System { .. } if absent => self.timeout.unwrap_or(ARRIVAL),
            ReadError::Damaged { .. } => MENDING,
            _ => Duration::ZERO,
        };
        if since.elapsed() < patience {
            return Ok(None);
        }
        let within = || format!("; none came within {}", number::duration(patience.as_secs_f64()));
        let waited = if absent && !self.once { within() } else { String::new() };
        Err(Failure::because(&error, format_args!("{error}{waited}")))
    }

    /// Warns that the run may have been killed, if so it seems.
    fn warning(&self, look: &Look) -> Option<String> {
        let silence = self.pace.silence(look, Instant::now()).filter(|_| look.state == State::Running)?;
        let silence = number::duration(silence.as_secs_f64().floor());
        Some(format!("no new sample for {silence}; the run may have been killed"))
    }

    fn check_timeout(&self) -> Result<(), Failure> {
        let Some(timeout) = self.timeout else { return Ok(()) };
        if self.last.is_none() || self.pace.idle(Instant::now()) < timeout {
            return Ok(());
        }
        let (path, timeout) = (self.path.display(), number::duration(timeout.as_secs_f64()));
        Err(Failure::run(format_args!("{path} has no new sample for {timeout}; the run may have been killed")))
    }
}

/// Standard output.
#[derive(Debug)]
struct Screen {
    /// Terminal; none where standard output is something else.
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
    fn new() -> Self {
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

    fn show(&mut self, look: &Look, pace: &Pace, warning: Option<&str>) -> io::Result<()> {
        match &self.terminal {
            Some(terminal) => {
                let size = terminal.size();
                let (height, width) = size;
                let style = Style { unicode: self.unicode, width: width.into(), height: height.into() };
                let lines = page(look, pace, warning, style);
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
                writeln!(out, "{}", line(look, pace, warning, self.unicode))?;
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

/// Dots of a character of a curve, in width and height: of a Braille letter, or of a star.
fn dots_of(unicode: bool) -> (usize, usize) {
    if unicode { (2, 4) } else { (1, 1) }
}

/// The character with these dots, row by row from the top: a Braille letter, or a star.
fn character(dots: &[bool], unicode: bool) -> char {
    // The dots of a Braille letter are numbered down the left column and down the right one, but for the lowest two, which were
    // added later.
    const BITS: [u32; 8] = [0x01, 0x08, 0x02, 0x10, 0x04, 0x20, 0x40, 0x80];
    match dots.iter().zip(BITS).filter(|(dot, _)| **dot).map(|(_, bit)| bit).sum::<u32>() {
        0 => ' ',
        bits if unicode => char::from_u32(0x2800 + bits).unwrap_or(' '),
        _ => '*',
    }
}

/// Draws values against times as lines of characters, the highest first; the first time is at the left, the last at the
/// right, `range` (low, high) at bottom and top.
fn curve(times: &[f64], values: &[f64], range: (f64, f64), size: (usize, usize), unicode: bool) -> Vec<String> {
    let ((columns, rows), (wide, high)) = (size, dots_of(unicode));
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
    let at = |column: usize, row: usize| {
        let dot = |index: usize| marks[(row * high + index / wide) * width + column * wide + index % wide];
        character(&(0..wide * high).map(dot).collect::<Vec<_>>(), unicode)
    };
    (0..rows).map(|row| (0..columns).map(|column| at(column, row)).collect()).collect()
}

/// Square millimetres in a square metre.
const MM2: f64 = 1e6;
/// Characters of the progress bar, at least and at most.
const BAR: (usize, usize) = (8, 28);
/// Lines of a curve, at least and at most.
const CURVE_LINES: (usize, usize) = (3, 12);
/// Characters of a curve in width, at least.
const CURVE_WIDTH: usize = 20;

/// Drawing of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Style {
    /// Letters beyond ASCII.
    unicode: bool,
    /// Characters of a line.
    width: usize,
    /// Lines of the terminal.
    height: usize,
}

/// Everything in one line.
fn line(look: &Look, pace: &Pace, warning: Option<&str>, unicode: bool) -> String {
    let mut parts = vec![progress(look)];
    parts.extend(speed(look, pace, warning));
    parts.push(format!("{} samples", number::grouped(look.times.len() as u64)));
    parts.extend(contact_area(look));
    readable(&format!("{}: {}", look.state.name(), parts.join(", ")), unicode)
}

/// The lines of a page, which fit the terminal and leave its last line to the cursor.
fn page(look: &Look, pace: &Pace, warning: Option<&str>, page: Style) -> Vec<String> {
    let Style { unicode, height, .. } = page;
    // One character less than there is room for: some terminals begin a new line after the last.
    let width = page.width.saturating_sub(1);
    let state = match look.state {
        State::Running => style(look.state.name()).cyan(),
        State::Finished => style(look.state.name()).green(),
        State::Interrupted => style(look.state.name()).yellow(),
        State::Failed => style(look.state.name()).red(),
    };
    let mut lines = vec![format!("{state}: {}", style(readable(&look.title, unicode)).bold())];
    let progress = progress(look);
    let bar = look.progress().and_then(|done| bar(done, unicode, width.saturating_sub(progress.len() + 2)));
    lines.push(bar.map(|bar| bar + "  ").unwrap_or_default() + &progress);
    let samples = format!("{} samples", number::grouped(look.times.len() as u64));
    let speed = speed(look, pace, warning).into_iter().chain([samples]).collect::<Vec<_>>().join(", ");
    lines.extend(folded(&speed, width));
    lines.extend(contact_area(look).iter().flat_map(|text| folded(&readable(text, unicode), width)));
    let warning = warning.map(|warning| folded(&readable(warning, unicode), width)).unwrap_or_default();
    lines.extend(warning.iter().map(|line| style(line).yellow().to_string()));
    let room = height.saturating_sub(lines.len() + 4);
    lines.extend(chart(look, unicode, width, room));
    // A page that scrolls could not be drawn over.
    lines.truncate(height.saturating_sub(1).max(1));
    let cut = if unicode { "…" } else { "~" };
    lines.into_iter().map(|line| console::truncate_str(&line, width, cut).into_owned()).collect()
}

/// A text in lines of this width, as far as it can be broken after commas and semicolons.
fn folded(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in text.split_inclusive([',', ';']).map(str::trim_start) {
        match lines.last_mut() {
            Some(line) if console::measure_text_width(line) + 1 + console::measure_text_width(part) <= width => {
                *line += " ";
                *line += part;
            }
            _ => lines.push(part.to_owned()),
        }
    }
    lines
}

fn progress(look: &Look) -> String {
    let time = look.time();
    match (look.duration, look.progress()) {
        // The last step may end a little later than asked for.
        (Some(duration), Some(done)) => {
            let (time, duration) = (number::short(time.min(duration)), number::short(duration));
            format!("{time} of {duration} s ({} %)", (100.0 * done).floor())
        }
        _ => format!("{} s", number::short(time)),
    }
}

/// The speed, and the time left unless the run may have been killed.
fn speed(look: &Look, pace: &Pace, warning: Option<&str>) -> Option<String> {
    let speed = pace.speed(look)?;
    let text = format!("{} simulated s per s", number::short(speed));
    match (look.state, look.duration, warning) {
        (State::Running, Some(duration), None) => {
            Some(format!("{text}, {} left", number::duration((duration - look.time()).max(0.0) / speed)))
        }
        _ => Some(text),
    }
}

fn contact_area(look: &Look) -> Option<String> {
    let area = look.contact_area.last()?;
    let mut text = format!("contact area {:.4} mm²", MM2 * area);
    if let Some(mean) = look.contact_area_mean.last() {
        text += &format!(", mean of the last revolution {:.4} mm²", MM2 * mean);
    }
    if let Some(filled) = look.filled_fraction {
        text += &format!(", disc filled {:.1} %", 100.0 * filled);
    }
    Some(text)
}

/// A bar of so many characters, where that is enough for one.
fn bar(done: f64, unicode: bool, room: usize) -> Option<String> {
    let length = room.min(BAR.1);
    let full = ((done * length as f64) as usize).min(length);
    let (dark, light) = if unicode { ("█", "░") } else { ("#", "-") };
    (length >= BAR.0).then(|| dark.repeat(full) + &light.repeat(length - full))
}

/// The contact area against time with its axes, where there is room for it and something to draw.
fn chart(look: &Look, unicode: bool, width: usize, room: usize) -> Vec<String> {
    let (title, values) = if look.contact_area_mean.is_empty() {
        ("contact area, mm²", &look.contact_area)
    } else {
        ("contact area, mean of the last simulated revolution, mm²", &look.contact_area_mean)
    };
    let shown: Vec<f64> = values.iter().map(|area| MM2 * area).collect();
    let finite = || shown.iter().copied().filter(|area| area.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let labels = [number::short(high), number::short(low)];
    let margin = labels.iter().map(String::len).max().unwrap_or(0);
    let columns = width.saturating_sub(margin + 2);
    if look.times.len() < 2 || low > high || columns < CURVE_WIDTH || room < CURVE_LINES.0 {
        return Vec::new();
    }
    let rows = room.min(CURVE_LINES.1);
    let (side, corner, bottom) = if unicode { ('│', '└', "─") } else { ('|', '+', "-") };
    let mut lines = vec![readable(title, unicode)];
    let drawn = curve(&look.times, &shown, (low, high), (columns, rows), unicode);
    for (row, line) in drawn.into_iter().enumerate() {
        let label = match row {
            0 => labels[0].as_str(),
            row if row + 1 == rows => labels[1].as_str(),
            _ => "",
        };
        lines.push(format!("{label:>margin$} {side}{}", style(line).cyan()));
    }
    lines.push(format!("{:margin$} {corner}{}", "", bottom.repeat(columns)));
    let (start, end) = (number::short(look.times[0]), format!("{} s", number::short(look.time())));
    let between = columns.saturating_sub(start.len());
    lines.push(format!("{:margin$}  {start}{end:>between$}", ""));
    lines
}

/// A text without control characters, and without other letters than the terminal has.
fn readable(text: &str, unicode: bool) -> String {
    let readable = |letter| match letter {
        '²' if !unicode => '2',
        letter if unicode || letter.is_ascii() => letter,
        _ => '?',
    };
    on_one_line(text).chars().map(readable).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/commands/watch.rs"]
mod tests;
