//! Journals of studies: damaged lines are passed over, and lines whose checksum holds are records or none, whatever they say.

use std::fs;
use std::path::Path;

use plateau_io::study::Study;
use plateau_io::study::journal::{Journal, Shard, merge};
use plateau_io::study::plan::Plan;
use plateau_io::study::record::Identity;
use plateau_io::study::record::{Outcome, Record, Series};
use plateau_io::study::results::Collected;
use plateau_io::study::results::table;
use proptest::prelude::*;

use super::bytes::changes;
use super::harness::Fuzz;
use crate::hostile_tables::crc32;
use crate::studies;

fn plan(folder: &Path) -> Plan {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/quick.toml");
    fs::copy(base, folder.join("quick.toml")).unwrap();
    let study = studies::Study::new("quick.toml", "full-factorial", "")
        .load("levels = [\"5 N\", \"6 N\"]")
        .response("pool", "/series/pool", "reaches = 0.9")
        .response("mean", "/series/contact_area", "mean = \"last tenth\"")
        .response("late", "/series/pool", "at = \"2 s\"");
    fs::write(folder.join("study.toml"), study).unwrap();
    Plan::new(Study::load(&folder.join("study.toml")).unwrap()).unwrap()
}

/// The records of both runs, without their checksums.
fn lines(folder: &Path) -> Vec<Vec<u8>> {
    let names = ["time", "simulated_revolutions", "pool", "contact_area", "contact_area_integral"];
    let column = |scale: f64| (1..=20).map(|sample| f64::from(sample) * scale).collect::<Vec<f64>>();
    let columns = [0.1, 1.0, 1e-12, 1e-6, 1e-7].map(column).to_vec();
    let series = Series::new(names.map(str::to_owned).to_vec(), columns).pack();
    let mut shard = Shard::create(folder, "h").unwrap();
    for (run, identity) in [(1, "a"), (2, "b")] {
        let outcome =
            Outcome::Finished { steps: 20, until: 20.0, series: series.clone(), events: None, pulse_time: None };
        let (identity, host, end_time) = (identity.to_owned(), "h".to_owned(), "now".to_owned());
        let of = Identity::default();
        shard.append(&Record { identity, of, run, outcome, wall_time: 0.5, host, end_time }).unwrap();
    }
    shard.close().unwrap();
    let path = fs::read_dir(folder).unwrap().next().unwrap().unwrap().path();
    let content = fs::read(&path).unwrap();
    fs::remove_file(path).unwrap();
    content.split(|byte| *byte == b'\n').filter(|line| !line.is_empty()).map(|line| line[9..].to_vec()).collect()
}

#[test]
fn changed_journals_are_read_or_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let (plan, journal) = (plan(folder.path()), folder.path().join("journal"));
    let lines = lines(&journal);
    let strategy = (changes(), any::<bool>()).prop_map(move |(changes, sealed)| {
        let mut content = lines[0].clone();
        changes.iter().for_each(|change| change.apply(&mut content));
        let sum = if sealed { crc32(&content) } else { crc32(&lines[0]) };
        let own = [format!("{sum:08x} ").as_bytes(), &content, b"\n"].concat();
        [&own[..], format!("{:08x} ", crc32(&lines[1])).as_bytes(), &lines[1], b"\n"].concat()
    });
    let identities = ["a", "b"].map(str::to_owned);
    Fuzz { corpus: "journals", cases: 600, least_accepted: 200 }.run(strategy, |content| {
        let _ = fs::remove_dir_all(&journal);
        fs::create_dir_all(&journal).unwrap();
        fs::write(journal.join("h_1_0-0.journal"), content).unwrap();
        let read = Journal::read(&journal).map_err(|error| TestCaseError::fail(error.to_string()))?;
        // A line that holds is never lost to one that does not.
        prop_assert!(read.get("b").is_some());
        let collected =
            Collected::new(&plan, &identities, &read).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(collected.runs.len(), 2);
        prop_assert_eq!(table(&plan, &collected).len(), 3);
        let file = folder.path().join("results.h5");
        if let Err(error) = collected.write(&file, true, &plan, Vec::new()) {
            prop_assert!(!error.to_string().is_empty());
        }
        prop_assert!(merge(&journal, "h").is_ok());
        Ok(read.get("a").is_some())
    });
}
