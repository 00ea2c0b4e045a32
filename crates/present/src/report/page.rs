//! The page, put together.

use plateau_core::observe::Map;
use plateau_io::run_file::{ContactArea, ReadError, RunFile, State};

use super::document::Document;
use super::html;
use super::layout::{AROUND, Layout, Section};
use super::outcome::{self, Measure, UNKNOWN, readable};
use super::picture::Pictures;
use super::series::{MOST_POINTS, Recorded, recorded};
use super::{comparison, dissipation, events, provenance};
use crate::label::labels;
use plateau_io::number;

/// Bytes of a page, as far as maps can be reduced to meet it.
const MOST_BYTES: usize = 4_900_000;

const STYLE: &str = include_str!("../../assets/uplot/uPlot.min.css");
/// Scripts, each after those that it uses.
const SCRIPT: &str = concat!(
    "/*\n",
    include_str!("../../assets/uplot/LICENSE-uPlot"),
    "*/\n",
    include_str!("../../assets/uplot/uPlot.iife.min.js"),
    include_str!("assets/data.js"),
    include_str!("assets/chart.js"),
    include_str!("assets/map.js"),
    include_str!("assets/main.js"),
);

/// One self-contained HTML page about runs and figures of them, made by a program of that name and version.
///
/// # Errors
/// [`ReadError::Damaged`] when a series or a map cannot be read.
pub fn page(runs: &[RunFile], pictures: &Pictures, program: &str) -> Result<String, ReadError> {
    let labels = labels(runs);
    let series = runs.iter().map(recorded).collect::<Result<Vec<_>, _>>()?;
    let contact_areas = runs.iter().map(RunFile::contact_area).collect::<Result<Vec<_>, _>>()?;
    let of_every_run =
        series.iter().zip(&contact_areas).map(|(series, area)| outcome::measures(series, area.last_tenth));
    let measures: Vec<_> =
        of_every_run.zip(dissipation::measures(&series)).map(|(every, parts)| [every, parts].concat()).collect();
    let mut document = Document::new(runs, &labels, &series, &pictures.pictures);
    let parts = Parts { runs, labels: &labels, series: &series, contact_areas: &contact_areas, measures: &measures };
    let around = AROUND + STYLE.len() + SCRIPT.len() + parts.provenance().len() + 20_000 * (1 + runs.len());
    document.add_maps(runs, MOST_BYTES.saturating_sub(around))?;
    let has_samples = runs.iter().any(|run| !run.time().is_empty());
    let has_maps = document.runs.iter().any(|run| !run.maps.is_empty());
    let sections = [
        Section::new("summary", "Summary", parts.summary()),
        Section::new("comparison", "Comparison", parts.comparison()),
        Section::new("series", "Series", if has_samples { CHARTS } else { "" }),
        Section::new("maps", "Maps", if has_maps { MAPS } else { "" }),
        Section::new("figures", "Figures", if pictures.pictures.is_empty() { "" } else { FIGURES }),
        Section::new("events", "Events", events::tables(runs, &labels)?),
        Section::new("residuals", "Residuals", if has_samples { parts.residuals() } else { String::new() }),
        Section::new("scenes", "Scenes and provenance", parts.provenance()),
        Section::new(
            "contents",
            "What this page holds",
            html::list(&[parts.contents(&document), pictures.left_out.clone()].concat()),
        ),
    ];
    let page = Layout {
        title: &parts.title(),
        subtitle: &parts.subtitle(program),
        notices: &parts.notices(),
        without_scripts: "Charts, maps and figures need JavaScript; tables and scenes do not.",
        sections: &sections,
        style: STYLE,
        data: &document.to_json(),
        script: SCRIPT,
    };
    Ok(page.html())
}

const CHARTS: &str = "<p class=\"hint\">Drag over a chart to zoom, double-click to see all. With the keyboard: arrow keys move \
    the cursor, + and − zoom, 0 shows all.</p>\n<fieldset id=\"runs-shown\"><legend>Runs</legend></fieldset>\n\
    <div id=\"charts\"></div>\n";

const MAPS: &str = "<div id=\"map-controls\" class=\"controls\"></div>\n<div id=\"map-views\"></div>\n";

const FIGURES: &str = "<details id=\"figure-fold\" open>\n<summary>Figures for print</summary>\n<div id=\"figure-list\"></div>\n</details>\n";

/// What the parts of the page that are text are made of.
struct Parts<'a> {
    runs: &'a [RunFile],
    labels: &'a [String],
    series: &'a [Vec<Recorded>],
    contact_areas: &'a [ContactArea],
    measures: &'a [Vec<Measure>],
}

impl Parts<'_> {
    fn title(&self) -> String {
        match self.labels {
            [one] => one.clone(),
            several => format!("{} runs of Plateau", several.len()),
        }
    }

    fn subtitle(&self, program: &str) -> String {
        let names = if self.labels.len() > 1 { format!("{}. ", self.labels.join(" · ")) } else { String::new() };
        format!("{names}Made by {program}.")
    }

    /// What deserves attention before the numbers.
    fn notices(&self) -> Vec<String> {
        let unfinished = self.runs.iter().zip(self.labels).filter(|(run, _)| run.state() != State::Finished);
        let notice = |(run, label): (&RunFile, &String)| {
            let samples = if run.time().is_empty() { " It has no samples." } else { "" };
            format!("{label} is not finished: its state is {}.{samples}", run.state().name())
        };
        unfinished.map(notice).collect()
    }

    /// Heads of a table with a column for every run.
    fn heads(&self, first: &str) -> Vec<String> {
        std::iter::once(first.to_owned()).chain(self.labels.iter().cloned()).collect()
    }

    fn summary(&self) -> String {
        let facts: Vec<_> =
            self.runs.iter().zip(self.contact_areas).map(|(run, area)| outcome::facts(run, area)).collect();
        let fact = |index: usize| {
            let name = facts[0][index].0.to_owned();
            std::iter::once(name).chain(facts.iter().map(|facts| facts[index].1.clone())).collect()
        };
        let measure = |index: usize| {
            let name = self.measures[0][index].name.clone();
            std::iter::once(name).chain(self.measures.iter().map(|measures| measures[index].text())).collect()
        };
        let rows: Vec<Vec<String>> =
            (0..facts[0].len()).map(fact).chain((0..self.measures[0].len()).map(measure)).collect();
        html::table("Summary", &self.heads("At the end"), &rows)
    }

    /// Empty for one run.
    fn comparison(&self) -> String {
        if self.runs.len() < 2 {
            return String::new();
        }
        let scenes: Vec<_> = self.runs.iter().map(RunFile::scene).collect();
        let differences = provenance::differences(&scenes);
        let numbers = html::table(
            "Numbers, with differences from the first run",
            &self.heads("At the end, and how far from the first run"),
            &comparison::rows(self.measures),
        );
        let scenes = if differences.is_empty() {
            "<p>Their scenes are the same.</p>\n".to_owned()
        } else {
            html::table("Keys of the scenes that differ", &self.heads("Keys of the scenes that differ"), &differences)
        };
        numbers + &scenes
    }

    fn residuals(&self) -> String {
        let row = |(label, series): (&String, &Vec<Recorded>), run: &RunFile| {
            let of = |name: &str| {
                let found = series.iter().find(|series| series.name == name);
                let text = |value: Option<f64>| value.map_or_else(|| UNKNOWN.into(), |value| readable(value.abs()));
                [text(found.and_then(|found| found.largest)), text(found.and_then(|found| found.last))]
            };
            let tolerance = run.scene().get("contact").and_then(|contact| contact.get("load_tolerance"));
            let tolerance = tolerance
                .and_then(toml::Value::as_float)
                .map_or_else(|| UNKNOWN.into(), |tolerance| number::with_minus(&format!("{tolerance:e}")));
            let [load, last_load] = of("load_residual");
            let [balance, last_balance] = of("balance_residual");
            vec![label.clone(), load, last_load, tolerance, balance, last_balance]
        };
        let heads = ["Run", "Load: largest", "Load: last", "Load: tolerance", "Debris: largest", "Debris: last"];
        let rows: Vec<_> =
            self.labels.iter().zip(self.series).zip(self.runs).map(|(part, run)| row(part, run)).collect();
        html::table("Residuals", &heads.map(str::to_owned), &rows)
            + "<p class=\"hint\">Relative residuals of the load balance and of the debris balance; the chart shows their \
               magnitude.</p>\n<div id=\"residual-chart\"></div>\n"
    }

    fn provenance(&self) -> String {
        self.labels.iter().zip(self.runs).map(|(label, run)| provenance::fold(label, run)).collect()
    }

    /// What was left out of the run files, and how exact the rest is.
    fn contents(&self, document: &Document) -> Vec<String> {
        let mut notes = vec![
            format!(
                "Numbers in tables come from all samples. A chart has at most {MOST_POINTS} points a series, and of every \
                 interval in between the lowest and the highest sample; values are rounded to 32-bit floating point (relative \
                 error 6e−8 at most)."
            ),
            "Colours of heights leave out the lowest and the highest 0.5 % of the values, which take the colours of the ends; \
             pressures begin at 0, and the highest 0.5 % of the cells in contact take the last colour. The pin wears by far \
             more than it is rough: its colours are of heights less their mean at each time."
                .to_owned(),
        ];
        if self.runs.iter().any(|run| run.has_map(Map::Temperature)) {
            notes.push(
                "Temperatures of the pin's cells count pressures as frozen during a pass and have no conduction along the \
                 surface: on rough discs the hottest may be half of their rise too low."
                    .to_owned(),
            );
        }
        for (run, file) in document.runs.iter().zip(self.runs) {
            let samples = file.time().len();
            let thinned = if samples > MOST_POINTS { "thinned in the charts" } else { "all in the charts" };
            notes.push(format!("{}: {samples} samples, {thinned}. {}", run.label(), run.maps_note()));
        }
        if self.runs.iter().any(|run| run.time().is_empty()) {
            notes.push("Charts and residuals of runs without samples are left out.".into());
        }
        if document.runs.iter().all(|run| run.maps.is_empty()) {
            notes.push("There are no maps on this page: the runs did not record any.".into());
        }
        notes
    }
}
