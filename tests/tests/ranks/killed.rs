//! Jobs of which a rank or the launcher is killed at any moment end as one, and are gone on with as if nothing had happened.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use plateau_tests::program::{WorkingDirectory, program, scene, wait_until};
use plateau_tests::run_file::{assert_holds_start, differences};
use plateau_tests::scenes::{Stream, few_or_all};

use super::{LEAVE_PROCESS_NUMBER, mpirun};

/// A run of some seconds with many samples and a checkpoint every few hundredths of a second.
fn arguments(file: &str) -> Vec<String> {
    let sets = [
        "operation.duration=150 s",
        "numerics.time_acceleration=1",
        "output.sample_every=0.05 s",
        "output.maps_at=[\"0 s\", \"100 s\"]",
        "output.checkpoint_every=0.03 s",
    ];
    let mut arguments = ["run", &scene("quick.toml"), "-o", file, "--resume"].map(str::to_owned).to_vec();
    arguments.extend(sets.iter().flat_map(|set| ["--set".to_owned(), (*set).to_owned()]));
    arguments
}

/// The processes of the ranks that have begun.
fn ranks_of(directory: &WorkingDirectory, ranks: usize) -> Vec<String> {
    let process = |rank: usize| fs::read_to_string(directory.path(&rank.to_string())).ok();
    (0..ranks).filter_map(process).map(|text| text.trim_end().to_owned()).filter(|text| !text.is_empty()).collect()
}

/// Kills as often as `PLATEAU_KILLS` says, if it does; every third time the launcher, else one of the ranks.
#[test]
#[ignore = "needs MPI"]
fn jobs_that_are_killed_again_and_again_end_bit_for_bit_like_an_undisturbed_run() {
    let kills = std::env::var("PLATEAU_KILLS").map_or(few_or_all(6, 200), |kills| kills.parse().unwrap());
    let directory = WorkingDirectory::new();
    directory.plateau(arguments("whole.h5")).ends(0, &[]);
    let whole = directory.run_file("whole.h5").content();
    let (mut random, mut killed, mut ended) = (Stream(25), 0, 0);
    while killed < kills || ended == 0 {
        let ranks = 2 + killed % 2;
        (0..3).for_each(|rank| drop(fs::remove_file(directory.path(&rank.to_string()))));
        let stderr = File::create(directory.path("stderr")).unwrap();
        let mut command = mpirun(&directory);
        command.args(["-n", &ranks.to_string(), "sh", "-c", LEAVE_PROCESS_NUMBER]).arg(program());
        let mut launcher = command.args(arguments("run.h5")).stdout(Stdio::null()).stderr(stderr).spawn().unwrap();
        if killed < kills {
            thread::sleep(Duration::from_secs_f64(0.2 + 1.3 * random.uniform()));
            let processes = ranks_of(&directory, ranks);
            if launcher.try_wait().unwrap().is_none() {
                match processes.get(killed % 3) {
                    // It may have come to its end just now.
                    Some(rank) => drop(Command::new("kill").args(["-s", "KILL", rank]).stderr(Stdio::null()).status()),
                    None => launcher.kill().unwrap(),
                }
                killed += 1;
            }
        }
        let mut status = None;
        let has_ended = wait_until(|| {
            status = launcher.try_wait().unwrap();
            status.is_some() && !ranks_of(&directory, ranks).iter().any(|process| is_alive(process))
        });
        let stderr = || fs::read_to_string(directory.path("stderr")).unwrap_or_default();
        assert!(has_ended, "the job goes on after {killed} kills: {}", stderr());
        if !status.is_some_and(|status| status.success()) {
            assert!(killed > 0, "{status:?}: {}", stderr());
            assert_holds_start(&directory, "run.h5", &whole);
            continue;
        }
        let run_file = directory.run_file("run.h5");
        assert_eq!(run_file.text("state"), "finished");
        assert_eq!(differences(&whole, &run_file.content()), [""; 0], "after {killed} kills");
        ended += 1;
        directory.remove("run.h5");
    }
    println!("{killed} kills, {ended} runs to their end");
}

/// Whether a process is there and no zombie.
fn is_alive(process: &str) -> bool {
    let state = fs::read_to_string(Path::new("/proc").join(process).join("stat")).unwrap_or_default();
    state.rsplit(") ").next().is_some_and(|rest| !rest.is_empty() && !rest.starts_with('Z'))
}
