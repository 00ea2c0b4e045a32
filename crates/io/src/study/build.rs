//! A study from its file: read, its keys checked, put together.

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use plateau_study::design::{Alpha, Fraction, Kind};
use toml::Spanned;

use crate::scene::{Locator, Origin, Problem, not_toml, schema};
use crate::study::document::{self, Document};
use crate::study::factor::Factor;
use crate::study::keys::{factors, responses, series_name, stated_unit};
use crate::study::plan::{DesignSource, Order, Replicates, Study, StudyError};
use crate::study::response::Response;
use crate::study::value_table;
use crate::text::{self, MOST_PROBLEMS, short};
use crate::{hdf5_file, input, limits};

impl Study {
    /// Reads the study at `path`. Whether the scenes of its runs can be built is seen when they are planned.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let file: Arc<Path> = path.into();
        let at = |origin: Origin, message: String| StudyError(vec![Problem::without_key(&origin, message)]);
        let text = input::read_to_string(path, limits::STUDY).map_err(|error| {
            let (what, system) = if hdf5_file::is_hdf5(path).unwrap_or(false) {
                ("this is an HDF5 file, expected a study, which is a text in TOML".to_owned(), None)
            } else {
                (format!("cannot read the study: {error}"), error.raw_os_error())
            };
            StudyError(vec![Problem { system, ..Problem::without_key(&Origin::File(file.clone()), what) }])
        })?;
        let locator = Locator::new(file.clone(), &text);
        let located = |error: &toml::de::Error, message: String| {
            at(error.span().map_or(Origin::File(file.clone()), |span| locator.origin(span)), message)
        };
        let table: toml::Table = text.parse().map_err(|error| located(&error, not_toml(&text, &error)))?;
        if is_scene(&table) {
            let message = "this is a scene, expected a study; `plateau run` and `plateau check` take scenes";
            return Err(at(Origin::File(file.clone()), message.to_owned()));
        }
        let document: Document =
            toml::from_str(&text).map_err(|error| located(&error, document::with_advice(error.message())))?;
        build(document, path, &locator).map_err(StudyError)
    }
}

/// Tells whether this is a scene: it has a table that only scenes have, and nothing that every study has.
fn is_scene(table: &toml::Table) -> bool {
    let has = |keys: &[&str]| keys.iter().any(|key| table.contains_key(*key));
    let tables = ["mesh", "operation", "contact", "materials", "plateaus", "disc", "pin", "extends"];
    has(&tables) && !has(&["design", "factor", "base"])
}

/// The newest version of the study format that this program reads.
const VERSION: i64 = 1;

fn build(document: Document, path: &Path, locator: &Locator<'_>) -> Result<Study, Vec<Problem>> {
    let mut problems = Vec::new();
    let folder = path.parent().unwrap_or(Path::new(""));
    let version = *document.version.get_ref();
    if version != VERSION {
        let message = format!("{version}, this program reads version {VERSION}");
        problems.push(locator.problem(&document.version, "version", message));
    }
    let mut factors = factors(&document, locator, &mut problems);
    let source = source(&document, &factors, folder, locator).map_err(|problem| problems.push(problem)).ok();
    if let Some(DesignSource::File(points)) = &source {
        let levels_of = |at: usize| points.iter().map(|point| point[at].clone()).collect::<Vec<_>>();
        for (at, factor) in factors.iter_mut().enumerate().filter(|(_, factor)| factor.keys.is_empty()) {
            let levels = levels_of(at);
            factor.stated_unit = stated_unit(levels.first());
            if let (Some(other), Some(file)) = (Factor::in_another_unit(&levels), &document.file) {
                let message = format!("{} of \"{}\": expected all in the same unit", other.label, factor.name);
                problems.push(locator.problem(file, "file", message));
            }
        }
    }
    let orders = [("random", Order::Random), ("standard", Order::Standard)];
    let order = match &document.order {
        // What was done elsewhere was done in the order of its table, as far as anybody knows.
        None if document.base.is_none() && document.file.is_some() => Order::Standard,
        given => locator.choice(given.as_ref(), "order", &orders).unwrap_or_else(|problem| {
            problems.push(problem);
            Order::Standard
        }),
    };
    let replicates = document
        .replicates
        .as_ref()
        .map(|given| self::replicates(given, document.base.is_some(), locator, &mut problems));
    let responses = responses(&document.response, locator, &mut problems);
    if document.base.is_none() && !responses.iter().all(Response::is_imported) {
        let message =
            "missing, expected base = \"SCENE.toml\"; it may be left out where all responses have imported = true";
        problems.push(Problem::new(&Origin::File(locator.file.clone()), "base", message));
    }
    let series = document.series.as_ref().map(|series| {
        let few = |problems: &[Problem]| problems.len() < MOST_PROBLEMS;
        let names =
            series.iter().map_while(|name| few(&problems).then(|| series_name(name, "series", locator, &mut problems)));
        names.flatten().collect::<Vec<_>>()
    });
    let stem = path.file_stem().map_or_else(|| "study".into(), |stem| stem.to_string_lossy().into_owned());
    let directory = document.directory.unwrap_or_else(|| stem.clone());
    let names = [("title", document.title.as_deref().unwrap_or_default()), ("directory", directory.as_str())];
    let file = || Origin::File(locator.file.clone());
    names.into_iter().for_each(|(key, name)| locator.check_name(name, file, key, &mut problems));
    if directory.is_empty() {
        problems.push(Problem::new(&Origin::File(locator.file.clone()), "directory", "\"\", expected a folder"));
    }
    let Some(source) = source.filter(|_| problems.is_empty()) else { return Err(problems) };
    let mut files = vec![path.to_owned()];
    let measured = document.response.iter().filter_map(|table| table.measured_file.as_ref());
    files.extend(measured.map(|file| folder.join(file.get_ref())));
    files.extend(document.file.iter().map(|file| folder.join(file.get_ref())));
    Ok(Study {
        files,
        title: document.title.unwrap_or(stem),
        path: path.to_owned(),
        base_place: document.base.as_ref().map_or_else(file, |base| locator.origin(base.span())),
        base: document.base.map(|base| folder.join(base.get_ref())),
        directory: folder.join(directory),
        is_elsewhere: false,
        design: document.design.into_inner(),
        sets: document.set.into_iter().map(Spanned::into_inner).collect(),
        seed: document.seed.map_or(0, Spanned::into_inner),
        source,
        factors,
        replicates,
        order,
        responses,
        series,
    })
}

/// Content of `[replicates]`; of a study without a scene, numbers of measurements without keys.
fn replicates(
    given: &document::Replicates,
    has_scene: bool,
    locator: &Locator<'_>,
    problems: &mut Vec<Problem>,
) -> Replicates {
    let keys = given.keys.as_ref().map_or(&[][..], |keys| keys.get_ref());
    for key in keys {
        if !schema::find(key.get_ref()).is_some_and(schema::Key::is_seed) {
            let message = format!(
                "\"{}\" is not a seed; expected keys such as disc.surface.synthetic.seed, or disc.prepare.extend_seed of a \
                     measured patch",
                short(key.get_ref())
            );
            problems.push(locator.problem(key, "replicates.keys", message));
        }
    }
    let seeds: Vec<i64> = given.seeds.get_ref().iter().map(|seed| *seed.get_ref()).collect();
    if seeds.is_empty() || has_scene && keys.is_empty() {
        problems.push(locator.problem(&given.seeds, "replicates", "expected at least one key and one seed"));
    }
    let mut known = HashSet::new();
    for seed in given.seeds.get_ref() {
        let message = match known.insert(*seed.get_ref()) {
            _ if problems.len() >= MOST_PROBLEMS => break,
            false => "is there twice: equal seeds give equal runs",
            true if *seed.get_ref() < 0 => "is negative, expected a seed of at least 0",
            true => continue,
        };
        problems.push(locator.problem(seed, "replicates.seeds", format!("{} {message}", seed.get_ref())));
    }
    Replicates { keys: keys.iter().map(|key| key.get_ref().clone()).collect(), seeds }
}

/// Designs by their name in a study.
const DESIGNS: [&str; 9] = [
    "full-factorial",
    "fractional-factorial",
    "plackett-burman",
    "central-composite",
    "box-behnken",
    "latin-hypercube",
    "sobol",
    "morris",
    "csv",
];

/// Those that have no centre points of their own, but may have some.
const FACTORIALS: [&str; 3] = ["full-factorial", "fractional-factorial", "plackett-burman"];

/// Trajectories of a Morris design and levels of its ranges, unless given.
const TRAJECTORIES: usize = 10;
const GRID_LEVELS: usize = 4;

/// Source of the points, from the keys of the design.
pub(super) fn source(
    document: &Document,
    factors: &[Factor],
    folder: &Path,
    locator: &Locator<'_>,
) -> Result<DesignSource, Problem> {
    let design = document.design.get_ref().as_str();
    let only = |name: &str, span: Option<usize>, designs: &[&str]| match span {
        Some(at) if !designs.contains(&design) => {
            let message = format!("it belongs to design = \"{}\", found \"{design}\"", designs.join("\" or \""));
            Err(Problem::new(&locator.origin(at..at), name, message))
        }
        _ => Ok(()),
    };
    fn start<T>(found: &Option<Spanned<T>>) -> Option<usize> {
        found.as_ref().map(|found| found.span().start)
    }
    fn value<T: Clone>(found: &Option<Spanned<T>>) -> Option<T> {
        found.as_ref().map(|found| found.get_ref().clone())
    }
    only("resolution", start(&document.resolution), &["fractional-factorial"])?;
    only("generators", start(&document.generators), &["fractional-factorial"])?;
    only("points", start(&document.points), &["latin-hypercube", "sobol"])?;
    only("trajectories", start(&document.trajectories), &["morris"])?;
    only("levels", start(&document.levels), &["morris"])?;
    only("alpha", start(&document.alpha), &["central-composite"])?;
    let with_centre = [&FACTORIALS[..], &["central-composite", "box-behnken"]].concat();
    only("centre_points", start(&document.centre_points), &with_centre)?;
    only("file", start(&document.file), &["csv"])?;
    let missing = |what: &str| Err(locator.problem(&document.design, "design", format!("\"{design}\" needs {what}")));
    let points = value(&document.points).filter(|points| *points > 0);
    let (centre, seed) = (value(&document.centre_points), value(&document.seed).unwrap_or(0));
    let kind = match design {
        "full-factorial" => Kind::FullFactorial,
        "fractional-factorial" => match (value(&document.resolution), value(&document.generators)) {
            (Some(resolution), None) => Kind::FractionalFactorial(Fraction::Resolution(resolution)),
            (None, Some(generators)) => Kind::FractionalFactorial(Fraction::Generators(generators)),
            _ => return missing("either resolution = 4 or generators = [\"D = ABC\"]"),
        },
        "plackett-burman" => Kind::PlackettBurman,
        "central-composite" => {
            let alphas = [("face", Alpha::Face), ("rotatable", Alpha::Rotatable), ("orthogonal", Alpha::Orthogonal)];
            let alpha = locator.choice(document.alpha.as_ref(), "alpha", &alphas)?;
            // Equal points without seeds are equal runs, and tell nothing of the error.
            let centre = centre.unwrap_or(1);
            Kind::CentralComposite { alpha, centre: [centre.div_ceil(2), centre / 2] }
        }
        "box-behnken" => Kind::BoxBehnken { centre: centre.unwrap_or(1) },
        "latin-hypercube" => match points {
            Some(points) => Kind::LatinHypercube { points, seed },
            None => return missing("points = 20, at least 1"),
        },
        "sobol" => match points {
            Some(points) => Kind::Sobol { points },
            None => return missing("points = 32, at least 1"),
        },
        "morris" => Kind::Morris {
            trajectories: value(&document.trajectories).unwrap_or(TRAJECTORIES),
            levels: value(&document.levels).unwrap_or(GRID_LEVELS),
            seed,
        },
        "csv" => {
            let Some(file) = &document.file else { return missing("file = \"points.csv\"") };
            let imported = document.response.iter().filter(|table| table.imported.is_some());
            let others: Vec<&str> = imported.map(|table| table.name.get_ref().as_str()).collect();
            let points = value_table::read_points(&folder.join(file.get_ref()), factors, &others);
            return points.map(DesignSource::File).map_err(|message| locator.problem(file, "file", message));
        }
        other => {
            let nearest = text::nearest(other, DESIGNS);
            let advice = nearest.map_or_else(String::new, |nearest| format!("; did you mean \"{nearest}\"?"));
            let message = format!("\"{}\", expected one of {}{advice}", short(other), DESIGNS.join(", "));
            return Err(locator.problem(&document.design, "design", message));
        }
    };
    let centre = centre.filter(|_| FACTORIALS.contains(&design)).unwrap_or(0);
    Ok(DesignSource::Kind(kind, centre))
}

#[cfg(test)]
#[path = "../../tests/unit/study/build.rs"]
mod tests;
