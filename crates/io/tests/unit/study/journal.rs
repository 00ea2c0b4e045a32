//! Journals of several processes, torn ones, and ones that are made smaller.

use std::fs;
use std::path::{Path, PathBuf};

use super::{COMPLETE, FEW, Journal, OPEN, Shard, line, merge, next_line, shards};
use crate::study::record::{Identity, Outcome, Record, Series};

fn record(identity: &str, finished: bool) -> Record {
    let series = Series::new(vec!["time".into()], vec![vec![1.0, 2.0]]).pack();
    let outcome = if finished {
        Outcome::Finished { steps: 2, until: 2.0, series, events: None, pulse_time: None }
    } else {
        Outcome::Failed { error: "no".into() }
    };
    let (host, end_time) = ("h".into(), "now".into());
    let of = Identity::default();
    Record { identity: identity.into(), of, run: 1, outcome, wall_time: 0.5, host, end_time }
}

/// A complete shard of these records; where it is.
fn keep(folder: &Path, records: &[Record]) -> PathBuf {
    let mut shard = Shard::create(folder, "h").unwrap();
    records.iter().for_each(|record| shard.append(record).unwrap());
    let path = shard.path.with_extension(COMPLETE);
    shard.close().unwrap();
    path
}

fn identities(folder: &Path) -> Vec<(String, bool)> {
    let journal = Journal::read(folder).unwrap();
    let entries = journal.entries.iter();
    entries
        .map(|(identity, entry)| {
            let record = entry.record().unwrap();
            assert_eq!(record.identity, *identity);
            (record.identity, matches!(record.outcome, Outcome::Finished { .. }))
        })
        .collect()
}

#[test]
fn records_come_back_and_a_torn_line_is_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = keep(folder.path(), &[record("a", true), record("b", false)]);
    let bytes = fs::read(&path).unwrap();
    let whole = bytes.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    for length in 0..=bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let expected = usize::from(length >= whole) + usize::from(length == bytes.len());
        assert_eq!(identities(folder.path()).len(), expected, "cut at {length}");
    }
    // Any changed bit is found.
    for at in (0..whole).step_by(7) {
        let mut changed = bytes.clone();
        changed[at] ^= 1;
        fs::write(&path, &changed).unwrap();
        assert!(!identities(folder.path()).contains(&("a".into(), true)), "bit of byte {at}");
    }
}

#[test]
fn what_finished_counts_more_than_what_failed() {
    let folder = tempfile::tempdir().unwrap();
    for finished in [false, true, false] {
        keep(folder.path(), &[record("a", finished)]);
    }
    assert_eq!(identities(folder.path()), [("a".to_owned(), true)]);
}

#[test]
fn merging_keeps_every_record_in_few_files() {
    let folder = tempfile::tempdir().unwrap();
    for number in 0..30 {
        keep(folder.path(), &[record(&format!("{number:02}"), true)]);
        merge(folder.path(), "h").unwrap();
        assert!(shards(folder.path()).unwrap().len() <= FEW);
    }
    assert_eq!(identities(folder.path()).len(), 30);
}

#[test]
fn what_is_no_record_stays_where_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let good = line(&record("good", true)).unwrap();
    let notes = ["my notes\n", "my notes", "", "12345678 {"];
    for (number, text) in notes.iter().enumerate() {
        fs::write(path(&format!("notes{number}.{COMPLETE}")), text).unwrap();
    }
    let damaged = [&good[..20], b"\n", &good].concat();
    fs::write(path(&format!("h_1_a-0.{COMPLETE}")), &damaged).unwrap();
    let strange = Journal::read(folder.path()).unwrap().strange;
    assert_eq!(strange.len(), 5);
    for number in 0..12 {
        keep(folder.path(), &[record(&format!("{number:02}"), true)]);
    }
    // Of processes that were killed before their first record, and in the midst of one.
    fs::write(path(&format!("h_1_b-0.{COMPLETE}")), "").unwrap();
    fs::write(path(&format!("h_1_c-0.{COMPLETE}")), &good[..good.len() - 5]).unwrap();
    merge(folder.path(), "h").unwrap();
    assert_eq!(shards(folder.path()).unwrap().len(), 1 + 5);
    assert!(strange.iter().all(|path| path.exists()));
    assert_eq!(fs::read(path(&format!("h_1_a-0.{COMPLETE}"))).unwrap(), damaged);
    assert_eq!(identities(folder.path()).len(), 13);
}

#[test]
fn a_writer_taken_for_dead_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut shard = Shard::create(folder.path(), "h").unwrap();
    shard.append(&record("a", true)).unwrap();
    // As if another machine had given this process's number to nobody.
    fs::rename(&shard.path, shard.path.with_extension(COMPLETE)).unwrap();
    shard.append(&record("b", true)).unwrap();
    shard.append(&record("c", true)).unwrap();
    shard.close().unwrap();
    assert_eq!(identities(folder.path()).len(), 3);
}

#[test]
fn a_journal_is_read_on_from_where_it_was_read() {
    let folder = tempfile::tempdir().unwrap();
    let mut shard = Shard::create(folder.path(), "h").unwrap();
    shard.append(&record("a", true)).unwrap();
    let mut journal = Journal::read(folder.path()).unwrap();
    // Another process is in the midst of a line, then ends it.
    let half = line(&record("c", true)).unwrap();
    let open = folder.path().join(format!("h_1_a-0.{OPEN}"));
    fs::write(&open, &half[..half.len() - 4]).unwrap();
    shard.append(&record("b", false)).unwrap();
    journal.read_on(folder.path()).unwrap();
    let known = |journal: &Journal| {
        journal.entries().map(|(identity, entry)| (identity.to_owned(), entry.failure.is_some())).collect::<Vec<_>>()
    };
    assert_eq!(known(&journal), [("a".to_owned(), false), ("b".to_owned(), true)]);
    fs::write(&open, &half).unwrap();
    shard.append(&record("b", true)).unwrap();
    shard.close().unwrap();
    journal.read_on(folder.path()).unwrap();
    let all = [("a", false), ("b", false), ("c", false)].map(|(identity, failed)| (identity.to_owned(), failed));
    assert_eq!(known(&journal), all);
    // What was read is not read again, also under the name that a complete shard has.
    for shard in shards(folder.path()).unwrap() {
        let length = fs::metadata(&shard).unwrap().len() as usize;
        fs::write(&shard, vec![b'x'; length]).unwrap();
    }
    journal.read_on(folder.path()).unwrap();
    assert_eq!((known(&journal), journal.damaged), (all.to_vec(), 1));
}

#[test]
fn of_runs_that_were_made_again_the_one_that_kept_most_counts() {
    let folder = tempfile::tempdir().unwrap();
    let names = [&["time"][..], &["time", "pool", "worn_pin"], &["time", "pool"]];
    for names in names {
        let columns = names.iter().map(|_| vec![1.0]).collect();
        let series = Series::new(names.iter().map(|name| (*name).to_owned()).collect(), columns).pack();
        let outcome = Outcome::Finished { steps: 2, until: 3.0, series, events: None, pulse_time: None };
        keep(folder.path(), &[Record { outcome, ..record("a", true) }]);
    }
    let journal = Journal::read(folder.path()).unwrap();
    let entry = journal.get("a").unwrap();
    assert_eq!((entry.kept.iter().map(String::as_str).collect::<Vec<_>>()), (vec!["pool", "time", "worn_pin"]));
    assert!(matches!(entry.record().unwrap().outcome, Outcome::Finished { series, .. } if series.names().len() == 3));
}

#[test]
fn shards_of_processes_that_are_gone_are_merged() {
    let folder = tempfile::tempdir().unwrap();
    // In names of files a dot is not a part of the machine's.
    let host = "h.cluster.example";
    let mut living = Shard::create(folder.path(), host).unwrap();
    living.append(&record("living", true)).unwrap();
    for number in 0..12 {
        let name = format!("h-cluster-example_{}_{number:x}-0.{OPEN}", u32::MAX - number);
        fs::write(folder.path().join(name), line(&record(&format!("dead {number}"), true)).unwrap()).unwrap();
        let name = format!("elsewhere_{}_{number:x}-0.{OPEN}", u32::MAX - number);
        fs::write(folder.path().join(name), line(&record(&format!("far {number}"), true)).unwrap()).unwrap();
    }
    merge(folder.path(), host).unwrap();
    // One for the dead; who is elsewhere may be alive.
    assert_eq!(shards(folder.path()).unwrap().len(), 1 + 1 + 12);
    assert_eq!(identities(folder.path()).len(), 25);
}

#[test]
fn what_is_no_file_is_no_shard() {
    let folder = tempfile::tempdir().unwrap();
    let fifo = folder.path().join("h_1_0-0.journal");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    fs::create_dir(folder.path().join("h_1_0-1.open")).unwrap();
    assert!(Journal::read(folder.path()).unwrap().entries.is_empty());
    merge(folder.path(), "h").unwrap();
}

#[test]
fn a_line_without_end_takes_no_memory() {
    let mut text = "ab\ncdefghij\nkl\nmnop".as_bytes();
    let (mut line, mut lines) = (Vec::new(), Vec::new());
    loop {
        match next_line(&mut text, &mut line, 4).unwrap() {
            0 => break,
            length => lines.push((length, String::from_utf8(line.clone()).unwrap())),
        }
    }
    let expected = [(3, "ab\n"), (9, ""), (3, "kl\n"), (4, "")];
    assert_eq!(lines, expected.map(|(length, text)| (length, text.to_owned())));
}
