//! The design of a study, from the keys that say it.

use std::path::Path;

use plateau_study::design::{Alpha, Fraction, Kind};
use toml::Spanned;

use super::document::Document;
use super::factor::Factor;
use super::place::Place;
use super::{DesignSource, points_of_file};
use crate::scene::{Problem, schema};
use crate::text::short;

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

/// What the keys of the design say.
pub(super) fn source(
    document: &Document,
    factors: &[Factor],
    folder: &Path,
    place: &Place<'_>,
) -> Result<DesignSource, Problem> {
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
    let with_centre = [&FACTORIALS[..], &["central-composite", "box-behnken"]].concat();
    only("centre_points", start(&document.centre_points), &with_centre)?;
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
    let centre = centre.filter(|_| FACTORIALS.contains(&design)).unwrap_or(0);
    Ok(DesignSource::Kind(kind, centre))
}
