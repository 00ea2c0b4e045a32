//! Run files that were changed at random, in every command that reads one: each in a process of its own, for a library stands
//! between, and with bounded memory and time.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use plateau_tests::program::{WorkingDirectory, run, scene};
use plateau_tests::scenes::{Stream, few_or_all};

/// Longest that one command may take on a file of 200 kB, without optimisation.
const LONGEST: Duration = Duration::from_secs(60);

/// Changes some bytes: mostly where the file says how it is organised.
fn changed(good: &[u8], random: &mut Stream) -> Vec<u8> {
    let mut content = good.to_vec();
    let mut below = |count: usize| ((count as f64 * random.uniform()) as usize).min(count - 1);
    for _ in 0..1 + below(4) {
        let room = if below(2) == 0 { content.len().min(8192) } else { content.len() };
        let at = below(room);
        match below(5) {
            0 => content[at] ^= 1 << below(8),
            1 => content[at] = [0, 0x7f, 0x80, 0xff][below(4)],
            2 => {
                let end = content.len().min(at + 8);
                content[at..end].fill([0, 0xff][below(2)]);
            }
            3 => {
                let (from, length) = (below(content.len()), 1 + below(64));
                let piece = content[from..content.len().min(from + length)].to_vec();
                let end = content.len().min(at + piece.len());
                content[at..end].copy_from_slice(&piece[..end - at]);
            }
            _ => content.truncate(at.max(1)),
        }
    }
    content
}

#[test]
fn changed_run_files_are_read_or_refused() {
    let directory = WorkingDirectory::new();
    let sets = ["mesh.rows=4", "mesh.disc_columns=60", "mesh.pin_columns=8", "operation.duration=3 s"];
    let surfaces = ["disc.surface.synthetic.correlation_length=2 mm", "pin.surface.synthetic.correlation_length=2 mm"];
    let sets: Vec<&str> = sets.into_iter().chain(surfaces).flat_map(|set| ["--set", set]).collect();
    let quick = scene("quick.toml");
    directory.plateau(["run", &quick, "-o", "run.h5"].iter().chain(&sets)).ends(0, &[]);
    let good = fs::read(directory.path("run.h5")).unwrap();
    let resume: Vec<&str> = ["run", &quick, "-o", "changed.h5", "--resume"].into_iter().chain(sets.clone()).collect();
    let commands: [&[&str]; 6] = [
        &["verify", "changed.h5"],
        &["watch", "changed.h5", "--once"],
        &["summary", "changed.h5"],
        &["surface", "changed.h5"],
        &["repair", "changed.h5"],
        &resume,
    ];
    let seconds = std::env::var("PLATEAU_FUZZ_SECONDS").ok().map(|text| text.parse().unwrap());
    let (most, start) = (few_or_all(20, 2000), Instant::now());
    let mut random = Stream(if seconds.is_some() { u64::from(std::process::id()) } else { 23 });
    let (mut tried, mut answered) = (0, 0);
    while seconds.map_or(tried < most, |seconds| start.elapsed() < Duration::from_secs(seconds)) {
        let content = changed(&good, &mut random);
        // One after the other: all on each file would take seven times as long.
        let command = commands[tried % commands.len()];
        directory.remove("changed.h5");
        fs::copy(directory.path("run.h5.checkpoint"), directory.path("changed.h5.checkpoint")).unwrap();
        directory.write("changed.h5", &content);
        let before = Instant::now();
        let outcome = run(directory.command_after("ulimit -c 0; ulimit -v 2000000", command));
        let is_answer = matches!(outcome.status, Some(0..=2)) && !outcome.stderr.contains("panicked");
        if !is_answer || before.elapsed() > LONGEST {
            let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("changed-{tried}.h5"));
            fs::write(&kept, &content).unwrap();
            panic!("{command:?} on {} in {:.0?}: {outcome:?}", kept.display(), before.elapsed());
        }
        tried += 1;
        answered += usize::from(outcome.status == Some(0));
    }
    println!("{tried} changed run files, {answered} read");
    // A sixth of them is read. Of the few that a busy machine tries at random there may be none.
    let spared = if seconds.is_some() { 60 } else { 0 };
    assert!(20 * answered + spared > tried, "only {answered} of {tried} are still read");
}
