#!/bin/sh
# The wheel as its users have it, in a clean Python environment and as an ordinary user on Debian 11, 12 and 13 (glibc 2.31, 2.36, 2.41) and on
# Ubuntu 24.04 (glibc 2.39): without Rust, without a compiler, without this checkout it runs a scene, opens
# the run, draws it and makes a study. Builds the wheel unless PLATEAU_WHEEL names one. Debian 11
# comes with debootstrap into a folder that goes with the check; only root can do that. Its own Python is too old for what the package
# needs, so Python 3.11 is built there from the source of Debian 12, which takes some minutes: PLATEAU_DEBIAN_11 names a folder that is kept,
# and in which it is looked for.
set -u
cd "$(dirname "$0")/../.." || exit 1
# shellcheck disable=SC2034
root=$PWD
. tests/cluster/packages.sh
. tests/cluster/debian.sh
. scripts/say.sh
. scripts/python.sh

PYTHON_SOURCE=http://deb.debian.org/debian/pool/main/p/python3.11/python3.11_3.11.2.orig.tar.gz
PYTHON_SHA256=2411c74bda5bbcfcddaf4531f66d1adc73f247f529aee981b029513aefdbf849

# The wheel and Python are built: a quarter of an hour, which a change does not wait for.
[ -n "${PLATEAU_WHEEL:-}" ] || only_when_long 'builds for a quarter of an hour'

lab=$(mktemp -d) || exit 1
eleven=${PLATEAU_DEBIAN_11:-$lab/eleven}
twelve=${PLATEAU_DEBIAN_12:-$lab/twelve}
thirteen=${PLATEAU_DEBIAN_13:-$lab/thirteen}
ubuntu=${PLATEAU_UBUNTU:-$lab/ubuntu}
clean_up() {
    leave_debian "$eleven"
    leave_debian "$twelve"
    leave_debian "$thirteen"
    leave_debian "$ubuntu"
    rm -rf "$lab"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

wheel=${PLATEAU_WHEEL:-}
if [ -z "$wheel" ]; then
    wheel=$(sh scripts/wheel.sh "$lab/dist" | tail -n 1)
    [ -f "$wheel" ] || exit 1
fi
case $wheel in /*) ;; *) wheel=$root/$wheel ;; esac

# What a user has: the wheel, a scene, and a script.
mkdir "$lab/files" || exit 1
cp "$wheel" data/scenes/quick.toml tests/extra/wheel_use.py "$lab/files"
chmod -R a+rX "$lab" "$lab/files"

# An environment of its own, in a folder of its own, with nothing of Rust or the checkout in reach.
make_venv "$lab/venv"
"$lab/venv/bin/python" -m pip install --quiet "${wheel}[all]" || { echo 'pip cannot install the wheel with what it needs' && exit 77; }
cp -R "$lab/files" "$lab/clean" || exit 1
(cd "$lab/clean" && env -i HOME="$lab" PATH="$lab/venv/bin:/usr/bin:/bin" "$lab/venv/bin/python" wheel_use.py) || exit 1
echo "$(basename "$wheel") in a clean environment: a run, its file, a figure, a study"

if [ "$(id -u)" -ne 0 ]; then
    echo 'on Debian and Ubuntu it was not tried: only root may make those systems'
    exit 77
fi
have_curl() { command -v curl >/dev/null 2>&1; }
provide curl have_curl curl

make_debian bullseye "$eleven" gcc libbz2-dev libc6-dev libffi-dev liblzma-dev libssl-dev make zlib1g-dev

if [ ! -x "$eleven/opt/python/bin/python3.11" ]; then
    curl -sSf -o "$eleven/root/python.tar.gz" "$PYTHON_SOURCE" || { echo 'the source of Python cannot be had here' && exit 77; }
    echo "$PYTHON_SHA256  $eleven/root/python.tar.gz" | sha256sum --check --quiet || exit 1
    # The shell inside expands it.
    # shellcheck disable=SC2016
    inside "$eleven" sh -ec 'cd /root && tar xzf python.tar.gz && cd Python-3.11.2 && ./configure -q --prefix=/opt/python &&
        make -s -j"$(nproc)" && make -s install' >"$lab/log" 2>&1 || { tail -n 20 "$lab/log" && exit 1; }
fi
# use_wheel DIR PYTHON: what an ordinary user does on that system.
use_wheel() {
    cp "$lab"/files/* "$1/home/user"
    inside "$1" chown -R user /home/user
    ! as_user "$1" 'command -v cargo || command -v rustc' || { echo 'there is a Rust' && exit 1; }
    began=$(date +%s)
    as_user "$1" "$2 -m venv venv && venv/bin/pip install --quiet --disable-pip-version-check ./$(basename "$wheel")[all]" || exit 1
    echo "pip install: $(($(date +%s) - began)) s"
    as_user "$1" 'venv/bin/python wheel_use.py && venv/bin/plateau --version' || exit 1
    # The shell inside expands it.
    # shellcheck disable=SC2016
    echo "$(basename "$wheel") on $(inside "$1" sh -c '. /etc/os-release && echo "$PRETTY_NAME"'), glibc $(inside "$1" ldd --version | sed -n '1s/.* //p'), as an ordinary user: the same"
}
use_wheel "$eleven" /opt/python/bin/python3.11

# As it is, with its own Python.
for system in "bookworm $twelve" "trixie $thirteen"; do
    make_debian "${system%% *}" "${system#* }" python3 python3-venv
    use_wheel "${system#* }" python3
done
make_ubuntu noble "$ubuntu" python3 python3-venv
use_wheel "$ubuntu" python3
