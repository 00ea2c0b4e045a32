#!/bin/sh
# The wheel as its users have it, in a clean Python environment and as an ordinary user on Debian 11 (glibc 2.31): without Rust, without a
# compiler, without this checkout it runs a scene, opens the run and draws it. Builds the wheel unless PLATEAU_WHEEL names one. Debian 11
# comes with debootstrap into a folder that goes with the check; only root can do that. Its own Python is too old for what the package
# needs, so Python 3.11 is built there from the source of Debian 12, which takes some minutes: PLATEAU_DEBIAN_11 names a folder that is kept,
# and in which it is looked for.
set -u
cd "$(dirname "$0")/../.." || exit 1
# shellcheck disable=SC2034
root=$PWD
. tests/cluster/packages.sh
. scripts/say.sh
. scripts/python.sh

PYTHON_SOURCE=http://deb.debian.org/debian/pool/main/p/python3.11/python3.11_3.11.2.orig.tar.gz
PYTHON_SHA256=2411c74bda5bbcfcddaf4531f66d1adc73f247f529aee981b029513aefdbf849

# The wheel and Python are built: a quarter of an hour, which a change does not wait for.
if [ -z "${PLATEAU_LONG:-}${PLATEAU_WHEEL:-}" ]; then
    echo "builds for a quarter of an hour: PLATEAU_LONG=1 ./check extra runs it, and so do the weekly checks"
    exit 77
fi

lab=$(mktemp -d) || exit 1
debian=${PLATEAU_DEBIAN_11:-$lab/debian}
clean_up() {
    umount "$debian/proc" 2>/dev/null
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
"$lab/venv/bin/python" -m pip install --quiet "${wheel}[plot]" || { echo 'pip cannot install the wheel with what it needs' && exit 77; }
(cd "$lab/files" && env -i HOME="$lab" PATH="$lab/venv/bin:/usr/bin:/bin" "$lab/venv/bin/python" wheel_use.py) || exit 1
echo "$(basename "$wheel") in a clean environment: a run, its file, a figure"

if [ "$(id -u)" -ne 0 ]; then
    echo 'on Debian 11 it was not tried: only root may make that system'
    exit 77
fi
have_debootstrap() { command -v debootstrap >/dev/null 2>&1; }
provide debootstrap have_debootstrap debootstrap
have_curl() { command -v curl >/dev/null 2>&1; }
provide curl have_curl curl

inside() {
    chroot "$debian" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root "$@"
}

make_debian() {
    [ ! -x "$debian/usr/bin/gcc" ] || return 0
    debootstrap --variant=minbase \
        --include=ca-certificates,gcc,libbz2-dev,libc6-dev,libffi-dev,liblzma-dev,libssl-dev,make,zlib1g-dev \
        bullseye "$debian" http://deb.debian.org/debian >"$lab/log" 2>&1
}
make_debian || { tail -n 5 "$lab/log" && echo 'Debian 11 cannot be had here' && exit 77; }
[ -e "$debian/proc/self" ] || mount -t proc proc "$debian/proc" || { echo 'no /proc can be mounted for Debian 11' && exit 77; }
# The names and certificates of this machine.
cp /etc/resolv.conf "$debian/etc/resolv.conf"
cp /etc/ssl/certs/ca-certificates.crt "$debian/etc/ssl/certs/ca-certificates.crt"

if [ ! -x "$debian/opt/python/bin/python3.11" ]; then
    curl -sSf -o "$debian/root/python.tar.gz" "$PYTHON_SOURCE" || { echo 'the source of Python cannot be had here' && exit 77; }
    echo "$PYTHON_SHA256  $debian/root/python.tar.gz" | sha256sum --check --quiet || exit 1
    # The shell inside expands it.
    # shellcheck disable=SC2016
    inside sh -ec 'cd /root && tar xzf python.tar.gz && cd Python-3.11.2 && ./configure -q --prefix=/opt/python &&
        make -s -j"$(nproc)" && make -s install' >"$lab/log" 2>&1 || { tail -n 20 "$lab/log" && exit 1; }
fi
inside sh -ec 'id user >/dev/null 2>&1 || useradd -m user; rm -rf /home/user/*'
cp "$lab"/files/* "$debian/home/user"
inside chown -R user /home/user
user() {
    chroot --userspec=user "$debian" env -i PATH=/usr/bin:/bin HOME=/home/user PIP_CERT=/etc/ssl/certs/ca-certificates.crt \
        sh -ec "cd && $1"
}
! user 'command -v cargo' || { echo 'there is a Rust on Debian 11' && exit 1; }
user '/opt/python/bin/python3.11 -m venv venv && venv/bin/pip install --quiet --disable-pip-version-check ./*.whl matplotlib' || exit 1
user 'venv/bin/python wheel_use.py && venv/bin/plateau --version' || exit 1
echo "$(basename "$wheel") on Debian $(cat "$debian/etc/debian_version"), glibc $(inside ldd --version | sed -n '1s/.* //p'), as an ordinary user: the same"
