# Packages that a check needs. Sourced.
# shellcheck shell=sh

# only_when_long WHY: ends the script with 77, as skipped, unless the long checks were asked for.
only_when_long() {
    if [ -z "${PLATEAU_LONG:-}" ]; then
        echo "$1: ./check --long extra runs it, and so do the weekly checks"
        exit 77
    fi
}

# provide WHAT COMMAND PACKAGE...: if COMMAND, which tells whether WHAT is there, says no, the packages are installed.
# Ends the script with 77, as skipped, where they cannot be.
provide() {
    what=$1
    is_there=$2
    shift 2
    ! "$is_there" || return 0
    if [ "$(id -u)" -ne 0 ] || ! command -v apt-get >/dev/null 2>&1; then
        echo "$what is not installed, and only root may install it"
        exit 77
    fi
    # One at a time: checks that need packages run side by side, and one may have waited for the packages of another.
    if ! (
        flock 9
        "$is_there" || { apt-get update && apt-get install -y --no-install-recommends "$@" && "$is_there"; }
    ) 9>>"${TMPDIR:-/tmp}/plateau-packages.lock"; then
        echo "$what is not installed, and apt-get could not install it"
        exit 77
    fi
}
