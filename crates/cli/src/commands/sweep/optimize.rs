//! `plateau sweep optimize`: the settings at which the responses of a study are best.

use std::path::PathBuf;

use plateau_io::{brief, number};
use plateau_present::figure::Figure;
use plateau_present::figure::optimum::{Shown, figures};
use plateau_present::study::cautions::with_two_values;
use plateau_present::study::forecasts::heads;
use plateau_present::study::goals::{self, Aim, limit_words};
use plateau_present::study::place::{Place, Space};
use plateau_study::design::Setting;
use plateau_study::optimum::{Axis, Goal, Kept, Limit, Optimum, Wish};
use plateau_study::surrogate::Forecast;
use serde::Serialize;

use super::analysed::Analysed;
use super::effects_files::draw_all;
use super::optimize_limits::{LimitReport, Limited};
use super::optimize_search::{beyond_runs, search};
use super::predict::{
    ForecastReport, SettingReport, confirmed_text, forecasts_of, notes_of_intervals, notes_of_place, reasons,
    settings_of,
};
use crate::arguments::{LimitOn, OptimizeArguments};
use crate::failure::Failure;
use crate::output_folder::{OutputFolder, name_of, names_of};
use crate::sweep::confirmation::{Confirmed, confirm};
use crate::table::{columns, print};
use crate::{message, sweep};

/// Looks for the best settings.
pub fn optimize(arguments: &OptimizeArguments) -> Result<(), Failure> {
    let plan = sweep::plan(&arguments.study)?;
    let folder = arguments.output.clone().unwrap_or_else(|| plan.study().directory.join("optimum"));
    let analysed = Analysed::of(plan, arguments.fit.asked())?;
    analysed.warn_of_factors();
    let analysis = &analysed.analysis;
    let (goals, limits) = wanted(&analysed, arguments)?;
    let space = Space::new(analysed.plan.study(), analysis);
    let axes = axes(&analysed, &space, arguments)?;
    let mut straight = with_two_values(analysis);
    straight.retain(|factor| axes[*factor] == Axis::Range);
    analysed.warn_of_no_curve(&straight);
    let contour = arguments.contour.as_deref().map(|names| pair(&space, names, &axes)).transpose()?;
    // What is asked wrongly is said first: with --force alone one would ask wrongly again.
    let mut folder = OutputFolder::new(folder, arguments.force)?;
    let goals = beyond_runs(&analysed, &goals, &axes, arguments.fit.confidence)?;
    let (best, forecasts) = search(&analysed, &goals, &limits, &axes, arguments.fit.confidence)?;
    if best.overall <= 0.0 && best.keeps_limits {
        message::warning(
            "a goal is worth nothing wherever the others are worth something; give wider values, such as NAME=LOW..HIGH",
        );
    }
    let place = space.of(best.settings.clone()).map_err(Failure::input)?;
    let limited = Limited { analysed: &analysed, limits: &limits, axes: &axes, forecasts: &forecasts };
    let shown = Shown {
        analysis,
        goals: &goals,
        limits: &limits,
        axes: &axes,
        best: &best.settings,
        confidence: arguments.fit.confidence,
    };
    let pair = contour.or_else(|| shown.pair());
    let figures = figures(&shown, pair);
    if pair.is_some() && !figures.iter().any(|figure| figure.name == "contour") {
        message::note(
            "there is no contour: over two factors the desirability is the same everywhere, such as 0 where a limit is missed",
        );
    }
    write(&mut folder, &figures, &analysed.inputs)?;
    let files = folder.files().to_vec();
    let make = || confirm(&analysed.plan, &analysed.identities, &[(&place.levels, &forecasts)], &arguments.cores);
    let confirmed = arguments.confirm.then(make).transpose()?.and_then(|places| places.into_iter().next());
    if arguments.json {
        let document = Document {
            study: &analysed.plan.study().title,
            confidence: arguments.fit.confidence,
            settings: settings_of(&analysed, &place),
            responses: forecasts_of(&analysed, &forecasts),
            goals: goals
                .iter()
                .zip(&best.desirabilities)
                .map(|(goal, worth)| GoalReport::new(&analysed, goal, *worth))
                .collect(),
            desirability: best.overall,
            keeps_limits: best.keeps_limits,
            limits: limited.reports(),
            at_ends: limited.at_ends(&best),
            confirmed,
            files,
        };
        print(&(serde_json::to_string_pretty(&document).map_err(Failure::run)? + "\n"))?;
        return kept(&best);
    }
    let mut text = text_of(&limited, &place, &goals, &best, arguments.fit.confidence)?;
    if let Some(confirmed) = &confirmed {
        text.push_str(&confirmed_text(&analysed, confirmed));
    }
    let count = files.iter().filter(|file| file.ends_with(".png")).count();
    text.push_str(&format!(
        "written {} as PNG, SVG and PDF in {}\n",
        number::count(count, "figure"),
        folder.path().display()
    ));
    print(&text)?;
    kept(&best)
}

/// That all limits are kept.
fn kept(best: &Optimum) -> Result<(), Failure> {
    if best.keeps_limits { Ok(()) } else { Err(Failure::run("no settings within the ranges keep all limits")) }
}

/// Goals and limits of the command line.
fn wanted(analysed: &Analysed, arguments: &OptimizeArguments) -> Result<(Vec<Goal>, Vec<Limit>), Failure> {
    let analysis = &analysed.analysis;
    let given =
        [(Aim::Maximize, &arguments.maximize), (Aim::Minimize, &arguments.minimize), (Aim::Target, &arguments.target)];
    let mut goals: Vec<Goal> = Vec::new();
    for (aim, text) in given.into_iter().flat_map(|(aim, texts)| texts.iter().map(move |text| (aim, text))) {
        let (response, wish) = goals::wish(analysis, aim, text).map_err(Failure::input)?;
        if goals.iter().any(|goal| goal.response == response) {
            let name = &analysis.responses[response].name;
            return Err(Failure::input(format!(
                "\"{name}\" has two goals, expected one; a --limit may stand beside it"
            )));
        }
        goals.push(Goal { response, wish, weight: 1.0, importance: 1.0 });
    }
    if goals.is_empty() {
        return Err(Failure::input("no goal: give --maximize, --minimize or --target with a response"));
    }
    let powers = [("--importance", &arguments.importance), ("--weight", &arguments.weight)];
    for (option, text) in powers.into_iter().flat_map(|(option, texts)| texts.iter().map(move |text| (option, text))) {
        let (response, power) = goals::power(analysis, option, text).map_err(Failure::input)?;
        let Some(goal) = goals.iter_mut().find(|goal| goal.response == response) else {
            return Err(Failure::input(format!("{option} \"{text}\": this response has no goal")));
        };
        if option == "--weight" { goal.weight = power } else { goal.importance = power }
    }
    let on = match arguments.limit_on {
        LimitOn::Mean => Kept::Value,
        LimitOn::Means => Kept::Means,
        LimitOn::Runs => Kept::Runs,
    };
    let limits = arguments.limit.iter().map(|text| goals::limit(analysis, text, on)).collect::<Result<_, _>>();
    Ok((goals, limits.map_err(Failure::input)?))
}

/// Where each factor may be.
fn axes(analysed: &Analysed, space: &Space<'_>, arguments: &OptimizeArguments) -> Result<Vec<Axis>, Failure> {
    let held = space.named(&arguments.hold).map_err(|error| Failure::input(format!("--hold: {error}")))?;
    if !held.beyond.is_empty() {
        return Err(Failure::input(format!(
            "--hold: {}; the search stays within the ranges",
            brief::list(&held.beyond, ", ")
        )));
    }
    let axis = |(factor, setting): (usize, Setting)| match () {
        () if !held.assumed.contains(&analysed.plan.study().factors[factor].name) => Axis::Settings(vec![setting]),
        () if space.is_continuous(factor) => Axis::Range,
        () => Axis::Settings(space.levels(factor)),
    };
    Ok(held.settings.iter().copied().enumerate().map(axis).collect())
}

/// The two factors of a contour.
fn pair(space: &Space<'_>, names: &str, axes: &[Axis]) -> Result<[usize; 2], Failure> {
    let at = |error: String| Failure::input(format!("--contour {names}: {error}"));
    // Names may have commas, too.
    let halves = names.match_indices(',').map(|(comma, _)| (names[..comma].trim(), names[comma + 1..].trim()));
    let pairs = halves.map(|(one, other)| Ok([space.factor(one)?, space.factor(other)?]));
    let pair = pairs.reduce(Result::or).unwrap_or_else(|| Err("expected two factors with a comma between".to_owned()));
    let pair = pair.map_err(at)?;
    match pair.iter().all(|factor| axes[*factor] == Axis::Range) && pair[0] != pair[1] {
        true => Ok(pair),
        false => Err(at("expected two different factors that are numbers and not held".to_owned())),
    }
}

/// Draws the figures.
fn write(folder: &mut OutputFolder, figures: &[Figure], inputs: &[PathBuf]) -> Result<(), Failure> {
    let drawn = draw_all(figures)?;
    folder.begin(&names_of(figures.iter()), inputs)?;
    for (name, format, content) in drawn
        .iter()
        .flat_map(|drawn| drawn.files.iter().map(move |(format, content)| (&drawn.picture.name, format, content)))
    {
        folder.write(&name_of(name, *format), content)?;
    }
    Ok(())
}

/// What is said of the optimum.
fn text_of(
    limited: &Limited<'_>,
    place: &Place,
    goals: &[Goal],
    best: &Optimum,
    confidence: f64,
) -> Result<String, Failure> {
    let Limited { analysed, limits, forecasts, .. } = *limited;
    let words = Space::new(analysed.plan.study(), &analysed.analysis).words(place);
    let found = match best.keeps_limits {
        true => "best at",
        false => "no settings within the ranges keep all limits; they are missed least at",
    };
    let heading = format!(
        "{}\n  {found} {words}\n  desirability {}",
        analysed.plan.study().title,
        number::rounded(best.overall, 3)
    );
    let heads = heads(confidence);
    let names: Vec<&str> = heads.iter().map(String::as_str).chain(["goal", "desirability"]).collect();
    let line = |(at, forecast): (usize, &Option<Forecast>)| {
        let response = &analysed.analysis.responses[at];
        let mut cells = response.cells(forecast.as_ref()?);
        let goal = goals.iter().zip(&best.desirabilities).find(|(goal, _)| goal.response == at);
        let own = limits.iter().filter(|limit| limit.response == at);
        let wanted: Vec<String> = goal
            .map(|(goal, _)| goal_words(analysed, goal))
            .into_iter()
            .chain(own.map(|limit| limit_words(response, limit)))
            .collect();
        cells.push(wanted.join("; "));
        cells.push(goal.map_or_else(String::new, |(_, worth)| number::rounded(*worth, 3)));
        Some(cells)
    };
    let rows: Vec<Vec<String>> = forecasts.iter().enumerate().filter_map(line).collect();
    Ok(columns(&heading, &names, &rows)
        + &limited.text(best, confidence)?
        + &reasons(analysed)
        + &notes_of_place(analysed, place)
        + &notes_of_intervals(analysed, forecasts))
}

/// A goal in words.
fn goal_words(analysed: &Analysed, goal: &Goal) -> String {
    let response = &analysed.analysis.responses[goal.response];
    let all = |values: &[f64]| values.iter().map(|value| response.shown(*value)).collect::<Vec<_>>().join(" … ");
    match goal.wish {
        Wish::Maximum(ends) => format!("large, {}", all(&ends)),
        Wish::Minimum(ends) => format!("small, {}", all(&ends)),
        Wish::Target(values) => format!("near {}, {}", response.shown(values[1]), all(&[values[0], values[2]])),
    }
}

/// What `plateau sweep optimize --json` prints. Numbers are in SI units.
#[derive(Debug, Serialize)]
struct Document<'a> {
    study: &'a str,
    confidence: f64,
    settings: Vec<SettingReport>,
    responses: Vec<ForecastReport>,
    goals: Vec<GoalReport>,
    /// The mean of all goals.
    desirability: f64,
    keeps_limits: bool,
    limits: Vec<LimitReport>,
    /// Factors that are at an end of their range.
    at_ends: Vec<String>,
    confirmed: Option<Vec<Option<Confirmed>>>,
    files: Vec<String>,
}

/// A goal in it.
#[derive(Debug, Serialize)]
struct GoalReport {
    response: String,
    aim: &'static str,
    /// From worth nothing to worth most, or for a target to worth nothing again.
    values: Vec<f64>,
    weight: f64,
    importance: f64,
    desirability: f64,
}

impl GoalReport {
    fn new(analysed: &Analysed, goal: &Goal, desirability: f64) -> Self {
        let (aim, values) = match goal.wish {
            Wish::Maximum([low, high]) => ("maximize", vec![low, high]),
            Wish::Minimum([low, high]) => ("minimize", vec![high, low]),
            Wish::Target(values) => ("target", values.to_vec()),
        };
        let response = analysed.analysis.responses[goal.response].name.clone();
        Self { response, aim, values, weight: goal.weight, importance: goal.importance, desirability }
    }
}
