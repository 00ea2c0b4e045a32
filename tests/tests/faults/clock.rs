//! A clock that is wrong, or set while a command runs or between two: what is written is the same but for its dates.

use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use plateau_tests::fault::shim;
use plateau_tests::program::{WorkingDirectory, run};
use plateau_tests::run_file::differences;

use super::answers::{CASES, compare, copied, files, prepared};
use super::{Killed, short_run, whole};

const DAY: i64 = 86_400;

/// Seconds that the clock is ahead of the machine's when it is first read, and from then on.
fn clocks() -> [(i64, i64); 6] {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs();
    let now = i64::try_from(now).unwrap();
    let [year_1970, year_1960] = [100 - now, -now - 10 * 365 * DAY];
    // Set back by an hour meanwhile, wrong all the time, without a battery, and put right meanwhile; beyond the year 9999.
    [(0, -3600), (-DAY, -DAY), (year_1970, year_1970), (year_1970, 0), (year_1960, year_1960), (0, 9000 * 365 * DAY)]
}

fn with_clock(mut command: Command, (first, then): (i64, i64)) -> Command {
    command.env("LD_PRELOAD", shim("clock")).env("PLATEAU_CLOCK", format!("{first}:{then}"));
    command
}

#[test]
fn runs_are_the_same_with_any_clock() {
    let (whole, killed) = (whole(), Killed::new());
    for clock in clocks() {
        let done = |directory: &WorkingDirectory, command: Command| {
            let outcome = run(with_clock(command, clock));
            assert_eq!(outcome.status, Some(0), "{clock:?}: {outcome:?}");
            let verified = run(with_clock(directory.command(["verify", "run.h5"]), clock));
            assert_eq!(verified.status, Some(0), "{clock:?}: {verified:?}");
            let watched = run(with_clock(directory.command(["watch", "--once", "run.h5"]), clock));
            assert_eq!(watched.status, Some(0), "{clock:?}: {watched:?}");
        };
        let same = |directory: &WorkingDirectory| {
            let run_file = directory.run_file("run.h5");
            assert_eq!(differences(&whole, &run_file.content()), [""; 0], "{clock:?}");
            let dates = ["start_time", "end_time"].map(|name| run_file.text(name));
            assert!(dates.iter().all(|date| date.len() >= 20 && date.ends_with('Z')), "{clock:?}: {dates:?}");
            // No date is written of before 1970.
            assert_eq!(dates[1].starts_with("1970-01-01T00:"), clock.1 < -DAY, "{clock:?}: {dates:?}");
        };
        let directory = WorkingDirectory::new();
        done(&directory, short_run(&directory, &[]));
        same(&directory);
        // Of a killed run, whose lock and checkpoint are of another time.
        let directory = killed.directory();
        done(&directory, directory.command(["repair", "run.h5"]));
        done(&directory, short_run(&directory, &["--resume"]));
        same(&directory);
        let directory = killed.directory();
        done(&directory, short_run(&directory, &["--resume"]));
        same(&directory);
    }
}

#[test]
fn what_is_made_of_runs_is_the_same_with_any_clock() {
    let before = files(&prepared());
    for case in &CASES {
        let whole = copied(&before);
        assert_eq!(whole.plateau(case.arguments).status, Some(0));
        for clock in clocks() {
            let directory = copied(&before);
            let outcome = run(with_clock(directory.command(case.arguments), clock));
            let what = format!("{clock:?}, {:?}: {outcome:?}", case.arguments);
            assert_eq!(outcome.status, Some(0), "{what}");
            compare(case, &directory, &whole, true, &what);
        }
    }
}
