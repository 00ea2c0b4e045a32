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

with_lock "$environment.lock" fill_venv "$environment" "$requirements" >&2 || die "Numba cannot be installed, see above"
printf '%s\n' "$environment/bin/python"
