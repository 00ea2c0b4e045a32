#!/bin/sh
# A study shared in every way that clusters have, killed and gone on with: always the results of one process. Installs Slurm
# (which runs on this machine alone, for the time of the check), GNU parallel and Open MPI where they are missing and may be
# installed. One line for each thing shown. PLATEAU_LONG=1 also waits for a time limit of Slurm.
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
. tests/cluster/packages.sh
. tests/cluster/open_mpi.sh
. tests/cluster/slurm.sh

have_parallel() {
    case $(parallel --version 2>/dev/null </dev/null) in 'GNU parallel'*) ;; *) return 1 ;; esac
}

provide_slurm
provide 'GNU parallel' have_parallel parallel
provide_mpi

. scripts/paths.sh
. scripts/say.sh
. scripts/lock.sh
. scripts/python.sh
need_program_with_mpi || exit 1
sh scripts/build.sh || exit 1
with_lock .venv.lock install_readers || exit 1

. tests/cluster/lab.sh

# enter NAME DURATION: the working directory is one of this name from here on, with a study in it, which `maker` makes.
enter() {
    mkdir "$lab/$1" && cd "$lab/$1" || exit 1
    maker=$program
    cat >study.toml <<END
version = 1
title = "24 short runs"
base = "$root/data/scenes/quick.toml"
set = ["operation.duration = '$2'", "output.sample_every = '0.5 s'"]
design = "full-factorial"
directory = "results"

[replicates]
keys = ["disc.surface.synthetic.seed", "pin.base.synthetic.seed"]
seeds = [7, 8, 9]

[[factor]]
name = "load"
key = "operation.normal_force"
levels = ["5 N", "10 N", "20 N", "40 N"]

[[factor]]
name = "fibre fraction"
key = "pin.base.synthetic.fibre_fraction"
levels = [0.2, 0.4]

[[response]]
name = "contact area at the end"
dataset = "/series/contact_area_mean"
at = "end"

[[response]]
name = "mean filling"
dataset = "/series/filled_fraction"
mean = ["50 s", "100 s"]
END
}

# Of a study that takes some seconds, and of one that takes hours.
short='150 s'
long='100000 s'

sweep() {
    "$maker" sweep run study.toml "$@"
}

# shown WHAT: the study of this folder is complete and gives what one process gives.
shown() {
    "$maker" sweep collect study.toml >/dev/null || fail "$1: cannot be collected"
    compared=$("$root/.venv/bin/python" -B "$root/tests/cluster/same_results.py" "$lab/alone/results" results 2>&1) ||
        fail "$1: $compared"
    echo "$1: $compared"
}

# Runs of the study of this folder that have a result.
finished() {
    "$maker" sweep collect study.toml --json -o collected | sed -n 's/.*"finished": \([0-9]*\).*/\1/p'
}

# writers N: at least so many processes are at work; the first N process numbers, from the names of their files.
writers() {
    processes=
    for shard in results/journal/*.open; do
        [ -s "$shard" ] || continue
        number=${shard##*/}
        number=${number#*_}
        processes="$processes ${number%%_*}"
    done
    # shellcheck disable=SC2086
    set -- "$1" $processes
    [ $# -gt "$1" ]
}

is_under_way() {
    writers 1
}

# A process that is asked to stop leaves its file complete and names what is left.
closed() {
    for shard in results/journal/*; do
        case $shard in *.journal) ;; *) fail "$1: $shard is left as it was" ;; esac
    done
}

# stopped WHAT: some of the runs have a result and some have not.
stopped() {
    count=$(finished)
    { [ "$count" -gt 0 ] && [ "$count" -lt 24 ]; } || fail "$1: $count of 24 runs are there"
}

enter alone "$short"
sweep --jobs 2 >/dev/null || exit 1
shown 'one process, 2 runs at a time'

enter signal "$short"
"$maker" sweep run study.toml --jobs 1 >said 2>&1 &
job=$!
await 30 is_under_way
kill -TERM $job
wait $job
status=$?
job=
[ $status -eq 143 ] || fail "SIGTERM: exit status $status"
closed SIGTERM
stopped SIGTERM
sweep --jobs 2 >/dev/null || exit 1
shown "SIGTERM after $count of 24 runs (exit status 143, journal closed), taken up again"

enter parallel "$short"
PATH=$(dirname "$program"):$PATH parallel plateau sweep run study.toml --task '{}/4' ::: 1 2 3 4 >said 2>&1 ||
    fail "GNU parallel: $(cat said)"
shown 'GNU parallel, 4 tasks'

enter array "$short"
PATH=$PATH:/usr/sbin
slurm_start "$lab/slurm" || fail 'Slurm did not start'

# submit [OPTION...]: the script as a job array; its number.
submit() {
    sbatch --parsable "$@" study.sbatch || exit 1
}

"$maker" sweep slurm study.toml --tasks 4 >/dev/null || exit 1
submit >/dev/null
await 60 is_under_way
kill -KILL "${processes##* }" || exit 1
slurm_wait 60 || exit 1
stopped 'SIGKILL of a task'
submit >/dev/null
slurm_wait 60 || exit 1
shown "Slurm, 4 tasks, one killed with SIGKILL (then $count of 24 runs), submitted again"

enter cancelled "$short"
"$maker" sweep slurm study.toml --tasks 4 >/dev/null || exit 1
array=$(submit) || exit 1
await 60 is_under_way
scancel "$array"
slurm_wait 60 || exit 1
grep -q 'stopped by signal 15; .* runs are left' ./*.out || fail 'scancel: no task says that it was stopped'
closed scancel
stopped scancel
submit >/dev/null
slurm_wait 60 || exit 1
shown "Slurm, cancelled after $count of 24 runs (journals closed), submitted again"

# The shortest limit that Slurm has, so that the script's signal comes as soon as Slurm looks at limits, every 30 s.
if [ -n "${PLATEAU_LONG:-}" ]; then
    enter limit "$long"
    "$maker" sweep slurm study.toml --tasks 4 >/dev/null || exit 1
    array=$(submit --time=1 --array=1) || exit 1
    began=$(date +%s)
    slurm_wait 120 || exit 1
    seconds=$(($(date +%s) - began))
    scontrol show job "$array" | grep -q 'ExitCode=143:0' || fail 'time limit: not ended with 143'
    [ $seconds -lt 60 ] || fail "time limit of 60 s: told after $seconds s, not before it"
    echo "Slurm, warned 60 s before the time limit: ended by itself after $seconds s of 60 s, exit status 143"
fi

# on_ranks N: the study on so many ranks.
on_ranks() {
    # shellcheck disable=SC2086
    $mpirun -n "$1" "$maker" sweep run study.toml
}

enter ranks "$short"
maker=$target/plateau-mpi
on_ranks 2 >said 2>&1 || fail "MPI: $(cat said)"
[ "$(find results/journal -name '*.journal' | wc -l)" -eq 2 ] || fail 'MPI: not every rank has made runs'
shown 'MPI, 2 ranks'

three_are_under_way() {
    writers 3
}

enter rank "$short"
maker=$target/plateau-mpi
# shellcheck disable=SC2086
$mpirun -n 3 "$maker" sweep run study.toml >said 2>&1 &
job=$!
await 60 three_are_under_way
kill -TERM "${processes##* }" || exit 1
wait $job
status=$?
job=
[ $status -eq 143 ] || fail "MPI, SIGTERM of a rank: exit status $status: $(cat said)"
[ "$(grep -c 'stopped by signal 15' said)" -eq 1 ] || fail "MPI, SIGTERM of a rank: not said once: $(cat said)"
closed 'MPI, SIGTERM of a rank'
stopped 'MPI, SIGTERM of a rank'
on_ranks 3 >said 2>&1 || fail "MPI: $(cat said)"
shown "MPI, 3 ranks, SIGTERM of one after $count of 24 runs (exit status 143, journals closed), taken up again"

enter launcher "$short"
maker=$target/plateau-mpi
# shellcheck disable=SC2086
$mpirun -n 3 "$maker" sweep run study.toml >said 2>&1 &
job=$!
await 60 three_are_under_way
kill -TERM $job
wait $job
status=$?
job=
[ $status -ne 0 ] || fail 'MPI, SIGTERM of mpirun: exit status 0'
stopped 'MPI, SIGTERM of mpirun'
on_ranks 2 >said 2>&1 || fail "MPI: $(cat said)"
shown "MPI, 3 ranks, SIGTERM of mpirun after $count of 24 runs, taken up again by 2"
