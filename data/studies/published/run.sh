#!/bin/sh
# Both studies, with the base scene and with pair-strength.toml; then results.json and docs/evidence/published.md. A few minutes on one
# core. Called again after it was stopped, it goes on.
#
# usage: data/studies/published/run.sh
set -u
cd "$(dirname "$0")/../../.." || exit 1
root=$PWD
study=data/studies/published

. scripts/paths.sh
. scripts/say.sh
. scripts/lock.sh
. scripts/python.sh
sh scripts/build.sh || exit 1
with_lock .venv.lock install_readers || exit 1
# The package of the checkout, with its program.
PATH=$root/python/bin:$PATH
PYTHONPATH=$root/python
PLATEAU_PROGRAM=$program
export PATH PYTHONPATH PLATEAU_PROGRAM

mkdir -p "$study/strength"
for name in skewness factors; do
    sed 's|^base = "pair.toml"|base = "../pair-strength.toml"|' "$study/$name.toml" >"$study/strength/$name.toml"
    for file in "$study/$name.toml" "$study/strength/$name.toml"; do
        "$program" sweep run "$file" --jobs 1 || die 'call this again to go on'
        "$program" sweep collect "$file" >/dev/null || exit 1
    done
done
"$root/.venv/bin/python" -B "$study/evaluate.py" || exit 1
exec "$root/.venv/bin/python" -B "$study/page.py"
