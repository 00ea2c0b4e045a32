# Messages of the scripts. Sourced.
# shellcheck shell=sh

say() {
    printf 'plateau: %s\n' "$*" >&2
}

die() {
    say "$@"
    exit 1
}

# run_quietly COMMAND...: its output is shown, on standard error, only when it fails.
run_quietly() {
    if quiet_output=$("$@" 2>&1 </dev/null); then
        return 0
    fi
    printf '%s\n' "$quiet_output" >&2
    return 1
}
