//! From the text of a study to the study: what its keys say together.

use std::path::Path;

use toml::Spanned;

use super::design_keys::source;
use super::document::Document;
use super::factor::Factor;
use super::factor_keys::{factors, stated_unit};
use super::place::Place;
use super::response::Response;
use super::response_keys::{responses, series_name};
use super::{DesignSource, Order, Study, replicates};
use crate::brief::MOST_PROBLEMS;
use crate::scene::{Origin, Problem};
use crate::text::short;

/// The newest version of the study format that this program reads.
const VERSION: i64 = 1;

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
    let replicates =
        document.replicates.as_ref().map(|given| replicates::of(given, document.base.is_some(), place, &mut problems));
    let responses = responses(&document.response, place, &mut problems);
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
    let measured = document.response.iter().filter_map(|table| table.measured_file.as_ref());
    files.extend(measured.map(|file| folder.join(file.get_ref())));
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
        series,
    })
}
