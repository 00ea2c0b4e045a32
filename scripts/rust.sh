# A Rust toolchain and a C compiler that work. Sourced after say.sh with `root` set.
# shellcheck shell=sh disable=SC2154

need_rust() {
    if ! command -v cargo >/dev/null 2>&1; then
        [ -x "$HOME/.cargo/bin/cargo" ] || die "cargo is missing: install Rust $(minimum_rust) or newer with rustup"
        PATH=$HOME/.cargo/bin:$PATH
    fi
    rust_version=$(cd "$root" && rustc --version 2>&1) || die "rustc does not run: $rust_version"
    rust_version=${rust_version#rustc }
    rust_version=${rust_version%% *}
    version_at_least "$rust_version" "$(minimum_rust)" ||
        die "Rust $rust_version is too old, $(minimum_rust) or newer is needed: rustup update stable"
}

minimum_rust() {
    sed -n 's/^rust-version *= *"\(.*\)"/\1/p' "$root/Cargo.toml"
}

# The linker of Rust programs is cc too. Compiling a line also finds out that the C library's headers are there.
need_c_compiler() {
    scratch=$(mktemp -d) || exit 1
    printf '#include <stdio.h>\nint main(void) { return puts("") < 0; }\n' >"$scratch/probe.c"
    # CC may hold options.
    # shellcheck disable=SC2086
    ${CC:-cc} -o "$scratch/probe" "$scratch/probe.c" >/dev/null 2>&1
    probed=$?
    rm -rf "$scratch"
    [ $probed -eq 0 ] ||
        die "the C compiler '${CC:-cc}' is missing or cannot link a program: install gcc and libc6-dev (or set CC)"
}

# version_at_least FOUND NEEDED: compares major and minor.
version_at_least() {
    found_major=${1%%.*}
    found_minor=${1#*.}
    found_minor=${found_minor%%[!0-9]*}
    needed_major=${2%%.*}
    needed_minor=${2#*.}
    needed_minor=${needed_minor%%.*}
    case $found_major$found_minor in *[!0-9]* | '') return 1 ;; esac
    [ "$found_major" -gt "$needed_major" ] ||
        { [ "$found_major" -eq "$needed_major" ] && [ "${found_minor:-0}" -ge "$needed_minor" ]; }
}
