//! Runs in words: what deserves to be said of run files that a command line names, the results of a run that is finished, and
//! `plateau summary`, what the Python package asks of a run file that this program computes.

use plateau_core::acceleration::Chosen;
use plateau_core::model::accounts::AccountsReport;
use plateau_core::observe::running_in::{Drift, NotDefined, RUN_IN, Trend};
use plateau_core::observe::window_mean::{LEAST_PULSES, WindowMean};
use plateau_io::number;
use plateau_io::run_file::{NoDrift, RunFile, State};
use plateau_run::{AccountsSummary, RunSummary};
use serde::Serialize;

use crate::arguments::SummaryArguments;
use crate::failure::Failure;
use crate::message;
use crate::output::{list, print_json, table};

/// Warns of a run that is not finished.
pub fn warn_of_unfinished(run: &RunFile) {
    let samples = number::count(run.time().len(), "sample");
    let state = match run.state() {
        State::Finished => return,
        State::Running => "running (or it was killed)".to_owned(),
        state => state.name().to_owned(),
    };
    message::warning(format_args!("{} is not finished: its state is {state}, with {samples}", run.path().display()));
}

/// Part of the last time that a time may be beyond the maps without a word: maps are of the step that comes to their time.
const BEYOND: f64 = 1e-3;

/// Warns where a map is asked for, by a time in s, before the first or after the last one of a run.
pub fn warn_of_times(run: &RunFile, at: &[f64]) {
    let times = run.map_time();
    let [Some(first), Some(last)] = [times.first(), times.last()] else { return };
    for time in at {
        let (place, index) = if *time < first - BEYOND * last {
            ("before the first", 0)
        } else if *time > last + BEYOND * last {
            ("after the last", times.len() - 1)
        } else {
            continue;
        };
        let (path, time, shown) = (run.path().display(), number::rounded(*time, 4), moment(run, index));
        message::warning(format_args!("{path}: {time} s is {place} recorded map, that of {shown} is shown"));
    }
}

/// Indices of the maps that were recorded nearest to some times (s), in their order, each once.
pub fn nearest(run: &RunFile, times: &[f64]) -> Vec<usize> {
    let recorded = run.map_time();
    let distance = |index: &usize, time: f64| (recorded[*index] - time).abs();
    let nearest =
        |time: &f64| (0..recorded.len()).min_by(|one, other| distance(one, *time).total_cmp(&distance(other, *time)));
    let mut indices: Vec<usize> = times.iter().filter_map(nearest).collect();
    indices.sort_unstable();
    indices.dedup();
    indices
}

/// The time of a map, in words.
pub fn moment(run: &RunFile, index: usize) -> String {
    let seconds = run.map_time().get(index).copied().unwrap_or(f64::NAN);
    match seconds {
        short if short > 0.0 && short < 0.1 => format!("{} ms", number::rounded(1e3 * short, 4)),
        long if long >= 2e4 => format!("{} h", number::rounded(long / 3600.0, 4)),
        seconds => format!("{} s", number::rounded(seconds, 4)),
    }
}

/// The contact area at the end of a run, and what the run says of itself, in words.
#[derive(Debug, Serialize)]
struct Document {
    state: &'static str,
    contact_area_last_tenth: Option<WindowMean>,
    running_in: String,
    running_in_time: String,
    time_acceleration: Option<String>,
}

/// Prints it as JSON.
pub fn summary(arguments: &SummaryArguments) -> Result<(), Failure> {
    let run = RunFile::open(&arguments.run).map_err(Failure::input)?;
    warn_of_unfinished(&run);
    let found = run.contact_area().map_err(Failure::input)?;
    let filled = run.values("filled_fraction").map_err(Failure::input)?.and_then(|values| values.last().copied());
    let document = Document {
        state: run.state().name(),
        contact_area_last_tenth: found.last_tenth,
        running_in: running_in(&found.drift, filled.unwrap_or_default()),
        running_in_time: running_in_time(&found.running_in),
        time_acceleration: run
            .chosen_acceleration()
            .map(|chosen| acceleration(&chosen))
            .or(run.given_acceleration().map(|given| format!("m = {}", number::short(given)))),
    };
    print_json(&document)
}

/// A table for people.
pub fn text(summary: &RunSummary) -> String {
    // Adding 0 makes a negative zero a plain one.
    let percent = |fraction: f64| format!("{:.2} %", (1e4 * fraction).round() / 1e2 + 0.0);
    let mm3 = |volume: f64| format!("{} mm³", number::short(volume * 1e9));
    let (area, ratio) = (summary.contact_area * 1e6, percent(summary.contact_ratio));
    let last_step = format!("last step {area:.4} mm², {ratio} of the pin");
    let contact_area = match &summary.contact_area_last_tenth {
        Some(window) => format!("{}; {last_step}", contact_area(window)),
        None => last_step,
    };
    let steps = number::grouped(summary.steps) + if summary.steps == 1 { " step" } else { " steps" };
    let speed = number::grouped(summary.steps_per_second as u64);
    let mut rows = vec![
        ("simulated time", format!("{} s in {steps}", number::short(summary.time))),
        ("wall time", format!("{} ({speed} steps/s)", number::duration(summary.wall_time))),
        ("waited for the run file", number::duration(summary.writer_wait)),
        ("contact area", contact_area),
    ];
    rows.extend(summary.time_acceleration.as_ref().map(|chosen| ("time acceleration", acceleration(chosen))));
    let (drift, time) = &summary.running_in;
    let [mean, largest] = [summary.mean_pressure, summary.max_pressure].map(|pressure| pressure * 1e-6);
    let [on_disc, on_pin] = [summary.disc_secondary, summary.pin_secondary].map(percent);
    let [worn, emitted] = [summary.worn, summary.emitted].map(mm3);
    let [whole, off_plateaus] = [summary.worn_whole_pin, summary.worn_pin].map(mm3);
    rows.extend([
        ("running in", running_in(drift, summary.filled_fraction)),
        ("running-in time", running_in_time(time)),
        ("contact pressure", format!("last step: mean {mean:.3} MPa, largest {largest:.3} MPa")),
        ("disc filled", percent(summary.filled_fraction)),
        ("secondary plateaus", format!("{on_disc} of the disc, {on_pin} of the pin")),
        ("worn volume", format!("{worn} of the simulated pin and the disc, of which emitted {emitted}")),
        ("worn off the pin", format!("{whole} of the whole simulated pin, {off_plateaus} of it off plateaus")),
    ]);
    if let Some(rate) = summary.specific_wear_rate_whole_pin {
        // Build-up on the pin is weighed with it.
        let (lost, per_work) = (mm3(summary.lost_pin), rate * 1e9);
        let rate = format!("specific wear rate of the whole pin {rate:.3e} 1/Pa, {per_work:.3e} mm³/(N m)");
        rows.push(("lost by the pin", format!("{lost} as a balance shows it, {rate}")));
    }
    rows.extend(parts(summary));
    let heat = summary.accounts.last.heat.map_or(String::new(), |heat| format!(", heat {:.1e}", heat.residual));
    let RunSummary { load_residual, balance_residual, .. } = summary;
    rows.push(("residuals", format!("load {load_residual:.1e} at most, debris balance {balance_residual:.1e}{heat}")));
    rows.extend(summary.peak_memory.map(|bytes| ("peak memory", number::bytes(bytes))));
    rows.push(("run file", format!("{} ({})", summary.file.display(), number::bytes(summary.file_size))));
    format!("{}\n{}", table(&summary.title, &rows), list("Surfaces", &summary.surfaces))
}

/// Rows of the parts of the model that the scene asks for.
fn parts(summary: &RunSummary) -> Vec<(&'static str, String)> {
    let AccountsSummary { last, largest_disc_temperature } = summary.accounts;
    let AccountsReport { friction, heat, emission } = last;
    let mut rows = Vec::new();
    if let Some(friction) = friction {
        let (coefficient, work) = (friction.coefficient_mean, number::short(friction.work));
        let over = "mean of the last simulated revolution";
        rows.push(("friction", format!("coefficient {coefficient:.3} ({over}), work {work} J of the simulated pin")));
    }
    if let Some(heat) = heat {
        let celsius = |kelvin: f64| format!("{:.1} °C", kelvin - 273.15);
        let contact = if heat.contact.is_nan() { "lifted".to_owned() } else { celsius(heat.contact) };
        let [disc, pin] = [heat.disc, heat.pin].map(celsius);
        let largest = largest_disc_temperature.map_or(String::new(), |most| format!(" (at most {})", celsius(most)));
        rows.push(("temperature", format!("contact {contact}, disc {disc}{largest}, pin {pin}")));
    }
    if let Some(emission) = emission {
        let [pm10, pm25] = [emission.pm10, emission.pm25].map(|mass| number::short(mass * 1e9));
        let particles = number::short(emission.number);
        let area = number::rounded(summary.pin_area * 1e6, 3);
        let particles = format!("{particles} particles of the simulated pin, {area} mm²");
        rows.push(("airborne", format!("PM10 {pm10} µg, PM2.5 {pm25} µg, {particles}")));
    }
    rows.extend(brake(summary));
    rows
}

/// Rows of the whole brake, where the scene has one.
fn brake(summary: &RunSummary) -> Vec<(&'static str, String)> {
    let value = |name: &str| summary.brake.get(name).copied();
    let mut rows = Vec::new();
    if let Some(pm10) = value("brake_pm10_mass") {
        let each = [("lost", "emitted"), ("PM10", "pm10"), ("PM2.5", "pm25")].map(|(what, series)| {
            let mass = value(&format!("brake_{series}_per_distance"))?;
            Some(format!(", {what} {} mg/km", number::short(mass * 1e9)))
        });
        let each: String = each.into_iter().flatten().collect();
        rows.push(("whole brake", format!("PM10 {} mg{each}", number::short(pm10 * 1e6))));
    }
    if let Some(wear) = value("pad_wear") {
        let mut text = format!("worn by {} µm", number::short(wear * 1e6));
        if let Some((rate, life)) =
            value("pad_wear_per_distance").zip(value("pad_life")).filter(|(_, life)| *life > 0.0 && life.is_finite())
        {
            // Three digits are more than such a number has.
            let life = number::to_digits(life * 1e-3, 3);
            let [rate, life] = [number::short(rate * 1e9), number::grouped(life.round() as u64)];
            text += &format!(", {rate} mm in 1000 km: at this rate they last {life} km");
        }
        rows.push(("pads", text));
    }
    rows
}

/// A mean contact area with its standard error, and over what it is taken.
fn contact_area(window: &WindowMean) -> String {
    let mean = number::with_error(window.mean * 1e6, window.standard_error.map(|error| error * 1e6));
    let width = number::rounded(window.to - window.from, 4);
    let over = match window.revolutions {
        Some(revolutions) if !window.is_long() => {
            format!("mean of all {width} s, only {} simulated revolutions", number::rounded(revolutions, 2))
        }
        _ => format!("mean of the last {width} s"),
    };
    let contact = in_contact(window);
    let error = match window.standard_error {
        Some(_) => ", ± standard error",
        None => ", too few samples or pulses for an error",
    };
    format!("{mean} mm² ({over}{contact}{error})")
}

/// Tells whether the mean contact area still changes, in words, or why that cannot be told.
fn running_in(found: &Result<Drift, NoDrift>, filled: f64) -> String {
    let drift = match found {
        Ok(drift) => drift,
        Err(reason) => return reason.to_string(),
    };
    let Drift { third_quarter, last_quarter, change, standard_error, pulses } = drift;
    if let (Trend::TooShort, Some(pulses)) = (drift.trend(), pulses) {
        let pulses = format!("{} pulses of the contact area, {LEAST_PULSES} are needed", number::rounded(*pulses, 2));
        return format!("cannot be told: a quarter of the run has at most {pulses}");
    }
    let percent = number::with_error(100.0 * change, Some(100.0 * standard_error));
    let sign = if *change > 0.0 { "+" } else { "" };
    let [start, middle, end] =
        [third_quarter.from, last_quarter.from, last_quarter.to].map(|time| number::rounded(time, 4));
    let found = match drift.trend() {
        Trend::Rises => "contact area still rises",
        Trend::Falls => "contact area still falls",
        Trend::Steady => "contact area is steady",
        Trend::Unknown | Trend::TooShort => "cannot be told from a run of this length",
    };
    // It falls at first, where the highest points of the disc are worn to, and rises as long as the disc fills.
    let fills_on = drift.trend() == Trend::Steady && HARDLY_FILLED.contains(&filled);
    let caution = if fills_on {
        let filled = number::rounded(100.0 * filled, 2);
        format!("; the disc is filled by {filled} %, and as it fills on the area may rise")
    } else {
        String::new()
    };
    format!("{found}: {sign}{percent} % from {start} … {middle} s to {middle} … {end} s{caution}")
}

/// Filled fractions of a disc that fills and is far from full.
const HARDLY_FILLED: std::ops::Range<f64> = 0.001..0.8;

/// Time at which the contact area had come to its value at the end, in words.
fn running_in_time(found: &Result<f64, NotDefined>) -> String {
    match found {
        Ok(time) => {
            let (time, percent) = (number::rounded(*time, 4), 100.0 * RUN_IN);
            format!("{time} s, to {percent:.0} % of the contact area at the end")
        }
        Err(reason) => reason.to_string(),
    }
}

/// Over how much of its part a mean of the contact area is, behind that part; nothing where it is all of it.
fn in_contact(window: &WindowMean) -> String {
    let rest = "the time in which the pin is lifted, and before the first step, does not count";
    let told = |time| format!(", of which {} s in contact: {rest}", number::rounded(time, 4));
    window.contact_time.map_or_else(String::new, told)
}

/// Range and last m, the estimated error, and whether that is within the tolerance.
fn acceleration(chosen: &Chosen) -> String {
    let Chosen { tolerance, smallest, largest, last, estimated_error, met } = chosen;
    let [smallest, largest, last] = [smallest, largest, last].map(|m| number::rounded(*m, 3));
    let range = match largest == smallest {
        true => format!("m = {largest}"),
        false => format!("m = {smallest} to {largest}, last {last}"),
    };
    let [error, tolerance] = [estimated_error, tolerance].map(|part| number::percent(*part));
    let met = if *met { "met" } else { "not met" };
    format!("{range}; estimated error of the contact area {error}, tolerance {tolerance} {met}")
}

#[cfg(test)]
#[path = "../../tests/unit/commands/runs.rs"]
mod tests;
