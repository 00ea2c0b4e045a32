# One process at a time. Sourced after say.sh.
# shellcheck shell=sh

# with_lock FILE COMMAND...: run COMMAND in a subshell while nobody else holds FILE. Where there is no flock
# (macOS) it runs at once: cargo has a lock of its own. COMMAND does not inherit the lock's descriptor, so that
# a compiler server started by it does not hold the lock for ever.
with_lock() (
    lock_file=$1
    shift
    if command -v flock >/dev/null 2>&1 && (: >>"$lock_file") 2>/dev/null; then
        exec 9>>"$lock_file"
        if ! flock -n 9; then
            say "waiting for another build, which holds $lock_file"
            flock 9
        fi
        "$@" 9>&-
    else
        "$@"
    fi
)
