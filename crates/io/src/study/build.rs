//! From the text of a study to the study: what its keys say together.

use std::collections::HashSet;
use std::path::Path;

use plateau_study::design::{Alpha, Fraction, Kind};
use toml::Spanned;

use super::document::{self, Document};
use super::factor::{Factor, Values};
use super::level::Level;
use super::place::{Place, unseen};
use super::response::Response;
use super::response_keys::{responses, series_name};
use super::{DesignSource, Order, Study, measured, points_of_file, replicates};
use crate::brief::MOST_PROBLEMS;
use crate::scene::{Origin, Problem, schema};
use crate::text::{odd_character, short, too_long};
use crate::units;

/// The newest version of the study format that this program reads.
const VERSION: i64 = 1;

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

/// Trajectories of a Morris design and levels of its ranges, unless given.
const TRAJECTORIES: usize = 10;
const GRID_LEVELS: usize = 4;

pub(super) fn build(document: Document, path: &Path, place: &Place<'_>) -> Result<Study, Vec<Problem>> {
    let mut problems = Vec::new();
    let folder = path.parent().unwrap_or(Path::new(""));
    let version = *document.version.get_ref();
    if version != VERSION {
        let message = format!("{version}, this program reads version {VERSION}");
        problems.push(place.problem(&document.version, "version", message));
    }
    let mut factors = factors(&document, place, &mut problems);
    let source = source(&document, &factors, folder, place).map_err(|problem| problems.push(problem)).ok();
    if let Some(DesignSource::File(points)) = &source {
        let levels_of = |at: usize| points.iter().map(|point| point[at].clone()).collect::<Vec<_>>();
        for (at, factor) in factors.iter_mut().enumerate().filter(|(_, factor)| factor.keys.is_empty()) {
            let levels = levels_of(at);
            factor.stated_unit = stated_unit(levels.first());
            if let (Some(other), Some(file)) = (Factor::in_another_unit(&levels), &document.file) {
                let message = format!("{} of \"{}\": expected all in the same unit", other.label, factor.name);
                problems.push(place.problem(file, "file", message));
            }
        }
    }
    let order = match document.order.as_ref().map(|order| (order, order.get_ref().as_str())) {
        // What was done elsewhere was done in the order of its table, as far as anybody knows.
        None if document.base.is_none() && document.file.is_some() => Order::Standard,
        None | Some((_, "random")) => Order::Random,
        Some((_, "standard")) => Order::Standard,
        Some((order, found)) => {
            problems.push(place.problem(
                order,
                "order",
                format!("\"{}\", expected \"random\" or \"standard\"", short(found)),
            ));
            Order::Standard
        }
    };
    let replicates = document.replicates.as_ref().map(|given| replicates::of(given, place, &mut problems));
    let responses = responses(&document.response, folder, place, &mut problems);
    let fit = measured::settings(&document, &responses, place, &mut problems);
    if document.base.is_none() && !responses.iter().all(Response::is_imported) {
        let message =
            "missing, expected base = \"SCENE.toml\"; it may be left out where all responses have imported = true";
        problems.push(Problem::new(&Origin::File(place.file.clone()), "base", message));
    }
    let series = document.series.as_ref().map(|series| {
        let few = |problems: &[Problem]| problems.len() < MOST_PROBLEMS;
        let names =
            series.iter().map_while(|name| few(&problems).then(|| series_name(name, "series", place, &mut problems)));
        names.flatten().collect::<Vec<_>>()
    });
    let stem = path.file_stem().map_or_else(|| "study".into(), |stem| stem.to_string_lossy().into_owned());
    let directory = document.directory.unwrap_or_else(|| stem.clone());
    let names = [("title", document.title.as_deref().unwrap_or_default()), ("directory", directory.as_str())];
    let file = || Origin::File(place.file.clone());
    names.into_iter().for_each(|(key, name)| place.check_name(name, file, key, &mut problems));
    if directory.is_empty() {
        problems.push(Problem::new(&Origin::File(place.file.clone()), "directory", "\"\", expected a folder"));
    }
    let Some(source) = source.filter(|_| problems.is_empty()) else { return Err(problems) };
    let mut files = vec![path.to_owned()];
    files.extend(responses.iter().filter_map(|response| Some(response.measured_series()?.path.clone())));
    files.extend(document.file.iter().map(|file| folder.join(file.get_ref())));
    Ok(Study {
        files,
        title: document.title.unwrap_or(stem),
        path: path.to_owned(),
        base_place: document.base.as_ref().map_or_else(file, |base| place.at(base.span().start)),
        base: document.base.map(|base| folder.join(base.get_ref())),
        directory: folder.join(directory),
        design: document.design.into_inner(),
        sets: document.set.into_iter().map(Spanned::into_inner).collect(),
        seed: document.seed.map_or(0, Spanned::into_inner),
        source,
        factors,
        replicates,
        order,
        responses,
        fit,
        series,
    })
}

fn factors(document: &Document, place: &Place<'_>, problems: &mut Vec<Problem>) -> Vec<Factor> {
    let mut factors: Vec<Factor> = Vec::new();
    let (mut names, mut varied) = (HashSet::new(), HashSet::new());
    for table in &document.factor {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        let keys = table.key.as_ref().map_or(Vec::new(), |key| key.get_ref().0.clone());
        if let Some(key) = &table.key {
            for unknown in keys.iter().filter(|key| schema::find(key).is_none()) {
                let (section, name) = unknown.rsplit_once('.').unwrap_or(("", unknown));
                let without =
                    if document.base.is_none() { "; what is set on a rig needs a name and no key" } else { "" };
                let message = format!("\"{}\": {}{without}", short(unknown), schema::unknown(section, name));
                problems.push(place.problem(key, "factor.key", message));
            }
        } else if let Some((at, message)) = without_key(table, document) {
            let place = at.map_or_else(|| Origin::File(place.file.clone()), |at| place.at(at));
            problems.push(Problem::new(&place, "factor.key", message));
            continue;
        }
        let name = table.name.as_ref().map_or_else(|| keys[0].clone(), |name| name.get_ref().clone());
        let at = table.name.as_ref().map(Spanned::span).or(table.key.as_ref().map(Spanned::span)).unwrap_or_default();
        place.check_label(&name, || place.at(at.start), "factor.name", problems);
        // What values an unknown key has nobody knows.
        let key = keys.first().map_or("", String::as_str);
        let values = if !key.is_empty() && schema::find(key).is_none() {
            Values::Levels(Vec::new())
        } else {
            let values = values(table, key, document.design.get_ref() == "csv", place);
            values.map_err(|problem| problems.push(problem)).unwrap_or(Values::Levels(Vec::new()))
        };
        if !names.insert(name.clone()) {
            problems.push(Problem::new(
                &place.at(at.start),
                "factor.name",
                format!("\"{}\" is the name of two", short(&name)),
            ));
        }
        // A key may stand twice in one list: that sets it to the same value.
        if let (Some(twice), Some(key)) = (keys.iter().find(|key| varied.contains(*key)), &table.key) {
            problems.push(place.problem(key, "factor.key", format!("\"{}\" is varied by two factors", short(twice))));
        }
        varied.extend(keys.iter().cloned());
        let stated_unit = match &values {
            Values::Levels(levels) => stated_unit(levels.first()),
            Values::Range { low, .. } => stated_unit(Some(low)),
        };
        factors.push(Factor { name, keys, stated_unit, values });
    }
    if factors.is_empty() {
        let message = "nothing is varied, expected at least one [[factor]]";
        problems.push(Problem::new(&Origin::File(place.file.clone()), "factor", message));
    }
    factors
}

/// What is wrong with a factor that has no key, and where.
fn without_key(table: &document::Factor, document: &Document) -> Option<(Option<usize>, &'static str)> {
    let at = table.name.as_ref().map(|name| name.span().start);
    match (&document.base, at) {
        (Some(_), _) => Some((
            at,
            "missing, expected a key of the scene such as \"operation.normal_force\"; factors that are set \
            elsewhere, as on a rig, belong into a study without base",
        )),
        (None, None) => Some((None, "a factor has neither key nor name")),
        (None, Some(_)) => None,
    }
}

/// The unit of a level; empty for plain numbers and words.
fn stated_unit(level: Option<&Level>) -> String {
    level.and_then(Level::split).map_or_else(String::new, |(_, unit)| unit.to_owned())
}

fn values(table: &document::Factor, key: &str, in_file: bool, place: &Place<'_>) -> Result<Values, Problem> {
    let of = |value: &Spanned<toml::Value>| Level::new(key, value.get_ref());
    let start =
        table.key.as_ref().map(Spanned::span).or(table.name.as_ref().map(Spanned::span)).unwrap_or_default().start;
    let at = |message: &str| Err(Problem::new(&place.at(start), "factor", message));
    if let Some(scale) = &table.scale
        && table.range.is_none()
    {
        return Err(place.problem(scale, "factor.scale", "it belongs to a range"));
    }
    match (&table.levels, &table.range) {
        (None, None) if in_file => Ok(Values::Levels(Vec::new())),
        (Some(levels), None) => {
            let list: Vec<Level> = levels.get_ref().iter().map(of).collect();
            if list.len() < 2 {
                return Err(place.problem(levels, "factor.levels", "expected at least two levels"));
            }
            let refuse =
                |at: usize, message: String| Err(place.problem(&levels.get_ref()[at], "factor.levels", message));
            let mut known = HashSet::new();
            if let Some(at) = list.iter().position(|level| !known.insert(level.text.as_str())) {
                return refuse(at, format!("{} is there twice", list[at].text));
            }
            if let Some(other) = key.is_empty().then(|| Factor::in_another_unit(&list)).flatten() {
                return Err(place.problem(
                    levels,
                    "factor.levels",
                    format!("{}: expected all in the same unit", other.text),
                ));
            }
            let mut unfit = levels.get_ref().iter().enumerate();
            if let Some((at, why)) = unfit.find_map(|(at, level)| Some((at, Level::unfit(key, level.get_ref())?))) {
                return refuse(at, why);
            }
            let odd = list.iter().enumerate().find_map(|(at, level)| Some((at, odd_character(&level.label)?)));
            if let Some((at, found)) = odd {
                return refuse(at, format!("{} has {found}; take it out", list[at].text.escape_debug()));
            }
            let words = || list.iter().enumerate().filter(|(_, level)| level.number.is_none());
            if let Some((at, unseen)) = words().find_map(|(at, level)| Some((at, unseen(&level.label)?))) {
                return refuse(at, unseen);
            }
            if let Some((at, long)) =
                list.iter().enumerate().find_map(|(at, level)| Some((at, too_long(&level.label)?)))
            {
                return refuse(at, long);
            }
            Ok(Values::Levels(list))
        }
        (None, Some(range)) => {
            let logarithmic = match table.scale.as_ref().map(|scale| (scale, scale.get_ref().as_str())) {
                None | Some((_, "linear")) => false,
                Some((_, "logarithmic")) => true,
                Some((scale, found)) => {
                    let message = format!("\"{}\", expected \"linear\" or \"logarithmic\"", short(found));
                    return Err(place.problem(scale, "factor.scale", message));
                }
            };
            let [low, high] = range.get_ref().each_ref().map(of);
            let number = |end: &Spanned<toml::Value>| {
                let refused = |why: String| place.problem(end, "factor.range", why);
                Level::end_of_range(key, end.get_ref()).map_err(refused)
            };
            let (from, to) = (number(&range.get_ref()[0])?, number(&range.get_ref()[1])?);
            if from >= to || (logarithmic && from <= 0.0) {
                let wanted = if logarithmic { "0 < lower < upper" } else { "lower < upper" };
                let message = format!("{} to {}: expected {wanted}", low.text, high.text);
                return Err(place.problem(range, "factor.range", message));
            }
            let whole = |end: &Spanned<toml::Value>| matches!(end.get_ref(), toml::Value::Integer(_));
            if schema::find(key)
                .is_some_and(|key| matches!(key.kind, schema::Kind::Integer(_) | schema::Kind::CountOr(_)))
            {
                return Err(place.problem(range, "factor.range", "this key holds whole numbers: give levels"));
            }
            let units_of_ends =
                [&low, &high].map(|level| level.label.trim().split_once(' ').map_or("", |(_, unit)| unit.trim()));
            if units_of_ends[0] != units_of_ends[1] && !range.get_ref().iter().all(whole) {
                let message = format!("{} to {}: expected both in the same unit", low.text, high.text);
                return Err(place.problem(range, "factor.range", message));
            }
            if logarithmic && units::zero_of(units_of_ends[0]) != 0.0 {
                let message = format!(
                    "{} to {}: equal ratios need a range in K, for 0 degC is not the lowest",
                    low.text, high.text
                );
                return Err(place.problem(range, "factor.range", message));
            }
            Ok(Values::Range { low, high, logarithmic })
        }
        (Some(_), Some(_)) => at("levels and range are given together, keep one"),
        (None, None) => at("expected levels = [...] or range = [lower, upper]"),
    }
}

/// What the keys of the design say.
fn source(document: &Document, factors: &[Factor], folder: &Path, place: &Place<'_>) -> Result<DesignSource, Problem> {
    let design = document.design.get_ref().as_str();
    let only = |name: &str, span: Option<usize>, designs: &[&str]| match span {
        Some(at) if !designs.contains(&design) => {
            let message = format!("it belongs to design = \"{}\", found \"{design}\"", designs.join("\" or \""));
            Err(Problem::new(&place.at(at), name, message))
        }
        _ => Ok(()),
    };
    fn start<T>(found: &Option<Spanned<T>>) -> Option<usize> {
        found.as_ref().map(|found| found.span().start)
    }
    only("resolution", start(&document.resolution), &["fractional-factorial"])?;
    only("generators", start(&document.generators), &["fractional-factorial"])?;
    only("points", start(&document.points), &["latin-hypercube", "sobol"])?;
    only("trajectories", start(&document.trajectories), &["morris"])?;
    only("levels", start(&document.levels), &["morris"])?;
    only("alpha", start(&document.alpha), &["central-composite"])?;
    only("centre_points", start(&document.centre_points), &["central-composite", "box-behnken"])?;
    only("file", start(&document.file), &["csv"])?;
    let missing = |what: &str| Err(place.problem(&document.design, "design", format!("\"{design}\" needs {what}")));
    let points = || document.points.as_ref().map(|points| *points.get_ref()).filter(|points| *points > 0);
    let centre = document.centre_points.as_ref().map(|points| *points.get_ref());
    let kind = match design {
        "full-factorial" => Kind::FullFactorial,
        "fractional-factorial" => match (&document.resolution, &document.generators) {
            (Some(resolution), None) => Kind::FractionalFactorial(Fraction::Resolution(*resolution.get_ref())),
            (None, Some(generators)) => Kind::FractionalFactorial(Fraction::Generators(generators.get_ref().clone())),
            _ => return missing("either resolution = 4 or generators = [\"D = ABC\"]"),
        },
        "plackett-burman" => Kind::PlackettBurman,
        "central-composite" => {
            let alpha = match document.alpha.as_ref().map(|alpha| (alpha, alpha.get_ref().as_str())) {
                None | Some((_, "face")) => Alpha::Face,
                Some((_, "rotatable")) => Alpha::Rotatable,
                Some((_, "orthogonal")) => Alpha::Orthogonal,
                Some((alpha, found)) => {
                    let message = format!("\"{}\", expected \"face\", \"rotatable\" or \"orthogonal\"", short(found));
                    return Err(place.problem(alpha, "alpha", message));
                }
            };
            // Equal points without seeds are equal runs, and tell nothing of the error.
            let centre = centre.unwrap_or(1);
            Kind::CentralComposite { alpha, centre: [centre.div_ceil(2), centre / 2] }
        }
        "box-behnken" => Kind::BoxBehnken { centre: centre.unwrap_or(1) },
        "latin-hypercube" => match points() {
            Some(points) => {
                Kind::LatinHypercube { points, seed: document.seed.as_ref().map_or(0, |seed| *seed.get_ref()) }
            }
            None => return missing("points = 20, at least 1"),
        },
        "sobol" => match points() {
            Some(points) => Kind::Sobol { points },
            None => return missing("points = 32, at least 1"),
        },
        "morris" => Kind::Morris {
            trajectories: document.trajectories.as_ref().map_or(TRAJECTORIES, |count| *count.get_ref()),
            levels: document.levels.as_ref().map_or(GRID_LEVELS, |count| *count.get_ref()),
            seed: document.seed.as_ref().map_or(0, |seed| *seed.get_ref()),
        },
        "csv" => {
            let Some(file) = &document.file else { return missing("file = \"points.csv\"") };
            let imported = document.response.iter().filter(|table| table.imported.is_some());
            let others: Vec<&str> = imported.map(|table| table.name.get_ref().as_str()).collect();
            let points = points_of_file::read(&folder.join(file.get_ref()), factors, &others);
            return points.map(DesignSource::File).map_err(|message| place.problem(file, "file", message));
        }
        other => {
            let nearest = schema::nearest(other, DESIGNS);
            let advice = nearest.map_or_else(String::new, |nearest| format!("; did you mean \"{nearest}\"?"));
            let message = format!("\"{}\", expected one of {}{advice}", short(other), DESIGNS.join(", "));
            return Err(place.problem(&document.design, "design", message));
        }
    };
    Ok(DesignSource::Kind(kind))
}
