//! Tables of what runs of the program cost, one for each scene.

use super::table::{Table, number, range};
use crate::document::{Document, RunCost, Spread, ratios};

/// A table for each scene, with a row for each variant.
pub fn tables(document: &Document) -> Vec<Table> {
    let scenes = document.runs.chunk_by(|one, next| one.scene == next.scene);
    scenes.map(table).collect()
}

fn table(runs: &[RunCost]) -> Table {
    let header = ["variant", "µs per step", "ratio", "range", "peak memory MB", "difference MB", "run file kB"];
    let title = runs
        .first()
        .map_or(String::new(), |first| format!("{}, {} columns, {} steps", first.scene, first.mesh, first.steps));
    let mut table = Table::new(title, &header);
    for run in runs {
        let against = runs.iter().find(|other| other.name == run.against).unwrap_or(run);
        let ratio = ratios(&run.raw_microseconds_per_step, &against.raw_microseconds_per_step);
        table.rows.push(vec![
            run.name.clone(),
            number(run.microseconds_per_step.median),
            number(ratio.median),
            range(ratio),
            megabytes(&run.peak_memory_bytes).map_or("–".into(), |memory| format!("{memory:.1}")),
            difference(run, against).map_or("–".into(), signed),
            format!("{:.0}", run.file_bytes as f64 / 1e3),
        ]);
    }
    table
}

/// Middle of the peaks, none where the system did not tell.
fn megabytes(peaks: &[u64]) -> Option<f64> {
    let peaks: Vec<f64> = peaks.iter().map(|peak| *peak as f64 / 1e6).collect();
    (!peaks.is_empty()).then(|| Spread::of(&peaks).median)
}

/// Of the middle peaks, MB.
fn difference(run: &RunCost, against: &RunCost) -> Option<f64> {
    Some(megabytes(&run.peak_memory_bytes)? - megabytes(&against.peak_memory_bytes)?)
}

/// One decimal, 0 without a sign.
fn signed(value: f64) -> String {
    if value.abs() < 0.05 { "0.0".into() } else { format!("{value:+.1}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::MeshSize;

    fn run(name: &str, against: &str, times: [f64; 3], peaks: [u64; 3], file_bytes: u64) -> RunCost {
        RunCost {
            scene: "scene.toml".into(),
            mesh: MeshSize::QUICK,
            name: name.into(),
            against: against.into(),
            steps: 691,
            microseconds_per_step: Spread::of(&times),
            raw_microseconds_per_step: times.to_vec(),
            peak_memory_bytes: peaks.to_vec(),
            file_bytes,
        }
    }

    #[test]
    fn a_variant_is_set_against_what_it_names() {
        let runs = [
            run("the scene", "the scene", [2.0, 4.0, 8.0], [30_000_000, 31_000_000, 35_000_000], 6_400_400),
            run("no maps", "the scene", [1.0, 3.0, 2.0], [20_500_000, 20_400_000, 20_600_000], 65_000),
            run("no maps, one pool", "no maps", [1.5, 3.0, 4.0], [20_500_000; 3], 65_600),
        ];
        // By hand: medians; ratios 1/2, 3/4, 2/8 and 3/2, 1, 2 of runs next to each other.
        let expected = [
            ["the scene", "4.00", "1.00", "1.00 – 1.00", "31.0", "0.0", "6400"],
            ["no maps", "2.00", "0.50", "0.25 – 0.75", "20.5", "-10.5", "65"],
            ["no maps, one pool", "3.00", "1.50", "1.00 – 2.00", "20.5", "0.0", "66"],
        ];
        let made = table(&runs);
        assert_eq!(made.title, "scene.toml, 20 x 40 on 691 columns, 691 steps");
        assert_eq!(made.rows, expected);
    }

    #[test]
    fn a_memory_that_nobody_told_is_no_number() {
        let mut silent = run("the scene", "the scene", [1.0; 3], [0; 3], 1000);
        silent.peak_memory_bytes.clear();
        assert_eq!(table(&[silent]).rows[0][4..6], ["–", "–"]);
    }
}
