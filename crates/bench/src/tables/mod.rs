//! The tables that are made from results.

mod costs;
mod table;

use crate::document::{Agreement, Benchmark, Document, Measurement, STRONG, Spread, WEAK};
use table::{Table, number, range};

/// The tables of a benchmark, the last one with the circumstances of the measurement below it.
pub fn tables(document: &Document) -> Vec<Table> {
    let mut tables = match document.benchmark {
        Benchmark::Kernel => vec![kernel(document)],
        Benchmark::Scaling => vec![strong(document), weak(document), sizes(document)],
        Benchmark::Parts => vec![parts(document)],
        Benchmark::Costs => costs::tables(document),
        Benchmark::Peers => vec![peers(document), agreements(document)],
    };
    tables.retain(|table| !table.rows.is_empty());
    if let Some(last) = tables.last_mut() {
        last.notes.extend(document.notes.iter().cloned());
        last.notes.push(circumstances(document));
    }
    tables
}

/// Where, with what and how something was measured.
fn circumstances(document: &Document) -> String {
    let Document { machine, build, settings, .. } = document;
    let memory = machine.memory_bytes.map_or(String::new(), |bytes| format!(", {:.1} GB", bytes as f64 / 1e9));
    let load = machine.load.map_or(String::new(), |load| format!(", load {load} before"));
    let flags = if build.flags.is_empty() { String::new() } else { format!(", flags {}", build.flags) };
    let sets: String = settings.sets.iter().map(|set| format!(" `{set}`")).collect();
    let quick = if settings.quick { " Only a look at whether it runs: the numbers mean nothing." } else { "" };
    let (name, cores, system) = (&machine.processor, machine.cores, &machine.system);
    let (commit, changed) = build.revision.split_once('-').unwrap_or((&build.revision, ""));
    let commit: String = commit.chars().take(12).collect();
    let changed = if changed.is_empty() { "" } else { ", changed" };
    let worn_in = if settings.worn_in > 0.0 { format!(", worn in for {} s", settings.worn_in) } else { String::new() };
    let blocks = settings.block_milliseconds.map_or("runs".into(), |time| format!("blocks of about {time} ms"));
    format!(
        "{name}, {cores} cores{memory}, {system}{load}; revision {commit}{changed}, {}, {} for {}{flags}; {}{sets}{worn_in}; \
         median of {} {blocks}, measured in turn.{quick}",
        build.compiler, build.profile, build.target, settings.scene, settings.repeats,
    )
}

/// Median, and least and largest.
fn time(spread: Spread) -> [String; 2] {
    [number(spread.median), range(spread)]
}

fn percent(fraction: f64) -> String {
    format!("{:.0} %", fraction * 100.0)
}

fn evaluations(measurement: &Measurement) -> String {
    measurement.load_evaluations_per_step.map_or("–".into(), number)
}

/// How many times as fast as `other`.
fn speedup(this: &Measurement, other: &Measurement) -> Spread {
    other.ratio_to(this)
}

fn kernel(document: &Document) -> Table {
    let header = ["instructions", "workers", "µs per step", "range", "ns per cell", "load evaluations", "speedup"];
    let mesh = document.measurements.first().map_or(String::new(), |first| first.mesh.to_string());
    let mut table = Table::new(format!("One step, {mesh} columns"), &header);
    for step in &document.measurements {
        let [median, range] = time(step.microseconds_per_step);
        table.rows.push(vec![
            step.name.clone(),
            step.workers.to_string(),
            median,
            range,
            number(step.nanoseconds_per_cell),
            evaluations(step),
            number(speedup(step, &document.measurements[0]).median),
        ]);
    }
    table
}

/// The measurement of one worker on the same mesh.
fn alone<'a>(document: &'a Document, step: &Measurement) -> Option<&'a Measurement> {
    document.measurements.iter().find(|other| other.mesh == step.mesh && other.workers == 1)
}

fn strong(document: &Document) -> Table {
    let header = ["mesh", "workers", "µs per step", "range", "ns per cell", "speedup", "efficiency"];
    let mut table = Table::new("Strong scaling: more workers on the same mesh", &header);
    for step in document.measurements.iter().filter(|step| step.name == STRONG) {
        let faster = alone(document, step).map(|alone| speedup(step, alone).median);
        let [median, range] = time(step.microseconds_per_step);
        table.rows.push(vec![
            step.mesh.to_string(),
            step.workers.to_string(),
            median,
            range,
            number(step.nanoseconds_per_cell),
            faster.map_or("–".into(), number),
            faster.map_or("–".into(), |faster| percent(faster / step.workers as f64)),
        ]);
    }
    table
}

fn weak(document: &Document) -> Table {
    let header = ["mesh", "workers", "µs per step", "range", "efficiency"];
    let mut table = Table::new("Weak scaling: W workers on a pin and ring W times as long", &header);
    let Some(first) = document.measurements.first() else { return table };
    for step in document.measurements.iter().filter(|step| step.name == WEAK) {
        let [median, range] = time(step.microseconds_per_step);
        let efficiency = percent(speedup(step, first).median);
        table.rows.push(vec![step.mesh.to_string(), step.workers.to_string(), median, range, efficiency]);
    }
    if !table.rows.is_empty() {
        let [median, range] = time(first.microseconds_per_step);
        table.rows.insert(0, vec![first.mesh.to_string(), "1".into(), median, range, percent(1.0)]);
    }
    table
}

fn sizes(document: &Document) -> Table {
    let header = ["mesh", "cells", "µs per step", "load evaluations", "ns per cell", "against the first"];
    let mut table = Table::new("Cost of a cell by size of the mesh, one worker", &header);
    let alone: Vec<_> = document.measurements.iter().filter(|step| step.name == STRONG && step.workers == 1).collect();
    for step in &alone {
        let relative = |time: f64| time * alone[0].mesh.pin_cells() as f64 / step.mesh.pin_cells() as f64;
        table.rows.push(vec![
            step.mesh.to_string(),
            step.mesh.pin_cells().to_string(),
            number(step.microseconds_per_step.median),
            evaluations(step),
            number(step.nanoseconds_per_cell),
            number(relative(step.ratio_to(alone[0]).median)),
        ]);
    }
    table
}

fn parts(document: &Document) -> Table {
    let header = ["scene", "µs per step", "range", "load evaluations", "against the scene", "range"];
    let mesh = document.measurements.first().map_or(String::new(), |first| first.mesh.to_string());
    let mut table = Table::new(format!("Optional parts, {mesh} columns, one worker"), &header);
    for step in &document.measurements {
        let ratio = step.ratio_to(&document.measurements[0]);
        let [median, times] = time(step.microseconds_per_step);
        table.rows.push(vec![
            step.name.clone(),
            median,
            times,
            evaluations(step),
            format!("{:.3}", ratio.median),
            format!("{:.3} – {:.3}", ratio.minimum, ratio.maximum),
        ]);
    }
    table
}

fn peers(document: &Document) -> Table {
    let header = ["program", "µs per step", "range", "ns per cell", "load evaluations", "times ours", "range"];
    let mesh = document.measurements.first().map_or(String::new(), |first| first.mesh.to_string());
    let mut table = Table::new(format!("The same step by other means, {mesh} columns, one core"), &header);
    for step in &document.measurements {
        let ratio = step.ratio_to(&document.measurements[0]);
        let [median, times] = time(step.microseconds_per_step);
        table.rows.push(vec![
            step.name.clone(),
            median,
            times,
            number(step.nanoseconds_per_cell),
            evaluations(step),
            number(ratio.median),
            range(ratio),
        ]);
    }
    table
}

/// A difference from ours, with the head of its column.
type Difference = (&'static str, fn(&Agreement) -> Option<f64>);

fn agreements(document: &Document) -> Table {
    let all: [Difference; 5] = [
        ("displacement", |peer| Some(peer.displacement)),
        ("contact area", |peer| Some(peer.contact_area)),
        ("debris pool", |peer| peer.pool),
        ("deposited volume", |peer| peer.deposited),
        ("heights", |peer| Some(peer.heights)),
    ];
    let is_known = |value: fn(&Agreement) -> Option<f64>| document.agreements.iter().any(|peer| value(peer).is_some());
    let differences: Vec<Difference> = all.into_iter().filter(|(_, value)| is_known(*value)).collect();
    let names = differences.iter().map(|(name, _)| *name);
    let header: Vec<&str> = ["program", "time acceleration", "steps"].into_iter().chain(names).collect();
    let mut table = Table::new("Largest difference from ours over the largest value", &header);
    for peer in &document.agreements {
        let name = format!("{} ({})", peer.peer, peer.versions);
        let figures =
            differences.iter().map(|(_, value)| value(peer).map_or("–".into(), |value| format!("{value:.0e}")));
        let circumstances = [name, peer.time_acceleration.to_string(), peer.steps.to_string()];
        table.rows.push(circumstances.into_iter().chain(figures).collect());
    }
    table
}
