#!/bin/sh
# Measure what a developer waits for, in fresh clones of what is committed: the first build, ./check after it, a run after one changed line of
# core, .ci/run. Takes three quarters of an hour on two cores, which should have nothing else to do.
set -u

cd "$(dirname "$0")/.." || exit 1
clones=$(mktemp -d) || exit 1
trap 'rm -rf "$clones"' EXIT

# timed WORDS COMMAND...: seconds that the command takes, and its exit status; and what it printed where it failed.
timed() {
    words=$1
    shift
    started=$(date +%s)
    "$@" >"$clones/output" 2>&1
    status=$?
    printf '%-45s %5d s, exit status %d\n' "$words" "$(($(date +%s) - started))" "$status"
    [ "$status" -eq 0 ] || cat "$clones/output"
}

git rev-parse HEAD && uname -m && getconf _NPROCESSORS_ONLN && grep -m 1 'model name' /proc/cpuinfo
git clone -q . "$clones/one" && git clone -q . "$clones/two" || exit 1
cd "$clones/one" || exit 1
timed 'first build: ./plateau --version' ./plateau --version
timed './check after it' ./check
echo '// One more line.' >>crates/core/src/model/step.rs
timed 'run after one changed line of core: quick.toml' ./plateau run data/scenes/quick.toml
cd "$clones/two" || exit 1
timed '.ci/run' .ci/run
