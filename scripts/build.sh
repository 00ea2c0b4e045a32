#!/bin/sh
# Build the program `plateau`, with whatever its libraries need first. Messages go to standard error.
set -u

root=$(CDPATH='' cd -P "${0%/*}/.." && pwd -P) || exit 1
. "$root/scripts/paths.sh"
. "$root/scripts/say.sh"
. "$root/scripts/lock.sh"
. "$root/scripts/toolchain.sh"

build() {
    prepare_toolchain
    mark=$stamp.$$
    printf '%s\n' "$stamp_key" >"$mark" || exit 1
    [ -x "$program" ] || say "building the program; the first time takes 3 to 5 minutes on two cores"
    # The module of the Python package comes with it, which needs no Python to be built. With the tests among the packages libraries
    # have the features that they have in tests, and cargo does not build them, and the crates above them, a second time for those.
    # shellcheck disable=SC2086
    if ! (cd "$root" && cargo build --release --locked -p plateau $module -p plateau-tests --bin plateau --lib --target-dir "$target" \
        $feature_options); then
        rm -f "$mark"
        die "the program could not be built, see above"
    fi
    can_start
    if [ ! -x "$program" ]; then
        rm -f "$mark"
        die "cargo put the program elsewhere than $program: unset CARGO_BUILD_TARGET and build.target"
    fi
    mv -f "$mark" "$stamp"
}

mkdir -p "$target" 2>/dev/null
[ -w "$target" ] ||
    die "the program is missing or out of date, and $target cannot be written: set CARGO_TARGET_DIR"
with_lock "$target/plateau.lock" build >&2 </dev/null
