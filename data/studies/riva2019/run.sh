#!/bin/sh
# The whole study: runs without time acceleration of the paper's three discs with local and with pooled debris, sets of surfaces,
# checks of symmetry, what the local rule rests on, and what a strength of the build-up does; then all numbers, figures and tables.
# Takes six hours or more on two cores. Called again after it was stopped, it goes on.
#
# usage: data/studies/riva2019/run.sh [--keep-pooled]
#   --keep-pooled  without the runs with pooled debris and without time acceleration: their numbers are those that were kept in
#                  pooled-kept.json, which saves half an hour
set -u
case ${1:-} in '' | --keep-pooled) keep=${1:-} ;; *) echo "usage: run.sh [--keep-pooled]" >&2 && exit 2 ;; esac
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
# The package of the checkout, with its program.
PYTHONPATH=$root/python
PLATEAU_PROGRAM=$program
export PYTHONPATH PLATEAU_PROGRAM
mkdir -p "$runs"

# The environment in which other readings of the rule are compiled, .venv-study.
with_lock .venv-study.lock fill_venv "$root/.venv-study" "$study/requirements.txt" || exit 1

# simulate SCENE NAME [SET...]: a run with one worker, or the rest of it.
simulate() {
    scene=$1
    name=$2
    shift 2
    "$program" run "$study/$scene.toml" --resume --workers 1 -o "$runs/$name.h5" "$@" >"$runs/$name.log" 2>&1 ||
        die "$name failed: $(tail -n 1 "$runs/$name.log")"
}

# with_set SCENE NAME DISC PIN SCALE [SET...]: the same with the surfaces of these numbers.
with_set() {
    scene=$1
    name=$2
    set -- "$@" --set "disc.surface.synthetic.seed=$3" --set "pin.base.synthetic.seed=$4" \
        --set "pin.surface.synthetic.seed=$4" --set "disc.prepare.scale=$5"
    shift 5
    simulate "$scene" "$name" "$@"
}

of_the_model() {
    simulate baseline baseline
    if [ "$keep" ]; then
        return 0
    fi
    for scale in 1 0.1 0.01; do
        simulate pooled "pooled-$scale" --set "disc.prepare.scale=$scale"
    done
}

of_symmetry() {
    # The initial maps of any run of the baseline do.
    simulate baseline begin --set 'operation.duration="1 s"' --set 'output.maps_at=["0 s"]'
    # shellcheck disable=SC2086
    $python "$study/symmetry.py" "$runs/begin.h5" "$runs/symmetry-surfaces.h5" || exit 1
    for way in as-they-are other-direction inside-out half-a-turn; do
        simulate symmetry "$way" --set "disc.surface.dataset=\"/$way/disc\"" \
            --set "pin.surface.dataset=\"/$way/pin\"" --set "pin.base.dataset=\"/$way/base\""
    done
}

of_sets() {
    for scale in 1 0.1 0.01; do
        # The surfaces of the runs without acceleration.
        simulate sets "quick-$scale" --set "disc.prepare.scale=$scale"
        for seed in 1 2 3 4 5 6 7 8 9 10; do
            with_set sets "set-local-$seed-$scale" "$seed" "$seed" "$scale"
            with_set pooled-sets "set-pooled-$seed-$scale" "$seed" "$seed" "$scale"
        done
    done
    # To the end of the real test.
    simulate sets long --set 'operation.duration="7200 s"' --set 'output.maps_at=["0 s", "3000 s", "7200 s"]'
    # Other pins on the disc of the first set.
    for pin in 2 3 4 5; do
        with_set sets "pin-$pin" 1 "$pin" 1
    done
}

of_the_rig() {
    for scale in 1 0.1 0.01; do
        for seed in 1 2 3; do
            with_set round-pin "round-$seed-$scale" "$seed" "$seed" "$scale"
        done
    done
}

of_strength() {
    for scale in 1 0.1 0.01; do
        for seed in 1 2 3; do
            with_set strength "strength-$seed-$scale" "$seed" "$seed" "$scale"
            # A strength that nothing reaches: none.
            with_set strength "length-$seed-$scale" "$seed" "$seed" "$scale" \
                --set 'materials.pin_secondary.strength="1e6 MPa"'
        done
    done
}

# Studies of a few runs to some hundred, which take both cores.
studies="open-questions ../strength unknowns counterface steady levels"

# One core each: the longest runs, and all else.
(
    of_the_model
    "$program" sweep run "$study/open-questions.toml" --jobs 1 --task 1/2 >/dev/null 2>"$runs/open-questions-1.log"
) &
long=$!
(
    simulate heights-10 heights-10
    simulate heights-100 heights-100
    of_symmetry
    of_sets
    of_the_rig
    of_strength
    "$root/.venv-study/bin/python" -B "$study/variants.py" || exit 1
    "$program" sweep run "$study/open-questions.toml" --jobs 1 --task 2/2 >/dev/null 2>"$runs/open-questions-2.log"
) || die 'the study is not complete; call this again to go on'
wait $long || die 'the baseline is not complete; call this again to go on'
for name in $studies; do
    "$program" sweep run "$study/$name.toml" --jobs 2 >/dev/null || die 'call this again to go on'
    "$program" sweep collect "$study/$name.toml" >/dev/null || exit 1
done

# shellcheck disable=SC2086
{
    $python "$study/evaluate.py" || exit 1
    $python "$study/round_pin.py" || exit 1
    $python "$study/strength.py" || exit 1
    $python "$study/write_docs.py" || exit 1
}
exec "$study/figures.sh"
