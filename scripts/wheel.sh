#!/bin/sh
# Build the wheel: the Python package with its module in Rust and the program in it, for Linux with glibc 2.28 or newer, and check what is in it. What it
# needs besides Rust (maturin, zig as the C compiler and linker, cmake, ninja, auditwheel) comes with pip into .venv-wheel.
#
# usage: scripts/wheel.sh [FOLDER], the folder for the wheel, dist in the checkout unless given
set -u

root=$(CDPATH='' cd -P "${0%/*}/.." && pwd -P) || exit 1
. "$root/scripts/say.sh"
. "$root/scripts/lock.sh"
. "$root/scripts/paths.sh"
. "$root/scripts/rust.sh"
. "$root/scripts/python.sh"

folder=${1:-$root/dist}
case $folder in /*) ;; *) folder=$PWD/$folder ;; esac
environment=$root/.venv-wheel
requirements=$root/scripts/wheel-requirements.txt
glibc=2_28

build() {
    # Of the works of others in the program; they go into the wheel, and not into the checkout.
    python3 "$root/scripts/notices.py" >"$root/THIRD-PARTY-NOTICES" || die "the notices could not be collected, see above"
    set -- --zig --compatibility "manylinux_$glibc" --target-dir "$target"
    (cd "$root" && python packaging/backend/wheel_backend.py "$@" && maturin build --release --locked "$@" \
        --sbom-include packaging/program.cdx.json --out "$folder") ||
        die "the wheel could not be built, see above"
}

# In the wheel there is what there should be, and the program asks for no newer system than the name of the wheel says.
check() {
    python "$root/scripts/wheel_check.py" "$1" || exit 1
    auditwheel show "$1" | tr '\n' ' ' | grep -q "consistent with the following platform tag: *\"manylinux_" ||
        { auditwheel show "$1" >&2 && die "auditwheel finds another platform than manylinux, see above"; }
}

trap 'rm -f "$root/THIRD-PARTY-NOTICES"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
need_rust
with_lock "$environment.lock" fill_venv "$environment" "$requirements" >&2 || die "pip could not install what builds the wheel, see above"
PATH=$environment/bin:$PATH
CMAKE=$environment/bin/cmake
CMAKE_GENERATOR=Ninja
export PATH CMAKE CMAKE_GENERATOR
mkdir -p "$folder" "$target" || exit 1
with_lock "$target/plateau.lock" build >&2 </dev/null || exit 1
version=$(sed -n 's/^version *= *"\(.*\)"/\1/p' "$root/Cargo.toml" | head -n 1)
for wheel in "$folder"/plateau_brake-"$version"-*-manylinux_"$glibc"_*.whl; do
    [ -f "$wheel" ] || die "maturin has written no wheel for manylinux_$glibc into $folder"
    check "$wheel"
    printf '%s\n' "$wheel"
done
