#!/bin/sh
# Every figure of the study: those of the paper's section 4 by their numbers there, and what the paper leaves open. Writes
# into data/studies/riva2019/figures and, those that docs/evidence/validation.md shows, into docs/images.
#
# usage: data/studies/riva2019/figures.sh, after run.sh
set -u
cd "$(dirname "$0")/../../.." || exit 1
root=$PWD

. scripts/say.sh
. scripts/lock.sh
. scripts/python.sh
with_lock .venv.lock install_readers || exit 1
# The package of the checkout.
PYTHONPATH=$root/python
export PYTHONPATH
"$root/.venv/bin/python" -B data/studies/riva2019/figures.py || exit 1
exec "$root/.venv/bin/python" -B data/studies/riva2019/friction_figures.py
