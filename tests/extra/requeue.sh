#!/bin/sh
# A long run under Slurm that is warned, killed, requeued and cut into several jobs: always the run file of an undisturbed run.
# Installs Slurm, which runs on this machine alone, for the time of the check, where it is missing and may be installed. One
# line for each thing shown. PLATEAU_LONG=1 also shows what Slurm does by itself at time limits, which takes minutes.
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
. tests/cluster/packages.sh
. tests/cluster/slurm.sh

provide_slurm

. scripts/paths.sh
. scripts/say.sh
. scripts/lock.sh
. scripts/python.sh
# As in the other tests, a program that is built already can be named.
if [ -n "${PLATEAU_PROGRAM:-}" ]; then program=$PLATEAU_PROGRAM; else sh scripts/build.sh || exit 1; fi
with_lock .venv.lock install_readers || exit 1

. tests/cluster/lab.sh

# enter NAME: the working directory is one of this name from here on.
enter() {
    mkdir "$lab/$1" && cd "$lab/$1" || exit 1
}

# Slurm looks at time limits every 30 s, so a run that it is to warn must take longer, on a fast machine too.
seconds=15
[ -z "${PLATEAU_LONG:-}" ] || seconds=50
enter speed
piece=200
wall_time=$("$program" run "$root/data/scenes/quick.toml" -o run.h5 --workers 1 --set numerics.time_acceleration=1 \
    --set "operation.duration=$piece s" --json | sed -n 's/.*"wall_time": \([0-9.]*\).*/\1/p')
duration=$(echo "$seconds $piece $wall_time" | awk '$3 > 0 { print int($1 * $2 / $3) }')
[ -n "$duration" ] || fail 'no wall time is told'

# The batch script of every job here. It is its own process that becomes the program, so that Slurm's signals to the batch
# script reach the program. Checkpoints are made for the sake of signals alone.
cat >"$lab/run.sbatch" <<END
#!/bin/sh
echo \$\$ >process
exec '$program' run '$root/data/scenes/quick.toml' -o run.h5 --resume --workers 1 \\
    --set numerics.time_acceleration=1 \\
    --set operation.duration='$duration s' \\
    --set output.sample_every='0.1 s' \\
    --set output.maps_at='["0 s", "$((duration / 5)) s", "$((duration * 2 / 3)) s", "$((duration - 1)) s"]' \\
    --set output.checkpoint_every='1 h'
END

# submit [OPTION...]: the script as a job of its own; its number. All that the jobs of a folder say is in one file.
submit() {
    sbatch --parsable --output=said --open-mode=append --time=10 "$@" "$lab/run.sbatch" || exit 1
}

# shown WHAT: the run of this folder has ended and gives what the undisturbed one gives.
shown() {
    compared=$("$root/.venv/bin/python" -B "$root/tests/cluster/same_run.py" "$lab/alone/run.h5" run.h5 2>&1) ||
        fail "$1: $compared: $(cat said)"
    echo "$1: $compared"
}

# steps_of TEXT: the steps in the lines that say so, one a line.
steps_of() {
    sed -n "s/^plateau: .*$1 \([0-9]*\)[ ,].*/\1/p" said
}

# resumed WHAT: every process but the first has gone on from the step at which the one before was stopped.
resumed() {
    stops=$(steps_of 'stopped by signal 15 after')
    [ -n "$stops" ] || fail "$1: the run does not say that it was stopped: $(cat said)"
    [ "$stops" = "$(steps_of 'goes on from step')" ] || fail "$1: not gone on from where it was stopped: $(cat said)"
}

# The same script without Slurm, on another core than the first job.
enter alone
sh "$lab/run.sbatch" >said 2>&1 &
job=$!

PATH=$PATH:/usr/sbin
slurm_start "$lab/slurm" || fail 'Slurm did not start'

# What is written after the checkpoint.
goes_on() {
    [ -n "$(find run.h5 -newer run.h5.checkpoint)" ]
}

enter warned
began=$(date +%s)
if [ -n "${PLATEAU_LONG:-}" ]; then
    submit --time=1 --signal=B:USR1@60 >/dev/null
else
    number=$(submit) || exit 1
    await 60 test -e run.h5
    scancel --batch --signal=USR1 "$number"
fi
await 60 test -e run.h5.checkpoint
warned=$(($(date +%s) - began))
await 10 goes_on
kill -0 "$(cat process)" || fail "SIGUSR1 has ended the run: $(cat said)"
echo "Slurm, warned with SIGUSR1, checkpoint after $warned s: the run goes on"

kill -KILL "$(cat process)" || exit 1
slurm_wait 60 || exit 1
! grep -q 'goes on from step' said || fail "goes on before it was killed: $(cat said)"
submit >/dev/null
slurm_wait 300 || exit 1
step=$(steps_of 'goes on from step')
[ -n "$step" ] || fail "SIGKILL: the run does not go on: $(cat said)"
wait $job
status=$?
job=
[ $status -eq 0 ] || fail "the undisturbed run: exit status $status: $(cat "$lab/alone/said")"
shown "SIGKILL of the program, submitted again, gone on from step $step, that of the warning"

# One after the other: each is stopped before its time is over, and the next goes on; those that are left find nothing to do.
tasks=6
if [ -n "${PLATEAU_LONG:-}" ]; then
    enter array
    submit --time=1 --signal=B:TERM@60 --array=1-$tasks%1 >/dev/null
fi

is_held_back() {
    [ "$(squeue --noheader --jobs="$number" --format=%t)" = PD ]
}

# Its process is another one.
is_back() {
    [ "$(cat process)" != "$process" ]
}

enter requeued
number=$(submit) || exit 1
await 120 test -e run.h5
# So that there is something to lose.
sleep 3
process=$(cat process)
scontrol requeue "$number" || fail 'cannot be requeued'
await 60 is_held_back
! kill -0 "$process" 2>/dev/null || fail 'requeued while its process is there'
# Slurm holds back what was requeued, for two minutes unless told otherwise: a node refuses a job in the second in which it
# has ended it.
sleep 2
scontrol update JobId="$number" StartTime=now || fail 'cannot be started at once'
await 120 is_back
slurm_wait 600 || exit 1
scontrol show job "$number" | grep -q 'Restarts=1 ' || fail "requeue: not started again once by Slurm: $(cat said)"
resumed requeue
shown "Slurm, scontrol requeue, stopped after $stops steps, started again by Slurm and gone on from there"

[ -n "${PLATEAU_LONG:-}" ] || exit 0
cd "$lab/array" || exit 1
resumed 'job array'
stopped=$(echo "$stops" | wc -l)
left=$(grep -c 'run.h5 is finished' said)
[ "$left" -gt 0 ] || fail "job array: $stopped of $tasks jobs were stopped, and none is left: $(cat said)"
[ $((stopped + 1 + left)) -eq $tasks ] || fail "job array: not every job has ended well: $(cat said)"
shown "Slurm, array of $tasks jobs of 60 s one after the other, $stopped stopped in time, $left with nothing left to do"
