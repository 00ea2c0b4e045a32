#!/bin/sh
# Prints the Python of an environment with the packages that the benchmark `plateau-bench peers` needs; installs them
# into .venv-peers in the checkout at first. Without Numba there is NumPy alone. Messages go to standard error.
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
    say "installing $(tr '\n' ' ' <"$requirements")into $environment"
    if "$environment/bin/python" -m pip install --quiet -r "$requirements"; then
        cp "$requirements" "$environment/installed.txt"
    else
        say "Numba cannot be installed, going on with NumPy alone"
        "$environment/bin/python" -m pip install --quiet numpy || die "NumPy cannot be installed either, see above"
    fi
}

with_lock "$environment.lock" install >&2 || exit 1
printf '%s\n' "$environment/bin/python"
