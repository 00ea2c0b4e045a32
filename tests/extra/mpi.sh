#!/bin/sh
# One scene on the ranks of an MPI job. Installs Open MPI and libclang where they are missing and may be installed.
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD

. tests/cluster/packages.sh
. tests/cluster/open_mpi.sh
provide_mpi

PLATEAU_FEATURES=mpi
export PLATEAU_FEATURES
. scripts/paths.sh
. scripts/say.sh
. scripts/lock.sh
. scripts/toolchain.sh

# ranks N [HOW]: the ranks on their own, without a simulation (crates/run/tests/mpi.rs).
ranks() {
    number=$1
    shift
    # cargo starts the tests that it built with this runner.
    timeout 300 cargo test --quiet --release --locked --workspace --features mpi --test mpi \
        --target-dir "$target" --config "target.'cfg(unix)'.runner = '$mpirun -n $number'" -- "$@"
}

# ranks_end STATUS HOW: with one rank failing in this way, three ranks must end with this status, and not hang.
ranks_end() {
    ranks 3 "$2" >"$output" 2>&1 || :
    grep -q "(exit status: $1)" "$output" || { cat "$output" && echo "3 ranks: $2 did not end with $1" && exit 1; }
}

output=$(mktemp) || exit 1
trap 'rm -f "$output"' EXIT

need_program_with_mpi || exit 1
prepare_toolchain
cargo clippy --release --locked -p plateau-run -p plateau -p plateau-tests --lib --bins --test mpi --target-dir "$target" --features mpi \
    -- -D warnings || exit 1
for number in 1 2 3 5; do
    ranks $number || exit 1
done
ranks_end 1 panic
ranks_end 1 drop
ranks_end 3 fail
ranks_end 3 fail-alike
[ "$(grep -c 'all ranks failed on purpose' "$output")" -eq 1 ] ||
    { cat "$output" && echo 'what failed all ranks was not said once' && exit 1; }

# Two tests at a time, for most of their time is that in which ranks start. Should they wait for each other for ever, it fails.
PLATEAU_PROGRAM=$target/plateau-mpi PLATEAU_MPIRUN=$mpirun timeout 1800 cargo test --release --locked --workspace --test end_to_end \
    --target-dir "$target" -- --ignored --test-threads 2 ranks::
