//! The figures of runs: for one run, or for several side by side with common scales.
//!
//! [`figures`] reads what is plotted and gives it as plain data; a [`Figure`] draws itself.
//!
//! | figure | where |
//! |---|---|
//! | heights of disc and pin | [`topography`] |
//! | status of their cells | [`status`] |
//! | thickness of what has built up on them | [`build_up`] |
//! | contact pressure on the pin | [`pressure`] |
//! | temperature of the pin's cells, of runs that record it | [`contact_temperature`] |
//! | contact area against time | [`contact_area`] |
//! | load and speed above it, of runs with a cycle | [`operation`] |
//! | coefficient of friction, of runs with friction | [`friction`] |
//! | temperatures against time, of runs with heat | [`temperature`] |
//! | airborne mass and particles, of runs with emission | [`emission`] |
//! | filling and coverage against time | [`filled`] |
//! | how large plateaus are | [`plateau_sizes`] |
//! | where the debris is | [`debris`] |
//! | distribution of heights, Abbott-Firestone curve | [`heights`] |
//!
//! What they have in common: charts in [`chart`](super::chart), maps in [`map_page`], [`map_pages`], [`map_rows`], [`map_section`] and [`shape`], the moments that are
//! shown in [`moments`], what lines and bands are in [`legend`], many samples as few in [`spans`], [`weighted_mean`] and [`mod@crate::envelope`], what grows as what is added in a time in
//! [`rates`], names of runs in [`mod@crate::label`].

mod build_up;
mod contact_area;
mod contact_temperature;
mod debris;
mod emission;
mod filled;
mod friction;
mod heights;
mod legend;
mod map_page;
mod map_pages;
mod map_rows;
mod map_section;
mod moments;
mod operation;
mod plateau_sizes;
mod pressure;
mod rates;
mod shape;
mod spans;
mod status;
mod temperature;
mod thickness;
mod topography;
mod weighted_mean;
#[cfg(test)]
mod written;

pub use moments::{moment, nearest};

use std::fmt;
use std::path::PathBuf;

use plateau_io::run_file::{ReadError, RunFile};

use super::format::Figure;
use super::page::{PER_MILLIMETRE, Page};
use crate::colour::ColourMap;
use crate::label::labels;
use shape::Shape;

/// More runs make no legible figure, and have no colours of their own.
pub const MOST_RUNS: usize = crate::colour::RUNS.len();

/// How figures are to look, and which of them are drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// The ring as a ring, instead of unrolled.
    pub polar: bool,
    /// Names of the figures that are drawn; all if there are none.
    pub only: Vec<String>,
    /// Times whose maps are shown, the nearest that were recorded, s; the first and the last map if there are none.
    pub at: Vec<f64>,
    /// Width of the figures, mm; that of one or two columns of a journal if there is none.
    pub width: Option<f64>,
    /// Colours of ranges.
    pub colours: ColourMap,
}

/// Adds a figure, if the runs have what it shows.
type Add = fn(&[Subject], &Options, &mut Figures) -> Result<(), ReadError>;

/// Every figure with its name, in their order.
const FIGURES: [(&str, Add); 13] = [
    ("topography", topography::add),
    ("status", status::add),
    ("build-up", build_up::add),
    ("pressure", |subjects, _, figures| pressure::add(subjects, figures)),
    ("contact-temperature", |subjects, _, figures| contact_temperature::add(subjects, figures)),
    ("contact-area", |subjects, _, figures| contact_area::add(subjects, figures)),
    ("friction", |subjects, _, figures| friction::add(subjects, figures)),
    ("temperature", |subjects, _, figures| temperature::add(subjects, figures)),
    ("filled", |subjects, _, figures| filled::add(subjects, figures)),
    ("plateau-sizes", |subjects, _, figures| plateau_sizes::add(subjects, figures)),
    ("debris", |subjects, _, figures| debris::add(subjects, figures)),
    ("emission", |subjects, _, figures| emission::add(subjects, figures)),
    ("heights", |subjects, _, figures| heights::add(subjects, figures)),
];

/// Names of all figures of runs, in their order.
pub const NAMES: [&str; FIGURES.len()] = {
    let mut names = [""; FIGURES.len()];
    let mut figure = 0;
    while figure < names.len() {
        names[figure] = FIGURES[figure].0;
        figure += 1;
    }
    names
};

impl Options {
    /// How the disc is shown.
    fn disc_shape(&self) -> Shape {
        if self.polar { Shape::Polar } else { Shape::Unrolled }
    }
}

/// The figures that there are of runs, and why others are not.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figures {
    /// The figures.
    pub figures: Vec<Figure>,
    /// What was left out, and why.
    pub left_out: Vec<LeftOut>,
    /// Width of the figures, pixels, if it is not the usual one.
    width: Option<f64>,
}

/// What a run did not record, and the figures that do without it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// The run file.
    pub path: PathBuf,
    /// What it does not have, such as "no map pressure".
    pub missing: String,
    /// Names of the figures.
    pub figures: Vec<&'static str>,
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} has {}: left out of {}", self.path.display(), self.missing, self.figures.join(", "))
    }
}

/// A run with what it is called in figures.
struct Subject<'a> {
    run: &'a RunFile,
    label: String,
    /// Indices of the maps that are shown, in their order; none if those are the first and the last.
    chosen: Vec<usize>,
}

/// The figures of runs, in the order of [`NAMES`]. What a run did not record is left out.
///
/// # Errors
/// [`ReadError`] when a file turns out to be damaged.
pub fn figures(runs: &[RunFile], options: &Options) -> Result<Figures, ReadError> {
    let labels = labels(runs);
    let subject = |(run, label)| Subject { run, label, chosen: nearest(run, &options.at) };
    let subjects: Vec<Subject> = runs.iter().zip(labels).map(subject).collect();
    let mut figures = Figures { width: options.width.map(|width| PER_MILLIMETRE * width), ..Figures::default() };
    let is_asked_for = |name: &str| options.only.is_empty() || options.only.iter().any(|only| only == name);
    for (name, add) in FIGURES.iter().filter(|(name, _)| is_asked_for(name)) {
        let (before, named) = (figures.figures.len(), |note: &LeftOut| note.figures.contains(name));
        add(&subjects, options, &mut figures)?;
        // Of what no scene asked for nothing is said, unless somebody asks for the figure.
        if !options.only.is_empty() && figures.figures.len() == before && !figures.left_out.iter().any(named) {
            subjects.iter().for_each(|subject| figures.leave_out(name, subject, "nothing of the kind"));
        }
    }
    figures.figures.iter_mut().for_each(|figure| figure.page.recolour(options.colours));
    Ok(figures)
}

impl Figures {
    /// Width of a figure that usually has this one, pixels. In less than two thirds of it texts would be cut.
    fn width(&self, usual: f64) -> f64 {
        self.width.map_or(usual, |width| width.max(usual / 1.5))
    }

    fn add(&mut self, name: &'static str, title: &'static str, caption: impl Into<String>, page: Page) {
        self.add_pages(name, title, caption, vec![page]);
    }

    /// Adds a figure on one page or several.
    fn add_pages(&mut self, name: &'static str, title: &'static str, caption: impl Into<String>, pages: Vec<Page>) {
        self.figures.extend(Figure::of_pages(name, title, &caption.into(), pages));
    }

    /// Notes that a figure, or what it would show of a run, is left out.
    fn leave_out(&mut self, figure: &'static str, subject: &Subject, missing: &str) {
        let path = subject.run.path();
        let same = self.left_out.iter_mut().find(|note| note.path == path && note.missing == missing);
        match same {
            Some(note) if note.figures.contains(&figure) => {}
            Some(note) => note.figures.push(figure),
            None => {
                self.left_out.push(LeftOut { path: path.into(), missing: missing.into(), figures: vec![figure] });
            }
        }
    }

    /// The runs that have all these series and at least one sample; of the others it is noted that they are left out.
    fn with_series<'a>(
        &mut self,
        what: &'static str,
        subjects: &'a [Subject<'a>],
        series: &[&str],
    ) -> Vec<(usize, &'a Subject<'a>)> {
        let mut having = Vec::new();
        for (number, subject) in subjects.iter().enumerate() {
            let has = |name: &&&str| subject.run.series().iter().any(|series| series.name == **name);
            match series.iter().find(|name| !has(name)) {
                Some(name) => self.leave_out(what, subject, &format!("no series {name}")),
                None if subject.run.time().is_empty() => self.leave_out(what, subject, "no samples"),
                None => having.push((number, subject)),
            }
        }
        having
    }

    /// The same for series of a part that scenes do without, such as friction: where no run has them, there is nothing to note.
    fn with_part<'a>(
        &mut self,
        what: &'static str,
        subjects: &'a [Subject<'a>],
        series: &[&str],
    ) -> Vec<(usize, &'a Subject<'a>)> {
        let has = |subject: &Subject, name: &str| subject.run.series().iter().any(|series| series.name == name);
        let is_there = subjects.iter().any(|subject| series.iter().all(|name| has(subject, name)));
        if is_there { self.with_series(what, subjects, series) } else { Vec::new() }
    }
}
