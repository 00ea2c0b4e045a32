#!/bin/sh
# The whole study: runs without time acceleration of the paper's three discs, checks of symmetry, and what the paper leaves open;
# then all numbers, figures and tables. Takes one to two hours on two cores. Called again after it was stopped, it goes on.
#
# usage: data/studies/riva2019/run.sh
set -u
cd "$(dirname "$0")/../../.." || exit 1
root=$PWD
study=data/studies/riva2019
runs=$study/runs

. scripts/paths.sh
. scripts/say.sh
. scripts/lock.sh
. scripts/python.sh
sh scripts/build.sh || exit 1
with_lock .venv.lock install_readers || exit 1
python="$root/.venv/bin/python -B"
mkdir -p "$runs"

# simulate SCENE NAME [SET...]: a run with one worker, or the rest of it.
simulate() {
    scene=$1
    name=$2
    shift 2
    "$program" run "$study/$scene.toml" --resume --workers 1 -o "$runs/$name.h5" "$@" >"$runs/$name.log" 2>&1 ||
        die "$name failed: $(tail -n 1 "$runs/$name.log")"
}

# One core each: the long run, and all else, of which it makes a part when it is done.
(
    simulate baseline baseline
    "$program" sweep run "$study/open-questions.toml" --jobs 1 --task 1/2 >/dev/null 2>"$runs/open-questions-1.log"
) &
long=$!
(
    simulate heights-10 heights-10
    simulate heights-100 heights-100
    # The initial maps of any run of the baseline do.
    simulate baseline begin --set 'operation.duration="1 s"' --set 'output.maps_at=["0 s"]'
    # shellcheck disable=SC2086
    $python "$study/symmetry.py" "$runs/begin.h5" "$runs/symmetry-surfaces.h5" || exit 1
    for way in as-they-are other-direction inside-out half-a-turn; do
        simulate symmetry "$way" --set "disc.surface.dataset=\"/$way/disc\"" \
            --set "pin.surface.dataset=\"/$way/pin\"" --set "pin.base.dataset=\"/$way/base\""
    done
    for seed in 1 2 3 4 5 6 7 8 9 10; do
        for scale in 1 0.1 0.01; do
            simulate sets "set-$seed-$scale" --set "disc.surface.synthetic.seed=$seed" \
                --set "pin.base.synthetic.seed=$seed" --set "pin.surface.synthetic.seed=$seed" \
                --set "disc.prepare.scale=$scale"
        done
    done
    "$program" sweep run "$study/open-questions.toml" --jobs 1 --task 2/2 >/dev/null 2>"$runs/open-questions-2.log"
) || die 'the study is not complete; call this again to go on'
wait $long || die 'the baseline is not complete; call this again to go on'
"$program" sweep run "$study/open-questions.toml" --jobs 2 >/dev/null || die 'call this again to go on'
"$program" sweep collect "$study/open-questions.toml" >/dev/null || exit 1

# shellcheck disable=SC2086
{
    $python "$study/evaluate.py" || exit 1
    $python "$study/write_docs.py" || exit 1
}
exec "$study/figures.sh"
