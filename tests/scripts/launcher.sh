#!/bin/sh
# The command ./plateau on a machine made of stand-ins: cargo, rustc and Python are scripts that write down how they
# were called, and PATH holds nothing but them and the tools every Debian has. What is tested is when a build
# happens, with which tools, and how the program is started; no compiler runs.
# shellcheck disable=SC2030,SC2031
set -u

repository=$(CDPATH='' cd -P "${0%/*}/../.." && pwd -P) || exit 1
sandbox=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$sandbox"; rm -rf "$sandbox"' EXIT
failures=0

# The checkout has a space in its name.
checkout="$sandbox/check out"
tools=$sandbox/tools
calls=$sandbox/calls
unset CARGO_TARGET_DIR PLATEAU_FEATURES CMAKE CMAKE_GENERATOR RUSTUP_TOOLCHAIN RUSTFLAGS CC
HOME=$sandbox/home
export HOME calls

stand_in() {
    cat >"$tools/$1"
    chmod +x "$tools/$1"
}

set_up() {
    rm -rf "$checkout" "$tools" "$HOME/.cargo"
    mkdir -p "$checkout/crates/cli/src" "$tools" "$HOME" "$checkout/.git/logs"
    cp -R "$repository/plateau" "$repository/scripts" "$checkout"
    printf 'rust-version = "1.95"\n' >"$checkout/Cargo.toml"
    : >"$checkout/Cargo.lock"
    : >"$checkout/crates/cli/src/main.rs"
    : >"$checkout/crates/cli/src/other.rs"
    : >"$checkout/.git/logs/HEAD"
    : >"$calls"
    for tool in sh find mkdir mv rm sed cat chmod mktemp readlink sleep flock; do
        path=$(PATH=/usr/bin:/bin command -v "$tool") && ln -s "$path" "$tools/$tool"
    done
    stand_in rustc <<'END'
#!/bin/sh
echo "rustc ${fake_rust:-1.95.0} (0123456 2026-04-14)"
END
    stand_in cc <<'END'
#!/bin/sh
while [ "$1" != -o ]; do shift; done
printf '#!/bin/sh\n' >"$2"
END
    stand_in make </dev/null
    stand_in cmake <<'END'
#!/bin/sh
echo "cmake version ${fake_cmake:-3.26.0}"
END
    # Fails when a second one runs at the same time. The program it makes tells how it was started.
    stand_in cargo <<'END'
#!/bin/sh
echo "cargo CMAKE=${CMAKE:-} CMAKE_GENERATOR=${CMAKE_GENERATOR:-} $*" >>"$calls"
echo 'message on standard output'
[ -z "${fake_failure:-}" ] || { echo 'error: this does not compile' >&2; exit 101; }
while [ "$1" != --target-dir ]; do shift; done
mkdir "$2/running" || exit 1
sleep 0.2
[ -z "${fake_edit:-}" ] || : >"$fake_edit"
mkdir -p "$2/release"
printf '#!/bin/sh\necho "$PLATEAU_CALLED" >"$calls.called"\nprintf "%%s\\n" "in $PWD" "$@"\nexit 7\n' >"$2/release/plateau"
chmod +x "$2/release/plateau"
rm -r "$2/running"
END
    # As on a fresh Debian: a venv comes without pip, and there is no ensurepip; pip is installed for the system.
    stand_in python3 <<'END'
#!/bin/sh
echo "python3 $*" >>"$calls"
case $* in
    '-m venv --without-pip '*)
        for venv; do :; done
        mkdir -p "$venv/bin"
        cat >"$venv/bin/python" <<'PYTHON'
#!/bin/sh
venv=${0%/bin/python}
case $* in
    '-c '*) echo "$venv/site-packages" ;;
    *-m\ ensurepip*) exit 1 ;;
    *) [ -d "$venv/site-packages/pip" ] || exit 1 ;;
esac
for package; do :; done
case $package in
    */build-requirements.txt)
        printf '#!/bin/sh\necho cmake version 4.4.4\n' >"$venv/bin/cmake"
        printf '#!/bin/sh\necho 1.13\n' >"$venv/bin/ninja"
        chmod +x "$venv/bin/cmake" "$venv/bin/ninja"
        ;;
esac
PYTHON
        chmod +x "$venv/bin/python"
        ;;
    *--target*) mkdir -p "$6/pip" ;;
esac
END
    # The stamp and the files it is compared with must not share a tick of the clock.
    sleep 0.02
}

# launch COMMAND...: its standard output, standard error and status, with nothing on PATH but the stand-ins.
launch() {
    (PATH=$tools; "$@") >"$sandbox/out" 2>"$sandbox/err"
    status=$?
    sleep 0.02
}

builds() {
    grep -c '^cargo' "$calls"
}

expect() {
    if [ "$2" != "$3" ]; then
        failures=$((failures + 1))
        printf 'FAILED %s\n  expected: %s\n  found:    %s\n' "$1" "$3" "$2"
        cat "$sandbox/err"
    fi
}

expect_message() {
    expect "$1: exit status" "$status" 1
    case $(cat "$sandbox/err") in
        "plateau: "*"$2"*) ;;
        *) expect "$1: message" "$(cat "$sandbox/err")" "plateau: ...$2..." ;;
    esac
    expect "$1: lines of the message" "$(wc -l <"$sandbox/err")" 1
}

set_up
cd "$HOME" || exit 1
launch "$checkout/plateau" run 'a scene.toml' ''
expect 'first use: output, working directory and arguments' "$(cat "$sandbox/out")" "in $HOME
run
a scene.toml"
expect 'the status of the program' $status 7
expect 'first use builds once, locked' "$(cat "$calls")" \
    "cargo CMAKE= CMAKE_GENERATOR= build --release --locked -p plateau -p plateau-python -p plateau-tests --bin plateau --lib --target-dir $checkout/target"
launch "$checkout/plateau"
expect 'second use does not build' "$(builds)" 1
expect 'second use is silent' "$(cat "$sandbox/err")" ''

rm "$tools/find"
launch "$checkout/plateau"
expect_message 'without find' 'find is missing'
ln -s "$(PATH=/usr/bin:/bin command -v find)" "$tools/find"
# As on a file system that is mounted noexec: there the system says the same of a file with that permission.
chmod a-x "$checkout/target/release/plateau"
launch "$checkout/plateau"
expect_message 'a program that may not be started' 'noexec'
expect 'that does not build' "$(builds)" 1
chmod a+x "$checkout/target/release/plateau"
# The system would end the real program by a signal.
# The inner shell expands the name.
# shellcheck disable=SC2016
launch sh -c 'ulimit -v 20000; exec "$0"' "$checkout/plateau"
expect_message 'less address space than the program takes' 'may have 20000 KiB of address space'

mkdir "$sandbox/bin" "$sandbox/bin/deep"
ln -s ../../check\ out/plateau "$sandbox/bin/deep/relative"
ln -s "$sandbox/bin/deep/relative" "$sandbox/bin/absolute"
launch "$sandbox/bin/absolute" version
expect 'through two links' "$(cat "$sandbox/out")" "in $HOME
version"
(cd "$checkout" && launch sh plateau version)
expect 'as an argument of sh' "$(cat "$sandbox/out")" "in $checkout
version"
expect 'links do not build' "$(builds)" 1

: >"$checkout/crates/cli/src/main.rs"
launch "$checkout/plateau"
expect 'a changed source builds' "$(builds)" 2
rm "$checkout/crates/cli/src/other.rs"
launch "$checkout/plateau"
expect 'a deleted source builds' "$(builds)" 3
: >"$checkout/.git/logs/HEAD"
launch "$checkout/plateau"
expect 'another revision builds' "$(builds)" 4
: >"$checkout/rust-toolchain.toml"
launch "$checkout/plateau"
expect 'a toolchain file builds' "$(builds)" 5
RUSTFLAGS='-C target-cpu=native' launch "$checkout/plateau"
RUSTFLAGS='-C target-cpu=native' launch "$checkout/plateau"
expect 'other compiler flags build, once' "$(builds)" 6
PLATEAU_FEATURES=system-hdf5 fake_cmake=3.25.1 launch "$checkout/plateau"
expect 'other features build' "$(builds)" 7
expect 'the installed HDF5 needs no cmake' "$(tail -n 1 "$calls")" \
    "cargo CMAKE= CMAKE_GENERATOR= build --release --locked -p plateau -p plateau-python -p plateau-tests --bin plateau --lib --target-dir $checkout/target --no-default-features --features system-hdf5"
PLATEAU_FEATURES=mpi launch "$checkout/plateau"
expect_message 'no MPI' "the compiler 'mpicc' is missing: install libopenmpi-dev and libclang-dev"
expect 'without MPI nothing is built' "$(builds)" 7
stand_in mpicc </dev/null
PLATEAU_FEATURES=mpi launch "$checkout/plateau"
expect 'MPI comes on top of the default features' "$(tail -n 1 "$calls" | sed 's/.*target //')" '--features mpi'
PLATEAU_FEATURES=system-hdf5,mpi launch "$checkout/plateau"
expect 'the installed HDF5 and MPI' "$(tail -n 1 "$calls" | sed 's/.*target //')" \
    '--no-default-features --features system-hdf5,mpi'
launch "$checkout/plateau"
launch "$checkout/plateau"
expect 'default features again build, once' "$(builds)" 10

rm "$checkout/target/release/plateau"
fake_edit=$checkout/crates/cli/src/main.rs launch "$checkout/plateau"
launch "$checkout/plateau"
expect 'a source changed during the build builds again' "$(builds)" 12

: >"$checkout/crates/cli/src/main.rs"
fake_failure=1 launch "$checkout/plateau"
expect 'a failed build' $status 1
expect 'a failed build shows the reason' "$(grep -c '^error: this does not compile' "$sandbox/err")" 1
expect 'a failed build leaves standard output alone' "$(cat "$sandbox/out")" ''
launch "$checkout/plateau"
expect 'after a failed build the next one runs' "$(builds) $status" '14 7'

set_up
CARGO_TARGET_DIR=elsewhere launch "$checkout/plateau"
CARGO_TARGET_DIR=elsewhere launch "$checkout/plateau"
expect 'a target folder relative to the working directory' "$(builds) $status" '1 7'
expect 'the program is in that folder' "$(ls "$HOME/elsewhere/release")" plateau

set_up
(PATH=$tools; "$checkout/plateau" one >"$sandbox/one" 2>&1) &
(PATH=$tools; "$checkout/plateau" two >"$sandbox/two" 2>&1) &
wait
expect 'two first uses at once' "$(tail -n 1 "$sandbox/one") $(tail -n 1 "$sandbox/two")" 'one two'
launch "$checkout/plateau"
expect 'and their stamp is right' "$(cat "$sandbox/err")" ''

set_up
fake_rust=1.94.1 launch "$checkout/plateau"
expect_message 'an old compiler' 'Rust 1.94.1 is too old, 1.95 or newer is needed'
fake_rust=2.0.0 launch "$checkout/plateau"
expect 'a new compiler' $status 7
expect 'the program knows how it was called' "$(cat "$calls.called")" "$checkout/plateau"

set_up
mkdir -p "$HOME/.cargo/bin"
mv "$tools/cargo" "$HOME/.cargo/bin"
launch "$checkout/plateau"
expect 'cargo beside PATH' $status 7
set_up
rm "$tools/cargo"
launch "$checkout/plateau"
expect_message 'no cargo' 'cargo is missing: install Rust 1.95'
set_up
rm "$tools/cc"
launch "$checkout/plateau"
expect_message 'no C compiler' "install gcc and libc6-dev"
set_up
CMAKE=$tools/cmake fake_cmake=3.25.1 launch "$checkout/plateau"
expect_message 'CMAKE too old' 'which is no cmake 3.26'

set_up
fake_cmake=3.25.1 launch "$checkout/plateau"
expect 'an old cmake is replaced' "$(tail -n 1 "$calls" | sed 's/ build --release.*//')" \
    "cargo CMAKE=$checkout/.venv-build/bin/cmake CMAKE_GENERATOR="
rm "$tools/python3" "$checkout/target/plateau.stamp"
fake_cmake=3.25.1 launch "$checkout/plateau"
expect 'and fetched once' $status 7

set_up
rm "$tools/cmake" "$tools/make"
launch "$checkout/plateau"
expect 'neither cmake nor make' "$(tail -n 1 "$calls" | sed 's/ build --release.*//')" \
    "cargo CMAKE=$checkout/.venv-build/bin/cmake CMAKE_GENERATOR=Ninja"
set_up
rm "$tools/make"
launch "$checkout/plateau"
expect 'no make' "$(tail -n 1 "$calls" | sed 's/ build --release.*//') $(ls "$checkout/.venv-build/bin")" \
    "cargo CMAKE= CMAKE_GENERATOR=Ninja cmake
ninja
python"

set_up
rm "$tools/cmake" "$tools/python3"
launch "$checkout/plateau"
expect 'no Python: exit status' $status 1
expect 'no Python: message' "$(tail -n 1 "$sandbox/err")" 'plateau: python3 is missing: install python3'

# Root may write everywhere, so for root this holds less.
set_up
launch "$checkout/plateau"
chmod -R a-w "$checkout"
launch "$checkout/plateau"
expect 'a read-only checkout that is up to date' "$status $(cat "$sandbox/err")" '7 '
chmod -R u+w "$checkout"

[ $failures -eq 0 ] || exit 1
echo 'the launcher does what it should'
