# What a check with jobs works in: a folder that goes with the check, like its jobs and Slurm. Sourced after slurm.sh.
# shellcheck shell=sh

lab=$(mktemp -d) || exit 1
# The process that runs beside the check, if there is one.
job=
clean_up() {
    trap '' INT TERM
    if [ -n "$job" ] && kill "$job"; then wait "$job"; fi
    slurm_stop
    rm -rf "$lab"
} 2>/dev/null
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

fail() {
    echo "$*"
    exit 1
}

# await SECONDS COMMAND...: until it succeeds.
await() {
    looks=$(($1 * 20))
    shift
    until "$@"; do
        looks=$((looks - 1))
        [ $looks -gt 0 ] || fail "waited in vain for: $*: $(cat said 2>/dev/null)"
        sleep 0.05
    done
}
