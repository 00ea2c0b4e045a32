//! One scene on several ranks of an MPI job: the same bits, one voice, one end. Needs a program with feature `mpi` and
//! `PLATEAU_MPIRUN`, the launcher with its options, so `tests/extra/mpi.sh` runs these.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

use plateau_tests::program::{Outcome, WorkingDirectory, program, run, scene, send, wait_until};
use plateau_tests::run_file::{Content, RunFile, differences};
use plateau_tests::studies::Study;

use crate::heat::hot;

mod killed;

/// The launcher, to be run in a directory.
fn mpirun(directory: &WorkingDirectory) -> Command {
    let launcher = std::env::var("PLATEAU_MPIRUN").expect("PLATEAU_MPIRUN, for example \"mpirun --oversubscribe\"");
    let mut words = launcher.split_whitespace();
    let mut command = Command::new(words.next().expect("the launcher"));
    command.args(words).current_dir(directory.path("."));
    command
}

/// Arguments of a short run of `quick.toml` with these.
fn short_run(arguments: &[&str]) -> Vec<String> {
    let quick = scene("quick.toml");
    let common = ["run", &quick, "-o", "run.h5", "--set", "operation.steps=1500"];
    common.iter().chain(arguments).map(ToString::to_string).collect()
}

/// What this many ranks say, and how they end, with these arguments.
fn on_ranks(directory: &WorkingDirectory, ranks: usize, arguments: &[String]) -> Outcome {
    let mut command = mpirun(directory);
    command.args(["-n", &ranks.to_string()]).arg(program()).args(arguments);
    run(command)
}

/// Every dataset of the run file that a command wrote beside its last checkpoint, and the number of workers that it names.
fn written(directory: &WorkingDirectory, outcome: &Outcome) -> (BTreeMap<String, Content>, f64) {
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    // Of a run of more than a minute there are two checkpoints.
    let names = directory.names().into_iter().filter(|name| name != "run.h5.checkpoint-before");
    assert_eq!(names.collect::<Vec<_>>(), ["run.h5", "run.h5.checkpoint"]);
    let file = directory.run_file("run.h5");
    assert_eq!(file.text("state"), "finished");
    (file.content(), file.number("workers"))
}

#[test]
#[ignore = "needs MPI"]
fn the_number_of_ranks_does_not_show() {
    for debris in [
        &["--set=plateaus.debris=local"][..],
        &["--set=plateaus.transport_length=770 um", "--set=materials.pin_secondary.strength=2 MPa"],
    ] {
        let on_threads = |threads| {
            let directory = WorkingDirectory::new();
            let arguments = [debris, &["--workers", threads]].concat();
            written(&directory, &directory.plateau(short_run(&arguments))).0
        };
        let one = on_threads("1");
        assert_eq!(differences(&one, &on_threads("2")), [""; 0], "2 threads");
        for (ranks, kind) in [(1, "auto"), (2, "sectors"), (3, "bands")] {
            let directory = WorkingDirectory::new();
            let outcome = on_ranks(&directory, ranks, &short_run(&[debris, &["--decomposition", kind]].concat()));
            let (content, workers) = written(&directory, &outcome);
            assert_eq!(differences(&one, &content), [""; 0], "{ranks} ranks, {debris:?}");
            assert_eq!(workers, ranks as f64);
            // One summary, not one from every rank.
            assert_eq!(outcome.stdout.matches("run.h5").count(), 1, "{}", outcome.stdout);
        }
    }
}

#[test]
#[ignore = "needs MPI"]
fn ranks_choose_the_same_acceleration() {
    let quick = scene("quick.toml");
    let chosen = "numerics.time_acceleration={ tolerance = 0.01, max = 1000 }";
    let common = ["run", &quick, "-o", "run.h5", "--set", "operation.duration=20 s", "--set", chosen];
    let arguments = common.map(str::to_owned);
    let directory = WorkingDirectory::new();
    let one = written(&directory, &directory.plateau(&arguments)).0;
    assert!(one.contains_key("/series/time_acceleration"), "{:?}", one.keys());
    for ranks in [2, 3] {
        let directory = WorkingDirectory::new();
        let outcome = on_ranks(&directory, ranks, &arguments);
        assert_eq!(differences(&one, &written(&directory, &outcome).0), [""; 0], "{ranks} ranks");
    }
}

/// Stops and pauses with friction, heat that acts back on the wear rates, and emission.
#[test]
#[ignore = "needs MPI"]
fn ranks_warm_up_alike() {
    let directory = WorkingDirectory::with("hot.toml", hot("stops.toml", ""));
    let arguments: Vec<String> = ["run", "hot.toml", "-o", "run.h5"].map(str::to_owned).to_vec();
    directory.plateau(&arguments).ends(0, &[]);
    let one = directory.run_file("run.h5").content();
    assert!(one.contains_key("/series/contact_temperature"), "{:?}", one.keys());
    for ranks in [2, 3] {
        on_ranks(&directory, ranks, &[&arguments[..], &["--force".to_owned()]].concat()).ends(0, &[]);
        let run = directory.run_file("run.h5");
        assert_eq!(run.number("workers"), ranks as f64);
        assert_eq!(differences(&one, &run.content()), [""; 0], "{ranks} ranks");
    }
}

#[test]
#[ignore = "needs MPI"]
fn ranks_without_a_sector_keep_pace() {
    // 7 columns make at most 3 sectors.
    let arguments = short_run(&[
        "--set=mesh.disc_columns=7",
        "--set=mesh.pin_columns=4",
        "--set=disc.surface.synthetic.correlation_length=\"20 mm\"",
    ]);
    let directory = WorkingDirectory::new();
    let one = written(&directory, &directory.plateau(&arguments)).0;
    let directory = WorkingDirectory::new();
    let (content, workers) = written(&directory, &on_ranks(&directory, 5, &arguments));
    assert_eq!(differences(&one, &content), [""; 0]);
    assert_eq!(workers, 5.0);
}

#[test]
#[ignore = "needs MPI"]
fn ranks_take_the_place_of_threads() {
    for (argument, found) in
        [("--workers=2", "--workers is 2, expected 1 on 3 ranks"), ("--pin", "mpirun --bind-to core")]
    {
        let directory = WorkingDirectory::new();
        on_ranks(&directory, 3, &short_run(&[argument])).ends(2, &[found]);
        assert_eq!(directory.names(), [""; 0], "{argument}");
    }
    let directory = WorkingDirectory::new();
    let outcome = on_ranks(&directory, 3, &short_run(&["--workers", "auto"]));
    assert_eq!(written(&directory, &outcome).1, 3.0);
    let directory = WorkingDirectory::new();
    let outcome = on_ranks(&directory, 1, &short_run(&["--workers", "2"]));
    assert_eq!(written(&directory, &outcome).1, 2.0);
}

#[test]
#[ignore = "needs MPI"]
fn a_rank_that_fails_ends_all_with_its_status_and_message() {
    let mut job = EndlessJob::start(3);
    // Only rank 0 writes, so only rank 0 fails. MPI itself needs larger files when it starts.
    let order = ["--fsize=200000", "--pid", &job.process(0)];
    assert!(Command::new("prlimit").args(order).status().expect("prlimit, of util-linux").success());
    let (status, stderr) = job.end();
    assert_eq!(status, Some(1), "{stderr}");
    assert_eq!(stderr.matches("plateau: writing ").count(), 1, "{stderr}");
}

#[test]
#[ignore = "needs MPI"]
fn a_rank_without_its_scene_ends_all() {
    let directory = WorkingDirectory::new();
    let mut command = mpirun(&directory);
    command.args(["-n", "2"]).arg(program()).args(short_run(&[]));
    command.args([":", "-n", "1"]).arg(program()).args(["run", "missing.toml"]);
    let outcome = run(command).ends(2, &[]);
    assert_eq!(outcome.stderr.matches("plateau: missing.toml: ").count(), 1, "{}", outcome.stderr);
}

#[test]
#[ignore = "needs MPI"]
fn what_all_ranks_find_wrong_is_said_once() {
    let directory = WorkingDirectory::new();
    let outcome = on_ranks(&directory, 3, &["run", "missing.toml"].map(String::from)).ends(2, &[]);
    assert_eq!(outcome.stderr.matches("plateau: ").count(), 1, "{}", outcome.stderr);
    assert_eq!(directory.names(), [""; 0]);
}

#[test]
#[ignore = "needs MPI"]
fn ranks_with_different_scenes_do_not_start() {
    let directory = WorkingDirectory::new();
    let mut command = mpirun(&directory);
    command.args(["-n", "2"]).arg(program()).args(short_run(&[]));
    command.args([":", "-n", "1"]).arg(program()).args(short_run(&["--set", "operation.normal_force=\"6 N\""]));
    run(command).ends(2, &["plateau: rank 2 was given another scene"]);
    assert_eq!(directory.names(), [""; 0]);
}

#[test]
#[ignore = "needs MPI"]
fn a_rank_that_is_asked_to_stop_stops_all_in_good_order() {
    let mut job = EndlessJob::start(2);
    send("TERM", job.process(1));
    let (status, stderr) = job.end();
    assert_eq!(status, Some(143), "{stderr}");
    assert_eq!(stderr.matches("plateau: stopped by signal 15").count(), 1, "{stderr}");
    assert_eq!(RunFile::open(job.file()).text("state"), "interrupted");
}

#[test]
#[ignore = "needs MPI"]
fn ranks_that_prepare_a_run_end_at_a_signal() {
    // To one rank alone, and to the launcher, which passes it on to all.
    for rank in [Some(1), None] {
        let directory = WorkingDirectory::new();
        let stderr = File::create(directory.path("stderr")).expect("a file");
        let mut command = mpirun(&directory);
        command.args(["-n", "2", "sh", "-c", LEAVE_PROCESS_NUMBER]).arg(program());
        // Fibres that are so long that nearly all of them miss the pin: hours of one loop.
        let fibres =
            ["--set", "pin.base.synthetic.fibre_length=1e5 m", "--set", "pin.base.synthetic.fibre_width=1e-7 m"];
        command.args(short_run(&fibres)).stdout(Stdio::null()).stderr(stderr);
        let mut launcher = command.spawn().expect("the launcher");
        assert!(wait_until(|| [0, 1].iter().all(|rank| directory.path(&rank.to_string()).exists())));
        std::thread::sleep(std::time::Duration::from_secs(2));
        let process = rank.map_or_else(|| launcher.id().to_string(), |rank| process_of_rank(&directory, rank));
        send("TERM", &process);
        let ended = wait_until(|| launcher.try_wait().expect("a process").is_some());
        let _ = launcher.kill();
        assert!(ended, "the ranks do not hear the signal");
        assert_ne!(launcher.wait().expect("an end").code(), Some(0));
        let stderr = fs::read_to_string(directory.path("stderr")).expect("what was said");
        // The launcher may end before it has passed on what a rank says; that it is said twice would be the mistake.
        assert!(stderr.matches("before the first step").count() <= 1 && !stderr.contains("panicked"), "{stderr}");
        assert!(!directory.names().iter().any(|name| name.starts_with("run.h5")), "{:?}", directory.names());
    }
}

#[test]
#[ignore = "needs MPI"]
fn what_ranks_did_is_gone_on_with() {
    let enough = ["--set", "operation.steps=1500000", "--resume"];
    let mut job = EndlessJob::in_directory(WorkingDirectory::new(), 2, &enough);
    send("TERM", job.process(1));
    let (status, stderr) = job.end();
    assert_eq!(status, Some(143), "{stderr}");
    let directory = &job.directory;
    let arguments = |file: &str| {
        let words = ["run", &scene("quick.toml"), "-o", file].map(str::to_owned);
        words.into_iter().chain(enough.map(str::to_owned)).collect::<Vec<_>>()
    };
    let resumed = on_ranks(directory, 2, &arguments("run.h5")).ends(0, &[]);
    assert_eq!(resumed.stderr.matches("goes on from step").count(), 1, "{}", resumed.stderr);
    directory.plateau(arguments("whole.h5")).ends(0, &[]);
    let content = |file| directory.run_file(file).content();
    assert_eq!(differences(&content("whole.h5"), &content("run.h5")), [""; 0]);
}

#[test]
#[ignore = "needs MPI"]
fn a_rank_that_is_killed_ends_all() {
    let mut job = EndlessJob::start(2);
    send("KILL", job.process(1));
    let (status, stderr) = job.end();
    assert_ne!(status, Some(0), "{stderr}");
}

#[test]
#[ignore = "needs MPI"]
fn a_rank_takes_over_what_another_is_late_with() {
    let directory = WorkingDirectory::new();
    let seeds: Vec<String> = (1..=24).map(|seed: u32| seed.to_string()).collect();
    let study = Study::new(&scene("quick.toml"), "full-factorial", "set = [\"operation.duration = '40 s'\"]")
        .factor("seed", "pin.base.synthetic.seed", &format!("levels = [{}]", seeds.join(", ")))
        .response("area", "/series/contact_area_mean", "at = \"end\"");
    directory.write("study.toml", study);
    // The second rank rests from its first result on, until the first rank has made more than half of the runs.
    let mut command = mpirun(&directory);
    command.args(["-n", "2", "sh", "-c", LEAVE_PROCESS_NUMBER]).arg(program()).args(["sweep", "run", "study.toml"]);
    let job = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the launcher");
    let shards = || fs::read_dir(directory.path("results/journal")).into_iter().flatten().map(|shard| shard.unwrap());
    let made = || {
        let texts = shards().filter_map(|shard| fs::read_to_string(shard.path()).ok());
        let mut made: Vec<usize> = texts.map(|text| text.lines().count()).filter(|runs| *runs > 0).collect();
        made.sort_unstable();
        made
    };
    assert!(wait_until(|| made().len() == 2));
    let second = process_of_rank(&directory, 1);
    send("STOP", &second);
    let taken_over = wait_until(|| made().last().is_some_and(|runs| *runs > seeds.len() / 2));
    send("CONT", &second);
    let output = job.wait_with_output().expect("the end of the job");
    assert!(taken_over, "one rank left the runs of the other: {:?}", made());
    assert!(output.status.success(), "{output:?}");
    let texts: Vec<_> = shards().map(|shard| fs::read_to_string(shard.path()).expect("a shard")).collect();
    assert_eq!(texts.len(), 2, "both ranks made runs");
    let runs = texts.iter().flat_map(|text| text.lines()).map(|line| line.split("\"run\":").nth(1).unwrap());
    let mut runs: Vec<usize> = runs.map(|rest| rest.split(',').next().unwrap().parse().unwrap()).collect();
    runs.sort_unstable();
    assert_eq!(runs, (1..=seeds.len()).collect::<Vec<_>>());
}

/// Every rank leaves its process number in a file that is named by its rank.
const LEAVE_PROCESS_NUMBER: &str = "echo $$ >$OMPI_COMM_WORLD_RANK; exec \"$0\" \"$@\"";

/// The process of a rank.
fn process_of_rank(directory: &WorkingDirectory, rank: usize) -> String {
    let text = fs::read_to_string(directory.path(&rank.to_string())).expect("a process number");
    text.trim_end().to_owned()
}

/// A run that goes on until something ends it.
struct EndlessJob {
    directory: WorkingDirectory,
    launcher: Child,
}

impl EndlessJob {
    /// Starts it and waits for its first sample.
    fn start(ranks: usize) -> Self {
        Self::in_directory(WorkingDirectory::new(), ranks, &["--set", "operation.steps=100000000"])
    }

    /// The same with other arguments.
    fn in_directory(directory: WorkingDirectory, ranks: usize, arguments: &[&str]) -> Self {
        let stderr = File::create(directory.path("stderr")).expect("a file");
        let mut command = mpirun(&directory);
        command.args(["-n", &ranks.to_string(), "sh", "-c", LEAVE_PROCESS_NUMBER]).arg(program());
        command.args(["run", &scene("quick.toml"), "-o", "run.h5"]).args(arguments);
        let launcher = command.stdout(Stdio::null()).stderr(stderr).spawn().expect("the launcher");
        let job = Self { directory, launcher };
        let runs = || RunFile::follow(job.file()).is_ok_and(|file| file.shape("/time")[0] > 0);
        assert!(wait_until(runs), "no sample came");
        job
    }

    fn file(&self) -> PathBuf {
        self.directory.path("run.h5")
    }

    /// The process of a rank.
    fn process(&self, rank: usize) -> String {
        process_of_rank(&self.directory, rank)
    }

    /// Waits for its end; gives the exit status and what was said on standard error.
    fn end(&mut self) -> (Option<i32>, String) {
        let mut status = None;
        let ended = wait_until(|| {
            status = self.launcher.try_wait().expect("the state of the job");
            status.is_some()
        });
        if !ended {
            self.launcher.kill().expect("a job that runs");
            panic!("the job did not end");
        }
        let stderr = fs::read_to_string(self.directory.path("stderr")).expect("standard error");
        (status.and_then(|status| status.code()), stderr)
    }
}
