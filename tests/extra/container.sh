#!/bin/sh
# The recipes of the containers, step by step on clean systems with Debian 12: the first stage builds and installs the program with MPI, the
# second one runs it, alone and on two ranks. Only root can make such systems. Rust comes from this machine, read-only. No program for
# containers is needed; apptainer.sh tries plateau.def with Apptainer itself.
# What is between single quotes is for the shells of those systems.
# shellcheck disable=SC2016
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
. tests/cluster/packages.sh
. tests/cluster/debian.sh

only_when_long 'builds for ten minutes'
if [ "$(id -u)" -ne 0 ]; then
    echo 'only root may make the systems on which it is tried'
    exit 77
fi
# PLATEAU_CONTAINERS names a folder whose systems are kept.
lab=$(mktemp -d) || exit 1
systems=${PLATEAU_CONTAINERS:-$lab}
clean_up() {
    umount "$systems/build/opt/rust" 2>/dev/null
    leave_debian "$systems/build"
    leave_debian "$systems/final"
    rm -rf "$lab"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# Both recipes have the same steps.
for recipe in Containerfile plateau.def; do
    for step in 'sh /src/packaging/container/build.sh /opt/plateau' 'sh /opt/runtime.sh'; do
        grep -q "$step" "packaging/container/$recipe" || { echo "$recipe does not say '$step'" && exit 1; }
    done
done

make_debian bookworm "$systems/build"
rm -rf "$systems/build/src" && git clone -q "$root" "$systems/build/src" || exit 1
mkdir -p "$systems/build/opt/rust"
if ! { mount --bind "$(rustc --print sysroot)" "$systems/build/opt/rust" && mount -o remount,bind,ro "$systems/build/opt/rust"; }; then
    echo 'no folder of this machine can be mounted there'
    exit 77
fi
inside "$systems/build" env PATH=/opt/rust/bin:/usr/sbin:/usr/bin:/sbin:/bin sh /src/packaging/container/build.sh /opt/plateau >"$lab/said" 2>&1 ||
    { tail -n 20 "$lab/said" && echo 'the first stage failed' && exit 1; }
echo "first stage: $(inside "$systems/build" /opt/plateau/bin/plateau --version | head -n 1)"

make_debian bookworm "$systems/final"
cp packaging/container/runtime.sh "$systems/final/opt/runtime.sh"
inside "$systems/final" sh /opt/runtime.sh >"$lab/said" 2>&1 || { tail -n 20 "$lab/said" && echo 'the second stage failed' && exit 1; }
rm -rf "$systems/final/opt/plateau" && cp -r "$systems/build/opt/plateau" "$systems/final/opt/plateau" || exit 1
# The environment of both recipes, and the test of plateau.def.
as_user "$systems/final" 'export PATH=/opt/plateau/bin:$PATH
    plateau --version >/dev/null
    plateau check /opt/plateau/share/plateau/scenes/quick.toml >/dev/null
    plateau run /opt/plateau/share/plateau/scenes/quick.toml -o one.h5 >/dev/null
    mpirun --oversubscribe -n 2 plateau run /opt/plateau/share/plateau/scenes/quick.toml -o two.h5 >/dev/null
    for run in one two; do plateau surface $run.h5 --dataset disc/height --at "60 s" --to $run.npy >/dev/null; done
    cmp one.npy two.npy' ||
    { echo 'the second stage does not run' && exit 1; }
echo "second stage, as an ordinary user without a compiler: a run, and the same heights from two ranks"
