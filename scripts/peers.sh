#!/bin/sh
# Prints the Python of an environment with the packages that the benchmark `plateau-bench peers` needs; installs them
# into .venv-peers in the checkout at first. Messages go to standard error.
set -u

root=$(CDPATH='' cd -P "${0%/*}/.." && pwd -P) || exit 1
. "$root/scripts/say.sh"
. "$root/scripts/lock.sh"
. "$root/scripts/python.sh"

requirements=$root/crates/bench/peers/requirements.txt
environment=$root/.venv-peers

install() {
    make_venv "$environment"
    ! cmp -s "$requirements" "$environment/installed.txt" || return 0
    say "installing Numba into $environment"
    "$environment/bin/python" -m pip install --quiet -r "$requirements" || die "Numba cannot be installed, see above"
    cp "$requirements" "$environment/installed.txt"
}

with_lock "$environment.lock" install >&2 || exit 1
printf '%s\n' "$environment/bin/python"
