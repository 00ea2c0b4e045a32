# Where the build lives, and whether it is up to date. Sourced with `root`, the checkout, set; say.sh comes too.
# shellcheck shell=sh disable=SC2034,SC2154

target=${CARGO_TARGET_DIR:-$root/target}
case $target in /*) ;; *) target=$PWD/$target ;; esac
[ -z "${CARGO_TARGET_DIR:-}" ] || CARGO_TARGET_DIR=$target
program=$target/release/plateau

# Features besides the default ones or, with system-hdf5, instead of them: PLATEAU_FEATURES=system-hdf5,mpi
features=${PLATEAU_FEATURES:-}

# The stamp is written when a build ends, but as old as its beginning: what changes during a build is newer.
# Its content is what else decides over the build. A target folder of one's own may serve several checkouts.
stamp=$target/plateau.stamp
stamp_key="features=$features toolchain=${RUSTUP_TOOLCHAIN:-} flags=${RUSTFLAGS:-}"
[ -z "${CARGO_TARGET_DIR:-}" ] || stamp_key="$stamp_key checkout=$root"

# Ends with one line where the program is there and the system will not start it. Building it again would not help.
can_start() {
    [ ! -f "$program" ] || [ -x "$program" ] ||
        die "$program may not be started: the file system is mounted noexec, or the file lost its permission;" \
            "set CARGO_TARGET_DIR to a folder elsewhere, or remove the file"
    # With less address space than the program itself takes, the system ends it by a signal before it can say anything.
    # Shells without it have no such limit to tell.
    # shellcheck disable=SC3045
    limit=$(ulimit -v 2>/dev/null)
    case $limit in
        '' | *[!0-9]*) ;;
        *) [ "$limit" -ge 32768 ] || die "the program needs 64 MiB of memory and may have $limit KiB of address space:" \
            "allow more of it (ulimit -v)" ;;
    esac
}

# Status 2: nobody can tell, for there is no find.
# The program is there and nothing that goes into it has changed since it was built. Folders count, so that a
# deleted file is noticed; the log of the checked-out revision counts, because results name the revision.
is_fresh() {
    [ -x "$program" ] && [ -f "$stamp" ] || return 1
    IFS= read -r built_key <"$stamp" || return 1
    [ "$built_key" = "$stamp_key" ] || return 1
    git_dir=$root/.git
    [ ! -f "$git_dir" ] || read -r _ git_dir <"$git_dir"
    command -v find >/dev/null 2>&1 || return 2
    newer=$(find "$root/crates" "$root/data/scene.schema.json" "$root/Cargo.toml" "$root/Cargo.lock" "$root/.cargo" "$root/rust-toolchain" \
        "$root/rust-toolchain.toml" "$git_dir/logs/HEAD" -newer "$stamp" -print -quit 2>/dev/null)
    [ -z "$newer" ]
}
